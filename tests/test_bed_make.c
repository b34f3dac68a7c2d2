/* test_bed_make.c - the beds that are made for tests and benches are what they claim to be.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <string.h>
#include "bed/packing.h"
#include "copies.h"
#include "suite.h"

/* The least distance between surfaces. If the bed is periodic, nearest images count. */
static double least_gap(const struct bed *bed) {
    const double *const axis[3] = {bed->x, bed->y, bed->z};
    double least = INFINITY;
    for (uint32_t i = 0; i < bed->n; i++)
        for (uint32_t j = 0; j < i; j++) {
            double square = 0;
            for (int a = 0; a < 3; a++) {
                double e = axis[a][i] - axis[a][j];
                if (bed->period[a] > 0) e -= bed->period[a] * round(e / bed->period[a]);
                square += e * e;
            }
            least = fmin(least, sqrt(square) - bed->r[i] - bed->r[j]);
        }
    return least;
}

TEST(packing) {
    static const uint32_t sizes[] = {1, 10, 100, 700};
    for (int k = 0; k < 4; k++) {
        OWNED_BED bed = bed_empty(), again = bed_empty();
        ck_assert_int_eq(bed_make_packing(&bed, sizes[k], .8, 1.2, .55, 7), 0);
        ck_assert_uint_eq(bed.n, sizes[k]);
        ck_assert_double_ge(least_gap(&bed), 0);
        double solid = 0;
        for (uint32_t i = 0; i < bed.n; i++) {
            solid += 4 * PI / 3 * pow(bed.r[i], 3);
            ck_assert(bed.r[i] >= .8 && bed.r[i] <= 1.2);
            ck_assert(bed.x[i] >= 0 && bed.x[i] <= bed.period[0]);
        }
        ck_assert_double_eq_tol(solid / pow(bed.period[0], 3), .55, 1e-12);
        ck_assert_int_eq(bed_make_packing(&again, sizes[k], .8, 1.2, .55, 7), 0);
        ck_assert(memcmp(bed.x, again.x, bed.n * sizeof *bed.x) == 0);
    }
}

TEST(copies) {
    OWNED_BED tile = bed_empty(), bed = bed_empty();
    ck_assert_int_eq(bed_make_packing(&tile, 60, .8, 1.2, .55, 7), 0);
    ck_assert_int_eq(bed_make_copies(&bed, &tile, (const uint32_t[]){3, 1, 2}), 0);
    ck_assert_uint_eq(bed.n, 360);
    ck_assert_double_ge(least_gap(&bed), -1e-14);
    ck_assert_double_eq(bed.period[0], 3 * tile.period[0]);
    ck_assert_double_eq(bed.period[1], tile.period[1]);
    ck_assert_double_eq(bed.period[2], 2 * tile.period[2]);
    for (uint32_t k = 0; k < bed.n; k++) ck_assert_double_eq(bed.r[k], tile.r[k / 6]);
}

TEST(fcc) {
    OWNED_BED bed = bed_empty();
    ck_assert_int_eq(bed_make_fcc(&bed, 1, 4, 0), 0);
    ck_assert_uint_eq(bed.n, 1 + 12 + 6 + 24 + 12); /* the shells are at 2, 2.83, 3.46, 4 */
    ck_assert_double_eq_tol(least_gap(&bed), 0, 1e-14);
    bed_clear(&bed);
    ck_assert_int_eq(bed_make_fcc(&bed, .55, 10, 3), 0);
    ck_assert_double_eq(bed.r[0], 1);
    double mean = 0;
    for (uint32_t i = 1; i < bed.n; i++) mean += bed.r[i] / (bed.n - 1);
    ck_assert_double_eq_tol(mean, .775, .02);
}
