/* read_columns.h - rows of named columns become spheres; shared by all readers. SPDX-License-Identifier: MIT */
#ifndef READ_COLUMNS_H
#define READ_COLUMNS_H

#include "bed/bed.h"
#include "read/read.h"
#include "read/read_lines.h"

/* Where the columns wanted stand in a row. */
struct columns {
    size_t width;    /* fields of a row */
    size_t place[3]; /* x, y, z */
    bool scaled[3];  /* the coordinate is a fraction of the box */
    size_t radius;
    double radius_unit; /* 0.5 for diameters */
    size_t id;
    size_t *extra; /* [extras] */
};

/* Finds the columns by the names of a header: x, xu, xs or xsu, and so on; radius, r or diameter; id; the extras.
 * Errors: STATUS_INPUT naming the column that is missing or stands there twice. Free columns->extra. */
int columns_find(struct columns *columns, const struct lines *lines, const struct fields *names,
                 const struct read_options *options);

/* Adds the sphere of one row to the bed. Errors: STATUS_INPUT naming the column. */
int columns_add(const struct columns *columns, const struct lines *lines, const struct fields *row,
                const struct read_options *options, struct bed *bed);

#endif
