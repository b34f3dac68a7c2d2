/* tracer.c - memory of a tracer and its lists of near spheres. SPDX-License-Identifier: MIT */
#include "ray/tracer.h"
#include "base/arena.h"
#include "base/sort.h"
#include "row/work.h"
#include "scene/grid_walk.h"

/* A list looks REACH mean spacings beyond the surface of its sphere, or as far as its room goes. */
#define REACH      1.8
#define CANDIDATES 512
#define LISTS      2048
#define LISTS_MAX  (1u << 20)

typedef struct fibrad_candidate {
    double clearance, c[3], r;
    uint32_t sphere;
    int8_t periods[3];
} fibrad_candidate;

static fibrad_tracer *layout(fibrad_arena *arena, uint32_t lists, fibrad_tracer *tracer) {
    fibrad_tracer *place = fibrad_arena_take(arena, 1, sizeof *place);
    tracer->lists = lists;
    tracer->owner = fibrad_arena_take(arena, lists, sizeof *tracer->owner);
    tracer->nearby = fibrad_arena_take(arena, lists, sizeof *tracer->nearby);
    for (int k = 0; k < 2; k++) tracer->key[k] = fibrad_arena_take(arena, CANDIDATES, sizeof *tracer->key[k]);
    tracer->candidate = fibrad_arena_take(arena, CANDIDATES, sizeof *tracer->candidate);
    return place;
}

/* The number of lists of a configuration, a power of two; 0 if it is not valid. */
static uint32_t lists_of(const fibrad_tracer_config *config) {
    uint32_t wanted = config != NULL && config->lists > 0 ? config->lists : LISTS, lists = 1;
    if (wanted > LISTS_MAX) return 0;
    while (lists < wanted) lists *= 2;
    return lists;
}

size_t fibrad_tracer_size(const fibrad_tracer_config *config) {
    uint32_t lists = lists_of(config);
    if (lists == 0) return 0;
    fibrad_arena arena = {0};
    fibrad_tracer fields = {0};
    layout(&arena, lists, &fields);
    return fibrad_arena_total(&arena);
}

int fibrad_tracer_init(fibrad_tracer **out, void *memory, size_t size, const fibrad_tracer_config *config,
                       const fibrad_scene *scene) {
    if (out == NULL || scene == NULL) return FIBRAD_E_ARGUMENT;
    fibrad_arena arena;
    int status = fibrad_arena_open(&arena, memory, size, fibrad_tracer_size(config));
    if (status != FIBRAD_OK) return status;
    fibrad_tracer fields = {.scene = scene};
    fibrad_tracer *tracer = layout(&arena, lists_of(config), &fields);
    for (uint32_t k = 0; k < fields.lists; k++) fields.owner[k] = FIBRAD_NONE;
    *tracer = fields;
    *out = tracer;
    return FIBRAD_OK;
}

/* Gathers the spheres with a clearance of at most `limit` from the sphere at `place`. False: there is no room. */
static bool gather(fibrad_tracer *tracer, uint32_t place, double limit, uint32_t *count) {
    const fibrad_scene *scene = tracer->scene;
    double centre[3] = {scene->x[place], scene->y[place], scene->z[place]}, inverse = 1 / scene->r[place];
    *count = 0;
    for (uint32_t l = 0; l < scene->levels; l++) {
        double ball = limit * scene->r[place] + scene->level[l].radius_max, low[3], high[3];
        for (int axis = 0; axis < 3; axis++) low[axis] = centre[axis] - ball, high[axis] = centre[axis] + ball;
        fibrad_walk walk;
        fibrad_walk_begin(&walk, scene, &scene->level[l], low, high);
        while (fibrad_walk_next(&walk)) {
            int32_t periods[3] = {0};
            for (int axis = 0; axis < 3; axis++)
                if (scene->period[axis] > 0)
                    periods[axis] = (int32_t)fibrad_floor(walk.shift[axis] / scene->period[axis] + 0.5);
            bool image = periods[0] != 0 || periods[1] != 0 || periods[2] != 0;
            for (uint32_t j = walk.begin; j < walk.end; j++) {
                double x = (scene->x[j] - centre[0] + walk.shift[0]) * inverse;
                double y = (scene->y[j] - centre[1] + walk.shift[1]) * inverse;
                double z = (scene->z[j] - centre[2] + walk.shift[2]) * inverse, r = scene->r[j] * inverse;
                double clearance = fibrad_sqrt(x * x + y * y + z * z) - r;
                if (clearance > limit || (j == place && !image)) continue;
                if (*count == CANDIDATES) return false;
                tracer->candidate[(*count)++] = (fibrad_candidate){
                    clearance, {x, y, z}, r, j, {(int8_t)periods[0], (int8_t)periods[1], (int8_t)periods[2]}};
            }
        }
    }
    return true;
}

/* Fills one place of a list. Floats err so that a sphere may be looked at in vain, but never the other way round, as in
 * row/neighbours_lanes.c; beyond the range of floats all are looked at. */
static void enter(fibrad_nearby *list, uint32_t k, const fibrad_candidate *s) {
    double square = s->c[0] * s->c[0] + s->c[1] * s->c[1] + s->c[2] * s->c[2];
    double about = 1 + fibrad_abs(s->c[0]) + fibrad_abs(s->c[1]) + fibrad_abs(s->c[2]);
    bool small = about < 1e18;
    list->x[k] = small ? (float)s->c[0] : 0;
    list->y[k] = small ? (float)s->c[1] : 0;
    list->z[k] = small ? (float)s->c[2] : 0;
    list->q[k] = small ? (float)(square + 1 - s->r * s->r - 4e-6 * about * about) : -FLT_MAX;
    list->sphere[k] = s->sphere;
    for (int axis = 0; axis < 3; axis++) list->periods[k][axis] = s->periods[axis];
}

/* Rays start at distance 1 from the centre; the rest is for rounding. */
static double length_for(double clearance) { return clearance * (1 - 1e-9) - 1 - 1e-9; }

static void make(fibrad_tracer *tracer, fibrad_nearby *list, uint32_t place) {
    const fibrad_scene *scene = tracer->scene;
    double reach = REACH * scene->spacing / scene->r[place];
    /* so few periods that they fit into their bytes */
    for (int axis = 0; axis < 3; axis++)
        if (scene->period[axis] > 0) reach = fibrad_min(reach, 60 * scene->period[axis] / scene->r[place]);
    double limit = 1 + reach;
    uint32_t count = 0;
    while (!gather(tracer, place, limit, &count)) {
        if (limit > 1.001) {
            limit = 1 + (limit - 1) / 2;
        } else { /* hundreds of small ones touch this sphere: the grid alone */
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
        for (uint32_t k = g * FIBRAD_GROUP; k < (g + 1) * FIBRAD_GROUP; k++) {
            if (k < listed) {
                const fibrad_candidate *s = &tracer->candidate[(uint32_t)key[k]];
                least = fibrad_min(least, s->clearance);
                farthest = fibrad_max(farthest, s->clearance + s->r);
                enter(list, k, s);
            } else {
                list->x[k] = list->y[k] = list->z[k] = 0;
                list->q[k] = FLT_MAX;
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
        make(tracer, list, place);
        tracer->owner[slot] = place;
    }
    return list;
}
