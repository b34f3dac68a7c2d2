/* bed.h - spheres as read from a file, with the lines they came from. SPDX-License-Identifier: MIT */
#ifndef BED_H
#define BED_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct bed {
    uint32_t n, capacity;
    double *x, *y, *z, *r; /* [n] file units */
    uint64_t *line;        /* [n] where in the file each sphere stands, from 1 */
    bool ids;
    int64_t *id;   /* [n] the file's ids, if asked for */
    double *extra; /* [n][extras] further columns asked for by name */
    size_t extras;
    double low[3], high[3]; /* the file's box; all 0 if it has none */
    double period[3];       /* length of the periodic box per axis; 0: the axis is open */
};

/* One sphere to be added. */
struct bed_sphere {
    double x, y, z, r;
    uint64_t line;
    int64_t id;
};

/* Makes an empty bed with room for ids if they are wanted. */
void bed_init(struct bed *bed, bool ids, size_t extras);

/* Adds a sphere; its extra columns are for the caller to fill in. Status 0 or STATUS_MEMORY. */
int bed_add(struct bed *bed, const struct bed_sphere *sphere);

/* Forgets the spheres and the box, keeps the memory. */
void bed_clear(struct bed *bed);

void bed_free(struct bed *bed);

#endif
