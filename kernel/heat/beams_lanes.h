/* beams_lanes.h - where the beams of a sphere go, one version per instruction set. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_HEAT_BEAMS_LANES_H
#define FIBRAD_HEAT_BEAMS_LANES_H

#include "bed/work.h"
#include "heat/heat.h"

/* Fills heat->hit of the sphere at `place`. FIBRAD_E_CAPACITY: the work memory is too small. */
typedef int fibrad_heat_beams_function(fibrad_heat *heat, fibrad_work *work, uint32_t place);

fibrad_heat_beams_function fibrad_heat_beams_scalar, fibrad_heat_beams_sse2, fibrad_heat_beams_avx2,
    fibrad_heat_beams_avx512;

/* Fills heat->leave. */
typedef void fibrad_heat_leave_function(fibrad_heat *heat);

fibrad_heat_leave_function fibrad_heat_leave_scalar, fibrad_heat_leave_sse2, fibrad_heat_leave_avx2,
    fibrad_heat_leave_avx512;

#endif
