/* test_tiles.c - the rays of tiles against rays traced one by one, and rows with tiles against rows without.
 * SPDX-License-Identifier: MIT */
#include "base/dispatch.h"
#include "ray/tiles_lanes.h"
#include "scenes.h"
#include "suite.h"

enum { WALLS = 6, N = 120 };

/* A packing in a box whose walls touch or cut the outer spheres. */
static fibrad_scene *boxed(const struct bed *bed, int isa) {
    fibrad_body walls[WALLS];
    const double *const c[3] = {bed->x, bed->y, bed->z};
    for (int face = 0; face < WALLS; face++) {
        const int axis = face / 2, upper = face % 2;
        double end = -INFINITY;
        for (uint32_t i = 0; i < bed->n; i++) end = fmax(end, (upper ? c[axis][i] : -c[axis][i]) + .98 * bed->r[i]);
        walls[face] = plane_at(axis, upper, upper ? end : -end);
    }
    return scene_with(bed, &(fibrad_scene_config){.isa = isa, .body = walls, .bodies = WALLS});
}

static fibrad_tile_function *version_of(int isa) { return FIBRAD_VERSION_OF(fibrad_tile_ray, isa); }

static fibrad_tiles tiles_of(const fibrad_scene *scene, double side, uint64_t seed) {
    fibrad_tiles tiles = {.tile = block_of(FIBRAD_TILES * sizeof *tiles.tile), .key = calloc(FIBRAD_TILES, 8)};
    fibrad_tiles_begin(&tiles, scene->hash, side, seed);
    return tiles;
}

static void tiles_free(fibrad_tiles *tiles) { free(tiles->tile), free(tiles->key); }

/* From any point of a plane, the ray begins in the same square or in its mirror image at an edge of the box. It meets
 * what a ray meets that is traced alone. All instruction sets have the same bits. */
LOOP_TEST(rays_are_those_of_the_grid, 2) {
    const double side = _i ? 3 : .7;
    OWNED_BED bed = packing(N, _i ? .1 : .5, 1, .5, 3, false);
    const struct isas isas = isas_there();
    uint32_t met = 0;
    for (int s = 0; s < isas.count; s++) {
        OWNED fibrad_scene *scene = boxed(&bed, isas.set[s]), *scalar = boxed(&bed, FIBRAD_ISA_SCALAR);
        fibrad_tiles tiles = tiles_of(scene, side, 5), plain = tiles_of(scalar, side, 5);
        for (uint64_t k = 0; k < 3000; k++) {
            const uint32_t plane = (uint32_t)(k % 6), axis = fibrad_face_axis(plane);
            double point[3], from[3], w[3], other[3];
            fibrad_hit hit = {0}, alone;
            for (uint32_t a = 0; a < 3; a++)
                point[a] = scene->container.low[a] +
                           bed_make_random(7, 3 * k + a) * (scene->container.high[a] - scene->container.low[a]);
            point[axis] = fibrad_face_is_upper(plane) ? scene->container.high[axis] : scene->container.low[axis];
            memcpy(from, point, sizeof from), memcpy(other, point, sizeof other);
            version_of(isas.set[s])(&tiles, scene, plane, from, w, &hit);
            for (uint32_t a = 0; a < 3; a++) {
                const bool at_edge = fabs(point[a] - scene->container.low[a]) < side / 8 ||
                                     fabs(point[a] - scene->container.high[a]) < side / 8;
                ck_assert(at_edge || floor(from[a] / side * 8) == floor(point[a] / side * 8) || a == axis);
                ck_assert_double_le(scene->container.low[a] - from[a], 1e-6);
                ck_assert_double_le(from[a] - scene->container.high[a], 1e-6);
            }
            ck_assert_double_eq(from[axis], point[axis]);
            ck_assert_double_ge(fibrad_face_is_upper(plane) ? -w[axis] : w[axis], 0);
            fibrad_trace_point_scalar(scene, from, w, FIBRAD_NO_SIDE, &alone);
            ck_assert_uint_eq(hit.sphere, alone.sphere);
            if (hit.sphere == FIBRAD_NONE) continue;
            met++;
            ck_assert(hit.distance >= alone.distance && hit.distance <= alone.distance * (1 + 2e-6));
            for (int a = 0; a < 3; a++) {
                ck_assert_double_eq_tol(hit.normal[a], alone.normal[a], 1e-7);
                ck_assert_double_eq_tol(hit.centre[a], alone.centre[a], 1e-12);
            }
            fibrad_hit again = {0};
            double along[3];
            fibrad_tile_ray_scalar(&plain, scalar, plane, other, along, &again);
            ck_assert_mem_eq(&hit, &again, sizeof hit);
            ck_assert(memcmp(w, along, sizeof w) == 0 && memcmp(from, other, sizeof from) == 0);
        }
        tiles_free(&tiles), tiles_free(&plain);
    }
    ck_assert_uint_gt(met, 1000 * (uint32_t)isas.count);
}

