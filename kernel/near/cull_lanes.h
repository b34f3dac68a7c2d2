/* cull_lanes.h - spheres in floats, for comparisons (culls) with beams and rays. SPDX-License-Identifier: MIT
 *
 * A cull may pass a sphere that the exact test rejects later. It never rejects a sphere that the exact test would
 * pass. */
#ifndef FIBRAD_NEAR_CULL_LANES_H
#define FIBRAD_NEAR_CULL_LANES_H

#include "base/port.h"

/* x, y, z, q are numbers that floats can hold. */
typedef struct sphere_cull {
    vd x, y, z; /* the centre */
    vd q;       /* a little less than square + 1 - r^2 */
    vd square;  /* of the distance */
    vd size;    /* an upper bound of the distance */
    vm small;   /* whether the distance is within the range of floats; if not, culls pass the sphere */
} sphere_cull;

/* The errors of three products and two sums are less than 4 ulp of the distance. Those of their squares are less than
 * 40 ulp of its square. */
FIBRAD_INLINE sphere_cull cull_of_sphere(vd x, vd y, vd z, vd r) {
    const vd zero = vd_set1(0), size = vd_abs(x) + vd_abs(y) + vd_abs(z), about = 1 + size;
    const vd square = x * x + y * y + z * z;
    const vm small = vd_lt(size, vd_set1(1e18));
    return (sphere_cull){.x = vd_select(small, x, zero),
                         .y = vd_select(small, y, zero),
                         .z = vd_select(small, z, zero),
                         .q = vd_select(small, square + 1 - r * r - 4e-6 * (about * about), vd_set1(-FLT_MAX)),
                         .square = square,
                         .size = size,
                         .small = small};
}

#endif
