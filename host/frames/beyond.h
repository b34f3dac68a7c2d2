/* beyond.h - spheres that lie beyond a closed mesh. SPDX-License-Identifier: MIT */
#ifndef BEYOND_H
#define BEYOND_H

#include "bed/bed.h"
#include "bed/wall_option.h"

/* Warns of the first sphere that lies wholly beyond a closed mesh with a wall on one side only: such a sphere is there
 * by mistake. Spheres that a mesh cuts are normal. file: name of the bed. Status 0 or STATUS_MEMORY. */
int warn_beyond(const struct bed *bed, const struct walls *walls, const char *file);

#endif
