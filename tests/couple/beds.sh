# beds.sh - beds and boxes as files that LAMMPS reads; read by other scripts. SPDX-License-Identifier: MIT
# shellcheck shell=bash

# as_data DUMP [REVERSED]: a bed (columns id type x y z radius T ...) as a data file of LAMMPS; odd ids
# are of type 1, even ones of type 2
as_data() {
    awk -v reversed="${2:-0}" '
        /BOX BOUNDS/ { side = 1; next }
        side && side < 4 { box[side++] = $1 " " $2; next }
        NF >= 7 && !/ITEM/ { n++; sphere[n] = $1 " " 2 - $1%2 " " 2*$6 " 2500 " $3 " " $4 " " $5; t[n] = $1 " " $7 }
        END {
            print "bed\n\n" n " atoms\n2 atom types\n" box[1] " xlo xhi\n" box[2] " ylo yhi\n" box[3] " zlo zhi\n\nAtoms # sphere\n"
            for (i = 1; i <= n; i++) print sphere[reversed ? n + 1 - i : i]
            print "\nTemperatures\n"
            for (i = 1; i <= n; i++) print t[i]
        }' CONVFMT=%.17g OFMT=%.17g "$1"
}

# box WIDE HIGH: a box from 0 to WIDE and HIGH as a text file, one solid for each side
box() {
    awk -v wide="$1" -v high="$2" '
        function corner(k) { return (k%2 ? wide : 0) " " (int(k/2)%2 ? wide : 0) " " (k > 3 ? high : 0) }
        function facet(a, b, c) {
            print "facet normal 0 0 0\nouter loop\nvertex " corner(a) "\nvertex " corner(b) "\nvertex " corner(c) "\nendloop\nendfacet"
        }
        function side(name, a, b, c, d) { print "solid " name; facet(a, b, c); facet(a, c, d); print "endsolid" }
        BEGIN {
            side("xlo", 0, 4, 6, 2); side("xhi", 1, 3, 7, 5); side("ylo", 0, 1, 5, 4)
            side("yhi", 2, 6, 7, 3); side("zlo", 0, 2, 3, 1); side("zhi", 4, 5, 7, 6)
        }'
}
