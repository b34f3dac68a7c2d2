/* test_spots.c - contacts at their places on spheres that conduct. SPDX-License-Identifier: MIT */
#include "fibrad_light.h"
#include "heat_problem.h"

/* A column of a simple cubic lattice of touching spheres between two plates, at temperatures near 1. Contacts lead from
 * sphere to sphere and to the plates. */
enum { LAYERS = 24, CONTACTS = LAYERS + 1 };
static double found[LAYERS], conductivity[LAYERS], power[LAYERS], flow[CONTACTS], conductance[CONTACTS];
static double least[LAYERS], largest[LAYERS];
static uint32_t first[CONTACTS], second[CONTACTS];

typedef struct carried {
    double all, contact; /* over 4 sigma T^3 d and the gradient */
} carried;

static void touch(struct problem *p, double k_star, double size) {
    for (uint32_t i = 0; i < CONTACTS; i++) {
        first[i] = i == 0 ? LAYERS : i - 1, second[i] = i == LAYERS ? LAYERS + 1 : i;
        conductance[i] = (i == 0 || i == LAYERS ? 4 : 2) * 4 * k_star * size * .5;
    }
    p->sources.contact_first = first, p->sources.contact_second = second;
    p->sources.conductance = conductance, p->sources.contacts = CONTACTS;
    p->result.contact_flow = flow;
}

/* size: the radius of a spot over that of a sphere; 0: no contacts. */
static carried carried_by(double k_star, double e, double size) {
    double spheres[LAYERS][4], x[2] = {0, 0}, xy[2] = {0, 0};
    for (int i = 0; i < LAYERS; i++) spheres[i][0] = spheres[i][1] = 0, spheres[i][2] = i + .5, spheres[i][3] = .5;
    OWNED_PROBLEM p = problem_of(bed_of(LAYERS, (const double(*)[4])spheres), NAN, e);
    p.bed.period[0] = p.bed.period[1] = 1;
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, 0, LAYERS}};
    p.wall_temperature[4] = 1.0005, p.wall_temperature[5] = .9995, p.sources.surroundings = 1;
    p.config.directions = 400;
    for (int i = 0; i < LAYERS; i++) power[i] = 0, conductivity[i] = 4 * k_star;
    p.sources.conductivity = conductivity, p.sources.power = power, p.result.temperature = found;
    p.result.least_temperature = least, p.result.largest_temperature = largest;
    trace(&p);
    double *spots = calloc(5 * CONTACTS + fibrad_heat_patches(p.heat), sizeof *spots);
    if (size > 0) touch(&p, k_star, size);
    p.sources.contact_places = spots;
    solve(&p);
    free(spots);
    for (uint32_t i = LAYERS / 4; i < 3 * LAYERS / 4; i++) {
        const double z = p.bed.z[i] - LAYERS / 2.;
        x[0] += z, x[1] += z * z, xy[0] += emission(found[i]), xy[1] += z * emission(found[i]);
    }
    const double n = LAYERS / 2., slope = (n * xy[1] - x[0] * xy[0]) / (n * x[1] - x[0] * x[0]);
    return (carried){p.wall_power[5] / -slope, size > 0 ? flow[LAYERS / 2] / -slope : 0};
}

/* What contacts add to the conductivity F of the lattice, and what they carry themselves. The numbers are from
 * harmonics to degree 15, whose exchange is by 2e7 rays, and from the closed forms for spots. */
static const struct lattice {
    double e, k_star, size, more, contact;
} lattice_with[] = {
    {1, .1, .05, .0002, .0002},  {1, 1, .05, .0093, .0220},  {.6, 10, .05, .431, .4528}, {.2, 1, .05, .0364, .0419},
    {.2, 10, .05, .4611, .4679}, {.6, 3, .05, .1039, .1227}, {1, 1, .02, .0036, .0085},  {.6, 1, .1, .0405, .0641},
    {.6, 10, .1, .8393, .8839},  {1, 10, .02, .1579, .1758}, {1, 10, .1, .7616, .8475},  {.2, .1, .05, .00065, .00185},
};
LOOP_TEST(a_lattice_with_contacts, by_night(12, 8)) {
    const struct lattice *at = &lattice_with[_i];
    const carried without = carried_by(at->k_star, at->e, 0), with = carried_by(at->k_star, at->e, at->size);
    ck_assert_double_le(fabs(with.all - without.all - at->more), .01 * with.all);
    ck_assert_double_le(fabs(with.contact - at->contact), fmax(.05 * at->contact, .002));
}

