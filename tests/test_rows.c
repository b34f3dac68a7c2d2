/* test_rows.c - matrices of view factors: averaging, limiting, dropping. SPDX-License-Identifier: MIT */
#include "compute/average.h"
#include "scenes.h"
#include "suite.h"

static fibrad_rows rows_of(uint32_t n, uint64_t capacity) {
    return (fibrad_rows){.n = n,
                         .capacity = capacity,
                         .start = calloc((size_t)n + 1, sizeof(uint64_t)),
                         .col = calloc(capacity, sizeof(uint32_t)),
                         .f = calloc(capacity, sizeof(double))};
}

static fibrad_rows raw_rows(const struct bed *bed, fibrad_beam_rule rule, double *escaped) {
    fibrad_scene *scene = scene_of(bed, FIBRAD_ISA_BEST);
    fibrad_work *work = work_of(&(fibrad_work_config){.discs = 512, .entries = bed->n});
    fibrad_rows rows = rows_of(bed->n, (uint64_t)bed->n * bed->n + bed->n);
    for (uint32_t i = 0; i < bed->n; i++) {
        uint64_t begin = rows.start[i];
        fibrad_row row = {.col = rows.col + begin, .f = rows.f + begin, .capacity = bed->n};
        ck_assert_int_eq(fibrad_beam_row(scene, work, i, &rule, &row), FIBRAD_OK);
        rows.start[i + 1] = begin + row.length;
        escaped[i] = row.escaped;
    }
    free(scene);
    free(work);
    return rows;
}

static double sum_of(const fibrad_rows *rows, uint32_t i) {
    double sum = 0;
    for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) sum += rows->f[k];
    return sum;
}

static void ascending(const fibrad_rows *rows) {
    for (uint32_t i = 0; i < rows->n; i++)
        for (uint64_t k = rows->start[i] + 1; k < rows->start[i + 1]; k++)
            ck_assert_uint_lt(rows->col[k - 1], rows->col[k]);
}

static fibrad_rows averaged(const fibrad_rows *raw, const double *r) {
    fibrad_rows out = rows_of(raw->n, 2 * raw->start[raw->n]);
    ck_assert_int_eq(fibrad_rows_average(raw, r, &out), FIBRAD_OK);
    return out;
}

/* What is received is never more than a sphere's own disc: sums stay at most 1 with exact areas. */
START_TEST(averaging_makes_rows_reciprocal) {
    struct bed beds[] = {packing(400, .8, 1.2, .55, 7, true), packing(400, .3, 1.5, .5, 8, false), lattice('f', 5)};
    for (size_t b = 0; b < 3; b++) {
        double *escaped = calloc(beds[b].n, sizeof *escaped), before, after;
        fibrad_rows raw = raw_rows(&beds[b], (fibrad_beam_rule){.directions = 100}, escaped);
        fibrad_rows out = averaged(&raw, beds[b].r);
        ascending(&out);
        ck_assert_int_eq(fibrad_rows_reciprocity(&raw, beds[b].r, &before), FIBRAD_OK);
        ck_assert_int_eq(fibrad_rows_reciprocity(&out, beds[b].r, &after), FIBRAD_OK);
        ck_assert_double_gt(before, 1e-4);
        ck_assert_double_le(after, 1e-14);
        for (uint32_t i = 0; i < out.n; i++) ck_assert_double_le(sum_of(&out, i), 1 + 1e-12);
        for (uint32_t i = 0; i < raw.n; i++) /* every raw entry is there, and half its exchange at least */
            for (uint64_t k = raw.start[i]; k < raw.start[i + 1]; k++) {
                bool there = false;
                for (uint64_t m = out.start[i]; m < out.start[i + 1]; m++)
                    if (out.col[m] == raw.col[k]) there = out.f[m] >= raw.f[k] / 2 * (1 - 1e-15);
                ck_assert(there);
            }
        rows_free(&raw);
        rows_free(&out);
        free(escaped);
        bed_free(&beds[b]);
    }
}
END_TEST

