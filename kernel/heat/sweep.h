/* sweep.h - what patches send in a sweep over all beams, and what the sweep gathers. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_HEAT_SWEEP_H
#define FIBRAD_HEAT_SWEEP_H

#include "heat/solution.h"

/* Chooses the sequence of spheres in sweeps, and the part of each row. */
void fibrad_heat_divide(fibrad_heat *heat);

/* The net flow to each patch after all parts are swept: [patches]. After the sweep FIBRAD_HEAT_AREA: areas. */
const double *fibrad_heat_gathered(fibrad_heat *heat);

#endif
