/* heat_calls.h - a heat problem in its own blocks of memory, for tests of calls. SPDX-License-Identifier: MIT */
#ifndef TESTS_HEAT_CALLS_H
#define TESTS_HEAT_CALLS_H

#include "heat_runs.h"
#include "suite.h"

enum { N = 14, PARTS = 8, WALLS = 3 };

struct problem {
    unsigned char *scene_block, *heat_block;
    size_t scene_size, heat_size;
    fibrad_scene *scene;
    fibrad_heat *heat;
    fibrad_work work;
    double temperature[N], emissivity[N], wall_temperature[WALLS], wall_emissivity[WALLS];
    fibrad_heat_sources sources;
    double power[N], wall_power[WALLS];
    fibrad_heat_result result;
};

/* The scene, the sources and the memory of a problem. */
struct contents {
    double x[N], y[N], z[N], r[N];
    fibrad_wall wall[WALLS];
    double period_x;
    uint32_t n;
};

static const fibrad_heat_config heat_config = {
    .directions = 12, .points = 64, .patches = 24, .wall_rays = 2000, .parts = PARTS};

/* Spheres in two layers between a floor, a ceiling and one side wall. The other sides are open. */
static inline struct contents contents_of(uint64_t seed) {
    struct contents c = {.wall = {plane_at(2, 0, -1.2), plane_at(2, 1, 3.4), plane_at(1, 0, -1.3)}, .n = N};
    for (uint32_t i = 0; i < N; i++) {
        c.x[i] = 2.1 * (i % 4) + .1 * bed_make_random(seed, 4 * i);
        c.y[i] = 2.1 * (i / 4 % 2) + .1 * bed_make_random(seed, 4 * i + 1);
        c.z[i] = 2.1 * (i / 8) + .1 * bed_make_random(seed, 4 * i + 2);
        c.r[i] = .8 + .2 * bed_make_random(seed, 4 * i + 3);
    }
    return c;
}

static inline int build_at(void *block, size_t size, const struct contents *c, fibrad_scene **scene) {
    fibrad_plane opening[6];
    uint32_t openings = 0;
    for (int side = c->period_x > 0 ? 2 : 0; side < 6; side++) {
        bool walled = false;
        for (int b = 0; b < WALLS; b++) walled = walled || 2 * c->wall[b].plane.axis + c->wall[b].plane.upper == side;
        if (!walled) opening[openings++] = (fibrad_plane){side / 2, side % 2, side % 2 ? 9 : -9};
    }
    const fibrad_scene_config config = {
        .period = {c->period_x}, .wall = c->wall, .walls = WALLS, .opening = opening, .openings = openings};
    const fibrad_spheres spheres = {.x = c->x, .y = c->y, .z = c->z, .r = c->r, .n = c->n};
    return fibrad_scene_init(scene, block, size, &config, &spheres, NULL);
}

/* Makes the scene in its block, which may have another scene. */
static inline void build(struct problem *p, const struct contents *c) {
    assert_ok(build_at(p->scene_block, p->scene_size, c, &p->scene));
}

static inline void set_sources(struct problem *p) {
    for (uint32_t i = 0; i < N; i++)
        p->temperature[i] = 1 + bed_make_random(7, i), p->emissivity[i] = .2 + .7 * bed_make_random(8, i);
    for (uint32_t b = 0; b < WALLS; b++) p->wall_temperature[b] = 1 + .3 * b, p->wall_emissivity[b] = .4 + .2 * b;
    fibrad_heat_sources_init(&p->sources);
    p->sources.temperature = p->temperature, p->sources.emissivity = p->emissivity;
    p->sources.wall_temperature = p->wall_temperature, p->sources.wall_emissivity = p->wall_emissivity;
    p->sources.surroundings = .7, p->sources.tolerance = 1e-9;
    p->result.power = p->power, p->result.wall_power = p->wall_power;
}

