/* points_lanes.h - points of a window that a sphere hides, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WINDOW_POINTS_LANES_H
#define FIBRAD_WINDOW_POINTS_LANES_H

#include "base/lanes/laned.h"
#include "sample/tables.h"
#include "window/discs.h"

/* The points of a window that no disc has hidden so far. */
typedef struct fibrad_points {
    fibrad_disc_points set;
    uint32_t count, open;
    uint64_t seen[4]; /* bit p: point p is open */
    uint32_t occluders;
    uint32_t occluder[256]; /* the discs that have taken points, nearest first */
} fibrad_points;

/* Takes away the open points inside a disc. */
void LANED(fibrad_points_disc)(fibrad_points *points, double x, double y, double r);

/* Lets the discs from order[from] on down to `depth`, from front to back, take the open points inside them: the
 * ray-sphere test of a parallel beam, without a square root. hits tells how many each takes. Returns where in the order
 * the deeper ones begin. */
uint32_t LANED(fibrad_points_discs)(fibrad_points *points, const fibrad_discs *disc, uint32_t from, double depth);

#endif
