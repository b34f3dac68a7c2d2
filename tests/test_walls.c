/* test_walls.c - walls of a scene: what a ray meets, rows that are closed in containers, the option --wall.
 * SPDX-License-Identifier: MIT */
#include "bed/wall_option.h"
#include "scene/walls.h"
#include "scenes.h"
#include "suite.h"

static double uniform(double low, double high) { return low + (high - low) * (rand() / (RAND_MAX + 1.0)); }

#define WALLS 7 /* x low, x high, y low, y high, z low, z high, cylinder, as the kernel has them inside */

/* Walls by place. */
struct container {
    uint32_t planes, open; /* sums of 1 << place; those of openings likewise */
    double at[6], cylinder[3];
};

/* The places of a configuration's walls. */
struct places {
    uint32_t count, place[WALLS];
    fibrad_wall wall[WALLS];
    uint32_t openings;
    fibrad_plane opening[6];
};

/* Orders in which walls are named. Results follow the order. */
static const uint32_t orders[][WALLS] = {
    {0, 1, 2, 3, 4, 5, 6}, {3, 6, 0, 5, 2, 4, 1}, {6, 5, 4, 3, 2, 1, 0}, {4, 2, 6, 1, 5, 3, 0}};
enum { ORDERS = sizeof orders / sizeof *orders };

static struct places places_of(const struct container *walls, const uint32_t order[WALLS]) {
    struct places places = {0};
    for (int k = 0; k < WALLS; k++) {
        const uint32_t place = order[k];
        if (walls->open >> place & 1)
            places.opening[places.openings++] = (fibrad_plane){(int)place / 2, place % 2, walls->at[place]};
        if (!(place == 6 ? walls->cylinder[2] > 0 : walls->planes >> place & 1)) continue;
        places.place[places.count] = place;
        places.wall[places.count++] = place == 6
                                          ? cylinder_at(walls->cylinder[0], walls->cylinder[1], walls->cylinder[2])
                                          : plane_at((int)place / 2, place % 2, walls->at[place]);
    }
    return places;
}

/* Makes a scene with walls; free(*scene) frees it. */
static int init(fibrad_scene **scene, const struct bed *bed, uint32_t walls, const fibrad_wall *wall,
                fibrad_fault *fault) {
    return scene_try(scene, bed, &(fibrad_scene_config){.wall = wall, .walls = walls}, fault);
}

static fibrad_scene *scene_at(const struct bed *bed, const struct places *places, int isa) {
    return scene_with(bed, &(fibrad_scene_config){.isa = isa,
                                                  .wall = places->wall,
                                                  .walls = places->count,
                                                  .opening = places->opening,
                                                  .openings = places->openings});
}

static fibrad_scene *scene_in(const struct bed *bed, const struct container *walls, int isa) {
    const struct places places = places_of(walls, orders[1]);
    return scene_at(bed, &places, isa);
}

/* Turns factors to walls, in the order in which they are named, into factors to walls by place. A wall that does not
 * exist has 0. */
static void by_place(const struct container *walls, const uint32_t order[WALLS], double wall[WALLS_MOST]) {
    const struct places places = places_of(walls, order);
    double ordered[WALLS] = {0};
    for (uint32_t b = 0; b < places.count; b++) ordered[places.place[b]] = wall[b];
    memcpy(wall, ordered, sizeof ordered);
}

/* Row i by beams, with the walls in row.wall by place. */
static fibrad_row beam_in_order(const struct bed *bed, const struct container *walls, const uint32_t order[WALLS],
                                uint32_t i, const fibrad_beam_rule *rule, int isa) {
    const struct places places = places_of(walls, order);
    OWNED fibrad_scene *scene = scene_at(bed, &places, isa);
    OWNED_WORK work = work_growing();
    fibrad_row row = row_of(1024);
    assert_ok(fibrad_beam_row(scene, &work, i, rule, &row));
    for (uint32_t b = places.count; b < WALLS_MOST; b++) ck_assert(row.wall[b] == 0); /* not touched */
    by_place(walls, order, row.wall);
    return row;
}

static fibrad_row beam(const struct bed *bed, const struct container *walls, uint32_t i, uint32_t directions,
                       uint32_t points, int isa) {
    const fibrad_beam_rule rule = {.directions = directions, .points = points};
    return beam_in_order(bed, walls, orders[1], i, &rule, isa);
}

/* Row i by rays in a scene of scene_in, with the walls by place. */
static void cast(const fibrad_scene *scene, const struct container *walls, fibrad_work *work, uint32_t i, uint32_t rays,
                 fibrad_row *row) {
    assert_ok(fibrad_cast_row(scene, work, i, &(fibrad_cast_rule){.rays = rays}, row, NULL));
    by_place(walls, orders[1], row->wall);
}

static fibrad_row lone(double x, double y, double z, double r, const struct container *walls, uint32_t directions) {
    OWNED_BED bed = BED({x, y, z, r});
    return beam(&bed, walls, 0, directions, 0, FIBRAD_ISA_BEST);
}

static double wall_sum(const fibrad_row *row) {
    double sum = 0;
    for (int k = 0; k < WALLS; k++) {
        ck_assert(row->wall[k] >= 0);
        sum += row->wall[k];
    }
    return sum;
}

static void assert_closed(const fibrad_row *row) {
    ck_assert(row->beyond == 0);
    ck_assert_double_eq_tol(row_sum(row) + wall_sum(row) + row->escaped, 1, 2e-15 * (10 + row->length));
}

/* What a sphere sends to a surface wholly on one side of it depends on its centre alone. An element of the surface sees
 * the whole sphere and receives dA cos r^2/d^2. So F is the solid angle over 4 pi. */
static double to_corner(double a, double b, double d) { return atan(a * b / (d * sqrt(a * a + b * b + d * d))); }

static double to_rectangle(double a0, double a1, double b0, double b1, double d) {
    return (to_corner(a1, b1, d) - to_corner(a0, b1, d) - to_corner(a1, b0, d) + to_corner(a0, b0, d)) / (4 * PI);
}

/* F to a disc of radius R at the distance d, whose axis is s < R away. The sum goes over the azimuths about the foot of
 * the distance, where the rim is rho(phi) away. It is the trapezium rule of a smooth periodic function. */
