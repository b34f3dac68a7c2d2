/* mesh_share_lanes.h - what of a window triangles take from spheres and from the open. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_MESH_SHARE_LANES_H
#define FIBRAD_ROW_MESH_SHARE_LANES_H

#include "base/lanes/laned.h"
#include "work/work.h"

/* Looks which points of window k, whose spheres are resolved, meet a triangle first. points: of the window, or count 0:
 * then its areas are known, and `open` of them is. Takes from entries, or leaves out of them, what triangles hide, and
 * leaves in work->met which points meet them; with areas adds the entries. Returns what stays open. */
double LANED(fibrad_mesh_share)(fibrad_workspace *work, const double frame[9], fibrad_points *points, uint32_t k,
                                double open);

/* Adds what triangles take in window k to the entries of their slots, which follow those of the spheres. */
void LANED(fibrad_mesh_count)(fibrad_workspace *work, const double frame[9], uint32_t k);

/* The line of point p of the window in hand, if work->met->any: where it begins [L], and its direction, of any length.
 */
void LANED(fibrad_mesh_line)(const fibrad_workspace *work, const double frame[9], uint32_t p, double origin[3],
                             double w[3]);

/* Where it meets its triangle [L], if it does. */
void LANED(fibrad_mesh_place)(const fibrad_workspace *work, const double frame[9], uint32_t p, double at[3]);

/* Whether a triangle may come before what is seen down to a depth. */
static inline bool fibrad_mesh_near(const fibrad_workspace *work, double depth) {
    return work->clear_mesh < __builtin_inf() && !(depth * depth + 1 < work->clear_mesh * work->clear_mesh);
}

#endif
