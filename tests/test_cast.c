/* test_cast.c - rows by rays against exact pairs, against the published table, against rays followed by hand, against
 * beams, and against themselves under settings that must not matter. SPDX-License-Identifier: MIT */
#include <stdio.h>

#include "base/random.h"
#include "workspace/workspace.h"
#include "scenes.h"
#include "suite.h"

static fibrad_row cast(const struct bed *bed, uint32_t i, fibrad_cast_rule rule, int isa) {
    OWNED fibrad_scene *scene = scene_of(bed, isa);
    OWNED_WORK work = work_growing();
    fibrad_row row = row_of(bed->n);
    assert_ok(fibrad_cast_row(scene, &work, i, &rule, &row, NULL));
    ck_assert_uint_eq(row.sphere, i);
    ck_assert_int_eq(row.symmetric, 0);
    return row;
}

/* Makes two spheres, one in direction k of 24 from the other. */
static struct bed pair(double r1, double r2, double distance, uint32_t k) {
    double w[3];
    assert_ok(fibrad_direction(k, 24, w));
    return BED({0, 0, 0, r1}, {distance * w[0], distance * w[1], distance * w[2], r2});
}

TEST(two_spheres_match_the_exact_pair) {
    static const double cases[][3] = {{1, 1, 0},   {1, .3, 0},  {.3, 1, .1}, {1, 3, .01}, {1, 10, 0},
                                      {10, 1, .1}, {1, 1, -.2}, {1, 3, -.1}, {3, 1, -.3}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++)
        for (int random = 0; random <= 1; random++) {
            const double *p = cases[c];
            double exact, error = 0, estimate = 0;
            assert_ok(fibrad_pair_exact(p[0], p[1], p[2], &exact));
            for (uint32_t k = 0; k < 24; k++) {
                OWNED_BED bed = pair(p[0], p[1], p[0] + p[1] + p[2], k);
                OWNED_ROW row = cast(&bed, 0, (fibrad_cast_rule){20000, random, k, 0}, FIBRAD_ISA_BEST);
                ck_assert_uint_eq(row.length, 1);
                ck_assert_double_eq_tol(row.f[0] + row.escaped, 1, 1e-15);
                error += pow(row.f[0] - exact, 2) / 24;
                estimate += pow(row.error, 2) / 24;
            }
            ck_assert_msg(error < 2.25 * estimate, "%g %g %g random %d: error %g, estimate %g", p[0], p[1], p[2],
                          random, sqrt(error), sqrt(estimate));
            ck_assert_double_lt(sqrt(error), random ? .5 / sqrt(20000) * 1.3 : .0012);
        }
}

/* Unit spheres are H apart. The error at 200,000 rays, and the mean length and angle of the rays, are those of
 * docs/validation.md. */
TEST(rays_have_the_errors_of_the_pebble_table) {
    static const struct {
        double h, error, length, angle;
    } table[] = {{2, .003, .3590, 30.84},
                 {3, .006, 1.4923, 18.24},
                 {4, .009, 2.5399, 13.34},
                 {5, .012, 3.5663, 10.56},
                 {6, .015, 4.5835, 8.75}};
    for (size_t t = 0; t < 5; t++) {
        double exact, error = 0, length = 0, angle = 0;
        assert_ok(fibrad_pair_exact(1, 1, table[t].h - 2, &exact));
        for (uint32_t k = 0; k < 24; k++) {
            OWNED_BED bed = pair(1, 1, table[t].h, k);
            OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
            OWNED_WORK work = work_growing();
            OWNED_ROW row = row_of(2);
            double lengths[2], angles[2];
            const fibrad_cast_rule rule = {.rays = 200000, .seed = k};
            const fibrad_cast_means means = {lengths, angles};
            assert_ok(fibrad_cast_row(scene, &work, 0, &rule, &row, &means));
            error += pow(row.f[0] / exact - 1, 2) / 24;
            length += lengths[0] / 24;
            angle += angles[0] * 180 / PI / 24;
        }
        ck_assert_msg(sqrt(error) < table[t].error, "H = %g: %.2f %%", table[t].h, 100 * sqrt(error));
        ck_assert_double_eq_tol(length, table[t].length, .004);
        ck_assert_double_eq_tol(angle, table[t].angle, .03);
    }
}

