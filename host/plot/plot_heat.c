/* plot_heat.c - a picture of temperatures and net radiative powers, by gnuplot. SPDX-License-Identifier: MIT */
#include "plot/plot_heat.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "bed/units.h"
#include "cli/message.h"
#include "plot/gnuplot.h"
#include "simple/cylinder.h"

enum { LAYERS_MAX = 60 };

/* Colours of heat gained and lost. */
#define GAINED "c8553d"
#define LOST   "3a6ea5"

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

/* Whether temperatures of spheres were found. The picture then has them by height, not powers. */
static bool any_found(const struct contents *what) {
    bool found = false;
    for (uint32_t i = 0; i < what->bed->n; ++i)
        found = found || (isnan(what->sources->temperature[i]) && !isnan(what->result->temperature[i]));
    return found;
}

/* Sums over the spheres that gain heat and over those that lose heat. */
struct turnover {
    double gained, lost; /* [W] both >= 0 */
};

static struct turnover turnover_of(const struct contents *what) {
    struct turnover all = {0, 0};
    for (uint32_t i = 0; i < what->bed->n; ++i) {
        all.gained += fmax(what->result->power[i], 0);
        all.lost += fmax(-what->result->power[i], 0);
    }
    return all;
}

static void print_head(FILE *script, const struct output *output, const char *name, const struct contents *what) {
    const struct extremes kelvins = extremes_of(what->result->temperature, what->bed->n);
    const struct turnover all = turnover_of(what);
    const double net = all.gained - all.lost;
    const struct prefixed unit = unit_prefixed(fabs(net), "W");
    double light = 0;
    for (uint32_t i = 0; i < what->bed->n && what->light; ++i) light += what->light->absorbed[i];
    const struct prefixed unit_of_light = unit_prefixed(light, "W");
    gnuplot_style(script, output->path, 1500, 1240);
    fputs("set multiplot layout 2,2 margins 0.075,0.89,0.065,0.90 spacing 0.16,0.115\n"
          "set label 1 '",
          script);
    gnuplot_name(script, name);
    fprintf(script,
            "' at screen 0.015,0.975 font ',19' tc '#111111' noenhanced\n"
            "set label 2 '%u spheres of %.5g to %.5g K %s %.4g %s by radiation",
            what->bed->n, kelvins.low, kelvins.high, net >= 0 ? "gain" : "lose", fabs(net) / unit.scale, unit.name);
    if (what->light) fprintf(script, "; they absorb %.4g %s of light", light / unit_of_light.scale, unit_of_light.name);
    fputs("' at screen 0.015,0.945 tc '#444444'\n", script);
}

static int ascending_sizes(const void *a, const void *b) {
    const double x = fabs(*(const double *)a), y = fabs(*(const double *)b);
    return (x > y) - (x < y);
}

/* The end of the colour scale. One sphere of fifty exceeds this power. So a few large powers do not make all other
 * spheres grey. 0: out of memory. */
static double power_shown(const double *value, uint32_t n) {
    double *power = malloc(n * sizeof *power);
    if (!power) return 0;
    for (uint32_t i = 0; i < n; ++i) power[i] = value[i];
    qsort(power, n, sizeof *power, ascending_sizes);
    double most = fabs(power[(n - 1) * (uint64_t)49 / 50]);
    if (!(most > 0)) most = fabs(power[n - 1]);
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
        "(0 '#" LOST "', 0.5 '#e9e9e9', 1 '#" GAINED "')"};
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

/* Layers of the bed across z, about one mean diameter thick, or rings about the axis of a cylinder, half as thick. */
struct layers {
    const struct bed *bed;
    const fibrad_wall *tube; /* the cylinder of rings; NULL: layers */
    int n;
    double low, high, thick;
};

static struct layers layers_of(const struct bed *bed, const fibrad_wall *tube) {
    struct layers layers = {.bed = bed, .tube = tube};
    double diameter = 0;
    for (uint32_t i = 0; i < bed->n; ++i) diameter += 2 * bed->r[i] / bed->n;
    layers.low = tube ? 0 : bed_reach(bed, 2, false);
    layers.high = tube ? tube->cylinder.radius : bed_reach(bed, 2, true);
    layers.n = (int)fmin(LAYERS_MAX, fmax(1, floor((layers.high - layers.low) / (tube ? diameter / 2 : diameter))));
    layers.thick = (layers.high - layers.low) / layers.n;
    return layers;
}

static int layer_of(const struct layers *layers, uint32_t i) {
    const struct bed *bed = layers->bed;
    const fibrad_wall *tube = layers->tube;
    const double at[3] = {bed->x[i], bed->y[i], bed->z[i]}, place = tube ? cylinder_distance(tube, at) : at[2];
    return (int)fmin(layers->n - 1, floor((place - layers->low) / layers->thick));
}

