/* window_lanes.h - what one window of a beam sees. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_WINDOW_LANES_H
#define FIBRAD_ROW_WINDOW_LANES_H

#include "row/work.h"
#include "window/points_lanes.h"

/* Window k of the row begun in `work`: adds what it sees to the entries. Of points, leaves in points->seen those that
 * no sphere hides, and in points->occluder the discs that have taken the others. Returns what stays open, a number of
 * points, or an area if points->count is 0. work->disc.count > work->disc.capacity: there was no room for all. */
double LANED(fibrad_beam_window)(fibrad_workspace *work, const double frame[9], fibrad_points *points, uint32_t k);

#endif
