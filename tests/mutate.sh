#!/bin/sh
# mutate.sh - checks that the tests notice when the kernel is broken. SPDX-License-Identifier: MIT
#
# Breaks a copy of the kernel in one line at a time, as tests/mutants.txt says. Runs the quick tests until one fails,
# but not the pinned bits, which notice any change. Ends with status 1 if a break is not noticed or does not compile,
# or if the line no longer exists. Arguments are numbers of breaks, counted from 1; without arguments all breaks are
# made. JOBS breaks run at a time.
set -u
: "${BUILD:=build}" "${MAKE:=make}" "${CC:=cc}" "${JOBS:=$(nproc 2>/dev/null || echo 1)}"
export BUILD MAKE CC
tests="base pair_exact surface matrix scene direction drift areas furnace surface_row work beam cast walls trace exchange body_rows protocol part heat light_mesh stress"
whole=$BUILD/mutate/whole # built and unbroken; every break starts from a copy
export CK_DEFAULT_TIMEOUT="${CK_DEFAULT_TIMEOUT:-60}"

# build TREE TEST: objects that the break does not change exist already
build() {
    $MAKE -s -C "$1" BUILD=build CC="$CC" CFLAGS=-O1 ISAS=scalar "build/tests/test_$2" >"$1/log" 2>&1
}

run() {
    (cd "$1" && timeout 1200 "build/tests/test_$2") >"$1/log" 2>&1
}

# one NUMBER: makes a break, runs the tests and prints one line
one() {
    IFS='|' read -r file old new <<LINE
$(awk -v number="$1" '!/^#/ && ++n == number' tests/mutants.txt)
LINE
    file=${file% } tree=$BUILD/mutate/$1 by=UNNOTICED why="" ran=""
    rm -rf "$tree" && cp -Rp "$whole" "$tree" || exit 1
    case $file in # what is most likely to notice comes first
    kernel/exchange/flow.c | kernel/scene/surroundings.c) tests="beyond flow part $tests" ;;
    kernel/exchange/*) tests="exchange body_rows protocol part $tests" ;;
    kernel/heat/*) tests="protocol_heat heat heat_arguments heat_paths heat_patches heat_invariants $tests" ;;
    */points_*) tests="beam cast $tests" ;;
    kernel/window/*) tests="silhouettes areas beam $tests" ;;
    kernel/silhouette/*) tests="silhouettes silhouette_scenes $tests" ;;
    */surface_row*) tests="surface_row $tests" ;;
    */walls.* | */wall_*) tests="walls part estimate $tests" ;;
    kernel/surface/*) tests="surface $tests" ;;
    */work.*) tests="work beam cast $tests" ;;
    kernel/row/mesh*) tests="mesh beam $tests" ;;
    kernel/row/*) tests="beam cast protocol $tests" ;;
    */cast*) tests="cast $tests" ;;
    kernel/ray/*) tests="trace $tests" ;;
    */drift*) tests="drift $tests" ;;
    kernel/scene/*) tests="scene beam $tests" ;;
    kernel/matrix/*) tests="matrix matrix_calls estimate protocol $tests" ;;
    kernel/work/*) tests="matrix matrix_calls protocol $tests" ;;
    kernel/furnace/*) tests="furnace furnace_calls $tests" ;;
    esac
    if awk -v old="$old" -v new="$new" 'BEGIN {sub(/^ /, "", old); sub(/ $/, "", old); sub(/^ /, "", new)}
        {at = index($0, old); if (at) {found++; $0 = substr($0, 1, at - 1) new substr($0, at + length(old))} print}
        END {exit found != 1}' "$file" >"$tree/$file"; then
        for test in $tests; do
            case " $ran " in *" $test "*) continue ;; esac
            ran="$ran $test"
            build "$tree" "$test" || { by=UNCOMPILED && break; }
            run "$tree" "$test" && continue
            by=test_$test
            # an assertion rather than a test that did not end
            why=$(sed -n '/Test timeout expired/!s/.*:[FE]:[^:]*:\([^:]*\):.*/\1/p' "$tree/log" | head -n 1)
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

rm -rf "$BUILD/mutate" && mkdir -p "$whole" && cp -R Makefile kernel host tests "$whole" || exit 1
for test in $tests; do
    if ! build "$whole" "$test" || ! run "$whole" "$test"; then
        echo "test_$test fails before anything is broken" && cat "$whole/log" && exit 1
    fi
done
if test $# = 0; then awk '!/^#/ {print ++n}' tests/mutants.txt; else printf '%s\n' "$@"; fi |
    xargs -n 1 -P "$JOBS" "$0" one | tee "$BUILD/mutate/results"
awk '$2 ~ /^test_/ {n++} END {print n + 0 " of " NR " breaks noticed"; exit n != NR}' "$BUILD/mutate/results"
