/* test_matrix.c - matrices of view and exchange factors: averaged, closed, thinned out, raw.
 * SPDX-License-Identifier: MIT */
#include "matrices.h"

/* Makes a matrix of rows that are given. View factors that are missing go to the surroundings. */
static struct matrix matrix_by_hand(uint32_t n, const double *r, const uint64_t *start, const uint32_t *col,
                                    const double *f, const fibrad_matrix_rule *rule) {
    OWNED fibrad_scene *scene = apart(n, r);
    OWNED_ROWS rows = {.memory = memory_growing()};
    add_rows(&rows, n, start, col, f, rule == NULL || rule->kind != FIBRAD_ROWS_EXCHANGE);
    return matrix_of(scene, &rows, 1, rule);
}

static double reciprocity(const struct matrix *m) {
    double largest = NAN;
    assert_ok(fibrad_matrix_reciprocity(m->matrix, &largest));
    return largest;
}

static void ascending(const fibrad_factors *m) {
    for (uint32_t i = 0; i < m->n; i++) {
        for (uint64_t k = m->start[i] + 1; k < m->start[i + 1]; k++) ck_assert_uint_lt(m->col[k - 1], m->col[k]);
        if (m->start[i + 1] > m->start[i]) ck_assert_uint_lt(m->col[m->start[i + 1] - 1], m->n);
    }
}

static void all_closed(const fibrad_factors *m) {
    for (uint32_t i = 0; i < m->n; i++) {
        ck_assert_double_eq_tol(matrix_total(m, i), 1, 1e-13);
        ck_assert_double_le(matrix_sum(m, i), 1 + 1e-14);
        ck_assert(m->escaped[i] >= 0 && m->beyond[i] == 0 && m->error[i] >= 0);
        for (uint32_t b = 0; b < m->walls; b++) ck_assert(m->wall[(size_t)i * m->walls + b] >= 0);
    }
}

/* The mean of the rows and their transpose, entry by entry, before anything else changes it: dense, [n][n]. If r is
 * NULL, the mean has halves; otherwise each counts by its area. */
static double *mean_of(const fibrad_factors *raw, const double *area, const double *r) {
    double *mean = calloc((size_t)raw->n * raw->n, sizeof *mean);
    for (uint32_t i = 0; i < raw->n; i++)
        for (uint64_t k = raw->start[i]; k < raw->start[i + 1]; k++) {
            const uint32_t j = raw->col[k];
            const double part = r != NULL ? r[j] * r[j] / (r[i] * r[i] + r[j] * r[j]) : .5;
            mean[(size_t)i * raw->n + j] += raw->f[k] * part;
            mean[(size_t)j * raw->n + i] += area[i] / area[j] * raw->f[k] * part;
        }
    return mean;
}

static double *squares(const struct bed *bed, const double *emissivity) {
    double *area = calloc(bed->n, sizeof *area);
    for (uint32_t i = 0; i < bed->n; i++) area[i] = bed->r[i] * bed->r[i] * (emissivity != NULL ? emissivity[i] : 1);
    return area;
}

/* No more is received than a sphere's own disc: with exact areas, sums are at most 1. */
TEST(averaging_makes_rows_reciprocal) {
    struct bed beds[] = {packing(400, .8, 1.2, .55, 7, true), packing(400, .3, 1.5, .5, 8, false), lattice('f', 5)};
    for (size_t b = 0; b < 3; b++) {
        OWNED fibrad_scene *scene = scene_of(&beds[b], FIBRAD_ISA_BEST);
        const fibrad_beam_rule rule = {.directions = 100};
        OWNED_MATRIX raw = matrix_by_beams(scene, &rule, true), out = matrix_by_beams(scene, &rule, false);
        ascending(&raw.factors);
        ascending(&out.factors);
        all_closed(&out.factors);
        ck_assert_double_gt(reciprocity(&raw), 1e-4);
        ck_assert_double_le(reciprocity(&out), 1e-14);
        OWNED double *area = squares(&beds[b], NULL), *mean = mean_of(&raw.factors, area, NULL);
        double off = 0;
        const uint32_t n = beds[b].n;
        for (uint32_t i = 0; i < n; i++) {
            double sum = 0;
            for (uint32_t j = 0; j < n; j++) sum += mean[(size_t)i * n + j];
            ck_assert_double_le(sum, 1 + 1e-12);
            for (uint32_t j = 0; j < n; j++)
                worst_of(&off, fabs(matrix_factor(&out.factors, i, j) - mean[(size_t)i * n + j]));
        }
        ck_assert_double_le(off, 1e-12);
        for (uint32_t i = 0; i < n; i++) /* each raw entry is there, with half its exchange at least */
            for (uint64_t k = raw.factors.start[i]; k < raw.factors.start[i + 1]; k++)
                ck_assert_double_ge(matrix_factor(&out.factors, i, raw.factors.col[k]),
                                    raw.factors.f[k] / 2 * (1 - 1e-12));
        bed_free(&beds[b]);
    }
}

