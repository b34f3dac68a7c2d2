/* test_matrix_calls.c - collections of rows, and threads, states and memory of matrices. SPDX-License-Identifier: MIT
 */
#include "matrices.h"

static void at_once(void *calls, uint32_t pieces, fibrad_piece *piece, void *job) {
    ++*(int *)calls;
#pragma omp parallel for num_threads(4) schedule(dynamic, 1)
    for (uint32_t k = 0; k < pieces; k++) piece(job, pieces - 1 - k);
}

/* Makes a matrix of `tasks` tasks, backwards in several threads or not. */
static struct matrix by_tasks(const fibrad_scene *scene, const fibrad_rows *rows, uint32_t count,
                              fibrad_matrix_rule rule, uint32_t tasks, bool threads) {
    struct matrix m = {NULL, {0}};
    int calls = 0;
    rule.tasks = tasks;
    if (threads) rule.parallel = at_once, rule.context = &calls;
    const size_t size = fibrad_matrix_size(scene, rows, count, &rule);
    void *block = block_of(size);
    memset(block, 0xa5, size);
    assert_ok(fibrad_matrix_init(&m.matrix, block, size, scene, rows, count, &rule, NULL));
    assert_ok(fibrad_matrix_close(m.matrix));
    assert_ok(fibrad_matrix_read(m.matrix, &m.factors));
    double largest, same;
    assert_ok(fibrad_matrix_reciprocity(m.matrix, &largest));
    ck_assert(!threads || tasks == 1 || calls > 4);
    OWNED_MATRIX alone = matrix_of(
        scene, rows, count, &(fibrad_matrix_rule){.kind = rule.kind, .emissivity = rule.emissivity, .drop = rule.drop});
    assert_ok(fibrad_matrix_reciprocity(alone.matrix, &same));
    ck_assert_double_eq(largest, same);
    return m;
}

/* No bit depends on the number of tasks, on threads, nor on how rows are spread over collections. */
TEST(tasks_change_no_bit) {
    OWNED_BED bed = packing(150, .3, 1.5, .5, 3, true);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED double *emissivity = calloc(bed.n, sizeof *emissivity);
    for (uint32_t i = 0; i < bed.n; i++) emissivity[i] = (1 + i % 7) / 7.;
    const fibrad_matrix_rule rules[] = {{0}, {.kind = FIBRAD_ROWS_EXCHANGE, .emissivity = emissivity}, {.drop = 5e-3}};
    fibrad_rows rows = rows_by_beams(scene, &(fibrad_beam_rule){.directions = 34}), spread[4];
    for (int c = 0; c < 4; c++) spread[c] = (fibrad_rows){.memory = memory_growing()};
    OWNED_WORK work = work_growing();
    for (uint32_t i = bed.n; i-- > 0;) { /* none in the third */
        fibrad_row to = {.rows = &spread[i % 3 == 2 ? 3 : i % 3]};
        assert_ok(fibrad_beam_row(scene, &work, i, &(fibrad_beam_rule){.directions = 34}, &to));
    }
    for (int k = 0; k < 3; k++) {
        OWNED_MATRIX whole = matrix_of(scene, &rows, 1, &rules[k]), other = matrix_of(scene, spread, 4, &rules[k]);
        ck_assert(matrix_same_bits(&whole.factors, &other.factors));
        for (uint32_t tasks = 1; tasks <= 1024; tasks += tasks < 16 ? 1 : 1008) {
            for (int way = 0; way < 4; way++) {
                OWNED_MATRIX m = by_tasks(scene, way % 2 ? spread : &rows, way % 2 ? 4 : 1, rules[k], tasks, way < 2);
                ck_assert(matrix_same_bits(&whole.factors, &m.factors));
            }
        }
    }
    for (int c = 0; c < 4; c++) rows_free(&spread[c]);
    rows_free(&rows);
}

