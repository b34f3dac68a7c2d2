/* worst.h - the largest of measured errors, for an assertion after a loop. SPDX-License-Identifier: MIT
 *
 * fmax and `if (x > worst)` leave NaN out. Here NaN stays to the end, where every comparison with it fails. */
#ifndef TESTS_WORST_H
#define TESTS_WORST_H

#include <math.h>

/* Makes `worst` the larger of itself and `value`. The result is NaN if either of them is NaN. */
static inline void worst_of(double *worst, double value) {
    if (!isnan(*worst) && !(value <= *worst)) *worst = value;
}

/* Makes `least` the smaller of itself and `value`. The result is NaN if either of them is NaN. */
static inline void least_of(double *least, double value) {
    if (!isnan(*least) && !(value >= *least)) *least = value;
}

#endif