TEST(averaging_agrees_with_sums_by_hand) {
    const double r[] = {1, 2, 1}; /* areas are 1 : 4 : 1; 0 sees 1, 2 alone sees 0, and 2 sees itself */
    OWNED_MATRIX m =
        matrix_by_hand(3, r, (uint64_t[]){0, 1, 1, 3}, (uint32_t[]){1, 0, 2}, (double[]){.5, .25, .125}, NULL);
    static const uint32_t col[] = {1, 2, 0, 0, 2};
    static const double f[] = {.25, .125, .0625, .125, .125};
    ck_assert_uint_eq(m.factors.n, 3);
    ck_assert_mem_eq(m.factors.start, ((uint64_t[]){0, 2, 3, 5}), 4 * sizeof(uint64_t));
    ck_assert_mem_eq(m.factors.col, col, sizeof col);
    for (int k = 0; k < 5; k++) ck_assert_double_eq(m.factors.f[k], f[k]);
    static const double escaped[] = {1 - .375, 1 - .0625, 1 - .25}; /* the rest escapes */
    for (int i = 0; i < 3; i++) ck_assert_double_eq(m.factors.escaped[i], escaped[i]);
}

/* Sphere 0 sees 25 others, which do not see it. So closing changes what each row gives to the surroundings, whatever
 * its error is. */
TEST(changed_shows_what_closing_changes) {
    enum { N = 26 };
    double r[N], f[N];
    uint64_t start[N + 1] = {0};
    uint32_t col[N];
    for (uint32_t k = 0; k < N; k++) r[k] = 1, f[k] = .02, col[k] = k + 1, start[k + 1] = N - 1;
    for (int raw = 0; raw < 2; raw++) {
        OWNED_MATRIX m = matrix_by_hand(N, r, start, col, f, &(fibrad_matrix_rule){.raw = raw, .tasks = 3});
        double most = 0, ratio[N];
        for (uint32_t i = 0; i < N && !raw; i++) {
            ratio[i] = fabs(m.factors.escaped[i] - (i == 0 ? .5 : 1)) / m.factors.error[i];
            most = fmax(most, ratio[i]);
        }
        ck_assert(raw || most > 2);
        ck_assert(fabs(m.factors.changed - most) <= 1e-9 * most);
        const uint32_t row = m.factors.changed_row;
        ck_assert(raw || fabs(ratio[row] - most) <= 1e-9 * most);
    }
}

/* Factors of 0 stay where they were. */
TEST(factors_of_zero_stay_in_place) {
    const double r[] = {1, 2};
    const fibrad_matrix_rule rules[] = {{0}, {.raw = 1}};
    for (int k = 0; k < 2; k++) {
        OWNED_MATRIX m = matrix_by_hand(2, r, (uint64_t[]){0, 1, 2}, (uint32_t[]){1, 0}, (double[]){0, 0}, &rules[k]);
        ck_assert_double_eq(reciprocity(&m), 0);
        for (uint32_t i = 0; i < 2; i++) {
            ck_assert_double_eq(matrix_sum(&m.factors, i), 0);
            ck_assert_double_eq(matrix_total(&m.factors, i), 1);
        }
    }
    const double emissivity[] = {.5, .25};
    OWNED_MATRIX m =
        matrix_by_hand(2, r, (uint64_t[]){0, 1, 2}, (uint32_t[]){1, 0}, (double[]){0, 0},
                       &(fibrad_matrix_rule){.kind = FIBRAD_ROWS_EXCHANGE, .emissivity = emissivity, .drop = .1});
    for (uint32_t i = 0; i < 2; i++) ck_assert_double_eq(matrix_total(&m.factors, i), 1);
}