TEST(calls_out_of_order_are_refused) {
    const double r[] = {1, 2, 1};
    OWNED fibrad_scene *scene = apart(3, r);
    OWNED_ROWS rows = {.memory = memory_growing()};
    add_rows(&rows, 3, (uint64_t[]){0, 1, 1, 3}, (uint32_t[]){1, 0, 2}, (double[]){.5, .25, .125}, true);
    for (int raw = 0; raw < 2; raw++) {
        const fibrad_matrix_rule rule = {.tasks = 2, .raw = raw};
        const size_t size = fibrad_matrix_size(scene, &rows, 1, &rule);
        OWNED void *block = block_of(size);
        fibrad_matrix *m = NULL;
        fibrad_factors factors = {.n = 77};
        double largest = -7;
        assert_ok(fibrad_matrix_init(&m, block, size, scene, &rows, 1, &rule, NULL));
        ck_assert_int_eq(fibrad_matrix_read(m, &factors), FIBRAD_E_STATE);
        ck_assert_int_eq(fibrad_matrix_reciprocity(m, &largest), FIBRAD_E_STATE);
        ck_assert(factors.n == 77 && factors.start == NULL && largest == -7);
        assert_ok(fibrad_matrix_close(m));
        assert_ok(fibrad_matrix_read(m, &factors));
        const double first = factors.f[0];
        ck_assert_int_eq(fibrad_matrix_close(m), FIBRAD_E_STATE);
        assert_ok(fibrad_matrix_read(m, &factors)); /* this may be repeated */
        ck_assert_double_eq(factors.f[0], first);
        assert_ok(fibrad_matrix_reciprocity(m, &largest));
        assert_invalid(fibrad_matrix_read(m, NULL));
        assert_invalid(fibrad_matrix_reciprocity(m, NULL));
    }
    fibrad_factors factors;
    double largest;
    assert_invalid(fibrad_matrix_close(NULL));
    assert_invalid(fibrad_matrix_read(NULL, &factors));
    assert_invalid(fibrad_matrix_reciprocity(NULL, &largest));
}

/* If a row is missing, or occurs twice in one collection or in two, its sphere is named, and there is no matrix. */
TEST(rows_missing_or_double_are_named) {
    const double r[] = {1, 2, 1, 1, 3}, f = .5;
    OWNED fibrad_scene *scene = apart(5, r);
    const uint32_t col = 2;
    unsigned char block[8192];
    for (int raw = 0; raw < 2; raw++)
        for (uint32_t missing = 0; missing < 6; missing++)
            for (uint32_t twice = 0; twice < 6; twice++) {
                fibrad_rows rows[2] = {{.memory = memory_growing()}, {.memory = memory_growing()}};
                for (uint32_t i = 0; i < 5; i++) {
                    fibrad_row row = {.sphere = i, .col = (uint32_t *)(uintptr_t)&col, .f = (double *)(uintptr_t)&f};
                    row.length = i % 2;
                    if (i != missing) assert_ok(fibrad_rows_add(&rows[0], &row, 0));
                    if (i == twice) assert_ok(fibrad_rows_add(&rows[i % 2], &row, 0));
                }
                const fibrad_matrix_rule rule = {.raw = raw};
                const bool doubled = twice < 5 && (twice != missing), lacks = missing < 5 && twice != missing;
                fibrad_matrix *m = NULL;
                uint32_t sphere = 99;
                const size_t size = fibrad_matrix_size(scene, rows, 2, &rule);
                ck_assert(size > 0 && size <= sizeof block);
                const int status = fibrad_matrix_init(&m, block, size, scene, rows, 2, &rule, &sphere);
                if (doubled || (lacks && !raw)) {
                    ck_assert_int_eq(status, FIBRAD_E_STATE);
                    ck_assert(doubled && lacks && !raw ? sphere == twice || sphere == missing
                                                       : sphere == (doubled ? twice : missing));
                    ck_assert_ptr_null(m);
                    ck_assert_int_eq(fibrad_matrix_init(&m, block, size, scene, rows, 2, &rule, NULL), FIBRAD_E_STATE);
                } else {
                    assert_ok(status);
                    ck_assert_uint_eq(sphere, 99);
                }
                rows_free(&rows[0]), rows_free(&rows[1]);
            }
    fibrad_matrix *m = NULL; /* no collections at all */
    uint32_t sphere = 99;
    ck_assert_int_eq(fibrad_matrix_init(&m, block, sizeof block, scene, NULL, 0, NULL, &sphere), FIBRAD_E_STATE);
    ck_assert_uint_eq(sphere, 0);
    OWNED_MATRIX empty = matrix_of(scene, NULL, 0, &(fibrad_matrix_rule){.raw = 1});
    ck_assert_uint_eq(empty.factors.start[5], 0);
}

