/* test_exchange.c - exchange factors and their reach against view factors, radiosity solved by hand, closed forms,
 * plain paths, and the books. SPDX-License-Identifier: MIT */
#include <stdio.h>

#include "base/elementary.h"
#include "exchange/paths.h"
#include "scenes.h"
#include "suite.h"

#define PI 3.14159265358979323846

static fibrad_tracer *tracer_of(const fibrad_scene *scene) {
    size_t size = fibrad_tracer_size(NULL);
    fibrad_tracer *tracer = NULL;
    ck_assert_int_eq(fibrad_tracer_init(&tracer, block_of(size), size, NULL, scene), FIBRAD_OK);
    return tracer;
}

static fibrad_scene *scene_within(const struct bed *bed, const fibrad_walls *walls, int isa) {
    fibrad_scene_config config = {.spheres = bed->n, .isa = isa, .walls = *walls};
    memcpy(config.period, bed->period, sizeof config.period);
    size_t size = fibrad_scene_size(&config);
    fibrad_spheres spheres = {bed->x, bed->y, bed->z, bed->r, bed->n};
    fibrad_scene *scene = NULL;
    ck_assert_int_eq(fibrad_scene_init(&scene, block_of(size), size, &config, &spheres, NULL), FIBRAD_OK);
    return scene;
}

static fibrad_row exchange_in(const fibrad_scene *scene, uint32_t n, uint32_t i, const fibrad_exchange_rule *rule) {
    fibrad_work *work = work_of(&(fibrad_work_config){.entries = n});
    fibrad_tracer *tracer = tracer_of(scene);
    fibrad_row row = row_of(n);
    ck_assert_int_eq(fibrad_exchange_row(tracer, work, i, rule, &row, NULL), FIBRAD_OK);
    free(work);
    free(tracer);
    return row;
}

static double *constant(uint32_t n, double value) {
    double *e = calloc(n, sizeof *e);
    for (uint32_t i = 0; i < n; i++) e[i] = value;
    return e;
}

static double whole(const fibrad_row *row) {
    double sum = row_sum(row) + row->escaped;
    for (int wall = 0; wall < FIBRAD_WALLS; wall++) sum += row->wall[wall];
    return sum;
}

/* Black spheres: exchange factors are view factors, to the bit. */
START_TEST(black_is_the_beam_row) {
    struct bed bed = packing(200, .5, 1, .5, 1, true);
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    double *e = constant(bed.n, 1);
    fibrad_work *work = work_of(NULL);
    for (uint32_t i = 0; i < bed.n; i += 40) {
        fibrad_row row = exchange_in(scene, bed.n, i, &(fibrad_exchange_rule){.emissivity = e, .directions = 233});
        fibrad_row beam = row_of(bed.n);
        ck_assert_int_eq(fibrad_beam_row(scene, work, i, NULL, &beam), FIBRAD_OK);
        ck_assert_uint_eq(row.length, beam.length);
        for (uint32_t k = 0; k < row.length; k++) {
            ck_assert_uint_eq(row.col[k], beam.col[k]);
            ck_assert_double_eq_tol(row.f[k], beam.f[k], 1e-16);
        }
        ck_assert_double_eq(row.escaped, beam.escaped);
        ck_assert_uint_eq(row.directions, 233);
        row_free(&row);
        row_free(&beam);
    }
    free(work);
    free(e);
    free(scene);
    bed_free(&bed);
}
END_TEST

/* A sphere alone sees nothing; two far apart exchange e F e' of what the first emits, and 1 - e' of F goes on its way.
 */
START_TEST(one_and_two_spheres) {
    const double e[2] = {.3, .6};
    struct bed bed = bed_of(2, (const double[][4]){{0, 0, 0, 1}, {30, 0, 0, 2}});
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    double exact;
    ck_assert_int_eq(fibrad_pair_exact(1, 2, 27, &exact), FIBRAD_OK);
    fibrad_row row =
        exchange_in(scene, 2, 0, &(fibrad_exchange_rule){.emissivity = e, .directions = 65536, .paths = 4000});
    ck_assert_double_eq_tol(row_factor(&row, 1), .6 * exact, .01 * exact); /* twice reflected: 1e-3 of it */
    ck_assert_double_eq_tol(whole(&row), 1, 1e-12);
    ck_assert_double_eq_tol(row.escaped, 1 - .6 * exact, .002 * exact);
    row_free(&row);
    free(scene);
    bed_free(&bed);
}
END_TEST

