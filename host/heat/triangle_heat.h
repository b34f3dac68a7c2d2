/* triangle_heat.h - what the triangles of walls gain, and their temperatures. SPDX-License-Identifier: MIT */
#ifndef TRIANGLE_HEAT_H
#define TRIANGLE_HEAT_H

#include "frames/bed_options.h"

enum { TRIANGLE_ARRAYS = 6 };

/* Of all triangles of the meshes. Zeroed: not wanted; to be freed by triangle_heat_free. */
struct triangle_heat {
    uint32_t n;                          /* triangles */
    double *flux, *temperature;          /* [2 n] as fibrad_heat_read_sides; NULL: not wanted */
    struct array shown[TRIANGLE_ARRAYS]; /* [arrays] for struct contents: flux_W_m2 and temperature_K of a triangle, and
                                          * of front and back where a triangle has both */
    size_t arrays;
};

/* Takes the arrays for the meshes of walls. Status 0 or STATUS_MEMORY; to be freed also then. */
int triangle_heat_begin(struct triangle_heat *heat, const struct walls *walls);
void triangle_heat_free(struct triangle_heat *heat);

/* Makes what is shown of the sides' fluxes, which are divided by `unit`, and temperatures. The flux of a triangle is
 * the sum of those of its sides, its temperature that at which one side would emit the mean of both. */
void triangle_heat_show(struct triangle_heat *heat, double unit);

#endif
