/* test_matrix.c - collections of rows, and the matrices made of them: averaged, limited, balanced, closed, dropped.
 * SPDX-License-Identifier: MIT */
#include "scenes.h"
#include "suite.h"

/* Spheres of these radii, too far apart to see each other: rows are made by hand. */
static fibrad_scene *apart(uint32_t n, const double *r) {
    struct bed bed;
    bed_init(&bed);
    for (uint32_t i = 0; i < n; i++) add_sphere(&bed, 1000. * (i + 1), 0, 0, r[i]);
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    bed_free(&bed);
    return scene;
}

/* Rows by hand, in the arrays of a compressed matrix. */
static void add_rows(fibrad_rows *rows, uint32_t n, const uint64_t *start, const uint32_t *col, const double *f) {
    const fibrad_factors all = {.n = n, .start = start, .col = col, .f = f};
    for (uint32_t i = 0; i < n; i++) {
        const uint64_t begin = all.start[i];
        const fibrad_row row = {.sphere = i,
                                .col = (uint32_t *)(uintptr_t)(all.col + begin),
                                .f = (double *)(uintptr_t)(all.f + begin),
                                .length = (uint32_t)(all.start[i + 1] - begin)};
        ck_assert_int_eq(fibrad_rows_add(rows, &row, 0), FIBRAD_OK);
    }
}

/* A matrix of rows by hand. */
static struct matrix matrix_by_hand(uint32_t n, const double *r, const uint64_t *start, const uint32_t *col,
                                    const double *f, const fibrad_matrix_rule *rule) {
    fibrad_scene *scene = apart(n, r);
    fibrad_rows rows = {.memory = memory_growing()};
    add_rows(&rows, n, start, col, f);
    const struct matrix m = matrix_of(scene, &rows, 1, rule);
    rows_free(&rows);
    free(scene);
    return m;
}

static double reciprocity(const struct matrix *m) {
    double largest = NAN;
    ck_assert_int_eq(fibrad_matrix_reciprocity(m->matrix, &largest), FIBRAD_OK);
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
        for (uint32_t b = 0; b < m->bodies; b++) ck_assert(m->body[(size_t)i * m->bodies + b] >= 0);
    }
}

/* The mean of rows and their transpose, entry by entry, before anything else is done to it: dense, [n][n];
 * halves (r NULL), or each by its area. */
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

/* ---- view factors ----------------------------------------------------------------------------------------------- */

/* What is received is never more than a sphere's own disc: sums stay at most 1 with exact areas. */
START_TEST(averaging_makes_rows_reciprocal) {
    struct bed beds[] = {packing(400, .8, 1.2, .55, 7, true), packing(400, .3, 1.5, .5, 8, false), lattice('f', 5)};
    for (size_t b = 0; b < 3; b++) {
        fibrad_scene *scene = scene_of(&beds[b], FIBRAD_ISA_BEST);
        const fibrad_beam_rule rule = {.directions = 100};
        struct matrix raw = matrix_by_beams(scene, &rule, true), out = matrix_by_beams(scene, &rule, false);
        ascending(&raw.factors);
        ascending(&out.factors);
        all_closed(&out.factors);
        ck_assert_double_gt(reciprocity(&raw), 1e-4);
        ck_assert_double_le(reciprocity(&out), 1e-14);
        double *area = squares(&beds[b], NULL), *mean = mean_of(&raw.factors, area, NULL), off = 0;
        const uint32_t n = beds[b].n;
        for (uint32_t i = 0; i < n; i++) {
            double sum = 0;
            for (uint32_t j = 0; j < n; j++) sum += mean[(size_t)i * n + j];
            ck_assert_double_le(sum, 1 + 1e-12);
            for (uint32_t j = 0; j < n; j++)
                worst_of(&off, fabs(matrix_factor(&out.factors, i, j) - mean[(size_t)i * n + j]));
        }
        ck_assert_double_le(off, 1e-12);
        for (uint32_t i = 0; i < n; i++) /* every raw entry is there, and half its exchange at least */
            for (uint64_t k = raw.factors.start[i]; k < raw.factors.start[i + 1]; k++)
                ck_assert_double_ge(matrix_factor(&out.factors, i, raw.factors.col[k]),
                                    raw.factors.f[k] / 2 * (1 - 1e-12));
        free(area), free(mean), free(scene);
        matrix_free(&raw), matrix_free(&out);
        bed_free(&beds[b]);
    }
}
END_TEST

START_TEST(averaging_by_hand) {
    const double r[] = {1, 2, 1}; /* areas 1 : 4 : 1; 0 sees 1, nobody sees 0 but 2, and 2 sees itself */
    struct matrix m =
        matrix_by_hand(3, r, (uint64_t[]){0, 1, 1, 3}, (uint32_t[]){1, 0, 2}, (double[]){.5, .25, .125}, NULL);
    static const uint32_t col[] = {1, 2, 0, 0, 2};
    static const double f[] = {.25, .125, .0625, .125, .125};
    ck_assert_uint_eq(m.factors.n, 3);
    ck_assert_mem_eq(m.factors.start, ((uint64_t[]){0, 2, 3, 5}), 4 * sizeof(uint64_t));
    ck_assert_mem_eq(m.factors.col, col, sizeof col);
    for (int k = 0; k < 5; k++) ck_assert_double_eq(m.factors.f[k], f[k]);
    static const double escaped[] = {1 - .375, 1 - .0625, 1 - .25}; /* rows that met nothing: what is left */
    for (int i = 0; i < 3; i++) ck_assert_double_eq(m.factors.escaped[i], escaped[i]);
    matrix_free(&m);
}
END_TEST

/* Sphere 0 sees 25 others that do not see it, and nobody says what else is seen: closing gives the rest of each row to
 * the surroundings, whatever its error is. */
START_TEST(what_closing_changes) {
    enum { N = 26 };
    double r[N], f[N];
    uint64_t start[N + 1] = {0};
    uint32_t col[N];
    for (uint32_t k = 0; k < N; k++) r[k] = 1, f[k] = .02, col[k] = k + 1, start[k + 1] = N - 1;
    for (int raw = 0; raw < 2; raw++) {
        struct matrix m = matrix_by_hand(N, r, start, col, f, &(fibrad_matrix_rule){.raw = raw, .tasks = 3});
        double most = 0;
        for (uint32_t i = 0; i < N && !raw; i++) most = fmax(most, m.factors.escaped[i] / m.factors.error[i]);
        ck_assert(raw || most > 5);
        ck_assert(fabs(m.factors.changed - most) <= 1e-9 * most);
        const uint32_t row = m.factors.changed_row;
        ck_assert(raw || m.factors.escaped[row] / m.factors.error[row] == most);
        matrix_free(&m);
    }
}
END_TEST

