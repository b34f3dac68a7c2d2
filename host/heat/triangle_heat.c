/* triangle_heat.c - net flux and temperature of each triangle of walls. SPDX-License-Identifier: MIT */
#include "heat/triangle_heat.h"

#include <gsl/gsl_math.h>

static double sum_of_sides(double a, double b) { return a + b; }

static double mean_of_sides(double a, double b) { return a == b ? a : pow((gsl_pow_4(a) + gsl_pow_4(b)) / 2, 0.25); }

int triangle_heat_begin(struct side_arrays *heat, const struct walls *walls) {
    static const struct side_quantity quantity[TRIANGLE_QUANTITIES] = {
        {.name = {"flux_W_m2", "flux_front_W_m2", "flux_back_W_m2"}, .join = sum_of_sides},
        {.name = {"temperature_K", "temperature_front_K", "temperature_back_K"}, .join = mean_of_sides}};
    return side_arrays_begin(heat, &walls->meshes->triangles, quantity, TRIANGLE_QUANTITIES);
}

void triangle_heat_show(struct side_arrays *heat, double unit) {
    for (size_t s = 0; s < 2 * (size_t)heat->n; ++s) heat->quantity[TRIANGLE_FLUX].side[s] /= unit;
    side_arrays_show(heat);
}