/* At each offset the matrix has the same bits, nothing is written beside the block, and a byte less is too little. */
TEST(matrix_blocks_may_have_any_alignment) {
    OWNED_BED bed = packing(60, .5, 1.5, .5, 3, true);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED_ROWS rows = rows_by_beams(scene, &(fibrad_beam_rule){.directions = 34});
    double emissivity[60];
    for (uint32_t i = 0; i < bed.n; i++) emissivity[i] = (1 + i % 5) / 5.;
    const fibrad_matrix_rule rules[] = {
        {.tasks = 3}, {.raw = 1}, {.kind = FIBRAD_ROWS_EXCHANGE, .emissivity = emissivity, .tasks = 7}, {.drop = .02}};
    for (int k = 0; k < 4; k++) {
        OWNED_MATRIX expected = matrix_of(scene, &rows, 1, &rules[k]);
        const size_t size = fibrad_matrix_size(scene, &rows, 1, &rules[k]);
        /* the header promises this */
        ck_assert_uint_le(size, (k == 1 ? 12 : 36) * rows.entries + (k == 1 ? 60 : 120) * bed.n + 2048);
        OWNED unsigned char *block = block_of(size + 128);
        for (size_t offset = 0; offset < 64; offset++) {
            fibrad_matrix *m = NULL;
            fibrad_factors factors;
            memset(block, 0xa5, size + 128);
            ck_assert_int_eq(fibrad_matrix_init(&m, block + offset, size - 1, scene, &rows, 1, &rules[k], NULL),
                             FIBRAD_E_SIZE);
            ck_assert_int_eq(fibrad_matrix_init(&m, block + offset, 0, scene, &rows, 1, &rules[k], NULL),
                             FIBRAD_E_SIZE);
            ck_assert_ptr_null(m);
            assert_ok(fibrad_matrix_init(&m, block + offset, size, scene, &rows, 1, &rules[k], NULL));
            assert_ok(fibrad_matrix_close(m));
            assert_ok(fibrad_matrix_read(m, &factors));
            ck_assert(matrix_same_bits(&factors, &expected.factors));
            ck_assert(bytes_are(block, 0, offset, 0xa5));
            ck_assert(bytes_are(block, offset + size, size + 128, 0xa5));
        }
    }
}

