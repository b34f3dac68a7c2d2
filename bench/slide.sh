#!/bin/bash
# slide.sh - the time of radiation beside that of LAMMPS in a bed that slides, and the error of temperatures.
# docs/lammps.md has the table. SPDX-License-Identifier: MIT
#
# bench/slide.sh NP DUMP WIDE WORDS...: DUMP is a bed in a box from 0 to WIDE (columns id type x y z radius T). Each of
# WORDS has keywords of fix fibrad, such as "accuracy low". The first of them is the reference. Its rows are made every
# 260 steps, those of the others every 500 steps. The script needs `make lammps`.
set -eu
: "${BUILD:=build}" "${MPIRUN:=mpirun}" "${LMP:=lmp}"
. tests/couple/mpi.sh
np=$1 dump=$2 wide=$3
shift 3
work=$BUILD/bench/slide
mkdir -p "$work"
awk '/BOX BOUNDS/ { side = 1; next }
    side && side < 4 { box[side++] = $1 " " $2; next }
    NF >= 7 && !/ITEM/ { sphere[++n] = $1 " 1 " 2*$6 " 2500 " $3 " " $4 " " $5; t[n] = $1 " " $7 }
    END {
        print "bed\n\n" n " atoms\n1 atom types\n" box[1] " xlo xhi\n" box[2] " ylo yhi\n" box[3] " zlo zhi\n\nAtoms # sphere\n"
        for (i = 1; i <= n; i++) print sphere[i]
        print "\nTemperatures\n"
        for (i = 1; i <= n; i++) print t[i]
    }' CONVFMT=%.17g OFMT=%.17g "$dump" >"$work/bed.data"

every=260 out=reference
for words in "$@"; do
    "$MPIRUN" -np "$np" "$LMP" -in bench/slide.lmp -screen none -log "$work/$out.log" -var load "$BUILD/couple/fibrad.lmp" \
        -var data "$work/bed.data" -var wide "$wide" -var every $every -var words "$words" -var out "$work/$out.out"
    awk '$1 == "Step" { on = 1; next } /^Loop time/ { on = 0; loop = $4 }
        on && NF == 4 { seconds = $3 + $4; if (!m++) first = seconds; moved = $2 }
        END { printf "radiation %.2f s, over the rest of LAMMPS %.2f, moved %.2g (rms); ", seconds - first,
                  (seconds - first)/(loop - seconds + first), sqrt(moved) }' "$work/$out.log"
    awk 'FNR == 1 { file++ } /^Temperatures/ { data = 1 } !/^[0-9]+ [^ ]+$/ { next }
        file == 1 && data { begin[$1] = $2 }
        file == 2 { reference[$1] = $2 }
        file == 3 { error += ($2 - reference[$1])^2; change += (reference[$1] - begin[$1])^2 }
        END { printf "error of T %.2f %% of its change\n", 100*sqrt(error/change) }' \
        "$work/bed.data" "$work/reference.out" "$work/$out.out" | sed "s|^|$words: |"
    every=500 out=other
done
