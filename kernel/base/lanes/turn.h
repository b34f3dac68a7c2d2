/* turn.h - cosine and sine in lanes, by polynomials. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_TURN_H
#define FIBRAD_TURN_H

#include "base/port.h"

/* sin(2 pi t) for t in [-1/4, 1/4], by its series to the 19th power: to 1e-15. */
static inline vd vd_sine_quarter(vd t) {
    static const double ratio[] = {1. / (18 * 19), 1. / (16 * 17), 1. / (14 * 15), 1. / (12 * 13), 1. / (10 * 11),
                                   1. / (8 * 9),   1. / (6 * 7),   1. / (4 * 5),   1. / (2 * 3)};
    vd x = 2 * FIBRAD_PI * t, square = x * x, sum = vd_set1(1);
    for (int k = 0; k < 9; k++) sum = 1 - square * ratio[k] * sum;
    return x * sum;
}

/* Cosine and sine of t turns, t in [0, 1). */
static inline void vd_turn(vd t, vd *cosine, vd *sine) {
    vd y = t - .5, size = vd_abs(y);
    *cosine = vd_sine_quarter(.25 - size);
    vd folded = vd_sine_quarter(vd_min(size, .5 - size));
    *sine = vd_select(vd_lt(y, vd_set1(0)), 0 - folded, folded);
}

#endif
