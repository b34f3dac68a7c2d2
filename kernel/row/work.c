/* work.c - lays out the work memory of one thread. SPDX-License-Identifier: MIT */
#include "row/work.h"
#include "base/arena.h"

#define DEFAULT_NEAR    1024u
#define DEFAULT_DISCS   256u
#define DEFAULT_ENTRIES 1024u

/* Takes the arrays of `work` from the arena; the object itself is to be copied to the address returned.
 * FIBRAD_WORK_BYTES in fibrad.h must be kept above what this takes. */
static fibrad_workspace *layout(fibrad_arena *arena, const fibrad_work_config *config, fibrad_workspace *work) {
    fibrad_workspace *place = fibrad_arena_take(arena, 1, sizeof *work);
    work->config = work->needed = *config;

    size_t discs = (size_t)config->discs + FIBRAD_LANES_MAX;
    fibrad_near *near = &work->near;
    near->capacity = (config->near + 15) / 16 * 16;
    near->fx = fibrad_arena_take(arena, near->capacity, sizeof(float));
    near->fy = fibrad_arena_take(arena, near->capacity, sizeof(float));
    near->fz = fibrad_arena_take(arena, near->capacity, sizeof(float));
    near->fe = fibrad_arena_take(arena, near->capacity, sizeof(float));
    near->fq = fibrad_arena_take(arena, near->capacity, sizeof(float));
    near->x = fibrad_arena_take(arena, near->capacity, sizeof(double));
    near->y = fibrad_arena_take(arena, near->capacity, sizeof(double));
    near->z = fibrad_arena_take(arena, near->capacity, sizeof(double));
    near->r = fibrad_arena_take(arena, near->capacity, sizeof(double));
    near->sphere = fibrad_arena_take(arena, near->capacity + discs, sizeof(uint32_t));
    near->entry = fibrad_arena_take(arena, near->capacity + discs, sizeof(uint32_t));

    for (int list = 0; list < 2; list++) {
        fibrad_obstacles *blockers = &work->blockers[list];
        blockers->x = fibrad_arena_take(arena, near->capacity, sizeof(double));
        blockers->y = fibrad_arena_take(arena, near->capacity, sizeof(double));
        blockers->z = fibrad_arena_take(arena, near->capacity, sizeof(double));
        blockers->r = fibrad_arena_take(arena, near->capacity, sizeof(double));
    }

    fibrad_discs *disc = &work->disc;
    disc->capacity = config->discs;
    disc->depth = fibrad_arena_take(arena, discs, sizeof(double));
    disc->u = fibrad_arena_take(arena, discs, sizeof(double));
    disc->v = fibrad_arena_take(arena, discs, sizeof(double));
    disc->r = fibrad_arena_take(arena, discs, sizeof(double));
    disc->fu = fibrad_arena_take(arena, discs, sizeof(float));
    disc->fv = fibrad_arena_take(arena, discs, sizeof(float));
    disc->square = fibrad_arena_take(arena, discs, sizeof(float));
    disc->near = fibrad_arena_take(arena, discs + near->capacity, sizeof(uint32_t));
    disc->order = fibrad_arena_take(arena, discs, sizeof(uint32_t));
    disc->hits = fibrad_arena_take(arena, discs, sizeof(uint32_t));
    disc->taker = fibrad_arena_take(arena, discs, sizeof(uint32_t));
    fibrad_areas_layout(&work->areas, arena, config->discs);

    fibrad_entries *entries = &work->entries;
    entries->capacity = config->entries;
    entries->slots = 16;
    while (entries->slots < config->entries + config->entries / 2) entries->slots *= 2;
    entries->at = fibrad_arena_take(arena, entries->slots, sizeof(uint32_t));
    entries->slot = fibrad_arena_take(arena, entries->capacity, sizeof(uint32_t));
    entries->sphere = fibrad_arena_take(arena, entries->capacity, sizeof(uint32_t));
    entries->part = fibrad_arena_take(arena, entries->capacity, sizeof *entries->part);
    entries->lengths = fibrad_arena_take(arena, entries->capacity, sizeof(double));
    entries->angles = fibrad_arena_take(arena, entries->capacity, sizeof(double));
    for (int list = 0; list < 2; list++)
        entries->key[list] = fibrad_arena_take(arena, entries->capacity, sizeof(uint64_t));
    return place;
}

static fibrad_work_config completed(const fibrad_work_config *config) {
    fibrad_work_config c = {0};
    if (config != NULL) c = *config;
    if (c.near == 0) c.near = DEFAULT_NEAR;
    if (c.discs == 0) c.discs = DEFAULT_DISCS;
    if (c.entries == 0) c.entries = DEFAULT_ENTRIES;
    return c;
}

size_t fibrad_work_size(const fibrad_work_config *config) {
    fibrad_work_config c = completed(config);
    if (c.near > FIBRAD_WORK_MAX || c.discs > FIBRAD_WORK_MAX || c.entries > FIBRAD_WORK_MAX) return 0;
    fibrad_arena arena = {0};
    fibrad_work fields = {0};
    layout(&arena, &c, &fields);
    return fibrad_arena_total(&arena);
}

int fibrad_work_init(fibrad_workspace **out, void *memory, size_t size, const fibrad_work_config *config) {
    if (out == NULL) return FIBRAD_E_ARGUMENT;
    fibrad_arena arena;
    int status = fibrad_arena_open(&arena, memory, size, fibrad_work_size(config));
    if (status != FIBRAD_OK) return status;
    fibrad_work_config c = completed(config);
    fibrad_work fields = {0};
    fibrad_zero(memory, fibrad_work_size(config)); /* lanes beyond a count are computed too, and must be harmless */
    fibrad_workspace *work = layout(&arena, &c, &fields);
    for (uint32_t slot = 0; slot < fields.entries.slots; slot++) fields.entries.at[slot] = FIBRAD_NONE;
    *work = fields;
    *out = work;
    return FIBRAD_OK;
}

void fibrad_work_needed(const fibrad_workspace *work, fibrad_work_config *config) {
    if (work != NULL && config != NULL) *config = work->needed;
}
