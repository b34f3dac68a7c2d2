/* tracer.c - memory of a tracer and its lists of near spheres. SPDX-License-Identifier: MIT */
#include "ray/tracer.h"
#include "base/arena.h"
#include "base/random.h"
#include "base/sort.h"
#include "scene/grid_walk.h"

/* A list has the spheres up to REACH mean spacings beyond the surface of its sphere, or as many as it has room for. */
#define REACH      1.8
#define CANDIDATES 512
#define LISTS_MIN  16u

/* A list of a cell is made when this many rays have begun in the cell. */
#define CELL_RAYS 4u

typedef struct fibrad_candidate {
    double clearance, c[3], r;
    uint32_t sphere;
    int8_t periods[3];
} fibrad_candidate;

static void tracer_layout(fibrad_arena *arena, uint32_t lists, fibrad_tracer *tracer) {
    tracer->lists = lists;
    tracer->cells = lists > LISTS_MIN ? lists / 2 : 1;
    tracer->owner = fibrad_arena_take(arena, lists, sizeof *tracer->owner);
    tracer->nearby = fibrad_arena_take(arena, lists + tracer->cells, sizeof *tracer->nearby);
    tracer->cell = fibrad_arena_take(arena, tracer->cells, sizeof *tracer->cell);
    for (int k = 0; k < 2; k++) tracer->key[k] = fibrad_arena_take(arena, CANDIDATES, sizeof *tracer->key[k]);
    tracer->candidate = fibrad_arena_take(arena, CANDIDATES, sizeof *tracer->candidate);
}

/* Bytes of a tracer with a number of lists, which is a power of two. */
static size_t tracer_bytes(uint32_t lists) {
    fibrad_arena arena = {0};
    fibrad_tracer fields = {0};
    fibrad_arena_take(&arena, 1, sizeof fields);
    tracer_layout(&arena, lists, &fields);
    return arena.used;
}

size_t fibrad_tracer_least(void) { return tracer_bytes(LISTS_MIN); }

size_t fibrad_tracer_best(const fibrad_scene *scene) {
    uint32_t lists = LISTS_MIN;
    while (lists < FIBRAD_LISTS && lists < scene->facts.spheres) lists *= 2;
    return tracer_bytes(lists);
}

fibrad_tracer *fibrad_tracer_of(fibrad_workspace *space, const fibrad_scene *scene) {
    fibrad_tracer *tracer = space->extra;
    if (space->extra_owner != scene->hash) {
        uint32_t lists = LISTS_MIN;
        while (2 * lists <= FIBRAD_LISTS && tracer_bytes(2 * lists) <= space->plan.extra) lists *= 2;
        fibrad_arena arena = {.base = space->extra, .size = space->plan.extra};
        fibrad_arena_take(&arena, 1, sizeof *tracer);
        tracer_layout(&arena, lists, tracer);
        for (uint32_t k = 0; k < lists; k++) tracer->owner[k] = FIBRAD_NONE;
        for (uint32_t k = 0; k < tracer->cells; k++)
            tracer->cell[k] = (fibrad_tracer_cell){.list = tracer->nearby + lists + k};
        space->extra_owner = scene->hash;
    }
    tracer->scene = scene;
    return tracer;
}

/* The ball that a list belongs to. */
struct ball {
    double centre[3], radius; /* L */
    uint32_t place;           /* of the sphere that it is, or FIBRAD_NONE */
};

/* Lists the spheres with a clearance of at most `limit` radii from the ball. False: there is no room. */
static bool gather_candidates(fibrad_tracer *tracer, const struct ball *from, double limit, uint32_t *count) {
    const fibrad_scene *scene = tracer->scene;
    const double *centre = from->centre, inverse = 1 / from->radius;
    *count = 0;
    for (uint32_t l = 0; l < scene->levels; l++) {
        const double wide = limit * from->radius + scene->level[l].radius_max;
        fibrad_walk walk;
        fibrad_walk_about(&walk, scene, &scene->level[l], centre, centre, wide);
        while (fibrad_walk_next(&walk))
            for (uint32_t j = walk.begin; j < walk.end; j++) {
                double x = (scene->x[j] - centre[0] + walk.shift[0]) * inverse;
                double y = (scene->y[j] - centre[1] + walk.shift[1]) * inverse;
                double z = (scene->z[j] - centre[2] + walk.shift[2]) * inverse, r = scene->r[j] * inverse;
                double clearance = fibrad_sqrt(x * x + y * y + z * z) - r;
                if (clearance > limit || (j == from->place && !walk.image)) continue;
                if (*count == CANDIDATES) return false;
                tracer->candidate[(*count)++] =
                    (fibrad_candidate){clearance,
                                       {x, y, z},
                                       r,
                                       j,
                                       {(int8_t)walk.periods[0], (int8_t)walk.periods[1], (int8_t)walk.periods[2]}};
            }
    }
    return true;
}

/* Fills one element of a group. Floats are rounded so that a sphere may be compared in vain, but never missed, as in
 * near/near_lanes.c. Beyond the range of floats all spheres are compared. */
