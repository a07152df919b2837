#!/usr/bin/env bash
# Whether AArch64 gives the bits that x86-64 does with fused multiply-add: tests/dependent, run by qemu, against
# tests/golden/bits.txt. It takes three minutes. What it needs: the target by `rustup target add aarch64-unknown-linux-gnu`,
# a linker and an emulator (Debian: gcc-aarch64-linux-gnu, qemu-user).
#
#     tools/check-targets.sh
set -euo pipefail
cd "$(dirname "$0")/../tests/dependent"
target=aarch64-unknown-linux-gnu
for tool in aarch64-linux-gnu-gcc qemu-aarch64; do
    if ! command -v "$tool" > /dev/null; then
        echo "$tool is missing: $target is not looked at"
        exit 0
    fi
done
if ! [ -d "$(rustc --print sysroot)/lib/rustlib/$target" ]; then
    echo "the target $target is missing: it is not looked at"
    exit 0
fi

export CARGO_TARGET_DIR=../../target/dependent
export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc
export CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_RUNNER="qemu-aarch64 -L /usr/aarch64-linux-gnu"
diff <(grep ^fused ../golden/bits.txt) <(cargo run --quiet --locked --release --target "$target" | sed 's/^portable/fused/')
echo "$target: bits as with fused multiply-add on x86-64"
