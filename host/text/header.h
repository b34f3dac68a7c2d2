/* header.h - names and units of the columns of a table, and its rows. SPDX-License-Identifier: MIT */
#ifndef HEADER_H
#define HEADER_H

#include "text/read_lines.h"

/* The header: names of columns and their units, which point into `text`. */
struct header {
    char *text;
    struct fields names;
    char **unit; /* [names.n] "": the column has none */
    uint64_t line;
};

/* The character between the values of a line: the first of ; tab , that it has, or else a blank, which stands for any
 * number of blanks. */
char header_separator(const char *text);

/* Takes a text of the current line as the header. Names may have units, x [mm], k [W/(m K)] or r (m). separators: any
 * of them stand between names; NULL: that of the text. Free with header_free also after an error. Status 0,
 * STATUS_INPUT if a quote is missing, or STATUS_MEMORY. */
int header_take(struct header *header, const struct lines *lines, const char *text, const char *separators);

/* Names n columns 1, 2 ... n. Status 0 or STATUS_MEMORY. */
int header_number(struct header *header, size_t n);

/* Splits a row at the separator. Status as fields_split_at. */
int header_split(struct fields *fields, const struct lines *lines, char *text, char separator);

/* Whether the current line begins with a number, which may stand in quotes. */
bool header_is_row(const struct lines *lines);

void header_free(struct header *header);

#endif
