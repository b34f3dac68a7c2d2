#!/bin/bash
# check_pages.sh - the scripts of docs/lammps.md run as they stand there, with files of tests in the
# place of the reader's. SPDX-License-Identifier: MIT
set -u
: "${BUILD:=build}" "${MPICC:=mpicc}" "${MPIRUN:=mpirun}" "${LMP:=lmp}"
for program in "$MPICC" "$MPIRUN" "$LMP"; do
    command -v "$program" >/dev/null || { echo "SKIP scripts of pages: no $program on this machine (make deps-couple)" && exit; }
done
test -e /usr/include/lammps/fix.h || { echo "SKIP scripts of pages: no liblammps-dev (make deps-couple)" && exit; }
. tests/couple/mpi.sh

make_one_by_one "$BUILD/couple/fibrad.lmp" "$BUILD/couple/example" "$BUILD/fibrad" || exit 1
root=$(pwd) work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 1
faults=0

# verdict WHAT STATUS
verdict() {
    if test "$2" -eq 0; then echo "ok      $1"; else echo "FAILED  $1" && faults=1; fi
}

# block PAGE WORDS: the block of code, between ``` or four blanks in, that has a line with WORDS
block() {
    awk -v words="$2" '
        function end() { if (has) { printf "%s", text; exit } text = ""; has = 0 }
        /^```/ { fenced = !fenced; end(); next }
        fenced || /^    / { if (!fenced) sub(/^    /, ""); text = text $0 "\n"; if (index($0, words)) has = 1; next }
        /^$/ && text != "" { text = text "\n"; next }
        { end() }' "docs/$1"
}

# lammps NP NAME: runs the script NAME in $work
lammps() {
    (cd "$work" && limited_mpi "$1" "$LMP" -in "$2" -log "$2.log" -screen none) >"$work/$2.err" 2>&1 &&
        ! grep -q '^ERROR' "$work/$2.log"
}

# ---- fix fibrad -------------------------------------------------------------------------------------------------------
block lammps.md read_data | sed "s|/path/to/fibrad/build|$root/$BUILD|; s|/path/to/fibrad|$root|; s/run  *100000/run 200/" >"$work/whole"
lammps 2 whole && grep -q 'fix fibrad: rows made' "$work/whole.log"
verdict "the script of docs/lammps.md" $?

# what a script has before the fix, with a quarter of a bed of 2,000 in the place of the pebbles
awk '/BOX BOUNDS/ { side = 1; next }
    side && side < 4 { box[side++] = $1 " " $2; next }
    NF == 8 && !/ITEM/ && $3 < 6 && $4 < 6 { sphere[++n] = $1 " 1 " 2*$6 " 2500 " $3 " " $4 " " $5; t[n] = $1 " " $7 }
    END {
        print "bed\n\n" n " atoms\n1 atom types\n" box[1] " xlo xhi\n" box[2] " ylo yhi\n" box[3] " zlo zhi\n\nAtoms # sphere\n"
        for (i = 1; i <= n; i++) print sphere[i]
        print "\nTemperatures\n"
        for (i = 1; i <= n; i++) print t[i]
    }' CONVFMT=%.17g OFMT=%.17g tests/data/mono2000.dump >"$work/bed.data"
sed -n '1,/^read_data/p' "$work/whole" | sed '$d' >"$work/before"
block lammps.md "read_data       bed.data" >>"$work/before"
printf 'pair_style zero 1.3\npair_coeff * *\ntimestep 1e-5\n' >>"$work/before"
block lammps.md "rows bed" | cat "$work/before" - >"$work/rows"
lammps 2 rows && "$BUILD/fibrad" join "$work"/bed.0.*.rows --quiet -o "$work/rows.npz"
verdict "rows without heat" $?

# a box from 0 to 6.499 m and 20 m high, in millimetres: its lid is one mesh, its other sides are another
awk 'function corner(k) { return (k%2 ? 6499 : 0) " " (int(k/2)%2 ? 6499 : 0) " " (k > 3 ? 20000 : 0) }
    function facet(a, b, c) {
        print "facet normal 0 0 0\nouter loop\nvertex " corner(a) "\nvertex " corner(b) "\nvertex " corner(c) "\nendloop\nendfacet"
    }
    function side(a, b, c, d) { facet(a, b, c); facet(a, c, d) }
    BEGIN {
        print "solid hopper"
        side(0, 4, 6, 2); side(1, 3, 7, 5); side(0, 1, 5, 4); side(2, 6, 7, 3); side(0, 2, 3, 1)
        print "endsolid\nsolid lid"
        side(4, 5, 7, 6)
        print "endsolid"
    }' | tee >(sed -n '/solid hopper/,/^endsolid/p' >"$work/hopper.stl") |
    sed -n '/solid lid/,$p' | awk '/vertex/ { for (k = 2; k < 5; k++) $k /= 1000 } { print }' >"$work/tube.stl"
{ cat "$work/before" && block lammps.md "wall mesh hopper.stl temperature" && echo 'run 100'; } >"$work/meshes"
lammps 2 meshes && grep -q 'is of wall tube, 2 triangles' "$work/meshes.log"
verdict "walls of triangles" $?
cp "$work/tube.stl" "$work/drum.stl"
{ cat "$work/before" && echo 'comm_modify vel yes' && block lammps.md "rotate 0 0 1 4" && echo 'run 100'; } >"$work/turning"
lammps 2 turning && grep -q 'is of wall drum, 2 triangles' "$work/turning.log"
verdict "a mesh that turns" $?

{ cat "$work/before" && block lammps.md "contacts 30 hertz" && echo 'run 10'; } >"$work/contacts"
lammps 2 contacts && grep -q 'through contacts' "$work/contacts.log"
verdict "contacts" $?

# ---- your own code -------------------------------------------------------------------------------------------------------
# the reader's program is the example
sed 's|couple/fibrad_couple.h|fibrad_couple.h|' host/couple/example.c >"$work/mycode.c"
{
    cat <<'END'
set -e
mpicc() { command "$MPICC" "$@" -o "$work/own"; }
mpirun() { command "$MPIRUN" "$@"; }
END
    block lammps.md mycode.c | grep -v '^make' | sed "s|build/|$BUILD/|g; s|mycode.c|\"\$work/mycode.c\"|"
    echo "mpirun -np 2 $work/own"
} >"$work/commands"
# shellcheck disable=SC1091
(. "$work/commands") >"$work/commands.out" 2>&1 && test "$(sort -u "$work/commands.out" | wc -l)" -eq 1
verdict "the commands of docs/lammps.md" $?
cat >"$work/loop.c" <<END
#include "fibrad_couple.h"
static double x[6] = {0, 0, 0, 3, 0, 0}, radius[2] = {1, 1}, emissivity[2] = {1, 1}, t[2] = {1000, 300}, power[2];
static const uint64_t id[2] = {1, 2};
static void move_particles(void) { x[3] += 1e-4; }
static void heat_particles(const double *q) { for (int i = 0; i < 2; ++i) t[i] += 1e-7 * q[i]; }
int main(int count, char **argument) {
    fibrad_insitu *radiation;
    fibrad_insitu_bed bed = {.n = 2, .id = id, .x = x, .radius = radius, .emissivity = emissivity};
    fibrad_insitu_state state = {.n = 2, .id = id, .temperature = t};
    uint64_t step, steps = 3000;
    MPI_Init(&count, &argument);
$(block lammps.md move_particles)
    fibrad_insitu_free(radiation);
    MPI_Finalize();
    return !(t[0] < 999 && t[1] > 300 && power[0] < 0 && power[1] > 0);
}
END
"$MPICC" -Ikernel -Ihost/couple "$work/loop.c" "$BUILD/couple/libfibrad_couple.a" "$BUILD/libfibrad.a" -fopenmp -lm -o "$work/loop" &&
    run_mpi 1 "$work/loop"
verdict "the loop of docs/lammps.md" $?
exit $faults
