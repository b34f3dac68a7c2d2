/* near_lanes.h - shells of near spheres, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_BED_NEAR_LANES_H
#define FIBRAD_BED_NEAR_LANES_H

#include "base/lanes/laned.h"
#include "bed/work.h"

/* Adds the next shell of near spheres, or sets near.full. */
void LANED(fibrad_near_extend)(fibrad_work *work);

/* Appends the discs of `found` near spheres to work->disc, where their places are listed already, if they overlap the
 * window and lie ahead. Beyond its capacity they are only counted, all of them. */
void LANED(fibrad_near_discs)(fibrad_work *work, const double frame[9], uint32_t found);

#endif
