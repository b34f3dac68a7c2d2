/* silhouettes.c - all rows of a scene from silhouettes: tasks, their pairs, and rows from these.
 * SPDX-License-Identifier: MIT */
#include "base/arena.h"
#include "base/constants.h"
#include "base/sort.h"
#include "row/row.h"
#include "sample/direction.h"
#include "sample/line.h"
#include "silhouette/circle_lanes.h"

#define TASK_SPHERES 256u     /* spheres of a task: those near each other share pairs in the cache */
#define TABLE_BEST   0x10000u /* slots of a task's table, ... */
#define TABLE_LEAST  0x2000u  /* ... and the least */

struct fibrad_silhouettes {
    const fibrad_scene *scene;
    uint64_t hash;
    uint32_t lines, spheres;
    fibrad_line *line; /* [lines] */
    uint32_t *first;   /* [spheres], by position in scene order: its first pair, numbered through all collections */
    const fibrad_pairs *pairs; /* [count], collections that were joined; NULL: not yet */
    uint32_t count;
    uint64_t serial;
};

/* ---- the object ------------------------------------------------------------------------------------------------- */

static fibrad_silhouettes *silhouettes_layout(fibrad_arena *arena, fibrad_silhouettes *s) {
    fibrad_silhouettes *place = fibrad_arena_take(arena, 1, sizeof *place);
    s->line = fibrad_arena_take(arena, s->lines, sizeof *s->line);
    s->first = fibrad_arena_take(arena, s->spheres, sizeof *s->first);
    return place;
}

/* The numbers that follow from the arguments; _ARGUMENT, _UNSUPPORTED. */
static int silhouettes_dimension(fibrad_silhouettes *s, const fibrad_scene *scene, const fibrad_silhouette_rule *rule) {
    uint32_t lines = rule != NULL ? rule->lines : 0;
    if (lines == 0) lines = FIBRAD_DIRECTIONS_DEFAULT;
    if (lines < FIBRAD_DIRECTIONS_MIN || lines > FIBRAD_DIRECTIONS_MAX) return FIBRAD_E_ARGUMENT;
    *s = (fibrad_silhouettes){.scene = scene, .hash = scene->hash, .lines = lines, .spheres = scene->facts.spheres};
    return scene->container.walls || scene->mesh.triangles > 0 || scene->region ? FIBRAD_E_UNSUPPORTED : FIBRAD_OK;
}

static size_t silhouettes_bytes(fibrad_silhouettes fields) {
    fibrad_arena arena = {0};
    silhouettes_layout(&arena, &fields);
    return fibrad_arena_total(&arena);
}

size_t fibrad_silhouettes_size(const fibrad_scene *scene, const fibrad_silhouette_rule *rule) {
    fibrad_silhouettes fields;
    if (!fibrad_scene_ready(scene) || silhouettes_dimension(&fields, scene, rule) != FIBRAD_OK) return 0;
    return silhouettes_bytes(fields);
}

/* Two unit vectors across a direction, and the direction. */
static void make_frame(const double d[3], double frame[9]) {
    const double x = fibrad_abs(d[0]), y = fibrad_abs(d[1]), z = fibrad_abs(d[2]);
    const int least = x <= y && x <= z ? 0 : y <= z ? 1 : 2;
    const double size = fibrad_sqrt(1 - d[least] * d[least]);
    for (int k = 0; k < 3; k++) frame[k] = ((k == least) - d[least] * d[k]) / size, frame[6 + k] = d[k];
    for (int k = 0; k < 3; k++) {
        const int next = (k + 1) % 3, last = (k + 2) % 3;
        frame[3 + k] = d[next] * frame[last] - d[last] * frame[next];
    }
}

