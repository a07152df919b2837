#!/usr/bin/env bash
# Fuzzes a target for so many seconds: tools/fuzz.sh TARGET SECONDS [SANITIZER]
# Without a sanitizer unless one is named (address), as the library has `unsafe` in src/simd alone.
# Takes a nightly toolchain and cargo-fuzz. What it learns lies in fuzz/corpus, what breaks a promise in fuzz/artifacts.
set -euo pipefail
cd "$(dirname "$0")/.."

target=$1 seconds=$2 sanitizer=${3:-none}
mkdir -p "fuzz/corpus/$target"
# Edges are what tells inputs apart; how often each is passed is a matter of the number of rays.
seeds=(fuzz/seeds)
case $target in npz | c) seeds=() ;; esac
cargo +nightly fuzz run --release --sanitizer "$sanitizer" --no-trace-compares "$target" \
    "fuzz/corpus/$target" "${seeds[@]}" -- \
    -max_total_time="$seconds" -max_len=1024 -len_control=0 -use_counters=0 -reduce_inputs=0 -print_final_stats=1
