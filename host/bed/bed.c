/* bed.c - spheres as read from a file, with the lines they came from. SPDX-License-Identifier: MIT */
#include "bed/bed.h"

#include <stdlib.h>

#include "cli/message.h"
#include "fibrad.h"

void bed_init(struct bed *bed, bool ids, size_t extras) { *bed = (struct bed){.ids = ids, .extras = extras}; }

static void *resized(void *array, size_t bytes, bool *good) {
    void *moved = realloc(array, bytes);
    if (!moved) *good = false;
    return moved ? moved : array;
}

/* Doubles the arrays, so that memory stays within a small multiple of what the file really holds. */
static int grow(struct bed *bed) {
    const size_t capacity = bed->capacity ? 2 * (size_t)bed->capacity : 1024;
    bool good = true;
    bed->x = resized(bed->x, capacity * sizeof *bed->x, &good);
    bed->y = resized(bed->y, capacity * sizeof *bed->y, &good);
    bed->z = resized(bed->z, capacity * sizeof *bed->z, &good);
    bed->r = resized(bed->r, capacity * sizeof *bed->r, &good);
    bed->line = resized(bed->line, capacity * sizeof *bed->line, &good);
    if (bed->ids) bed->id = resized(bed->id, capacity * sizeof *bed->id, &good);
    if (bed->extras) bed->extra = resized(bed->extra, capacity * bed->extras * sizeof *bed->extra, &good);
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

void bed_clear(struct bed *bed) {
    bed->n = 0;
    for (int axis = 0; axis < 3; ++axis) bed->low[axis] = bed->high[axis] = bed->period[axis] = 0;
}

void bed_free(struct bed *bed) {
    free(bed->x);
    free(bed->y);
    free(bed->z);
    free(bed->r);
    free(bed->line);
    free(bed->id);
    free(bed->extra);
    *bed = (struct bed){0};
}
