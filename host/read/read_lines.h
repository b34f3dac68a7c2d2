/* read_lines.h - text input line by line, with strict numbers. SPDX-License-Identifier: MIT */
#ifndef READ_LINES_H
#define READ_LINES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

struct lines {
    FILE *file;
    const char *name; /* for messages */
    uint64_t number;  /* of the line in `text`, from 1 */
    char *text;       /* without its end */
    size_t capacity;
    bool held;
};

/* Pieces of a line; they point into its text. */
struct fields {
    char **at;
    size_t n, capacity;
};

/* What messages call a path: "-" is standard input. */
const char *lines_name(const char *path);

/* Opens a file, or standard input for "-". Status 0 or STATUS_FILE. */
int lines_open(struct lines *lines, const char *path);
void lines_close(struct lines *lines);

/* The next line; *more is false at the end of the file. Status 0, STATUS_INPUT (binary data, endless lines),
 * STATUS_FILE, STATUS_MEMORY or that of a signal. */
int lines_next(struct lines *lines, bool *more);

/* lines_next will return the current line once more. */
void lines_hold(struct lines *lines);

/* Is there nothing but blanks in the line? */
bool lines_blank(const struct lines *lines);

/* Cuts a text at any of the separators, runs of which count once; *fields grows as needed (free fields->at). */
int fields_split(struct fields *fields, char *text, const char *separators);

/* Cuts the line at commas, takes off the blanks and quotes about the pieces. */
int fields_split_csv(struct fields *fields, const struct lines *lines);

/* A finite number, a whole number: the entire text or an error naming the line and `what` it should have been. */
int lines_number(const struct lines *lines, const char *what, const char *text, double *value);
int lines_whole(const struct lines *lines, const char *what, const char *text, int64_t *value);

#endif
