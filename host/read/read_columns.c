/* read_columns.c - rows of named columns become spheres; shared by all readers of text. SPDX-License-Identifier: MIT */
#include "read/read_columns.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "cli/message.h"
#include "cli/spelling.h"
#include "text/text.h"

typedef int compare_names(const char *, const char *);

/* Finds a column by name. *column: names->n if there is none. */
static int find(size_t *column, const struct lines *lines, const struct fields *names, const char *wanted,
                compare_names *compare) {
    *column = names->n;
    for (size_t k = 0; k < names->n; ++k) {
        if (compare(names->at[k], wanted) != 0) continue;
        if (*column != names->n)
            return message_at(STATUS_INPUT, lines->name, lines->number, "two columns are named %.40s", wanted);
        *column = k;
    }
    return STATUS_OK;
}

/* Finds a column by the first of several names that the header has. The names end with NULL. Names in the same case go
 * before names in another case. *which: index of the name. *column: names->n if there is none. */
static int find_any(size_t *column, int *which, const struct lines *lines, const struct fields *names,
                    const char *const wanted[]) {
    compare_names *const compare[] = {strcmp, strcasecmp};
    for (int k = 0; k < 2; ++k)
        for (*which = 0; wanted[*which]; ++*which) {
            const int status = find(column, lines, names, wanted[*which], compare[k]);
            if (status || *column != names->n) return status;
        }
    return STATUS_OK;
}

static int column_missing(const struct lines *lines, const struct fields *names, const char *wanted) {
    char list[NAMES_LISTED], hint[HINT_ROOM], table[HINT_ROOM];
    const char *const *known = (const char *const *)names->at;
    return message_at(STATUS_INPUT, lines->name, lines->number, "the header names no column %.60s%s there are %s%s",
                      wanted, name_hint(hint, "", wanted, strlen(wanted), known, names->n),
                      names_list(list, known, names->n), table_hint(table, "", wanted));
}

/* Whether a wanted name is a name of the header with its unit: `T [C]`, `T (C)` or `T_[C]`. */
static bool names_with_unit(const char *wanted, const char *name, const char *unit) {
    const size_t length = strlen(name), size = strlen(unit);
    if (!*unit || strncmp(wanted, name, length) != 0) return false;
    wanted += length + strspn(wanted + length, " \t_");
    return (*wanted == '[' || *wanted == '(') && strncmp(wanted + 1, unit, size) == 0 &&
           (wanted[size + 1] == ']' || wanted[size + 1] == ')') && !wanted[size + 2];
}

static int find_radius(struct columns *columns, const struct lines *lines, const struct fields *names,
                       const struct read_options *options) {
    static const char *const radius[] = {"r", "radius", "diameter", "d", NULL};
    int which;
    if (options->no_radius) return STATUS_OK;
    const int status = find_any(&columns->radius, &which, lines, names, radius);
    if (!status && columns->radius == names->n)
        return column_missing(lines, names, "r, radius, d or diameter; --radius gives radii");
    columns->radius_unit = which >= 2 ? 0.5 : 1;
    return status;
}

static void columns_free_kept(struct columns *columns) {
    free(columns->kept);
    free(columns->text);
    free(columns->kept_names);
    columns->kept = NULL, columns->text = NULL, columns->kept_names = NULL;
}

void columns_free(struct columns *columns) {
    free(columns->extra);
    columns_free_kept(columns);
}

static int find_extras(struct columns *columns, const struct lines *lines, const struct fields *names,
                       const struct read_options *options) {
    if (options->extras == 0) return STATUS_OK;
    size_t *extra = realloc(columns->extra, options->extras * sizeof *extra);
    if (!extra) return message_memory();
    columns->extra = extra;
    for (size_t k = 0; k < options->extras; ++k) {
        const int status = find(&extra[k], lines, names, options->extra[k], strcmp);
        if (status) return status;
        for (size_t c = 0; columns->units && c < names->n && extra[k] == names->n; ++c)
            if (names_with_unit(options->extra[k], names->at[c], columns->units[c])) extra[k] = c;
        if (extra[k] == names->n) return column_missing(lines, names, options->extra[k]);
    }
    return STATUS_OK;
}

/* Whether write_dump writes a column of this name of its own. */
static bool is_own(const char *name) {
    static const char *const own[] = {"id", "x", "y", "z", "radius", "T_K", "q_W"};
    for (size_t k = 0; k < sizeof own / sizeof *own; ++k)
        if (strcmp(name, own[k]) == 0) return true;
    return false;
}

/* Finds the columns that are kept as text: all but coordinates, radii, ids and those that write_dump writes. */
static int find_kept(struct columns *columns, const struct fields *names, const struct read_options *options) {
    size_t room = 1;
    columns->keeps = 0;
    if (!options->keep) return STATUS_OK;
    for (size_t k = 0; k < names->n; ++k) room += strlen(names->at[k]) + 1;
    columns_free_kept(columns);
    columns->kept = malloc((names->n + 1) * sizeof *columns->kept);
    columns->text = malloc((names->n + 1) * sizeof *columns->text);
    columns->kept_names = calloc(room, 1);
    if (!columns->kept || !columns->text || !columns->kept_names) return message_memory();
    for (size_t k = 0; k < names->n; ++k) {
        const bool used = k == columns->coordinate[0] || k == columns->coordinate[1] || k == columns->coordinate[2] ||
                          k == columns->id || (!options->no_radius && k == columns->radius);
        if (used || is_own(names->at[k]) || !*names->at[k]) continue;
        char *to = columns->kept_names + strlen(columns->kept_names);
        if (columns->keeps > 0) *to++ = ' ';
        for (const char *c = names->at[k]; *c; ++c) *to++ = (char)(*c == ' ' || *c == '\t' ? '_' : *c);
        columns->kept[columns->keeps++] = k;
    }
    return STATUS_OK;
}

