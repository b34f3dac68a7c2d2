/* test_heat_paths.c - net powers against paths that are followed one by one, and against published conductivities.
 * SPDX-License-Identifier: MIT */
#include "copies.h"
#include "heat_problem.h"

LOOP_TEST(powers_are_those_of_paths, 3) {
    static const struct {
        double low, high, spheres, walls, bar;
    } cases[] = {{1, 1, .3, .5, .01}, {.5, 1.5, .3, .4, .015}, {1, 1, .8, .9, .015}};
    OWNED_PROBLEM p = problem_of(packing(24, cases[_i].low, cases[_i].high, .55, 11, false), 1, cases[_i].spheres);
    p.walls = box_about(&p.bed);
    for (uint32_t i = 0; i < p.bed.n; i++) p.temperature[i] = 1 + .5 * bed_make_random(4, i);
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_temperature[k] = .8 + .2 * k, p.wall_emissivity[k] = cases[_i].walls;
    trace_and_solve(&p);
    double difference = 0, size = 0;
    for (uint32_t i = 0; i < p.bed.n; i++) {
        const double truth = power_by_paths(&p, i, 40000);
        difference += (p.result.power[i] - truth) * (p.result.power[i] - truth), size += truth * truth;
    }
    ck_assert_msg(sqrt(difference / size) < cases[_i].bar, "off by %g", sqrt(difference / size));
}

/* A box and a cylinder with grey walls are open above, or above and on one side. Powers are compared with paths that
 * end in the surroundings. */
LOOP_TEST(powers_in_open_containers_are_those_of_paths, 3) {
    OWNED_PROBLEM p = problem_of(packing(24, .5, 1.5, .55, 11, false), 1, .4);
    p.walls = box_about(&p.bed);
    p.walls.open = _i == 1 ? 34 : 32, p.walls.planes = 63 & ~p.walls.open;
    if (_i == 2) {
        const double *at = p.walls.at;
        p.walls.planes = 16;
        p.walls.cylinder[0] = (at[0] + at[1]) / 2, p.walls.cylinder[1] = (at[2] + at[3]) / 2;
        p.walls.cylinder[2] = hypot(at[1] - at[0], at[3] - at[2]) / 2;
    }
    for (uint32_t i = 0; i < p.bed.n; i++) p.temperature[i] = 1 + .5 * bed_make_random(4, i);
    p.sources.surroundings = .7;
    for (int k = 0; k < FIBRAD_WALLS; k++) {
        const bool open = p.walls.open >> k & 1; /* of the paths alone */
        p.wall_temperature[k] = open ? .7 : .8 + .2 * k, p.wall_emissivity[k] = open ? 1 : .3;
    }
    trace_and_solve(&p);
    double difference = 0, size = 0;
    for (uint32_t i = 0; i < p.bed.n; i++) {
        const double truth = power_by_paths(&p, i, 20000);
        difference += (p.result.power[i] - truth) * (p.result.power[i] - truth), size += truth * truth;
    }
    ck_assert_msg(sqrt(difference / size) < .015, "off by %g", sqrt(difference / size));
}

/* An opening is a black plane at the temperature of the surroundings, and its power is theirs. This holds to the bit,
 * except that powers of several openings are added. It holds for powers of spheres and other walls, their errors, and
 * temperatures that are found; for one opening or several, endless plates that face them, insulated walls, and one
 * radiosity for each wall. */
TEST(an_opening_is_a_black_plane_as_hot_as_the_surroundings) {
    static const struct {
        uint32_t planes, open;
        double radius;
    } cases[] = {{31, 32, 0}, {29, 34, 0}, {16, 32, 3}, {0, 48, 3}, {16, 32, 0}, {0, 48, 0}, {0, 2, 0}, {4, 59, 0}};
    for (uint64_t k = 0; k < by_night(8, 5); k++) {
        const uint32_t open = cases[k].open;
        struct problem p[2];
        double power[2][30], error[2][30], temperature[2][30], found[2][30];
        for (int closed = 0; closed < 2; closed++) {
            struct problem *q = &p[closed];
            *q = problem_of(packing(30, .3, .8, .3, 5, false), 1, .4);
            for (uint32_t i = 0; i < 30; i++) power[closed][i] = i % 2 ? .1 * i : NAN, found[closed][i] = 0;
            for (uint32_t i = 0; i < 30; i++) q->temperature[i] = i % 2 ? NAN : 1 + bed_make_random(3, i);
            q->sources.power = power[closed];
            q->walls = box_about(&q->bed);
            const double *at = q->walls.at;
            q->walls.planes = cases[k].planes | (closed ? open : 0), q->walls.open = closed ? 0 : open;
            q->walls.cylinder[0] = (at[0] + at[1]) / 2, q->walls.cylinder[1] = (at[2] + at[3]) / 2;
            q->walls.cylinder[2] = cases[k].radius > 0 ? hypot(at[1] - at[0], at[3] - at[2]) / 2 : 0;
            q->sources.surroundings = .8;
            for (int w = 0; w < FIBRAD_WALLS; w++) {
                const bool lid = open >> w & 1;
                q->wall_temperature[w] = lid ? .8 : 1 + .1 * w, q->wall_emissivity[w] = lid ? 1 : .3;
            }
            q->config.directions = 24;
            q->result.power_error = error[closed], q->result.temperature = temperature[closed];
            q->result.temperature_error = found[closed];
            trace_and_solve(q);
        }
        ck_assert_mem_eq(p[0].result.power, p[1].result.power, 30 * sizeof(double));
        ck_assert_mem_eq(error[0], error[1], sizeof error[0]);
        ck_assert_mem_eq(temperature[0], temperature[1], sizeof temperature[0]);
        ck_assert_mem_eq(found[0], found[1], sizeof found[0]);
        double lids = p[1].result.surroundings_power;
        for (int w = 0; w < FIBRAD_WALLS; w++)
            if (open >> w & 1)
                lids += p[1].wall_power[w];
            else
                ck_assert_double_eq(p[0].wall_power[w], p[1].wall_power[w]);
        ck_assert_double_eq_tol(p[0].result.surroundings_power, lids, 1e-12 * fabs(lids));
        free_problem(&p[0]), free_problem(&p[1]);
    }
}