/* Factors of 0 stand where they were. */
START_TEST(averaging_nothing) {
    const double r[] = {1, 2};
    const fibrad_matrix_rule rules[] = {{0}, {.raw = 1}};
    for (int k = 0; k < 2; k++) {
        struct matrix m = matrix_by_hand(2, r, (uint64_t[]){0, 1, 2}, (uint32_t[]){1, 0}, (double[]){0, 0}, &rules[k]);
        ck_assert_double_eq(reciprocity(&m), 0);
        for (uint32_t i = 0; i < 2; i++) {
            ck_assert_double_eq(matrix_sum(&m.factors, i), 0);
            ck_assert_double_eq(matrix_total(&m.factors, i), k == 0 ? 1 : 0);
        }
        matrix_free(&m);
    }
    const double emissivity[] = {.5, .25};
    struct matrix m = matrix_by_hand(2, r, (uint64_t[]){0, 1, 2}, (uint32_t[]){1, 0}, (double[]){0, 0},
                                     &(fibrad_matrix_rule){.emissivity = emissivity, .drop = .1});
    for (uint32_t i = 0; i < 2; i++) ck_assert_double_eq(matrix_total(&m.factors, i), 1);
    matrix_free(&m);
}
END_TEST

/* Entry by entry the formula of the header. */
START_TEST(averaging_entry_by_entry) {
    struct bed bed = packing(120, .3, 1.5, .5, 9, false);
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    const fibrad_beam_rule rule = {.directions = 34};
    struct matrix raw = matrix_by_beams(scene, &rule, true), out = matrix_by_beams(scene, &rule, false);
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
    free(scene);
    matrix_free(&raw), matrix_free(&out);
    bed_free(&bed);
}
END_TEST

/* The estimate follows from how far the mean is off the raw row, and is half the raw one at least; rows that are
 * symmetric by themselves keep theirs. */
START_TEST(errors_of_averaged_rows) {
    struct bed bed = packing(120, .3, 1.5, .5, 9, false);
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    fibrad_rows rows = rows_by_beams(scene, &(fibrad_beam_rule){.directions = 34});
    fibrad_rows symmetric = {.memory = memory_growing()};
    struct matrix raw = matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.raw = 1});
    struct matrix out = matrix_of(scene, &rows, 1, NULL);
    uint32_t by_distance = 0;
    for (uint32_t i = 0; i < bed.n; i++) {
        fibrad_row before = matrix_row(&raw.factors, i);
        const fibrad_row after = matrix_row(&out.factors, i);
        const double distance = 1.6 * row_distance(&before, &after), half = before.error / 2;
        ck_assert_double_gt(before.error, 0);
        ck_assert_double_eq_tol(after.error, distance > half ? distance : half, 1e-14);
        by_distance += distance > half;
        before.symmetric = 1;
        ck_assert_int_eq(fibrad_rows_add(&symmetric, &before, 0), FIBRAD_OK);
    }
    ck_assert(by_distance > 0 && by_distance < bed.n);
    struct matrix kept = matrix_of(scene, &symmetric, 1, NULL);
    for (uint32_t i = 0; i < bed.n; i++) ck_assert_double_eq(kept.factors.error[i], raw.factors.error[i]);
    rows_free(&rows), rows_free(&symmetric), free(scene);
    matrix_free(&raw), matrix_free(&out), matrix_free(&kept);
    bed_free(&bed);
}
END_TEST

/* Points err by their number, and a cutoff opens rows that others close. */
START_TEST(limiting_keeps_reciprocity) {
    struct bed bed = packing(400, .8, 1.2, .58, 7, true);
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    const fibrad_beam_rule rule = {.directions = 55, .points = 64};
    struct matrix raw = matrix_by_beams(scene, &rule, true), limited = matrix_by_beams(scene, &rule, false);
    double *area = squares(&bed, NULL), *mean = mean_of(&raw.factors, area, NULL), above = 0, moved = 0;
    for (uint32_t i = 0; i < bed.n; i++) {
        double sum = 0;
        for (uint32_t j = 0; j < bed.n; j++) sum += mean[(size_t)i * bed.n + j];
        worst_of(&above, sum - 1);
    }
    ck_assert_double_gt(above, 1e-6); /* there is something to do */
    all_closed(&limited.factors);
    ck_assert_double_le(reciprocity(&limited), 1e-14);
    for (uint32_t i = 0; i < bed.n; i++)
        for (uint64_t k = limited.factors.start[i]; k < limited.factors.start[i + 1]; k++)
            worst_of(&moved, 1 - limited.factors.f[k] / mean[(size_t)i * bed.n + limited.factors.col[k]]);
    ck_assert_double_le(moved, above);
    free(area), free(mean), free(scene);
    matrix_free(&raw), matrix_free(&limited);
    bed_free(&bed);
}
END_TEST

/* ---- exchange factors ------------------------------------------------------------------------------------------- */

/* A_i emissivity_i D_ij is symmetric, each row counts by its partner's area, and rows that were closed are. */
START_TEST(exchange_factors_are_balanced) {
    struct bed bed = packing(150, .5, 1.5, .5, 3, true);
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    double *emissivity = calloc(bed.n, sizeof *emissivity);
    for (uint32_t i = 0; i < bed.n; i++) emissivity[i] = .2 + .8 * bed_make_random(5, i);
    fibrad_rows rows = {.memory = memory_growing()};
    fibrad_work work = work_growing();
    const fibrad_exchange_rule rule = {.emissivity = emissivity};
    for (uint32_t i = 0; i < bed.n; i++)
        ck_assert_int_eq(fibrad_exchange_row(scene, &work, i, &rule, &(fibrad_row){.rows = &rows}, NULL), FIBRAD_OK);
    struct matrix raw = matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.emissivity = emissivity, .raw = 1});
    struct matrix out = matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.emissivity = emissivity});
    double *area = squares(&bed, emissivity), *mean = mean_of(&raw.factors, area, bed.r), moved = 0;
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
    ck_assert(moved > 1e-4 && moved < .5);                 /* the mean is scaled, by little */
    struct matrix view = matrix_of(scene, &rows, 1, NULL); /* what the same rows would be as view factors */
    ck_assert(!matrix_same_bits(&view.factors, &out.factors));
    free(area), free(mean), free(emissivity), free(scene);
    rows_free(&rows), work_free(&work);
    matrix_free(&raw), matrix_free(&out), matrix_free(&view);
    bed_free(&bed);
}
END_TEST

/* S_01 = (4 (3 A_0 D_01) + A_1 D_10)/5 with A = 4 pi (1, 4), in units of the largest emissivity, and what rows leave
 * over are closed by factors u: D_01 u_0 u_1, and u_0 times the rest of row 0. Where all emissivities are equal, areas
 * alone count. */
START_TEST(exchange_by_hand) {
    const double r[] = {1, 2}, emissivity[] = {.9, .3};
    const uint64_t start[] = {0, 2, 4};
    const uint32_t col[] = {0, 1, 0, 1};
    const double f[] = {.2, .4, .3, .25}; /* 3 x 1 x .4 = 1.2, and 4 x .3 = 1.2: reciprocal, as they are to stay */
    struct matrix m = matrix_by_hand(2, r, start, col, f, &(fibrad_matrix_rule){.emissivity = emissivity});
    ck_assert_uint_eq(m.factors.start[2], 4);
    for (int k = 0; k < 4; k++) ck_assert_double_eq_tol(m.factors.f[k], f[k], 2e-15);
    matrix_free(&m);
    const double skew[] = {.2, .5, .2, .25};
    m = matrix_by_hand(2, r, start, col, skew, &(fibrad_matrix_rule){.emissivity = emissivity});
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
    m = matrix_by_hand(2, r, start, col, reciprocal, &(fibrad_matrix_rule){.emissivity = same});
    for (int k = 0; k < 4; k++) ck_assert_double_eq_tol(m.factors.f[k], reciprocal[k], 2e-15);
    matrix_free(&m);
}
END_TEST

