#!/bin/sh
# check_tables.sh [all] - the tables have their pinned bits, smaller tables give the same directions; all: with more
# sizes of tables. SPDX-License-Identifier: MIT
set -u
test "${1:-}" = all && azimuths="0 256" || azimuths=256
: "${BUILD:=build}" "${CC:=cc}"
pinned=$(cut -d ' ' -f 1 tests/golden/tables.sha256)
found=$(sha256sum <"$BUILD/tables.c" | cut -d ' ' -f 1)
if test "$pinned" != "$found"; then
    echo "$BUILD/tables.c: SHA-256 $found, pinned in tests/golden/tables.sha256 is $pinned"
    exit 1
fi

mkdir -p "$BUILD/tests"
program=$BUILD/tests/test_direction_small
for limit in $azimuths; do
    # shellcheck disable=SC2046,SC2086  # lists of flags
    "$CC" -O2 -std=c11 -D_POSIX_C_SOURCE=200809L -ffp-contract=off -Ikernel -DFIBRAD_TABLE_AZIMUTHS=$limit \
        "$BUILD/tables.c" kernel/sample/direction.c tests/test_direction.c $(pkg-config --cflags --libs check) -lm \
        -o "$program" && "$program" || exit 1
done
