#!/usr/bin/env bash
# Whether the crate as it is published builds, and has the pages and images that its documents name: the tarball of
# `cargo package`, unpacked outside the repository, built and documented with all features.
#
#     tools/check-package.sh
set -euo pipefail
cd "$(dirname "$0")/.."
export CARGO_TARGET_DIR=$PWD/target/packaged

cargo package --quiet --locked --package airlight --no-verify --allow-dirty
tarball=$(ls -t "$CARGO_TARGET_DIR"/package/airlight-*.crate | head -n 1)
place=$(mktemp -d)
trap 'rm -r "$place"' EXIT
tar --extract --gzip --file "$tarball" --directory "$place" --strip-components 1
cd "$place"

# Links to files, without the fragment: `](docs/speed.md#table)`, `[speed]: docs/speed.md`.
missing=0
for page in README.md docs/*.md; do
    while read -r link; do
        if ! [ -e "$(dirname "$page")/$link" ]; then
            echo "$page names $link, which the package does not have"
            missing=1
        fi
    done < <(grep --only-matching --perl-regexp '(?:\]\(|^\[[^]]+\]: )\K[^\s)#:]+(?=[\s)#]|$)' "$page" || true)
done
[ $missing = 0 ]

cargo build --quiet --all-features
RUSTDOCFLAGS="-D warnings" cargo doc --quiet --no-deps --all-features
echo "$(basename "$tarball"): $(tar --list --gzip --file "$tarball" | wc -l) files, builds, and its documents are whole"