static double to_disc(double R, double s, double d) {
    double sum = 0;
    for (int k = 0; k < 2000; k++) {
        double phi = 2 * PI * (k + .5) / 2000, rho = s * cos(phi) + sqrt(R * R - s * s * sin(phi) * sin(phi));
        sum += 1 - d / sqrt(d * d + rho * rho);
    }
    return sum / 2000 / 2;
}

static const struct container box10 = {.planes = 63, .at = {0, 10, 0, 10, 0, 10}};
static const struct container can10 = {.planes = 48, .at = {0, 0, 0, 0, 0, 10}, .cylinder = {5, 5, 5}};

TEST(bad_walls_are_refused) {
    const double spheres[][4] = {{5, 5, 5, 1}, {2, 5, 5, 1}, {5, 5, 9.5, 1}};
    OWNED_BED bed = bed_of(3, spheres);
    OWNED fibrad_scene *scene = NULL;
    fibrad_fault fault;
    free(scene_in(&bed, &box10, 0)); /* a sphere may reach through a wall */
    const fibrad_wall z_low = plane_at(2, 0, 0), x_low = plane_at(0, 0, 0), y_high = plane_at(1, 1, 20),
                      can = cylinder_at(5, 5, 9);
    const struct {
        uint32_t count;
        fibrad_wall wall[2];
    } bad[] = {{1, {{.kind = 0}}},
               {1, {{.kind = 4}}},
               {1, {plane_at(3, 0, 0)}},
               {1, {plane_at(-1, 0, 0)}},
               {1, {plane_at(0, 2, 0)}},
               {2, {plane_at(0, 0, 6), plane_at(0, 1, 6)}},
               {2, {z_low, z_low}}, /* two planes have the same side */
               {1, {plane_at(0, 0, NAN)}},
               {1, {plane_at(0, 0, -1e200)}},
               {1, {cylinder_at(5, 5, 0)}},
               {1, {cylinder_at(5, 5, NAN)}},
               {1, {cylinder_at(INFINITY, 0, 1)}},
               {2, {can, can}},
               {2, {x_low, can}},
               {2, {can, y_high}}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        fault = (fibrad_fault){9, 9, 9, 0, 0};
        ck_assert_msg(init(&scene, &bed, bad[k].count, bad[k].wall, &fault) == FIBRAD_E_ARGUMENT, "walls %zu", k);
        ck_assert(fault.first == 3 && fault.second == 3); /* none of the spheres */
        assert_invalid(init(&scene, &bed, bad[k].count, bad[k].wall, NULL));
    }
    assert_invalid(init(&scene, &bed, 1, NULL, &fault));
    const struct {
        fibrad_wall wall;
        uint32_t whose;
    } beyond[] = {{plane_at(0, 0, 3), 1},
                  {plane_at(2, 1, 9.25), 2},
                  {plane_at(2, 0, -1e20), 3}, /* too far away for the digits of coordinates: no sphere is named */
                  {cylinder_at(5, 5, 2.5), 1}};
    for (size_t k = 0; k < 4; k++) {
        fault = (fibrad_fault){9, 9, 9, 0, 0};
        bed.period[2] = k == 3 ? 20 : 0;
        assert_invalid(init(&scene, &bed, 1, &beyond[k].wall, &fault));
        ck_assert_uint_eq(fault.first, beyond[k].whose);
        ck_assert_uint_eq(fault.second, beyond[k].whose);
    }
    bed.period[0] = 20;
    assert_invalid(init(&scene, &bed, 1, &x_low, &fault)); /* on a periodic axis */
    assert_invalid(init(&scene, &bed, 1, &can, &fault));
    bed.period[0] = 0, bed.period[1] = 20;
    assert_invalid(init(&scene, &bed, 1, &y_high, &fault));
    assert_invalid(init(&scene, &bed, 1, &can, &fault));
    bed.period[1] = 0, bed.period[2] = 20;
    assert_invalid(init(&scene, &bed, 1, &z_low, &fault));
    assert_ok(init(&scene, &bed, 1, &can, &fault));
}

/* More walls than there may be, a side twice, and a mesh without triangles. */
TEST(what_is_not_supported) {
    OWNED_BED bed = BED({5, 5, 5, 1});
    fibrad_scene *scene = NULL;
    fibrad_fault fault;
    fibrad_wall walls[FIBRAD_WALLS_MAX + 1];
    for (int k = 0; k <= FIBRAD_WALLS_MAX; k++) walls[k] = plane_at(k / 2 % 3, k % 2, k % 2 ? 10 : 0);
    ck_assert_int_eq(init(&scene, &bed, FIBRAD_WALLS_MAX + 1, walls, &fault), FIBRAD_E_UNSUPPORTED);
    assert_invalid(init(&scene, &bed, 7, walls, &fault)); /* a side twice */
    assert_ok(init(&scene, &bed, 6, walls, &fault));
    free(scene), scene = NULL;
    const fibrad_wall mesh = {.kind = FIBRAD_WALL_MESH}; /* without triangles */
    assert_invalid(init(&scene, &bed, 1, &mesh, &fault));
    walls[5] = mesh;
    assert_invalid(init(&scene, &bed, 6, walls, &fault));
    ck_assert_ptr_null(scene);
}

/* The mean factors of all spheres to the walls, by 14 windows of 64 points that are turned at random, many times.
 * error: their standard errors. */
static void mean_of_turns(const struct bed *bed, const fibrad_scene *scene, double mean[WALLS + 1],
                          double error[WALLS + 1]) {
    const uint32_t turns = 400;
    double square[WALLS + 1] = {0};
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(1024);
    for (int k = 0; k <= WALLS; k++) mean[k] = 0;
    for (uint32_t turn = 1; turn <= turns; turn++) {
        double sum[WALLS + 1] = {0};
        for (uint32_t i = 0; i < bed->n; i++) {
            const fibrad_beam_rule rule = {.directions = 14, .points = 64, .turn = turn * bed->n + i};
            assert_ok(fibrad_beam_row(scene, &work, i, &rule, &row));
            for (int k = 0; k < WALLS; k++) sum[k] += row.wall[k] / bed->n;
            sum[WALLS] += row.escaped / bed->n;
        }
        for (int k = 0; k <= WALLS; k++) mean[k] += sum[k] / turns, square[k] += sum[k] * sum[k] / turns;
    }
    for (int k = 0; k <= WALLS; k++) error[k] = sqrt(fmax(0, square[k] - mean[k] * mean[k]) / turns);
}

