/* points_lanes.h - points of a window that discs hide, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WINDOW_POINTS_LANES_H
#define FIBRAD_WINDOW_POINTS_LANES_H

#include "base/lanes/laned.h"
#include "window/discs.h"
#include "points/points.h"

/* Which points of a word of 64 lie in a disc. */
uint64_t LANED(fibrad_points_within)(const fibrad_points *points, uint32_t word, double x, double y, double r);

/* Hides the open points inside a disc. */
void LANED(fibrad_points_disc)(fibrad_points *points, double x, double y, double r);

/* Hides the open points inside discs, from front to back: order[from] to the last disc not deeper than `depth`. This
 * is the test of rays and spheres for a parallel beam, without a square root. hidden_points: out: how many points
 * each disc hides. Returns the position in the order where the deeper discs begin. */
uint32_t LANED(fibrad_points_discs)(fibrad_points *points, const fibrad_discs *disc, uint32_t from, double depth);

#endif
