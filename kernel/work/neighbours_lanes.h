/* neighbours_lanes.h - which spheres can come before the windows of a sphere: shells of near ones for all directions,
 * and a march along one direction for what lies beyond. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WORK_NEIGHBOURS_LANES_H
#define FIBRAD_WORK_NEIGHBOURS_LANES_H

#include "base/lanes/laned.h"
#include "work/work.h"

/* Adds the next shell of near spheres, or sets near.full. */
void LANED(fibrad_near_extend)(fibrad_workspace *work);

/* A list of all spheres of the first shell, which there must be, that come before the window of direction w. */
const fibrad_sight *LANED(fibrad_near_sight)(fibrad_near *near, const double w[3]);

/* Appends the discs of `found` near spheres to work->disc, where their places are listed already, if they overlap the
 * window and lie ahead. Beyond its capacity all of them are counted, and no more. */
void LANED(fibrad_near_discs)(fibrad_workspace *work, const double frame[9], uint32_t found);

/* A part of a beam: all of it (0, 0, 1), or the ray at (u, v) of its window (u, v, 0). */
typedef struct fibrad_tube {
    double u, v, radius;
} fibrad_tube;

/* Appends to work->disc those before the window of direction w whose minimum depth lies in (from, to]; from < 0: those
 * in contact too. Discs that do not overlap the tube may be missing. frame: two unit vectors across w, and w. */
void LANED(fibrad_near_march)(fibrad_workspace *work, const double frame[9], const fibrad_tube *tube, double from,
                              double to);

#endif