TEST(bad_matrices_are_refused) {
    const double r[] = {1, 2}, f = .5, wall = .1;
    OWNED fibrad_scene *scene = apart(2, r);
    OWNED_ROWS rows = {.memory = memory_growing()}, stranger = rows, seen = rows, walled = rows;
    uint32_t other = 1, none = 2; /* no such sphere */
    fibrad_row row = {.col = &other, .f = (double *)(uintptr_t)&f, .wall = (double *)(uintptr_t)&wall, .length = 1};
    for (row.sphere = 0; row.sphere < 2; row.sphere++) {
        assert_ok(fibrad_rows_add(&rows, &row, 0));
        assert_ok(fibrad_rows_add(&walled, &row, 1));
    }
    assert_ok(fibrad_rows_add(&stranger, &row, 0)); /* of sphere 2 */
    row.sphere = 0, row.col = &none;
    assert_ok(fibrad_rows_add(&seen, &row, 0));
    static unsigned char block[8192];
    fibrad_matrix *m = NULL;
    assert_invalid(fibrad_matrix_init(NULL, block, sizeof block, scene, &rows, 1, NULL, NULL));
    assert_invalid(fibrad_matrix_init(&m, NULL, sizeof block, scene, &rows, 1, NULL, NULL));
    static const double white[] = {1, 1}, grey[][2] = {{1, 0}, {1, -1}, {NAN, 1}, {1, INFINITY}, {1.5, 1}};
    const fibrad_matrix_rule plain = {0};
    const struct {
        const fibrad_scene *scene;
        const fibrad_rows *rows;
        fibrad_matrix_rule rule;
    } bad[] = {{NULL, &rows, plain},
               {scene, NULL, plain},
               {scene, &stranger, plain},
               {scene, &seen, plain},
               {scene, &walled, plain},
               {scene, &rows, {.tasks = 1025}},
               {scene, &rows, {.drop = -1}},
               {scene, &rows, {.drop = NAN}},
               {scene, &rows, {.kind = -1}},
               {scene, &rows, {.kind = 3}},
               {scene, &rows, {.kind = FIBRAD_ROWS_EXCHANGE}}, /* the emissivities are missing */
               {scene, &rows, {.emissivity = white}},
               {scene, &rows, {.kind = FIBRAD_ROWS_EXCHANGE, .emissivity = grey[0]}},
               {scene, &rows, {.kind = FIBRAD_ROWS_EXCHANGE, .emissivity = grey[1]}},
               {scene, &rows, {.kind = FIBRAD_ROWS_EXCHANGE, .emissivity = grey[2]}},
               {scene, &rows, {.kind = FIBRAD_ROWS_EXCHANGE, .emissivity = grey[3]}},
               {scene, &rows, {.kind = FIBRAD_ROWS_EXCHANGE, .emissivity = grey[4]}}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        const int status =
            fibrad_matrix_init(&m, block, sizeof block, bad[k].scene, bad[k].rows, 1, &bad[k].rule, NULL);
        const bool accepted = fibrad_matrix_size(bad[k].scene, bad[k].rows, 1, &bad[k].rule) != 0;
        ck_assert_msg(!accepted && status == FIBRAD_E_ARGUMENT, "matrix %zu: %d", k, status);
    }
    ck_assert_ptr_null(m);
    assert_ok(fibrad_matrix_init(&m, block, sizeof block, scene, &rows, 1, NULL, NULL));
}

static bool same_collection(const fibrad_rows *a, const fibrad_rows *b) {
    return a->count == b->count && a->entries == b->entries;
}

TEST(bad_rows_are_refused) {
    OWNED_ROWS rows = {.memory = memory_growing()};
    uint32_t col[] = {1, 3}, descending[] = {3, 1}, equal[] = {1, 1};
    double f[] = {.1, .2}, wall[] = {.5};
    const fibrad_row good = {.sphere = 7, .col = col, .f = f, .wall = wall, .length = 2, .escaped = .7, .error = .01};
    assert_ok(fibrad_rows_add(&rows, &good, 1));
    ck_assert(rows.count == 1 && rows.entries == 2 && rows.used > 0);
    const fibrad_rows before = rows;
    fibrad_row bad = good;
    const fibrad_row lacking[] = {{.col = descending, .f = f, .wall = wall, .length = 2},
                                  {.col = equal, .f = f, .wall = wall, .length = 2},
                                  {.f = f, .wall = wall, .length = 2},
                                  {.col = col, .wall = wall, .length = 2},
                                  {.col = col, .f = f, .length = 2},
                                  {.col = col, .f = f, .wall = wall, .length = 2, .escaped = NAN},
                                  {.col = col, .f = f, .wall = wall, .length = 2, .error = NAN}};
    for (size_t k = 0; k < sizeof lacking / sizeof *lacking; k++)
        assert_invalid(fibrad_rows_add(&rows, &lacking[k], 1));
    const double wrong[] = {-.1, 1.1, NAN, INFINITY, -INFINITY};
    double *const places[] = {&f[0], &f[1], &wall[0]};
    for (size_t k = 0; k < 3 * sizeof wrong / sizeof *wrong; k++) {
        const double was = *places[k % 3];
        *places[k % 3] = wrong[k / 3];
        assert_invalid(fibrad_rows_add(&rows, &good, 1));
        *places[k % 3] = was;
    }
    assert_invalid(fibrad_rows_add(NULL, &good, 1));
    assert_invalid(fibrad_rows_add(&rows, NULL, 1));
    ck_assert(same_collection(&rows, &before) && rows.used == before.used);
    bad = good, bad.wall = NULL; /* no walls, no array */
    assert_ok(fibrad_rows_add(&rows, &bad, 0));
    bad = (fibrad_row){.sphere = 3, .escaped = 1}; /* nothing seen */
    assert_ok(fibrad_rows_add(&rows, &bad, 0));
    double whole[] = {1 + 1e-15, 0};
    bad = (fibrad_row){.sphere = 4, .col = col, .f = whole, .length = 2}; /* above 1 by rounding; 0 */
    assert_ok(fibrad_rows_add(&rows, &bad, 0));
    ck_assert(rows.count == 4 && rows.entries == 6);
    fibrad_rows_clear(NULL);
}

