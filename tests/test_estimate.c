/* test_estimate.c - rows are as accurate as they claim, and as they are asked to be. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "compute/rows.h"
#include "scenes.h"
#include "suite.h"
#include "compute/tolerance.h"

enum { ROWS = 16 };

static struct bed random_bed(void) { return packing(200, .8, 1.2, .5, 3, true); }
static struct bed sparse_bed(void) { return packing(100, .8, 1.2, .05, 3, false); }
static struct bed unequal_bed(void) { return packing(200, .25, 1, .45, 4, false); }
static struct bed cubic_bed(void) { return lattice('p', 6); }

static const struct {
    const char *name;
    struct bed (*make)(void);
} beds[] = {{"random", random_bed}, {"sparse", sparse_bed}, {"sizes 1:4", unequal_bed}, {"cubic", cubic_bed}};

static struct result rows(const struct bed *bed, uint32_t directions, bool raw, const bool *wanted) {
    struct result result;
    const fibrad_beam_rule rule = {.directions = directions};
    const struct run_options options = {
        .file = "bed", .method = method_beam(&rule), .threads = 1, .raw = raw, .wanted = wanted};
    ck_assert_int_eq(run_rows(bed, &options, &result), 0);
    return result;
}

/* ROWS rows of a bed with many directions. */
static struct result truth_of(const struct bed *bed) {
    bool wanted[1000] = {false};
    ck_assert_uint_lt(bed->n, 1000);
    for (uint32_t k = 0; k < ROWS; k++) wanted[bed->n * (2 * k + 1) / (2 * ROWS)] = true;
    return rows(bed, 10000, true, wanted);
}

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* All but two of 48 estimates above the truth, or nearly so: rows of a lattice err together. No more than 4 times it on
 * the median. */
START_TEST(estimates_are_honest) {
    struct bed bed = beds[_i].make();
    struct result truth = truth_of(&bed);
    for (int raw = 0; raw < 2; raw++) {
        double ratio[3 * ROWS];
        uint32_t count = 0;
        for (uint32_t directions = 60; directions <= 540; directions *= 3) {
            struct result result = rows(&bed, directions, raw, NULL);
            for (uint32_t i = 0; i < bed.n; i++)
                if (truth.wanted[i]) ratio[count++] = result.error[i] / rows_distance(&result.rows, &truth.rows, i);
            result_free(&result);
        }
        ck_assert_uint_eq(count, 3 * ROWS);
        qsort(ratio, count, sizeof *ratio, ascending);
        printf("%s, %s: estimate over error %.2f %.2f %.2f\n", beds[_i].name, raw ? "raw" : "averaged", ratio[2],
               ratio[count / 2], ratio[count - 3]);
        ck_assert_double_ge(ratio[2], _i == 3 && raw ? .85 : 1);
        ck_assert_double_lt(ratio[count / 2], 4);
    }
    result_free(&truth);
    bed_free(&bed);
}
END_TEST

/* The rows asked for are that accurate, by the truth and by their own account; averaged ones closed and reciprocal. */
START_TEST(tolerance_is_met) {
    struct bed bed = beds[_i].make();
    struct result truth = truth_of(&bed), result;
    const double wanted = _i == 1 ? .1 : 4e-3;
    for (int raw = 0; raw < 2; raw++) {
        const struct run_options options = {.file = "bed", .threads = 1, .raw = raw};
        ck_assert_int_eq(tolerance_rows(&bed, &options, &(fibrad_beam_rule){0}, wanted, &result), 0);
        uint32_t above = 0;
        for (uint32_t i = 0; i < bed.n; i++) {
            ck_assert_double_le(result.error[i], wanted);
            if (truth.wanted[i]) above += rows_distance(&result.rows, &truth.rows, i) > wanted;
        }
        printf("%s, %s: %u directions for %g, estimate %.2g\n", beds[_i].name, raw ? "raw" : "averaged",
               result.directions, wanted, result.error_estimate);
        ck_assert_uint_le(above, 1);
        ck_assert_double_gt(result.error_estimate, wanted / 4);
        ck_assert_double_le(result.row_sum_max, 1 + 1e-12);
        if (!raw) ck_assert_double_lt(result.reciprocity_max, 1e-14);
        result_free(&result);
    }
    result_free(&truth);
    bed_free(&bed);
}
END_TEST

