/* bench_pair.c - two free spheres: nanoseconds a call, by the kernel and by GSL's quadrature.
 * SPDX-License-Identifier: MIT
 *
 * The bench writes CSV to standard output. Times are the best of several rounds. `difference` is the largest
 * |kernel/GSL - 1| over the radii. */
#include <math.h>

#include "bench.h"
#include "papers/pair/exact_gsl.h"

enum { RADII = 16 };

static double radius(int k) { return 0.1 * pow(100, k / (RADII - 1.0)); }

/* Nanoseconds a call, as mean over all radii. f gets the factors. */
static double by_kernel(double gap, int times, double f[RADII]) {
    double best = INFINITY;
    for (int round = 0; round < 5; ++round) {
        const double begun = bench_thread_seconds();
        for (int t = 0; t < times; ++t)
            for (int k = 0; k < RADII; ++k)
                if (fibrad_pair_exact(1, radius(k), gap, &f[k])) exit(1);
        best = fmin(best, bench_thread_seconds() - begun);
    }
    return 1e9 * best / times / RADII;
}

static double by_gsl(double gap, double f[RADII]) {
    double abserr;
    const double begun = bench_thread_seconds();
    for (int k = 0; k < RADII; ++k)
        if (exact_gsl_lens(1, radius(k), gap, &f[k], &abserr)) exit(1);
    return 1e9 * (bench_thread_seconds() - begun) / RADII;
}

int main(int argc, char **argv) {
    static const double gaps[] = {0, 1e-6, 1e-3, 0.01, 0.1, 1, 10, 100};
    const int times = argc > 1 && strcmp(argv[1], "quick") == 0 ? 10 : 20000;
    bench_preamble("bench_pair: exact factor of two free spheres, radii 1 and 0.1 to 10", 1);
    puts("gap,kernel_ns,gsl_ns,ratio,difference");
    for (size_t g = 0; g < sizeof gaps / sizeof *gaps; ++g) {
        double kernel[RADII], gsl[RADII], difference = 0;
        const double kernel_ns = by_kernel(gaps[g], times, kernel), gsl_ns = by_gsl(gaps[g], gsl);
        for (int k = 0; k < RADII; ++k) difference = fmax(difference, fabs(kernel[k] / gsl[k] - 1));
        printf("%g,%.1f,%.0f,%.0f,%.2g\n", gaps[g], kernel_ns, gsl_ns, gsl_ns / kernel_ns, difference);
        if (!(difference < 1e-9)) return fprintf(stderr, "bench_pair: kernel and GSL differ\n"), 1;
    }
    return 0;
}