/* The origin and the direction of ray k of the unit sphere. */
static void ray(uint32_t i, uint32_t k, const fibrad_cast_rule *rule, double o[3], double w[3]) {
    const fibrad_random stream = {fibrad_mix(fibrad_random_ahead((fibrad_random){rule->seed}, i))};
    double at[4], g = 1.2;
    for (int n = 0; n < 60; n++) g = pow(1 + g, .2); /* g^5 = g + 1 */
    for (int d = 0; d < 4; d++) {
        uint64_t move = fibrad_random_ahead(stream, rule->random ? 4 * (uint64_t)k + (uint64_t)d : (uint64_t)d);
        at[d] = ldexp((double)(move >> 11), -53) + (rule->random ? 0 : fmod(k * pow(g, -d - 1), 1));
    }
    double z = 1 - 2 * fmod(at[0], 1), ring = sqrt(1 - z * z), azimuth = 2 * PI * at[1], about = 2 * PI * at[3];
    double sine = sqrt(fmod(at[2], 1)), cosine = sqrt(1 - fmod(at[2], 1));
    /* turns are counted from their middle */
    double c = -cos(azimuth), s = -sin(azimuth), p = -sine * cos(about), q = -sine * sin(about);
    o[0] = ring * c, o[1] = ring * s, o[2] = z;
    w[0] = -p * s - q * z * c + cosine * o[0];
    w[1] = p * c - q * z * s + cosine * o[1];
    w[2] = q * ring + cosine * o[2];
}

/* The sphere, among all spheres, that a ray from sphere i meets first by the distance along the ray. n: the ray meets
 * none. */
static uint32_t first_met(const struct bed *bed, uint32_t i, const double o[3], const double w[3]) {
    uint32_t first = bed->n;
    double nearest = INFINITY, least = INFINITY;
    for (uint32_t j = 0; j < bed->n; j++) {
        if (j == i) continue;
        double c[3] = {bed->x[j] - bed->x[i], bed->y[j] - bed->y[i], bed->z[j] - bed->z[i]};
        double depth = 0, along = 0, square = 0;
        for (int axis = 0; axis < 3; axis++) {
            double e = c[axis] - bed->r[i] * o[axis];
            depth += c[axis] * w[axis];
            along += e * w[axis];
            square += e * e;
        }
        double chord = along * along - square + bed->r[j] * bed->r[j];
        if (!(depth > 0 && chord > 0)) continue;
        double distance = fmax(0, along - sqrt(chord));
        if (distance < nearest || (distance == nearest && depth < least)) first = j, nearest = distance, least = depth;
    }
    return first;
}

static void check_every_ray(const struct bed *bed, int random) {
    const fibrad_cast_rule rule = {.rays = 4000, .random = random, .seed = 5};
    OWNED uint32_t *count = calloc(bed->n + 1, sizeof *count);
    for (uint32_t i = 0; i < bed->n; i += 37) {
        memset(count, 0, (bed->n + 1) * sizeof *count);
        for (uint32_t k = 0; k < rule.rays; k++) {
            double o[3], w[3];
            ray(i, k, &rule, o, w);
            count[first_met(bed, i, o, w)]++;
        }
        OWNED_ROW row = cast(bed, i, rule, FIBRAD_ISA_BEST);
        for (uint32_t j = 0; j < bed->n; j++)
            ck_assert_msg(fabs(row_factor(&row, j) * rule.rays - count[j]) < .5,
                          "row %u: %u rays meet sphere %u, not %g", i, count[j], j, row_factor(&row, j) * rule.rays);
        ck_assert_double_eq_tol(row.escaped * rule.rays, count[bed->n], .5);
    }
}

/* The radii go from 1 to 10. Then the same spheres swell until they overlap. */
TEST(rays_meet_the_first_sphere) {
    OWNED_BED bed = packing(400, .2, 2, .5, 11, false);
    check_every_ray(&bed, 0);
    check_every_ray(&bed, 1);
    for (uint32_t i = 0; i < bed.n; i++) bed.r[i] *= 1.05;
    check_every_ray(&bed, 0);
}

