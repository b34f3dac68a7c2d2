/* test_protocol.c - calls at the wrong time, and scenes that are rebuilt in place. SPDX-License-Identifier: MIT */
#include "grey_rules.h"
#include "heat_calls.h"

TEST(sources_missing) {
    const struct contents c = contents_of(11);
    ENDED struct problem *book = by_the_book(&c), *p = begin_problem(&c, 0);
    const fibrad_heat_sources zeroed = {0}, good = p->sources;
    trace_all(p);
    assert_invalid(fibrad_heat_begin(p->heat, &zeroed));
    fibrad_heat_sources initial;
    fibrad_heat_sources_init(NULL);
    fibrad_heat_sources_init(&initial);
    assert_invalid(fibrad_heat_begin(p->heat, &initial));
    for (int what = 0; what < 12; what++) {
        fibrad_heat_sources s = good;
        const double **const arrays[] = {&s.temperature, &s.emissivity, &s.wall_temperature, &s.wall_emissivity};
        double *const values[] = {&s.surroundings, &s.sigma, &s.tolerance};
        if (what < 4) *arrays[what] = NULL;
        if (what >= 4 && what < 7) *values[what - 4] = NAN;
        if (what >= 7 && what < 10) *values[what - 7] = -1;
        if (what == 10) s.sigma = 0;
        if (what == 11) s.surroundings = INFINITY;
        ck_assert_msg(fibrad_heat_begin(p->heat, &s) == FIBRAD_E_ARGUMENT, "sources %d", what);
        assert_nothing_to_solve(p);
    }
    double *const arrays[] = {p->temperature, p->emissivity, p->wall_temperature, p->wall_emissivity};
    static const double bad[] = {NAN, -1e-300, -1, INFINITY, 1.0000001};
    for (int a = 0; a < 4; a++)
        for (uint32_t i = 0; i < (a < 2 ? N : WALLS); i++)
            for (size_t k = 0; k < (a % 2 == 0 ? 4 : 5); k++) { /* temperatures may be above 1 */
                const double was = arrays[a][i];
                arrays[a][i] = bad[k];
                assert_invalid(fibrad_heat_begin(p->heat, &p->sources));
                arrays[a][i] = was;
            }
    assert_nothing_to_solve(p);
    solve(p);
    assert_same_powers(p, book);
    /* a refusal leaves the solution that there is */
    assert_invalid(fibrad_heat_begin(p->heat, &zeroed));
    memset(p->power, 0, sizeof p->power);
    assert_ok(fibrad_heat_read(p->heat, &p->result));
    assert_same_powers(p, book);
}

/* Zero is a valid temperature and a valid emissivity. */
TEST(zero_is_a_value) {
    const struct contents c = contents_of(12);
    ENDED struct problem *p = begin_problem(&c, 0);
    trace_all(p);
    for (uint32_t i = 0; i < N; i++) p->temperature[i] = 0, p->emissivity[i] = i % 2;
    for (uint32_t b = 0; b < WALLS; b++) p->wall_temperature[b] = 0, p->wall_emissivity[b] = 0;
    p->sources.surroundings = 0;
    solve(p);
    for (uint32_t i = 0; i < N; i++) ck_assert_double_eq(p->power[i], 0);
    for (uint32_t b = 0; b < WALLS; b++) ck_assert_double_eq(p->wall_power[b], 0);
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
    for (uint32_t b = 0; b < WALLS; b++) {
        ck_assert_double_le(fabs(p->wall_power[b]), 1e-6 * fabs(p->power[1]));
        sum += p->wall_power[b];
    }
    ck_assert_double_lt(p->power[1], 0);
    ck_assert_double_le(fabs(sum), 1e-12 * largest);
}

enum { CHANGES = 9 };

