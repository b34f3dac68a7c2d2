/* points_lanes.h - points of a window that discs hide, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WINDOW_POINTS_LANES_H
#define FIBRAD_WINDOW_POINTS_LANES_H

#include "base/lanes/laned.h"
#include "window/discs.h"
#include "window/points.h"

/* The points of one word of 64 that a disc holds. */
uint64_t LANED(fibrad_points_within)(const fibrad_points *points, uint32_t word, double x, double y, double r);

/* Hides the open points inside a disc. */
void LANED(fibrad_points_disc)(fibrad_points *points, double x, double y, double r);

/* Hides the open points inside the discs order[from] to the last one not deeper than `depth`, from front to back: the
 * ray-sphere test of a parallel beam, without a square root. Writes to hidden_points how many each disc hides. Returns
 * the position in the order where the deeper ones begin. */
uint32_t LANED(fibrad_points_discs)(fibrad_points *points, const fibrad_discs *disc, uint32_t from, double depth);

#endif
