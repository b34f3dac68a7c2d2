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
    const double bad_values[] = {NAN, -1};
    for (int what = 0; what < 10; what++) {
        fibrad_heat_sources s = good;
        const double **const arrays[] = {&s.temperature, &s.emissivity, &s.wall_temperature, &s.wall_emissivity};
        double *const values[] = {&s.surroundings, &s.sigma, &s.tolerance};
        if (what < 4) *arrays[what] = NULL;
        if (what >= 4) *values[what % 3] = bad_values[what % 2];
        ck_assert_msg(fibrad_heat_begin(p->heat, &s) == FIBRAD_E_ARGUMENT, "sources %d", what);
    }
    double *const arrays[] = {p->temperature, p->emissivity, p->wall_temperature, p->wall_emissivity};
    static const double bad[] = {NAN, -1e-300, -1, INFINITY, 1.0000001};
    for (int a = 0; a < 4; a++)
        for (size_t k = 0; k < (a % 2 == 0 ? 4 : 5); k++) { /* temperatures may be above 1 */
            const uint32_t last = (a < 2 ? N : WALLS) - 1;
            const double was = arrays[a][last];
            arrays[a][last] = bad[k];
            assert_invalid(fibrad_heat_begin(p->heat, &p->sources));
            arrays[a][last] = was;
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

/* At each stage the scene is rebuilt with other contents of each kind, and then as it was. */
TEST(other_contents_in_place) {
    const struct contents c = contents_of(13);
    ENDED struct problem *book = by_the_book(&c), *p = begin_problem(&c, 0);
    for (int stage = MADE; stage < STAGES; stage++) {
        advance_to(p, stage - 1, stage);
        for (int what = 0; what < CHANGES; what++) {
            const struct contents other = changed(&c, what);
            build(p, &other);
            assert_other_scene(p);
            build(p, &c);
        }
    }
    assert_ok(fibrad_heat_read(p->heat, &p->result));
    assert_same_powers(p, book);
}

/* What stands in the place of a scene that could not be made anew gives nothing. */
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

static fibrad_rows rows_from(const fibrad_scene *scene, uint32_t begin, uint32_t end) {
    OWNED_WORK work = work_growing();
    fibrad_rows rows = {.memory = memory_growing()};
    for (uint32_t i = begin; i < end; i++)
        assert_ok(fibrad_beam_row(scene, &work, i, NULL, &(fibrad_row){.rows = &rows}));
    return rows;
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
