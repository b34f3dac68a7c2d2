#!/bin/bash
# powers.sh - powers of fix fibrad in LAMMPS, whose rows are made once, against those of `fibrad heat`. docs/lammps.md
# has the table. SPDX-License-Identifier: MIT
#
# bench/powers.sh [WORD]: all cases, or those whose name has this word. A line has a case, an accuracy and a seed. The
# error is the root mean square of the differences between powers of particles, over that of the powers. The error of
# the sum is over the sum of magnitudes. Where surroundings and floor are at 0 K, the line ends with the errors of their
# powers. The script needs `make lammps build/fibrad`.
set -eu
: "${BUILD:=build}" "${LMP:=lmp}"
. tests/couple/mpi.sh
. tests/couple/beds.sh
work=$BUILD/bench/powers only=${1:-}
mkdir -p "$work"

# measure CASE BED CHANGE T SURROUNDINGS EMISSIVITIES WALLS LIST TEMPERATURES: CHANGE is a program of awk that prints
# lines of the dump BED. T is a formula of LAMMPS. The first of two EMISSIVITIES is that of odd ids. WALLS are keywords
# of the fix. LIST and TEMPERATURES are the same walls for fibrad heat.
measure() {
    local name=$1 bed=$2 change=$3 field=$4 cold=$5 emissivities=$6 walls=$7 list=$8 temperatures=$9
    local boundary="f f f" error=0.002 out=$work/powers.dump accuracy seed
    [[ $name == *"$only"* ]] || return 0

    test "$bed" != monoper2000 || boundary="p p f"
    case $name in apart*) error=0.005 ;; *" 0.3") error=0.003 ;; esac
    awk "$change" "tests/data/$bed.dump" >"$work/bed.dump"
    as_data "$work/bed.dump" >"$work/bed.data"
    rm -f "$work/heat.csv"
    for accuracy in normal high; do
        for seed in 1 2 3; do
            "$LMP" -in bench/powers.lmp -screen none -log "$work/log" -var load "$BUILD/couple/fibrad.lmp" \
                -var data "$work/bed.data" -var boundary "$boundary" -var T "$field" -var out "$out" -var words \
                "emissivity type $emissivities surroundings $cold $walls accuracy $accuracy seed $seed"
            test -e "$work/heat.csv" || "$BUILD/fibrad" heat "$out" --length-unit m --temperature d_T \
                --ambient "$cold" --emissivity "1:${emissivities/ /,2:}" --wall "$list" \
                --wall-temperature "$temperatures" --wall-emissivity 0.9 --error $error --quiet -o "$work/heat.csv"
            echo "$name, $accuracy, seed $seed: $(compare "$work/heat.csv" "$out")"
        done
    done
}

# compare CSV DUMP: the errors of DUMP and of DUMP.rest, which has the surroundings and the first wall
compare() {
    awk 'NR == FNR { t[$1] = $2; power[$1] = $3; next }
        !/^-?[0-9]+ / { next }
        { difference = $NF - power[$1] }
        $1 < 0 { rest = rest sprintf(", %.2f %%", 100*difference/power[$1]); next }
        { n++; squares += power[$1]^2; errors += difference^2; sum += difference; all += sqrt(power[$1]^2) }
        END { printf "%d particles, error %.2f %%, of the sum %.2f %%%s\n", n, 100*sqrt(errors/squares), 100*sum/all,
                  t[-1] + t[-2] == 0 ? rest : "" }' FS=, "$1" FS=' ' "$2" "$2.rest"
}

high=$(awk 'NF == 8 && $5 + $6 > high { high = $5 + $6 } END { print high }' tests/data/poly2000.dump)
box 12 "$high" | sed '/solid zhi/,$d' >"$work/box.stl"
sides=
for face in xlo xhi ylo yhi zlo; do sides="$sides wall $face 1000 0.9"; done
cylinder="wall zcylinder 5.5 300 0.9 at 6 6 wall zhi open"
# shellcheck disable=SC2016  # columns of awk
inside='NF < 8 || /ITEM/ || ($3 - 6)^2 + ($4 - 6)^2 < 25' halved='NF == 8 && !/ITEM/ { $6 /= 2 } 1'

measure "box 0.8" poly2000 1 300 300 "0.8 0.8" "$sides wall zhi open" box:open=zmax 1000
measure "box 0.8 and 0.3" poly2000 1 300 300 "0.8 0.3" "$sides wall zhi open" box:open=zmax 1000
measure "triangles 0.8" poly2000 1 300 300 "0.8 0.8" "wall mesh $work/box.stl 1000 0.9" "mesh:$work/box.stl" 1000
for e in 0.8 0.3; do
    measure "apart $e" mono2000 "$halved" 300 600 "$e $e" "wall zlo 1000 0.9" zmin 1000
    measure "cylinder $e" mono2000 "$inside" 300 300 "$e $e" "wall zlo 1000 0.9 $cylinder" \
        zmin,zmax=open,cylinder:6,6,5.5 zmin=1000,300
    measure "flat $e" monoper2000 1 1000 0 "$e $e" "wall zlo 0 0.9" zmin 0
done
measure "linear 0.8" monoper2000 1 "300+700*z/bound(all,zmax)" 1000 "0.8 0.8" "wall zlo 300 0.9" zmin 300
