/* plot_slice.h - a slice through a bed across y with coloured spheres and walls. SPDX-License-Identifier: MIT */
#ifndef PLOT_SLICE_H
#define PLOT_SLICE_H

#include <stdio.h>

#include "bed/bed.h"
#include "bed/wall_option.h"

/* A slice: its plane, its range and its unit. */
struct plot_slice {
    const struct bed *bed;
    const struct walls *walls; /* NULL: none */
    double y;                  /* of the plane, which goes through the centre nearest to the middle of the bed */
    double low[3], high[3];    /* range: the bed, and walls near the bed */
    double scale;              /* unit of the axes [L] */
    char unit[32];             /* name of that unit; "": not known */
    char place[64];            /* y with its unit, for titles */
};

/* Makes a slice through a bed. metres: the bed's unit of length [m]; 0: not known. */
void plot_slice_of(struct plot_slice *slice, const struct bed *bed, const struct walls *walls, double metres);

/* Draws the circles in which the plane cuts spheres, coloured by value [n] with the current palette. wanted [n]: 0: the
 * sphere is left out; NULL: all spheres are drawn. Walls that meet the plane are lines, coloured by wall_value [walls].
 * wall_value NULL: grey. */
void plot_slice_draw(FILE *script, const struct plot_slice *slice, const double *value, const unsigned char *wanted,
                     const double *wall_value);

#endif
