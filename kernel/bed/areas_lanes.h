/* areas_lanes.h - visible areas, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_BED_AREAS_LANES_H
#define FIBRAD_BED_AREAS_LANES_H

#include "base/lanes/laned.h"
#include "bed/areas.h"

/* An open window. */
void LANED(fibrad_areas_begin)(fibrad_areas *areas);

/* Hands over the next disc, with a number of the caller's, at most areas->discs of them. False once nothing is open. */
bool LANED(fibrad_areas_disc)(fibrad_areas *areas, uint32_t whose, double x, double y, double r);

/* Completes areas->area[c] for circles c = 1 ... areas->circles - 1, seen of disc areas->whose[c]; of other discs
 * nothing is seen. Returns the area that is still open. */
double LANED(fibrad_areas_end)(fibrad_areas *areas);

#endif
