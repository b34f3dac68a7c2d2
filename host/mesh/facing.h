/* facing.h - on which side of a surface spheres lie. SPDX-License-Identifier: MIT */
#ifndef FACING_H
#define FACING_H

#include "fibrad.h"
#include "mesh/welded.h"

/* Lets spheres vote on which side of each component they lie. A sphere votes by the side of its centre at the nearest
 * triangle, with the weight (r/distance)^2, at most 1. If there are many spheres, only some of them vote. period: 0:
 * the axis is open. votes [components], out: above 0: before the fronts of triangles that are not turned; below 0:
 * behind them; 0: unknown. Status 0 or STATUS_MEMORY. */
int facing_votes(const struct surface *surface, const fibrad_spheres *spheres, const double period[3], double *votes);

/* The distance from a point to a component. *side: 1: before the fronts of triangles that are not turned; -1: behind
 * them; 0: unknown. */
double facing_distance(const struct surface *surface, const struct component *component, const double point[3],
                       const double period[3], int *side);

/* Volume within a closed component. Below 0: the fronts of triangles that are not turned are inside. */
double facing_volume(const struct surface *surface, const struct component *component);

#endif
