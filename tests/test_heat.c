/* test_heat.c - net powers against closed forms. SPDX-License-Identifier: MIT */
#include "heat_problem.h"

static void assert_still(struct problem *p) {
    for (uint32_t i = 0; i < p->bed.n; i++) {
        const double black = sphere_area(&p->bed, i) * emission(p->temperature[i]);
        ck_assert_double_le(fabs(p->result.power[i]), 1e-10 * fmax(p->emissivity[i], .1) * black);
    }
    for (int k = 0; k < FIBRAD_WALLS; k++)
        ck_assert_double_le(fabs(p->wall_power[k]), 1e-10 * emission(p->temperature[0]));
}

TEST(nothing_flows_in_a_closed_box_at_one_temperature) {
    OWNED_PROBLEM p = problem_of(packing(60, .6, 1.2, .5, 3, false), 3, .5);
    p.walls = box_about(&p.bed);
    for (uint32_t i = 0; i < p.bed.n; i++) p.emissivity[i] = (double)(i % 11) / 10;
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = 3, p.wall_emissivity[k] = .2 * k;
    p.config.directions = 40;
    trace_and_solve(&p);
    assert_still(&p);

    /* the same holds after a solution in which much flowed */
    p.temperature[7] = 5, p.wall_temperature[3] = 1;
    solve(&p);
    ck_assert_double_gt(fabs(p.result.power[7]), 1);
    p.temperature[7] = 3, p.wall_temperature[3] = 3;
    solve(&p);
    assert_still(&p);
}

TEST(nothing_flows_in_a_periodic_bed_at_one_temperature) {
    OWNED_PROBLEM p = problem_of(packing(100, 1, 1, .55, 5, true), 2, .3);
    p.config.directions = 40;
    trace_and_solve(&p);
    assert_still(&p);
}

TEST(a_grey_sphere_in_black_surroundings) {
    for (int walls = 0; walls < 2; walls++) {
        OWNED_PROBLEM p = problem_of(BED({.1, .2, .3, 1}), 2, .3);
        if (walls) p.walls = box_of(20);
        for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = 1;
        p.sources.surroundings = walls ? 0 : 1;
        trace_and_solve(&p);
        assert_near(p.result.power[0], .3 * 4 * PI * (1 - 16), 1e-3);
    }
}

/* The power is that between a sphere and a concentric sphere of the area of the box, whose walls are lit evenly
 * enough. */
TEST(a_grey_sphere_in_a_large_grey_box) {
    OWNED_PROBLEM p = problem_of(BED({.1, .2, .3, 1}), 2, .3);
    p.walls = box_of(20);
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = 1, p.wall_emissivity[k] = .05;
    trace_and_solve(&p);
    assert_near(p.result.power[0], 4 * PI * (1 - 16) / (1 / .3 + 4 * PI / 9600 * (1 / .05 - 1)), 1e-3);
}

TEST(two_parallel_grey_walls) {
    OWNED_PROBLEM p = problem_of(BED({.2, .3, .5, 1e-4}), 1, .5);
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, 0, 1}};
    p.bed.period[0] = p.bed.period[1] = 2;
    p.wall_temperature[4] = 3, p.wall_emissivity[4] = .3;
    p.wall_temperature[5] = 2, p.wall_emissivity[5] = .6;
    trace_and_solve(&p);
    assert_near(p.wall_power[5], 4 * (81 - 16) / (1 / .3 + 1 / .6 - 1), 1e-3);
    ck_assert_double_eq(p.result.surroundings_power, 0);
}

/* Half of the 10,752 beams meet the plane, but for 6. Each estimate is made from one sample, so estimates hold on the
 * mean. */
TEST(a_black_sphere_touches_a_black_plane) {
    OWNED_PROBLEM p = problem_of(BED({0, 0, 0, 1}), 2, 1);
    double estimate[FIBRAD_WALLS], errors = 0, estimates = 0;
    p.result.wall_error = estimate;
    for (uint32_t wall = 0; wall < 6; wall++) {
        p.walls = (struct walls){.planes = 1u << wall};
        p.walls.at[wall] = wall % 2 ? 1 : -1;
        trace_and_solve(&p);
        const double error = p.wall_power[wall] / (16 * 2 * PI) - 1;
        ck_assert_double_le(fabs(error), 1.2e-3);
        assert_near(p.result.surroundings_power, 16 * 2 * PI, 1.2e-3);
        errors += error * error / 6, estimates += pow(estimate[0] / (16 * 2 * PI), 2) / 6;
    }
    ck_assert_double_le(sqrt(errors), 1e-3);
    ck_assert(errors < 4 * estimates && estimates < 4 * errors);
}