/* Prints the title of a panel with its layers, and the label and range of the axis along which they lie. */
static void print_layers_axis(FILE *script, const struct layers *layers, const char *what, char axis, const char *label,
                              const struct plot_slice *slice) {
    const double scale = slice->scale;
    const char *unit = slice->unit;
    fprintf(script,
            "set title '%s, %s of %.3g %s'\nset %clabel '%s%s%s%s'; set %crange [%.9g:%.9g]\n"
            "unset colorbox; set grid; set xtics auto; set ytics auto; unset key\n",
            what, layers->tube ? "rings" : "layers", layers->thick / scale, unit, axis, label, *unit ? " [" : "", unit,
            *unit ? "]" : "", axis, layers->low / scale, layers->high / scale);
}

/* Draws gains and losses of layers, and their sums. */
static void print_layers(FILE *script, const struct plot_slice *slice, const struct contents *what) {
    const struct layers layers = layers_of(what->bed, NULL);
    struct turnover layer[LAYERS_MAX] = {{0, 0}};
    double most = 0;
    for (uint32_t i = 0; i < what->bed->n; ++i) {
        const int k = layer_of(&layers, i);
        layer[k].gained += fmax(what->result->power[i], 0);
        layer[k].lost += fmax(-what->result->power[i], 0);
    }
    for (int k = 0; k < layers.n; ++k) most = fmax(most, fmax(layer[k].gained, layer[k].lost));
    const struct prefixed unit = unit_prefixed(most, "W");
    fputs("$layers << END\n", script);
    for (int k = 0; k < layers.n; ++k)
        fprintf(script, "%.6g %.6g %.6g %.6g\n", (layers.low + (k + 0.5) * layers.thick) / slice->scale,
                layer[k].gained / unit.scale, -layer[k].lost / unit.scale,
                (layer[k].gained - layer[k].lost) / unit.scale);
    fputs("END\n", script);
    print_layers_axis(script, &layers, "Net power by height", 'y', "z", slice);
    fprintf(script,
            "set xlabel 'power of a layer [%s]: red gained, blue lost, line both'\n"
            "set xrange [*:*]; set yzeroaxis lt 1 lc '#555555'\n"
            "half = %.9g\n"
            "plot $layers using ($2/2):1:($2/2):(half) with boxxyerror fc '#" GAINED "' fs solid 0.8 noborder, "
            "'' using ($3/2):1:($3/2):(half) with boxxyerror fc '#" LOST "' fs solid 0.8 noborder, "
            "'' using 4:1 with linespoints lw 2 pt 7 ps 0.6 lc '#222222'\n",
            unit.name, 0.46 * layers.thick / slice->scale);
}

/* Draws mean, least and largest temperature of each layer, or of each ring within a tube. */
static void print_profile(FILE *script, const struct plot_slice *slice, const struct contents *what,
                          const fibrad_wall *tube) {
    const struct layers layers = layers_of(what->bed, tube);
    struct {
        double sum, least, most;
        uint32_t n;
    } layer[LAYERS_MAX];
    for (int k = 0; k < layers.n; ++k)
        layer[k].sum = layer[k].n = 0, layer[k].least = INFINITY, layer[k].most = -INFINITY;
    for (uint32_t i = 0; i < what->bed->n; ++i) {
        const int k = layer_of(&layers, i);
        if (isnan(what->result->temperature[i])) continue; /* emissivity 0: no temperature */
        layer[k].sum += what->result->temperature[i];
        layer[k].least = fmin(layer[k].least, what->result->temperature[i]);
        layer[k].most = fmax(layer[k].most, what->result->temperature[i]);
        ++layer[k].n;
    }
    fputs("$layers << END\n", script);
    for (int k = 0; k < layers.n; ++k)
        if (layer[k].n > 0)
            fprintf(script, "%.6g %.6g %.6g %.6g\n", (layers.low + (k + 0.5) * layers.thick) / slice->scale,
                    layer[k].sum / layer[k].n, layer[k].least, layer[k].most);
    fputs("NaN NaN NaN NaN\nEND\n", script);
    print_layers_axis(script, &layers, tube ? "Temperature by radius" : "Temperature by height", tube ? 'x' : 'y',
                      tube ? "distance from the axis" : "z", slice);
    const char *across = tube ? "y" : "x";
    fprintf(script,
            "set %slabel 'temperature [K]: %s'; set %srange [*:*]\n"
            "plot $layers using %s:3:4 with %serrorbars pt 0 lw 4 lc '#e3b7ab', "
            "'' using %s with linespoints lw 2 pt 7 ps 0.6 lc '#" GAINED "'\n",
            across, tube ? "mean, coldest, hottest" : "mean of a layer, coldest and hottest", across,
            tube ? "1:3" : "3:1", across, tube ? "1:2" : "2:1");
}

/* Prints a bar: its name, temperature (NaN: none) and power in the unit of the panel, where 1e-6 is nothing. `between`
 * stands between name and temperature. */
static void print_bar(FILE *script, int at, const char *what, const char *between, double temperature, double power) {
    if (fabs(power) < 1e-6) power = 0; /* also -0 */
    if (isnan(temperature))
        fprintf(script, "%d %.6g \"%s\"\n", at, power, what);
    else
        fprintf(script, "%d %.6g \"%s%s%.5g K\"\n", at, power, what, between, temperature);
}

