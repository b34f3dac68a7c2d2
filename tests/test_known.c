/* test_known.c - paths from walls and openings, and what they tell rows of spheres: closed forms, reciprocity,
 * balances. SPDX-License-Identifier: MIT */
#include "grey_rules.h"
#include "rectangles.h"
#include "scenes.h"
#include "suite.h"
#include "meshes.h"

enum { SPHERES = 30, DIRECTIONS = 300, KINDS = 4 };

/* Unequal spheres among walls and an opening. Kind 0: a box. 1: a cylinder. 2: a box with a mesh. 3: a box with spheres
 * that conduct. */
struct hall {
    struct bed bed;
    struct mesh *mesh;
    fibrad_wall wall[7];
    uint32_t walls;
    fibrad_plane opening[2];
    uint32_t openings;
    double e[SPHERES], node[SPHERES], conductivity[SPHERES], wall_e[7];
    fibrad_scene *scene;
    fibrad_work work;
    fibrad_exchange_rule rule;
};

static void hall_free(struct hall **hall) {
    bed_free(&(*hall)->bed), work_free(&(*hall)->work);
    free((*hall)->mesh), free((*hall)->scene), free(*hall);
}

#define OWNED_HALL OWNED_BY(hall_free) struct hall

static bool is_free(const struct hall *h, int kind, const double c[3], double r) {
    if (kind == 1 && hypot(c[0] - 2, c[1] - 2) + r > 2) return false;
    if (kind == 2 && fabs(c[2] - 2) < r) return false;
    for (uint32_t j = 0; j < h->bed.n; j++)
        if (pow(c[0] - h->bed.x[j], 2) + pow(c[1] - h->bed.y[j], 2) + pow(c[2] - h->bed.z[j], 2) <
            pow(r + h->bed.r[j], 2))
            return false;
    return true;
}

static void add_mesh(struct hall *h) {
    h->mesh = mesh_new();
    const uint32_t v[4] = {mesh_vertex(h->mesh, .5, 1, 2), mesh_vertex(h->mesh, 3, 1, 2), mesh_vertex(h->mesh, 3, 3, 2),
                           mesh_vertex(h->mesh, .5, 3, 2)};
    mesh_quad(h->mesh, v, h->walls, h->walls);
    h->wall[h->walls++] = h->mesh->wall[0];
}

/* What bounds the space from 0 to 4 along each axis. */
static void add_bounds(struct hall *h, int kind) {
    if (kind == 1) h->wall[h->walls++] = cylinder_at(2, 2, 2);
    for (int face = kind == 1 ? 4 : 0; face < 6; face++)
        if (face == 1 || face == 5)
            h->opening[h->openings++] = (fibrad_plane){face / 2, 1, 4};
        else
            h->wall[h->walls++] = plane_at(face / 2, face % 2, face % 2 * 4);
    if (kind == 2) add_mesh(h);
}

static struct hall *make_hall(int kind) {
    static const double of_wall[] = {.3, .8, 0, 1, .5, .1, .6}, walls_of_tube[] = {.2, .7};
    struct hall *h = calloc(1, sizeof *h);
    h->bed = bed_empty();
    add_bounds(h, kind);
    for (uint64_t k = 0; h->bed.n < SPHERES; k++) {
        const double r = .25 + .25 * bed_make_random(7, 4 * k);
        double c[3];
        for (uint32_t a = 0; a < 3; a++) c[a] = r + (4 - 2 * r) * bed_make_random(7, 4 * k + 1 + a);
        if (is_free(h, kind, c, r)) add_sphere(&h->bed, c[0], c[1], c[2], r);
    }
    memcpy(h->wall_e, kind == 1 ? walls_of_tube : of_wall, h->walls * sizeof *h->wall_e);
    for (uint32_t i = 0; i < SPHERES; i++) {
        h->e[i] = i % 2 ? .8 : .3, h->conductivity[i] = .2 + i % 3;
        h->node[i] = fibrad_node_emissivity(h->e[i], h->conductivity[i]);
    }
    fibrad_scene_config config = {.wall = h->wall, .walls = h->walls, .opening = h->opening, .openings = h->openings};
    config.triangles = h->mesh ? &h->mesh->triangles : NULL;
    h->scene = scene_with(&h->bed, &config);
    h->work = work_growing();
    h->rule = (fibrad_exchange_rule){.emissivity = h->e, .wall_emissivity = h->wall_e, .directions = DIRECTIONS};
    if (kind == 3) h->rule.conductivity = h->conductivity, h->rule.node_emissivity = h->node;
    return h;
}

