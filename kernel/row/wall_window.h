/* wall_window.h - a window as walls see it: the disc of directions it stands for. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_WALL_WINDOW_H
#define FIBRAD_ROW_WALL_WINDOW_H

#include "work/wall_sum.h"

typedef struct fibrad_wall_window {
    const double *frame; /* its axes */
    uint32_t k, n;       /* window k of n */
    double open, hidden; /* parts of it, areas or points */
    double part;         /* of its disc of directions: 1; less if the slope is not known */
    double slope[2];     /* how fast the open part grows as the direction turns towards the axes, per radian */
    double wide;         /* radius of the disc of directions, ... */
    double spread;       /* ... and of the part of it that is needed among walls as near as these */
    double sharpness[3]; /* of the edge between the planes across axes a and a + 1, or, [2], of a cylinder's end: one
                            over what passing by, distance times sine of the angle, changes by over that half width */
} fibrad_wall_window;

/* Completes a window of which the fields down to slope are set. */
void fibrad_wall_window_begin(fibrad_wall_window *window, const fibrad_wall_view *view);

/* Adds a window that all goes to one wall, or of which one number tells the shares, to the regions. False: neither, so
 * lines must tell. turned: whether the directions have been turned. */
bool fibrad_wall_window_simple(const fibrad_wall_window *window, const fibrad_wall_view *view, bool turned,
                               fibrad_wall_sums *sums);

/* Whether lines of the window lie in an octant. */
bool fibrad_wall_window_has(const fibrad_wall_window *window, const fibrad_wall_view *view, uint32_t octant);

/* Adds to a region of it the open area or points, and the share that the region would have if nothing were hidden. */
void fibrad_wall_window_add(const fibrad_wall_window *window, uint32_t region, double open, double share,
                            fibrad_wall_sums *sums);

#endif
