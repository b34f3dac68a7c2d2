/* read_columns.h - rows of named columns become spheres; shared by all readers of text. SPDX-License-Identifier: MIT */
#ifndef READ_COLUMNS_H
#define READ_COLUMNS_H

#include "bed/bed.h"
#include "read/read_options.h"
#include "text/read_lines.h"

/* Where the columns wanted stand in a row. */
struct columns {
    size_t width;    /* fields of a row */
    size_t place[3]; /* x, y, z */
    bool scaled[3];  /* the coordinate is a fraction of the box */
    size_t radius;
    double radius_unit; /* 0.5 for diameters */
    size_t id;          /* width: there is none */
    size_t *extra;      /* [extras] */
    size_t *kept;       /* [keeps] columns that are kept as text, */
    const char **text;  /* [keeps] what a row has in them */
    char *kept_names;   /* and their names, parted by blanks */
    size_t keeps;
    bool commas;        /* numbers may have decimal commas */
    char mark;          /* point or comma, the first that was found */
    char *const *units; /* [width] of the names in the header, "": none; NULL: they say none */
};

/* Finds the columns by the names of a header: x, xu, xs or xsu, and so on; radius, r, diameter or d, in any case; id;
 * the extras, with or without their units. Errors: STATUS_INPUT naming the column that is missing or stands there
 * twice, or where coordinates are scaled and the bed has no box. Free by columns_free. */
int columns_find(struct columns *columns, const struct lines *lines, const struct fields *names,
                 const struct read_options *options, const struct bed *bed);

void columns_free(struct columns *columns);

/* Do names have x, y and z among them? */
bool columns_named(const struct fields *names);

/* Adds the sphere of one row to the bed. Errors: STATUS_INPUT naming the column. */
int columns_add(struct columns *columns, const struct lines *lines, const struct fields *row,
                const struct read_options *options, struct bed *bed);

/* Adds a sphere whose radius is above 0, or is not looked for. Errors: STATUS_INPUT. */
int columns_add_sphere(const struct lines *lines, const struct read_options *options, struct bed_sphere *sphere,
                       struct bed *bed);

#endif