/* Few windows that are turned at random have no bias: the mean over many turns is the factor. */
TEST(few_turned_windows_have_no_bias) {
    OWNED_BED bed = packing(60, .6, 1.4, .3, 3, false);
    const struct container walls[] = {{.planes = 31, .open = 32, .at = {-2, 12, -2, 12, -2, 12}},
                                      {.planes = 48, .at = {[4] = -2, [5] = 13}, .cylinder = {5, 5, 11}},
                                      {.planes = 48, .at = {[4] = -2, [5] = 13}}};
    for (size_t which = 0; which < sizeof walls / sizeof *walls; which++) {
        OWNED fibrad_scene *scene = scene_in(&bed, &walls[which], 0);
        double mean[WALLS + 1], error[WALLS + 1], truth[WALLS + 1] = {0};
        OWNED_WORK work = work_growing();
        OWNED_ROW row = row_of(1024);
        for (uint32_t i = 0; i < bed.n; i++) {
            assert_ok(fibrad_beam_row(scene, &work, i, &(fibrad_beam_rule){.directions = 2000}, &row));
            for (int k = 0; k < WALLS; k++) truth[k] += row.wall[k] / bed.n;
            truth[WALLS] += row.escaped / bed.n;
        }
        mean_of_turns(&bed, scene, mean, error);
        for (int k = 0; k <= WALLS; k++)
            ck_assert_double_eq_tol(mean[k], truth[k], 4 * error[k] + 5e-4 * truth[k] + 1e-9);
    }
}

/* Factors follow the index of the wall and have the same bits, in whatever order walls are named. */
TEST(walls_in_any_order) {
    OWNED_BED bed = packing(60, .6, 1.4, .3, 3, false);
    const struct container walls[] = {{.planes = 63, .at = {-3, 40, -4, 41, -5, 42}},
                                      {.planes = 48, .at = {[4] = -3, [5] = 40}, .cylinder = {5, 6, 30}}};
    for (int k = 0; k < 2; k++)
        for (uint32_t points = 0; points <= 64; points += 64) {
            const fibrad_beam_rule rule = {.directions = 101, .points = points};
            OWNED_ROW first = beam_in_order(&bed, &walls[k], orders[0], 7, &rule, 0);
            for (int order = 1; order < ORDERS; order++) {
                OWNED_ROW row = beam_in_order(&bed, &walls[k], orders[order], 7, &rule, 0);
                ck_assert(same_bits_with(&row, &first, WALLS));
            }
        }
}

/* An opening gets what a plane in its place would get, to the bit, by each method. Nothing else changes, and spheres do
 * not reach beyond it. */
TEST(openings_take_what_planes_would) {
    OWNED_BED bed = packing(80, .6, 1.4, .4, 3, false);
    double top = -1e9;
    for (uint32_t i = 0; i < bed.n; i++) worst_of(&top, bed.z[i] + bed.r[i]);
    const struct container box = {.planes = 63, .at = {-3, 20, -4, 21, -5, top}},
                           can = {.planes = 48, .at = {[4] = -5, [5] = top}, .cylinder = {5, 6, 15}};
    OWNED_WORK work = work_growing();
    OWNED_ROW rays = row_of(1024), open_rays = row_of(1024);
    for (int k = 0; k < 4; k++) {
        const struct container closed = k % 2 ? can : box;
        struct container open = closed;
        open.open = k < 2 ? 32 : k == 2 ? 58 : 48, open.planes &= ~open.open; /* one; several */
        OWNED fibrad_scene *scene = scene_in(&bed, &closed, 0), *opened = scene_in(&bed, &open, 0);
        for (uint32_t i = 0; i < bed.n; i += 9) {
            double of_planes = 0, of_rays = 0;
            OWNED_ROW row = beam(&bed, &closed, i, 101, i % 2 ? 64 : 0, 0);
            OWNED_ROW open_row = beam(&bed, &open, i, 101, i % 2 ? 64 : 0, 0);
            cast(scene, &closed, &work, i, 2000, &rays);
            cast(opened, &open, &work, i, 2000, &open_rays);
            for (uint32_t wall = 0; wall < 6; wall++) {
                if (!(open.open >> wall & 1)) continue;
                of_planes += row.wall[wall], of_rays += rays.wall[wall];
                row.wall[wall] = rays.wall[wall] = 0;
            }
            ck_assert_double_eq_tol(open_row.escaped, row.escaped + of_planes, 1e-15);
            ck_assert_double_eq_tol(open_rays.escaped, of_rays, 1e-15);
            ck_assert(of_planes > 0);
            row.escaped = open_row.escaped, rays.escaped = open_rays.escaped;
            ck_assert(same_bits_with(&row, &open_row, WALLS) && same_bits_with(&rays, &open_rays, WALLS));
            assert_closed(&open_row);
        }
    }
}

/* Returns the status for walls and openings about a sphere at (5, 5, 5) of radius 1. */
static int status_of(const struct container *walls, const double period[3], fibrad_fault *fault) {
    OWNED_BED bed = BED({5, 5, 5, 1});
    const struct places places = places_of(walls, orders[0]);
    memcpy(bed.period, period, sizeof bed.period);
    OWNED fibrad_scene *scene = NULL;
    const int status = scene_try(
        &scene, &bed,
        &(fibrad_scene_config){
            .wall = places.wall, .walls = places.count, .opening = places.opening, .openings = places.openings},
        fault);
    return status;
}

/* Of all containers, those are endless that are not closed across several axes, and cylinders without ends. */
TEST(walls_without_an_end_are_refused) {
    for (uint32_t periods = 0; periods < 8; periods++)
        for (uint32_t sides = 0; sides < 64; sides++)
            for (uint32_t open = 0; open < 64; open += 21)
                for (int round = 0; round < 2; round++) {
                    struct container walls = {.at = {0, 10, 0, 10, 0, 10}, .cylinder = {5, 5, round ? 9 : 0}};
                    double period[3];
                    bool closed = true, fits = true;
                    uint32_t walled = 0;
                    walls.planes = sides & ~open, walls.open = sides & open;
                    for (uint32_t axis = 0; axis < 3; axis++) {
                        const uint32_t both = sides >> 2 * axis & 3;
                        period[axis] = periods >> axis & 1 ? 12 : 0;
                        walled += both > 0;
                        fits = fits && !(both > 0 && period[axis] > 0);
                        fits = fits && !(round && axis < 2 && (both > 0 || period[axis] > 0));
                        closed = closed && (both == 3 || period[axis] > 0 || (round && axis < 2));
                    }
                    const bool endless = (round || walled > 1) && !closed;
                    const int expected = !fits ? FIBRAD_E_ARGUMENT : endless ? FIBRAD_E_ENDLESS : FIBRAD_OK;
                    fibrad_fault fault = {9, 9, 9, 0, 0};
                    ck_assert_msg(status_of(&walls, period, &fault) == expected, "sides %u, periods %u, round %d",
                                  sides, periods, round);
                    if (expected != FIBRAD_OK) ck_assert(fault.first == 1 && fault.second == 1);
                }
}

