/* clip_lanes.h - visible areas, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WINDOW_CLIP_LANES_H
#define FIBRAD_WINDOW_CLIP_LANES_H

#include "base/lanes/laned.h"
#include "window/areas.h"

/* Begins a window. All of it is open. */
void LANED(fibrad_areas_begin)(fibrad_areas *areas);

/* Hands over the next discs, which[0] to which[count - 1]. A window takes at most areas->discs discs. The caller's
 * number of a disc is `first` higher. The function ends when nothing is open. Then areas->open is false. Returns the
 * number of discs that it has used. */
uint32_t LANED(fibrad_areas_discs)(fibrad_areas *areas, uint32_t first, const uint32_t *which, uint32_t count,
                                   const double *x, const double *y, const double *r);

/* Completes areas->area[c] for circles c = 1 ... areas->circles - 1. This is the visible area of disc
 * areas->whose[c]. Discs without a circle are hidden. Returns the area that is still open. */
double LANED(fibrad_areas_end)(fibrad_areas *areas);

#endif