/* Spheres of emissivity 0 between two others: their rows stay empty, the others are to the bit what they are without
 * them; also where little entries are dropped, and as raw rows. */
START_TEST(empty_rows_stay_empty) {
    const double r[] = {1, 2}, emissivity[] = {.9, .3}, f[] = {.2, .5, .2, .25};
    const double r_all[] = {5, 1, .3, 2}, emissivity_all[] = {0, .9, 0, .3};
    for (int raw = 0; raw <= 1; raw++)
        for (int drop = 0; drop <= 1; drop++) {
            fibrad_matrix_rule rule = {.emissivity = emissivity, .raw = raw, .drop = drop * .22};
            struct matrix two = matrix_by_hand(2, r, (uint64_t[]){0, 2, 4}, (uint32_t[]){0, 1, 0, 1}, f, &rule);
            rule.emissivity = emissivity_all;
            struct matrix four =
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
            matrix_free(&two), matrix_free(&four);
        }
}
END_TEST

/* All reflect: a matrix of empty rows. */
START_TEST(all_rows_empty) {
    const double r[] = {1, 2}, emissivity[] = {0, 0};
    struct matrix m = matrix_by_hand(2, r, (uint64_t[]){0, 0, 0}, (uint32_t[]){0}, (double[]){0},
                                     &(fibrad_matrix_rule){.emissivity = emissivity, .drop = .1});
    for (uint32_t i = 0; i < 2; i++) ck_assert_double_eq(matrix_total(&m.factors, i) + m.factors.error[i], 0);
    ck_assert(m.factors.start[2] == 0 && reciprocity(&m) == 0);
    matrix_free(&m);
}
END_TEST

/* Rows of a walled bed with reflectors, made reciprocal and closed. */
START_TEST(reflectors_in_a_walled_bed) {
    struct bed bed = packing(120, .5, 1.5, .45, 3, false);
    const fibrad_body floor_plane = plane_at(2, 0, -100);
    fibrad_scene *scene = scene_with(&bed, &(fibrad_scene_config){.body = &floor_plane, .bodies = 1});
    double *emissivity = calloc(bed.n, sizeof *emissivity);
    for (uint32_t i = 0; i < bed.n; i++) emissivity[i] = i % 3 == 1 ? 0 : .2 + .8 * bed_make_random(5, i);
    fibrad_rows rows = {.memory = memory_growing()};
    fibrad_work work = work_growing();
    const fibrad_exchange_rule rule = {.emissivity = emissivity, .body_emissivity = (double[]){.4}};
    for (uint32_t i = 0; i < bed.n; i++)
        ck_assert_int_eq(fibrad_exchange_row(scene, &work, i, &rule, &(fibrad_row){.rows = &rows}, NULL), FIBRAD_OK);
    for (int drop = 0; drop <= 1; drop++) {
        struct matrix m = matrix_of(scene, &rows, 1,
                                    &(fibrad_matrix_rule){.emissivity = emissivity, .drop = drop * 1e-3, .tasks = 3});
        ck_assert_double_le(reciprocity(&m), 1e-14);
        ascending(&m.factors);
        for (uint32_t i = 0; i < bed.n; i++) {
            const double expected = i % 3 == 1 ? 0 : 1;
            ck_assert_double_le(fabs(matrix_total(&m.factors, i) - expected), 1e-13 * expected);
            ck_assert_double_eq(matrix_factor(&m.factors, i, 1), 0);
        }
        matrix_free(&m);
    }
    free(emissivity), free(scene);
    rows_free(&rows), work_free(&work);
    bed_free(&bed);
}
END_TEST

/* ---- dropping --------------------------------------------------------------------------------------------------- */

START_TEST(dropping_keeps_the_books) {
    struct bed bed = packing(400, .7, 1.3, .55, 17, true);
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    fibrad_rows rows = rows_by_beams(scene, &(fibrad_beam_rule){.directions = 233});
    struct matrix before = matrix_of(scene, &rows, 1, NULL);
    const double thresholds[] = {0, 1e-3, 1e-2, 1};
    uint64_t last = UINT64_MAX;
    for (int t = 0; t < 4; t++) {
        struct matrix m = matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.drop = thresholds[t]});
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
        if (t == 3) ck_assert_uint_eq(last, bed.n); /* all gone: each row keeps what it had in F_ii */
        matrix_free(&m);
    }
    matrix_free(&before);
    rows_free(&rows);
    free(scene);
    bed_free(&bed);
}
END_TEST

/* A threshold that equals an entry: both of a pair must go, or neither. */
START_TEST(dropping_at_the_threshold) {
    uint32_t gone = 0, stayed = 0;
    for (uint64_t k = 0; k < 2000; k++) {
        const double r[2] = {.1 + bed_make_random(9, 3 * k), .1 + bed_make_random(9, 3 * k + 1)};
        const double f = .01 * bed_make_random(9, 3 * k + 2), back = r[0] / r[1] * (r[0] / r[1]) * f;
        const uint64_t start[] = {0, 1, 2};
        const uint32_t col[] = {1, 0};
        const double both[] = {f, back};
        struct matrix whole = matrix_by_hand(2, r, start, col, both, NULL);
        ck_assert_uint_eq(whole.factors.start[2], 2);
        const fibrad_matrix_rule rule = {.drop = whole.factors.f[k % 2]};
        struct matrix m = matrix_by_hand(2, r, start, col, both, &rule);
        ck_assert_double_le(reciprocity(&m), 1e-14);
        for (uint32_t i = 0; i < 2; i++)
            ck_assert_double_eq_tol(matrix_sum(&m.factors, i), matrix_sum(&whole.factors, i), 1e-14);
        ck_assert_uint_eq(m.factors.start[2], 2);
        ck_assert((m.factors.col[0] == 1) == (m.factors.col[1] == 0));
        *(m.factors.col[0] == 1 ? &stayed : &gone) += 1;
        matrix_free(&whole), matrix_free(&m);
    }
    ck_assert_uint_gt(stayed, 1000); /* the other one is above the threshold, or the entry itself is not below */
    ck_assert_uint_eq(stayed + gone, 2000);
}
END_TEST

/* A star: what its centre gives away cannot be given back to the leaves by any scaling. */
START_TEST(dropping_where_no_scaling_exists) {
    const double r[] = {1, 1, 1, 1};
    static const uint64_t start[] = {0, 2, 5, 7, 8};
    static const uint32_t col[] = {1, 2, 0, 2, 3, 0, 1, 1};
    static const double f[] = {.3, .001, .3, .2, .1, .001, .2, .1};
    struct matrix whole = matrix_by_hand(4, r, start, col, f, NULL);
    struct matrix m = matrix_by_hand(4, r, start, col, f, &(fibrad_matrix_rule){.drop = .01});
    ascending(&m.factors);
    for (uint32_t i = 0; i < 4; i++)
        ck_assert_double_eq_tol(matrix_sum(&m.factors, i), matrix_sum(&whole.factors, i), 1e-14);
    ck_assert_double_le(reciprocity(&m), 1e-14);
    ck_assert_double_eq(matrix_factor(&m.factors, 0, 2), 0);
    matrix_free(&whole), matrix_free(&m);
}
END_TEST

