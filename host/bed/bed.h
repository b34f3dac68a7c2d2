/* bed.h - spheres as read from a file, with the lines they came from. SPDX-License-Identifier: MIT */
#ifndef BED_H
#define BED_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct bed {
    uint32_t n, capacity, kept_capacity;
    bool ids;              /* spheres have ids; else their positions name them */
    double *x, *y, *z, *r; /* [n] units of the file */
    uint64_t *line;        /* [n] where in the file each sphere stands, from 1; 0: in a VTK file */
    int64_t *id;           /* [n] ascending, from 0 on, no two alike */
    double *extra;         /* [n][extras] further columns asked for by name */
    size_t extras;
    const char *kept_names; /* of further columns that are kept as text, parted by blanks, the reader's; NULL: none */
    char *kept;             /* [kept_used] their texts, a 0 behind those of each sphere */
    size_t *kept_at;        /* [n] where those of a sphere begin */
    size_t kept_used, kept_room;
    double low[3], high[3]; /* the file's box; all 0 if it has none */
    double period[3];       /* length of the periodic box per axis; 0: the axis is open */
    char units[16];         /* as the file calls them, such as "cgs"; "": it says nothing */
    int64_t frame;          /* which one of the file, or of all frames of a series of files, from 0 */
    int64_t timestep;       /* as the file says; -1: it says nothing */
};

/* One sphere to be added. */
struct bed_sphere {
    double x, y, z, r;
    uint64_t line;
    int64_t id;
};

/* Makes an empty bed. What has ids or extras says so before the first sphere. */
void bed_init(struct bed *bed);

/* Adds a sphere; its extra columns are for the caller to fill in. Status 0 or STATUS_MEMORY. */
int bed_add(struct bed *bed, const struct bed_sphere *sphere);

/* Keeps the columns' texts of the last sphere, those of the bed's kept_names. Blanks within them become _. Status 0 or
 * STATUS_MEMORY. */
int bed_keep(struct bed *bed, const char *const *text, size_t n);

/* The lower or upper end of a bed along an axis: that of the file's box, or else of the spheres. */
double bed_end(const struct bed *bed, int axis, bool upper);

/* Where a wall stands there: at the end of the file's box; at that of the spheres where the box is one about centres,
 * as LAMMPS shrinks it, which sets *moved. */
double bed_wall_end(const struct bed *bed, int axis, bool upper, bool *moved);

/* How far its spheres reach there. */
double bed_reach(const struct bed *bed, int axis, bool upper);

/* The name of a sphere: its id, or its position from 0 on. */
int64_t bed_name(const struct bed *bed, uint32_t i);

/* Room for what bed_place says. */
enum { BED_PLACE = 32 };

/* " of line 7", or "" where a sphere is on no line, in `text`, which is returned. */
const char *bed_place(const struct bed *bed, uint32_t i, char text[BED_PLACE]);

/* Puts the spheres in the order of their ids, if they have any. Status 0; STATUS_INPUT naming the line of an id that is
 * negative or there twice; STATUS_MEMORY. `file` is the bed's name in messages. */
int bed_sort(struct bed *bed, const char *file);

/* Forgets the spheres, the box and what the file says of the frame, keeps the memory. */
void bed_clear(struct bed *bed);

void bed_free(struct bed *bed);

#endif
