/* tiles_lanes.c - makes the tiles of planes and their rays. Compiled once per instruction set.
 * SPDX-License-Identifier: MIT
 *
 * Spheres near the tile are compared with all rays in lanes. Rays that meet none of them go through the grid. Both ways
 * compute the same bits. */
#include FIBRAD_LANES_HEADER
#include "base/lanes/laned.h"
#include "base/lanes/turn.h"
#include "base/random.h"
#include "ray/tiles_lanes.h"
#include "ray/tracer.h"
#include "scene/grid_walk.h"
#include "scene/walls.h"

#define NEAR_MOST    256u
#define NEAR_SPACING 3.0  /* spheres up to this many mean spacings beyond the tile are near */
#define AROUND       2.2  /* no ray begins farther than this many sides from the middle of the tile */
#define ROUND        1e-9 /* more than rounding errors of lengths, in parts of the way across the near spheres */

/* The making of a tile. */
struct tile_build {
    const fibrad_scene *scene;
    fibrad_tile *tile;
    double side;      /* L */
    uint32_t plane;   /* its slot */
    double corner[2]; /* L, of the tile, along the edges of the plane */
    double level;     /* L, of the plane along its axis */
    double known;     /* L: no ray meets a sphere that is not near before this length */
    uint32_t near[NEAR_MOST], count;
    _Alignas(64) double point[3][FIBRAD_TILE_RAYS]; /* L, of each ray */
    double length[FIBRAD_TILE_RAYS];                /* L, to the first near sphere; infinity: none */
    double first[FIBRAD_TILE_RAYS];                 /* its number among the near ones */
    double equal[FIBRAD_TILE_RAYS];                 /* 1: two spheres are met at one length */
};

/* A coordinate [L] along an axis, mirrored at walls. So every ray begins within the walls. */
static double mirror(const fibrad_container *container, uint32_t axis, double c) {
    const double low = container->low[axis], high = container->high[axis];
    if (c < low) c = low + (low - c);
    if (c > high) c = high - (c - high);
    return fibrad_max(low, c);
}

/* Sets where the rays begin, and the coordinates of their directions. */
static void spread_points(struct tile_build *b, const fibrad_sobol *sobol, fibrad_random stream,
                          double even[2][FIBRAD_TILE_RAYS]) {
    uint32_t x[8];
    for (uint32_t d = 0; d < 8; d++) x[d] = (uint32_t)(fibrad_random_ahead(stream, d) >> 32);
    for (uint32_t k = 0; k < FIBRAD_TILE_RAYS; k++) {
        if (k > 0) fibrad_sobol_move(sobol, k - 1, k, x);
        const uint32_t square = (x[0] >> 29) + FIBRAD_TILE_SIDE * (x[1] >> 29);
        b->point[fibrad_face_axis(b->plane)][square] = b->level;
        for (uint32_t edge = 0; edge < 2; edge++) {
            const uint32_t axis = fibrad_face_along(b->plane, edge);
            const double c = mirror(&b->scene->container, axis, b->corner[edge] + x[edge] * 0x1p-32 * b->side);
            b->tile->at[edge][square] = (float)((c - b->corner[edge]) / b->side);
            b->point[axis][square] = b->corner[edge] + b->tile->at[edge][square] * b->side;
            even[edge][square] = x[2 + edge] * 0x1p-32;
        }
    }
}

/* Sets directions by the cosine law: those of the normal plus a point of the unit sphere. */
static void spread_directions(struct tile_build *b, double even[2][FIBRAD_TILE_RAYS]) {
    const double point[3] = {b->point[0][0], b->point[1][0], b->point[2][0]};
    double normal[3];
    fibrad_wall_normal(b->scene, b->plane, point, normal);
    for (uint32_t k = 0; k < FIBRAD_TILE_RAYS; k += VD_LANES) {
        const vd height = vd_load(even[0] + k), ring = vd_sqrt(4 * height * (1 - height));
        vd cosine, sine;
        vd_turn(vd_load(even[1] + k), &cosine, &sine);
        const vd w[3] = {normal[0] + ring * cosine, normal[1] + ring * sine, normal[2] + (1 - (height + height))};
        const vd square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2], inverse = 1 / vd_sqrt(square);
        const vm flat = vd_lt(square, vd_set1(1e-24));
        for (int axis = 0; axis < 3; axis++)
            vd_store_float(b->tile->w[axis] + k, vd_select(flat, vd_set1(normal[axis]), w[axis] * inverse));
    }
}