/* Light goes back and forth between endless plates without a period, and in a tube with one. Between plates a mote sees
 * the radiosities of two plates that have only each other. In a tube it sees that of a black body. */
TEST(a_mote_between_endless_walls) {
    OWNED_PROBLEM p = problem_of(BED({0, 0, 0, .01}), 2, .5);
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, -.5, .5}};
    p.wall_temperature[4] = 3, p.wall_emissivity[4] = .8;
    p.wall_temperature[5] = 1, p.wall_emissivity[5] = .5;
    p.sources.surroundings = 1.5;
    trace_and_solve(&p);
    const double low = (.8 * 81 + .2 * .5 * 1) / (1 - .2 * .5), high = .5 * 1 + .5 * low;
    assert_near(p.result.power[0], .5 * 4e-4 * PI * ((low + high) / 2 - 16), 1e-3);
    double largest;
    ck_assert_double_le(fabs(sum_of_powers(&p, &largest)), 1e-12 * largest);
    p.walls = (struct walls){.cylinder = {0, 0, .5}};
    p.bed.period[2] = 1;
    p.wall_temperature[FIBRAD_CYLINDER] = 3, p.wall_emissivity[FIBRAD_CYLINDER] = .1;
    trace_and_solve(&p);
    assert_near(p.result.power[0], .5 * 4e-4 * PI * (81 - 16), 1e-2);
}

/* Plates with a period have the powers of the closed form, whatever the mote is. */
/* The powers of a pair of endless plates are those of an area, which the result tells. They are those of infinite
 * parallel plates. */
TEST(a_pair_of_endless_plates) {
    double area[FIBRAD_WALLS];
    OWNED_PROBLEM p = problem_of(BED({0, 0, 0, 1e-3}, {.3, .1, 0, 1e-3}), 2, 1e-3);
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, -.5, .5}};
    p.wall_temperature[4] = 3, p.wall_temperature[5] = 1;
    p.result.wall_area = area;
    for (int grey = 0; grey < 2; grey++) {
        if (grey) p.wall_emissivity[4] = .8, p.wall_emissivity[5] = .3;
        trace_and_solve(&p);
        const double q = (81 - 1) / (1 / p.wall_emissivity[4] + 1 / p.wall_emissivity[5] - 1);
        ck_assert_double_eq_tol(area[0], .904 * .704,
                                1e-12); /* the extent of the centres, and the largest size of the bed on either side */
        assert_near(p.wall_power[4], -q * area[0], 2e-3);
        assert_near(p.wall_power[5], q * area[1], 2e-3);
    }
}

TEST(a_mote_between_periodic_plates) {
    OWNED_PROBLEM p = problem_of(BED({0, 0, 0, .01}), 2, .5);
    p.bed.period[0] = p.bed.period[1] = 1;
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, -.5, .5}};
    p.wall_temperature[4] = 3, p.wall_emissivity[4] = .8;
    p.wall_temperature[5] = 1, p.wall_emissivity[5] = .5;
    trace_and_solve(&p);
    assert_near(p.wall_power[5], (81 - 1) / (1 / .8 + 1 / .5 - 1), 1e-3);
    assert_near(p.wall_power[4], -p.wall_power[5], 1e-3);
}

/* An endless plane reflects what comes from the surroundings and from the sphere. A diffuse wall is not a perfect
 * mirror, so two equal spheres in each other's mirror are no comparison. But a sphere between two endless white walls,
 * at the temperature of the surroundings, must neither gain nor lose, whatever the walls' temperature. */
