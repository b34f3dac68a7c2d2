/* workspace.c - lays out the work memory of one thread, and makes it larger. SPDX-License-Identifier: MIT
 *
 * Callers do not see the inside of work memory. At first it is laid out for a packed bed, or for as much of that as
 * the block has room for. When a row asks for more, it is laid out again. The new layout is in a larger block, or in
 * the same block: then lists that only save time become shorter. No result is lost, since each row begins with empty
 * memory. */
#include "workspace/workspace.h"

/* The sizes that a packed bed needs. */
#define USUAL_DISCS   256u
#define USUAL_ENTRIES 1024u
#define MOST_SEEN     8192u /* octants of directions have lists of their own for up to so many near spheres */
/* The smallest sizes that work. */
#define LEAST_NEAR  16u
#define LEAST_COUNT 4u

/* Takes the arrays of `work` from the arena. The caller copies the object itself to the address returned.
 * FIBRAD_WORK_BYTES and _WALLS in fibrad.h must be larger than this layout. */
static fibrad_workspace *work_layout(fibrad_arena *arena, const fibrad_work_plan *plan, fibrad_workspace *work) {
    fibrad_workspace *place = fibrad_arena_take(arena, 1, sizeof *work);
    work->plan = work->needed = *plan;

    size_t discs = (size_t)plan->discs + FIBRAD_LANES_MAX;
    fibrad_near *near = &work->near;
    near->capacity = (plan->near + 15) / 16 * 16;
    fibrad_arena_floats(arena, near->capacity,
                        (float **const[]){&near->fx, &near->fy, &near->fz, &near->fe, &near->fq, &near->fsquare, NULL});
    fibrad_arena_doubles(arena, near->capacity, (double **const[]){&near->x, &near->y, &near->z, &near->r, NULL});
    fibrad_arena_words(arena, near->capacity + discs, (uint32_t * *const[]){&near->sphere, &near->entry, NULL});
    near->count = fibrad_arena_take(arena, near->capacity, sizeof *near->count);
    near->all = (fibrad_sight){.x = near->fx, .y = near->fy, .z = near->fz, .e = near->fe, .square = near->fsquare};
    near->all.near = fibrad_arena_take(arena, near->capacity, sizeof(uint32_t));
    near->sights = ((near->capacity < MOST_SEEN ? near->capacity : MOST_SEEN) / 4 + 15) / 16 * 16;
    for (int octant = 0; octant < 8; octant++) {
        fibrad_sight *s = &near->octant[octant];
        fibrad_arena_floats(arena, near->sights, (float **const[]){&s->x, &s->y, &s->z, &s->e, &s->square, NULL});
        s->near = fibrad_arena_take(arena, near->sights, sizeof(uint32_t));
    }

    fibrad_discs *disc = &work->disc;
    disc->capacity = plan->discs;
    fibrad_arena_doubles(arena, discs,
                         (double **const[]){&disc->depth, &disc->u, &disc->v, &disc->r, &disc->resolved, NULL});
    fibrad_arena_floats(arena, discs, (float **const[]){&disc->fu, &disc->fv, &disc->square, &disc->fdepth, NULL});
    fibrad_arena_words(arena, discs, (uint32_t * *const[]){&disc->order, &disc->hidden_points, &disc->occluder, NULL});
    disc->near = fibrad_arena_take(arena, discs + near->capacity, sizeof(uint32_t));
    for (int list = 0; list < 2; list++) disc->key[list] = fibrad_arena_take(arena, discs, sizeof(uint64_t));
    fibrad_areas_layout(&work->areas, arena, plan->discs);

    fibrad_entries *entries = &work->entries;
    entries->capacity = plan->entries;
    entries->slots = 16;
    while (entries->slots < plan->entries + plan->entries / 2) entries->slots *= 2;
    entries->at = fibrad_arena_take(arena, entries->slots, sizeof(uint32_t));
    fibrad_arena_words(arena, entries->capacity, (uint32_t * *const[]){&entries->slot, &entries->sphere, NULL});
    entries->part = fibrad_arena_take(arena, entries->capacity, sizeof *entries->part);
    fibrad_arena_doubles(arena, entries->capacity,
                         (double **const[]){&entries->lengths, &entries->angles, &entries->exact, NULL});
    for (int list = 0; list < 2; list++)
        entries->key[list] = fibrad_arena_take(arena, entries->capacity, sizeof(uint64_t));
    work->segments.segment = fibrad_arena_take(arena, plan->segments, sizeof *work->segments.segment);
    if (plan->walls > 0) work->walls = fibrad_arena_take(arena, 1, sizeof *work->walls);
    if (plan->met > 0) work->met = fibrad_arena_take(arena, 1, sizeof *work->met);
    work->extra = fibrad_arena_take(arena, plan->extra, 1);
    return place;
}

static size_t bytes_of(const fibrad_work_plan *plan) {
    if (plan->near > FIBRAD_WORK_MAX || plan->discs > FIBRAD_WORK_MAX || plan->entries > FIBRAD_WORK_MAX) return 0;
    fibrad_arena arena = {0};
    fibrad_workspace fields = {0};
    work_layout(&arena, plan, &fields);
    return fibrad_arena_total(&arena);
}

