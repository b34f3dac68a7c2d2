#!/bin/sh
# make.sh - makes the files of this folder anew, by the programs whose formats they have: LAMMPS, LIGGGHTS, YADE,
# ParaView. SPDX-License-Identifier: MIT
#
# LAMMPS settles the spheres and says where they are in six digits; these numbers go to every program.
set -eu
cd "$(dirname "$0")"
trap 'rm -f settled.dump hybrid_in.data liggghts_in.data shuffled.data log.* *.vtr *boundingBox*' EXIT

lmp -in in.settle -log none >/dev/null
sed '1,9d' settled.dump | LC_ALL=C sort -n | awk 'BEGIN { print "id,type,x,y,z,r,T" }
    { print $1 "," $2 "," $3 "," $4 "," $5 "," $6 "," 300 + 7 * $1 % 500 }' >settled.csv
rows=$(sed 1d settled.csv | awk -F , '{ print ($1 * 71) % 125, $0 }' | LC_ALL=C sort -n | cut -d ' ' -f 2) # another order

{
    printf 'the settled bed\n\n125 atoms\n2 atom types\n\n0 0.02 xlo xhi\n0 0.02 ylo yhi\n0 0.04 zlo zhi\n\nAtoms # sphere\n\n'
    echo "$rows" | awk -F , '{ printf "%s %s %.6g 2500 %s %s %s\n", $1, $2, 2 * $6, $3, $4, $5 }'
} >shuffled.data
sed 's/ # sphere//' shuffled.data >liggghts_in.data
awk '/ # sphere/ { sub("sphere", "hybrid") } NF == 7 { $0 = $1 " " $2 " " $5 " " $6 " " $7 " " $3 " " $4 " 0" } { print }' \
    shuffled.data >hybrid_in.data
lmp -in in.lammps -log none >/dev/null
lmp -in in.hybrid -log none >/dev/null
liggghts -in in.liggghts -log none >/dev/null
mv liggghts_0.vtk liggghts.vtk
mv liggghts_0.vtp liggghts.vtp
yade -x -n write_yade.py >/dev/null 2>&1
mv yade-spheres-00000000.vtk yade.vtk
for name in packed ascii; do
    mv "$(find . -name "yade_$name-*.vtu" | head -n 1)" "yade_$name.vtu"
    rm -f "yade_$name-"*
done
pvpython write_vtk.py

# formats of programs that are not at hand, by their documentation
echo "$rows" | awk -F , 'BEGIN {
        print 125
        print "Lattice=\"0.02 0 0 0 0.02 0 0 0 0.04\" Origin=\"0 0 0\" Properties=species:S:1:id:I:1:pos:R:3:velo:R:3:" \
            "radius:R:1:T:R:1 pbc=\"F F F\" Time=0"
    }
    { print "S" $2, $1, $3, $4, $5, 0, 0, 0, $6, $7 }' >extended.xyz
sed 1d settled.csv | awk -F , 'BEGIN { print "125 0 0 0 0 0.02 0.02 0.04 " }
    { print $3, $4, $5, 0, 0, 0, $6, 0, 0, 0, 0, 0, 0, $2 - 1 }' >mercury.data
echo "$rows" | awk -F , 'BEGIN { print "Id;X [mm];Y [mm];Z [mm];Diameter [mm];T [K]" }
    { line = $1 ";" 1000 * $3 ";" 1000 * $4 ";" 1000 * $5 ";" 2000 * $6 ";" $7; gsub(/\./, ",", line); print line }' \
    >semicolons.csv
echo "$rows" | awk -F , 'BEGIN { print "# made by hand\n# id x y z r T" } { print $1, $3, $4, $5, $6, $7 }' >blanks.txt
