/* row_sum.c - collects the entries of a row. SPDX-License-Identifier: MIT */
#include "sums/row_sum.h"
#include "base/sort.h"
#include "rows/record.h"

static uint32_t hash_slot_of(const fibrad_entries *entries, uint32_t sphere) {
    uint32_t mask = entries->slots - 1, slot = (sphere * 2654435769u >> 7) & mask; /* Fibonacci hashing */
    while (entries->at[slot] != FIBRAD_NONE && entries->sphere[entries->at[slot]] != sphere) slot = (slot + 1) & mask;
    return slot;
}

uint32_t fibrad_entries_of(fibrad_entries *entries, uint32_t sphere) {
    uint32_t slot = hash_slot_of(entries, sphere), entry = entries->at[slot];
    if (entry != FIBRAD_NONE || entries->length == entries->capacity) return entry;
    entry = entries->at[slot] = entries->length++;
    entries->slot[entry] = slot;
    entries->sphere[entry] = sphere;
    for (int part = 0; part < 4; part++) entries->part[entry][part] = 0;
    entries->lengths[entry] = entries->angles[entry] = entries->exact[entry] = 0;
    return entry;
}

uint32_t fibrad_entries_find(const fibrad_entries *entries, uint32_t sphere) {
    return entries->at[hash_slot_of(entries, sphere)];
}

static double entry_sum(const double part[4]) { return part[0] + part[2] + (part[1] + part[3]); }

/* The difference between the halves. */
static double entry_difference(const fibrad_entries *entries, uint32_t entry) {
    const double *part = entries->part[entry], *balance = entries->balance;
    return part[0] * balance[0] + part[2] * balance[0] - part[1] * balance[1] - part[3] * balance[1];
}

void fibrad_entries_slots(const fibrad_entries *entries, const fibrad_scene *scene, double wall[FIBRAD_SLOTS]) {
    const uint32_t spheres = scene->facts.spheres;
    for (uint32_t k = 0; k < entries->length && scene->mesh.triangles > 0; k++)
        if (entries->sphere[k] >= spheres) wall[entries->sphere[k] - spheres] += entry_sum(entries->part[k]);
}

/* Adds a square of at most 1 to a sum of two words, which is the same in any order. */
static void add_square(uint64_t sum[2], double square) {
    const double units = square * 0x1p60;
    sum[0] += (uint64_t)units;
    sum[1] += (uint64_t)((units - (double)(uint64_t)units) * 0x1p32);
}

int fibrad_entries_row(const fibrad_entries *entries, const fibrad_scene *scene, double scale, fibrad_row *row) {
    uint32_t n = 0;
    uint64_t units[2] = {0, 0};
    double square = 0;
    for (uint32_t k = 0; k < entries->length; k++) {
        const double exact = entries->exact[k], difference = exact > 0 ? 0 : entry_difference(entries, k) * scale;
        square += difference * difference;
        if (entries->masked) add_square(units, difference * difference);
        if (entries->sphere[k] >= scene->facts.spheres || (entry_sum(entries->part[k]) == 0 && exact == 0)) continue;
        entries->key[0][n++] = (uint64_t)scene->order[entries->sphere[k]] << 32 | k;
    }
    row->length = n;
    if (n > row->capacity) return FIBRAD_E_CAPACITY;
    if (entries->masked) square = (double)units[0] * 0x1p-60 + (double)units[1] * 0x1p-92;
    row->error = fibrad_sqrt(square);

    const uint64_t *key = fibrad_sort_keys(entries->key[0], entries->key[1], n, 32, scene->facts.spheres - 1);
    for (uint32_t k = 0; k < n; k++) {
        uint32_t entry = (uint32_t)key[k];
        row->col[k] = (uint32_t)(key[k] >> 32);
        const double exact = entries->exact[entry];
        row->f[k] = exact > 0 ? exact : entry_sum(entries->part[entry]) * scale;
        if (row->half != NULL)
            row->half[k] = exact > 0 ? FIBRAD_HALF_EXACT : (float)(entry_difference(entries, entry) * scale);
    }
    return FIBRAD_OK;
}

/* If the error falls by the same ratio from fourths to halves as from halves to the whole, it is halves^2/fourths.
 * The bounds are measured, docs/accuracy.md: the factor for rules where many windows see each sphere, and the factor
 * for independent windows. Halves of a row with few entries may agree by chance. Then the fourths tell the error, as
 * if errors fall as directions^-1.5. */
double fibrad_entries_error(const fibrad_entries *entries, const double parts[2], double distance, double scale) {
    const double least = 0.5, most = 1.1, of_fourths = 0.125;
    double halves = parts[0], fourths = parts[1], gain = most;
    for (uint32_t k = 0; k < entries->length; k++) {
        const double *part = entries->part[k];
        if (entries->exact[k] > 0) continue;
        double half = part[0] + part[2] - part[1] - part[3], even = part[0] - part[2], odd = part[1] - part[3];
        halves += half * half;
        fourths += even * even + odd * odd;
    }
    if (halves < fourths) gain = fibrad_max(least, most * fibrad_sqrt(halves / fourths));
    return fibrad_max(distance * gain, of_fourths * fibrad_sqrt(fourths) * scale);
}
