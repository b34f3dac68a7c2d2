#!/bin/bash
# powers.sh - powers of fix fibrad in LAMMPS, whose rows are made once, against those of `fibrad heat`. docs/lammps.md
# has the table. SPDX-License-Identifier: MIT
#
# bench/powers.sh [WORD [ACCURACIES [SEEDS]]]: all cases, or those whose name has this word. ACCURACIES are "high normal
# low" and SEEDS "1 2 3" if nothing else is given. "tolerance=0.01" is an accuracy, too. A line has a case and
# an accuracy. Errors are differences from `fibrad heat`:
#     rms           root mean square of those of particles over that of their powers, the mean of all seeds
#     largest       that of a particle over its power, or over the root mean square of all powers if that is larger;
#                   this and the next two are the largest of all seeds
#     sum           that of the sum of all powers over the sum of their magnitudes
#     rest, floor   those of the surroundings and of the first wall over their powers
#     warnings      number of warnings of the fix, all seeds
# What `fibrad heat` finds is kept in build/bench/powers. The script needs `make lammps build/fibrad`.
set -eu
: "${BUILD:=build}" "${LMP:=lmp}"
. tests/couple/mpi.sh
. tests/couple/beds.sh
work=${WORK:-$BUILD/bench/powers} only=${1:-} accuracies=${2:-high normal low} seeds=${3:-1 2 3}
mkdir -p "$work"

# What the lines should stay below, in %: rms; or largest, sum and floor.
declare -A bar=(
    ["below high"]="1.5 .2 .2" ["hopper high"]="1.5 .2 .2" ["curtain high"]="1.5 .2 .2"
    ["closed high"]=.6 ["closed normal"]=2.5 ["closed low"]=5 ["box 0.8 high"]=.7 ["box 0.8 normal"]=3.2 ["box 0.8 low"]=6
    ["poured high"]=.8 ["poured normal"]=3 ["poured low"]=5.5 ["drum high"]=1.1 ["drum normal"]=5.5 ["drum low"]=9.5
    ["flat 0.8 high"]=.5 ["flat 0.8 normal"]=2.2 ["flat 0.8 low"]=4.7 ["plate high"]=.8 ["plate normal"]=5.5 ["plate low"]=10.5
)

