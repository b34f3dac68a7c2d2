/* read_columns.h - spheres from rows of named columns, for all readers of text. SPDX-License-Identifier: MIT */
#ifndef READ_COLUMNS_H
#define READ_COLUMNS_H

#include "bed/bed.h"
#include "read/read_options.h"
#include "text/read_lines.h"

struct source;

enum { UNIT_LENGTH = 32 };

/* The wanted columns. Each field is an index in a row. */
struct columns {
    const struct fields *header; /* the names; within columns_find only */
    size_t width;                /* fields of a row */
    size_t coordinate[3];        /* x, y, z */
    bool scaled[3];              /* the coordinate is a fraction of the box */
    size_t radius;
    double radius_unit; /* 0.5 for diameters */
    size_t id;          /* width: there is none */
    size_t *wanted;     /* [extras + rules] the further columns, and those of read_options.rule */
    double *factor;     /* [extras] from the unit of the column to the expected one */
    size_t *named;      /* [names] columns of read_options.name */
    struct twin *twin;  /* [twins] wanted columns that the file has twice, which must be equal */
    size_t twins;
    size_t *kept;      /* [keeps] columns that are kept as text */
    const char **text; /* [keeps] their texts in the current row */
    char *kept_names;  /* their names, with blanks in between */
    size_t keeps;
    bool commas;               /* numbers may have decimal commas */
    char mark;                 /* decimal point or comma, the first one in the file; 0: none so far */
    char (*unit)[UNIT_LENGTH]; /* [width] units of columns; "": none */
};

/* Finds the columns by the names of a header, in any case: x, xu, xs or xsu, and so on; r, radius, diameter or d; id.
 * Columns of source->options.name go before them. Extra columns have exactly the wanted names, with or without units.
 * units: [names->n] those of the header, NULL: headers of this format have none. The unit of the coordinates becomes
 * that of the bed. Free with columns_free. Status 0, STATUS_MEMORY, or STATUS_INPUT if a column is missing, if units
 * contradict each other, or if coordinates are scaled and the bed has no box. */
int columns_find(struct source *source, const struct fields *names, char *const *units, struct bed *bed);

void columns_free(struct columns *columns);

/* Whether x, y and z are among the names. */
bool columns_named(const struct fields *names);

/* Finds the factor from the unit of further column k to the expected one. lengths: the unit of lengths, or "". Status
 * 0, or STATUS_INPUT if the unit is of another kind. */
int columns_factor(const struct source *source, size_t k, const char *unit, const char *lengths, double *factor);

/* Adds the sphere of the row in source->fields to the bed, if the rules allow. Status 0, STATUS_MEMORY, or STATUS_INPUT
 * naming the column. */
int columns_add(struct source *source, struct bed *bed);

/* Adds a sphere. Refuses a radius that is not above 0, unless radii come from --radius. Status 0, STATUS_MEMORY or
 * STATUS_INPUT. */
int columns_add_sphere(const struct source *source, struct bed_sphere *sphere, struct bed *bed);

#endif
