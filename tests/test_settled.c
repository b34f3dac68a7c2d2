/* test_settled.c - temperatures that are found for given powers, against closed forms, and against the powers that
 * follow from the same temperatures. SPDX-License-Identifier: MIT */
#include "host_owned.h"
#include "scenes.h"
#include "suite.h"

enum { N = 40, WALLS = 6 };

static const double pi = 3.14159265358979323846, sigma = FIBRAD_STEFAN_BOLTZMANN, unknown = NAN;

/* A bed in a box or in the open, its sources and its results. */
struct settled {
    struct bed bed;
    fibrad_wall wall[WALLS];
    fibrad_scene_config scene;
    fibrad_heat_config config;
    fibrad_heat_sources sources;
    fibrad_heat_result result;
    double temperature[N], emissivity[N], power[N], storage[N], reference[N];
    double wall_temperature[WALLS], wall_emissivity[WALLS], wall_power[WALLS];
    unsigned char insulated[WALLS];
    struct {
        double power[N], temperature[N], error[N], wall_power[WALLS], wall_temperature[WALLS];
    } found;
};

static void settled_free(struct settled *s) { bed_free(&s->bed); }

static void begin(struct settled *s, struct bed bed) {
    *s = (struct settled){.bed = bed};
    for (int axis = 0; axis < 3; axis++) s->scene.period[axis] = bed.period[axis];
    for (uint32_t i = 0; i < N; i++) s->temperature[i] = 300, s->emissivity[i] = .8, s->reference[i] = NAN;
    fibrad_heat_sources_init(&s->sources);
    s->sources.temperature = s->temperature, s->sources.emissivity = s->emissivity;
    s->sources.surroundings = 300;
    s->result = (fibrad_heat_result){.power = s->found.power, .wall_power = s->found.wall_power};
    s->result.temperature = s->found.temperature, s->result.wall_temperature = s->found.wall_temperature;
    s->result.temperature_error = s->found.error;
}

static void add_wall(struct settled *s, int axis, int upper, double at, double temperature, double emissivity) {
    const uint32_t k = s->scene.walls++;
    s->wall[k] = (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane = {axis, upper, at}};
    s->scene.wall = s->wall;
    s->wall_temperature[k] = temperature, s->wall_emissivity[k] = emissivity;
    s->sources.wall_temperature = s->wall_temperature, s->sources.wall_emissivity = s->wall_emissivity;
}

/* N unequal spheres in a box of six grey walls. */
static void begin_box(struct settled *s, uint64_t seed) {
    struct bed bed = packing(N, .3, 1, .3, seed, false);
    begin(s, bed);
    for (uint32_t i = 0; i < N; i++) {
        s->temperature[i] = 400 + 20 * (i * 7 % N);
        s->emissivity[i] = i % 8 == 0 ? 1 : .2 + .7 * (i * 11 % N) / N;
    }
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (uint32_t i = 0; i < N; i++) {
        const double at[3] = {bed.x[i], bed.y[i], bed.z[i]};
        for (int a = 0; a < 3; a++) low[a] = fmin(low[a], at[a] - bed.r[i]), high[a] = fmax(high[a], at[a] + bed.r[i]);
    }
    for (int k = 0; k < WALLS; k++)
        add_wall(s, k / 2, k % 2, k % 2 ? high[k / 2] + .1 : low[k / 2] - .1, 300 + 150 * k, .25 + .12 * k);
}

static int settle(struct settled *s) {
    OWNED_MADE *radiation = NULL;
    const fibrad_spheres spheres = {.x = s->bed.x, .y = s->bed.y, .z = s->bed.z, .r = s->bed.r, .n = s->bed.n};
    assert_ok(made_with(&radiation, &s->scene, &spheres, &s->config, NULL));
    const int status = fibrad_bed_solve(radiation, &s->sources, NULL, &s->result);
    return status;
}

static void close_to(double value, double truth, double error) {
    ck_assert_msg(fabs(value - truth) <= error * fabs(truth), "%.9g is not %.9g, off by %.2g", value, truth,
                  value / truth - 1);
}

/* A sphere alone gives off A eps sigma (T^4 - T0^4), less the term of `storage`. */
TEST(one_sphere) {
    static const double eps[] = {.1, .5, 1}, storage[] = {0, 3, 1e6};
    for (int k = 0; k < 9; k++) {
        OWNED_BY(settled_free) struct settled s;
        begin(&s, BED({0, 0, 0, .5}));
        s.temperature[0] = unknown, s.emissivity[0] = eps[k % 3], s.power[0] = 5e4, s.storage[0] = storage[k / 3];
        s.reference[0] = 900;
        s.sources.power = s.power, s.sources.storage = s.storage, s.sources.reference = s.reference;
        s.sources.tolerance = 1e-12;
        assert_ok(settle(&s));
        const double link = pi * eps[k % 3], t0 = 300, t1 = 900;
        const double e =
            (5e4 + sigma * (storage[k / 3] * pow(t1, 4) + link * pow(t0, 4))) / (sigma * (storage[k / 3] + link));
        close_to(s.found.temperature[0], pow(e, .25), 1e-9);
        close_to(-s.found.power[0], link * sigma * (e - pow(t0, 4)), storage[k / 3] > 1e3 ? 1e-6 : 1e-9);
        ck_assert_double_eq_tol(s.found.power[0] + s.result.surroundings_power, 0, 1e-9 * 5e4);
    }
}

