/* workspace.c - lays out the work memory of one thread, and makes it larger. SPDX-License-Identifier: MIT
 *
 * Callers do not see the inside of work memory. At first it is laid out for a packed bed, or for as much of that as
 * the block has room for. When a row asks for more, it is laid out again. The new layout is in a larger block, or in
 * the same block: then lists that only save time become shorter. No result is lost, since each row begins with empty
 * memory. */
#include "workspace/workspace.h"
#include "base/arena.h"
#include "base/constants.h"
#include "base/random.h"

/* The sizes that a packed bed needs. */
#define USUAL_DISCS    256u
#define USUAL_ENTRIES  1024u
#define ENOUGH_DISCS   64u
#define ENOUGH_ENTRIES 256u
#define MOST_SEEN      8192u /* octants of directions have lists of their own for up to so many near spheres */
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
    near->fx = fibrad_arena_take(arena, near->capacity, sizeof(float));
    near->fy = fibrad_arena_take(arena, near->capacity, sizeof(float));
    near->fz = fibrad_arena_take(arena, near->capacity, sizeof(float));
    near->fe = fibrad_arena_take(arena, near->capacity, sizeof(float));
    near->fq = fibrad_arena_take(arena, near->capacity, sizeof(float));
    near->fsquare = fibrad_arena_take(arena, near->capacity, sizeof(float));
    near->count = fibrad_arena_take(arena, near->capacity, sizeof *near->count);
    near->x = fibrad_arena_take(arena, near->capacity, sizeof(double));
    near->y = fibrad_arena_take(arena, near->capacity, sizeof(double));
    near->z = fibrad_arena_take(arena, near->capacity, sizeof(double));
    near->r = fibrad_arena_take(arena, near->capacity, sizeof(double));
    near->sphere = fibrad_arena_take(arena, near->capacity + discs, sizeof(uint32_t));
    near->entry = fibrad_arena_take(arena, near->capacity + discs, sizeof(uint32_t));
    near->all = (fibrad_sight){.x = near->fx, .y = near->fy, .z = near->fz, .e = near->fe, .square = near->fsquare};
    near->all.near = fibrad_arena_take(arena, near->capacity, sizeof(uint32_t));
    near->sights = ((near->capacity < MOST_SEEN ? near->capacity : MOST_SEEN) / 4 + 15) / 16 * 16;
    for (int octant = 0; octant < 8; octant++) {
        fibrad_sight *sight = &near->octant[octant];
        sight->x = fibrad_arena_take(arena, near->sights, sizeof(float));
        sight->y = fibrad_arena_take(arena, near->sights, sizeof(float));
        sight->z = fibrad_arena_take(arena, near->sights, sizeof(float));
        sight->e = fibrad_arena_take(arena, near->sights, sizeof(float));
        sight->square = fibrad_arena_take(arena, near->sights, sizeof(float));
        sight->near = fibrad_arena_take(arena, near->sights, sizeof(uint32_t));
    }

    fibrad_discs *disc = &work->disc;
    disc->capacity = plan->discs;
    disc->depth = fibrad_arena_take(arena, discs, sizeof(double));
    disc->u = fibrad_arena_take(arena, discs, sizeof(double));
    disc->v = fibrad_arena_take(arena, discs, sizeof(double));
    disc->r = fibrad_arena_take(arena, discs, sizeof(double));
    disc->resolved = fibrad_arena_take(arena, discs, sizeof(double));
    disc->fu = fibrad_arena_take(arena, discs, sizeof(float));
    disc->fv = fibrad_arena_take(arena, discs, sizeof(float));
    disc->square = fibrad_arena_take(arena, discs, sizeof(float));
    disc->fdepth = fibrad_arena_take(arena, discs, sizeof(float));
    disc->near = fibrad_arena_take(arena, discs + near->capacity, sizeof(uint32_t));
    disc->order = fibrad_arena_take(arena, discs, sizeof(uint32_t));
    disc->hidden_points = fibrad_arena_take(arena, discs, sizeof(uint32_t));
    disc->occluder = fibrad_arena_take(arena, discs, sizeof(uint32_t));
    for (int list = 0; list < 2; list++) disc->key[list] = fibrad_arena_take(arena, discs, sizeof(uint64_t));
    fibrad_areas_layout(&work->areas, arena, plan->discs);

    fibrad_entries *entries = &work->entries;
    entries->capacity = plan->entries;
    entries->slots = 16;
    while (entries->slots < plan->entries + plan->entries / 2) entries->slots *= 2;
    entries->at = fibrad_arena_take(arena, entries->slots, sizeof(uint32_t));
    entries->slot = fibrad_arena_take(arena, entries->capacity, sizeof(uint32_t));
    entries->sphere = fibrad_arena_take(arena, entries->capacity, sizeof(uint32_t));
    entries->part = fibrad_arena_take(arena, entries->capacity, sizeof *entries->part);
    entries->lengths = fibrad_arena_take(arena, entries->capacity, sizeof(double));
    entries->angles = fibrad_arena_take(arena, entries->capacity, sizeof(double));
    entries->exact = fibrad_arena_take(arena, entries->capacity, sizeof(double));
    for (int list = 0; list < 2; list++)
        entries->key[list] = fibrad_arena_take(arena, entries->capacity, sizeof(uint64_t));
    work->legs.leg = fibrad_arena_take(arena, plan->legs, sizeof *work->legs.leg);
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

static uint32_t less_of(uint32_t count, uint32_t least) {
    const uint32_t less = count - count / 4;
    return less > least && less < count ? less : least;
}