static double sphere_emits(const struct hall *h, uint32_t i) {
    return 4 * PI * h->bed.r[i] * h->bed.r[i] * (h->rule.node_emissivity ? h->node : h->e)[i];
}

static fibrad_row row_in(struct hall *h, uint32_t i) {
    fibrad_row row = row_of(SPHERES);
    assert_ok(fibrad_exchange_row(h->scene, &h->work, i, &h->rule, &row, NULL));
    return row;
}

/* What a row gives to wall b, or to the surroundings. */
static double given(const struct hall *h, const fibrad_row *row, uint32_t b) {
    return b < h->walls ? row->wall[b] : row->escaped;
}

/* The sum of a row is 1, and nothing is below 0. */
static void check_row(const struct hall *h, const fibrad_row *row) {
    double sum = row_sum(row) + row->beyond;
    for (uint32_t b = 0; b <= h->walls; b++) {
        sum += given(h, row, b);
        ck_assert_double_ge(given(h, row, b), 0);
    }
    for (uint32_t k = 0; k < row->length; k++) ck_assert_double_ge(row->f[k], 0);
    ck_assert_double_eq_tol(sum, 1, 1e-12);
}

/* ---- rows of spheres -------------------------------------------------------------------------------------------- */

LOOP_TEST(nothing_known, KINDS) {
    OWNED_HALL *h = make_hall(_i);
    double known[8];
    for (int b = 0; b < 8; b++) known[b] = NAN;
    for (uint32_t i = 0; i < SPHERES; i += 7) {
        h->rule.known = NULL;
        OWNED_ROW without = row_in(h, i);
        h->rule.known = known, h->rule.known_paths = 1000;
        OWNED_ROW with = row_in(h, i);
        ck_assert(same_bits_with(&without, &with, h->walls));
        ck_assert_double_eq(with.escaped, without.escaped);
    }
}

/* What a row gives after the first segment, or what the first segment gives: to each wall, the surroundings, each
 * sphere. */
enum { TARGETS = 8 + SPHERES };

/* Among black surfaces there is no more than the first segment. */
static void first_segment(struct hall *h, uint32_t i, double *direct) {
    OWNED_ROW beam = row_of(SPHERES);
    double black[SPHERES];
    for (uint32_t j = 0; j < SPHERES; j++) black[j] = 1;
    const fibrad_exchange_rule rule = {
        .emissivity = black, .wall_emissivity = black, .directions = DIRECTIONS, .seed = h->rule.seed};
    const double *e = h->rule.node_emissivity ? h->node : h->e;
    assert_ok(fibrad_exchange_row(h->scene, &h->work, i, &rule, &beam, NULL));
    for (uint32_t b = 0; b <= h->walls; b++) direct[b] = given(h, &beam, b) * (b < h->walls ? h->wall_e[b] : 1);
    for (uint32_t j = 0; j < SPHERES; j++) direct[8 + j] = row_factor(&beam, j) * e[j];
}

static void reflected_part(struct hall *h, uint32_t i, double *reflected) {
    double direct[TARGETS] = {0};
    OWNED_ROW row = row_in(h, i);
    check_row(h, &row);
    first_segment(h, i, direct);
    for (uint32_t b = 0; b <= h->walls; b++) reflected[b] = given(h, &row, b) - direct[b];
    for (uint32_t j = 0; j < SPHERES; j++) reflected[8 + j] = row_factor(&row, j) - direct[8 + j];
}

/* What paths of a row and others give after the first segment is weighed with their numbers. If there are very many
 * others, what they say holds. Spheres and walls that are not known share the rest, in the proportions of the row's own
 * paths.
 */
