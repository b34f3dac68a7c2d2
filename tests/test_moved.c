/* test_moved.c - rows kept while a bed moves: their errors against rows computed anew, their bits, and the loop.
 * SPDX-License-Identifier: MIT */
#include "compute/moving_rows.h"
#include "scenes.h"
#include "suite.h"

static struct bed copy_of(const struct bed *bed) {
    struct bed to;
    bed_init(&to, false, 0);
    for (uint32_t i = 0; i < bed->n; i++) add_sphere(&to, bed->x[i], bed->y[i], bed->z[i], bed->r[i]);
    memcpy(to.period, bed->period, sizeof to.period);
    return to;
}

/* Each sphere by at most `amplitude` radii along each axis. */
static void jitter(struct bed *bed, double amplitude, uint64_t seed) {
    double *at[3] = {bed->x, bed->y, bed->z};
    for (uint32_t i = 0; i < bed->n; i++)
        for (uint32_t axis = 0; axis < 3; axis++)
            at[axis][i] += amplitude * bed->r[i] * (2 * bed_make_random(seed, 3 * i + axis) - 1);
}

/* The work memory is kept from one row to the next. */
static fibrad_row row_in(const fibrad_scene *scene, uint32_t i, const fibrad_beam_rule *rule, uint32_t n) {
    static fibrad_work *work;
    if (work == NULL) work = work_of(&(fibrad_work_config){.discs = 512, .entries = 2000});
    fibrad_row row = row_of(n);
    int status;
    while ((status = fibrad_beam_row(scene, work, i, rule, &row)) == FIBRAD_E_CAPACITY) {
        fibrad_work_config config;
        fibrad_work_needed(work, &config);
        free(work);
        work = work_of(&config);
    }
    ck_assert_int_eq(status, FIBRAD_OK);
    return row;
}

static double error_of(const fibrad_scene *before, const fibrad_scene *now, uint32_t i, const fibrad_row *row) {
    double error;
    ck_assert_int_eq(fibrad_moved_error(before, now, i, row, &error), FIBRAD_OK);
    return error;
}

