/* read_table.c - beds from tables of text, and from YADE's text export. SPDX-License-Identifier: MIT
 *
 * Commas, semicolons, tabs or blanks stand between values. A header names the columns. The header is the first line. If
 * that line has numbers only, the header is a comment before it, such as `# x y z r` or YADE's `#format x_y_z_r`. Names
 * may have units, such as `x [mm]` or `r (m)`. Other lines that begin with # are skipped. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bed/units.h"
#include "cli/message.h"
#include "read/read_format.h"

/* The header: names of columns and their units, which point into `text`. */
struct header {
    char *text;
    struct fields names;
    char **unit; /* [names.n] "": the column has none */
    uint64_t line;
    bool yade; /* of YADE: any blanks stand between values */
};

static bool is_table(const struct source *source) {
    (void)source; /* the last format that is tried: it takes all files */
    return true;
}

/* The character between the values of a line. */
static char find_separator(const char *text) {
    for (const char *c = ";\t,"; *c; ++c)
        if (strchr(text, *c)) return *c;
    return ' ';
}

static int split(struct fields *fields, const struct lines *lines, char *text, char separator) {
    if (separator == ' ') return fields_split_blanks(fields, text);
    return fields_split_at(fields, lines, text, separator);
}

/* Cuts the unit off a name and returns the unit. "": the name has none. */
static char *take_unit(char *name) {
    char *open = strpbrk(name, "[(");
    char *end = name + strlen(name);
    if (!open || !strchr("])", end[-1])) return end;
    end[-1] = 0;
    char *tail = open;
    while (tail > name && strchr(" \t_", tail[-1])) --tail;
    *tail = 0;
    return open + 1;
}

/* Cuts the units off all names. If blanks stand between columns, `x [mm]` has been split into two names, which are
 * joined here. */
static int take_units(struct header *header) {
    struct fields *names = &header->names;
    size_t n = 0;
    header->unit = calloc(names->n + 1, sizeof *header->unit);
    if (!header->unit) return message_memory();
    for (size_t k = 0; k < names->n; ++k) {
        char *unit = take_unit(names->at[k]);
        if (n > 0 && *unit && !*names->at[k]) {
            header->unit[n - 1] = unit;
        } else {
            names->at[n] = names->at[k];
            header->unit[n++] = unit;
        }
    }
    names->n = n;
    return STATUS_OK;
}

static void forget_header(struct header *header) {
    free(header->text);
    free(header->names.at);
    free(header->unit);
    *header = (struct header){0};
}

/* Takes a text of the current line as the header. */
static int take_header(struct header *header, const struct lines *lines, const char *text) {
    static const char yade[] = "#format";
    forget_header(header);
    header->line = lines->number;
    header->text = strdup(text);
    if (!header->text) return message_memory();
    char *names = header->text;
    int status;
    header->yade = strncmp(names, yade, strlen(yade)) == 0;
    if (header->yade) {
        status = fields_split(&header->names, names + strlen(yade), "_ \t");
    } else {
        names += strspn(names, "# \t");
        status = split(&header->names, lines, names, find_separator(names));
    }
    return status ? status : take_units(header);
}

/* Takes a comment as the header if it names x, y and z. */
static int take_comment(struct header *header, const struct lines *lines) {
    struct header comment = {0};
    const int status = take_header(&comment, lines, lines->text);
    const bool good = !status && columns_named(&comment.names);
    forget_header(good ? header : &comment);
    if (good) *header = comment;
    return status;
}

static bool begins_with_number(const struct lines *lines) {
    const char *text = lines->text + strspn(lines->text, " \t\"");
    char *end;
    strtod(text, &end);
    return end != text;
}