/* Between endless plates, without spheres: q = sigma (T1^4 - T2^4)/(1/e1 + 1/e2 - 1). */
TEST(plates) {
    OWNED_BY(settled_free) struct settled s;
    begin(&s, bed_empty());
    s.scene.period[0] = s.scene.period[1] = 2;
    add_wall(&s, 2, 0, 0, unknown, .3);
    add_wall(&s, 2, 1, 1.5, 500, .6);
    s.sources.wall_power = s.wall_power;
    s.wall_power[0] = 4 * 8000;
    assert_ok(settle(&s));
    close_to(s.found.wall_temperature[0], pow(pow(500, 4) + 8000 / sigma * (1 / .3 + 1 / .6 - 1), .25), 1e-6);
    close_to(s.found.wall_power[1], 4 * 8000, 1e-9);
    ck_assert_double_eq(s.found.wall_temperature[1], 500);
}

/* Powers follow from given temperatures. Then the powers of every other wall are given, and the temperatures must come
 * back. Both solutions extrapolate, so a difference of second order remains. */
TEST(there_and_back) {
    OWNED_BY(settled_free) struct settled s;
    double temperature[N], wall_temperature[WALLS];
    begin_box(&s, 7);
    s.sources.tolerance = 1e-9;
    assert_ok(settle(&s));
    memcpy(temperature, s.temperature, sizeof temperature);
    memcpy(wall_temperature, s.wall_temperature, sizeof wall_temperature);
    for (uint32_t i = 0; i < N; i++) {
        assert_near(s.found.temperature[i], temperature[i], 1e-9);
        s.power[i] = i % 2 ? -s.found.power[i] : unknown;
        if (i % 2) s.temperature[i] = unknown;
    }
    for (int k = 0; k < WALLS; k++) s.wall_power[k] = k % 3 == 2 ? -s.found.wall_power[k] : unknown;
    s.wall_temperature[2] = s.wall_temperature[5] = unknown;
    s.sources.power = s.power, s.sources.wall_power = s.wall_power;
    assert_ok(settle(&s));
    for (uint32_t i = 0; i < N; i++) close_to(s.found.temperature[i], temperature[i], 1e-3);
    for (int k = 0; k < WALLS; k++) close_to(s.found.wall_temperature[k], wall_temperature[k], 1e-3);
    for (uint32_t i = 1; i < N; i += 2) ck_assert_double_eq(s.found.power[i], -s.power[i]);
}

/* In a box at one temperature, walls that give off nothing have the same temperature. */
TEST(equilibrium) {
    OWNED_BY(settled_free) struct settled s;
    begin_box(&s, 3);
    s.sources.power = s.power, s.sources.wall_power = s.wall_power, s.sources.insulated = s.insulated;
    for (int k = 0; k < WALLS; k++) s.wall_temperature[k] = k == 1 ? unknown : 700;
    s.insulated[4] = 1;
    for (uint32_t i = 0; i < N; i++) s.temperature[i] = unknown;
    s.emissivity[5] = 0;
    assert_ok(settle(&s));
    for (uint32_t i = 0; i < N; i++)
        if (i != 5) close_to(s.found.temperature[i], 700, 1e-12);
    ck_assert(isnan(s.found.temperature[5]));
    for (int k = 0; k < WALLS; k++) close_to(s.found.wall_temperature[k], 700, 1e-12);
}

/* An insulated wall reflects all, but has a temperature between those of the walls about it. */
TEST(insulated) {
    OWNED_BY(settled_free) struct settled s;
    double power[N];
    begin_box(&s, 5);
    for (int k = 0; k < WALLS; k++) s.wall_emissivity[k] = k == 3 ? 0 : .7;
    assert_ok(settle(&s));
    ck_assert(isnan(s.found.wall_temperature[3]));
    memcpy(power, s.found.power, sizeof power);
    s.wall_emissivity[3] = .4, s.insulated[3] = 1, s.wall_temperature[3] = unknown;
    s.sources.insulated = s.insulated;
    assert_ok(settle(&s));
    ck_assert_mem_eq(power, s.found.power, sizeof power);
    ck_assert_double_eq(s.found.wall_power[3], 0);
    ck_assert(s.found.wall_temperature[3] > 300 && s.found.wall_temperature[3] < 1200);
}