/* The points of all tiles are evenly spread over them, and directions follow the cosine law. */
TEST(rays_fill_tile_and_hemisphere) {
    OWNED_BED bed = packing(N, 1, 1, .5, 3, false);
    OWNED fibrad_scene *scene = boxed(&bed, FIBRAD_ISA_BEST);
    fibrad_tiles tiles = tiles_of(scene, 1, 9);
    double sum[5] = {0};
    enum { COUNT = 64 * 16 };
    for (uint32_t k = 0; k < COUNT; k++) { /* each square of 16 tiles once */
        const uint32_t a = k % 32, b = k / 32;
        double point[3] = {0, a / 8. + .01, b / 8. + .01}, w[3];
        point[0] = scene->container.low[0];
        point[1] += ceil(scene->container.low[1]), point[2] += ceil(scene->container.low[2]);
        fibrad_hit hit;
        version_of((int)scene->facts.isa)(&tiles, scene, 0, point, w, &hit);
        sum[0] += w[0], sum[1] += w[0] * w[0], sum[2] += w[1], sum[3] += w[2];
        sum[4] += (point[1] - floor(point[1])) * w[1];
    }
    tiles_free(&tiles);
    ck_assert_double_eq_tol(sum[0] / COUNT, 2. / 3, .005);
    ck_assert_double_eq_tol(sum[1] / COUNT, 1. / 2, .005);
    for (int m = 2; m < 5; m++) ck_assert_double_eq_tol(sum[m] / COUNT, 0, .01);
}

/* The mean of many rows with tiles is a row of very many paths. Their spread is smaller than that of rows without. */
LOOP_TEST(rows_have_the_same_mean, 2) {
    enum { ROWS = 400 };
    OWNED_BED bed = packing(N, .5, 1, .5, 4, false);
    OWNED fibrad_scene *scene = boxed(&bed, FIBRAD_ISA_BEST);
    uint32_t i = 0;
    for (uint32_t k = 0; k < N; k++) /* the sphere that is nearest to an edge of the box */
        if (bed.x[k] + bed.z[k] - 2 * bed.r[k] < bed.x[i] + bed.z[i] - 2 * bed.r[i]) i = k;
    double e[N], mean[N] = {0}, square[2][WALLS] = {{0}}, wall[2][WALLS] = {{0}};
    for (uint32_t k = 0; k < N; k++) e[k] = _i ? .3 : .8;
    const double walls[WALLS] = {0, 0, .5, 0, .8, 1};
    fibrad_exchange_rule rule = {.emissivity = e, .body_emissivity = walls, .directions = 144, .paths = 1 << 20};
    OWNED_WORK work = work_growing();
    OWNED_ROW exact = row_of(N);
    ck_assert_int_eq(fibrad_exchange_row(scene, &work, i, &rule, &exact, NULL), FIBRAD_OK);
    rule.paths = 60;
    for (uint64_t k = 0; k < 2 * ROWS; k++) {
        OWNED_ROW row = row_of(N);
        rule.seed = k + 1, rule.tile = k % 2 ? 1.5 : 0, rule.tile_seed = k;
        ck_assert_int_eq(fibrad_exchange_row(scene, &work, i, &rule, &row, NULL), FIBRAD_OK);
        double whole = row_sum(&row) + row.escaped + row.beyond;
        for (int b = 0; b < WALLS; b++) {
            whole += row.body[b], wall[k % 2][b] += row.body[b] / ROWS;
            square[k % 2][b] += pow(row.body[b] - exact.body[b], 2) / ROWS;
        }
        ck_assert_double_eq_tol(whole, 1, 1e-12);
        for (uint32_t c = 0; c < row.length && k % 2; c++) mean[row.col[c]] += row.f[c] / ROWS;
    }
    ck_assert_double_gt(square[0][4], 1e-5);
    ck_assert_double_lt(square[1][4], (_i ? .9 : .5) * square[0][4]); /* at .3 most of it comes from spheres */
    for (int b = 0; b < WALLS; b++)
        ck_assert_double_eq_tol(wall[1][b], exact.body[b], 4 * sqrt(square[1][b] / ROWS) + 1e-3);
    for (uint32_t c = 0; c < N; c++) ck_assert_double_eq_tol(mean[c], row_factor(&exact, c), 3e-3);
}
