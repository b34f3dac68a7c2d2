/* mesh_lines_lanes.h - lines of a window and the triangles that they meet first. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_LINES_MESH_LINES_LANES_H
#define FIBRAD_LINES_MESH_LINES_LANES_H

#include "base/lanes/laned.h"
#include "work/work.h"

/* How deep the line of a point leaves sphere i. */
static inline double fibrad_point_exit(const fibrad_points *points, uint32_t p) {
    const double u = points->set.x[p], v = points->set.y[p];
    return fibrad_sqrt(fibrad_max(0, 1 - u * u - v * v));
}

/* Lays out the parallel lines of all points; line of point p does not look beyond depth[p] (NULL: any depth). */
void LANED(fibrad_lines_parallel)(fibrad_met *met, const fibrad_points *points, const double *depth);

/* Lays out lines of the points given by bits, with directions of their own in window k that spread so far, so that they
 * are near each other at a depth. Returns how many they are. */
uint32_t LANED(fibrad_lines_spread)(fibrad_met *met, const fibrad_points *points, const uint64_t chosen[4], uint32_t k,
                                    double spread, double at);

/* Notes which of the listed triangles the lines meet first, besides what was noted before. slack: lengths that may be
 * rounding. */
void LANED(fibrad_lines_meet)(fibrad_workspace *work, double slack);

/* Follows the lines that have met nothing down to a depth one by one from there, to another depth: far away, more
 * images lie beside a window than before its lines. */
void LANED(fibrad_lines_follow)(fibrad_workspace *work, const double frame[9], double from, double deepest);

/* Tells their points what the lines meet. Returns how many meet anything. */
uint32_t LANED(fibrad_lines_tell)(fibrad_met *met);

/* Beyond which depth no line looks, after what they have met so far. */
double LANED(fibrad_lines_last)(fibrad_lines *lines);

/* The side that the deepest of the lines meets; FIBRAD_NO_SIDE: they meet none. */
uint32_t LANED(fibrad_lines_deepest)(const fibrad_lines *lines);

#endif
