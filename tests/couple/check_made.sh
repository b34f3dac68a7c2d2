#!/bin/sh
# check_made.sh - `make deps-couple lammps couple` on a machine where deps-couple has to install LAMMPS and LIGGGHTS, and
# an error where they are missing. SPDX-License-Identifier: MIT
set -u
: "${BUILD:=build}" "${MAKE:=make}" "${MPICC:=mpicc}"
command -v "$MPICC" >/dev/null || { echo "SKIP what make couple builds: no MPI (make deps-couple)" && exit; }
for header in lammps/fix.h liggghts/library.h; do
    test -e /usr/include/$header || { echo "SKIP what make couple builds: no $header (make deps-couple)" && exit; }
done
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 1
made="$BUILD/couple/fibrad.lmp $BUILD/couple/fibrad_liggghts"
faults=0

# make, as on a machine whose packages are installed by a script
fresh_make() {
    "$MAKE" -s --no-print-directory DEPS="$work/install" LAMMPS_INCLUDE="$work/lammps" LIGGGHTS_INCLUDE="$work/liggghts" "$@"
}

# refuses GOAL WORDS: the goal is an error that has these words, and makes nothing
refuses() {
    rm -f "$BUILD/couple/fibrad.lmp"
    if fresh_make "$1" >"$work/log" 2>&1 || ! grep -q "$2" "$work/log"; then
        echo "make $1 does not say '$2':" && cat "$work/log" && faults=1
    fi
    test ! -e "$BUILD/couple/fibrad.lmp" || { echo "make $1 has made a fix" && faults=1; }
}

refuses couple "fix fibrad needs LAMMPS"
refuses lammps "fix fibrad needs LAMMPS"
refuses "$BUILD/couple/fibrad_liggghts" "The driver of LIGGGHTS needs its library"

cat >"$work/install" <<END
#!/bin/sh
ln -s /usr/include/lammps /usr/include/liggghts "$work"
END
chmod +x "$work/install"
# shellcheck disable=SC2086  # a list of files
rm -f $made
fresh_make -j2 deps-couple couple >"$work/log" 2>&1 || { cat "$work/log" && faults=1; }
for file in $made; do
    test -e "$file" || { echo "make deps-couple couple has not made $file" && faults=1; }
done
exit $faults
