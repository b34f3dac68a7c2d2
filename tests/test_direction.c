/* test_direction.c - the spherical Fibonacci set of directions. SPDX-License-Identifier: MIT */
#include "fibrad.h"
#include "sample/direction.h"
#include "golden_angle.h"
#include "suite.h"
#include "worst.h"

#include <stdlib.h>
#include <string.h>

static const uint32_t SIZES[] = {8, 9, 55, 144, 233, 1000, 4181, 10946, 10947, 65535, 65536};
enum { SIZE_COUNT = sizeof SIZES / sizeof SIZES[0] };

LOOP_TEST(directions_agree_with_the_c_library, SIZE_COUNT) {
    uint32_t n = SIZES[_i];
    uint64_t remainder = 0;
    for (uint32_t k = 0; k < n; k++, remainder = golden_next(remainder)) {
        double d[3];
        assert_ok(fibrad_direction(k, n, d));
        long double z = 1 - (2 * k + 1.0L) / n, ring = sqrtl((2 * k + 1.0L) * (2.0L * n - 2 * k - 1)) / n;
        const long double truth[3] = {ring * cosl(golden_angle(remainder)), ring * sinl(golden_angle(remainder)), z};
        for (int axis = 0; axis < 3; axis++)
            ck_assert_ldouble_le(fabsl(d[axis] - truth[axis]), 2 * DBL_EPSILON * fabs(d[axis]) + GOLDEN_TOLERANCE);
        ck_assert_double_le(fabs(sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) - 1), 1e-15);
    }
}

TEST(azimuths_are_rounded_once) {
    uint64_t remainder = 0;
    for (uint32_t k = 0; k < FIBRAD_DIRECTIONS_MAX; k++, remainder = golden_next(remainder)) {
        double c, s;
        fibrad_azimuth(k, &c, &s);
        ck_assert_ldouble_le(fabsl(c - cosl(golden_angle(remainder))), half_ulp(c) + GOLDEN_TOLERANCE);
        ck_assert_ldouble_le(fabsl(s - sinl(golden_angle(remainder))), half_ulp(s) + GOLDEN_TOLERANCE);
    }
}

TEST(sums_have_the_bits_of_the_table) {
#if FIBRAD_TABLE_AZIMUTHS > 0
    for (uint32_t k = 0; k < FIBRAD_TABLE_AZIMUTHS; k++) {
        double sum[2];
        fibrad_azimuth_sum(k, &sum[0], &sum[1]);
        ck_assert_mem_eq(sum, fibrad_table_azimuth[k], sizeof sum);
    }
#endif
}

LOOP_TEST(set_is_balanced, SIZE_COUNT) {
    uint32_t n = SIZES[_i];
    double sum[3] = {0}, square[3][3] = {{0}};
    for (uint32_t k = 0; k < n; k++) {
        double d[3];
        assert_ok(fibrad_direction(k, n, d));
        for (int a = 0; a < 3; a++) {
            sum[a] += d[a];
            for (int b = 0; b < 3; b++) square[a][b] += d[a] * d[b];
        }
    }
    ck_assert_double_le(hypot(sum[0], sum[1]), 1);
    ck_assert_double_le(fabs(sum[2]), 1e-10);
    for (int a = 0; a < 3; a++)
        for (int b = 0; b < 3; b++) ck_assert_double_le(fabs(square[a][b] - (a == b ? n / 3.0 : 0)), 1);
}

/* A hexagonal packing of n points has the distance sqrt(8 pi/sqrt 3)/sqrt n = 3.81/sqrt n. */
LOOP_TEST(nearest_neighbours_keep_their_distance, SIZE_COUNT) {
    enum { LARGEST = 4181 };
    static double d[LARGEST][3];
    uint32_t n = SIZES[_i];
    if (n > LARGEST) return;
    double closest = 2, farthest = 0;
    for (uint32_t k = 0; k < n; k++) assert_ok(fibrad_direction(k, n, d[k]));
    for (uint32_t k = 0; k < n; k++) {
        double nearest = 2;
        for (uint32_t j = 0; j < n; j++)
            if (j != k) least_of(&nearest, hypot(hypot(d[j][0] - d[k][0], d[j][1] - d[k][1]), d[j][2] - d[k][2]));
        least_of(&closest, nearest);
        worst_of(&farthest, nearest);
    }
    ck_assert_double_gt(closest * sqrt(n), 2.6);
    ck_assert_double_lt(farthest * sqrt(n), 3.81);
}

TEST(polar_form_is_the_direction) {
    for (uint32_t k = 0; k < 233; k++) {
        fibrad_polar p = fibrad_direction_polar(k, 233);
        double d[3];
        assert_ok(fibrad_direction(k, 233, d));
        ck_assert_double_eq(d[0], p.ring * p.cos);
        ck_assert_double_eq(d[1], p.ring * p.sin);
        ck_assert_double_eq(d[2], p.z);
    }
}

TEST(bad_arguments_are_refused) {
    static const uint32_t bad[][2] = {{0, 0},          {0, 7},          {8, 8},
                                      {233, 233},      {0, 65537},      {65536, 65536},
                                      {UINT32_MAX, 8}, {0, UINT32_MAX}, {UINT32_MAX, UINT32_MAX}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        double d[3] = {7, 8, 9};
        assert_invalid(fibrad_direction(bad[i][0], bad[i][1], d));
        ck_assert(d[0] == 7 && d[1] == 8 && d[2] == 9);
    }
    assert_invalid(fibrad_direction(0, 8, NULL));
}
