/* subdivision.h - the patches of spheres and walls, and the rays that leave walls. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_PATCHES_SUBDIVISION_H
#define FIBRAD_PATCHES_SUBDIVISION_H

#include "patches/problem.h"

/* ---- divides patches near small spheres -------------------------------------------------------------------------- */

/* A ray of a fine patch counts as this many beams, since beams are spread more evenly. Between a small sphere and the
 * spot under it the beams of the sphere count most. Between a fine patch and what is far or large its rays do. */
#define FIBRAD_HEAT_RAY 0.0625

/* An upper bound of the number of nodes. There are fewer fine fours than nodes. Needs heat->config, scene, spheres,
 * side and wall. */
uint64_t fibrad_heat_count_nodes(const fibrad_heat *heat);

/* Divides the fours: sets heat->division (without balance), heat->rows, and heat->density of rows of fine fours. */
void fibrad_heat_divide_fours(fibrad_heat *heat);

/* Finds heat->division.balance from heat->leave. */
void fibrad_heat_balance(fibrad_heat *heat);

/* The point of a four at u, v, both from 0 to 1. at: out: the point [L], relative to the centre of a sphere, or in the
 * scene. normal: out: it points out of a sphere, or into the container. Returns the area [L^2] that the four would have
 * if its scale were the same everywhere as at the point. */
double fibrad_heat_fine_point(const fibrad_heat *heat, const fibrad_heat_four *four, double u, double v, double at[3],
                              double normal[3]);

/* The fraction of a sphere's radiation that a mesh nearby would send back if it reflected all. 0: the patches of the
 * mesh are small enough to tell this themselves. */
double fibrad_heat_comes_back(const fibrad_heat *heat, uint32_t sphere);

/* The number of a patch of a wall among all fine patches. FIBRAD_NONE: the patch is not fine. */
uint32_t fibrad_heat_fine_of(const fibrad_heat *heat, uint32_t patch);

/* Finds the next ray of a row. False: no ray is left. Zero the structure before the first call. */
typedef struct fibrad_heat_fine_rays {
    double at[3], normal[3], direction[3]; /* out: start, as of fibrad_heat_fine_point, and direction of the ray */
    uint32_t patch;                        /* out: number of the patch within the row */
    uint32_t k;                            /* points of the random sequence that are used up */
    uint32_t fours, left;                  /* fours begun, and rays of the last of them that are left */
    double due;                            /* number of rays that rounding has put off */
    double most;                           /* largest result of fibrad_heat_fine_point on the four */
} fibrad_heat_fine_rays;
bool fibrad_heat_fine_ray(const fibrad_heat *heat, uint32_t row, fibrad_heat_fine_rays *rays);

/* ---- the patches of walls, and the rays that leave them ---------------------------------------------------------- */

/* Chooses the patches and rays of all walls, and the rays of meshes: heat->wall, heat->patch_area, heat->rays. Needs
 * heat->config, heat->scene and heat->meshes. */
void fibrad_heat_cut_walls(fibrad_heat *heat);

/* Cuts the meshes into patches of heat->patch_area: sets heat->of_mesh and, if it is not NULL, heat->cut. */
void fibrad_heat_cut_meshes(fibrad_heat *heat);

/* The area of a wall's rectangle [L^2]. */
double fibrad_heat_wall_area(const fibrad_heat *heat, uint32_t wall);

/* The coordinates of a point of a wall along its edges, as fibrad_wall_point takes them, from its shares of the edges
 * of the rectangle. */
static inline void fibrad_heat_wall_coordinates(const fibrad_heat *heat, uint32_t wall, const double share[2],
                                                double coordinate[2]) {
    const fibrad_heat_wall *w = &heat->wall[wall];
    for (int edge = 0; edge < 2; edge++) coordinate[edge] = w->low[edge] + share[edge] * w->size[edge];
}

/* The point of a wall [L] in squares of its rectangle. False: the point lies beyond the rectangle. */
bool fibrad_heat_wall_place(const fibrad_heat *heat, uint32_t wall, const double at[3], double place[2]);

/* Whether the squares at both ends of an edge are neighbours. */
bool fibrad_heat_wall_wraps(const fibrad_heat *heat, uint32_t wall, uint32_t side);

/* The patch of a wall at a point on it [L]. may_be_fine: false for the patch that exchanges with the cap of a sphere
 * behind the wall: rays of fine patches do not meet caps. */
uint32_t fibrad_heat_wall_patch(const fibrad_heat *heat, uint32_t wall, const double at[3], bool may_be_fine);

/* The patch at a point [L] on a side of a mesh, or on an image of the side. FIBRAD_NONE: the side belongs to no wall.
 */
uint32_t fibrad_heat_mesh_patch(const fibrad_heat *heat, uint32_t side, const double at[3]);

/* Rays per area that the wall of a patch sends out. 0: the patch belongs to no wall. */
double fibrad_heat_wall_density(const fibrad_heat *heat, uint32_t patch);

/* The patch where a ray ends that meets no sphere. w: unit vector. side, length: what the ray meets of the meshes, or
 * FIBRAD_NO_SIDE. FIBRAD_NONE: the ray ends on a side that belongs to no wall. */
uint32_t fibrad_heat_ends(const fibrad_heat *heat, const double origin[3], const double w[3], uint32_t side,
                          double length);

/* Four numbers in [0, 1) for ray k. Those of all even rays are evenly spread, and those of all odd rays are. */
void fibrad_heat_ray_coordinates(uint64_t seed, uint32_t k, double x[4]);

/* Four numbers in [0, 1): point k of Sobol's sequence, moved at random. */
void fibrad_heat_even_point(const fibrad_heat *heat, uint64_t seed, uint32_t k, double x[4]);

/* A direction by the cosine law about a normal, from two numbers in [0, 1). */
void fibrad_heat_direction(const double x[2], const double normal[3], double w[3]);

/* Origin [L] and direction of ray k of a plane or the cylinder. False: the origin lies outside the container. */
bool fibrad_heat_wall_ray(const fibrad_heat *heat, uint32_t wall, uint32_t k, double origin[3], double w[3]);

/* Origin [L] and direction of ray k of a mesh. side: out: the side that the ray leaves. */
bool fibrad_heat_mesh_ray(const fibrad_heat *heat, uint32_t mesh, uint32_t k, double origin[3], double w[3],
                          uint32_t *side);

#endif
