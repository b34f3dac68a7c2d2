/* test_callbacks.c - functions of the caller that call the library again, and outputs of the simple layer after calls
 * that fail. SPDX-License-Identifier: MIT */
#include "host_owned.h"
#include "scenes.h"
#include "suite.h"

enum { SIDE = 3, CUBE = SIDE * SIDE * SIDE };

/* A cube of spheres. Functions of the caller get it as their context. */
struct cube {
    double x[CUBE], y[CUBE], z[CUBE], r[CUBE], emissivity[CUBE], temperature[CUBE], capacity[CUBE];
    double power[CUBE], found[CUBE], first[CUBE];
    fibrad_spheres spheres;
    fibrad_heat_sources sources;
    fibrad_bed *made;
    bool inside;    /* functions of the caller call the library */
    int calls, ask; /* calls so far; the call after which progress asks to stop, 0: never */
};

static void make_cube(struct cube *c) {
    *c = (struct cube){.calls = 0};
    for (int i = 0; i < CUBE; i++) {
        c->x[i] = 2.1 * (i % SIDE), c->y[i] = 2.1 * (i / SIDE % SIDE), c->z[i] = 2.1 * (i / SIDE / SIDE);
        c->r[i] = c->capacity[i] = 1, c->emissivity[i] = .7, c->temperature[i] = 500 + 20 * i;
    }
    c->spheres = (fibrad_spheres){.x = c->x, .y = c->y, .z = c->z, .r = c->r, .n = CUBE};
    fibrad_heat_sources_init(&c->sources);
    c->sources.emissivity = c->emissivity, c->sources.temperature = c->temperature, c->sources.surroundings = 300;
}

static void free_cube(struct cube *c) { fibrad_bed_free(c->made); }

#define OWNED_CUBE OWNED_BY(free_cube) struct cube

static const fibrad_heat_config coarse = {.directions = 12, .patches = 24};

/* Calls for the objects of a cube that are busy: all are refused, and write nothing. */
static void call_again(struct cube *c) {
    double power[CUBE], temperature[CUBE];
    fibrad_heat_result result = {.power = power, .temperature = temperature};
    const fibrad_light light = {.direction = {0, 0, -1}, .flux = 1};
    const fibrad_light_sources lit = {.light = &light, .lights = 1, .absorptivity = c->emissivity};
    fibrad_light_result shone = {.absorbed = power, .absorbed_first = temperature};
    fibrad_span span = {.temperature = temperature, .capacity = c->capacity, .duration = 1};
    c->calls++;
    if (!c->inside) return;
    for (int i = 0; i < CUBE; i++) power[i] = temperature[i] = 77;
    ck_assert_int_eq(fibrad_bed_solve(c->made, &c->sources, NULL, &result), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_bed_move(c->made, NULL, &c->spheres), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_bed_beams(c->made, NULL), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_bed_shine(c->made, &lit, &shone), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_bed_advance(c->made, &c->sources, &span), FIBRAD_E_STATE);
    for (int i = 0; i < CUBE; i++) ck_assert(power[i] == 77 && temperature[i] == 77);
}

static int show(void *cube, const char *stage, uint64_t done, uint64_t total) {
    struct cube *c = cube;
    (void)stage, (void)done, (void)total;
    call_again(c);
    return c->ask > 0 && c->calls >= c->ask;
}

static void warm(void *cube, const double *temperature, const double *wall_temperature, double *emissivity,
                 double *wall_emissivity) {
    (void)wall_temperature, (void)wall_emissivity;
    call_again(cube);
    for (int i = 0; i < CUBE; i++) emissivity[i] = isnan(temperature[i]) ? .5 : .3 + .4 * temperature[i] / 2000;
}

static void look(void *cube, double time, const double *temperature) {
    (void)time, (void)temperature;
    call_again(cube);
}

