/* test_work.c - work memory: fixed and growing, of any alignment, for any scenes and functions in turn, without a trace
 * in the results. Also the blocks of heat problems. SPDX-License-Identifier: MIT */
#include "grey_rules.h"
#include "fibrad_surface.h"
#include "heat_runs.h"
#include "suite.h"

/* The functions that need work memory. */
enum { BEAM, POINTS, CAST, MC, EXCHANGE, SURFACE, DISPLACEMENT, FUNCTIONS };

static const char *const names[] = {"beam", "points", "cast", "mc", "exchange", "surface", "displacement"};

/* What a function has written. */
struct output {
    fibrad_row row;
    fibrad_displacement displacement;
    uint64_t rays;
};

#define MOST  2048
#define WALLS 2

static struct output output_of(void) { return (struct output){.row = row_of(MOST)}; }

static void output_free(struct output *out) { row_free(&out->row); }

static int call(int function, const fibrad_scene *scene, fibrad_work *work, uint32_t i, struct output *out) {
    static double grey[MOST];
    for (uint32_t k = 0; k < MOST; k++) grey[k] = .6 + .001 * (k % 100);
    const fibrad_exchange_rule exchange = {.emissivity = grey, .wall_emissivity = grey, .directions = 34, .paths = 100};
    fibrad_row *row = &out->row;
    fibrad_scene_facts facts;
    fibrad_scene_describe(scene, &facts);
    if (function == SURFACE && facts.walls > 0) function = BEAM; /* the surface method has no walls */
    memset(row->wall, 0, WALLS * sizeof *row->wall);
    switch (function) {
    case BEAM:
        return fibrad_beam_row(scene, work, i, &(fibrad_beam_rule){.directions = 55}, row);
    case POINTS:
        return fibrad_beam_row(scene, work, i, &(fibrad_beam_rule){.directions = 55, .points = 64}, row);
    case CAST:
        return fibrad_cast_row(scene, work, i, &(fibrad_cast_rule){.rays = 2000, .seed = 3}, row, NULL);
    case MC:
        return fibrad_cast_row(scene, work, i, &(fibrad_cast_rule){.rays = 2000, .random = 1}, row, NULL);
    case EXCHANGE:
        return fibrad_exchange_row(scene, work, i, &exchange, row, &out->rays);
    case SURFACE:
        return fibrad_surface_row(scene, work, i, &(fibrad_surface_rule){.nodes = 13, .cutoff = 5}, row);
    default:
        return displacement_of(scene, work, i, &exchange, &out->displacement);
    }
}

static bool same_output(int function, const struct output *a, const struct output *b) {
    if (function == DISPLACEMENT) return memcmp(&a->displacement, &b->displacement, sizeof a->displacement) == 0;
    return same_bits_with(&a->row, &b->row, WALLS) && (function != EXCHANGE || a->rays == b->rays) &&
           a->row.sphere == b->row.sphere && a->row.directions == b->row.directions &&
           a->row.fallbacks == b->row.fallbacks && a->row.symmetric == b->row.symmetric;
}

/* Beds: packed, periodic, of mixed sizes, nearly empty, and between two walls. */
enum { SCENES = 5 };

static struct bed between_walls(void) { return BED({1, 1, 0, 1}, {2, 3, 2, 1}, {3, 1, 3, 1}); }

static struct bed bed_number(int k) {
    return k == 0   ? packing(150, .8, 1.2, .55, 7, false)
           : k == 1 ? packing(100, .5, 1.5, .5, 8, true)
           : k == 2 ? strewn(200, 42)
           : k == 3 ? BED({0, 0, 0, 1}, {1, 2, 3, 1})
                    : between_walls();
}

static fibrad_scene *scene_number(int k, const struct bed *bed) {
    const fibrad_wall walls[WALLS] = {plane_at(2, 0, -1), plane_at(2, 1, 5)};
    return scene_with(bed, &(fibrad_scene_config){.wall = walls, .walls = k == SCENES - 1 ? WALLS : 0});
}

/* The output of a function with new and plentiful memory. */
static struct output expected(int function, const fibrad_scene *scene, uint32_t i) {
    struct output out = output_of();
    const size_t size = 8u << 20;
    OWNED void *block = malloc(size);
    ck_assert_ptr_nonnull(block);
    fibrad_work work = work_fixed(block, size);
    assert_ok(call(function, scene, &work, i, &out));
    return out;
}

/* Memory begins at nothing and grows as the kernel asks for it. The kernel asks for more each time, but not often. With
 * as much memory as it asked for last, the same call succeeds at once in another block. */