TEST(bad_openings_are_refused) {
    const double none[3] = {0, 0, 0}, along_z[3] = {0, 0, 20};
    fibrad_fault fault;
    struct container walls = {.open = 32, .at = {[5] = 6}};
    assert_ok(status_of(&walls, none, &fault)); /* touches */
    walls.at[5] = 6 - 1e-15;
    assert_ok(status_of(&walls, none, &fault)); /* but for rounding */
    for (int k = 0; k < 2; k++) {
        walls.at[5] = k == 0 ? 6 - 1e-9 : 3; /* the sphere reaches beyond it, and then its centre is beyond */
        ck_assert_int_eq(status_of(&walls, none, &fault), FIBRAD_E_GEOMETRY);
        ck_assert(fault.first == 0 && fault.second == 0);
    }
    ck_assert_int_eq(status_of(&(struct container){.open = 1, .at = {4 + 1e-9}}, none, &fault), FIBRAD_E_GEOMETRY);
    assert_ok(status_of(&(struct container){.open = 1, .at = {4}}, none, &fault));
    const struct container bad[] = {{.open = 32, .at = {[5] = NAN}},
                                    {.open = 32, .at = {[5] = INFINITY}},
                                    {.open = 32, .planes = 32, .at = {[5] = 9}},
                                    {.open = 32, .planes = 16, .at = {[4] = 9, [5] = 9}}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) assert_invalid(status_of(&bad[k], none, &fault));
    walls.at[5] = 9;
    assert_invalid(status_of(&walls, along_z, &fault));
    OWNED_BED bed = BED({5, 5, 5, 1});
    fibrad_scene *scene = NULL;
    const fibrad_plane twice[] = {{2, 1, 9}, {2, 1, 9}}, axis = {3, 1, 9};
    assert_invalid(scene_try(&scene, &bed, &(fibrad_scene_config){.openings = 1}, NULL));
    assert_invalid(scene_try(&scene, &bed, &(fibrad_scene_config){.opening = twice, .openings = 2}, NULL));
    assert_invalid(scene_try(&scene, &bed, &(fibrad_scene_config){.opening = &axis, .openings = 1}, NULL));
}

TEST(areas_of_walls) {
    OWNED_BED bed = BED({5, 5, 5, 1});
    const struct container walls[] = {{.planes = 63, .at = {0, 10, 1, 10, 3, 10}},
                                      can10,
                                      {.planes = 16},
                                      {.planes = 48, .at = {[5] = 10}},
                                      {.cylinder = {5, 5, 5}}};
    const double inf = INFINITY, area[][WALLS] = {{63, 63, 70, 70, 90, 90, 0},
                                                  {0, 0, 0, 0, 25 * PI, 25 * PI, 100 * PI},
                                                  {0, 0, 0, 0, inf, 0, 0},
                                                  {0, 0, 0, 0, 12, 12, 0},
                                                  {0, 0, 0, 0, 0, 0, 70 * PI}};
    for (size_t k = 0; k < 5; k++)
        for (int order = 0; order < ORDERS; order++) {
            bed.period[0] = k == 3 ? 3 : 0, bed.period[1] = k == 3 ? 4 : 0, bed.period[2] = k == 4 ? 7 : 0;
            const struct places places = places_of(&walls[k], orders[order]);
            OWNED fibrad_scene *scene = NULL;
            fibrad_scene_facts facts;
            assert_ok(init(&scene, &bed, places.count, places.wall, NULL));
            fibrad_scene_describe(scene, &facts);
            ck_assert_uint_eq(facts.walls, places.count);
            for (uint32_t b = 0; b < places.count; b++) {
                const double is = fibrad_scene_wall_area(scene, b), should = area[k][places.place[b]];
                ck_assert(is == should || fabs(is - should) < 1e-12);
            }
            ck_assert_double_nan(fibrad_scene_wall_area(scene, places.count));
            ck_assert_double_nan(fibrad_scene_wall_area(scene, UINT32_MAX));
        }
    ck_assert_double_nan(fibrad_scene_wall_area(NULL, 0));
}

/* How far a place lies within a wall. */
static double within(const struct container *walls, uint32_t wall, const double at[3]) {
    if (wall == 6) return walls->cylinder[2] - hypot(at[0] - walls->cylinder[0], at[1] - walls->cylinder[1]);
    return wall % 2 ? walls->at[wall] - at[wall / 2] : at[wall / 2] - walls->at[wall];
}

static bool has(const struct container *walls, uint32_t wall) {
    return wall == 6 ? walls->cylinder[2] > 0 : walls->planes >> wall & 1;
}

static void assert_exit(const fibrad_scene *scene, const struct container *walls, const double o[3], const double w[3],
                        uint32_t from) {
    double distance, at[3], normal[3], middle[3];
    uint32_t wall = fibrad_walls_exit(scene, o, w, &distance);
    ck_assert(wall != from);
    for (uint32_t k = 0; k < WALLS && wall == FIBRAD_NONE; k++) /* then no wall lies ahead */
        if (has(walls, k))
            for (double far = 1; far < 1e9; far *= 1e3)
                ck_assert(within(walls, k, (double[]){o[0] + far * w[0], o[1] + far * w[1], o[2] + far * w[2]}) > 0);
    if (wall == FIBRAD_NONE) {
        ck_assert(distance == INFINITY);
        return;
    }
    for (int axis = 0; axis < 3; axis++) {
        at[axis] = o[axis] + distance * w[axis];
        middle[axis] = o[axis] + .5 * distance * w[axis];
    }
    ck_assert(has(walls, wall) && distance > 0);
    ck_assert_double_eq_tol(within(walls, wall, at), 0, 1e-11);
    for (uint32_t k = 0; k < WALLS; k++)
        if (has(walls, k)) ck_assert(within(walls, k, at) > -1e-11 && within(walls, k, middle) > -1e-11);
    fibrad_wall_normal(scene, wall, at, normal);
    ck_assert_double_eq_tol(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2], 1, 1e-14);
    ck_assert(normal[0] * w[0] + normal[1] * w[1] + normal[2] * w[2] < 1e-9);
    double inside[3] = {at[0] + .01 * normal[0], at[1] + .01 * normal[1], at[2] + .01 * normal[2]};
    ck_assert_double_eq_tol(within(walls, wall, inside), .01, 1e-11);
}

