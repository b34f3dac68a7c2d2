/* coarse_map.h - where the whole bed has particles, in coarse cells. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_COARSE_MAP_H
#define FIBRAD_COUPLE_COARSE_MAP_H

#include "couple/halo.h"

/* Collective. Makes the occupancy of the bed in a box (low, high, periodic, set before, the same on all ranks) of cells
 * about `width` wide, 2^24 at most: marks those that particle[own] may touch, on all ranks; radius: the largest. Where
 * there would be more cells, the box is first made smaller by particles far from all others, which are then in nobody's
 * way; then cells wider. mark: its memory. Errors, on all ranks: _MEMORY. */
int fibrad_coarse_map(MPI_Comm comm, double width, double radius, const fibrad_particle *particle, size_t own,
                      fibrad_block *mark, fibrad_occupancy *map);

#endif