LOOP_TEST(fixed_memory_grows_in_few_steps, SCENES *FUNCTIONS) {
    OWNED_BED bed = bed_number(_i / FUNCTIONS);
    const int function = _i % FUNCTIONS;
    OWNED fibrad_scene *scene = scene_number(_i / FUNCTIONS, &bed);
    for (uint32_t i = 0; i < bed.n; i += 49) {
        OWNED_BY(output_free) struct output truth = expected(function, scene, i), out = output_of();
        out.row.length = 77;
        out.row.error = -5;
        fibrad_work work = work_fixed(NULL, 0);
        int tries = 0;
        while (work_again(&work, call(function, scene, &work, i, &out))) {
            ck_assert_msg(out.row.length == 77 && out.row.error == -5, "%s has written", names[function]);
            ck_assert_msg(++tries < 12, "%s asks for ever more memory", names[function]);
        }
        ck_assert_int_ge(tries, 1);
        assert_ok(call(function, scene, &work, i, &out));
        ck_assert_msg(same_output(function, &out, &truth), "%s", names[function]);
        const size_t size = work.memory.size;
        work_free_fixed(&work);
        OWNED void *block = malloc(size);
        memset(block, 0xff, size);
        work = work_fixed(block, size);
        const int status = call(function, scene, &work, i, &out);
        ck_assert_msg(status == FIBRAD_OK, "%s, %zu bytes: %s, %zu", names[function], size, fibrad_status_text(status),
                      work.memory.needed);
        ck_assert(same_output(function, &out, &truth));
    }
}

/* One growing work memory and one of each other kind serve all scenes and functions in turn. */
TEST(one_work_serves_all_scenes_and_functions) {
    struct bed bed[SCENES];
    fibrad_scene *scene[SCENES];
    for (int k = 0; k < SCENES; k++) bed[k] = bed_number(k), scene[k] = scene_number(k, &bed[k]);
    const size_t size = 8u << 20;
    void *block = malloc(size);
    memset(block, 0xff, size);
    fibrad_work growing = work_growing(), fixed = work_fixed(block, size), little = work_fixed(NULL, 0);
    OWNED_BY(output_free) struct output out = output_of();
    uint32_t at = 0;
    for (int round = 0; round < 100; round++) {
        at = at * 1664525u + 1013904223u;
        const int k = (int)((at >> 29) % SCENES), function = (int)((at >> 20) % FUNCTIONS);
        const uint32_t i = (at >> 8) % bed[k].n;
        OWNED_BY(output_free) struct output truth = expected(function, scene[k], i);
        assert_ok(call(function, scene[k], &growing, i, &out));
        ck_assert_msg(same_output(function, &out, &truth), "growing, round %d: %s", round, names[function]);
        assert_ok(call(function, scene[k], &fixed, i, &out));
        ck_assert_msg(same_output(function, &out, &truth), "fixed, round %d: %s", round, names[function]);
        int tries = 0, status;
        do {
            status = call(function, scene[k], &little, i, &out);
            ck_assert_int_lt(tries++, 12);
        } while (work_again(&little, status));
        assert_ok(status);
        ck_assert_msg(same_output(function, &out, &truth), "little, round %d: %s", round, names[function]);
    }
    work_free(&growing);
    work_free_fixed(&little);
    free(block);
    for (int k = 0; k < SCENES; k++) free(scene[k]), bed_free(&bed[k]);
}

/* Scenes are made anew in the place of others, between calls with the same work memory. */
TEST(scenes_made_anew_in_one_place_are_told_apart) {
    const size_t size = fibrad_scene_size(150, 0);
    OWNED void *block = block_of(size);
    OWNED_WORK work = work_growing();
    OWNED_BY(output_free) struct output out = output_of();
    for (uint64_t seed = 0; seed < 3; seed++)
        for (int function = 0; function < FUNCTIONS; function++) {
            OWNED_BED bed = packing(150, .8, 1.2, .5, seed, false);
            const fibrad_spheres spheres = spheres_of(&bed);
            fibrad_scene *scene = NULL;
            assert_ok(fibrad_scene_init(&scene, block, size, NULL, &spheres, NULL));
            OWNED_BY(output_free) struct output truth = expected(function, scene, 70);
            assert_ok(call(function, scene, &work, 70, &out));
            ck_assert_msg(same_output(function, &out, &truth), "%s", names[function]);
        }
}

/* The caller may give another block at any time, whatever it holds. */
TEST(the_block_may_change_at_any_time) {
    OWNED_BED bed = bed_number(0);
    fibrad_scene *scene = scene_of(&bed, 0);
    const size_t size = 4u << 20;
    unsigned char *blocks[2] = {malloc(size), malloc(size)};
    memset(blocks[0], 0xff, size), memset(blocks[1], 1, size);
    for (int function = 0; function < FUNCTIONS; function++) {
        OWNED_BY(output_free) struct output truth = expected(function, scene, 3), out = output_of();
        fibrad_work work = work_fixed(blocks[0], size);
        for (int round = 0; round < 8; round++) {
            work.memory.block = blocks[round / 2 % 2] + (round & 4 ? 24 : 0);
            work.memory.size = size - 64 - (round & 2 ? 1000 : 0);
            assert_ok(call(function, scene, &work, 3, &out));
            ck_assert_msg(same_output(function, &out, &truth), "%s", names[function]);
        }
    }
    free(blocks[0]), free(blocks[1]), free(scene);
}

