#!/bin/sh
# check_dist.sh [all] - the kernel in two files builds without further flags and has the pinned bits; all: by other
# compilers, too. SPDX-License-Identifier: MIT
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
$MAKE -s --no-print-directory BUILD="$BUILD" CC="$CC" dist || exit 1

# variant COMPILER RUN FLAGS ISA...: compiles with no flags of ours, links the hashing program, compares
variant() {
    compiler=$1 run=$2 flags=$3
    shift 3
    if ! command -v "$compiler" >/dev/null || { test -n "$run" && ! command -v "$run" >/dev/null; }; then
        echo "SKIP two files by $compiler: no $compiler${run:+ or no $run} on this machine"
        return
    fi
    # shellcheck disable=SC2086  # flags is a list
    if ! "$compiler" -O2 -Wall -Wextra -Werror -c "$folder/fibrad.c" -o "$folder/$compiler.o" ||
        ! "$compiler" -std=c11 -O2 -ffp-contract=off $flags -I"$folder" -I"$folder/joined" tests/bits/bits.c \
            "$folder/$compiler.o" -o "$folder/$compiler.bits"; then
        faults=1
        return
    fi
    for isa in "$@"; do
        $run "$folder/$compiler.bits" "$isa" >"$folder/bits.txt"
        status=$?
        if test $status = 77; then
            echo "SKIP two files by $compiler, $isa: not on this machine"
        elif test $status != 0 || ! cmp -s tests/golden/bits.txt "$folder/bits.txt"; then
            echo "two files by $compiler, $isa: other bits, or exit status $status"
            faults=1
        else
            echo "two files by $compiler, $isa: the pinned bits"
        fi
    done
}

variant gcc "" "" scalar sse2 avx2 avx512
test "${1:-}" = all || exit $faults
variant clang "" "" scalar sse2 avx2 avx512
variant aarch64-linux-gnu-gcc qemu-aarch64 -static scalar neon
exit $faults
