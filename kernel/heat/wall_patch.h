/* wall_patch.h - the patches of walls, and the rays that leave them. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_HEAT_WALL_PATCH_H
#define FIBRAD_HEAT_WALL_PATCH_H

#include "heat/problem.h"

/* Chooses the patches and rays of all walls: heat->wall and heat->rays. Needs heat->config and heat->scene. */
void fibrad_heat_cut_walls(fibrad_heat *heat);

/* The patch of a wall at a place on it [L]. */
uint32_t fibrad_heat_wall_patch(const fibrad_heat *heat, uint32_t wall, const double at[3]);

/* Rays per area that leave the wall of a patch; 0 if it belongs to none. */
double fibrad_heat_wall_density(const fibrad_heat *heat, uint32_t patch);

/* The patch that a ray meets which meets no sphere: of a wall, or the surroundings. */
uint32_t fibrad_heat_leaves(const fibrad_heat *heat, const double origin[3], const double w[3]);

/* Origin [L] and direction of ray k of a wall. False: it starts outside the container. */
bool fibrad_heat_wall_ray(const fibrad_heat *heat, uint32_t wall, uint32_t k, double origin[3], double w[3]);

#endif