/* If the solid conducts well, the lattice carries what two spots at opposite poles carry: without radiation the
 * temperature drops between them by Q/(2 k a) (1 + (x/pi) (1/2 - ln x - .85 x)), x being a/r. */
LOOP_TEST(a_solid_that_conducts_well, 4) {
    static const double size[] = {.02, .05, .1, .05}, k_star[] = {1e4, 1e4, 1e6, 1e8};
    const double x = size[_i], truth = x * k_star[_i] / (1 + x / PI * (.5 - log(x) - .85 * x));
    const carried with = carried_by(k_star[_i], .5, x);
    assert_near(with.contact, truth, .01);
    assert_near(with.all, truth, .01);
}

/* A hot plate heats a sphere through a contact. The hottest place of the sphere is the spot, which is about as hot as
 * the plate: a plate has one temperature. */
TEST(spots_are_the_hottest_and_coldest_places) {
    const carried with = carried_by(1, .6, .05);
    ck_assert_double_gt(with.contact, 0);
    assert_near(largest[0] - 1, 1.0005 - 1, 1e-2);
    assert_near(1 - least[LAYERS - 1], 1 - .9995, 1e-2);
    for (int i = 1; i < LAYERS; i++) ck_assert_double_le(fabs(least[i - 1] - largest[i]), 1e-6);
}

/* A contact carries the same in all directions: its spot may lie anywhere on a patch. Two spheres in cold surroundings.
 */
TEST(directions_do_not_matter) {
    enum { DIRECTIONS = 8 };
    double carries[DIRECTIONS], hottest[DIRECTIONS], sum = 0;
    for (int k = 0; k < DIRECTIONS; k++) {
        const double z = 1 - (2 * k + 1.) / DIRECTIONS, across = sqrt(1 - z * z), turn = 2.4 * k;
        OWNED_PROBLEM p =
            problem_of(BED({0, 0, 0, 1}, {2 * across * cos(turn), 2 * across * sin(turn), 2 * z, 1}), 1, .7);
        p.temperature[1] = 1.2, p.sources.surroundings = .5;
        for (int i = 0; i < 2; i++) conductivity[i] = 8;
        first[0] = 0, second[0] = 1, conductance[0] = 2 * 8 * .05;
        p.sources.contact_first = first, p.sources.contact_second = second, p.sources.conductance = conductance;
        p.sources.contacts = 1, p.sources.conductivity = conductivity;
        p.result.contact_flow = &carries[k], p.result.least_temperature = least, p.result.largest_temperature = largest;
        trace(&p);
        double *spots = calloc(5 + fibrad_heat_patches(p.heat), sizeof *spots);
        p.sources.contact_places = spots;
        solve(&p);
        free(spots);
        hottest[k] = largest[0], sum += carries[k];
    }
    for (int k = 0; k < DIRECTIONS; k++) {
        assert_near(carries[k], sum / DIRECTIONS, .02);
        assert_near(hottest[k] - 1, hottest[0] - 1, .03);
    }
}

