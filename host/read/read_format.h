/* read_format.h - what the readers of all formats have in common. SPDX-License-Identifier: MIT */
#ifndef READ_FORMAT_H
#define READ_FORMAT_H

#include "bed/bed.h"
#include "read/read_columns.h"
#include "read/read_options.h"
#include "text/read_lines.h"

/* A file that is being read. */
struct source {
    struct lines lines;
    struct read_options options;
    struct fields fields;
    struct columns columns;
    char units[sizeof((struct bed *)0)->units]; /* as said once for all frames */
    bool warned;                                /* that the file does not say what is periodic */
};

enum found {
    FOUND_FRAME,
    FOUND_END,
    FOUND_PART /* the file ends within a frame */
};

/* How a format is read. Files are told by contents. */
struct format {
    bool (*is)(const struct source *source); /* by the first bytes of the file, as lines_open has left them */

    /* Passes over a frame and checks that all lines of it are there, without cutting any; tells in LACK_MAX bytes what
     * a part lacks. NULL: the file is one frame. */
    int (*skip)(struct source *source, enum found *found, char *lack);

    /* Reads a frame into an empty bed. */
    int (*read)(struct source *source, struct bed *bed);
};

enum { LACK_MAX = 100 };

/* The first bytes of the file, before any line has been read. */
const char *source_begin(const struct source *source, size_t *size);

/* Does the file begin with a text? */
bool source_begins(const struct source *source, const char *text);

extern const struct format format_data, format_dump, format_mercury, format_table, format_vtk, format_vtk_xml,
    format_xyz;

/* Refuses a file that is known to have no spheres, and says what it is. Status 0 or STATUS_INPUT. */
int source_foreign(const struct source *source);

/* The error `what`, in the current line. Status STATUS_INPUT. */
int source_fail(const struct source *source, const char *what);

/* Finds the columns by names in one text, parted by blanks. Status as columns_find. */
int source_columns(struct source *source, const char *names, const struct bed *bed);

/* Reads the next lines as so many spheres; rows may have up to `more` columns behind those that are known. Status as
 * columns_add, and STATUS_INPUT where the file ends. */
int source_rows(struct source *source, int64_t rows, size_t more, struct bed *bed);

/* Passes over so many lines; FOUND_PART: the file has fewer. */
int source_skip(struct source *source, int64_t rows, enum found *found, char *lack);

/* A frame whose last line has no end is but a part: a number may have been cut. For files that programs alone write. */
void source_skip_end(const struct source *source, enum found *found, char *lack);

/* The line, or its first word, as a number of atoms. */
int source_count(const struct source *source, const char *text, int64_t *atoms);

/* Warns, once, that the file does not say which axes are periodic. */
void source_warn_open(struct source *source);

/* The line without the blanks about it, as much as there is room for. Returns `to`. */
char *source_word(const struct source *source, char *to, size_t room);

/* The file ends too early, which is what `lack` says in more detail. Status STATUS_INPUT. */
int source_ends(const struct source *source, const char *lack);

#endif
