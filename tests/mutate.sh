#!/bin/sh
# mutate.sh - do the tests notice when the kernel is broken? SPDX-License-Identifier: MIT
#
# Breaks a copy of the kernel in one line at a time, as tests/mutants.txt says, and runs the quick tests (not the pinned
# bits, which notice anything). Ends with status 1 if a break goes unnoticed, or the line is no longer there.
set -u
: "${BUILD:=build}" "${MAKE:=make}" "${CC:=cc}"
tests="base scene direction pair_exact areas rows beam moved surface surface_row stress cast furnace"
tree=$BUILD/mutate
export CK_DEFAULT_TIMEOUT=60
missed=0 caught=0

rm -rf "$tree" && mkdir -p "$tree" && cp -r Makefile kernel host tests "$tree" || exit 1
# who notices the break; nobody: empty. One test program after the other is built, as the first mostly suffices.
noticed_by() {
    for test in $tests; do
        $MAKE -s -C "$tree" CC="$CC" CFLAGS=-O1 ISAS=scalar "build/tests/test_$test" >"$tree/log" 2>&1 || {
            echo compiler
            return
        }
        (cd "$tree" && timeout 1200 "build/tests/test_$test") >"$tree/log" 2>&1 || { echo "test_$test" && return; }
    done
}

test -z "$(noticed_by)" || { echo "the tests fail before anything is broken" && cat "$tree/log" && exit 1; }
while IFS='|' read -r file old new; do
    case $file in '#'*) continue ;; esac
    file=${file% }
    awk -v old="$old" -v new="$new" 'BEGIN {sub(/^ /, "", old); sub(/ $/, "", old); sub(/^ /, "", new)}
        {at = index($0, old); if (at) {found++; $0 = substr($0, 1, at - 1) new substr($0, at + length(old))} print}
        END {exit found == 0}' "$file" >"$tree/broken" || { echo "NO SUCH LINE $file:$old" && missed=$((missed + 1)) && continue; }
    cp "$tree/broken" "$tree/$file"
    by=$(noticed_by)
    cp "$file" "$tree/$file"
    printf '%-12s %s:%s ->%s\n' "${by:-UNNOTICED}" "$file" "$old" "$new"
    if test -n "$by"; then caught=$((caught + 1)); else missed=$((missed + 1)); fi
done <tests/mutants.txt
echo "$caught of $((caught + missed)) breaks noticed"
test $missed = 0