static int ascending(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* The factor of two spheres alone, which is known, as their distance changes. */
START_TEST(estimate_bounds_the_change_of_a_pair) {
    static const double ratios[] = {.1, .3, 1, 3, 10}, gaps[] = {0, .01, .1, 1, 10, 100}, moves[] = {-1e-3, 1e-4, 1e-2};
    for (size_t k = 0; k < 5 * 6 * 3; k++) {
        double r = ratios[k % 5], gap = gaps[k / 5 % 6], move = moves[k / 30], from, to;
        struct bed bed = bed_of(2, (const double[][4]){{0, 0, 0, 1}, {1 + r + gap, 0, 0, r}}), moved = copy_of(&bed);
        move *= fmin(1, r);
        moved.x[1] += move;
        ck_assert_int_eq(fibrad_pair_exact(1, r, gap, &from), FIBRAD_OK);
        ck_assert_int_eq(fibrad_pair_exact(1, r, gap + move, &to), FIBRAD_OK);
        fibrad_scene *before = scene_of(&bed, FIBRAD_ISA_BEST), *now = scene_of(&moved, FIBRAD_ISA_BEST);
        fibrad_row row = {.col = &(uint32_t){1}, .length = 1};
        double estimate = error_of(before, now, 0, &row);
        ck_assert_msg(fabs(to - from) <= estimate, "ratio %g, gap %g, move %g: %g above %g", r, gap, move,
                      fabs(to - from), estimate);
        ck_assert_msg(gap > .1 || estimate < 20 * fabs(to - from), "ratio %g, gap %g, move %g: %g far below %g", r, gap,
                      move, fabs(to - from), estimate);
        free(before);
        free(now);
        bed_free(&bed);
        bed_free(&moved);
    }
}
END_TEST

START_TEST(estimates_hold_in_beds) {
    struct bed beds[] = {packing(300, .8, 1.2, .55, 7, true), packing(300, .8, 1.2, .4, 7, false),
                         packing(300, .3, 1.5, .5, 3, true)};
    const fibrad_beam_rule rule = {.directions = 200};
    for (size_t b = 0; b < 3; b++)
        for (int kind = 0; kind < 3; kind++)
            for (double amplitude = 1e-4; amplitude < .05; amplitude *= 20) {
                struct bed moved = copy_of(&beds[b]);
                if (kind == 0) jitter(&moved, amplitude, 5);
                for (uint32_t i = 0; i < moved.n && kind == 1; i++) /* a strain */
                    moved.x[i] += amplitude * cos(6.283185307179586 * moved.y[i] / 12) * 12 / 6.283185307179586;
                for (uint32_t i = 0; i < moved.n && kind == 2; i += 40) moved.z[i] += amplitude * moved.r[i];
                fibrad_scene *before = scene_of(&beds[b], FIBRAD_ISA_BEST), *now = scene_of(&moved, FIBRAD_ISA_BEST);
                double ratio[100];
                size_t rows = 0;
                for (uint32_t i = 0; i < moved.n; i += 7) {
                    fibrad_row old = row_in(before, i, &rule, moved.n), new = row_in(now, i, &rule, moved.n);
                    ratio[rows++] = row_distance(&old, &new) / error_of(before, now, i, &old);
                    row_free(&old);
                    row_free(&new);
                }
                qsort(ratio, rows, sizeof *ratio, ascending);
                ck_assert_msg(ratio[rows - 1] < 1, "bed %zu, motion %d of %g: %g", b, kind, amplitude, ratio[rows - 1]);
                ck_assert_msg(kind == 2 || ratio[rows / 2] > .1, "bed %zu, motion %d of %g: %g", b, kind, amplitude,
                              ratio[rows / 2]);
                free(before);
                free(now);
                bed_free(&moved);
            }
    for (size_t b = 0; b < 3; b++) bed_free(&beds[b]);
}
END_TEST

/* Nothing moves against anything else, also where spheres leave the box on one side and come in on the other. */
START_TEST(moving_as_a_whole_is_no_error) {
    struct bed bed = packing(200, .8, 1.2, .5, 2, true), moved = copy_of(&bed);
    for (uint32_t i = 0; i < bed.n; i++) moved.x[i] += 3, moved.y[i] -= 2.5;
    fibrad_scene *before = scene_of(&bed, FIBRAD_ISA_BEST), *now = scene_of(&moved, FIBRAD_ISA_BEST);
    for (uint32_t i = 0; i < bed.n; i += 3) {
        fibrad_row row = row_in(before, i, NULL, bed.n);
        ck_assert_double_lt(error_of(before, now, i, &row), 1e-13);
        row_free(&row);
    }
    free(before);
    free(now);
    bed_free(&bed);
    bed_free(&moved);
}
END_TEST

/* Spheres beyond the reach of a row may as well not be there. */
START_TEST(nothing_beyond_the_reach_matters) {
    struct bed bed = packing(1500, .7, 1.3, .55, 4, false);
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    uint32_t finite = 0;
    for (uint32_t points = 0; points <= 64; points += 64)
        for (uint32_t i = 0; i < bed.n; i += 3) {
            const fibrad_beam_rule rule = {.directions = 8, .points = points};
            fibrad_row row = row_in(scene, i, &rule, bed.n);
            ck_assert(isinf(row.reach) == (row.escaped > 0));
            if (isinf(row.reach)) {
                row_free(&row);
                continue;
            }
            struct bed part;
            bed_init(&part, false, 0);
            uint32_t at = 0, number[1500];
            for (uint32_t j = 0; j < bed.n; j++) {
                double x = bed.x[j] - bed.x[i], y = bed.y[j] - bed.y[i], z = bed.z[j] - bed.z[i];
                double sum = bed.r[i] + bed.r[j];
                if (x * x + y * y + z * z > (row.reach * row.reach + sum * sum) * (1 + 1e-12)) continue;
                if (j == i) at = part.n;
                number[part.n] = j;
                add_sphere(&part, bed.x[j], bed.y[j], bed.z[j], bed.r[j]);
            }
            ck_assert_uint_lt(part.n, bed.n);
            fibrad_scene *few = scene_of(&part, FIBRAD_ISA_BEST);
            fibrad_row same = row_in(few, at, &rule, part.n);
            for (uint32_t k = 0; k < same.length; k++) same.col[k] = number[same.col[k]];
            ck_assert(same_bits(&row, &same));
            finite++;
            row_free(&row);
            row_free(&same);
            free(few);
            bed_free(&part);
        }
    ck_assert_uint_gt(finite, 20);
    free(scene);
    bed_free(&bed);
}
END_TEST

/* Rows called the same are the same to the bit; moving a sphere must leave some so, and change others. */
START_TEST(same_rows_have_the_same_bits) {
    struct bed lattice = bed_of(0, NULL);
    for (int k = 0; k < 1000; k++) add_sphere(&lattice, 2 * (k % 10), 2 * (k / 10 % 10), 2 * (k / 100), 1);
    for (int axis = 0; axis < 3; axis++) lattice.period[axis] = 20;
    struct bed beds[] = {packing(1500, .8, 1.2, .55, 4, true), packing(1500, .8, 1.2, .55, 4, false), lattice};
    for (size_t b = 0; b < 3; b++) {
        const fibrad_beam_rule rule = {.directions = b == 2 ? 30 : 8, .cutoff = b == 2 ? 7 : 0};
        const uint32_t n = beds[b].n;
        fibrad_scene *before = scene_of(&beds[b], FIBRAD_ISA_BEST);
        double *reach = calloc(n, sizeof *reach);
        fibrad_row *rows = calloc(n, sizeof *rows);
        unsigned char *same = calloc(n, 1), *scratch = calloc(n, 2);
        for (uint32_t i = 0; i < n; i++) rows[i] = row_in(before, i, &rule, n), reach[i] = rows[i].reach;
        uint32_t lowest = 0;
        for (uint32_t i = 0; i < n; i++)
            if (beds[b].x[i] < beds[b].x[lowest]) lowest = i;
        for (int kind = 0; kind < 4; kind++) {
            struct bed moved = copy_of(&beds[b]);
            if (kind == 1) moved.z[n / 2] += 1e-9;
            if (kind == 2) moved.x[lowest] -= 1e-3; /* which moves the cells of all */
            if (kind == 3) moved.y[n / 3] += 1.5;   /* into something, maybe */
            fibrad_scene_config config = {.spheres = n};
            memcpy(config.period, moved.period, sizeof config.period);
            fibrad_spheres views = {moved.x, moved.y, moved.z, moved.r, n};
            fibrad_scene *now;
            size_t size = fibrad_scene_size(&config);
            void *block = block_of(size);
            if (fibrad_scene_init(&now, block, size, &config, &views, NULL) == FIBRAD_OK) {
                ck_assert_int_eq(fibrad_moved_same(before, now, reach, scratch, same), FIBRAD_OK);
                uint32_t kept = 0;
                for (uint32_t i = 0; i < n; i++) {
                    kept += same[i];
                    if (!same[i]) continue;
                    fibrad_row row = row_in(now, i, &rule, n);
                    ck_assert_msg(same_bits(&row, &rows[i]), "bed %zu, motion %d, row %u", b, kind, i);
                    row_free(&row);
                }
                ck_assert(kind != 0 || kept == n);
                ck_assert_msg(kind == 0 || (kept > 0 && kept < n), "bed %zu, motion %d: %u", b, kind, kept);
            } else {
                ck_assert_int_eq(kind, 3);
            }
            free(block);
            bed_free(&moved);
        }
        for (uint32_t i = 0; i < n; i++) row_free(&rows[i]);
        free(before);
        free(reach);
        free(rows);
        free(same);
        free(scratch);
        bed_free(&beds[b]);
    }
}
END_TEST

/* The disc that covers a window last lies as deep as the row reaches, and its centre is farther away. */
START_TEST(what_covers_the_deepest_window_is_within_reach) {
    struct bed bed = packing(500, .8, 1.2, .55, 4, true);
    fibrad_scene *before = scene_of(&bed, FIBRAD_ISA_BEST);
    double reach[500] = {0};
    unsigned char same[500], scratch[1000];
    uint32_t found = 0;
    for (uint32_t i = 0; i < bed.n; i += 20) {
        fibrad_row row = row_in(before, i, &(fibrad_beam_rule){.directions = 8}, bed.n);
        for (uint32_t k = 0; k < row.length; k++) {
            const uint32_t j = row.col[k];
            const double edge = bed.period[0], x = remainder(bed.x[j] - bed.x[i], edge);
            const double y = remainder(bed.y[j] - bed.y[i], edge), z = remainder(bed.z[j] - bed.z[i], edge);
            if (j == i || x * x + y * y + z * z <= row.reach * row.reach) continue;
            struct bed moved = copy_of(&bed);
            moved.y[j] += 1e-6;
            fibrad_scene *now = scene_of(&moved, FIBRAD_ISA_BEST);
            reach[i] = row.reach;
            ck_assert_int_eq(fibrad_moved_same(before, now, reach, scratch, same), FIBRAD_OK);
            ck_assert_uint_eq(same[i], 0);
            found++;
            free(now);
            bed_free(&moved);
        }
        row_free(&row);
    }
    ck_assert_uint_gt(found, 3);
    free(before);
    bed_free(&bed);
}
END_TEST

/* The largest error of the rows kept, against rows computed anew. */
static double worst_row(const struct moving *moving, const struct bed *bed) {
    struct moving anew;
    ck_assert_int_eq(moving_begin(&anew, bed, &moving->rule, 1), 0);
    double worst = 0;
    for (uint32_t i = 0; i < bed->n; i++) worst = fmax(worst, row_distance(&moving->row[i], &anew.row[i]));
    moving_end(&anew);
    return worst;
}

static void check_closed(const struct moving *moving) {
    for (uint32_t i = 0; i < moving->n; i++)
        ck_assert_double_eq_tol(row_sum(&moving->row[i]) + moving->row[i].escaped, 1, 1e-12);
}

/* Rows of different ages, averaged. */
static void check_averaged(const struct moving *moving, const double *r) {
    const uint32_t n = moving->n;
    uint64_t entries = 0;
    for (uint32_t i = 0; i < n; i++) entries += moving->row[i].length;
    fibrad_rows raw = {.n = n, .capacity = entries}, mean = {.n = n, .capacity = 2 * entries};
    raw.start = calloc(n + 1, sizeof *raw.start), mean.start = calloc(n + 1, sizeof *mean.start);
    raw.col = calloc(entries, sizeof *raw.col), mean.col = calloc(2 * entries, sizeof *mean.col);
    raw.f = calloc(entries, sizeof *raw.f), mean.f = calloc(2 * entries, sizeof *mean.f);
    double *scratch = calloc(n, sizeof *scratch), reciprocity;
    for (uint32_t i = 0; i < n; i++) {
        const fibrad_row *row = &moving->row[i];
        raw.start[i + 1] = raw.start[i] + row->length;
        memcpy(raw.col + raw.start[i], row->col, row->length * sizeof *row->col);
        memcpy(raw.f + raw.start[i], row->f, row->length * sizeof *row->f);
    }
    ck_assert_int_eq(fibrad_rows_average(&raw, r, &mean), FIBRAD_OK);
    ck_assert_int_eq(fibrad_rows_limit(&mean, scratch), FIBRAD_OK);
    ck_assert_int_eq(fibrad_rows_reciprocity(&mean, r, &reciprocity), FIBRAD_OK);
    ck_assert_double_lt(reciprocity, 1e-14);
    for (uint32_t i = 0; i < n; i++) {
        double sum = 0;
        for (uint64_t k = mean.start[i]; k < mean.start[i + 1]; k++) sum += mean.f[k];
        ck_assert_double_le(sum, 1 + 1e-12);
    }
    free(raw.start), free(raw.col), free(raw.f), free(scratch);
    free(mean.start), free(mean.col), free(mean.f);
}

START_TEST(the_loop_keeps_its_error) {
    struct bed bed = packing(300, .8, 1.2, .55, 7, true);
    const fibrad_beam_rule rule = {.directions = 60};
    for (double allowed = 5e-3; allowed < .02; allowed *= 3) {
        struct bed now = copy_of(&bed);
        struct moving moving;
        ck_assert_int_eq(moving_begin(&moving, &bed, &rule, 1), 0);
        ck_assert_uint_eq(moving.redone, bed.n);
        uint32_t redone = 0;
        for (uint64_t step = 1; step <= 8; step++) {
            jitter(&now, 3e-3, step);
            ck_assert_int_eq(moving_step(&moving, &now, allowed), 0);
            redone += moving.redone;
            check_closed(&moving);
        }
        ck_assert_double_lt(worst_row(&moving, &now), allowed);
        ck_assert_uint_gt(redone, 0);
        ck_assert_uint_lt(redone, 6 * bed.n);
        check_averaged(&moving, bed.r);
        moving_end(&moving);
        bed_free(&now);
    }
    bed_free(&bed);
}
END_TEST

/* A sphere goes to a free place far away: it comes into the sight of rows that see nothing move. */
START_TEST(what_comes_into_sight_is_found) {
    struct bed bed = packing(400, .8, 1.2, .4, 9, true);
    bed.r[0] = .5;
    struct bed now = copy_of(&bed);
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
    struct moving moving;
    ck_assert_int_eq(moving_begin(&moving, &bed, &(fibrad_beam_rule){.directions = 60}, 1), 0);
    ck_assert_double_gt(worst_row(&moving, &now), .01);
    ck_assert_int_eq(moving_step(&moving, &now, 4e-3), 0);
    ck_assert_uint_gt(moving.rounds, 1);
    ck_assert_uint_lt(moving.redone, bed.n / 2);
    ck_assert_double_lt(worst_row(&moving, &now), 4e-3);
    moving_end(&moving);
    bed_free(&bed);
    bed_free(&now);
}
END_TEST

START_TEST(threads_and_exact_steps_change_no_bit) {
    struct bed bed = packing(200, .8, 1.2, .55, 7, true);
    const fibrad_beam_rule rule = {.directions = 50};
    for (int exact = 0; exact < 2; exact++) {
        struct bed now = copy_of(&bed);
        struct moving one, many, anew;
        ck_assert_int_eq(moving_begin(&one, &bed, &rule, 1), 0);
        ck_assert_int_eq(moving_begin(&many, &bed, &rule, 3), 0);
        for (uint64_t step = 1; step <= 3; step++) {
            if (exact)
                now.z[7] += 1e-3;
            else
                jitter(&now, 3e-3, step);
            ck_assert_int_eq(moving_step(&one, &now, exact ? 0 : 6e-3), 0);
            ck_assert_int_eq(moving_step(&many, &now, exact ? 0 : 6e-3), 0);
            ck_assert_uint_eq(one.redone, many.redone);
        }
        ck_assert_int_eq(moving_begin(&anew, &now, &rule, 2), 0);
        for (uint32_t i = 0; i < bed.n; i++) {
            ck_assert(same_bits(&one.row[i], &many.row[i]));
            ck_assert(!exact || same_bits(&one.row[i], &anew.row[i]));
        }
        moving_end(&one);
        moving_end(&many);
        moving_end(&anew);
        bed_free(&now);
    }
    bed_free(&bed);
}
END_TEST

/* Moving a wall changes rows that see it; nothing is the same then. */
START_TEST(walls_that_move_change_rows) {
    struct bed bed = packing(100, .8, 1.2, .4, 1, false);
    fibrad_scene_config config = {.spheres = bed.n, .walls = {.planes = 63, .at = {-3, 30, -3, 30, -3, 30}}};
    const fibrad_spheres views = {bed.x, bed.y, bed.z, bed.r, bed.n};
    const size_t size = fibrad_scene_size(&config);
    fibrad_scene *scene[3];
    void *block[3];
    for (int k = 0; k < 3; k++) {
        if (k == 2) config.walls.at[5] = 31;
        block[k] = block_of(size);
        ck_assert_int_eq(fibrad_scene_init(&scene[k], block[k], size, &config, &views, NULL), FIBRAD_OK);
    }
    double reach[100];
    unsigned char same[100], scratch[200];
    for (uint32_t i = 0; i < bed.n; i++) reach[i] = INFINITY;
    ck_assert_int_eq(fibrad_moved_same(scene[0], scene[1], reach, scratch, same), FIBRAD_OK);
    for (uint32_t i = 0; i < bed.n; i++) ck_assert_uint_eq(same[i], 1);
    ck_assert_int_eq(fibrad_moved_same(scene[0], scene[2], reach, scratch, same), FIBRAD_OK);
    for (uint32_t i = 0; i < bed.n; i++) ck_assert_uint_eq(same[i], 0);
    for (int k = 0; k < 3; k++) free(block[k]);
    bed_free(&bed);
}
END_TEST

START_TEST(bad_arguments_are_refused) {
    struct bed bed = packing(50, .8, 1.2, .4, 1, true), less = packing(49, .8, 1.2, .4, 1, true), open = copy_of(&bed);
    open.period[1] = 0;
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST), *other = scene_of(&less, FIBRAD_ISA_BEST);
    fibrad_scene *unlike = scene_of(&open, FIBRAD_ISA_BEST);
    fibrad_row row = {.col = (uint32_t[]){1, 50}, .f = (double[]){.1, .1}, .length = 1}, beyond = row;
    beyond.length = 2;
    double error[50] = {0}, reach[50] = {0};
    unsigned char same[50], scratch[100];
    ck_assert_int_eq(fibrad_moved_error(scene, scene, 0, &row, error), FIBRAD_OK);
    ck_assert_double_eq(error[0], 0);
    ck_assert_int_eq(fibrad_moved_error(NULL, scene, 0, &row, error), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_moved_error(scene, NULL, 0, &row, error), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_moved_error(scene, other, 0, &row, error), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_moved_error(scene, unlike, 0, &row, error), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_moved_error(scene, scene, 50, &row, error), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_moved_error(scene, scene, 0, NULL, error), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_moved_error(scene, scene, 0, &beyond, error), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_moved_error(scene, scene, 0, &row, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_moved_seen(scene, 0, &row, &row, error), FIBRAD_OK);
    ck_assert_int_eq(fibrad_moved_seen(NULL, 0, &row, &row, error), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_moved_seen(scene, 50, &row, &row, error), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_moved_seen(scene, 0, &beyond, &row, error), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_moved_seen(scene, 0, &row, &beyond, error), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_moved_seen(scene, 0, &row, NULL, error), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_moved_seen(scene, 0, &row, &row, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_moved_same(scene, scene, reach, scratch, same), FIBRAD_OK);
    ck_assert_int_eq(fibrad_moved_same(scene, other, reach, scratch, same), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_moved_same(scene, scene, NULL, scratch, same), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_moved_same(scene, scene, reach, NULL, same), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_moved_same(scene, scene, reach, scratch, NULL), FIBRAD_E_ARGUMENT);
    reach[49] = NAN;
    ck_assert_int_eq(fibrad_moved_same(scene, scene, reach, scratch, same), FIBRAD_E_ARGUMENT);
    free(scene);
    free(other);
    free(unlike);
    bed_free(&bed);
    bed_free(&less);
    bed_free(&open);
}
END_TEST

int main(void) {
    Suite *suite = suite_create("moved");
    TCase *tests = suite_case(suite, "moved");
    tcase_add_test(tests, estimate_bounds_the_change_of_a_pair);
    tcase_add_test(tests, estimates_hold_in_beds);
    tcase_add_test(tests, moving_as_a_whole_is_no_error);
    tcase_add_test(tests, nothing_beyond_the_reach_matters);
    tcase_add_test(tests, same_rows_have_the_same_bits);
    tcase_add_test(tests, what_covers_the_deepest_window_is_within_reach);
    tcase_add_test(tests, the_loop_keeps_its_error);
    tcase_add_test(tests, what_comes_into_sight_is_found);
    tcase_add_test(tests, threads_and_exact_steps_change_no_bit);
    tcase_add_test(tests, walls_that_move_change_rows);
    tcase_add_test(tests, bad_arguments_are_refused);
    return suite_run(suite);
}
