/* bed.c - spheres that were read from a file, and the lines they stand in. SPDX-License-Identifier: MIT */
#include "bed/bed.h"

#include <assert.h>
#include <stdio.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "fibrad.h"

struct bed bed_empty(void) {
    return (struct bed){.timestep = -1};
}

/* Doubles the arrays. So memory stays within a small multiple of the spheres in the file, whatever number the file
 * declares. */
static int grow(struct bed *bed) {
    const size_t capacity = bed->capacity ? 2 * (size_t)bed->capacity : 1024;
    bool good = true;
    bed->x = memory_resized(bed->x, capacity * sizeof *bed->x, &good);
    bed->y = memory_resized(bed->y, capacity * sizeof *bed->y, &good);
    bed->z = memory_resized(bed->z, capacity * sizeof *bed->z, &good);
    bed->r = memory_resized(bed->r, capacity * sizeof *bed->r, &good);
    bed->line = memory_resized(bed->line, capacity * sizeof *bed->line, &good);
    bed->id = memory_resized(bed->id, capacity * sizeof *bed->id, &good);
    if (bed->extras) bed->extra = memory_resized(bed->extra, capacity * bed->extras * sizeof *bed->extra, &good);
    if (!good) return message_memory();
    bed->capacity = (uint32_t)capacity;
    return STATUS_OK;
}

int bed_add(struct bed *bed, const struct bed_sphere *sphere) {
    if (bed->n == FIBRAD_SPHERES_MAX) return message(STATUS_INPUT, "more than %u spheres", FIBRAD_SPHERES_MAX);
    if (bed->n == bed->capacity) {
        const int status = grow(bed);
        if (status) return status;
    }
    const uint32_t i = bed->n++;
    bed->x[i] = sphere->x;
    bed->y[i] = sphere->y;
    bed->z[i] = sphere->z;
    bed->r[i] = sphere->r;
    bed->line[i] = sphere->line;
    if (bed->ids) bed->id[i] = sphere->id;
    return STATUS_OK;
}

const double *bed_centres(const struct bed *bed, int axis) { return axis == 0 ? bed->x : axis == 1 ? bed->y : bed->z; }

double bed_reach(const struct bed *bed, int axis, bool upper) {
    const double *c = bed_centres(bed, axis);
    double end = upper ? -INFINITY : INFINITY;
    for (uint32_t i = 0; i < bed->n; ++i) end = upper ? fmax(end, c[i] + bed->r[i]) : fmin(end, c[i] - bed->r[i]);
    return end;
}

double bed_diameter(const struct bed *bed) {
    double mean = 0;
    for (uint32_t i = 0; i < bed->n; ++i) mean += 2 * bed->r[i] / bed->n;
    return mean;
}

int bed_keep(struct bed *bed, const char *const *text, size_t n) {
    size_t room = 1;
    for (size_t k = 0; k < n; ++k) room += strlen(text[k]) + 4; /* a blank, or `nan` for an empty field */
    bool good = true;
    if (bed->kept_used + room > bed->kept_room) {
        const size_t wanted = 2 * (bed->kept_used + room);
        bed->kept = memory_resized(bed->kept, wanted, &good);
        if (good) bed->kept_room = wanted;
    }
    if (bed->n > bed->kept_capacity) {
        bed->kept_at = memory_resized(bed->kept_at, bed->capacity * sizeof *bed->kept_at, &good);
        if (good) bed->kept_capacity = bed->capacity;
    }
    if (!good) return message_memory();
    bed->kept_at[bed->n - 1] = bed->kept_used;
    char *to = bed->kept + bed->kept_used;
    for (size_t k = 0; k < n; ++k) {
        if (k > 0) *to++ = ' ';
        for (const char *c = text[k][0] ? text[k] : "nan"; *c; ++c) *to++ = (char)(*c == ' ' || *c == '\t' ? '_' : *c);
    }
    *to++ = 0;
    bed->kept_used = (size_t)(to - bed->kept);
    return STATUS_OK;
}

double bed_end(const struct bed *bed, int axis, bool upper) {
    if (bed->low[axis] < bed->high[axis]) return upper ? bed->high[axis] : bed->low[axis];
    return bed_reach(bed, axis, upper);
}

/* A box is a box about centres if an end lies this deep in a sphere, in radii. No sphere is pressed so far into a real
 * wall. A centre may lie beyond such an end by rounding only. */
#define SHRUNK_DEPTH  0.5
#define SHRUNK_BEYOND 1.001

double bed_wall_end(const struct bed *bed, int axis, bool upper, bool *moved) {
    const double end = bed_end(bed, axis, upper), *c = bed_centres(bed, axis);
    double deepest = 0;
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double depth = bed->r[i] + (upper ? c[i] - end : end - c[i]);
        deepest = fmax(deepest, depth / bed->r[i]);
    }
    if (!(deepest > SHRUNK_DEPTH && deepest < SHRUNK_BEYOND)) return end;
    *moved = true;
    return bed_reach(bed, axis, upper);
}

