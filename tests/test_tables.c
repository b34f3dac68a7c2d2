/* test_tables.c - the tables of Fibonacci samples against the C library in long double. SPDX-License-Identifier: MIT */
#include "sample/tables.h"
#include "golden_angle.h"
#include "suite.h"
#include "worst.h"

#include <stdlib.h>

static const long double LONG_PI = 3.141592653589793238462643383279502884L;

static void assert_rounded(double value, long double truth) {
    ck_assert_ldouble_le(fabsl((long double)value - truth), half_ulp(value) + GOLDEN_TOLERANCE);
}

TEST(fibonacci_numbers_are_right) {
    uint64_t previous = 1, current = 1, earlier = 0;
    for (int i = 2; i < 93; i++) {
        uint64_t sum = previous + current;
        if (i == 91) earlier = current;
        previous = current;
        current = sum;
    }
    ck_assert_uint_eq(current, FIBONACCI_93);
    ck_assert_uint_eq(earlier, FIBONACCI_91);
}

TEST(azimuths_are_multiples_of_the_golden_angle) {
    uint64_t remainder = 0;
    ck_assert_int_eq(FIBRAD_TABLE_AZIMUTHS, 10946);
    for (uint32_t k = 0; k < FIBRAD_TABLE_AZIMUTHS; k++, remainder = golden_next(remainder)) {
        double cos = fibrad_table_azimuth[k][0], sin = fibrad_table_azimuth[k][1];
        assert_rounded(cos, cosl(golden_angle(remainder)));
        assert_rounded(sin, sinl(golden_angle(remainder)));
        ck_assert_ldouble_le(fabsl((long double)cos * cos + (long double)sin * sin - 1), 2.5e-16L);
    }
}

/* Both parts together must lie on the unit circle to twice the precision. Let c + c' and s + s' be the parts. Fused
 * multiplication finds c^2 + s^2 - 1 exactly. It must be -2 (c c' + s s'). */
static void assert_long_angle(const fibrad_long_angle *a, uint64_t remainder) {
    assert_rounded(a->cos, cosl(golden_angle(remainder)));
    assert_rounded(a->sin, sinl(golden_angle(remainder)));
    ck_assert_ldouble_le(fabsl((long double)a->cos_rest), half_ulp(a->cos));
    ck_assert_ldouble_le(fabsl((long double)a->sin_rest), half_ulp(a->sin));
    double c2 = a->cos * a->cos, c2_rest = fma(a->cos, a->cos, -c2);
    double s2 = a->sin * a->sin, s2_rest = fma(a->sin, a->sin, -s2), large = fmax(c2, s2), small = fmin(c2, s2);
    double excess = (large - 1) + small; /* this is exact, since the larger part is at least 1/2 */
    ck_assert_double_le(fabs(excess + c2_rest + s2_rest + 2 * (a->cos * a->cos_rest + a->sin * a->sin_rest)), 1e-31);
}

TEST(long_angles_have_twice_the_precision) {
    uint64_t remainder = 0;
    for (uint32_t k = 0; k < FIBRAD_DIRECTIONS_MAX; k++, remainder = golden_next(remainder)) {
        if (k < FIBRAD_TABLE_STRIDE) assert_long_angle(&fibrad_table_near[k], remainder);
        if (k % FIBRAD_TABLE_STRIDE == 0) assert_long_angle(&fibrad_table_far[k / FIBRAD_TABLE_STRIDE], remainder);
    }
}

