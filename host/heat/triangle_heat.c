/* triangle_heat.c - what the triangles of walls gain, and their temperatures. SPDX-License-Identifier: MIT */
#include "heat/triangle_heat.h"

#include <gsl/gsl_math.h>
#include <stdlib.h>

#include "cli/message.h"

int triangle_heat_begin(struct triangle_heat *heat, const struct walls *walls) {
    const struct fibrad_triangles *all = &walls->meshes->triangles;
    static const char *const names[TRIANGLE_ARRAYS] = {"flux_W_m2",      "temperature_K",       "flux_front_W_m2",
                                                       "flux_back_W_m2", "temperature_front_K", "temperature_back_K"};
    bool both = false;
    for (uint32_t t = 0; t < all->n; ++t)
        both = both || (all->front[t] != FIBRAD_NO_BODY && all->back[t] != FIBRAD_NO_BODY);
    *heat = (struct triangle_heat){.n = all->n, .arrays = both ? TRIANGLE_ARRAYS : 2};
    double *values = calloc((4 + heat->arrays) * (size_t)all->n, sizeof *values);
    if (!values) return message_memory();
    heat->flux = values, heat->temperature = values + 2 * (size_t)all->n;
    for (size_t k = 0; k < heat->arrays; ++k)
        heat->shown[k] = (struct array){.name = names[k], .data = values + (4 + k) * all->n, .length = all->n};
    return STATUS_OK;
}

void triangle_heat_free(struct triangle_heat *heat) {
    free(heat->flux);
    *heat = (struct triangle_heat){0};
}

/* The sum, or the mean of the fourth powers, of the numbers that are there of two. */
static double sum_of_two(double a, double b) { return isnan(a) ? b : isnan(b) ? a : a + b; }

static double mean_of_two(double a, double b) {
    if (isnan(a) || isnan(b) || a == b) return isnan(a) ? b : a;
    return pow((gsl_pow_4(a) + gsl_pow_4(b)) / 2, 0.25);
}

void triangle_heat_show(struct triangle_heat *heat, double unit) {
    double *flux = heat->flux, *kelvins = heat->temperature, *shown = heat->temperature + 2 * (size_t)heat->n;
    const size_t n = heat->n;
    for (size_t t = 0; t < n; ++t) {
        flux[2 * t] /= unit, flux[2 * t + 1] /= unit;
        shown[t] = sum_of_two(flux[2 * t], flux[2 * t + 1]);
        shown[n + t] = mean_of_two(kelvins[2 * t], kelvins[2 * t + 1]);
        for (size_t k = 0; k < 2 && heat->arrays > 2; ++k)
            shown[(2 + k) * n + t] = flux[2 * t + k], shown[(4 + k) * n + t] = kelvins[2 * t + k];
    }
}