/* A fixed block may begin at each of the 64 offsets. Nothing is written beside it. */
LOOP_TEST(blocks_may_have_any_alignment, FUNCTIONS) {
    OWNED_BED bed = bed_number(1);
    OWNED fibrad_scene *scene = scene_of(&bed, 0);
    const int function = _i;
    OWNED_BY(output_free) struct output truth = expected(function, scene, 5), out = output_of();
    fibrad_work least = work_fixed(NULL, 0);
    for (int tries = 0; work_again(&least, call(function, scene, &least, 5, &out)); tries++)
        ck_assert_int_lt(tries, 12);
    const size_t size = least.memory.size;
    work_free_fixed(&least);
    OWNED unsigned char *block = block_of(size + 128);
    for (size_t offset = 0; offset < 64; offset++) {
        memset(block, 0x5a, size + 128);
        fibrad_work work = work_fixed(block + offset, size);
        assert_ok(call(function, scene, &work, 5, &out));
        ck_assert_msg(same_output(function, &out, &truth), "%s at %zu", names[function], offset);
        ck_assert(bytes_are(block, 0, offset, 0x5a));
        ck_assert(bytes_are(block, offset + size, size + 128, 0x5a));
    }
}

/* Each call of the resize function in turn returns FIBRAD_E_MEMORY. Nothing is written, and the next call, which gets
 * memory, has the right result. */
LOOP_TEST(refused_memory_is_an_error_once, FUNCTIONS) {
    OWNED_BED bed = bed_number(2);
    OWNED fibrad_scene *scene = scene_of(&bed, 0);
    const int function = _i;
    OWNED_BY(output_free) struct output truth = expected(function, scene, 5), out = output_of();
    uint32_t calls = 1;
    for (uint32_t refuse = 0; refuse <= calls; refuse++) {
        struct source source = {.refuse_at = refuse};
        fibrad_work work = {.memory = {.resize = source_resize, .context = &source}};
        out.row.length = 77;
        int status = call(function, scene, &work, 5, &out);
        if (refuse > 0) {
            ck_assert_msg(status == FIBRAD_E_MEMORY, "%s, call %u of %u", names[function], refuse, calls);
            ck_assert_uint_eq(out.row.length, 77);
            status = call(function, scene, &work, 5, &out);
        } else {
            calls = source.calls;
            ck_assert_uint_ge(calls, 1);
        }
        assert_ok(status);
        ck_assert_msg(same_output(function, &out, &truth), "%s", names[function]);
        ck_assert(work.memory.size == source.size && (unsigned char *)work.memory.block >= source.whole);
        free(source.whole);
    }
}

/* The size FIBRAD_WORK_BYTES is enough at any offset: for a packed bed, for a sphere that meets hundreds in a window,
 * and for one that meets six. */
TEST(the_bytes_of_the_header_are_enough) {
    static unsigned char packed[FIBRAD_WORK_BYTES(64, 200) + 64], hundreds[FIBRAD_WORK_BYTES(1000, 1000) + 64],
        six[FIBRAD_WORK_BYTES(6, 6) + 64], walls[FIBRAD_WORK_BYTES(64, 3) + FIBRAD_WORK_WALLS + 64];
    OWNED_BED bed = packing(600, .8, 1.2, .6, 7, true), around = BED({0, 0, 0, 4});
    OWNED_BED lone = lattice('p', 2), between = between_walls();
    for (uint32_t k = 0; k < 1000; k++) {
        double w[3];
        fibrad_direction(k, 1000, w);
        add_sphere(&around, 5 * w[0], 5 * w[1], 5 * w[2], .2);
    }
    fibrad_scene *scenes[4] = {scene_of(&bed, 0), scene_of(&around, 0), scene_of(&lone, 0),
                               scene_number(SCENES - 1, &between)};
    OWNED_BY(output_free) struct output out = output_of();
    for (size_t offset = 0; offset < 64; offset += 21) {
        fibrad_work works[4] = {work_fixed(packed + offset, FIBRAD_WORK_BYTES(64, 200)),
                                work_fixed(hundreds + offset, FIBRAD_WORK_BYTES(1000, 1000)),
                                work_fixed(six + offset, FIBRAD_WORK_BYTES(6, 6)),
                                work_fixed(walls + offset, FIBRAD_WORK_BYTES(64, 3) + FIBRAD_WORK_WALLS)};
        for (int function = BEAM; function <= POINTS; function++) {
            for (uint32_t i = 0; i < bed.n; i += 7) assert_ok(call(function, scenes[0], &works[0], i, &out));
            assert_ok(call(function, scenes[1], &works[1], 0, &out));
            for (uint32_t i = 0; i < lone.n; i++) assert_ok(call(function, scenes[2], &works[2], i, &out));
            ck_assert_uint_eq(out.row.length, 1 + 4);
            assert_ok(call(function, scenes[3], &works[3], 0, &out));
        }
    }
    for (int k = 0; k < 4; k++) free(scenes[k]);
}