/* The results are those of functions that do not call the library. */
TEST(laws_that_solve) {
    double power[2][CUBE];
    for (int inside = 0; inside < 2; inside++) {
        OWNED_CUBE c;
        make_cube(&c);
        fibrad_run run = {.threads = 1, .progress = show, .context = &c};
        fibrad_heat_result result = {.power = power[inside], .temperature = c.found};
        assert_ok(made_with(&c.made, NULL, &c.spheres, &coarse, &run));
        c.inside = inside;
        assert_ok(made_settle(c.made, &c.sources, warm, &c, c.emissivity, NULL, &result));
        ck_assert_int_gt(c.calls, 2);
        c.inside = false;
        assert_ok(fibrad_bed_solve(c.made, &c.sources, NULL, &result)); /* it is free again */
    }
    ck_assert_mem_eq(power[0], power[1], sizeof power[0]);
}

LOOP_TEST(observers_that_move, 2) {
    double temperature[2][CUBE];
    for (int inside = 0; inside < 2; inside++) {
        OWNED_CUBE c;
        make_cube(&c);
        fibrad_run run = {.threads = 1, .progress = show, .context = &c};
        fibrad_law law = {.follow = warm, .context = &c};
        fibrad_span span = {.temperature = temperature[inside], .capacity = c.capacity, .duration = 1e-3};
        span.observe = look, span.law = _i ? &law : NULL, span.context = &c;
        memcpy(temperature[inside], c.temperature, sizeof c.temperature);
        assert_ok(made_with(&c.made, NULL, &c.spheres, &coarse, &run));
        c.inside = inside;
        assert_ok(fibrad_bed_advance(c.made, &c.sources, &span));
        ck_assert_int_gt(c.calls, 2);
        c.inside = false;
        assert_ok(fibrad_bed_move(c.made, NULL, &c.spheres)); /* it is free again */
    }
    ck_assert_mem_eq(temperature[0], temperature[1], sizeof temperature[0]);
}

/* A call that is stopped in its trace leaves a bed whose beams the next call traces. */
TEST(traces_that_stop_are_made_again) {
    OWNED_CUBE c;
    make_cube(&c);
    fibrad_run run = {.threads = 1, .progress = show, .context = &c};
    fibrad_span span = {.temperature = c.temperature, .capacity = c.capacity, .duration = 1e-9};
    assert_ok(made_with(&c.made, NULL, &c.spheres, &coarse, &run));
    assert_ok(fibrad_bed_advance(c.made, &c.sources, &span));
    assert_ok(fibrad_bed_move(c.made, NULL, &c.spheres));
    c.calls = 0, c.ask = 1;
    ck_assert_int_eq(fibrad_bed_beams(c.made, &coarse), FIBRAD_E_CANCELLED);
    c.ask = 0;
    assert_ok(fibrad_bed_advance(c.made, &c.sources, &span));
}

/* Laws that never settle, or go wrong: emissivities up and down; NaN at the second call. */
static void restless(void *calls, const double *temperature, const double *wall_temperature, double *emissivity,
                     double *wall_emissivity) {
    (void)temperature, (void)wall_temperature, (void)wall_emissivity;
    for (int i = 0; i < CUBE; i++) emissivity[i] = *(int *)calls % 2 ? .2 : .9;
    ++*(int *)calls;
}

static void wrong(void *calls, const double *temperature, const double *wall_temperature, double *emissivity,
                  double *wall_emissivity) {
    restless(calls, temperature, wall_temperature, emissivity, wall_emissivity);
    if (*(int *)calls == 2) emissivity[5] = NAN;
}

TEST(laws_that_fail_write_nothing) {
    fibrad_emissivity_law *const laws[] = {restless, wrong};
    for (int k = 0; k < 2; k++) {
        OWNED_CUBE c;
        int calls = 0;
        make_cube(&c);
        double before[CUBE], marked[CUBE], emissivity[CUBE];
        for (int i = 0; i < CUBE; i++) c.power[i] = c.found[i] = marked[i] = -7 - i, before[i] = emissivity[i] = .5;
        fibrad_heat_result result = {.power = c.power, .temperature = c.found, .surroundings_power = 77};
        assert_ok(made_with(&c.made, NULL, &c.spheres, &coarse, NULL));
        ck_assert_int_eq(made_settle(c.made, &c.sources, laws[k], &calls, emissivity, NULL, &result),
                         k == 0 ? FIBRAD_E_UNSETTLED : FIBRAD_E_ARGUMENT);
        ck_assert_mem_eq(emissivity, before, sizeof before);
        ck_assert_mem_eq(c.power, marked, sizeof marked);
        ck_assert_mem_eq(c.found, marked, sizeof marked);
        ck_assert(result.surroundings_power == 77 && result.sweeps == 0);
    }
}