START_TEST(averaging_by_hand) {
    double r[] = {1, 2, 1}; /* areas 1 : 4 : 1; 0 sees 1, nobody sees 0 but 2, and 2 sees itself */
    fibrad_rows raw = {.n = 3,
                       .capacity = 3,
                       .start = (uint64_t[]){0, 1, 1, 3},
                       .col = (uint32_t[]){1, 0, 2},
                       .f = (double[]){.5, .25, .125}};
    fibrad_rows out = rows_of(3, 4);
    ck_assert_int_eq(fibrad_rows_average(&raw, r, &out), FIBRAD_E_CAPACITY);
    ck_assert_uint_eq(out.start[3], 5);
    rows_free(&out);
    out = rows_of(3, 5);
    ck_assert_int_eq(fibrad_rows_average(&raw, r, &out), FIBRAD_OK);
    static const uint32_t col[] = {1, 2, 0, 0, 2};
    static const double f[] = {.25, .125, .0625, .125, .125};
    ck_assert_mem_eq(out.start, ((uint64_t[]){0, 2, 3, 5}), 4 * sizeof(uint64_t));
    ck_assert_mem_eq(out.col, col, sizeof col);
    for (int k = 0; k < 5; k++) ck_assert_double_eq(out.f[k], f[k]);
    rows_free(&out);
}
END_TEST

static double entry(const fibrad_rows *rows, uint32_t i, uint32_t j) {
    for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++)
        if (rows->col[k] == j) return rows->f[k];
    return 0;
}

/* Entry by entry the formula of the header, and the same bits where `out` has just the room it needs. */
START_TEST(averaging_entry_by_entry) {
    struct bed bed = packing(120, .3, 1.5, .5, 9, false);
    double *escaped = calloc(bed.n, sizeof *escaped);
    fibrad_rows raw = raw_rows(&bed, (fibrad_beam_rule){.directions = 34}, escaped);
    fibrad_rows out = averaged(&raw, bed.r);
    const uint64_t entries = out.start[out.n];
    uint64_t wanted = 0;
    for (uint32_t i = 0; i < bed.n; i++)
        for (uint32_t j = 0; j < bed.n; j++) {
            const double here = entry(&raw, i, j), there = entry(&raw, j, i), ratio = bed.r[j] / bed.r[i];
            wanted += here > 0 || there > 0;
            ck_assert_double_eq_tol(entry(&out, i, j), (here + ratio * ratio * there) / 2, 1e-15);
        }
    ck_assert_uint_eq(entries, wanted);
    ck_assert_uint_lt(entries, 2 * raw.start[raw.n]);
    fibrad_rows tight = rows_of(raw.n, entries);
    ck_assert_int_eq(fibrad_rows_average(&raw, bed.r, &tight), FIBRAD_OK);
    ck_assert_mem_eq(tight.start, out.start, (out.n + 1) * sizeof *out.start);
    ck_assert_mem_eq(tight.col, out.col, entries * sizeof *out.col);
    ck_assert_mem_eq(tight.f, out.f, entries * sizeof *out.f);
    rows_free(&raw);
    rows_free(&out);
    rows_free(&tight);
    free(escaped);
    bed_free(&bed);
}
END_TEST

/* S_01 = (3 A_0 F_01 + A_1 F_10)/4 with A = 4 pi (1, 4); where only one side has an entry, its share of it. */
START_TEST(averaging_with_weights) {
    fibrad_rows raw = {.n = 3,
                       .capacity = 3,
                       .start = (uint64_t[]){0, 2, 3, 3},
                       .col = (uint32_t[]){1, 2, 0},
                       .f = (double[]){.4, .2, .2}};
    const double r[] = {1, 2, 1}, weight[] = {3, 1, 1}, same[] = {7, 7, 7};
    fibrad_rows out = rows_of(3, 6), plain = averaged(&raw, r);
    ck_assert_int_eq(fibrad_rows_average_weighted(&raw, r, weight, &out), FIBRAD_OK);
    ck_assert_uint_eq(out.start[3], 4);
    const double expected[] = {(3 * .4 + 4 * .2) / 4, 3 * .2 / 4, (3 * .4 / 4 + .2) / 4, 3 * .2 / 4};
    for (int k = 0; k < 4; k++) ck_assert_double_eq_tol(out.f[k], expected[k], 1e-15);
    ck_assert_int_eq(fibrad_rows_average_weighted(&raw, r, same, &out), FIBRAD_OK);
    ck_assert_mem_eq(out.f, plain.f, 4 * sizeof *out.f);
    const double bad[][3] = {{1, 0, 1}, {1, -1, 1}, {NAN, 1, 1}, {1, 1, INFINITY}};
    for (int k = 0; k < 4; k++)
        ck_assert_int_eq(fibrad_rows_average_weighted(&raw, r, bad[k], &out), FIBRAD_E_ARGUMENT);
    rows_free(&out);
    rows_free(&plain);
}
END_TEST