/* Each entry is that of the formula in the header. */
TEST(each_entry_is_that_of_the_header) {
    OWNED_BED bed = packing(120, .3, 1.5, .5, 9, false);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    const fibrad_beam_rule rule = {.directions = 34};
    OWNED_MATRIX raw = matrix_by_beams(scene, &rule, true), out = matrix_by_beams(scene, &rule, false);
    uint64_t wanted = 0;
    for (uint32_t i = 0; i < bed.n; i++)
        for (uint32_t j = 0; j < bed.n; j++) {
            const double here = matrix_factor(&raw.factors, i, j), there = matrix_factor(&raw.factors, j, i);
            const double ratio = bed.r[j] / bed.r[i];
            wanted += here > 0 || there > 0;
            ck_assert_double_eq_tol(matrix_factor(&out.factors, i, j), (here + ratio * ratio * there) / 2, 1e-15);
        }
    ck_assert_uint_eq(out.factors.start[bed.n], wanted);
    ck_assert_uint_lt(wanted, 2 * raw.factors.start[bed.n]);
}

/* The estimate follows from the difference between the mean and the raw row, and is at least half the estimate of the
 * raw row. Rows that are symmetric by themselves keep their estimates. */
TEST(errors_of_averaged_rows_follow_from_differences) {
    OWNED_BED bed = packing(120, .3, 1.5, .5, 9, false);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED_ROWS rows = rows_by_beams(scene, &(fibrad_beam_rule){.directions = 34});
    OWNED_ROWS symmetric = {.memory = memory_growing()};
    OWNED_MATRIX raw = matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.raw = 1});
    OWNED_MATRIX out = matrix_of(scene, &rows, 1, NULL);
    uint32_t by_distance = 0;
    for (uint32_t i = 0; i < bed.n; i++) {
        fibrad_row before = matrix_row(&raw.factors, i);
        const fibrad_row after = matrix_row(&out.factors, i);
        const double distance = 1.6 * row_distance(&before, &after), half = before.error / 2;
        ck_assert_double_gt(before.error, 0);
        ck_assert_double_eq_tol(after.error, distance > half ? distance : half, 1e-14);
        by_distance += distance > half;
        before.symmetric = 1;
        assert_ok(fibrad_rows_add(&symmetric, &before, 0));
    }
    ck_assert(by_distance > 0 && by_distance < bed.n);
    OWNED_MATRIX kept = matrix_of(scene, &symmetric, 1, NULL);
    for (uint32_t i = 0; i < bed.n; i++) ck_assert_double_eq(kept.factors.error[i], raw.factors.error[i]);
}

/* Rows by points err by the number of points. Sums of their means differ from 1, although no window is open. Closing
 * changes entries by about as much. */
TEST(closing_keeps_reciprocity) {
    OWNED_BED bed = packing(400, .8, 1.2, .58, 7, true);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    const fibrad_beam_rule rule = {.directions = 55, .points = 64};
    OWNED_MATRIX raw = matrix_by_beams(scene, &rule, true), closed = matrix_by_beams(scene, &rule, false);
    OWNED double *area = squares(&bed, NULL), *mean = mean_of(&raw.factors, area, NULL);
    double apart = 0, moved = 0;
    for (uint32_t i = 0; i < bed.n; i++) {
        double sum = 0;
        for (uint32_t j = 0; j < bed.n; j++) sum += mean[(size_t)i * bed.n + j];
        worst_of(&apart, fabs(sum - 1));
    }
    ck_assert_double_gt(apart, 1e-6); /* otherwise there is nothing to close */
    all_closed(&closed.factors);
    ck_assert_double_le(reciprocity(&closed), 1e-14);
    for (uint32_t i = 0; i < bed.n; i++)
        for (uint64_t k = closed.factors.start[i]; k < closed.factors.start[i + 1]; k++)
            worst_of(&moved, fabs(1 - closed.factors.f[k] / mean[(size_t)i * bed.n + closed.factors.col[k]]));
    ck_assert_double_le(moved, 2 * apart);
}

/* A_i emissivity_i D_ij is symmetric. Each row counts by the area of its partner. Rows that were closed remain
 * closed. */
