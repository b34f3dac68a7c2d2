/* plot_heat.c - a picture of temperatures and net radiative powers, by gnuplot. SPDX-License-Identifier: MIT */
#include "plot/plot_heat.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "cli/message.h"
#include "plot/gnuplot.h"
#include "plot/plot_slice.h"

enum { LAYERS_MAX = 60 };

/* Colours of heat gained and lost. */
#define GAINED "c8553d"
#define LOST   "3a6ea5"

/* Sums over the spheres that gain heat and over those that lose heat. */
struct turnover {
    double gained, lost; /* [W] both >= 0 */
};

static struct turnover turnover_of(const struct heat_shown *what) {
    struct turnover all = {0, 0};
    for (uint32_t i = 0; i < what->bed->n; ++i) {
        all.gained += fmax(what->power[i], 0);
        all.lost += fmax(-what->power[i], 0);
    }
    return all;
}

static void print_head(FILE *script, const struct output *output, const char *name, const struct heat_shown *what) {
    double low = INFINITY, high = -INFINITY;
    for (uint32_t i = 0; i < what->bed->n; ++i) {
        low = fmin(low, what->temperature[i]);
        high = fmax(high, what->temperature[i]);
    }
    const struct turnover all = turnover_of(what);
    gnuplot_style(script, output->path, 1500, 1240);
    fputs("set multiplot layout 2,2 margins 0.075,0.89,0.065,0.90 spacing 0.16,0.115\n"
          "set label 1 '",
          script);
    gnuplot_name(script, name);
    fprintf(script,
            "' at screen 0.015,0.975 font ',19' tc '#111111' noenhanced\n"
            "set label 2 '%u spheres of %.5g to %.5g K %s %.4g W by radiation' at screen 0.015,0.945 tc '#444444'\n",
            what->bed->n, low, high, all.gained >= all.lost ? "gain" : "lose", fabs(all.gained - all.lost));
}

/* Draws the slice. Spheres and walls are coloured by their temperatures. */
static void print_temperatures(FILE *script, const struct plot_slice *slice, const struct heat_shown *what) {
    fprintf(script,
            "set palette defined (0 '#000004', 1 '#3b0f70', 2 '#8c2981', 3 '#de4968', 4 '#fe9f6d', 5 '#fcfdbf')\n"
            "set title 'Temperature [K], slice at y = %s'; set cbrange [*:*]\n",
            slice->place);
    plot_slice_draw(script, slice, what->temperature, NULL, what->wall_temperature);
    fputs("unset label 1; unset label 2\n", script);
}

static int ascending_sizes(const void *a, const void *b) {
    const double x = fabs(*(const double *)a), y = fabs(*(const double *)b);
    return (x > y) - (x < y);
}

/* The end of the colour scale. One sphere of fifty exceeds this power. So a few large powers do not make all other
 * spheres grey. 0: out of memory. */
static double power_shown(const struct heat_shown *what) {
    const uint32_t n = what->bed->n;
    double *power = malloc(n * sizeof *power);
    if (!power) return 0;
    for (uint32_t i = 0; i < n; ++i) power[i] = what->power[i];
    qsort(power, n, sizeof *power, ascending_sizes);
    double most = fabs(power[(n - 1) * (uint64_t)49 / 50]);
    if (!(most > 0)) most = fabs(power[n - 1]);
    free(power);
    return most > 0 ? most : 1;
}

static int print_powers(FILE *script, const struct plot_slice *slice, const struct heat_shown *what) {
    const double most = power_shown(what);
    if (!(most > 0)) return message_memory();
    fprintf(script,
            "set palette defined (0 '#" LOST "', 0.5 '#e9e9e9', 1 '#" GAINED "')\n"
            "set title 'Net power [W], slice at y = %s'; set cbrange [%.3g:%.3g]; set format cb '%%.3g'\n",
            slice->place, -most, most);
    plot_slice_draw(script, slice, what->power, NULL, NULL);
    fputs("set format cb '%h'\n", script);
    return STATUS_OK;
}

/* Layers of the bed across z, about one mean diameter thick. */
struct layers {
    int n;
    double low, high, thick;
};

