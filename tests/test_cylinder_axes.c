/* test_cylinder_axes.c - a cylinder along x, y or z: beds that are turned by an exchange of the axes, and closed forms.
 * SPDX-License-Identifier: MIT */
#include <gsl/gsl_integration.h>

#include "host_owned.h"
#include "scene/walls.h"
#include "scenes.h"
#include "suite.h"

/* A bed of few spheres within a cylinder that has a floor and a lid or an opening. */
struct can {
    struct bed bed;
    fibrad_wall wall[3];
    fibrad_plane lid;
    fibrad_scene_config config;
};

static struct can can_of(int turn, bool open) {
    struct can can = {.bed = packing(40, .5, 1, .4, 3, false)};
    double low = INFINITY, high = -INFINITY, round = 0;
    for (uint32_t i = 0; i < can.bed.n; i++) {
        low = fmin(low, can.bed.z[i] - can.bed.r[i]), high = fmax(high, can.bed.z[i] + can.bed.r[i]);
        round = fmax(round, hypot(can.bed.x[i] - 3, can.bed.y[i] - 4) + can.bed.r[i]);
    }
    can.wall[0] = turned_wall(cylinder_at(3, 4, round), turn);
    can.wall[1] = turned_wall(plane_at(2, 0, low), turn), can.wall[2] = turned_wall(plane_at(2, 1, high), turn);
    can.lid = can.wall[2].plane;
    can.config = (fibrad_scene_config){.walls = open ? 2 : 3, .openings = open};
    turn_bed(&can.bed, turn);
    return can;
}

static void can_point(struct can *can) { can->config.wall = can->wall, can->config.opening = &can->lid; }

/* Points, normals, areas and ends of rays are turned with the axes. */
TEST(walls_turn_with_the_axes) {
    struct can can[3];
    fibrad_scene *scene[3];
    for (int turn = 0; turn < 3; turn++) {
        can[turn] = can_of(turn, false);
        can_point(&can[turn]);
        scene[turn] = scene_with(&can[turn].bed, &can[turn].config);
    }
    for (int turn = 1; turn < 3; turn++)
        for (int k = 0; k < 300; k++) {
            const int wall = k % 3;
            const double share[2] = {fmod(.7548776662 * k, 1), fmod(.5698402910 * k, 1)};
            double at[2][3], normal[2][3], distance[2], turned[3];
            for (int t = 0; t < 2; t++) {
                const uint32_t slot = scene[t * turn]->slot[wall];
                fibrad_wall_even_point(scene[t * turn], slot, share, at[t]);
                fibrad_wall_normal(scene[t * turn], slot, at[t], normal[t]);
                ck_assert_double_eq_tol(fibrad_walls_away(&scene[t * turn]->container, slot, at[t]), 0, 1e-14);
            }
            turned_point(normal[0], turn, turned);
            for (int a = 0; a < 3 && wall == 0; a++) ck_assert_double_eq_tol(normal[1][a], turned[a], 1e-14);
            if (wall == 0) turned_point(at[0], turn, turned);
            for (int a = 0; a < 3 && wall == 0; a++) ck_assert_double_eq_tol(at[1][a], turned[a], 1e-14);
            const double middle[3] = {3 + share[0], 4 - share[1], 3},
                         w[3] = {share[1] - .5, share[0] - .4, .3 - share[0]};
            double from[3], along[3];
            turned_point(middle, turn, from), turned_point(w, turn, along);
            const uint32_t first = fibrad_walls_exit(scene[0], middle, w, &distance[0]);
            const uint32_t second = fibrad_walls_exit(scene[turn], from, along, &distance[1]);
            ck_assert_double_eq_tol(distance[1], distance[0], 1e-12);
            for (int b = 0; b < 3; b++) ck_assert((scene[0]->slot[b] == first) == (scene[turn]->slot[b] == second));
        }
    for (int turn = 0; turn < 3; turn++) {
        for (uint32_t b = 0; b < 3; b++)
            assert_near(fibrad_scene_wall_area(scene[turn], b), fibrad_scene_wall_area(scene[0], b), 1e-14);
        free(scene[turn]);
        bed_free(&can[turn].bed);
    }
}

struct rim {
    double aside, radius, low, high;
};

/* The solid angle of a strip of the cylinder at an angle, seen from a point between its ends, over 4 pi. */
static double strip(double angle, void *context) {
    const struct rim *c = context;
    const double x = c->radius * cos(angle) - c->aside, y = c->radius * sin(angle), square = x * x + y * y;
    const double ends = c->high / sqrt(square + c->high * c->high) - c->low / sqrt(square + c->low * c->low);
    return c->radius * (x * cos(angle) + y * sin(angle)) / square * ends / (4 * PI);
}

