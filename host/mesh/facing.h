/* facing.h - which side of a surface spheres are on. SPDX-License-Identifier: MIT */
#ifndef FACING_H
#define FACING_H

#include "fibrad.h"
#include "mesh/welded.h"

/* For each part: above 0 where spheres are before the side that is the front of triangles that are not turned, below 0
 * where they are behind it, 0 where nothing tells. Spheres, not all of them if they are many, vote by the side that
 * their centre is on of the nearest triangle, with the weight (r/distance)^2, at most 1. period: 0: the axis is open.
 * votes [parts] out. Status 0 or STATUS_MEMORY. */
int facing_votes(const struct surface *surface, const fibrad_spheres *spheres, const double period[3], double *votes);

/* The distance from a point to a part; *side: 1 if the point is before triangles that are not turned, -1 behind them,
 * 0 if nothing tells. */
double facing_distance(const struct surface *surface, const struct part *part, const double point[3],
                       const double period[3], int *side);

/* Volume that a closed part bounds, above 0 if triangles that are not turned have their fronts outside. */
double facing_volume(const struct surface *surface, const struct part *part);

#endif
