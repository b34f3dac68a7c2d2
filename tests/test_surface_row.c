/* test_surface_row.c - rows by the surface method against ray-by-ray sums and against beams.
 * SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "bed/packing.h"
#include "fibrad.h"
#include "suite.h"
#include "surface_plain.h"

#define CUTOFF 6.0
#define MOST   4096 /* entries of a row, near spheres */

static struct bed bed;
static fibrad_scene *scene;
static fibrad_work *work;
static void *scene_block, *work_block;
static uint32_t col[MOST];
static double f[MOST];

static void *block(size_t size) {
    void *memory = aligned_alloc(64, (size + 63) / 64 * 64);
    ck_assert_ptr_nonnull(memory);
    return memory;
}

static void make_scene(int isa, bool periodic) {
    fibrad_scene_config config = {.spheres = bed.n, .isa = isa};
    for (int axis = 0; axis < 3; axis++) config.period[axis] = periodic ? bed.period[axis] : 0;
    const fibrad_spheres spheres = {bed.x, bed.y, bed.z, bed.r, bed.n};
    const size_t size = fibrad_scene_size(&config);
    free(scene_block);
    scene_block = block(size);
    ck_assert_int_eq(fibrad_scene_init(&scene, scene_block, size, &config, &spheres, NULL), FIBRAD_OK);
}

static void make_work(const fibrad_work_config *config) {
    const size_t size = fibrad_work_size(config);
    free(work_block);
    work_block = block(size);
    ck_assert_int_eq(fibrad_work_init(&work, work_block, size, config), FIBRAD_OK);
}

/* A random bed of n spheres. */
static void make(uint32_t n, bool periodic) {
    bed_free(&bed);
    bed_init(&bed, false, 0);
    ck_assert_int_eq(bed_make_packing(&bed, n, .8, 1.2, .55, 1), 0);
    make_scene(FIBRAD_ISA_BEST, periodic);
    make_work(&(fibrad_work_config){.near = MOST});
}

static fibrad_row row_of(uint32_t i, const fibrad_surface_rule *rule) {
    fibrad_row row = {.col = col, .f = f, .capacity = MOST};
    ck_assert_int_eq(fibrad_surface_row(scene, work, i, rule, &row), FIBRAD_OK);
    return row;
}

static double entry(const fibrad_row *row, uint32_t j) {
    for (uint32_t k = 0; k < row->length; k++)
        if (row->col[k] == j) return row->f[k];
    return 0;
}

/* F from i to j, both at their own places, ray by ray, in the frame that fibrad.h tells. */
static double plain(uint32_t i, uint32_t j, uint32_t nodes) {
    const uint32_t one = i < j ? i : j, two = i < j ? j : i;
    const double c1[3] = {bed.x[one], bed.y[one], bed.z[one]};
    double w[3] = {bed.x[two] - c1[0], bed.y[two] - c1[1], bed.z[two] - c1[2]};
    const double d = sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    int least = 0;
    for (int axis = 0; axis < 3; axis++) {
        w[axis] /= d;
        if (fabs(w[axis]) < fabs(w[least])) least = axis;
    }
    const double a[3] = {least == 0, least == 1, least == 2};
    double u[3] = {a[1] * w[2] - a[2] * w[1], a[2] * w[0] - a[0] * w[2], a[0] * w[1] - a[1] * w[0]};
    const double ring = sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
    for (int axis = 0; axis < 3; axis++) u[axis] /= ring;
    const double v[3] = {w[1] * u[2] - w[2] * u[1], w[2] * u[0] - w[0] * u[2], w[0] * u[1] - w[1] * u[0]};

    static double x[MOST], y[MOST], z[MOST], r[MOST];
    fibrad_spheres obstacles = {x, y, z, r, 0};
    for (uint32_t k = 0; k < bed.n; k++) {
        const double from_i[3] = {bed.x[k] - bed.x[i], bed.y[k] - bed.y[i], bed.z[k] - bed.z[i]};
        const double e[3] = {bed.x[k] - c1[0], bed.y[k] - c1[1], bed.z[k] - c1[2]};
        if (k == i || k == j) continue;
        if (from_i[0] * from_i[0] + from_i[1] * from_i[1] + from_i[2] * from_i[2] > CUTOFF * CUTOFF) continue;
        const uint32_t n = obstacles.n++;
        x[n] = e[0] * u[0] + e[1] * u[1] + e[2] * u[2];
        y[n] = e[0] * v[0] + e[1] * v[1] + e[2] * v[2];
        z[n] = e[0] * w[0] + e[1] * w[1] + e[2] * w[2];
        r[n] = bed.r[k];
    }
    const double r1 = bed.r[one], r2 = bed.r[two], ratio = one == i ? 1 : r1 * r1 / (r2 * r2);
    double unblocked, blocked, exact;
    surface_plain(r1, r2, d - r1 - r2, &obstacles, nodes, &unblocked, &blocked);
    ck_assert_int_eq(fibrad_pair_exact(r1, r2, d - r1 - r2, &exact), FIBRAD_OK);
    return ratio * (blocked / unblocked * exact);
}

