/* test_protocol.c - calls left out, repeated, too early or for a scene that has changed: each is refused, and when the
 * protocol is then followed the numbers are right. SPDX-License-Identifier: MIT */
#include "fibrad_heat.h"
#include "scenes.h"
#include "suite.h"

/* ---- heat: a problem in blocks of its own, which stay where they are -------------------------------------------- */

enum { N = 14, PARTS = 8, BODIES = 3 };

struct problem {
    unsigned char *scene_block, *heat_block;
    size_t scene_size, heat_size;
    fibrad_scene *scene;
    fibrad_heat *heat;
    fibrad_work work;
    double temperature[N], emissivity[N], body_temperature[BODIES], body_emissivity[BODIES];
    fibrad_heat_sources sources;
    double power[N], body_power[BODIES];
    fibrad_heat_result result;
};

/* What a problem is made of. */
struct contents {
    double x[N], y[N], z[N], r[N];
    fibrad_body body[BODIES];
    double period_x;
    uint32_t n;
};

static const fibrad_heat_config heat_config = {.directions = 24, .patches = 24, .parts = PARTS};

/* Spheres in two layers between a floor, a ceiling and one side wall; open on the other sides. */
static struct contents contents_of(uint64_t seed) {
    struct contents c = {.body = {plane_at(2, 0, -1.2), plane_at(2, 1, 3.4), plane_at(1, 0, -1.3)}, .n = N};
    for (uint32_t i = 0; i < N; i++) {
        c.x[i] = 2.1 * (i % 4) + .1 * bed_make_random(seed, 4 * i);
        c.y[i] = 2.1 * (i / 4 % 2) + .1 * bed_make_random(seed, 4 * i + 1);
        c.z[i] = 2.1 * (i / 8) + .1 * bed_make_random(seed, 4 * i + 2);
        c.r[i] = .8 + .2 * bed_make_random(seed, 4 * i + 3);
    }
    return c;
}

static int build_at(void *block, size_t size, const struct contents *c, fibrad_scene **scene) {
    fibrad_plane opening[6];
    uint32_t openings = 0;
    for (int side = c->period_x > 0 ? 2 : 0; side < 6; side++) {
        bool walled = false;
        for (int b = 0; b < BODIES; b++) walled = walled || 2 * c->body[b].plane.axis + c->body[b].plane.upper == side;
        if (!walled) opening[openings++] = (fibrad_plane){side / 2, side % 2, side % 2 ? 9 : -9};
    }
    const fibrad_scene_config config = {
        .period = {c->period_x}, .body = c->body, .bodies = BODIES, .opening = opening, .openings = openings};
    const fibrad_spheres spheres = {.x = c->x, .y = c->y, .z = c->z, .r = c->r, .n = c->n};
    return fibrad_scene_init(scene, block, size, &config, &spheres, NULL);
}

/* Makes the scene in its place, where another one may be. */
static void build(struct problem *p, const struct contents *c) {
    ck_assert_int_eq(build_at(p->scene_block, p->scene_size, c, &p->scene), FIBRAD_OK);
}

static void set_sources(struct problem *p) {
    for (uint32_t i = 0; i < N; i++)
        p->temperature[i] = 1 + bed_make_random(7, i), p->emissivity[i] = .2 + .7 * bed_make_random(8, i);
    for (uint32_t b = 0; b < BODIES; b++) p->body_temperature[b] = 1 + .3 * b, p->body_emissivity[b] = .4 + .2 * b;
    fibrad_heat_sources_init(&p->sources);
    p->sources.temperature = p->temperature, p->sources.emissivity = p->emissivity;
    p->sources.body_temperature = p->body_temperature, p->sources.body_emissivity = p->body_emissivity;
    p->sources.surroundings = .7, p->sources.tolerance = 1e-9;
    p->result.power = p->power, p->result.body_power = p->body_power;
}

/* A problem as far as fibrad_heat_init; what was in the block before is `fill`. */
static struct problem *begin_problem(const struct contents *c, int fill) {
    struct problem *p = calloc(1, sizeof *p);
    p->scene_size = fibrad_scene_size(N, 0);
    p->scene_block = block_of(p->scene_size);
    p->work = work_growing();
    build(p, c);
    p->heat_size = fibrad_heat_size(&heat_config, p->scene);
    ck_assert_uint_gt(p->heat_size, 0);
    p->heat_block = block_of(p->heat_size);
    memset(p->heat_block, fill, p->heat_size);
    ck_assert_int_eq(fibrad_heat_init(&p->heat, p->heat_block, p->heat_size, &heat_config, p->scene), FIBRAD_OK);
    set_sources(p);
    return p;
}

static void end_problem(struct problem *p) {
    work_free(&p->work);
    free(p->scene_block);
    free(p->heat_block);
    free(p);
}

static uint32_t tasks_of(const struct problem *p) { return fibrad_heat_tasks(p->heat); }

static void trace_all(struct problem *p) {
    for (uint32_t k = 0; k < tasks_of(p); k++) ck_assert_int_eq(fibrad_heat_trace(p->heat, &p->work, k), FIBRAD_OK);
}

static void sweep_all(struct problem *p) {
    for (uint32_t k = 0; k < PARTS; k++) ck_assert_int_eq(fibrad_heat_sweep(p->heat, k), FIBRAD_OK);
}

/* From fibrad_heat_begin on. */
static void solve(struct problem *p) {
    ck_assert_int_eq(fibrad_heat_begin(p->heat, &p->sources), FIBRAD_OK);
    for (int solved = 0; !solved;) {
        sweep_all(p);
        ck_assert_int_eq(fibrad_heat_step(p->heat, &solved), FIBRAD_OK);
    }
    ck_assert_int_eq(fibrad_heat_read(p->heat, &p->result), FIBRAD_OK);
}

/* Powers by the book. */
static struct problem *by_the_book(const struct contents *c) {
    struct problem *p = begin_problem(c, 0xa5);
    trace_all(p);
    solve(p);
    return p;
}

static void assert_same_powers(const struct problem *p, const struct problem *book) {
    ck_assert_mem_eq(p->power, book->power, sizeof p->power);
    ck_assert_mem_eq(p->body_power, book->body_power, sizeof p->body_power);
    ck_assert_mem_eq(&p->result.surroundings_power, &book->result.surroundings_power, sizeof(double));
}

/* To what the tolerance of the sources leaves, when the one of them began with a solution. */
static void assert_like_powers(const struct problem *p, const struct problem *book) {
    double largest = 0, difference = 0;
    for (uint32_t i = 0; i < N; i++) {
        worst_of(&largest, fabs(book->power[i]));
        worst_of(&difference, fabs(p->power[i] - book->power[i]));
    }
    for (uint32_t b = 0; b < BODIES; b++) worst_of(&difference, fabs(p->body_power[b] - book->body_power[b]));
    worst_of(&difference, fabs(p->result.surroundings_power - book->result.surroundings_power));
    ck_assert_double_gt(largest, 0);
    ck_assert_double_lt(difference, 1e-6 * largest);
}

