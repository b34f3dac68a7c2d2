#!/bin/sh
# check_symbols.sh - libfibrad.a defines only fibrad_*, needs only copying and clearing of memory, and has no
# variables and no constructors. libfibrad_host.a defines only fibrad_*, needs a heap, mapped files and OpenMP
# besides, and has no variables. SPDX-License-Identifier: MIT
set -u
library=${BUILD:=build}/libfibrad.a
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 1
faults=0

fault() { # MESSAGE LIST
    test -z "$2" && return
    echo "$library: $1:"
    echo "$2" | sed 's/^/    /'
    faults=1
}

nm -g --defined-only "$library" >"$work/nm" && nm -g --undefined-only "$library" >"$work/nmu" &&
    size "$library" >"$work/size" || exit 1
awk 'NF == 3 {print $3}' "$work/nm" | sort -u >"$work/defined"
awk '$1 == "U" {print $2}' "$work/nmu" | sort -u >"$work/undefined"

test -s "$work/defined" || fault "defines" nothing
fault "symbols that do not begin with fibrad_" "$(grep -v '^fibrad_' "$work/defined")"

# Compilers emit calls of these four even in freestanding code; the port header names the first two. Where there is no
# instruction for square roots, kernel/base/port.h calls sqrt and sqrtf: name them in FIBRAD_PORT_SYMBOLS.
allowed="memcpy memset memmove memcmp _GLOBAL_OFFSET_TABLE_ ${FIBRAD_PORT_SYMBOLS:-}"
echo "$allowed" | tr -s ' ' '\n' | sort -u | sort -u - "$work/defined" >"$work/known"
fault "symbols that the port header does not name" "$(comm -23 "$work/undefined" "$work/known")"

fault "variables (data, bss)" "$(awk 'NR > 1 && $2 + $3 > 0 {print $6 ": " $2 + $3 " bytes"}' "$work/size")"

# functions HEADER...: those that they declare
functions() { sed -n '/^typedef/d; s/^[a-z].*[ *]\(fibrad_[a-z0-9_]*\)(.*/\1/p' "$@" | sort -u; }

fault "functions of the headers that are missing" "$(functions kernel/*.h | comm -23 - "$work/defined")"

test $faults -eq 0 && echo "$library: $(wc -l <"$work/defined") symbols, all fibrad_*; needs" \
    "$(comm -23 "$work/undefined" "$work/defined" | tr '\n' ' ')"

library=$BUILD/libfibrad_host.a
if test -e "$library"; then # it needs OpenMP, which not every machine has
    nm -g --defined-only "$library" | awk 'NF == 3 {print $3}' | sort -u >"$work/host"
    fault "symbols that do not begin with fibrad_" "$(grep -v '^fibrad_' "$work/host")"
    fault "functions of the header that are missing" "$(functions host/simple/fibrad_host.h | comm -23 - "$work/host")"
    fault "symbols but of a heap, strings, mapped files and OpenMP" "$(nm -g --undefined-only "$library" | awk '$1 == "U" {print $2}' |
        sort -u | comm -23 - "$work/host" | comm -23 - "$work/defined" |
        grep -vxE '(malloc|calloc|realloc|free|qsort|strcmp|strlen|bcmp|mem[a-z]*|_GLOBAL_OFFSET_TABLE_|omp_.*|GOMP_.*|__kmpc_.*)' |
        grep -vxE '(mkstemp|unlink|fcntl|posix_fallocate|mmap)(64)?|munmap|close')"
    fault "variables (data, bss)" "$(size -A "$library" | awk '/^\.(data|bss) / && $2 > 0 {print $1 ": " $2 " bytes"}')"
fi
exit $faults
