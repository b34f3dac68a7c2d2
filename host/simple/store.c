/* store.c - the heat that spheres store over temperature, and back. SPDX-License-Identifier: MIT
 *
 * The capacity is linear in each section of temperatures. So the heat is quadratic there, and what melts adds a part
 * that is linear. Pieces begin at 0 K, at the rows of the table, and where melting begins and ends. If both are at one
 * temperature, the heat jumps there: a section of no length, in which heats differ. */
#include "simple/store.h"

#include <math.h>

bool fibrad_store_valid(const fibrad_store *store) {
    bool valid = store->rows == 0 || (store->temperature && store->capacity);
    for (uint32_t k = 0; k < store->rows && valid; ++k)
        valid = store->capacity[k] > 0 && store->capacity[k] <= FIBRAD_CAPACITY_MAX &&
                store->temperature[k] <= FIBRAD_TEMPERATURE_MAX &&
                (k > 0 ? store->temperature[k] > store->temperature[k - 1] : store->temperature[k] >= 0);
    if (!valid || store->latent == 0) return valid;
    return store->latent > 0 && store->latent <= FIBRAD_CAPACITY_MAX && store->width >= 0 &&
           store->melting - store->width / 2 > 0 && store->melting + store->width / 2 <= FIBRAD_TEMPERATURE_MAX;
}

/* Adds a place at which a section begins. *row: the first row of the table that is not below it. */
static void add_section(fibrad_sections *p, const fibrad_store *store, uint32_t *row, double begin, double melted) {
    fibrad_section *now = &p->section[p->n], *last = p->n > 0 ? now - 1 : now;
    const double *t = store->temperature, *c = store->capacity;
    while (*row < store->rows && t[*row] < begin) ++*row;
    *now = (fibrad_section){.begin = begin, .melted = melted, .capacity = 1};
    if (store->rows > 0) now->capacity = c[*row < store->rows ? *row : store->rows - 1];
    if (*row > 0 && *row < store->rows)
        now->capacity -= (t[*row] - begin) / (t[*row] - t[*row - 1]) * (c[*row] - c[*row - 1]);
    if (p->n++ == 0) return;
    const double length = begin - last->begin;
    if (length > 0) last->slope = (now->capacity - last->capacity) / length;
    if (melted > last->melted) last->melting = (melted - last->melted) / length;
    now->heat = last->heat + length * (last->capacity + now->capacity) / 2 + store->latent * (melted - last->melted);
}

void fibrad_sections_make(fibrad_sections *sections, const fibrad_store *store) {
    const double low = store->melting - store->width / 2, high = store->melting + store->width / 2;
    bool begun = !(store->latent > 0), ended = begun; /* whether places where melting begins and ends are there */
    uint32_t row = 0;
    sections->n = 0, sections->latent = store->latent;
    add_section(sections, store, &row, 0, 0);
    for (uint32_t k = 0; k <= store->rows; ++k) {
        const double next = k < store->rows ? store->temperature[k] : INFINITY;
        if (!begun && low <= next) add_section(sections, store, &row, low, 0), begun = true;
        if (!ended && high <= next) add_section(sections, store, &row, high, 1), ended = true;
        if (k == store->rows || (store->latent > 0 && (next == low || next == high))) continue;
        add_section(sections, store, &row, next,
                    !(store->latent > 0) || !begun ? 0
                    : ended                        ? 1
                                                   : (next - low) / (high - low));
    }
}

/* The last section that begins at most at a temperature, or at a heat. */
static const fibrad_section *find_section(const fibrad_sections *sections, double value, bool by_heat) {
    uint32_t low = 0, high = sections->n;
    while (high - low > 1) {
        const uint32_t middle = low + (high - low) / 2;
        const fibrad_section *p = &sections->section[middle];
        *((by_heat ? p->heat : p->begin) <= value ? &low : &high) = middle;
    }
    return &sections->section[low];
}

double fibrad_sections_heat(const fibrad_sections *sections, double temperature, double melted) {
    const fibrad_section *p = find_section(sections, temperature, false);
    const double x = temperature - p->begin, so_far = x > 0 ? p->melted + x * p->melting : p->melted;
    const double heat = p->heat + x * (p->capacity + x * p->slope / 2) + sections->latent * (so_far - p->melted);
    const bool jumps = x == 0 && p > sections->section && p[-1].melting == INFINITY;
    if (isnan(melted)) return jumps ? p[-1].heat : heat;
    return heat + sections->latent * (melted - so_far);
}

fibrad_stored fibrad_sections_at(const fibrad_sections *sections, double heat) {
    const fibrad_section *p = find_section(sections, heat, true);
    const double more = heat - p->heat;
    if (p->melting == INFINITY) return (fibrad_stored){p->begin, INFINITY, p->melted + more / sections->latent};
    const double capacity = p->capacity + sections->latent * p->melting;
    const double there = sqrt(larger_of(capacity * capacity + 2 * p->slope * more, 0)),
                 x = 2 * more / (capacity + there);
    return (fibrad_stored){p->begin + x, there, p->melted + x * p->melting};
}
