/* silhouettes.c - all rows of a scene from silhouettes: tasks, their pairs, and rows from these.
 * SPDX-License-Identifier: MIT */
#include "base/arena.h"
#include "base/constants.h"
#include "base/reserve.h"
#include "base/sort.h"
#include "row/row.h"
#include "sample/direction.h"
#include "sample/line.h"
#include "scene/grid_walk.h"
#include "silhouette/circle_lanes.h"
#include "silhouette/open_lanes.h"

#define AHEAD 16u /* memory is fetched ahead by this many pairs */

#define TASK_CIRCLES 256u     /* circles of each line in a task; circles near each other share pairs in the cache */
#define TABLE_BEST   0x10000u /* slots of a task's table */
#define TABLE_LEAST  0x2000u  /* ... and the least */

struct fibrad_silhouettes {
    const fibrad_scene *scene;
    uint64_t hash;
    uint32_t lines, spheres;
    fibrad_line *line;         /* [lines] */
    uint32_t *sequence;        /* [spheres], positions in scene order, in the order in which tasks take them */
    uint64_t *stretch;         /* [spheres + 1], in the order of `sequence`: stretches of those before */
    uint64_t *start;           /* [spheres + 1], by position in scene order: where its pairs are in `index` */
    const uint32_t *index;     /* [start[spheres]], pairs, numbered through all collections; NULL: not joined */
    const fibrad_pairs *pairs; /* [count], collections that were joined */
    uint32_t count;
    uint64_t serial, all; /* number of changes of these collections, and of elements of `index` */
};

/* ---- the object ------------------------------------------------------------------------------------------------- */

static fibrad_silhouettes *silhouettes_layout(fibrad_arena *arena, fibrad_silhouettes *s) {
    fibrad_silhouettes *place = fibrad_arena_take(arena, 1, sizeof *place);
    s->line = fibrad_arena_take(arena, s->lines, sizeof *s->line);
    s->sequence = fibrad_arena_take(arena, s->spheres, sizeof *s->sequence);
    s->stretch = fibrad_arena_take(arena, (size_t)s->spheres + 1, sizeof *s->stretch);
    s->start = fibrad_arena_take(arena, (size_t)s->spheres + 1, sizeof *s->start);
    return place;
}

/* The numbers that follow from the arguments. Errors: _ARGUMENT, _UNSUPPORTED. */
static int silhouettes_dimension(fibrad_silhouettes *s, const fibrad_scene *scene, const fibrad_silhouette_rule *rule) {
    uint32_t lines = rule != NULL ? rule->lines : 0;
    if (lines == 0) lines = FIBRAD_LINES_DEFAULT;
    if (lines < FIBRAD_DIRECTIONS_MIN || lines > FIBRAD_DIRECTIONS_MAX) return FIBRAD_E_ARGUMENT;
    *s = (fibrad_silhouettes){.scene = scene, .hash = scene->hash, .lines = lines, .spheres = scene->facts.spheres};
    return scene->mesh.triangles > 0 || scene->region ? FIBRAD_E_UNSUPPORTED : FIBRAD_OK;
}

static size_t silhouettes_bytes(fibrad_silhouettes fields) {
    fibrad_arena arena = {0};
    silhouettes_layout(&arena, &fields);
    return fibrad_arena_total(&arena);
}

