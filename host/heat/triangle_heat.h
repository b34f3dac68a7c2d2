/* triangle_heat.h - net flux and temperature of each triangle of walls. SPDX-License-Identifier: MIT */
#ifndef TRIANGLE_HEAT_H
#define TRIANGLE_HEAT_H

#include "bed/wall_option.h"

/* Quantities of a triangle: the sum of the fluxes of its two sides, and the temperature whose T^4 is the mean of T^4 of
 * both sides. */
enum { TRIANGLE_FLUX, TRIANGLE_TEMPERATURE, TRIANGLE_QUANTITIES };

/* Allocates the arrays for all triangles of walls. Status 0 or STATUS_MEMORY. */
int triangle_heat_begin(struct side_arrays *heat, const struct walls *walls);

/* Fills the arrays of triangles from the arrays of sides, which fibrad_radiation_sides or fibrad_transient_sides has
 * written. Divides fluxes by `unit` before. */
void triangle_heat_show(struct side_arrays *heat, double unit);

#endif