/* A sphere within a cylinder sends to it what a point in its centre does. */
TEST(a_sphere_in_a_cylinder) {
    const struct rim c = {.aside = .7, .radius = 2, .low = -1.5, .high = 2.5};
    gsl_integration_workspace *space = gsl_integration_workspace_alloc(100);
    double expected, unsure, at_z = 0;
    gsl_integration_qag(&(gsl_function){strip, (void *)(uintptr_t)&c}, 0, 2 * PI, 0, 1e-11, 100, 6, space, &expected,
                        &unsure);
    gsl_integration_workspace_free(space);
    for (int turn = 0; turn < 3; turn++) {
        OWNED_BED bed = BED({5.7, -3, 1.5, .5});
        turn_bed(&bed, turn);
        const fibrad_wall wall[3] = {turned_wall(cylinder_at(5, -3, c.radius), turn),
                                     turned_wall(plane_at(2, 0, 0), turn), turned_wall(plane_at(2, 1, 4), turn)};
        OWNED fibrad_scene *scene = scene_with(&bed, &(fibrad_scene_config){.wall = wall, .walls = 3});
        OWNED_WORK work = work_growing();
        double got[3];
        fibrad_row row = {.wall = got};
        assert_ok(fibrad_beam_row(scene, &work, 0, NULL, &row));
        ck_assert_double_eq_tol(got[0], expected, 2e-6);
        ck_assert_double_eq_tol(got[0] + got[1] + got[2], 1, 1e-14);
        double grey[3], self;
        uint32_t col;
        const double eps = .8, emissivity[3] = {.4, 1, 1};
        row = (fibrad_row){.wall = grey, .col = &col, .f = &self, .capacity = 1};
        assert_ok(fibrad_exchange_row(
            scene, &work, 0, &(fibrad_exchange_rule){.emissivity = &eps, .wall_emissivity = emissivity, .paths = 4000},
            &row, NULL));
        if (turn == 0) at_z = grey[0];
        ck_assert_double_eq_tol(grey[0], at_z, .02);
        ck_assert(grey[0] > .4 * expected && grey[0] < .8 * expected); /* it gets a part of what it reflects, too */
    }
}

/* Rows, exchange factors and powers of a turned bed are those of the bed, within errors: its directions are others. */
TEST(beds_turn_with_the_axes) {
    double factor[3][41][3], exchange[3][41][3], power[3][41];
    for (int turn = 0; turn < 3; turn++) {
        struct can can = can_of(turn, false);
        can_point(&can);
        const fibrad_spheres spheres = spheres_of(&can.bed);
        OWNED_FACTORS *f = NULL, *d = NULL;
        double emissivity[40], temperature[40], wall[3] = {.5, .8, .3}, hot[3] = {500, 900, 300}, at_wall[3];
        for (uint32_t i = 0; i < can.bed.n; i++) emissivity[i] = .7, temperature[i] = 400 + 5 * i;
        assert_ok(fibrad_view_factors(&can.config, &spheres,
                                      &(fibrad_bed_rule){.beam = &(fibrad_beam_rule){.directions = 500}}, NULL, &f));
        const fibrad_exchange_rule rule = {
            .emissivity = emissivity, .wall_emissivity = wall, .directions = 100, .paths = 1000};
        assert_ok(exchange_of(&can.config, &spheres, &rule, NULL, NULL, &d));
        for (uint32_t i = 0; i < can.bed.n; i++)
            for (int b = 0; b < 3; b++)
                factor[turn][i][b] = matrix_row(&f->matrix, i).wall[b],
                exchange[turn][i][b] = matrix_row(&d->matrix, i).wall[b];
        fibrad_bed *radiation;
        fibrad_heat_sources sources;
        fibrad_heat_sources_init(&sources);
        sources.temperature = temperature, sources.emissivity = emissivity;
        sources.surroundings = 0, sources.wall_temperature = hot, sources.wall_emissivity = wall;
        fibrad_heat_result result = {.power = power[turn], .wall_power = at_wall};
        assert_ok(made_with(&radiation, &can.config, &spheres, &(fibrad_heat_config){.directions = 40}, NULL));
        assert_ok(fibrad_bed_solve(radiation, &sources, NULL, &result));
        fibrad_bed_free(radiation);
        power[turn][40] = at_wall[0];
        bed_free(&can.bed);
    }
    for (int turn = 1; turn < 3; turn++) {
        double off[3] = {0}, most = 0;
        for (int i = 0; i < 40; i++) {
            for (int b = 0; b < 3; b++) {
                off[0] = fmax(off[0], fabs(factor[turn][i][b] - factor[0][i][b]));
                off[1] = fmax(off[1], fabs(exchange[turn][i][b] - exchange[0][i][b]));
            }
            off[2] = fmax(off[2], fabs(power[turn][i] - power[0][i])), most = fmax(most, fabs(power[0][i]));
        }
        ck_assert_double_lt(off[0], 8e-3);
        ck_assert_double_lt(off[1], 4e-2);
        ck_assert_double_lt(off[2], .04 * most);
        assert_near(power[turn][40], power[0][40], 5e-3);
    }
}

/* Whatever does not fit is refused: a fourth axis, planes or periods across the cylinder, open ends. */
TEST(cylinders_that_do_not_fit_are_refused) {
    for (int axis = -1; axis < 4; axis++)
        for (int across = 0; across < 3; across++) {
            OWNED_BED bed = BED({0, 0, 0, 1});
            fibrad_scene *scene;
            fibrad_wall wall[2] = {cylinder_at(0, 0, 3), plane_at(across, 0, -2)};
            wall[0].cylinder.along = axis;
            const bool valid = axis >= 0 && axis < 3;
            ck_assert_int_eq(scene_try(&scene, &bed, &(fibrad_scene_config){.wall = wall, .walls = 2}, NULL),
                             valid && axis == across ? FIBRAD_E_ENDLESS : FIBRAD_E_ARGUMENT);
            bed.period[across] = 8;
            const int status = scene_try(&scene, &bed, &(fibrad_scene_config){.wall = wall, .walls = 1}, NULL);
            ck_assert_int_eq(status, valid && axis == across ? FIBRAD_OK : FIBRAD_E_ARGUMENT);
            if (status == FIBRAD_OK) free(scene);
        }
}