uint32_t fibrad_silhouettes_lines(uint32_t lines) {
    for (uint32_t n = lines; n <= FIBRAD_LINES_EVEN_MAX; n++)
        if (fibrad_lines_tabled(n)) return n;
    return lines;
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

/* Makes the lines in the last third of the memory for frames. Then makes the frames from the lines, from the first to
 * the last. */
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

/* The number of spheres that may touch circles of a sphere, and the sum of their radii. */
typedef struct nearby {
    double count, radii;
} nearby;

/* Counts the spheres of a level down to a depth from the surface of the sphere at `place`. */
static nearby count_nearby(const fibrad_scene *scene, const fibrad_level *level, uint32_t place, double depth) {
    const double centre[3] = {scene->x[place], scene->y[place], scene->z[place]}, reach = scene->r[place] + depth;
    double low[3], high[3];
    fibrad_walk walk;
    nearby found = {0, 0};
    for (int axis = 0; axis < 3; axis++) low[axis] = centre[axis] - reach, high[axis] = centre[axis] + reach;
    fibrad_walk_begin(&walk, scene, level, low, high);
    while (fibrad_walk_next(&walk))
        for (uint32_t j = walk.begin; j < walk.end; j++) {
            const double x = scene->x[j] + walk.shift[0] - centre[0], y = scene->y[j] + walk.shift[1] - centre[1];
            const double z = scene->z[j] + walk.shift[2] - centre[2];
            if (x * x + y * y + z * z > reach * reach) continue;
            found.count += 1, found.radii += scene->r[j];
        }
    return found;
}

#define STRETCH_LENGTH 8.0  /* mean radii of the neighbours: half a stretch; an ordinary circle is about as long */
#define STRETCH_DISCS  32.0 /* least number of discs on both sides together */

/* The number of stretches in which the circles of a sphere are followed. At most the part sqrt(r/R) of all near discs
 * touches a circle. */
static uint64_t sphere_stretches(const fibrad_scene *scene, uint32_t place, double mean) {
    nearby all = {0, 0};
    const double r = scene->r[place];
    if (r <= STRETCH_LENGTH / 2 * mean) return 1;
    for (uint32_t l = 0; l < scene->levels; l++) {
        const nearby some = count_nearby(scene, &scene->level[l], place, FIBRAD_CIRCLE_STRIDE.first * scene->spacing);
        all.count += some.count, all.radii += some.radii;
    }
    const double ratio = fibrad_min(1, all.radii / (all.count * r));
    const double some =
        fibrad_min(FIBRAD_PI / (STRETCH_LENGTH * ratio), all.count * fibrad_sqrt(ratio) / STRETCH_DISCS);
    return some > 1 ? (uint64_t)some : 1;
}

#define CURVE_BITS 10 /* of a coordinate */

/* Spreads the bits of a number below 2^CURVE_BITS: two zeros after each. */
static uint32_t spread_bits(uint32_t x) {
    x = (x | x << 16) & 0x030000ff;
    x = (x | x << 8) & 0x0300f00f;
    x = (x | x << 4) & 0x030c30c3;
    return (x | x << 2) & 0x09249249;
}

/* Orders the spheres along a curve that fills space (Morton 1966). The spheres of a task then lie in a compact region
 * and share most of their pairs. */
static void make_sequence(fibrad_silhouettes *s) {
    const fibrad_scene *scene = s->scene;
    const double *coordinate[3] = {scene->x, scene->y, scene->z};
    double edge = 0;
    for (int axis = 0; axis < 3; axis++) edge = fibrad_max(edge, scene->box_high[axis] - scene->box_low[axis]);
    const double scale = edge > 0 ? ((1 << CURVE_BITS) - 1) / edge : 0;
    for (uint32_t k = 0; k < s->spheres; k++) {
        uint64_t curve = 0;
        for (int axis = 0; axis < 3; axis++) {
            const double at = coordinate[axis][k] - scene->box_low[axis]; /* strays lie outside the box */
            curve |= spread_bits((uint32_t)(fibrad_max(0, fibrad_min(edge, at)) * scale)) << axis;
        }
        s->stretch[k] = curve << 32 | k;
    }
    const uint64_t *sorted = fibrad_sort_keys(s->stretch, s->start, s->spheres, 32, (1 << 3 * CURVE_BITS) - 1);
    for (uint32_t k = 0; k < s->spheres; k++) s->sequence[k] = (uint32_t)sorted[k];
}

static void count_stretches(fibrad_silhouettes *s) {
    const fibrad_scene *scene = s->scene;
    double mean = 0;
    for (uint32_t k = 0; k < s->spheres; k++) mean += scene->r[k] / s->spheres;
    s->stretch[0] = 0;
    for (uint32_t k = 0; k < s->spheres; k++)
        s->stretch[k + 1] = s->stretch[k] + sphere_stretches(scene, s->sequence[k], mean);
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
    make_sequence(s);
    count_stretches(s);
    *out = s;
    return FIBRAD_OK;
}

/* ---- tasks ------------------------------------------------------------------------------------------------------ */

uint32_t fibrad_silhouettes_tasks(const fibrad_silhouettes *s) {
    return s == NULL ? 0 : (uint32_t)((s->stretch[s->spheres] + TASK_CIRCLES - 1) / TASK_CIRCLES);
}

static fibrad_circles *circles_layout(fibrad_arena *arena, uint32_t slots, fibrad_circle_near *near,
                                      fibrad_pair_table *table) {
    fibrad_circles *place = fibrad_arena_take(arena, 1, sizeof *place);
    const size_t room = FIBRAD_NEAR_MOST + 8 * FIBRAD_CIRCLE_ROOM;
    near->ball = fibrad_arena_take(arena, room, sizeof *near->ball);
    near->away = fibrad_arena_take(arena, room, sizeof *near->away);
    near->seen = fibrad_arena_take(arena, room, sizeof *near->seen);
    near->sphere = fibrad_arena_take(arena, room, sizeof(uint32_t));
    for (int half = 0; half < 2; half++) near->sum[half] = fibrad_arena_take(arena, room, sizeof(int64_t));
    near->nothing = (uint32_t)room - 2, near->nowhere = (uint32_t)room - 3;
    table->slot = fibrad_arena_take(arena, slots, sizeof *table->slot);
    return place;
}

static size_t circles_bytes(uint32_t slots) {
    fibrad_arena arena = {0};
    fibrad_circle_near near;
    fibrad_pair_table table;
    circles_layout(&arena, slots, &near, &table);
    return fibrad_arena_total(&arena);
}

/* A number whose ulp is the grid of projected centres. Centres that differ by rounding alone then coincide. If there
 * are periods, sums of centres and shifts are exact, and 128 extents are within range. */
static double centre_grid(const fibrad_scene *scene, double scale) {
    double extent = 0, grid = 1;
    bool periodic = false;
    for (int axis = 0; axis < 3; axis++) {
        extent += (scene->box_high[axis] - scene->box_low[axis]) * scale;
        periodic = periodic || scene->period[axis] > 0;
    }
    while (grid < extent) grid *= 2;
    return grid * (periodic ? 0x1.8p6 : 0x1.8p3); /* 2^-46 or 2^-49 of the extent */
}

static void begin_circles(const fibrad_scene *scene, fibrad_circles *c) {
    c->scene = scene;
    c->scale = 1;
    while (c->scale * scene->facts.radius_max >= 2) c->scale /= 2;
    while (c->scale * scene->facts.radius_max < 1) c->scale *= 2;
    c->apart = scene->container.walls;
    for (int axis = 0; axis < 3; axis++) {
        c->origin[axis] = scene->box_low[axis];
        c->period[axis] = scene->period[axis] * c->scale;
    }
    c->grid = centre_grid(scene, c->scale);
    for (int k = 0; k < FIBRAD_LANES_MAX; k++) c->near.fill[k] = c->near.nowhere;
    for (int axis = 0; axis < 3; axis++)
        c->near.ball[c->near.nowhere][axis] = 0x1p100, c->near.away[c->near.nowhere][axis] = 0;
    c->near.ball[c->near.nowhere][3] = 1;
}

/* Lays out scratch memory for circles. The table is as large as the memory allows. */
static fibrad_circles *open_circles(fibrad_workspace *space, const fibrad_scene *scene, fibrad_pair_table *table) {
    fibrad_circle_near near;
    uint32_t slots = TABLE_BEST;
    while (circles_bytes(slots) > space->plan.extra) slots /= 2;
    space->extra_owner = 0;
    fibrad_arena arena = {0};
    const size_t lead = fibrad_arena_lead(space->extra);
    arena.base = (unsigned char *)space->extra + lead, arena.size = space->plan.extra - lead;
    fibrad_circles *c = circles_layout(&arena, slots, &near, table);
    fibrad_zero(c, sizeof *c);
    c->near = near;
    begin_circles(scene, c);
    table->slots = slots, table->used = 0, table->shift = 64;
    for (uint32_t size = slots; size > 1; size /= 2) table->shift--;
    for (uint32_t k = 0; k < slots; k++) table->slot[k] = (fibrad_pair_sum){.key = UINT64_MAX};
    return c;
}

/* Moves the pairs of a table into a collection. */
static int empty_table(fibrad_pair_table *table, fibrad_pairs *pairs) {
    const size_t lead =
        pairs->count > 0 ? (size_t)((unsigned char *)fibrad_pairs_of(pairs) - (unsigned char *)pairs->memory.block) : 0;
    const int status = fibrad_memory_reserve(&pairs->memory, (pairs->count + table->used) * sizeof(fibrad_pair) + 8);
    if (status != FIBRAD_OK) return status;
    if (pairs->count > 0) /* a new block may have another alignment */
        __builtin_memmove(fibrad_pairs_of(pairs), (unsigned char *)pairs->memory.block + lead,
                          pairs->count * sizeof(fibrad_pair));
    fibrad_pair *to = fibrad_pairs_of(pairs) + pairs->count;
    for (uint32_t k = 0; k < table->slots; k++) {
        fibrad_pair_sum *slot = &table->slot[k];
        if (slot->key == UINT64_MAX) continue;
        if (slot->sum[0] != 0 || slot->sum[1] != 0)
            *to++ = (fibrad_pair){/* NOLINT(clang-analyzer-core.NullDereference): there is a block by now */
                                  .first = (uint32_t)(slot->key >> 32),
                                  .second = (uint32_t)slot->key,
                                  .sum = {slot->sum[0], slot->sum[1]}};
        *slot = (fibrad_pair_sum){.key = UINT64_MAX};
    }
    pairs->count = (size_t)(to - fibrad_pairs_of(pairs));
    table->used = 0;
    return FIBRAD_OK;
}

/* The sphere to which a stretch belongs, in the order of `sequence`. */
static uint32_t sphere_of_stretch(const fibrad_silhouettes *s, uint64_t stretch) {
    uint32_t low = 0, high = s->spheres - 1;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (s->stretch[middle + 1] > stretch)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/* Where stretch k of `count` begins. */
static double place_of_stretch(uint64_t k, uint64_t count) {
    const double place = FIBRAD_CIRCLE_BEGIN + (FIBRAD_CIRCLE_END - FIBRAD_CIRCLE_BEGIN) * (double)k / (double)count;
    return (place + 5) - 5; /* on the grid of places */
}

/* Follows stretches [from, to) of the circles of a sphere, number k of `sequence`. */
static int follow_sphere(const fibrad_silhouettes *s, fibrad_workspace *space, fibrad_circles *c, uint32_t k,
                         uint64_t from, uint64_t to, fibrad_pair_table *table, fibrad_pairs *pairs) {
    const uint64_t count = s->stretch[k + 1] - s->stretch[k];
    int status = FIBRAD_OK;
    c->begin = c->next = place_of_stretch(from, count), c->end = place_of_stretch(to, count);
    c->step = (FIBRAD_CIRCLE_END - FIBRAD_CIRCLE_BEGIN) / (double)count;
    for (uint32_t line = 0; line < s->lines && status == FIBRAD_OK;) {
        status = FIBRAD_VERSION_OF(fibrad_circle_lines, s->scene->facts.isa)(space, c, s->sequence[k], s->line, &line,
                                                                             s->lines, table);
        const bool full = !fibrad_pair_room(table, FIBRAD_CIRCLE_ENDS + FIBRAD_NEAR_MOST);
        if (status == FIBRAD_OK && full) status = empty_table(table, pairs);
    }
    return status;
}

/* Follows stretches [from, to) of all circles. */
static int follow_stretches(const fibrad_silhouettes *s, fibrad_workspace *space, uint64_t from, uint64_t to,
                            fibrad_pairs *pairs) {
    fibrad_pair_table table;
    fibrad_circles *c = open_circles(space, s->scene, &table);
    int status = FIBRAD_OK;
    for (uint32_t k = sphere_of_stretch(s, from); from < to && status == FIBRAD_OK; k++) {
        const uint64_t first = s->stretch[k], last = s->stretch[k + 1], end = last < to ? last : to;
        status = follow_sphere(s, space, c, k, from - first, end - first, &table, pairs);
        from = end;
    }
    return status != FIBRAD_OK ? status : empty_table(&table, pairs);
}

int fibrad_silhouettes_task(const fibrad_silhouettes *s, fibrad_work *work, uint32_t task, fibrad_pairs *pairs) {
    if (s == NULL || work == NULL || pairs == NULL) return FIBRAD_E_ARGUMENT;
    if (!fibrad_memory_valid(&pairs->memory) || task >= fibrad_silhouettes_tasks(s)) return FIBRAD_E_ARGUMENT;
    if (s->scene->hash != s->hash) return FIBRAD_E_STATE;
    const uint64_t from = (uint64_t)task * TASK_CIRCLES, left = s->stretch[s->spheres] - from;
    const size_t before = pairs->count;
    fibrad_workspace *space;
    pairs->serial++;
    int status = fibrad_work_open(work, s->scene, circles_bytes(TABLE_LEAST), circles_bytes(TABLE_BEST), &space);
    while (status == FIBRAD_OK) {
        status = follow_stretches(s, space, from, from + (left < TASK_CIRCLES ? left : TASK_CIRCLES), pairs);
        if (status != FIBRAD_E_WORK) break;
        pairs->count = before;
        status = fibrad_work_grow(work, &space);
    }
    if (status != FIBRAD_OK) pairs->count = before;
    return status;
}

/* ---- rows ------------------------------------------------------------------------------------------------------- */

/* Whether both members of a pair are spheres. */
static bool is_mutual(const fibrad_pair *pair) {
    return !fibrad_pair_opens(pair->second) && pair->second != pair->first;
}

/* Counts the pairs of each sphere. start[k + 1] becomes where those of sphere k begin. */
static void count_by_sphere(fibrad_silhouettes *s) {
    uint64_t *count = s->start + 1, before = 0;
    fibrad_zero(s->start, ((size_t)s->spheres + 1) * sizeof *s->start);
    for (uint32_t c = 0; c < s->count; c++) {
        const fibrad_pair *pair = fibrad_pairs_of(&s->pairs[c]);
        for (size_t k = 0; k < s->pairs[c].count; k++) {
            count[pair[k].first]++;
            if (is_mutual(&pair[k])) count[pair[k].second]++;
        }
    }
    for (uint32_t k = 0; k < s->spheres; k++) {
        const uint64_t own = count[k];
        count[k] = before, before += own;
    }
    s->all = before;
}

/* Lists the pairs of each sphere. start[k + 1] becomes where those of sphere k end. */
static void list_by_sphere(fibrad_silhouettes *s, uint32_t *index) {
    uint64_t *at = s->start + 1;
    uint32_t number = 0;
    for (uint32_t c = 0; c < s->count; c++) {
        const fibrad_pair *pair = fibrad_pairs_of(&s->pairs[c]);
        for (size_t k = 0; k < s->pairs[c].count; k++, number++) {
            index[at[pair[k].first]++] = number;
            if (is_mutual(&pair[k])) index[at[pair[k].second]++] = number;
        }
    }
}

int fibrad_silhouettes_join(fibrad_silhouettes *s, const fibrad_pairs *pairs, uint32_t count, fibrad_memory *memory) {
    if (s == NULL || memory == NULL || (pairs == NULL && count > 0)) return FIBRAD_E_ARGUMENT;
    if (!fibrad_memory_valid(memory)) return FIBRAD_E_ARGUMENT;
    if (s->scene->hash != s->hash) return FIBRAD_E_STATE;
    uint64_t all = 0;
    for (uint32_t c = 0; c < count; c++) all += pairs[c].count;
    if (all >= FIBRAD_NONE) return FIBRAD_E_UNSUPPORTED;
    s->index = NULL;
    s->pairs = pairs, s->count = count, s->serial = 0;
    for (uint32_t c = 0; c < count; c++) s->serial += pairs[c].serial;
    count_by_sphere(s);
    const int status = fibrad_memory_reserve(memory, (size_t)s->all * sizeof *s->index + sizeof *s->index);
    if (status != FIBRAD_OK) return status;
    uint32_t *index = (uint32_t *)(void *)((unsigned char *)memory->block + ((size_t) - (uintptr_t)memory->block & 3));
    list_by_sphere(s, index);
    s->index = index;
    return FIBRAD_OK;
}

static uint64_t pairs_serial(const fibrad_silhouettes *s) {
    uint64_t serial = 0;
    for (uint32_t c = 0; c < s->count; c++) serial += s->pairs[c].serial;
    return serial;
}

static const fibrad_pair *numbered_pair(const fibrad_silhouettes *s, uint32_t number) {
    uint32_t c = 0;
    for (; number >= s->pairs[c].count; c++) number -= (uint32_t)s->pairs[c].count;
    return fibrad_pairs_of(&s->pairs[c]) + number;
}

/* The sums of one entry. They use the memory in which rows by beams keep their parts. */
typedef struct pair_entry {
    int64_t sum[2];
    uint32_t place, unused[3];
} pair_entry;

/* The number of a sphere in the caller's order. Numbers from the number of spheres on stand for 2 line + sense, or for
 * all lines and senses together. */
static uint32_t key_number(const fibrad_silhouettes *s, uint32_t name) {
    if (!fibrad_pair_opens(name)) return s->scene->order[name];
    const uint32_t which = name - FIBRAD_PAIR_OPEN, all = 2 * s->lines;
    return s->spheres + (which < all ? which : all);
}

/* Lists all pairs of the sphere at a position. The keys have the numbers of the other members. Error: _WORK. */
static int gather_pairs(const fibrad_silhouettes *s, fibrad_workspace *space, uint32_t place, uint32_t *count) {
    fibrad_entries *entries = &space->entries;
    pair_entry *to = (pair_entry *)(void *)entries->part;
    uint32_t n = 0;
    for (uint64_t k = s->start[place]; k < s->start[place + 1]; k++) {
        if (k + AHEAD < s->all) __builtin_prefetch(numbered_pair(s, s->index[k + AHEAD]));
        const fibrad_pair *pair = numbered_pair(s, s->index[k]);
        const uint32_t other = pair->first != place ? pair->first : pair->second;
        if (n < entries->capacity) {
            to[n] = (pair_entry){{pair->sum[0], pair->sum[1]}, other, {0}};
            entries->key[0][n] = (uint64_t)key_number(s, other) << 32 | n;
        }
        n++;
    }
    *count = n;
    if (n <= entries->capacity) return FIBRAD_OK;
    space->needed = space->plan;
    space->needed.entries = n;
    return FIBRAD_E_WORK;
}

/* The factor that follows from the sums over even and over odd lines. Adds the square of the difference of their
 * means. */
static double entry_factor(const fibrad_silhouettes *s, const int64_t sum[2], double scale, double *square) {
    const uint32_t odd = s->lines / 2, even = s->lines - odd;
    const double difference = ((double)sum[0] / even - (double)sum[1] / odd) * (s->lines * scale / 2);
    *square += difference * difference;
    return (double)(sum[0] + sum[1]) * scale;
}

/* The error of the whole set over half the difference of its two halves: docs/accuracy.md. */
#define HALVES_ERROR 0.4

/* The same for the shares of walls. Both halves have errors of these shares in common. */
#define WALLS_ERROR 0.8

/* Adds up the pairs from number *k on that have one key. */
static const pair_entry *add_alike(const fibrad_workspace *space, const uint64_t *key, uint32_t count, uint32_t *k,
                                   int64_t sum[2]) {
    const pair_entry *entry = (const pair_entry *)(const void *)space->entries.part;
    const pair_entry *first = &entry[(uint32_t)key[*k]];
    const uint64_t name = key[*k] >> 32;
    sum[0] = sum[1] = 0;
    for (; *k < count && key[*k] >> 32 == name; ++*k)
        for (int half = 0; half < 2; half++) sum[half] += entry[(uint32_t)key[*k]].sum[half];
    return first;
}

#define OPEN_LEAST 0x1p14 /* units; a smaller open part, below 1e-9 of the disc, is divided as other lines say */

/* Divides the open part of a row among walls. open: of all lines together, as a fraction of the row. which [named]:
 * lines and senses in which the sphere is open. */
static int share_among_walls(const fibrad_silhouettes *s, fibrad_workspace *space, uint32_t place, double open,
                             const uint64_t *which, uint32_t named, fibrad_row *row) {
    const fibrad_scene *scene = s->scene;
    const fibrad_open_lines lines = {s->line, s->lines, which, named};
    double parts[2] = {0, 0}, sum = 0;
    const int status = FIBRAD_VERSION_OF(fibrad_open_share, scene->facts.isa)(space, scene, place, &lines, parts);
    if (status != FIBRAD_OK) return status;
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++) sum += space->wall[slot] = fibrad_max(0, space->wall[slot]);
    const double scale = sum > 0 ? open / sum : 0, unit = 1 / (2 * FIBRAD_PI * s->lines);
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++) space->wall[slot] *= scale;
    row->escaped = space->wall[FIBRAD_ESCAPED];
    row->error = fibrad_sqrt(row->error * row->error + WALLS_ERROR * WALLS_ERROR * parts[0] * (unit * unit));
    fibrad_row_cut(scene, place, space->wall, row);
    fibrad_row_bodies(scene, space->wall, row);
    return FIBRAD_OK;
}

