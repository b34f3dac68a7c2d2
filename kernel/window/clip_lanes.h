/* clip_lanes.h - visible areas, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WINDOW_CLIP_LANES_H
#define FIBRAD_WINDOW_CLIP_LANES_H

#include "base/lanes/laned.h"
#include "window/areas.h"

/* Begins a window: all of it is open. */
void LANED(fibrad_areas_begin)(fibrad_areas *areas);

/* Hands over the next discs, which[0] to which[count - 1], not more than areas->discs in one window; their numbers are
 * for the caller `first` higher. Ends once nothing is open, which sets areas->open to false, and returns how many discs
 * it has used. */
uint32_t LANED(fibrad_areas_discs)(fibrad_areas *areas, uint32_t first, const uint32_t *which, uint32_t count,
                                   const double *x, const double *y, const double *r);

/* Completes areas->area[c] for circles c = 1 ... areas->circles - 1, the visible area of disc areas->whose[c]; other
 * discs are hidden. Returns the area that is still open. */
double LANED(fibrad_areas_end)(fibrad_areas *areas);

#endif