TEST(exchange_factors_are_balanced) {
    OWNED_BED bed = packing(150, .5, 1.5, .5, 3, true);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED double *emissivity = calloc(bed.n, sizeof *emissivity);
    for (uint32_t i = 0; i < bed.n; i++) emissivity[i] = .2 + .8 * bed_make_random(5, i);
    OWNED_ROWS rows = {.memory = memory_growing()};
    OWNED_WORK work = work_growing();
    const fibrad_exchange_rule rule = {.emissivity = emissivity};
    for (uint32_t i = 0; i < bed.n; i++)
        assert_ok(fibrad_exchange_row(scene, &work, i, &rule, &(fibrad_row){.rows = &rows}, NULL));
    OWNED_MATRIX raw = matrix_of(
        scene, &rows, 1, &(fibrad_matrix_rule){.kind = FIBRAD_ROWS_EXCHANGE, .emissivity = emissivity, .raw = 1});
    OWNED_MATRIX out =
        matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.kind = FIBRAD_ROWS_EXCHANGE, .emissivity = emissivity});
    OWNED double *area = squares(&bed, emissivity), *mean = mean_of(&raw.factors, area, bed.r);
    double moved = 0;
    ck_assert_double_gt(reciprocity(&raw), 1e-4);
    ck_assert_double_le(reciprocity(&out), 1e-14);
    ascending(&out.factors);
    all_closed(&out.factors);
    for (uint32_t i = 0; i < bed.n; i++) {
        double sum = 0;
        ck_assert_double_eq_tol(matrix_sum(&out.factors, i), matrix_sum(&raw.factors, i), 2e-13);
        for (uint32_t j = 0; j < bed.n; j++) {
            const double f = matrix_factor(&out.factors, i, j), before = mean[(size_t)i * bed.n + j];
            sum += before;
            ck_assert((f > 0) == (before > 0));
            if (f > 0) worst_of(&moved, fabs(f / before - 1));
        }
        ck_assert_double_eq_tol(sum, matrix_sum(&raw.factors, i), .2);
    }
    ck_assert(moved > 1e-4 && moved < .5);                /* balancing scales the mean by little */
    OWNED_MATRIX view = matrix_of(scene, &rows, 1, NULL); /* the same rows, taken as view factors */
    ck_assert(!matrix_same_bits(&view.factors, &out.factors));
}

/* S_01 = (4 (3 A_0 D_01) + A_1 D_10)/5 with A = 4 pi (1, 4), in units of the largest emissivity. Factors u close what
 * rows leave over: D_01 becomes D_01 u_0 u_1, and the rest of row 0 is multiplied by u_0. If all emissivities are
 * equal, areas alone count. */
TEST(exchange_agrees_with_sums_by_hand) {
    const double r[] = {1, 2}, emissivity[] = {.9, .3};
    const uint64_t start[] = {0, 2, 4};
    const uint32_t col[] = {0, 1, 0, 1};
    const double f[] = {.2, .4, .3, .25}; /* 3 x 1 x .4 = 1.2 and 4 x .3 = 1.2: they are reciprocal, and stay so */
    OWNED_MATRIX m = matrix_by_hand(2, r, start, col, f,
                                    &(fibrad_matrix_rule){.kind = FIBRAD_ROWS_EXCHANGE, .emissivity = emissivity});
    ck_assert_uint_eq(m.factors.start[2], 4);
    for (int k = 0; k < 4; k++) ck_assert_double_eq_tol(m.factors.f[k], f[k], 2e-15);
    matrix_free(&m);
    const double skew[] = {.2, .5, .2, .25};
    m = matrix_by_hand(2, r, start, col, skew,
                       &(fibrad_matrix_rule){.kind = FIBRAD_ROWS_EXCHANGE, .emissivity = emissivity});
    ck_assert_double_le(reciprocity(&m), 1e-15);
    ck_assert_double_eq_tol(3 * m.factors.f[1], 4 * m.factors.f[2], 1e-15);
    /* D_ij u_i u_j of the mean (.2, 2.72/6; 2.04/6, .25) */
    const double u0 = sqrt(m.factors.f[0] / .2), u1 = sqrt(m.factors.f[3] / .25);
    ck_assert_double_eq_tol(m.factors.f[1], 2.72 / 6 * u0 * u1, 1e-14);
    ck_assert_double_eq_tol(matrix_sum(&m.factors, 0) + .3 * u0, 1, 2e-14);
    ck_assert_double_eq_tol(matrix_sum(&m.factors, 1) + .55 * u1, 1, 2e-14);
    ck_assert_double_eq_tol(m.factors.escaped[1], .55 * u1, 2e-14);
    matrix_free(&m);
    const double same[] = {.7, .7}, reciprocal[] = {.2, .4, .1, .25};
    m = matrix_by_hand(2, r, start, col, reciprocal,
                       &(fibrad_matrix_rule){.kind = FIBRAD_ROWS_EXCHANGE, .emissivity = same});
    for (int k = 0; k < 4; k++) ck_assert_double_eq_tol(m.factors.f[k], reciprocal[k], 2e-15);
}