/* Finds the header and the separator of the rows. The first row is the next line. */
static int find_header(struct source *source, struct header *header, char *separator) {
    struct lines *lines = &source->lines;
    bool more;
    int status;
    while ((status = lines_next(lines, &more)) == STATUS_OK && more) {
        if (*lines->text == '#') status = take_comment(header, lines);
        if (status) return status;
        if (*lines->text == '#' || lines_blank(lines)) continue;
        *separator = header->yade ? ' ' : find_separator(lines->text);
        if (!begins_with_number(lines)) return take_header(header, lines, lines->text);
        if (header->names.n == 0)
            return source_fail(source, "numbers without a header that names their columns, such as x,y,z,r");
        lines_hold(lines);
        return STATUS_OK;
    }
    return status;
}

/* Finds the unit of lengths, which must be the same in all columns. */
static int find_unit(const struct source *source, const struct header *header, struct bed *bed) {
    const struct columns *columns = &source->columns;
    const char *unit = header->unit[columns->coordinate[0]];
    const size_t lengths[] = {columns->coordinate[1], columns->coordinate[2],
                              source->options.no_radius ? columns->coordinate[0] : columns->radius};
    for (int k = 0; k < 3; ++k)
        if (strcmp(header->unit[lengths[k]], unit) != 0)
            return message_at(STATUS_INPUT, source->lines.name, header->line,
                              "lengths of more than one unit: %.40s in [%.10s], %.40s in [%.10s]",
                              header->names.at[columns->coordinate[0]], unit, header->names.at[lengths[k]],
                              header->unit[lengths[k]]);
    snprintf(bed->units, sizeof bed->units, "%s", unit);
    return STATUS_OK;
}

/* Refuses a further column whose header names another unit than the expected one. */
static int check_units(const struct source *source, const struct header *header) {
    for (size_t k = 0; k < source->options.extras; ++k) {
        const char *unit = header->unit[source->columns.extra[k]];
        const char *taken = source->options.unit ? source->options.unit[k] : NULL;
        if (source->options.any_unit &&
            strcmp(source->options.extra[k], header->names.at[source->columns.extra[k]]) != 0)
            continue;
        const bool none = !*unit || strcmp(unit, "-") == 0 || strcmp(unit, "1") == 0;
        if (taken ? *unit && !unit_is(unit, taken) : !none)
            return message_at(STATUS_INPUT, source->lines.name, header->line,
                              "the column %.40s is in [%.20s], but is taken as [%.20s]%s", source->options.extra[k],
                              unit, taken ? taken : "-", taken ? "; see --temperature-unit" : "");
    }
    return STATUS_OK;
}

static int find_columns(struct source *source, const struct header *header, char separator, struct bed *bed) {
    struct lines at = source->lines; /* a copy with the line of the header, for messages */
    at.number = header->line;
    source->columns.units = header->unit;
    int status = columns_find(&source->columns, &at, &header->names, &source->options, bed);
    source->columns.commas = separator != ',';
    if (!status) status = check_units(source, header);
    return status ? status : find_unit(source, header, bed);
}

/* Reads a row. If the last name of YADE's header is attrs, a row may have any number of attributes. */
static int read_row(struct source *source, const struct header *header, char separator, struct bed *bed) {
    const struct fields *names = &header->names;
    const int status = split(&source->fields, &source->lines, source->lines.text, separator);
    if (status) return status;
    if (header->yade && source->fields.n > names->n && strcmp(names->at[names->n - 1], "attrs") == 0)
        source->fields.n = names->n;
    return columns_add(&source->columns, &source->lines, &source->fields, &source->options, bed);
}

static int read_table(struct source *source, struct bed *bed) {
    struct lines *lines = &source->lines;
    struct header header = {0};
    char separator = ',';
    bool more;
    int status = find_header(source, &header, &separator);
    if (!status && header.names.n > 0) status = find_columns(source, &header, separator, bed);
    while (!status && (status = lines_next(lines, &more)) == STATUS_OK && more)
        if (*lines->text != '#' && !lines_blank(lines)) status = read_row(source, &header, separator, bed);
    forget_header(&header);
    return status;
}

const struct format format_table = {is_table, NULL, read_table};
