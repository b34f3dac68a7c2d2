# plot_papers.gp - the figures of docs/validation.md from the files of `fibrad reproduce -o FOLDER`.
# SPDX-License-Identifier: MIT
# gnuplot -e "folder='docs/figures'" bench/plot_papers.gp
if (!exists("folder")) folder = 'docs/figures'
cd folder
set terminal svg size 900,600 font 'Helvetica,13' background 'white'
set datafile separator ','
set datafile columnheaders

# begins a picture with the defaults of all
begin = "reset session; set terminal svg size 900,600 font 'Helvetica,13' background 'white'; \
set datafile separator ','; set datafile columnheaders; set grid; set style data linespoints; set key font ',11'"