/* A word that only work memory laid out in this block has. */
static uint64_t seal_of(const fibrad_work *work) {
    return fibrad_mix((uintptr_t)work->memory.block ^ fibrad_mix(work->memory.size));
}

/* The inside of work memory. NULL: the block has not been laid out. */
static fibrad_workspace *inside_of(const fibrad_work *work) {
    unsigned char *block = work->memory.block;
    if (block == NULL || work->memory.size < sizeof(fibrad_workspace) + FIBRAD_ALIGNMENT) return NULL;
    fibrad_workspace *space = (fibrad_workspace *)(void *)(block + fibrad_arena_lead(block));
    return work->inside == space && space->seal == seal_of(work) ? space : NULL;
}

static fibrad_workspace *lay_out_work(fibrad_work *work, const fibrad_work_plan *plan) {
    fibrad_arena arena = {0};
    fibrad_workspace fields = {0};
    if (fibrad_arena_open(&arena, work->memory.block, work->memory.size, bytes_of(plan)) != FIBRAD_OK) return NULL;
    /* lanes beyond the end of a list are computed too, and must do no harm */
    fibrad_zero(arena.base, bytes_of(plan) - plan->extra - (FIBRAD_ALIGNMENT - 1));
    fibrad_workspace *space = work_layout(&arena, plan, &fields);
    for (uint32_t slot = 0; slot < fields.entries.slots; slot++) fields.entries.at[slot] = FIBRAD_NONE;
    for (uint32_t k = 0; k < fields.near.capacity; k++) fields.near.all.near[k] = k;
    fields.seal = seal_of(work);
    *space = fields;
    work->inside = space;
    return space;
}

static uint32_t greater_count(uint32_t a, uint32_t b) { return a > b ? a : b; }

/* The sizes of `best` divided by 2^times, but no less than `least`. */
static fibrad_work_plan divided(const fibrad_work_plan *best, const fibrad_work_plan *least, int times) {
    fibrad_work_plan plan = *least;
    plan.near = greater_count(plan.near, best->near >> times);
    plan.discs = greater_count(plan.discs, best->discs >> times);
    plan.entries = greater_count(plan.entries, best->entries >> times);
    if (best->extra >> times > plan.extra) plan.extra = best->extra >> times;
    return plan;
}

/* Lays out `best` if the block may grow. Otherwise as much of it as the block has room for, but no less than `least`.
 * If even that has no room, memory.needed is what most rows of a packed bed need, or twice of what this row needs. */
static int fit(fibrad_work *work, const fibrad_work_plan *best, const fibrad_work_plan *least,
               fibrad_workspace **space) {
    fibrad_memory *memory = &work->memory;
    fibrad_work_plan plan = divided(best, least, 0), enough = *least;
    size_t bytes = bytes_of(&plan);
    if (bytes == 0) return FIBRAD_E_ARGUMENT;
    work->inside = NULL;
    if (memory->resize != NULL && (memory->block == NULL || memory->size < bytes)) {
        memory->needed = bytes;
        void *block = memory->resize(memory->context, memory->block, bytes);
        if (block == NULL) return FIBRAD_E_MEMORY;
        memory->block = block;
        memory->size = bytes;
    }
    for (int times = 1; times < 32 && bytes > memory->size; times++)
        plan = divided(best, least, times), bytes = bytes_of(&plan);
    if (memory->block == NULL || bytes > memory->size) {
        enough.discs = greater_count(2 * least->discs, best->discs / 4);
        enough.entries = greater_count(2 * least->entries, best->entries / 4);
        memory->needed = bytes_of(&enough);
        return FIBRAD_E_WORK;
    }
    *space = lay_out_work(work, &plan);
    if (*space == NULL) return FIBRAD_E_WORK;
    (*space)->best = *best, (*space)->least = *least;
    return FIBRAD_OK;
}

int fibrad_work_open(fibrad_work *work, const fibrad_scene *scene, size_t extra_min, size_t extra_best,
                     fibrad_workspace **space) {
    const uint32_t walls = scene->container.walls, met = scene->mesh.triangles > 0;
    if (!fibrad_memory_valid(&work->memory)) return FIBRAD_E_ARGUMENT;
    fibrad_workspace *inside = inside_of(work);
    const fibrad_work_plan least = {walls, met, LEAST_NEAR, LEAST_COUNT, LEAST_COUNT, extra_min, 0};
    if (inside != NULL && inside->plan.extra >= extra_min && inside->plan.walls >= walls && inside->plan.met >= met) {
        inside->least = least;
        *space = inside;
        return FIBRAD_OK;
    }
    fibrad_work_plan best = {walls, met, FIBRAD_NEAR_MOST, USUAL_DISCS, USUAL_ENTRIES, extra_best, 0};
    if (inside != NULL) best = inside->best, best.extra = extra_best;
    return fit(work, &best, &least, space);
}

