#!/bin/sh
# check_fortran.sh - the Fortran module: without warnings, against closed forms, its example and that of docs/embedding.md.
# SPDX-License-Identifier: MIT
set -eu
: "${BUILD:=build}" "${CC:=cc}" "${FC:=gfortran}" "${MAKE:=make}"
command -v "$FC" >/dev/null || { echo "SKIP: no $FC (Debian: gfortran)" && exit 0; }
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT
"$MAKE" -s --no-print-directory lib-host BUILD="$BUILD" CC="$CC"
case $BUILD in /*) build=$BUILD ;; *) build=$PWD/$BUILD ;; esac

awk '/^```fortran$/ { inside = 1; next } /^```/ { inside = 0 } inside' docs/embedding.md >"$work/page.f90"
grep -q '^end program' "$work/page.f90"

compile() { "$FC" -O2 -std=f2018 -Wall -Wextra -Werror -J "$work" "$@"; }
compile -c host/fortran/fibrad.f90 -o "$work/fibrad.o"
for source in tests/fortran/test_fortran.f90 host/fortran/example.f90 "$work/page.f90"; do
    compile "$source" "$work/fibrad.o" -L"$build" -lfibrad -Wl,-rpath,"$build" -o "$work/program"
    "$work/program"
done
