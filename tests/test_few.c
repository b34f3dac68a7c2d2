/* test_few.c - few spheres, and spheres far apart: pairs that nothing comes between are exact, and estimates know what
 * no line has met. SPDX-License-Identifier: MIT */
#include <math.h>

#include "bed/packing.h"
#include "host_owned.h"
#include "meshes.h"
#include "papers/pair/exact_gsl.h"
#include "papers/pair/reference.h"
#include "scenes.h"
#include "suite.h"

static const double pi = 3.14159265358979323846;

static int ascending(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static fibrad_bed_matrix *factors_of(const struct bed *bed, const fibrad_scene_config *config,
                                     const fibrad_beam_rule *rule) {
    const fibrad_spheres spheres = spheres_of(bed);
    fibrad_bed_matrix *factors = NULL;
    assert_ok(fibrad_view_factors(config, &spheres, &(fibrad_bed_rule){.beam = rule}, NULL, &factors));
    return factors;
}

static double factor_of(const fibrad_factors *m, uint32_t i, uint32_t j) {
    for (uint64_t k = m->start[i]; k < m->start[i + 1]; k++)
        if (m->col[k] == j) return m->f[k];
    return 0;
}

static double distance_of(const struct bed *bed, uint32_t i, uint32_t j) {
    return hypot(hypot(bed->x[i] - bed->x[j], bed->y[i] - bed->y[j]), bed->z[i] - bed->z[j]);
}

/* The factor of two spheres with nothing in between. */
static double free_of(const struct bed *bed, uint32_t i, uint32_t j) {
    double f;
    assert_ok(fibrad_pair_exact(bed->r[i], bed->r[j], distance_of(bed, i, j) - bed->r[i] - bed->r[j], &f));
    return f;
}

static double sum_of(const fibrad_factors *m, uint32_t i) {
    double sum = m->escaped[i] + m->beyond[i];
    for (uint64_t k = m->start[i]; k < m->start[i + 1]; k++) sum += m->f[k];
    for (uint32_t b = 0; b < m->walls; b++) sum += m->wall[i * m->walls + b];
    return sum;
}

static void check_closed(const fibrad_bed_matrix *factors) {
    for (uint32_t i = 0; i < factors->matrix.n; i++) ck_assert_double_eq_tol(sum_of(&factors->matrix, i), 1, 1e-13);
    ck_assert_double_le(factors->reciprocity_error, 1e-16);
}

static const double GAPS[] = {-.1, 0, 1e-9, .01, 1, 8, 18, 200, 1e4};
static const double RADII[] = {1, .1, .01, 100};
enum { GAP_COUNT = sizeof GAPS / sizeof *GAPS, RADIUS_COUNT = sizeof RADII / sizeof *RADII };

LOOP_TEST(two_spheres_are_exact, GAP_COUNT *RADIUS_COUNT) {
    const double r = RADII[_i / GAP_COUNT], gap = GAPS[_i % GAP_COUNT] * fmin(1, r), d = 1 + r + gap;
    OWNED_BED bed = BED({1, 2, 3, 1}, {1 + .6 * d, 2 - .48 * d, 3 + .64 * d, r});
    OWNED_FACTORS *few = factors_of(&bed, NULL, &(fibrad_beam_rule){.directions = 8});
    OWNED_FACTORS *factors = factors_of(&bed, NULL, NULL);
    double f, error;
    ck_assert_int_eq(exact_gsl_lens(1, r, gap, &f, &error), 0);
    ck_assert_double_eq_tol(factor_of(&factors->matrix, 0, 1), f, 1e-12 * f + 2 * error);
    ck_assert_double_eq_tol(factor_of(&factors->matrix, 0, 1), free_of(&bed, 0, 1), 1e-12 * f);
    ck_assert_double_eq_tol(factor_of(&few->matrix, 1, 0), free_of(&bed, 1, 0), 1e-12 * f / (r * r));
    ck_assert_double_le(factors->matrix.error[0], 1e-12);
    check_closed(factors);
}

TEST(small_scenes_have_more_lines) {
    OWNED_BED two = BED({0, 0, 0, 1}, {5, 0, 0, 1}), many = packing(300, .8, 1.2, .01, 3, false);
    OWNED_FACTORS *of_two = factors_of(&two, NULL, NULL), *of_many = factors_of(&many, NULL, NULL);
    ck_assert_uint_eq(of_two->directions, FIBRAD_LINES_EVEN_MAX);
    ck_assert_uint_eq(of_many->directions, FIBRAD_LINES_DEFAULT);
}

/* Spheres at corners of a cube, whose hulls meet no other, and whose radii differ as 1:100. */
TEST(five_spheres_are_exact) {
    OWNED_BED bed = BED({0, 0, 0, 30}, {100, 0, 0, .3}, {0, 100, 0, 3}, {0, 0, 100, 1}, {100, 100, 100, 10});
    OWNED_FACTORS *factors = factors_of(&bed, NULL, NULL);
    for (uint32_t i = 0; i < 5; i++)
        for (uint32_t j = 0; j < 5; j++)
            if (i != j) ck_assert_double_eq_tol(factor_of(&factors->matrix, i, j) / free_of(&bed, i, j), 1, 1e-12);
    check_closed(factors);
}

/* A third sphere that touches the hull leaves a pair exact. One that reaches into it does not. */
TEST(what_comes_between_is_seen) {
    for (int into = 0; into < 2; into++) {
        const double aside = 1.5 - .2 * into;
        OWNED_BED bed = BED({0, 0, 0, 1}, {10, 0, 0, 1}, {5, aside, 0, .5});
        const fibrad_spheres spheres = spheres_of(&bed);
        OWNED_FACTORS *factors = factors_of(&bed, NULL, NULL);
        double f;
        assert_ok(reference_pair(&spheres, 0, 1, &(struct reference_rule){1e-6, 100000000}, &f,
                                 &(struct reference_report){0, 0}));
        const double found = factor_of(&factors->matrix, 0, 1), open = free_of(&bed, 0, 1);
        ck_assert_double_eq_tol(found, f, 2 * factors->matrix.error[0] + 1e-6 * open);
        ck_assert((fabs(found / open - 1) < 1e-12) == !into);
        ck_assert_double_eq_tol(factor_of(&factors->matrix, 0, 2) / free_of(&bed, 0, 2), 1, 1e-12);
        check_closed(factors);
    }
}

/* Walls take the difference between what lines have seen and what is exact. A wall that cuts a sphere ends this. */
TEST(walls_take_the_difference) {
    const fibrad_wall wall[] = {plane_at(2, 0, -1), plane_at(2, 1, 9), cylinder_at(0, 0, 30)};
    const fibrad_scene_config config = {.wall = wall, .walls = 3};
    OWNED_BED bed = BED({0, 0, 0, 1}, {6, 0, 3, 2}), cut = BED({0, 0, 0, 1.1}, {6, 0, 3, 2});
    OWNED_FACTORS *factors = factors_of(&bed, &config, NULL), *of_cut = factors_of(&cut, &config, NULL);
    ck_assert_double_eq_tol(factor_of(&factors->matrix, 0, 1) / free_of(&bed, 0, 1), 1, 1e-12);
    ck_assert_double_gt(fabs(factor_of(&of_cut->matrix, 0, 1) / free_of(&cut, 0, 1) - 1), 1e-6);
    ck_assert_double_le(factors->matrix.escaped[0], 1e-13);
    check_closed(factors);
    check_closed(of_cut);
}

/* The factor between two spheres among others, by an integral over both surfaces. */
static double factor_by_integral(const struct bed *bed, uint32_t i, uint32_t j, double tolerance) {
    const fibrad_spheres spheres = spheres_of(bed);
    double f;
    const int status = reference_pair(&spheres, i, j, &(struct reference_rule){tolerance, 10000000}, &f,
                                      &(struct reference_report){0, 0});
    ck_assert_int_eq(status, REFERENCE_OK);
    return f;
}

/* Far pairs of which other spheres hide a part. No window need meet them. */
TEST(partly_hidden_far_pairs) {
    OWNED_BED half = BED({0, 0, 0, .1}, {2.7, 0, 0, .1}, {1.5, .1, 0, .1}, {1.5, 40, 40, .1});
    OWNED_BED touched = BED({0, 0, 0, .1}, {2.7, 0, 0, .1}, {1.5, .19, 0, .1});
    OWNED_BED two = BED({0, 0, 0, 1}, {0, 36, 0, .5}, {.6, 15, .6, .3}, {-.5, 25, 0, .4});
    OWNED_BED four =
        BED({0, 0, 0, 1}, {30, 0, 0, 1}, {5, .9, 0, .3}, {12, -.8, .3, .5}, {20, 0, .9, .4}, {25, 0, 0, .2});
    OWNED_BED all = BED({0, 0, 0, 1}, {0, 0, 50, 1}, {0, 0, 30, 1.5});
    struct bed *beds[] = {&half, &touched, &two, &four, &all};
    for (int b = 0; b < 5; b++)
        for (int wanted = 0; wanted < 2; wanted++) {
            OWNED_FACTORS *factors = factors_of(beds[b], NULL, &(fibrad_beam_rule){.tolerance = wanted ? .002 : 0});
            const double f = factor_by_integral(beds[b], 0, 1, 1e-5), open = free_of(beds[b], 0, 1);
            const double error = fabs(factor_of(&factors->matrix, 0, 1) - f);
            ck_assert_double_le(sqrt(2) * error, 2 * factors->matrix.error[0] + 1e-5 * open);
            ck_assert_double_le(error, .03 * open);
            ck_assert_double_le(factors->matrix.error[0], .05 * open);
            check_closed(factors);
        }
}

TEST(a_cutoff_bounds_what_is_exact) {
    OWNED_BED bed = BED({0, 0, 0, 1}, {6, 0, 0, 1}, {0, 9, 0, 1});
    OWNED_FACTORS *near = factors_of(&bed, NULL, &(fibrad_beam_rule){.cutoff = 7});
    ck_assert_double_eq_tol(factor_of(&near->matrix, 0, 1) / free_of(&bed, 0, 1), 1, 1e-12);
    ck_assert_double_eq(factor_of(&near->matrix, 0, 2), 0);
    check_closed(near);
}

/* A square of two triangles across the line of centres, or aside. */
TEST(triangles_come_between) {
    OWNED_BED bed = BED({0, 0, 0, 1}, {8, 0, 0, 1});
    for (int aside = 0; aside < 2; aside++) {
        const double y = aside ? 1.5 : -.5;
        OWNED struct mesh *mesh = mesh_new();
        const double at[4][2] = {{y, -3}, {y + 1, -3}, {y + 1, 3}, {y, 3}};
        uint32_t corner[4];
        for (int k = 0; k < 4; k++) corner[k] = mesh_vertex(mesh, 4, at[k][0], at[k][1]);
        mesh_quad(mesh, corner, 0, 0);
        const fibrad_scene_config config = {.wall = mesh->wall, .walls = 1, .triangles = &mesh->triangles};
        OWNED_FACTORS *factors = factors_of(&bed, &config, NULL);
        ck_assert((fabs(factor_of(&factors->matrix, 0, 1) / free_of(&bed, 0, 1) - 1) < 1e-12) == (aside == 1));
        check_closed(factors);
    }
}

/* Rows of spheres in another order have the same bits. */
TEST(exact_pairs_have_the_same_bits) {
    OWNED_BED bed = packing(60, .5, 1.5, .01, 5, false), turned = bed_empty();
    uint64_t id[60];
    for (uint32_t i = 0; i < 60; i++) add_sphere(&turned, bed.x[59 - i], bed.y[59 - i], bed.z[59 - i], bed.r[59 - i]);
    for (uint32_t i = 0; i < 60; i++) id[i] = 59 - i;
    fibrad_spheres back = spheres_of(&turned);
    back.id = id;
    OWNED_FACTORS *first = factors_of(&bed, NULL, NULL), *reversed = NULL;
    assert_ok(fibrad_view_factors(NULL, &back, NULL, NULL, &reversed));
    for (uint32_t i = 0; i < 60; i++)
        for (uint32_t j = 0; j < 60; j++)
            ck_assert_double_eq(factor_of(&first->matrix, i, j), factor_of(&reversed->matrix, 59 - i, 59 - j));
    check_closed(first);
}

/* Small spheres in a thin layer about a large one have many near ones. A row tries no more of them than it has windows.
 */
TEST(few_pairs_are_tried_in_a_thin_layer) {
    enum { N = 20000 };
    OWNED_BED bed = BED({0, 0, 0, 1});
    for (uint64_t i = 0; i < N; i++) {
        const double z = 1 - (2 * (double)i + 1) / N, angle = 2.399963229728653 * (double)i, ring = sqrt(1 - z * z);
        const double out = 1.0006 + .02 * bed_make_random(3, i);
        add_sphere(&bed, out * ring * cos(angle), out * ring * sin(angle), out * z, 5e-4);
    }
    OWNED_FACTORS *factors = factors_of(&bed, NULL, &(fibrad_beam_rule){.directions = 55});
    ck_assert_uint_le(factors->matrix.start[N + 1], 2 * 55 * (uint64_t)N);
}

/* ---- exchange and heat ------------------------------------------------------------------------------------------ */

/* The exchange factor of two far spheres of emissivity e, whose reflected light hardly meets the other again. */
static double far_exchange(double e, double f, double back) { return e * f / (1 - (1 - e) * (1 - e) * f * back); }

static const double FAR[] = {8, 10, 20, 500};
enum { FAR_COUNT = sizeof FAR / sizeof *FAR };

LOOP_TEST(exchange_of_two_far_spheres, FAR_COUNT * 2) {
    const double r = _i % 2 ? .1 : 1, d = FAR[_i / 2], e[] = {.8, .8};
    OWNED_BED bed = BED({0, 0, 0, 1}, {.6 * d, -.48 * d, .64 * d, r});
    const fibrad_spheres spheres = spheres_of(&bed);
    OWNED_FACTORS *given = NULL, *wanted = NULL;
    assert_ok(exchange_of(NULL, &spheres, &(fibrad_exchange_rule){.emissivity = e}, NULL, NULL, &given));
    assert_ok(
        exchange_of(NULL, &spheres, &(fibrad_exchange_rule){.emissivity = e, .tolerance = 1e-4}, NULL, NULL, &wanted));
    const double exact = far_exchange(.8, free_of(&bed, 0, 1), free_of(&bed, 1, 0));
    ck_assert_double_eq_tol(factor_of(&given->matrix, 0, 1) / exact, 1, 1e-5);
    ck_assert_double_eq_tol(factor_of(&wanted->matrix, 0, 1) / exact, 1, 1e-5);
    ck_assert_double_le(fabs(factor_of(&given->matrix, 0, 1) - exact), given->matrix.error[0]);
    ck_assert_uint_eq(wanted->directions, FIBRAD_EXCHANGE_DIRECTIONS_DEFAULT);
    check_closed(given);
}

/* What the first segment gives a sphere that no window meets, is reflected to a third one. */
TEST(light_goes_on_from_a_sphere_that_no_window_meets) {
    const double e[] = {1, 0, 1};
    OWNED_BED bed = BED({0, 0, 0, 1}, {60, 0, 0, 1}, {58, 3, 0, 1});
    const fibrad_spheres spheres = spheres_of(&bed);
    OWNED_FACTORS *factors = NULL;
    assert_ok(
        exchange_of(NULL, &spheres, &(fibrad_exchange_rule){.emissivity = e, .paths = 40000}, NULL, NULL, &factors));
    const double direct = free_of(&bed, 0, 2), whole = factor_of(&factors->matrix, 0, 2);
    ck_assert_double_gt(whole - direct, .02 * free_of(&bed, 0, 1));
    ck_assert_double_le(whole - direct, .2 * free_of(&bed, 0, 1));
}

/* The powers of two spheres of these emissivities and temperatures in surroundings of 0 K, and their estimated errors.
 */
static void heat_of(const struct bed *bed, const double e[2], const double temperature[2], double power[2],
                    double error[2]) {
    const fibrad_spheres spheres = spheres_of(bed);
    OWNED_MADE *radiation = NULL;
    fibrad_heat_sources sources;
    fibrad_heat_result result = {.power = power, .power_error = error};
    fibrad_heat_sources_init(&sources);
    sources.temperature = temperature, sources.emissivity = e, sources.surroundings = 0, sources.sigma = 1e-12;
    assert_ok(made_with(&radiation, NULL, &spheres, NULL, NULL));
    assert_ok(fibrad_bed_solve(radiation, &sources, NULL, &result));
}

/* The power of a cold sphere that only the other one heats, over what it would be without reflections back, is exact
 * among black spheres, and nearly so among grey ones. */
LOOP_TEST(heat_of_two_far_spheres, FAR_COUNT * 4) {
    const double r = _i % 2 ? .1 : 1, d = FAR[_i / 4], grey = _i / 2 % 2 ? .8 : 1, e[] = {grey, grey};
    const double temperature[] = {0, 1000};
    OWNED_BED bed = BED({0, 0, 0, 1}, {.6 * d, -.48 * d, .64 * d, r});
    double power[2], error[2];
    heat_of(&bed, e, temperature, power, error);
    const double exact = 4 * pi * grey * far_exchange(grey, free_of(&bed, 0, 1), free_of(&bed, 1, 0));
    ck_assert_double_eq_tol(power[0] / exact, 1, grey < 1 ? 1e-3 : 1e-6);
    ck_assert_double_le(fabs(power[0] - exact), error[0]);
}

/* Estimates know what is exact. The exact powers leave out what goes back and forth more than once. A far sphere sends
 * 8/3 times as much back to where it is lit from as a bright one would. */
TEST(estimates_of_far_pairs) {
    static const double distance[] = {10, 25, 70, 200, 500, 1000};
    static const double emissivity[][2] = {{.4, .7}, {1, 1}, {.8, .8}, {.9, .2}, {1, .5}}, radius[] = {1, .3, 3};
    enum { PAIRS = 6 * 5 * 3 };
    double ratio[2][PAIRS], temperature[] = {1000, 0};
    int bad = 0;
    for (int k = 0; k < PAIRS; k++) {
        const double *e = emissivity[k / 6 % 5], r = radius[k / 30], d = distance[k % 6] * fmax(1, r);
        OWNED_BED bed = BED({0, 0, 0, 1}, {.6 * d, -.48 * d, .64 * d, r});
        double power[2], error[2];
        heat_of(&bed, e, temperature, power, error);
        const double f = free_of(&bed, 0, 1), back = f * free_of(&bed, 1, 0) * (1 - e[1]) * 8 / 3, area = 4 * pi;
        const double right[] = {-area * e[0] * (1 - e[0] * back),
                                area * e[0] * e[1] * f / (1 - (1 - e[0]) * back * 8 / 3)};
        for (int b = 0; b < 2; b++) {
            ratio[b][k] = error[b] / fabs(power[b] - right[b]);
            bad += ratio[b][k] < .5;
        }
    }
    for (int b = 0; b < 2; b++) {
        qsort(ratio[b], PAIRS, sizeof *ratio[b], ascending);
        printf("far pairs, sphere %d: estimate over error %.2f %.2f\n", b, ratio[b][PAIRS / 20], ratio[b][PAIRS / 2]);
        ck_assert_double_lt(ratio[b][PAIRS / 2], 30);
    }
    ck_assert_int_le(bad, 2 * PAIRS / 20);
}

/* ---- estimates -------------------------------------------------------------------------------------------------- */

/* So few spheres in so much space hide nothing from each other that counts. */
TEST(dilute_rows_know_what_no_line_meets) {
    enum { N = 280 };
    const double side = 1055; /* of which spheres fill a millionth */
    OWNED_BED bed = bed_empty();
    for (uint64_t i = 0; i < N; i++)
        add_sphere(&bed, side * bed_make_random(7, 3 * i), side * bed_make_random(7, 3 * i + 1),
                   side * bed_make_random(7, 3 * i + 2), 1);
    OWNED_FACTORS *factors = factors_of(&bed, NULL, NULL);
    double ratio[N];
    int bad = 0;
    for (uint32_t i = 0; i < N; i++) {
        double square = 0;
        for (uint32_t j = 0; j < N; j++)
            if (j != i) square += pow(factor_of(&factors->matrix, i, j) - free_of(&bed, i, j), 2);
        ratio[i] = factors->matrix.error[i] / sqrt(square);
        bad += ratio[i] < .5;
    }
    qsort(ratio, N, sizeof *ratio, ascending);
    ck_assert_double_gt(ratio[0], 0);
    ck_assert_int_le(bad, N / 20);
    ck_assert_double_lt(ratio[N / 2], 3);
}

/* Rows of beds whose far pairs are often hidden in part. At most 5 % err by more than twice the estimate. */
LOOP_TEST(estimates_of_dilute_beds_hold, by_night(6, 3)) {
    static const double fraction[] = {.001, .006, .01, .001, .003, .006}, tolerance[] = {0, .005, .002};
    enum { N = 30, RULES = 3 };
    OWNED_BED bed = packing(N, _i < 3 ? .3 : 1, 1, fraction[_i], 11 + (uint64_t)(_i + 3) % 6, false);
    double truth[N][N] = {{0}}, ratio[RULES * N];
    int bad = 0, rows = 0;
    for (uint32_t i = 0; i < N; i++)
        for (uint32_t j = 0; j < i; j++) {
            truth[i][j] = factor_by_integral(&bed, i, j, 1e-3);
            truth[j][i] = truth[i][j] * pow(bed.r[i] / bed.r[j], 2);
        }
    for (int rule = 0; rule < RULES; rule++) {
        OWNED_FACTORS *factors = factors_of(&bed, NULL, &(fibrad_beam_rule){.tolerance = tolerance[rule]});
        for (uint32_t i = 0; i < N; i++) {
            double square = 0, open = 0;
            for (uint32_t j = 0; j < N; j++) {
                const double difference = factor_of(&factors->matrix, i, j) - truth[i][j];
                square += difference * difference, open += difference;
            }
            const double error = sqrt(square + open * open);
            if (error < 1e-6) continue; /* of the truth */
            bad += error > 2 * factors->matrix.error[i];
            ratio[rows++] = factors->matrix.error[i] / error;
        }
    }
    qsort(ratio, (size_t)rows, sizeof *ratio, ascending);
    printf("solid fraction %g: estimate over error %.2f, %d of %d too low\n", fraction[_i], ratio[rows / 2], bad, rows);
    ck_assert_int_gt(rows, RULES * N / 2);
    ck_assert_int_le(bad, rows / 20);
    ck_assert_double_le(ratio[rows / 2], 3);
}
