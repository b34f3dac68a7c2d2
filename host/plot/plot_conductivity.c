/* plot_conductivity.c - a picture of exchange factors along the axes, by gnuplot. SPDX-License-Identifier: MIT */
#include "plot/plot_conductivity.h"

#include <math.h>
#include <string.h>

#include "cli/message.h"
#include "plot/gnuplot.h"

/* Prints a line per axis: number, F_E, twice its error, F_E between plates, twice its error, name. Returns the number
 * of lines. */
static int print_axes(FILE *script, const struct conduction *conduction, bool *between) {
    int axes = 0;
    fputs("$axes << END\n", script);
    for (int axis = 0; axis < 3; ++axis) {
        if (!conduction_wants(conduction, axis)) continue;
        const char *doubt = conduction_doubt(conduction, axis);
        fprintf(script, "%d %.6g %.6g %.6g %.6g \"%c", axes++, conduction->factor[axis], 2 * conduction->error[axis],
                conduction->steady[axis], 2 * conduction->steady_error[axis], 'x' + axis);
        if (!isnan(conduction->temperature)) fprintf(script, "\\nk = %.4g W/(m K)", conduction->k[axis]);
        if (doubt) fprintf(script, "\\n%.*s\\n%s", (int)strcspn(doubt, ":") + 1, doubt, strchr(doubt, ':') + 2);
        fputs("\"\n", script);
        *between = *between || !isnan(conduction->steady[axis]);
    }
    fputs("END\n", script);
    return axes;
}

int plot_conduction(const struct output *output, const char *name, const struct conduction *conduction) {
    struct gnuplot gnuplot;
    bool between = false;
    const int status = gnuplot_start(&gnuplot, output);
    if (status) return status;
    FILE *script = gnuplot.script;
    gnuplot_style(script, output->path, 800, 640);
    const int axes = print_axes(script, conduction, &between);
    fputs("set label 1 '", script);
    gnuplot_name(script, name);
    fprintf(script,
            "' at screen 0.03,0.955 font ',17' tc '#111111' noenhanced\n"
            "set label 2 'solid fraction %.3f, %u spheres emit",
            conduction->solid_fraction, conduction->emitters);
    if (!isnan(conduction->temperature)) fprintf(script, ", %.5g K", conduction->temperature);
    fprintf(
        script,
        "' at screen 0.03,0.905 tc '#444444'\n"
        "set tmargin at screen 0.86; set bmargin at screen 0.13\n"
        "set ylabel 'exchange factor F_E, and twice its standard error'; set grid y; set key %s\n"
        "set xrange [-0.6:%g]; set yrange [0:*]; set offsets 0,0,graph 0.12,0; set boxwidth 0.5; set xtics noenhanced\n"
        "plot $axes using 1:2:xtic(6) with boxes fc '#365c8d' fs solid 0.8 noborder title 'linear field', "
        "'' using 1:2:3 with yerrorbars pt 0 lw 2 lc '#222222' notitle%s\n",
        between ? "top right" : "off", axes - 0.4,
        between ? ", '' using 1:4:5 with yerrorbars pt 7 ps 1.2 lw 2 lc '#d1495b' title 'between two plates'" : "");
    return gnuplot_end(&gnuplot);
}
