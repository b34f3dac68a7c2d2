/* test_drift.c - old rows after spheres have moved: estimated errors against rows computed anew.
 * SPDX-License-Identifier: MIT */
#include "scenes.h"
#include "suite.h"

static struct bed copy_of(const struct bed *bed) {
    struct bed to = bed_empty();
    for (uint32_t i = 0; i < bed->n; i++) add_sphere(&to, bed->x[i], bed->y[i], bed->z[i], bed->r[i]);
    memcpy(to.period, bed->period, sizeof to.period);
    return to;
}

/* Moves each sphere by at most `amplitude` radii along each axis. */
static void jitter(struct bed *bed, double amplitude, uint64_t seed) {
    double *at[3] = {bed->x, bed->y, bed->z};
    for (uint32_t i = 0; i < bed->n; i++)
        for (uint32_t axis = 0; axis < 3; axis++)
            at[axis][i] += amplitude * bed->r[i] * (2 * bed_make_random(seed, 3 * i + axis) - 1);
}

/* Computes a row. The work memory is kept from one row to the next. */
static fibrad_row row_in(const fibrad_scene *scene, uint32_t i, const fibrad_beam_rule *rule, uint32_t n) {
    static fibrad_work work = {.memory = {.resize = test_resize}};
    fibrad_row row = row_of(n);
    assert_ok(fibrad_beam_row(scene, &work, i, rule, &row));
    return row;
}

static double error_of(const fibrad_scene *before, const fibrad_scene *now, uint32_t i, const fibrad_row *row) {
    double error;
    assert_ok(fibrad_drift_row(before, now, i, row->col, row->length, &error));
    return error;
}

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The factor of two lone spheres is known as their distance changes. */
TEST(estimate_bounds_the_change_of_a_pair) {
    static const double ratios[] = {.1, .3, 1, 3, 10}, gaps[] = {0, .01, .1, 1, 10, 100}, moves[] = {-1e-3, 1e-4, 1e-2};
    for (size_t k = 0; k < 5 * 6 * 3; k++) {
        double r = ratios[k % 5], gap = gaps[k / 5 % 6], move = moves[k / 30], from, to;
        OWNED_BED bed = BED({0, 0, 0, 1}, {1 + r + gap, 0, 0, r}), moved = copy_of(&bed);
        move *= fmin(1, r);
        moved.x[1] += move;
        assert_ok(fibrad_pair_exact(1, r, gap, &from));
        assert_ok(fibrad_pair_exact(1, r, gap + move, &to));
        OWNED fibrad_scene *before = scene_of(&bed, FIBRAD_ISA_BEST), *now = scene_of(&moved, FIBRAD_ISA_BEST);
        fibrad_row row = {.col = &(uint32_t){1}, .length = 1};
        double estimate = error_of(before, now, 0, &row);
        ck_assert_msg(fabs(to - from) <= estimate, "ratio %g, gap %g, move %g: %g above %g", r, gap, move,
                      fabs(to - from), estimate);
        ck_assert_msg(gap > .1 || estimate < 20 * fabs(to - from), "ratio %g, gap %g, move %g: %g far below %g", r, gap,
                      move, fabs(to - from), estimate);
    }
}

TEST(estimates_hold_in_beds) {
    struct bed beds[] = {packing(300, .8, 1.2, .55, 7, true), packing(300, .8, 1.2, .4, 7, false),
                         packing(300, .3, 1.5, .5, 3, true)};
    const fibrad_beam_rule rule = {.directions = 200};
    for (size_t b = 0; b < 3; b++)
        for (int kind = 0; kind < 3; kind++)
            for (double amplitude = 1e-4; amplitude < .05; amplitude *= 20) {
                OWNED_BED moved = copy_of(&beds[b]);
                if (kind == 0) jitter(&moved, amplitude, 5);
                for (uint32_t i = 0; i < moved.n && kind == 1; i++) /* a strain */
                    moved.x[i] += amplitude * cos(6.283185307179586 * moved.y[i] / 12) * 12 / 6.283185307179586;
                for (uint32_t i = 0; i < moved.n && kind == 2; i += 40) moved.z[i] += amplitude * moved.r[i];
                OWNED fibrad_scene *before = scene_of(&beds[b], FIBRAD_ISA_BEST),
                                   *now = scene_of(&moved, FIBRAD_ISA_BEST);
                double ratio[100];
                size_t rows = 0;
                for (uint32_t i = 0; i < moved.n; i += 7) {
                    OWNED_ROW old = row_in(before, i, &rule, moved.n), new = row_in(now, i, &rule, moved.n);
                    ratio[rows++] = row_distance(&old, &new) / error_of(before, now, i, &old);
                }
                qsort(ratio, rows, sizeof *ratio, ascending);
                ck_assert_msg(ratio[rows - 1] < 1, "bed %zu, motion %d of %g: %g", b, kind, amplitude, ratio[rows - 1]);
                ck_assert_msg(kind == 2 || ratio[rows / 2] > .1, "bed %zu, motion %d of %g: %g", b, kind, amplitude,
                              ratio[rows / 2]);
            }
    for (size_t b = 0; b < 3; b++) bed_free(&beds[b]);
}

/* Nothing moves against anything else, also where spheres leave the box on one side and come in on the other. */
TEST(moving_as_a_whole_is_no_error) {
    OWNED_BED bed = packing(200, .8, 1.2, .5, 2, true), moved = copy_of(&bed);
    for (uint32_t i = 0; i < bed.n; i++) moved.x[i] += 3, moved.y[i] -= 2.5;
    OWNED fibrad_scene *before = scene_of(&bed, FIBRAD_ISA_BEST), *now = scene_of(&moved, FIBRAD_ISA_BEST);
    for (uint32_t i = 0; i < bed.n; i += 3) {
        OWNED_ROW row = row_in(before, i, NULL, bed.n);
        ck_assert_double_lt(error_of(before, now, i, &row), 1e-13);
    }
}