/* A row alone takes what it needs, whatever the room it was given, and holds the row of that many directions. */
START_TEST(rows_by_themselves) {
    struct bed bed = random_bed();
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    fibrad_work *work = work_of(&(fibrad_work_config){.discs = 2048});
    fibrad_row row = row_of(bed.n), plain = row_of(bed.n);
    uint32_t before = 0;
    for (double error = 1e-2; error > 1e-4; error /= 3) {
        ck_assert_int_eq(fibrad_beam_row(scene, work, 7, &(fibrad_beam_rule){.error = error}, &row), FIBRAD_OK);
        ck_assert_double_le(row.error, error);
        ck_assert_uint_ge(row.directions, before);
        before = row.directions;
        ck_assert_int_eq(fibrad_beam_row(scene, work, 7, &(fibrad_beam_rule){.directions = before}, &plain), FIBRAD_OK);
        ck_assert_double_eq(row_distance(&row, &plain), 0);
        ck_assert_double_eq(row.error, plain.error);
    }
    ck_assert_uint_gt(before, 400);
    const uint32_t room = row.capacity;
    row.capacity = 3;
    ck_assert_int_eq(fibrad_beam_row(scene, work, 7, &(fibrad_beam_rule){.error = .01}, &row), FIBRAD_E_CAPACITY);
    row.capacity = room;
    ck_assert_int_eq(fibrad_beam_row(scene, work, 7, &(fibrad_beam_rule){.error = -1}, &row), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_beam_row(scene, work, 7, &(fibrad_beam_rule){.error = NAN}, &row), FIBRAD_E_ARGUMENT);
    row_free(&row);
    row_free(&plain);
    free(scene);
    free(work);
    bed_free(&bed);
}
END_TEST

/* Where no number of directions does, the most there is. */
START_TEST(out_of_reach) {
    struct bed bed = bed_of(2, (const double[][4]){{0, 0, 0, 1}, {1, 2, 3, 1}});
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    fibrad_work *work = work_of(NULL);
    fibrad_row row = row_of(bed.n);
    ck_assert_int_eq(fibrad_beam_row(scene, work, 0, &(fibrad_beam_rule){.error = 1e-15}, &row), FIBRAD_OK);
    ck_assert_uint_eq(row.directions, FIBRAD_DIRECTIONS_MAX);
    ck_assert_double_gt(row.error, 1e-15);
    ck_assert_uint_eq(fibrad_directions_for(FIBRAD_DIRECTIONS_MAX, 2, 1), FIBRAD_DIRECTIONS_MAX);
    ck_assert_uint_gt(fibrad_directions_for(100, 1.01, 1), 110);
    ck_assert_uint_lt(fibrad_directions_for(100, 8, 1), 500); /* 400 and some */
    row_free(&row);
    free(scene);
    free(work);
    bed_free(&bed);
}
END_TEST

/* Large spheres among small ones with a fourth of the directions: rows stay reciprocal, their sums at most 1; the worst
 * row is no worse than it was, the large ones still have less error than the small ones, and estimates hold. */
START_TEST(fewer_directions_for_large_spheres) {
    enum { LARGE = 5 };
    struct bed bed;
    bed_init(&bed, false, 0);
    ck_assert_int_eq(bed_make_two_sizes(&bed, LARGE, 4, .5, 1), 0);
    struct result truth = rows(&bed, 1200, false, NULL), with[2];
    const fibrad_beam_rule rule = {.directions = 100}, large_rule = {.directions = 25};
    double worst[2][2] = {{0}};
    for (int fewer = 0; fewer < 2; fewer++) {
        struct run_options options = {.file = "bed", .method = method_beam(&rule), .threads = 1};
        if (fewer) options.method.large_rule = &large_rule;
        ck_assert_int_eq(run_rows(&bed, &options, &with[fewer]), 0);
        uint32_t below = 0;
        for (uint32_t i = 0; i < bed.n; i++) {
            const double e = rows_distance(&with[fewer].rows, &truth.rows, i);
            worst[fewer][i >= LARGE] = fmax(worst[fewer][i >= LARGE], e);
            below += e < with[fewer].error[i];
        }
        ck_assert_uint_gt(below, bed.n * 95 / 100);
        ck_assert_double_lt(with[fewer].reciprocity_max, 1e-14);
        ck_assert_double_lt(with[fewer].row_sum_max, 1 + 1e-12);
    }
    ck_assert(with[0].rows.f[0] != with[1].rows.f[0]); /* the option does something */
    ck_assert_double_lt(worst[1][1], 1.1 * worst[0][1]);
    ck_assert_double_lt(worst[1][0], .5 * worst[1][1]);
    result_free(&truth);
    result_free(&with[0]);
    result_free(&with[1]);
    bed_free(&bed);
}
END_TEST

/* Nothing changes where no sphere is large. */
START_TEST(large_rule_is_for_large_spheres) {
    struct bed bed = random_bed();
    const fibrad_beam_rule rule = {.directions = 50}, large_rule = {.directions = 12};
    struct run_options options = {.file = "bed", .method = method_beam(&rule), .threads = 1};
    options.method.large_rule = &large_rule;
    struct result plain = rows(&bed, 50, false, NULL), with;
    ck_assert_int_eq(run_rows(&bed, &options, &with), 0);
    ck_assert_uint_eq(with.rows.start[bed.n], plain.rows.start[bed.n]);
    ck_assert_mem_eq(with.rows.f, plain.rows.f, plain.rows.start[bed.n] * sizeof *plain.rows.f);
    ck_assert_mem_eq(with.error, plain.error, bed.n * sizeof *plain.error);
    result_free(&plain);
    result_free(&with);
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
    tcase_add_test(tcase, fewer_directions_for_large_spheres);
    tcase_add_test(tcase, large_rule_is_for_large_spheres);
    return suite_run(suite);
}
