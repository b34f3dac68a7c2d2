/* plot_slice.h - a slice through a bed across y, its spheres and walls coloured, by gnuplot. SPDX-License-Identifier:
 * MIT
 */
#ifndef PLOT_SLICE_H
#define PLOT_SLICE_H

#include <stdio.h>

#include "bed/bed.h"
#include "bed/wall_option.h"

/* Where a bed is cut, and what of it is shown. */
struct plot_slice {
    const struct bed *bed;
    const struct walls *walls; /* NULL: none */
    double y;                  /* of the plane: that through the centre nearest the middle of the bed */
    double low[3], high[3];    /* the bed, and walls not far from it */
    double scale;              /* coordinates are shown as multiples of it */
    char unit[32];             /* of the lengths shown; empty: not known */
    char place[64];            /* y, as shown */
};

/* metres: of the unit of the bed's lengths; 0: not known. */
void plot_slice_of(struct plot_slice *slice, const struct bed *bed, const struct walls *walls, double metres);

/* Draws the circles in which the spheres cut the plane, coloured by value [n] with the palette in force; those marked
 * 0 in wanted [n] are left out (NULL: none). Walls that meet the plane are lines, coloured by wall_value [walls], or
 * grey if that is NULL. */
void plot_slice_draw(FILE *script, const struct plot_slice *slice, const double *value, const unsigned char *wanted,
                     const double *wall_value);

#endif