static void assert_other_scene(struct problem *p) {
    int solved = 77;
    for (uint32_t k = 0; k < tasks_of(p); k++)
        ck_assert_int_eq(fibrad_heat_trace(p->heat, &p->work, k), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_heat_begin(p->heat, &p->sources), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_heat_step(p->heat, &solved), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_heat_read(p->heat, &p->result), FIBRAD_E_STATE);
    ck_assert_int_eq(solved, 77);
}

/* At each stage the scene is rebuilt with other contents, and then as it was. */
LOOP_TEST(other_contents_in_place, CHANGES) {
    const struct contents c = contents_of(13);
    ENDED struct problem *book = by_the_book(&c);
    const struct contents other = changed(&c, _i);
    ENDED struct problem *p = begin_problem(&c, 0);
    for (int stage = MADE; stage < STAGES; stage++) {
        advance_to(p, stage - 1, stage);
        build(p, &other);
        assert_other_scene(p);
        build(p, &c);
    }
    assert_ok(fibrad_heat_read(p->heat, &p->result));
    assert_same_powers(p, book);
}

/* The same holds if the second scene is not even made. */
TEST(no_contents_in_place) {
    const struct contents c = contents_of(14);
    ENDED struct problem *book = by_the_book(&c);
    struct contents bad = c;
    bad.x[9] = bad.x[8], bad.y[9] = bad.y[8], bad.z[9] = bad.z[8];
    ENDED struct problem *p = begin_problem(&c, 0);
    for (int stage = MADE; stage < STAGES; stage++) {
        fibrad_scene *none = NULL;
        advance_to(p, stage - 1, stage);
        ck_assert_int_eq(build_at(p->scene_block, p->scene_size, &bad, &none), FIBRAD_E_GEOMETRY);
        ck_assert_ptr_null(none);
        assert_other_scene(p);
        build(p, &c);
    }
    assert_ok(fibrad_heat_read(p->heat, &p->result));
    assert_same_powers(p, book);
}

/* What has become of such a scene gives nothing else either. */
TEST(nothing_of_no_scene) {
    const struct contents c = contents_of(14);
    struct contents bad = c;
    bad.x[9] = bad.x[8], bad.y[9] = bad.y[8], bad.z[9] = bad.z[8];
    ENDED struct problem *p = begin_problem(&c, 0);
    fibrad_scene *const scene = p->scene, *none = NULL;
    const fibrad_exchange_rule rule = {.emissivity = p->emissivity, .wall_emissivity = p->wall_emissivity};
    OWNED_ROWS rows = {.memory = memory_growing()};
    fibrad_row row = row_of(N), added = {.rows = &rows};
    fibrad_displacement displacement;
    fibrad_heat *heat = NULL;
    assert_ok(fibrad_beam_row(scene, &p->work, 0, NULL, &row));
    ck_assert_int_eq(build_at(p->scene_block, p->scene_size, &bad, &none), FIBRAD_E_GEOMETRY);
    ck_assert_int_eq(fibrad_beam_row(scene, &p->work, 0, NULL, &row), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_beam_row(scene, &p->work, 0, NULL, &added), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_cast_row(scene, &p->work, 0, NULL, &row, NULL), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_exchange_row(scene, &p->work, 0, &rule, &row, NULL), FIBRAD_E_STATE);
    ck_assert_int_eq(displacement_of(scene, &p->work, 0, &rule, &displacement), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_heat_init(&heat, p->heat_block, p->heat_size, &heat_config, scene), FIBRAD_E_STATE);
    ck_assert_uint_eq(fibrad_heat_size(&heat_config, scene), 0);
    ck_assert_int_eq(fibrad_heat_move(p->heat, scene), FIBRAD_E_STATE);
    ck_assert_uint_eq(fibrad_matrix_size(scene, &rows, 1, &(fibrad_matrix_rule){.raw = 1}), 0);
    ck_assert_uint_eq(rows.count, 0);
    row_free(&row);
}

/* Checks what work memory keeps between calls: after the scene was rebuilt in place, rows are the same in fresh memory
 * and in old memory. */
