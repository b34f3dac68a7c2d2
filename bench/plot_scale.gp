# plot_scale.gp - processor time per circle and memory against the number of spheres. SPDX-License-Identifier: MIT
# gnuplot -e "in='build/bench/bench_scale.csv'; out='scale.svg'" bench/plot_scale.gp
if (!exists("in")) in = 'build/bench/bench_scale.csv'
if (!exists("out")) out = 'build/bench/scale.svg'
set terminal svg size 760,420 font "sans,13" background "white"
set output out
set datafile separator ","
set datafile commentschars "#"
set logscale x
set xrange [100:1e6]
set format x "10^{%T}"
set xlabel "spheres"
set ylabel "processor time per circle (sphere and line) [microseconds]"
set y2label "memory per sphere [kB]"
set ytics nomirror
set y2tics
set yrange [0:]
set y2range [0:]
set grid
set key bottom right
of(threads) = $2 == threads ? $6 : NaN
plot in using 1:(of(1)) with linespoints pt 7 title "one thread", \
     in using 1:(of(2)) with linespoints pt 6 title "two threads", \
     in using 1:($2 == 2 ? $7 / 1000 : NaN) axes x1y2 with linespoints dt 2 pt 4 title "memory at most (right)"