/* Of two spheres that overlap by almost a radius, a ray may meet first the one that is deeper, which has perhaps not
 * been looked up yet. The reach of the shells depends on the whole scene, here on a speck behind. What the ray meets
 * must not depend on it. */
TEST(deeper_spheres_are_met_first) {
    for (double depth = 12; depth < 60; depth += .31) {
        double f[2][2];
        for (int k = 0; k < 2; k++) {
            OWNED_BED bed =
                BED({0, 0, 0, 1}, {0, 0, depth, 10}, {9.9, 0, depth + 1.5, 10}, {0, 0, k == 0 ? -20 : -2000, 1e-6});
            OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
            OWNED_WORK work = work_growing();
            OWNED_ROW row = row_of(4);
            assert_ok(fibrad_cast_row(scene, &work, 0, &(fibrad_cast_rule){.rays = 3000}, &row, NULL));
            for (uint32_t j = 0; j < 2; j++) f[k][j] = row_factor(&row, j + 1);
        }
        ck_assert_double_eq(f[0][0], f[1][0]);
        ck_assert_double_eq(f[0][1], f[1][1]);
    }
}

TEST(rays_agree_with_beams) {
    struct bed beds[] = {packing(300, .8, 1.2, .55, 7, true), packing(300, .3, 2, .5, 8, true)};
    for (size_t b = 0; b < 2; b++) {
        OWNED fibrad_scene *scene = scene_of(&beds[b], FIBRAD_ISA_BEST);
        OWNED_WORK work = work_growing();
        OWNED_ROW ours = row_of(beds[b].n), beams = row_of(beds[b].n);
        for (int random = 0; random <= 1; random++) {
            double error = 0, estimate = 0, bias = 0;
            for (uint32_t i = 0; i < 30; i++) {
                const fibrad_cast_rule rule = {.rays = 20000, .random = random, .seed = 3};
                const fibrad_beam_rule fine = {.directions = 4000};
                assert_ok(fibrad_cast_row(scene, &work, i, &rule, &ours, NULL));
                assert_ok(fibrad_beam_row(scene, &work, i, &fine, &beams));
                error += pow(row_distance(&ours, &beams), 2) / 30;
                estimate += pow(ours.error, 2) / 30;
                bias += (ours.f[0] - row_factor(&beams, ours.col[0])) / 30;
            }
            ck_assert_double_lt(error, 1.5 * estimate);
            ck_assert_double_gt(error, .2 * estimate);
            ck_assert_double_lt(sqrt(error), random ? .009 : .005);
            ck_assert_double_lt(fabs(bias), 2e-4);
        }
        bed_free(&beds[b]);
    }
}

TEST(seeds_give_other_rays) {
    OWNED_BED bed = packing(200, .8, 1.2, .5, 5, true);
    for (int random = 0; random <= 1; random++) {
        OWNED_ROW a = cast(&bed, 3, (fibrad_cast_rule){1000, random, 7, 0}, FIBRAD_ISA_BEST);
        OWNED_ROW same = cast(&bed, 3, (fibrad_cast_rule){1000, random, 7, 0}, FIBRAD_ISA_BEST);
        OWNED_ROW other = cast(&bed, 3, (fibrad_cast_rule){1000, random, 8, 0}, FIBRAD_ISA_BEST);
        ck_assert(same_bits(&a, &same));
        ck_assert(!same_bits(&a, &other));
    }
}

TEST(scaling_by_powers_of_two_changes_no_bit) {
    OWNED_BED bed = packing(200, .8, 1.2, .5, 5, true), scaled = packing(200, .8, 1.2, .5, 5, true);
    OWNED_ROW row = cast(&bed, 11, (fibrad_cast_rule){2000, 0, 0, 9}, FIBRAD_ISA_BEST);
    for (int k = -400; k <= 400; k += 100) {
        scale_bed(&scaled, &bed, k);
        OWNED_ROW other = cast(&scaled, 11, (fibrad_cast_rule){2000, 0, 0, ldexp(9, k)}, FIBRAD_ISA_BEST);
        ck_assert(same_bits(&row, &other));
    }
}