/* Two so far apart that hardly a path meets the other: rows end, closed, and say how much is not known. */
START_TEST(hardly_seen) {
    const double e[2] = {.3, .6};
    struct bed bed = bed_of(2, (const double[][4]){{0, 0, 0, 1}, {1e4, 0, 0, 1}});
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    for (int tolerance = 0; tolerance <= 1; tolerance++) {
        fibrad_row row = exchange_in(scene, 2, 0, &(fibrad_exchange_rule){.emissivity = e, .error = tolerance * 1e-3});
        ck_assert_double_eq_tol(whole(&row), 1, 1e-12);
        ck_assert_double_le(row.error, 1e-3);
        row_free(&row);
    }
    free(scene);
    bed_free(&bed);
}
END_TEST

/* A sphere in a much larger closed box of grey walls: it is met again by what they reflect. Walls and sphere then
 * nearly form an enclosure of two: of what the sphere emits it gets back, by the balance of two grey surfaces with F_12
 * = 1 and F_21 = A_1/A_2,  D_11 = (1 - e_2) F_21 e_1/(1 - (1 - e_2)(1 - F_21) - (1 - e_2) F_21 (1 - e_1)). */
START_TEST(sphere_in_a_grey_box) {
    struct bed bed = bed_of(1, (const double[][4]){{.1, -.2, .3, 1}});
    const fibrad_walls walls = {.planes = 63, .at = {-4, 4, -4, 4, -4, 4}};
    const double e[1] = {.4};
    fibrad_scene *scene = scene_within(&bed, &walls, FIBRAD_ISA_BEST);
    fibrad_exchange_rule rule = {.emissivity = e, .directions = 1000, .paths = 400000};
    for (int wall = 0; wall < 6; wall++) rule.wall_emissivity[wall] = .1;
    fibrad_row row = exchange_in(scene, 1, 0, &rule);
    double back = 4 * PI / (6 * 64), gap = .9 * back;
    ck_assert_double_eq_tol(row_factor(&row, 0), gap * .4 / (1 - .9 * (1 - back) - gap * .6), .02 * .105);
    ck_assert_double_eq_tol(whole(&row), 1, 1e-12);
    ck_assert_double_eq_tol(row.escaped, 0, 1e-13);
    row_free(&row);
    /* walls that reflect all: the sphere gets back all it emits */
    for (int wall = 0; wall < 6; wall++) rule.wall_emissivity[wall] = 0;
    rule.paths = 200;
    row = exchange_in(scene, 1, 0, &rule);
    ck_assert_double_eq_tol(row_factor(&row, 0), 1, 1e-13);
    row_free(&row);
    free(scene);
    bed_free(&bed);
}
END_TEST

