/* plot_heat.c - pictures of temperatures and powers, also in time, by gnuplot. SPDX-License-Identifier: MIT */
#include "plot/plot_heat.h"

#include <math.h>
#include <stdlib.h>

#include "bed/units.h"
#include "cli/message.h"
#include "plot/gnuplot.h"
#include "text/read_number.h"

/* The least and largest number of an array. NaN are left out. */
struct extremes {
    double low, high;
};

static struct extremes extremes_of(const double *value, uint32_t n) {
    struct extremes all = {INFINITY, -INFINITY};
    for (uint32_t i = 0; i < n; ++i) all.low = fmin(all.low, value[i]), all.high = fmax(all.high, value[i]);
    return all;
}

/* Whether numbers differ by more than rounding. */
static bool varies(const double *value, uint32_t n) {
    const struct extremes all = extremes_of(value, n);
    return all.high - all.low > 1e-6 * fmax(fabs(all.low), fabs(all.high));
}

/* Begins a picture of two panels. */
static void print_title(FILE *script, const struct output *output, const char *name) {
    gnuplot_style(script, output->path, 1500, 700);
    fputs("set multiplot layout 1,2 margins 0.075,0.89,0.14,0.84 spacing 0.16\nset label 1 '", script);
    gnuplot_name(script, name);
    fputs("' at screen 0.015,0.955 font ',19' tc '#111111' noenhanced\n", script);
}

static void print_head(FILE *script, const struct output *output, const char *name, const struct contents *what) {
    const struct extremes kelvins = extremes_of(what->result->temperature, what->bed->n);
    double net = 0, light = 0, conducted = 0;
    for (uint32_t i = 0; i < what->bed->n; ++i) net += what->result->power[i];
    for (uint32_t i = 0; i < what->bed->n && what->result->conducted; ++i) conducted += what->result->conducted[i];
    for (uint32_t i = 0; i < what->bed->n && what->light; ++i) light += what->light->absorbed[i];
    const struct prefixed unit = unit_prefixed(fabs(net), "W"), unit_of_light = unit_prefixed(light, "W");
    print_title(script, output, name);
    fprintf(script, "set label 2 '%u spheres of %.5g to %.5g K %s %.4g %s", what->bed->n, kelvins.low, kelvins.high,
            net >= 0 ? "gain" : "lose", fabs(net) / unit.scale, unit.name);
    if (what->result->conducted)
        fprintf(script, ": %.4g %s by radiation, %.4g %s by conduction",
                (net >= 0 ? 1 : -1) * (net - conducted) / unit.scale, unit.name,
                (net >= 0 ? 1 : -1) * conducted / unit.scale, unit.name);
    if (what->light) fprintf(script, "; they absorb %.4g %s of light", light / unit_of_light.scale, unit_of_light.name);
    fputs("' at screen 0.015,0.905 tc '#444444'\n", script);
}

/* The end of the colour scale. One sphere of fifty exceeds this power. So a few large powers do not make all other
 * spheres grey. 0: out of memory. */
static double power_shown(const double *value, uint32_t n) {
    double *power = malloc(n * sizeof *power);
    if (!power) return 0;
    for (uint32_t i = 0; i < n; ++i) power[i] = fabs(value[i]);
    qsort(power, n, sizeof *power, number_order);
    double most = power[(n - 1) * (uint64_t)49 / 50];
    if (!(most > 0)) most = power[n - 1];
    free(power);
    return most > 0 ? most : 1;
}

/* What a slice shows. */
enum shown { TEMPERATURE, LIGHT, POWER, QUANTITIES };

/* Draws a slice. Spheres are coloured by a quantity, and walls by their temperatures if that is it. */
static int print_panel(FILE *script, enum shown shown, const struct plot_slice *slice, const struct contents *what) {
    static const char *const title[] = {"Temperature", "Absorbed light", "Net power"};
    static const char *const palette[] = {
        "(0 '#000004', 1 '#3b0f70', 2 '#8c2981', 3 '#de4968', 4 '#fe9f6d', 5 '#fcfdbf')",
        "(0 '#1c1c3a', 1 '#7a3b69', 2 '#d9704f', 3 '#f6c25b', 4 '#fffbe0')",
        "(0 '#3a6ea5', 0.5 '#e9e9e9', 1 '#c8553d')"};
    const double *const value[] = {what->result->temperature, what->light ? what->light->absorbed : NULL,
                                   what->result->power};
    const double most = shown == TEMPERATURE ? 1 : power_shown(value[shown], what->bed->n);
    const struct prefixed unit = unit_prefixed(shown == TEMPERATURE ? 0 : most, shown == TEMPERATURE ? "K" : "W");
    const struct plot_colours colours = {.value = value[shown],
                                         .unit = unit.scale,
                                         .wall_value = shown == TEMPERATURE ? what->result->wall_temperature : NULL};
    if (!(most > 0)) return message_memory();
    fprintf(script, "set palette defined %s\nset title '%s [%s], slice at %s'\nset format cb '%%.4g'; ", palette[shown],
            title[shown], unit.name, slice->place);
    if (shown == TEMPERATURE)
        fputs("set cbrange [*:*]\n", script);
    else
        fprintf(script, "set cbrange [%.3g:%.3g]\n", shown == POWER ? -most / unit.scale : 0, most / unit.scale);
    plot_slice_draw(script, slice, &colours);
    fputs("unset label 1; unset label 2; set format cb '%h'\n", script);
    return STATUS_OK;
}

