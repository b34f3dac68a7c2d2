/* test_reference.c - the host's adaptive reference for blocked scenes. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdint.h>

#include "fibrad.h"
#include "papers/pair/reference.h"
#include "suite.h"

enum { MAX = 300 };
static double x[MAX], y[MAX], z[MAX], r[MAX], f[MAX], escaped;
static fibrad_spheres spheres = {.x = x, .y = y, .z = z, .r = r};
static struct reference_report report;

static void add(double x_, double y_, double z_, double r_) {
    const uint32_t n = spheres.n++;
    x[n] = x_, y[n] = y_, z[n] = z_, r[n] = r_;
}

static void start(void) { spheres.n = 0; }

FIXTURE(start, NULL)

/* Touching, nearly touching, far, small and large spheres about the first one. */
static void crowd(void) {
    add(0, 0, 0, 1);
    add(2, 0, 0, 1);
    add(-1.2, 1.8, 0.3, 0.9);
    add(0.2, -2.3, 1, 1.51);
    add(0.5, 0.8, 2.2, 0.7);
    add(3, 2.2, 1, 1.5);
    add(-2, -2, -2, 1);
    add(0.3, 0.1, -2.5, 0.1);
}

static double row(uint32_t i, double tolerance) {
    const struct reference_rule rule = {tolerance, 1u << 24};
    ck_assert_int_eq(reference_row(&spheres, i, &rule, f, &escaped, &report), REFERENCE_OK);
    ck_assert_double_le(report.error, tolerance);
    double sum = escaped;
    for (uint32_t j = 0; j < spheres.n; j++) sum += f[j];
    return sum;
}

static double pair(uint32_t i, uint32_t j, double tolerance) {
    const struct reference_rule rule = {tolerance, 1u << 24};
    double value = -1;
    ck_assert_int_eq(reference_pair(&spheres, i, j, &rule, &value, &report), REFERENCE_OK);
    ck_assert_double_le(report.error, tolerance);
    return value;
}

TEST(unobstructed_pairs_are_exact) {
    static const double scene[][3] = {{1, 1, 0},      {1, 0.7, 0.3}, {0.7, 1, 0.3},    {1, 1, -0.05},
                                      {0.3, 2, -0.2}, {2, 0.05, 1},  {0.05, 2, 0.001}, {1e-150, 1e-150, 1e-150}};
    for (size_t k = 0; k < sizeof scene / sizeof *scene; k++) {
        const double *s = scene[k];
        double exact;
        assert_ok(fibrad_pair_exact(s[0], s[1], s[2], &exact));
        spheres.n = 0;
        const double d = s[0] + s[1] + s[2];
        add(0.1 * d, -0.2 * d, 0.3 * d, s[0]);
        add(0.1 * d + 0.48 * d, -0.2 * d + 0.6 * d, 0.3 * d - 0.64 * d, s[1]);
        /* visible areas of overlapping spheres jump where the centres have equal depths, so rows converge slowly */
        const double tolerance = s[2] < 0 ? 1e-4 : 1e-7, sum = row(0, tolerance), value = pair(0, 1, 1e-8);
        ck_assert_msg(fabs(value / exact - 1) < 1e-8, "pair %zu: %.12g, exact %.12g", k, value, exact);
        ck_assert_msg(fabs(f[1] - exact) < tolerance, "row %zu: %.12g, exact %.12g", k, f[1], exact);
        ck_assert_double_eq(f[0], 0);
        ck_assert_double_le(fabs(sum - 1), 1e-8);
    }
}

TEST(rows_close_and_agree_with_pairs) {
    crowd();
    for (uint32_t i = 0; i < 3; i++) {
        const double sum = row(i, 1e-6);
        ck_assert_double_le(fabs(sum - 1), 1e-8);
        ck_assert_double_gt(escaped, 0);
        for (uint32_t j = 0; j < spheres.n; j++)
            if (j != i) ck_assert_double_le(fabs(pair(i, j, 3e-6) - f[j]), 1e-7);
    }
}

TEST(pairs_are_reciprocal) {
    crowd();
    for (uint32_t i = 0; i < spheres.n; i++)
        for (uint32_t j = 0; j < i; j++) {
            const double there = pair(i, j, 1e-5) * r[i] * r[i], back = pair(j, i, 1e-5) * r[j] * r[j];
            ck_assert_msg(fabs(there - back) < 1e-7, "%u, %u: %.12g %.12g", i, j, there, back);
        }
}

TEST(tighter_tolerance_stays_within_the_estimate) {
    crowd();
    double fine[MAX];
    row(0, 2e-8);
    for (uint32_t j = 0; j < spheres.n; j++) fine[j] = f[j];
    for (double tolerance = 1e-4; tolerance > 5e-8; tolerance /= 10) {
        row(0, tolerance);
        for (uint32_t j = 0; j < spheres.n; j++) ck_assert_double_le(fabs(f[j] - fine[j]), report.error);
    }
}

