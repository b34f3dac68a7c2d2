/* patch_beams_lanes.h - where beams and rays go, one version per instruction set. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_PATCHES_PATCH_BEAMS_LANES_H
#define FIBRAD_PATCHES_PATCH_BEAMS_LANES_H

#include "patches/problem.h"

/* Follows the beams of one task. The tasks are, in this order: spheres by their position, rows of fine fours, and
 * stretches of heat->ray. Errors: FIBRAD_E_WORK: the work memory is too small; FIBRAD_E_SIZE: the memory of the problem
 * is; FIBRAD_E_BACK. */
typedef int fibrad_heat_follow_function(fibrad_heat *heat, fibrad_workspace *work, uint32_t task);

FIBRAD_DECLARE_VERSIONS(fibrad_heat_follow_function, fibrad_heat_follow);

#endif
