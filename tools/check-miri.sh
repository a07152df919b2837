#!/usr/bin/env bash
# No undefined behaviour in what Miri reaches, on few rays: every call on the portable backend and on AVX2, the C ABI, and the
# README's example. Takes a nightly toolchain with the components miri and rust-src.
#
# Miri knows no AVX-512 as far as it is used here, and no naked functions: the entries of the C ABI are run for a target that has
# none (i686), with what they call.
set -euo pipefail
cd "$(dirname "$0")/.."
# Seeds lie in files, and the seed of random tests is the time.
export MIRIFLAGS="-Zmiri-disable-isolation"

step() { echo "== $1"; }

step "one ray of every strategy and the README's example: portable"
cargo +nightly miri test --manifest-path tests/dependent/Cargo.toml
step "every call: AVX2 with FMA"
RUSTFLAGS="-C target-feature=+avx2,+fma,+popcnt" \
    cargo +nightly miri test --manifest-path fuzz/Cargo.toml --no-default-features --target x86_64-unknown-linux-gnu \
    -- random_bytes the_seeds
step "every call, those of the C ABI too: portable"
cargo +nightly miri test --manifest-path fuzz/Cargo.toml --no-default-features --target i686-unknown-linux-gnu \
    -- random_bytes the_seeds
