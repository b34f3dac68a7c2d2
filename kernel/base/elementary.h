/* elementary.h - exponential, logarithm, sine and cosine by polynomials. SPDX-License-Identifier: MIT
 *
 * The functions use only sums and products, so their bits are the same everywhere. Their errors are some units in
 * the last place. That is far below what random samples need. */
#ifndef FIBRAD_BASE_ELEMENTARY_H
#define FIBRAD_BASE_ELEMENTARY_H

#include "base/port.h"

static const double fibrad_inverse_factorial[16] = {
    0x1.0000000000000p+0,  0x1.0000000000000p+0,  0x1.0000000000000p-1,  0x1.5555555555555p-3,
    0x1.5555555555555p-5,  0x1.1111111111111p-7,  0x1.6c16c16c16c17p-10, 0x1.a01a01a01a01ap-13,
    0x1.a01a01a01a01ap-16, 0x1.71de3a556c734p-19, 0x1.27e4fb7789f5cp-22, 0x1.ae64567f544e4p-26,
    0x1.1eed8eff8d898p-29, 0x1.6124613a86d09p-33, 0x1.93974a8c07c9dp-37, 0x1.ae7f3e733b81fp-41,
};

/* 2^k, k in [-1022, 1023]. */
static inline double fibrad_power_of_two(int64_t k) {
    uint64_t bits = (uint64_t)(k + 1023) << 52;
    double x;
    fibrad_copy(&x, &bits, sizeof x);
    return x;
}

/* e^x for x <= 700; 0 below -700. The argument is brought to |r| <= ln(2)/2, where Taylor's series ends at r^13. */
static inline double fibrad_exp(double x) {
    if (!(x > -700)) return 0;
    double k = fibrad_floor(x * 0x1.71547652b82fep0 + 0.5);
    double r = x - k * 0x1.62e42fefa3800p-1 - k * 0x1.ef35793c76730p-45; /* ln 2 in two parts, the first with zeros */
    double sum = fibrad_inverse_factorial[13];
    for (int n = 12; n >= 0; n--) sum = sum * r + fibrad_inverse_factorial[n];
    return sum * fibrad_power_of_two((int64_t)k);
}

/* Natural logarithm of a normal x > 0. With x = m 2^k, m in [sqrt(1/2), sqrt(2)): ln m = 2 artanh((m-1)/(m+1)). */
static inline double fibrad_log(double x) {
    uint64_t bits;
    fibrad_copy(&bits, &x, sizeof bits);
    double k = (double)(bits >> 52) - 1023;
    bits = (bits & 0xfffffffffffffu) | 0x3ff0000000000000u;
    fibrad_copy(&x, &bits, sizeof x);
    if (x > 0x1.6a09e667f3bcdp0) {
        x *= 0.5;
        k += 1;
    }
    double s = (x - 1) / (x + 1), s2 = s * s, sum = 0;
    for (int n = 21; n > 0; n -= 2) sum = sum * s2 + 2.0 / n; /* constants, once unrolled */
    return k * 0x1.62e42fefa39efp-1 + sum * s;
}

/* Sine and cosine of u turns, u in [0, 1]. Subtracts the nearest quarter turn. The rest is at most pi/4, where
 * Taylor's series serves. */
static inline void fibrad_sincos_turn(double u, double *sine, double *cosine) {
    int quarter = (int)(4 * u + 0.5);
    double r = (u - 0.25 * quarter) * 0x1.921fb54442d18p2, r2 = r * r;
    double s = fibrad_inverse_factorial[15], c = fibrad_inverse_factorial[14];
    for (int n = 13; n > 0; n -= 2) {
        s = fibrad_inverse_factorial[n] - s * r2;
        c = fibrad_inverse_factorial[n - 1] - c * r2;
    }
    s *= r;
    *sine = quarter & 1 ? c : s;
    *cosine = quarter & 1 ? s : c;
    if (quarter & 2) *sine = -*sine;
    if ((quarter + 1) & 2) *cosine = -*cosine;
}

/* A direction, spread evenly over the sphere, from two numbers in [0, 1). */
static inline void fibrad_even_direction(const double x[2], double w[3]) {
    const double z = 1 - 2 * x[0], ring = fibrad_sqrt(fibrad_max(0, 1 - z * z));
    double sine, cosine;
    fibrad_sincos_turn(x[1], &sine, &cosine);
    w[0] = ring * cosine, w[1] = ring * sine, w[2] = z;
}

/* The angle in [0, pi/2] of the point (x, y). x and y are 0 to 1e150, and not both are 0. The angle to the nearer
 * axis is halved twice, to at most pi/16. There the series of atan ends at u^25. */
static inline double fibrad_quarter_angle(double x, double y) {
    double u = y < x ? y / x : x / y;
    u = u / (1 + fibrad_sqrt(1 + u * u));
    u = u / (1 + fibrad_sqrt(1 + u * u));
    double u2 = u * u, sum = 1.0 / 25;
    for (int n = 23; n > 0; n -= 2) sum = 1.0 / n - u2 * sum; /* constants, once unrolled */
    return y < x ? 4 * (u * sum) : 0x1.921fb54442d18p0 - 4 * (u * sum);
}

#endif
