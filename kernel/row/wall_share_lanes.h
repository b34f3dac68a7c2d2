/* wall_share_lanes.h - which walls the open part of a window meets, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_WALL_SHARE_LANES_H
#define FIBRAD_ROW_WALL_SHARE_LANES_H

#include "base/lanes/laned.h"
#include "row/work.h"
#include "window/points_lanes.h"

/* Adds `rest`, what is open of window k of n and thus meets no sphere, to work->wall by the walls it meets. points: as
 * the window has left them; count 0: areas are exact, and the discs in hand tell what is open. */
void LANED(fibrad_walls_share)(fibrad_workspace *work, const double frame[9], const fibrad_points *points, uint32_t k,
                               uint32_t n, double rest);

#endif
