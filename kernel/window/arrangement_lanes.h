/* arrangement_lanes.h - visible areas by the arrangement of circles, in lanes. This method works for all
 * configurations of discs. SPDX-License-Identifier: MIT
 *
 * The three functions are those of clip_lanes.h. */
#ifndef FIBRAD_WINDOW_ARRANGEMENT_LANES_H
#define FIBRAD_WINDOW_ARRANGEMENT_LANES_H

#include "base/lanes/laned.h"
#include "window/areas.h"

void LANED(fibrad_arrangement_begin)(fibrad_areas *areas);
bool LANED(fibrad_arrangement_disc)(fibrad_areas *areas, uint32_t whose, double x, double y, double r);
double LANED(fibrad_arrangement_end)(fibrad_areas *areas);

#endif