/* Parts, laid one behind the other, are the whole to the bit, in just the room they need; so is the host's mean,
 * whatever the number of threads. */
START_TEST(averaging_in_parts) {
    struct bed bed = packing(150, .3, 1.5, .5, 3, true);
    double *escaped = calloc(bed.n, sizeof *escaped), *weight = calloc(bed.n, sizeof *weight);
    fibrad_rows raw = raw_rows(&bed, (fibrad_beam_rule){.directions = 34}, escaped);
    for (uint32_t i = 0; i < bed.n; i++) weight[i] = 1 + i % 7;
    fibrad_rows whole = rows_of(raw.n, 2 * raw.start[raw.n]);
    ck_assert_int_eq(fibrad_rows_average_weighted(&raw, bed.r, weight, &whole), FIBRAD_OK);
    for (uint32_t parts = 1; parts <= 5; parts++) {
        for (uint32_t p = 0; p < parts; p++) {
            const uint32_t begin = bed.n * p / parts, end = bed.n * (p + 1) / parts;
            const uint64_t from = whole.start[begin], entries = whole.start[end] - from;
            fibrad_rows part = rows_of(raw.n, entries);
            ck_assert_int_eq(fibrad_rows_average_part(&raw, bed.r, weight, begin, end, &part), FIBRAD_OK);
            for (uint32_t i = 0; i <= bed.n; i++) {
                const uint32_t row = i < begin ? begin : i > end ? end : i;
                ck_assert_uint_eq(part.start[i], whole.start[row] - from);
            }
            ck_assert_mem_eq(part.col, whole.col + from, entries * sizeof *part.col);
            ck_assert_mem_eq(part.f, whole.f + from, entries * sizeof *part.f);
            part.capacity--;
            ck_assert_int_eq(fibrad_rows_average_part(&raw, bed.r, weight, begin, end, &part), FIBRAD_E_CAPACITY);
            ck_assert_uint_eq(part.start[bed.n], entries);
            rows_free(&part);
        }
    }
    fibrad_rows mean, none = rows_of(raw.n, 1);
    ck_assert_int_eq(average_rows(&raw, bed.r, weight, 3, &mean), 0);
    ck_assert_mem_eq(mean.start, whole.start, (bed.n + 1) * sizeof *mean.start);
    ck_assert_mem_eq(mean.col, whole.col, whole.start[bed.n] * sizeof *mean.col);
    ck_assert_mem_eq(mean.f, whole.f, whole.start[bed.n] * sizeof *mean.f);
    rows_free(&mean);
    ck_assert_int_eq(fibrad_rows_average_part(&raw, bed.r, weight, 70, 70, &none), FIBRAD_OK);
    ck_assert_uint_eq(none.start[bed.n], 0);
    ck_assert_int_eq(fibrad_rows_average_part(&raw, bed.r, weight, 71, 70, &whole), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_rows_average_part(&raw, bed.r, weight, 0, bed.n + 1, &whole), FIBRAD_E_ARGUMENT);
    rows_free(&none);
    rows_free(&raw);
    rows_free(&whole);
    free(escaped);
    free(weight);
    bed_free(&bed);
}
END_TEST

/* Points err by their number, and a cutoff opens rows that others close. */
START_TEST(limiting_keeps_reciprocity) {
    struct bed bed = packing(400, .8, 1.2, .58, 7, true);
    double *escaped = calloc(bed.n, sizeof *escaped), *scratch = calloc(bed.n, sizeof *scratch), largest;
    fibrad_rows raw = raw_rows(&bed, (fibrad_beam_rule){.directions = 55, .points = 64}, escaped);
    fibrad_rows out = averaged(&raw, bed.r);
    double above = 0, moved = 0;
    for (uint32_t i = 0; i < out.n; i++) above = fmax(above, sum_of(&out, i) - 1);
    ck_assert_double_gt(above, 1e-6); /* there is something to do */
    fibrad_rows limited = averaged(&raw, bed.r);
    ck_assert_int_eq(fibrad_rows_limit(&limited, scratch), FIBRAD_OK);
    for (uint32_t i = 0; i < out.n; i++) ck_assert_double_le(sum_of(&limited, i), 1 + 1e-14);
    ck_assert_int_eq(fibrad_rows_reciprocity(&limited, bed.r, &largest), FIBRAD_OK);
    ck_assert_double_le(largest, 1e-14);
    for (uint64_t k = 0; k < out.start[out.n]; k++) moved = fmax(moved, 1 - limited.f[k] / out.f[k]);
    ck_assert_double_le(moved, above);
    rows_free(&raw);
    rows_free(&out);
    rows_free(&limited);
    free(escaped);
    free(scratch);
    bed_free(&bed);
}
END_TEST

