/* beyond.h - spheres that lie beyond a closed mesh. SPDX-License-Identifier: MIT */
#ifndef BEYOND_H
#define BEYOND_H

#include "bed/bed.h"
#include "bed/wall_option.h"
#include "simple/fibrad_host.h"

/* Warns of the first sphere that lies wholly beyond a closed mesh with a wall on one side only: such a sphere is there
 * by mistake. Spheres that a mesh cuts are normal. made: the bed in the library. file: its name. */
void warn_beyond(const fibrad_bed *made, const struct bed *bed, const struct walls *walls, const char *file);

#endif
