/* cylinder.h - the axes of a wall that is a cylinder. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_CONTACT_CYLINDER_H
#define FIBRAD_CONTACT_CYLINDER_H

#include <math.h>

#include "fibrad.h"

/* The axis along a cylinder, 0: x, 1: y, 2: z. */
static inline int cylinder_along(const fibrad_wall *wall) { return (wall->cylinder.axis + 2) % 3; }

/* The first (0) or the second (1) axis across a cylinder, in the order x, y, z. */
static inline int cylinder_across(const fibrad_wall *wall, int k) {
    const int along = cylinder_along(wall);
    return k == 0 ? along == 0 : 2 - (along == 2);
}

/* The distance of a point from the axis of a cylinder. */
static inline double cylinder_distance(const fibrad_wall *wall, const double at[3]) {
    return hypot(at[cylinder_across(wall, 0)] - wall->cylinder.x, at[cylinder_across(wall, 1)] - wall->cylinder.y);
}

#endif
