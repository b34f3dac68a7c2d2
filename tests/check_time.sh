#!/bin/sh
# check_time.sh - fibrad heat --until: closed forms, tables of time, series, and refusals.
# SPDX-License-Identifier: MIT
set -u
: "${BUILD:=build}"
work=$(mktemp -d) && trap 'rm -rf "$work"' EXIT || exit 1
faults=0
fault() {
    echo "check_time: $*"
    faults=1
}

march() { # march FILE OPTIONS...: a march, its summary in $work/said
    bed=$1
    shift
    "$BUILD/fibrad" heat "$bed" --threads 2 --emissivity 0.6 --heat-capacity 800 --density 2500 "$@" \
        >"$work/said" 2>"$work/errors"
}
value() { awk -v key="$1" '$1 == key { print $2 }' "$work/said"; }
is() { awk -v a="$1" -v b="$2" -v most="$3" 'BEGIN { exit !(a - b <= most && b - a <= most) }'; }

# A sphere of 2 cm into 0 K: 1/T^3 grows by 3 A e sigma/C a second, by nine times that of density rho c r/3.
printf 'id,x,y,z,r,T\n5,0,0,0,20,1200\n' >"$work/one.csv"
march "$work/one.csv" --length-unit mm --temperature T --ambient 0 --until 600 --times every:200 -o "$work/one.out.csv" \
    -o "$work/cool.*.vtp" || fault "$(cat "$work/errors")"
end=$(awk 'BEGIN { print (1200^-3 + 3 * 0.6 * 5.670374419e-8 * 3 / (800 * 2500 * 0.02) * 600)^(-1/3) }')
is "$(value temperature_mean_K)" "$end" 0.05 || fault "one sphere ends at $(value temperature_mean_K) K, not $end K"
is "$(value stored_J)" "-$(value surroundings_J)" 0.1 || fault "stored_J is not what the surroundings got"
is "$(value balance_of_stored)" 0 1e-12 || fault "the energy is not kept: $(value balance_of_stored)"
test "$(sed -n 1p "$work/one.out.csv")" = "time_s,i,T_K,q_W,q_error_W,T_error_K,body" || fault "header of .csv"
test "$(awk -F , '$2 == 5 { printf "%s ", $1 }' "$work/one.out.csv")" = "0 200 400 600 " || fault "times in .csv"
test "$(grep -c 'file="cool\.[0-3]\.vtp"' "$work/cool.pvd")" = 4 || fault "cool.pvd does not name four files"
test -s "$work/cool.3.vtp" || fault "no cool.3.vtp"
test ! -e "$work/cool.4.vtp" || fault "one .vtp too many"

# Emissivity T/2000 by a table: 1/T^4 grows by four times 3 sigma/(2000 density c r) a second; by type, too.
printf '0,0\n2000,1\n' >"$work/eps.csv"
printf 'id,x,y,z,r,type\n5,0,0,0,20,1\n' >"$work/type.csv"
end=$(awk 'BEGIN { print (1200^-4 + 4 * 3 * 5.670374419e-8 / (2000 * 800 * 2500 * 0.02) * 600)^(-1/4) }')
for law in "@$work/eps.csv" "1:@$work/eps.csv"; do
    march "$work/type.csv" --length-unit mm --temperature 1200 --ambient 0 --until 600 --emissivity "$law" \
        -o "$work/law.csv" || fault "$(cat "$work/errors")"
    is "$(value temperature_mean_K)" "$end" 0.05 || fault "with $law it ends at $(value temperature_mean_K) K, not $end K"
    awk -F , -v t="$end" '$2 == 5 { q = 5.670374419e-8 * 16e-4 * atan2(0, -1) * t^5 / 2000 }
        $2 == 5 && ($4 + q > 1e-3 * q || $4 + q < -1e-3 * q) { exit 1 }' "$work/law.csv" || fault "$law: powers of another emissivity"
done

