/* nearest.h - the nearest place of a triangle. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_NEAREST_H
#define FIBRAD_SIMPLE_NEAREST_H

#include <math.h>
#include <stdbool.h>

static inline double inner(const double a[3], const double b[3]) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static inline void cross(const double a[3], const double b[3], double to[3]) {
    for (int k = 0; k < 3; ++k) to[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* The point of the side from `a` along `side` that is nearest to the origin. */
static inline double nearest_on_side(const double a[3], const double side[3], double to[3]) {
    const double square = inner(side, side), share = square > 0 ? -inner(a, side) / square : 0;
    const double along = share < 0 ? 0 : share > 1 ? 1 : share;
    for (int k = 0; k < 3; ++k) to[k] = a[k] + along * side[k];
    return inner(to, to);
}

/* The point of a triangle that is nearest to the origin. corner[3]: relative to the origin. *inside: the point lies on
 * no edge. Returns its distance. */
static inline double nearest_on_triangle(double corner[3][3], double to[3], bool *inside) {
    double side[3][3], normal[3], best = INFINITY;
    for (int c = 0; c < 3; ++c)
        for (int k = 0; k < 3; ++k) side[c][k] = corner[(c + 1) % 3][k] - corner[c][k];
    cross(side[0], side[1], normal);
    const double square = inner(normal, normal);
    *inside = square > 0;
    for (int c = 0; c < 3; ++c) {
        double out[3], at[3];
        cross(side[c], normal, out);
        *inside = *inside && inner(out, corner[c]) >= 0;
        const double far = nearest_on_side(corner[c], side[c], at);
        if (far >= best) continue;
        best = far;
        for (int k = 0; k < 3; ++k) to[k] = at[k];
    }
    if (!*inside) return sqrt(best);
    const double height = inner(corner[0], normal) / square;
    for (int k = 0; k < 3; ++k) to[k] = height * normal[k];
    return fabs(height) * sqrt(square);
}

/* Whether a place of a wall lies beside a nearer place. Both are relative to the origin. Along the direction of the
 * nearer place it is then at least nine tenths as far away as this place. */
static inline bool lies_beside(const double place[3], const double nearer[3]) {
    return inner(place, nearer) > 0.9 * inner(nearer, nearer);
}

#endif
