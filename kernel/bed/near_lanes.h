/* near_lanes.h - shells of near spheres, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_BED_NEAR_LANES_H
#define FIBRAD_BED_NEAR_LANES_H

#include "base/lanes/laned.h"
#include "bed/work.h"

/* Adds the next shell of near spheres, or sets near.full. */
void LANED(fibrad_near_extend)(fibrad_work *work);

#endif