int fibrad_work_grow(fibrad_work *work, fibrad_workspace **space) {
    const fibrad_work_plan now = (*space)->plan, needed = (*space)->needed;
    fibrad_work_plan best = (*space)->best, least = (*space)->least;
    const bool more = needed.near > now.near || needed.discs > now.discs || needed.entries > now.entries ||
                      needed.extra > now.extra || needed.segments > now.segments;
    if (!more) return FIBRAD_E_UNSUPPORTED; /* without this the call would be repeated for ever */
    /* a size that was once too small in this call must not become smaller again */
    if (needed.near > now.near) least.near = needed.near;
    if (needed.discs > now.discs) least.discs = needed.discs, best.discs = greater_count(best.discs, 2 * needed.discs);
    if (needed.entries > now.entries)
        least.entries = needed.entries, best.entries = greater_count(best.entries, needed.entries);
    if (needed.extra > now.extra) least.extra = needed.extra;
    if (needed.segments > now.segments) least.segments = needed.segments;
    return fit(work, &best, &least, space);
}

int fibrad_work_entries_missed(fibrad_workspace *space) {
    if (space->entries.missed == 0) return FIBRAD_OK;
    const uint64_t enough = (uint64_t)space->entries.capacity + space->entries.missed;
    const uint32_t spheres = space->scene->facts.spheres;
    const uint32_t most = space->scene->mesh.triangles > 0 ? spheres + FIBRAD_SLOTS : spheres;
    space->needed.entries = (uint32_t)(enough < most ? enough : most);
    return FIBRAD_E_WORK;
}

int fibrad_work_discs_missed(fibrad_workspace *space) {
    space->needed.discs = greater_count(space->disc.count, space->disc.capacity + 1);
    return FIBRAD_E_WORK;
}

/* How far along an axis, up or down, there may be spheres that come before a window. */
static double extent_along(const fibrad_workspace *work, int axis, int up) {
    const fibrad_scene *scene = work->scene;
    double far = up ? scene->high[axis] - work->centre[axis] : work->centre[axis] - scene->low[axis];
    if (scene->period[axis] > 0) far = FIBRAD_PERIODS * scene->period[axis];
    return (far + (work->unit + scene->facts.radius_max)) * work->inverse;
}

void fibrad_work_begin(fibrad_workspace *work, const fibrad_scene *scene, uint32_t place, double cutoff,
                       fibrad_stride stride) {
    for (uint32_t k = 0; k < work->entries.length; k++) work->entries.at[work->entries.slot[k]] = FIBRAD_NONE;
    work->entries.length = work->entries.missed = 0;
    work->entries.end = false;
    work->parallel = false;
    work->entries.masked = work->entries.halves = false;
    work->entries.weight = work->entries.balance[0] = work->entries.balance[1] = 1;
    fibrad_zero(work->wall, sizeof work->wall);
    work->needed = work->plan;
    work->scene = scene;
    work->place = place;
    work->unit = scene->r[place];
    work->inverse = 1 / work->unit;
    work->centre[0] = scene->x[place], work->centre[1] = scene->y[place], work->centre[2] = scene->z[place];
    work->reach = cutoff > 0 ? cutoff * (1 + 1e-12) * work->inverse : __builtin_inf();
    work->cut = cutoff > 0;
    work->step = stride.first * scene->spacing * work->inverse;
    work->growth = stride.growth;
    const double thin = scene->spacing / scene->facts.radius_max;
    work->free_path = thin * thin / FIBRAD_PI * scene->spacing * work->inverse;

    double farthest[3];
    for (int axis = 0; axis < 3; axis++)
        farthest[axis] = scene->period[axis] > 0 ? __builtin_inf()
                                                 : fibrad_max(work->centre[axis] - scene->low[axis],
                                                              scene->high[axis] - work->centre[axis]) *
                                                       work->inverse;
    work->farthest = fibrad_min(farthest[0] + farthest[1] + farthest[2], work->reach) * (1 + 1e-12);
    work->clear = work->farthest;
    for (int axis = 0; axis < 3; axis++)
        for (int up = 0; up < 2; up++) {
            work->extent[axis][up] = extent_along(work, axis, up);
            work->clear = fibrad_min(work->clear, work->extent[axis][up]);
        }
    work->clear_mesh = scene->clear != NULL ? scene->clear[place] : __builtin_inf();
    work->back = UINT32_MAX;
    if (work->met != NULL) work->met->any = false;
    work->near.shells = 0;
    for (int octant = 0; octant < 8; octant++) work->near.seen[octant] = NULL;
    work->near.full = false;
    work->near.asked = 0;
}

uint32_t fibrad_work_met(const fibrad_workspace *work, const double from[3], const double w[3], double ball) {
    double origin[3], distance;
    for (int axis = 0; axis < 3; axis++) origin[axis] = work->centre[axis] + work->unit * from[axis];
    return fibrad_surroundings_met(work->scene, origin, w, fibrad_ball_exit(from, w, ball) * work->unit, &distance);
}

double fibrad_near_horizon(const fibrad_workspace *work, const double w[3]) {
    double horizon = work->farthest;
    for (int axis = 0; axis < 3; axis++)
        if (w[axis] != 0) horizon = fibrad_min(horizon, work->extent[axis][w[axis] > 0] / fibrad_abs(w[axis]));
    return horizon;
}