START_TEST(equals_plain_sums) {
    make(150, false);
    uint32_t entries = 0;
    for (uint32_t i = 0; i < bed.n; i += 10) {
        const fibrad_row row = row_of(i, &(fibrad_surface_rule){.nodes = 34, .cutoff = CUTOFF});
        for (uint32_t j = 0; j < bed.n; j++) {
            const double e[3] = {bed.x[j] - bed.x[i], bed.y[j] - bed.y[i], bed.z[j] - bed.z[i]};
            const bool within = j != i && e[0] * e[0] + e[1] * e[1] + e[2] * e[2] <= CUTOFF * CUTOFF;
            ck_assert_double_eq_tol(entry(&row, j), within ? plain(i, j, 34) : 0, 1e-12);
        }
        entries += row.length;
    }
    ck_assert_uint_gt(entries, 300);
}
END_TEST

START_TEST(skips_and_instruction_sets_change_no_bit) {
    static uint32_t col_first[MOST];
    static double f_first[MOST];
    for (int periodic = 0; periodic < 2; periodic++) {
        make(200, periodic);
        for (uint32_t i = 0; i < bed.n; i += 20) {
            fibrad_surface_rule rule = {.cutoff = CUTOFF};
            make_scene(FIBRAD_ISA_SCALAR, periodic);
            const fibrad_row first = row_of(i, &rule);
            memcpy(col_first, col, first.length * sizeof *col);
            memcpy(f_first, f, first.length * sizeof *f);
            for (int isa = FIBRAD_ISA_SCALAR; isa <= (int)fibrad_isa_best(); isa++) {
                make_scene(isa, periodic);
                for (uint32_t skip = 2; skip <= 32; skip *= 2) {
                    rule.flags = skip < 32 ? skip : 30;
                    const fibrad_row row = row_of(i, &rule);
                    ck_assert_uint_eq(row.length, first.length);
                    ck_assert(memcmp(col, col_first, row.length * sizeof *col) == 0);
                    ck_assert(memcmp(f, f_first, row.length * sizeof *f) == 0);
                }
            }
        }
    }
}
END_TEST

/* The rows of both methods are as far apart as the estimate of the surface method says, which is the coarser one. */
START_TEST(agrees_with_beams) {
    make(300, true);
    static uint32_t beam_col[MOST];
    static double beam_f[MOST];
    double difference = 0, estimate = 0;
    for (uint32_t i = 0; i < bed.n; i += 5) {
        const fibrad_row row = row_of(i, &(fibrad_surface_rule){.cutoff = CUTOFF});
        fibrad_row beam = {.col = beam_col, .f = beam_f, .capacity = MOST};
        const fibrad_beam_rule rule = {.directions = 2000, .cutoff = CUTOFF};
        ck_assert_int_eq(fibrad_beam_row(scene, work, i, &rule, &beam), FIBRAD_OK);
        for (uint32_t j = 0; j < bed.n; j++) {
            const double e = entry(&row, j) - entry(&beam, j);
            difference += e * e;
        }
        estimate += row.error * row.error;
    }
    ck_assert_double_lt(sqrt(difference / estimate), 1.5);
    ck_assert_double_gt(sqrt(difference / estimate), 0.5);
}
END_TEST

START_TEST(reciprocal_without_cutoff) {
    make(60, false);
    static double all[60][60];
    for (uint32_t i = 0; i < bed.n; i++) {
        const fibrad_row row = row_of(i, NULL);
        double sum = row.escaped;
        for (uint32_t j = 0; j < bed.n; j++) sum += all[i][j] = entry(&row, j);
        ck_assert_double_eq_tol(sum, 1, 1e-14);
    }
    for (uint32_t i = 0; i < bed.n; i++)
        for (uint32_t j = 0; j < i; j++) {
            const double there = all[i][j] * bed.r[i] * bed.r[i], back = all[j][i] * bed.r[j] * bed.r[j];
            ck_assert_double_le(fabs(there - back), 1e-15 * there);
        }
}
END_TEST

