/* rectangles.h - view factors between rectangles, for tests. SPDX-License-Identifier: MIT
 *
 * Closed forms of J. R. Howell, A catalog of radiation heat transfer configuration factors. */
#ifndef TESTS_RECTANGLES_H
#define TESTS_RECTANGLES_H

#include <math.h>

#include "asserts.h"

/* C-11: rectangles a by b at distance c. */
static inline double opposite(double a, double b, double c) {
    const double x = a / c, y = b / c, p = 1 + x * x, q = 1 + y * y;
    return 2 / (PI * x * y) *
           (.5 * log(p * q / (p + q - 1)) + x * sqrt(q) * atan(x / sqrt(q)) + y * sqrt(p) * atan(y / sqrt(p)) -
            x * atan(x) - y * atan(y));
}

/* C-14: from a rectangle l by w to one l by h that stands on its edge l. */
static inline double adjacent(double l, double w, double h) {
    const double a = h / l, b = w / l, p = 1 + a * a, q = 1 + b * b, s = a * a + b * b;
    return 1 / (PI * b) *
           (b * atan(1 / b) + a * atan(1 / a) - sqrt(s) * atan(1 / sqrt(s)) +
            .25 * log(p * q / (1 + s) * pow(b * b * (1 + s) / (q * s), b * b) * pow(a * a * (1 + s) / (p * s), a * a)));
}

#endif