/* Makes the lines in the last third of the frames, and from them the frames, first to last. */
static void make_lines(fibrad_silhouettes *s, uint64_t seed) {
    double *all = s->line[0].frame, turn[9], (*line)[3] = (double(*)[3])(void *)(all + (size_t)6 * s->lines);
    fibrad_lines_make(s->lines, line, all);
    if (seed != 0) fibrad_rotation(seed, turn);
    for (uint32_t k = 0; k < s->lines; k++) {
        double frame[9];
        make_frame(line[k], frame);
        if (seed != 0) fibrad_rotate_axes(turn, frame);
        fibrad_copy(s->line[k].frame, frame, sizeof frame);
    }
}

int fibrad_silhouettes_init(fibrad_silhouettes **out, void *memory, size_t size, const fibrad_scene *scene,
                            const fibrad_silhouette_rule *rule) {
    fibrad_silhouettes fields;
    fibrad_arena arena;
    if (out == NULL || scene == NULL) return FIBRAD_E_ARGUMENT;
    if (!fibrad_scene_ready(scene)) return FIBRAD_E_STATE;
    int status = silhouettes_dimension(&fields, scene, rule);
    if (status == FIBRAD_OK) status = fibrad_arena_open(&arena, memory, size, silhouettes_bytes(fields));
    if (status != FIBRAD_OK) return status;
    fibrad_silhouettes *s = silhouettes_layout(&arena, &fields);
    *s = fields;
    make_lines(s, rule != NULL ? rule->turn : 0);
    *out = s;
    return FIBRAD_OK;
}

/* ---- tasks ------------------------------------------------------------------------------------------------------ */

uint32_t fibrad_silhouettes_tasks(const fibrad_silhouettes *s) {
    return s == NULL ? 0 : s->spheres / TASK_SPHERES + (s->spheres % TASK_SPHERES != 0);
}

/* Takes the arrays of `c` from the arena; the object itself is to be copied to the address returned. */
static fibrad_circles *circles_layout(fibrad_arena *arena, fibrad_circles *c, uint32_t near, uint32_t slots,
                                      fibrad_pair_table *table) {
    fibrad_circles *place = fibrad_arena_take(arena, 1, sizeof *place);
    const size_t room = (size_t)near + 8 * FIBRAD_CIRCLE_ROOM;
    for (int axis = 0; axis < 3; axis++) {
        c->home[axis] = fibrad_arena_take(arena, room, sizeof(double));
        c->away[axis] = fibrad_arena_take(arena, room, sizeof(double));
    }
    c->radius = fibrad_arena_take(arena, room, sizeof(double));
    c->sphere = fibrad_arena_take(arena, room, sizeof(uint32_t));
    for (int half = 0; half < 2; half++) c->sum[half] = fibrad_arena_take(arena, room, sizeof(int64_t));
    c->surroundings = (uint32_t)room - 1;
    table->slot = fibrad_arena_take(arena, slots, sizeof *table->slot);
    return place;
}

static size_t circles_bytes(uint32_t slots) {
    fibrad_arena arena = {0};
    fibrad_circles fields;
    fibrad_pair_table table;
    circles_layout(&arena, &fields, FIBRAD_NEAR_MOST, slots, &table);
    return fibrad_arena_total(&arena);
}

/* A power of two whose ulp is the grid of projected centres: with periods sums of centres and shifts are exact. */
static double grid_of(const fibrad_scene *scene, double scale) {
    double extent = 0, grid = 1;
    for (int axis = 0; axis < 3; axis++) extent += (scene->box_high[axis] - scene->box_low[axis]) * scale;
    while (grid < extent) grid *= 2;
    return grid * 0x1.8p6; /* 2^-46 of the extent, and 128 of it within range */
}

static void begin_circles(const fibrad_scene *scene, fibrad_circles *c) {
    c->scene = scene;
    c->scale = 1;
    while (c->scale * scene->facts.radius_max >= 2) c->scale /= 2;
    while (c->scale * scene->facts.radius_max < 1) c->scale *= 2;
    c->periodic = false;
    for (int axis = 0; axis < 3; axis++) {
        c->origin[axis] = scene->box_low[axis];
        c->period[axis] = scene->period[axis] * c->scale;
        c->periodic = c->periodic || scene->period[axis] > 0;
    }
    c->grid = c->periodic ? grid_of(scene, c->scale) : 0;
    c->sphere[c->surroundings] = FIBRAD_NONE;
}

