/* beyond.h - spheres that lie beyond a closed mesh. SPDX-License-Identifier: MIT */
#ifndef BEYOND_H
#define BEYOND_H

#include "bed/bed.h"
#include "bed/wall_option.h"

/* Warns of the first sphere that lies with all of it beyond a closed mesh of which one side is a wall: nothing is there
 * but in error. Such as meshes cut are normal. `file` is the bed's name. Status 0 or STATUS_MEMORY. */
int warn_beyond(const struct bed *bed, const struct walls *walls, const char *file);

#endif
