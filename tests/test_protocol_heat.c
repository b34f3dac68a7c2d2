/* test_protocol_heat.c - calls of a heat problem at the wrong time, in the wrong order, or twice.
 * SPDX-License-Identifier: MIT */
#include "heat_calls.h"

/* Checks that powers agree within the tolerance of the sources, if one of the two solutions began with an earlier
 * one. */
static void assert_like_powers(const struct problem *p, const struct problem *book) {
    double largest = 0, difference = 0;
    for (uint32_t i = 0; i < N; i++) {
        worst_of(&largest, fabs(book->power[i]));
        worst_of(&difference, fabs(p->power[i] - book->power[i]));
    }
    for (uint32_t b = 0; b < WALLS; b++) worst_of(&difference, fabs(p->wall_power[b] - book->wall_power[b]));
    worst_of(&difference, fabs(p->result.surroundings_power - book->result.surroundings_power));
    ck_assert_double_gt(largest, 0);
    ck_assert_double_lt(difference, 1e-6 * largest);
}

static void assert_no_begin(struct problem *p) {
    ck_assert_int_eq(fibrad_heat_begin(p->heat, &p->sources), FIBRAD_E_STATE);
    assert_nothing_to_solve(p);
}

static void *no_more(void *context, void *block, size_t size) {
    (void)context, (void)block, (void)size;
    return NULL;
}

/* Each call that comes too early, twice or for what is not there is refused, whatever the block held before, and what
 * follows has the bits of calls in their order. */
LOOP_TEST(calls_out_of_order_change_nothing, 3) {
    const struct contents c = contents_of(1);
    ENDED struct problem *book = by_the_book(&c), *p = begin_problem(&c, _i == 0 ? 0 : _i == 1 ? 0x5a : 0xff);
    unsigned char small[64];
    fibrad_work none = {0}, tiny = work_fixed(small, sizeof small), refused = {.memory = {.resize = no_more}};
    const uint32_t tasks = tasks_of(p), left_out = _i == 0 ? 0 : _i == 1 ? N : tasks - 1;
    assert_nothing_to_solve(p);
    assert_no_begin(p);
    for (uint32_t k = 0; k < tasks; k++) {
        ck_assert_int_eq(fibrad_heat_trace(p->heat, &none, k), FIBRAD_E_WORK);
        ck_assert_int_eq(fibrad_heat_trace(p->heat, &tiny, k), FIBRAD_E_WORK);
        ck_assert_uint_gt(tiny.memory.needed, sizeof small);
        ck_assert_int_eq(fibrad_heat_trace(p->heat, &refused, k), FIBRAD_E_MEMORY);
        assert_invalid(fibrad_heat_trace(p->heat, NULL, k));
    }
    for (uint32_t k = 0; k < tasks; k++)
        for (int again = 0; k != left_out && again < 2; again++)
            ck_assert_int_eq(fibrad_heat_trace(p->heat, &p->work, k), again ? FIBRAD_E_STATE : FIBRAD_OK);
    assert_invalid(fibrad_heat_trace(p->heat, &p->work, tasks));
    assert_invalid(fibrad_heat_trace(p->heat, &p->work, UINT32_MAX));
    assert_no_begin(p);
    assert_ok(fibrad_heat_trace(p->heat, &p->work, left_out));
    assert_nothing_to_solve(p);
    assert_ok(fibrad_heat_begin(p->heat, &p->sources));
    uint32_t out = 0;
    for (int solved = 0; !solved; out = (out + 1) % PARTS) {
        solved = 77;
        for (uint32_t k = 0; k < PARTS; k++)
            for (int again = 0; k != out && again < 2; again++)
                ck_assert_int_eq(fibrad_heat_sweep(p->heat, k), again ? FIBRAD_E_STATE : FIBRAD_OK);
        assert_invalid(fibrad_heat_sweep(p->heat, PARTS));
        assert_invalid(fibrad_heat_sweep(NULL, 0));
        assert_invalid(fibrad_heat_step(NULL, &solved));
        assert_invalid(fibrad_heat_step(p->heat, NULL));
        ck_assert_int_eq(fibrad_heat_step(p->heat, &solved), FIBRAD_E_STATE);
        ck_assert_int_eq(fibrad_heat_read(p->heat, &p->result), FIBRAD_E_STATE);
        ck_assert_int_eq(fibrad_heat_trace(p->heat, &p->work, 3), FIBRAD_E_STATE);
        ck_assert_int_eq(solved, 77);
        assert_ok(fibrad_heat_sweep(p->heat, out));
        assert_ok(fibrad_heat_step(p->heat, &solved));
    }
    int solved = 77; /* there is a solution: no further step and no sweep are allowed */
    ck_assert_int_eq(fibrad_heat_step(p->heat, &solved), FIBRAD_E_STATE);
    for (uint32_t k = 0; k < PARTS; k++) ck_assert_int_eq(fibrad_heat_sweep(p->heat, k), FIBRAD_E_STATE);
    for (int again = 0; again < 2; again++) {
        memset(p->power, 0, sizeof p->power);
        assert_ok(fibrad_heat_read(p->heat, &p->result));
        assert_same_powers(p, book);
        ck_assert_uint_eq(p->result.sweeps, book->result.sweeps);
    }
}