/* ---- raw rows --------------------------------------------------------------------------------------------------- */

/* Pairs of which one factor is missing, on either side of the diagonal: it counts in full. */
START_TEST(lone_factors_are_not_reciprocal) {
    const double r[] = {1, 2, 1};
    const fibrad_matrix_rule raw = {.raw = 1};
    struct matrix above =
        matrix_by_hand(3, r, (uint64_t[]){0, 2, 3, 3}, (uint32_t[]){1, 2, 0}, (double[]){.2, .3, .05}, &raw);
    ck_assert_double_eq_tol(reciprocity(&above), .3, 1e-16); /* F_02 */
    struct matrix below =
        matrix_by_hand(3, r, (uint64_t[]){0, 1, 2, 3}, (uint32_t[]){1, 0, 1}, (double[]){.2, .05, .4}, &raw);
    ck_assert_double_eq_tol(reciprocity(&below), .1, 1e-16); /* F_21, a quarter of it by area */
    struct matrix diagonal =
        matrix_by_hand(2, r, (uint64_t[]){0, 2, 4}, (uint32_t[]){0, 1, 0, 1}, (double[]){.5, .2, .05, .125}, &raw);
    ck_assert_double_eq(reciprocity(&diagonal), 0);
    const double emissivity[] = {1, .5, 1}; /* 4 x .5 x .1 = .2: reciprocal with these alone */
    const double grey[] = {.2, .1};
    struct matrix exchange = matrix_by_hand(2, r, (uint64_t[]){0, 1, 2}, (uint32_t[]){1, 0}, grey,
                                            &(fibrad_matrix_rule){.raw = 1, .emissivity = emissivity});
    ck_assert_double_le(reciprocity(&exchange), 1e-16);
    matrix_free(&above), matrix_free(&below), matrix_free(&diagonal), matrix_free(&exchange);
}
END_TEST

/* Raw rows are what they were, in the order of the spheres, and what is missing is empty. */
START_TEST(raw_rows_stay_as_they_are) {
    struct bed bed = packing(100, .5, 1.5, .4, 3, false);
    const fibrad_body floor_plane = plane_at(2, 0, -100);
    fibrad_scene *scene = scene_with(&bed, &(fibrad_scene_config){.body = &floor_plane, .bodies = 1});
    fibrad_work work = work_growing();
    fibrad_rows rows = {.memory = memory_growing()};
    const fibrad_beam_rule rule = {.directions = 34};
    fibrad_row row = row_of(bed.n);
    for (uint32_t i = bed.n; i-- > 0;)
        if (i % 3 != 1)
            ck_assert_int_eq(fibrad_beam_row(scene, &work, i, &rule, &(fibrad_row){.rows = &rows}), FIBRAD_OK);
    struct matrix m = matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.raw = 1});
    ck_assert_uint_eq(m.factors.start[bed.n], rows.entries);
    for (uint32_t i = 0; i < bed.n; i++) {
        const fibrad_row there = matrix_row(&m.factors, i);
        if (i % 3 == 1) {
            ck_assert(there.length == 0 && there.escaped == 0 && there.error == 0 && there.body[0] == 0);
            continue;
        }
        ck_assert_int_eq(fibrad_beam_row(scene, &work, i, &rule, &row), FIBRAD_OK);
        ck_assert(same_bits_with(&row, &there, 1));
        ck_assert_double_gt(there.body[0], 0);
    }
    uint32_t sphere = 999;
    fibrad_matrix *none = NULL;
    const size_t size = fibrad_matrix_size(scene, &rows, 1, NULL);
    void *block = block_of(size);
    ck_assert_int_eq(fibrad_matrix_init(&none, block, size, scene, &rows, 1, NULL, &sphere), FIBRAD_E_STATE);
    ck_assert_uint_eq(sphere, 1);
    ck_assert_ptr_null(none);
    free(block), free(scene);
    row_free(&row), rows_free(&rows), work_free(&work);
    matrix_free(&m);
    bed_free(&bed);
}
END_TEST

/* ---- tasks and states ------------------------------------------------------------------------------------------- */

static void at_once(void *calls, uint32_t pieces, fibrad_piece *piece, void *job) {
    ++*(int *)calls;
#pragma omp parallel for num_threads(4) schedule(dynamic, 1)
    for (uint32_t k = 0; k < pieces; k++) piece(job, pieces - 1 - k);
}

/* The matrix of `tasks` tasks, every one but each `left`-th averaged here, backwards or by several threads, which then
 * do all the rest, too. */
static struct matrix by_tasks(const fibrad_scene *scene, const fibrad_rows *rows, uint32_t count,
                              fibrad_matrix_rule rule, uint32_t tasks, uint32_t left, bool threads) {
    struct matrix m = {NULL, {0}};
    int calls = 0;
    rule.tasks = tasks;
    if (threads) rule.parallel = at_once, rule.context = &calls;
    const size_t size = fibrad_matrix_size(scene, rows, count, &rule);
    void *block = block_of(size);
    memset(block, 0xa5, size);
    ck_assert_int_eq(fibrad_matrix_init(&m.matrix, block, size, scene, rows, count, &rule, NULL), FIBRAD_OK);
    int failed = 0;
#pragma omp parallel for num_threads(threads ? 4 : 1) schedule(dynamic, 1) reduction(+ : failed)
    for (uint32_t k = 0; k < tasks; k++)
        if (left == 0 || k % left != 0) failed += fibrad_matrix_average(m.matrix, tasks - 1 - k) != FIBRAD_OK;
    ck_assert_int_eq(failed, 0);
    ck_assert_int_eq(fibrad_matrix_close(m.matrix), FIBRAD_OK);
    ck_assert_int_eq(fibrad_matrix_read(m.matrix, &m.factors), FIBRAD_OK);
    double largest, same;
    ck_assert_int_eq(fibrad_matrix_reciprocity(m.matrix, &largest), FIBRAD_OK);
    ck_assert(!threads || tasks == 1 || calls > 4);
    struct matrix alone =
        matrix_of(scene, rows, count, &(fibrad_matrix_rule){.emissivity = rule.emissivity, .drop = rule.drop});
    ck_assert_int_eq(fibrad_matrix_reciprocity(alone.matrix, &same), FIBRAD_OK);
    ck_assert_double_eq(largest, same);
    matrix_free(&alone);
    return m;
}