static int row_of_pairs(const fibrad_scene *scene, fibrad_workspace *space, uint32_t i, const void *silhouettes,
                        fibrad_row *row) {
    const fibrad_silhouettes *s = silhouettes;
    const uint32_t place = scene->place[i];
    const double r = scene->r[place], unit = 1 / (FIBRAD_PAIR_UNITS * 2 * FIBRAD_PI * s->lines);
    int64_t sum[2], open[2] = {0, 0};
    double square = 0;
    uint32_t count, n = 0, named = 0, k = 0;
    const int status = gather_pairs(s, space, place, &count);
    if (status != FIBRAD_OK) return status;
    uint64_t *const *list = space->entries.key;
    const uint64_t *key = fibrad_sort_keys(list[0], list[1], count, 32, s->spheres + 2 * s->lines);
    uint64_t *which = key == list[0] ? list[1] : list[0];
    while (k < count && key[k] >> 32 < s->spheres) {
        const pair_entry *entry = add_alike(space, key, count, &k, sum);
        const double ratio = fibrad_min(1, scene->r[entry->place] / r), area = unit * (ratio * ratio);
        const double f = entry_factor(s, sum, entry->place == place ? 2 * area : area, &square);
        if (f <= 0) continue; /* sums that have cancelled, to rounding */
        if (n < row->capacity) row->col[n] = scene->order[entry->place], row->f[n] = f;
        n++;
    }
    while (k < count) {
        which[named] = (key[k] >> 32) - s->spheres;
        (void)add_alike(space, key, count, &k, sum);
        named += (double)(sum[0] + sum[1]) > OPEN_LEAST;
        open[0] += sum[0], open[1] += sum[1];
    }
    row->length = n;
    if (n > row->capacity) return FIBRAD_E_CAPACITY;
    row->escaped = fibrad_max(0, entry_factor(s, open, unit, &square));
    row->beyond = 0;
    row->error = HALVES_ERROR * fibrad_sqrt(square);
    row->directions = s->lines;
    row->fallbacks = 0;
    row->symmetric = 1;
    if (scene->container.walls) {
        const int shared = share_among_walls(s, space, place, row->escaped, which, named, row);
        if (shared != FIBRAD_OK) return shared;
    }
    return fibrad_row_checked(scene, row);
}

int fibrad_silhouettes_row(const fibrad_silhouettes *s, fibrad_work *work, uint32_t i, fibrad_row *row) {
    if (s == NULL) return FIBRAD_E_ARGUMENT;
    if (s->index == NULL || s->scene->hash != s->hash || s->serial != pairs_serial(s)) return FIBRAD_E_STATE;
    return fibrad_row_run(s->scene, work, i, &(fibrad_row_method){row_of_pairs, s, 0, 0}, row);
}
