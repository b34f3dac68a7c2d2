/* lines_lanes.h - lines of a window and the triangles that they meet first. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_FACING_LINES_LANES_H
#define FIBRAD_FACING_LINES_LANES_H

#include "base/lanes/laned.h"
#include "workspace/workspace.h"

/* The depth at which the line of a point leaves sphere i. */
static inline double fibrad_point_exit(const fibrad_points *points, uint32_t p) {
    const double u = points->set.x[p], v = points->set.y[p];
    return fibrad_sqrt(fibrad_max(0, 1 - u * u - v * v));
}

/* Lays out the parallel lines of all points. The line of point p ends at depth[p]. depth NULL: at any depth. */
void LANED(fibrad_lines_parallel)(fibrad_met *met, const fibrad_points *points, const double *depth);

/* Lays out lines of the points given by bits. Each line has a direction of its own in window k. spread: how wide the
 * directions are. The lines are sorted so that lines of a block are near each other at depth `at`. Returns the
 * number of lines. */
uint32_t LANED(fibrad_lines_spread)(fibrad_met *met, const fibrad_points *points, const uint64_t chosen[4], uint32_t k,
                                    double spread, double at);

/* Notes which of the listed triangles the lines meet first. What was noted before stays if it comes before them.
 * slack: lengths below this may be rounding errors. */
void LANED(fibrad_lines_meet)(fibrad_workspace *work, double slack);

/* Follows lines that have met nothing down to a depth, one by one, from there to another depth. Far away more images
 * lie beside a window than before its lines. */
void LANED(fibrad_lines_follow)(fibrad_workspace *work, const double frame[9], double from, double deepest);

/* Writes to the points what their lines meet. Returns the number of lines that meet a triangle. */
uint32_t LANED(fibrad_lines_tell)(fibrad_met *met);

/* The depth beyond which no line looks after what the lines have met so far. */
double LANED(fibrad_lines_last)(fibrad_lines *lines);

/* The side that the deepest of the lines meets. FIBRAD_NO_SIDE: no line meets a side. */
uint32_t LANED(fibrad_lines_deepest)(const fibrad_lines *lines);

#endif
