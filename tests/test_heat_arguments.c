/* test_heat_arguments.c - arguments, and memory that is too small. SPDX-License-Identifier: MIT */
#include "heat_problem.h"

TEST(arguments_are_checked) {
    OWNED_PROBLEM p = problem_of(BED({0, 0, 0, 1}, {3, 0, 0, 1}), 1, .5);
    p.config = (fibrad_heat_config){.directions = 8};
    trace(&p);
    static const fibrad_heat_config bad[] = {{.directions = 7}, {.directions = 65537},
                                             {.points = 65},    {.patches = 25},
                                             {.parts = 1025},   {.wall_rays = FIBRAD_WALL_RAYS_MAX + 1}};
    const size_t size = fibrad_heat_size(&p.config, p.scene);
    OWNED unsigned char *block = block_of(size + 128);
    fibrad_heat *heat = NULL;
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        ck_assert_uint_eq(fibrad_heat_size(&bad[k], p.scene), 0);
        assert_invalid(fibrad_heat_init(&heat, block, size, &bad[k], p.scene));
    }
    ck_assert_uint_eq(fibrad_heat_size(&p.config, NULL), 0);
    ck_assert_uint_gt(fibrad_heat_size(NULL, p.scene), size);
    ck_assert_uint_eq(fibrad_heat_tasks(NULL), 0);
    ck_assert_uint_eq(fibrad_heat_parts(NULL), 0);

    memset(block, 0x5a, size + 128);
    ck_assert_int_eq(fibrad_heat_init(&heat, block, size - 1, &p.config, p.scene), FIBRAD_E_SIZE);
    assert_invalid(fibrad_heat_init(&heat, NULL, size, &p.config, p.scene));
    assert_invalid(fibrad_heat_init(NULL, block, size, &p.config, p.scene));
    assert_invalid(fibrad_heat_init(&heat, block, size, &p.config, NULL));
    for (size_t k = 0; k < size + 128; k++) ck_assert_int_eq(block[k], 0x5a);
    OWNED_WORK work = work_growing();
    solve(&p);
    double power[2];
    memcpy(power, p.result.power, sizeof power);
    fibrad_heat *const first = p.heat;
    for (size_t shift = 0; shift < 64; shift += 9) { /* any alignment gives the same bits */
        memset(block, 0x5a, size + 128);
        assert_ok(fibrad_heat_init(&heat, block + shift, size, &p.config, p.scene));
        assert_invalid(fibrad_heat_trace(NULL, &work, 0));
        assert_invalid(fibrad_heat_trace(heat, &work, 2));
        assert_invalid(fibrad_heat_trace(heat, NULL, 0));
        for (uint32_t i = 0; i < 2; i++) assert_ok(fibrad_heat_trace(heat, &work, i));
        ck_assert_int_eq(fibrad_heat_read(heat, &p.result), FIBRAD_E_STATE); /* unsolved */
        p.heat = heat;
        solve(&p);
        ck_assert_mem_eq(power, p.result.power, sizeof power);
        assert_invalid(fibrad_heat_read(heat, NULL));
        assert_invalid(fibrad_heat_read(heat, &(fibrad_heat_result){0}));
        assert_invalid(fibrad_heat_read(NULL, &p.result));
        for (size_t k = 0; k < shift; k++) ck_assert_int_eq(block[k], 0x5a);
        for (size_t k = shift + size; k < size + 128; k++) ck_assert_int_eq(block[k], 0x5a);
    }

    const struct problem fine = p;
    p.temperature[1] = -1;
    assert_invalid(fibrad_heat_begin(heat, &p.sources));
    p.temperature[1] = NAN;
    assert_invalid(fibrad_heat_begin(heat, &p.sources));
    p.temperature[1] = 1, p.emissivity[0] = 1.5;
    assert_invalid(fibrad_heat_begin(heat, &p.sources));
    p.emissivity[0] = .5, p.sources.sigma = 0;
    assert_invalid(fibrad_heat_begin(heat, &p.sources));
    p.sources = fine.sources, p.sources.tolerance = 1;
    assert_invalid(fibrad_heat_begin(heat, &p.sources));
    assert_invalid(fibrad_heat_begin(heat, NULL));
    assert_invalid(fibrad_heat_begin(NULL, &fine.sources));
    p.sources = fine.sources;
    solve(&p);
    ck_assert_double_eq_tol(p.result.power[0], power[0], 1e-3 * fabs(power[0])); /* warm */
    p.heat = first;
}