TEST(white_walls_take_nothing) {
    OWNED_PROBLEM p = problem_of(BED({0, 0, 0, 1}), 2, .4);
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, -1.5, 1.5}};
    p.wall_emissivity[4] = p.wall_emissivity[5] = 0;
    p.wall_temperature[4] = 7, p.sources.surroundings = 2;
    trace_and_solve(&p);
    ck_assert_double_le(fabs(p.result.power[0]), 1e-10);
    p.sources.surroundings = 0;
    solve(&p);
    ck_assert(p.wall_power[4] == 0 && p.wall_power[5] == 0);
    assert_near(p.result.surroundings_power, -p.result.power[0], 1e-12);
    ck_assert_double_lt(-p.result.power[0], .4 * 16 * 4 * PI);     /* less than alone, */
    ck_assert_double_gt(-p.result.power[0], .4 * 16 * 4 * PI / 2); /* but at least half as much */
}

/* More beams bring more rays of walls. Otherwise the exchange of walls would not become better if there are few
 * spheres. */
LOOP_TEST(view_factors_between_the_walls_of_a_cube, 2) {
    OWNED_PROBLEM p = problem_of(BED({0, 0, 0, 1e-4}), 0, 1);
    p.walls = box_of(.5), p.wall_temperature[4] = 1;
    if (_i == 1) p.config.directions = 4000;
    trace_and_solve(&p);
    double square = 0;
    for (int k = 0; k < 6; k++) {
        const double truth = k == 5 ? 0.1998249 : 0.2000438, error = p.wall_power[k] / truth - 1;
        if (k != 4) square += error * error / 5;
        if (k != 4) ck_assert_double_le(fabs(error), 5e-3);
    }
    ck_assert_msg(_i == 0 || sqrt(square) < 7e-4, "off by %g", sqrt(square));
}

/* Each wall has an estimate of its own error. The true error is seldom above twice the estimate. */
TEST(walls_know_their_errors) {
    double error[6], ratio = 0;
    uint32_t low = 0;
    for (uint32_t hot = 0; hot < 6; hot++) {
        OWNED_PROBLEM p = problem_of(BED({0, 0, 0, 1e-4}), 0, 1);
        p.walls = box_of(.5);
        p.wall_temperature[hot] = 1;
        p.result.wall_error = error;
        trace_and_solve(&p);
        for (uint32_t k = 0; k < 6; k++) {
            const double truth = k == hot ? -1 : k == (hot ^ 1) ? 0.1998249 : 0.2000438;
            low += fabs(p.wall_power[k] - truth) > 2 * error[k];
            ratio += error[k] / 36 / 1e-3;
        }
    }
    ck_assert_uint_le(low, 6); /* of 36 errors, which are not independent */
    ck_assert_double_lt(ratio, 1);
    ck_assert_double_gt(ratio, .05);
}

TEST(view_factors_between_the_walls_of_a_cylinder) {
    OWNED_PROBLEM p = problem_of(BED({0, 0, 0, 1e-4}), 0, 1);
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, -1, 1}, .cylinder = {0, 0, 1}};
    p.wall_temperature[4] = 1;
    trace_and_solve(&p);
    const double x = 2 + 4, lids = .5 * (x - sqrt(x * x - 4)); /* coaxial discs of radius 1, distance 2 */
    assert_near(p.wall_power[5], PI * lids, 5e-3);
    assert_near(p.wall_power[6], PI * (1 - lids), 5e-3);
}

/* There are walls without spheres: a box anywhere, and endless walls. Patches of the latter must lie on the inner side
 * of the other walls, although no bed tells where that is. */
TEST(walls_alone) {
    OWNED_PROBLEM p = problem_of(bed_empty(), 0, 1);
    p.walls = (struct walls){.planes = 63, .at = {49, 50, -20, -19, 7, 8}};
    p.wall_temperature[4] = 1;
    trace_and_solve(&p);
    assert_near(p.wall_power[5], 0.1998249, 5e-3);
    for (int k = 0; k < 4; k++) assert_near(p.wall_power[k], 0.2000438, 5e-3);
    for (uint32_t planes = 1; planes < 63; planes += (uint32_t)by_night(1, 5)) {
        double largest;
        p.walls = (struct walls){.planes = planes, .at = {-300, -200, 100, 250, -220, 4}};
        p.walls.open = openings_of(planes);
        for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = 1 + .1 * k, p.wall_emissivity[k] = .5;
        p.sources.surroundings = .5, p.config.directions = 8;
        trace_and_solve(&p);
        ck_assert(isfinite(p.result.surroundings_power));
        ck_assert_double_le(fabs(sum_of_powers(&p, &largest)), 1e-12 * largest);
        for (uint32_t k = 0; k < 6; k++) {
            ck_assert(isfinite(p.wall_power[k]));
            if ((planes >> k & 1) == 0) ck_assert_double_eq(p.wall_power[k], 0);
        }
    }
}

