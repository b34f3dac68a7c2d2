/* beam_kept.c - the sums of a part of a row, kept in memory of the caller. SPDX-License-Identifier: MIT
 *
 * First there are the sums of the windows, then those by slot, then those by regions of the sky if there are walls,
 * then what spheres have got, in the order of first sight. All sums are the same in any order of the windows. */
#include "base/reserve.h"
#include "row/beam_lanes.h"

#define ENTRY_BYTES (4 * sizeof(double) + sizeof(uint32_t))

static unsigned char *keep_bytes(unsigned char *to, const void *from, size_t size) {
    fibrad_copy(to, from, size);
    return to + size;
}

int fibrad_beam_keep(const fibrad_workspace *work, const fibrad_beam_sums *sums, fibrad_row_part *part) {
    const fibrad_entries *entries = &work->entries;
    const size_t regions = work->scene->container.walls ? work->walls->sums.used : 0;
    part->used = sizeof *sums + sizeof work->wall + regions + entries->length * ENTRY_BYTES;
    const int status = fibrad_memory_reserve(&part->memory, part->used);
    if (status != FIBRAD_OK) return status;
    unsigned char *to = keep_bytes(keep_bytes(part->memory.block, sums, sizeof *sums), work->wall, sizeof work->wall);
    if (regions > 0) to = keep_bytes(to, &work->walls->sums, regions);
    for (uint32_t k = 0; k < entries->length; k++)
        to = keep_bytes(keep_bytes(to, entries->part[k], sizeof *entries->part), &entries->sphere[k],
                        sizeof *entries->sphere);
    return FIBRAD_OK;
}

static const unsigned char *add(double *to, size_t count, const unsigned char *from) {
    for (size_t k = 0; k < count; k++, from += sizeof(double)) {
        double term;
        fibrad_copy(&term, from, sizeof term);
        to[k] += term;
    }
    return from;
}

static void add_entry(fibrad_entries *entries, const unsigned char *from) {
    double part[4];
    uint32_t sphere;
    fibrad_copy(part, from, sizeof part);
    fibrad_copy(&sphere, from + sizeof part, sizeof sphere);
    const uint32_t entry = fibrad_entries_of(entries, sphere);
    if (entry == FIBRAD_NONE) entries->missed++;
    for (int p = 0; p < 4 && entry != FIBRAD_NONE; p++) entries->part[entry][p] += part[p];
}

static const unsigned char *add_regions(fibrad_wall_sums *sums, const unsigned char *from) {
    from = add(sums->open[0], 4 * FIBRAD_REGIONS, from);
    from = add(sums->all[0], 4 * FIBRAD_REGIONS, from);
    from = add(sums->mixed, FIBRAD_REGIONS, from) + sizeof sums->used;
    const size_t words = (sums->used - offsetof(fibrad_wall_sums, hidden)) / sizeof *sums->hidden;
    for (size_t k = 0; k < words; k++, from += sizeof *sums->hidden) {
        uint64_t hidden;
        fibrad_copy(&hidden, from, sizeof hidden);
        sums->hidden[k] |= hidden;
    }
    return from;
}

void fibrad_beam_add_kept(fibrad_workspace *work, const fibrad_row_part *part, fibrad_beam_sums *sums) {
    const unsigned char *from = part->memory.block, *end = from + part->used;
    from = add(sums->open, 2, from);
    from = add(sums->whole, 2, from);
    from = add(&sums->seen, 1, from);
    from = add(work->wall, FIBRAD_SLOTS, from);
    if (work->scene->container.walls) from = add_regions(&work->walls->sums, from);
    for (; from < end; from += ENTRY_BYTES) add_entry(&work->entries, from);
    work->areas.fallbacks += part->fallbacks;
}
