#!/usr/bin/env bash
# Whether a crate that depends on airlight runs in every profile, on threads with a stack of 256 KiB, and gives the same
# bits. The crate is tests/dependent; it has a target folder of its own.
#
#     tools/check-profiles.sh [PROFILE...]      of tests/dependent/Cargo.toml; all of them unless told otherwise
set -euo pipefail
cd "$(dirname "$0")/../tests/dependent"
export CARGO_TARGET_DIR=../../target/dependent
profiles=("$@")
[ ${#profiles[@]} -gt 0 ] || profiles=(dev opt-1 opt-2 release opt-s opt-z lto)

cargo test --quiet --locked
first=
for profile in "${profiles[@]}"; do
    hashes=$(cargo run --quiet --locked --profile "$profile")
    first=${first:-$hashes}
    if [ "$hashes" != "$first" ]; then
        echo "$profile: other bits than ${profiles[0]}:"
        diff <(echo "$first") <(echo "$hashes") || exit 1
    fi
    echo "$profile: $(echo "$hashes" | wc -l) samplers on backends ran, bits as in ${profiles[0]}"
done