TEST(two_black_spheres_in_contact) {
    OWNED_PROBLEM p = problem_of(BED({0, 0, 0, 1}, {1.2, 1.6, 0, 1}), 1, 1);
    p.temperature[1] = 0;
    trace_and_solve(&p);
    assert_near(p.result.power[1], 4 * PI * 0.0755868184216124, 1e-2);
}

/* Makes a bed of which every third sphere reflects all. */
static struct problem reflecting(void) {
    struct problem p = problem_of(packing(60, .6, 1.2, .5, 8, false), 1, .6);
    for (uint32_t i = 0; i < p.bed.n; i++) {
        p.temperature[i] = 1 + bed_make_random(3, i);
        if (i % 3 == 0) p.emissivity[i] = 0, p.temperature[i] *= 20;
    }
    p.sources.surroundings = .5;
    return p;
}

static void assert_adiabatic(const struct problem *p) {
    double largest;
    const double sum = sum_of_powers(p, &largest);
    ck_assert_double_le(fabs(sum), 1e-12 * fmax(largest, 1));
    for (uint32_t i = 0; i < p->bed.n; i++)
        if (p->emissivity[i] == 0) ck_assert_double_eq(p->result.power[i], 0);
    ck_assert(p->result.residual <= 1e-3 && p->result.error_patches >= 0 && p->result.error_beams >= 0);
}

/* Reflectors gain nothing, and their temperature changes no bit. All is the same as at emissivity 1e-6. The powers of
 * the others are those of paths. */
TEST(reflectors_gain_nothing) {
    OWNED_PROBLEM p = reflecting();
    OWNED double *truth = calloc(p.bed.n, sizeof *truth), *first = calloc(p.bed.n, sizeof *first);
    p.walls = box_about(&p.bed);
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = .8 + .2 * k, p.wall_emissivity[k] = .3 * (k % 3);
    trace_and_solve(&p);
    assert_adiabatic(&p);
    for (uint32_t i = 0; i < p.bed.n; i++) truth[i] = power_by_paths(&p, i, 20000);
    ck_assert_double_lt(difference_of(p.result.power, truth, p.bed.n), .015);

    memcpy(first, p.result.power, p.bed.n * sizeof *first);
    for (uint32_t i = 0; i < p.bed.n; i += 3) p.temperature[i] = i % 2 ? 0 : 1e3;
    trace_and_solve(&p);
    ck_assert_mem_eq(first, p.result.power, p.bed.n * sizeof *first);

    p.sources.tolerance = 1e-10;
    solve(&p);
    assert_adiabatic(&p);
    memcpy(first, p.result.power, p.bed.n * sizeof *first);
    for (uint32_t i = 0; i < p.bed.n; i += 3) p.temperature[i] = 1, p.emissivity[i] = 1e-6;
    solve(&p);
    ck_assert_double_lt(difference_of(p.result.power, first, p.bed.n), 1e-5);
    ck_assert_double_gt(difference_of(p.result.power, first, p.bed.n), 1e-9);
}

/* A bed reflects all, in the open and between walls that do so, too. Nothing flows, and no time is lost. The same holds
 * after a solution in which much flowed. */
LOOP_TEST(all_reflect, 2) {
    OWNED_PROBLEM p = reflecting();
    if (_i == 1) p.walls = box_about(&p.bed);
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = 3, p.wall_emissivity[k] = 0;
    p.config.directions = 30;
    trace_and_solve(&p);
    assert_adiabatic(&p);
    double largest;
    (void)sum_of_powers(&p, &largest);
    ck_assert_double_gt(largest, 1);
    for (int warm = 1; warm >= 0; warm--) {
        for (uint32_t i = 0; i < p.bed.n; i++) p.emissivity[i] = 0;
        solve(&p);
        assert_adiabatic(&p);
        (void)sum_of_powers(&p, &largest);
        ck_assert_double_le(largest, warm ? 1e-9 : 0);
        ck_assert_uint_le(p.result.sweeps, warm ? 300 : 4);
        trace(&p);
    }
}
