/* turned.h - cylinders along x and y. The cylinder of a scene lies along z. So a scene gets such a bed with turned
 * axes: each axis of the bed takes the place of another, cyclically, until the axis of the cylinder is in the place of
 * z. All else keeps the axes of the bed. cylinder: as in fibrad_insitu_bed. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_TURNED_H
#define FIBRAD_COUPLE_TURNED_H

#include <stdbool.h>

#include "fibrad.h"

/* The place of an axis of the bed among the axes of the scene. */
static inline int fibrad_turned_axis(int cylinder, int axis) { return (axis + 3 - cylinder) % 3; }

static inline void fibrad_turn(int cylinder, const double x[3], double turned[3]) {
    for (int axis = 0; axis < 3; ++axis) turned[fibrad_turned_axis(cylinder, axis)] = x[axis];
}

/* The same for arrays of coordinates. */
static inline void fibrad_turn_arrays(int cylinder, const double *const x[3], const double *turned[3]) {
    for (int axis = 0; axis < 3; ++axis) turned[fibrad_turned_axis(cylinder, axis)] = x[axis];
}

/* A plane that is not valid stays as it is. */
static inline fibrad_plane fibrad_turned_plane(int cylinder, fibrad_plane plane) {
    if (plane.axis >= 0 && plane.axis < 3) plane.axis = fibrad_turned_axis(cylinder, plane.axis);
    return plane;
}

static inline fibrad_wall fibrad_turned_wall(int cylinder, fibrad_wall wall) {
    const double at[2] = {wall.cylinder.x, wall.cylinder.y};
    const bool swapped = cylinder == 2; /* x and z of the bed are y and x of the scene */
    wall.plane = fibrad_turned_plane(cylinder, wall.plane);
    wall.cylinder.x = at[swapped], wall.cylinder.y = at[!swapped];
    return wall;
}

#endif
