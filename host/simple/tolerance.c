/* tolerance.c - numbers of directions and paths for a tolerance. SPDX-License-Identifier: MIT
 *
 * Rows of view factors that are averaged have one number of lines. If the estimated errors are too large after
 * averaging, the number is raised, from set to set. Each row of exchange factors has its own tolerance. This tolerance
 * is lowered until the worst row has, after averaging, the error that the caller allows. */
#include <math.h>

#include "simple/rows.h"

enum { PILOT = 50 }; /* lines to begin with */

/* First tolerance of a row of exchange factors over that after averaging. Averaging hardly helps rows of small spheres
 * among large ones. */
static const double before_averaging = 0.9;

static double worst_error(const fibrad_factors *matrix) {
    double worst = 0;
    for (uint32_t i = 0; i < matrix->n; ++i) worst = matrix->error[i] > worst ? matrix->error[i] : worst;
    return worst;
}

int fibrad_bed_tolerance_rows(fibrad_bed *bed, const fibrad_beam_rule *rule, const fibrad_matrix_rule *average,
                              fibrad_bed_matrix **factors) {
    fibrad_beam_rule used = *rule;
    fibrad_rows_report report;
    used.tolerance = 0;
    if (!used.directions) used.directions = PILOT;
    for (;;) {
        const bool lines = used.directions <= FIBRAD_LINES_EVEN_MAX;
        if (lines) used.directions = fibrad_line_set_lines(used.directions);
        int status = fibrad_bed_line_rows(bed, &used, &report);
        if (!status) status = fibrad_bed_average(bed, average, &report, factors);
        if (status) return status;
        const double worst = worst_error(&(*factors)->matrix);
        if (worst <= rule->tolerance || used.directions == FIBRAD_DIRECTIONS_MAX) return FIBRAD_OK;
        used.directions = fibrad_directions_for(used.directions, worst, rule->tolerance);
        if (lines && used.directions > FIBRAD_LINES_EVEN_MAX) used.directions += used.directions / 2;
        if (used.directions > FIBRAD_DIRECTIONS_MAX) used.directions = FIBRAD_DIRECTIONS_MAX;
        fibrad_bed_matrix_free(*factors);
        *factors = NULL;
    }
}

/* Rows are computed again for `spare` of the tolerance, as long as the worst error falls to `gain` of the last one. */
static const double spare = 0.95, gain = 0.9;

int fibrad_bed_exchange_rows(fibrad_bed *bed, fibrad_row_method *row, const fibrad_exchange_rule *rule,
                             const fibrad_matrix_rule *average, fibrad_bed_matrix **factors) {
    fibrad_exchange_rule used = *rule;
    fibrad_rows_report report;
    double least = INFINITY;
    used.tolerance *= before_averaging;
    for (;;) {
        int status = fibrad_bed_rows(bed, row, &used, NULL, &report);
        if (!status) status = fibrad_bed_average(bed, average, &report, factors);
        if (status) return status;
        const double worst = worst_error(&(*factors)->matrix);
        if (worst <= rule->tolerance || worst > gain * least) return FIBRAD_OK;
        least = worst;
        used.tolerance *= spare * rule->tolerance / worst;
        fibrad_bed_matrix_free(*factors);
        *factors = NULL;
    }
}
