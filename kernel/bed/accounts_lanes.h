/* accounts_lanes.h - visible areas by accounts of circles, in lanes: no arrangement of discs disturbs them.
 * SPDX-License-Identifier: MIT
 *
 * The three functions are those of areas_lanes.h. */
#ifndef FIBRAD_BED_ACCOUNTS_LANES_H
#define FIBRAD_BED_ACCOUNTS_LANES_H

#include "base/lanes/laned.h"
#include "bed/areas.h"

void LANED(fibrad_accounts_begin)(fibrad_areas *areas);
bool LANED(fibrad_accounts_disc)(fibrad_areas *areas, uint32_t whose, double x, double y, double r);
double LANED(fibrad_accounts_end)(fibrad_areas *areas);

#endif