/* Rows that the kernel computes and rows that are added give the same matrix, also both in one collection. The
 * collection is then emptied and used again without more memory. */
TEST(rows_added_are_rows_computed) {
    OWNED_BED bed = packing(50, .5, 1.5, .4, 3, false);
    const fibrad_wall walls[] = {plane_at(2, 0, -100), plane_at(2, 1, 500)};
    OWNED fibrad_scene *scene = scene_with(&bed, &(fibrad_scene_config){.wall = walls, .walls = 2});
    OWNED_WORK work = work_growing();
    const fibrad_beam_rule rule = {.directions = 34};
    OWNED_ROWS computed = rows_by_beams(scene, &rule), mixed = {.memory = memory_growing()};
    OWNED_ROW row = row_of(bed.n);
    OWNED_MATRIX expected = matrix_of(scene, &computed, 1, NULL);
    size_t size = 0;
    for (int round = 0; round < 3; round++) {
        for (uint32_t i = 0; i < bed.n; i++) {
            fibrad_row append = {.rows = &mixed, .sphere = 1000, .length = 1000};
            assert_ok(fibrad_beam_row(scene, &work, i, &rule, i % 2 ? &row : &append));
            if (i % 2) assert_ok(fibrad_rows_add(&mixed, &row, 2));
            if (i % 2) continue;
            ck_assert_uint_eq(append.sphere, i); /* a row that is appended tells this, too */
            ck_assert(append.length > 0 && append.length < bed.n);
            assert_ok(fibrad_beam_row(scene, &work, i, &rule, &row));
            ck_assert(same_bits_with(&append, &row, 2)); /* where it stands now */
            ck_assert_uint_eq(append.directions, 34);
            ck_assert_double_gt(append.error, 0);
        }
        ck_assert(same_collection(&mixed, &computed));
        ck_assert_uint_eq(mixed.used, computed.used);
        OWNED_MATRIX m = matrix_of(scene, &mixed, 1, NULL);
        ck_assert(matrix_same_bits(&m.factors, &expected.factors));
        if (round > 0) ck_assert_uint_eq(mixed.memory.size, size);
        size = mixed.memory.size;
        const void *block = mixed.memory.block;
        fibrad_rows_clear(&mixed);
        ck_assert(mixed.count == 0 && mixed.used == 0 && mixed.entries == 0);
        ck_assert(mixed.memory.block == block && mixed.memory.size == size);
    }
}

/* A collection in fixed memory says how much memory a row lacks. Nothing is lost or written beside the block. With that
 * much memory the row is appended. This holds at each offset of the block. */