/* Paths by other means: absorbed as a whole where a random number says so, ray by ray in the bed itself. */
static void plain(const struct bed *bed, const double *e, uint32_t i, uint32_t paths, double *d) {
    fibrad_scene *scene = scene_of(bed, FIBRAD_ISA_SCALAR);
    fibrad_random random = fibrad_random_start(99, i);
    for (uint32_t k = 0; k < paths; k++) {
        double o[3] = {bed->x[i], bed->y[i], bed->z[i]}, n[3], w[3], cosine, sine;
        double z = 1 - 2 * fibrad_random_next(&random), ring = sqrt(1 - z * z), radius = bed->r[i];
        fibrad_sincos_turn(fibrad_random_next(&random), &sine, &cosine);
        n[0] = ring * cosine, n[1] = ring * sine, n[2] = z;
        for (;;) { /* a direction by the cosine law in the normal's own frame */
            double square = fibrad_random_next(&random), a[3], b[3];
            fibrad_sincos_turn(fibrad_random_next(&random), &sine, &cosine);
            double side = 1 / sqrt(n[0] * n[0] + n[1] * n[1] + 1e-300);
            a[0] = -n[1] * side, a[1] = n[0] * side, a[2] = 0;
            b[0] = n[1] * a[2] - n[2] * a[1], b[1] = n[2] * a[0] - n[0] * a[2], b[2] = n[0] * a[1] - n[1] * a[0];
            double start[3];
            for (int axis = 0; axis < 3; axis++) {
                w[axis] = sqrt(square) * (cosine * a[axis] + sine * b[axis]) + sqrt(1 - square) * n[axis];
                start[axis] = o[axis] + radius * (1 + 1e-12) * n[axis];
            }
            fibrad_hit hit;
            fibrad_trace_point_scalar(scene, start, w, &hit);
            if (hit.sphere == FIBRAD_NONE) break;
            uint32_t j = scene->order[hit.sphere];
            if (fibrad_random_next(&random) < e[j]) {
                d[j] += 1.0 / paths;
                break;
            }
            for (int axis = 0; axis < 3; axis++) o[axis] = start[axis] + hit.centre[axis];
            radius = bed->r[j];
            memcpy(n, hit.normal, sizeof n);
        }
    }
    free(scene);
}

/* Unequal spheres of unequal emissivities against plain paths: entry by entry within the noise of these. */
START_TEST(against_plain_paths) {
    enum { PATHS = 200000 };
    struct bed bed = packing(60, .4, 1, .45, 8, _i == 0);
    double *e = calloc(bed.n, sizeof *e), *d = calloc(bed.n, sizeof *d);
    for (uint32_t i = 0; i < bed.n; i++) e[i] = .1 + .85 * bed_make_random(4, i);
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    fibrad_row row =
        exchange_in(scene, bed.n, 5, &(fibrad_exchange_rule){.emissivity = e, .directions = 2000, .paths = PATHS});
    plain(&bed, e, 5, PATHS, d);
    double square = 0, noise = 0;
    for (uint32_t j = 0; j < bed.n; j++) {
        double sigma = sqrt(d[j] / PATHS + 1e-9);
        ck_assert_double_lt(fabs(row_factor(&row, j) - d[j]), 5 * sigma);
        square += pow(row_factor(&row, j) - d[j], 2);
        noise += sigma * sigma;
    }
    ck_assert_double_lt(square, 2 * noise);
    ck_assert_double_eq_tol(whole(&row), 1, 1e-12);
    row_free(&row);
    free(scene);
    free(e);
    free(d);
    bed_free(&bed);
}
END_TEST

/* The error falls as stated and is estimated honestly. */
START_TEST(error_and_its_estimate) {
    struct bed bed = packing(300, 1, 1, .55, 3, true);
    double *e = constant(bed.n, .5);
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    double error = 0, estimate = 0, tight = 0;
    for (uint32_t i = 0; i < bed.n; i += 30) {
        fibrad_row truth = exchange_in(
            scene, bed.n, i, &(fibrad_exchange_rule){.emissivity = e, .directions = 2000, .paths = 60000, .seed = 1});
        fibrad_row row = exchange_in(scene, bed.n, i, &(fibrad_exchange_rule){.emissivity = e});
        fibrad_row fine = exchange_in(scene, bed.n, i, &(fibrad_exchange_rule){.emissivity = e, .error = .005});
        error += pow(row_distance(&row, &truth), 2) / 10;
        estimate += row.error * row.error / 10;
        tight += pow(row_distance(&fine, &truth), 2) / 10;
        ck_assert_double_le(fine.error, .005);
        row_free(&truth);
        row_free(&row);
        row_free(&fine);
    }
    ck_assert_double_lt(error, estimate);
    ck_assert_double_gt(error, estimate / 9);
    ck_assert_double_lt(sqrt(tight), .005);
    ck_assert_double_gt(sqrt(tight), .001);
    free(e);
    free(scene);
    bed_free(&bed);
}
END_TEST