/* Spheres of emissivity 0 stand between two others. Their rows stay empty, and the other rows have the bits that they
 * have without them. This holds also if little entries are dropped, and for raw rows. */
TEST(empty_rows_stay_empty) {
    const double r[] = {1, 2}, emissivity[] = {.9, .3}, f[] = {.2, .5, .2, .25};
    const double r_all[] = {5, 1, .3, 2}, emissivity_all[] = {0, .9, 0, .3};
    for (int raw = 0; raw <= 1; raw++)
        for (int drop = 0; drop <= 1; drop++) {
            fibrad_matrix_rule rule = {
                .kind = FIBRAD_ROWS_EXCHANGE, .emissivity = emissivity, .raw = raw, .drop = drop * .22};
            OWNED_MATRIX two = matrix_by_hand(2, r, (uint64_t[]){0, 2, 4}, (uint32_t[]){0, 1, 0, 1}, f, &rule);
            rule.emissivity = emissivity_all;
            OWNED_MATRIX four =
                matrix_by_hand(4, r_all, (uint64_t[]){0, 0, 2, 2, 4}, (uint32_t[]){1, 3, 1, 3}, f, &rule);
            ck_assert_uint_eq(two.factors.start[2], four.factors.start[4]);
            ck_assert_mem_eq(two.factors.f, four.factors.f, two.factors.start[2] * sizeof(double));
            ck_assert_double_eq(reciprocity(&two), reciprocity(&four));
            for (uint32_t i = 0; i < 4; i++) {
                const bool emits = i % 2 == 1;
                ck_assert_double_eq(four.factors.escaped[i], emits ? two.factors.escaped[i / 2] : 0);
                ck_assert_double_eq(four.factors.error[i], emits ? two.factors.error[i / 2] : 0);
                if (!raw) ck_assert_double_eq_tol(matrix_total(&four.factors, i), emits, 1e-13);
                if (!emits) ck_assert_double_eq(matrix_total(&four.factors, i), 0);
            }
        }
}

/* All spheres reflect all light, so that all rows of the matrix are empty. */
TEST(all_rows_may_be_empty) {
    const double r[] = {1, 2}, emissivity[] = {0, 0};
    OWNED_MATRIX m =
        matrix_by_hand(2, r, (uint64_t[]){0, 0, 0}, (uint32_t[]){0}, (double[]){0},
                       &(fibrad_matrix_rule){.kind = FIBRAD_ROWS_EXCHANGE, .emissivity = emissivity, .drop = .1});
    for (uint32_t i = 0; i < 2; i++) ck_assert_double_eq(matrix_total(&m.factors, i) + m.factors.error[i], 0);
    ck_assert(m.factors.start[2] == 0 && reciprocity(&m) == 0);
}

/* The rows of a walled bed with reflectors become reciprocal and closed. */
TEST(rows_among_walls_and_reflectors_are_closed) {
    OWNED_BED bed = packing(120, .5, 1.5, .45, 3, false);
    const fibrad_wall floor_plane = plane_at(2, 0, -100);
    OWNED fibrad_scene *scene = scene_with(&bed, &(fibrad_scene_config){.wall = &floor_plane, .walls = 1});
    OWNED double *emissivity = calloc(bed.n, sizeof *emissivity);
    for (uint32_t i = 0; i < bed.n; i++) emissivity[i] = i % 3 == 1 ? 0 : .2 + .8 * bed_make_random(5, i);
    OWNED_ROWS rows = {.memory = memory_growing()};
    OWNED_WORK work = work_growing();
    const fibrad_exchange_rule rule = {.emissivity = emissivity, .wall_emissivity = (double[]){.4}};
    for (uint32_t i = 0; i < bed.n; i++)
        assert_ok(fibrad_exchange_row(scene, &work, i, &rule, &(fibrad_row){.rows = &rows}, NULL));
    for (int drop = 0; drop <= 1; drop++) {
        OWNED_MATRIX m =
            matrix_of(scene, &rows, 1,
                      &(fibrad_matrix_rule){
                          .kind = FIBRAD_ROWS_EXCHANGE, .emissivity = emissivity, .drop = drop * 1e-3, .tasks = 3});
        ck_assert_double_le(reciprocity(&m), 1e-14);
        ascending(&m.factors);
        for (uint32_t i = 0; i < bed.n; i++) {
            const double expected = i % 3 == 1 ? 0 : 1;
            ck_assert_double_le(fabs(matrix_total(&m.factors, i) - expected), 1e-13 * expected);
            ck_assert_double_eq(matrix_factor(&m.factors, i, 1), 0);
        }
    }
}

