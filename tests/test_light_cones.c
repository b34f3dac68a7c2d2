/* test_light_cones.c - light whose directions fill wide cones, by plain rays. SPDX-License-Identifier: MIT */
#include "host_owned.h"
#include "plain_light.h"
#include "scenes.h"
#include "suite.h"

enum { SPHERES = 40 };

/* The fractions of the light of a disc and a cone about -z that black spheres take. */
static void take_plain(const struct plain_bed *p, const fibrad_light *light, int rays, double share[SPHERES]) {
    double all[SPHERES] = {0};
#pragma omp parallel for schedule(static) reduction(+ : all[:SPHERES])
    for (int k = 0; k < rays; k++) {
        uint64_t state = (uint64_t)k * 1000003u;
        const double r = light->radius * sqrt((k + plain_random(&state)) / rays), turn = 2 * PI * plain_random(&state);
        const double s = sin(light->half_angle) * sqrt(plain_random(&state)), about = 2 * PI * plain_random(&state);
        const double w[3] = {s * cos(about), s * sin(about), -sqrt(1 - s * s)};
        const double at[3] = {light->centre[0] + r * cos(turn), light->centre[1] + r * sin(turn), light->centre[2]};
        const struct plain_end end = plain_trace(p, at, w);
        if (end.sphere >= 0) all[end.sphere] += 1. / rays;
    }
    memcpy(share, all, sizeof all);
}

/* Every sphere that takes more than a hundredth of the light is right to 1 % of its power. The estimates know. */
LOOP_TEST(spheres_in_wide_cones, by_night(3, 2)) {
    enum { RAYS = 2000000 };
    const double half = (const double[]){.05, .1, .08}[_i];
    OWNED_BED bed = packing(SPHERES, .8, 1.2, .3, 5 + (uint64_t)_i, true);
    const double side = bed.period[0];
    for (int a = 0; a < 3; a++) bed.period[a] = 0;
    OWNED_BY(plain_free) struct plain_bed plain = plain_bed_of(&bed);
    fibrad_light light = {.direction = {0, 0, -1}, .flux = 1 / (PI * 4), .centre = {side / 2, side / 2, 2 * side}};
    light.half_angle = half, light.shape = FIBRAD_LIGHT_DISC, light.radius = 2;
    double black[SPHERES], rays[SPHERES], absorbed[SPHERES], first[SPHERES], error[SPHERES];
    OWNED_MADE *radiation = NULL;
    const fibrad_spheres spheres = spheres_of(&bed);
    const fibrad_light_sources sources = {.light = &light, .lights = 1, .absorptivity = black};
    fibrad_light_result result = {.absorbed = absorbed, .absorbed_first = first, .absorbed_error = error};
    for (int i = 0; i < SPHERES; i++) black[i] = 1;
    assert_ok(made_with(&radiation, NULL, &spheres, NULL, NULL));
    assert_ok(fibrad_bed_shine(radiation, &sources, &result));
    take_plain(&plain, &light, RAYS, rays);
    int beyond = 0, lit = 0;
    double worst = 0, squares = 0, said = 0;
    for (int i = 0; i < SPHERES; i++) {
        const double noise = sqrt(rays[i] * (1 - rays[i]) / RAYS), off = fabs(first[i] - rays[i]);
        lit += rays[i] > 0, beyond += off > 2 * sqrt(error[i] * error[i] + noise * noise);
        squares += off * off - noise * noise, said += error[i] * error[i];
        if (rays[i] < .01) continue;
        worst = fmax(worst, (off - 2 * noise) / rays[i]);
    }
    printf("cone of %.2f: largest error %.4f, rms %.2e, said %.2e, %d of %d beyond\n", half, worst,
           sqrt(fmax(0, squares)), sqrt(said), beyond, lit);
    ck_assert_double_le(worst, .01);
    ck_assert_int_le(10 * beyond, lit);
}

/* What a plane receives of a cone is the flux times its area, at any half-angle. A plane at a slant receives the cosine
 * of it: the axis of the cone is its mean direction. */
LOOP_TEST(plane_across_a_cone, 8) {
    const double half = (const double[]){0, .01, .2, .5}[_i % 4], slant = _i < 4 ? 0 : .6;
    OWNED_BED bed = BED({.5, .5, 3, 1e-6});
    const fibrad_wall floor = plane_at(2, 0, 0);
    const fibrad_scene_config scene = {.period = {1, 1, 0}, .wall = &floor, .walls = 1};
    const fibrad_spheres spheres = spheres_of(&bed);
    const fibrad_light light = {.direction = {sin(slant), 0, -cos(slant)}, .flux = 7, .half_angle = half};
    const fibrad_light_sources sources = {
        .light = &light, .lights = 1, .absorptivity = &(double){1}, .wall_absorptivity = &(double){1}};
    double absorbed, first, wall, wall_first;
    fibrad_light_result result = {
        .absorbed = &absorbed, .absorbed_first = &first, .wall_absorbed = &wall, .wall_absorbed_first = &wall_first};
    OWNED_MADE *made = NULL;
    assert_ok(made_with(&made, &scene, &spheres, NULL, NULL));
    assert_ok(fibrad_bed_shine(made, &sources, &result));
    ck_assert_double_eq_tol(wall + absorbed, 7 * cos(slant), slant > 0 ? 2e-3 : 1e-9);
    ck_assert_double_eq_tol(result.incident, wall + absorbed, 1e-12);
}
