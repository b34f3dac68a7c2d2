/* test_heat_invariants.c - net powers under every setting that must not matter. SPDX-License-Identifier: MIT */
#include "heat_problem.h"

LOOP_TEST(powers_add_up_to_zero, 8) {
    OWNED_PROBLEM p = problem_of(packing(150, .4, 1.6, .5, 9, false), 1, .5);
    for (uint32_t i = 0; i < p.bed.n; i++)
        p.temperature[i] = 300 + 700 * bed_make_random(1, i), p.emissivity[i] = bed_make_random(2, i);
    p.walls = box_about(&p.bed);
    p.walls.planes = 21 * (uint32_t)_i % 64; /* no planes, all, one for each axis, and others */
    p.walls.open = openings_of(p.walls.planes);
    p.config.directions = 30;
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = 400 + 100 * k, p.wall_emissivity[k] = .15 * k;
    p.sources.surroundings = 350;
    p.sources.sigma = FIBRAD_STEFAN_BOLTZMANN;
    trace(&p);
    solve(&p);
    double largest;
    ck_assert_double_le(fabs(sum_of_powers(&p, &largest)), 1e-12 * largest);
}

static void assert_same_bits(const struct problem *p, const struct problem *q) {
    ck_assert_int_eq(memcmp(p->result.power, q->result.power, p->bed.n * sizeof(double)), 0);
    ck_assert_int_eq(memcmp(p->wall_power, q->wall_power, sizeof p->wall_power), 0);
    ck_assert_int_eq(memcmp(&p->result.surroundings_power, &q->result.surroundings_power, sizeof(double)), 0);
    ck_assert_int_eq(memcmp(&p->result.error_beams, &q->result.error_beams, sizeof(double)), 0);
}

static struct problem small_problem(int isa, bool backwards, bool turned) {
    struct problem p = problem_of(packing(80, .3, 1, .5, 21, false), 1, .4);
    for (uint32_t i = 0; i < p.bed.n; i++) p.temperature[i] = 1 + bed_make_random(3, i);
    p.isa = isa, p.backwards = backwards, p.turned = turned;
    p.walls = box_about(&p.bed);
    p.walls.planes = 31, p.walls.open = 32;
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = 1, p.wall_emissivity[k] = .7;
    p.config = (fibrad_heat_config){.directions = 24, .points = 128, .parts = 5};
    trace_and_solve(&p);
    return p;
}

TEST(the_order_of_the_work_changes_no_bit) {
    OWNED_PROBLEM p = small_problem(FIBRAD_ISA_BEST, false, false), q = small_problem(FIBRAD_ISA_BEST, true, false);
    assert_same_bits(&p, &q);
}

/* Walls listed from the last to the first are the same walls. */
TEST(the_order_of_walls_changes_but_roundings) {
    OWNED_PROBLEM p = small_problem(FIBRAD_ISA_BEST, false, false), q = small_problem(FIBRAD_ISA_BEST, false, true);
    double largest;
    (void)sum_of_powers(&p, &largest);
    ck_assert_uint_eq(p.given, 5);
    ck_assert_uint_eq(p.slot[0], q.slot[4]);
    for (uint32_t i = 0; i < p.bed.n; i++)
        ck_assert_double_eq_tol(p.result.power[i], q.result.power[i], 1e-12 * largest);
    for (int k = 0; k < FIBRAD_WALLS; k++) ck_assert_double_eq_tol(p.wall_power[k], q.wall_power[k], 1e-12 * largest);
    ck_assert_double_eq_tol(p.result.surroundings_power, q.result.surroundings_power, 1e-12 * largest);
}