TEST(hidden_spheres_are_not_seen) {
    /* equal spheres in a line: at every angle the lens of the outer discs lies inside the middle disc */
    add(0, 0, 0, 1);
    add(0, 0, 5, 1);
    add(0, 0, 2.5, 1);
    ck_assert_double_eq(pair(0, 1, 1e-9), 0);
    row(0, 1e-6);
    ck_assert_double_eq(f[1], 0);
    /* an obstacle beside the beam changes nothing */
    double exact;
    fibrad_pair_exact(1, 1, 3, &exact);
    x[2] = 2.001;
    assert_near(pair(0, 1, 1e-9), exact, 1e-9);
    x[2] = 1.9;
    ck_assert_double_lt(pair(0, 1, 1e-9), exact * (1 - 1e-5));
}

/* Rays start at random points of sphere 0 and follow the cosine law. They share nothing with beams, slices or
 * cubature. */
TEST(random_rays_agree) {
    enum { RAYS = 400000 };
    crowd();
    uint64_t state = 1;
    uint32_t hits[MAX] = {0};
    for (int ray = 0; ray < RAYS; ray++) {
        double u[4], o[3], w[3];
        for (int k = 0; k < 4; k++) {
            state = state * 6364136223846793005u + 1442695040888963407u;
            u[k] = ldexp((double)(state >> 11), -53);
        }
        const double pi = 3.14159265358979323846, c = 1 - 2 * u[0], s = sqrt(1 - c * c), p = 2 * pi * u[1];
        o[0] = s * cos(p), o[1] = s * sin(p), o[2] = c;
        /* the normal plus a uniform unit vector has the cosine law */
        const double e = 1 - 2 * u[2], t = sqrt(1 - e * e), q = 2 * pi * u[3];
        w[0] = o[0] + t * cos(q), w[1] = o[1] + t * sin(q), w[2] = o[2] + e;
        const double length = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
        double nearest = INFINITY;
        uint32_t hit = 0;
        for (uint32_t j = 1; j < spheres.n; j++) {
            const double m[3] = {x[j] - o[0], y[j] - o[1], z[j] - o[2]};
            const double along = (m[0] * w[0] + m[1] * w[1] + m[2] * w[2]) / length;
            const double miss = m[0] * m[0] + m[1] * m[1] + m[2] * m[2] - along * along, left = r[j] * r[j] - miss;
            if (along > 0 && left > 0 && along - sqrt(left) < nearest) nearest = along - sqrt(left), hit = j;
        }
        hits[hit]++;
    }
    row(0, 1e-5);
    for (uint32_t j = 0; j < spheres.n; j++) {
        const double truth = j ? f[j] : escaped, seen = (double)hits[j] / RAYS;
        ck_assert_msg(fabs(seen - truth) < 5 * sqrt(truth / RAYS) + 1e-5, "%u: rays %g, row %g", j, seen, truth);
    }
}

/* Row sums of the face-centred cubic lattice of touching unit spheres within a distance of centres. */
TEST(face_centred_cubic_rows_add_up) {
    static const double reach[] = {2, 3, 4}, sum[] = {0.8626, 0.9651, 0.9973};
    const double half = sqrt(2.0);
    for (int k = 0; k < 3; k++) {
        spheres.n = 0;
        add(0, 0, 0, 1);
        for (int a = -3; a <= 3; a++)
            for (int b = -3; b <= 3; b++)
                for (int c = -3; c <= 3; c++) {
                    const double d2 = 2.0 * (a * a + b * b + c * c);
                    if ((a + b + c) % 2 == 0 && d2 > 0 && d2 < reach[k] * reach[k] + 1e-9)
                        add(a * half, b * half, c * half, 1);
                }
        ck_assert_double_le(fabs(row(0, 2e-5) - 1), 1e-8);
        ck_assert_msg(fabs(1 - escaped - sum[k]) < 1e-4, "reach %g: %.6f", reach[k], 1 - escaped);
        /* all twelve neighbours are alike, although the cubature has axes */
        for (uint32_t j = 2; j < 13 && k == 0; j++) ck_assert_double_le(fabs(f[j] - f[1]), 2e-5);
    }
}

TEST(bad_arguments_are_refused) {
    const struct reference_rule rule = {1e-3, 1000}, scarce = {1e-9, 1000};
    crowd();
    ck_assert_int_eq(reference_row(&spheres, 8, &rule, f, &escaped, &report), REFERENCE_ARGUMENT);
    ck_assert_int_eq(reference_pair(&spheres, 0, 8, &rule, f, &report), REFERENCE_ARGUMENT);
    ck_assert_int_eq(reference_pair(&spheres, 8, 0, &rule, f, &report), REFERENCE_ARGUMENT);
    ck_assert_int_eq(reference_pair(&spheres, 1, 1, &rule, f, &report), REFERENCE_ARGUMENT);
    ck_assert_int_eq(reference_row(&spheres, 0, &scarce, f, &escaped, &report), REFERENCE_UNCONVERGED);
    ck_assert_double_gt(report.error, 1e-9);
    ck_assert_double_gt(f[1], 0.05);
    x[1] = 0.1; /* inside sphere 0 */
    r[1] = 0.5;
    ck_assert_int_eq(reference_pair(&spheres, 0, 1, &rule, f, &report), REFERENCE_ARGUMENT);
    x[1] = 0;
    ck_assert_int_eq(reference_row(&spheres, 0, &rule, f, &escaped, &report), REFERENCE_ARGUMENT);
}
