/* clumps.c - numbers of clumps from a column, and a bed of bodies. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "bed/bed.h"
#include "cli/message.h"

int bed_take_clumps(struct bed *bed, const char *file, size_t extra, bool lone) {
    bool good = true;
    bed->clump = memory_resized(bed->clump, (bed->capacity + (size_t)1) * sizeof *bed->clump, &good);
    if (!good) return message_memory();
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double found = bed->extra[i * bed->extras + extra], number = lone && found == -1 ? 0 : found;
        if (!(number >= 0 && number <= UINT32_MAX && number == floor(number)))
            return message_at(
                STATUS_INPUT, file, bed->line[i],
                "sphere %lld: the clump is %.10g; clumps have whole numbers from 1 to %u, and 0 stands for "
                "a sphere that is alone",
                (long long)bed_name(bed, i), number, UINT32_MAX);
        bed->clump[i] = (uint32_t)number;
    }
    return STATUS_OK;
}

static int by_id(const void *a, const void *b) {
    const int64_t x = *(const int64_t *)a, y = *(const int64_t *)b;
    return x < y ? -1 : x > y;
}

/* Whether ids are all different. Status 0 or STATUS_MEMORY. */
static int are_different(const int64_t *id, uint32_t n, bool *different) {
    int64_t *sorted = malloc((size_t)n * sizeof *sorted + 1);
    *different = true;
    if (!sorted) return message_memory();
    for (uint32_t k = 0; k < n; ++k) sorted[k] = id[k];
    qsort(sorted, n, sizeof *sorted, by_id);
    for (uint32_t k = 1; k < n; ++k) *different = *different && sorted[k] != sorted[k - 1];
    free(sorted);
    return STATUS_OK;
}

/* Adds to a body the place of a member, by its nearest image to the first member. */
static void add_member_place(const struct bed *bed, uint32_t i, uint32_t first, double sum[3]) {
    for (int axis = 0; axis < 3; ++axis) {
        const double *c = bed_centres(bed, axis), period = bed->period[axis], d = c[i] - c[first];
        sum[axis] += period > 0 ? d - period * rint(d / period) : d;
    }
}

int bed_bodies(const struct bed *bed, uint32_t n, const uint32_t *body, const double *area, struct bed *bodies) {
    struct {
        uint32_t first, members;
        double sum[3];
    } *of = calloc((size_t)n + 1, sizeof *of);
    *bodies = bed_empty();
    bodies->ids = true;
    int status = of ? STATUS_OK : message_memory();
    for (uint32_t i = 0; i < bed->n && !status; ++i) {
        if (of[body[i]].members++ == 0) of[body[i]].first = i;
        add_member_place(bed, i, of[body[i]].first, of[body[i]].sum);
    }
    for (uint32_t b = 0; b < n && !status; ++b) {
        const uint32_t i = of[b].first, clump = bed->clump[i], members = of[b].members;
        status =
            bed_add(bodies, &(struct bed_sphere){bed->x[i] + of[b].sum[0] / members, bed->y[i] + of[b].sum[1] / members,
                                                 bed->z[i] + of[b].sum[2] / members, sqrt(area[b] / (4 * M_PI)),
                                                 bed->line[i], clump ? clump : bed_name(bed, i)});
    }
    bool different = true;
    if (!status) status = are_different(bodies->id, n, &different);
    for (uint32_t b = 0; b < n && !status && !different; ++b) bodies->id[b] = bed_name(bed, of[b].first);
    for (int axis = 0; axis < 3; ++axis) {
        bodies->low[axis] = bed->low[axis], bodies->high[axis] = bed->high[axis];
        bodies->period[axis] = bed->period[axis];
    }
    for (size_t k = 0; k < sizeof bed->units; ++k) bodies->units[k] = bed->units[k];
    bodies->metres = bed->metres, bodies->frame = bed->frame, bodies->timestep = bed->timestep;
    free(of);
    return status;
}