static struct layers layers_of(const struct bed *bed) {
    double diameter = 0;
    struct layers layers = {.low = INFINITY, .high = -INFINITY};
    for (uint32_t i = 0; i < bed->n; ++i) {
        diameter += 2 * bed->r[i] / bed->n;
        layers.low = fmin(layers.low, bed->z[i] - bed->r[i]);
        layers.high = fmax(layers.high, bed->z[i] + bed->r[i]);
    }
    layers.n = (int)fmin(LAYERS_MAX, fmax(1, floor((layers.high - layers.low) / diameter)));
    layers.thick = (layers.high - layers.low) / layers.n;
    return layers;
}

static int layer_at(const struct layers *layers, double z) {
    return (int)fmin(layers->n - 1, floor((z - layers->low) / layers->thick));
}

/* Draws gains and losses of layers, and their sums. */
static void print_layers(FILE *script, const struct plot_slice *slice, const struct heat_shown *what) {
    const struct bed *bed = what->bed;
    const struct layers layers = layers_of(bed);
    struct turnover layer[LAYERS_MAX] = {{0, 0}};
    for (uint32_t i = 0; i < bed->n; ++i) {
        const int k = layer_at(&layers, bed->z[i]);
        layer[k].gained += fmax(what->power[i], 0);
        layer[k].lost += fmax(-what->power[i], 0);
    }
    fputs("$layers << END\n", script);
    for (int k = 0; k < layers.n; ++k)
        fprintf(script, "%.6g %.6g %.6g %.6g\n", (layers.low + (k + 0.5) * layers.thick) / slice->scale,
                layer[k].gained, -layer[k].lost, layer[k].gained - layer[k].lost);
    fprintf(script,
            "END\n"
            "set title 'Net power by height, layers of %.3g %s'\n"
            "set xlabel 'power of a layer [W]: red gained, blue lost, line both'; set ylabel 'z%s%s%s'; unset "
            "colorbox; set grid\n"
            "set xrange [*:*]; set yrange [%.9g:%.9g]; set xtics auto; set yzeroaxis lt 1 lc '#555555'\n"
            "unset key\n"
            "half = %.9g\n"
            "plot $layers using ($2/2):1:($2/2):(half) with boxxyerror fc '#" GAINED "' fs solid 0.8 noborder, "
            "'' using ($3/2):1:($3/2):(half) with boxxyerror fc '#" LOST "' fs solid 0.8 noborder, "
            "'' using 4:1 with linespoints lw 2 pt 7 ps 0.6 lc '#222222'\n",
            layers.thick / slice->scale, slice->unit, slice->unit[0] ? " [" : "", slice->unit,
            slice->unit[0] ? "]" : "", layers.low / slice->scale, layers.high / slice->scale,
            0.46 * layers.thick / slice->scale);
}

/* Draws mean, least and largest temperature of each layer. */
static void print_profile(FILE *script, const struct plot_slice *slice, const struct heat_shown *what) {
    const struct bed *bed = what->bed;
    const struct layers layers = layers_of(bed);
    struct {
        double sum, least, most;
        uint32_t n;
    } layer[LAYERS_MAX];
    for (int k = 0; k < layers.n; ++k)
        layer[k].sum = layer[k].n = 0, layer[k].least = INFINITY, layer[k].most = -INFINITY;
    for (uint32_t i = 0; i < bed->n; ++i) {
        const int k = layer_at(&layers, bed->z[i]);
        if (isnan(what->temperature[i])) continue; /* emissivity 0: no temperature */
        layer[k].sum += what->temperature[i];
        layer[k].least = fmin(layer[k].least, what->temperature[i]);
        layer[k].most = fmax(layer[k].most, what->temperature[i]);
        ++layer[k].n;
    }
    fputs("$layers << END\n", script);
    for (int k = 0; k < layers.n; ++k)
        if (layer[k].n > 0)
            fprintf(script, "%.6g %.6g %.6g %.6g\n", (layers.low + (k + 0.5) * layers.thick) / slice->scale,
                    layer[k].sum / layer[k].n, layer[k].least, layer[k].most);
    fputs("NaN NaN NaN NaN\nEND\n", script);
    fprintf(script,
            "set title 'Temperature by height, layers of %.3g %s'\n"
            "set xlabel 'temperature [K]: mean of a layer, coldest and hottest'; set ylabel 'z%s%s%s'; unset "
            "colorbox; set grid\n"
            "set xrange [*:*]; set yrange [%.9g:%.9g]; set xtics auto; unset key\n"
            "plot $layers using 3:1:3:4 with xerrorbars pt 0 lw 4 lc '#e3b7ab', "
            "'' using 2:1 with linespoints lw 2 pt 7 ps 0.6 lc '#" GAINED "'\n",
            layers.thick / slice->scale, slice->unit, slice->unit[0] ? " [" : "", slice->unit,
            slice->unit[0] ? "]" : "", layers.low / slice->scale, layers.high / slice->scale);
}

