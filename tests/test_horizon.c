/* test_horizon.c - a sphere that stands on top of layers sees the sky above its horizon and other spheres below it. How
 * much it sees of the floor is known from plain rays. SPDX-License-Identifier: MIT */
#include "host_owned.h"
#include "scenes.h"
#include "suite.h"

/* Layers of wide x wide spheres above the floor at 0, and one sphere on top, the last one. turn: which axis is up. */
static struct bed layers(int wide, int high, bool periodic, int turn) {
    struct bed bed = bed_empty();
    for (int k = 0; k < high; k++)
        for (int i = 0; i < wide * wide; i++)
            add_sphere(&bed, (i / wide + .25 + .5 * (k % 2)), (i % wide + .25 + .5 * (k % 2)), .5 + .72 * k, .499);
    const double middle = wide / 2 + (high % 2 ? .75 : .25);
    add_sphere(&bed, middle, middle, .5 + .72 * high, .499);
    turn_bed(&bed, turn);
    for (int axis = 0; axis < 2 && periodic; axis++) bed.period[(axis + turn) % 3] = wide;
    return bed;
}

/* The part of what the last sphere sends out that meets the floor. */
static double floor_of_last(const struct bed *bed, int turn, uint32_t directions) {
    const fibrad_wall floor = plane_at((2 + turn) % 3, 0, 0);
    fibrad_scene_config config = {.wall = &floor, .walls = 1};
    const fibrad_spheres spheres = spheres_of(bed);
    OWNED_FACTORS *factors = NULL;
    memcpy(config.period, bed->period, sizeof config.period);
    assert_ok(fibrad_view_factors(
        &config, &spheres, &(fibrad_bed_rule){.beam = &(fibrad_beam_rule){.directions = directions}}, NULL, &factors));
    return factors->matrix.wall[bed->n - 1];
}

/* Of 10^6 plain rays, 15 arrive through 3 layers. */
LOOP_TEST(no_floor_below_periodic_layers, 12) {
    static const uint32_t directions[] = {100, 181, 512, 1000};
    const int turn = _i / 4, wide = _i % 2 ? 4 : 8;
    OWNED_BED bed = layers(wide, 3, true, turn);
    ck_assert_double_lt(floor_of_last(&bed, turn, directions[_i % 4]), 6e-5);
}

/* Beyond the edge of layers that end there is more floor. Shares by rays: 1e6 rays, so 1.5e-4 is their noise. */
TEST(floor_beyond_the_edge) {
    OWNED_BED bed = layers(12, 2, false, 0);
    ck_assert_double_eq_tol(floor_of_last(&bed, 0, 233), .02452, .0012);
    ck_assert_double_eq_tol(floor_of_last(&bed, 0, 1000), .02452, .0008);
}

/* Plain rays: -1455 W, with an error of 3 W. Spheres of 400 K, a floor of 1300 K, a sky of 300 K; all black. */
LOOP_TEST(power_of_a_sphere_on_top, 4) {
    const int turn = _i / 2;
    static const uint32_t directions[] = {168, 400};
    OWNED_BED bed = layers(4, 3, true, turn);
    const fibrad_wall floor = plane_at((2 + turn) % 3, 0, 0);
    fibrad_scene_config scene = {.wall = &floor, .walls = 1};
    const fibrad_heat_config config = {.directions = directions[_i % 2]};
    const fibrad_spheres spheres = spheres_of(&bed);
    double *temperature = malloc(bed.n * sizeof *temperature), *emissivity = malloc(bed.n * sizeof *emissivity);
    double *power = malloc(bed.n * sizeof *power), *error = malloc(bed.n * sizeof *error);
    fibrad_heat_sources sources;
    fibrad_run run = {0};
    fibrad_heat_result result = {.power = power, .power_error = error, .wall_power = &(double){0}};
    OWNED_MADE *made = NULL;
    memcpy(scene.period, bed.period, sizeof scene.period);
    assert_ok(made_with(&made, &scene, &spheres, &config, &run));
    for (uint32_t i = 0; i < bed.n; i++) temperature[i] = 400, emissivity[i] = 1;
    fibrad_heat_sources_init(&sources);
    sources.temperature = temperature, sources.emissivity = emissivity, sources.surroundings = 300;
    sources.wall_temperature = &(double){1300}, sources.wall_emissivity = &(double){1};
    assert_ok(fibrad_bed_solve(made, &sources, NULL, &result));
    const double found = power[bed.n - 1], estimate = error[bed.n - 1];
    ck_assert_msg(fabs(found + 1455) < 2 * estimate && fabs(found + 1455) < 60, "%g, %g", found, estimate);
    free(temperature), free(emissivity), free(power), free(error);
}
