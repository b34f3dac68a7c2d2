/* pencils.c - how the beams of a sphere are kept. SPDX-License-Identifier: MIT
 *
 * A row has about a hundred other ends, and its beams go by these: so an end of a beam is a patch of a known body, and
 * takes a byte. How much two bodies exchange is known from all beams; where on them the light leaves and arrives, from
 * those that are kept, each of which stands for as many. */
#include "heat/pencils.h"
#include "base/constants.h"

/* Others that a row in a bed sees, times the solid fraction, over the root of its beams: in random beds of equal
 * spheres 0.75 at solid fraction 0.6, 1.1 at 0.2, of which there is room for more. */
#define ROOM_PENCILS 1.3

/* Beams that are left of N when those of the same patches, P, are joined, over sqrt(N P), at solid fraction 1/2 and
 * above: 2.1 to 2.8 at P = 24, 3.4 to 3.9 at 96, up to 6.3 at 384, for N from 1,000 to 128,000. */
#define ROOM_JOINED      4.5
#define ROOM_JOINED_WIDE 6.8

/* Beams that meet walls are all kept; by reciprocity they are as many as the walls are large. */
size_t fibrad_heat_room(const fibrad_heat *heat) {
    const fibrad_scene *scene = heat->scene;
    const double n = heat->spheres, beams = heat->beams, spacing = scene->spacing;
    double solid = 0, surface = 0, walls = 0;
    if (heat->spheres == 0) return 0;
    for (uint32_t i = 0; i < heat->spheres; i++) {
        const double r = scene->r[i];
        solid += 4. / 3 * FIBRAD_PI * r * r * r, surface += 4 * FIBRAD_PI * r * r;
    }
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++)
        if (scene->wall_area[k] > 0)
            walls += heat->wall[k].size[0] * heat->wall[k].size[1] *
                     (k == FIBRAD_CYLINDER ? 2 * FIBRAD_PI * scene->container.radius : 1);
    const double blocks = FIBRAD_HEAT_OTHERS + (double)(heat->patches - fibrad_heat_others(heat)) / FIBRAD_HEAT_BLOCK;
    const double fraction = fibrad_min(1, solid / (n * spacing * spacing * spacing));
    const double pencils = fibrad_min(fibrad_min(n + blocks, beams), 16 + ROOM_PENCILS * fibrad_sqrt(beams) / fraction);
    const double of_walls = scene->container.walls ? beams * fibrad_min(1, 1.5 * walls / surface) : 0;
    const double thinned = beams / heat->thin;
    const double most = (fibrad_heat_number_bytes(heat) == 2 ? ROOM_JOINED_WIDE : ROOM_JOINED) *
                        fibrad_sqrt(thinned * heat->config.patches);
    const double joined = fibrad_min(thinned, most + (thinned - most) * fibrad_max(0, 1 - 2 * fraction));
    const double kept = fibrad_min(beams, joined + pencils + of_walls);
    const double pencil = sizeof(fibrad_heat_pencil) + sizeof(fibrad_heat_link) + 2;
    return (size_t)(1.1 * n * (3 * kept * (double)fibrad_heat_number_bytes(heat) + pencils * pencil)) + 4096;
}

/* Patches that the other end of a beam may have, at the most. */
static uint32_t pairs_stride(const fibrad_heat *heat) {
    return heat->config.patches > FIBRAD_HEAT_BLOCK ? heat->config.patches : FIBRAD_HEAT_BLOCK;
}

/* Puts beams in the order of their entries; counts[e] is then how many those of entry e and before are. */
static void sort_beams(const fibrad_heat_beam *beam, uint32_t count, fibrad_heat_beam *sorted, uint64_t *counts,
                       uint32_t entries) {
    uint64_t sum = 0;
    for (uint32_t e = 0; e < entries; e++) counts[e] = 0;
    for (uint32_t k = 0; k < count; k++) counts[beam[k].entry]++;
    for (uint32_t e = 0; e < entries; e++) sum += counts[e], counts[e] = sum - counts[e];
    for (uint32_t k = 0; k < count; k++) sorted[counts[beam[k].entry]++] = beam[k];
}

/* Joins beams of an entry that connect the same patches, in the order of first sight; returns how many are left. `seen`
 * is zero, and is so again: which one has each two patches, counted from 1. */
static uint32_t join_beams(const fibrad_heat *heat, fibrad_heat_beam *beam, uint64_t count, uint32_t *seen) {
    const uint32_t most = fibrad_heat_number_bytes(heat) == 1 ? UINT8_MAX : UINT16_MAX, to = pairs_stride(heat);
    uint32_t joined = 0;
    for (uint64_t k = 0; k < count; k++) {
        uint32_t *at = &seen[beam[k].from * to + beam[k].to];
        if (*at != 0 && beam[*at - 1].count < most)
            beam[*at - 1].count++;
        else
            beam[joined] = beam[k], *at = ++joined;
    }
    for (uint32_t k = 0; k < joined; k++) seen[beam[k].from * to + beam[k].to] = 0;
    return joined;
}