int plot_heat(const struct output *output, const char *name, const struct contents *what,
              const struct plot_plane *plane) {
    const uint32_t n = what->bed->n;
    const bool shows[QUANTITIES] = {varies(what->result->temperature, n),
                                    what->light && varies(what->light->absorbed, n), varies(what->result->power, n)};
    enum shown shown[QUANTITIES];
    struct gnuplot gnuplot;
    struct plot_slice slice, second;
    int count = 0, status = gnuplot_start(&gnuplot, output);
    if (status) return status;
    for (enum shown k = TEMPERATURE; k < QUANTITIES; ++k)
        if (shows[k]) shown[count++] = k;
    if (count == 0) shown[count++] = TEMPERATURE, shown[count++] = POWER;
    plot_slice_of(&slice, plane, what->bed, what->walls);
    second = slice;
    if (count == 1)
        plot_slice_of(&second, &(struct plot_plane){.axis = slice.across == 1 ? 'x' : 'y'}, what->bed, what->walls);
    print_head(gnuplot.script, output, name, what);
    status = print_panel(gnuplot.script, shown[0], &slice, what);
    if (!status) status = print_panel(gnuplot.script, shown[count > 1], &second, what);
    fputs("unset multiplot\n", gnuplot.script);
    const int drawn = gnuplot_end(&gnuplot);
    return status ? status : drawn;
}

/* Draws temperatures over time. */
static void print_times(FILE *script, const struct time_point *point, size_t points) {
    const struct prefixed unit = unit_seconds(point[points - 1].time);
    fputs("$time << END\n", script);
    for (size_t k = 0; k < points; ++k)
        fprintf(script, "%.9g %.9g %.9g %.9g %.9g\n", point[k].time / unit.scale, point[k].mean, point[k].least,
                point[k].most, point[k].outlet);
    fprintf(script,
            "END\n"
            "set xlabel 'time [%s]'; set ylabel 'temperature [K]'; set grid; set key top right\n"
            "set xrange [0:%.9g]\n"
            "plot $time using 1:3:4 with filledcurves fc '#c8553d' fs transparent solid 0.25 noborder "
            "title 'coldest to hottest', "
            "'' using 1:3 with lines lw 1 lc '#c8553d' notitle, '' using 1:4 with lines lw 1 lc '#c8553d' notitle, "
            "'' using 1:2 with lines lw 3 lc '#222222' title 'mean'%s\n",
            unit.name, point[points - 1].time / unit.scale,
            isnan(point[points - 1].outlet) ? ""
                                            : ", '' using 1:5 with lines lw 3 lc '#2a6f97' title 'gas at the outlet'");
}

int plot_time(const struct output *output, const char *name, const struct time_point *point, size_t points,
              const struct contents *what, const struct plot_plane *plane) {
    const struct time_point *end = &point[points - 1];
    const struct prefixed unit = unit_seconds(end->time);
    struct gnuplot gnuplot;
    struct plot_slice slice;
    const int status = gnuplot_start(&gnuplot, output);
    if (status) return status;
    plot_slice_of(&slice, plane, what->bed, what->walls);
    print_title(gnuplot.script, output, name);
    fprintf(gnuplot.script,
            "set label 2 '%u spheres of %.5g to %.5g K after %.4g %s' at screen 0.015,0.905 tc '#444444'\n",
            what->bed->n, end->least, end->most, end->time / unit.scale, unit.name);
    print_times(gnuplot.script, point, points);
    fputs("set autoscale x; unset label 1; unset label 2\n", gnuplot.script);
    print_panel(gnuplot.script, TEMPERATURE, &slice, what);
    fputs("unset multiplot\n", gnuplot.script);
    return gnuplot_end(&gnuplot);
}
