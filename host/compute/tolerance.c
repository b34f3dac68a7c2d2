/* tolerance.c - as many directions as a stated error takes. SPDX-License-Identifier: MIT */
#include "compute/tolerance.h"

#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

enum { PILOT = 50, SAMPLE = 48 };

/* The largest estimate of averaged rows over that of raw ones, 0.4 to 0.7 as measured; more in sparse beds, which are
 * then repeated. */
static const double averaged_over_raw = 0.6;

static int descending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x < y) - (x > y);
}

/* Marks the rows of largest estimate: those at the surface of a bed, mostly. */
static int mark_worst(uint32_t n, const double *error, bool *wanted) {
    double *sorted = malloc(n * sizeof *sorted);
    if (!sorted) return message_memory();
    memcpy(sorted, error, n * sizeof *sorted);
    qsort(sorted, n, sizeof *sorted, descending);
    uint32_t rows = n < SAMPLE ? n : SAMPLE;
    const double least = sorted[rows - 1];
    for (uint32_t i = 0; i < n && rows > 0; ++i)
        if (error[i] >= least) wanted[i] = true, --rows;
    free(sorted);
    return STATUS_OK;
}

/* Computes all rows with few directions, and then the worst with as many as they need by themselves. */
static int sample(const struct bed *bed, struct run_options options, fibrad_beam_rule rule, double error,
                  struct result *result) {
    bool *wanted = calloc(bed->n, sizeof *wanted);
    if (!wanted) return message_memory();
    options.raw = true;
    options.method = method_beam(&rule);
    rule.directions = PILOT;
    int status = run_rows(bed, &options, result);
    const double seconds = result->seconds;
    if (!status) status = mark_worst(bed->n, result->error, wanted);
    result_free(result);
    rule.error = error / averaged_over_raw;
    options.wanted = wanted;
    if (!status) status = run_rows(bed, &options, result);
    result->seconds += seconds;
    free(wanted);
    return status;
}

int tolerance_rows(const struct bed *bed, const struct run_options *options, const fibrad_beam_rule *rule, double error,
                   struct result *result) {
    struct run_options now = *options;
    fibrad_beam_rule used = *rule;
    used.directions = 0;
    now.method = method_beam(&used);
    if (options->raw) {
        used.error = error;
        return run_rows(bed, &now, result);
    }
    int status = sample(bed, *options, used, error, result);
    used.directions = result->directions;
    for (double seconds = result->seconds; !status; seconds = result->seconds) {
        result_free(result);
        status = run_rows(bed, &now, result);
        result->seconds += seconds;
        if (status || result->error_estimate <= error || used.directions == FIBRAD_DIRECTIONS_MAX) break;
        used.directions = fibrad_directions_for(used.directions, result->error_estimate, error);
    }
    return status;
}