/* A sphere moves to a free place far away. There it comes into the sight of rows that see nothing else move. */
TEST(what_comes_into_sight_is_found) {
    OWNED_BED bed = packing(400, .8, 1.2, .4, 9, true);
    bed.r[0] = .5;
    OWNED_BED now = copy_of(&bed);
    const double edge = bed.period[0];
    for (uint64_t draw = 0, free_place = 0; !free_place; draw++) {
        now.x[0] = edge * bed_make_random(1, 3 * draw);
        now.y[0] = edge * bed_make_random(1, 3 * draw + 1);
        now.z[0] = edge * bed_make_random(1, 3 * draw + 2);
        free_place = 1;
        for (uint32_t j = 0; j < bed.n; j++) {
            double x = remainder(now.x[0] - bed.x[j], edge), y = remainder(now.y[0] - bed.y[j], edge);
            double z = remainder(now.z[0] - bed.z[j], edge);
            if (sqrt(x * x + y * y + z * z) < (j == 0 ? 7 : .5 + bed.r[j])) free_place = 0;
        }
    }
    const fibrad_beam_rule rule = {.directions = 60};
    OWNED fibrad_scene *from = scene_of(&bed, FIBRAD_ISA_BEST), *to = scene_of(&now, FIBRAD_ISA_BEST);
    OWNED_ROW before = row_in(from, 0, &rule, bed.n), row = row_in(to, 0, &rule, bed.n);
    double *error = calloc(bed.n, sizeof *error), unseen = 0, left = 0;
    assert_ok(fibrad_drift_partners(to, 0, &before, &row, error));
    for (uint32_t i = 1; i < bed.n; i++) {
        OWNED_ROW old = row_in(from, i, &rule, bed.n), new = row_in(to, i, &rule, bed.n);
        const double change = row_distance(&old, &new);
        worst_of(&unseen, change);
        if (row_factor(&old, 0) == 0) worst_of(&left, change - error[i] - 4e-3);
    }
    ck_assert_double_gt(unseen, .01);
    ck_assert_double_le(left, 0);
    free(error);
}

/* The estimate counts spheres alone. Walls may have moved, or may be other walls. */
TEST(walls_that_move_are_not_counted) {
    OWNED_BED bed = packing(100, .8, 1.2, .4, 1, false);
    fibrad_wall wall = plane_at(2, 1, 30);
    fibrad_scene_config config = {.wall = &wall, .walls = 1};
    OWNED fibrad_scene *before = scene_with(&bed, &config), *open = scene_of(&bed, FIBRAD_ISA_BEST);
    wall.plane.at = 31;
    OWNED fibrad_scene *now = scene_with(&bed, &config);
    for (uint32_t i = 0; i < bed.n; i += 9) {
        OWNED_ROW row = row_in(before, i, NULL, bed.n);
        ck_assert_double_eq(error_of(before, now, i, &row), 0);
        ck_assert_double_eq(error_of(before, open, i, &row), 0);
    }
}

TEST(bad_arguments_are_refused) {
    OWNED_BED bed = packing(50, .8, 1.2, .4, 1, true), less = packing(49, .8, 1.2, .4, 1, true), open = copy_of(&bed);
    open.period[1] = 0;
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST), *other = scene_of(&less, FIBRAD_ISA_BEST);
    OWNED fibrad_scene *unlike = scene_of(&open, FIBRAD_ISA_BEST);
    fibrad_row row = {.col = (uint32_t[]){1, 50}, .f = (double[]){.1, .1}, .length = 1}, beyond = row;
    beyond.length = 2;
    double error[50] = {0};
    assert_ok(fibrad_drift_row(scene, scene, 0, row.col, row.length, error));
    ck_assert_double_eq(error[0], 0);
    assert_invalid(fibrad_drift_row(NULL, scene, 0, row.col, row.length, error));
    assert_invalid(fibrad_drift_row(scene, NULL, 0, row.col, row.length, error));
    assert_invalid(fibrad_drift_row(scene, other, 0, row.col, row.length, error));
    assert_invalid(fibrad_drift_row(scene, unlike, 0, row.col, row.length, error));
    assert_invalid(fibrad_drift_row(scene, scene, 50, row.col, row.length, error));
    assert_invalid(fibrad_drift_row(scene, scene, 0, NULL, 1, error));
    assert_invalid(fibrad_drift_row(scene, scene, 0, beyond.col, beyond.length, error));
    assert_invalid(fibrad_drift_row(scene, scene, 0, row.col, row.length, NULL));
    assert_ok(fibrad_drift_partners(scene, 0, &row, &row, error));
    assert_invalid(fibrad_drift_partners(NULL, 0, &row, &row, error));
    assert_invalid(fibrad_drift_partners(scene, 50, &row, &row, error));
    assert_invalid(fibrad_drift_partners(scene, 0, &beyond, &row, error));
    assert_invalid(fibrad_drift_partners(scene, 0, &row, &beyond, error));
    assert_invalid(fibrad_drift_partners(scene, 0, &row, NULL, error));
    assert_invalid(fibrad_drift_partners(scene, 0, NULL, &row, error));
    assert_invalid(fibrad_drift_partners(scene, 0, &row, &row, NULL));
}
