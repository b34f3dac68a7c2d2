/* wall_share_lanes.h - which walls the open part of a window meets, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_WALL_SHARE_LANES_H
#define FIBRAD_ROW_WALL_SHARE_LANES_H

#include "base/lanes/laned.h"
#include "row/work.h"
#include "window/points.h"

/* Adds `rest`, the open part of window k of n, which meets no sphere, to work->wall by what it meets. points: as
 * fibrad_beam_window has left them; count 0: areas are exact, and the discs of `work` decide what is open. turned:
 * whether the directions have been turned. */
void LANED(fibrad_walls_share)(fibrad_workspace *work, const double frame[9], const fibrad_points *points, uint32_t k,
                               uint32_t n, bool turned, double rest);

#endif
