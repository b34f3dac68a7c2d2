/* tolerance.c - numbers of directions and paths for a tolerance. SPDX-License-Identifier: MIT
 *
 * Rows of view factors that are averaged have one number of directions, for only then are their sums at most 1. By
 * silhouettes the number grows from set to set. By beams the number follows from the worst rows of a pilot run, which
 * are computed by themselves. If the estimated errors are too large after averaging, the number is raised. Each row of
 * exchange factors has its own tolerance. This tolerance is lowered until the worst row has, after averaging, the error
 * that the caller allows. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "simple/job.h"

enum { PILOT = 50, SAMPLE = 48 };

/* Largest estimated error of averaged rows over that of raw rows. Measured: 0.4 to 0.7, more in sparse beds, whose rows
 * are then computed again. */
static const double averaged_over_raw = 0.6;

/* First tolerance of a row of exchange factors over that after averaging. Averaging hardly helps rows of small spheres
 * among large ones. */
static const double before_averaging = 0.9;

static int descending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

/* Marks the rows of largest estimated error. Most of them lie at the surface of a bed. */
static int mark_worst(uint32_t n, const double *error, unsigned char *wanted) {
    double *sorted = malloc(n * sizeof *sorted);
    if (!sorted) return FIBRAD_E_MEMORY;
    memcpy(sorted, error, n * sizeof *sorted);
    qsort(sorted, n, sizeof *sorted, descending);
    uint32_t rows = n < SAMPLE ? n : SAMPLE;
    const double least = sorted[rows - 1];
    for (uint32_t i = 0; i < n && rows > 0; ++i)
        if (error[i] >= least) wanted[i] = 1, --rows;
    free(sorted);
    return FIBRAD_OK;
}

/* Finds the number of directions: computes all rows with few directions, then the worst rows by the tolerance. */
static int find_directions(fibrad_job *job, fibrad_job_row *row, fibrad_beam_rule rule, double *error,
                           unsigned char *wanted, uint32_t *directions) {
    fibrad_job_report report;
    const fibrad_beam_rule pilot = {.directions = PILOT, .points = rule.points, .cutoff = rule.cutoff};
    int status = fibrad_job_rows(job, row, &pilot, NULL, error, &report);
    if (!status) status = mark_worst(job->facts.spheres, error, wanted);
    rule.tolerance /= averaged_over_raw;
    if (!rule.directions) rule.directions = PILOT;
    if (!status) status = fibrad_job_rows(job, row, &rule, wanted, NULL, &report);
    *directions = report.directions;
    return status;
}

static double worst_error(const fibrad_factors *matrix) {
    double worst = 0;
    for (uint32_t i = 0; i < matrix->n; ++i) worst = matrix->error[i] > worst ? matrix->error[i] : worst;
    return worst;
}

int fibrad_job_tolerance(fibrad_job *job, fibrad_job_row *row, const fibrad_beam_rule *rule,
                         const fibrad_matrix_rule *average, fibrad_bed_factors **factors) {
    const uint32_t n = job->facts.spheres;
    fibrad_beam_rule used = *rule;
    fibrad_job_report report;
    double *error = malloc(((size_t)n + 1) * sizeof *error);
    unsigned char *wanted = calloc((size_t)n + 1, 1);
    int status = error && wanted ? FIBRAD_OK : FIBRAD_E_MEMORY;
    if (row && !status && n > 0) status = find_directions(job, row, *rule, error, wanted, &used.directions);
    free(error);
    free(wanted);
    used.tolerance = 0;
    if (!row && !used.directions) used.directions = PILOT;
    while (!status) {
        if (!row) used.directions = fibrad_silhouettes_lines(used.directions);
        status =
            row ? fibrad_job_rows(job, row, &used, NULL, NULL, &report) : fibrad_job_silhouettes(job, &used, &report);
        if (!status) status = fibrad_job_factors(job, average, &report, factors);
        if (status) break;
        const double worst = worst_error(&(*factors)->matrix);
        if (worst <= rule->tolerance || used.directions == FIBRAD_DIRECTIONS_MAX) break;
        used.directions = fibrad_directions_for(used.directions, worst, rule->tolerance);
        fibrad_bed_free(*factors);
        *factors = NULL;
    }
    return status;
}

/* Rows are computed again for `spare` of the tolerance, as long as the worst error falls to `gain` of the last one. */
static const double spare = 0.95, gain = 0.9;

int fibrad_job_exchange(fibrad_job *job, fibrad_job_row *row, const fibrad_exchange_rule *rule,
                        const fibrad_matrix_rule *average, fibrad_bed_factors **factors) {
    fibrad_exchange_rule used = *rule;
    fibrad_job_report report;
    double least = INFINITY;
    used.tolerance *= before_averaging;
    for (;;) {
        int status = fibrad_job_rows(job, row, &used, NULL, NULL, &report);
        if (!status) status = fibrad_job_factors(job, average, &report, factors);
        if (status) return status;
        const double worst = worst_error(&(*factors)->matrix);
        if (worst <= rule->tolerance || worst > gain * least) return FIBRAD_OK;
        least = worst;
        used.tolerance *= spare * rule->tolerance / worst;
        fibrad_bed_free(*factors);
        *factors = NULL;
    }
}