/* Writes one pencil; without `to` it only counts the bytes. */
static size_t write_pencil(const fibrad_heat *heat, fibrad_heat_pencil pencil, const fibrad_heat_beam *beam,
                           unsigned char *to) {
    const size_t bytes = fibrad_heat_pencil_bytes(heat, &pencil);
    if (to == NULL) return bytes;
    fibrad_heat_pencil *header = (void *)to;
    uint8_t *narrow = (void *)(header + 1);
    uint16_t *wide = (void *)(header + 1);
    *header = pencil;
    for (uint32_t k = 0; k < pencil.count; k++) {
        const uint16_t number[3] = {beam[k].from, beam[k].to, beam[k].count};
        for (uint32_t d = 0; d < 3; d++)
            if (fibrad_heat_number_bytes(heat) == 1)
                narrow[3 * k + d] = (uint8_t)number[d];
            else
                wide[3 * k + d] = number[d];
    }
    return bytes;
}

/* Writes the pencils of a row, one for each entry, more where that has more beams than one can count; without `to`
 * only counts bytes, and pencils that end on spheres. */
static size_t write_row(const fibrad_heat *heat, const fibrad_entries *entries, const fibrad_heat_beam *beam,
                        unsigned char *to, uint32_t *to_spheres) {
    const uint64_t *end = entries->key[0], *joined = entries->key[1];
    size_t bytes = 0;
    uint64_t begin = 0;
    *to_spheres = 0;
    for (uint32_t e = 0; e < entries->length; begin = end[e++]) {
        const double *part = entries->part[e], even = part[0] + part[2], odd = part[1] + part[3];
        fibrad_heat_pencil pencil = {.body = entries->sphere[e],
                                     .share = (float)((even + odd) / (double)(end[e] - begin)),
                                     .tilt = (int16_t)(32767 * (even - odd) / (even + odd))};
        for (uint64_t k = 0; k < joined[e]; k += pencil.count) {
            pencil.count = (uint16_t)(joined[e] - k < UINT16_MAX ? joined[e] - k : UINT16_MAX);
            bytes += write_pencil(heat, pencil, beam + begin + k, to != NULL ? to + bytes : NULL);
            if (pencil.body < heat->spheres) ++*to_spheres;
        }
    }
    return bytes;
}

size_t fibrad_heat_scratch(const fibrad_heat *heat) {
    const size_t pairs = (size_t)heat->config.patches * pairs_stride(heat);
    return 2 * heat->beams * sizeof(fibrad_heat_beam) + pairs * sizeof(uint32_t);
}

int fibrad_heat_keep(fibrad_heat *heat, const fibrad_workspace *work, uint32_t place, uint32_t count) {
    const fibrad_entries *entries = &work->entries;
    fibrad_heat_beam *beam = work->extra, *sorted = beam + heat->beams;
    uint32_t *seen = (uint32_t *)(void *)(sorted + heat->beams), pencils;
    uint64_t *end = entries->key[0], begin = 0;
    sort_beams(beam, count, sorted, end, entries->length);
    fibrad_zero(seen, (size_t)heat->config.patches * pairs_stride(heat) * sizeof *seen);
    for (uint32_t e = 0; e < entries->length; begin = end[e++])
        entries->key[1][e] = join_beams(heat, sorted + begin, end[e] - begin, seen);
    fibrad_heat_row *row = &heat->row[place];
    row->bytes = write_row(heat, entries, sorted, NULL, &pencils);
    row->begin = fibrad_add_at_once(&heat->used, row->bytes);
    const size_t links = fibrad_add_at_once(&heat->links, pencils) + pencils;
    /* whoever adds to both last sees the sums */
    if (links > heat->room / sizeof(fibrad_heat_link) ||
        fibrad_add_at_once(&heat->used, 0) > heat->room - links * sizeof(fibrad_heat_link))
        return FIBRAD_E_SIZE;
    write_row(heat, entries, sorted, heat->pool + row->begin, &pencils);
    return FIBRAD_OK;
}

void fibrad_heat_link_pencils(fibrad_heat *heat) {
    const uint32_t n = heat->spheres;
    size_t *first = heat->first_link;
    fibrad_zero(first, (n + 2) * sizeof *first);
    heat->link = (void *)(heat->pool + (heat->used + FIBRAD_ALIGNMENT - 1) / FIBRAD_ALIGNMENT * FIBRAD_ALIGNMENT);
    for (uint32_t place = 0; place < n; place++) {
        const unsigned char *at = heat->pool + heat->row[place].begin, *end = at + heat->row[place].bytes;
        for (; at < end; at += fibrad_heat_pencil_bytes(heat, fibrad_heat_pencil_at(at))) {
            const uint32_t other = fibrad_heat_pencil_at(at)->body;
            if (other < n) first[other + 2]++;
        }
    }
    for (uint32_t i = 2; i < n + 2; i++) first[i] += first[i - 1];
    for (uint32_t place = 0; place < n; place++) {
        const unsigned char *begin = heat->pool + heat->row[place].begin, *end = begin + heat->row[place].bytes;
        for (const unsigned char *at = begin; at < end;
             at += fibrad_heat_pencil_bytes(heat, fibrad_heat_pencil_at(at))) {
            const uint32_t other = fibrad_heat_pencil_at(at)->body;
            if (other < n)
                heat->link[first[other + 1]++] = (fibrad_heat_link){place, (uint32_t)((size_t)(at - begin) / 4)};
        }
    }
}