/* Row i in any instruction set, after any other row, with any number of lists: the same bits. */
START_TEST(same_bits_always) {
    struct bed bed = packing(150, .3, 1, .5, 6, false);
    const fibrad_walls walls = {.planes = 3, .at = {bed.x[0] - 50, bed.x[0] + 50}};
    double *e = calloc(bed.n, sizeof *e);
    for (uint32_t i = 0; i < bed.n; i++) e[i] = .2 + .8 * bed_make_random(1, i);
    const fibrad_exchange_rule rule = {.emissivity = e, .wall_emissivity = {.5, .5}};
    fibrad_scene *scene = scene_within(&bed, &walls, FIBRAD_ISA_SCALAR);
    fibrad_row row = exchange_in(scene, bed.n, 70, &rule);
    fibrad_spread spread = {0};
    fibrad_tracer *tracer = tracer_of(scene);
    ck_assert_int_eq(fibrad_exchange_spread(tracer, 70, &rule, &spread), FIBRAD_OK);
    free(tracer);
    for (int isa = FIBRAD_ISA_SSE2; isa <= (int)fibrad_isa_best(); isa++) {
        fibrad_scene *other = scene_within(&bed, &walls, isa);
        fibrad_work *work = work_of(NULL);
        size_t size = fibrad_tracer_size(&(fibrad_tracer_config){.lists = 2});
        ck_assert_int_eq(fibrad_tracer_init(&tracer, block_of(size), size, &(fibrad_tracer_config){.lists = 2}, other),
                         FIBRAD_OK);
        fibrad_row again = row_of(bed.n);
        for (uint32_t i = 71; i-- > 68;) {
            again.length = 0;
            ck_assert_int_eq(fibrad_exchange_row(tracer, work, i, &rule, &again, NULL), FIBRAD_OK);
            if (i == 70) ck_assert(same_bits(&row, &again));
        }
        fibrad_spread repeated = {0};
        ck_assert_int_eq(fibrad_exchange_spread(tracer, 70, &rule, &repeated), FIBRAD_OK);
        ck_assert_mem_eq(&spread, &repeated, sizeof spread);
        row_free(&again);
        free(tracer);
        free(work);
        free(other);
    }
    row_free(&row);
    free(e);
    free(scene);
    bed_free(&bed);
}
END_TEST

/* F_E of a lattice of unit spheres. */
static double factor(const struct bed *bed, double solid, double emissivity, uint32_t paths) {
    double *e = constant(bed->n, emissivity), square = 0;
    fibrad_scene *scene = scene_of(bed, FIBRAD_ISA_BEST);
    fibrad_tracer *tracer = tracer_of(scene);
    for (uint32_t i = 0; i < bed->n; i++) {
        fibrad_spread spread;
        ck_assert_int_eq(
            fibrad_exchange_spread(tracer, i, &(fibrad_exchange_rule){.emissivity = e, .paths = paths}, &spread),
            FIBRAD_OK);
        for (int axis = 0; axis < 3; axis++) square += spread.square[axis] / 3 / bed->n;
        ck_assert_double_eq_tol(spread.absorbed, 1, .05);
    }
    free(e);
    free(scene);
    free(tracer);
    return 3 * solid * emissivity * square / 4;
}

/* Body- and face-centred lattices, two emissivities, against values from other programs (DESIGN: to 1-2 %). */
START_TEST(conductivity_of_lattices) {
    const double b = 4 / sqrt(3), f = 2 * sqrt(2);
    struct bed centred = bed_of(2, (const double[][4]){{0, 0, 0, 1}, {b / 2, b / 2, b / 2, 1}});
    struct bed faces =
        bed_of(4, (const double[][4]){{0, 0, 0, 1}, {f / 2, f / 2, 0, 1}, {0, f / 2, f / 2, 1}, {f / 2, 0, f / 2, 1}});
    for (int axis = 0; axis < 3; axis++) centred.period[axis] = b, faces.period[axis] = f;
    ck_assert_double_eq_tol(factor(&centred, PI * sqrt(3) / 8, .4, 60000), .336, .02 * .336);
    ck_assert_double_eq_tol(factor(&centred, PI * sqrt(3) / 8, 1, 60000), .916, .02 * .916);
    ck_assert_double_eq_tol(factor(&faces, PI * sqrt(2) / 6, .4, 30000), .299, .02 * .299);
    ck_assert_double_eq_tol(factor(&faces, PI * sqrt(2) / 6, 1, 30000), .875, .02 * .875);
    bed_free(&centred);
    bed_free(&faces);
}
END_TEST

