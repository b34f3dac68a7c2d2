/* coarse_map.h - marks the coarse cells of the whole bed that have particles. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_COARSE_MAP_H
#define FIBRAD_COUPLE_COARSE_MAP_H

#include "couple/ranks/halo.h"

/* Collective. Makes the occupancy of the bed: marks the cells that particles of any rank may touch. The caller sets
 * low, high and periodic of `map`, the same on all ranks. Cells are about `width` wide. radius: the largest radius.
 * There are at most 2^24 cells. If there were more, the box is first narrowed, which leaves out particles far from all
 * others; then cells are made wider. mark: memory of the map.
 * Errors, on all ranks: _MEMORY. */
int fibrad_coarse_map(MPI_Comm comm, double width, double radius, const fibrad_particle *particle, size_t own,
                      fibrad_block *mark, fibrad_occupancy *map);

#endif
