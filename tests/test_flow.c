/* test_flow.c - powers from rows, and the errors of these functions. SPDX-License-Identifier: MIT */
#include "part_beds.h"

struct powers {
    fibrad_flow flow;
    double *weight, *emission, *power, wall_emission[WALLS_MOST], wall_power[WALLS_MOST];
};

static struct powers powers_of(const struct bed *bed, const double *emissivity) {
    struct powers p = {.weight = calloc(bed->n, sizeof(double)),
                       .emission = calloc(bed->n, sizeof(double)),
                       .power = calloc(bed->n, sizeof(double))};
    fibrad_random random = fibrad_random_start(2, 3);
    for (uint32_t i = 0; i < bed->n; i++) {
        p.weight[i] = 4 * 3.14159265358979323846 * bed->r[i] * bed->r[i] * emissivity[i];
        p.emission[i] = 100 + 900 * fibrad_random_next(&random);
    }
    for (int b = 0; b < WALLS_MOST; b++) p.wall_emission[b] = 300 + 100 * b;
    p.flow.surroundings_emission = 77;
    return p;
}

static void powers_point(struct powers *p) {
    p->flow.weight = p->weight, p->flow.emission = p->emission, p->flow.power = p->power;
    p->flow.wall_emission = p->wall_emission, p->flow.wall_power = p->wall_power;
}

static void powers_free(struct powers *p) { free(p->weight), free(p->emission), free(p->power); }

#define OWNED_POWERS OWNED_BY(powers_free) struct powers

static fibrad_rows exchange_rows(const fibrad_scene *scene, uint32_t n, const fibrad_exchange_rule *rule) {
    OWNED_WORK work = work_growing();
    fibrad_rows rows = {.memory = memory_growing()};
    for (uint32_t i = 0; i < n; i++)
        assert_ok(fibrad_exchange_row(scene, &work, i, rule, &(fibrad_row){.rows = &rows}, NULL));
    return rows;
}

/* Powers add up to zero. Nothing flows between equals. A part of the rows gives a part of the powers. */
TEST(what_one_gains_others_lose) {
    OWNED_BED bed = packing(60, .6, 1, .5, 9, false);
    const fibrad_wall wall[] = {plane_at(2, 0, -1), plane_at(0, 0, -1)};
    const fibrad_plane open[] = {{0, 1, 9}, {1, 0, -2}, {1, 1, 9}, {2, 1, 9}};
    OWNED fibrad_scene *scene =
        scene_with(&bed, &(fibrad_scene_config){.wall = wall, .walls = 2, .opening = open, .openings = 4});
    double e[60];
    for (int i = 0; i < 60; i++) e[i] = .4 + .01 * i;
    OWNED_ROWS rows = exchange_rows(
        scene, bed.n,
        &(fibrad_exchange_rule){.emissivity = e, .wall_emissivity = wall_emissivity, .seed = 5, .cutoff = 3});
    OWNED_POWERS p = powers_of(&bed, e);
    powers_point(&p);
    assert_ok(fibrad_rows_flow(&rows, bed.n, 2, &p.flow));
    double sum = p.flow.surroundings_power + p.wall_power[0] + p.wall_power[1], size = fabs(sum);
    for (uint32_t i = 0; i < bed.n; i++) sum += p.power[i], size += fabs(p.power[i]);
    ck_assert_double_eq_tol(sum / size, 0, 1e-14);
    ck_assert(p.power[0] != 0 && p.wall_power[0] != 0 && p.wall_power[1] != 0 && p.flow.surroundings_power != 0);
    /* the second call adds to the powers of the first */
    OWNED_POWERS twice = powers_of(&bed, e);
    powers_point(&twice);
    for (int k = 0; k < 2; k++) assert_ok(fibrad_rows_flow(&rows, bed.n, 2, &twice.flow));
    for (uint32_t i = 0; i < bed.n; i++) ck_assert_double_eq_tol(twice.power[i], 2 * p.power[i], 1e-12 * size);
    /* row by row, by hand */
    double *expected = calloc(bed.n, sizeof *expected);
    const struct matrix raw = matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.raw = 1});
    for (uint32_t i = 0; i < bed.n; i++) {
        const fibrad_row row = matrix_row(&raw.factors, i);
        ck_assert_double_gt(row.beyond, 0);
        const double weight = p.weight[i] / (1 - row.beyond);
        for (uint32_t k = 0; k < row.length; k++) {
            const double gained = .5 * weight * row.f[k] * (p.emission[row.col[k]] - p.emission[i]);
            expected[i] += gained, expected[row.col[k]] -= gained;
        }
        for (int b = 0; b < 2; b++) expected[i] += weight * row.wall[b] * (p.wall_emission[b] - p.emission[i]);
        expected[i] += weight * row.escaped * (77 - p.emission[i]);
    }
    for (uint32_t i = 0; i < bed.n; i++) ck_assert_double_eq_tol(p.power[i], expected[i], 1e-13 * size);
    /* equals */
    OWNED_POWERS same = powers_of(&bed, e);
    powers_point(&same);
    for (uint32_t i = 0; i < bed.n; i++) same.emission[i] = 77;
    for (int b = 0; b < 2; b++) same.wall_emission[b] = 77;
    assert_ok(fibrad_rows_flow(&rows, bed.n, 2, &same.flow));
    for (uint32_t i = 0; i < bed.n; i++) ck_assert_double_eq(same.power[i], 0);
    ck_assert(same.wall_power[0] == 0 && same.wall_power[1] == 0 && same.flow.surroundings_power == 0);
    free(expected), free((void *)(uintptr_t)raw.matrix);
}

