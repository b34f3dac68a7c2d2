/* worst.h - the largest or the mean of measured errors, for an assertion after a loop. SPDX-License-Identifier: MIT
 *
 * fmax and `if (x > worst)` leave NaN out. Here NaN stays to the end, where every comparison with it fails. */
#ifndef TESTS_WORST_H
#define TESTS_WORST_H

#include <math.h>
#include <stdint.h>

/* Makes `worst` the larger of itself and `value`. The result is NaN if either of them is NaN. */
static inline void worst_of(double *worst, double value) {
    if (!isnan(*worst) && !(value <= *worst)) *worst = value;
}

/* Makes `least` the smaller of itself and `value`. The result is NaN if either of them is NaN. */
static inline void least_of(double *least, double value) {
    if (!isnan(*least) && !(value >= *least)) *least = value;
}

/* The root mean square of the differences of two lists, divided by the root mean square of the second list. */
static inline double difference_of(const double *a, const double *b, uint32_t n) {
    double square = 0, size = 0;
    for (uint32_t i = 0; i < n; i++) square += (a[i] - b[i]) * (a[i] - b[i]), size += b[i] * b[i];
    return sqrt(square / size);
}

#endif
