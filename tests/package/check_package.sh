#!/bin/sh
# check_package.sh - programs in C99 and C++17 build and run against the installed library, found by pkg-config.
# SPDX-License-Identifier: MIT
set -eu
: "${BUILD:=build}" "${CC:=cc}" "${CXX:=c++}" "${MAKE:=make}"
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

"$MAKE" --no-print-directory install-lib BUILD="$BUILD" CC="$CC" PREFIX=/usr DESTDIR="$tree"
export PKG_CONFIG_LIBDIR="$tree/usr/lib/pkgconfig" PKG_CONFIG_SYSROOT_DIR="$tree"
export PKG_CONFIG_ALLOW_SYSTEM_CFLAGS=1 PKG_CONFIG_ALLOW_SYSTEM_LIBS=1
version=$(sed -n 's/^#define FIBRAD_VERSION "\(.*\)"/\1/p' kernel/fibrad.h)
test "$(pkg-config --modversion fibrad)" = "$version"
flags=$(pkg-config --cflags --libs fibrad)

# shellcheck disable=SC2086  # a list of flags
"$CC" -std=c99 -pedantic-errors -Wall -Wextra -Werror tests/package/row.c $flags -lm -o "$tree/row_c"
"$tree/row_c"

if command -v "$CXX" >/dev/null; then
    # shellcheck disable=SC2086
    "$CXX" -std=c++17 -pedantic-errors -Wall -Wextra -Werror tests/package/row.cpp $flags -o "$tree/row_cpp"
    "$tree/row_cpp"
else
    echo "SKIP package in C++: no $CXX on this machine"
fi