int64_t bed_name(const struct bed *bed, uint32_t i) { return bed->ids ? bed->id[i] : (int64_t)i; }

const char *bed_line_text(const struct bed *bed, uint32_t i, char text[BED_LINE_TEXT]) {
    text[0] = 0;
    if (bed->line[i]) snprintf(text, BED_LINE_TEXT, " of line %llu", (unsigned long long)bed->line[i]);
    return text;
}

/* The id and the position of a sphere. */
struct named {
    int64_t id;
    uint32_t at;
};

/* Sorts by id, eight bits at a time from the lowest ones. Spheres with equal ids keep their order. Negative ids come
 * last. */
static void sort_names(struct named *name, struct named *room, uint32_t n) {
    for (int shift = 0; shift < 64; shift += 8) {
        uint32_t start[257] = {0};
        for (uint32_t k = 0; k < n; ++k) ++start[((uint64_t)name[k].id >> shift & 255) + 1];
        if (start[((uint64_t)name[0].id >> shift & 255) + 1] == n) continue; /* all ids have the same eight bits */
        for (int digit = 0; digit < 256; ++digit) start[digit + 1] += start[digit];
        for (uint32_t k = 0; k < n; ++k) room[start[(uint64_t)name[k].id >> shift & 255]++] = name[k];
        memcpy(name, room, n * sizeof *name);
    }
}

static bool is_sorted(const struct bed *bed) {
    for (uint32_t i = 1; i < bed->n; ++i)
        if (!(bed->id[i - 1] < bed->id[i])) return false;
    return bed->n == 0 || bed->id[0] >= 0;
}

static int check_names(const struct bed *bed, const char *file, const struct named *name) {
    for (uint32_t k = 0; k < bed->n; ++k) {
        const uint64_t line = bed->line[name[k].at];
        const long long id = name[k].id;
        if (id < 0)
            return message_at(STATUS_INPUT, file, line,
                              "the id %lld is negative; --positions names spheres by positions instead", id);
        if (k == 0 || name[k - 1].id != id) continue;
        const uint64_t other = bed->line[name[k - 1].at];
        if (other == 0)
            return message_at(STATUS_INPUT, file, 0,
                              "the id %lld occurs twice; --positions names spheres by positions instead", id);
        return message_at(STATUS_INPUT, file, line,
                          "the id %lld occurs in line %llu, too; --positions names spheres by positions instead", id,
                          (unsigned long long)other);
    }
    return STATUS_OK;
}

/* Puts the n elements of an array, of `size` bytes each, into the order of the names. */
static void rearrange(void *array, size_t size, const struct named *name, uint32_t n, void *room) {
    if (size == 0) return;
    for (uint32_t k = 0; k < n; ++k) memcpy((char *)room + k * size, (char *)array + name[k].at * size, size);
    memcpy(array, room, n * size);
}

int bed_sort(struct bed *bed, const char *file) {
    if (!bed->ids || is_sorted(bed)) return STATUS_OK;
    const size_t widest = sizeof(double) * (bed->extras > 2 ? bed->extras : 2);
    static_assert(sizeof(struct named) <= 2 * sizeof(double), "names are sorted in the same room");
    struct named *name = malloc(bed->n * sizeof *name);
    void *room = malloc(bed->n * widest);
    int status = name && room ? STATUS_OK : message_memory();
    for (uint32_t i = 0; i < bed->n && !status; ++i) name[i] = (struct named){bed->id[i], i};
    if (!status) sort_names(name, room, bed->n);
    if (!status) status = check_names(bed, file, name);
    if (!status) {
        double *const array[] = {bed->x, bed->y, bed->z, bed->r};
        for (int k = 0; k < 4; ++k) rearrange(array[k], sizeof(double), name, bed->n, room);
        rearrange(bed->line, sizeof *bed->line, name, bed->n, room);
        rearrange(bed->id, sizeof *bed->id, name, bed->n, room);
        rearrange(bed->extra, bed->extras * sizeof(double), name, bed->n, room);
        if (bed->kept_names) rearrange(bed->kept_at, sizeof *bed->kept_at, name, bed->n, room);
    }
    free(name);
    free(room);
    return status;
}

void bed_clear(struct bed *bed) {
    bed->n = 0;
    bed->kept_names = NULL;
    bed->kept_used = 0;
    memset(bed->units, 0, sizeof bed->units); /* all bytes: .npz files have the whole array */
    bed->timestep = -1;
    for (int axis = 0; axis < 3; ++axis) bed->low[axis] = bed->high[axis] = bed->period[axis] = 0;
}

void bed_free(struct bed *bed) {
    free(bed->x);
    free(bed->y);
    free(bed->z);
    free(bed->r);
    free(bed->line);
    free(bed->id);
    free(bed->clump);
    free(bed->extra);
    free(bed->kept);
    free(bed->kept_at);
    *bed = (struct bed){0};
}
