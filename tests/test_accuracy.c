/* test_accuracy.c - beam rows against the adaptive reference. SPDX-License-Identifier: MIT */
#include <stdio.h>

#include "papers/pair/reference.h"
#include "scenes.h"
#include "suite.h"

/* Euclidean error of row i of the beam method with exact areas. */
static double error_of(const struct bed *bed, uint32_t i, uint32_t directions, double tolerance) {
    double *f = calloc(bed->n, sizeof *f), escaped;
    const fibrad_spheres spheres = spheres_of(bed);
    struct reference_report report;
    struct reference_rule rule = {tolerance, 2000000};
    ck_assert_int_eq(reference_row(&spheres, i, &rule, f, &escaped, &report), REFERENCE_OK);

    OWNED fibrad_scene *scene = scene_of(bed, FIBRAD_ISA_BEST);
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(bed->n);
    assert_ok(fibrad_beam_row(scene, &work, i, &(fibrad_beam_rule){.directions = directions}, &row));
    double square = 0;
    for (uint32_t j = 0; j < bed->n; j++) square += pow(row_factor(&row, j) - f[j], 2);
    ck_assert_double_eq_tol(row.escaped, escaped, 3e-5);
    free(f);
    return sqrt(square);
}

TEST(rows_of_lattices_are_right) {
    for (int kind = 0; kind < 3; kind++) {
        OWNED_BED bed = lattice("pif"[kind], 6);
        double error = error_of(&bed, 0, 4181, 2e-5);
        printf("lattice %c, %u spheres: %.2g\n", "pif"[kind], bed.n, error);
        ck_assert_double_lt(error, 3e-5);
    }
}

TEST(rows_of_small_scenes_are_right) {
    double worst = 0;
    for (uint64_t seed = 0; seed < 12; seed++) {
        OWNED_BED bed = packing(3 + (uint32_t)(seed % 6), .3, 1.2, .3, seed, false);
        double error = error_of(&bed, 0, 4181, 1e-6);
        worst_of(&worst, error);
    }
    printf("3 to 8 spheres: %.2g\n", worst);
    ck_assert_double_lt(worst, 3e-5);
}

/* An obstacle stands near a pair of spheres: it touches both, it touches their common tangent cone from outside or from
 * inside, or it stands in the middle. */
TEST(tangent_obstacles_leave_rows_right) {
    double h = sqrt(3);
    struct bed beds[] = {BED({0, 0, 0, 1}, {0, 0, 2, 1}, {h, 0, 1, 1}),
                         BED({0, 0, 0, 1}, {0, 0, 4, 1}, {1.5, 0, 2, .5}),
                         BED({0, 0, 0, 1}, {0, 0, 4, 1}, {.5, 0, 2, .5}), BED({0, 0, 0, 1}, {0, 0, 4, 1}, {0, 0, 2, 1}),
                         BED({0, 0, 0, 1}, {0, 0, 3, .5}, {.7, 0, 2, .7}, {-.3, 0, 2, .3})};
    for (size_t b = 0; b < sizeof beds / sizeof *beds; b++) {
        double error = error_of(&beds[b], 0, 4181, 1e-6);
        printf("tangent obstacles %zu: %.2g\n", b, error);
        ck_assert_double_lt(error, 3e-5);
        bed_free(&beds[b]);
    }
}

/* The error falls as n^-1.5: eight-fold from n to 4 n, on the mean over rows. The true rows are those with many
 * directions. */
TEST(error_falls_as_it_should) {
    OWNED_BED bed = packing(300, .8, 1.2, .55, 5, true);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED_WORK work = work_growing();
    double mean[3] = {0};
    for (uint32_t i = 0; i < 10; i++) {
        OWNED_ROW truth = row_of(bed.n), row = row_of(bed.n);
        assert_ok(fibrad_beam_row(scene, &work, i, &(fibrad_beam_rule){.directions = 30000}, &truth));
        for (int k = 0; k < 3; k++) {
            fibrad_beam_rule rule = {.directions = 100u << 2 * k};
            assert_ok(fibrad_beam_row(scene, &work, i, &rule, &row));
            mean[k] += row_distance(&row, &truth) / 10;
        }
    }
    printf("n = 100, 400, 1600: %.2g %.2g %.2g\n", mean[0], mean[1], mean[2]);
    ck_assert_double_gt(mean[0] / mean[2], 35);
    ck_assert_double_lt(mean[2], 1.2e-4);
}
