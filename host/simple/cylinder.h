/* cylinder.h - the axes of a wall that is a cylinder. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_CYLINDER_H
#define FIBRAD_SIMPLE_CYLINDER_H

#include <math.h>

#include "fibrad.h"

/* The first (0) or the second (1) axis across a cylinder, in the order x, y, z. */
static inline int cylinder_across(const fibrad_wall *wall, int k) {
    const int along = wall->cylinder.along;
    return k == 0 ? along == 0 : 2 - (along == 2);
}

/* The distance of a point from the axis of a cylinder. */
static inline double cylinder_distance(const fibrad_wall *wall, const double at[3]) {
    const double u = at[cylinder_across(wall, 0)] - wall->cylinder.x;
    const double v = at[cylinder_across(wall, 1)] - wall->cylinder.y;
    return sqrt(u * u + v * v);
}

#endif