/* If no temperature is given, powers must add up to zero, or there is no solution. */
TEST(afloat) {
    OWNED_BY(settled_free) struct settled s;
    double sum = 0, weights = 0;
    begin_box(&s, 9);
    for (uint32_t i = 0; i < N; i++) s.temperature[i] = unknown, s.power[i] = i % 2 ? 1000 : -1000;
    for (int k = 0; k < WALLS; k++) s.wall_temperature[k] = unknown;
    s.sources.power = s.power, s.sources.wall_power = s.wall_power;
    s.sources.surroundings = 800;
    assert_ok(settle(&s));
    for (uint32_t i = 0; i < N; i++) {
        const double weight = s.emissivity[i] * 4 * pi * s.bed.r[i] * s.bed.r[i];
        sum += weight * pow(s.found.temperature[i], 4), weights += weight;
    }
    for (int k = 0; k < WALLS; k++) {
        const fibrad_wall *b = s.wall;
        const double size[3] = {b[1].plane.at - b[0].plane.at, b[3].plane.at - b[2].plane.at,
                                b[5].plane.at - b[4].plane.at};
        const double weight = s.wall_emissivity[k] * size[0] * size[1] * size[2] / size[k / 2];
        sum += weight * pow(s.found.wall_temperature[k], 4), weights += weight;
    }
    close_to(sum / weights, pow(800, 4), .01); /* areas as beams have them */
    for (uint32_t i = 0; i < N; i++) ck_assert_double_eq_tol(s.found.power[i], -s.power[i], 1e-6 * 1000);
    s.power[0] = -999;
    ck_assert_int_eq(settle(&s), FIBRAD_E_UNSOLVABLE);
    s.wall_temperature[0] = 800; /* this wall takes up the rest */
    assert_ok(settle(&s));
}

/* The emissivity of spheres and of the floor: .9 - T/2000. */
static void falling(void *calls, const double *temperature, const double *wall_temperature, double *emissivity,
                    double *wall_emissivity) {
    ++*(int *)calls;
    if (!isnan(temperature[0])) emissivity[0] = .9 - temperature[0] / 2000;
    if (wall_emissivity && !isnan(wall_temperature[0])) wall_emissivity[0] = .9 - wall_temperature[0] / 2000;
}

/* A sphere alone has an emissivity that falls with its temperature. Whether the temperature or the power is given, A
 * eps(T) sigma (T^4 - T0^4) is the power. */
TEST(emissivity_of_temperature) {
    for (int given = 0; given < 2; ++given) {
        OWNED_BY(settled_free) struct settled s;
        OWNED_MADE *radiation = NULL;
        int calls = 0;
        begin(&s, BED({0, 0, 0, .5}));
        s.temperature[0] = given ? 800 : unknown, s.power[0] = given ? unknown : 5e4, s.emissivity[0] = .5;
        s.sources.power = s.power, s.sources.emissivity = NULL;
        const fibrad_spheres spheres = {.x = s.bed.x, .y = s.bed.y, .z = s.bed.z, .r = s.bed.r, .n = 1};
        assert_ok(made_with(&radiation, NULL, &spheres, NULL, NULL));
        assert_ok(made_settle(radiation, &s.sources, falling, &calls, s.emissivity, NULL, &s.result));
        const double t = s.found.temperature[0];
        close_to(-s.found.power[0], pi * (.9 - t / 2000) * sigma * (pow(t, 4) - pow(300, 4)), 1e-4);
        if (given) ck_assert(t == 800 && calls == 2 && s.emissivity[0] == .5);
        if (!given) ck_assert_double_eq(s.found.power[0], -5e4);
        assert_invalid(made_settle(radiation, &s.sources, NULL, NULL, s.emissivity, NULL, &s.result));
    }
}

TEST(refused) {
    OWNED_BY(settled_free) struct settled s;
    begin_box(&s, 1);
    s.temperature[3] = unknown; /* and no powers */
    assert_invalid(settle(&s));
    s.sources.power = s.power;
    assert_ok(settle(&s));
    s.power[3] = NAN;
    assert_invalid(settle(&s));
    s.power[3] = 10, s.emissivity[3] = 0;
    assert_invalid(settle(&s));
    s.emissivity[3] = .5, s.power[3] = -1e7; /* more than the sphere can take up */
    ck_assert_int_eq(settle(&s), FIBRAD_E_UNSOLVABLE);
    ck_assert(isnan(s.found.temperature[3]) && s.found.temperature[2] == s.temperature[2]);
    s.power[3] = 10, s.storage[3] = 1, s.sources.storage = s.storage; /* held at what? */
    assert_invalid(settle(&s));
    s.storage[3] = 0;
    assert_ok(settle(&s));
    s.wall_temperature[2] = unknown;
    assert_invalid(settle(&s));
    s.sources.wall_power = s.wall_power;
    assert_ok(settle(&s));
    s.scene.walls = 2, s.wall_temperature[1] = unknown; /* walls without end */
    ck_assert_int_eq(settle(&s), FIBRAD_E_UNSUPPORTED);
}