/* A ray that goes on inwards from the wall that it met comes to another wall, or to the same cylinder farther on. A ray
 * outwards is at this wall at once. This holds also if rounding, or more, has put the place beyond the wall. */
TEST(a_ray_leaves_through_the_first_wall) {
    const struct container walls[] = {box10,
                                      can10,
                                      {.planes = 1},
                                      {.planes = 48, .at = {[5] = 10}},
                                      {.planes = 32, .at = {[5] = 10}},
                                      {.cylinder = {5, 5, 5}}};
    OWNED_BED bed = BED({5, 5, 5, 1});
    srand(1);
    for (size_t k = 0; k < sizeof walls / sizeof *walls; k++) {
        bed.period[2] = k == 5 ? 20 : 0;
        OWNED fibrad_scene *scene = scene_in(&bed, &walls[k], 0);
        for (int ray = 0; ray < 10000; ray++) {
            double o[3], w[3], distance, normal[3], on[3];
            for (int axis = 0; axis < 3; axis++) o[axis] = uniform(1.5, 8.5), w[axis] = uniform(-1, 1);
            if (ray % 4 == 1) w[ray / 4 % 3] = 0;
            if (ray % 4 == 2) w[ray / 4 % 3] = 0, w[(ray / 4 + 1) % 3] = 0;
            assert_exit(scene, &walls[k], o, w, FIBRAD_NONE - 1);
            uint32_t wall = fibrad_walls_exit(scene, o, w, &distance);
            if (wall == FIBRAD_NONE) continue;
            for (int axis = 0; axis < 3; axis++) on[axis] = o[axis] + distance * w[axis];
            fibrad_wall_normal(scene, wall, on, normal);
            double beyond = ray % 3 == 0 ? 0 : ray % 3 == 1 ? 1e-12 : 1e-3, lean = 0;
            for (int axis = 0; axis < 3; axis++) on[axis] -= beyond * normal[axis], w[axis] = uniform(-1, 1);
            for (int axis = 0; axis < 3; axis++) lean += w[axis] * normal[axis];
            if (fabs(lean) < .2) continue;
            for (int axis = 0; axis < 3 && lean > 0; axis++) w[axis] = -w[axis]; /* outwards */
            bool corner = false; /* the place is beyond several walls: any of them is right */
            for (uint32_t other = 0; other < WALLS; other++)
                corner |= other != wall && has(&walls[k], other) && within(&walls[k], other, on) < .05;
            if (corner) continue;
            ck_assert_uint_eq(fibrad_walls_exit(scene, on, w, &distance), wall);
            ck_assert_double_le(distance, 1e-12);
            for (int axis = 0; axis < 3; axis++) w[axis] = -w[axis]; /* inwards */
            assert_exit(scene, &walls[k], on, w, wall == 6 ? FIBRAD_NONE - 1 : wall);
        }
    }
}

/* Nothing hides the plane, whose solid angle is half of all. */
TEST(half_of_a_sphere_sees_a_plane) {
    const uint32_t directions[] = {8, 9, 100, 101, 233, 987, 1000};
    for (size_t k = 0; k < sizeof directions / sizeof *directions; k++)
        for (uint32_t wall = 0; wall < 6; wall++) {
            const struct container plane = {.planes = 1u << wall, .at = {-1, 1, -1, 1, -1, 1}};
            OWNED_ROW row = lone(0, 0, 0, 1, &plane, directions[k]);
            double tolerance = 1e-14;
            ck_assert_double_eq_tol(row.wall[wall], .5, tolerance);
            ck_assert_double_eq_tol(row.escaped, .5, tolerance);
            assert_closed(&row);
        }
    const struct container slit = {.planes = 48, .at = {[4] = -1.5, [5] = 40}};
    OWNED_ROW row = lone(0, 0, 0, 2, &slit, 101); /* a plane cuts off an eighth of the surface: tests/test_cut.c */
    ck_assert_double_eq_tol(row.wall[4], .5 + 1. / 128, 1e-14);
    ck_assert_double_eq_tol(row.wall[5], .5 - 1. / 128, 1e-14);
    ck_assert(row.escaped == 0);
}

/* A sphere stands in boxes of 2.5 to 1000 radii, among them boxes whose walls touch it. Factors are the solid angles,
 * with hardly any error. */
TEST(sphere_in_a_box) {
    srand(2);
    const uint32_t directions[3] = {50, 233, 987};
    for (int k = 0; k < 3; k++)
        for (int t = 0; t < 40; t++) {
            double side[3], c[3], r = uniform(.5, 2);
            struct container box = {.planes = 63};
            for (int axis = 0; axis < 3; axis++) {
                side[axis] = r * 2.5 * pow(400, t / 39.) * uniform(1, 2);
                box.at[2 * axis] = uniform(-9, 9);
                box.at[2 * axis + 1] = box.at[2 * axis] + side[axis];
                c[axis] = t % 4 == axis ? r : uniform(r, side[axis] - r);
            }
            OWNED_ROW row = lone(box.at[0] + c[0], box.at[2] + c[1], box.at[4] + c[2], r, &box, directions[k]);
            for (uint32_t wall = 0; wall < 6; wall++) {
                uint32_t a = wall / 2, b = (a + 1) % 3, d = (a + 2) % 3;
                double away = wall % 2 ? side[a] - c[a] : c[a];
                double exact = to_rectangle(-c[b], side[b] - c[b], -c[d], side[d] - c[d], away);
                ck_assert_double_eq_tol(row.wall[wall], exact, 1e-12);
            }
            ck_assert(row.escaped == 0);
            ck_assert_double_le(row.error, 1e-12);
            assert_closed(&row);
        }
}

