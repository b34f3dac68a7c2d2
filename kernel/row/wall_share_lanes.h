/* wall_share_lanes.h - which walls the open part of a window meets, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_WALL_SHARE_LANES_H
#define FIBRAD_ROW_WALL_SHARE_LANES_H

#include "base/lanes/laned.h"
#include "workspace/workspace.h"

/* The windows of a row. */
typedef struct fibrad_window_set {
    void (*frame)(const void *from, uint32_t k, uint32_t points, double frame[9]); /* that of window k */
    const void *from;                                                              /* handed to it */
    uint32_t directions;                                                           /* how many windows there are */
    double whole; /* the size of a window, or about that of masks */
    bool ends;    /* the first and the last window count half in differences of even and odd windows */
} fibrad_window_set;

/* Adds the open part of window k of a row, which meets no sphere, to work->walls->sums by what it meets. Lines that
 * are cut are added to work->wall. rest: the size of the open part. whole: the size of the window. points: as
 * fibrad_beam_window has left them. With points->count 0 areas are exact, and the discs of `work` tell which points are
 * open. */
void LANED(fibrad_walls_share)(fibrad_workspace *work, const double frame[9], const fibrad_points *points, uint32_t k,
                               const fibrad_window_set *set, double rest, double whole);

/* Whether a beam of a window meets nothing if the window turns from its direction to `way` [unit vector]. frame: of the
 * window. p: the point of the beam in the frame, x and y. */
bool LANED(fibrad_beam_turned)(const fibrad_workspace *work, const double frame[9], const double p[2],
                               const double way[3]);

/* Adds the view factors of walls to work->wall[] when all windows are done. parts: as in fibrad_wall_factors. */
void LANED(fibrad_walls_complete)(fibrad_workspace *work, const fibrad_window_set *set, double parts[2]);

#endif
