/* reproduce_beds.c - figure 10 and table 1 of the surface paper: lattices and random beds.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bed/packing.h"
#include "cli/message.h"
#include "papers/reproduce/reproduce.h"

/* ---- figure 10: row sums of one sphere of a lattice ---- */

enum { DISTANCES = 7, DRAWS = 20, METHODS = 3 };
static const double distances[DISTANCES] = {2, 3, 4, 5, 6, 8, 10};
static const char *const names[METHODS] = {"surface", "beam", "reference"};

/* The row sum of the first sphere, without spheres whose centres are farther than `distance`. */
static int lattice_row_sum(struct rows *rows, int method, double distance, double *sum) {
    const fibrad_surface_rule surface = {.cutoff = distance};
    const fibrad_beam_rule beam = {.directions = method == 1 ? 0 : 8192, .cutoff = distance};
    const struct row_rule methods[2] = {{.surface = &surface}, {.beam = &beam}};
    fibrad_row row;
    const int status = rows_row(rows, &methods[method > 0], 0, &row);
    *sum = 0;
    for (uint32_t k = 0; k < row.length && !status; ++k) *sum += rows->f[k];
    return status;
}

static int draw_lattice(double low, uint64_t seed, double sums[METHODS][DISTANCES]) {
    struct rows rows = ROWS_NONE;
    int status = bed_make_fcc(&rows.bed, low, distances[DISTANCES - 1], seed);
    if (!status) status = rows_open(&rows, false);
    for (int m = 0; m < METHODS; ++m)
        for (int d = 0; d < DISTANCES && !status; ++d) status = lattice_row_sum(&rows, m, distances[d], &sums[m][d]);
    rows_close(&rows);
    return status;
}

static void report_lattice(struct reproduce *reproduce, double fraction, uint32_t draws,
                           double sums[DRAWS][METHODS][DISTANCES], const double *check) {
    for (int m = 0; m < METHODS; ++m)
        for (int d = 0; d < DISTANCES; ++d) {
            double mean = 0, square = 0, least = INFINITY, most = -INFINITY;
            for (uint32_t k = 0; k < draws; ++k) {
                mean += sums[k][m][d] / draws;
                least = fmin(least, sums[k][m][d]);
                most = fmax(most, sums[k][m][d]);
            }
            for (uint32_t k = 0; k < draws; ++k) square += pow(sums[k][m][d] - mean, 2);
            const double spread = draws > 1 ? sqrt(square / (draws - 1)) : 0;
            fprintf(reproduce->data, "%g,%s,%g,%.6f,%.6f,%.6f,%.6f\n", fraction, names[m], distances[d], mean, spread,
                    least, most);
            if (check && m != 1)
                reproduce_compare(reproduce, SOURCE_CHECK, "", check[d], mean, "%s, solid %g, D = %g: mean of %u",
                                  names[m], fraction, distances[d], draws);
            if (distances[d] == 6)
                reproduce_compare(reproduce, SOURCE_PAPER, "", .95, mean, "%s, solid %g, D = 6: sum at least", names[m],
                                  fraction);
        }
}

int reproduce_fig10(struct reproduce *reproduce) {
    static const struct {
        double fraction, low;
        double check[DISTANCES]; /* of one draw; 0: none */
    } lattices[] = {{.74, 1, {.8626, .9651, .9973, .9998, 1, 1, 1}},
                    {.567, .824, {.715, .843, .963, .992, .997, .999, 1}},
                    {.474, .707, {0}},
                    {.428, .640, {0}},
                    {.374, .550, {.505, .613, .784, .882, .936, .977, .990}}};
    static double sums[DRAWS][METHODS][DISTANCES];
    fputs("fraction,method,distance,mean,spread,least,most\n", reproduce->data);
    for (size_t l = 0; l < sizeof lattices / sizeof *lattices; ++l) {
        const uint32_t draws = lattices[l].low < 1 ? DRAWS : 1;
        for (uint32_t k = 0; k < draws; ++k) {
            const int status = draw_lattice(lattices[l].low, k, sums[k]);
            if (status) return status;
        }
        report_lattice(reproduce, lattices[l].fraction, draws, sums,
                       lattices[l].check[0] > 0 ? lattices[l].check : NULL);
    }
    return STATUS_OK;
}

