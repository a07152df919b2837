#!/usr/bin/env bash
# Fuzzes a target for so many seconds: tools/fuzz.sh TARGET SECONDS [SANITIZER]
# Without a sanitizer unless one is named (address), as the library has `unsafe` in src/simd alone; with it, debug assertions are
# on as well.
# Takes a nightly toolchain and cargo-fuzz. What it learns lies in fuzz/corpus, what breaks a promise in fuzz/artifacts.
set -euo pipefail
cd "$(dirname "$0")/.."

target=$1 seconds=$2 sanitizer=${3:-none}
longest=1024 seeds=(fuzz/seeds)
case $target in
    c) seeds=() ;;
    # An archive of every column.
    npz) longest=4096 seeds=(fuzz/files) ;;
esac
build=(--release --sanitizer "$sanitizer" --no-trace-compares)
if [ "$sanitizer" != none ]; then build+=(--debug-assertions); fi
mkdir -p "fuzz/corpus/$target"
# Edges are what tells inputs apart; how often each is passed is a matter of the number of rays. To weigh inputs by how rare their
# edges are takes as long as a call.
cargo +nightly fuzz run "${build[@]}" "$target" "fuzz/corpus/$target" "${seeds[@]}" -- \
    -max_total_time="$seconds" -max_len="$longest" -len_control=0 -use_counters=0 -entropic=0 -reduce_inputs=0 -print_final_stats=1
