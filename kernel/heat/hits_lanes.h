/* hits_lanes.h - where beams and rays go, one version per instruction set. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_HEAT_HITS_LANES_H
#define FIBRAD_HEAT_HITS_LANES_H

#include "base/dispatch.h"
#include "heat/problem.h"
#include "work/work.h"

/* Keeps the beams of the sphere at place `task`; from the number of spheres on, fills a part of heat->ray.
 * FIBRAD_E_WORK: the work memory is too small; _SIZE: that of the beams is. */
typedef int fibrad_heat_follow_function(fibrad_heat *heat, fibrad_workspace *work, uint32_t task);

FIBRAD_DECLARE_VERSIONS(fibrad_heat_follow_function, fibrad_heat_follow);

#endif