/* Draws a bar for spheres, each wall and the surroundings. If there are many bars, their names are rotated. */
static void print_bars(FILE *script, const struct contents *what) {
    const struct turnover all = turnover_of(what);
    const bool open = !isnan(what->sources->surroundings), many = what->walls->count + open > 4;
    const char *between = many ? ", " : "\\n";
    double most = fmax(fmax(all.gained, all.lost), open ? fabs(what->result->surroundings_power) : 0);
    int bars = 0;
    for (uint32_t k = 0; k < what->walls->count; ++k) most = fmax(most, fabs(what->result->wall_power[k]));
    const struct prefixed unit = unit_prefixed(most, "W");
    fputs("$bars << END\n", script);
    print_bar(script, bars++, many ? "spheres that gain" : "spheres\\nthat gain", between, NAN,
              all.gained / unit.scale);
    print_bar(script, bars++, many ? "spheres that lose" : "spheres\\nthat lose", between, NAN, -all.lost / unit.scale);
    for (uint32_t k = 0; k < what->walls->count; ++k)
        print_bar(script, bars++, wall_name(what->walls, k), between, what->result->wall_temperature[k],
                  what->result->wall_power[k] / unit.scale);
    if (open)
        print_bar(script, bars++, "surroundings", between, what->sources->surroundings,
                  what->result->surroundings_power / unit.scale);
    fprintf(script,
            "END\n"
            "set title 'Where the heat goes: gained above, lost below [%s]'\n"
            "unset xlabel; set ylabel 'net power [%s]'; unset yzeroaxis\n"
            "set xtics scale 0 font ',%d' noenhanced %s\n%s"
            "set xrange [-0.6:%g]; set yrange [*:*]; set ytics auto; set offsets 0,0,graph 0.08,graph 0.08\n"
            "set boxwidth 0.7; set xzeroaxis lt 1 lc '#555555'; unset key\n"
            "plot $bars using 1:2:($2 < 0 ? 0x" LOST " : 0x" GAINED
            "):xtic(3) with boxes fs solid 0.85 noborder lc rgb variable, "
            "'' using 1:($2 < 0 ? NaN : $2):(sprintf('%%.%dg', $2)) with labels offset 0,0.6 tc '#222222', "
            "'' using 1:($2 < 0 ? $2 : NaN):(sprintf('%%.%dg', $2)) with labels offset 0,-0.7 tc '#222222'\n"
            "unset multiplot\n",
            unit.name, unit.name,
            bars > 16 ? 9
            : many    ? 11
                      : 12,
            many ? "rotate by 40 right" : "", many ? "set bmargin at screen 0.135\n" : "", bars - 0.4, many ? 3 : 4,
            many ? 3 : 4);
}

/* The cylinder about the bed. NULL: there is none. */
static const fibrad_wall *cylinder_of(const struct walls *walls) {
    for (uint32_t k = 0; k < walls->count; ++k)
        if (walls->wall[k].kind == FIBRAD_WALL_CYLINDER) return &walls->wall[k];
    return NULL;
}

/* Draws two slices, or a slice and temperatures against radius. */
static int print_slices(FILE *script, const struct plot_slice *slice, const struct contents *what) {
    const uint32_t n = what->bed->n;
    const bool shows[QUANTITIES] = {varies(what->result->temperature, n),
                                    what->light && varies(what->light->absorbed, n), varies(what->result->power, n)};
    const fibrad_wall *tube = any_found(what) && !what->light ? cylinder_of(what->walls) : NULL;
    enum shown shown[QUANTITIES];
    int count = 0;
    for (enum shown k = TEMPERATURE; k < QUANTITIES; ++k)
        if (shows[k]) shown[count++] = k;
    if (count == 0) shown[count++] = TEMPERATURE, shown[count++] = POWER;
    int status = print_panel(script, shown[0], slice, what);
    if (!status && tube) {
        print_profile(script, slice, what, tube);
    } else if (!status) {
        const struct plot_plane other = {.axis = slice->across == 1 ? 'x' : 'y'};
        struct plot_slice second = *slice;
        if (count == 1) plot_slice_of(&second, &other, what->bed, what->walls);
        status = print_panel(script, shown[count > 1], &second, what);
    }
    return status;
}

int plot_heat(const struct output *output, const char *name, const struct contents *what,
              const struct plot_plane *plane) {
    struct gnuplot gnuplot;
    struct plot_slice slice;
    int status = gnuplot_start(&gnuplot, output);
    if (status) return status;
    plot_slice_of(&slice, plane, what->bed, what->walls);
    print_head(gnuplot.script, output, name, what);
    status = print_slices(gnuplot.script, &slice, what);
    if (any_found(what))
        print_profile(gnuplot.script, &slice, what, NULL);
    else
        print_layers(gnuplot.script, &slice, what);
    print_bars(gnuplot.script, what);
    const int drawn = gnuplot_end(&gnuplot);
    return status ? status : drawn;
}
