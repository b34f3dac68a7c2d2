/* test_estimate.c - rows are as accurate as they claim, and as they are asked to be. SPDX-License-Identifier: MIT */
#include "bed/bed_scene.h"
#include "scenes.h"
#include "simple/fibrad_host.h"
#include "suite.h"

enum { ROWS = 16 };

static struct bed random_bed(void) { return packing(200, .8, 1.2, .5, 3, true); }
static struct bed sparse_bed(void) { return packing(100, .8, 1.2, .05, 3, false); }
static struct bed unequal_bed(void) { return packing(200, .25, 1, .45, 4, false); }
static struct bed cubic_bed(void) { return lattice('p', 6); }

static const struct {
    const char *name;
    struct bed (*make)(void);
} beds[] = {{"random", random_bed}, {"sparse", sparse_bed}, {"sizes 1:4", unequal_bed}, {"cubic", cubic_bed}};

static fibrad_bed_factors *rows(const struct bed *bed, const fibrad_beam_rule *rule, bool raw,
                                const unsigned char *wanted) {
    const fibrad_spheres spheres = bed_spheres(bed);
    const fibrad_scene_config config = bed_scene(bed, NULL);
    const fibrad_bed_options options = {.beam = rule, .wanted = wanted, .raw = raw};
    fibrad_run run = {.threads = 1};
    fibrad_bed_factors *factors = NULL;
    ck_assert_int_eq(fibrad_view_factors(&config, &spheres, &options, &run, &factors), FIBRAD_OK);
    return factors;
}

/* ROWS rows of a bed with many directions, and which they are. */
static fibrad_bed_factors *truth_of(const struct bed *bed, unsigned char wanted[1000]) {
    ck_assert_uint_lt(bed->n, 1000);
    memset(wanted, 0, 1000);
    for (uint32_t k = 0; k < ROWS; k++) wanted[bed->n * (2 * k + 1) / (2 * ROWS)] = 1;
    return rows(bed, &(fibrad_beam_rule){.directions = 10000}, true, wanted);
}