/* What may not be called before `begin` is not called. */
static void assert_nothing_to_solve(struct problem *p) {
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

static void assert_no_begin(struct problem *p) {
    ck_assert_int_eq(fibrad_heat_begin(p->heat, &p->sources), FIBRAD_E_STATE);
    assert_nothing_to_solve(p);
}

/* ---- heat: tasks ------------------------------------------------------------------------------------------------ */

/* Every fibrad_heat_trace has returned an error, and the caller did not look. */
START_TEST(traces_that_failed) {
    const struct contents c = contents_of(1);
    struct problem *book = by_the_book(&c), *p = begin_problem(&c, 0xa5);
    unsigned char small[64];
    fibrad_work none = {0}, tiny = work_fixed(small, sizeof small);
    for (uint32_t k = 0; k < tasks_of(p); k++) {
        ck_assert_int_eq(fibrad_heat_trace(p->heat, &none, k), FIBRAD_E_WORK);
        ck_assert_uint_gt(none.memory.needed, 0);
        ck_assert_int_eq(fibrad_heat_trace(p->heat, &tiny, k), FIBRAD_E_WORK);
        ck_assert_uint_gt(tiny.memory.needed, sizeof small);
        ck_assert_int_eq(fibrad_heat_trace(p->heat, NULL, k), FIBRAD_E_ARGUMENT);
    }
    assert_no_begin(p);
    trace_all(p); /* each may be called again */
    solve(p);
    assert_same_powers(p, book);
    end_problem(p);
    end_problem(book);
}
END_TEST

static void *no_more(void *context, void *block, size_t size) {
    (void)context, (void)block, (void)size;
    return NULL;
}

START_TEST(traces_without_memory) {
    const struct contents c = contents_of(2);
    struct problem *book = by_the_book(&c), *p = begin_problem(&c, 0);
    fibrad_work work = {.memory = {.resize = no_more}};
    for (uint32_t k = 0; k < tasks_of(p); k++) ck_assert_int_eq(fibrad_heat_trace(p->heat, &work, k), FIBRAD_E_MEMORY);
    assert_no_begin(p);
    work.memory.resize = test_resize; /* now there is some */
    for (uint32_t k = 0; k < tasks_of(p); k++) ck_assert_int_eq(fibrad_heat_trace(p->heat, &work, k), FIBRAD_OK);
    solve(p);
    assert_same_powers(p, book);
    work_free(&work);
    end_problem(p);
    end_problem(book);
}
END_TEST

/* Nothing is traced, whatever was in the block before. */
START_TEST(nothing_traced) {
    static const int fills[] = {0, 1, 0x5a, 0xff};
    const struct contents c = contents_of(3);
    struct problem *book = by_the_book(&c);
    for (size_t k = 0; k < sizeof fills / sizeof *fills; k++) {
        struct problem *p = begin_problem(&c, fills[k]);
        assert_nothing_to_solve(p);
        assert_no_begin(p);
        trace_all(p);
        assert_nothing_to_solve(p);
        solve(p);
        assert_same_powers(p, book);
        end_problem(p);
    }
    end_problem(book);
}
END_TEST

/* One task is left out, the first, the last, one of spheres and one of walls among them. */
START_TEST(one_task_not_traced) {
    const struct contents c = contents_of(4);
    struct problem *book = by_the_book(&c);
    ck_assert_uint_gt(tasks_of(book), N + 1);
    const uint32_t last = tasks_of(book) - 1, left_out[] = {0, N / 2, N - 1, N, (N + last) / 2, last};
    for (size_t t = 0; t < sizeof left_out / sizeof *left_out; t++) {
        const uint32_t out = left_out[t];
        struct problem *p = begin_problem(&c, 0);
        for (uint32_t k = 0; k < tasks_of(p); k++)
            if (k != out) ck_assert_int_eq(fibrad_heat_trace(p->heat, &p->work, k), FIBRAD_OK);
        assert_no_begin(p);
        ck_assert_int_eq(fibrad_heat_trace(p->heat, &p->work, out), FIBRAD_OK);
        solve(p);
        assert_same_powers(p, book);
        end_problem(p);
    }
    end_problem(book);
}
END_TEST

START_TEST(tasks_and_parts_out_of_range) {
    const struct contents c = contents_of(5);
    struct problem *book = by_the_book(&c), *p = begin_problem(&c, 0);
    const uint32_t tasks = tasks_of(p), beyond[] = {0, 1, 1000, UINT32_MAX - tasks};
    for (size_t k = 0; k < 4; k++)
        ck_assert_int_eq(fibrad_heat_trace(p->heat, &p->work, tasks + beyond[k]), FIBRAD_E_ARGUMENT);
    assert_no_begin(p);
    trace_all(p);
    for (size_t k = 0; k < 4; k++)
        ck_assert_int_eq(fibrad_heat_trace(p->heat, &p->work, tasks + beyond[k]), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_heat_begin(p->heat, &p->sources), FIBRAD_OK);
    for (int solved = 0; !solved;) {
        ck_assert_int_eq(fibrad_heat_sweep(p->heat, PARTS), FIBRAD_E_ARGUMENT);
        ck_assert_int_eq(fibrad_heat_sweep(p->heat, UINT32_MAX), FIBRAD_E_ARGUMENT);
        sweep_all(p);
        ck_assert_int_eq(fibrad_heat_sweep(p->heat, PARTS), FIBRAD_E_ARGUMENT);
        ck_assert_int_eq(fibrad_heat_sweep(NULL, 0), FIBRAD_E_ARGUMENT);
        ck_assert_int_eq(fibrad_heat_step(NULL, &solved), FIBRAD_E_ARGUMENT);
        ck_assert_int_eq(fibrad_heat_step(p->heat, NULL), FIBRAD_E_ARGUMENT);
        ck_assert_int_eq(fibrad_heat_step(p->heat, &solved), FIBRAD_OK);
    }
    ck_assert_int_eq(fibrad_heat_sweep(p->heat, PARTS), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_heat_read(p->heat, &p->result), FIBRAD_OK);
    assert_same_powers(p, book);
    end_problem(p);
    end_problem(book);
}
END_TEST

START_TEST(tasks_traced_twice) {
    const struct contents c = contents_of(6);
    struct problem *book = by_the_book(&c), *p = begin_problem(&c, 0xff);
    for (uint32_t k = 0; k < tasks_of(p); k++)
        for (int again = 0; again < 3; again++)
            ck_assert_int_eq(fibrad_heat_trace(p->heat, &p->work, k), again ? FIBRAD_E_STATE : FIBRAD_OK);
    ck_assert_int_eq(fibrad_heat_begin(p->heat, &p->sources), FIBRAD_OK);
    sweep_all(p);
    ck_assert_int_eq(fibrad_heat_trace(p->heat, &p->work, 3), FIBRAD_E_STATE);
    solve(p); /* begins anew */
    ck_assert_int_eq(fibrad_heat_trace(p->heat, &p->work, 3), FIBRAD_E_STATE);
    assert_same_powers(p, book);
    end_problem(p);
    end_problem(book);
}
END_TEST

/* ---- heat: sweeps and steps ------------------------------------------------------------------------------------- */

/* One of the parts is left out of every sweep at first, and made up for. */
START_TEST(one_part_not_swept) {
    const struct contents c = contents_of(7);
    struct problem *book = by_the_book(&c), *p = begin_problem(&c, 0);
    trace_all(p);
    ck_assert_int_eq(fibrad_heat_begin(p->heat, &p->sources), FIBRAD_OK);
    uint32_t out = 0;
    for (int solved = 0; !solved; out = (out + 1) % PARTS) {
        solved = 77;
        for (uint32_t k = 0; k < PARTS; k++)
            if (k != out) ck_assert_int_eq(fibrad_heat_sweep(p->heat, k), FIBRAD_OK);
        for (int again = 0; again < 2; again++) ck_assert_int_eq(fibrad_heat_step(p->heat, &solved), FIBRAD_E_STATE);
        ck_assert_int_eq(solved, 77);
        ck_assert_int_eq(fibrad_heat_read(p->heat, &p->result), FIBRAD_E_STATE);
        ck_assert_int_eq(fibrad_heat_sweep(p->heat, out), FIBRAD_OK);
        ck_assert_int_eq(fibrad_heat_step(p->heat, &solved), FIBRAD_OK);
        ck_assert(solved == 0 || solved == 1);
    }
    ck_assert_int_eq(fibrad_heat_read(p->heat, &p->result), FIBRAD_OK);
    assert_same_powers(p, book);
    ck_assert_uint_eq(p->result.sweeps, book->result.sweeps);
    end_problem(p);
    end_problem(book);
}
END_TEST

START_TEST(parts_swept_twice) {
    const struct contents c = contents_of(8);
    struct problem *book = by_the_book(&c), *p = begin_problem(&c, 0);
    trace_all(p);
    ck_assert_int_eq(fibrad_heat_begin(p->heat, &p->sources), FIBRAD_OK);
    for (int solved = 0; !solved;) {
        for (uint32_t k = 0; k < PARTS; k++) {
            ck_assert_int_eq(fibrad_heat_sweep(p->heat, k), FIBRAD_OK);
            for (uint32_t earlier = 0; earlier <= k; earlier++)
                ck_assert_int_eq(fibrad_heat_sweep(p->heat, earlier), FIBRAD_E_STATE);
        }
        ck_assert_int_eq(fibrad_heat_step(p->heat, &solved), FIBRAD_OK);
    }
    ck_assert_int_eq(fibrad_heat_read(p->heat, &p->result), FIBRAD_OK);
    assert_same_powers(p, book);
    end_problem(p);
    end_problem(book);
}
END_TEST

START_TEST(steps_and_reads_too_early) {
    const struct contents c = contents_of(9);
    struct problem *book = by_the_book(&c), *p = begin_problem(&c, 0);
    trace_all(p);
    assert_nothing_to_solve(p);
    ck_assert_int_eq(fibrad_heat_begin(p->heat, &p->sources), FIBRAD_OK);
    for (int solved = 0; !solved;) {
        int other = 77;
        ck_assert_int_eq(fibrad_heat_step(p->heat, &other), FIBRAD_E_STATE);
        ck_assert_int_eq(other, 77);
        ck_assert_int_eq(fibrad_heat_read(p->heat, &p->result), FIBRAD_E_STATE);
        sweep_all(p);
        ck_assert_int_eq(fibrad_heat_read(p->heat, &p->result), FIBRAD_E_STATE);
        ck_assert_int_eq(fibrad_heat_step(p->heat, &solved), FIBRAD_OK);
    }
    int solved = 77; /* the solution is there: no further step, and no sweep */
    ck_assert_int_eq(fibrad_heat_step(p->heat, &solved), FIBRAD_E_STATE);
    ck_assert_int_eq(solved, 77);
    for (uint32_t k = 0; k < PARTS; k++) ck_assert_int_eq(fibrad_heat_sweep(p->heat, k), FIBRAD_E_STATE);
    for (int again = 0; again < 2; again++) {
        memset(p->power, 0, sizeof p->power);
        ck_assert_int_eq(fibrad_heat_read(p->heat, &p->result), FIBRAD_OK);
        assert_same_powers(p, book);
    }
    end_problem(p);
    end_problem(book);
}
END_TEST

/* A solution given up half-way, in any of its sweeps, leaves nothing behind. */
START_TEST(begun_anew_in_between) {
    const struct contents c = contents_of(10);
    struct problem *book = by_the_book(&c);
    for (uint32_t until = 0; until < book->result.sweeps; until++) {
        struct problem *p = begin_problem(&c, 0);
        trace_all(p);
        p->sources.surroundings = 3;
        ck_assert_int_eq(fibrad_heat_begin(p->heat, &p->sources), FIBRAD_OK);
        int solved = 0;
        for (uint32_t k = 0; k < until && !solved; k++) {
            sweep_all(p);
            ck_assert_int_eq(fibrad_heat_step(p->heat, &solved), FIBRAD_OK);
        }
        for (uint32_t k = 0; k < until % PARTS && !solved; k++)
            ck_assert_int_eq(fibrad_heat_sweep(p->heat, k), FIBRAD_OK);
        p->sources.surroundings = .7;
        solve(p);
        assert_like_powers(p, book);
        end_problem(p);
    }
    end_problem(book);
}
END_TEST

/* ---- heat: sources ---------------------------------------------------------------------------------------------- */

START_TEST(sources_missing) {
    const struct contents c = contents_of(11);
    struct problem *book = by_the_book(&c), *p = begin_problem(&c, 0);
    const fibrad_heat_sources zeroed = {0}, good = p->sources;
    trace_all(p);
    ck_assert_int_eq(fibrad_heat_begin(p->heat, &zeroed), FIBRAD_E_ARGUMENT);
    fibrad_heat_sources initial;
    fibrad_heat_sources_init(NULL);
    fibrad_heat_sources_init(&initial);
    ck_assert_int_eq(fibrad_heat_begin(p->heat, &initial), FIBRAD_E_ARGUMENT);
    for (int what = 0; what < 12; what++) {
        fibrad_heat_sources s = good;
        const double **const arrays[] = {&s.temperature, &s.emissivity, &s.body_temperature, &s.body_emissivity};
        double *const values[] = {&s.surroundings, &s.sigma, &s.tolerance};
        if (what < 4) *arrays[what] = NULL;
        if (what >= 4 && what < 7) *values[what - 4] = NAN;
        if (what >= 7 && what < 10) *values[what - 7] = -1;
        if (what == 10) s.sigma = 0;
        if (what == 11) s.surroundings = INFINITY;
        ck_assert_msg(fibrad_heat_begin(p->heat, &s) == FIBRAD_E_ARGUMENT, "sources %d", what);
        assert_nothing_to_solve(p);
    }
    double *const arrays[] = {p->temperature, p->emissivity, p->body_temperature, p->body_emissivity};
    static const double bad[] = {NAN, -1e-300, -1, INFINITY, 1.0000001};
    for (int a = 0; a < 4; a++)
        for (uint32_t i = 0; i < (a < 2 ? N : BODIES); i++)
            for (size_t k = 0; k < (a % 2 == 0 ? 4 : 5); k++) { /* temperatures may be above 1 */
                const double was = arrays[a][i];
                arrays[a][i] = bad[k];
                ck_assert_int_eq(fibrad_heat_begin(p->heat, &p->sources), FIBRAD_E_ARGUMENT);
                arrays[a][i] = was;
            }
    assert_nothing_to_solve(p);
    solve(p);
    assert_same_powers(p, book);
    /* refused when there is a solution: that one stays */
    ck_assert_int_eq(fibrad_heat_begin(p->heat, &zeroed), FIBRAD_E_ARGUMENT);
    memset(p->power, 0, sizeof p->power);
    ck_assert_int_eq(fibrad_heat_read(p->heat, &p->result), FIBRAD_OK);
    assert_same_powers(p, book);
    end_problem(p);
    end_problem(book);
}
END_TEST

/* Zero is a temperature and an emissivity. */
START_TEST(zero_is_a_value) {
    const struct contents c = contents_of(12);
    struct problem *p = begin_problem(&c, 0);
    trace_all(p);
    for (uint32_t i = 0; i < N; i++) p->temperature[i] = 0, p->emissivity[i] = i % 2;
    for (uint32_t b = 0; b < BODIES; b++) p->body_temperature[b] = 0, p->body_emissivity[b] = 0;
    p->sources.surroundings = 0;
    solve(p);
    for (uint32_t i = 0; i < N; i++) ck_assert_double_eq(p->power[i], 0);
    for (uint32_t b = 0; b < BODIES; b++) ck_assert_double_eq(p->body_power[b], 0);
    ck_assert_double_eq(p->result.surroundings_power, 0);
    p->temperature[1] = 10, p->sources.sigma = 1;
    solve(p);
    double largest = 0, sum = p->result.surroundings_power;
    for (uint32_t i = 0; i < N; i++) {
        ck_assert(isfinite(p->power[i]));
        worst_of(&largest, fabs(p->power[i]));
        sum += p->power[i];
        if (i % 2 == 0) ck_assert_double_le(fabs(p->power[i]), 1e-6 * fabs(p->power[1])); /* white */
    }
    for (uint32_t b = 0; b < BODIES; b++) {
        ck_assert_double_le(fabs(p->body_power[b]), 1e-6 * fabs(p->power[1]));
        sum += p->body_power[b];
    }
    ck_assert_double_lt(p->power[1], 0);
    ck_assert_double_le(fabs(sum), 1e-12 * largest);
    end_problem(p);
}
END_TEST

/* ---- heat: scenes rebuilt in place ------------------------------------------------------------------------------ */

enum { CHANGES = 9 };

/* Contents a little other than those. */
static struct contents changed(const struct contents *from, int what) {
    struct contents c = *from;
    double swap;
    switch (what) {
    case 0:
        c.r[5] = nextafter(c.r[5], 0);
        break;
    case 1:
        c.x[0] = nextafter(c.x[0], 1);
        break;
    case 2:
        c.z[N - 1] += 1e-3;
        break;
    case 3: /* two of them change places */
        swap = c.x[2], c.x[2] = c.x[3], c.x[3] = swap;
        swap = c.y[2], c.y[2] = c.y[3], c.y[3] = swap;
        swap = c.z[2], c.z[2] = c.z[3], c.z[3] = swap;
        swap = c.r[2], c.r[2] = c.r[3], c.r[3] = swap;
        break;
    case 4:
        c.body[1].plane.at += 1e-9;
        break;
    case 5: /* walls in another order */
        c.body[0] = from->body[1], c.body[1] = from->body[0];
        break;
    case 6:
        c.period_x = 40;
        break;
    case 7:
        c.n = N - 1;
        break;
    default:
        c.n = 0;
    }
    return c;
}

/* A problem of which so many stages are done: nothing, traced, begun and swept, solved. */
enum { MADE, TRACED, SWEPT, SOLVED, STAGES };

static void advance_to(struct problem *p, int from, int to) {
    for (int stage = from + 1; stage <= to; stage++) {
        if (stage == TRACED) trace_all(p);
        if (stage == SWEPT) {
            ck_assert_int_eq(fibrad_heat_begin(p->heat, &p->sources), FIBRAD_OK);
            for (int k = 0, solved; k < 3; k++) {
                sweep_all(p);
                ck_assert_int_eq(fibrad_heat_step(p->heat, &solved), FIBRAD_OK);
            }
            sweep_all(p);
        }
        for (int solved = 0; stage == SOLVED && !solved;) {
            ck_assert_int_eq(fibrad_heat_step(p->heat, &solved), FIBRAD_OK);
            if (!solved) sweep_all(p);
        }
    }
}

static void assert_other_scene(struct problem *p) {
    int solved = 77;
    for (uint32_t k = 0; k < tasks_of(p); k++)
        ck_assert_int_eq(fibrad_heat_trace(p->heat, &p->work, k), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_heat_begin(p->heat, &p->sources), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_heat_step(p->heat, &solved), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_heat_read(p->heat, &p->result), FIBRAD_E_STATE);
    ck_assert_int_eq(solved, 77);
}

/* The scene is rebuilt with other contents at some stage, and then as it was. */
START_TEST(other_contents_in_place) {
    const struct contents c = contents_of(13);
    struct problem *book = by_the_book(&c);
    const struct contents other = changed(&c, _i);
    for (int stage = MADE; stage < STAGES; stage++) {
        struct problem *p = begin_problem(&c, 0);
        advance_to(p, MADE, stage);
        build(p, &other);
        assert_other_scene(p);
        build(p, &c);
        advance_to(p, stage, SOLVED);
        ck_assert_int_eq(fibrad_heat_read(p->heat, &p->result), FIBRAD_OK);
        assert_same_powers(p, book);
        end_problem(p);
    }
    end_problem(book);
}
END_TEST

/* The same, but the second scene is not even made. */
START_TEST(no_contents_in_place) {
    const struct contents c = contents_of(14);
    struct problem *book = by_the_book(&c);
    struct contents bad = c;
    bad.x[9] = bad.x[8], bad.y[9] = bad.y[8], bad.z[9] = bad.z[8];
    for (int stage = MADE; stage < STAGES; stage++) {
        struct problem *p = begin_problem(&c, 0);
        fibrad_scene *none = NULL;
        advance_to(p, MADE, stage);
        ck_assert_int_eq(build_at(p->scene_block, p->scene_size, &bad, &none), FIBRAD_E_GEOMETRY);
        ck_assert_ptr_null(none);
        assert_other_scene(p);
        build(p, &c);
        advance_to(p, stage, SOLVED);
        ck_assert_int_eq(fibrad_heat_read(p->heat, &p->result), FIBRAD_OK);
        assert_same_powers(p, book);
        end_problem(p);
    }
    end_problem(book);
}
END_TEST

/* Nor is there anything else to be had of what has become of such a scene. */
START_TEST(nothing_of_no_scene) {
    const struct contents c = contents_of(14);
    struct contents bad = c;
    bad.x[9] = bad.x[8], bad.y[9] = bad.y[8], bad.z[9] = bad.z[8];
    struct problem *p = begin_problem(&c, 0);
    fibrad_scene *const scene = p->scene, *none = NULL;
    const fibrad_exchange_rule rule = {.emissivity = p->emissivity, .body_emissivity = p->body_emissivity};
    fibrad_rows rows = {.memory = memory_growing()};
    fibrad_row row = row_of(N), added = {.rows = &rows};
    fibrad_displacement displacement;
    fibrad_heat *heat = NULL;
    double error = 0;
    ck_assert_int_eq(fibrad_beam_row(scene, &p->work, 0, NULL, &row), FIBRAD_OK);
    ck_assert_int_eq(build_at(p->scene_block, p->scene_size, &bad, &none), FIBRAD_E_GEOMETRY);
    ck_assert_int_eq(fibrad_beam_row(scene, &p->work, 0, NULL, &row), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_beam_row(scene, &p->work, 0, NULL, &added), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_cast_row(scene, &p->work, 0, NULL, &row, NULL), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_exchange_row(scene, &p->work, 0, &rule, &row, NULL), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_exchange_displacement(scene, &p->work, 0, &rule, &displacement), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_heat_init(&heat, p->heat_block, p->heat_size, &heat_config, scene), FIBRAD_E_STATE);
    ck_assert_uint_eq(fibrad_heat_size(&heat_config, scene), 0);
    ck_assert_int_eq(fibrad_heat_move(p->heat, scene), FIBRAD_E_STATE);
    ck_assert_int_ne(fibrad_drift_row(scene, scene, 0, row.col, row.length, &error), FIBRAD_OK);
    ck_assert_uint_eq(fibrad_matrix_size(scene, &rows, 1, &(fibrad_matrix_rule){.raw = 1}), 0);
    ck_assert_uint_eq(rows.count, 0);
    row_free(&row);
    rows_free(&rows);
    end_problem(p);
}
END_TEST

/* ---- heat: moved ------------------------------------------------------------------------------------------------ */

START_TEST(moved_before_the_first_solution) {
    const struct contents c = contents_of(15), d = contents_of(16);
    struct problem *book = by_the_book(&d);
    for (int stage = MADE; stage <= SWEPT; stage++) {
        struct problem *p = begin_problem(&c, 0);
        advance_to(p, MADE, stage);
        build(p, &d); /* in place */
        ck_assert_int_eq(fibrad_heat_move(p->heat, p->scene), FIBRAD_OK);
        assert_no_begin(p);
        trace_all(p);
        assert_nothing_to_solve(p);
        solve(p);
        assert_same_powers(p, book);
        end_problem(p);
    }
    end_problem(book);
}
END_TEST

/* A warm start takes fewer sweeps to the same powers; in place and to a scene elsewhere; with spheres in other cells
 * (mirrored), too. */
START_TEST(moved_after_a_solution) {
    const struct contents c = contents_of(17);
    for (int far = 0; far < 2; far++) {
        struct contents d = c;
        for (uint32_t i = 0; i < N; i++) d.x[i] = far ? 6.4 - c.x[i] : c.x[i] + 1e-4 * bed_make_random(3, i);
        struct problem *book = by_the_book(&d);
        for (int elsewhere = 0; elsewhere < 2; elsewhere++) {
            struct problem *p = begin_problem(&c, 0);
            trace_all(p);
            solve(p);
            const uint32_t cold = p->result.sweeps;
            unsigned char *old = p->scene_block;
            if (elsewhere) p->scene_block = block_of(p->scene_size);
            build(p, &d);
            ck_assert_int_eq(fibrad_heat_move(p->heat, p->scene), FIBRAD_OK);
            if (elsewhere) { /* the old one may go */
                memset(old, 0xee, p->scene_size);
                free(old);
            }
            assert_no_begin(p);
            trace_all(p);
            assert_nothing_to_solve(p);
            solve(p);
            assert_like_powers(p, book);
            if (!far) {
                ck_assert_uint_lt(p->result.sweeps, book->result.sweeps);
                ck_assert_uint_lt(p->result.sweeps, cold);
            }
            end_problem(p);
        }
        end_problem(book);
    }
}
END_TEST

/* What was moved there and back again has the bits of a second solution where nothing was moved. */
START_TEST(moved_there_and_back) {
    const struct contents c = contents_of(18), d = changed(&c, 3);
    struct problem *p = begin_problem(&c, 0), *still = begin_problem(&c, 0);
    trace_all(p), trace_all(still);
    solve(p), solve(still);
    build(p, &d);
    ck_assert_int_eq(fibrad_heat_move(p->heat, p->scene), FIBRAD_OK);
    build(p, &c);
    ck_assert_int_eq(fibrad_heat_trace(p->heat, &p->work, 0), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_heat_move(p->heat, p->scene), FIBRAD_OK);
    trace_all(p);
    p->temperature[0] = still->temperature[0] = 3;
    solve(p), solve(still);
    assert_like_powers(p, still);
    end_problem(p);
    end_problem(still);
}
END_TEST

/* Refused, a move leaves everything as it was: the solution can be read, and another one begun. */
START_TEST(moves_refused) {
    const struct contents c = contents_of(19);
    struct problem *book = by_the_book(&c), *p = by_the_book(&c);
    unsigned char *block = block_of(p->scene_size);
    for (int what = 0; what < 8; what++) {
        struct contents d = c;
        fibrad_scene *scene = NULL;
        int expected = FIBRAD_E_ARGUMENT;
        if (what == 1) d.n = N - 1;
        if (what == 2) d.n = 0;
        if (what == 3) d.body[2] = plane_at(1, 1, 5);                        /* the other side */
        if (what == 4) d.body[0] = c.body[1], d.body[1] = c.body[0];         /* another order */
        if (what == 5) d.body[2].plane.at = -2000, expected = FIBRAD_E_SIZE; /* or it fits */
        const fibrad_scene_config fewer = {.body = d.body, .bodies = 2}, open = {0};
        const fibrad_spheres spheres = {.x = d.x, .y = d.y, .z = d.z, .r = d.r, .n = N};
        if (what == 6 || what == 7)
            ck_assert_int_eq(
                fibrad_scene_init(&scene, block, p->scene_size, what == 6 ? &fewer : &open, &spheres, NULL), FIBRAD_OK);
        else if (what > 0)
            ck_assert_int_eq(build_at(block, p->scene_size, &d, &scene), FIBRAD_OK);
        const int status = fibrad_heat_move(p->heat, scene);
        if (what == 5 && status == FIBRAD_OK) { /* its patches found room: back */
            ck_assert_int_eq(fibrad_heat_move(p->heat, p->scene), FIBRAD_OK);
            trace_all(p);
            solve(p);
            assert_like_powers(p, book);
            continue;
        }
        ck_assert_msg(status == expected, "move %d: %d", what, status);
        memset(p->power, 0, sizeof p->power);
        ck_assert_int_eq(fibrad_heat_read(p->heat, &p->result), FIBRAD_OK);
        assert_like_powers(p, book);
        ck_assert_int_eq(fibrad_heat_trace(p->heat, &p->work, 0), FIBRAD_E_STATE); /* all are */
        solve(p);
        assert_like_powers(p, book);
    }
    ck_assert_int_eq(fibrad_heat_move(NULL, p->scene), FIBRAD_E_ARGUMENT);
    free(block);
    end_problem(p);
    end_problem(book);
}
END_TEST

/* ---- work memory ------------------------------------------------------------------------------------------------ */

/* What is kept in work memory between calls: rows in fresh memory and in old, after the scene was rebuilt in place. */
static void assert_row_as_fresh(struct problem *p, fibrad_work *kept, uint32_t i) {
    const fibrad_exchange_rule rule = {
        .emissivity = p->emissivity, .body_emissivity = p->body_emissivity, .paths = 300, .seed = 2};
    fibrad_row a = row_of(N), b = row_of(N);
    fibrad_displacement da = {0}, db = {0};
    fibrad_work fresh = work_growing();
    uint64_t rays_a, rays_b;
    ck_assert_int_eq(fibrad_exchange_row(p->scene, kept, i, &rule, &a, &rays_a), FIBRAD_OK);
    ck_assert_int_eq(fibrad_exchange_row(p->scene, &fresh, i, &rule, &b, &rays_b), FIBRAD_OK);
    ck_assert(same_bits_with(&a, &b, BODIES));
    ck_assert_uint_eq(rays_a, rays_b);
    work_free(&fresh), fresh = work_growing();
    ck_assert_int_eq(fibrad_exchange_displacement(p->scene, kept, i, &rule, &da), FIBRAD_OK);
    ck_assert_int_eq(fibrad_exchange_displacement(p->scene, &fresh, i, &rule, &db), FIBRAD_OK);
    ck_assert_mem_eq(&da, &db, sizeof da);
    work_free(&fresh), fresh = work_growing();
    ck_assert_int_eq(fibrad_cast_row(p->scene, kept, i, NULL, &a, NULL), FIBRAD_OK);
    ck_assert_int_eq(fibrad_cast_row(p->scene, &fresh, i, NULL, &b, NULL), FIBRAD_OK);
    ck_assert(same_bits_with(&a, &b, BODIES));
    work_free(&fresh), fresh = work_growing();
    ck_assert_int_eq(fibrad_beam_row(p->scene, kept, i, NULL, &a), FIBRAD_OK);
    ck_assert_int_eq(fibrad_beam_row(p->scene, &fresh, i, NULL, &b), FIBRAD_OK);
    ck_assert(same_bits_with(&a, &b, BODIES));
    work_free(&fresh);
    row_free(&a);
    row_free(&b);
}

START_TEST(work_kept_while_scenes_change) {
    const struct contents c = contents_of(20);
    struct problem *p = begin_problem(&c, 0);
    fibrad_work fixed = work_fixed(block_of(1 << 18), 1 << 18);
    for (int what = 0; what < 16; what++) {
        const struct contents d = what % 8 == 7 ? contents_of((uint64_t)what) : changed(&c, what % 8);
        build(p, what % 2 ? &c : &d);
        for (uint32_t i = 0; i < N - 1; i += 5) {
            assert_row_as_fresh(p, &p->work, i);
            assert_row_as_fresh(p, &fixed, i);
        }
    }
    free(fixed.memory.block);
    end_problem(p);
}
END_TEST

/* The block of work memory is exchanged for another, moved, overwritten by the caller's realloc, or made smaller. */
START_TEST(work_in_another_block) {
    const struct contents c = contents_of(21);
    struct problem *p = begin_problem(&c, 0);
    size_t size = 1 << 18;
    unsigned char *block = block_of(size);
    fibrad_work work = work_fixed(block, size);
    for (int what = 0; what < 6; what++) {
        assert_row_as_fresh(p, &work, 3);
        unsigned char *other = block_of(size + 64);
        memset(other, what % 2 ? 0xff : 0, size + 64);
        const size_t shift = what % 3 == 2 ? 5 : 0;
        if (what % 3 > 0) memcpy(other + shift, work.memory.block, size);
        memset(block, 0xee, size);
        free(block);
        block = other;
        work.memory.block = other + shift;
    }
    for (; size > 160000; size -= size / 8) { /* the least for reflections is some 150 KB */
        work.memory.size = size;
        assert_row_as_fresh(p, &work, 3);
    }
    free(block);
    end_problem(p);
}
END_TEST

/* ---- rows and matrices ------------------------------------------------------------------------------------------ */

static fibrad_rows rows_from(const fibrad_scene *scene, uint32_t begin, uint32_t end) {
    fibrad_work work = work_growing();
    fibrad_rows rows = {.memory = memory_growing()};
    for (uint32_t i = begin; i < end; i++)
        ck_assert_int_eq(fibrad_beam_row(scene, &work, i, NULL, &(fibrad_row){.rows = &rows}), FIBRAD_OK);
    work_free(&work);
    return rows;
}

START_TEST(matrix_calls_out_of_order) {
    const struct contents c = contents_of(22);
    struct problem *p = begin_problem(&c, 0);
    fibrad_rows rows = rows_from(p->scene, 0, N);
    struct matrix book = matrix_of(p->scene, &rows, 1, NULL);
    const fibrad_matrix_rule rule = {.tasks = 5};
    const size_t size = fibrad_matrix_size(p->scene, &rows, 1, &rule);
    void *block = block_of(size);
    fibrad_matrix *m = NULL;
    fibrad_factors factors = {.n = 77};
    double largest = 77;
    memset(block, 0xff, size);
    ck_assert_int_eq(fibrad_matrix_init(&m, block, size, p->scene, &rows, 1, &rule, NULL), FIBRAD_OK);
    ck_assert_int_eq(fibrad_matrix_read(m, &factors), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_matrix_reciprocity(m, &largest), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_matrix_average(m, 5), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_matrix_average(m, UINT32_MAX), FIBRAD_E_ARGUMENT);
    for (uint32_t task = 4; task > 1; task--) { /* not all of them: closing does the others */
        ck_assert_int_eq(fibrad_matrix_average(m, task), FIBRAD_OK);
        ck_assert_int_eq(fibrad_matrix_average(m, task), FIBRAD_E_STATE);
        ck_assert_int_eq(fibrad_matrix_read(m, &factors), FIBRAD_E_STATE);
    }
    ck_assert_uint_eq(factors.n, 77);
    ck_assert_double_eq(largest, 77);
    ck_assert_int_eq(fibrad_matrix_close(m), FIBRAD_OK);
    ck_assert_int_eq(fibrad_matrix_close(m), FIBRAD_E_STATE);
    for (uint32_t task = 0; task < 5; task++) ck_assert_int_eq(fibrad_matrix_average(m, task), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_matrix_average(m, 5), FIBRAD_E_ARGUMENT);
    ck_assert_int_eq(fibrad_matrix_read(m, &factors), FIBRAD_OK);
    ck_assert(matrix_same_bits(&factors, &book.factors));
    ck_assert_int_eq(fibrad_matrix_reciprocity(m, &largest), FIBRAD_OK);
    free(block);
    matrix_free(&book);
    rows_free(&rows);
    end_problem(p);
}
END_TEST

/* Rows missing, in two collections at once, twice in one, or of something else. */
START_TEST(matrix_of_wrong_rows) {
    const struct contents c = contents_of(23);
    struct problem *p = begin_problem(&c, 0);
    fibrad_rows rows[4] = {rows_from(p->scene, 0, 5), rows_from(p->scene, 5, N), rows_from(p->scene, 4, 6)};
    rows[3] = rows_from(p->scene, 0, N);
    struct matrix book = matrix_of(p->scene, rows, 2, NULL);
    const size_t size = fibrad_matrix_size(p->scene, rows, 4, NULL);
    void *block = block_of(size);
    fibrad_matrix *m = NULL;
    uint32_t sphere = 77;
    ck_assert_int_eq(fibrad_matrix_init(&m, block, size, p->scene, rows, 1, NULL, &sphere), FIBRAD_E_STATE);
    ck_assert_uint_eq(sphere, 5);
    ck_assert_int_eq(fibrad_matrix_init(&m, block, size, p->scene, rows + 1, 1, NULL, &sphere), FIBRAD_E_STATE);
    ck_assert_uint_eq(sphere, 0);
    ck_assert_int_eq(fibrad_matrix_init(&m, block, size, p->scene, NULL, 0, NULL, &sphere), FIBRAD_E_STATE);
    for (int raw = 0; raw < 2; raw++) { /* a raw matrix may lack rows, but not have them twice */
        const fibrad_matrix_rule rule = {.raw = raw};
        ck_assert_int_eq(fibrad_matrix_init(&m, block, size, p->scene, rows, 3, &rule, &sphere), FIBRAD_E_STATE);
        ck_assert(sphere == 4 || sphere == 5);
        ck_assert_int_eq(fibrad_matrix_init(&m, block, size, p->scene, rows, 3, &rule, NULL), FIBRAD_E_STATE);
        ck_assert_int_eq(fibrad_matrix_init(&m, block, size, p->scene, rows + 1, 3, &rule, &sphere), FIBRAD_E_STATE);
    }
    fibrad_row again = matrix_row(&book.factors, 2);
    ck_assert_int_eq(fibrad_rows_add(&rows[0], &again, BODIES), FIBRAD_OK);
    ck_assert_int_eq(fibrad_matrix_init(&m, block, size, p->scene, rows, 2, NULL, &sphere), FIBRAD_E_STATE);
    ck_assert_uint_eq(sphere, 2);

    /* of other bodies, of more spheres, of spheres that are not there */
    for (int what = 0; what < 3; what++) {
        fibrad_rows wrong = {.memory = memory_growing()};
        fibrad_row row = matrix_row(&book.factors, 0);
        if (what == 1) row.sphere = N;
        uint32_t col[] = {1, N};
        double f[] = {.1, .1};
        if (what == 2) row.col = col, row.f = f, row.length = 2;
        ck_assert_int_eq(fibrad_rows_add(&wrong, &row, what == 0 ? 2 : BODIES), FIBRAD_OK);
        ck_assert_uint_eq(fibrad_matrix_size(p->scene, &wrong, 1, &(fibrad_matrix_rule){.raw = 1}), 0);
        ck_assert_int_eq(
            fibrad_matrix_init(&m, block, size, p->scene, &wrong, 1, &(fibrad_matrix_rule){.raw = 1}, NULL),
            FIBRAD_E_ARGUMENT);
        rows_free(&wrong);
    }
    ck_assert_ptr_null(m);

    /* emptied and filled again, all is well */
    fibrad_rows_clear(&rows[0]);
    ck_assert_uint_eq(rows[0].count, 0);
    fibrad_work work = work_growing();
    for (uint32_t i = 5; i-- > 0;)
        ck_assert_int_eq(fibrad_beam_row(p->scene, &work, i, NULL, &(fibrad_row){.rows = rows}), FIBRAD_OK);
    work_free(&work);
    struct matrix right = matrix_of(p->scene, rows, 2, NULL);
    ck_assert(matrix_same_bits(&right.factors, &book.factors));
    matrix_free(&right);
    matrix_free(&book);
    for (int k = 0; k < 4; k++) rows_free(&rows[k]);
    free(block);
    end_problem(p);
}
END_TEST

/* A row that is refused leaves a collection as it was. */
START_TEST(refused_rows_are_not_appended) {
    const struct contents c = contents_of(24);
    struct problem *p = begin_problem(&c, 0);
    static unsigned char memory[1 << 12];
    fibrad_rows rows = {.memory = {.block = memory, .size = sizeof memory}};
    fibrad_work work = work_growing(), none = {0};
    uint32_t before = 0;
    for (uint32_t i = 0; i < N; i++) {
        fibrad_row row = {.rows = &rows};
        ck_assert_int_eq(fibrad_beam_row(p->scene, &none, i, NULL, &row), FIBRAD_E_WORK);
        ck_assert_int_eq(fibrad_beam_row(p->scene, &work, N, NULL, &row), FIBRAD_E_ARGUMENT);
        ck_assert_uint_eq(rows.count, before);
        const int status = fibrad_beam_row(p->scene, &work, i, NULL, &row);
        if (status != FIBRAD_OK) {
            ck_assert_int_eq(status, FIBRAD_E_CAPACITY);
            ck_assert_uint_gt(rows.memory.needed, sizeof memory);
        } else {
            before++;
        }
        ck_assert_uint_eq(rows.count, before);
    }
    ck_assert_uint_gt(before, 1);
    struct matrix m = matrix_of(p->scene, &rows, 1, &(fibrad_matrix_rule){.raw = 1});
    for (uint32_t i = 0; i < before; i++) ck_assert_double_eq_tol(matrix_total(&m.factors, i), 1, 1e-12);
    matrix_free(&m);
    work_free(&work);
    end_problem(p);
}
END_TEST

/* A row that was appended to a collection and is then given its own arrays no more: its capacity says so. */
START_TEST(row_reused_after_appending) {
    struct bed bed = packing(60, .8, 1.2, .5, 3, false);
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    fibrad_work work = work_growing();
    fibrad_rows rows = {.memory = work_growing().memory};
    uint32_t col[60];
    double f[60];
    fibrad_row row = {.col = col, .f = f, .capacity = 60, .rows = &rows};
    ck_assert_int_eq(fibrad_beam_row(scene, &work, 0, NULL, &row), FIBRAD_OK);
    const double first = row.f[0];
    row.rows = NULL;
    ck_assert_int_eq(fibrad_beam_row(scene, &work, 1, NULL, &row), FIBRAD_E_CAPACITY);
    ck_assert_double_eq(row.f[0], first);
    work_free(&work);
    free(rows.memory.block);
    free(scene);
    bed_free(&bed);
}
END_TEST

/* Rows of another scene, rows that change while their matrix is made, and a matrix that failed in place. */
START_TEST(matrix_of_changing_rows) {
    struct bed bed = packing(60, .8, 1.2, .5, 3, false), other = packing(60, .8, 1.2, .5, 4, false);
    fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST), *another = scene_of(&other, FIBRAD_ISA_BEST);
    fibrad_rows rows = rows_from(scene, 0, 60), more = rows_from(scene, 0, 1), fewer = rows_from(scene, 1, 60);
    fibrad_matrix *matrix;
    uint32_t sphere = 99;
    const size_t size = fibrad_matrix_size(scene, &rows, 1, NULL);
    void *block = malloc(size);
    ck_assert_int_eq(fibrad_matrix_init(&matrix, block, size, another, &rows, 1, NULL, &sphere), FIBRAD_E_STATE);
    ck_assert_uint_eq(sphere, 0);
    ck_assert_int_eq(fibrad_matrix_init(&matrix, block, size, scene, &rows, 1, NULL, NULL), FIBRAD_OK);
    fibrad_rows_clear(&rows);
    ck_assert_int_eq(fibrad_matrix_average(matrix, 0), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_matrix_close(matrix), FIBRAD_E_STATE);
    fibrad_matrix *again = NULL;
    ck_assert_int_eq(fibrad_matrix_init(&again, block, size, scene, &fewer, 1, NULL, &sphere), FIBRAD_E_STATE);
    ck_assert(again == NULL && sphere == 0);
    ck_assert_int_eq(fibrad_matrix_close(matrix), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_matrix_average(matrix, 0), FIBRAD_E_STATE);
    const fibrad_rows both[] = {more, fewer};
    ck_assert_int_eq(fibrad_matrix_init(&matrix, block, size, scene, both, 2, NULL, NULL), FIBRAD_OK);
    ck_assert_int_eq(fibrad_matrix_close(matrix), FIBRAD_OK);
    free(block);
    free(rows.memory.block), free(more.memory.block), free(fewer.memory.block);
    free(scene), free(another);
    bed_free(&bed), bed_free(&other);
}
END_TEST

