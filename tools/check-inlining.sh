#!/usr/bin/env bash
# Whether the kernels of a release build are what they were written as: vector instructions, and no call to a function
# that was to be inlined. A call passes vectors through memory and costs more than the kernel around it.
#
#     tools/check-inlining.sh [BINARY]      of x86-64; target/release/airlight unless told otherwise
set -euo pipefail
binary=${1:-"$(dirname "$0")/../target/release/airlight"}

if ! command -v objdump > /dev/null; then
    echo "objdump is missing: the kernels are not looked at"
    exit 0
fi

objdump --disassemble --demangle --no-show-raw-insn "$binary" | awk '
    # A function begins. Kernels are inlined into these, one for each set of instructions.
    /^[0-9a-f]+ <.*>:$/ {
        name = $0
        sub(/^[0-9a-f]+ </, "", name)
        sub(/>:$/, "", name)
        isa = ""
        if (name ~ /::avx2::Home.*::vectorized/) isa = "avx2"
        if (name ~ /::avx512::Home.*::vectorized/) isa = "avx512"
        if (name ~ /::portable::Home.*::apart/) isa = "portable"
        if (isa != "") { kernels[isa]++ }
    }
    isa == "" { next }

    # Multiply-adds on registers of each width.
    /vfn?m(add|sub)[0-9]+p[sd] .*%zmm/ { wide["avx512"] += isa == "avx512" }
    /vfn?m(add|sub)[0-9]+p[sd] .*%ymm/ { wide["avx2"] += isa == "avx2" }

    # Direct calls; those to the standard library go through a table. What may be called is what ends the program, and what
    # copies lanes.
    /\tcall +[0-9a-f]+ </ {
        callee = $0
        sub(/.*\tcall +[0-9a-f]+ </, "", callee)
        sub(/>$/, "", callee)
        if (callee ~ /core::panicking|_index_fail|len_mismatch_fail|mem(cpy|move|set)/) next
        outlined[callee " (called by a kernel of " isa ")"]++
    }

    END {
        if (!kernels["avx2"] || !kernels["avx512"] || !kernels["portable"]) broken = fail("a backend has no kernel")
        for (isa in kernels) {
            printf "%s: %d kernels", isa, kernels[isa]
            # Portable ones have the width that the build enables.
            if (isa != "portable") printf ", %d multiply-adds on whole registers", wide[isa]
            print ""
            if (isa != "portable" && !wide[isa]) broken = fail("no whole register is used by " isa)
        }
        for (callee in outlined) broken = fail("not inlined: " callee)
        exit broken
    }
    function fail(what) {
        print what
        return 1
    }
'
