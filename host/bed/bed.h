/* bed.h - spheres that were read from a file, and the lines they stand in. SPDX-License-Identifier: MIT */
#ifndef BED_H
#define BED_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct bed {
    uint32_t n, capacity, kept_capacity;
    bool ids;              /* spheres have ids; else their positions name them */
    double *x, *y, *z, *r; /* [n] centres and radii, in the unit of the file */
    uint64_t *line;        /* [n] line of each sphere in the file, from 1; 0: VTK files have no lines */
    int64_t *id;           /* [n] ascending, from 0, all different; if ids */
    uint32_t *clump;       /* [n] number of the clump, 0: the sphere is alone; NULL: there are no clumps */
    double *extra;         /* [n][extras] columns that options name */
    size_t extras;
    const char *kept_names; /* names of columns kept as text, with blanks in between; owned by the reader; NULL: none */
    char *kept;             /* [kept_used] the texts of these columns, a 0 behind those of each sphere */
    size_t *kept_at;        /* [n] index in `kept` where the texts of a sphere begin */
    size_t kept_used, kept_room;
    double low[3], high[3]; /* box of the file; all 0: the file has none */
    double period[3];       /* length of the periodic box per axis; 0: the axis is open */
    char units[16];         /* units that the file names, such as "cgs"; "": none */
    double metres;          /* unit of length [m], by the file or --length-unit; 0: not known */
    int64_t frame;          /* number of the frame in the file or in the series of files, from 0 */
    int64_t timestep;       /* timestep that the file names; -1: none */
};

/* Centres along an axis, 0 to 2. */
const double *bed_centres(const struct bed *bed, int axis);

/* A sphere for bed_add. */
struct bed_sphere {
    double x, y, z, r;
    uint64_t line;
    int64_t id;
};

/* A bed without spheres. Set its ids and extras before the first sphere. */
struct bed bed_empty(void);

/* Adds a sphere. The caller fills in its extra columns. Status 0, STATUS_INPUT if there are too many spheres, or
 * STATUS_MEMORY. */
int bed_add(struct bed *bed, const struct bed_sphere *sphere);

/* Keeps texts [n] of the last sphere, in the columns of bed->kept_names. Blanks within a text become _. Status 0 or
 * STATUS_MEMORY. */
int bed_keep(struct bed *bed, const char *const *text, size_t n);

/* The lower or upper end of a bed along an axis: that of the file's box, or else that of the spheres. */
double bed_end(const struct bed *bed, int axis, bool upper);

/* The coordinate of a wall at the lower or upper end: that of bed_end. LAMMPS may shrink a box until its faces pass
 * through centres. Then the wall lies at the end of the spheres, and *moved is set. */
double bed_wall_end(const struct bed *bed, int axis, bool upper, bool *moved);

/* The least or largest coordinate of the spheres of a bed along an axis. */
double bed_reach(const struct bed *bed, int axis, bool upper);

/* The mean diameter of the spheres of a bed. */
double bed_diameter(const struct bed *bed);

/* The name of a sphere: its id, or its position from 0. */
int64_t bed_name(const struct bed *bed, uint32_t i);

/* Writes " of line 7" for messages, or "" if the sphere has no line. Returns `text`. */
enum { BED_LINE_TEXT = 32 };
const char *bed_line_text(const struct bed *bed, uint32_t i, char text[BED_LINE_TEXT]);

/* Sorts the spheres by id, if they have ids. file: name of the bed in messages. Status 0, STATUS_MEMORY, or
 * STATUS_INPUT naming the line of an id that is negative or occurs twice. */
int bed_sort(struct bed *bed, const char *file);

/* Empties a bed and keeps its memory. */
void bed_clear(struct bed *bed);

void bed_free(struct bed *bed);

/* Takes the numbers of clumps from a further column. lone: -1, which LIGGGHTS writes, stands for 0. Status 0,
 * STATUS_MEMORY, or STATUS_INPUT naming the line of a number that is not whole or out of range. */
int bed_take_clumps(struct bed *bed, const char *file, size_t extra, bool lone);

/* Makes a bed of n bodies. A clump has the mean centre of its members, and the radius of a sphere of its exposed area.
 * Its id is its number. If a sphere that is alone has such a number, all clumps have the ids of their first members
 * instead. body [bed->n]: of each sphere; area [n]. Free `bodies` also after an error. Status 0 or STATUS_MEMORY. */
int bed_bodies(const struct bed *bed, uint32_t n, const uint32_t *body, const double *area, struct bed *bodies);

#endif
