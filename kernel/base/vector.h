/* vector.h - products of two vectors, and the frame about a direction. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_BASE_VECTOR_H
#define FIBRAD_BASE_VECTOR_H

#include "base/port.h"

static inline double fibrad_dot(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void fibrad_cross(const double a[3], const double b[3], double product[3]) {
    product[0] = a[1] * b[2] - a[2] * b[1];
    product[1] = a[2] * b[0] - a[0] * b[2];
    product[2] = a[0] * b[1] - a[1] * b[0];
}

/* Two unit vectors across a unit vector w. u, v and w are a right-handed frame. */
static inline void fibrad_frame_about(const double w[3], double u[3], double v[3]) {
    int least = fibrad_abs(w[1]) < fibrad_abs(w[0]) ? 1 : 0;
    if (fibrad_abs(w[2]) < fibrad_abs(w[least])) least = 2;
    const double scale = 1 / fibrad_sqrt(1 - w[least] * w[least]);
    for (int axis = 0; axis < 3; axis++) u[axis] = ((axis == least) - w[least] * w[axis]) * scale;
    fibrad_cross(w, u, v);
}

#endif