/* Lays scratch memory out for circles, with as large a table as there is room for. */
static fibrad_circles *open_circles(fibrad_workspace *space, const fibrad_scene *scene, fibrad_pair_table *table) {
    fibrad_circles fields = {0};
    uint32_t slots = TABLE_BEST;
    while (circles_bytes(slots) > space->plan.extra) slots /= 2;
    space->extra_owner = 0;
    fibrad_arena arena = {0};
    const size_t lead = fibrad_arena_lead(space->extra);
    arena.base = (unsigned char *)space->extra + lead, arena.size = space->plan.extra - lead;
    fibrad_circles *c = circles_layout(&arena, &fields, FIBRAD_NEAR_MOST, slots, table);
    fibrad_zero(c, sizeof *c);
    begin_circles(scene, &fields);
    *c = fields;
    table->slots = slots, table->used = 0, table->shift = 64;
    for (uint32_t size = slots; size > 1; size /= 2) table->shift--;
    for (uint32_t k = 0; k < slots; k++) table->slot[k] = (fibrad_pair_sum){.key = UINT64_MAX};
    return c;
}

/* Makes room for some more pairs. */
static int reserve_pairs(fibrad_pairs *pairs, size_t more) {
    fibrad_memory *memory = &pairs->memory;
    const size_t needed = (pairs->count + more) * sizeof(fibrad_pair) + FIBRAD_ALIGNMENT;
    if (memory->block != NULL && needed <= memory->size) return FIBRAD_OK;
    memory->needed = needed;
    if (memory->resize == NULL) return FIBRAD_E_CAPACITY;
    const size_t size = needed < SIZE_MAX / 2 ? needed + needed / 2 : needed;
    void *block = memory->resize(memory->context, memory->block, size);
    if (block == NULL) return FIBRAD_E_MEMORY;
    memory->block = block, memory->size = size;
    return FIBRAD_OK;
}

/* Moves the pairs of a table into a collection. */
static int empty_table(fibrad_pair_table *table, fibrad_pairs *pairs) {
    const int status = reserve_pairs(pairs, table->used);
    if (status != FIBRAD_OK) return status;
    fibrad_pair *to = fibrad_pairs_of(pairs) + pairs->count;
    for (uint32_t k = 0; k < table->slots; k++) {
        fibrad_pair_sum *slot = &table->slot[k];
        if (slot->key == UINT64_MAX) continue;
        if (slot->sum[0] != 0 || slot->sum[1] != 0)
            *to++ = (fibrad_pair){.first = (uint32_t)(slot->key >> 32),
                                  .second = (uint32_t)slot->key,
                                  .sum = {slot->sum[0], slot->sum[1]}};
        *slot = (fibrad_pair_sum){.key = UINT64_MAX};
    }
    pairs->count = (size_t)(to - fibrad_pairs_of(pairs));
    table->used = 0;
    return FIBRAD_OK;
}

/* Follows the circles of spheres [from, to) in scene order. */
static int follow_spheres(const fibrad_silhouettes *s, fibrad_workspace *space, uint32_t from, uint32_t to,
                          fibrad_pairs *pairs) {
    fibrad_pair_table table;
    fibrad_circles *c = open_circles(space, s->scene, &table);
    int status = FIBRAD_OK;
    for (uint32_t place = from; place < to; place++)
        for (uint32_t line = 0; line < s->lines && status == FIBRAD_OK;) {
            status = FIBRAD_VERSION_OF(fibrad_circle_lines, s->scene->facts.isa)(space, c, place, s->line, &line,
                                                                                 s->lines, &table);
            const bool full = !fibrad_pair_room(&table, FIBRAD_CIRCLE_ENDS + FIBRAD_NEAR_MOST);
            if (status == FIBRAD_OK && full) status = empty_table(&table, pairs);
        }
    return status != FIBRAD_OK ? status : empty_table(&table, pairs);
}

