/* points.h - the points of a window. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WINDOW_POINTS_H
#define FIBRAD_WINDOW_POINTS_H

#include "sample/tables.h"

/* The points of a window, and which of them no disc has hidden so far. */
typedef struct fibrad_points {
    fibrad_disc_points set;
    uint32_t count, open;
    uint64_t seen[4];       /* bit p: point p is open */
    uint32_t occluders;     /* number of discs that have hidden points */
    uint32_t occluder[256]; /* these discs, nearest first */
} fibrad_points;

/* Beams of a window that escape may have a direction for each point. Point p of window k takes its direction from
 * this other point of the same set. */
static inline uint32_t fibrad_points_partner(uint32_t points, uint32_t p, uint32_t k) {
    return (45 * p + 21 * k) & (points - 1);
}

#endif
