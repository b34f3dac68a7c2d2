/* plot_furnace.c - a picture of the fields in the centre plane of a box, by gnuplot. SPDX-License-Identifier: MIT */
#include "papers/furnace/furnace.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "plot/gnuplot.h"

/* A map of the centre plane. Values are at centres of cells, or of faces across axis x or z. */
struct map {
    const double *values;
    int axis; /* of the faces; -1: cells */
    bool temperature;
    const char *title;
    double contour; /* distance of contour lines */
};

/* The mean over the two cells next to the plane y = Y/2. */
static double furnace_plane_mean(const struct furnace_run *run, const struct map *map, size_t i, size_t k) {
    const uint32_t *n = run->config.cells;
    size_t across = n[0] + (map->axis == 0 ? 1u : 0u);
    double value = 0;
    for (uint32_t j = 0; j < 2; j++) {
        size_t place = i + across * ((n[1] - 1 + j) / 2 + (size_t)n[1] * k);
        value += (map->temperature ? fibrad_furnace_temperature(map->values[place]) : 1 / map->values[place]) / 2;
    }
    return value;
}

static void furnace_print_map(FILE *script, const struct furnace_run *run, const struct map *map) {
    const fibrad_furnace_config *c = &run->config;
    uint32_t across = c->cells[0] + (map->axis == 0), up = c->cells[2] + (map->axis == 2);
    double low = furnace_plane_mean(run, map, 0, 0), high = low;
    fputs("$map << END\n", script);
    for (uint32_t k = 0; k < up; k++) {
        for (uint32_t i = 0; i < across; i++) {
            double value = furnace_plane_mean(run, map, i, k);
            fprintf(script, "%.6g %.6g %.6g\n", (i + (map->axis == 0 ? 0 : 0.5)) * c->size[0] / c->cells[0],
                    (k + (map->axis == 2 ? 0 : 0.5)) * c->size[2] / c->cells[2], value);
            low = fmin(low, value);
            high = fmax(high, value);
        }
        fputc('\n', script);
    }
    double first = ceil(low / map->contour) * map->contour;
    fprintf(script,
            "END\n"
            "set cbrange [%g:%g]; set title \"%s\"\n"
            "set contour base; unset surface; set cntrparam levels incremental %g,%g,%g; set cntrlabel onecolor\n"
            "set table $lines; splot $map using 1:2:3; unset table\n"
            "unset contour; set surface\n"
            "plot $map using 1:2:3 with image pixels notitle, $lines using 1:2 with lines lw 1.1 lc '#ffffff' notitle, "
            "$lines using 1:2:3 every 40::15 with labels font ',9' tc '#ffffff' notitle\n",
            low, high, map->title, first, map->contour, high);
}

/* A round number near half the range of T on the axis. */
static double furnace_tic_interval(const struct furnace_run *run) {
    double low = furnace_axis_temperature(run, 0), high = low;
    for (int k = 1; k <= 20; k++) {
        double t = furnace_axis_temperature(run, run->config.size[2] * k / 20);
        low = fmin(low, t);
        high = fmax(high, t);
    }
    double half = fmax((high - low) / 2, 1e-3), power = pow(10, floor(log10(half)));
    return power * (half < 2 * power ? 1 : half < 5 * power ? 2 : 5);
}

static void furnace_print_profile(FILE *script, const struct furnace_run *run, int number) {
    const fibrad_furnace_config *c = &run->config;
    fputs("$axis << END\n", script);
    for (int k = 0; k <= 200; k++) {
        double z = c->size[2] * (0.5 / c->cells[2] + (1 - 1.0 / c->cells[2]) * k / 200);
        fprintf(script, "%.6g %.6g\n", furnace_axis_temperature(run, z), z);
    }
    fputs("END\n$reference << END\n", script);
    for (int k = 0; number && k < FURNACE_REFERENCES; k++)
        fprintf(script, "%.6g %.6g\n", furnace_reference(number, k), furnace_reference_z[k]);
    fprintf(script,
            "END\n"
            "set title \"T on the axis [K]\"; set xrange [*:*]; set xtics %g; set xlabel 'T [K]'; unset ylabel\n"
            "set size ratio %g; unset colorbox; set grid lc '#e6e6e6' lw 1 lt 1; set key bottom left reverse Left "
            "samplen 2\n"
            "plot $axis using 1:2 with lines lw 2.5 lc '#365c8d' title 'this run'%s\n",
            furnace_tic_interval(run), c->size[2] / c->size[0],
            number ? ", $reference using 1:2 with points pt 6 ps 1.1 lw 1.6 lc '#d1495b' title 'reference'" : "");
}

int furnace_plot(const struct output *output, const char *name, const struct furnace_run *run, bool measured,
                 int number) {
    const fibrad_furnace_config *c = &run->config;
    const struct map maps[] = {
        {run->at.e, -1, true, "T [K]", 25},
        {run->at.theta[2][0], 2, false, "1/{/Symbol Q}_z^+", 0.02},
        {run->at.theta[2][1], 2, false, "1/{/Symbol Q}_z^-", 0.02},
        {run->at.theta[0][0], 0, false, "1/{/Symbol Q}_x^+", 0.02},
    };
    size_t count = measured ? 4 : 1, length = strlen(output->path);
    bool png = length > 4 && strcmp(output->path + length - 4, ".png") == 0;
    struct gnuplot gnuplot;
    int status = gnuplot_start(&gnuplot, output);
    if (status) return status;
    FILE *script = gnuplot.script;
    fprintf(script,
            "set terminal %s size %zu,%.0f font 'DejaVu Sans,%d' background '#ffffff'\n"
            "set border lc '#555555'; set tics nomirror out scale 0.6 tc '#333333'\n" GNUPLOT_PALETTE
            "set multiplot layout 1,%zu margins screen %g,0.985,0.12,0.86 spacing screen %g,0\n"
            "set xrange [0:%g]; set yrange [0:%g]; set size ratio -1\n"
            "set xlabel 'x [m]'; set ylabel 'z [m]' offset 1; set colorbox; set cbtics font ',9'\n",
            png ? "pngcairo" : "svg", 300 * (count + 1) + 60, 140 + 205 * fmin(c->size[2] / c->size[0], 6),
            png ? 11 : 13, count + 1, 0.2 / (double)(count + 1), 0.38 / (double)(count + 1), c->size[0], c->size[2]);
    fputs("set label 1 '", script);
    gnuplot_name(script, name);
    fprintf(script, ", plane y = %g m' at screen 0.012,0.968 font ',15' tc '#111111' noenhanced\n", c->size[1] / 2);
    for (size_t m = 0; m < count; m++) {
        furnace_print_map(script, run, &maps[m]);
        fputs("unset label 1; unset ylabel\n", script);
    }
    furnace_print_profile(script, run, number);
    fputs("unset multiplot\n", script);
    return gnuplot_end(&gnuplot);
}