int main(void) {
    Suite *suite = suite_create("protocol");
    TCase *tasks = suite_case(suite, "tasks"), *sweeps = suite_case(suite, "sweeps");
    tcase_add_test(tasks, traces_that_failed);
    tcase_add_test(tasks, traces_without_memory);
    tcase_add_test(tasks, nothing_traced);
    tcase_add_test(tasks, one_task_not_traced);
    tcase_add_test(tasks, tasks_and_parts_out_of_range);
    tcase_add_test(tasks, tasks_traced_twice);
    tcase_add_test(sweeps, one_part_not_swept);
    tcase_add_test(sweeps, parts_swept_twice);
    tcase_add_test(sweeps, steps_and_reads_too_early);
    tcase_add_test(sweeps, begun_anew_in_between);
    TCase *sources = suite_case(suite, "sources"), *scenes = suite_case(suite, "scenes");
    tcase_add_test(sources, sources_missing);
    tcase_add_test(sources, zero_is_a_value);
    tcase_add_loop_test(scenes, other_contents_in_place, 0, CHANGES);
    tcase_add_test(scenes, no_contents_in_place);
    tcase_add_test(scenes, nothing_of_no_scene);
    TCase *moves = suite_case(suite, "moves"), *work = suite_case(suite, "work");
    tcase_add_test(moves, moved_before_the_first_solution);
    tcase_add_test(moves, moved_after_a_solution);
    tcase_add_test(moves, moved_there_and_back);
    tcase_add_test(moves, moves_refused);
    tcase_add_test(work, work_kept_while_scenes_change);
    tcase_add_test(work, work_in_another_block);
    TCase *matrices = suite_case(suite, "matrices");
    tcase_add_test(matrices, matrix_calls_out_of_order);
    tcase_add_test(matrices, matrix_of_wrong_rows);
    tcase_add_test(matrices, refused_rows_are_not_appended);
    tcase_add_test(matrices, row_reused_after_appending);
    tcase_add_test(matrices, matrix_of_changing_rows);
    return suite_run(suite);
}