/* A block of size 0 is too small. NULL that is said to have bytes is refused. */
TEST(blocks_of_size_zero_are_too_small) {
    OWNED_BED bed = strewn(50, 9);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED_WORK work = work_growing();
    const fibrad_beam_rule rule = {.directions = 20};
    OWNED_ROW row = row_of(50);
    double byte;
    for (int k = 0; k < 3; k++) { /* no block yet; a block; NULL that is said to have bytes */
        const fibrad_memory memory = {.block = k == 1 ? &byte : NULL, .size = k == 2 ? 1 << 20 : 0};
        fibrad_work little = {.memory = memory};
        fibrad_rows rows = {.memory = memory};
        fibrad_row append = {.rows = &rows};
        ck_assert_int_eq(fibrad_beam_row(scene, &little, 1, &rule, &row), k == 2 ? FIBRAD_E_ARGUMENT : FIBRAD_E_WORK);
        ck_assert_int_eq(fibrad_beam_row(scene, &work, 1, &rule, &append),
                         k == 2 ? FIBRAD_E_ARGUMENT : FIBRAD_E_CAPACITY);
        if (k < 2) ck_assert(little.memory.needed > 0 && rows.memory.needed > 0);
        assert_ok(fibrad_beam_row(scene, &work, 1, &rule, &row));
        ck_assert_int_eq(fibrad_rows_add(&rows, &row, 0), k == 2 ? FIBRAD_E_ARGUMENT : FIBRAD_E_CAPACITY);
    }
}

/* Arrays are too small. With the length that the row of each method says, the next call succeeds. Until then nothing is
 * written. */
static void ask_and_repeat(const fibrad_scene *scene, const fibrad_beam_rule *beam,
                           const fibrad_exchange_rule *exchange) {
    enum { LONGEST = 100 };
    OWNED_WORK work = work_growing();
    fibrad_rows rows = {0};
    fibrad_row append = {.rows = &rows};
    uint32_t col[LONGEST];
    double f[LONGEST], wall[1];
    for (int k = 0; k < LONGEST; k++) col[k] = 7, f[k] = -7;
    wall[0] = -7;
    fibrad_row row = {.col = col, .f = f, .wall = wall};
    for (uint32_t tries = 0; tries < 2; tries++) {
        const int expected = tries == 0 ? FIBRAD_E_CAPACITY : FIBRAD_OK;
        ck_assert_int_eq(beam ? fibrad_beam_row(scene, &work, 0, beam, &row)
                              : fibrad_exchange_row(scene, &work, 0, exchange, &row, NULL),
                         expected);
        if (tries == 1) ck_assert_uint_eq(row.length, row.capacity);
        for (int k = tries == 0 ? 0 : (int)row.length; k < LONGEST; k++) ck_assert(col[k] == 7 && f[k] == -7);
        if (tries == 0) ck_assert(wall[0] == -7 && row.error == 0 && row.escaped == 0);
        row.capacity = row.length;
        ck_assert_int_eq(beam ? fibrad_beam_row(scene, &work, 0, beam, &append)
                              : fibrad_exchange_row(scene, &work, 0, exchange, &append, NULL),
                         tries < 1 ? FIBRAD_E_CAPACITY : expected);
        if (tries == 0) rows.memory.size = rows.memory.needed, rows.memory.block = malloc(rows.memory.size);
    }
    free(rows.memory.block);
}

TEST(the_length_that_is_asked_for_suffices) {
    OWNED_BED bed = packing(100, .5, 1.5, .3, 4, false);
    const fibrad_wall floor = plane_at(2, 0, -100);
    OWNED fibrad_scene *scene = scene_with(&bed, &(fibrad_scene_config){.wall = &floor, .walls = 1});
    double emissivity[100];
    for (int i = 0; i < 100; i++) emissivity[i] = .2;
    fibrad_exchange_rule exchange = {.emissivity = emissivity, .wall_emissivity = &(double){.5}, .directions = 8};
    ask_and_repeat(scene, &(fibrad_beam_rule){.directions = 8, .tolerance = 1e-3}, NULL);
    ask_and_repeat(scene, NULL, &exchange);
    for (int i = 1; i < 100; i += 2) emissivity[i] = 0; /* the first segment sees it, and there are no entries */
    ask_and_repeat(scene, NULL, &exchange);
}
