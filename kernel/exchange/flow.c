/* flow.c - powers from rows of exchange factors, one collection of rows at a time. SPDX-License-Identifier: MIT */
#include "rows/record.h"

/* A row with more than this beyond the cutoff says nothing about powers. */
#define BEYOND_MOST (1 - 1e-12)

static bool all_finite(const double *values, uint32_t count) {
    double sum = 0; /* a value that is not finite makes it NaN for good */
    for (uint32_t k = 0; k < count; k++) sum += values[k] - values[k];
    return sum == 0;
}

static bool flow_given(const fibrad_flow *flow, uint32_t spheres, uint32_t walls) {
    if (spheres > 0 && (flow->weight == NULL || flow->emission == NULL || flow->power == NULL)) return false;
    if (walls > 0 && (flow->wall_emission == NULL || flow->wall_power == NULL)) return false;
    return all_finite(flow->emission, spheres) && all_finite(flow->wall_emission, walls) &&
           fibrad_finite(flow->surroundings_emission);
}

static bool record_fits(const fibrad_record *row, const fibrad_flow *flow, uint32_t spheres, uint32_t walls) {
    const uint32_t *col = fibrad_record_col(row); /* ascending */
    if (row->sphere >= spheres || row->walls != walls) return false;
    if (row->length > 0 && col[row->length - 1] >= spheres) return false;
    return fibrad_finite(flow->weight[row->sphere]) && fibrad_finite(row->beyond) && fibrad_finite(row->escaped);
}

/* Adds the power that one row exchanges. Nothing is known about what is beyond the row. So the known factors are scaled
 * to add up to 1. An entry counts half, because the row of the other sphere adds the other half. */
static void add_row(const fibrad_record *row, fibrad_flow *flow) {
    const uint32_t *col = fibrad_record_col(row);
    const double *f = fibrad_record_f(row), *wall = fibrad_record_wall(row), *emission = flow->emission;
    const double own = emission[row->sphere], given_back = row->beyond < BEYOND_MOST ? 1 / (1 - row->beyond) : 0;
    const double weight = flow->weight[row->sphere] * given_back, half = 0.5 * weight;
    double gain = 0;
    for (uint32_t k = 0; k < row->length; k++) {
        const double gained = half * f[k] * (emission[col[k]] - own);
        flow->power[col[k]] -= gained;
        gain += gained;
    }
    for (uint32_t b = 0; b < row->walls; b++) {
        const double gained = weight * wall[b] * (flow->wall_emission[b] - own);
        flow->wall_power[b] -= gained;
        gain += gained;
    }
    const double gained = weight * row->escaped * (flow->surroundings_emission - own);
    flow->surroundings_power -= gained;
    flow->power[row->sphere] += gain + gained;
}

int fibrad_rows_flow(const fibrad_rows *rows, uint32_t spheres, uint32_t walls, fibrad_flow *flow) {
    if (rows == NULL || flow == NULL || !flow_given(flow, spheres, walls)) return FIBRAD_E_ARGUMENT;
    if (!fibrad_rows_settled(rows)) return FIBRAD_E_STATE;
    size_t at = 0;
    for (const fibrad_record *row; (row = fibrad_rows_next(rows, &at)) != NULL;)
        if (!record_fits(row, flow, spheres, walls)) return FIBRAD_E_ARGUMENT;
    at = 0;
    for (const fibrad_record *row; (row = fibrad_rows_next(rows, &at)) != NULL;) add_row(row, flow);
    return FIBRAD_OK;
}
