/* near_lanes.h - the spheres that can come before the windows of a sphere. Near spheres are listed in shells
 * for all directions. A walk along one direction finds the spheres beyond. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_NEAR_NEAR_LANES_H
#define FIBRAD_NEAR_NEAR_LANES_H

#include "base/lanes/laned.h"
#include "workspace/workspace.h"

/* Adds the next shell of near spheres, or sets near.full. */
void LANED(fibrad_near_extend)(fibrad_workspace *work);

/* A list with all spheres of the first shell that come before the window of direction w. The first shell must exist. */
const fibrad_sight *LANED(fibrad_near_sight)(fibrad_near *near, const double w[3]);

/* Appends the discs of near spheres that overlap the window and lie ahead to work->disc. found: number of spheres.
 * Their places are listed in work->disc.near. Discs beyond the capacity are only counted. */
void LANED(fibrad_near_discs)(fibrad_workspace *work, const double frame[9], uint32_t found);

/* A part of a beam: the whole beam (0, 0, 1), or the ray at (u, v) of its window (u, v, 0). */
typedef struct fibrad_tube {
    double u, v, radius;
} fibrad_tube;

/* Appends to work->disc the discs before the window of direction w whose minimum depth lies in (from, to]. from < 0:
 * spheres in contact are included. Discs that do not overlap the tube may be missing. frame: two unit vectors across
 * w, then w. */
void LANED(fibrad_near_walk)(fibrad_workspace *work, const double frame[9], const fibrad_tube *tube, double from,
                             double to);

#endif