/* Lists the spheres near the tile. None is listed if there are too many. */
static void list_close(struct tile_build *b) {
    const fibrad_scene *scene = b->scene;
    const double reach = NEAR_SPACING * scene->spacing + AROUND * b->side;
    double centre[3];
    centre[fibrad_face_axis(b->plane)] = b->level;
    for (uint32_t edge = 0; edge < 2; edge++)
        centre[fibrad_face_along(b->plane, edge)] = b->corner[edge] + 0.5 * b->side;
    b->count = 0, b->known = reach * (1 - ROUND) - AROUND * b->side;
    for (uint32_t l = 0; l < scene->levels; l++) {
        double ball = reach + scene->level[l].radius_max, low[3], high[3];
        for (int axis = 0; axis < 3; axis++) low[axis] = centre[axis] - ball, high[axis] = centre[axis] + ball;
        fibrad_walk walk;
        fibrad_walk_begin(&walk, scene, &scene->level[l], low, high);
        while (fibrad_walk_next(&walk))
            for (uint32_t j = walk.begin; j < walk.end; j++) {
                const double x = scene->x[j] - centre[0], y = scene->y[j] - centre[1], z = scene->z[j] - centre[2];
                const double most = reach + scene->r[j];
                if (x * x + y * y + z * z > most * most) continue;
                if (b->count < NEAR_MOST) b->near[b->count] = j;
                b->count++;
            }
    }
    if (b->count > NEAR_MOST) b->count = 0, b->known = 0;
}

/* Compares the near spheres with the rays of one vector, as intersect_sphere of trace_lanes.c does. */
static void meet_near(struct tile_build *b, uint32_t k) {
    const fibrad_scene *scene = b->scene;
    const vd zero = vd_set1(0), one = vd_set1(1);
    const vd px = vd_load(b->point[0] + k), py = vd_load(b->point[1] + k), pz = vd_load(b->point[2] + k);
    const vd wx = vd_load_float(b->tile->w[0] + k), wy = vd_load_float(b->tile->w[1] + k),
             wz = vd_load_float(b->tile->w[2] + k);
    vd length = vd_set1(__builtin_inf()), first = zero, equal = zero;
    for (uint32_t n = 0; n < b->count; n++) {
        const uint32_t j = b->near[n];
        const vd x = scene->x[j] - px, y = scene->y[j] - py, z = scene->z[j] - pz;
        const vd along = x * wx + y * wy + z * wz;
        const vd ax = x - along * wx, ay = y - along * wy, az = z - along * wz;
        const vd square = vd_set1(scene->r[j] * scene->r[j]) - (ax * ax + ay * ay + az * az);
        if (vm_bits(vd_lt(zero, square)) == 0) continue;
        const vd root = vd_sqrt(vd_max(square, zero)), here = vd_max(along - root, zero);
        const vm met = vd_lt(zero, square) & vd_lt(zero, along + root), before = met & vd_lt(here, length);
        equal = vd_select(met & vd_le(here, length) & vd_le(length, here), one, vd_select(before, zero, equal));
        length = vd_select(before, here, length);
        first = vd_select(before, vd_set1(n), first);
    }
    vd_store(b->length + k, length), vd_store(b->first + k, first), vd_store(b->equal + k, equal);
}

