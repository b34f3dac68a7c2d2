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
. tests/couple/beds.sh
np=$1 dump=$2 wide=$3
shift 3
work=$BUILD/bench/slide
mkdir -p "$work"
as_data "$dump" >"$work/bed.data"

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
