#!/bin/sh
# check_bits.sh [all|pin|VARIANT...] - the kernel's results have their pinned bits for every instruction set, compiler,
# optimisation level, processor and number of threads. SPDX-License-Identifier: MIT
#
# tests/bits/bits.c prints the hashes of tests/golden/bits.txt. matrix.sha256 is the hash of the file of a whole bed.
# After a deliberate change of the results run `make golden`, which calls check_bits.sh pin. A variant is
# COMPILER:FLAG[,FLAG]. All variants take minutes, so without arguments only the library in BUILD is checked. No library
# may fuse a product with a sum.
set -u
: "${BUILD:=build}" "${MAKE:=make}" "${CC:=cc}" "${HOSTCC:=cc}"
faults=0

# variant NAME COMPILER LEVEL RUN FLAGS ISA...: builds the kernel and the hashing program, and compares what it prints
variant() {
    name=$1 compiler=$2 level=$3 run=$4 flags=$5
    shift 5
    if ! command -v "$compiler" >/dev/null || { test -n "$run" && ! command -v "$run" >/dev/null; }; then
        echo "SKIP bits of $name: no $compiler${run:+ or no $run} on this machine"
        return
    fi
    folder=$BUILD/bits/$name
    mkdir -p "$folder"
    library=$BUILD/libfibrad.a
    # shellcheck disable=SC2086  # level and flags are lists
    if ! { { test "$name" = built || { library=$folder/libfibrad.a &&
        $MAKE -s -j2 BUILD="$folder" CC="$compiler" HOSTCC="$HOSTCC" CFLAGS="$level" lib; }; } &&
        "$compiler" -std=c11 $level -ffp-contract=off -Ikernel $flags tests/bits/bits.c "$library" -lm \
            -o "$folder/bits"; } >"$BUILD/bits/log" 2>&1; then
        echo "$name: does not build:"
        tail -n 5 "$BUILD/bits/log"
        faults=1
        return
    fi
    if objdump -d "$library" 2>/dev/null | grep -E 'vfn?m(add|sub)'; then
        echo "$name: products are fused with sums"
        faults=1
    fi
    for isa; do
        # shellcheck disable=SC2086  # run may be empty
        $run "$folder/bits" $isa >"$folder/bits.txt"
        status=$?
        if test $status = 77; then
            echo "SKIP bits of $name, $isa: not on this machine"
        elif test $status != 0; then
            echo "$name, $isa: exit status $status"
            faults=1
        elif ! cmp -s tests/golden/bits.txt "$folder/bits.txt"; then
            echo "$name, $isa: other bits (pinned <, found >):"
            diff tests/golden/bits.txt "$folder/bits.txt" | head -n 5
            faults=1
        else
            echo "$name, $isa: the pinned bits"
        fi
    done
}

matrix() { # THREADS
    "$BUILD/fibrad" factors tests/data/poly2000.dump --positions --directions 55 --threads "$1" -o "$BUILD/bits/F.mtx" \
        >"$BUILD/bits/log" 2>&1 && sha256sum <"$BUILD/bits/F.mtx" | cut -d ' ' -f 1
}

mkdir -p "$BUILD/bits"
if test "${1:-}" = pin; then # with the simplest build
    $MAKE -s BUILD="$BUILD/bits/pin" CC="$HOSTCC" CFLAGS=-O0 ISAS=scalar lib &&
        $HOSTCC -std=c11 -Ikernel tests/bits/bits.c "$BUILD/bits/pin/libfibrad.a" -o "$BUILD/bits/pin/bits" &&
        "$BUILD/bits/pin/bits" scalar >tests/golden/bits.txt && matrix 1 >tests/golden/matrix.sha256
    exit
fi

test $# -gt 0 || variant built "$CC" -O2 "" "" scalar sse2 avx2 avx512
test "${1:-}" != all || set -- gcc:-O0 gcc:-O2 gcc:-O3 gcc:-O3,-march=native \
    clang:-O0 clang:-O2 clang:-O3 clang:-O3,-march=native aarch64:-O2
for build; do
    level=$(echo "${build#*:}" | tr , ' ')
    case $build in
    aarch64:*) variant "aarch64$level" aarch64-linux-gnu-gcc "$level" qemu-aarch64 -static scalar neon ;;
    *) variant "$(echo "$build" | tr -d :,=)" "${build%:*}" "$level" "" "" scalar sse2 avx2 avx512 ;;
    esac
done
for threads in 1 2 7; do
    found=$(matrix $threads)
    if test "$found" = "$(cat tests/golden/matrix.sha256)"; then
        echo "$threads threads: the pinned matrix"
    else
        echo "$threads threads: another matrix, SHA-256 ${found:-none}"
        faults=1
    fi
done
exit $faults