/* ---- table 1: seconds for all factors of random beds ---- */

#define CUTOFF 6.0
enum { SIZES = 5, SAMPLE = 40 };
static const uint32_t sizes[SIZES] = {10, 50, 100, 500, 1000};

/* Accurate rows of some spheres of a bed. */
struct truth {
    uint32_t n, count;
    double *f; /* [count][n] rows of spheres k n/count */
};

static void add_factors(double *f, const struct rows *rows, const fibrad_row *row, double factor) {
    for (uint32_t k = 0; k < row->length; ++k) f[rows->col[k]] += factor * rows->f[k];
}

static int make_truth(struct truth *truth, struct rows *rows) {
    const fibrad_beam_rule rule = {.directions = 16384, .cutoff = CUTOFF};
    const struct row_rule fine = {.beam = &rule};
    truth->n = rows->n;
    truth->count = rows->n < SAMPLE ? rows->n : SAMPLE;
    truth->f = calloc((size_t)truth->count * truth->n, sizeof *truth->f);
    int status = truth->f ? STATUS_OK : message_memory();
    for (uint32_t k = 0; k < truth->count && !status; ++k) {
        fibrad_row row;
        status = rows_row(rows, &fine, (uint32_t)((uint64_t)k * truth->n / truth->count), &row);
        if (!status) add_factors(truth->f + (size_t)k * truth->n, rows, &row, 1);
    }
    return status;
}

/* The root mean square over rows of the Euclidean error of a row. */
static int error_of(struct rows *rows, const struct row_rule *method, const struct truth *truth, double *error) {
    double *difference = malloc(truth->n * sizeof *difference), square = 0;
    int status = difference ? STATUS_OK : message_memory();
    for (uint32_t k = 0; k < truth->count && !status; ++k) {
        fibrad_row row;
        status = rows_row(rows, method, (uint32_t)((uint64_t)k * truth->n / truth->count), &row);
        if (status) break;
        memcpy(difference, truth->f + (size_t)k * truth->n, truth->n * sizeof *difference);
        add_factors(difference, rows, &row, -1);
        for (uint32_t j = 0; j < truth->n; ++j) square += difference[j] * difference[j];
    }
    free(difference);
    *error = sqrt(square / truth->count);
    return status;
}

/* Other work on the machine disturbs processor time least. */
static double processor_seconds(void) { return (double)clock() / CLOCKS_PER_SEC; }

/* The processor time for all rows [s]. Rows of small beds are computed many times, which is long enough to measure. */
static int seconds_of(struct rows *rows, const struct row_rule *method, double *seconds) {
    const double begun = processor_seconds();
    uint32_t times = 0;
    int status = STATUS_OK;
    fibrad_row row;
    for (; processor_seconds() - begun < 0.2 && !status; ++times)
        for (uint32_t i = 0; i < rows->n && !status; ++i) status = rows_row(rows, method, i, &row);
    *seconds = (processor_seconds() - begun) / times;
    return status;
}

/* Finds the fewest directions, in steps of a quarter, whose error is at most `error`. */
static int fewest_directions(struct rows *rows, const struct truth *truth, double error, fibrad_beam_rule *rule) {
    double found;
    rule->directions = FIBRAD_DIRECTIONS_MIN;
    for (;;) {
        const struct row_rule beam = {.beam = rule};
        const int status = error_of(rows, &beam, truth, &found);
        if (status || found <= error || rule->directions > 8192) return status;
        rule->directions += rule->directions / 4;
    }
}

/* A method of rays with an error, and its time for all rows. All rows by rays take about the same time, so the time of
 * some rows gives the time of all. */
struct rays_at {
    fibrad_cast_rule rule;
    double error, seconds;
};

