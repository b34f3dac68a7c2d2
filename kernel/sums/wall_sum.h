/* wall_sum.h - sums over the windows of a row of what walls get, by regions of the sky, and the view factors to
 * walls. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SUMS_WALL_SUM_H
#define FIBRAD_SUMS_WALL_SUM_H

#include "scene/surroundings.h"

/* The walls and the cutoff in the frame of a sphere: relative to its centre, in units of its radius, by the axes
 * of the cylinder. */
typedef struct fibrad_wall_view {
    uint32_t turn;                           /* as in fibrad_container */
    double low[3], high[3], axis[2], radius; /* infinite where there is no wall */
    int only;                                /* the axis across which all walls are planes, or 3 */
    bool round;                              /* whether there is a cylinder */
    bool cut;                                /* whether lines may be cut */
    double ball;                             /* lines are cut where they leave the ball of this radius */
} fibrad_wall_view;

/* The distance of a wall that does not exist, where a finite number is needed. In units of the radius. */
#define FIBRAD_FAR_AWAY 1e30

/* The axis across which all walls are planes, or 3. */
int fibrad_walls_only(const fibrad_container *container);

/* cut: whether there is a cutoff. ball: the cutoff in radii. */
fibrad_wall_view fibrad_wall_view_of(const fibrad_scene *scene, uint32_t place, bool cut, double ball);

/* A region of the sky is the directions of one octant in which a line meets one wall. Region 4 octant + n belongs to
 * the plane across axis n, or to the cylinder if n = 3. Bit b of an octant is set if lines rise along axis b. With a
 * cylinder only octants 0 and 4 are used, for all lines that fall or rise along it. If all walls are across one axis,
 * only octant 0 and the octant of that axis are used. */
#define FIBRAD_REGIONS 32

/* Sums over the windows of a row. */
typedef struct fibrad_wall_sums {
    double open[FIBRAD_REGIONS][4]; /* the open part, an area or points, in four parts as in fibrad_entries */
    double all[FIBRAD_REGIONS][4];  /* the same if nothing were hidden, in windows */
    double mixed[FIBRAD_REGIONS];   /* the open part times the hidden part */
    uint64_t hidden[2 * FIBRAD_DIRECTIONS_MAX / 64 + 1]; /* bit k: window k is hidden and does not count in `all` */
} fibrad_wall_sums;

/* Begins the sums over a number of windows. */
void fibrad_wall_sums_begin(fibrad_wall_sums *sums, uint32_t windows);

/* Adds the value of window k to part k mod 4 of a sum. end: the window counts half in differences between parts, as in
 * fibrad_entries_add. */
static inline void fibrad_wall_add(double part[4], uint32_t k, bool end, double value) {
    const double quarter = end ? value / 4 : 0;
    part[k % 4 ^ 1] += quarter;
    part[k % 4] += value - quarter;
}

/* Sums over the points of a window in one octant, for each wall. There are eight partial sums for each, so that the
 * order of the terms is the same in all instruction sets. */
typedef struct fibrad_octant_sums {
    _Alignas(64) double all[4][8], open[4][8], u[4][8],
        v[4][8]; /* shares of the wall; the same for open points; times u; times v */
    uint32_t octant;
} fibrad_octant_sums;

/* A line in the frame of a sphere, by the axes x, y and z. */
typedef struct fibrad_wall_line {
    double origin[3], w[3];
} fibrad_wall_line;

/* Sums over the points of a window. cuts: the number of open lines that are cut before they meet a wall, by the wall
 * that they would meet. first_cut: the first of these lines. */
typedef struct fibrad_point_sums {
    fibrad_octant_sums part[8];
    uint32_t octants, cuts[FIBRAD_WALLS + 1];
    fibrad_wall_line first_cut[FIBRAD_WALLS + 1];
} fibrad_point_sums;

/* The distance of the nearest wall from the centre. Infinity: there is none. */
double fibrad_wall_nearest(const fibrad_wall_view *view);

/* How much the solid angles count, 0 to 1. 1: no wall cuts the sphere, or all walls are across one axis. 0: a wall
 * cuts the sphere deeply, or lines are cut. */
double fibrad_wall_apart(const fibrad_wall_view *view);

/* Adds to wall[] the view factor of each wall and of the surroundings. A region's factor is its open part times its
 * solid angle over that of its windows. The sum of all factors must be the open part of all windows. The remainder
 * goes to regions that are hidden in part. parts: squared distances between the sums over even and odd windows, and
 * over fourths, as in fibrad_entries_error. */
void fibrad_wall_factors(const fibrad_wall_sums *sums, const fibrad_wall_view *view, uint32_t windows, double apart,
                         double wall[FIBRAD_SLOTS], double parts[2]);

#endif