/* A sphere is .002 to 1.5 radii away from one wall and far from others. From where the wall does not touch it to where
 * the wall cuts it, factors change little by little. */
TEST(factors_are_smooth_where_walls_touch) {
    double before[6] = {0};
    for (int k = 0; k <= 400; k++) {
        const double away = 1.2 - .001 * k;
        OWNED_ROW row = lone(3, 4, away, 1, &(struct container){.planes = 63, .at = {0, 7, 0, 9, 0, 8}}, 233);
        for (int wall = 0; wall < 6; wall++) {
            const double change = fabs(row.wall[wall] - before[wall]);
            if (k > 0) ck_assert_msg(change < 3e-4, "%g at %g", change, away);
            before[wall] = row.wall[wall];
        }
        assert_closed(&row);
    }
}

/* A sphere lies on top of a heap in a wide box and in a wide cylinder. Its factors to the walls at 233 directions are
 * compared with those at many. */
TEST(walls_of_a_heap) {
    OWNED_BED bed = packing(150, .8, 1.2, .5, 1, false);
    const struct container walls[] = {{.planes = 63, .at = {-20, 40, -9, 30, -1, 50}},
                                      {.planes = 48, .at = {[4] = -1, [5] = 30}, .cylinder = {6, 6, 25}}};
    const double bound[] = {9e-4, 1e-3};
    double top = 0;
    for (uint32_t i = 0; i < bed.n; i++) worst_of(&top, bed.z[i]);
    for (int k = 0; k < 2; k++) {
        double square = 0, far = 0;
        uint32_t rows = 0;
        for (uint32_t i = 0; i < bed.n; i++) {
            if (bed.z[i] < top - 2.5) continue;
            OWNED_ROW row = beam(&bed, &walls[k], i, 233, 0, 0), fine = beam(&bed, &walls[k], i, 20000, 0, 0);
            for (int wall = 0; wall < WALLS; wall++) square += pow(row.wall[wall] - fine.wall[wall], 2);
            far += wall_sum(&fine);
            rows++;
        }
        printf("%u rows, walls get %.2f: RMS error %.2g\n", rows, far / rows, sqrt(square / rows));
        ck_assert(rows > 10 && far / rows > .3);
        ck_assert_double_lt(sqrt(square / rows), bound[k]);
    }
}

TEST(sphere_in_a_cylinder) {
    srand(3);
    for (int t = 0; t < 40; t++) {
        double R = 1.5 * pow(200, t / 39.), h = R * uniform(.8, 3) + 2, z = uniform(1, h - 1), s = uniform(0, R - 1);
        double phi = uniform(0, 2 * PI), bottom = to_disc(R, s, z), top = to_disc(R, s, h - z);
        for (uint32_t kind = 0; kind < 3; kind++) { /* a closed can, one open above, an open one */
            struct container can = {.planes = kind == 0 ? 48 : kind == 1 ? 16 : 0, .at = {[4] = 2, [5] = 2 + h}};
            can.open = 48 & ~can.planes;
            can.cylinder[0] = 3, can.cylinder[1] = -4, can.cylinder[2] = R;
            OWNED_ROW row = lone(3 + s * cos(phi), -4 + s * sin(phi), 2 + z, 1, &can, 987);
            if (kind == 0) ck_assert_double_eq_tol(row.wall[5], top, 2e-5);
            if (kind < 2) ck_assert_double_eq_tol(row.wall[4], bottom, 2e-5);
            ck_assert_double_eq_tol(row.escaped, kind == 0 ? 0 : kind == 1 ? top : bottom + top, 2e-5);
            ck_assert_double_eq_tol(row.wall[6], 1 - bottom - top, 2e-5);
            assert_closed(&row);
        }
    }
}

/* Within a container, a slit or a cylinder spheres see each other as they do without walls, and the walls get the
 * rest. */
TEST(walls_take_what_escapes) {
    OWNED_BED bed = packing(150, .8, 1.2, .4, 1, false);
    double low[3] = {1e9, 1e9, 1e9}, high[3] = {-1e9, -1e9, -1e9};
    for (uint32_t i = 0; i < bed.n; i++)
        for (int axis = 0; axis < 3; axis++) {
            double c = axis == 0 ? bed.x[i] : axis == 1 ? bed.y[i] : bed.z[i];
            least_of(&low[axis], c - bed.r[i]), worst_of(&high[axis], c + bed.r[i]);
        }
    struct container walls[4] = {{.planes = 63}, {.planes = 48}, {.planes = 48}, {.planes = 29, .open = 34}};
    for (int k = 0; k < 4; k++)
        for (int axis = 0; axis < 3; axis++) walls[k].at[2 * axis] = low[axis], walls[k].at[2 * axis + 1] = high[axis];
    walls[2].cylinder[0] = (low[0] + high[0]) / 2, walls[2].cylinder[1] = (low[1] + high[1]) / 2;
    walls[2].cylinder[2] = hypot(high[0] - low[0], high[1] - low[1]) / 2;
    OWNED_WORK work = work_growing();
    OWNED_ROW rays = row_of(1024);
    double worst = 0;
    for (int k = 0; k < 4; k++) {
        OWNED fibrad_scene *scene = scene_in(&bed, &walls[k], 0);
        for (uint32_t i = 0; i < bed.n; i += 11)
            for (uint32_t points = 0; points <= 256; points += 128) {
                OWNED_ROW free_row = beam(&bed, &(struct container){0}, i, 610, points, 0);
                OWNED_ROW row = beam(&bed, &walls[k], i, 610, points, 0);
                ck_assert_uint_eq(row.length, free_row.length);
                ck_assert_mem_eq(row.f, free_row.f, row.length * sizeof *row.f);
                ck_assert_double_eq_tol(wall_sum(&row) + row.escaped, free_row.escaped, 5e-14);
                if (k != 3) ck_assert_int_eq(row.escaped == 0, k == 0 || k == 2 || wall_sum(&row) > 0);
                assert_closed(&row);
                cast(scene, &walls[k], &work, i, 50000, &rays);
                assert_closed(&rays);
                for (int wall = 0; wall < WALLS; wall++) worst_of(&worst, fabs(rays.wall[wall] - row.wall[wall]));
                worst_of(&worst, fabs(rays.escaped - row.escaped));
            }
    }
    ck_assert_msg(worst < 5e-3, "beams and rays differ by %g", worst);
}

