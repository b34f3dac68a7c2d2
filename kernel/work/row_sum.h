/* row_sum.h - the entries of a row while they are summed. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WORK_ROW_SUM_H
#define FIBRAD_WORK_ROW_SUM_H

#include "base/addends.h"
#include "scene/scene.h"

/* What has been seen of each sphere so far, in the order of first sight; the sum over each fourth direction or ray
 * apart, for the estimate of the error. */
typedef struct fibrad_entries {
    uint32_t *at;      /* [slots] open addressing by sphere: which entry is its; FIBRAD_NONE: free */
    uint32_t *slot;    /* [capacity] where `at` tells of each entry */
    uint32_t *sphere;  /* [capacity] */
    double (*part)[4]; /* [capacity] visible area over all windows k = 0, 1, 2, 3 mod 4, or number of rays */
    double *lengths;   /* [capacity] of the rays, summed [L] */
    double *angles;    /* [capacity] between the rays and the line of centres, summed */
    uint64_t *key[2];  /* [capacity] scratch of the sort by columns */
    uint32_t slots, capacity, length, missed;
    fibrad_addends *addends; /* NULL, or where what is added is listed instead */
    bool end; /* the window in hand is the first or the last: it counts half in differences of even and odd windows */
} fibrad_entries;

/* The entry of a sphere, a new one if it has none so far; FIBRAD_NONE if that finds no room. */
uint32_t fibrad_entries_of(fibrad_entries *entries, uint32_t sphere);

/* Lists what is added to an entry instead of adding it. */
void fibrad_entries_list(fibrad_entries *entries, uint32_t entry, uint32_t k, double area);

/* Adds visible area to part k mod 4 of an entry. Counts in entries.missed what has none. */
static inline void fibrad_entries_add(fibrad_entries *entries, uint32_t entry, uint32_t k, double area) {
    if (entry == FIBRAD_NONE) {
        entries->missed++;
        return;
    }
    if (entries->addends != NULL) {
        fibrad_entries_list(entries, entry, k, area);
        return;
    }
    double *part = entries->part[entry];
    if (entries->end) { /* so even - odd holds half of it */
        part[k % 4 ^ 1] += area / 4;
        area -= area / 4;
    }
    part[k % 4] += area;
}

/* The entry of a sphere; FIBRAD_NONE if it has found no room. */
uint32_t fibrad_entries_find(const fibrad_entries *entries, uint32_t sphere);

/* Adds the entries that follow those of spheres, spheres + slot, to what slots have. */
void fibrad_entries_slots(const fibrad_entries *entries, const fibrad_scene *scene, double wall[FIBRAD_SLOTS]);

/* Writes the row: entries times `scale`, columns ascending, and as its error the distance of the sums over even and odd
 * windows. Those of slots are errors alone; those of spheres that triangles have hidden again are left out. */
int fibrad_entries_row(const fibrad_entries *entries, const fibrad_scene *scene, double scale, fibrad_row *row);

/* The error of the whole rule, estimated: `distance` is that of the halves, entries times scale, and what the caller
 * has put into it besides: parts are the squared distances of those halves and fourths, unscaled. */
double fibrad_entries_error(const fibrad_entries *entries, const double parts[2], double distance, double scale);

#endif
