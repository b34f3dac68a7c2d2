/* window_lanes.h - computes one window of a beam. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_WINDOW_LANES_H
#define FIBRAD_ROW_WINDOW_LANES_H

#include "base/lanes/laned.h"
#include "workspace/workspace.h"

/* With these numbers the first shell of a packed bed has 275 spheres, and two shells fit into the default memory.
 * Pairs from (2.4, 1.25) to (5.5, 1.2) were tried. This one and (4.2, 1.4) were the fastest at 100 directions. They
 * take 8 % less time than (3, 1.4) with points. */
#define FIBRAD_BEAM_STRIDE ((fibrad_stride){3.9, 1.5})

/* Computes window k of the row begun in `work`: adds what is visible of each sphere to the entries. k FIBRAD_NONE, for
 * exact areas without triangles: nothing is added. With points,
 * points->seen has the points that no sphere hides afterwards, and points->occluder has the discs that hide the
 * others. Returns the part that stays open: a number of points, or an area if points->count is 0. If
 * work->disc.count > work->disc.capacity, there was no room for all discs. */
double LANED(fibrad_beam_window)(fibrad_workspace *work, const double frame[9], fibrad_points *points, uint32_t k);

/* The same by masks. work->masks: in: the open window; out: which points are still open. What spheres hide is added to
 * near.count, and to entries. k FIBRAD_NONE: nothing is added. False: a triangle may come before the window. Then
 * nothing has been added. */
bool LANED(fibrad_mask_window)(fibrad_workspace *work, const double frame[9], uint32_t k);

#endif