/* Makes a plan smaller until it fits into `size` bytes. First the lists that only save time become shorter. Then the
 * larger one of discs and entries, down to `least`. False: the plan does not fit. */
static bool shrink(fibrad_work_plan *plan, const fibrad_work_plan *least, size_t size) {
    while (bytes_of(plan) > size) {
        const bool entries_first = (size_t)plan->entries * 96 > (size_t)plan->discs * 768;
        if (plan->legs > least->legs)
            plan->legs = least->legs;
        else if (plan->extra > least->extra && (plan->extra > (size_t)plan->near * 64 || plan->near == least->near))
            plan->extra = plan->extra / 2 > least->extra ? plan->extra / 2 : least->extra;
        else if (plan->near > least->near)
            plan->near = less_of(plan->near, least->near);
        else if (plan->entries > least->entries && (entries_first || plan->discs == least->discs))
            plan->entries = less_of(plan->entries, least->entries);
        else if (plan->discs > least->discs)
            plan->discs = less_of(plan->discs, least->discs);
        else
            return false;
    }
    return true;
}

/* Lays out a plan in the block or in a larger block. If there is no larger block, it lays out as much as fits, but
 * no less than `least`. */
static int fit(fibrad_work *work, fibrad_work_plan plan, const fibrad_work_plan *least, fibrad_workspace **space) {
    fibrad_memory *memory = &work->memory;
    const fibrad_work_plan wanted = {plan.walls,   plan.met,     least->near, plan.discs,
                                     plan.entries, least->extra, least->legs};
    size_t bytes = bytes_of(&plan);
    if (bytes == 0) return FIBRAD_E_ARGUMENT;
    work->inside = NULL;
    if (memory->resize != NULL && (memory->block == NULL || memory->size < bytes)) {
        memory->needed = bytes;
        void *block = memory->resize(memory->context, memory->block, bytes);
        if (block == NULL) return FIBRAD_E_MEMORY;
        memory->block = block;
        memory->size = bytes;
    } else if (memory->block == NULL || !shrink(&plan, least, memory->size)) {
        memory->needed = bytes_of(&wanted);
        return FIBRAD_E_WORK;
    }
    *space = lay_out_work(work, &plan);
    return *space != NULL ? FIBRAD_OK : FIBRAD_E_WORK;
}

int fibrad_work_open(fibrad_work *work, const fibrad_scene *scene, size_t extra_min, size_t extra_best,
                     fibrad_workspace **space) {
    const uint32_t walls = scene->container.walls, met = scene->mesh.triangles > 0;
    if (!fibrad_memory_valid(&work->memory)) return FIBRAD_E_ARGUMENT;
    fibrad_workspace *inside = inside_of(work);
    fibrad_work_plan plan = {walls, met, FIBRAD_NEAR_MOST, USUAL_DISCS, USUAL_ENTRIES, extra_best, 0};
    const fibrad_work_plan least = {walls, met, LEAST_NEAR, LEAST_COUNT, LEAST_COUNT, extra_min, 0};
    if (inside != NULL && inside->plan.extra >= extra_min && inside->plan.walls >= walls && inside->plan.met >= met) {
        inside->least = least;
        *space = inside;
        return FIBRAD_OK;
    }
    if (inside != NULL) {
        plan = inside->plan;
        plan.walls = walls, plan.met = met;
        plan.extra = extra_best;
    }
    const int status = fit(work, plan, &least, space);
    if (status == FIBRAD_OK) (*space)->least = least;
    if (status == FIBRAD_E_WORK) { /* the size that most rows of a packed bed need, which is not the fastest size */
        const fibrad_work_plan enough = {walls, met, LEAST_NEAR, ENOUGH_DISCS, ENOUGH_ENTRIES, extra_min, 0};
        work->memory.needed = bytes_of(&enough);
    }
    return status;
}

int fibrad_work_grow(fibrad_work *work, fibrad_workspace **space) {
    const fibrad_workspace *now = *space;
    fibrad_work_plan plan = now->plan, least = now->least;
    plan.walls = least.walls, plan.met = least.met;
    const fibrad_work_plan needed = now->needed;
    const bool more = needed.near > plan.near || needed.discs > plan.discs || needed.entries > plan.entries ||
                      needed.extra > plan.extra || needed.legs > plan.legs;
    if (!more) return FIBRAD_E_UNSUPPORTED; /* without this the call would be repeated for ever */
    /* a size that was once too small in this call must not become smaller again */
    if (needed.near > plan.near) plan.near = least.near = needed.near;
    if (needed.discs > plan.discs) least.discs = plan.discs + 1, plan.discs = needed.discs;
    if (needed.entries > plan.entries) least.entries = plan.entries + 1, plan.entries = needed.entries;
    if (needed.extra > plan.extra) plan.extra = least.extra = needed.extra;
    if (needed.legs > plan.legs) plan.legs = least.legs = needed.legs;
    const int status = fit(work, plan, &least, space);
    if (status == FIBRAD_OK) (*space)->least = least;
    return status;
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
    const uint32_t met = space->disc.count, room = space->disc.capacity;
    space->needed.discs = met > 2 * room ? met : 2 * room;
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
    work->entries.grid = (fibrad_grid){0, 0};
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
    work->cut = cutoff > 0 || scene->region;
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
    for (int axis = 0; axis < 3; axis++) {
        if (w[axis] != 0) horizon = fibrad_min(horizon, work->extent[axis][w[axis] > 0] / fibrad_abs(w[axis]));
    }
    return horizon;
}
