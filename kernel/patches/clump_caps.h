/* clump_caps.h - spheres that are one body: their leaders, and what of them lies inside one another.
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_PATCHES_CLUMP_CAPS_H
#define FIBRAD_PATCHES_CLUMP_CAPS_H

#include "patches/problem.h"

/* Number of caps of all spheres. */
size_t fibrad_heat_count_caps(const fibrad_scene *scene);

/* Finds heat->clumps. The function overwrites heat->solution.gathered. */
void fibrad_heat_find_clumps(fibrad_heat *heat);

#endif
