#!/bin/sh
# newer.sh [TREE] - builds a newer LAMMPS with GRANULAR and PLUGIN, the plugin of fix fibrad, and runs the tests with both.
# SPDX-License-Identifier: MIT
#
# TREE is a source tree of LAMMPS; without one, that of Debian's next suite (4 Feb 2025) is fetched. All goes into
# build/newer; 5 minutes on two processors. Needs cmake, g++, openmpi; curl and xz to fetch.
set -eu
: "${BUILD:=build}" "${MAKE:=make}"
version=20250204+dfsg.1
address=https://deb.debian.org/debian/pool/main/l/lammps/lammps_$version.orig.tar.xz
sum=3671165bd52fad36734e0a9136c5bc5ecb225e03988f8c89aa13366a8b53b1c7
place=$BUILD/newer
mkdir -p "$place"

tree=${1:-$place/source}
if test $# -eq 0 && ! test -e "$tree/src/lammps.h"; then
    curl -fsSL -o "$place/lammps.tar.xz" "$address"
    echo "$sum  $place/lammps.tar.xz" | sha256sum -c
    mkdir -p "$tree"
    tar -xf "$place/lammps.tar.xz" -C "$tree" --strip-components=1
fi

# one place for each tree
lammps=$place/build$(realpath "$tree")
cmake -S "$tree/cmake" -B "$lammps" -D CMAKE_BUILD_TYPE= -D CMAKE_CXX_FLAGS=-O1 -D BUILD_SHARED_LIBS=yes -D BUILD_OMP=no \
    -D PKG_GRANULAR=yes -D PKG_PLUGIN=yes
"$MAKE" -C "$lammps" -j2

"$MAKE" -s --no-print-directory "$BUILD/couple/fibrad_plugin.so" LAMMPS_SOURCE="$tree"
echo "plugin load $BUILD/couple/fibrad_plugin.so" >"$place/load.lmp"
LMP=$lammps/lmp LOAD=$place/load.lmp tests/couple/check_lammps.sh