# measure CASE BED WALLS [LIST]: BED is a dump. WALLS are in the words of the program, all of emissivity 0.9; LIST has the
# same for fibrad heat if it reads the bed turned. Variables tell more: `e`, emissivities of odd and even ids; `field`, temperatures of particles as a
# formula of LAMMPS; `cold`, that of the surroundings; `error`, allowed to fibrad heat; `turn`, a program of awk for what
# fibrad heat reads.
measure() {
    local name=$1 bed=$2 walls=${3//:temperature/:emissivity=0.9:temperature} list=${4:-$3} out=$work/powers.dump boundary accuracy words seed heat key
    local e=${e:-0.8 0.8} field=${field:-300} cold=${cold:-300} error=${error:-0.002} turn=${turn:-1}
    [[ $name == *"$only"* ]] || return 0

    boundary=$(awk '/BOX BOUNDS/ { for (i = 4; i < 7; i++) printf "%s ", substr($i, 1, 1) }' "$bed")
    as_data "$bed" >"$work/bed.data"
    walls=$(echo "$walls" | sed 's/,\([a-z]\)/ wall \1/g; s/[:=,]/ /g')
    for accuracy in $accuracies; do
        words="accuracy $accuracy"
        [[ $accuracy != *=* ]] || words=${accuracy/=/ }
        rm -f "$work"/log.* "$work/errors"
        for seed in $seeds; do
            "$LMP" -in bench/powers.lmp -screen none -log "$work/log.$seed" -var load "$BUILD/couple/fibrad.lmp" \
                -var data "$work/bed.data" -var boundary "$boundary" -var T "$field" -var out "$out" -var words \
                "emissivity type $e surroundings $cold wall $walls $words seed $seed"
            heat=(--length-unit m --temperature d_T --ambient "$cold" --emissivity "1:${e/ /,2:}"
                --wall "${list//:temperature/:emissivity=0.9:temperature}" --error "$error" --quiet)
            awk '/ITEM: ATOMS/ || (NF == 8 && !/ITEM/) { NF-- } 1' "$out" | awk "$turn" >"$work/heat.dump"
            key=$(echo "${heat[@]}" | cat - "$work/heat.dump" | cksum | cut -d ' ' -f 1)
            test -e "$work/$key.csv" || "$BUILD/fibrad" heat "$work/heat.dump" "${heat[@]}" -o "$work/$key.csv"
            compare "$work/$key.csv" "$out" >>"$work/errors"
        done
        awk -v warnings="$(cat "$work"/log.* | grep -c 'WARNING: fix fibrad')" -v bar="${bar[$name $accuracy]:--}" '
            function most(k, x) { if (x < 0) x = -x; if (x > worst[k]) worst[k] = x }
            { rms += $2; for (k = 3; k < 7; k++) most(k, $k); if ($3 == worst[3]) whose = $7 }
            END { printf "%d particles, rms %.2f %%, largest %.2f %% (%d), sum %.2f %%, rest %.2f %%, floor %.2f %%, " \
                "warnings %d; bar %s\n", $1, rms/NR, worst[3], whose, worst[4], worst[5], worst[6], warnings, bar }' \
            "$work/errors" | sed "s/^/$name, $accuracy: /"
    done
}

# compare CSV DUMP: number, rms, largest, sum, rest, floor and the id of the largest, of DUMP and of DUMP.rest
compare() {
    awk 'NR == FNR { power[$1] = $3; if ($1 + 0 > 0) { n++; squares += $3^2 } next }
        !/^-?[0-9]+ / || (FNR < 10 && !/^-/) { next }
        { difference = $NF - power[$1] }
        $1 < 0 { rest[$1] = power[$1] ? 100*difference/power[$1] : 0; next }
        {
            m++; errors += difference^2; sum += difference; size = sqrt(power[$1]^2); all += size
            if (size < sqrt(squares/n)) size = sqrt(squares/n)
            if ((difference/size)^2 > most^2) { most = sqrt((difference/size)^2); whose = $1 }
        }
        END { if (m != n) exit 1
            print n, 100*sqrt(errors/squares), 100*most, 100*sum/all, rest[-1], rest[-2], whose }' \
        FS=, "$1" FS=' ' "$2" "$2.rest"
}

# bed WIDE HIGH: a dump of the lines `x y z radius` of the input, in a box that is periodic along x and y
bed() {
    awk -v wide="$1" -v high="$2" '{ line[NR] = $0 }
        END {
            print "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n" NR "\nITEM: BOX BOUNDS pp pp ff"
            print "0 " wide "\n0 " wide "\n0 " high "\nITEM: ATOMS id type x y z radius v_T v_none"
            for (i = 1; i <= NR; i++) print i, 1, line[i], 300, 0
        }'
}

# part BED PROGRAM: BED of tests/data with what a program of awk does to its particles, whose z is $5
part() {
    awk "NF == 8 && !/ITEM/ { $2 } 1" "tests/data/$1.dump"
}

# funnel WIDE LOW HIGH HOLE: four sides of a hopper about the axis of a box, from an opening at the height LOW to WIDE at
# HIGH
funnel() {
    awk -v wide="$1" -v low="$2" -v high="$3" -v hole="$4" '
        function corner(s, up,   w) {
            w = (up ? wide : hole)/2
            return "vertex " wide/2 + (s%4%3 ? w : -w) " " wide/2 + (s%4 > 1 ? w : -w) " " (up ? high : low) "\n"
        }
        function facet(a, b, c) { print "facet normal 0 0 0\nouter loop\n" a b c "endloop\nendfacet" }
        BEGIN {
            print "solid funnel"
            for (s = 0; s < 4; s++) {
                facet(corner(s, 0), corner(s + 1, 0), corner(s + 1, 1))
                facet(corner(s, 0), corner(s + 1, 1), corner(s, 1))
            }
            print "endsolid"
        }'
}

# a layer of a lattice, and three balls below it
awk 'BEGIN {
    print "6.006 6.006 2.5025 .5\n9.009 4.004 1.5015 .5\n2.002 2.002 3.5035 .5"
    for (n = 0; n < 1440; n++) print (n%12 + .5)*1.001, (int(n/12)%12 + .5)*1.001, (int(n/144) + 6.5)*1.001, .5
}' | bed 12.012 20.02 >"$work/below.dump"
# 650 particles that lie in a hopper with an opening of 4, and 30 that have left it
awk 'function near(x) { s = s*16807%2147483647; return x + .1*(s/2147483647 - .5) }
    BEGIN {
        s = 1
        for (n = 0; n < 30; n++) print near(4.5 + n%3), near(4.5 + int(n/3)%2*2), near(4.4 - .85*int(n/6)), .4
        for (n = 0; m < 650; n++) {
            x = n%11 + .5; y = int(n/11)%11 + .5; z = 5.5 + .9*int(n/121); wide = 1.5 + .175*(z - 5)
            if ((x - 5.5)^2 < wide^2 && (y - 5.5)^2 < wide^2) { m++; print near(x), near(y), near(z), .4 }
        }
    }' | bed 11 25 >"$work/hopper.dump"
