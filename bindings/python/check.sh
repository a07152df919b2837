#!/usr/bin/env bash
# Builds the Python package as a user does, in a virtual environment under target/, and runs its tests: formatting, lints,
# types, documentation, behaviour. Without Python, or where PyPI cannot be reached, it says so and goes on.
set -euo pipefail
cd "$(dirname "$0")"
if ! python3 -c 'import ensurepip, sys, venv; assert sys.version_info >= (3, 11)' 2> /dev/null; then
    echo "Python 3.11 or later, with venv, is missing: bindings/python is not looked at"
    exit
fi
target=$(cd ../.. && pwd)/target
export CARGO_TARGET_DIR=$target/bindings

cargo fmt --check
cargo clippy --locked --release --all-targets -- -D warnings
python3 -m venv "$target/python"
if ! "$target/python/bin/pip" download --quiet --disable-pip-version-check --no-deps --dest "$target/python/probe" maturin; then
    echo "PyPI cannot be reached: the tests of bindings/python are not run"
    exit
fi
"$target/python/bin/pip" install --quiet --disable-pip-version-check '.[test]'
"$target/python/bin/ruff" format --check --quiet
"$target/python/bin/ruff" check --quiet
"$target/python/bin/python" -m mypy --strict python/airlight
"$target/python/bin/python" -m mypy.stubtest airlight._airlight
"$target/python/bin/pytest" --quiet
