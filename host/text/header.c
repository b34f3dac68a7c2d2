/* header.c - names and units of the columns of a table, and its rows. SPDX-License-Identifier: MIT */
#include "text/header.h"

#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "text/read_number.h"
#include "text/unit.h"

#define WITHIN '\037' /* stands for a blank within brackets while names are split at blanks */

char header_separator(const char *text) {
    for (const char *c = ";\t,"; *c; ++c)
        if (strchr(text, *c)) return *c;
    return ' ';
}

int header_split(struct fields *fields, const struct lines *lines, char *text, char separator) {
    if (separator == ' ') return fields_split_blanks(fields, text);
    return fields_split_at(fields, lines, text, separator);
}

/* The bracket that closes the one at `open`. NULL: there is none. */
static char *closing(char *open) {
    int depth = 0;
    for (char *c = open; *c; ++c) {
        depth += *c == '[' || *c == '(';
        depth -= *c == ']' || *c == ')';
        if (depth == 0) return c;
    }
    return NULL;
}

static void replace(char *from, const char *end, char old, char new) {
    for (; from < end; ++from)
        if (*from == old) *from = new;
}

/* Splits names at blanks, but not within brackets: `k [W/(m K)]` has one unit. */
static int split_names(struct fields *names, char *text) {
    for (char *open = strpbrk(text, "[("); open; open = strpbrk(open + 1, "[(")) {
        char *close = closing(open);
        if (close) replace(open, close, ' ', WITHIN);
    }
    const int status = fields_split_blanks(names, text);
    for (size_t k = 0; k < names->n; ++k) replace(names->at[k], names->at[k] + strlen(names->at[k]), WITHIN, ' ');
    return status;
}

/* Cuts the unit off a name and returns the unit. "": the name has none. */
static char *take_unit(char *name) {
    const char *unit;
    size_t bare, length;
    if (!unit_behind(name, &bare, &unit, &length)) return name + strlen(name);
    char *found = name + (unit - name);
    found[length] = 0;
    name[bare] = 0;
    return found;
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

void header_free(struct header *header) {
    free(header->text);
    free(header->names.at);
    free(header->unit);
    *header = (struct header){0};
}

int header_take(struct header *header, const struct lines *lines, const char *text, const char *separators) {
    header_free(header);
    header->line = lines->number;
    for (const char *c = text; *c; ++c)
        if (iscntrl((unsigned char)*c) && !isspace((unsigned char)*c))
            return lines_fault(lines, "binary data; a text file is expected");
    header->text = strdup(text);
    if (!header->text) return message_memory();
    const char separator = header_separator(header->text);
    const int status = separators         ? fields_split(&header->names, header->text, separators)
                       : separator == ' ' ? split_names(&header->names, header->text)
                                          : fields_split_at(&header->names, lines, header->text, separator);
    return status ? status : take_units(header);
}

int header_number(struct header *header, size_t n) {
    enum { WIDTH = 12 };
    header_free(header);
    header->text = malloc(n * WIDTH + 1);
    if (!header->text) return message_memory();
    char *to = header->text;
    *to = 0;
    for (size_t k = 0; k < n; ++k) to += snprintf(to, WIDTH, "%zu ", k + 1);
    const int status = fields_split_blanks(&header->names, header->text);
    return status ? status : take_units(header);
}

bool header_is_row(const struct lines *lines) {
    char word[64];
    double value;
    const char *text = lines->text + strspn(lines->text, " \t\"");
    snprintf(word, sizeof word, "%.*s", (int)strcspn(text, " \t\r,;\""), text);
    return number_read(word, &value);
}
