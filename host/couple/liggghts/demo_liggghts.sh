#!/bin/sh
# demo_liggghts.sh - a bed on a hot floor in LIGGGHTS on 2 ranks, by conduction alone and with radiation: temperatures,
# energy, picture. SPDX-License-Identifier: MIT
set -eu
: "${BUILD:=build}"
. tests/couple/mpi.sh
out=$BUILD/demo-liggghts script=host/couple/liggghts/hot_floor.liggghts
mkdir -p "$out"

{ cat $script && echo 'run 10000'; } >"$out/conduction.in"
run_mpi 2 liggghts -in "$out/conduction.in" -log none >"$out/conduction.txt"
run_mpi 2 "$BUILD/couple/fibrad_liggghts" -in $script --emissivity 0.8 --surroundings 300 --wall zmin:temperature=1200:emissivity=0.9 \
    --steps 10000 -- -log none >"$out/radiation.txt"

# lines of four numbers are thermo output: step, mean and highest temperature, mean of the heat conducted from walls
awk 'BEGIN { print "seconds,conduction alone: mean,conduction alone: hottest,with radiation: mean,with radiation: hottest" }
    NF == 4 && $1 + 0 == $1 && $2 > 1 {
        if (FNR == NR) first[$1] = $2 "," $3
        else if ($1 in first) printf "%.3f,%s,%s,%s\n", $1 * 2e-5, first[$1], $2, $3
    }' "$out/conduction.txt" "$out/radiation.txt" >"$out/liggghts.csv"
gnuplot <<END
set terminal svg size 640,400 font 'sans,12' noenhanced
set output '$out/liggghts.svg'
set datafile separator ','
set xlabel 'time [s]'
set ylabel 'temperature [K]'
set key top left
plot for [k = 4:5] '$out/liggghts.csv' using 1:k with lines linewidth 2 title columnhead(k), \
    for [k = 2:3] '$out/liggghts.csv' using 1:k with lines linewidth 2 dashtype 2 title columnhead(k)
END
sed -n '/^heat_before/,$p' "$out/radiation.txt"
echo "Temperatures: $out/liggghts.csv, $out/liggghts.svg"
