#!/bin/sh
# run.sh PROGRAM|SCRIPT... - runs tests and ends with "N passed, N failed". SPDX-License-Identifier: MIT
#
# As many tests run at a time as there are processors. A libcheck program counts by its own summary, a script counts as one test. A program that ends
# without a summary, or whose exit status contradicts its summary, counts as one more failure.
set -u
logs=${BUILD:=build}/tests/logs
export BUILD

# Runs one test, reports it, leaves its counts.
if test "${1:-}" = --one; then
    name=${2##*/}
    log=$logs/$name.log
    "$2" >"$log" 2>&1
    status=$?
    times >"$logs/$name.times" # of this shell, then of what it ran
    took=$(tail -n 1 "$logs/$name.times" | tr ms '  ' | awk '{ printf "%.1f", 60*($1 + $3) + $2 + $4 }')
    summary=$(sed -n 's/^[0-9]*%: Checks: \([0-9]*\), Failures: \([0-9]*\), Errors: \([0-9]*\)$/\1 \2 \3/p' "$log")
    case $name in
    *.sh) test $status -eq 0 && summary="1 0 0" || summary="1 1 0" ;;
    *) test -n "$summary" || summary="1 1 0" ;;
    esac
    # shellcheck disable=SC2086  # three numbers
    set -- $summary
    bad=$(($2 + $3))
    good=$(($1 - bad))
    if test $status -ne 0 && test $bad -eq 0; then bad=1; fi
    echo "$good $bad $(grep -c '^SKIP' "$log")" >"$logs/$name.counts"
    printf '%-44s %4d passed %3d failed %6s s of processor\n' "$name" $good $bad "$took"
    if test $bad -ne 0; then sed 's/^/    /' "$log"; else grep '^SKIP' "$log"; fi
    exit 0
fi

# Each test has one thread, unless it asks for more: the others have the other processors. Threads that wait must leave
# them to the other tests: spinning took up to two thirds of the time of tests with OpenMP.
at_a_time=$(nproc) # before OMP_NUM_THREADS is set: nproc obeys it
export OMP_NUM_THREADS="${OMP_NUM_THREADS:-1}" OMP_WAIT_POLICY="${OMP_WAIT_POLICY:-passive}"

# A loaded machine is no failure, so no test program has its own limit of time.
export CK_DEFAULT_TIMEOUT="${CK_DEFAULT_TIMEOUT:-300}"
tests=$#
rm -rf "$logs"
mkdir -p "$logs"
printf '%s\n' "$@" | xargs -r -n 1 -P "$at_a_time" "$0" --one

set -- 0 0 0 0
for counts in "$logs"/*.counts; do
    read -r good bad skips <"$counts"
    set -- $(($1 + good)) $(($2 + bad)) $(($3 + skips)) $(($4 + 1))
done
test "$3" -eq 0 || echo "$3 skipped"
echo "$1 passed, $2 failed"
test "$2" -eq 0 && test "$4" -eq "$tests"
