/* wall_share_lanes.h - which walls the open part of a window meets, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_WALL_SHARE_LANES_H
#define FIBRAD_ROW_WALL_SHARE_LANES_H

#include "base/lanes/laned.h"
#include "work/work.h"
#include "window/points.h"

/* Adds `rest`, the open part of window k of a row, which meets no sphere, to work->walls->sums by what it meets, or,
 * where lines are cut, to work->wall. points: as fibrad_beam_window has left them; count 0: areas are exact, and the
 * discs of `work` decide what is open. */
void LANED(fibrad_walls_share)(fibrad_workspace *work, const double frame[9], const fibrad_points *points, uint32_t k,
                               const fibrad_beam_rule *rule, double rest);

/* Adds to work->wall[] what work->walls->sums say, once all windows are done. parts: as of fibrad_wall_factors. */
void LANED(fibrad_walls_complete)(fibrad_workspace *work, const fibrad_beam_rule *rule, double parts[2]);

#endif