TEST(collections_in_fixed_memory_say_what_they_lack) {
    OWNED_BED bed = packing(40, .5, 1.5, .4, 3, false);
    OWNED fibrad_scene *scene = scene_of(&bed, 0);
    OWNED_WORK work = work_growing();
    const fibrad_beam_rule rule = {.directions = 13};
    OWNED_ROWS plenty = rows_by_beams(scene, &rule);
    OWNED_MATRIX expected = matrix_of(scene, &plenty, 1, NULL);
    const size_t room = plenty.used + 256;
    OWNED unsigned char *block = block_of(room + 128);
    OWNED_ROW row = row_of(bed.n);
    for (size_t offset = 0; offset < 64; offset++) {
        memset(block, 0xa5, room + 128);
        fibrad_rows rows = {.memory = {.block = block + offset, .size = offset % 8}};
        uint32_t refused = 0;
        for (uint32_t i = 0; i < bed.n; i++) {
            const bool added = (i + offset) % 2;
            if (added) assert_ok(fibrad_beam_row(scene, &work, i, &rule, &row));
            fibrad_row append = {.rows = &rows};
            for (;;) {
                const uint64_t entries = rows.entries;
                const size_t used = rows.used;
                const int status =
                    added ? fibrad_rows_add(&rows, &row, 0) : fibrad_beam_row(scene, &work, i, &rule, &append);
                if (status == FIBRAD_OK) break;
                ck_assert_int_eq(status, FIBRAD_E_CAPACITY);
                ck_assert_uint_gt(rows.memory.needed, rows.memory.size);
                ck_assert(rows.count == i && rows.entries == entries && rows.used == used);
                ck_assert_uint_le(rows.memory.needed, room);
                ck_assert(rows.memory.block == block + offset);
                ck_assert(bytes_are(block, offset + rows.memory.size, room + 128, 0xa5));
                rows.memory.size = rows.memory.needed;
                ck_assert_uint_le(++refused, 3 * bed.n);
            }
        }
        ck_assert_uint_ge(refused, bed.n / 2);
        ck_assert(same_collection(&rows, &plenty));
        ck_assert(bytes_are(block, 0, offset, 0xa5));
        ck_assert(bytes_are(block, offset + rows.memory.size, room + 128, 0xa5));
        OWNED_MATRIX m = matrix_of(scene, &rows, 1, NULL);
        ck_assert(matrix_same_bits(&m.factors, &expected.factors));
    }
    fibrad_rows nothing = {0}; /* no block at all */
    ck_assert_int_eq(fibrad_rows_add(&nothing, &row, 0), FIBRAD_E_CAPACITY);
    ck_assert_uint_gt(nothing.memory.needed, 0);
    fibrad_row append = {.rows = &nothing};
    ck_assert_int_eq(fibrad_beam_row(scene, &work, 0, &rule, &append), FIBRAD_E_CAPACITY);
    ck_assert_uint_gt(nothing.memory.needed, 0);
}

/* Rows come back as they were appended, also empty ones. Their columns may be written. */
TEST(rows_are_read_as_they_were_appended) {
    uint32_t col[] = {3, 5, 9};
    double f[] = {.25, .125, .0625}, wall[] = {.5};
    fibrad_row in = {.col = col, .f = f, .wall = wall, .length = 3, .escaped = .03125, .beyond = .03125, .error = .01};
    in.symmetric = 1;
    OWNED_ROWS rows = {.memory = memory_growing()};
    fibrad_row out;
    size_t at = 0;
    ck_assert_int_eq(fibrad_rows_read(&rows, &at, &out), 0);
    for (uint32_t i = 0; i < 40; i++) {
        fibrad_row row = in;
        row.sphere = i, row.length = i % 4;
        assert_ok(fibrad_rows_add(&rows, &row, 1));
    }
    for (uint32_t again = 0; again < 2; again++) {
        at = 0;
        for (uint32_t i = 0; i < 40; i++) {
            ck_assert_int_eq(fibrad_rows_read(&rows, &at, &out), 1);
            ck_assert(out.sphere == i && out.length == i % 4 && out.wall[0] == .5 && out.symmetric == 1);
            ck_assert(out.escaped == .03125 && out.beyond == .03125 && out.error == .01 && out.rows == NULL);
            for (uint32_t k = 0; k < out.length; k++) {
                ck_assert(out.col[k] == col[k] + again * 100 && out.f[k] == f[k]);
                out.col[k] += 100;
            }
        }
        ck_assert_int_eq(fibrad_rows_read(&rows, &at, &out), 0);
    }
    ck_assert_int_eq(fibrad_rows_read(NULL, &at, &out), 0);
    ck_assert_int_eq(fibrad_rows_read(&rows, NULL, &out), 0);
    ck_assert_int_eq(fibrad_rows_read(&rows, &at, NULL), 0);
}