/* There is hardly any room to work in. The call says so, and the size that it asks for is enough. */
TEST(work_memory_may_be_too_small) {
    OWNED_PROBLEM p = problem_of(packing(100, 1, 1, .55, 5, true), 1, 1);
    p.config.directions = 8;
    trace(&p);
    assert_ok(fibrad_heat_move(p.heat, p.scene));
    size_t size = 64;
    OWNED void *block = block_of(size);
    fibrad_work work = work_fixed(block, size);
    int status = fibrad_heat_trace(p.heat, &work, 0);
    ck_assert_int_eq(status, FIBRAD_E_WORK);
    for (int tries = 0; tries < 20 && status == FIBRAD_E_WORK; tries++) {
        ck_assert_uint_gt(work.memory.needed, size);
        size = work.memory.needed;
        free(block);
        block = block_of(size);
        work = work_fixed(block, size);
        status = fibrad_heat_trace(p.heat, &work, 0);
    }
    assert_ok(status);
}

/* Bytes of the pool up to the end of the last link. */
static size_t pool_end(const fibrad_heat *heat) {
    return (size_t)((const unsigned char *)(heat->pencils.link + heat->pencils.links) - heat->pencils.pool);
}

/* Traces all spheres again, until there is no room. */
static int trace_again(struct problem *p) {
    OWNED_WORK work = work_growing();
    int status = fibrad_heat_move(p->heat, p->scene);
    for (uint32_t task = 0; task < p->bed.n && status == FIBRAD_OK; task++)
        status = fibrad_heat_trace(p->heat, &work, task);
    return status;
}

/* Links begin on a boundary after the pencils. If there is room for both but not for the gap between them, it is too
 * small, and nothing is written after it. Room up to the last link, in whole alignments, suffices. */
TEST(nothing_is_written_behind_the_room_for_beams) {
    for (uint32_t directions = 8; directions < 12; directions++) {
        OWNED_PROBLEM p = problem_of(packing(30, 1, 1, .55, 5, true), 1, .5);
        p.config.directions = directions;
        trace_and_solve(&p);
        const size_t all = p.heat->pencils.room, end = pool_end(p.heat);
        const size_t sum = p.heat->pencils.used + p.heat->pencils.links * sizeof(fibrad_heat_link);
        ck_assert_uint_lt(sum, end);
        for (int last = 0; last <= 2; last++) {
            p.heat->pencils.room = last == 0 ? sum : last == 1 ? end - 1 : (end + 63) / 64 * 64;
            memset(p.heat->pencils.pool + p.heat->pencils.room, 0x5a, all - p.heat->pencils.room);
            ck_assert_int_eq(trace_again(&p), last < 2 ? FIBRAD_E_SIZE : FIBRAD_OK);
            if (last == 2) solve(&p);
            for (size_t k = p.heat->pencils.room; k < all; k++) ck_assert_uint_eq(p.heat->pencils.pool[k], 0x5a);
        }
    }
}

/* The block gives the room for beams. If it is too small, the tasks that find no room say so. If it is larger than
 * needed, no bit changes. */
TEST(the_room_for_beams_may_be_too_small) {
    OWNED_PROBLEM p = problem_of(packing(100, 1, 1, .55, 5, true), 1, .5);
    double power[2][100];
    p.temperature[0] = 2, p.config.directions = 24;
    build_scene(&p);
    const size_t size = fibrad_heat_size(&p.config, p.scene);
    for (size_t times = 1; times <= 2; times++) {
        assert_ok(fibrad_heat_init(&p.heat, block_of(times * size), times * size, &p.config, p.scene));
        trace_beams(&p);
        solve(&p);
        memcpy(power[times - 1], p.result.power, sizeof power[0]);
        ck_assert_uint_le(pool_end(p.heat), p.heat->pencils.room);
        if (times == 1) free(p.heat);
    }
    ck_assert_mem_eq(power[0], power[1], sizeof power[0]);

    p.heat->pencils.room = pool_end(p.heat) - 1000;
    ck_assert_int_eq(trace_again(&p), FIBRAD_E_SIZE);
    ck_assert_int_eq(fibrad_heat_begin(p.heat, &p.sources), FIBRAD_E_STATE);
}
