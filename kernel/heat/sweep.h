/* sweep.h - what a sweep over all beams is given and brings. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_HEAT_SWEEP_H
#define FIBRAD_HEAT_SWEEP_H

#include "heat/problem.h"

/* Puts the spheres into the sequence of sweeps, and each into a part. */
void fibrad_heat_divide(fibrad_heat *heat);

/* What patch a sends out in the next sweep, and what it was told to send. */
static inline void fibrad_heat_send(fibrad_heat *heat, uint32_t a, double value) { heat->solution.source[a] = value; }
static inline double fibrad_heat_sent(const fibrad_heat *heat, uint32_t a) { return heat->solution.source[a]; }

/* The net flow to each patch [patches] once all parts are swept, or its area in the first sweep of all. */
const double *fibrad_heat_gathered(fibrad_heat *heat);

#endif
