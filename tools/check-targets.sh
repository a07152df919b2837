#!/usr/bin/env bash
# Whether other targets give the bits of x86-64 that stand in tests/golden/bits.txt: tests/dependent, built for each and run
# by an emulator. AArch64 has those with fused multiply-add; wasm32, with and without simd128, those without. What is missing
# on this machine is named and left out. It takes four minutes.
#
#     tools/check-targets.sh [aarch64|wasm32|wasm32-simd128]...      all of them unless told otherwise
#
# Targets come by `rustup target add aarch64-unknown-linux-gnu wasm32-wasip1`, the linker and the emulators from
# Debian's gcc-aarch64-linux-gnu, qemu-user and nodejs.
set -euo pipefail
cd "$(dirname "$0")/../tests/dependent"
export CARGO_TARGET_DIR=../../target/dependent
export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc
export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER="qemu-aarch64 -L /usr/aarch64-linux-gnu"
export CARGO_TARGET_WASM32_WASIP1_RUNNER="node --no-warnings $PWD/node.mjs"

# Whether the target and these programs are there.
have() {
    local target=$1 tool
    if ! [ -d "$(rustc --print sysroot)/lib/rustlib/$target" ]; then
        echo "the target $target is missing: $name is not looked at"
        return 1
    fi
    for tool in "${@:2}"; do
        if ! command -v "$tool" > /dev/null; then
            echo "$tool is missing: $name is not looked at"
            return 1
        fi
    done
}

# Runs tests/dependent for a target, and compares with the lines of this rounding.
compare() {
    local target=$1 rounding=$2 hashes
    hashes=$(cargo run --quiet --locked --release --target "$target" | sed "s/^portable/$rounding/")
    diff <(grep "^$rounding" ../golden/bits.txt) <(echo "$hashes")
    echo "$name: $(echo "$hashes" | wc -l) samplers ran, bits as on x86-64 ($rounding)"
}

names=("$@")
[ ${#names[@]} -gt 0 ] || names=(aarch64 wasm32 wasm32-simd128)
for name in "${names[@]}"; do
    case $name in
        aarch64)
            if have aarch64-unknown-linux-gnu aarch64-linux-gnu-gcc qemu-aarch64; then
                compare aarch64-unknown-linux-gnu fused
            fi
            ;;
        wasm32)
            if have wasm32-wasip1 node; then compare wasm32-wasip1 plain; fi
            ;;
        wasm32-simd128)
            if have wasm32-wasip1 node; then RUSTFLAGS="-C target-feature=+simd128" compare wasm32-wasip1 plain; fi
            ;;
        *) echo "there is no $name" >&2 && exit 2 ;;
    esac
done
