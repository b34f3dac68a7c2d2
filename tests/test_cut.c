/* test_cut.c - walls cut spheres: the part of a sphere behind a wall exchanges with that wall alone.
 * SPDX-License-Identifier: MIT */
#include "grey_rules.h"
#include "base/random.h"
#include "host_owned.h"
#include "scenes.h"
#include "suite.h"

/* The fraction f of a unit sphere's surface lies behind a plane at the distance h from its centre. Half of all lines
 * point to the plane. An element of the cap that is inclined to the plane by t sends (1 - cos t)/2 away from it. The
 * mean of this over the cap is f/2. */
static double to_plane(double h) {
    const double f = (1 - h) / 2;
    return .5 + f * f / 2;
}

static const double heights[] = {0, .5, .9};
#define HEIGHTS (sizeof heights / sizeof *heights)

/* A unit sphere whose centre lies at a height above a plane across some axis. */
static fibrad_scene *above(double height, int axis, int upper, fibrad_wall *plane) {
    OWNED_BED bed = BED({0, 0, 0, 1});
    *plane = plane_at(axis, upper, upper ? height : -height);
    fibrad_scene *scene = scene_with(&bed, &(fibrad_scene_config){.wall = plane, .walls = 1});
    return scene;
}

TEST(lone_sphere_by_beams) {
    static const uint32_t directions[] = {9, 100, 233}, points[] = {0, 128};
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(1);
    fibrad_wall plane;
    for (size_t k = 0; k < HEIGHTS; k++)
        for (int wall = 0; wall < 6; wall++) {
            OWNED fibrad_scene *scene = above(heights[k], wall / 2, wall % 2, &plane);
            for (int n = 0; n < 6; n++) {
                const fibrad_beam_rule rule = {.directions = directions[n / 2], .points = points[n % 2]};
                assert_ok(fibrad_beam_row(scene, &work, 0, &rule, &row));
                ck_assert_double_eq_tol(row.wall[0], to_plane(heights[k]), 1e-14);
                ck_assert_double_eq_tol(row.escaped, 1 - to_plane(heights[k]), 1e-14);
            }
        }
}

TEST(lone_sphere_by_rays) {
    const double emissivity = .5, black = 1, grey = .2;
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(2);
    fibrad_wall plane;
    for (size_t k = 0; k < HEIGHTS; k++) {
        OWNED fibrad_scene *scene = above(heights[k], 2, 0, &plane);
        const double expected = to_plane(heights[k]);
        assert_ok(fibrad_cast_row(scene, &work, 0, &(fibrad_cast_rule){.rays = 200000}, &row, NULL));
        ck_assert_double_eq_tol(row.wall[0], expected, 2e-4);
        fibrad_exchange_rule rule = {.emissivity = &emissivity, .wall_emissivity = &black, .paths = 100000};
        assert_ok(fibrad_exchange_row(scene, &work, 0, &rule, &row, NULL));
        ck_assert_double_eq_tol(row.wall[0], expected, 1e-14);
        ck_assert_uint_eq(row.length, 0);
        rule.wall_emissivity = &grey; /* light goes back and forth between cap and plane until it is absorbed */
        assert_ok(fibrad_exchange_row(scene, &work, 0, &rule, &row, NULL));
        ck_assert_double_ge(row.escaped, 1 - expected - 1e-12);
        ck_assert_double_le(row.escaped, 1 - (1 - heights[k]) / 2);
        fibrad_displacement displacement;
        rule.wall_emissivity = &black, rule.emissivity = &black;
        assert_ok(displacement_of(scene, &work, 0, &rule, &displacement));
        ck_assert_double_eq_tol(displacement.absorbed, 0, 1e-14);
    }
}

/* ---- heat ------------------------------------------------------------------------------------------------------- */

struct heat {
    double power[8], plane, sky;
};

/* Powers of the walls, in units in which sigma is 1. */
static struct heat heat_of(const struct bed *bed, const fibrad_wall *plane, const double *temperature,
                           const double *emissivity, const double of_plane[2], double sky) {
    const fibrad_spheres spheres = spheres_of(bed);
    OWNED_MADE *radiation = NULL;
    fibrad_heat_sources sources;
    struct heat heat;
    fibrad_heat_result result = {.power = heat.power, .wall_power = &heat.plane};
    assert_ok(made_with(&radiation, &(fibrad_scene_config){.wall = plane, .walls = 1}, &spheres, NULL, NULL));
    fibrad_heat_sources_init(&sources);
    sources.temperature = temperature, sources.emissivity = emissivity;
    sources.wall_temperature = of_plane, sources.wall_emissivity = of_plane + 1;
    sources.surroundings = sky, sources.sigma = 1, sources.tolerance = 1e-8;
    assert_ok(fibrad_bed_solve(radiation, &sources, NULL, &result));
    heat.sky = result.surroundings_power;
    return heat;
}