LOOP_TEST(known_is_pooled, 2 * KINDS) {
    enum { PATHS = 500 };
    OWNED_HALL *h = make_hall(_i / 2);
    const double others = _i % 2 ? 1500 : 1e13;
    h->rule.paths = PATHS;
    for (uint32_t i = 0; i < SPHERES; i += 3) {
        double known[TARGETS], own[TARGETS] = {0}, pooled[TARGETS] = {0}, rest = 0, left = 0;
        for (uint32_t b = 0; b < TARGETS; b++)
            known[b] = (i + b) % 4 == 0 || b > h->walls ? NAN : others * .01 * bed_make_random(i, b);
        h->rule.known = NULL;
        reflected_part(h, i, own);
        h->rule.known = known, h->rule.known_paths = others;
        reflected_part(h, i, pooled);
        for (uint32_t b = 0; b < TARGETS; b++)
            if (isnan(known[b])) rest += own[b], left += pooled[b];
        for (uint32_t b = 0; b < TARGETS; b++) {
            const double mean = (PATHS * own[b] + known[b]) / (PATHS + others);
            ck_assert_double_eq_tol(pooled[b], isnan(known[b]) ? own[b] * left / rest : mean, 1e-12);
            if (others > 1e12 && !isnan(known[b])) ck_assert_double_eq_tol(pooled[b], known[b] / others, 1e-9);
        }
    }
}

/* Whatever others claim, rows add up to 1 and have no entry below 0. */
LOOP_TEST(any_claim, KINDS) {
    static const double claim[] = {0, 1e-300, 1, 30, 1e4, 1e12, 1e300, INFINITY, NAN, -1}, number[] = {0, 1, 1e3, 1e14};
    OWNED_HALL *h = make_hall(_i);
    h->rule.paths = 50;
    for (uint32_t k = 0; k < 400; k++) {
        double known[8];
        for (uint32_t b = 0; b < 8; b++) known[b] = claim[(uint32_t)(10 * bed_make_random(k, b))];
        for (uint32_t b = 0; b < 8 && k % 10 == 0; b++) known[b] = claim[k / 10 % 10];
        h->rule.known = known, h->rule.known_paths = number[k % 4];
        OWNED_ROW row = row_in(h, k % SPHERES);
        check_row(h, &row);
    }
}

/* A lone sphere in a box gets nothing back if few paths are followed. Then walls take all, in the proportions of what
 * is known of them. */
TEST(all_is_known) {
    OWNED_BED bed = BED({1, 2, 2, .01});
    fibrad_wall wall[6];
    for (int k = 0; k < 6; k++) wall[k] = plane_at(k / 2, k % 2, k % 2 * 4);
    OWNED fibrad_scene *scene = scene_with(&bed, &(fibrad_scene_config){.wall = wall, .walls = 6});
    OWNED_WORK work = work_growing();
    const double e[1] = {.5}, wall_e[6] = {.1, .3, .7, .9, .6, .37};
    for (uint64_t seed = 0; seed < 30; seed++) {
        const int much = (int)(seed % 3);
        double known[7] = {.1, .7, .3, .9, .2, .11, 0}, sum = 0, left = 1;
        for (int b = 0; b < 6; b++) known[b] *= much ? pow(100, much) : 0;
        fibrad_exchange_rule rule = {.emissivity = e, .wall_emissivity = wall_e, .directions = DIRECTIONS, .paths = 37};
        rule.seed = seed, rule.known = known, rule.known_paths = much == 2 ? 1e9 : 400;
        OWNED_ROW row = row_of(1), beam = row_of(1);
        assert_ok(fibrad_exchange_row(scene, &work, 0, &rule, &row, NULL));
        const fibrad_beam_rule first = {.directions = DIRECTIONS, .turn = seed};
        assert_ok(fibrad_beam_row(scene, &work, 0, &first, &beam));
        ck_assert_double_eq(row_sum(&row), 0);
        for (int b = 0; b < 6; b++) sum += row.wall[b], left -= beam.wall[b] * wall_e[b];
        ck_assert_double_eq_tol(sum, 1, 1e-12);
        for (int b = 0; b < 6 && much == 2; b++)
            ck_assert_double_eq_tol(row.wall[b] - beam.wall[b] * wall_e[b], known[b] / 2.31e4 * left, 1e-2 * left);
    }
}

TEST(impossible_numbers_of_paths) {
    static const double impossible[] = {-1, NAN, INFINITY};
    OWNED_HALL *h = make_hall(0);
    const double known[8] = {1};
    OWNED_ROW row = row_of(SPHERES);
    for (int k = 0; k < 3; k++) {
        h->rule.known = known, h->rule.known_paths = impossible[k];
        assert_invalid(fibrad_exchange_row(h->scene, &h->work, 0, &h->rule, &row, NULL));
        h->rule.known = NULL;
        assert_ok(fibrad_exchange_row(h->scene, &h->work, 0, &h->rule, &row, NULL));
    }
}