/* No bit depends on the number of tasks, on who averages them, nor on how rows are spread over collections. */
START_TEST(tasks_change_no_bit) {
    struct bed bed = packing(150, .3, 1.5, .5, 3, true);
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    double *emissivity = calloc(bed.n, sizeof *emissivity);
    for (uint32_t i = 0; i < bed.n; i++) emissivity[i] = (1 + i % 7) / 7.;
    const fibrad_matrix_rule rules[] = {{0}, {.emissivity = emissivity}, {.drop = 5e-3}};
    fibrad_rows rows = rows_by_beams(scene, &(fibrad_beam_rule){.directions = 34}), spread[4];
    for (int c = 0; c < 4; c++) spread[c] = (fibrad_rows){.memory = memory_growing()};
    fibrad_work work = work_growing();
    for (uint32_t i = bed.n; i-- > 0;) { /* none in the third */
        fibrad_row to = {.rows = &spread[i % 3 == 2 ? 3 : i % 3]};
        ck_assert_int_eq(fibrad_beam_row(scene, &work, i, &(fibrad_beam_rule){.directions = 34}, &to), FIBRAD_OK);
    }
    for (int k = 0; k < 3; k++) {
        struct matrix whole = matrix_of(scene, &rows, 1, &rules[k]), other = matrix_of(scene, spread, 4, &rules[k]);
        ck_assert(matrix_same_bits(&whole.factors, &other.factors));
        matrix_free(&other);
        for (uint32_t tasks = 1; tasks <= 1024; tasks += tasks < 16 ? 1 : 1008) {
            for (uint32_t left = 0; left <= 3; left++) {
                struct matrix m =
                    by_tasks(scene, left % 2 ? spread : &rows, left % 2 ? 4 : 1, rules[k], tasks, left, left == 0);
                ck_assert(matrix_same_bits(&whole.factors, &m.factors));
                matrix_free(&m);
            }
        }
        matrix_free(&whole);
    }
    for (int c = 0; c < 4; c++) rows_free(&spread[c]);
    rows_free(&rows), work_free(&work);
    free(emissivity), free(scene);
    bed_free(&bed);
}
END_TEST

