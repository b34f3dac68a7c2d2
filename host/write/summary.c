/* summary.c - sums, means and errors of the rows of a matrix. SPDX-License-Identifier: MIT */
#include <math.h>

#include "write/write.h"

double summary_row(const fibrad_factors *matrix, uint32_t i) {
    double sum = 0;
    for (uint64_t k = matrix->start[i]; k < matrix->start[i + 1]; ++k) sum += matrix->f[k];
    return sum;
}

static void add_summary(struct summary *summary, const fibrad_factors *matrix, uint32_t i, double rows) {
    const double sum = summary_row(matrix, i), *wall = matrix->wall + (size_t)i * matrix->walls;
    double all = sum + matrix->escaped[i] + matrix->beyond[i];
    for (uint32_t k = 0; k < matrix->walls; ++k) {
        summary->wall_mean[k] += wall[k] / rows;
        all += wall[k];
    }
    summary->row_sum_min = fmin(summary->row_sum_min, sum);
    summary->row_sum_max = fmax(summary->row_sum_max, sum);
    summary->closure_max = fmax(summary->closure_max, fabs(all - 1));
    summary->error_max = fmax(summary->error_max, matrix->error[i]);
    summary->error_rms += matrix->error[i] * matrix->error[i] / rows;
    summary->escaped_mean += matrix->escaped[i];
    summary->beyond_mean += matrix->beyond[i];
}

/* Whether a row is not empty. Rows that are not wanted and rows of spheres of emissivity 0 are empty. */
static bool has_row(const struct contents *what, uint32_t i) {
    return (!what->wanted || what->wanted[i]) && (!what->grey || what->grey->emissivity[i] > 0);
}

void summary_make(struct summary *summary, const struct contents *what) {
    const fibrad_factors *matrix = &what->factors->matrix;
    uint32_t rows = 0;
    *summary = (struct summary){.row_sum_min = INFINITY, .row_sum_max = -INFINITY};
    for (uint32_t i = 0; i < matrix->n; ++i) rows += has_row(what, i);
    if (rows == 0) { /* nothing emits */
        *summary = (struct summary){0};
        return;
    }
    for (uint32_t i = 0; i < matrix->n; ++i)
        if (has_row(what, i)) add_summary(summary, matrix, i, rows);
    for (uint32_t k = 0; matrix->wall_wall && k < matrix->walls; ++k)
        summary->wall_error_max = fmax(summary->wall_error_max, matrix->wall_error[k]); /* fmax() ignores NaN */
    summary->escaped_mean /= rows;
    summary->beyond_mean /= rows;
    summary->error_rms = sqrt(summary->error_rms);
}

/* Reports the mean factor to a wall and, if the wall is finite, its area. */
static void report_wall_share(const struct summary *summary, const struct contents *what, uint32_t k,
                              struct report *report) {
    const char *kind = what->walls->wall[k].kind ? "wall_" : ""; /* names of unknown walls begin with wall_ */
    const double area = what->factors->wall_area[k];
    char own[WALL_NAME];
    const char *name = contents_wall(what, k, own);
    report_value(report, report_key(report, "%s%s_F", kind, name), summary->wall_mean[k], 6);
    if (area < INFINITY) report_value(report, report_key(report, "%s%s_area", kind, name), area, 6);
}

/* Reports the factors from a wall to all walls and to the surroundings, and their error, if the wall has a row. */
static void report_wall_row(const struct contents *what, uint32_t k, struct report *report) {
    const fibrad_factors *matrix = &what->factors->matrix;
    char own[WALL_NAME];
    const char *name = contents_wall(what, k, own);
    double sum = 0;
    for (uint32_t j = 0; j < matrix->walls; ++j) sum += matrix->wall_wall[(size_t)k * matrix->walls + j];
    if (isnan(sum)) return;
    report_measured(report, report_key(report, "wall_%s_to_walls", name), sum, matrix->wall_error[k]);
    report_measured(report, report_key(report, "wall_%s_escaped", name), matrix->wall_escaped[k],
                    matrix->wall_error[k]);
    report_value(report, report_key(report, "wall_%s_error", name), matrix->wall_error[k], 2);
}

void summary_report(const struct summary *summary, const struct contents *what, struct report *report) {
    const fibrad_factors *matrix = &what->factors->matrix;
    report_count(report, "nonzeros", matrix->start[matrix->n]);
    report_measured(report, "row_sum_min", summary->row_sum_min, summary->error_max);
    report_measured(report, "row_sum_max", summary->row_sum_max, summary->error_max);
    report_measured(report, "escaped_mean", summary->escaped_mean, summary->error_rms);
    report_measured(report, "beyond_mean", summary->beyond_mean, summary->error_rms);
    for (uint32_t k = 0; k < what->walls->count; ++k) report_wall_share(summary, what, k, report);
    if (matrix->wall_wall) {
        for (uint32_t k = 0; k < matrix->walls; ++k) report_wall_row(what, k, report);
        report_value(report, "wall_correction", matrix->wall_correction, 2);
        report_value(report, "wall_closure", matrix->wall_closure, 2);
    }
    report_value(report, "closure_max", fmax(what->factors->closure_error, summary->closure_max), 2);
    report_value(report, "reciprocity_max", what->factors->reciprocity_error, 2);
    report_value(report, "error_rms", summary->error_rms, 2);
    report_value(report, "error_estimate", summary->error_max, 2);
}
