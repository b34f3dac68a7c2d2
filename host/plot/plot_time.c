/* plot_time.c - a picture of temperatures in time, by gnuplot. SPDX-License-Identifier: MIT */
#include "plot/plot_time.h"

#include "cli/message.h"
#include "plot/gnuplot.h"

int plot_time(const struct output *output, const char *name, const struct time_point *point, size_t points) {
    struct gnuplot gnuplot;
    const int status = gnuplot_start(&gnuplot, output);
    if (status) return status;
    gnuplot_style(gnuplot.script, output->path, 1100, 700);
    fputs("$time << END\n", gnuplot.script);
    for (size_t k = 0; k < points; ++k)
        fprintf(gnuplot.script, "%.9g %.9g %.9g %.9g\n", point[k].time, point[k].mean, point[k].least, point[k].most);
    fputs("END\nset title '", gnuplot.script);
    gnuplot_name(gnuplot.script, name);
    fprintf(gnuplot.script,
            "' noenhanced\n"
            "set xlabel 'time [s]'; set ylabel 'temperature [K]'; set grid; set key top right\n"
            "set xrange [%.9g:%.9g]\n"
            "plot $time using 1:3:4 with filledcurves fc '#c8553d' fs transparent solid 0.25 noborder title 'coldest "
            "to hottest', '' using 1:3 with lines lw 1 lc '#c8553d' notitle, '' using 1:4 with lines lw 1 lc '#c8553d' "
            "notitle, '' using 1:2 with lines lw 3 lc '#222222' title 'mean'\n",
            point[0].time, point[points - 1].time);
    return gnuplot_end(&gnuplot);
}