START_TEST(dropping_keeps_the_books) {
    struct bed bed = packing(400, .7, 1.3, .55, 17, true);
    double *escaped = calloc(bed.n, sizeof *escaped), *scratch = calloc(3 * (size_t)bed.n, sizeof *scratch), largest;
    fibrad_rows raw = raw_rows(&bed, (fibrad_beam_rule){.directions = 233}, escaped);
    double thresholds[] = {0, 1e-3, 1e-2, 2};
    uint64_t last = UINT64_MAX;
    for (int t = 0; t < 4; t++) {
        fibrad_rows rows = averaged(&raw, bed.r), before = averaged(&raw, bed.r);
        rows.capacity = before.capacity; /* 2 entries: room enough for all F_ii */
        ck_assert_int_eq(fibrad_rows_drop(&rows, bed.r, thresholds[t], scratch), FIBRAD_OK);
        ascending(&rows);
        ck_assert_int_eq(fibrad_rows_reciprocity(&rows, bed.r, &largest), FIBRAD_OK);
        ck_assert_double_le(largest, 1e-14);
        for (uint32_t i = 0; i < rows.n; i++) ck_assert_double_eq_tol(sum_of(&rows, i), sum_of(&before, i), 2e-14);
        for (uint64_t k = 0; k < rows.start[rows.n]; k++) ck_assert_double_ge(rows.f[k], 0);
        ck_assert_uint_lt(rows.start[rows.n], last);
        last = rows.start[rows.n];
        if (t == 3) ck_assert_uint_eq(last, bed.n); /* all gone: each row keeps what it had in F_ii */
        rows_free(&rows);
        rows_free(&before);
    }
    rows_free(&raw);
    free(escaped);
    free(scratch);
    bed_free(&bed);
}
END_TEST

/* A threshold that equals an entry: both of a pair must go, or neither. */
START_TEST(dropping_at_the_threshold) {
    for (uint64_t k = 0; k < 2000; k++) {
        double r[2] = {.1 + bed_make_random(9, 3 * k), .1 + bed_make_random(9, 3 * k + 1)}, scratch[6], largest;
        double f = .01 * bed_make_random(9, 3 * k + 2), back = r[0] / r[1] * (r[0] / r[1]) * f;
        fibrad_rows rows = {2, 4, (uint64_t[]){0, 1, 2}, (uint32_t[]){1, 0, 0, 0}, (double[]){f, back, 0, 0}};
        ck_assert_int_eq(fibrad_rows_drop(&rows, r, k % 2 == 0 ? f : back, scratch), FIBRAD_OK);
        ck_assert_int_eq(fibrad_rows_reciprocity(&rows, r, &largest), FIBRAD_OK);
        ck_assert_double_le(largest, 1e-14);
    }
}
END_TEST

/* A star: what its centre gives away cannot be given back to the leaves by any scaling. */
START_TEST(dropping_where_no_scaling_exists) {
    double r[] = {1, 1, 1, 1}, scratch[12];
    fibrad_rows rows = rows_of(4, 12);
    static const uint64_t start[] = {0, 2, 5, 7, 8};
    static const uint32_t col[] = {1, 2, 0, 2, 3, 0, 1, 1};
    static const double f[] = {.3, .001, .3, .2, .1, .001, .2, .1};
    memcpy(rows.start, start, sizeof start);
    memcpy(rows.col, col, sizeof col);
    memcpy(rows.f, f, sizeof f);
    double sum[4], largest;
    for (uint32_t i = 0; i < 4; i++) sum[i] = sum_of(&rows, i);
    ck_assert_int_eq(fibrad_rows_drop(&rows, r, .01, scratch), FIBRAD_OK);
    ascending(&rows);
    for (uint32_t i = 0; i < 4; i++) ck_assert_double_eq_tol(sum_of(&rows, i), sum[i], 1e-14);
    ck_assert_int_eq(fibrad_rows_reciprocity(&rows, r, &largest), FIBRAD_OK);
    ck_assert_double_le(largest, 1e-14);
    rows_free(&rows);
}
END_TEST

