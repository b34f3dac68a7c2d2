/* radiosity.c - powers by one radiosity per sphere, from a matrix of view factors. SPDX-License-Identifier: MIT
 *
 * The equations and their solution are those of solve.c, with spheres for patches and the rows' exchange areas
 * A_i F_ij for those of beams. */
#include "base/port.h"
#include "fibrad.h"

#define PI 3.14159265358979323846

/* Net flow to sphere i at the values v, those of the surroundings being 0. */
static double net_flow(const fibrad_rows *rows, const double *r, const double *v, uint32_t i, double *away) {
    const double area = 4 * PI * r[i] * r[i];
    double sum = 0, open = 1;
    for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) {
        sum += rows->f[k] * (v[rows->col[k]] - v[i]);
        open -= rows->f[k];
    }
    *away = area * open * v[i];
    return area * sum - *away;
}

static double emission_of(const fibrad_heat_sources *s, uint32_t i) {
    const double t = s->temperature[i], t0 = s->surroundings;
    return s->sigma * (t * t + t0 * t0) * (t + t0) * (t - t0);
}

static bool valid(const fibrad_rows *rows, const double *r, const fibrad_heat_sources *s) {
    if (!(s->surroundings >= 0 && fibrad_finite(s->surroundings) && s->sigma > 0 && fibrad_finite(s->sigma)))
        return false;
    if (!(s->tolerance >= 0 && s->tolerance < 1)) return false;
    for (uint32_t i = 0; i < rows->n; i++) {
        if (!(r[i] > 0 && s->temperature[i] >= 0 && fibrad_finite(s->temperature[i]))) return false;
        if (!(s->emissivity[i] >= 0 && s->emissivity[i] <= 1)) return false;
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++)
            if (rows->col[k] >= rows->n) return false;
    }
    return true;
}

int fibrad_radiosity(const fibrad_rows *rows, const double *r, const fibrad_heat_sources *s, double *scratch,
                     fibrad_heat_result *result) {
    if (rows == NULL || r == NULL || s == NULL || scratch == NULL || result == NULL || result->power == NULL ||
        s->temperature == NULL || s->emissivity == NULL || !valid(rows, r, s))
        return FIBRAD_E_ARGUMENT;
    const uint32_t n = rows->n, limit = s->sweeps_max > 0 ? s->sweeps_max : 1000;
    const double tolerance = s->tolerance > 0 ? s->tolerance : 1e-6;
    double *radiosity = scratch, *direction = scratch + n, *product = direction + n, *net = result->power, away;
    double slope = 0, scale = 0, weights = 0, mean = 0, largest = 0;
    for (uint32_t i = 0; i < n; i++) {
        const double area = s->emissivity[i] * (r[i] * r[i]), e = radiosity[i] = emission_of(s, i);
        weights += area, mean += area * e, largest += 4 * PI * area * e * e;
    }
    for (uint32_t i = 0; i < n && weights > 0; i++) {
        const double d = radiosity[i] - mean / weights;
        scale += 4 * PI * s->emissivity[i] * (r[i] * r[i]) * d * d;
    }
    for (uint32_t i = 0; i < n; i++) net[i] = net_flow(rows, r, radiosity, i, &away);
    uint32_t sweeps = 1;
    for (;; sweeps++) {
        const double last = slope;
        slope = 0;
        for (uint32_t i = 0; i < n; i++) { /* the residual, in `product` for the time being */
            const double eps = s->emissivity[i], area = 4 * PI * r[i] * r[i];
            const double z = eps * (emission_of(s, i) - radiosity[i]) + (1 - eps) * net[i] / area;
            product[i] = eps < 1 ? z : 0;
            if (eps < 1) slope += area * z * z / (1 - eps);
        }
        if (slope <= fibrad_max(tolerance * tolerance * scale, 1e-28 * largest) || sweeps >= limit) break;
        const double keep = sweeps > 1 ? slope / last : 0;
        for (uint32_t i = 0; i < n; i++) direction[i] = product[i] + (keep > 0 ? keep * direction[i] : 0);
        double curvature = 0;
        for (uint32_t i = 0; i < n; i++) {
            const double eps = s->emissivity[i], p = direction[i], area = 4 * PI * r[i] * r[i];
            product[i] = net_flow(rows, r, direction, i, &away);
            if (eps < 1) curvature += p * (area * p * eps / (1 - eps) - product[i]);
        }
        if (!(curvature > 0)) break;
        for (uint32_t i = 0; i < n; i++) {
            radiosity[i] += slope / curvature * direction[i];
            net[i] += slope / curvature * product[i];
        }
    }
    result->surroundings_power = 0;
    for (uint32_t i = 0; i < n; i++) {
        net[i] = net_flow(rows, r, radiosity, i, &away);
        result->surroundings_power += away;
    }
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++) result->wall_power[k] = 0;
    result->error_patches = result->error_beams = 0;
    result->sweeps = sweeps;
    result->residual = scale > 0 ? fibrad_sqrt(slope / scale) : 0;
    return FIBRAD_OK;
}
