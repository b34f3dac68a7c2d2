/* read_xyz.c - beds from XYZ and extended XYZ files. SPDX-License-Identifier: MIT
 *
 * A frame is a line with the number of atoms, a comment, and a line for each atom. In extended XYZ the comment has
 * `Properties=species:S:1:pos:R:3:radius:R:1`, which names the columns. The comment may have `Lattice="..."`, the edges
 * of the box, `Origin="x y z"`, and `pbc="T T F"`, the periodic axes. Without pbc all axes are periodic. */
#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

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

/* Reads the number of atoms of the next frame. */
static int xyz_count(struct source *source, int64_t *atoms, bool *more) {
    const int status = lines_next_text(&source->lines, more);
    return status || !*more ? status : source_count_line(source, atoms);
}

static int skip_xyz(struct source *source) {
    bool more;
    int64_t atoms;
    source->found = FOUND_END;
    int status = xyz_count(source, &atoms, &more);
    if (status || !more) return status;
    status = source_skip(source, 1, "spheres", NULL);
    return status || source->found == FOUND_PART ? status : source_skip(source, atoms, "spheres", NULL);
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

/* Reads the n numbers of a key's value. *there: the comment has the key. Refuses another number of them. */
static int take_numbers(const struct source *source, const char *comment, const char *key, int n, const char *like,
                        double *value, bool *there) {
    char text[1000], *word, *rest = text;
    int count = 0;
    *there = find_value(comment, key, text, sizeof text);
    if (!*there) return STATUS_OK;
    for (; (word = strtok_r(rest, " \t", &rest)); ++count) {
        double number;
        if (!number_read(word, &number) || !isfinite(number))
            return source_fail(source, "%s: '%.40s' is not a number", key, word);
        if (count < n) value[count] = number;
    }
    if (count == n) return STATUS_OK;
    return source_fail(source, "%s has %d number%s; it needs %d in quotes: %s=\"%s\"", key, count,
                       count == 1 ? "" : "s", n, key, like);
}

/* Reads pbc: three of T and F. Without pbc all axes are periodic. */
static int take_periodic(const struct source *source, const char *comment, bool periodic[3]) {
    char text[100], *word, *rest = text;
    int count = 0;
    if (!find_value(comment, "pbc", text, sizeof text)) return STATUS_OK;
    for (; (word = strtok_r(rest, " \t", &rest)); ++count) {
        if (count == 3 || !strchr("TtFf01", *word)) return source_fail(source, "pbc needs three of T and F");
        periodic[count] = strchr("Tt1", *word) != NULL;
    }
    return count == 3 ? STATUS_OK : source_fail(source, "pbc needs three of T and F");
}

static int read_lattice(const struct source *source, const char *comment, struct bed *bed) {
    double edge[9], origin[3] = {0, 0, 0};
    bool periodic[3] = {true, true, true}, there, moved;
    int status = take_numbers(source, comment, "Lattice", 9, "LX 0 0 0 LY 0 0 0 LZ", edge, &there);
    if (status || !there) return status;
    status = take_numbers(source, comment, "Origin", 3, "X Y Z", origin, &moved);
    if (!status) status = take_periodic(source, comment, periodic);
    return status ? status : source_edges(source, "the lattice is tilted", edge, origin, periodic, bed);
}

/* Prints the names of the columns of all properties: species:S:1:pos:R:3 becomes `species x y z`. */
static int print_names(const struct source *source, char *properties, FILE *names) {
    struct fields piece = {0};
    int64_t count, columns = 0;
    int status = fields_split(&piece, properties, ":");
    bool good = piece.n % 3 == 0;
    for (size_t k = 0; k + 2 < piece.n && !status && good; k += 3) {
        good = number_read_whole(piece.at[k + 2], &count) && count >= 1 && (columns += count) <= COLUMNS_MAX;
        const bool position = strcasecmp(piece.at[k], "pos") == 0 && count == 3;
        for (int64_t c = 0; c < count && good; ++c)
            if (position)
                fprintf(names, "%c ", "xyz"[c]);
            else if (count == 1)
                fprintf(names, "%s ", piece.at[k]);
            else
                fprintf(names, "%s:%" PRId64 " ", piece.at[k], c);
    }
    free(piece.at);
    if (status || good) return status;
    return source_fail(source, "Properties needs name:type:count for each, such as pos:R:3:radius:R:1");
}

static int extended_columns(struct source *source, char *properties, struct bed *bed) {
    char *names = NULL;
    size_t size;
    FILE *file = open_memstream(&names, &size);
    if (!file) return message_memory();
    int status = print_names(source, properties, file);
    if (fclose(file) != 0 && !status) status = message_memory();
    if (!status) status = source_columns(source, names, bed);
    free(names);
    return status;
}

static int read_xyz(struct source *source, struct bed *bed) {
    static const char lammps[] = "Atoms. Timestep: ";
    bool more;
    int64_t atoms = 0;
    char properties[4000];
    int status = xyz_count(source, &atoms, &more);
    if (!status) status = lines_next(&source->lines, &more);
    if (status || atoms == 0) return status;
    const char *comment = source->lines.text;
    if (lines_begin(&source->lines, lammps)) (void)number_read_whole(comment + strlen(lammps), &bed->timestep);
    if (find_value(comment, "Properties", properties, sizeof properties)) {
        status = read_lattice(source, comment, bed);
        if (!status) status = extended_columns(source, properties, bed);
        return status ? status : source_rows(source, atoms, 0, bed);
    }
    if (!source->options.no_radius)
        return source_fail(
            source, "an XYZ file without Properties=species:S:1:pos:R:3:radius:R:1 has no radii; --radius gives them");
    status = source_columns(source, "type x y z", bed);
    return status ? status : source_rows(source, atoms, ANY, bed);
}

const struct format format_xyz = {is_xyz, skip_xyz, read_xyz};
