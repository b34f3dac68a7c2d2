/* read_lines.h - text files line by line, which may be packed by gzip, and their numbers.
 * SPDX-License-Identifier: MIT */
#ifndef READ_LINES_H
#define READ_LINES_H

#include "cli/message.h"

struct gzFile_s;

struct lines {
    struct gzFile_s *file;
    const char *name; /* for messages */
    uint64_t number;  /* of the current line, from 1 */
    char *text;       /* the current line, without the end of line; NULL: none */
    size_t length;
    bool ended;     /* an end of line follows the line, not the end of the file */
    bool truncated; /* the file is a gzip file that was cut off, and all of it has been read */

    /* The buffer has the kept lines from `kept` on, the current line, and unread bytes from `next` to `end`. */
    char *buffer;
    size_t capacity, kept, next, end;
    bool keeps;           /* lines are kept */
    bool finished;        /* the end of the file has been read */
    char behind;          /* the character that the 0 behind the current line has replaced */
    uint64_t kept_number; /* number of the line before the kept ones */
};

/* Fields of a line; they point into its text. */
struct fields {
    char **at;
    size_t n, capacity;
};

/* The name of a path in messages: "standard input" for "-". */
const char *lines_name(const char *path);

/* Opens a file, or standard input for "-". Reads its first bytes, up to 65536, into lines->buffer from lines->next to
 * lines->end. Skips a byte order mark. Status 0, STATUS_FILE, STATUS_INPUT (damaged gzip file), STATUS_MEMORY, or as
 * output_spare. */
int lines_open(struct lines *lines, const char *path);
void lines_close(struct lines *lines);

/* Prints an error with the number of the current line, as printf does. Is STATUS_INPUT. */
#define lines_fault(lines, ...) message_at(STATUS_INPUT, (lines)->name, (lines)->number, __VA_ARGS__)

/* Reads the next line. *more: false at the end of the file. Status 0, STATUS_INPUT (binary data, a line without end,
 * damaged gzip file), STATUS_FILE, STATUS_MEMORY or that of a signal. */
int lines_next(struct lines *lines, bool *more);

/* Reads the next line that is not blank. As lines_next. */
int lines_next_text(struct lines *lines, bool *more);

/* Makes lines_next return the current line once more. Until then there is no current line. */
void lines_hold(struct lines *lines);

/* lines_keep keeps in memory all lines behind the current one. lines_return goes back to the first kept line, if no
 * line has been split since. lines_drop ends the keeping. */
void lines_keep(struct lines *lines);
void lines_return(struct lines *lines);
void lines_drop(struct lines *lines);

/* Reads all bytes behind the current line into the buffer, with a 0 behind them. Status as lines_next. */
int lines_rest(struct lines *lines, char **rest, size_t *size);

/* Whether the current line has blanks only. */
bool lines_blank(const struct lines *lines);

/* Whether the current line is a comment: it begins with # or %. */
bool lines_comment(const struct lines *lines);

/* Whether the current line begins with a text. */
bool lines_begin(const struct lines *lines, const char *with);

/* Splits a text at any of the separators, or at blanks. Several separators in a row count as one. Free fields->at in
 * the end. Status 0 or STATUS_MEMORY. */
int fields_split(struct fields *fields, char *text, const char *separators);
int fields_split_blanks(struct fields *fields, char *text);

/* Splits a text of the current line at each separator. Removes blanks and quotes about the fields. Status 0,
 * STATUS_INPUT if a quote is missing, or STATUS_MEMORY. */
int fields_split_at(struct fields *fields, const struct lines *lines, char *text, char separator);

/* Read a finite number, or a whole number, which must be the whole text. `what` names the number in messages. Status 0,
 * or STATUS_INPUT naming the line. */
int lines_number(const struct lines *lines, const char *what, const char *text, double *value);
int lines_whole(const struct lines *lines, const char *what, const char *text, int64_t *value);

/* Reads a number of a file that may have decimal commas. *mark: point or comma, the first one in the file, which all
 * others must be; 0: none so far. mark NULL: the file has no decimal commas. Changes a comma in the text to a point.
 * Otherwise as lines_number. */
int lines_decimal(const struct lines *lines, const char *what, char *text, char *mark, double *value);

#endif
