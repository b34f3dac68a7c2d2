/* test_row_parts.c - rows computed in parts, each of which is a range of directions, have the bits of rows computed at
 * once. SPDX-License-Identifier: MIT */
#include "suite.h"
#include "scenes.h"
#include "meshes.h"

enum { PARTS_MOST = 7, SPHERES = 400 };

/* Computes row i in this many parts of unequal size, from the last part to the first. */
static int row_in_parts(const fibrad_scene *scene, uint32_t i, const fibrad_beam_rule *rule, uint32_t parts,
                        fibrad_row *row) {
    OWNED_WORK first = work_growing(), second = work_growing();
    fibrad_row_part part[PARTS_MOST];
    const uint32_t windows = rule->lines != NULL ? fibrad_line_set_count(rule->lines) : rule->directions;
    for (uint32_t p = parts; p-- > 0;) {
        part[p] = (fibrad_row_part){.memory = memory_growing()};
        const uint32_t from = windows * p * p / (parts * parts);
        const uint32_t to = windows * (p + 1) * (p + 1) / (parts * parts);
        assert_ok(fibrad_beam_part(scene, p % 2 == 0 ? &first : &second, i, rule, from, to, &part[p]));
    }
    const int status = fibrad_beam_join(scene, &second, i, rule, part, parts, row);
    for (uint32_t p = 0; p < parts; p++) free(part[p].memory.block);
    return status;
}

/* Compares row i, computed at once and in parts. */
static void compare_row(const fibrad_scene *scene, uint32_t n, uint32_t walls, uint32_t i, const fibrad_beam_rule *rule,
                        uint32_t parts, double seen[2]) {
    OWNED_WORK work = work_growing();
    OWNED_ROW one = row_of(n), joined = row_of(n);
    OWNED float *half = calloc(n, sizeof *half), *joined_half = calloc(n, sizeof *half);
    one.half = half, joined.half = joined_half;
    assert_ok(fibrad_beam_row(scene, &work, i, rule, &one));
    assert_ok(row_in_parts(scene, i, rule, parts, &joined));
    ck_assert(same_bits_with(&one, &joined, walls));
    ck_assert_uint_eq(joined.directions + joined.lines,
                      rule->lines != NULL ? fibrad_line_set_count(rule->lines) : rule->directions);
    ck_assert_uint_eq(joined.fallbacks, one.fallbacks);
    ck_assert_uint_eq(joined.sphere, i);
    ck_assert(joined.noise == one.noise && joined.shares == one.shares && joined.lines == one.lines);
    if (rule->lines != NULL) ck_assert_mem_eq(half, joined_half, one.length * sizeof *half);
    seen[0] += row_sum(&one);
    for (uint32_t b = 0; b < walls; b++) seen[1] += one.wall[b];
}

/* Compares rows of a large, a small and the last sphere, computed at once and in parts. Adds what spheres get and what
 * walls get. */
static void compare_rows(const struct bed *bed, const fibrad_scene_config *config, double cutoff, double seen[2]) {
    OWNED fibrad_scene *scene = scene_with(bed, config);
    static unsigned char block[1 << 16];
    static const uint32_t chords[] = {FIBRAD_CHORDS_NONE, 16, 64};
    fibrad_line_set *lines;
    const uint32_t rows[] = {0, bed->n / 2, bed->n - 1};
    for (int k = 0; k < 18; k++) {
        const uint32_t i = rows[k % 3], parts = 1 + (uint32_t)k % PARTS_MOST;
        const fibrad_beam_rule rule = {
            .directions = 50 + (uint32_t)k, .points = k % 2 == 0 ? 0 : 64, .cutoff = cutoff, .turn = k < 9 ? 0 : 5};
        compare_row(scene, bed->n, config->walls, i, &rule, parts, seen);
        assert_ok(fibrad_line_set_init(&lines, block, sizeof block, rule.directions));
        const fibrad_beam_rule along = {.lines = lines, .chords = chords[k % 3], .cutoff = cutoff};
        compare_row(scene, bed->n, config->walls, rows[(k + k / 3) % 3], &along, parts, seen);
        const fibrad_beam_rule masks = {.directions = rule.directions, .chords = 32, .cutoff = cutoff};
        compare_row(scene, bed->n, config->walls, i, &masks, parts, seen);
    }
}

