/* triangle_heat.h - what the triangles of walls gain, and their temperatures. SPDX-License-Identifier: MIT */
#ifndef TRIANGLE_HEAT_H
#define TRIANGLE_HEAT_H

#include "bed/wall_option.h"

/* What is written of a triangle: the sum of the fluxes of its sides, and the temperature at which one side would emit
 * the mean of both. */
enum { TRIANGLE_FLUX, TRIANGLE_TEMPERATURE, TRIANGLE_QUANTITIES };

/* Takes the arrays for the meshes of walls. Status 0 or STATUS_MEMORY. */
int triangle_heat_begin(struct side_arrays *heat, const struct walls *walls);

/* Fills them, from what fibrad_radiation_sides or fibrad_transient_sides has put into those of sides, fluxes divided by
 * a unit. */
void triangle_heat_show(struct side_arrays *heat, double unit);

#endif
