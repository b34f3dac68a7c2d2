# plot_papers.gp - the figures of docs/validation.md from the files of `fibrad reproduce -o FOLDER`.
# SPDX-License-Identifier: MIT
# gnuplot -e "folder='docs/figures'" bench/plot_papers.gp
if (!exists("folder")) folder = 'docs/figures'
cd folder

# begins a picture with the defaults of all
begin = "reset; set terminal svg size 900,600 font 'Helvetica,13' background 'white'; \
set datafile separator ','; set datafile columnheaders; set grid; set style data linespoints; set key font ',11'"
# ends multiplot, if there is one, and closes the picture
end = "if (GPVAL_MULTIPLOT) {unset multiplot}; set output"
eval begin

set output 'fig3.svg'
set multiplot layout 2,2
set logscale x
set xrange [0.004:10]
set yrange [-25:25]
set xlabel 'gap p_2 + 0.005 [radii]'
set ylabel 'error [%]'
set key font ',9' horizontal bottom right samplen 1
do for [p in '0.1 0.3 0.7 1'] {
    set title 'p_1 = '.p
    plot for [n in '13 34 55 89 144 233 610'] 'fig3.csv' using ($3+0.005):($1==real(p)&&$2==int(n)?$6:1/0) \
        pt 7 ps 0.4 title 'N_F = '.n
}
eval end

eval begin
set output 'fig4.svg'
set logscale y
set xlabel 'gap p_2 [radii]'
set ylabel 'F_{12}, equal spheres'
plot 'fig4.csv' using 1:4 with lines lw 3 lc rgb '#bbbbbb' title 'exact', \
     '' using 1:2 pt 7 ps 0.4 title 'surface, 55 nodes, not corrected', \
     '' using 1:5 with lines dt 2 title 'point source: (1 - (1 - 1/d^2)^{1/2})/2', \
     '' using 1:6 with lines dt 3 title 'far field: 1/(4 d^2)'
eval end

# fig7 has factors. fig8 and fig9 have errors: raw from column 8 on, corrected from column 11 on.
do for [k=7:9] {
    eval begin
    set output 'fig'.k.'.svg'
    set multiplot layout 2,2
    set xlabel 'gap p_2 + 0.005 [radii]'
    set logscale x
    set xrange [0.004:2]
    c = 8 + 3*(k-8)
    if (k == 7) {set ylabel 'F_{12}, third sphere touching both'} \
    else {set ylabel 'error against the reference [%]'; set yrange [-10:10]}
    do for [p in '0.1 0.3 0.7 1'] {
        set title 'p_1 = r_c = '.p
        if (k == 7) {
            plot 'fig7-9.csv' using ($2+0.005):($1==real(p)?$7:1/0) with lines lw 3 lc rgb '#bbbbbb' title 'reference', \
                 '' using ($2+0.005):($1==real(p)?$3:1/0) pt 7 ps 0.5 title '55 nodes', \
                 '' using ($2+0.005):($1==real(p)?$5:1/0) pt 6 ps 0.5 title '987 nodes'
        } else {
            plot 'fig7-9.csv' using ($2+0.005):($1==real(p)?column(c):1/0):(column(c+1)):(column(c+2)) \
                     with yerrorbars pt 7 ps 0.5 title '55 nodes, azimuth 0 and all', \
                 '' using ($2+0.005):($1==real(p)?column(k+6):1/0) pt 6 ps 0.5 title '987 nodes'
        }
    }
    eval end
}

eval begin
set output 'fig10.svg'
set xlabel 'distance D of the centres taken in [radii]'
set ylabel 'sum of the factors of the centre sphere'
set key bottom right
set yrange [0.4:1.02]
plot for [p in '0.74 0.567 0.474 0.428 0.374'] \
         'fig10.csv' using 3:($1==real(p)&&strcol(2) eq 'reference'?$4:1/0) with lines lw 2 title 'solid '.p.', reference', \
     '' using 3:(strcol(2) eq 'surface'?$4:1/0):5 with yerrorbars pt 7 ps 0.5 lc rgb '#333333' \
         title 'surface, 55 nodes: mean, spread', \
     '' using 3:(strcol(2) eq 'beam'?$4:1/0) with points pt 6 ps 1 lc rgb '#d1495b' title 'beam, 233 directions'
eval end

eval begin
set output 'table1.svg'
set logscale xy
set xlabel 'spheres'
set ylabel 'seconds for all factors, one thread'
set key top left
set xrange [8:1300]
plot 'table1.csv' using 1:2 pt 4 title 'published: surface', '' using 1:8 pt 8 title 'published: Monte Carlo', \
     '' using 1:3 pt 7 title 'surface, 55 nodes', '' using 1:6 pt 5 title 'beam at equal error', \
     '' using 1:13 pt 9 title 'mc at equal error', '' using 1:10 pt 11 title 'cast at equal error'
eval end

eval begin
set output 'pebble-pair.svg'
set xlabel 'angle from the line of centres [degrees]'
set ylabel 'received per area, of that at angle 0'
set xrange [0:90]
set yrange [0:1.02]
plot 'pebble-pair.csv' using 1:2 with lines lw 4 lc rgb '#bbbbbb' title 'cosine', \
     for [k=3:6] '' using 1:k with lines lw 2 title word('2 3 4 6',k-2).' radii apart'
eval end

eval begin
set output 'pebble-rays.svg'
set logscale y
set xlabel 'centre distance [radii]'
set ylabel 'rays for an error of 1 %'
set key top left
set xrange [1.8:6.2]
plot 'pebble-rays.csv' using 1:7 pt 7 title 'cast: quasi-random', '' using 1:8 pt 5 title 'mc: random'
eval end

eval begin
set output 'pebble-bed.svg'
set xlabel 'centre distance [radii]'
set ylabel 'sum of the factors within'
set y2label 'spheres within'
set y2tics
set ytics nomirror
set key right center
plot for [p in '0.55 0.6'] 'pebble-bed.csv' using 2:($1==real(p)?$3:1/0) with lines lw 2 title 'factor, solid '.p, \
     for [p in '0.55 0.6'] '' using 2:($1==real(p)?$4:1/0) axes x1y2 with lines dt 2 title 'spheres, solid '.p
eval end

eval begin
set output 'correlations.svg'
set xlabel 'emissivity'
set ylabel 'F_E of a correlation over that of the bed'
set xrange [0.15:1.05]
set yrange [0:1.6]
set key top right
name = 'Zehner-Bauer-Schluender Kunii-Smith'
plot 1 with lines lc 'black' title 'random bed', \
     for [k=1:2] 'correlations.csv' using (abs($1-0.4)<1e-9 ? $2 : 1/0):(column(3+k)/$3) \
         title word(name, k).', porosity 0.40' lw 2 lc k, \
     for [k=1:2] '' using (abs($1-0.5)<1e-9 ? $2 : 1/0):(column(3+k)/$3) notitle dt 2 pt 0 lc k, \
     1/0 with lines dt 2 lc 'black' title 'the same, porosity 0.50'
eval end