/* ---- paths from walls and openings ------------------------------------------------------------------------------ */

/* What the source has given to a sphere after reflections, as a part of the sphere's emission: mean and its error. */
static void give_back(struct hall *h, uint32_t wall, double emits, double mean[SPHERES], double square[SPHERES]) {
    double part[FIBRAD_WALL_PARTS][SPHERES];
    h->rule.known = NULL, h->rule.paths = 131072;
    for (uint32_t p = 0; p < FIBRAD_WALL_PARTS; p++) {
        uint64_t reflected[SPHERES] = {0};
        fibrad_wall_row row;
        assert_ok(wall_of(h->scene, &h->work, wall, &h->rule, p, &row, reflected));
        for (uint32_t i = 0; i < SPHERES; i++)
            part[p][i] = (double)reflected[i] * 0x1p-40 / (131072.0 / FIBRAD_WALL_PARTS) * emits / sphere_emits(h, i);
    }
    for (uint32_t i = 0; i < SPHERES; i++) {
        double sum = 0, squares = 0;
        for (int p = 0; p < FIBRAD_WALL_PARTS; p++) sum += part[p][i] / FIBRAD_WALL_PARTS;
        for (int p = 0; p < FIBRAD_WALL_PARTS; p++) squares += pow(part[p][i] - sum, 2);
        mean[i] += sum, square[i] += squares / (FIBRAD_WALL_PARTS * (FIBRAD_WALL_PARTS - 1));
    }
}

static double wall_emits(const struct hall *h, uint32_t b) {
    return fibrad_scene_wall_area(h->scene, b) * (b < h->walls ? h->wall_e[b] : 1);
}

/* What walls and openings give to spheres after reflections is what spheres give to them, A_b e_b D_bi = A_i e_i D_ib.
 * The paths of a row are compared with those of each wall, and of all openings together. */
LOOP_TEST(sources_are_reciprocal, KINDS) {
    enum { SEEDS = 60, STEP = 6 };
    OWNED_HALL *h = make_hall(_i);
    double mean[8][SPHERES] = {{0}}, square[8][SPHERES] = {{0}}, all = 0, count = 0;
    for (uint32_t b = 0; b < h->walls; b++) give_back(h, b, wall_emits(h, b), mean[b], square[b]);
    for (uint32_t k = 0; k < h->openings; k++) {
        const uint32_t wall = FIBRAD_OPENING(h->walls, h->opening[k].axis, h->opening[k].upper);
        give_back(h, wall, wall_emits(h, wall), mean[h->walls], square[h->walls]);
    }
    h->rule.paths = 1000;
    for (uint32_t i = 0; i < SPHERES; i += STEP) {
        double sum[8] = {0}, squares[8] = {0};
        for (uint64_t seed = 0; seed < SEEDS; seed++) {
            double reflected[TARGETS];
            h->rule.seed = seed;
            reflected_part(h, i, reflected);
            for (uint32_t b = 0; b <= h->walls; b++) sum[b] += reflected[b], squares[b] += pow(reflected[b], 2);
        }
        for (uint32_t b = 0; b <= h->walls; b++) {
            const double average = sum[b] / SEEDS, spread = fmax(0, squares[b] / SEEDS - average * average);
            const double error = sqrt(spread / (SEEDS - 1) + square[b][i]), difference = average - mean[b][i];
            ck_assert_double_le(fabs(difference), 5 * error + 1e-15);
            if (error > 0) all += pow(difference / error, 2), count++;
            if (b == h->walls || h->wall_e[b] > 0) ck_assert_double_gt(average, 20 * error / 3);
        }
    }
    ck_assert_double_lt(all / count, 1.7); /* 1, but for the error of errors from 8 batches */
}

/* All spheres have the emissivity e, and walls are black. If all surfaces are black, spheres absorb the fraction H of
 * paths. So the first segment gives them e H, and what is left comes after reflections. Paths lose so little weight
 * that none ends by chance. */
