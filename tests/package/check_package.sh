#!/bin/sh
# check_package.sh - programs in C99 and C++17 build and run against the installed libraries, static ones found by
# pkg-config and the shared one, which exports the functions of the public headers and nothing else; the program is
# installed with its manual pages, completion and documents.
# SPDX-License-Identifier: MIT
set -eu
: "${BUILD:=build}" "${CC:=cc}" "${CXX:=c++}" "${MAKE:=make}"
tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT

"$MAKE" -s --no-print-directory install-lib BUILD="$BUILD" CC="$CC" PREFIX=/usr DESTDIR="$tree"
export PKG_CONFIG_LIBDIR="$tree/usr/lib/pkgconfig" PKG_CONFIG_SYSROOT_DIR="$tree"
export PKG_CONFIG_ALLOW_SYSTEM_CFLAGS=1 PKG_CONFIG_ALLOW_SYSTEM_LIBS=1
version=$(sed -n 's/^#define FIBRAD_VERSION "\(.*\)"/\1/p' kernel/fibrad.h)
test "$(pkg-config --modversion fibrad)" = "$version"
test "$(pkg-config --modversion fibrad_host)" = "$version"
strict="-pedantic-errors -Wall -Wextra -Werror"
shared="-I$tree/usr/include -L$tree/usr/lib -lfibrad"

# build COMPILER SOURCE PROGRAM FLAGS: builds and runs it
build() {
    # shellcheck disable=SC2086  # lists of flags
    "$1" $strict $4 "tests/package/$2" $5 -lm -o "$tree/$3"
    LD_LIBRARY_PATH="$tree/usr/lib" "$tree/$3" >"$tree/$3.out"
}

build "$CC" row.c row_c -std=c99 "$(pkg-config --cflags --libs fibrad)"
build "$CC" bed.c bed_static -std=c99 "$(pkg-config --cflags --libs fibrad_host)"
build "$CC" bed.c bed_shared -std=c99 "$shared"
cmp "$tree/bed_static.out" "$tree/bed_shared.out"
if ldd "$tree/row_c" "$tree/bed_static" | grep libfibrad; then exit 1; fi

if command -v "$CXX" >/dev/null; then
    build "$CXX" row.cpp row_cpp -std=c++17 "$(pkg-config --cflags --libs fibrad_host)"
else
    echo "SKIP package in C++: no $CXX on this machine"
fi

# every structure that the headers define, but those of the papers
headers=$(printf "%s " "$tree"/usr/include/fibrad.h "$tree"/usr/include/fibrad_[!sf]*.h)
# shellcheck disable=SC2086  # a list of headers
enums=$(sed -n 's/^typedef enum \(fibrad_[a-z_]*\) {.*/\1/p' $headers)
# shellcheck disable=SC2086
sed -n 's/^} \(fibrad_[a-z_]*\);.*/\1/p; s/^struct \(fibrad_[a-z_]*\) {.*/typedef struct \1 \1/p' $headers | sed 's/.* //' |
    grep -vx "$enums" | sed 's/.*/CHECK(&);/' >"$tree/structures.inc"
test "$(wc -l <"$tree/structures.inc")" -gt 20
build "$CC" sizes.c sizes "-std=c99 -I$tree" "$shared"

library=$tree/usr/lib/libfibrad.so
name=$(readelf -d "$library" | sed -n 's/.*soname: \[\(.*\)\]/\1/p')
test -e "$tree/usr/lib/$name" && test "$(readlink "$library")" = "$name"
sed -n '/^typedef/d; s/^[a-z].*[ *]\(fibrad_[a-z0-9_]*\)(.*/\1/p' "$tree"/usr/include/*.h | sort >"$tree/declared"
nm -D --defined-only "$library" | awk '$2 != "A" {sub(/@.*/, "", $3); print $3}' | sort >"$tree/exported"
diff "$tree/declared" "$tree/exported"

# the program: all that comes with it is there, readable, and nothing names where it was built
(
    unset PKG_CONFIG_LIBDIR PKG_CONFIG_SYSROOT_DIR
    "$MAKE" -s --no-print-directory install BUILD="$BUILD" CC="$CC" PREFIX=/opt/fibrad DESTDIR="$tree/all"
)
prefix=$tree/all/opt/fibrad
"$prefix/bin/fibrad" --help >"$tree/help"
{
    sed -n '/^Commands:/,/^$/s/^  \([a-z]*\) .*/share\/man\/man1\/fibrad-\1.1/p' "$tree/help"
    for file in bin/fibrad share/man/man1/fibrad.1 share/bash-completion/completions/fibrad lib/libfibrad.a \
        lib/libfibrad_host.a lib/libfibrad.so "lib/$name" lib/pkgconfig/fibrad.pc lib/pkgconfig/fibrad_host.pc \
        lib/cmake/fibrad/fibradConfig.cmake lib/cmake/fibrad/fibradConfigVersion.cmake; do
        echo "$file"
    done
    for file in README.md CHANGELOG.md LICENSE CITATION.cff SECURITY.md docs/*.md docs/figures/* $(find docs/examples -type f); do
        echo "share/doc/fibrad/$file"
    done
    for file in "$tree"/usr/include/*.h; do echo "include/${file##*/}"; done
} | sort >"$tree/expected"
(cd "$prefix" && find . -type f -o -type l) | sed 's|^\./||' | sort | diff "$tree/expected" -
if grep -rlI "$tree" "$prefix"; then exit 1; fi
test -z "$(find "$prefix" -type f ! -perm -444)"