/* In a closed box with spheres alone, the powers are those of the averaged matrix. */
TEST(powers_are_those_of_the_averaged_matrix) {
    OWNED_BED bed = packing(80, .7, 1, .5, 3, true);
    OWNED fibrad_scene *scene = scene_of(&bed, FIBRAD_ISA_BEST);
    double e[80];
    for (int i = 0; i < 80; i++) e[i] = .5 + .005 * i;
    OWNED_ROWS rows = exchange_rows(scene, bed.n, &(fibrad_exchange_rule){.emissivity = e});
    OWNED_POWERS p = powers_of(&bed, e);
    powers_point(&p);
    assert_ok(fibrad_rows_flow(&rows, bed.n, 0, &p.flow));
    const struct matrix m =
        matrix_of(scene, &rows, 1, &(fibrad_matrix_rule){.kind = FIBRAD_ROWS_EXCHANGE, .emissivity = e});
    double largest = 0;
    for (uint32_t i = 0; i < bed.n; i++) largest = fmax(largest, fabs(p.power[i]));
    for (uint32_t i = 0; i < bed.n; i++) {
        const fibrad_row row = matrix_row(&m.factors, i);
        double power = 0;
        for (uint32_t k = 0; k < row.length; k++)
            power += p.weight[i] * row.f[k] * (p.emission[row.col[k]] - p.emission[i]);
        ck_assert_double_eq_tol(p.power[i], power, .02 * largest); /* in the matrix, too, sums are those of raw rows */
    }
    free((void *)(uintptr_t)m.matrix);
}

TEST(bad_occupancies_are_refused) {
    OWNED_BED bed = BED({0, 0, 0, 1}, {0, 0, 3, 1});
    OWNED_PART p = part_of(&bed, (fibrad_scene_config){0});
    const uint64_t mark[1] = {1};
    const fibrad_occupancy good = {.high = {1, 1, 1}, .cells = {4, 4, 4}, .mark = mark};
    fibrad_occupancy o[9];
    for (int k = 0; k < 9; k++) o[k] = good;
    o[1].high[1] = 0, o[2].low[2] = NAN, o[3].high[0] = INFINITY, o[4].cells[0] = 0, o[5].cells[2] = (1 << 20) + 1;
    o[6].periodic[1] = 2, o[7].low[0] = 2, o[8].low[1] = -2e150;
    fibrad_scene *scene;
    for (int k = 0; k < 9; k++) {
        p.config.occupancy = &o[k];
        ck_assert_int_eq(part_scene_try(&p, &scene), k == 0 ? FIBRAD_OK : FIBRAD_E_ARGUMENT);
        if (k == 0) free(scene);
    }
}

/* Whatever a scene is made from tells it from other scenes. Rows of one do not go into a matrix of another. */
TEST(surroundings_tell_scenes_apart) {
    OWNED_BED bed = BED({0, 0, 0, 1}, {0, 0, 3, 1});
    OWNED_PART p = part_of(&bed, (fibrad_scene_config){0});
    uint64_t mark[2] = {1, 0};
    fibrad_occupancy o = {.high = {1, 1, 1}, .cells = {4, 4, 8}};
    fibrad_scene *scene[5];
    for (int k = 0; k < 5; k++) {
        if (k == 1) p.config.occupancy = &o;
        if (k == 2) o.mark = mark;
        if (k == 3) mark[1] = 1;
        if (k == 4) o.periodic[2] = 1;
        scene[k] = part_scene(&p);
    }
    for (int k = 0; k < 5; k++) {
        OWNED_ROWS rows = rows_by_beams(scene[k], &(fibrad_beam_rule){.directions = 8});
        static unsigned char block[1 << 12];
        for (int other = 0; other < 5; other++) {
            fibrad_matrix *matrix;
            ck_assert_int_eq(fibrad_matrix_init(&matrix, block, sizeof block, scene[other], &rows, 1, NULL, NULL),
                             other == k ? FIBRAD_OK : FIBRAD_E_STATE);
        }
    }
    for (int k = 0; k < 5; k++) free(scene[k]);
}