/* A solution that is given up half-way, in every fifth of its sweeps, leaves nothing behind. */
TEST(begun_anew_in_between) {
    const struct contents c = contents_of(10);
    ENDED struct problem *book = by_the_book(&c);
    for (uint32_t until = 0; until < book->result.sweeps; until += 9) {
        ENDED struct problem *p = begin_problem(&c, 0);
        trace_all(p);
        p->sources.surroundings = 3;
        assert_ok(fibrad_heat_begin(p->heat, &p->sources));
        int solved = 0;
        for (uint32_t k = 0; k < until && !solved; k++) {
            heat_sweep(p->heat, false);
            assert_ok(fibrad_heat_step(p->heat, &solved));
        }
        for (uint32_t k = 0; k < until % PARTS && !solved; k++) assert_ok(fibrad_heat_sweep(p->heat, k));
        p->sources.surroundings = .7;
        solve(p);
        assert_like_powers(p, book);
    }
}

TEST(moved_before_the_first_solution) {
    const struct contents c = contents_of(15), d = contents_of(16);
    ENDED struct problem *book = by_the_book(&d);
    for (int stage = MADE; stage <= SWEPT; stage++) {
        ENDED struct problem *p = begin_problem(&c, 0);
        advance_to(p, MADE, stage);
        build(p, &d); /* in place */
        assert_ok(fibrad_heat_move(p->heat, p->scene));
        assert_no_begin(p);
        trace_all(p);
        assert_nothing_to_solve(p);
        solve(p);
        assert_same_powers(p, book);
    }
}

/* A warm start needs fewer sweeps for the same powers. It works in place and with a scene elsewhere, also if spheres
 * are in other cells (mirrored). */
TEST(moved_after_a_solution) {
    const struct contents c = contents_of(17);
    for (int far = 0; far < 2; far++) {
        struct contents d = c;
        for (uint32_t i = 0; i < N; i++) d.x[i] = far ? 6.4 - c.x[i] : c.x[i] + 1e-4 * bed_make_random(3, i);
        ENDED struct problem *book = by_the_book(&d);
        for (int elsewhere = 0; elsewhere < 2; elsewhere++) {
            ENDED struct problem *p = begin_problem(&c, 0);
            trace_all(p);
            solve(p);
            const uint32_t cold = p->result.sweeps;
            unsigned char *old = p->scene_block;
            if (elsewhere) p->scene_block = block_of(p->scene_size);
            build(p, &d);
            assert_ok(fibrad_heat_move(p->heat, p->scene));
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
        }
    }
}

/* If a move is refused, everything stays as it was: the solution can be read, and another one begun. */
TEST(moves_refused) {
    const struct contents c = contents_of(19);
    ENDED struct problem *book = by_the_book(&c), *p = by_the_book(&c);
    OWNED unsigned char *block = block_of(p->scene_size);
    for (int what = 0; what < 8; what++) {
        struct contents d = c;
        fibrad_scene *scene = NULL;
        int expected = FIBRAD_E_ARGUMENT;
        if (what == 1) d.n = N - 1;
        if (what == 2) d.n = 0;
        if (what == 3) d.wall[2] = plane_at(1, 1, 5);                        /* the other side */
        if (what == 4) d.wall[0] = c.wall[1], d.wall[1] = c.wall[0];         /* another order */
        if (what == 5) d.wall[2].plane.at = -2000, expected = FIBRAD_E_SIZE; /* or it fits */
        const fibrad_scene_config fewer = {.wall = d.wall, .walls = 2}, open = {0};
        const fibrad_spheres spheres = {.x = d.x, .y = d.y, .z = d.z, .r = d.r, .n = N};
        if (what == 6 || what == 7)
            assert_ok(fibrad_scene_init(&scene, block, p->scene_size, what == 6 ? &fewer : &open, &spheres, NULL));
        else if (what > 0)
            assert_ok(build_at(block, p->scene_size, &d, &scene));
        const int status = fibrad_heat_move(p->heat, scene);
        if (what == 5 && status == FIBRAD_OK) { /* its patches found room: move back */
            assert_ok(fibrad_heat_move(p->heat, p->scene));
            trace_all(p);
            solve(p);
            assert_like_powers(p, book);
            continue;
        }
        ck_assert_msg(status == expected, "move %d: %d", what, status);
        memset(p->power, 0, sizeof p->power);
        assert_ok(fibrad_heat_read(p->heat, &p->result));
        assert_like_powers(p, book);
        ck_assert_int_eq(fibrad_heat_trace(p->heat, &p->work, 0), FIBRAD_E_STATE); /* all are */
        solve(p);
        assert_like_powers(p, book);
    }
    assert_invalid(fibrad_heat_move(NULL, p->scene));
}