TEST(lone_sphere_by_heat) {
    const double hot = 1, black = 1, cold_black[] = {0, 1};
    OWNED_BED bed = BED({0, 0, 0, 1});
    for (size_t k = 0; k < HEIGHTS; k++)
        for (int wall = 0; wall < 6; wall++) {
            const fibrad_wall plane = plane_at(wall / 2, wall % 2, wall % 2 ? heights[k] : -heights[k]);
            const struct heat heat = heat_of(&bed, &plane, &hot, &black, cold_black, 0);
            ck_assert_double_eq_tol(heat.power[0], -4 * PI, 1e-2);
            ck_assert_double_eq_tol(heat.plane, 4 * PI * to_plane(heights[k]), 2e-2);
            ck_assert_double_eq_tol(heat.sky, 4 * PI * (1 - to_plane(heights[k])), 2e-2);
            ck_assert_double_eq_tol(heat.power[0] + heat.plane + heat.sky, 0, 1e-12);
        }
}

/* ---- several spheres -------------------------------------------------------------------------------------------- */

/* Spheres above a floor. It cuts the first two, .4 and .25 of a radius deep, and hardly cuts the third. */
static const double some[][4] = {
    {0, 0, .6, 1}, {1.9, .2, .55, .8}, {.9, 1.8, .999, 1}, {.8, .6, 2.1, .6}, {-1.2, .3, 2.3, .9}};
#define SOME (sizeof some / sizeof *some)

/* Where a ray ends: 0 to SOME - 1: on this sphere; SOME: at the floor; SOME + 1: in the sky. */
static uint32_t end_of(uint32_t from, const double o[3], const double w[3]) {
    double least = w[2] < 0 ? -o[2] / w[2] : INFINITY;
    uint32_t end = w[2] < 0 ? SOME : SOME + 1;
    if (o[2] < 0) return SOME;
    for (uint32_t j = 0; j < SOME; j++) {
        double along = 0, square = 0;
        for (int axis = 0; axis < 3; axis++) {
            const double e = some[j][axis] - o[axis];
            along += e * w[axis], square += e * e;
        }
        const double inside = along * along - square + some[j][3] * some[j][3];
        if (j == from || !(inside > 0) || along - sqrt(inside) < 0 || along - sqrt(inside) > least) continue;
        least = along - sqrt(inside), end = j;
    }
    return end;
}

/* Finds the factors of all rows by plain random rays. */
static void plain_factors(uint32_t rays, double f[SOME][SOME + 2]) {
    const fibrad_random stream = fibrad_random_start(1, 2);
    memset(f, 0, SOME * sizeof *f);
    for (uint32_t i = 0; i < SOME; i++)
        for (uint64_t k = 0; k < rays; k++) {
            double at[2][3], o[3], w[3], size = 0;
            for (uint64_t side = 0; side < 2; side++) {
                const uint64_t number = ((uint64_t)i * rays + k) * 4 + 2 * side;
                const double z = 2 * fibrad_fraction(fibrad_random_ahead(stream, number)) - 1;
                const double turn = 2 * PI * fibrad_fraction(fibrad_random_ahead(stream, number + 1));
                at[side][0] = sqrt(1 - z * z) * cos(turn), at[side][1] = sqrt(1 - z * z) * sin(turn), at[side][2] = z;
            }
            for (int axis = 0; axis < 3; axis++) {
                o[axis] = some[i][axis] + some[i][3] * at[0][axis];
                w[axis] = at[0][axis] + at[1][axis], size += w[axis] * w[axis];
            }
            for (int axis = 0; axis < 3; axis++) w[axis] /= sqrt(size);
            f[i][end_of(i, o, w)] += 1. / rays;
        }
}

/* The Euclidean distance of a row from the plain one. */
static double distance_of(const fibrad_row *row, const double f[SOME + 2]) {
    double square = pow(row->wall[0] - f[SOME], 2) + pow(row->escaped - f[SOME + 1], 2);
    for (uint32_t j = 0; j < SOME; j++) square += pow(row_factor(row, j) - f[j], 2);
    return sqrt(square);
}

