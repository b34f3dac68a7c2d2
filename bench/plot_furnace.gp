# plot_furnace.gp - time against error of the furnace methods. SPDX-License-Identifier: MIT
# gnuplot -e "in='build/bench/bench_furnace.csv'; out='furnace_error.png'" bench/plot_furnace.gp
if (!exists("in")) in = 'build/bench/bench_furnace.csv'
if (!exists("out")) out = 'build/bench/furnace_error.png'
set terminal pngcairo size 1180,560 font 'DejaVu Sans,11' background '#ffffff'
set output out
set datafile separator ','
set border 3 lc '#555555'
set tics nomirror out scale 0.6 tc '#333333'
set grid lc '#e6e6e6' lw 1 lt 1
set logscale xy
set xrange [0.02:100]
set yrange [0.008:20]
set format y '%g'
set format x '%g'
set xlabel 'time [s]'
set ylabel 'error of T in the plane y = 1 m, largest of all cells [%]'
set key bottom left
set multiplot layout 1,2 margins 0.07,0.985,0.11,0.90 spacing 0.08,0
titles = 'without with'
do for [n = 1:2] {
    set title sprintf('Case %d: %s scattering', n, word(titles, n))
    set arrow 1 from graph 0, first 1 to graph 1, first 1 nohead dt 2 lc '#999999'
    set label 1 'the 1 % of the paper' at graph 0.72, first 1.15 tc '#777777' font ',9'
    plot for [m in 'mchf-paper mchf mchf-x mc'] in \
        using (($1 == n && strcol(2) eq m) ? $4 : NaN):7 with linespoints lw 2 pt 7 ps 0.9 \
        lc rgb (m eq 'mc' ? '#d1495b' : m eq 'mchf-x' ? '#365c8d' : m eq 'mchf' ? '#4ac16d' : '#c9a227') \
        title (m eq 'mchf-paper' ? 'mchf --theta paper' : m)
    set ylabel ' '
}
unset multiplot