/* Rays end after 100 periods however far the shells reach, which again depends on a speck. */
TEST(rays_end_after_100_periods) {
    double escaped = NAN;
    for (int speck = 0; speck < 5; speck++) {
        OWNED_BED bed = BED({0, 0, 0, 1}, {0, 0, -20 * pow(3, speck), 1e-6});
        bed.period[0] = 3;
        for (int k = 0; k < 8; k++) add_sphere(&bed, .2 * k, 300 * cos(2.4 * k), 300 * sin(2.4 * k), 1.5);
        OWNED_ROW row = cast(&bed, 0, (fibrad_cast_rule){.rays = 20000}, FIBRAD_ISA_BEST);
        if (speck == 0) escaped = row.escaped;
        ck_assert_double_eq(row.escaped, escaped);
    }
}

/* Spheres beyond the cutoff neither receive nor block. */
TEST(spheres_beyond_the_cutoff_do_nothing) {
    OWNED_BED bed = BED({0, 0, 0, 1}, {0, 0, 3, 1}, {0, 0, 40, 30});
    OWNED_ROW all = cast(&bed, 0, (fibrad_cast_rule){.rays = 5000}, FIBRAD_ISA_BEST);
    OWNED_ROW near = cast(&bed, 0, (fibrad_cast_rule){.rays = 5000, .cutoff = 3}, FIBRAD_ISA_BEST);
    OWNED_ROW none = cast(&bed, 0, (fibrad_cast_rule){.rays = 5000, .cutoff = 2.9}, FIBRAD_ISA_BEST);
    ck_assert_uint_eq(all.length, 2);
    ck_assert_uint_eq(near.length, 1);
    ck_assert_double_eq(near.f[0], all.f[0]);
    ck_assert_uint_eq(none.length, 0);
    ck_assert_double_eq(none.beyond, 1); /* the other sphere is there */
}

TEST(bad_arguments_and_short_arrays_are_refused) {
    OWNED_BED bed = packing(200, .8, 1.2, .5, 5, true);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED_WORK work = work_growing();
    OWNED_ROWS rows = {.memory = memory_growing()};
    fibrad_row row = row_of(200), small = {.capacity = 0};
    const fibrad_cast_rule bad[] = {{.random = 2}, {.random = -1}, {.cutoff = -1}, {.cutoff = NAN}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++)
        assert_invalid(fibrad_cast_row(scene, &work, 0, &bad[k], &row, NULL));
    assert_invalid(fibrad_cast_row(NULL, &work, 0, NULL, &row, NULL));
    assert_invalid(fibrad_cast_row(scene, NULL, 0, NULL, &row, NULL));
    assert_invalid(fibrad_cast_row(scene, &work, 200, NULL, &row, NULL));
    assert_invalid(fibrad_cast_row(scene, &work, 0, NULL, NULL, NULL));
    assert_invalid(fibrad_cast_row(scene, &work, 0, NULL, &row, &(fibrad_cast_means){NULL, NULL}));
    assert_ok(fibrad_cast_row(scene, &work, 0, NULL, &row, NULL));
    ck_assert_int_eq(fibrad_cast_row(scene, &work, 0, NULL, &small, NULL), FIBRAD_E_CAPACITY);
    ck_assert_uint_eq(small.length, row.length);
    assert_invalid(fibrad_cast_row(scene, &work, 0, NULL, &(fibrad_row){.rows = &rows},
                                   &(fibrad_cast_means){(double[200]){0}, (double[200]){0}}));
    ck_assert_uint_eq(rows.count, 0);

    /* a row in a collection is the same */
    fibrad_row added = {.rows = &rows};
    assert_ok(fibrad_cast_row(scene, &work, 0, NULL, &added, NULL));
    ck_assert_uint_eq(added.length, row.length);
    ck_assert_double_eq(added.error, row.error);
    OWNED_MATRIX m = matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.raw = 1});
    const fibrad_row kept = matrix_row(&m.factors, 0);
    ck_assert(same_bits(&row, &kept));
    row_free(&row);
}