static const char *const coordinate[3][7] = {{"x", "xu", "xs", "xsu", "Points:0", "Points_0", NULL},
                                             {"y", "yu", "ys", "ysu", "Points:1", "Points_1", NULL},
                                             {"z", "zu", "zs", "zsu", "Points:2", "Points_2", NULL}};

bool columns_named(const struct fields *names) {
    bool found[3] = {false, false, false};
    for (size_t k = 0; k < names->n; ++k)
        for (int axis = 0; axis < 3; ++axis)
            for (const char *const *name = coordinate[axis]; *name && !found[axis]; ++name)
                found[axis] = strcasecmp(names->at[k], *name) == 0;
    return found[0] && found[1] && found[2];
}

int columns_find(struct columns *columns, const struct lines *lines, const struct fields *names,
                 const struct read_options *options, const struct bed *bed) {
    static const char *const id[] = {"id", NULL};
    int which;
    columns->width = names->n;
    for (int axis = 0; axis < 3; ++axis) {
        const int status = find_any(&columns->coordinate[axis], &which, lines, names, coordinate[axis]);
        if (status) return status;
        if (columns->coordinate[axis] == names->n) return column_missing(lines, names, coordinate[axis][0]);
        columns->scaled[axis] = which == 2 || which == 3;
        if (columns->scaled[axis] && bed->low[axis] == bed->high[axis])
            return message_at(STATUS_INPUT, lines->name, lines->number,
                              "the scaled coordinate %s needs a box, and no box is given before",
                              names->at[columns->coordinate[axis]]);
    }
    int status = find_radius(columns, lines, names, options);
    if (!status) status = find_any(&columns->id, &which, lines, names, id);
    if (!status) status = find_kept(columns, names, options);
    return status ? status : find_extras(columns, lines, names, options);
}

/* Reads a number of a row. In files that may have decimal commas, points and commas must not mix. */
static int columns_number(struct columns *columns, const struct lines *lines, const char *what, char *text,
                          double *value) {
    char *mark = columns->commas ? strpbrk(text, ".,") : NULL;
    if (mark && columns->mark && *mark != columns->mark)
        return message_at(STATUS_INPUT, lines->name, lines->number,
                          "%s is '%.40s': decimal commas and decimal points in one file", what, text);
    if (mark) {
        columns->mark = *mark;
        *mark = '.';
    }
    return lines_number(lines, what, text, value);
}

/* Whether a value is missing in a column that allows this. */
static bool is_missing(const struct read_options *options, size_t k, const char *text) {
    return options->some && options->some[k] && (*text == 0 || strcasecmp(text, "nan") == 0);
}

int columns_add_sphere(const struct lines *lines, const struct read_options *options, struct bed_sphere *sphere,
                       struct bed *bed) {
    if (options->no_radius)
        sphere->r = NAN;
    else if (!(sphere->r > 0))
        return message_at(STATUS_INPUT, lines->name, sphere->line, "the radius is %g; it must be above 0", sphere->r);
    return bed_add(bed, sphere);
}

int columns_add(struct columns *columns, const struct lines *lines, const struct fields *row,
                const struct read_options *options, struct bed *bed) {
    static const char *const axes[] = {"x", "y", "z"};
    if (row->n != columns->width)
        return message_at(STATUS_INPUT, lines->name, lines->number, "%zu fields where the header names %zu columns",
                          row->n, columns->width);
    double centre[3];
    for (int axis = 0; axis < 3; ++axis) {
        const int status =
            columns_number(columns, lines, axes[axis], row->at[columns->coordinate[axis]], &centre[axis]);
        if (status) return status;
        if (columns->scaled[axis]) centre[axis] = bed->low[axis] + centre[axis] * (bed->high[axis] - bed->low[axis]);
    }
    struct bed_sphere sphere = {.x = centre[0], .y = centre[1], .z = centre[2], .line = lines->number};
    bed->ids = columns->id < columns->width && !options->positions;
    int status = STATUS_OK;
    if (!options->no_radius) status = columns_number(columns, lines, "the radius", row->at[columns->radius], &sphere.r);
    sphere.r *= columns->radius_unit;
    if (!status && bed->ids) status = lines_whole(lines, "the id", row->at[columns->id], &sphere.id);
    if (columns->keeps > 0) bed->kept_names = columns->kept_names;
    if (!status) status = columns_add_sphere(lines, options, &sphere, bed);
    for (size_t k = 0; k < options->extras && !status; ++k) {
        char *text = row->at[columns->extra[k]];
        double *value = &bed->extra[(bed->n - 1) * options->extras + k];
        if (is_missing(options, k, text))
            *value = NAN;
        else
            status = columns_number(columns, lines, options->extra[k], text, value);
    }
    for (size_t k = 0; k < columns->keeps; ++k) columns->text[k] = row->at[columns->kept[k]];
    return !status && columns->keeps > 0 ? bed_keep(bed, columns->text, columns->keeps) : status;
}
