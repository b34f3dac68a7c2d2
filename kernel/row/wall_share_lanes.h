/* wall_share_lanes.h - which walls the open part of a window meets, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_WALL_SHARE_LANES_H
#define FIBRAD_ROW_WALL_SHARE_LANES_H

#include "base/lanes/laned.h"
#include "work/work.h"
#include "window/points.h"

/* Adds the open part of window k of a row, which meets no sphere, to work->walls->sums by what it meets. Lines that
 * are cut are added to work->wall. rest: the size of the open part. points: as fibrad_beam_window has left them.
 * With points->count 0 areas are exact, and the discs of `work` tell which points are open. */
void LANED(fibrad_walls_share)(fibrad_workspace *work, const double frame[9], const fibrad_points *points, uint32_t k,
                               const fibrad_beam_rule *rule, double rest);

/* Adds the view factors of walls to work->wall[] when all windows are done. parts: as in fibrad_wall_factors. */
void LANED(fibrad_walls_complete)(fibrad_workspace *work, const fibrad_beam_rule *rule, double parts[2]);

#endif