/* The open axis of a periodic bed has walls. */
TEST(walls_of_a_periodic_bed) {
    OWNED_BED bed = packing(120, 1, 1, .3, 2, true);
    bed.period[2] = 0;
    double low = 1e9, high = -1e9;
    for (uint32_t i = 0; i < bed.n; i++) least_of(&low, bed.z[i] - 1), worst_of(&high, bed.z[i] + 1);
    const struct container slit = {.planes = 48, .at = {[4] = low, [5] = high}};
    OWNED fibrad_scene *scene = scene_in(&bed, &slit, 0);
    OWNED_WORK work = work_growing();
    OWNED_ROW rays = row_of(1024);
    for (uint32_t i = 0; i < bed.n; i += 17) {
        OWNED_ROW row = beam(&bed, &slit, i, 987, 0, 0);
        cast(scene, &slit, &work, i, 50000, &rays);
        assert_closed(&rays);
        ck_assert(row.escaped == 0 && rays.escaped == 0);
        assert_closed(&row);
        for (int wall = 4; wall < 6; wall++) ck_assert_double_eq_tol(row.wall[wall], rays.wall[wall], 3e-3);
    }
}

/* Another order of the spheres and another unit of length change nothing but rounding. Other axes change no more than
 * the rule's error. */
TEST(order_scale_and_axes) {
    const struct container box = {.planes = 63, .at = {-2, 14, -3, 16, -4, 15}};
    OWNED_BED bed = packing(50, .8, 1.2, .2, 4, false), other = bed_empty(), turned = bed_empty();
    struct container scaled = box, cyclic = box;
    for (int k = 0; k < 6; k++) scaled.at[k] *= 4, cyclic.at[(k + 2) % 6] = box.at[k];
    for (uint32_t i = 0; i < bed.n; i++) {
        uint32_t j = bed.n - 1 - i;
        add_sphere(&other, 4 * bed.x[j], 4 * bed.y[j], 4 * bed.z[j], 4 * bed.r[j]);
        add_sphere(&turned, bed.z[i], bed.x[i], bed.y[i], bed.r[i]);
    }
    for (uint32_t i = 0; i < bed.n; i += 7) {
        OWNED_ROW row = beam(&bed, &box, i, 987, 0, 0), again = beam(&other, &scaled, bed.n - 1 - i, 987, 0, 0);
        OWNED_ROW round = beam(&turned, &cyclic, i, 987, 0, 0);
        for (int wall = 0; wall < 6; wall++) {
            ck_assert_double_eq_tol(row.wall[wall], again.wall[wall], 1e-12);
            ck_assert_double_eq_tol(row.wall[wall], round.wall[(wall + 2) % 6], 2e-3);
        }
    }
}

/* Makes a matrix of three reciprocal rows in a scene with three walls. The halves of the rows agree: no row has
 * noise. */
static struct matrix closed(const double wall[3][3], const double escaped[3]) {
    OWNED_BED bed = BED({0, 0, 50, 1}, {0, 0, 10, 1}, {0, 0, 90, 2});
    const fibrad_wall walls[] = {plane_at(2, 0, 0), cylinder_at(0, 0, 99), plane_at(2, 1, 100)};
    OWNED fibrad_scene *scene = scene_with(&bed, &(fibrad_scene_config){.wall = walls, .walls = 3});
    OWNED_ROWS rows = {.memory = memory_growing()};
    uint32_t col[][2] = {{1, 0}, {0, 2}, {1, 0}};
    double f[][2] = {{.5, 0}, {.5, .4}, {.1, 0}}, own[3];
    float half[2] = {0, 0};
    for (uint32_t i = 0; i < 3; i++) {
        memcpy(own, wall[i], sizeof own);
        fibrad_row row = {.sphere = i, .lines = true, .col = col[i], .f = f[i], .half = half, .wall = own};
        row.length = i == 1 ? 2 : 1, row.escaped = escaped[i];
        assert_ok(fibrad_rows_add(&rows, &row, 3));
    }
    struct matrix m = matrix_of(scene, &rows, 1, NULL);
    for (uint32_t i = 0; i < 3; i++) ck_assert_double_eq_tol(matrix_total(&m.factors, i), 1, 1e-15);
    ck_assert_uint_eq(m.factors.walls, 3);
    return m;
}

/* Averaged rows are closed, too, whatever the error of the method. */
TEST(closing_rows) {
    OWNED_MATRIX m = closed((const double[][3]){{.2, .1, 0}, {0, 0, 0}, {0, 0, .2}}, (const double[]){.1, 0, 0});
    const double(*wall)[3] = (const double(*)[3])m.factors.wall, *escaped = m.factors.escaped;
    ck_assert_double_eq_tol(wall[0][0], .25, 1e-15);
    ck_assert_double_eq_tol(wall[0][1], .125, 1e-15);
    ck_assert(wall[0][2] == 0);
    ck_assert_double_eq_tol(escaped[0], .125, 1e-15);
    ck_assert_double_eq_tol(wall[2][2], .9, 1e-15);
    ck_assert(escaped[2] == 0 && wall[2][0] == 0 && wall[2][1] == 0);
    /* this sphere met nothing outside: .2, .1 and .1 come from sphere 0, 4 x .2 from sphere 2, of 1.2 in all */
    ck_assert_double_eq_tol(wall[1][0], .1 * .2 / 1.2, 1e-15);
    ck_assert_double_eq_tol(wall[1][1], .1 * .1 / 1.2, 1e-15);
    ck_assert_double_eq_tol(wall[1][2], .1 * .8 / 1.2, 1e-15);
    ck_assert_double_eq_tol(escaped[1], .1 * .1 / 1.2, 1e-15);
    matrix_free(&m);
    m = closed((const double[3][3]){{0}}, (const double[3]){0});
    ck_assert_double_eq_tol(m.factors.escaped[0], .5, 1e-15);
    ck_assert_double_eq_tol(m.factors.escaped[1], .1, 1e-15);
    for (int k = 0; k < 9; k++) ck_assert(m.factors.wall[k] == 0);
}

