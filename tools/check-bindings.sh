#!/usr/bin/env bash
# Whether the bindings are in order: formatting, lints, tests. What is missing on this machine is named and left out.
#
#     tools/check-bindings.sh [--install] [--aarch64]
#
# --install also installs with cargo-c and builds the examples with pkg-config and CMake (minutes, as it builds once more);
# --aarch64 runs tests/environment.c under qemu (the same).
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
export CARGO_TARGET_DIR=$root/target/bindings

# Whether all of these programs are there.
have() {
    local tool
    for tool in "$@"; do
        if ! command -v "$tool" > /dev/null; then
            echo "$tool is missing: $what is not looked at"
            return 1
        fi
    done
}

check_c() (
    cd "$root/bindings/c"
    cargo fmt --check
    cargo clippy --locked --release --all-targets -- -D warnings
    what="C" && { have "${CC:-cc}" || true; }
    what="C++" && { have "${CXX:-c++}" || true; }
    what="memory" && { have valgrind || true; }
    AIRLIGHT_FUZZ=${AIRLIGHT_FUZZ:-1000000} cargo test --locked --release
    RUSTDOCFLAGS="-D warnings" cargo doc --locked --release --no-deps --document-private-items
)

check_install() (
    what="the installed library"
    have cargo-cinstall pkg-config cmake cc c++ || return 0
    prefix=$(mktemp -d)
    cd "$root/bindings/c"
    # A folder of its own, as cargo-c contains another cargo, and the two would build anew after each other.
    CARGO_TARGET_DIR=$CARGO_TARGET_DIR/installed cargo cinstall --locked --release --prefix "$prefix"
    cd "$prefix"
    PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name airlight.pc)")
    export PKG_CONFIG_PATH
    read -ra flags <<< "$(pkg-config --cflags --libs airlight)"
    libraries=$(pkg-config --variable=libdir airlight)
    cc -std=c99 "$root/bindings/c/examples/wavefront.c" -o wavefront "${flags[@]}" -lm -lpthread
    LD_LIBRARY_PATH=$libraries ./wavefront
    c++ -std=c++17 "$root/bindings/c/examples/pathtrace.cpp" -o pathtrace "${flags[@]}"
    LD_LIBRARY_PATH=$libraries ./pathtrace fog.ppm 64
    cmake -S "$root/bindings/c/examples" -B build -DCMAKE_PREFIX_PATH="$prefix"
    cmake --build build
    build/wavefront
    build/pathtrace fog.ppm 64
    rm -r "$prefix"
)

check_aarch64() (
    target=aarch64-unknown-linux-gnu
    what=$target
    have aarch64-linux-gnu-gcc qemu-aarch64 || return 0
    if ! [ -d "$(rustc --print sysroot)/lib/rustlib/$target" ]; then
        echo "the target $target is missing: it is not looked at"
        return 0
    fi
    cd "$root/bindings/c"
    CARGO_TARGET_AARCH64_UNKNOWN_LINUX_GNU_LINKER=aarch64-linux-gnu-gcc cargo build --locked --release --target $target
    program=$CARGO_TARGET_DIR/$target/environment
    aarch64-linux-gnu-gcc -std=c99 -O2 -I include tests/environment.c \
        "$CARGO_TARGET_DIR/$target/release/libairlight_c.a" -o "$program" -lpthread -lm -ldl
    qemu-aarch64 -L /usr/aarch64-linux-gnu "$program"
)

check_c
bindings/python/check.sh
for option in "$@"; do
    case $option in
        --install) check_install ;;
        --aarch64) check_aarch64 ;;
        *) echo "there is no $option" >&2 && exit 2 ;;
    esac
done