TEST(dropping_keeps_sums_and_reciprocity) {
    OWNED_BED bed = packing(400, .7, 1.3, .55, 17, true);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED_ROWS rows = rows_by_beams(scene, &(fibrad_beam_rule){.directions = 233});
    OWNED_MATRIX before = matrix_of(scene, &rows, 1, NULL);
    const double thresholds[] = {0, 1e-3, 1e-2, 1};
    uint64_t last = UINT64_MAX;
    for (int t = 0; t < 4; t++) {
        OWNED_MATRIX m = matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.drop = thresholds[t]});
        ascending(&m.factors);
        all_closed(&m.factors);
        ck_assert_double_le(reciprocity(&m), 1e-14);
        for (uint32_t i = 0; i < bed.n; i++) {
            ck_assert_double_eq_tol(matrix_sum(&m.factors, i), matrix_sum(&before.factors, i), 2e-14);
            ck_assert_double_eq(m.factors.escaped[i], before.factors.escaped[i]);
        }
        for (uint64_t k = 0; k < m.factors.start[bed.n]; k++) ck_assert_double_ge(m.factors.f[k], 0);
        ck_assert_uint_lt(m.factors.start[bed.n], last);
        last = m.factors.start[bed.n];
        if (t == 0) ck_assert(matrix_same_bits(&m.factors, &before.factors));
        if (t == 3) ck_assert_uint_eq(last, bed.n); /* all are dropped: each row keeps its sum in F_ii */
    }
}

/* The threshold equals an entry. Either both entries of a pair are dropped, or neither. */
TEST(dropping_at_the_threshold_takes_both_or_none) {
    uint32_t gone = 0, stayed = 0;
    for (uint64_t k = 0; k < 2000; k++) {
        const double r[2] = {.1 + bed_make_random(9, 3 * k), .1 + bed_make_random(9, 3 * k + 1)};
        const double f = .01 * bed_make_random(9, 3 * k + 2), back = r[0] / r[1] * (r[0] / r[1]) * f;
        const uint64_t start[] = {0, 1, 2};
        const uint32_t col[] = {1, 0};
        const double both[] = {f, back};
        OWNED_MATRIX whole = matrix_by_hand(2, r, start, col, both, NULL);
        ck_assert_uint_eq(whole.factors.start[2], 2);
        const fibrad_matrix_rule rule = {.drop = whole.factors.f[k % 2]};
        OWNED_MATRIX m = matrix_by_hand(2, r, start, col, both, &rule);
        ck_assert_double_le(reciprocity(&m), 1e-14);
        for (uint32_t i = 0; i < 2; i++)
            ck_assert_double_eq_tol(matrix_sum(&m.factors, i), matrix_sum(&whole.factors, i), 1e-14);
        ck_assert_uint_eq(m.factors.start[2], 2);
        ck_assert((m.factors.col[0] == 1) == (m.factors.col[1] == 0));
        *(m.factors.col[0] == 1 ? &stayed : &gone) += 1;
    }
    ck_assert_uint_gt(stayed, 1000); /* the other entry is above the threshold, or this one is not below it */
    ck_assert_uint_eq(stayed + gone, 2000);
}

