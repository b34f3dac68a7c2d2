/* test_pair_exact.c - the view factor of an unobstructed pair. SPDX-License-Identifier: MIT */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "papers/pair/exact_gsl.h"
#include "fibrad.h"
#include "suite.h"

static double exact(double r1, double r2, double gap) {
    double f12 = -1;
    assert_ok(fibrad_pair_exact(r1, r2, gap, &f12));
    return f12;
}

static double relative(double value, double truth) { return fabs(value / truth - 1); }

/* True values, which data/generate_pair_exact.c made in 113-bit arithmetic from the integral over the distance of the
 * discs. Ratios of radii go to 1e4, gaps from 1e-300 to 1e12, and overlaps to nearly the centre. F is compared in both
 * directions, and for reciprocity. */
TEST(factors_are_the_true_values) {
    OWNED_FILE *file = opened("tests/data/pair_exact.csv", "r");
    char line[256];
    int lines = 0;
    ck_assert_ptr_nonnull(fgets(line, sizeof line, file));
    while (fgets(line, sizeof line, file)) {
        char *end = line;
        const double r1 = strtod(end, &end), r2 = strtod(end + 1, &end), gap = strtod(end + 1, &end);
        const double truth = strtod(end + 1, &end), there = exact(r1, r2, gap), back = exact(r2, r1, gap);
        ck_assert_msg(relative(there, truth) < 2e-15, "%s: %.17g", line, there);
        ck_assert_msg(relative(back * r2 * r2, there * r1 * r1) < 1e-15, "%s: reciprocity %.17g", line, back);
        lines++;
    }
    ck_assert_int_gt(lines, 700);
}

TEST(factors_are_the_closed_forms) {
    ck_assert_double_le(relative(exact(1, 1, 0), 0.5 - 4 / (3 * M_PI)), 1e-15);
    ck_assert_double_le(relative(exact(1, 1, 0), 0.0755868184216124), 1e-14);
    /* a small sphere that touches a plane sees it in half of its directions */
    ck_assert_double_le(fabs(exact(1e-8, 1, 0) - 0.5), 1e-4);
    /* the spheres overlap to (nearly) equal centres: all directions see the other sphere's half */
    ck_assert_double_le(fabs(exact(1, 1, -2 + 1e-15) - 0.5), 1e-14);
    ck_assert_double_le(fabs(exact(1, 2, -2 + 1e-15) - 0.5), 1e-7);
}

TEST(far_spheres_have_the_far_field) {
    for (double gap = 1e8; gap < 1e13; gap *= 10) {
        const double d = 3 + gap;
        ck_assert_double_le(relative(exact(2, 1, gap), 0.25 / d / d), 2e-15);
        ck_assert_double_le(relative(exact(1, 2, gap), 1 / d / d), 2e-15);
    }
    ck_assert_double_eq(exact(1, 1, 1e300), 0);
    ck_assert_double_le(exact(1e-150, 1e150, DBL_MAX), 1e-317);
    ck_assert_double_le(exact(1e150, 1e-150, DBL_MAX), 0);
}

/* The lens integral has neither the variable nor the integrand of the kernel's formula. */
TEST(quadratures_of_gsl_agree) {
    static const double radius[] = {1, 0.7, 0.1, 1e-3, 1e-4}, gap[] = {0, 1e-12, 1e-6, 1e-3, 0.1, 1, 6, 100, 1e6};
    static const double overlap[] = {-1e-9, -1e-6, -1e-4, -0.01, -0.5, -1.5};
    double f12, abserr;
    for (size_t i = 0; i < sizeof radius / sizeof *radius; i++) {
        const double r = radius[i];
        for (size_t k = 0; k < sizeof gap / sizeof *gap; k++) {
            ck_assert_int_eq(exact_gsl_lens(1, r, gap[k], &f12, &abserr), 0);
            ck_assert_msg(relative(exact(1, r, gap[k]), f12) < 1e-14, "lens 1 %g %g: %.17g", r, gap[k], f12);
        }
        for (size_t k = 0; k < sizeof overlap / sizeof *overlap; k++) {
            ck_assert_int_eq(exact_gsl_lens(r, 1, overlap[k] * r, &f12, &abserr), 0);
            ck_assert_msg(relative(exact(r, 1, overlap[k] * r), f12) < 2e-14, "lens %g 1 %g: %.17g", r, overlap[k] * r,
                          f12);
        }
    }
    ck_assert_int_ne(exact_gsl_lens(1, 1, -2, &f12, &abserr), 0);
}

static const double scene[][3] = {{1, 1, 0},     {1, 0.3, 1e-12},  {0.7, 1.3, 1e-5}, {1e-4, 1, 0.3}, {2, 3, 1e8},
                                  {1, 1, -1e-9}, {1.5, 0.2, -0.1}, {1, 1, -1.9},     {3e3, 0.3, 40}, {1, 0.9999, 2}};

