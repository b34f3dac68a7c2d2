/* read_table.c - beds from tables of text, and from YADE's text export. SPDX-License-Identifier: MIT
 *
 * Commas, semicolons, tabs or blanks stand between values. A header names the columns. The header is the first line. If
 * that line has numbers only, the header is a comment before it, such as `# x y z r` or YADE's `#format x_y_z_r`. Names
 * may have units, such as `x [mm]` or `r (m)`. Other lines that begin with # or % are skipped. */
#include <stdlib.h>
#include <string.h>

#include "read/read_format.h"
#include "text/header.h"

static bool is_table(const struct source *source) {
    (void)source; /* the last format that is tried: it takes all files */
    return true;
}

static const char yade[] = "#format";

static bool is_yade(const char *text) { return strncmp(text, yade, strlen(yade)) == 0; }

/* Takes a comment as the header if it names x, y and z. */
static int take_comment(struct header *header, bool *of_yade, const struct lines *lines) {
    struct header comment = {0};
    const bool format = is_yade(lines->text);
    const char *names = lines->text + (format ? strlen(yade) : strspn(lines->text, "#% \t"));
    const int status = header_take(&comment, lines, names, format ? "_ \t" : NULL);
    const bool good = !status && columns_named(&comment.names);
    header_free(good ? header : &comment);
    if (good) *header = comment, *of_yade = format;
    return status;
}

/* Finds the columns' names of a table without a header: numbers from 1, if --columns says which is which. */
static int number_table(struct source *source, struct header *header, char separator) {
    struct lines *lines = &source->lines;
    if (source->options.names == 0)
        return source_fail(source, "numbers without a header that names their columns, such as x,y,z,r; "
                                   "--columns x=1,y=2,z=3,r=4 names them");
    char *row = strdup(lines->text);
    int status = row ? header_split(&source->fields, lines, row, separator) : message_memory();
    if (!status) status = header_number(header, source->fields.n);
    free(row);
    header->line = lines->number;
    return status;
}

/* Finds the header and the separator of the rows. The first row is the next line. */
static int find_header(struct source *source, struct header *header, bool *of_yade, char *separator) {
    struct lines *lines = &source->lines;
    bool more;
    int status;
    while (!(status = lines_next(lines, &more)) && more) {
        if (lines_comment(lines)) status = take_comment(header, of_yade, lines);
        if (status) return status;
        if (lines_comment(lines) || lines_blank(lines)) continue;
        *separator = *of_yade ? ' ' : header_separator(lines->text);
        if (!header_is_row(lines)) return header_take(header, lines, lines->text, NULL);
        if (header->names.n == 0) status = number_table(source, header, *separator);
        if (!status) lines_hold(lines);
        return status;
    }
    return status;
}

static int find_columns(struct source *source, const struct header *header, char separator, struct bed *bed) {
    const uint64_t here = source->lines.number;
    source->lines.number = header->line; /* for messages */
    source->columns.commas = separator != ',';
    const int status = columns_find(source, &header->names, header->unit, bed);
    source->lines.number = here;
    return status;
}

/* Reads a row. If the last name of YADE's header is attrs, a row may have any number of attributes. */
static int read_row(struct source *source, const struct header *header, bool of_yade, char separator, struct bed *bed) {
    const struct fields *names = &header->names;
    const int status = header_split(&source->fields, &source->lines, source->lines.text, separator);
    if (status) return status;
    if (of_yade && source->fields.n > names->n && strcmp(names->at[names->n - 1], "attrs") == 0)
        source->fields.n = names->n;
    return columns_add(source, bed);
}

static int read_table(struct source *source, struct bed *bed) {
    struct lines *lines = &source->lines;
    struct header header = {0};
    char separator = ',';
    bool more, of_yade = false;
    int status = find_header(source, &header, &of_yade, &separator);
    if (!status && header.names.n > 0) status = find_columns(source, &header, separator, bed);
    while (!status && !(status = lines_next(lines, &more)) && more)
        if (!lines_comment(lines) && !lines_blank(lines)) status = read_row(source, &header, of_yade, separator, bed);
    header_free(&header);
    return status;
}

const struct format format_table = {is_table, NULL, read_table};
