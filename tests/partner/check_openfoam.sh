#!/bin/sh
# check_openfoam.sh - `fibrad couple` beside OpenFOAM: a hot bed in a box, and air that rises beside one of its walls. In
# 100 time windows the bed gives what the air takes. Takes two minutes: OpenFOAM looks for the bed's files once a second.
# SPDX-License-Identifier: MIT
set -u
: "${BUILD:=build}"
command -v buoyantPimpleFoam >/dev/null || { echo "SKIP fibrad couple beside OpenFOAM: it is not there (make deps-nightly)" && exit; }
case $BUILD in /*) fibrad=$BUILD/fibrad ;; *) fibrad=$PWD/$BUILD/fibrad ;; esac
test -n "${WM_PROJECT_DIR:-}" || export WM_PROJECT_DIR=/usr/share/openfoam
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 1
cp -r tests/partner/openfoam "$work/case" && cd "$work" || exit 1

# 125 spheres, contacts of 25 with the wall, and the box about them. A square of the box is a face of OpenFOAM.
awk '
function corner(axis, at, u, v,    p) {
    p[axis] = at; p[(axis + 1) % 3] = u; p[(axis + 2) % 3] = v
    return "vertex " p[0] " " p[1] " " p[2] "\n"
}
function triangle(corners) { printf "facet normal 0 0 0\nouter loop\n%sendloop\nendfacet\n", corners }
function side(axis, at,    i, j, a, c) {
    for (i = 0; i < 10; i++)
        for (j = 0; j < 10; j++) {
            a = corner(axis, at, i / 100, j / 100); c = corner(axis, at, (i + 1) / 100, (j + 1) / 100)
            triangle(a corner(axis, at, (i + 1) / 100, j / 100) c)
            triangle(a c corner(axis, at, i / 100, (j + 1) / 100))
        }
}
BEGIN {
    print "x [m],y [m],z [m],r [m]" >"bed.csv"
    print "i,j,W/K" >"contacts.csv"
    for (k = 4; k < 125; k += 5) print k ",box_air,0.005" >"contacts.csv"
    for (k = 0; k < 125; k++) print k % 5 / 50 + .01 "," int(k / 5) % 5 / 50 + .01 "," int(k / 25) / 50 + .01 ",.0095" >"bed.csv"
    print "solid air"; side(0, .1)
    print "endsolid air\nsolid rest"; side(0, 0); side(1, 0); side(1, .1); side(2, 0); side(2, .1); print "endsolid rest"
}' >box.stl

(cd case && blockMesh && timeout 600 buoyantPimpleFoam) >foam.log 2>&1 &
timeout 600 "$fibrad" couple bed.csv --openfoam case --window 0.01 --timeout 100 --faces box_air \
    --wall mesh:box.stl:solids:emissivity=0.9:temperature=650,box_rest:insulated --emissivity 0.9 --temperature 700 \
    --heat-capacity 800 --density 2500 --contacts contacts.csv --json bed.json --quiet
status=$?
wait $! || { tail -n 20 foam.log && exit 1; }
test $status = 0 && grep -q '^End' foam.log || exit 1
awk '
FILENAME != "bed.json" { if ($2 == "wall") { air += $5 * .01; steps++ }; next }
{ for (rest = $0; match(rest, /"faces_J": [-+.0-9e]+/); rest = substr(rest, RSTART + RLENGTH)) { bed += substr(rest, RSTART + 11, RLENGTH - 11); windows++ } }
END {
    printf "%d time windows, %d steps: the bed gives %.5g J, the air takes %.5g J, %.2g %% less\n", windows, steps, bed, air, 100 * (1 - air / bed)
    exit !(windows == 100 && steps == 100 && bed > 10 && (bed - air) ^ 2 < (0.01 * bed) ^ 2)
}' case/postProcessing/heat/0/*.dat bed.json
