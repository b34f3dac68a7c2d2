/* read_format.h - what the readers of all formats have in common. SPDX-License-Identifier: MIT */
#ifndef READ_FORMAT_H
#define READ_FORMAT_H

#include "bed/bed.h"
#include "read/read.h"
#include "read/read_columns.h"
#include "text/read_lines.h"

/* A file that is being read. */
struct source {
    struct lines lines;
    struct read_options options;
    struct fields fields;
    struct columns columns;
    char units[sizeof((struct bed *)0)->units]; /* as said once for all frames */
};

enum found {
    FOUND_FRAME,
    FOUND_END,
    FOUND_PART /* the file ends within a frame */
};

/* How a format is read. Files are told by contents. */
struct format {
    bool (*is)(const struct source *source); /* by the first bytes of the file, as lines_open has left them */

    /* Passes over a frame and checks that all lines of it are there, without cutting any; tells in LACK_MAX bytes what a
     * part lacks. NULL: the file is one frame. */
    int (*skip)(struct source *source, enum found *found, char *lack);

    /* Reads a frame into an empty bed. */
    int (*read)(struct source *source, struct bed *bed);
};

enum { LACK_MAX = 100 };

extern const struct format format_dump, format_table;

/* The error `what`, in the current line. Status STATUS_INPUT. */
int source_fail(const struct source *source, const char *what);

/* The line without the blanks about it, as much as there is room for. Returns `to`. */
char *source_word(const struct source *source, char *to, size_t room);

/* The file ends too early, which is what `lack` says in more detail. Status STATUS_INPUT. */
int source_ends(const struct source *source, const char *lack);

#endif
