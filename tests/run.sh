#!/bin/sh
# run.sh PROGRAM|SCRIPT... - runs tests and ends with "N passed, N failed". SPDX-License-Identifier: MIT
#
# A libcheck program counts by its own summary, a script as one test. A program that ends without a summary, or with
# another exit status than its failures demand, counts as one failure more.
set -u
passed=0
failed=0
skipped=0
# A loaded machine is no failure: no test program sets a limit of seconds of its own.
export CK_DEFAULT_TIMEOUT="${CK_DEFAULT_TIMEOUT:-300}"
log=${BUILD:=build}/tests/last.log
mkdir -p "$BUILD/tests"

for test; do
    begun=$(date +%s)
    "$test" >"$log" 2>&1
    status=$?
    took=$(($(date +%s) - begun))
    summary=$(sed -n 's/^[0-9]*%: Checks: \([0-9]*\), Failures: \([0-9]*\), Errors: \([0-9]*\)$/\1 \2 \3/p' "$log")
    # shellcheck disable=SC2086  # three numbers
    set -- ${summary:-0 0 0}
    bad=$(($2 + $3))
    good=$(($1 - bad))
    case $test in
    *.sh) test $status -eq 0 && good=1 || bad=1 ;;
    *) if test -z "$summary" || { test $status -ne 0 && test $bad -eq 0; }; then bad=$((bad + 1)); fi ;;
    esac
    skips=$(grep -c '^SKIP' "$log")
    passed=$((passed + good))
    failed=$((failed + bad))
    skipped=$((skipped + skips))
    printf '%-44s %4d passed %3d failed %4d s\n' "${test##*/}" $good $bad $took
    if test $bad -ne 0; then sed 's/^/    /' "$log"; else grep '^SKIP' "$log"; fi
done

test $skipped -eq 0 || echo "$skipped skipped"
echo "$passed passed, $failed failed"
test $failed -eq 0