/* Four pairs of a hot and a cold sphere stand in a cylinder whose wall reflects most light. Each pair is a quarter of a
 * turn from the next. What the wall reflects from one sphere to the other depends on where it is lit. */
TEST(powers_beside_the_wall_of_a_cylinder) {
    struct bed bed = bed_empty();
    double power[2] = {0, 0}, truth[2] = {0, 0};
    for (int k = 0; k < 8; k++) {
        const double turn = (k / 2 + .3) * (PI / 2);
        add_sphere(&bed, .3 + 2.2 * cos(turn), 2.2 * sin(turn) - .2, k % 2 ? .6 : -.4, .4);
    }
    OWNED_PROBLEM p = problem_of(bed, 0, 1);
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, -1, 1.2}, .cylinder = {.3, -.2, 3}};
    p.wall_emissivity[FIBRAD_CYLINDER] = .1;
    for (uint32_t i = 0; i < 8; i += 2) p.temperature[i] = 1;
    p.config.directions = 1000; /* the spheres are few and far apart */
    trace_and_solve(&p);
    for (uint32_t i = 0; i < 8; i++)
        power[i % 2] += p.result.power[i] / 4, truth[i % 2] += power_by_paths(&p, i, 200000) / 4;
    for (int k = 0; k < 2; k++) assert_near(power[k], truth[k], .01);
    for (uint32_t i = 0; i < 8; i++) assert_near(p.result.power[i], power[i % 2], .004);
}

/* Finds k_rad/(4 sigma T^3 d) of a periodic bed along z, from the powers at emissions 2 + cos kz, with k such that
 * `waves` waves fit into the box. */
static double conduction(struct problem *p, int waves) {
    const struct bed *bed = &p->bed;
    const double k = 2 * PI * waves / bed->period[2], volume = bed->period[0] * bed->period[1] * bed->period[2];
    for (uint32_t i = 0; i < bed->n; i++) p->temperature[i] = sqrt(sqrt(2 + cos(k * bed->z[i])));
    solve(p);
    double sum = 0;
    for (uint32_t i = 0; i < bed->n; i++) sum -= p->result.power[i] * cos(k * bed->z[i]);
    return sum * 2 / (volume * 2 * bed->r[0] * k * k);
}

/* Finds the conductivity in an even gradient. In waves it is smaller: this acts as a resistance that rises with the
 * square of k. */
static double even_conduction(struct problem *p, double eps) {
    for (uint32_t i = 0; i < p->bed.n; i++) p->emissivity[i] = eps;
    return 3 / (4 / conduction(p, 1) - 1 / conduction(p, 2));
}

/* Makes the lattice of scenes.h, 2 x 2 cells wide and `cells` long. */
static struct bed column(char kind, int cells) {
    static const double basis[4][3] = {{0, 0, 0}, {0, .5, .5}, {.5, 0, .5}, {.5, .5, 0}}, centre[3] = {.5, .5, .5};
    const double side = kind == 'p' ? 2 : kind == 'i' ? 4 / sqrt(3) : 2 * sqrt(2);
    const int sites = kind == 'p' ? 1 : kind == 'i' ? 2 : 4;
    struct bed bed = bed_empty();
    for (int cell = 0; cell < 4 * cells; cell++)
        for (int s = 0; s < sites; s++) {
            const double *b = kind == 'i' && s == 1 ? centre : basis[s];
            add_sphere(&bed, (cell % 2 + b[0]) * side, (cell / 2 % 2 + b[1]) * side, (cell / 4 + b[2]) * side, 1);
        }
    bed.period[0] = bed.period[1] = 2 * side, bed.period[2] = cells * side;
    return bed;
}

/* Along the channels of the simple cubic lattice light goes so far that the value depends on the length of the bed. At
 * low emissivity programs differ by 5 %. */
LOOP_TEST(conduction_of_lattices, 3) {
    static const struct {
        char kind;
        int cells;
        double known[5], bar;
    } lattices[] = {{'p', 24, {.354, .527, .715, .929, 1.187}, .04},
                    {'i', 16, {.196, .336, .498, .688, .916}, .02},
                    {'f', 12, {.162, .299, .458, .646, .875}, .02}};
    OWNED_PROBLEM p = problem_of(column(lattices[_i].kind, lattices[_i].cells), 1, 1);
    trace(&p);
    for (int k = 0; k < 5; k++) assert_near(even_conduction(&p, .2 * (k + 1)), lattices[_i].known[k], lattices[_i].bar);
}

/* A small random bed conducts a few per cent more or less than a large one, by about the same factor at all
 * emissivities. */
TEST(conduction_of_a_random_bed) {
    static const double known[][2] = {{.2, .276}, {.4, .433}, {.6, .610}, {.8, .815}};
    struct bed one = packing(120, 1, 1, .586, 2, true), bed = bed_empty();
    ck_assert_int_eq(bed_make_copies(&bed, &one, (uint32_t[]){1, 1, 3}), 0);
    bed_free(&one);
    OWNED_PROBLEM p = problem_of(bed, 1, 1);
    trace(&p);
    const double black = even_conduction(&p, 1);
    assert_near(black, 1.061, .05);
    for (size_t k = 0; k < 4; k++) assert_near(even_conduction(&p, known[k][0]) / black, known[k][1] / 1.061, .02);
}
