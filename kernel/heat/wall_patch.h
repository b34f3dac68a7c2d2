/* wall_patch.h - the patches of walls, and the rays that leave them. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_HEAT_WALL_PATCH_H
#define FIBRAD_HEAT_WALL_PATCH_H

#include "heat/problem.h"

/* Chooses the patches and rays of all walls, and the rays of meshes: heat->wall, heat->patch_area, heat->rays. Needs
 * heat->config, heat->scene and heat->meshes. */
void fibrad_heat_cut_walls(fibrad_heat *heat);

/* Cuts the meshes into patches of heat->patch_area: tells how many, and heat->cut if it is there. */
void fibrad_heat_cut_meshes(fibrad_heat *heat);

/* The area of the part of a wall that is cut [L2]. */
double fibrad_heat_wall_area(const fibrad_heat *heat, uint32_t wall);

/* The coordinates of a point of a wall along its edges, as fibrad_wall_point takes them, from its shares of the edges
 * of the rectangle. */
static inline void fibrad_heat_wall_coordinates(const fibrad_heat *heat, uint32_t wall, const double share[2],
                                                double coordinate[2]) {
    const fibrad_heat_wall *w = &heat->wall[wall];
    for (int edge = 0; edge < 2; edge++) coordinate[edge] = w->low[edge] + share[edge] * w->size[edge];
}

/* Where on a wall a place on it [L] is, in squares; false: beyond the part that is cut. Whether squares at one end of a
 * side are next to those at the other. */
bool fibrad_heat_wall_place(const fibrad_heat *heat, uint32_t wall, const double at[3], double place[2]);
bool fibrad_heat_wall_wraps(const fibrad_heat *heat, uint32_t wall, uint32_t side);

/* The patch of a wall at a place on it [L]. */
uint32_t fibrad_heat_wall_patch(const fibrad_heat *heat, uint32_t wall, const double at[3]);

/* The same of what a sphere's cap behind the wall exchanges with it: never a fine patch, whose rays do not meet it. */
uint32_t fibrad_heat_cap_patch(const fibrad_heat *heat, uint32_t wall, const double at[3]);

/* The patch at a place [L] on a side of a mesh, or on an image of it; FIBRAD_NONE: the side is nobody's. */
uint32_t fibrad_heat_mesh_patch(const fibrad_heat *heat, uint32_t side, const double at[3]);

/* Rays per area that leave the wall or the mesh of a patch; 0 if it belongs to none. */
double fibrad_heat_wall_density(const fibrad_heat *heat, uint32_t patch);

/* The patch that a ray meets which meets no sphere and no triangle: of a wall, or the surroundings. */
uint32_t fibrad_heat_leaves(const fibrad_heat *heat, const double origin[3], const double w[3]);

/* The patch that a ray along the unit vector w meets which meets no sphere before a side of a mesh, FIBRAD_NO_SIDE if
 * it meets none, at some length; FIBRAD_NONE if that side is nobody's. */
uint32_t fibrad_heat_ends(const fibrad_heat *heat, const double origin[3], const double w[3], uint32_t side,
                          double length);

/* Four numbers in [0, 1) of ray k of a sequence, those of even and of odd rays even among themselves. */
void fibrad_heat_ray_coordinates(uint64_t seed, uint32_t k, double x[4]);

/* A direction by the cosine law about a normal, by two numbers. */
void fibrad_heat_direction(const double x[2], const double normal[3], double w[3]);

/* Origin [L] and direction of ray k of a wall. False: it starts outside the container. */
bool fibrad_heat_wall_ray(const fibrad_heat *heat, uint32_t wall, uint32_t k, double origin[3], double w[3]);

/* The same of a mesh; *side: which it leaves. */
bool fibrad_heat_mesh_ray(const fibrad_heat *heat, uint32_t mesh, uint32_t k, double origin[3], double w[3],
                          uint32_t *side);

#endif