/* In a chain of two spheres a period the one emits to the other: the spread counts periods and takes the nearest image
 * as it is met. Contact factors to both sides: mean square 2 F 2^2 along the chain when all is absorbed at once. */
START_TEST(spread_of_a_chain) {
    struct bed bed = bed_of(2, (const double[][4]){{0, 0, 0, 1}, {2, 0, 0, 1}});
    bed.period[0] = 4;
    double *e = constant(2, 1), exact;
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    fibrad_tracer *tracer = tracer_of(scene);
    fibrad_spread spread;
    const fibrad_exchange_rule rule = {.emissivity = e, .paths = 400000};
    ck_assert_int_eq(fibrad_pair_exact(1, 1, 0, &exact), FIBRAD_OK);
    ck_assert_int_eq(fibrad_exchange_spread(tracer, 1, &rule, &spread), FIBRAD_OK);
    /* beyond the neighbours, which hide nearly all: little */
    ck_assert_double_gt(spread.absorbed, 2 * exact - .001);
    ck_assert_double_lt(spread.absorbed, 2 * exact + .02);
    ck_assert_double_gt(spread.square[0], 8 * exact - .01);
    ck_assert_double_lt(spread.square[0], 8 * exact + .6);
    ck_assert_double_eq(spread.square[1], 0);
    ck_assert_double_eq(spread.square[2], 0);
    ck_assert_uint_eq(spread.rays, 400000);
    free(e);
    free(scene);
    free(tracer);
    bed_free(&bed);
}
END_TEST

/* Rows of a whole bed, averaged with areas A e and balanced: reciprocal and closed; dropping keeps the books. */
START_TEST(rows_keep_the_books) {
    struct bed bed = packing(120, .5, 1, .5, 12, true);
    const uint32_t n = bed.n;
    double *e = calloc(n, sizeof *e), *radius = calloc(n, sizeof *radius), *target = calloc(n, sizeof *target);
    double *scratch = calloc(3 * n, sizeof *scratch), largest;
    fibrad_rows raw = {.n = n, .capacity = (uint64_t)n * n}, rows = {.n = n, .capacity = (uint64_t)n * (2 * n + 1)};
    fibrad_rows *both[2] = {&raw, &rows};
    for (int k = 0; k < 2; k++) {
        both[k]->start = calloc(n + 1, sizeof(uint64_t));
        both[k]->col = calloc(both[k]->capacity, sizeof(uint32_t));
        both[k]->f = calloc(both[k]->capacity, sizeof(double));
    }
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    for (uint32_t i = 0; i < n; i++) e[i] = .2 + .8 * bed_make_random(2, i), radius[i] = bed.r[i] * sqrt(e[i]);
    for (uint32_t i = 0; i < n; i++) {
        fibrad_row row = exchange_in(scene, n, i, &(fibrad_exchange_rule){.emissivity = e, .paths = 200});
        memcpy(raw.col + raw.start[i], row.col, row.length * sizeof *row.col);
        memcpy(raw.f + raw.start[i], row.f, row.length * sizeof *row.f);
        raw.start[i + 1] = raw.start[i] + row.length;
        target[i] = row_sum(&row);
        ck_assert_double_eq_tol(target[i] + row.escaped, 1, 1e-13);
        row_free(&row);
    }
    ck_assert_int_eq(fibrad_rows_average(&raw, radius, &rows), FIBRAD_OK);
    double off = 0;
    for (uint32_t i = 0; i < n; i++) {
        double sum = 0;
        for (uint64_t k = rows.start[i]; k < rows.start[i + 1]; k++) sum += rows.f[k];
        off = fmax(off, fabs(sum - target[i]));
    }
    ck_assert_double_gt(off, 1e-4); /* there is something to balance */
    ck_assert_int_eq(fibrad_rows_balance(&rows, target, scratch), FIBRAD_OK);
    for (int drop = 0; drop <= 1; drop++) {
        if (drop) ck_assert_int_eq(fibrad_rows_drop(&rows, radius, .003, scratch), FIBRAD_OK);
        for (uint32_t i = 0; i < n; i++) {
            double sum = 0;
            for (uint64_t k = rows.start[i]; k < rows.start[i + 1]; k++) sum += rows.f[k];
            ck_assert_double_eq_tol(sum, target[i], 1e-12);
        }
        ck_assert_int_eq(fibrad_rows_reciprocity(&rows, radius, &largest), FIBRAD_OK);
        ck_assert_double_lt(largest, 1e-14);
    }
    ck_assert_int_eq(fibrad_rows_balance(&rows, NULL, scratch), FIBRAD_E_ARGUMENT);
    target[3] = NAN;
    ck_assert_int_eq(fibrad_rows_balance(&rows, target, scratch), FIBRAD_E_ARGUMENT);
    for (int k = 0; k < 2; k++) free(both[k]->start), free(both[k]->col), free(both[k]->f);
    free(e), free(radius), free(target), free(scratch), free(scene);
    bed_free(&bed);
}
END_TEST

