/* tracer.c - memory of a tracer and its lists of near spheres. SPDX-License-Identifier: MIT */
#include "ray/tracer.h"

#define LISTS_MIN 16u

/* A list of a cell is made when this many rays have begun in the cell. */
#define CELL_RAYS 4u

static void tracer_layout(fibrad_arena *arena, uint32_t lists, fibrad_tracer *tracer) {
    tracer->lists = lists;
    tracer->cells = lists > LISTS_MIN ? lists / 2 : 1;
    tracer->owner = fibrad_arena_take(arena, lists, sizeof *tracer->owner);
    tracer->nearby = fibrad_arena_take(arena, lists + tracer->cells, sizeof *tracer->nearby);
    tracer->cell = fibrad_arena_take(arena, tracer->cells, sizeof *tracer->cell);
    fibrad_candidates *of = &tracer->candidates;
    fibrad_arena_doubles(arena, FIBRAD_CANDIDATES,
                         (double **const[]){&of->x, &of->y, &of->z, &of->r, &of->clearance, NULL});
    fibrad_arena_floats(arena, FIBRAD_CANDIDATES, (float **const[]){&of->fx, &of->fy, &of->fz, &of->fq, NULL});
    of->sphere = fibrad_arena_take(arena, FIBRAD_CANDIDATES, sizeof *of->sphere);
    of->periods = fibrad_arena_take(arena, FIBRAD_CANDIDATES, sizeof *of->periods);
    of->order = fibrad_arena_take(arena, FIBRAD_CANDIDATES, sizeof *of->order);
    of->step = fibrad_arena_take(arena, FIBRAD_CANDIDATES, sizeof *of->step);
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

static void make_nearby(const fibrad_tracer *tracer, const fibrad_ball *from, fibrad_nearby *list) {
    FIBRAD_VERSION_OF(fibrad_nearby_make, tracer->scene->facts.isa)(tracer, from, list);
}

const fibrad_nearby *fibrad_tracer_nearby(fibrad_tracer *tracer, uint32_t place) {
    uint32_t slot = place & (tracer->lists - 1);
    fibrad_nearby *list = &tracer->nearby[slot];
    if (tracer->owner[slot] != place) {
        const fibrad_scene *scene = tracer->scene;
        const fibrad_ball ball = {{scene->x[place], scene->y[place], scene->z[place]}, scene->r[place], place};
        make_nearby(tracer, &ball, list);
        tracer->owner[slot] = place;
    }
    return list;
}

const fibrad_nearby *fibrad_tracer_cell_of(fibrad_tracer *tracer, const double point[3], double start[3],
                                           double *radius) {
    const double edge = tracer->scene->spacing, half = 0.5 * edge;
    fibrad_ball ball = {.radius = half * fibrad_sqrt(3) * (1 + 1e-9), .place = FIBRAD_NONE};
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
    make_nearby(tracer, &ball, cell->list);
    return cell->list;
}
