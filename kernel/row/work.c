/* work.c - lays out the work memory of one thread, and collects the entries of a row. SPDX-License-Identifier: MIT */
#include "row/work.h"
#include "base/arena.h"
#include "base/sort.h"

#define DEFAULT_NEAR    1024u
#define DEFAULT_DISCS   256u
#define DEFAULT_ENTRIES 1024u

/* Takes the arrays of `work` from the arena; the object itself is to be copied to the address returned.
 * FIBRAD_WORK_BYTES in fibrad.h must be kept above what this takes. */
static fibrad_work *layout(fibrad_arena *arena, const fibrad_work_config *config, fibrad_work *work) {
    fibrad_work *place = fibrad_arena_take(arena, 1, sizeof *work);
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

int fibrad_work_init(fibrad_work **out, void *memory, size_t size, const fibrad_work_config *config) {
    if (out == NULL) return FIBRAD_E_ARGUMENT;
    fibrad_arena arena;
    int status = fibrad_arena_open(&arena, memory, size, fibrad_work_size(config));
    if (status != FIBRAD_OK) return status;
    fibrad_work_config c = completed(config);
    fibrad_work fields = {0};
    fibrad_zero(memory, fibrad_work_size(config)); /* lanes beyond a count are computed too, and must be harmless */
    fibrad_work *work = layout(&arena, &c, &fields);
    for (uint32_t slot = 0; slot < fields.entries.slots; slot++) fields.entries.at[slot] = FIBRAD_NONE;
    *work = fields;
    *out = work;
    return FIBRAD_OK;
}

void fibrad_work_needed(const fibrad_work *work, fibrad_work_config *config) {
    if (work != NULL && config != NULL) *config = work->needed;
}

static uint32_t slot_of(const fibrad_entries *entries, uint32_t sphere) {
    uint32_t mask = entries->slots - 1, slot = (sphere * 2654435769u >> 7) & mask; /* Fibonacci hashing */
    while (entries->at[slot] != FIBRAD_NONE && entries->sphere[entries->at[slot]] != sphere) slot = (slot + 1) & mask;
    return slot;
}

uint32_t fibrad_entries_of(fibrad_entries *entries, uint32_t sphere) {
    uint32_t slot = slot_of(entries, sphere), entry = entries->at[slot];
    if (entry != FIBRAD_NONE || entries->length == entries->capacity) return entry;
    entry = entries->at[slot] = entries->length++;
    entries->slot[entry] = slot;
    entries->sphere[entry] = sphere;
    for (int part = 0; part < 4; part++) entries->part[entry][part] = 0;
    entries->lengths[entry] = entries->angles[entry] = 0;
    return entry;
}

uint32_t fibrad_entries_find(const fibrad_entries *entries, uint32_t sphere) {
    return entries->at[slot_of(entries, sphere)];
}

int fibrad_entries_row(const fibrad_work *work, double scale, fibrad_row *row) {
    const fibrad_entries *entries = &work->entries;
    uint32_t n = entries->length;
    row->length = n;
    if (n > row->capacity) return FIBRAD_E_CAPACITY;
    double square = 0;
    for (uint32_t k = 0; k < n; k++) {
        const double *part = entries->part[k];
        double difference = (part[0] + part[2] - part[1] - part[3]) * scale;
        square += difference * difference;
        entries->key[0][k] = (uint64_t)work->scene->order[entries->sphere[k]] << 32 | k;
    }
    row->error = fibrad_sqrt(square);

    const uint64_t *key = fibrad_sort_keys(entries->key[0], entries->key[1], n, 32, work->scene->facts.spheres - 1);
    for (uint32_t k = 0; k < n; k++) {
        uint32_t entry = (uint32_t)key[k];
        row->col[k] = (uint32_t)(key[k] >> 32);
        const double *part = entries->part[entry];
        row->f[k] = (part[0] + part[2] + (part[1] + part[3])) * scale;
    }
    return FIBRAD_OK;
}

/* Where the error falls by the same ratio from fourths to halves as from halves to the whole, it is halves^2/fourths.
 * The bounds are measured, docs/accuracy.md: the factor where many windows see each sphere, and that of independent
 * windows. */
double fibrad_entries_gain(const fibrad_entries *entries) {
    const double least = 0.5, most = 1.1;
    double halves = 0, fourths = 0;
    for (uint32_t k = 0; k < entries->length; k++) {
        const double *part = entries->part[k];
        double half = part[0] + part[2] - part[1] - part[3], even = part[0] - part[2], odd = part[1] - part[3];
        halves += half * half;
        fourths += even * even + odd * odd;
    }
    if (!(halves < fourths)) return most;
    return fibrad_max(least, most * fibrad_sqrt(halves / fourths));
}