static void assert_row_as_fresh(struct problem *p, fibrad_work *kept, uint32_t i) {
    const fibrad_exchange_rule rule = {
        .emissivity = p->emissivity, .wall_emissivity = p->wall_emissivity, .paths = 300, .seed = 2};
    OWNED_ROW a = row_of(N), b = row_of(N);
    fibrad_displacement da = {0}, db = {0};
    OWNED_WORK fresh = work_growing();
    uint64_t rays_a, rays_b;
    assert_ok(fibrad_exchange_row(p->scene, kept, i, &rule, &a, &rays_a));
    assert_ok(fibrad_exchange_row(p->scene, &fresh, i, &rule, &b, &rays_b));
    ck_assert(same_bits_with(&a, &b, WALLS));
    ck_assert_uint_eq(rays_a, rays_b);
    work_free(&fresh), fresh = work_growing();
    assert_ok(displacement_of(p->scene, kept, i, &rule, &da));
    assert_ok(displacement_of(p->scene, &fresh, i, &rule, &db));
    ck_assert_mem_eq(&da, &db, sizeof da);
    work_free(&fresh), fresh = work_growing();
    assert_ok(fibrad_cast_row(p->scene, kept, i, NULL, &a, NULL));
    assert_ok(fibrad_cast_row(p->scene, &fresh, i, NULL, &b, NULL));
    ck_assert(same_bits_with(&a, &b, WALLS));
    work_free(&fresh), fresh = work_growing();
    assert_ok(fibrad_beam_row(p->scene, kept, i, NULL, &a));
    assert_ok(fibrad_beam_row(p->scene, &fresh, i, NULL, &b));
    ck_assert(same_bits_with(&a, &b, WALLS));
}

TEST(work_serves_while_scenes_change) {
    const struct contents c = contents_of(20);
    ENDED struct problem *p = begin_problem(&c, 0);
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
}

/* The block of work memory is exchanged for another, moved, overwritten by the caller's realloc, or made smaller. */
TEST(work_serves_in_another_block) {
    const struct contents c = contents_of(21);
    ENDED struct problem *p = begin_problem(&c, 0);
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
    for (; size > 180000; size -= size / 8) { /* rows with reflections need some 180 KB at least */
        work.memory.size = size;
        assert_row_as_fresh(p, &work, 3);
    }
    free(block);
}

static fibrad_rows rows_from(const fibrad_scene *scene, uint32_t begin, uint32_t end) {
    OWNED_WORK work = work_growing();
    fibrad_rows rows = {.memory = memory_growing()};
    for (uint32_t i = begin; i < end; i++)
        assert_ok(fibrad_beam_row(scene, &work, i, NULL, &(fibrad_row){.rows = &rows}));
    return rows;
}

TEST(matrix_calls_out_of_order_are_refused) {
    const struct contents c = contents_of(22);
    ENDED struct problem *p = begin_problem(&c, 0);
    OWNED_ROWS rows = rows_from(p->scene, 0, N);
    OWNED_MATRIX book = matrix_of(p->scene, &rows, 1, NULL);
    const fibrad_matrix_rule rule = {.tasks = 5};
    const size_t size = fibrad_matrix_size(p->scene, &rows, 1, &rule);
    OWNED void *block = block_of(size);
    fibrad_matrix *m = NULL;
    fibrad_factors factors = {.n = 77};
    double largest = 77;
    memset(block, 0xff, size);
    assert_ok(fibrad_matrix_init(&m, block, size, p->scene, &rows, 1, &rule, NULL));
    ck_assert_int_eq(fibrad_matrix_read(m, &factors), FIBRAD_E_STATE);
    ck_assert_int_eq(fibrad_matrix_reciprocity(m, &largest), FIBRAD_E_STATE);
    ck_assert_uint_eq(factors.n, 77);
    ck_assert_double_eq(largest, 77);
    assert_ok(fibrad_matrix_close(m));
    ck_assert_int_eq(fibrad_matrix_close(m), FIBRAD_E_STATE);
    assert_ok(fibrad_matrix_read(m, &factors));
    ck_assert(matrix_same_bits(&factors, &book.factors));
    assert_ok(fibrad_matrix_reciprocity(m, &largest));
}

