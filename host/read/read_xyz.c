/* read_xyz.c - beds from XYZ and extended XYZ files. SPDX-License-Identifier: MIT
 *
 * A frame is a line with the number of atoms, a comment, and a line for each atom. In extended XYZ the comment has
 * `Properties=species:S:1:pos:R:3:radius:R:1`, which names the columns. The comment may have `Lattice="..."`, the edges
 * of the box, `Origin="x y z"`, and `pbc="T T F"`, the periodic axes. Without pbc all axes are periodic. */
#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "cli/message.h"
#include "read/read_format.h"
#include "text/read_number.h"

enum { COLUMNS_MAX = 1000, ANY = 1000 };

/* Whether the first line is one whole number. */
static bool is_xyz(const struct source *source) {
    size_t size;
    const char *text = source_begin(source, &size), *end = memchr(text, '\n', size);
    if (!end) return false;
    while (text < end && isspace((unsigned char)*text)) ++text;
    const char *digits = text;
    while (text < end && isdigit((unsigned char)*text)) ++text;
    if (text == digits) return false;
    while (text < end && isspace((unsigned char)*text)) ++text;
    return text == end;
}

static int skip_xyz(struct source *source, enum found *found, char *lack) {
    bool more;
    int64_t atoms;
    char word[32];
    int status;
    *found = FOUND_END;
    while ((status = lines_next(&source->lines, &more)) == STATUS_OK && more && lines_blank(&source->lines)) continue;
    if (status || !more) return status;
    status = source_count(source, source_word(source, word, sizeof word), &atoms);
    if (!status) status = source_skip(source, 1, found, lack);
    if (status || *found == FOUND_PART) return status;
    return source_skip(source, atoms, found, lack);
}

/* Copies the value of a key of the comment. The value stands behind =, in quotes or up to a blank. False: there is no
 * such key, or the value is too long. */
static bool find_value(const char *comment, const char *key, char *to, size_t room) {
    const size_t length = strlen(key);
    char quote = 0;
    for (const char *c = comment; *c; ++c) {
        if (*c == '"') quote = quote ? 0 : '"';
        if (quote || (c > comment && !isspace((unsigned char)c[-1])) || strncasecmp(c, key, length) != 0 ||
            c[length] != '=')
            continue;
        const char *value = c + length + 1;
        const bool quoted = *value == '"';
        value += quoted;
        const size_t size = strcspn(value, quoted ? "\"" : " \t");
        if (size >= room) return false;
        memcpy(to, value, size);
        to[size] = 0;
        return true;
    }
    return false;
}

/* Reads up to n numbers of a value. Returns how many there are. */
static int take_numbers(const char *text, int n, double *value) {
    char word[64];
    int length, k = 0;
    while (k < n && sscanf(text, " %63s%n", word, &length) == 1 && number_read(word, &value[k])) {
        text += length;
        ++k;
    }
    return k;
}

static int read_lattice(const struct source *source, const char *comment, struct bed *bed) {
    char text[1000];
    double edge[9], origin[3] = {0, 0, 0};
    char periodic[3][8] = {"T", "T", "T"};
    if (!find_value(comment, "Lattice", text, sizeof text)) return STATUS_OK;
    if (take_numbers(text, 9, edge) != 9) return source_fail(source, "Lattice needs nine numbers");
    if (edge[1] != 0 || edge[2] != 0 || edge[3] != 0 || edge[5] != 0 || edge[6] != 0 || edge[7] != 0)
        return source_fail(source, "the lattice is tilted; only boxes with right angles can be read");
    if (find_value(comment, "Origin", text, sizeof text) && take_numbers(text, 3, origin) != 3)
        return source_fail(source, "Origin needs three numbers");
    if (find_value(comment, "pbc", text, sizeof text) &&
        sscanf(text, "%7s %7s %7s", periodic[0], periodic[1], periodic[2]) != 3)
        return source_fail(source, "pbc needs three of T and F");
    for (int axis = 0; axis < 3; ++axis) {
        const double length = edge[4 * axis];
        const char *mark = periodic[axis];
        if (!(length > 0)) return source_fail(source, "the box is empty: the edges of Lattice must be above 0");
        if (!strchr("TtFf01", *mark)) return source_fail(source, "pbc needs three of T and F");
        bed->low[axis] = origin[axis];
        bed->high[axis] = origin[axis] + length;
        bed->period[axis] = strchr("Tt1", *mark) ? length : 0;
    }
    return STATUS_OK;
}

/* Prints the names of the columns of one property. The columns of pos are x, y and z. */
static void print_names(FILE *names, const char *property, long count) {
    const bool position = strcasecmp(property, "pos") == 0 && count == 3;
    for (long k = 0; k < count; ++k)
        if (position)
            fprintf(names, "%c ", "xyz"[k]);
        else if (count == 1)
            fprintf(names, "%s ", property);
        else
            fprintf(names, "%s:%ld ", property, k);
}

/* Prints the names of the columns of all properties: species:S:1:pos:R:3 becomes `species x y z`. */
static int read_properties(const struct source *source, char *text, FILE *names) {
    struct fields piece = {0};
    int64_t count, columns = 0;
    int status = fields_split(&piece, text, ":");
    if (!status && piece.n % 3 != 0) status = source_fail(source, "Properties needs name:type:count for each");
    for (size_t k = 0; k + 2 < piece.n && !status; k += 3) {
        if (!number_read_whole(piece.at[k + 2], &count) || count < 1 || (columns += count) > COLUMNS_MAX)
            status = source_fail(source, "Properties needs name:type:count for each");
        else
            print_names(names, piece.at[k], (long)count);
    }
    free(piece.at);
    return status;
}

static int extended_columns(struct source *source, char *properties, const struct bed *bed) {
    char *names = NULL;
    size_t size;
    FILE *file = open_memstream(&names, &size);
    if (!file) return message_memory();
    int status = read_properties(source, properties, file);
    if (fclose(file) != 0 && !status) status = message_memory();
    if (!status) status = source_columns(source, names, bed);
    free(names);
    return status;
}

static int read_xyz(struct source *source, struct bed *bed) {
    static const char lammps[] = "Atoms. Timestep: ";
    bool more;
    int64_t atoms;
    char word[32], properties[4000];
    int status;
    while ((status = lines_next(&source->lines, &more)) == STATUS_OK && lines_blank(&source->lines)) continue;
    if (!status) status = source_count(source, source_word(source, word, sizeof word), &atoms);
    if (!status) status = lines_next(&source->lines, &more);
    if (status) return status;
    const char *comment = source->lines.text;
    if (lines_begin(&source->lines, lammps)) (void)number_read_whole(comment + strlen(lammps), &bed->timestep);
    if (find_value(comment, "Properties", properties, sizeof properties)) {
        status = read_lattice(source, comment, bed);
        if (!status) status = extended_columns(source, properties, bed);
        return status ? status : source_rows(source, atoms, 0, bed);
    }
    if (!source->options.no_radius)
        return source_fail(source, "an XYZ file without Properties=... has no radii; --radius gives them");
    status = source_columns(source, "type x y z", bed);
    return status ? status : source_rows(source, atoms, ANY, bed);
}

const struct format format_xyz = {is_xyz, skip_xyz, read_xyz};