static const char *const misspelt[] = {"",
                                       "wall",
                                       "zmin,",
                                       "zmin=",
                                       "zmin=a",
                                       "zmin:3",
                                       "zmin=3",
                                       ",zmin",
                                       "cylinder",
                                       "cylinder:",
                                       "cylinder:1,2",
                                       "cylinder:1,2,0",
                                       "cylinder:1,2,-1",
                                       "zmax=inf",
                                       "autos",
                                       "zmin zmax",
                                       "box=3",
                                       "cylinder:1,2,3,",
                                       "cylinder:1,2,3 4",
                                       "cylinder:1;2,3",
                                       "zmin=1=2",
                                       "zmax:opened",
                                       "zmax=3:",
                                       "zmax:open:at=3s",
                                       "open",
                                       "box:open",
                                       "box:open=top",
                                       "box:zmax",
                                       "box,zmax:open:open=zmax",
                                       "cylinder:1,2,3,xcylinder:1,2,3",
                                       "zmax:open:3"};

LOOP_TEST(misspelt_option, sizeof misspelt / sizeof *misspelt) {
    OWNED_BY(walls_free) struct wall_options options = {0};
    const int status = walls_option(misspelt[_i], &options);
    ck_assert_int_eq(status ? status : walls_settle(&options), 2);
}

/* Reads an option into options that may have some already. */
static void take_walls(const char *text, struct wall_options *options) {
    ck_assert_int_eq(walls_option(text, options), 0);
    options->walls = (struct walls){0};
    ck_assert_int_eq(walls_settle(options), 0);
}

/* Checks the walls that options place: their places in order, `at` by place, and the cylinder's axis and radius. */
static void assert_walls(const struct wall_options *options, const struct bed *bed, uint32_t count,
                         const uint32_t *place, const double at[WALLS], const double cylinder[3]) {
    struct walls walls;
    ck_assert_int_eq(walls_of(options, bed, "bed", &walls), 0);
    ck_assert_uint_eq(walls.count, count);
    for (uint32_t k = 0; k < count; k++) {
        const fibrad_wall *wall = &walls.wall[k];
        if (place[k] == 6) {
            ck_assert_int_eq(wall->kind, FIBRAD_WALL_CYLINDER);
            ck_assert(wall->cylinder.x == cylinder[0] && wall->cylinder.y == cylinder[1]);
            ck_assert(wall->cylinder.radius == cylinder[2]);
            ck_assert_str_eq(wall_name(&walls, k), "cylinder");
        } else {
            static const char *const names[] = {"xmin", "xmax", "ymin", "ymax", "zmin", "zmax"};
            ck_assert_int_eq(wall->kind, FIBRAD_WALL_PLANE);
            ck_assert_int_eq(2 * wall->plane.axis + wall->plane.upper, (int)place[k]);
            ck_assert(wall->plane.at == at[place[k]]);
            ck_assert_str_eq(wall_name(&walls, k), names[place[k]]);
        }
    }
}

TEST(option_places_walls) {
    OWNED_BED bed = BED({1, 2, 3, 1}, {4, 6, 8, 2});
    struct wall_options options = {0}, box = {0}, automatic = {0}, clash = {0}, beyond = {0}, mixed = {0};
    struct walls walls;
    take_walls("zmax,cylinder:2.5,4,30,zmin:at=-4", &options);
    assert_walls(&options, &bed, 3, (uint32_t[]){5, 6, 4}, (double[WALLS]){[4] = -4, [5] = 10}, (double[]){2.5, 4, 30});
    take_walls("xmin", &options); /* a second option adds to the first */
    ck_assert_int_eq(walls_of(&options, &bed, "bed", &walls), 2);

    const uint32_t all[] = {0, 1, 2, 3, 4, 5};
    const double ends[WALLS] = {0, 6, 1, 8, 2, 10}, file[WALLS] = {-1, 7, -2, 9, -3, 12};
    take_walls("box", &box);
    assert_walls(&box, &bed, 6, all, ends, NULL);
    take_walls("auto", &automatic);
    ck_assert_int_eq(walls_of(&automatic, &bed, "bed", &walls), 2);
    for (int axis = 0; axis < 3; axis++) bed.low[axis] = file[2 * axis], bed.high[axis] = file[2 * axis + 1];
    assert_walls(&automatic, &bed, 6, all, file, NULL);
    take_walls("ymax:open,box,ymax:at=9.5,auto", &mixed);
    assert_walls(&mixed, &bed, 6, (uint32_t[]){3, 0, 1, 2, 4, 5}, (double[WALLS]){-1, 7, -2, 9.5, -3, 12}, NULL);
    bed.period[0] = 8;
    assert_walls(&automatic, &bed, 4, (uint32_t[]){2, 3, 4, 5}, file, NULL);
    ck_assert_int_eq(walls_of(&box, &bed, "bed", &walls), 2);
    take_walls("zmin:at=9,zmax:at=8", &clash);
    ck_assert_int_eq(walls_of(&clash, &bed, "bed", &walls), 2);
    take_walls("zmin:at=4", &beyond);
    ck_assert_int_eq(walls_of(&beyond, &bed, "bed", &walls), 3);
    assert_walls(&(struct wall_options){0}, &bed, 0, NULL, NULL, NULL);
}

/* Openings are no walls. They stand at the ends of the spheres, whatever the box of the file says, or where the option
 * puts them. */
TEST(option_places_openings) {
    OWNED_BED bed = BED({1, 2, 3, 1}, {4, 6, 8, 2});
    struct wall_options options = {0};
    struct walls walls;
    for (int axis = 0; axis < 3; axis++) bed.low[axis] = -9, bed.high[axis] = 99;
    take_walls("ymax:open:at=20,box,xmin:open,zmax:open", &options);
    ck_assert_int_eq(walls_of(&options, &bed, "bed", &walls), 0);
    ck_assert_uint_eq(walls.count, 3);
    ck_assert_uint_eq(walls.openings, 3);
    const fibrad_plane should[] = {{1, 1, 20}, {0, 0, 0}, {2, 1, 10}};
    for (int k = 0; k < 3; k++) {
        ck_assert(walls.opening[k].axis == should[k].axis && walls.opening[k].upper == should[k].upper);
        ck_assert(walls.opening[k].at == should[k].at);
    }
    ck_assert(!walls_closed(&walls, &bed));
    for (uint32_t k = 0; k < walls.count; k++) ck_assert(!wall_endless(&walls, &bed, &walls.wall[k]));
    bed.period[0] = 200;
    ck_assert_int_eq(walls_of(&options, &bed, "bed", &walls), 2); /* this opening lies across a periodic axis */
}