/* Rows are missing, are in two collections at once or twice in one, or belong to something else. */
TEST(wrong_rows_make_no_matrix) {
    const struct contents c = contents_of(23);
    ENDED struct problem *p = begin_problem(&c, 0);
    fibrad_rows rows[4] = {rows_from(p->scene, 0, 5), rows_from(p->scene, 5, N), rows_from(p->scene, 4, 6)};
    rows[3] = rows_from(p->scene, 0, N);
    OWNED_MATRIX book = matrix_of(p->scene, rows, 2, NULL);
    const size_t size = fibrad_matrix_size(p->scene, rows, 4, NULL);
    OWNED void *block = block_of(size);
    fibrad_matrix *m = NULL;
    uint32_t sphere = 77;
    ck_assert_int_eq(fibrad_matrix_init(&m, block, size, p->scene, rows, 1, NULL, &sphere), FIBRAD_E_STATE);
    ck_assert_uint_eq(sphere, 5);
    ck_assert_int_eq(fibrad_matrix_init(&m, block, size, p->scene, rows + 1, 1, NULL, &sphere), FIBRAD_E_STATE);
    ck_assert_uint_eq(sphere, 0);
    ck_assert_int_eq(fibrad_matrix_init(&m, block, size, p->scene, NULL, 0, NULL, &sphere), FIBRAD_E_STATE);
    for (int raw = 0; raw < 2; raw++) { /* a raw matrix may lack rows, but must not have them twice */
        const fibrad_matrix_rule rule = {.raw = raw};
        ck_assert_int_eq(fibrad_matrix_init(&m, block, size, p->scene, rows, 3, &rule, &sphere), FIBRAD_E_STATE);
        ck_assert(sphere == 4 || sphere == 5);
        ck_assert_int_eq(fibrad_matrix_init(&m, block, size, p->scene, rows, 3, &rule, NULL), FIBRAD_E_STATE);
        ck_assert_int_eq(fibrad_matrix_init(&m, block, size, p->scene, rows + 1, 3, &rule, &sphere), FIBRAD_E_STATE);
    }
    fibrad_row again = matrix_row(&book.factors, 2);
    assert_ok(fibrad_rows_add(&rows[0], &again, WALLS));
    ck_assert_int_eq(fibrad_matrix_init(&m, block, size, p->scene, rows, 2, NULL, &sphere), FIBRAD_E_STATE);
    ck_assert_uint_eq(sphere, 2);

    /* these rows have other walls, more spheres, or spheres that do not exist */
    for (int what = 0; what < 3; what++) {
        OWNED_ROWS wrong = {.memory = memory_growing()};
        fibrad_row row = matrix_row(&book.factors, 0);
        if (what == 1) row.sphere = N;
        uint32_t col[] = {1, N};
        double f[] = {.1, .1};
        if (what == 2) row.col = col, row.f = f, row.length = 2;
        assert_ok(fibrad_rows_add(&wrong, &row, what == 0 ? 2 : WALLS));
        ck_assert_uint_eq(fibrad_matrix_size(p->scene, &wrong, 1, &(fibrad_matrix_rule){.raw = 1}), 0);
        assert_invalid(fibrad_matrix_init(&m, block, size, p->scene, &wrong, 1, &(fibrad_matrix_rule){.raw = 1}, NULL));
    }
    ck_assert_ptr_null(m);

    /* after the collection was emptied and filled again, the matrix is right */
    fibrad_rows_clear(&rows[0]);
    ck_assert_uint_eq(rows[0].count, 0);
    OWNED_WORK work = work_growing();
    for (uint32_t i = 5; i-- > 0;) assert_ok(fibrad_beam_row(p->scene, &work, i, NULL, &(fibrad_row){.rows = rows}));
    OWNED_MATRIX right = matrix_of(p->scene, rows, 2, NULL);
    ck_assert(matrix_same_bits(&right.factors, &book.factors));
    for (int k = 0; k < 4; k++) rows_free(&rows[k]);
}

