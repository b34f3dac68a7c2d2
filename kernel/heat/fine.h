/* fine.h - patches divided where something small is near. SPDX-License-Identifier: MIT
 *
 * Light goes back and forth between a small sphere and the spot under it on a large one or a wall. So four patches of a
 * sphere, a plane or the cylinder that are large against how far a small sphere is from them are divided into four
 * fours of patches, these again, and so on: the nearer, the finer, to a part of the distance. Fours that are divided no
 * more are fine ones. Their patches follow the others of their body; what they exchange is known from beams of spheres
 * that meet them, and from rays of their own, which stand in rows after those of the spheres: each row is of fours of
 * one body and one size. The own patches of a four that is divided send and receive nothing. */
#ifndef FIBRAD_HEAT_FINE_H
#define FIBRAD_HEAT_FINE_H

#include "heat/problem.h"

/* Rays of fine patches count as so many beams each, which are spread more evenly: what a small sphere and the spot
 * under it exchange is known from its beams, what is far and large from rays. */
#define FIBRAD_HEAT_RAY 0.0625

/* How many nodes there are at the most, more than fine fours. Needs heat->config, scene, spheres, side and wall. */
uint64_t fibrad_heat_count_nodes(const fibrad_heat *heat);

/* Divides the fours: heat->division.root, node, nodes, four, fours, first_four, fine, rows and the density of those. */
void fibrad_heat_divide_fours(fibrad_heat *heat);

/* Finds heat->division.balance from heat->leave. */
void fibrad_heat_balance(fibrad_heat *heat);

/* A point on a four: u, v in [0, 1] of it. Its place, from the centre of a sphere or in the scene [L], and the normal
 * outwards or into the container. Returns the area of the four if all of it were as here [L2]. */
double fibrad_heat_fine_point(const fibrad_heat *heat, const fibrad_heat_four *four, double u, double v, double at[3],
                              double normal[3]);

/* The part of what a sphere sends out that comes back from a mesh nearby, whose patches are too large to tell, if it
 * reflects all. */
double fibrad_heat_comes_back(const fibrad_heat *heat, uint32_t sphere);

/* The number among fine patches of a wall's patch; FIBRAD_NONE: it is none. */
uint32_t fibrad_heat_fine_of(const fibrad_heat *heat, uint32_t patch);

/* The rays of a row, one after another; begin with zeros. False: there are no more. */
typedef struct fibrad_heat_fine_rays {
    double at[3], normal[3], direction[3]; /* out: where it begins, as above */
    uint32_t patch, k;                     /* out: of the row; its number within its four, and one more */
    uint32_t fours, left;                  /* begun so far, rays of the last of them yet to come */
    double due, most;
} fibrad_heat_fine_rays;
bool fibrad_heat_fine_ray(const fibrad_heat *heat, uint32_t row, fibrad_heat_fine_rays *rays);

#endif
