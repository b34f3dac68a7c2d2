/* test_heat_walls.c - walls that are dim or insulated: when a search for radiosities ends, and what comes back from few
 * links. SPDX-License-Identifier: MIT */
#include "host_owned.h"
#include "scenes.h"
#include "suite.h"

enum { WALLS = 5, MOST = 40 };

/* A room without a lid, its spheres, and the results of one solution. */
struct room {
    struct bed bed;
    double size[3], temperature[MOST], emissivity[MOST], wall_temperature[WALLS], wall_emissivity[WALLS];
    double power[MOST], error[MOST], wall_power[WALLS], wall_error[WALLS], absorbed[WALLS], surroundings;
    fibrad_heat_result result;
};

static double drawn(uint64_t seed, uint64_t number, double low, double high) {
    return low + (high - low) * bed_make_random(seed, number);
}

/* A room with spheres in a grid of cells. Walls have emissivities from .05 to .2. */
static struct room room_of(uint64_t seed, uint32_t spheres) {
    double at[MOST][4];
    struct room room = {.surroundings = 300};
    for (int k = 0; k < 3; k++) room.size[k] = drawn(seed, (uint64_t)k, k < 2 ? .8 : .3, k < 2 ? 1.2 : 1);
    for (uint32_t i = 0; i < spheres; i++) {
        at[i][0] = room.size[0] * (i % 4 + .5) / 4, at[i][1] = room.size[1] * (i / 4 % 4 + .5) / 4;
        at[i][2] = room.size[2] * (i / 16 + .5) / 3, at[i][3] = drawn(seed, 100 + i, .01, .04);
        room.temperature[i] = drawn(seed, 200 + i, 300, 1300), room.emissivity[i] = drawn(seed, 300 + i, .1, 1);
    }
    for (uint64_t k = 0; k < WALLS; k++)
        room.wall_temperature[k] = drawn(seed, 10 + k, 300, 1300),
        room.wall_emissivity[k] = drawn(seed, 20 + k, .05, .2);
    room.bed = bed_of(spheres, (const double(*)[4])at);
    return room;
}

static fibrad_bed *radiation_of(const struct room *room) {
    static const fibrad_heat_config config = {.directions = 32, .patches = 24, .wall_rays = 20000};
    fibrad_wall wall[WALLS];
    const fibrad_plane lid = {2, 1, room->size[2]};
    const fibrad_spheres spheres = spheres_of(&room->bed);
    for (int k = 0; k < WALLS; k++) wall[k] = plane_at(k / 2, k % 2, k % 2 ? room->size[k / 2] : 0);
    const fibrad_scene_config scene = {.wall = wall, .walls = WALLS, .opening = &lid, .openings = 1};
    fibrad_run run = {.threads = 1};
    fibrad_bed *radiation;
    assert_ok(made_with(&radiation, &scene, &spheres, &config, &run));
    return radiation;
}

static void solve(fibrad_bed *radiation, struct room *room, double tolerance) {
    fibrad_heat_sources sources;
    fibrad_heat_sources_init(&sources);
    sources.temperature = room->temperature, sources.emissivity = room->emissivity;
    sources.wall_temperature = room->wall_temperature, sources.wall_emissivity = room->wall_emissivity;
    sources.surroundings = room->surroundings, sources.tolerance = tolerance;
    room->result = (fibrad_heat_result){.power = room->power, .power_error = room->error};
    room->result.wall_power = room->wall_power, room->result.wall_error = room->wall_error;
    room->result.wall_absorbed = room->absorbed;
    assert_ok(fibrad_bed_solve(radiation, &sources, NULL, &room->result));
}

/* The largest difference between the powers of walls of two solutions, over the larger of the power and 5 % of what the
 * wall absorbs. */
static double largest_difference(const struct room *found, const struct room *right) {
    double largest = 0;
    for (int k = 0; k < WALLS; k++)
        largest = fmax(largest, fabs(found->wall_power[k] - right->wall_power[k]) /
                                    fmax(fabs(right->wall_power[k]), .05 * right->absorbed[k]));
    return largest;
}

/* Dim walls gain little of what arrives. A search that ends by the residual of all patches leaves this little wrong by
 * several percent. */
