/* row_sum.h - the sums of a row by sphere, while the row is computed. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SUMS_ROW_SUM_H
#define FIBRAD_SUMS_ROW_SUM_H

#include "scene/scene.h"

/* What the windows have seen of each sphere so far, in the order of first sight. Each fourth direction or ray has a
 * sum of its own, from which the error is estimated. */
typedef struct fibrad_entries {
    uint32_t *at;      /* [slots] hash table with open addressing: the entry of a sphere; FIBRAD_NONE: free */
    uint32_t *slot;    /* [capacity] the slot in `at` of each entry */
    uint32_t *sphere;  /* [capacity] */
    double (*part)[4]; /* [capacity] visible area, or number of rays, over all windows k = 0, 1, 2, 3 mod 4 */
    double *lengths;   /* [capacity] sum of the lengths of the rays [L] */
    double *angles;    /* [capacity] sum of the angles between the rays and the line of centres */
    double *exact;     /* [capacity] an exact factor, which takes the place of the sums; 0: none */
    uint64_t *key[2];  /* [capacity] scratch of the sort by columns */
    uint32_t slots, capacity, length, missed;
    double weight;     /* by which values are multiplied; 1 but for areas among windows by masks */
    double balance[2]; /* by which sums over even and over odd windows count in their difference; 1 if both are
                          equally many */
    bool masked;       /* of a row by masks: the order of the entries may depend on the lists of near spheres */
    bool halves; /* areas of window k go to part k mod 2. The other parts have counts of points, exact in any order */
    bool end; /* the present window is the first or the last: it counts half in differences of even and odd windows */
} fibrad_entries;

/* The entry of a sphere. A sphere without an entry gets a new one. FIBRAD_NONE: there is no room. */
uint32_t fibrad_entries_of(fibrad_entries *entries, uint32_t sphere);

/* Adds visible area to part k mod 4 of an entry. If the entry is FIBRAD_NONE, it is counted in entries.missed. */
static inline void fibrad_entries_add(fibrad_entries *entries, uint32_t entry, uint32_t k, double area) {
    if (entry == FIBRAD_NONE) {
        entries->missed++;
        return;
    }
    area *= entries->weight;
    if (entries->halves) k %= 2;
    double *part = entries->part[entry];
    if (entries->end) { /* so half of it is in the difference of even and odd */
        const double quarter = area / 4;
        part[k % 4 ^ 1] += quarter;
        area -= quarter;
    }
    part[k % 4] += area;
}

/* The entry of a sphere. FIBRAD_NONE: the sphere has found no room. */
uint32_t fibrad_entries_find(const fibrad_entries *entries, uint32_t sphere);

/* Entries with numbers of spheres + slot belong to slots. Adds them to the sums of the slots. */
void fibrad_entries_slots(const fibrad_entries *entries, const fibrad_scene *scene, double wall[FIBRAD_SLOTS]);

/* Writes the row: entries times `scale`, columns ascending, and row->half unless it is NULL. For exact factors it is
 * FIBRAD_HALF_EXACT, and they have no part in row->error. row->error: the distance of the sums over even and odd
 * windows. Entries of slots count in the error only. Entries that triangles have hidden again are left out. */
int fibrad_entries_row(const fibrad_entries *entries, const fibrad_scene *scene, double scale, fibrad_row *row);

/* An estimate of the error of the whole rule. distance: between the halves, from entries times scale. parts: squared
 * distances of halves and of fourths that the caller has found besides, unscaled. */
double fibrad_entries_error(const fibrad_entries *entries, const double parts[2], double distance, double scale);

#endif