/* Pairs of which one factor is missing, on either side of the diagonal: it counts in full. */
START_TEST(lone_factors_are_not_reciprocal) {
    double r[] = {1, 2, 1}, f[] = {.5, .2, .05, .125}, largest = -1;
    uint64_t above[] = {0, 2, 3, 3}, below[] = {0, 1, 2, 3};
    fibrad_rows lone_above = {3, 4, above, (uint32_t[]){1, 2, 0}, (double[]){.2, .3, .05}};
    fibrad_rows lone_below = {3, 4, below, (uint32_t[]){1, 0, 1}, (double[]){.2, .05, .4}};
    fibrad_rows diagonal = {3, 4, (uint64_t[]){0, 2, 4, 4}, (uint32_t[]){0, 1, 0, 1}, f};
    ck_assert_int_eq(fibrad_rows_reciprocity(&lone_above, r, &largest), FIBRAD_OK);
    ck_assert_double_eq_tol(largest, .3, 1e-16); /* F_02 */
    ck_assert_int_eq(fibrad_rows_reciprocity(&lone_below, r, &largest), FIBRAD_OK);
    ck_assert_double_eq_tol(largest, .1, 1e-16); /* F_21, a quarter of it by area */
    ck_assert_int_eq(fibrad_rows_reciprocity(&diagonal, r, &largest), FIBRAD_OK);
    ck_assert_double_eq(largest, 0);
}
END_TEST

START_TEST(bad_rows_are_refused) {
    double r[] = {1, 1}, bad_r[] = {1, 0}, scratch[6], largest;
    uint32_t col[] = {1, 0}, descending[] = {1, 1}, outside[] = {2, 0};
    double f[] = {.1, .1};
    uint64_t start[] = {0, 1, 2}, falling[] = {0, 2, 1}, one_row[] = {0, 2, 2};
    fibrad_rows good = {2, 2, start, col, f}, out = rows_of(2, 4);
    ck_assert_int_eq(fibrad_rows_average(&good, r, &out), FIBRAD_OK);
    fibrad_rows bad[] = {{0, 2, start, col, f},     {2, 1, start, col, f},          {2, 2, falling, col, f},
                         {2, 2, start, outside, f}, {2, 2, one_row, descending, f}, {2, 2, NULL, col, f},
                         {2, 2, start, NULL, f}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        ck_assert_int_eq(fibrad_rows_average(&bad[k], r, &out), FIBRAD_E_ARGUMENT);
        ck_assert_int_eq(fibrad_rows_limit(&bad[k], scratch), FIBRAD_E_ARGUMENT);
        ck_assert_int_eq(fibrad_rows_drop(&bad[k], r, .1, scratch), FIBRAD_E_ARGUMENT);
        ck_assert_int_eq(fibrad_rows_reciprocity(&bad[k], r, &largest), FIBRAD_E_ARGUMENT);
    }
    ck_assert_int_eq(fibrad_rows_average(&good, bad_r, &out), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_rows_average(&good, NULL, &out), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_rows_average(&good, r, &good), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_rows_limit(&good, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_rows_drop(&good, r, NAN, scratch), FIBRAD_E_ARGUMENT);
    rows_free(&out);
}
END_TEST

int main(void) {
    Suite *suite = suite_create("rows");
    TCase *tcase = suite_case(suite, "rows");
    tcase_add_test(tcase, averaging_makes_rows_reciprocal);
    tcase_add_test(tcase, averaging_by_hand);
    tcase_add_test(tcase, averaging_entry_by_entry);
    tcase_add_test(tcase, averaging_with_weights);
    tcase_add_test(tcase, averaging_in_parts);
    tcase_add_test(tcase, limiting_keeps_reciprocity);
    tcase_add_test(tcase, dropping_keeps_the_books);
    tcase_add_test(tcase, dropping_at_the_threshold);
    tcase_add_test(tcase, dropping_where_no_scaling_exists);
    tcase_add_test(tcase, lone_factors_are_not_reciprocal);
    tcase_add_test(tcase, bad_rows_are_refused);
    return suite_run(suite);
}