/* The spheres form a star. No scaling can give back to the leaves what the centre gives away. */
TEST(dropping_works_where_no_scaling_exists) {
    const double r[] = {1, 1, 1, 1};
    static const uint64_t start[] = {0, 2, 5, 7, 8};
    static const uint32_t col[] = {1, 2, 0, 2, 3, 0, 1, 1};
    static const double f[] = {.3, .001, .3, .2, .1, .001, .2, .1};
    OWNED_MATRIX whole = matrix_by_hand(4, r, start, col, f, NULL);
    OWNED_MATRIX m = matrix_by_hand(4, r, start, col, f, &(fibrad_matrix_rule){.drop = .01});
    ascending(&m.factors);
    for (uint32_t i = 0; i < 4; i++)
        ck_assert_double_eq_tol(matrix_sum(&m.factors, i), matrix_sum(&whole.factors, i), 1e-14);
    ck_assert_double_le(reciprocity(&m), 1e-14);
    ck_assert_double_eq(matrix_factor(&m.factors, 0, 2), 0);
}

/* One factor of a pair is missing, on either side of the diagonal. The other counts in full. */
TEST(a_lone_factor_counts_in_full) {
    const double r[] = {1, 2, 1};
    const fibrad_matrix_rule raw = {.raw = 1};
    OWNED_MATRIX above =
        matrix_by_hand(3, r, (uint64_t[]){0, 2, 3, 3}, (uint32_t[]){1, 2, 0}, (double[]){.2, .3, .05}, &raw);
    ck_assert_double_eq_tol(reciprocity(&above), .3, 1e-16); /* F_02 */
    OWNED_MATRIX below =
        matrix_by_hand(3, r, (uint64_t[]){0, 1, 2, 3}, (uint32_t[]){1, 0, 1}, (double[]){.2, .05, .4}, &raw);
    ck_assert_double_eq_tol(reciprocity(&below), .1, 1e-16); /* F_21, of which a quarter counts by area */
    OWNED_MATRIX diagonal =
        matrix_by_hand(2, r, (uint64_t[]){0, 2, 4}, (uint32_t[]){0, 1, 0, 1}, (double[]){.5, .2, .05, .125}, &raw);
    ck_assert_double_eq(reciprocity(&diagonal), 0);
    const double emissivity[] = {1, .5, 1}; /* 4 x .5 x .1 = .2: reciprocal with these emissivities alone */
    const double grey[] = {.2, .1};
    OWNED_MATRIX exchange =
        matrix_by_hand(2, r, (uint64_t[]){0, 1, 2}, (uint32_t[]){1, 0}, grey,
                       &(fibrad_matrix_rule){.kind = FIBRAD_ROWS_EXCHANGE, .raw = 1, .emissivity = emissivity});
    ck_assert_double_le(reciprocity(&exchange), 1e-16);
}

/* Raw rows stay as they were, in the order of the spheres. Missing rows are empty. */
TEST(raw_rows_stay_as_they_are) {
    OWNED_BED bed = packing(100, .5, 1.5, .4, 3, false);
    const fibrad_wall floor_plane = plane_at(2, 0, -100);
    OWNED fibrad_scene *scene = scene_with(&bed, &(fibrad_scene_config){.wall = &floor_plane, .walls = 1});
    OWNED_WORK work = work_growing();
    OWNED_ROWS rows = {.memory = memory_growing()};
    const fibrad_beam_rule rule = {.directions = 34};
    OWNED_ROW row = row_of(bed.n);
    for (uint32_t i = bed.n; i-- > 0;)
        if (i % 3 != 1) assert_ok(fibrad_beam_row(scene, &work, i, &rule, &(fibrad_row){.rows = &rows}));
    OWNED_MATRIX m = matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.raw = 1});
    ck_assert_uint_eq(m.factors.start[bed.n], rows.entries);
    for (uint32_t i = 0; i < bed.n; i++) {
        const fibrad_row there = matrix_row(&m.factors, i);
        if (i % 3 == 1) {
            ck_assert(there.length == 0 && there.escaped == 0 && there.error == 0 && there.wall[0] == 0);
            continue;
        }
        assert_ok(fibrad_beam_row(scene, &work, i, &rule, &row));
        ck_assert(same_bits_with(&row, &there, 1));
        ck_assert_double_gt(there.wall[0], 0);
    }
    uint32_t sphere = 999;
    fibrad_matrix *none = NULL;
    const size_t size = fibrad_matrix_size(scene, &rows, 1, NULL);
    OWNED void *block = block_of(size);
    ck_assert_int_eq(fibrad_matrix_init(&none, block, size, scene, &rows, 1, NULL, &sphere), FIBRAD_E_STATE);
    ck_assert_uint_eq(sphere, 1);
    ck_assert_ptr_null(none);
}