# two rows of balls that fall
awk 'function near(x) { s = s*16807%2147483647; return x + .4*(s/2147483647 - .5) }
    BEGIN { s = 1; for (n = 0; n < 416; n++) print near(1.5*(n%8) + .75), near(5.25 + 1.5*(int(n/8)%2)), near(1.5*int(n/16) + 1), .5 }' |
    bed 12 50 >"$work/curtain.dump"
# shellcheck disable=SC2016  # columns of awk
{
    part mono2000 '$6 /= 2' >"$work/apart.dump"
    part mono2000 'if (($3 - 6)^2 + ($4 - 6)^2 >= 25) next' >"$work/cylinder.dump"
    part mono2000 'if (($3 - 6)^2 + ($4 - 6)^2 >= 25) next; if ($5 > 6) $5 = 6 + 3*($5 - 6)' >"$work/poured.dump"
    part mono2000 'if (($4 - 6)^2 + ($5 - 6)^2 >= 30.25 || $5 > 6.5) next' >"$work/drum.dump"
    lying='NF == 7 && !/ITEM/ { x = $3; $3 = $4; $4 = $5; $5 = x } 1'
}
poly=tests/data/poly2000.dump flat=tests/data/monoper2000.dump
high=$(awk 'NF == 8 && $5 + $6 > high { high = $5 + $6 } END { print high }' $poly)
box 12 "$high" | sed '/solid zhi/,$d' >"$work/box.stl"
box 12 1 | sed -n '/solid zlo/,/endsolid/p' >"$work/plate.stl"
funnel 11 5 25 4 >"$work/funnel.stl"
t=:temperature=1000
measure below "$work/below.dump" zmin$t
measure hopper "$work/hopper.dump" "zmin$t,mesh:$work/funnel.stl:temperature=300:both"
measure curtain "$work/curtain.dump" zmin$t
measure closed $poly "box$t,zmax$t:at=$high"
measure "box 0.8" $poly box$t,zmax:open
e="0.8 0.3" measure "box 0.8 and 0.3" $poly box$t,zmax:open
measure "triangles 0.8" $poly "mesh:$work/box.stl$t"
cylinder=zmin$t,cylinder:6,6,5.5:temperature=300,zmax:open
measure poured "$work/poured.dump" $cylinder
turn=$lying measure drum "$work/drum.dump" xcylinder:6,6,6$t,xmin:temperature=300,xmax:temperature=300 \
    cylinder:6,6,6$t,zmin:at=0:temperature=300,zmax:at=12:temperature=300
measure plate tests/data/mono2000.dump "mesh:$work/plate.stl$t"
# shellcheck disable=SC2097,SC2098  # measure is a function
for e in 0.8 0.3; do
    test $e = 0.8 || error=0.003
    e="$e $e" error=0.005 cold=600 measure "apart $e" "$work/apart.dump" zmin$t
    e="$e $e" measure "cylinder $e" "$work/cylinder.dump" $cylinder
    e="$e $e" field=1000 cold=0 measure "flat $e" $flat zmin:temperature=0
done
e="0.8 0.8" error=0.002 field="300+700*z/bound(all,zmax)" cold=1000 measure "linear 0.8" $flat zmin:temperature=300
