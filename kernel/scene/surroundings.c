/* surroundings.c - what lies beyond the spheres that a row knows. SPDX-License-Identifier: MIT */
#include "scene/surroundings.h"
#include "scene/walls.h"

#define OCCUPANCY_CELLS (1u << 20)

static bool occupancy_valid(const fibrad_occupancy *o) {
    for (int axis = 0; axis < 3; axis++) {
        if (!(fibrad_abs(o->low[axis]) <= FIBRAD_LENGTH_MAX && fibrad_abs(o->high[axis]) <= FIBRAD_LENGTH_MAX))
            return false;
        if (o->cells[axis] < 1 || o->cells[axis] > OCCUPANCY_CELLS) return false;
        if (!(o->high[axis] - o->low[axis] >= o->cells[axis] * FIBRAD_LENGTH_MIN)) return false;
        if (o->periodic[axis] != 0 && o->periodic[axis] != 1) return false;
    }
    return true;
}

int fibrad_surroundings_check(const fibrad_scene_config *config) {
    return config->occupancy == NULL || occupancy_valid(config->occupancy) ? FIBRAD_OK : FIBRAD_E_ARGUMENT;
}

void fibrad_surroundings_build(fibrad_scene *scene, const fibrad_scene_config *config) {
    if (config->occupancy != NULL) {
        scene->occupancy = *config->occupancy;
        return;
    }
    fibrad_occupancy *all = &scene->occupancy; /* one cell, the box of the spheres */
    for (int axis = 0; axis < 3; axis++) {
        const double wide = scene->period[axis] > 0 ? 0 : scene->facts.radius_max;
        all->low[axis] = scene->low[axis] - wide;
        all->high[axis] = scene->high[axis] + wide;
        all->cells[axis] = 1;
        all->periodic[axis] = scene->period[axis] > 0;
    }
}

double fibrad_ball_exit(const double o[3], const double w[3], double radius) {
    if (!(radius < FIBRAD_LENGTH_MAX)) return __builtin_inf();
    double along = 0, square = 0, inside = radius * radius;
    for (int axis = 0; axis < 3; axis++)
        along += o[axis] * w[axis], square += w[axis] * w[axis], inside -= o[axis] * o[axis];
    if (!(inside >= 0)) return -1;
    const double root = fibrad_sqrt(along * along + square * inside);
    return along > 0 ? inside / (along + root) : (root - along) / square; /* without cancellation */
}

/* A ray in units of the cells of an occupancy. */
typedef struct cell_walk {
    double origin[3], w[3]; /* on periodic axes the origin lies in the box */
    double begin, end;      /* lengths */
    int64_t at[3];          /* the cell; on periodic axes it may lie outside the box */
} cell_walk;

/* The length at which the ray leaves its cell along an axis. */
static double cell_exit(const cell_walk *walk, int axis) {
    if (walk->w[axis] == 0) return __builtin_inf();
    return ((double)walk->at[axis] + (walk->w[axis] > 0) - walk->origin[axis]) / walk->w[axis];
}

/* Begins with the part of the ray between two lengths that lies in the box. False: no part of the ray lies there. */
static bool cell_walk_begin(cell_walk *walk, const fibrad_occupancy *o, const double origin[3], const double w[3],
                            double begin, double end) {
    for (int axis = 0; axis < 3; axis++) {
        const double cells = o->cells[axis], inverse = cells / (o->high[axis] - o->low[axis]);
        double at = (origin[axis] - o->low[axis]) * inverse;
        if (o->periodic[axis]) at -= cells * fibrad_floor(at / cells);
        walk->origin[axis] = at, walk->w[axis] = w[axis] * inverse;
        if (o->periodic[axis]) continue;
        if (walk->w[axis] == 0) {
            if (!(at >= 0 && at <= cells)) return false;
            continue;
        }
        const double to_low = -at / walk->w[axis], to_high = (cells - at) / walk->w[axis];
        begin = fibrad_max(begin, fibrad_min(to_low, to_high)), end = fibrad_min(end, fibrad_max(to_low, to_high));
    }
    walk->begin = begin, walk->end = end;
    return begin < end;
}

/* Whether all cells between two lengths of a ray are free. False beyond FIBRAD_PERIODS periods of the box, since
 * nobody has looked there. */