TEST(parts_make_the_row_of_spheres_alone) {
    OWNED_BED bed = strewn(SPHERES, 3), box = packing(120, .8, 1.2, .55, 4, true);
    double seen[2] = {0, 0};
    compare_rows(&bed, &(fibrad_scene_config){0}, 0, seen);
    compare_rows(&bed, &(fibrad_scene_config){0}, .5, seen);
    compare_rows(&box, &(fibrad_scene_config){0}, 0, seen);
    ck_assert_double_gt(seen[0], 20);
}

TEST(parts_make_the_row_among_walls) {
    OWNED_BED bed = strewn(SPHERES, 5);
    const fibrad_wall planes[] = {plane_at(0, 0, -.3), plane_at(0, 1, 1.3), plane_at(1, 0, -.3),
                                  plane_at(1, 1, 1.3), plane_at(2, 0, -.3), plane_at(2, 1, 1.3)};
    const fibrad_wall tube[] = {cylinder_at(.5, .5, 1.2), plane_at(2, 0, -.3), plane_at(2, 1, 1.3)};
    double seen[2] = {0, 0};
    compare_rows(&bed, &(fibrad_scene_config){.wall = planes, .walls = 6}, 0, seen);
    compare_rows(&bed, &(fibrad_scene_config){.wall = planes + 4, .walls = 2}, 0, seen);
    compare_rows(&bed, &(fibrad_scene_config){.wall = planes, .walls = 6}, .5, seen);
    compare_rows(&bed, &(fibrad_scene_config){.wall = tube, .walls = 3}, 0, seen);
    ck_assert_double_gt(seen[1], 20);
}

TEST(parts_make_the_row_among_triangles) {
    OWNED_BED bed = strewn(SPHERES, 6);
    OWNED struct mesh *mesh = mesh_new();
    double seen[2] = {0, 0};
    mesh_box(mesh, (const double[]){-.3, -.3, -.3}, (const double[]){1.3, 1.3, 1.3}, 0);
    mesh_tube(mesh, .5, .5, .05, -.2, 1.2, 12, 3, true, 6, 6);
    compare_rows(&bed, &(fibrad_scene_config){.wall = mesh->wall, .walls = 7, .triangles = &mesh->triangles}, 0, seen);
    ck_assert_double_gt(seen[1], 10);
}

/* Parts of another row, rule or scene, in another order, or not complete are told from those that make the row. */
TEST(parts_that_do_not_fit_are_refused) {
    OWNED_BED bed = strewn(50, 7), other_bed = strewn(50, 8);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST), *other = scene_of(&other_bed, FIBRAD_ISA_BEST);
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(50);
    const fibrad_beam_rule rule = {.directions = 20}, more = {.directions = 21};
    const fibrad_beam_rule tolerant = {.directions = 20, .tolerance = 1e-3};
    fibrad_row_part part[2] = {{.memory = memory_growing()}, {.memory = memory_growing()}};
    ck_assert_int_eq(fibrad_beam_join(scene, &work, 1, &rule, part, 2, &row), FIBRAD_E_STATE);
    for (uint32_t p = 0; p < 2; p++) assert_ok(fibrad_beam_part(scene, &work, 1, &rule, 10 * p, 10 * p + 10, &part[p]));
    ck_assert_int_eq(fibrad_beam_join(scene, &work, 2, &rule, part, 2, &row), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_beam_join(scene, &work, 1, &more, part, 2, &row), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_beam_join(other, &work, 1, &rule, part, 2, &row), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_beam_join(scene, &work, 1, &rule, part, 1, &row), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_beam_join(scene, &work, 1, &rule, part + 1, 1, &row), FIBRAD_E_STATE);
    assert_invalid(fibrad_beam_join(scene, &work, 1, &rule, NULL, 2, &row));
    assert_invalid(fibrad_beam_join(NULL, &work, 1, &rule, part, 2, &row));
    ck_assert_int_eq(fibrad_beam_join(scene, &work, 1, &tolerant, part, 2, &row), FIBRAD_E_UNSUPPORTED);
    assert_ok(fibrad_beam_join(scene, &work, 1, &rule, part, 2, &row));
    assert_invalid(fibrad_beam_part(scene, &work, 1, &rule, 5, 5, &part[0]));
    assert_invalid(fibrad_beam_part(scene, &work, 1, &rule, 5, 21, &part[0]));
    assert_invalid(fibrad_beam_part(scene, &work, 50, &rule, 5, 9, &part[0]));
    assert_invalid(fibrad_beam_part(scene, &work, 1, &rule, 5, 9, NULL));
    assert_invalid(fibrad_beam_part(NULL, &work, 1, &rule, 5, 9, &part[0]));
    ck_assert_int_eq(fibrad_beam_part(scene, &work, 1, &tolerant, 5, 9, &part[0]), FIBRAD_E_UNSUPPORTED);
    for (int p = 0; p < 2; p++) free(part[p].memory.block);
}