TEST(gains_of_dim_walls) {
    for (uint64_t seed = 1; seed <= by_night(12, 6); seed++) {
        const uint32_t spheres = seed % 2 ? (uint32_t)seed : 16 + 2 * (uint32_t)seed;
        struct room found = room_of(seed, spheres), right = found;
        OWNED_MADE *first = radiation_of(&found), *second = radiation_of(&right);
        solve(first, &found, 0), solve(second, &right, 1e-12);
        const double difference = largest_difference(&found, &right);
        ck_assert_msg(difference < .002, "seed %d: %g", (int)seed, difference);
        bed_free(&found.bed);
    }
}

/* How many of the errors that a search leaves are above twice the estimates. */
struct covered {
    int values, beyond;
};

static void compare(struct covered *covered, double found, double right, double estimate) {
    covered->values++, covered->beyond += fabs(found - right) > 2 * estimate;
}

static void expect_covered(const struct covered *covered) {
    ck_assert_msg(20 * covered->beyond <= covered->values, "%d of %d", covered->beyond, covered->values);
}

/* The estimates know how far a search has come. */
TEST(residuals_are_estimated) {
    struct covered walls = {0}, spheres = {0}, open = {0};
    for (uint64_t seed = 21; seed <= by_night(36, 28); seed++) {
        struct room found = room_of(seed, 20), right = found;
        OWNED_MADE *first = radiation_of(&found), *second = radiation_of(&right);
        solve(first, &found, 2e-2), solve(second, &right, 1e-12);
        for (int k = 0; k < WALLS; k++) compare(&walls, found.wall_power[k], right.wall_power[k], found.wall_error[k]);
        for (int i = 0; i < 20; i++) compare(&spheres, found.power[i], right.power[i], found.error[i]);
        compare(&open, found.result.surroundings_power, right.result.surroundings_power,
                found.result.surroundings_error);
        bed_free(&found.bed);
    }
    expect_covered(&walls), expect_covered(&spheres), expect_covered(&open);
}

/* What a cube with a black floor and a black lid exchanges if its four sides are insulated: an integral equation gives
 * 30159 +- 1 W at 1000 and 300 K. By patches alone the sides send back too much of what arrives to where it came from,
 * the more the finer the patches are. */
TEST(insulated_sides) {
    static const unsigned char insulated[6] = {1, 1, 1, 1, 0, 0};
    static const double wall_temperature[6] = {[4] = 1000, [5] = 300}, wall_emissivity[6] = {[4] = 1, [5] = 1};
    static const double temperature = NAN, emissivity = .5, none = 0;
    fibrad_wall wall[6];
    for (int k = 0; k < 6; k++) wall[k] = plane_at(k / 2, k % 2, k % 2);
    const fibrad_scene_config scene = {.wall = wall, .walls = 6};
    for (uint32_t patches = 24; patches <= 384; patches *= 4) {
        OWNED_BED bed = BED({.5, .5, .5, 1e-4});
        const fibrad_spheres spheres = spheres_of(&bed);
        const fibrad_heat_config config = {.patches = patches};
        double power, gained[6], error[6];
        fibrad_heat_sources sources;
        fibrad_heat_sources_init(&sources);
        sources.temperature = &temperature, sources.emissivity = &emissivity, sources.power = &none;
        sources.wall_temperature = wall_temperature, sources.wall_emissivity = wall_emissivity;
        sources.insulated = insulated, sources.surroundings = 300;
        fibrad_heat_result result = {.power = &power, .wall_power = gained, .wall_error = error};
        OWNED_MADE *radiation = NULL;
        assert_ok(made_with(&radiation, &scene, &spheres, &config, NULL));
        assert_ok(fibrad_bed_solve(radiation, &sources, NULL, &result));
        ck_assert_msg(fabs(gained[5] - 30159) < .001 * 30159, "%d patches: %g", (int)patches, gained[5]);
        ck_assert_msg(fabs(gained[5] - 30159) < 2 * error[5], "%d patches: %g, error %g", (int)patches, gained[5],
                      error[5]);
        ck_assert_double_eq_tol(gained[4], -gained[5], 1e-6);
    }
}
