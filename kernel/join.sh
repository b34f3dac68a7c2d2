#!/bin/sh
# join.sh TABLES FOLDER SOURCE... - writes the whole kernel as FOLDER/fibrad.c and FOLDER/fibrad.h.
# SPDX-License-Identifier: MIT
#
# TABLES is the generated tables.c. The sources are those of the kernel, laned ones (*_lanes.c) included. A header
# stands where it is first included. The laned sources stand once. The file includes itself once per instruction set.
# Pragmas then choose the set, and macros give each static function, type and table of the laned sources its own name.
set -eu
tables=$1 to=$2
shift 2
cd "$(dirname "$0")"
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
mkdir -p "$to"

plain=$(printf '%s\n' "$@" | sed 's|^kernel/||' | grep -v '_lanes\.c$')
laned=$(printf '%s\n' "$@" | sed 's|^kernel/||' | grep '_lanes\.c$')
version=$(sed -n 's/^#define FIBRAD_VERSION "\(.*\)"/\1/p' fibrad.h)

# Headers that use lanes, for laned sources alone, and all others.
lanes_headers=$(grep -lE '\<(LANED\(|v[dfmn]_[a-z_0-9]+\(|vd |vf )' ./*/*.h ./*/*/*.h | sed 's|^\./||' |
    grep -vE '^base/lanes/(laned|places|vec_[a-z0-9]*)\.h$|^base/preamble')
headers=$(find . -name '*.h' | sed 's|^\./||' | sort | grep / | grep -vE '^base/lanes/(vec_|places)|^base/preamble' | grep -vxF "$lanes_headers")

# expand FILE...: prints the files with their headers. Each header goes in once. An #include that stays is printed. A
# header in the list $skip is left for later. The macros of a source end with the source.
expand() {
    # shellcheck disable=SC2086  # a list
    awk -v skip=" $(printf '%s ' $skip) " '
    function put(name, source,   line, header, n, i, own) {
        while ((getline line < name) > 0) {
            if (line ~ /^#include "/ || line ~ /^#include FIBRAD_LANES_HEADER/) {
                header = line
                gsub(/^#include "|"$/, "", header)
                if (header in done || line ~ /FIBRAD_LANES_HEADER/ || header ~ /^fibrad(_[a-z]*)?\.h$/) continue
                if (index(skip, " " header " ")) continue
                done[header] = 1
                put(header, 0)
                continue
            }
            if (line ~ /SPDX-License-Identifier: MIT/) {
                gsub(/ ?SPDX-License-Identifier: MIT/, "", line)
                if (line ~ /^ \*\/$/) { print line; continue }
            }
            if (line ~ /^ *# *define /) {
                n = line
                sub(/^ *# *define /, "", n)
                sub(/[^A-Za-z0-9_].*/, "", n)
                if (source) macro[n] = 1
            }
            print line
        }
        close(name)
    }
    BEGIN {
        for (i = 1; i < ARGC; i++) {
            split("", macro)
            if (ARGV[i] in done) continue
            done[ARGV[i]] = 1
            put(ARGV[i], ARGV[i] ~ /\.c$/)
            for (n in macro) if (n !~ /^FIBRAD_PORT/) list = list "#undef " n "\n"
            printf "%s", list
            list = ""
        }
    }' "$@"
}

# ---- fibrad.h
{
    echo "/* fibrad $version: the public headers of the kernel in one, made by 'make dist'. SPDX-License-Identifier: MIT */"
    for header in fibrad_limits.h fibrad.h fibrad_heat.h fibrad_light.h fibrad_mesh.h fibrad_surface.h fibrad_furnace.h; do
        grep -v '^#include "fibrad' $header
    done
} >"$to/fibrad.h"

# ---- fibrad.c
cp "$tables" "$work/tables.c"
{
    echo "/* fibrad $version: the whole kernel in one file, made by 'make dist' from the sources, which are what to read."
    echo " * cc -O2 -c fibrad.c; no other flags. The file includes itself: keep its name. SPDX-License-Identifier: MIT */"
    echo '#ifndef FIBRAD_PASS'
    cat base/preamble.h
    echo '#include "fibrad.h"'
    skip=$lanes_headers
    # shellcheck disable=SC2086  # a list of files
    expand $plain $headers "$work/tables.c"
    cat <<'PASSES'

/* ---- the laned sources, once per instruction set ---- */
#define FIBRAD_PASS 1
#define FIBRAD_ISA_SUFFIX _scalar
#include "fibrad.c"
#undef FIBRAD_PASS
#undef FIBRAD_ISA_SUFFIX
PASSES
    for pass in 2:sse2:sse2 3:avx2:avx2,popcnt 4:avx512:avx512f,avx512dq,avx512bw,avx512vl,popcnt 5:neon:; do
        number=${pass%%:*} isa=$(echo $pass | cut -d : -f 2) target=${pass##*:}
        echo "#ifdef FIBRAD_WITH_$(echo "$isa" | tr '[:lower:]' '[:upper:]')"
        test -z "$target" || cat <<PUSH
#ifdef __clang__
#pragma clang attribute push(__attribute__((target("$target"))), apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("$target")
#ifdef __AVX512F__ /* as at the beginning of this file */
#pragma GCC optimize("no-tree-vectorize")
#endif
#endif
PUSH
        cat <<PASS
#define FIBRAD_PASS $number
#define FIBRAD_ISA_SUFFIX _$isa
#include "fibrad.c"
#undef FIBRAD_PASS
#undef FIBRAD_ISA_SUFFIX
PASS
        test -z "$target" || cat <<POP
#ifdef __clang__
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif
POP
        echo '#endif'
    done
    echo '#else'
    # shellcheck disable=SC2086
    {
        number=0
        for isa in scalar sse2 avx2 avx512 neon; do
            number=$((number + 1))
            echo "#if FIBRAD_PASS == $number"
            skip=$headers
            expand base/lanes/vec_$isa.h
            echo '#endif'
        done
        expand $laned
    } | grep -vE '^#include [<"]' >"$work/laned"
    # names that each pass has for itself
    {
        sed -nE 's/^(static|FIBRAD_INLINE)( inline)? [^=;(]*[ *]([a-z_0-9]+)\(.*/\3 f/p' "$work/laned"
        sed -nE 's/^static ([^=(]*\([^)]*\))?[^=(]* \*?([a-z_0-9]+)(\[[^=]*)? = .*/\2 o/p; s/^typedef [^{(]* ([a-z_0-9]+);.*/\1 o/p; s/^(typedef )?(struct|union|enum) ([a-z_0-9]+) \{.*/\3 o/p; s/^\} ([a-z_0-9]+);.*/\1 o/p' "$work/laned"
    } | sort -u >"$work/names"
    awk '{ if ($2 == "f") print "#define " $1 "(...) FIBRAD_JOIN(" $1 ", FIBRAD_ISA_SUFFIX)(__VA_ARGS__)"
           else print "#define " $1 " FIBRAD_JOIN(" $1 ", FIBRAD_ISA_SUFFIX)" }' "$work/names"
    cat "$work/laned"
    awk '{ print "#undef " $1 }' "$work/names"
    sed -nE 's/^ *# *define ([A-Za-z_0-9]+).*/\1/p' "$work/laned" | sort -u | sed 's/^/#undef /'
    echo '#endif'
} >"$to/fibrad.c"