START_TEST(tells_what_it_needs) {
    make(200, true);
    const fibrad_surface_rule rule = {.cutoff = CUTOFF};
    const fibrad_row enough = row_of(0, &rule);
    make_work(&(fibrad_work_config){.near = 16, .entries = 4});
    fibrad_row row = {.col = col, .f = f, .capacity = MOST};
    int tries = 0;
    for (; fibrad_surface_row(scene, work, 0, &rule, &row) == FIBRAD_E_CAPACITY; tries++) {
        ck_assert_uint_eq(row.length, 0);
        fibrad_work_config needed;
        fibrad_work_needed(work, &needed);
        make_work(&needed);
    }
    ck_assert_int_eq(tries, 2);
    ck_assert_uint_eq(row.length, enough.length);
    row.capacity = 3;
    ck_assert_int_eq(fibrad_surface_row(scene, work, 0, &rule, &row), FIBRAD_E_CAPACITY);
    ck_assert_uint_eq(row.length, enough.length);
}
END_TEST

/* Three periods each way: 7^3 images in the cube. A hundred and more are refused, as is what would need more memory
 * than can be had. */
START_TEST(bounds_the_search_for_images) {
    make(60, true);
    const double period = bed.period[0];
    fibrad_row row = {.col = col, .f = f, .capacity = MOST};
    const struct {
        double periods;
        int status;
    } cases[] = {{3, FIBRAD_E_CAPACITY}, {100, FIBRAD_E_ARGUMENT}, {101, FIBRAD_E_ARGUMENT}, {1e9, FIBRAD_E_ARGUMENT}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++)
        ck_assert_int_eq(
            fibrad_surface_row(scene, work, 0, &(fibrad_surface_rule){.cutoff = cases[k].periods * period}, &row),
            cases[k].status);

    /* one sphere and its images are few enough, at 100 periods still */
    bed.n = 1;
    make_scene(FIBRAD_ISA_BEST, true);
    const fibrad_surface_rule most = {.cutoff = 100 * period}, more = {.cutoff = 100.001 * period};
    ck_assert_int_eq(fibrad_surface_row(scene, work, 0, &most, &row), FIBRAD_E_CAPACITY);
    fibrad_work_config needed;
    fibrad_work_needed(work, &needed);
    ck_assert_double_eq_tol(needed.near, 4. / 3 * 3.14159265358979 * 1e6, 3e4);
    ck_assert_int_eq(fibrad_surface_row(scene, work, 0, &more, &row), FIBRAD_E_ARGUMENT);
}
END_TEST

START_TEST(refuses_what_is_wrong) {
    make(20, true);
    fibrad_row row = {.col = col, .f = f, .capacity = MOST};
    const fibrad_surface_rule good = {.cutoff = CUTOFF}, many = {.nodes = 54, .cutoff = CUTOFF},
                              negative = {.cutoff = -1};
    const fibrad_surface_rule flags = {.flags = 64, .cutoff = CUTOFF};
    ck_assert_int_eq(fibrad_surface_row(NULL, work, 0, &good, &row), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_surface_row(scene, NULL, 0, &good, &row), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_surface_row(scene, work, 20, &good, &row), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_surface_row(scene, work, 0, &good, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_surface_row(scene, work, 0, NULL, &row), FIBRAD_E_ARGUMENT); /* periodic, no cutoff */
    ck_assert_int_eq(fibrad_surface_row(scene, work, 0, &negative, &row), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_surface_row(scene, work, 0, &flags, &row), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_surface_row(scene, work, 0, &many, &row), FIBRAD_E_TABLE);
}
END_TEST

int main(void) {
    Suite *suite = suite_create("surface row");
    TCase *cases = suite_case(suite, "surface row");
    tcase_add_test(cases, equals_plain_sums);
    tcase_add_test(cases, skips_and_instruction_sets_change_no_bit);
    tcase_add_test(cases, agrees_with_beams);
    tcase_add_test(cases, reciprocal_without_cutoff);
    tcase_add_test(cases, tells_what_it_needs);
    tcase_add_test(cases, bounds_the_search_for_images);
    tcase_add_test(cases, refuses_what_is_wrong);
    return suite_run(suite);
}
