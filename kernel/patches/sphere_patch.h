/* sphere_patch.h - the patches of a sphere. SPDX-License-Identifier: MIT
 *
 * The sphere is projected from its centre onto a cube. Each face of the cube is mapped so that equal squares have
 * images of about equal area on the sphere, and is then cut into squares. The cube is turned so that neither the
 * axes nor the contacts of common lattices lie on its edges. */
#ifndef FIBRAD_PATCHES_SPHERE_PATCH_H
#define FIBRAD_PATCHES_SPHERE_PATCH_H

#include "base/port.h"

/* The axes of a frame in the coordinates of the cube. */
static inline void fibrad_patch_turn(const double frame[9], double turned[9]) {
    static const double cube[9] = {4. / 9, -1. / 9, 8. / 9, 4. / 9, 8. / 9, -1. / 9, -7. / 9, 4. / 9, 4. / 9};
    for (int axis = 0; axis < 3; axis++)
        for (int row = 0; row < 3; row++)
            turned[3 * axis + row] = cube[3 * row] * frame[3 * axis] + cube[3 * row + 1] * frame[3 * axis + 1] +
                                     cube[3 * row + 2] * frame[3 * axis + 2];
}

/* The number of a patch. face: of the cube, 0 to 5. x, y: the place on the face in squares. side: squares along an
 * edge. Four squares, two by two, have successive numbers. */
static inline uint32_t fibrad_patch_number(uint32_t face, uint32_t x, uint32_t y, uint32_t side) {
    x = x < side ? x : side - 1, y = y < side ? y : side - 1;
    return face * side * side + ((x >> 1) * (side >> 1) + (y >> 1)) * 4 + (x & 1) * 2 + (y & 1);
}

/* The face and the place on it, in squares, of a normal. */
static inline uint32_t fibrad_patch_place(const double normal[3], uint32_t side, double at[2]) {
    static const double frame[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double axes[9], n[3];
    fibrad_patch_turn(frame, axes);
    for (int row = 0; row < 3; row++)
        n[row] = normal[0] * axes[row] + normal[1] * axes[3 + row] + normal[2] * axes[6 + row];
    uint32_t axis = fibrad_abs(n[0]) < fibrad_abs(n[1]) ? 1 : 0;
    if (fibrad_abs(n[axis]) < fibrad_abs(n[2])) axis = 2;
    for (uint32_t k = 0; k < 2; k++) {
        const double t = n[k < axis ? k : k + 1] / fibrad_abs(n[axis]);
        at[k] = fibrad_max(0, t * (1.25 - .25 * (t * t)) + 1) * (.5 * side);
    }
    return 2 * axis + (n[axis] < 0);
}

/* The t, [-1, 1], whose image t (5 - t^2)/4 is at a, [-1, 1]. */
static inline double fibrad_patch_unmapped(double a) {
    double t = a;
    for (int k = 0; k < 6; k++) t -= (t * (5 - t * t) - 4 * a) / (5 - 3 * t * t);
    return t;
}

/* The patch of a normal. */
static inline uint32_t fibrad_patch_of(const double normal[3], uint32_t side) {
    double at[2];
    const uint32_t face = fibrad_patch_place(normal, side, at);
    return fibrad_patch_number(face, (uint32_t)at[0], (uint32_t)at[1], side);
}

#endif
