/* test_curve.c - curves of tables against interpolation and integrals of GSL. SPDX-License-Identifier: MIT */
#include <gsl/gsl_interp.h>
#include <math.h>

#include "suite.h"
#include "text/read_curve.h"

enum { POINTS = 5 };
static double x[POINTS] = {300, 301, 450, 700, 1200}, y[POINTS] = {800, 900, 400, 400, 1300};
static const struct curve curve = {x, y, POINTS};
static gsl_interp *interp;

static void begin(void) {
    interp = gsl_interp_alloc(gsl_interp_linear, POINTS);
    gsl_interp_init(interp, x, y, POINTS);
}

static void end(void) { gsl_interp_free(interp); }

FIXTURE(begin, end)

/* The integral of y from the first point to `at`. */
static double integral(double at) {
    if (at < x[0]) return y[0] * (at - x[0]);
    const double last = x[POINTS - 1], inside = at < last ? at : last;
    return gsl_interp_eval_integ(interp, x, y, x[0], inside, NULL) + y[POINTS - 1] * (at - inside);
}

TEST(values) {
    for (double at = 300; at < 1200; at += 7.1)
        ck_assert_double_eq_tol(curve_at(&curve, at), gsl_interp_eval(interp, x, y, at, NULL), 1e-10);
    for (int k = 0; k < POINTS; ++k) ck_assert(curve_at(&curve, x[k]) == y[k]);
    ck_assert(curve_at(&curve, 200) == y[0] && curve_at(&curve, 2000) == y[POINTS - 1]);
}

/* The test goes from places inside, on points and outside, forth and back. */
TEST(ways_of_given_areas) {
    const double from[] = {-200, 250, 300, 300.5, 440, 450, 600, 1199, 1200, 1500};
    const double areas[] = {1e-3, 3, 900, 4e4, 2e5, 9e5};
    for (int k = 0; k < 60; ++k)
        for (int sign = -1; sign <= 1; sign += 2) {
            const double area = sign * areas[k % 6], to = curve_advance(&curve, from[k / 6], area);
            ck_assert_double_eq_tol(integral(to) - integral(from[k / 6]), area, 1e-9);
            ck_assert_double_eq_tol(curve_advance(&curve, to, -area), from[k / 6], 1e-11);
        }
    ck_assert(curve_advance(&curve, 450, 0) == 450 && curve_advance(&curve, 100, 0) == 100);
}

TEST(one_point) {
    const struct curve flat = {x, y, 1};
    ck_assert(curve_advance(&flat, 500, 1600) == 502 && curve_advance(&flat, 500, -1600) == 498);
}
