# plot_beam.gp - run time of a row against its error, all methods. SPDX-License-Identifier: MIT
# gnuplot -e "in='build/bench/bench_beam.csv'; peer='build/bench/bench_embree.csv'; out='beam_error.svg'" bench/plot_beam.gp
if (!exists("in")) in = 'build/bench/bench_beam.csv'
if (!exists("peer")) peer = 'build/bench/bench_embree.csv'
if (!exists("out")) out = 'build/bench/beam_error.svg'
set terminal svg size 760,520 font "sans,13" background "white"
set output out
set datafile separator ","
set datafile commentschars "#"
set logscale xy
set format xy "10^{%T}"
set xlabel "time of a row, one thread [microseconds]"
set ylabel "error of an entry of the row, root mean square"
set grid
set key bottom right spacing 0.9
of(method, kind) = (strcol(1) eq method && (kind eq "" || strcol(2) eq kind)) ? $5 : NaN
curves = "in using 4:(of('whole', '')) with linespoints lw 2 pt 5 lc rgb '#00703c' title 'all rows at once (along lines)'"
curves = curves . ", in using 4:(of('beam', 'areas')) with linespoints lw 2 pt 7 title 'beam, exact areas'"
curves = curves . ", in using 4:(of('beam', 'points 256')) with linespoints pt 6 title 'beam, 256 points'"
curves = curves . ", in using 4:(of('beam', 'points 64')) with linespoints pt 4 title 'beam, 64 points'"
curves = curves . ", in using 4:(of('surface', '')) with linespoints pt 8 title 'surface'"
curves = curves . ", in using 4:(of('cast', '')) with linespoints pt 10 lc rgb '#8c6d00' title 'cast'"
curves = curves . ", in using 4:(of('mc', '')) with linespoints pt 12 title 'mc'"
if (system("test -s '" . peer . "' && echo yes") eq "yes") {
    curves = curves . ", peer using 4:(of('embree owen', '')) with linespoints dt 2 pt 11 title 'Embree, Owen-Sobol'"
    curves = curves . ", peer using 4:(of('embree mc', '')) with linespoints dt 2 pt 13 title 'Embree, Monte Carlo'"
}
eval "plot " . curves