# In a closed black box whose temperature follows a table, a mote follows the walls. Tables have times and a unit.
printf '# seconds, degrees\ntime,T\n0,27\n100,827\n500,827\n' >"$work/ramp.csv"
printf '0,0,0,0.001,300\n' | sed '1i x,y,z,r,T' >"$work/mote.csv"
planes=
for axis in x y z; do
    for side in min:at=-1 max:at=1; do planes=$planes,$axis$side:temperature=@$work/ramp.csv; done
done
march "$work/mote.csv" --length-unit mm --temperature 27 --temperature-unit C --wall "${planes#,}" --until 300 --times 50,300 \
    -o "$work/mote.out.csv" || fault "$(cat "$work/errors")"
awk -F , '$2 == 0 { t[$1] = $3 } END { exit !(t[50] > 690 && t[50] < 700.15 && t[300] > 1100.1 && t[300] < 1100.2) }' \
    "$work/mote.out.csv" || fault "the mote does not follow the walls: $(grep ',0,' "$work/mote.out.csv")"
is "$(value wall_zmin_K)" 1100.15 1e-3 || fault "wall_zmin_K is $(value wall_zmin_K)"

# Powers and fixed steps. The energy supplied is stored or given off.
march tests/data/formats/lammps.dump --temperature 900 --power 2 --ambient 300 --until 20 --step 5 --patches 24 \
    --directions 36 -o "$work/steps.json" --plot "$work/steps.svg" || fault "$(cat "$work/errors")"
test "$(value steps)" = 4 || fault "$(value steps) steps instead of 4"
is "$(value balance_of_stored)" 0 1e-12 || fault "balance_of_stored is $(value balance_of_stored)"
grep -q '"time_s":20,' "$work/steps.json" || fault "no time in .json"
grep -q '</svg>' "$work/steps.svg" || fault "no picture"

refused() { # refused STATUS WORDS OPTIONS...: of one.csv
    status=$1 words=$2
    shift 2
    "$BUILD/fibrad" heat "$work/one.csv" --length-unit mm --emissivity 0.6 "$@" >"$work/said" 2>"$work/errors"
    got=$?
    test $got = "$status" || fault "status $got instead of $status: $*"
    grep -q -- "$words" "$work/errors" || fault "'$(cat "$work/errors")' instead of '$words'"
    test "$(wc -l <"$work/errors")" = 1 || fault "more than a line: $(cat "$work/errors")"
}
printf '0,300\n10,800\n10,500\n' >"$work/back.csv"
printf '0,300\n10,-1\n' >"$work/cold.csv"
set -- --ambient 300 --heat-capacity 800 --density 2500 --until 60
refused 2 'until needs --heat-capacity' --ambient 300 --temperature T --until 60 --density 2500
refused 2 'until needs --density' --ambient 300 --temperature T --until 60 --heat-capacity 800
refused 2 'heat-capacity needs --until' --ambient 300 --temperature T --heat-capacity 800
refused 2 'until needs --temperature' "$@" --power 3
refused 3 'one.csv:2: the temperature is 0 K' "$@" --temperature 0
refused 3 'back.csv:3: 10 is not above' "$@" --temperature T --wall "zmin:at=-30:temperature=@$work/back.csv"
refused 3 'cold.csv:2: the temperature is -1' "$@" --temperature T --wall "zmin:at=-30:temperature=@$work/cold.csv"
refused 3 'cold.csv:2: the temperature is -1' --temperature T --ambient "@$work/cold.csv" --heat-capacity 1 --density 1 --until 9
refused 2 'zmin has no temperature' "$@" --temperature T --wall zmin:at=-30
refused 2 '3 is not above the time before' "$@" --temperature T --times 5,3
refused 2 '90 is not above the time before, or not within 0 and 60' "$@" --temperature T --times 90
refused 2 'times every: .0. is not a number\|not within' "$@" --temperature T --times every:0
refused 2 'put \* into its name' "$@" --temperature T -o "$work/x.vtp"
refused 2 'not for --until' "$@" --temperature T --error 0.01
refused 2 'one frame' "$@" --temperature T --frame all
refused 3 'above 0 K' "$@" --temperature T --power=-1e6
exit $faults