enum { N = 60, MOST = N * N / 2 };
/* In a bed each sphere conducts what its contacts carry, and gains what is given. Nothing is lost. */
static void solve_bed(bool backwards, double *carries) {
    static double h[MOST], conducted[N], each[N], solid[N];
    static uint32_t from[MOST], to[MOST];
    OWNED_PROBLEM p = problem_of(packing(N, .8, 1.2, .5, 3, false), NAN, .8);
    uint32_t contacts = 0;
    for (uint32_t i = 0; i < N; i++)
        for (uint32_t j = 0; j < i; j++) {
            const double x = p.bed.x[i] - p.bed.x[j], y = p.bed.y[i] - p.bed.y[j], z = p.bed.z[i] - p.bed.z[j];
            if (x * x + y * y + z * z < 1.2 * (p.bed.r[i] + p.bed.r[j]) * (p.bed.r[i] + p.bed.r[j]))
                from[contacts] = i, to[contacts] = j, h[contacts++] = .5;
        }
    ck_assert_uint_gt(contacts, N);
    for (int i = 0; i < N; i++) p.emissivity[i] = i % 5 ? .8 : 1, each[i] = i % 3 - .9, solid[i] = i % 7 ? 8 : INFINITY;
    for (int i = 0; i < 3; i++) p.temperature[i] = 1 + .2 * i, each[i] = NAN;
    p.sources.surroundings = .9, p.sources.power = each, p.sources.conductivity = solid;
    p.sources.contact_first = from, p.sources.contact_second = to, p.sources.conductance = h;
    p.sources.contacts = contacts;
    p.result.contact_flow = carries, p.result.conducted = conducted;
    p.backwards = backwards, p.isa = backwards ? FIBRAD_ISA_SCALAR : 0;
    trace(&p);
    double *spots = calloc(5 * contacts + fibrad_heat_patches(p.heat), sizeof *spots);
    p.sources.contact_places = spots;
    solve(&p);
    free(spots);
    double all = p.result.surroundings_power;
    for (uint32_t i = 0; i < N; i++) {
        double sum = 0;
        for (uint32_t k = 0; k < contacts; k++) sum += (to[k] == i) * carries[k] - (from[k] == i) * carries[k];
        ck_assert_double_le(fabs(sum - conducted[i]), 1e-12 * contacts);
        if (i >= 3) ck_assert_double_le(fabs(p.result.power[i] + each[i]), 1e-12);
        all += p.result.power[i];
    }
    ck_assert_double_le(fabs(all), 1e-10);
}

TEST(a_bed_with_contacts) {
    static double carries[MOST], backwards[MOST];
    solve_bed(false, carries);
    solve_bed(true, backwards);
    ck_assert_mem_eq(carries, backwards, sizeof carries);
}

/* What a contact carries, and its estimate. The numbers are from rings in finer steps: series of Legendre polynomials
 * for conduction, spots of one temperature, and view factors between all rings, of the plane as well. */
struct carrier {
    double conductivity[2], emissivity[2], size, radius; /* radius 0: the second is the plane below */
    double warm[2], surroundings, power, flow;
};
static void assert_carries(const struct carrier *at, double bar) {
    const bool plane = at->radius == 0;
    double carries, error, *k = (double[]){at->conductivity[0], at->conductivity[1]};
    OWNED_PROBLEM p = problem_of(plane ? BED({0, 0, .5, .5}) : BED({0, 0, .5, .5}, {0, 0, 1 + at->radius, at->radius}),
                                 NAN, at->emissivity[0]);
    p.sources.sigma = FIBRAD_STEFAN_BOLTZMANN, p.sources.surroundings = at->surroundings;
    if (plane) p.walls = (struct walls){.planes = 16}, p.wall_temperature[4] = at->warm[1];
    if (plane) p.wall_emissivity[4] = at->emissivity[1];
    if (!plane) p.temperature[0] = at->warm[0], p.temperature[1] = at->warm[1], p.emissivity[1] = at->emissivity[1];
    first[0] = 0, second[0] = 1, power[0] = at->power;
    conductance[0] = 4 * at->size * .5 / (1 / k[0] + (plane ? 0 : 1 / k[1]));
    p.sources.conductivity = k, p.sources.power = plane ? power : NULL, p.sources.contacts = 1;
    p.sources.contact_first = first, p.sources.contact_second = second, p.sources.conductance = conductance;
    p.result.contact_flow = &carries, p.result.contact_error = &error, p.result.temperature = found;
    trace(&p);
    double *spots = calloc(5 + fibrad_heat_patches(p.heat), sizeof *spots);
    p.sources.contact_places = spots;
    solve(&p);
    free(spots);
    assert_near(carries, at->flow, bar);
    ck_assert_double_le(fabs(carries - at->flow), 2 * error + 1e-3 * fabs(at->flow));
    ck_assert_double_le(error, .1 * fabs(at->flow));
}