/* Finds what a ray meets, and enters it. */
static void finish_ray(struct tile_build *b, uint32_t k) {
    fibrad_tile *tile = b->tile;
    const double point[3] = {b->point[0][k], b->point[1][k], b->point[2][k]};
    const double w[3] = {tile->w[0][k], tile->w[1][k], tile->w[2][k]};
    fibrad_hit hit;
    if (b->length[k] < b->known && b->equal[k] == 0)
        LANED(fibrad_trace_sphere)(b->scene, point, w, b->near[(uint32_t)b->first[k]], &hit);
    else
        LANED(fibrad_trace_point)(b->scene, point, w, FIBRAD_NO_SIDE, &hit);
    tile->sphere[k] = hit.sphere;
    if (hit.sphere == FIBRAD_NONE) return;
    tile->length[k] = (float)(hit.distance * (1 + 1e-6));
    for (int axis = 0; axis < 3; axis++) tile->normal[axis][k] = (float)hit.normal[axis];
}

static void make_tile(const fibrad_tiles *tiles, const fibrad_scene *scene, uint32_t plane, const double corner[2],
                      fibrad_random stream, fibrad_tile *tile) {
    const uint32_t axis = fibrad_face_axis(plane);
    const fibrad_container *container = &scene->container;
    _Alignas(64) double even[2][FIBRAD_TILE_RAYS];
    struct tile_build b = {.scene = scene,
                           .tile = tile,
                           .side = tiles->side,
                           .plane = plane,
                           .corner = {corner[0], corner[1]},
                           .level = fibrad_face_is_upper(plane) ? container->high[axis] : container->low[axis]};
    spread_points(&b, &tiles->sobol, stream, even);
    spread_directions(&b, even);
    list_close(&b);
    for (uint32_t k = 0; k < FIBRAD_TILE_RAYS; k += VD_LANES) meet_near(&b, k);
    for (uint32_t k = 0; k < FIBRAD_TILE_RAYS; k++) finish_ray(&b, k);
}

/* The tile with a stream of random numbers. Each tile has its own. */
static const fibrad_tile *tile_of(fibrad_tiles *tiles, const fibrad_scene *scene, uint32_t plane,
                                  const double corner[2], fibrad_random stream) {
    const uint32_t set = (uint32_t)stream.counter & (FIBRAD_TILES - FIBRAD_TILE_WAYS);
    for (uint32_t k = set; k < set + FIBRAD_TILE_WAYS; k++)
        if (tiles->key[k] == stream.counter) return &tiles->tile[k];
    const uint32_t next = set + tiles->made++ % FIBRAD_TILE_WAYS;
    tiles->key[next] = stream.counter;
    make_tile(tiles, scene, plane, corner, stream, &tiles->tile[next]);
    return &tiles->tile[next];
}

void LANED(fibrad_tile_ray)(fibrad_tiles *tiles, const fibrad_scene *scene, uint32_t plane, double point[3],
                            double w[3], fibrad_hit *hit) {
    const double *const of_axis[3] = {scene->x, scene->y, scene->z};
    double corner[2];
    uint64_t key = plane;
    uint32_t square = 0;
    for (uint32_t edge = 2; edge-- > 0;) {
        const double at = point[fibrad_face_along(plane, edge)] / tiles->side, whole = fibrad_floor(at);
        corner[edge] = whole * tiles->side;
        square = square * FIBRAD_TILE_SIDE + (uint32_t)((at - whole) * FIBRAD_TILE_SIDE);
        key = fibrad_hash_number(key, whole);
    }
    const fibrad_tile *tile = tile_of(tiles, scene, plane, corner, fibrad_random_start(tiles->seed, key));
    for (uint32_t edge = 0; edge < 2; edge++)
        point[fibrad_face_along(plane, edge)] = corner[edge] + tile->at[edge][square] * tiles->side;
    *hit = (fibrad_hit){.side = FIBRAD_NO_SIDE, .sphere = tile->sphere[square], .distance = tile->length[square]};
    for (int axis = 0; axis < 3; axis++) {
        w[axis] = tile->w[axis][square];
        hit->normal[axis] = tile->normal[axis][square];
        if (hit->sphere != FIBRAD_NONE) hit->centre[axis] = of_axis[axis][hit->sphere] - point[axis];
    }
}
