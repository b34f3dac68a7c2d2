/* subdivision.h - divides patches near small spheres. SPDX-License-Identifier: MIT
 *
 * Light goes back and forth between a small sphere and the spot under it on a large sphere or a wall. Patches there
 * must be small against the distance. So a four of patches that is too large is divided into four fours, these are
 * divided again, and so on. This is done for spheres, planes and the cylinder. Fours that are not divided further are
 * called fine. The own patches of a divided four send and receive nothing. The fine patches of a body are numbered
 * after its own patches.
 *
 * Two kinds of rays tell what fine patches exchange: beams of spheres that meet them, and rays of their own. The rays
 * stand in rows after those of the spheres. A row has fine fours of one body and one size. */
#ifndef FIBRAD_PATCHES_SUBDIVISION_H
#define FIBRAD_PATCHES_SUBDIVISION_H

#include "patches/problem.h"

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

#endif