/* Measures the time of as many rays as give the error, extrapolated from 20,000 rays. */
static int time_rays(struct rows *rows, const struct truth *truth, double error, struct rays_at *rays) {
    const struct row_rule method = {.cast = &rays->rule};
    rays->rule.rays = 20000;
    int status = error_of(rows, &method, truth, &rays->error);
    if (status) return status;
    rays->rule.rays = (uint32_t)(20000 * pow(rays->error / error, rays->rule.random ? 2 : 1.6));
    const double begun = processor_seconds();
    status = error_of(rows, &method, truth, &rays->error);
    rays->seconds = (processor_seconds() - begun) * truth->n / truth->count;
    return status;
}

static int time_bed(struct reproduce *reproduce, struct rows *rows, double published, double published_mc) {
    struct truth truth = {0};
    const fibrad_surface_rule surface_rule = {.cutoff = CUTOFF};
    fibrad_beam_rule beam_rule = {.cutoff = CUTOFF};
    const struct row_rule surface = {.surface = &surface_rule}, beam = {.beam = &beam_rule};
    double error = 0, beam_error = 0, surface_seconds = 0, beam_seconds = 0;
    struct rays_at cast = {.rule.cutoff = CUTOFF}, mc = {.rule = {.random = 1, .cutoff = CUTOFF}};
    int status = make_truth(&truth, rows);
    if (!status) status = error_of(rows, &surface, &truth, &error);
    if (!status) status = fewest_directions(rows, &truth, error, &beam_rule);
    if (!status) status = error_of(rows, &beam, &truth, &beam_error);
    if (!status) status = seconds_of(rows, &surface, &surface_seconds);
    if (!status) status = seconds_of(rows, &beam, &beam_seconds);
    if (!status) status = time_rays(rows, &truth, error, &cast);
    if (!status) status = time_rays(rows, &truth, error, &mc);
    free(truth.f);
    if (status) return status;
    fprintf(reproduce->data, "%u,%g,%.4g,%.4g,%u,%.4g,%.4g,%g,%u,%.4g,%.4g,%u,%.4g,%.4g\n", rows->n, published,
            surface_seconds, error, beam_rule.directions, beam_seconds, beam_error, published_mc, cast.rule.rays,
            cast.seconds, cast.error, mc.rule.rays, mc.seconds, mc.error);
    reproduce_compare(reproduce, SOURCE_PAPER, "s", published, surface_seconds,
                      "N = %u, surface, 55 nodes, row error %.1e", rows->n, error);
    reproduce_compare(reproduce, "", "s", NAN, beam_seconds, "N = %u, beam, %u directions, row error %.1e", rows->n,
                      beam_rule.directions, beam_error);
    reproduce_compare(reproduce, "", "s", NAN, cast.seconds, "N = %u, cast, %u rays, row error %.1e", rows->n,
                      cast.rule.rays, cast.error);
    reproduce_compare(reproduce, SOURCE_PAPER, "s", published_mc, mc.seconds, "N = %u, mc, %u rays, row error %.1e",
                      rows->n, mc.rule.rays, mc.error);
    reproduce_compare(reproduce, SOURCE_PAPER, "", published_mc / published, mc.seconds / surface_seconds,
                      "N = %u, seconds mc : surface", rows->n);
    reproduce_compare(reproduce, "", "", NAN, surface_seconds / beam_seconds, "N = %u, seconds surface : beam",
                      rows->n);
    return STATUS_OK;
}

int reproduce_table1(struct reproduce *reproduce) {
    static const double published[SIZES] = {1.5, 16, 42, 236, 592},
                        published_mc[SIZES] = {2.3, 25.9, 68.2, 375.8, 931.2};
    fputs("N,published_surface_s,surface_s,surface_row_error,beam_directions,beam_s,beam_row_error,published_mc_s,"
          "cast_rays,cast_s,cast_row_error,mc_rays,mc_s,mc_row_error\n",
          reproduce->data);
    for (int k = 0; k < SIZES; ++k) {
        struct rows rows = ROWS_NONE;
        int status = bed_make_packing(&rows.bed, sizes[k], .8, 1.2, .55, 1);
        if (!status) status = rows_open(&rows, false);
        if (!status) status = time_bed(reproduce, &rows, published[k], published_mc[k]);
        rows_close(&rows);
        if (status) return status;
    }
    return STATUS_OK;
}
