#!/bin/sh
# demo.sh - runs pour.lmp on 2 ranks, prints the energy balance, leaves tables and pictures in build/demo/lammps.
# SPDX-License-Identifier: MIT
set -eu
: "${BUILD:=build}" "${LMP:=lmp}" "${LOAD:=$BUILD/couple/fibrad.lmp}"
out=$BUILD/demo/lammps
rm -rf "$out"
mkdir -p "$out"

. tests/couple/mpi.sh
run_mpi 2 "$LMP" -in host/couple/lammps/pour.lmp -log "$out/log" -var load "$LOAD" -var out "$out"

# T against time, and the balance: columns step, time, heat, powers of surroundings and floor, mean and largest T; a step of heat
# takes 50 time steps
awk -v csv="$out/temperature.csv" '
    BEGIN { print "time,mean,most" >csv }
    /^[0-9]/ {
        if (last != "") integral -= ($4 + $5)*($2 - last)
        last = $2
        heat = $3
        if ($6 > 0) print $2 "," $6 "," $7 >csv
    }
    END {
        error = (heat - integral)/heat
        printf "\nHeat of the pebbles above 300 K    %.12g J\nlost by floor and surroundings     %.12g J\n", heat, integral
        printf "difference, of the heat            %.1e\n", error < 0 ? -error : error
    }' "$out/balance.txt"

# a frame a file for ParaView, and the series
awk -v out="$out" '
    function array(name, width, column,    i) {
        print "<DataArray type=\"Float64\" Name=\"" name "\" NumberOfComponents=\"" width "\" format=\"ascii\">" >file
        for (i = 1; i <= n; i++) print (width == 3 ? row[i, 2] " " row[i, 3] " " row[i, 4] : row[i, column]) >file
        print "</DataArray>" >file
    }
    function frame(    i) {
        file = out "/bed." step ".vtp"
        print "<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\"><PolyData>" >file
        print "<Piece NumberOfPoints=\"" n "\" NumberOfVerts=\"" n "\"><Points>" >file
        array("points", 3)
        print "</Points><PointData>" >file
        array("radius", 1, 5)
        array("T", 1, 6)
        array("power", 1, 7)
        print "</PointData><Verts>" >file
        print "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">" >file
        for (i = 0; i < n; i++) print i >file
        print "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">" >file
        for (i = 1; i <= n; i++) print i >file
        print "</DataArray></Verts></Piece></PolyData></VTKFile>" >file
        close(file)
        print "<DataSet timestep=\"" step*1e-5 "\" file=\"bed." step ".vtp\"/>" >series
    }
    BEGIN {
        series = out "/bed.pvd"
        print "<VTKFile type=\"Collection\" version=\"0.1\"><Collection>" >series
    }
    /^ITEM: TIMESTEP/ { if (n) frame(); getline; step = $1; n = 0 }
    NF == 7 && /^[0-9]/ { n++; for (i = 1; i <= 7; i++) row[n, i] = $i }
    END { frame(); print "</Collection></VTKFile>" >series }' "$out/frames.dump"

awk '/^ITEM: TIMESTEP/ { n = 0 } NF == 7 && /^[0-9]/ { line[++n] = $2 " " $3 " " $4 " " $5 " " $6 }
    END { for (i = 1; i <= n; i++) print line[i] }' "$out/frames.dump" | sort -g -k 2,2r >"$out/last.txt"
gnuplot -e "
    set terminal pngcairo size 1200, 450; set output '$out/bed.png'; set multiplot;
    set origin 0, 0; set size 0.5, 1; set size ratio -1; set xrange [-1:21]; set yrange [0:14];
    set palette defined (0 '#203080', 0.5 '#e06030', 1 '#fff0a0'); set cblabel 'T [K]'; set cbrange [300:*];
    set xlabel 'x [mm]'; set ylabel 'z [mm]';
    plot '$out/last.txt' using (\$1*1e3):(\$3*1e3):(\$4*1e3):5 with circles fill solid border linecolor 'black' linecolor palette notitle;
    set origin 0.5, 0; set size 0.5, 1; set size noratio; set xrange [0:*]; set yrange [300:*];
    set xlabel 'time [s]'; set ylabel 'T [K]'; set key left; set datafile separator ',';
    plot '$out/temperature.csv' using 1:3 every ::1 with lines linewidth 2 title 'hottest pebble',
         '$out/temperature.csv' using 1:2 every ::1 with lines linewidth 2 title 'mean';
    unset multiplot"
echo
echo "Temperatures against time:  $out/temperature.csv"
echo "Picture:                    $out/bed.png"
echo "ParaView:                   $out/bed.pvd"
