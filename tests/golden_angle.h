/* golden_angle.h - multiples of the golden angle for tests, independent of the kernel's tables.
 * SPDX-License-Identifier: MIT
 *
 * The golden angle is (3 - sqrt 5)/2 of a turn. F(91)/F(93), a ratio of Fibonacci numbers, is a convergent of it. For k
 * < 65536, k times the convergent is wrong by k/(sqrt 5 F(93)^2) < 1e-34 of a turn. k F(91) mod F(93) is exact in
 * integers. */
#ifndef FIBRAD_TEST_GOLDEN_ANGLE_H
#define FIBRAD_TEST_GOLDEN_ANGLE_H

#include <float.h>
#include <math.h>
#include <stdint.h>

#define FIBONACCI_91 UINT64_C(4660046610375530309)
#define FIBONACCI_93 UINT64_C(12200160415121876738)

/* Bound of the error of the C library's trigonometry in long double and of one rounding to double. */
#define GOLDEN_TOLERANCE (8 * LDBL_EPSILON)

/* k F(91) mod F(93) from its value for k - 1. */
static inline uint64_t golden_next(uint64_t previous) {
    uint64_t room = FIBONACCI_93 - FIBONACCI_91;
    return previous >= room ? previous - room : previous + FIBONACCI_91;
}

/* The angle in (-pi, pi] [rad]. */
static inline long double golden_angle(uint64_t remainder) {
    const long double turn = 6.283185307179586476925286766559005768L;
    return remainder > FIBONACCI_93 / 2 ? -turn * ((long double)(FIBONACCI_93 - remainder) / (long double)FIBONACCI_93)
                                        : turn * ((long double)remainder / (long double)FIBONACCI_93);
}

/* Half the spacing of the doubles at x. A value that was rounded once is at most so far from the true value. */
static inline long double half_ulp(double x) {
    x = fabs(x);
    return x < DBL_MIN ? 0 : ((long double)nextafter(x, INFINITY) - x) / 2;
}

#endif
