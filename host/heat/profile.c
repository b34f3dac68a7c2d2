/* profile.c - temperatures and powers of spheres against a coordinate. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "heat/heat.h"
#include "simple/cylinder.h"

int profile_option(const char *text, void *profile) {
    struct profile *p = profile;
    const char *rest = text + 1;
    if (!text[0] || !strchr("xyzr", text[0]) || *rest != ':')
        return message(STATUS_USAGE, "--profile: '%.60s' is not AXIS:OUT or AXIS:BINS:OUT with x, y, z or r", text);
    p->axis = text[0];
    const size_t digits = strspn(++rest, "0123456789");
    if (digits > 0 && rest[digits] == ':') {
        char number[24] = "";
        strncat(number, rest, digits < 20 ? digits : 20);
        const int status = options_count("--profile", number, 1, 100000, &p->bins);
        if (status) return status;
        rest += digits + 1;
    }
    if (p->path) return message(STATUS_USAGE, "--profile is given twice");
    p->path = rest;
    return output_ends(rest, ".csv") ? STATUS_OK
                                     : message(STATUS_USAGE, "--profile: '%.60s' does not end in .csv", rest);
}

int profile_begin(struct heat *h) {
    if (!h->profile.path || h->profile.axis != 'r') return STATUS_OK;
    for (uint32_t k = 0; k < h->walls.count && !h->around; ++k)
        if (h->walls.wall[k].kind == FIBRAD_WALL_CYLINDER) h->around = &h->walls.wall[k];
    return h->around ? STATUS_OK : message(STATUS_USAGE, "--profile: r needs a wall that is a cylinder");
}

/* The coordinate of a sphere's centre. */
static double place_of(const struct heat *h, uint32_t i) {
    const double at[3] = {h->bed->x[i], h->bed->y[i], h->bed->z[i]};
    return h->around ? cylinder_distance(h->around, at) : at[h->profile.axis - 'x'];
}

/* How a column of outputs becomes one number of a bin. Errors are left out. */
enum bin_kind { LEFT_OUT, SUM, MEAN, LEAST, MOST };
static const enum bin_kind kind_of[HEAT_COLUMNS] = {MEAN,     SUM, LEFT_OUT, LEFT_OUT, LEAST, MOST, LEFT_OUT, MEAN,
                                                    LEFT_OUT, SUM, SUM,      SUM,      SUM,   SUM,  SUM};

/* A bin: the spheres whose centres lie in it, those of them that have a temperature, and its numbers. NaN: none yet. */
struct bin {
    uint32_t spheres, warm;
    double value[HEAT_COLUMNS];
};

struct bins {
    struct bin *bin; /* [count] */
    uint32_t count;
    double low, width;
};

/* Divides the extent of the spheres into bins, for r from the axis on. If the number of bins is not given, a bin is one
 * mean diameter wide, and the last one may reach beyond the spheres. Status 0 or STATUS_MEMORY. */
static int make_bins(const struct heat *h, struct bins *bins) {
    const double most = 1e6;
    const double diameter = bed_diameter(h->bed);
    double low = h->around ? 0 : bed_reach(h->bed, h->profile.axis - 'x', false), high = -INFINITY;
    for (uint32_t i = 0; i < h->bed->n; ++i) high = fmax(high, place_of(h, i) + h->bed->r[i]);
    const uint32_t given = h->profile.bins;
    bins->count = given ? given : (uint32_t)fmin(ceil((high - low) / diameter * (1 - 1e-9)), most);
    bins->width = given ? (high - low) / given : fmax(diameter, (high - low) / most);
    bins->low = low;
    bins->bin = calloc(bins->count, sizeof *bins->bin);
    for (uint32_t k = 0; k < bins->count && bins->bin; ++k)
        for (int c = 0; c < HEAT_COLUMNS; ++c) bins->bin[k].value[c] = NAN;
    return bins->bin ? STATUS_OK : message_memory();
}

/* Adds a sphere to a bin. */
static void add_sphere(struct bin *bin, const struct heat_column column[HEAT_COLUMNS], uint32_t i) {
    ++bin->spheres;
    bin->warm += isnan(column[HEAT_TEMPERATURE].value[i]) ? 0 : 1;
    for (int c = 0; c < HEAT_COLUMNS; ++c) {
        double *all = &bin->value[c];
        if (!column[c].value || kind_of[c] == LEFT_OUT) continue;
        const double value = heat_value(&column[c], i), old = isnan(*all) ? value : *all;
        if (isnan(value)) continue;
        *all = kind_of[c] == LEAST  ? fmin(old, value)
               : kind_of[c] == MOST ? fmax(old, value)
               : kind_of[c] == MEAN ? old + (value - old) / bin->warm
               : isnan(*all)        ? value
                                    : old + value;
    }
}

static void print_bins(FILE *file, char axis, const struct bins *bins, const struct heat_column column[HEAT_COLUMNS]) {
    fprintf(file, "%c_low,%c_high,spheres", axis, axis);
    for (int c = 0; c < HEAT_COLUMNS; ++c)
        if (column[c].value && kind_of[c] != LEFT_OUT) fprintf(file, ",%s", column[c].name);
    for (uint32_t k = 0; k < bins->count; ++k) {
        const struct bin *bin = &bins->bin[k];
        fprintf(file, "\n%.9g,%.9g,%u", bins->low + k * bins->width, bins->low + (k + 1) * bins->width, bin->spheres);
        for (int c = 0; c < HEAT_COLUMNS; ++c)
            if (column[c].value && kind_of[c] != LEFT_OUT)
                isnan(bin->value[c]) ? fputs(",", file) : fprintf(file, ",%.9g", bin->value[c]);
    }
    fputs("\n", file);
}

int profile_write(const struct heat *h, const struct contents *what) {
    const struct profile *profile = &h->profile;
    struct heat_column column[HEAT_COLUMNS];
    struct output output = {0};
    struct bins bins = {0};
    char path[OUTPUT_PATH];
    if (!profile->path || h->bed->n == 0) return STATUS_OK;
    int status = output_numbered(profile->path, what->bed->frame, path);
    if (!status) status = output_open(&output, path);
    if (!status) status = make_bins(h, &bins);
    if (!status) {
        heat_columns(what, column);
        for (uint32_t i = 0; i < h->bed->n; ++i) {
            const double place = fmax((place_of(h, i) - bins.low) / bins.width, 0);
            add_sphere(&bins.bin[(uint32_t)fmin(place, bins.count - 1.)], column, i);
        }
        print_bins(output.file, profile->axis, &bins, column);
        status = output_flush(&output);
    }
    free(bins.bin);
    return output_close(&output, status);
}
