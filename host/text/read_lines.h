/* read_lines.h - text input line by line, packed by gzip or not, with strict numbers. SPDX-License-Identifier: MIT */
#ifndef READ_LINES_H
#define READ_LINES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct gzFile_s;

struct lines {
    struct gzFile_s *file;
    const char *name; /* for messages */
    uint64_t number;  /* of the line in `text`, from 1 */
    char *text;       /* without its end */
    size_t length;
    bool ended;     /* a line end is behind it, not the end of the file */
    bool truncated; /* the end of the file is that of a gzip file that was cut off */

    /* what has been read of the file: lines that are kept, the current line, bytes that are still to come */
    char *buffer;
    size_t capacity, kept, next, end;
    bool keeps, finished;
    char behind; /* what stood where text ends now */
    uint64_t kept_number;
};

/* Pieces of a line; they point into its text. */
struct fields {
    char **at;
    size_t n, capacity;
};

/* What messages call a path: "-" is standard input. */
const char *lines_name(const char *path);

/* Opens a file, or standard input for "-", and reads its first bytes, up to 65536: those of lines->buffer from
 * lines->next to lines->end. A byte order mark is skipped. Status 0, STATUS_FILE, STATUS_INPUT (damaged gzip),
 * STATUS_MEMORY, or as output_spare. */
int lines_open(struct lines *lines, const char *path);
void lines_close(struct lines *lines);

/* The next line; *more is false at the end of the file. Status 0, STATUS_INPUT (binary data, endless lines, damaged
 * gzip), STATUS_FILE, STATUS_MEMORY or that of a signal. */
int lines_next(struct lines *lines, bool *more);

/* lines_next will return the current line once more; until then there is none. */
void lines_hold(struct lines *lines);

/* Keeps in memory all that comes behind the current line; lines_return goes back to there, once, if no line has been
 * cut to pieces since. lines_drop keeps no longer. */
void lines_keep(struct lines *lines);
void lines_return(struct lines *lines);
void lines_drop(struct lines *lines);

/* All that comes behind the current line, up to the end of the file, and a 0; it is the buffer's. Status as
 * lines_next. */
int lines_rest(struct lines *lines, char **rest, size_t *size);

/* Is there nothing but blanks in the line? */
bool lines_blank(const struct lines *lines);

/* Does it begin so? */
bool lines_begin(const struct lines *lines, const char *with);

/* Cuts a text at any of the separators, or at blanks, runs of which count once; *fields grows as needed (free
 * fields->at). */
int fields_split(struct fields *fields, char *text, const char *separators);
int fields_split_blanks(struct fields *fields, char *text);

/* Cuts a text of the current line at a separator, takes off the blanks and quotes about the pieces. */
int fields_split_at(struct fields *fields, const struct lines *lines, char *text, char separator);

/* A finite number, a whole number: the entire text or an error naming the line and `what` it should have been. */
int lines_number(const struct lines *lines, const char *what, const char *text, double *value);
int lines_whole(const struct lines *lines, const char *what, const char *text, int64_t *value);

#endif