/* Rays, paths and heat treat the caps exactly. Rows by beams take the mean over a cap. */
TEST(some_spheres) {
    double f[SOME][SOME + 2], by_rays = 0, by_beams = 0, by_points = 0, reciprocity = 0;
    OWNED_BED bed = bed_of(SOME, some);
    const fibrad_wall floor = plane_at(2, 0, 0);
    OWNED fibrad_scene *scene = scene_with(&bed, &(fibrad_scene_config){.wall = &floor, .walls = 1});
    OWNED_WORK work = work_growing();
    fibrad_row rays[SOME], row = row_of(SOME);
    const fibrad_beam_rule areas = {.directions = 987}, points = {.directions = 987, .points = 128};
    plain_factors(400000, f);
    for (uint32_t i = 0; i < SOME; i++) {
        rays[i] = row_of(SOME);
        ck_assert_int_eq(fibrad_cast_row(scene, &work, i, &(fibrad_cast_rule){.rays = 400000}, &rays[i], NULL), 0);
        worst_of(&by_rays, distance_of(&rays[i], f[i]));
        ck_assert_int_eq(fibrad_beam_row(scene, &work, i, &areas, &row), 0);
        worst_of(&by_beams, distance_of(&row, f[i]));
        ck_assert_int_eq(fibrad_beam_row(scene, &work, i, &points, &row), 0);
        worst_of(&by_points, distance_of(&row, f[i]));
        for (uint32_t j = 0; j < i; j++)
            worst_of(&reciprocity, fabs(some[i][3] * some[i][3] * row_factor(&rays[i], j) -
                                        some[j][3] * some[j][3] * row_factor(&rays[j], i)));
    }
    ck_assert_msg(by_rays < 2.5e-3 && reciprocity < 1e-3, "rays: %g, %g", by_rays, reciprocity);
    ck_assert_msg(by_beams < 8e-3 && by_points < 8e-3, "beams: %g, %g", by_beams, by_points);
    for (uint32_t i = 0; i < SOME; i++) row_free(&rays[i]);
    row_free(&row);
}

/* Rows are reciprocal and closed, as without cuts. */
TEST(matrix_of_some) {
    OWNED_BED bed = bed_of(SOME, some);
    const fibrad_wall floor = plane_at(2, 0, 0);
    OWNED fibrad_scene *scene = scene_with(&bed, &(fibrad_scene_config){.wall = &floor, .walls = 1});
    OWNED_MATRIX m = matrix_by_beams(scene, NULL, false);
    for (uint32_t i = 0; i < SOME; i++) {
        ck_assert_double_eq_tol(matrix_total(&m.factors, i), 1, 1e-14);
        for (uint32_t j = 0; j < i; j++)
            ck_assert_double_eq_tol(some[i][3] * some[i][3] * matrix_factor(&m.factors, i, j),
                                    some[j][3] * some[j][3] * matrix_factor(&m.factors, j, i), 1e-15);
    }
}

TEST(heat_of_some) {
    double f[SOME][SOME + 2], worst = 0, black[SOME], grey[SOME], warm[SOME];
    OWNED_BED bed = bed_of(SOME, some);
    const fibrad_wall floor = plane_at(2, 0, 0);
    const double cold[] = {0, 1}, warm_grey[] = {1, .3};
    plain_factors(400000, f);
    for (uint32_t j = 0; j < SOME; j++) black[j] = warm[j] = 1, grey[j] = .2 + .15 * j;
    for (uint32_t i = 0; i < SOME; i++) {
        const double area = 4 * PI * some[i][3] * some[i][3];
        double hot[SOME] = {0}, sum, square;
        hot[i] = 1;
        const struct heat heat = heat_of(&bed, &floor, hot, black, cold, 0),
                          lit = heat_of(&bed, &floor, hot, grey, cold, 0);
        square = pow(heat.plane / area - f[i][SOME], 2) + pow(heat.sky / area - f[i][SOME + 1], 2);
        for (uint32_t j = 0; j < SOME; j++)
            if (j != i) square += pow(heat.power[j] / area - f[i][j], 2);
        worst_of(&worst, sqrt(square));
        sum = lit.plane + lit.sky;
        for (uint32_t j = 0; j < SOME; j++) sum += lit.power[j];
        ck_assert_double_eq_tol(sum, 0, 1e-6);
    }
    ck_assert_msg(worst < 5e-3, "%g", worst);
    const struct heat even = heat_of(&bed, &floor, warm, grey, warm_grey, 1);
    for (uint32_t j = 0; j < SOME; j++) ck_assert_double_eq_tol(even.power[j], 0, 1e-9);
    ck_assert_double_eq_tol(even.plane, 0, 1e-9);
}

/* Lines that graze a cylinder meet it again. The mean over a cap beside the cylinder leaves this out. */
TEST(beside_a_cylinder) {
    OWNED_BED bed = BED({3.4, 0, 0, 1});
    const fibrad_wall wall[] = {cylinder_at(0, 0, 4), plane_at(2, 0, -1.2), plane_at(2, 1, 1.2)};
    OWNED fibrad_scene *scene = scene_with(&bed, &(fibrad_scene_config){.wall = wall, .walls = 3});
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(1), rays = row_of(1);
    ck_assert_int_eq(fibrad_beam_row(scene, &work, 0, &(fibrad_beam_rule){.directions = 987}, &row), 0);
    ck_assert_int_eq(fibrad_cast_row(scene, &work, 0, &(fibrad_cast_rule){.rays = 400000}, &rays, NULL), 0);
    for (int b = 0; b < 3; b++) ck_assert_double_eq_tol(row.wall[b], rays.wall[b], .4 * .04);
}