int fibrad_silhouettes_task(const fibrad_silhouettes *s, fibrad_work *work, uint32_t task, fibrad_pairs *pairs) {
    if (s == NULL || work == NULL || pairs == NULL) return FIBRAD_E_ARGUMENT;
    if (!fibrad_memory_valid(&pairs->memory) || task >= fibrad_silhouettes_tasks(s)) return FIBRAD_E_ARGUMENT;
    if (s->scene->hash != s->hash) return FIBRAD_E_STATE;
    const uint32_t from = task * TASK_SPHERES, left = s->spheres - from;
    const size_t before = pairs->count;
    fibrad_workspace *space;
    pairs->serial++;
    int status = fibrad_work_open(work, s->scene, circles_bytes(TABLE_LEAST), circles_bytes(TABLE_BEST), &space);
    while (status == FIBRAD_OK) {
        status = follow_spheres(s, space, from, from + (left < TASK_SPHERES ? left : TASK_SPHERES), pairs);
        if (status != FIBRAD_E_WORK) break;
        pairs->count = before;
        status = fibrad_work_grow(work, &space);
    }
    if (status != FIBRAD_OK) pairs->count = before;
    return status;
}

/* ---- rows ------------------------------------------------------------------------------------------------------- */

/* Links the pairs of each sphere. */
static void link_pairs(fibrad_silhouettes *s, fibrad_pairs *pairs, uint32_t number) {
    fibrad_pair *pair = fibrad_pairs_of(pairs);
    for (size_t k = 0; k < pairs->count; k++, number++) {
        pair[k].next[0] = s->first[pair[k].first], s->first[pair[k].first] = number;
        if (pair[k].second == FIBRAD_NONE || pair[k].second == pair[k].first) continue;
        pair[k].next[1] = s->first[pair[k].second], s->first[pair[k].second] = number;
    }
}

int fibrad_silhouettes_join(fibrad_silhouettes *s, fibrad_pairs *pairs, uint32_t count) {
    if (s == NULL || (pairs == NULL && count > 0)) return FIBRAD_E_ARGUMENT;
    if (s->scene->hash != s->hash) return FIBRAD_E_STATE;
    uint64_t all = 0;
    for (uint32_t c = 0; c < count; c++) all += pairs[c].count;
    if (all >= FIBRAD_NONE) return FIBRAD_E_UNSUPPORTED;
    for (uint32_t k = 0; k < s->spheres; k++) s->first[k] = FIBRAD_NONE;
    s->pairs = pairs, s->count = count, s->serial = 0;
    uint32_t number = 0;
    for (uint32_t c = 0; c < count; number += (uint32_t)pairs[c++].count) {
        link_pairs(s, &pairs[c], number);
        s->serial += pairs[c].serial;
    }
    return FIBRAD_OK;
}

static uint64_t serial_of(const fibrad_silhouettes *s) {
    uint64_t serial = 0;
    for (uint32_t c = 0; c < s->count; c++) serial += s->pairs[c].serial;
    return serial;
}

static const fibrad_pair *pair_of(const fibrad_silhouettes *s, uint32_t number) {
    uint32_t c = 0;
    for (; number >= s->pairs[c].count; c++) number -= (uint32_t)s->pairs[c].count;
    return fibrad_pairs_of(&s->pairs[c]) + number;
}

/* Sums of one entry, kept where rows by beams have their parts. */
typedef struct entry_sum {
    int64_t sum[2];
    uint32_t place, unused[3];
} entry_sum;