TEST(reflected_is_what_first_segments_leave) {
    enum { PATHS = 8000 };
    OWNED_HALL *h = make_hall(0);
    uint64_t reflected[SPHERES] = {0}, more[SPHERES], units = 0;
    fibrad_wall_row black, grey;
    h->rule.paths = PATHS * FIBRAD_WALL_PARTS;
    for (uint32_t b = 0; b < h->walls; b++) h->wall_e[b] = 1;
    for (uint32_t k = 0; k < 2; k++) {
        const uint32_t wall = k ? FIBRAD_OPENING(h->walls, 0, 1) : 1;
        for (uint32_t i = 0; i < SPHERES; i++) h->e[i] = 1, reflected[i] = 0;
        assert_ok(wall_of(h->scene, &h->work, wall, &h->rule, 3, &black, reflected));
        for (uint32_t i = 0; i < SPHERES; i++) ck_assert_uint_eq(reflected[i], 0);
        for (uint32_t i = 0; i < SPHERES; i++) h->e[i] = .03, more[i] = 1000 * i + 1;
        assert_ok(wall_of(h->scene, &h->work, wall, &h->rule, 3, &grey, reflected));
        assert_ok(wall_of(h->scene, &h->work, wall, &h->rule, 3, &grey, more));
        units = 0;
        for (uint32_t i = 0; i < SPHERES; i++) {
            ck_assert_uint_eq(more[i], reflected[i] + 1000 * i + 1);
            units += reflected[i];
        }
        ck_assert_double_eq_tol((double)units * 0x1p-40 / PATHS, grey.spheres - .03 * black.spheres, 1e-9);
        ck_assert_uint_gt(units, 0);
    }
}

/* Where nearly nothing absorbs, a batch follows fewer paths, and says so. What spheres absorb after reflections is all
 * but the first segment, which is next to nothing. */
TEST(reflected_among_mirrors) {
    OWNED_HALL *h = make_hall(0);
    const fibrad_wall tube[3] = {cylinder_at(2, 2, 4), plane_at(2, 0, 0), plane_at(2, 1, 4)};
    fibrad_wall_row row;
    uint64_t reflected[SPHERES] = {0}, units = 0;
    OWNED fibrad_scene *scene = scene_with(&h->bed, &(fibrad_scene_config){.wall = tube, .walls = 3});
    for (uint32_t b = 0; b < 3; b++) h->wall_e[b] = .0007;
    for (uint32_t i = 0; i < SPHERES; i++) h->e[i] = .001;
    h->rule.paths = 1000 * FIBRAD_WALL_PARTS;
    assert_ok(wall_of(scene, &h->work, 1, &h->rule, 0, &row, reflected));
    for (uint32_t i = 0; i < SPHERES; i++) units += reflected[i];
    ck_assert_uint_lt(row.paths, 900);
    assert_near((double)units * 0x1p-40 / (double)row.paths, row.spheres, .1);
}

/* An emissivity that is not valid ends in no fault. */
TEST(reflected_of_invalid_emissivities) {
    static const double bad[] = {NAN, -3, 1e300, INFINITY, -INFINITY};
    OWNED_HALL *h = make_hall(0);
    uint64_t reflected[SPHERES] = {0};
    fibrad_wall_row row;
    h->rule.paths = 4000;
    for (int k = 0; k < 5; k++) {
        for (uint32_t i = 0; i < SPHERES; i++) h->e[i] = bad[k];
        const int status = wall_of(h->scene, &h->work, 0, &h->rule, 0, &row, reflected);
        if (k == 0) assert_invalid(status);
    }
}

/* ---- rows of openings ------------------------------------------------------------------------------------------- */

/* Between openings and black walls of an empty box, by closed forms. Black surfaces by default are known exactly. Paths
 * are within their noise. */
