/* reproduce_pebbles.c - tables and figures of the pebble-bed paper. SPDX-License-Identifier: MIT */
#include <math.h>

#include "bed/packing.h"
#include "cli/message.h"
#include "papers/reproduce/reproduce.h"

/* ---- two unit spheres at centre distance H ---- */

/* The factor from a plane element to a unit sphere at distance h. t: angle between the normal and the direction of the
 * centre. */
static double element(double h, double t) {
    if (cos(t) >= 1 / h) return cos(t) / (h * h);
    if (cos(t) <= -1 / h) return 0;
    const double x = sqrt(h * h - 1), y = -x * cos(t) / sin(t), root = sin(t) * sqrt(fmax(0, 1 - y * y));
    if (x == 0) return cos(t) > 0 ? cos(t) : 0;
    return (cos(t) * acos(y) - x * root) / (M_PI * h * h) + atan(root / x) / M_PI;
}

/* The factor from sphere 2 at a point at angle t from the line of centres to sphere 1: distance and angle of sphere 1
 * depend on the point. */
static double received(double h, double t) {
    const double distance = sqrt(h * h + 1 - 2 * h * cos(t));
    if (distance <= 1) return 1; /* the point of contact */
    return element(distance, acos(fmax(-1, fmin(1, (h * cos(t) - 1) / distance))));
}

/* The fraction of the radiation received that sphere 2 receives within the angle t. */
static double share_within(double h, double t) {
    enum { STEPS = 4000 };
    double within = 0, all = 0;
    for (int k = 0; k < STEPS; ++k) {
        const double a = M_PI / 2 * (k + .5) / STEPS, power = received(h, a) * sin(a);
        all += power;
        if (a < t) within += power;
    }
    return within / all;
}

int reproduce_pebble_pair(struct reproduce *reproduce) {
    for (int h = 2; h <= 6; ++h) {
        reproduce_compare(reproduce, SOURCE_PAPER, "", .25, share_within(h, M_PI / 6),
                          "H = %d: received within 30 deg; cosine law", h);
        reproduce_compare(reproduce, SOURCE_PAPER, "", .75, share_within(h, M_PI / 3),
                          "H = %d: received within 60 deg; cosine law", h);
    }
    fputs("angle_degrees,cosine,H2,H3,H4,H6\n", reproduce->data);
    for (int degrees = 0; degrees <= 90; degrees += 2) {
        const double t = degrees * M_PI / 180;
        fprintf(reproduce->data, "%d,%.5f,%.5f,%.5f,%.5f,%.5f\n", degrees, cos(t), received(2, t) / received(2, 0),
                received(3, t) / received(3, 0), received(4, t) / received(4, 0), received(6, t) / received(6, 0));
    }
    return STATUS_OK;
}

/* ---- a random bed ---- */

enum { PEBBLES = 1000, SAMPLE = 100, BINS = 81 };
#define BIN 0.1 /* [radii] of the centre distance, up to 8 */

struct within {
    double factor[BINS], spheres[BINS]; /* sums of factors within each distance, as means over the sample */
};

/* The distance between the centres of the nearest images of two spheres. */
static double apart(const struct bed *bed, uint32_t i, uint32_t j) {
    const double *const axis[3] = {bed->x, bed->y, bed->z};
    double square = 0;
    for (int a = 0; a < 3; ++a) {
        double e = axis[a][j] - axis[a][i];
        e -= bed->period[a] * round(e / bed->period[a]);
        square += e * e;
    }
    return sqrt(square);
}

static int collect_within(struct within *within, struct rows *rows) {
    const struct bed *bed = &rows->bed;
    const fibrad_beam_rule rule = {.directions = 610};
    const struct row_rule beam = {.beam = &rule};
    for (uint32_t s = 0; s < SAMPLE; ++s) {
        const uint32_t i = s * (PEBBLES / SAMPLE);
        fibrad_row row;
        const int status = rows_row(rows, &beam, i, &row);
        if (status) return status;
        for (int b = 0; b < BINS; ++b) {
            for (uint32_t k = 0; k < row.length; ++k)
                if (rows->col[k] != i && apart(bed, i, rows->col[k]) <= b * BIN)
                    within->factor[b] += rows->f[k] / SAMPLE;
            for (uint32_t j = 0; j < bed->n; ++j)
                if (j != i && apart(bed, i, j) <= b * BIN) within->spheres[b] += 1.0 / SAMPLE;
        }
    }
    return STATUS_OK;
}

static void report_bed(struct reproduce *reproduce, double fraction, const struct within *within) {
    static const struct {
        int bin;
        const char *distance;
        double factor, spheres; /* NAN: nothing published */
    } published[] = {{40, "from centre to centre within 2 diameters", .98, 100},
                     {50, "from centre to surface within 2 diameters", .98, 100},
                     {60, "from surface to surface within 2 diameters", .98, 100},
                     {60, "from centre to centre within 3 diameters", .99, NAN},
                     {70, "from centre to surface within 3 diameters", .99, NAN},
                     {80, "from surface to surface within 3 diameters", .99, NAN}};
    for (size_t k = 0; k < sizeof published / sizeof *published; ++k) {
        reproduce_compare(reproduce, SOURCE_PAPER, "", published[k].factor, within->factor[published[k].bin],
                          "solid %g, %s: factor, over", fraction, published[k].distance);
        reproduce_compare(reproduce, SOURCE_PAPER, "", published[k].spheres, within->spheres[published[k].bin],
                          "solid %g, %s: spheres, under", fraction, published[k].distance);
    }
    for (int b = 0; b < BINS; ++b)
        fprintf(reproduce->data, "%g,%.1f,%.6f,%.3f\n", fraction, b * BIN, within->factor[b], within->spheres[b]);
}

int reproduce_pebble_bed(struct reproduce *reproduce) {
    static const double fractions[] = {.55, .6};
    fputs("fraction,centre_distance_radii,factor,spheres\n", reproduce->data);
    for (size_t k = 0; k < sizeof fractions / sizeof *fractions; ++k) {
        struct rows rows = ROWS_NONE;
        struct within within = {0};
        int status = bed_make_packing(&rows.bed, PEBBLES, 1, 1, fractions[k], 1);
        if (!status) status = rows_open(&rows, true);
        if (!status) status = collect_within(&within, &rows);
        if (!status) report_bed(reproduce, fractions[k], &within);
        rows_close(&rows);
        if (status) return status;
    }
    return STATUS_OK;
}