/* Prints a bar: its name, temperature (NaN: none) and power. `between` stands between name and temperature. */
static void print_bar(FILE *script, int at, const char *what, const char *between, double temperature, double power) {
    if (isnan(temperature))
        fprintf(script, "%d %.6g \"%s\"\n", at, power, what);
    else
        fprintf(script, "%d %.6g \"%s%s%.5g K\"\n", at, power, what, between, temperature);
}

/* Draws a bar for spheres, each wall and the surroundings. If there are many bars, their names are rotated. */
static void print_bars(FILE *script, const struct heat_shown *what) {
    const struct turnover all = turnover_of(what);
    const bool open = !isnan(what->surroundings_power), many = what->walls->count + open > 4;
    const char *between = many ? ", " : "\\n";
    int bars = 0;
    fputs("$bars << END\n", script);
    print_bar(script, bars++, many ? "spheres that gain" : "spheres\\nthat gain", between, NAN, all.gained);
    print_bar(script, bars++, many ? "spheres that lose" : "spheres\\nthat lose", between, NAN, -all.lost);
    for (uint32_t k = 0; k < what->walls->count; ++k)
        print_bar(script, bars++, wall_name(what->walls, k), between, what->wall_temperature[k], what->wall_power[k]);
    if (open)
        print_bar(script, bars++, "surroundings", between, what->surroundings_temperature, what->surroundings_power);
    fprintf(script,
            "END\n"
            "set title 'Where the heat goes: gained above, lost below [W]'\n"
            "unset xlabel; set ylabel 'net power [W]'; unset yzeroaxis\n"
            "set xtics scale 0 font ',%d' noenhanced %s\n%s"
            "set xrange [-0.6:%g]; set yrange [*:*]; set ytics auto; set offsets 0,0,graph 0.08,graph 0.08\n"
            "set boxwidth 0.7; set xzeroaxis lt 1 lc '#555555'; unset key\n"
            "plot $bars using 1:2:($2 < 0 ? 0x" LOST " : 0x" GAINED
            "):xtic(3) with boxes fs solid 0.85 noborder lc rgb variable, "
            "'' using 1:($2 < 0 ? NaN : $2):(sprintf('%%.3g', $2)) with labels offset 0,0.6 tc '#222222', "
            "'' using 1:($2 < 0 ? $2 : NaN):(sprintf('%%.3g', $2)) with labels offset 0,-0.7 tc '#222222'\n"
            "unset multiplot\n",
            bars > 16 ? 9
            : many    ? 11
                      : 12,
            many ? "rotate by 40 right" : "", many ? "set bmargin at screen 0.135\n" : "", bars - 0.4);
}

int plot_heat(const struct output *output, const char *name, const struct heat_shown *what) {
    struct gnuplot gnuplot;
    struct plot_slice slice;
    int status = gnuplot_start(&gnuplot, output);
    if (status) return status;
    plot_slice_of(&slice, what->bed, what->walls, what->metres);
    print_head(gnuplot.script, output, name, what);
    print_temperatures(gnuplot.script, &slice, what);
    status = print_powers(gnuplot.script, &slice, what);
    if (what->found)
        print_profile(gnuplot.script, &slice, what);
    else
        print_layers(gnuplot.script, &slice, what);
    print_bars(gnuplot.script, what);
    const int drawn = gnuplot_end(&gnuplot);
    return status ? status : drawn;
}