TEST(an_earlier_solution_saves_sweeps_and_changes_little) {
    OWNED_PROBLEM p = problem_of(packing(100, 1, 1, .55, 5, true), 1, .3);
    p.config.directions = 40, p.sources.tolerance = 1e-6;
    for (uint32_t i = 0; i < p.bed.n; i++) p.temperature[i] = 1 + bed_make_random(3, i);
    trace_and_solve(&p);
    for (uint32_t i = 0; i < p.bed.n; i++) p.temperature[i] *= 1 + 1e-4 * bed_make_random(6, i);
    solve(&p);
    const uint32_t warm = p.result.sweeps;
    double *power = malloc(p.bed.n * sizeof *power), largest = 0;
    memcpy(power, p.result.power, p.bed.n * sizeof *power);
    trace_and_solve(&p);
    ck_assert_uint_lt(warm, p.result.sweeps * 3 / 4);
    for (uint32_t i = 0; i < p.bed.n; i++) worst_of(&largest, fabs(p.result.power[i]));
    for (uint32_t i = 0; i < p.bed.n; i++) ck_assert_double_eq_tol(power[i], p.result.power[i], 1e-5 * largest);
    free(power);
}

/* A periodic bed moves as a whole, by a third of the box. It is the same bed, but its spheres come in another order
 * along the cells. What is carried over belongs to the spheres, so that next to nothing is left to do. */
TEST(an_earlier_solution_goes_with_the_spheres) {
    OWNED_PROBLEM p = problem_of(packing(100, 1, 1, .55, 5, true), 1, .3);
    p.config.directions = 40, p.sources.tolerance = 1e-6;
    for (uint32_t i = 0; i < p.bed.n; i++) p.temperature[i] = 1 + bed_make_random(3, i);
    trace_and_solve(&p);
    const uint32_t cold = p.result.sweeps;
    OWNED fibrad_scene *before = p.scene;
    double power[100], largest = 0;
    memcpy(power, p.result.power, sizeof power);
    for (uint32_t i = 0; i < p.bed.n; i++) {
        p.bed.x[i] = fmod(p.bed.x[i] + p.bed.period[0] / 3, p.bed.period[0]);
        p.bed.z[i] = fmod(p.bed.z[i] + p.bed.period[2] / 3, p.bed.period[2]);
        worst_of(&largest, fabs(power[i]));
    }
    build_scene(&p);
    uint32_t others = 0;
    for (uint32_t k = 0; k < p.bed.n; k++) others += fibrad_scene_sphere(before, k) != fibrad_scene_sphere(p.scene, k);
    ck_assert_uint_gt(others, 50);
    assert_ok(fibrad_heat_move(p.heat, p.scene));
    trace_beams(&p);
    solve(&p);
    for (uint32_t i = 0; i < p.bed.n; i++) ck_assert_double_eq_tol(power[i], p.result.power[i], 1e-5 * largest);
    ck_assert_uint_lt(p.result.sweeps, cold / 2);
}

TEST(the_error_is_as_estimated) {
    double truth[100], each[100], *power = NULL;
    for (int k = 0; k < 3; k++) {
        static const fibrad_heat_config configs[] = {
            {.directions = 600, .patches = 384}, {.directions = 72, .patches = 96}, {.directions = 144, .patches = 24}};
        OWNED_PROBLEM p = problem_of(packing(100, 1, 1, .55, 5, true), 1, .4);
        for (uint32_t i = 0; i < p.bed.n; i++) p.temperature[i] = 1 + bed_make_random(3, i);
        p.config = configs[k];
        p.result.power_error = each;
        trace_and_solve(&p);
        power = p.result.power;
        double square = 0, squares = 0;
        uint32_t low = 0;
        for (uint32_t i = 0; i < p.bed.n; i++) squares += each[i] * each[i] / p.bed.n;
        assert_near(hypot(p.result.error_patches, p.result.error_beams), sqrt(squares), 1e-12);
        for (uint32_t i = 0; i < p.bed.n && k > 0; i++) low += fabs(power[i] - truth[i]) > 2 * each[i];
        ck_assert_uint_le(low, 5);
        for (uint32_t i = 0; i < p.bed.n; i++) square += (power[i] - truth[i]) * (power[i] - truth[i]) / p.bed.n;
        if (k == 0) memcpy(truth, power, sizeof truth);
        if (k > 0) {
            const double estimate = hypot(p.result.error_patches, p.result.error_beams);
            ck_assert_msg(sqrt(square) < 3 * estimate && sqrt(square) > estimate / 5, "%g, estimated %g", sqrt(square),
                          estimate);
        }
    }
}