/* A row that is refused leaves a collection as it was. */
TEST(refused_rows_are_not_appended) {
    const struct contents c = contents_of(24);
    ENDED struct problem *p = begin_problem(&c, 0);
    static unsigned char memory[1 << 12];
    fibrad_rows rows = {.memory = {.block = memory, .size = sizeof memory}};
    fibrad_work work = work_growing(), none = {0};
    uint32_t before = 0;
    for (uint32_t i = 0; i < N; i++) {
        fibrad_row row = {.rows = &rows};
        ck_assert_int_eq(fibrad_beam_row(p->scene, &none, i, NULL, &row), FIBRAD_E_WORK);
        assert_invalid(fibrad_beam_row(p->scene, &work, N, NULL, &row));
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
    OWNED_MATRIX m = matrix_of(p->scene, &rows, 1, &(fibrad_matrix_rule){.raw = 1});
    for (uint32_t i = 0; i < before; i++) ck_assert_double_eq_tol(matrix_total(&m.factors, i), 1, 1e-12);
    work_free(&work);
}

/* A row was appended to a collection, so its factors lie there. If it is then used without the collection, its capacity
 * says that it has no arrays of its own. */
TEST(a_row_may_be_used_again_after_appending) {
    OWNED_BED bed = packing(60, .8, 1.2, .5, 3, false);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    OWNED_WORK work = work_growing();
    fibrad_rows rows = {.memory = work_growing().memory};
    uint32_t col[60];
    double f[60];
    fibrad_row row = {.col = col, .f = f, .capacity = 60, .rows = &rows};
    assert_ok(fibrad_beam_row(scene, &work, 0, NULL, &row));
    const double first = row.f[0];
    row.rows = NULL;
    ck_assert_int_eq(fibrad_beam_row(scene, &work, 1, NULL, &row), FIBRAD_E_CAPACITY);
    ck_assert_double_eq(row.f[0], first);
    free(rows.memory.block);
}

/* The rows are those of another scene, they change while their matrix is made, or a matrix failed in place. */
TEST(rows_that_change_make_no_matrix) {
    OWNED_BED bed = packing(60, .8, 1.2, .5, 3, false), other = packing(60, .8, 1.2, .5, 4, false);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST), *another = scene_of(&other, FIBRAD_ISA_BEST);
    fibrad_rows rows = rows_from(scene, 0, 60), more = rows_from(scene, 0, 1), fewer = rows_from(scene, 1, 60);
    fibrad_matrix *matrix;
    uint32_t sphere = 99;
    const size_t size = fibrad_matrix_size(scene, &rows, 1, NULL);
    void *block = malloc(size);
    ck_assert_int_eq(fibrad_matrix_init(&matrix, block, size, another, &rows, 1, NULL, &sphere), FIBRAD_E_STATE);
    ck_assert_uint_eq(sphere, 0);
    assert_ok(fibrad_matrix_init(&matrix, block, size, scene, &rows, 1, NULL, NULL));
    fibrad_rows_clear(&rows);
    ck_assert_int_eq(fibrad_matrix_close(matrix), FIBRAD_E_STATE);
    fibrad_matrix *again = NULL;
    ck_assert_int_eq(fibrad_matrix_init(&again, block, size, scene, &fewer, 1, NULL, &sphere), FIBRAD_E_STATE);
    ck_assert(again == NULL && sphere == 0);
    ck_assert_int_eq(fibrad_matrix_close(matrix), FIBRAD_E_STATE);
    const fibrad_rows both[] = {more, fewer};
    assert_ok(fibrad_matrix_init(&matrix, block, size, scene, both, 2, NULL, NULL));
    assert_ok(fibrad_matrix_close(matrix));
    free(block);
    free(rows.memory.block), free(more.memory.block), free(fewer.memory.block);
}