TEST(disc_points_are_sunflowers) {
    for (uint32_t m = 64; m <= 256; m *= 2) {
        fibrad_disc_points points;
        assert_ok(fibrad_disc_points_get(m, &points));
        ck_assert_uint_eq((uintptr_t)points.x % 64, 0);
        ck_assert_uint_eq((uintptr_t)points.y % 64, 0);
        uint64_t remainder = 0;
        double closest = 2, sum_x = 0, sum_y = 0, sum_square = 0;
        for (uint32_t k = 0; k < m; k++, remainder = golden_next(remainder)) {
            double x = (double)points.x[k], y = (double)points.y[k];
            long double radius = sqrtl((k + 0.5L) / m), half = 0x1p-25L + 4 * LDBL_EPSILON;
            ck_assert_ldouble_le(fabsl(x - radius * cosl(golden_angle(remainder))), half);
            ck_assert_ldouble_le(fabsl(y - radius * sinl(golden_angle(remainder))), half);
            for (uint32_t j = 0; j < k; j++)
                least_of(&closest, hypot(x - (double)points.x[j], y - (double)points.y[j]));
            sum_x += x;
            sum_y += y;
            sum_square += x * x + y * y;
        }
        ck_assert_double_gt(closest * sqrt(m),
                            1.4); /* evenly spread points: a square grid of as many points has 1.77 */
        ck_assert_double_le(hypot(sum_x, sum_y), 1);
        ck_assert_double_eq_tol(sum_square, m / 2.0, 1e-5);
    }
}

TEST(surface_nodes_follow_the_mapped_lattice) {
    uint32_t rules = 0;
    for (uint32_t before = 5, n = 8; n <= 987; rules++) {
        fibrad_surface_nodes nodes;
        assert_ok(fibrad_surface_nodes_get(n, &nodes));
        ck_assert_uint_eq(nodes.n, n);
        ck_assert_uint_eq((uintptr_t)nodes.z % 64, 0);
        ck_assert_uint_eq((uintptr_t)nodes.ring % 64, 0);
        ck_assert_uint_eq((uintptr_t)nodes.cos % 64, 0);
        ck_assert_uint_eq((uintptr_t)nodes.sin % 64, 0);
        ck_assert_uint_eq((uintptr_t)nodes.weight % 64, 0);
        double sum = 0;
        for (uint32_t k = 1; k <= n; k++) {
            double z = nodes.z[k - 1], ring = nodes.ring[k - 1], cos = nodes.cos[k - 1], sin = nodes.sin[k - 1];
            int64_t steps = 2 * (int64_t)k - n; /* n z_k */
            long double s = sinl(LONG_PI * steps / n), phi = 2 * LONG_PI * (k * before % n) / n;
            if (k == n) s = 0;
            assert_rounded(z, (long double)steps / n + s / LONG_PI);
            assert_rounded(cos, cosl(phi));
            assert_rounded(sin, sinl(phi));
            assert_rounded(nodes.weight[k - 1], 1 + cosl(LONG_PI * steps / n));
            ck_assert_double_eq_tol(ring * ring + z * z, 1, 1e-15);
            sum += nodes.weight[k - 1];
        }
        assert_near(sum, n, 1e-12);
        ck_assert_double_eq(nodes.z[n - 1], 1);
        ck_assert_double_eq(nodes.ring[n - 1], 0);
        ck_assert_double_eq(nodes.weight[n - 1], 0);
        for (uint32_t k = n; k % 8 != 0; k++) ck_assert_double_eq(nodes.weight[k], 0);
        uint32_t next = before + n;
        before = n;
        n = next;
    }
    ck_assert_uint_eq(rules, 11);
}

TEST(surface_weights_integrate_over_the_sphere) {
    fibrad_surface_nodes nodes; /* the mean of z^2 is 1/3, that of x^2 too, that of x z is 0 */
    assert_ok(fibrad_surface_nodes_get(987, &nodes));
    double zz = 0, xx = 0, xz = 0;
    for (uint32_t k = 0; k < nodes.n; k++) {
        double x = nodes.ring[k] * nodes.cos[k];
        zz += nodes.weight[k] * nodes.z[k] * nodes.z[k] / nodes.n;
        xx += nodes.weight[k] * x * x / nodes.n;
        xz += nodes.weight[k] * x * nodes.z[k] / nodes.n;
    }
    ck_assert_double_eq_tol(zz, 1 / 3.0, 1e-5);
    ck_assert_double_eq_tol(xx, 1 / 3.0, 1e-5);
    ck_assert_double_eq_tol(xz, 0, 1e-5);
}