/* Light that is cancelled after each number of calls of progress, until it is done. */
TEST(cancelled_light_writes_nothing) {
    OWNED_CUBE c;
    int cancelled = 0, status = FIBRAD_E_CANCELLED;
    make_cube(&c);
    const fibrad_light light = {.direction = {0, 0, -1}, .flux = 1};
    const fibrad_light_sources sources = {.light = &light, .lights = 1, .absorptivity = c.emissivity};
    fibrad_run run = {.threads = 1, .progress = show, .context = &c};
    assert_ok(made_with(&c.made, NULL, &c.spheres, &coarse, &run));
    fibrad_light_result result = {.absorbed = c.found, .absorbed_first = c.first};
    assert_ok(fibrad_bed_shine(c.made, &sources, &result));
    const fibrad_light_result whole = result;
    double marked[CUBE];
    for (int i = 0; i < CUBE; i++) marked[i] = c.found[i] = c.first[i] = -7 - i;
    for (int ask = 1; status == FIBRAD_E_CANCELLED; ask++) {
        c.calls = 0, c.ask = ask;
        status = fibrad_bed_shine(c.made, &sources, &result);
        if (status == FIBRAD_OK) break;
        ck_assert_int_eq(status, FIBRAD_E_CANCELLED);
        ck_assert_mem_eq(c.found, marked, sizeof marked);
        ck_assert_mem_eq(c.first, marked, sizeof marked);
        ck_assert(result.incident == whole.incident && result.transmitted == whole.transmitted);
        ck_assert(result.patches == whole.patches && result.patches[0] >= 0);
        cancelled++;
    }
    assert_ok(status);
    ck_assert_int_gt(cancelled, 2);
}

TEST(cancelled_span_writes_nothing) {
    OWNED_CUBE c;
    const fibrad_wall floor = {.kind = FIBRAD_WALL_PLANE, .plane = {.axis = 2, .at = -1.1}};
    const fibrad_scene_config scene = {.wall = &floor, .walls = 1};
    const double wall_temperature = 400, wall_emissivity = .5;
    double energy = 77, wall_power = 77, temperature[CUBE];
    make_cube(&c);
    c.sources.wall_temperature = &wall_temperature, c.sources.wall_emissivity = &wall_emissivity;
    fibrad_run run = {.threads = 1, .progress = show, .context = &c};
    memcpy(temperature, c.temperature, sizeof temperature);
    fibrad_span span = {.temperature = temperature, .capacity = c.capacity, .duration = 1e-2, .power = c.power};
    span.wall_power = &wall_power, span.wall_energy = &energy;
    span.steps = span.refused = span.sweeps = 77, span.surroundings_energy = span.error = 77;
    assert_ok(made_with(&c.made, &scene, &c.spheres, &coarse, &run));
    c.calls = 0, c.ask = 3; /* within the span */
    const fibrad_span before = span;
    ck_assert_int_eq(fibrad_bed_advance(c.made, &c.sources, &span), FIBRAD_E_CANCELLED);
    ck_assert_mem_eq(&span, &before, sizeof span);
    ck_assert_mem_eq(temperature, c.temperature, sizeof temperature);
    ck_assert(energy == 77 && wall_power == 77 && c.power[0] == 0);
    c.ask = 0;
    assert_ok(fibrad_bed_advance(c.made, &c.sources, &span));
    ck_assert(energy != 77 && span.steps != 77 && temperature[CUBE - 1] < c.temperature[CUBE - 1]);
}