static const struct carrier at_plane[] = {
    {{11.143}, {.3, .1}, .02, 0, {0, 1000}, 700, 0, -95.9189},
    {{18.144}, {.6, .4}, .02, 0, {0, 900}, 1100, 0, 74.6443},
    {{68.04}, {1, .1}, .03, 0, {0, 900}, 1100, 0, 715.037},
    {{41.785}, {.3, .4}, .06, 0, {0, 1000}, 700, 0, -750.464},
    {{69.642}, {.9, .1}, .1, 0, {0, 1000}, 700, 0, -3228.48},
    {{113.4}, {1, .4}, .1, 0, {0, 900}, 1100, 0, 3102.02},
    {{75.403}, {.73, .93}, .088, 0, {0, 690}, 1047, 0, 2374.81},
    {{329.721}, {.84, .43}, .065, 0, {0, 840}, 867, -2310, 476.332},
    {{453.6}, {.6, .4}, .06, 0, {0, 900}, 1100, 0, 7467.78},
};
LOOP_TEST(a_plane_takes, 9) { assert_carries(&at_plane[_i], _i < 2 ? .03 : .01); }

static const struct carrier facing[] = {
    {{41.785, 41.785}, {.8, .8}, .1, .3, {1000, 700}, 600, 0, 1268.92},
    {{41.785, 41.785}, {.4, .4}, .06, .5, {1000, 700}, 1000, 0, 791.626},
    {{69.642, 69.642}, {1, 1}, .1, .3, {1000, 700}, 800, 0, 2134.3},
    {{110.285, 236.45}, {.85, .29}, .089, .37, {1125, 823}, 1062, 0, 4226},
    {{139.284, 139.284}, {1, 1}, .06, .5, {1000, 700}, 800, 0, 2303.48},
    {{173.69, 139.498}, {.41, .6}, .098, .28, {771, 963}, 674, 0, -2988.01},
    {{407.935, 155.56}, {.22, .43}, .1, .27, {1036, 896}, 633, 0, 3003.69},
};
LOOP_TEST(unlike_spheres_exchange, 7) { assert_carries(&facing[_i], .015); }

/* A sphere between black plates, which see nothing else: the light that arrives is known exactly. */
LOOP_TEST(both_plates_take, 3) {
    static const struct plates {
        double k, e, flow[2];
    } of[] = {{20, .6, {23.5324, -12.6349}}, {100, .8, {198.516, -150.387}}, {400, .8, {1074.28, -901.215}}};
    const struct plates *at = &of[_i];
    double flows[2], error[2], k = at->k, none = 0;
    OWNED_PROBLEM p = problem_of(BED({0, 0, .5, .5}), NAN, at->e);
    p.sources.sigma = FIBRAD_STEFAN_BOLTZMANN, p.sources.surroundings = 900;
    p.walls = (struct walls){.planes = 48, .at = {0, 0, 0, 0, 0, 1}};
    p.wall_temperature[4] = 900, p.wall_temperature[5] = 1000;
    for (uint32_t i = 0; i < 2; i++) first[i] = 0, second[i] = 1 + i, conductance[i] = 4 * k * .03 * .5;
    p.sources.conductivity = &k, p.sources.power = &none, p.sources.contacts = 2;
    p.sources.contact_first = first, p.sources.contact_second = second, p.sources.conductance = conductance;
    p.result.contact_flow = flows, p.result.contact_error = error;
    trace(&p);
    double *spots = calloc(10 + fibrad_heat_patches(p.heat), sizeof *spots);
    p.sources.contact_places = spots;
    solve(&p);
    free(spots);
    for (int i = 0; i < 2; i++) {
        assert_near(flows[i], at->flow[i], _i == 0 ? .03 : .01);
        ck_assert_double_le(fabs(flows[i] - at->flow[i]), 2 * error[i]);
        ck_assert_double_le(error[i], .1 * fabs(at->flow[i]));
    }
}
