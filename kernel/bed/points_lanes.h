/* points_lanes.h - points of a window that a sphere hides, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_BED_POINTS_LANES_H
#define FIBRAD_BED_POINTS_LANES_H

#include "base/lanes/laned.h"
#include "sample/tables.h"

/* The points of a window that no disc has hidden so far. */
typedef struct fibrad_points {
    fibrad_disc_points set;
    uint32_t count, open;
    uint64_t seen[4]; /* bit p: point p is open */
    uint32_t takers;
    uint32_t taker[256]; /* the discs that have taken points, nearest first */
} fibrad_points;

/* Takes the open points inside a disc: the ray-sphere test of a parallel beam, without a square root. Returns how many
 * there are. */
uint32_t LANED(fibrad_points_disc)(fibrad_points *points, double x, double y, double r);

#endif