static bool way_is_clear(const fibrad_occupancy *o, const double origin[3], const double w[3], double begin,
                         double end) {
    cell_walk walk;
    double next[3], first[3];
    if (!cell_walk_begin(&walk, o, origin, w, begin, end)) return true;
    for (int axis = 0; axis < 3; axis++) {
        const double at = walk.origin[axis] + walk.w[axis] * walk.begin, cells = o->cells[axis];
        if (o->periodic[axis] && !(fibrad_abs(at) <= FIBRAD_PERIODS * cells)) return false;
        const double cell = fibrad_floor(at);
        walk.at[axis] = (int64_t)(o->periodic[axis] ? cell : fibrad_max(0, fibrad_min(cell, cells - 1)));
        next[axis] = cell_exit(&walk, axis);
        first[axis] = (double)walk.at[axis];
    }
    for (;;) {
        uint64_t cell = 0;
        for (int axis = 3; axis-- > 0;) {
            const int64_t cells = o->cells[axis], in_box = (walk.at[axis] % cells + cells) % cells;
            cell = cell * (uint64_t)cells + (uint64_t)in_box;
        }
        if (o->mark == NULL || (o->mark[cell / 64] >> cell % 64 & 1) != 0) return false;
        int axis = next[1] < next[0] ? 1 : 0;
        if (next[2] < next[axis]) axis = 2;
        if (!(next[axis] < walk.end)) return true;
        walk.at[axis] += walk.w[axis] > 0 ? 1 : -1;
        const double cells = o->cells[axis], at = (double)walk.at[axis];
        if (o->periodic[axis] ? fibrad_abs(at - first[axis]) > FIBRAD_PERIODS * cells : at < 0 || at >= cells)
            return !o->periodic[axis];
        next[axis] = cell_exit(&walk, axis);
    }
}

uint32_t fibrad_surroundings_met(const fibrad_scene *scene, const double origin[3], const double w[3], double ball,
                                 double *distance) {
    const uint32_t wall = fibrad_walls_exit(scene, origin, w, distance);
    const double within = fibrad_max(0, ball);
    if (*distance > within && !way_is_clear(&scene->occupancy, origin, w, within, *distance)) return FIBRAD_BEYOND;
    return wall == FIBRAD_NONE ? FIBRAD_ESCAPED : wall;
}

uint32_t fibrad_surroundings_side(const fibrad_scene *scene, const double origin[3], const double w[3], double ball,
                                  uint32_t side, double length, double *distance) {
    const uint32_t wall = fibrad_walls_exit(scene, origin, w, distance);
    const bool before = wall == FIBRAD_NONE || length < *distance;
    if (before) *distance = length;
    const double within = fibrad_max(0, ball);
    if (*distance > within && !way_is_clear(&scene->occupancy, origin, w, within, *distance)) return FIBRAD_BEYOND;
    return before ? fibrad_scene_slot(scene, side) : wall;
}

int fibrad_triangle_ray(const fibrad_scene *scene, const double origin[3], const double w[3], double length,
                        fibrad_triangle_hit *hit) {
    if (scene == NULL || origin == NULL || w == NULL || hit == NULL || !(length >= 0)) return FIBRAD_E_ARGUMENT;
    if (!fibrad_scene_ready(scene)) return FIBRAD_E_STATE;
    double square = 0;
    for (int axis = 0; axis < 3; axis++) {
        if (!fibrad_finite(origin[axis]) || !fibrad_finite(w[axis])) return FIBRAD_E_ARGUMENT;
        square += w[axis] * w[axis];
    }
    if (!(fibrad_abs(square - 1) < 1e-6)) return FIBRAD_E_ARGUMENT;
    for (int axis = 0; axis < 3 && scene->mesh.triangles > 0; axis++)
        if (!(fibrad_abs(origin[axis] - scene->mesh.middle[axis]) <= FIBRAD_COORDINATE_MAX * scene->mesh.extent))
            return FIBRAD_E_ARGUMENT;
    const fibrad_mesh_hit met = fibrad_mesh_first(&scene->mesh, origin, w, length, FIBRAD_NO_SIDE);
    *hit = (fibrad_triangle_hit){.triangle = UINT32_MAX, .distance = met.distance};
    if (met.side != FIBRAD_NO_SIDE)
        hit->triangle = fibrad_side_number(&scene->mesh, met.side), hit->back = fibrad_side_is_back(met.side);
    return FIBRAD_OK;
}
