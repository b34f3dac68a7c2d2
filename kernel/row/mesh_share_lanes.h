/* mesh_share_lanes.h - what triangles take of a window from spheres and from the open part.
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_MESH_SHARE_LANES_H
#define FIBRAD_ROW_MESH_SHARE_LANES_H

#include "base/lanes/laned.h"
#include "workspace/workspace.h"

/* Finds the points of window k whose lines meet a triangle first. The spheres before the window are known. points:
 * of the window; count 0: the window has areas, and `open` of it is open. What triangles hide is taken from the
 * entries, or left out of them. work->met has the points that meet triangles. With areas the entries are added here.
 * Returns the part that stays open. */
double LANED(fibrad_mesh_share)(fibrad_workspace *work, const double frame[9], fibrad_points *points, uint32_t k,
                                double open);

/* Adds what triangles take in window k to the entries of their slots. These entries follow those of the spheres. */
void LANED(fibrad_mesh_count)(fibrad_workspace *work, const double frame[9], uint32_t k);

/* The line of point p of the present window, if work->met->any: its beginning [L] and its direction, of any length. */
void LANED(fibrad_mesh_line)(const fibrad_workspace *work, const double frame[9], uint32_t p, double origin[3],
                             double w[3]);

/* The place where this line meets its triangle [L], if it meets one. */
void LANED(fibrad_mesh_place)(const fibrad_workspace *work, const double frame[9], uint32_t p, double at[3]);

/* Whether a triangle may come before what is seen down to a depth. */
static inline bool fibrad_mesh_near(const fibrad_workspace *work, double depth) {
    return work->clear_mesh < __builtin_inf() && !(depth * depth + 1 < work->clear_mesh * work->clear_mesh);
}

#endif