/* Lists all pairs of the sphere at a position, and what it exchanges with the surroundings. _WORK */
static int gather_pairs(const fibrad_silhouettes *s, fibrad_workspace *space, uint32_t place, int64_t open[2],
                        uint32_t *count) {
    fibrad_entries *entries = &space->entries;
    entry_sum *to = (entry_sum *)(void *)entries->part;
    uint32_t n = 0;
    for (uint32_t number = s->first[place]; number != FIBRAD_NONE;) {
        const fibrad_pair *pair = pair_of(s, number);
        const bool second = pair->first != place;
        const uint32_t other = second ? pair->first : pair->second;
        number = pair->next[second];
        if (other == FIBRAD_NONE) {
            open[0] += pair->sum[0], open[1] += pair->sum[1];
            continue;
        }
        if (n < entries->capacity) {
            to[n] = (entry_sum){{pair->sum[0], pair->sum[1]}, other, {0}};
            entries->key[0][n] = (uint64_t)s->scene->order[other] << 32 | n;
        }
        n++;
    }
    *count = n;
    if (n <= entries->capacity) return FIBRAD_OK;
    space->needed = space->plan;
    space->needed.entries = n;
    return FIBRAD_E_WORK;
}

/* What of a row follows from sums over even and over odd lines, and what their means differ by. */
static double factor_of(const fibrad_silhouettes *s, const int64_t sum[2], double scale, double *square) {
    const uint32_t odd = s->lines / 2, even = s->lines - odd;
    const double difference = ((double)sum[0] / even - (double)sum[1] / odd) * (s->lines * scale / 2);
    *square += difference * difference;
    return (double)(sum[0] + sum[1]) * scale;
}

/* Half the difference of the halves of a set errs this much more than the whole: docs/accuracy.md. */
#define HALVES_ERROR 0.4

static int row_of_pairs(const fibrad_scene *scene, fibrad_workspace *space, uint32_t i, const void *silhouettes,
                        fibrad_row *row) {
    const fibrad_silhouettes *s = silhouettes;
    const entry_sum *entry = (const entry_sum *)(const void *)space->entries.part;
    const uint32_t place = scene->place[i];
    const double r = scene->r[place], unit = 1 / (FIBRAD_PAIR_UNITS * 2 * FIBRAD_PI * s->lines);
    int64_t open[2] = {0, 0};
    double square = 0;
    uint32_t count, n = 0;
    const int status = gather_pairs(s, space, place, open, &count);
    if (status != FIBRAD_OK) return status;
    const uint64_t *key =
        fibrad_sort_keys(space->entries.key[0], space->entries.key[1], count, 32, scene->facts.spheres - 1);
    for (uint32_t k = 0, end; k < count; k = end) {
        const entry_sum *first = &entry[(uint32_t)key[k]];
        int64_t sum[2] = {0, 0};
        for (end = k; end < count && key[end] >> 32 == key[k] >> 32; end++)
            for (int half = 0; half < 2; half++) sum[half] += entry[(uint32_t)key[end]].sum[half];
        const double ratio = fibrad_min(1, scene->r[first->place] / r), area = unit * (ratio * ratio);
        const double f = factor_of(s, sum, first->place == place ? 2 * area : area, &square);
        if (f <= 0) continue; /* what has cancelled, to rounding */
        if (n < row->capacity) row->col[n] = scene->order[first->place], row->f[n] = f;
        n++;
    }
    row->length = n;
    if (n > row->capacity) return FIBRAD_E_CAPACITY;
    row->escaped = fibrad_max(0, factor_of(s, open, unit, &square));
    row->beyond = 0;
    row->error = HALVES_ERROR * fibrad_sqrt(square);
    row->directions = s->lines;
    row->fallbacks = 0;
    row->symmetric = 1;
    return fibrad_row_checked(scene, row);
}

int fibrad_silhouettes_row(const fibrad_silhouettes *s, fibrad_work *work, uint32_t i, fibrad_row *row) {
    if (s == NULL) return FIBRAD_E_ARGUMENT;
    if (s->pairs == NULL || s->scene->hash != s->hash || s->serial != serial_of(s)) return FIBRAD_E_STATE;
    return fibrad_row_run(s->scene, work, i, &(fibrad_row_method){row_of_pairs, s, 0, 0}, row);
}