static double distance_of(const fibrad_bed_factors *a, const fibrad_bed_factors *b, uint32_t i) {
    const fibrad_row of_a = matrix_row(&a->matrix, i), of_b = matrix_row(&b->matrix, i);
    return row_distance(&of_a, &of_b);
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* All but two of 48 estimates above the truth, or nearly so: rows of a lattice err together. No more than 4 times it on
 * the median. */
START_TEST(estimates_are_honest) {
    struct bed bed = beds[_i].make();
    unsigned char wanted[1000];
    fibrad_bed_factors *truth = truth_of(&bed, wanted);
    for (int raw = 0; raw < 2; raw++) {
        double ratio[3 * ROWS];
        uint32_t count = 0;
        for (uint32_t directions = 60; directions <= 540; directions *= 3) {
            fibrad_bed_factors *factors = rows(&bed, &(fibrad_beam_rule){.directions = directions}, raw, NULL);
            for (uint32_t i = 0; i < bed.n; i++) {
                if (!wanted[i]) continue;
                ratio[count] = factors->matrix.error[i] / distance_of(factors, truth, i);
                ck_assert_double_finite(ratio[count++]);
            }
            fibrad_bed_free(factors);
        }
        ck_assert_uint_eq(count, 3 * ROWS);
        qsort(ratio, count, sizeof *ratio, ascending);
        printf("%s, %s: estimate over error %.2f %.2f %.2f\n", beds[_i].name, raw ? "raw" : "averaged", ratio[2],
               ratio[count / 2], ratio[count - 3]);
        ck_assert_double_ge(ratio[2], _i == 3 && raw ? .85 : 1);
        ck_assert_double_lt(ratio[count / 2], 4);
    }
    fibrad_bed_free(truth);
    bed_free(&bed);
}
END_TEST

/* The rows asked for are that accurate, by the truth and by their own account; averaged ones closed and reciprocal. */
START_TEST(tolerance_is_met) {
    struct bed bed = beds[_i].make();
    unsigned char of_truth[1000];
    fibrad_bed_factors *truth = truth_of(&bed, of_truth);
    const double wanted = _i == 1 ? .1 : 4e-3;
    for (int raw = 0; raw < 2; raw++) {
        fibrad_bed_factors *factors = rows(&bed, &(fibrad_beam_rule){.tolerance = wanted}, raw, NULL);
        uint32_t above = 0;
        double largest = 0;
        for (uint32_t i = 0; i < bed.n; i++) {
            ck_assert_double_le(factors->matrix.error[i], wanted);
            worst_of(&largest, factors->matrix.error[i]);
            if (of_truth[i]) above += !(distance_of(factors, truth, i) <= wanted);
            ck_assert_double_le(matrix_sum(&factors->matrix, i), 1 + 1e-12);
            ck_assert_double_eq_tol(matrix_total(&factors->matrix, i), 1, 1e-12);
        }
        printf("%s, %s: %u directions for %g, estimate %.2g\n", beds[_i].name, raw ? "raw" : "averaged",
               factors->directions, wanted, largest);
        ck_assert_uint_le(above, 1);
        ck_assert_double_gt(largest, wanted / 4);
        ck_assert_double_le(factors->closure_error, 1e-12);
        if (!raw) ck_assert_double_lt(factors->reciprocity_error, 1e-14);
        fibrad_bed_free(factors);
    }
    fibrad_bed_free(truth);
    bed_free(&bed);
}
END_TEST

/* A row alone takes what it needs, whatever the room it was given, and holds the row of that many directions. */
START_TEST(rows_by_themselves) {
    struct bed bed = random_bed();
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    fibrad_work work = work_growing();
    fibrad_row row = row_of(bed.n), plain = row_of(bed.n);
    uint32_t before = 0;
    for (double error = 1e-2; error > 1e-4; error /= 3) {
        ck_assert_int_eq(fibrad_beam_row(scene, &work, 7, &(fibrad_beam_rule){.tolerance = error}, &row), FIBRAD_OK);
        ck_assert_double_le(row.error, error);
        ck_assert_uint_ge(row.directions, before);
        before = row.directions;
        ck_assert_int_eq(fibrad_beam_row(scene, &work, 7, &(fibrad_beam_rule){.directions = before}, &plain),
                         FIBRAD_OK);
        ck_assert_double_eq(row_distance(&row, &plain), 0);
        ck_assert_double_eq(row.error, plain.error);
    }
    ck_assert_uint_gt(before, 400);
    const uint32_t room = row.capacity;
    row.capacity = 3;
    ck_assert_int_eq(fibrad_beam_row(scene, &work, 7, &(fibrad_beam_rule){.tolerance = .01}, &row), FIBRAD_E_CAPACITY);
    row.capacity = room;
    ck_assert_int_eq(fibrad_beam_row(scene, &work, 7, &(fibrad_beam_rule){.tolerance = -1}, &row), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_beam_row(scene, &work, 7, &(fibrad_beam_rule){.tolerance = NAN}, &row), FIBRAD_E_ARGUMENT);
    row_free(&row);
    row_free(&plain);
    free(scene);
    work_free(&work);
    bed_free(&bed);
}
END_TEST

/* Where no number of directions does, the most there is. */
START_TEST(out_of_reach) {
    struct bed bed = bed_of(2, (const double[][4]){{0, 0, 0, 1}, {1, 2, 3, 1}});
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    fibrad_work work = work_growing();
    fibrad_row row = row_of(bed.n);
    ck_assert_int_eq(fibrad_beam_row(scene, &work, 0, &(fibrad_beam_rule){.tolerance = 1e-15}, &row), FIBRAD_OK);
    ck_assert_uint_eq(row.directions, FIBRAD_DIRECTIONS_MAX);
    ck_assert_double_gt(row.error, 1e-15);
    ck_assert_uint_eq(fibrad_directions_for(FIBRAD_DIRECTIONS_MAX, 2, 1), FIBRAD_DIRECTIONS_MAX);
    ck_assert_uint_gt(fibrad_directions_for(100, 1.01, 1), 110);
    ck_assert_uint_lt(fibrad_directions_for(100, 8, 1), 500); /* 400 and some */
    row_free(&row);
    free(scene);
    work_free(&work);
    bed_free(&bed);
}
END_TEST

int main(void) {
    const int count = sizeof beds / sizeof *beds;
    Suite *suite = suite_create("estimate");
    TCase *tcase = suite_case(suite, "estimate");
    tcase_add_loop_test(tcase, estimates_are_honest, 0, count);
    tcase_add_loop_test(tcase, tolerance_is_met, 0, count);
    tcase_add_test(tcase, rows_by_themselves);
    tcase_add_test(tcase, out_of_reach);
    return suite_run(suite);
}
