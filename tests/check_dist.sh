#!/bin/sh
# check_dist.sh [all] - the kernel in two files builds without further flags, needs no mathematical library, has the
# pinned bits, and fuses no product with a sum, whatever the processor can do; all: at other levels and by other
# compilers, too, and the sources of `make dist` build and test by themselves.
# SPDX-License-Identifier: MIT
set -u
: "${BUILD:=build}" "${MAKE:=make}" "${CC:=cc}"
folder=$BUILD/dist
faults=0
mkdir -p "$folder/joined" # the headers that are part of fibrad.h now
: >"$folder/joined/fibrad_heat.h"
: >"$folder/joined/fibrad_light.h"
: >"$folder/joined/fibrad_limits.h"
: >"$folder/joined/fibrad_mesh.h"
: >"$folder/joined/fibrad_surface.h"
: >"$folder/joined/fibrad_furnace.h"
$MAKE -s --no-print-directory BUILD="$BUILD" CC="$CC" "$folder/fibrad.c" || exit 1

# variant COMPILER LEVEL RUN FLAGS ISA...: compiles with no flags of ours but the level, counts fused operations, links
# the hashing program, compares
variant() {
    compiler=$1 level=$2 run=$3 flags=$4
    shift 4
    if ! command -v "$compiler" >/dev/null || { test -n "$run" && ! command -v "$run" >/dev/null; }; then
        echo "SKIP two files by $compiler: no $compiler${run:+ or no $run} on this machine"
        return
    fi
    # shellcheck disable=SC2086  # level and flags are lists
    if ! "$compiler" $level -Wall -Wextra -Werror -c "$folder/fibrad.c" -o "$folder/$compiler.o" ||
        ! "$compiler" -std=c11 -O2 -ffp-contract=off $flags -I"$folder" -I"$folder/joined" tests/bits/bits.c \
            "$folder/$compiler.o" -o "$folder/$compiler.bits"; then
        faults=1
        return
    fi
    if objdump -d "$folder/$compiler.o" 2>/dev/null | grep -E 'vfn?m(add|sub)'; then
        echo "two files by $compiler $level: products are fused with sums"
        faults=1
    fi
    for isa in "$@"; do
        $run "$folder/$compiler.bits" "$isa" >"$folder/bits.txt"
        status=$?
        if test $status = 77; then
            echo "SKIP two files by $compiler $level, $isa: not on this machine"
        elif test $status != 0 || ! cmp -s tests/golden/bits.txt "$folder/bits.txt"; then
            echo "two files by $compiler $level, $isa: other bits, or exit status $status"
            faults=1
        else
            echo "two files by $compiler $level, $isa: the pinned bits"
        fi
    done
}

case $(gcc -dumpmachine) in
x86_64*) variant gcc "-O2 -march=native" "" "" scalar sse2 avx2 avx512 ;;
*) variant gcc -O2 "" "" scalar ;;
esac
# arithmetic that is not IEEE 754 is refused with a sentence
for flag in -ffast-math -Ofast -ffinite-math-only; do
    "$CC" $flag -fsyntax-only "$folder/fibrad.c" 2>&1 | grep -q 'error.*fibrad needs IEEE 754 arithmetic' ||
        { echo "two files with $flag: no error says that this is wrong" && faults=1; }
done

# needs COMPILER NM FLAG...: the object takes square roots from the processor, not from the mathematical library
needs() {
    compiler=$1 nm=$2
    shift 2
    if ! command -v "$compiler" >/dev/null; then
        echo "SKIP two files without -lm by $compiler: no $compiler on this machine"
    elif ! "$compiler" "$@" -Wall -Wextra -Werror -c "$folder/fibrad.c" -o "$folder/$compiler.o" ||
        "$nm" -u "$folder/$compiler.o" | grep -w sqrt; then
        echo "two files by $compiler $*: do not build, or need sqrt"
        faults=1
    fi
}

case $(gcc -dumpmachine) in x86_64*) needs gcc nm -m32 -msse2 -mfpmath=sse -ffreestanding ;; esac
test "${1:-}" = all || exit $faults
if test -e .git; then
    rm -rf "$folder"/fibrad-*
    $MAKE -s --no-print-directory BUILD="$BUILD" CC="$CC" dist || exit 1
    tar -xzf "$folder"/fibrad-*.tar.gz -C "$folder"
    # variables of the make that runs this script are not for the other tree
    env -u MAKEFLAGS -u MFLAGS -u BUILD "$MAKE" -s -C "$folder"/fibrad-*/ CC="$CC" house test-heat || faults=1
fi
variant gcc -O1 "" "" sse2 avx2
variant gcc -O2 "" "" scalar sse2 avx2 avx512
variant gcc "-O3 -march=native" "" "" scalar avx512
variant clang -O2 "" "" scalar sse2 avx2 avx512
variant clang "-O3 -march=native" "" "" scalar avx512
variant aarch64-linux-gnu-gcc -O2 qemu-aarch64 -static scalar neon
exit $faults
