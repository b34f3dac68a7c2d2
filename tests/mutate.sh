#!/bin/sh
# mutate.sh - checks that the tests notice when kernel or couplings are broken. SPDX-License-Identifier: MIT
#
# Breaks a copy of the kernel in one line at a time, as tests/mutants.txt says. Runs the quick tests until one fails,
# but not the pinned bits, which notice any change. Ends with status 1 if a break is not noticed or does not compile,
# or if the line no longer exists. Arguments are numbers of breaks, counted from 1; without arguments all breaks are
# made. JOBS breaks run at a time. Breaks of host/couple need MPI and LIGGGHTS (make deps-couple).
set -u
: "${BUILD:=build}" "${MAKE:=make}" "${CC:=cc}" "${JOBS:=$(nproc 2>/dev/null || echo 1)}"
export BUILD MAKE CC
tests="base pair_exact direction areas scene beam work trace matrix cast walls wall_rows exchange protocol part heat light_mesh surface surface_row furnace stress"
whole=$BUILD/mutate/whole # built and unbroken; every break starts from a copy
export CK_DEFAULT_TIMEOUT="${CK_DEFAULT_TIMEOUT:-1200}"
# shellcheck disable=SC3045  # dash has it
ulimit -t 30 # of processor time: a loaded machine is no failure

# build TREE TEST: objects that the break does not change exist already
build() {
    case $2 in
    couple) goals="build/couple/test_couple build/couple/example" ;;
    liggghts) goals="build/couple/fibrad_liggghts build/fibrad" ;;
    *) goals="build/tests/test_$2 $(grep -q '"program.h"' "tests/test_$2.c" && echo build/fibrad)" ;;
    esac
    # shellcheck disable=SC2086  # a list of goals
    $MAKE -s -C "$1" BUILD=build CC="$CC" CFLAGS=-O1 ISAS=scalar $goals >"$1/log" 2>&1
}

run() {
    case $2 in
    couple) program=tests/couple/check_couple.sh ;;
    liggghts) program="tests/couple/check_liggghts.sh all" ;;
    *) program=build/tests/test_$2 ;;
    esac
    # shellcheck disable=SC2086  # a program and its argument
    (cd "$1" && BUILD=build MAKEFLAGS=" -- CFLAGS=-O1 ISAS=scalar" timeout 1200 $program) >"$1/log" 2>&1
}

# breaks [NUMBER]...: the lines of these breaks, or of all
breaks() {
    awk -v numbers=" $* " '!/^#/ && (++n && numbers == "  " || index(numbers, " " n " "))' tests/mutants.txt
}

# tests_of FILE: what is most likely to notice comes first, by tests/rooms.txt
tests_of() {
    case $1 in
    host/couple/simulation/*) echo liggghts ;;
    host/couple/*) echo couple ;;
    *) room=${1%/*} && echo "$(sed -n "s/^${room##*/} //p" tests/rooms.txt) $tests" ;;
    esac
}

# one NUMBER: makes a break, runs the tests and prints one line
one() {
    IFS='|' read -r file old new <<LINE
$(breaks "$1")
LINE
    file=${file% } tree=$BUILD/mutate/$1 by=UNNOTICED why="" ran=""
    rm -rf "$tree" && cp -Rp "$whole" "$tree" || exit 1
    if awk -v old="$old" -v new="$new" 'BEGIN {sub(/^ /, "", old); sub(/ $/, "", old); sub(/^ /, "", new)}
        {at = index($0, old); if (at) {found++; $0 = substr($0, 1, at - 1) new substr($0, at + length(old))} print}
        END {exit found != 1}' "$file" >"$tree/$file"; then
        for test in $(tests_of "$file"); do
            case " $ran " in *" $test "*) continue ;; esac
            ran="$ran $test"
            build "$tree" "$test" || { by=UNCOMPILED && break; }
            run "$tree" "$test" && continue
            by=test_$test
            # an assertion rather than a test that did not end
            why=$(sed -n '/Test timeout expired\|Received signal 24/!s/.*:[FE]:[^:]*:\([^:]*\):.*/\1/p' "$tree/log" | head -n 1)
            case $test in couple | liggghts) why=$(grep -m 1 ', line ' "$tree/log" || tail -n 1 "$tree/log") ;; esac
            : "${why:=no end}"
            break
        done
    else
        by=UNFOUND
    fi
    printf '%2d %-16s %-40s %s:%s ->%s\n' "$1" "$by" "$why" "$file" "$old" "$new"
    rm -rf "$tree"
}

test "${1-}" != one || { one "$2" && exit; }

rm -rf "$BUILD/mutate" && mkdir -p "$whole" && cp -R Makefile kernel host tests bench "$whole" || exit 1
for test in $(breaks "$@" | while read -r file rest; do tests_of "$file"; done | tr ' ' '\n' | awk '!seen[$0]++'); do
    if ! build "$whole" "$test" || ! run "$whole" "$test"; then
        echo "test_$test fails before anything is broken" && cat "$whole/log" && exit 1
    fi
done
if test $# = 0; then awk '!/^#/ {print ++n}' tests/mutants.txt; else printf '%s\n' "$@"; fi |
    xargs -n 1 -P "$JOBS" "$0" one | tee "$BUILD/mutate/results"
awk '$2 ~ /^test_/ {n++} END {print n + 0 " of " NR " breaks noticed"; exit n != NR}' "$BUILD/mutate/results"
