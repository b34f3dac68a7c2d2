/* areas.h - exact visible areas of discs in a window, front to back. SPDX-License-Identifier: MIT
 *
 * The window is the unit disc about the origin. Its open region is what no disc covers so far; discs are handed over
 * front to back and take their visible areas from it. docs/methods.md section 4 explains the algorithm. */
#ifndef FIBRAD_BED_AREAS_H
#define FIBRAD_BED_AREAS_H

#include "base/arena.h"
#include "base/port.h"

/* Arcs, each counter-clockwise from p to q on a circle (its number) and at most half of it; a and b tell the places of
 * p and q on it. */
typedef struct fibrad_arcs {
    double *a, *b, *px, *py, *qx, *qy, *circle;
    uint32_t count;
} fibrad_arcs;

/* Intervals of the new disc's circle that are out of sight, and the circles on account of which they are. */
typedef struct fibrad_intervals {
    double *from, *to, *circle;
    uint32_t count;
    bool all; /* nothing is in sight */
} fibrad_intervals;

#define FIBRAD_PIECES 64 /* arcs integrated at a time, about */

typedef struct fibrad_areas {
    uint32_t discs, arcs;        /* capacities: discs that a window may meet, arcs that bound its open region, ... */
    uint32_t seconds;            /* ... second parts at a time */
    uint32_t circles;            /* the window, and the discs whose circles may bound the open region */
    double *x, *y, *r, *inverse; /* [discs + 2] circle 0 is the window; inverse: 1/r */
    double *ox, *oy;             /* [discs + 2] about where the area of each is computed */
    double *sense;               /* [discs + 2] what its arcs add to their takers: the window's +1, others -1 */
    double *area;                /* [discs + 2] what is seen of each; that of circle 0 means nothing */
    uint32_t *whose;             /* [discs + 2] the caller's number of each */
    double *from, *to;           /* [discs + 2] what the new disc covers of each circle, ... */
    double *sx, *sy, *ex, *ey;   /* ... and the points where that begins and ends */
    fibrad_intervals hidden;     /* [discs + 1] */
    fibrad_arcs open, left; /* [arcs] the boundary of the open region; what is left of it when a disc has taken its */
    fibrad_arcs taken;      /* arcs that have left it and wait to be integrated, ... */
    double *taker;          /* ... and the circles of the discs that took them */
    fibrad_arcs second[2];  /* [seconds] second parts, that stay or go, of arcs cut in three: for a moment */
    bool overflow;          /* too many arcs for the memory: start again with more discs */
} fibrad_areas;

void fibrad_areas_layout(fibrad_areas *areas, fibrad_arena *arena, uint32_t discs);

#endif