TEST(openings_of_an_empty_box) {
    const double size[3] = {1, 1.5, .6}, e[4] = {1, 1, 1, 1};
    const fibrad_plane opening[2] = {{0, 0, 0}, {2, 1, .6}};
    const fibrad_wall wall[4] = {plane_at(0, 1, 1), plane_at(1, 0, 0), plane_at(1, 1, 1.5), plane_at(2, 0, 0)};
    struct bed none = bed_empty();
    OWNED fibrad_scene *scene =
        scene_with(&none, &(fibrad_scene_config){.wall = wall, .walls = 4, .opening = opening, .openings = 2});
    OWNED_WORK work = work_growing();
    fibrad_wall_row row;
    for (int exact = 0; exact < 2; exact++)
        for (int k = 0; k < 2; k++) {
            const uint32_t open = FIBRAD_OPENING(4, opening[k].axis, opening[k].upper), axis = k ? 2 : 0;
            const double off = exact ? 1e-14 : 5e-3, across = size[axis], beside = size[2 - axis];
            const fibrad_wall_rule rule = {.wall_emissivity = exact ? NULL : e, .paths = 80000};
            ck_assert_double_eq(fibrad_scene_wall_area(scene, open), size[1] * beside);
            assert_ok(fibrad_exchange_wall(scene, &work, open, &rule, 0, &row, NULL));
            ck_assert_double_eq(row.spheres, 0);
            ck_assert_double_eq_tol(row.wall[k ? 3 : 0], opposite(size[1], beside, across), off);
            ck_assert_double_eq_tol(row.wall[1], adjacent(beside, size[1], across), off);
            ck_assert_double_eq_tol(row.wall[2], adjacent(beside, size[1], across), off);
            ck_assert_double_eq_tol(row.escaped, adjacent(size[1], beside, across), off);
        }
    for (uint32_t face = 0; face < 8; face++) {
        if (face == 0 || face == 5) continue;
        ck_assert_double_nan(fibrad_scene_wall_area(scene, 4 + face));
        assert_invalid(fibrad_exchange_wall(scene, &work, 4 + face, &(fibrad_wall_rule){0}, 0, &row, NULL));
    }
    assert_invalid(fibrad_exchange_wall(scene, &work, UINT32_MAX, &(fibrad_wall_rule){0}, 0, &row, NULL));
    ck_assert_double_nan(fibrad_scene_wall_area(scene, UINT32_MAX));
}

/* An opening has the area of one period, or of the disc that ends a cylinder. An endless opening has no row. */
TEST(areas_of_openings) {
    OWNED_BED bed = BED({1, 1, 1, .5});
    const fibrad_plane top = {2, 1, 3};
    const fibrad_wall floor[2] = {plane_at(2, 0, 0), cylinder_at(1, 1, 1.5)};
    const double area[3] = {INFINITY, PI * 1.5 * 1.5, 6};
    for (int k = 0; k < 3; k++) {
        if (k == 2) bed.period[0] = 2, bed.period[1] = 3;
        const uint32_t walls = k == 1 ? 2 : 1, wall = FIBRAD_OPENING(walls, 2, 1);
        OWNED fibrad_scene *scene =
            scene_with(&bed, &(fibrad_scene_config){.wall = floor, .walls = walls, .opening = &top, .openings = 1});
        OWNED_WORK work = work_growing();
        fibrad_wall_row row;
        if (k > 0) ck_assert_double_eq_tol(fibrad_scene_wall_area(scene, wall), area[k], 1e-13);
        if (k == 0) ck_assert(isinf(fibrad_scene_wall_area(scene, wall)));
        ck_assert_int_eq(fibrad_exchange_wall(scene, &work, wall, &(fibrad_wall_rule){0}, 0, &row, NULL),
                         k ? FIBRAD_OK : FIBRAD_E_UNSUPPORTED);
    }
}

/* All that openings give to spheres is what spheres give to the surroundings. */
LOOP_TEST(openings_and_spheres_are_reciprocal, KINDS) {
    OWNED_HALL *h = make_hall(_i);
    double there = 0, back = 0, off = 0;
    h->rule.paths = 16384;
    for (uint32_t k = 0; k < h->openings; k++) {
        const uint32_t wall = FIBRAD_OPENING(h->walls, h->opening[k].axis, h->opening[k].upper);
        fibrad_wall_row part[FIBRAD_WALL_PARTS], mean;
        for (uint32_t p = 0; p < FIBRAD_WALL_PARTS; p++)
            assert_ok(wall_of(h->scene, &h->work, wall, &h->rule, p, &part[p], NULL));
        assert_ok(fibrad_exchange_wall_mean(part, &mean));
        there += wall_emits(h, wall) * mean.spheres, off += wall_emits(h, wall) * mean.error;
    }
    for (uint32_t i = 0; i < SPHERES; i++) {
        OWNED_ROW row = row_in(h, i);
        back += sphere_emits(h, i) * row.escaped;
        off += sphere_emits(h, i) * row.error / sqrt(SPHERES);
    }
    ck_assert_double_eq_tol(there, back, 2 * off);
    ck_assert_double_lt(off, .02 * back);
}