/* If terms were changed on the way, there is no row that looks right. */
TEST(parts_that_were_changed_make_no_row) {
    OWNED_BED bed = strewn(50, 7);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED_WORK work = work_growing();
    OWNED_ROW row = row_of(50);
    const fibrad_beam_rule rule = {.directions = 20};
    fibrad_row_part part = {.memory = memory_growing()};
    assert_ok(fibrad_beam_part(scene, &work, 1, &rule, 0, 20, &part));
    double *value = part.memory.block;
    *value += 1e-6;
    ck_assert_int_eq(fibrad_beam_join(scene, &work, 1, &rule, &part, 1, &row), FIBRAD_E_SUM);
    *value = NAN;
    ck_assert_int_eq(fibrad_beam_join(scene, &work, 1, &rule, &part, 1, &row), FIBRAD_E_SUM);
    assert_ok(fibrad_beam_part(scene, &work, 1, &rule, 0, 20, &part));
    assert_ok(fibrad_beam_join(scene, &work, 1, &rule, &part, 1, &row));
    free(part.memory.block);
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
        fibrad_row_part part = {.memory = memory};
        fibrad_rows rows = {.memory = memory};
        fibrad_row append = {.rows = &rows};
        ck_assert_int_eq(fibrad_beam_row(scene, &little, 1, &rule, &row), k == 2 ? FIBRAD_E_ARGUMENT : FIBRAD_E_WORK);
        ck_assert_int_eq(fibrad_beam_row(scene, &work, 1, &rule, &append),
                         k == 2 ? FIBRAD_E_ARGUMENT : FIBRAD_E_CAPACITY);
        ck_assert_int_eq(fibrad_beam_part(scene, &work, 1, &rule, 0, 20, &part),
                         k == 2 ? FIBRAD_E_ARGUMENT : FIBRAD_E_CAPACITY);
        if (k < 2) ck_assert(little.memory.needed > 0 && rows.memory.needed > 0 && part.memory.needed > 0);
        assert_ok(fibrad_beam_row(scene, &work, 1, &rule, &row));
        ck_assert_int_eq(fibrad_rows_add(&rows, &row, 0), k == 2 ? FIBRAD_E_ARGUMENT : FIBRAD_E_CAPACITY);
    }
}

/* Arrays are too small. With the length that the row of each method says, the next call succeeds. Until then nothing is
 * written. */
static void ask_and_repeat(const fibrad_scene *scene, const fibrad_beam_rule *beam,
                           const fibrad_exchange_rule *exchange) {
    enum { MOST = 100 };
    OWNED_WORK work = work_growing();
    fibrad_rows rows = {0};
    fibrad_row append = {.rows = &rows};
    uint32_t col[MOST];
    double f[MOST], wall[1];
    for (int k = 0; k < MOST; k++) col[k] = 7, f[k] = -7;
    wall[0] = -7;
    fibrad_row row = {.col = col, .f = f, .wall = wall};
    for (uint32_t tries = 0; tries < 2; tries++) {
        const int expected = tries == 0 ? FIBRAD_E_CAPACITY : FIBRAD_OK;
        ck_assert_int_eq(beam ? fibrad_beam_row(scene, &work, 0, beam, &row)
                              : fibrad_exchange_row(scene, &work, 0, exchange, &row, NULL),
                         expected);
        if (tries == 1) ck_assert_uint_eq(row.length, row.capacity);
        for (int k = tries == 0 ? 0 : (int)row.length; k < MOST; k++) ck_assert(col[k] == 7 && f[k] == -7);
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