/* Makes a problem by fibrad_heat_init. All bytes of the block are `fill` before. */
static inline struct problem *begin_problem(const struct contents *c, int fill) {
    struct problem *p = calloc(1, sizeof *p);
    p->scene_size = fibrad_scene_size(N, 0);
    p->scene_block = block_of(p->scene_size);
    p->work = work_growing();
    build(p, c);
    p->heat_size = fibrad_heat_size(&heat_config, p->scene);
    ck_assert_uint_gt(p->heat_size, 0);
    p->heat_block = block_of(p->heat_size);
    memset(p->heat_block, fill, p->heat_size);
    assert_ok(fibrad_heat_init(&p->heat, p->heat_block, p->heat_size, &heat_config, p->scene));
    set_sources(p);
    return p;
}

static inline void end_problem(struct problem *p) {
    work_free(&p->work);
    free(p->scene_block);
    free(p->heat_block);
    free(p);
}

/* Before a problem that ends with its block. */
static inline void end_owned(struct problem **p) { end_problem(*p); }
#define ENDED OWNED_BY(end_owned)

static inline uint32_t tasks_of(const struct problem *p) { return fibrad_heat_tasks(p->heat); }

static inline void trace_all(struct problem *p) { assert_ok(heat_trace(p->heat, &p->work, false)); }

static inline void solve(struct problem *p) { heat_solve(p->heat, &p->sources, &p->result, false); }

/* Powers of a problem when all calls come in the right order. */
static inline struct problem *by_the_book(const struct contents *c) {
    struct problem *p = begin_problem(c, 0xa5);
    trace_all(p);
    solve(p);
    return p;
}

static inline void assert_same_powers(const struct problem *p, const struct problem *book) {
    ck_assert_mem_eq(p->power, book->power, sizeof p->power);
    ck_assert_mem_eq(p->wall_power, book->wall_power, sizeof p->wall_power);
    ck_assert_mem_eq(&p->result.surroundings_power, &book->result.surroundings_power, sizeof(double));
}

/* Asserts that all calls that need fibrad_heat_begin are refused before it. */
static inline void assert_nothing_to_solve(struct problem *p) {
    int solved = 77;
    memset(p->power, 0x11, sizeof p->power);
    double power[N];
    memcpy(power, p->power, sizeof power);
    for (uint32_t k = 0; k < PARTS; k++) ck_assert_int_eq(fibrad_heat_sweep(p->heat, k), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_heat_step(p->heat, &solved), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_heat_read(p->heat, &p->result), FIBRAD_E_STATE);
    ck_assert_int_eq(solved, 77);
    ck_assert_mem_eq(power, p->power, sizeof power);
}

/* Contents with one change, which `what` selects. */
static inline struct contents changed(const struct contents *from, int what) {
    struct contents c = *from;
    if (what == 0) c.r[5] = nextafter(c.r[5], 0);
    if (what == 1) c.x[0] = nextafter(c.x[0], 1);
    if (what == 2) c.z[N - 1] += 1e-3;
    for (uint32_t k = 2; k < 4 && what == 3; k++) /* two of them change places */
        c.x[k] = from->x[5 - k], c.y[k] = from->y[5 - k], c.z[k] = from->z[5 - k], c.r[k] = from->r[5 - k];
    if (what == 4) c.wall[1].plane.at += 1e-9;
    if (what == 5) c.wall[0] = from->wall[1], c.wall[1] = from->wall[0]; /* walls in another order */
    if (what == 6) c.period_x = 40;
    if (what == 7) c.n = N - 1;
    if (what == 8) c.n = 0;
    return c;
}

/* Stages of a problem: made, traced, begun and swept, solved. */
enum { MADE, TRACED, SWEPT, SOLVED, STAGES };

static inline void advance_to(struct problem *p, int from, int to) {
    for (int stage = from + 1; stage <= to; stage++) {
        if (stage == TRACED) trace_all(p);
        if (stage == SWEPT) {
            assert_ok(fibrad_heat_begin(p->heat, &p->sources));
            for (int k = 0, solved; k < 3; k++) {
                heat_sweep(p->heat, false);
                assert_ok(fibrad_heat_step(p->heat, &solved));
            }
            heat_sweep(p->heat, false);
        }
        for (int solved = 0; stage == SOLVED && !solved;) {
            assert_ok(fibrad_heat_step(p->heat, &solved));
            if (!solved) heat_sweep(p->heat, false);
        }
    }
}

#endif
