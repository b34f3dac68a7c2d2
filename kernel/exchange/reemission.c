/* reemission.c - relative conductivity, and what a ball gives off evenly. SPDX-License-Identifier: MIT */
#include "exchange/paths.h"

/* From here on the series of above_leading is right to rounding. */
#define SERIES_FROM 24

/* Let b be the integral of t^(z - 1/2)/(1 + t) over t from 0 to 1. The function returns 2 z b - 1. This is a series in
 * 1/z^2 whose coefficients are Euler's numbers over 4^k. z: above SERIES_FROM. */
static double above_leading(double z) {
    static const double coefficient[] = {-1.0 / 4,     5.0 / 16,        -61.0 / 64,
                                         1385.0 / 256, -50521.0 / 1024, 2702765.0 / 4096};
    const double step = 1 / (z * z);
    double sum = 0;
    for (int k = 5; k >= 0; k--) sum = (sum + coefficient[k]) * step;
    return sum;
}

/* m = 1 - a + a (2 a - 1) b, b being the integral of t^a/(1 + t) over t from 0 to 1. For large a the leading terms
 * cancel in closed form. For small a, b follows from b at a + 24 by 24 steps of b(a - 1) = 1/a - b(a). */
double fibrad_reemitted_evenly(double a) {
    if (a >= SERIES_FROM) {
        const double z = a + 0.5;
        return 0.5 / z + (z - 1.5 + 0.5 / z) * above_leading(z);
    }
    const double z = a + SERIES_FROM + 0.5;
    double b = (1 + above_leading(z)) / (2 * z);
    for (int k = SERIES_FROM; k > 0; k--) b = 1 / (a + k) - b;
    return 1 - a + a * (2 * a - 1) * b;
}

double fibrad_relative_conductivity(double conductivity, double radius, double temperature, double sigma) {
    return conductivity / (8 * radius * sigma * temperature * temperature * temperature);
}

double fibrad_node_emissivity(double emissivity, double conductivity) {
    if (!(emissivity >= 0 && emissivity <= 1 && conductivity >= FIBRAD_RELATIVE_CONDUCTIVITY_MIN))
        return __builtin_nan("");
    return emissivity * fibrad_reemitted_evenly(emissivity / (2 * conductivity));
}
