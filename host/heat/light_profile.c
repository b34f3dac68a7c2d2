/* light_profile.c - what spheres absorb of light from outside, along an axis. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "bed/units.h"
#include "cli/message.h"
#include "heat/light_option.h"
#include "plot/gnuplot.h"

/* One bin: from `low` on, the spheres whose centres lie in it, and what these absorb [W]. */
struct light_bin {
    double low, first, absorbed;
    uint32_t spheres;
};

struct light_bins {
    struct light_bin *bin; /* [count] */
    uint32_t count;
    double width;
};

/* Divides the extent of the spheres along the axis into bins. If the number of bins is not given, a bin is one mean
 * diameter wide, and the last one may reach beyond the spheres. Status 0 or STATUS_MEMORY. */
static int make_bins(const struct light_options *options, const struct bed *bed, struct light_bins *bins) {
    const double *at = bed_centres(bed, options->axis - 'x');
    double low = INFINITY, high = -INFINITY, diameter = 0;
    for (uint32_t i = 0; i < bed->n; ++i) {
        low = fmin(low, at[i] - bed->r[i]), high = fmax(high, at[i] + bed->r[i]);
        diameter += 2 * bed->r[i] / bed->n;
    }
    const double most = 1e6;
    bins->count = options->bins > 0 ? options->bins : (uint32_t)fmin(ceil((high - low) / diameter * (1 - 1e-9)), most);
    bins->width = options->bins > 0 ? (high - low) / options->bins : fmax(diameter, (high - low) / most);
    bins->bin = calloc(bins->count, sizeof *bins->bin);
    if (!bins->bin) return message_memory();
    for (uint32_t k = 0; k < bins->count; ++k) bins->bin[k].low = low + k * bins->width;
    return STATUS_OK;
}

static void fill_bins(const struct light_state *state, const struct bed *bed, struct light_bins *bins) {
    const double *at = bed_centres(bed, state->options->axis - 'x');
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double place = (at[i] - bins->bin[0].low) / bins->width;
        struct light_bin *bin = &bins->bin[(uint32_t)fmin(place, bins->count - 1.)];
        ++bin->spheres;
        bin->first += state->first[i], bin->absorbed += state->absorbed[i];
    }
}

/* Writes the bins with a separator. Columns: low end, high end, spheres, absorbed first, absorbed, in units of
 * `watts`. */
static void print_bins(FILE *file, const struct light_bins *bins, char separator, double watts) {
    for (uint32_t k = 0; k < bins->count; ++k) {
        const struct light_bin *bin = &bins->bin[k];
        fprintf(file, "%.9g%c%.9g%c%u%c%.9g%c%.9g\n", bin->low, separator, bin->low + bins->width, separator,
                bin->spheres, separator, bin->first / watts, separator, bin->absorbed / watts);
    }
}

static int draw_bins(const struct output *output, const struct light_state *state, const struct light_bins *bins,
                     const char *name) {
    struct gnuplot gnuplot;
    const int status = gnuplot_start(&gnuplot, output);
    if (status) return status;
    FILE *script = gnuplot.script;
    double most = 0;
    for (uint32_t k = 0; k < bins->count; ++k) most = fmax(most, bins->bin[k].absorbed);
    const struct prefixed unit = unit_prefixed(most, "W");
    gnuplot_style(script, output->path, 800, 560);
    fputs("$bins << END\n", script);
    print_bins(script, bins, ' ', unit.scale);
    fputs("END\nset label 1 '", script);
    gnuplot_name(script, name);
    fprintf(script,
            "' at screen 0.03,0.955 font ',17' tc '#111111' noenhanced\n"
            "set tmargin at screen 0.9; set bmargin at screen 0.13; set grid y; set yrange [0:*]; set key top left\n"
            "set xrange [%.9g:%.9g]; set xlabel '%c'; set ylabel 'absorbed of the light [%s]'; set style fill solid "
            "0.8 noborder\n"
            "plot $bins using (($1+$2)/2):5:($2-$1) with boxes fc '#365c8d' title 'with reflections', "
            "'' using (($1+$2)/2):4 with histeps lw 2 lc '#d1495b' title 'where it falls first'\n",
            bins->bin[0].low, bins->bin[0].low + bins->count * bins->width, state->options->axis, unit.name);
    return gnuplot_end(&gnuplot);
}

int light_profile(const struct light_state *state, const struct bed *bed, const char *name) {
    const struct light_options *options = state->options;
    struct output output = {0};
    struct light_bins bins = {0};
    if (!options || !options->profile || bed->n == 0) return STATUS_OK;
    int status = output_open(&output, options->profile);
    if (!status) status = make_bins(options, bed, &bins);
    if (!status) fill_bins(state, bed, &bins);
    if (!status && output_ends(options->profile, ".csv")) {
        fprintf(output.file, "%c_low,%c_high,spheres,absorbed_first_W,absorbed_W\n", options->axis, options->axis);
        print_bins(output.file, &bins, ',', 1);
        status = output_flush(&output);
    } else if (!status) {
        status = draw_bins(&output, state, &bins, name);
    }
    free(bins.bin);
    return output_close(&output, status);
}