START_TEST(calls_out_of_order) {
    const double r[] = {1, 2, 1};
    fibrad_scene *scene = apart(3, r);
    fibrad_rows rows = {.memory = memory_growing()};
    add_rows(&rows, 3, (uint64_t[]){0, 1, 1, 3}, (uint32_t[]){1, 0, 2}, (double[]){.5, .25, .125});
    for (int raw = 0; raw < 2; raw++) {
        const fibrad_matrix_rule rule = {.tasks = 2, .raw = raw};
        const size_t size = fibrad_matrix_size(scene, &rows, 1, &rule);
        void *block = block_of(size);
        fibrad_matrix *m = NULL;
        fibrad_factors factors = {.n = 77};
        double largest = -7;
        ck_assert_int_eq(fibrad_matrix_init(&m, block, size, scene, &rows, 1, &rule, NULL), FIBRAD_OK);
        ck_assert_int_eq(fibrad_matrix_read(m, &factors), FIBRAD_E_STATE);
        ck_assert_int_eq(fibrad_matrix_reciprocity(m, &largest), FIBRAD_E_STATE);
        ck_assert(factors.n == 77 && factors.start == NULL && largest == -7);
        ck_assert_int_eq(fibrad_matrix_average(m, 2), FIBRAD_E_ARGUMENT);
        ck_assert_int_eq(fibrad_matrix_average(m, UINT32_MAX), FIBRAD_E_ARGUMENT);
        if (!raw) {
            ck_assert_int_eq(fibrad_matrix_average(m, 1), FIBRAD_OK);
            ck_assert_int_eq(fibrad_matrix_average(m, 1), FIBRAD_E_STATE);
            ck_assert_int_eq(fibrad_matrix_average(m, 0), FIBRAD_OK);
        }
        ck_assert_int_eq(fibrad_matrix_close(m), FIBRAD_OK);
        ck_assert_int_eq(fibrad_matrix_read(m, &factors), FIBRAD_OK);
        const double first = factors.f[0];
        ck_assert_int_eq(fibrad_matrix_close(m), FIBRAD_E_STATE);
        if (!raw) ck_assert_int_eq(fibrad_matrix_average(m, 0), FIBRAD_E_STATE);
        ck_assert_int_eq(fibrad_matrix_read(m, &factors), FIBRAD_OK); /* as often as one likes */
        ck_assert_double_eq(factors.f[0], first);
        ck_assert_int_eq(fibrad_matrix_reciprocity(m, &largest), FIBRAD_OK);
        ck_assert_int_eq(fibrad_matrix_read(m, NULL), FIBRAD_E_ARGUMENT);
        ck_assert_int_eq(fibrad_matrix_reciprocity(m, NULL), FIBRAD_E_ARGUMENT);
        free(block);
    }
    fibrad_factors factors;
    double largest;
    ck_assert_int_eq(fibrad_matrix_average(NULL, 0), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_matrix_close(NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_matrix_read(NULL, &factors), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_matrix_reciprocity(NULL, &largest), FIBRAD_E_ARGUMENT);
    rows_free(&rows);
    free(scene);
}
END_TEST

/* A row that is missing or there twice, in one collection or in two, is named, and there is no matrix. */
START_TEST(rows_missing_or_double) {
    const double r[] = {1, 2, 1, 1, 3}, f = .5;
    fibrad_scene *scene = apart(5, r);
    const uint32_t col = 2;
    unsigned char block[8192];
    for (int raw = 0; raw < 2; raw++)
        for (uint32_t missing = 0; missing < 6; missing++)
            for (uint32_t twice = 0; twice < 6; twice++) {
                fibrad_rows rows[2] = {{.memory = memory_growing()}, {.memory = memory_growing()}};
                for (uint32_t i = 0; i < 5; i++) {
                    fibrad_row row = {.sphere = i, .col = (uint32_t *)(uintptr_t)&col, .f = (double *)(uintptr_t)&f};
                    row.length = i % 2;
                    if (i != missing) ck_assert_int_eq(fibrad_rows_add(&rows[0], &row, 0), FIBRAD_OK);
                    if (i == twice) ck_assert_int_eq(fibrad_rows_add(&rows[i % 2], &row, 0), FIBRAD_OK);
                }
                const fibrad_matrix_rule rule = {.raw = raw};
                const bool doubled = twice < 5 && (twice != missing);
                const bool lacks = missing < 5 && twice != missing;
                fibrad_matrix *m = NULL;
                uint32_t sphere = 99;
                const size_t size = fibrad_matrix_size(scene, rows, 2, &rule);
                ck_assert(size > 0 && size <= sizeof block);
                const int status = fibrad_matrix_init(&m, block, size, scene, rows, 2, &rule, &sphere);
                if (doubled || (lacks && !raw)) {
                    ck_assert_int_eq(status, FIBRAD_E_STATE);
                    ck_assert(doubled && lacks && !raw ? sphere == twice || sphere == missing
                                                       : sphere == (doubled ? twice : missing));
                    ck_assert_ptr_null(m);
                    ck_assert_int_eq(fibrad_matrix_init(&m, block, size, scene, rows, 2, &rule, NULL), FIBRAD_E_STATE);
                } else {
                    ck_assert_int_eq(status, FIBRAD_OK);
                    ck_assert_uint_eq(sphere, 99);
                }
                rows_free(&rows[0]), rows_free(&rows[1]);
            }
    fibrad_matrix *m = NULL; /* no collections at all */
    uint32_t sphere = 99;
    ck_assert_int_eq(fibrad_matrix_init(&m, block, sizeof block, scene, NULL, 0, NULL, &sphere), FIBRAD_E_STATE);
    ck_assert_uint_eq(sphere, 0);
    struct matrix empty = matrix_of(scene, NULL, 0, &(fibrad_matrix_rule){.raw = 1});
    ck_assert_uint_eq(empty.factors.start[5], 0);
    matrix_free(&empty);
    free(scene);
}
END_TEST

/* ---- memory of matrices ----------------------------------------------------------------------------------------- */

/* At every offset the same bits, nothing written beside the block, and a byte less is too little. */
START_TEST(matrix_blocks_of_any_alignment) {
    struct bed bed = packing(60, .5, 1.5, .5, 3, true);
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    fibrad_rows rows = rows_by_beams(scene, &(fibrad_beam_rule){.directions = 34});
    double emissivity[60];
    for (uint32_t i = 0; i < bed.n; i++) emissivity[i] = (1 + i % 5) / 5.;
    const fibrad_matrix_rule rules[] = {
        {.tasks = 3}, {.raw = 1}, {.emissivity = emissivity, .tasks = 7}, {.drop = .02}};
    for (int k = 0; k < 4; k++) {
        struct matrix expected = matrix_of(scene, &rows, 1, &rules[k]);
        const size_t size = fibrad_matrix_size(scene, &rows, 1, &rules[k]);
        /* what the header says of it */
        ck_assert_uint_le(size, (k == 1 ? 12 : 36) * rows.entries + (k == 1 ? 60 : 120) * bed.n + 2048);
        unsigned char *block = block_of(size + 128);
        for (size_t offset = 0; offset < 64; offset++) {
            fibrad_matrix *m = NULL;
            fibrad_factors factors;
            memset(block, 0xa5, size + 128);
            ck_assert_int_eq(fibrad_matrix_init(&m, block + offset, size - 1, scene, &rows, 1, &rules[k], NULL),
                             FIBRAD_E_SIZE);
            ck_assert_int_eq(fibrad_matrix_init(&m, block + offset, 0, scene, &rows, 1, &rules[k], NULL),
                             FIBRAD_E_SIZE);
            ck_assert_ptr_null(m);
            ck_assert_int_eq(fibrad_matrix_init(&m, block + offset, size, scene, &rows, 1, &rules[k], NULL), FIBRAD_OK);
            ck_assert_int_eq(fibrad_matrix_close(m), FIBRAD_OK);
            ck_assert_int_eq(fibrad_matrix_read(m, &factors), FIBRAD_OK);
            ck_assert(matrix_same_bits(&factors, &expected.factors));
            ck_assert(bytes_are(block, 0, offset, 0xa5));
            ck_assert(bytes_are(block, offset + size, size + 128, 0xa5));
        }
        free(block);
        matrix_free(&expected);
    }
    rows_free(&rows);
    free(scene);
    bed_free(&bed);
}
END_TEST

START_TEST(bad_matrices_are_refused) {
    const double r[] = {1, 2}, f = .5;
    fibrad_scene *scene = apart(2, r);
    uint32_t col = 1;
    fibrad_rows rows = {.memory = memory_growing()}, stranger = rows, seen = rows, walled = rows;
    const double body = .1;
    fibrad_row row = {.col = &col, .f = (double *)(uintptr_t)&f, .length = 1};
    for (row.sphere = 0; row.sphere < 2; row.sphere++) {
        col = 1;
        ck_assert_int_eq(fibrad_rows_add(&rows, &row, 0), FIBRAD_OK);
        row.body = (double *)(uintptr_t)&body;
        ck_assert_int_eq(fibrad_rows_add(&walled, &row, 1), FIBRAD_OK);
        row.body = NULL;
        col = 1 + row.sphere; /* 2: no such sphere */
        ck_assert_int_eq(fibrad_rows_add(&seen, &row, 0), FIBRAD_OK);
    }
    col = 1;
    row.sphere = 2; /* no such sphere */
    ck_assert_int_eq(fibrad_rows_add(&stranger, &row, 0), FIBRAD_OK);
    static unsigned char block[8192];
    fibrad_matrix *m = NULL;
    ck_assert_int_eq(fibrad_matrix_init(NULL, block, sizeof block, scene, &rows, 1, NULL, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_matrix_init(&m, NULL, sizeof block, scene, &rows, 1, NULL, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_matrix_init(&m, block, sizeof block, NULL, &rows, 1, NULL, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_matrix_init(&m, block, sizeof block, scene, NULL, 1, NULL, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_uint_eq(fibrad_matrix_size(NULL, &rows, 1, NULL), 0);
    ck_assert_uint_eq(fibrad_matrix_size(scene, NULL, 1, NULL), 0);
    const fibrad_rows *const bad_rows[] = {&stranger, &seen, &walled};
    for (int k = 0; k < 3; k++) {
        ck_assert_uint_eq(fibrad_matrix_size(scene, bad_rows[k], 1, NULL), 0);
        ck_assert_int_eq(fibrad_matrix_init(&m, block, sizeof block, scene, bad_rows[k], 1, NULL, NULL),
                         FIBRAD_E_ARGUMENT);
    }
    static const double emissivity[][2] = {{1, 0}, {1, -1}, {NAN, 1}, {1, INFINITY}, {1.5, 1}};
    fibrad_matrix_rule bad[10] = {{.tasks = 1025}, {.tasks = UINT32_MAX}, {.drop = -1}, {.drop = NAN}};
    for (int k = 0; k < 5; k++) bad[4 + k].emissivity = emissivity[k];
    for (int k = 0; k < 9; k++) {
        ck_assert_uint_eq(fibrad_matrix_size(scene, &rows, 1, &bad[k]), 0);
        ck_assert_int_eq(fibrad_matrix_init(&m, block, sizeof block, scene, &rows, 1, &bad[k], NULL),
                         FIBRAD_E_ARGUMENT);
    }
    ck_assert_ptr_null(m);
    ck_assert_int_eq(fibrad_matrix_init(&m, block, sizeof block, scene, &rows, 1, NULL, NULL), FIBRAD_OK);
    rows_free(&rows), rows_free(&stranger), rows_free(&seen), rows_free(&walled);
    free(scene);
}
END_TEST

/* ---- collections ------------------------------------------------------------------------------------------------ */

static bool same_collection(const fibrad_rows *a, const fibrad_rows *b) {
    return a->count == b->count && a->entries == b->entries;
}

START_TEST(bad_rows_are_refused) {
    fibrad_rows rows = {.memory = memory_growing()};
    uint32_t col[] = {1, 3}, descending[] = {3, 1}, equal[] = {1, 1};
    double f[] = {.1, .2}, body[] = {.5};
    const fibrad_row good = {.sphere = 7, .col = col, .f = f, .body = body, .length = 2, .escaped = .7, .error = .01};
    ck_assert_int_eq(fibrad_rows_add(&rows, &good, 1), FIBRAD_OK);
    ck_assert(rows.count == 1 && rows.entries == 2 && rows.used > 0);
    const fibrad_rows before = rows;
    fibrad_row bad = good;
    bad.col = descending;
    ck_assert_int_eq(fibrad_rows_add(&rows, &bad, 1), FIBRAD_E_ARGUMENT);
    bad.col = equal;
    ck_assert_int_eq(fibrad_rows_add(&rows, &bad, 1), FIBRAD_E_ARGUMENT);
    bad.col = NULL;
    ck_assert_int_eq(fibrad_rows_add(&rows, &bad, 1), FIBRAD_E_ARGUMENT);
    bad = good, bad.f = NULL;
    ck_assert_int_eq(fibrad_rows_add(&rows, &bad, 1), FIBRAD_E_ARGUMENT);
    bad = good, bad.body = NULL;
    ck_assert_int_eq(fibrad_rows_add(&rows, &bad, 1), FIBRAD_E_ARGUMENT);
    const double wrong[] = {-.1, 1.1, NAN, INFINITY, -INFINITY};
    for (size_t k = 0; k < 2 * sizeof wrong / sizeof *wrong; k++) {
        double g[] = {.1, .2};
        g[k % 2] = wrong[k / 2];
        bad = good, bad.f = g;
        ck_assert_int_eq(fibrad_rows_add(&rows, &bad, 1), FIBRAD_E_ARGUMENT);
    }
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        double g = wrong[k];
        bad = good, bad.body = &g;
        ck_assert_int_eq(fibrad_rows_add(&rows, &bad, 1), FIBRAD_E_ARGUMENT);
    }
    bad = good, bad.escaped = NAN;
    ck_assert_int_eq(fibrad_rows_add(&rows, &bad, 1), FIBRAD_E_ARGUMENT);
    bad = good, bad.error = NAN;
    ck_assert_int_eq(fibrad_rows_add(&rows, &bad, 1), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_rows_add(NULL, &good, 1), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_rows_add(&rows, NULL, 1), FIBRAD_E_ARGUMENT);
    ck_assert(same_collection(&rows, &before) && rows.used == before.used);
    bad = good, bad.body = NULL; /* no bodies, no array */
    ck_assert_int_eq(fibrad_rows_add(&rows, &bad, 0), FIBRAD_OK);
    bad = (fibrad_row){.sphere = 3, .escaped = 1}; /* nothing seen */
    ck_assert_int_eq(fibrad_rows_add(&rows, &bad, 0), FIBRAD_OK);
    double whole[] = {1 + 1e-15, 0};
    bad = (fibrad_row){.sphere = 4, .col = col, .f = whole, .length = 2}; /* above 1 by rounding, and nothing */
    ck_assert_int_eq(fibrad_rows_add(&rows, &bad, 0), FIBRAD_OK);
    ck_assert(rows.count == 4 && rows.entries == 6);
    rows_free(&rows);
    fibrad_rows_clear(NULL);
}
END_TEST

/* Rows by the kernel and rows added come out alike, with one and the other in one collection, which is then emptied and
 * used again without more memory. */
START_TEST(rows_added_are_rows_computed) {
    struct bed bed = packing(50, .5, 1.5, .4, 3, false);
    const fibrad_body walls[] = {plane_at(2, 0, -100), plane_at(2, 1, 500)};
    fibrad_scene *scene = scene_with(&bed, &(fibrad_scene_config){.body = walls, .bodies = 2});
    fibrad_work work = work_growing();
    const fibrad_beam_rule rule = {.directions = 34};
    fibrad_rows computed = rows_by_beams(scene, &rule), mixed = {.memory = memory_growing()};
    fibrad_row row = row_of(bed.n);
    struct matrix expected = matrix_of(scene, &computed, 1, NULL);
    size_t size = 0;
    for (int round = 0; round < 3; round++) {
        for (uint32_t i = 0; i < bed.n; i++) {
            fibrad_row append = {.rows = &mixed, .sphere = 1000, .length = 1000};
            ck_assert_int_eq(fibrad_beam_row(scene, &work, i, &rule, i % 2 ? &row : &append), FIBRAD_OK);
            if (i % 2) ck_assert_int_eq(fibrad_rows_add(&mixed, &row, 2), FIBRAD_OK);
            if (i % 2) continue;
            ck_assert_uint_eq(append.sphere, i); /* said of a row that is appended, too */
            ck_assert(append.length > 0 && append.length < bed.n);
            ck_assert_int_eq(fibrad_beam_row(scene, &work, i, &rule, &row), FIBRAD_OK);
            ck_assert(same_bits_with(&append, &row, 2)); /* where it stands now */
            ck_assert_uint_eq(append.directions, 34);
            ck_assert_double_gt(append.error, 0);
        }
        ck_assert(same_collection(&mixed, &computed));
        ck_assert_uint_eq(mixed.used, computed.used);
        struct matrix m = matrix_of(scene, &mixed, 1, NULL);
        ck_assert(matrix_same_bits(&m.factors, &expected.factors));
        matrix_free(&m);
        if (round > 0) ck_assert_uint_eq(mixed.memory.size, size);
        size = mixed.memory.size;
        const void *block = mixed.memory.block;
        fibrad_rows_clear(&mixed);
        ck_assert(mixed.count == 0 && mixed.used == 0 && mixed.entries == 0);
        ck_assert(mixed.memory.block == block && mixed.memory.size == size);
    }
    matrix_free(&expected);
    row_free(&row), rows_free(&computed), rows_free(&mixed), work_free(&work);
    free(scene);
    bed_free(&bed);
}
END_TEST

/* Fixed memory: what a row lacks is said, nothing is lost or written beside the block, and with as much memory the row
 * goes in. At every offset of the block. */
START_TEST(collections_in_fixed_memory) {
    struct bed bed = packing(40, .5, 1.5, .4, 3, false);
    fibrad_scene *scene = scene_of(&bed, 0);
    fibrad_work work = work_growing();
    const fibrad_beam_rule rule = {.directions = 13};
    fibrad_rows plenty = rows_by_beams(scene, &rule);
    struct matrix expected = matrix_of(scene, &plenty, 1, NULL);
    const size_t room = plenty.used + 256;
    unsigned char *block = block_of(room + 128);
    fibrad_row row = row_of(bed.n);
    for (size_t offset = 0; offset < 64; offset++) {
        memset(block, 0xa5, room + 128);
        fibrad_rows rows = {.memory = {.block = block + offset, .size = offset % 8}};
        uint32_t refused = 0;
        for (uint32_t i = 0; i < bed.n; i++) {
            const bool added = (i + offset) % 2;
            if (added) ck_assert_int_eq(fibrad_beam_row(scene, &work, i, &rule, &row), FIBRAD_OK);
            fibrad_row append = {.rows = &rows};
            for (;;) {
                const uint64_t entries = rows.entries;
                const size_t used = rows.used;
                const int status =
                    added ? fibrad_rows_add(&rows, &row, 0) : fibrad_beam_row(scene, &work, i, &rule, &append);
                if (status == FIBRAD_OK) break;
                ck_assert_int_eq(status, FIBRAD_E_CAPACITY);
                ck_assert_uint_gt(rows.memory.needed, rows.memory.size);
                ck_assert(rows.count == i && rows.entries == entries && rows.used == used);
                ck_assert_uint_le(rows.memory.needed, room);
                ck_assert(rows.memory.block == block + offset);
                ck_assert(bytes_are(block, offset + rows.memory.size, room + 128, 0xa5));
                rows.memory.size = rows.memory.needed;
                ck_assert_uint_le(++refused, 3 * bed.n);
            }
        }
        ck_assert_uint_ge(refused, bed.n / 2);
        ck_assert(same_collection(&rows, &plenty));
        ck_assert(bytes_are(block, 0, offset, 0xa5));
        ck_assert(bytes_are(block, offset + rows.memory.size, room + 128, 0xa5));
        struct matrix m = matrix_of(scene, &rows, 1, NULL);
        ck_assert(matrix_same_bits(&m.factors, &expected.factors));
        matrix_free(&m);
    }
    fibrad_rows nothing = {0}; /* no block at all */
    ck_assert_int_eq(fibrad_rows_add(&nothing, &row, 0), FIBRAD_E_CAPACITY);
    ck_assert_uint_gt(nothing.memory.needed, 0);
    fibrad_row append = {.rows = &nothing};
    ck_assert_int_eq(fibrad_beam_row(scene, &work, 0, &rule, &append), FIBRAD_E_CAPACITY);
    ck_assert_uint_gt(nothing.memory.needed, 0);
    free(block), free(scene);
    matrix_free(&expected);
    row_free(&row), rows_free(&plenty), work_free(&work);
    bed_free(&bed);
}
END_TEST

START_TEST(collections_that_grow) {
    struct bed bed = packing(60, .5, 1.5, .4, 3, false);
    fibrad_scene *scene = scene_of(&bed, 0);
    const fibrad_beam_rule rule = {.directions = 13};
    fibrad_rows plenty = rows_by_beams(scene, &rule);
    struct matrix expected = matrix_of(scene, &plenty, 1, NULL);
    for (uint32_t refuse = 0; refuse < 5; refuse++) {
        struct source source = {.refuse_at = refuse};
        fibrad_rows rows = {.memory = {.resize = source_resize, .context = &source}};
        fibrad_work work = work_growing();
        uint32_t refused = 0;
        for (uint32_t i = 0; i < bed.n; i++) {
            int status = fibrad_beam_row(scene, &work, i, &rule, &(fibrad_row){.rows = &rows});
            if (status == FIBRAD_E_MEMORY) {
                refused++;
                ck_assert_uint_eq(rows.count, i);
                status = fibrad_beam_row(scene, &work, i, &rule, &(fibrad_row){.rows = &rows});
            }
            ck_assert_int_eq(status, FIBRAD_OK);
        }
        ck_assert_uint_eq(refused, refuse > 0 && source.calls >= refuse);
        ck_assert(same_collection(&rows, &plenty));
        struct matrix m = matrix_of(scene, &rows, 1, NULL);
        ck_assert(matrix_same_bits(&m.factors, &expected.factors));
        matrix_free(&m);
        free(source.whole);
        work_free(&work);
    }
    matrix_free(&expected);
    rows_free(&plenty);
    free(scene);
    bed_free(&bed);
}
END_TEST

/* Rows come back as they went in, also empty ones, with columns that may be written. */
START_TEST(rows_read_one_by_one) {
    uint32_t col[] = {3, 5, 9};
    double f[] = {.25, .125, .0625}, body[] = {.5};
    const fibrad_row in = {.col = col,
                           .f = f,
                           .body = body,
                           .length = 3,
                           .escaped = .03125,
                           .beyond = .03125,
                           .error = .01,
                           .symmetric = 1};
    fibrad_rows rows = {.memory = memory_growing()};
    fibrad_row out;
    size_t at = 0;
    ck_assert_int_eq(fibrad_rows_read(&rows, &at, &out), 0);
    for (uint32_t i = 0; i < 40; i++) {
        fibrad_row row = in;
        row.sphere = i, row.length = i % 4;
        ck_assert_int_eq(fibrad_rows_add(&rows, &row, 1), FIBRAD_OK);
    }
    for (uint32_t again = 0; again < 2; again++) {
        at = 0;
        for (uint32_t i = 0; i < 40; i++) {
            ck_assert_int_eq(fibrad_rows_read(&rows, &at, &out), 1);
            ck_assert(out.sphere == i && out.length == i % 4 && out.body[0] == .5 && out.symmetric == 1);
            ck_assert(out.escaped == .03125 && out.beyond == .03125 && out.error == .01 && out.rows == NULL);
            for (uint32_t k = 0; k < out.length; k++) {
                ck_assert(out.col[k] == col[k] + again * 100 && out.f[k] == f[k]);
                out.col[k] += 100;
            }
        }
        ck_assert_int_eq(fibrad_rows_read(&rows, &at, &out), 0);
    }
    ck_assert_int_eq(fibrad_rows_read(NULL, &at, &out), 0);
    ck_assert_int_eq(fibrad_rows_read(&rows, NULL, &out), 0);
    ck_assert_int_eq(fibrad_rows_read(&rows, &at, NULL), 0);
    rows_free(&rows);
}
END_TEST

int main(void) {
    Suite *suite = suite_create("matrix");
    TCase *tcase = suite_case(suite, "matrix");
    tcase_add_test(tcase, averaging_makes_rows_reciprocal);
    tcase_add_test(tcase, averaging_by_hand);
    tcase_add_test(tcase, what_closing_changes);
    tcase_add_test(tcase, averaging_nothing);
    tcase_add_test(tcase, averaging_entry_by_entry);
    tcase_add_test(tcase, errors_of_averaged_rows);
    tcase_add_test(tcase, limiting_keeps_reciprocity);
    tcase_add_test(tcase, exchange_factors_are_balanced);
    tcase_add_test(tcase, exchange_by_hand);
    tcase_add_test(tcase, empty_rows_stay_empty);
    tcase_add_test(tcase, all_rows_empty);
    tcase_add_test(tcase, reflectors_in_a_walled_bed);
    tcase_add_test(tcase, dropping_keeps_the_books);
    tcase_add_test(tcase, dropping_at_the_threshold);
    tcase_add_test(tcase, dropping_where_no_scaling_exists);
    tcase_add_test(tcase, lone_factors_are_not_reciprocal);
    tcase_add_test(tcase, raw_rows_stay_as_they_are);
    tcase_add_test(tcase, tasks_change_no_bit);
    tcase_add_test(tcase, calls_out_of_order);
    tcase_add_test(tcase, rows_missing_or_double);
    tcase_add_test(tcase, matrix_blocks_of_any_alignment);
    tcase_add_test(tcase, bad_matrices_are_refused);
    tcase_add_test(tcase, bad_rows_are_refused);
    tcase_add_test(tcase, rows_added_are_rows_computed);
    tcase_add_test(tcase, collections_in_fixed_memory);
    tcase_add_test(tcase, collections_that_grow);
    tcase_add_test(tcase, rows_read_one_by_one);
    return suite_run(suite);
}