static void enter_nearby(fibrad_nearby_group *group, uint32_t k, const fibrad_candidate *s) {
    double square = s->c[0] * s->c[0] + s->c[1] * s->c[1] + s->c[2] * s->c[2];
    double about = 1 + fibrad_abs(s->c[0]) + fibrad_abs(s->c[1]) + fibrad_abs(s->c[2]);
    bool small = about < 1e18;
    group->x[k] = small ? (float)s->c[0] : 0;
    group->y[k] = small ? (float)s->c[1] : 0;
    group->z[k] = small ? (float)s->c[2] : 0;
    group->q[k] = small ? (float)(square + 1 - s->r * s->r - 4e-6 * about * about) : -FLT_MAX;
    group->sphere[k] = s->sphere;
    for (int axis = 0; axis < 3; axis++) group->periods[k][axis] = s->periods[axis];
}

/* Rays start at distance 1 from the centre. The other terms allow for rounding. */
static double length_for(double clearance) { return clearance * (1 - 1e-9) - 1 - 1e-9; }

static void make_nearby(fibrad_tracer *tracer, fibrad_nearby *list, const struct ball *from) {
    const fibrad_scene *scene = tracer->scene;
    double reach = REACH * scene->spacing / from->radius;
    /* the numbers of periods must fit into bytes */
    for (int axis = 0; axis < 3; axis++)
        if (scene->period[axis] > 0) reach = fibrad_min(reach, 60 * scene->period[axis] / from->radius);
    double limit = 1 + reach;
    uint32_t count = 0;
    while (!gather_candidates(tracer, from, limit, &count)) {
        if (limit > 1.001) {
            limit = 1 + (limit - 1) / 2;
        } else { /* hundreds of small spheres touch this sphere: the grid serves its rays */
            count = 0, limit = 0;
            break;
        }
    }

    for (uint32_t k = 0; k < count; k++) {
        double step = tracer->candidate[k].clearance / limit * 65535;
        tracer->key[0][k] = (uint64_t)fibrad_max(0, step) << 32 | k;
    }
    const uint64_t *key = fibrad_sort_keys(tracer->key[0], tracer->key[1], count, 32, 65535);
    uint32_t listed = count < FIBRAD_NEARBY ? count : FIBRAD_NEARBY;
    for (uint32_t k = listed; k < count; k++) limit = fibrad_min(limit, tracer->candidate[(uint32_t)key[k]].clearance);
    double farthest = 1;
    list->groups = (listed + FIBRAD_GROUP - 1) / FIBRAD_GROUP;
    list->clear[list->groups] = length_for(limit);
    for (uint32_t g = list->groups; g-- > 0;) {
        double least = limit;
        for (uint32_t k = 0; k < FIBRAD_GROUP; k++) {
            if (g * FIBRAD_GROUP + k < listed) {
                const fibrad_candidate *s = &tracer->candidate[(uint32_t)key[g * FIBRAD_GROUP + k]];
                least = fibrad_min(least, s->clearance);
                farthest = fibrad_max(farthest, s->clearance + s->r);
                enter_nearby(&list->group[g], k, s);
            } else {
                list->group[g].x[k] = list->group[g].y[k] = list->group[g].z[k] = 0;
                list->group[g].q[k] = FLT_MAX;
            }
        }
        list->clear[g] = fibrad_min(length_for(least), list->clear[g + 1]);
    }
    list->behind = (float)(2e-6 * fibrad_min(farthest, 1e18));
}

const fibrad_nearby *fibrad_tracer_nearby(fibrad_tracer *tracer, uint32_t place) {
    uint32_t slot = place & (tracer->lists - 1);
    fibrad_nearby *list = &tracer->nearby[slot];
    if (tracer->owner[slot] != place) {
        const fibrad_scene *scene = tracer->scene;
        const struct ball ball = {{scene->x[place], scene->y[place], scene->z[place]}, scene->r[place], place};
        make_nearby(tracer, list, &ball);
        tracer->owner[slot] = place;
    }
    return list;
}

const fibrad_nearby *fibrad_tracer_cell_of(fibrad_tracer *tracer, const double point[3], double start[3],
                                           double *radius) {
    const double edge = tracer->scene->spacing, half = 0.5 * edge;
    struct ball ball = {.radius = half * fibrad_sqrt(3) * (1 + 1e-9), .place = FIBRAD_NONE};
    double at[3];
    uint64_t hash = 0;
    for (int axis = 0; axis < 3; axis++) {
        at[axis] = fibrad_floor(point[axis] / edge);
        hash = fibrad_hash_number(hash, at[axis]);
        ball.centre[axis] = at[axis] * edge + half;
        start[axis] = (point[axis] - ball.centre[axis]) / ball.radius;
    }
    *radius = ball.radius;
    fibrad_tracer_cell *cell = &tracer->cell[fibrad_mix(hash) & (tracer->cells - 1)];
    const bool same = at[0] == cell->at[0] && at[1] == cell->at[1] && at[2] == cell->at[2];
    if (!same) fibrad_copy(cell->at, at, sizeof at), cell->begun = 0;
    if (cell->begun > CELL_RAYS) return cell->list;
    if (++cell->begun <= CELL_RAYS) return NULL;
    make_nearby(tracer, cell->list, &ball);
    return cell->list;
}