/* Scaling by powers of two from 1e-144 to 1e144 changes no bit. */
TEST(scaling_by_two_changes_no_bit) {
    for (size_t i = 0; i < sizeof scene / sizeof *scene; i++)
        for (int k = -480; k <= 480; k += 6) {
            const double *s = scene[i], scaled = exact(ldexp(s[0], k), ldexp(s[1], k), ldexp(s[2], k));
            ck_assert_msg(scaled == exact(s[0], s[1], s[2]), "scene %d scaled by 2^%d", (int)i, k);
        }
}

TEST(scaling_by_ten_changes_roundings) {
    for (size_t i = 0; i < sizeof scene / sizeof *scene; i++)
        for (int k = -145; k <= 145; k += 10) {
            const double *s = scene[i], unit = pow(10, k);
            ck_assert_double_le(relative(exact(s[0] * unit, s[1] * unit, s[2] * unit), exact(s[0], s[1], s[2])), 1e-14);
        }
}

/* F falls with the gap, on both sides of contact and across it. Steps go down to where the slope meets rounding. F
 * changes by no more than the step allows, so it does not jump. */
TEST(factors_go_smoothly_across_contact) {
    static const double radius[] = {1, 0.5, 0.01, 1e-4};
    for (size_t i = 0; i < sizeof radius / sizeof *radius; i++)
        for (int exponent = -13; exponent <= -3; exponent++) {
            const double r = radius[i], step = r * pow(10, exponent);
            double before = exact(1, r, -100.5 * step);
            for (int k = -100; k <= 100; k++) {
                const double f12 = exact(1, r, (k + 0.5) * step - step);
                const double fall = (before - f12) / (r * r), rounding = 1e-15;
                ck_assert_msg(fall > -rounding, "1 %g, step %g, %d: %.17g after %.17g", r, step, k, f12, before);
                ck_assert_double_le(fall, 2 * step / r + rounding);
                before = f12;
            }
        }
}

TEST(the_factor_falls_with_the_gap) {
    static const double radius[] = {1, 0.5, 0.01, 1e-4};
    for (size_t i = 0; i < sizeof radius / sizeof *radius; i++) {
        const double r = radius[i];
        double before = 1;
        for (double overlap = 1.999; overlap > 1e-10; overlap *= 0.99) {
            const double f12 = exact(r, 1, -overlap * r);
            ck_assert_double_lt(f12, before);
            before = f12;
        }
        for (double gap = 1e-9; gap < 1e12; gap *= 1.01) {
            const double f12 = exact(r, 1, gap * r);
            ck_assert_double_lt(f12, before);
            before = f12;
        }
    }
}

/* Results at the ends of the range stay within bounds. A sphere at a plane, or in it, sees it in half of all
 * directions. */
TEST(extreme_sizes_are_right) {
    const double large = 1e150, small = 1e-150, contact = exact(1, 1, 0);
    ck_assert_double_eq_tol(exact(large, large, 0), contact, 1e-15);
    ck_assert_double_eq_tol(exact(small, small, 0), contact, 1e-15);
    ck_assert_double_eq(exact(1, 1, DBL_MAX), 0);
    const double gaps[] = {0, 1, -5e-324, -1e-300, -1e-170, -1e-155, -1e-150, -1.9e-150, -nextafter(2e-150, 0)};
    for (size_t k = 0; k < sizeof gaps / sizeof *gaps; k++) {
        ck_assert_double_eq_tol(exact(small, large, gaps[k]), 0.5, 1e-15);
        ck_assert_double_eq(exact(large, small, gaps[k]), 0);
    }
}

TEST(bad_arguments_are_refused) {
    static const double bad[][3] = {
        {0, 1, 1},         {1, 0, 1},     {-1, 1, 1},       {1, -1, 1},       {NAN, 1, 1},
        {1, NAN, 1},       {1, 1, NAN},   {INFINITY, 1, 1}, {1, INFINITY, 1}, {1, 1, INFINITY},
        {1, 1, -INFINITY}, {1, 1, -2},    {3, 0.5, -1},     {0.5, 3, -1},     {1, 1, -3},
        {1, 1e151, 0},     {1e151, 1, 0}, {1, 1e-151, 0},   {1e-151, 1, 0},   {12, DBL_MAX, -9},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        double f12 = 42;
        assert_invalid(fibrad_pair_exact(bad[i][0], bad[i][1], bad[i][2], &f12));
        ck_assert_double_eq(f12, 42);
    }
    assert_invalid(fibrad_pair_exact(1, 1, 1, NULL));
}