START_TEST(bad_arguments) {
    struct bed bed = bed_of(2, (const double[][4]){{0, 0, 0, 1}, {3, 0, 0, 1}});
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    fibrad_tracer *tracer = tracer_of(scene);
    fibrad_work *work = work_of(NULL);
    fibrad_row row = row_of(2), none = {0};
    const double good[2] = {.5, .5}, bad[][2] = {{0, 1}, {1.1, 1}, {NAN, 1}, {-.1, 1}};
    fibrad_exchange_rule rule = {.emissivity = good};
    fibrad_spread spread;
    ck_assert_int_eq(fibrad_exchange_row(NULL, work, 0, &rule, &row, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_exchange_row(tracer, NULL, 0, &rule, &row, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_exchange_row(tracer, work, 2, &rule, &row, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_exchange_row(tracer, work, 0, NULL, &row, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_exchange_row(tracer, work, 0, &rule, NULL, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_exchange_row(tracer, work, 0, &rule, &none, NULL), FIBRAD_E_CAPACITY);
    ck_assert_int_eq(fibrad_exchange_spread(tracer, 0, &rule, NULL), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_exchange_spread(tracer, 2, &rule, &spread), FIBRAD_E_ARGUMENT);
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        rule.emissivity = bad[k];
        ck_assert_int_eq(fibrad_exchange_row(tracer, work, 0, &rule, &row, NULL), FIBRAD_E_ARGUMENT);
    }
    rule.emissivity = good;
    rule.wall_emissivity[2] = 1.5;
    ck_assert_int_eq(fibrad_exchange_row(tracer, work, 0, &rule, &row, NULL), FIBRAD_E_ARGUMENT);
    rule.wall_emissivity[2] = 0;
    rule.error = -1;
    ck_assert_int_eq(fibrad_exchange_row(tracer, work, 0, &rule, &row, NULL), FIBRAD_E_ARGUMENT);
    rule.error = 0;
    ck_assert_int_eq(fibrad_exchange_row(tracer, work, 0, &rule, &row, NULL), FIBRAD_OK);
    ck_assert_double_eq_tol(whole(&row), 1, 1e-12);
    row_free(&row);
    free(work);
    free(tracer);
    free(scene);
    bed_free(&bed);
}
END_TEST

int main(void) {
    Suite *suite = suite_create("exchange");
    TCase *cases = suite_case(suite, "exchange");
    tcase_add_test(cases, black_is_the_beam_row);
    tcase_add_test(cases, one_and_two_spheres);
    tcase_add_test(cases, hardly_seen);
    tcase_add_test(cases, sphere_in_a_grey_box);
    tcase_add_loop_test(cases, against_plain_paths, 0, 2);
    tcase_add_test(cases, error_and_its_estimate);
    tcase_add_test(cases, same_bits_always);
    tcase_add_test(cases, conductivity_of_lattices);
    tcase_add_test(cases, spread_of_a_chain);
    tcase_add_test(cases, rows_keep_the_books);
    tcase_add_test(cases, bad_arguments);
    return suite_run(suite);
}