TEST(an_entry_counts_alone_if_the_other_row_is_older) {
    OWNED_BED bed = BED({0, 0, 0, 1}, {0, 0, 3, 1});
    uint32_t col[] = {0};
    double f[] = {.25}, e[] = {1, .5}, made[] = {7, 7};
    OWNED_ROWS rows = {.memory = memory_growing()};
    const fibrad_row row = {.col = col, .f = f, .length = 1, .sphere = 1, .escaped = .75};
    assert_ok(fibrad_rows_add(&rows, &row, 0));
    double moved[3];
    for (int k = 0; k < 3; k++) {
        OWNED_POWERS p = powers_of(&bed, e);
        powers_point(&p);
        p.flow.made = k > 0 ? made : NULL, made[1] = 6 + k;
        p.flow.surroundings_emission = p.emission[1];
        assert_ok(fibrad_rows_flow(&rows, 2, 0, &p.flow));
        moved[k] = p.power[1];
        ck_assert_double_eq_tol(moved[k], (k == 2 ? 1 : .5) * p.weight[1] * .25 * (p.emission[0] - p.emission[1]),
                                1e-15);
        ck_assert(p.power[0] == -p.power[1] && p.power[1] != 0);
    }
    ck_assert(moved[1] == moved[0] && moved[2] == 2 * moved[0]);
}

TEST(bad_flows_are_refused) {
    OWNED_BED bed = BED({0, 0, 0, 1}, {0, 0, 3, 1});
    uint32_t col[] = {0, 1};
    double f[] = {.1, .2}, wall[] = {.3}, e[] = {1, 1};
    OWNED_ROWS rows = {.memory = memory_growing()};
    fibrad_row row = {.col = col, .f = f, .wall = wall, .length = 2, .sphere = 1, .escaped = .1, .beyond = .3};
    assert_ok(fibrad_rows_add(&rows, &row, 1));
    OWNED_POWERS p = powers_of(&bed, e);
    powers_point(&p);
    fibrad_flow flow = p.flow;
    assert_invalid(fibrad_rows_flow(NULL, 2, 1, &flow));
    assert_invalid(fibrad_rows_flow(&rows, 2, 1, NULL));
    assert_invalid(fibrad_rows_flow(&rows, 1, 1, &flow));
    assert_invalid(fibrad_rows_flow(&rows, 2, 2, &flow));
    assert_invalid(fibrad_rows_flow(&rows, 2, 0, &flow));
    double *const nan_of[] = {&p.weight[1], &p.emission[0], &p.wall_emission[0], &flow.surroundings_emission};
    for (int k = 0; k < 4; k++)
        for (int infinite = 0; infinite < 2; infinite++) {
            const double before = *nan_of[k];
            *nan_of[k] = infinite ? INFINITY : NAN;
            assert_invalid(fibrad_rows_flow(&rows, 2, 1, &flow));
            *nan_of[k] = before;
        }
    p.weight[0] = NAN; /* no row needs this weight */
    for (int k = 0; k < 5; k++) {
        fibrad_flow bad = flow;
        if (k == 0) bad.weight = NULL;
        if (k == 1) bad.emission = NULL;
        if (k == 2) bad.power = NULL;
        if (k == 3) bad.wall_emission = NULL;
        if (k == 4) bad.wall_power = NULL;
        assert_invalid(fibrad_rows_flow(&rows, 2, 1, &bad));
    }
    ck_assert(p.power[0] == 0 && p.power[1] == 0 && flow.surroundings_power == 0 && p.wall_power[0] == 0);
    assert_ok(fibrad_rows_flow(&rows, 2, 1, &flow));
    ck_assert(p.power[0] != 0 && isfinite(p.power[0] + p.power[1]));
    /* a row that knows nothing adds nothing */
    fibrad_rows_clear(&rows);
    row = (fibrad_row){.sphere = 0, .beyond = 1, .wall = (double[]){0}};
    assert_ok(fibrad_rows_add(&rows, &row, 1));
    p.weight[0] = 1, p.power[0] = p.power[1] = 5;
    assert_ok(fibrad_rows_flow(&rows, 2, 1, &flow));
    ck_assert(p.power[0] == 5 && p.power[1] == 5);
    /* no rows, no spheres */
    assert_ok(fibrad_rows_flow(&(fibrad_rows){0}, 0, 0, &(fibrad_flow){0}));
}
