/* window_lanes.h - resolves one window of a beam. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_WINDOW_LANES_H
#define FIBRAD_ROW_WINDOW_LANES_H

#include "base/lanes/laned.h"
#include "work/work.h"
#include "window/points.h"

/* In packed beds the first shell then has 275 spheres, and two shells fit into the default memory. Of the pairs tried,
 * from (2.4, 1.25) to (5.5, 1.2), this was the fastest at 100 directions, with (4.2, 1.4); by 8 % over (3, 1.4) in
 * points. */
#define FIBRAD_BEAM_STRIDE ((fibrad_stride){3.9, 1.5})

/* Resolves window k of the row begun in `work`: adds what is visible of each sphere to the entries. Of points, leaves
 * in points->seen those that no sphere hides, and in points->occluder the discs that hide the others. Returns what
 * stays open, a number of points, or an area if points->count is 0. work->disc.count > work->disc.capacity: there was
 * no room for all. */
double LANED(fibrad_beam_window)(fibrad_workspace *work, const double frame[9], fibrad_points *points, uint32_t k);

#endif
