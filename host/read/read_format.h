/* read_format.h - the interface of a format, and functions for the readers of all formats.
 * SPDX-License-Identifier: MIT */
#ifndef READ_FORMAT_H
#define READ_FORMAT_H

#include "bed/bed.h"
#include "read/read_options.h"
#include "text/read_lines.h"

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

enum found {
    FOUND_FRAME,
    FOUND_END,
    FOUND_PART /* the file ends within a frame */
};

enum { LACK_MAX = 100 };

/* A file that is being read. */
struct source {
    struct lines lines;
    struct read_options options;
    struct fields fields;
    struct columns columns;
    char units[sizeof((struct bed *)0)->units]; /* of all frames, as the file names them once */
    enum found found;                           /* what the format has skipped */
    char lack[LACK_MAX];                        /* what is missing in a part */
    bool warned;                                /* source_warn_open has warned */
};

/* A format. The contents of a file tell its format. */
struct format {
    /* Whether a file has this format, by its first bytes, which lines_open has read. */
    bool (*is)(const struct source *source);

    /* Skips a frame, without splitting lines, and checks that all its lines are there. Sets source->found, and
     * source->lack if it is FOUND_PART. NULL: files of the format have one frame. */
    int (*skip)(struct source *source);

    /* Reads a frame into an empty bed. */
    int (*read)(struct source *source, struct bed *bed);
};

/* The first bytes of the file. Call it before the first line is read. */
const char *source_begin(const struct source *source, size_t *size);

/* Whether the file begins with a text. */
bool source_begins(const struct source *source, const char *text);

extern const struct format format_data, format_dump, format_mercury, format_table, format_vtk, format_vtk_series,
    format_vtk_xml, format_xyz;

/* Refuses a file of a known kind that has no spheres, and says what the file is. Status 0 or STATUS_INPUT. */
int source_foreign(const struct source *source);

/* Prints an error with the number of the current line, as printf does. Is STATUS_INPUT. */
#define source_fail(source, ...) lines_fault(&(source)->lines, __VA_ARGS__)

/* Finds the columns by a text of names with blanks in between. Status as columns_find. */
int source_columns(struct source *source, const char *names, struct bed *bed);

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

/* Reads the next lines as spheres, one per line. A row may have up to `more` columns behind the known ones. Status as
 * columns_add, or STATUS_INPUT if the file ends too early. */
int source_rows(struct source *source, int64_t rows, size_t more, struct bed *bed);

/* Skips lines. FOUND_PART: the file has fewer. what: names them in messages. A line that begins with `stop` is an
 * error; NULL: none is. */
int source_skip(struct source *source, int64_t rows, const char *what, const char *stop);

/* Changes FOUND_FRAME to FOUND_PART if the last line has no end of line: a number may be cut off. For formats that only
 * programs write. */
void source_skip_end(struct source *source);

/* Read a text, or the current line, as a number of atoms. Status 0 or STATUS_INPUT. */
int source_count(const struct source *source, const char *text, int64_t *atoms);
int source_count_line(const struct source *source, int64_t *atoms);

/* Relative to the length of an edge: boxes that were turned and written in digits have traces of this size. */
#define EDGE_TRACE 1e-9

/* Puts a box into the bed, whose edges a, b, c [3] begin at the origin. periodic [3]. `what` names the box in messages.
 * Status 0, or STATUS_INPUT if the edges do not lie along x, y and z, or are not above 0. */
int source_edges(const struct source *source, const char *what, const double edge[9], const double origin[3],
                 const bool periodic[3], struct bed *bed);

/* Warns once per file that the file does not say which axes are periodic. */
void source_warn_open(struct source *source);

/* Copies the current line without the blanks about it. A text longer than `room` is cut. Returns `to`. */
char *source_word(const struct source *source, char *to, size_t room);

/* Prints that the file ends too early: `lack`, or that the gzip file is cut off. Returns STATUS_INPUT. */
int source_ends(const struct source *source, const char *lack);

#endif
