/* wall_sum.h - what the windows of a row give to walls, by regions of the sky, and the factors that come of it.
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WORK_WALL_SUM_H
#define FIBRAD_WORK_WALL_SUM_H

#include "base/addends.h"
#include "scene/surroundings.h"

/* The walls, and where lines are cut, in the frame of a sphere: in units of its radius, from its centre. */
typedef struct fibrad_wall_view {
    double low[3], high[3], axis[2], radius;  /* infinite where there is none */
    int only;                                 /* the axis across which all walls are planes, or 3 */
    bool round;                               /* there is a cylinder */
    bool cut;                                 /* lines may be cut, ... */
    double known_low[3], known_high[3], ball; /* ... where they leave this box, or a ball of this radius */
} fibrad_wall_view;

/* The distance of a wall that does not exist, where a finite number is needed. In units of the radius. */
#define FIBRAD_FAR_AWAY 1e30

/* cut: whether there is a known region, or a cutoff, at `ball` radii. */
fibrad_wall_view fibrad_wall_view_of(const fibrad_scene *scene, uint32_t place, bool cut, double ball);

/* Regions of the sky: what a line meets, by the octant of its direction. Region 4 octant + n is met through the plane
 * across axis n or, n = 3, through the cylinder; bit b of an octant: lines rise along axis b. With a cylinder octants
 * 0 and 4 stand for all below and above, with planes across one axis 0 and that of its bit. */
#define FIBRAD_REGIONS 32

/* Sums over the windows of a row. */
typedef struct fibrad_wall_sums {
    double open[FIBRAD_REGIONS][4];              /* what is open, areas or points, in parts as in fibrad_entries */
    double all[FIBRAD_REGIONS][4];               /* what there would be if nothing were hidden, in windows */
    double mixed[FIBRAD_REGIONS];                /* open times hidden part */
    uint64_t hidden[FIBRAD_DIRECTIONS_MAX / 64]; /* bit k: window k is hidden, and not counted in `all` */
    fibrad_addends *addends;                     /* NULL, or where what is added is listed instead */
} fibrad_wall_sums;

/* Adds what window k of n gives to parts k mod 4 of a sum. The first and the last window count half in differences of
 * parts, as in fibrad_entries_add. */
static inline void fibrad_wall_add(double part[4], uint32_t k, uint32_t n, double value) {
    if (k == 0 || k == n - 1) {
        part[k % 4 ^ 1] += value / 4;
        value -= value / 4;
    }
    part[k % 4] += value;
}

/* Sums over the points of a window in one octant: by wall, eight apart so that their order is the same in every
 * instruction set. */
typedef struct fibrad_octant_sums {
    _Alignas(64) double all[4][8], open[4][8], u[4][8], v[4][8]; /* shares; those of open points; times u; times v */
    uint32_t octant;
} fibrad_octant_sums;

/* A line in the frame of a sphere. */
typedef struct fibrad_wall_line {
    double origin[3], w[3];
} fibrad_wall_line;

/* Sums over the points of a window; and open lines that are cut before they meet a wall, by the wall they would meet:
 * how many, and the first of them. */
typedef struct fibrad_point_sums {
    fibrad_octant_sums part[8];
    uint32_t octants, cuts[FIBRAD_WALLS + 1];
    fibrad_wall_line first_cut[FIBRAD_WALLS + 1];
} fibrad_point_sums;

/* How much these solid angles count: 1 if no wall cuts the sphere, or all are across one axis; 0 if one does deeply, or
 * if lines are cut. */
double fibrad_wall_apart(const fibrad_wall_view *view);

/* Adds to wall[] what each wall gets, or escapes: the open part of each region, over the windows it has, times the
 * solid angle it has. The sum is what was open, so what is left over goes to regions that are hidden in part. parts:
 * the squared distances of the sums over even and odd windows, and over every fourth, as of fibrad_entries_error. */
void fibrad_wall_factors(const fibrad_wall_sums *sums, const fibrad_wall_view *view, uint32_t windows, double apart,
                         double wall[FIBRAD_SLOTS], double parts[2]);

#endif
