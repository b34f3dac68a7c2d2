/* read_columns.c - rows of named columns become spheres; shared by all readers of text. SPDX-License-Identifier: MIT */
#include "read/read_columns.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "bed/units.h"
#include "cli/memory.h"
#include "cli/message.h"
#include "cli/spelling.h"
#include "text/read_number.h"
#include "text/text.h"
#include "text/unit.h"

typedef int compare_names(const char *, const char *);

/* Two columns of one name. */
struct twin {
    size_t first, second;
    const char *name;
};

const struct column_name *read_options_name(const struct read_options *options, const char *known, bool any_case) {
    for (size_t k = 0; k < options->names; ++k)
        if ((any_case ? strcasecmp : strcmp)(options->name[k].known, known) == 0) return &options->name[k];
    return NULL;
}

const char *read_options_none(const struct read_options *options) {
    return options->rules > 0 ? "--only and --skip leave no spheres of the file" : "there are no spheres in the file";
}

/* Finds a column by name. If there are several, it is the first one, and columns_add checks that all are equal.
 * *column: names->n if there is none. */
static int find(struct columns *columns, size_t *column, const struct fields *names, const char *wanted,
                compare_names *compare) {
    *column = names->n;
    for (size_t k = 0; k < names->n; ++k) {
        if (compare(names->at[k], wanted) != 0) continue;
        if (*column == names->n) {
            *column = k;
            continue;
        }
        bool good = true;
        columns->twin = memory_resized(columns->twin, (columns->twins + 1) * sizeof *columns->twin, &good);
        if (!good) return message_memory();
        columns->twin[columns->twins++] = (struct twin){*column, k, wanted};
    }
    return STATUS_OK;
}

/* Finds a column by the first of several names that the header has. The names end with NULL. Columns of options->name
 * go before all others, names in the same case before names in another case. *which: index of the name. *column:
 * names->n if there is none. */
static int find_any(struct columns *columns, size_t *column, int *which, const struct fields *names,
                    const struct read_options *options, const char *const wanted[]) {
    compare_names *const compare[] = {strcmp, strcasecmp};
    for (*which = 0; wanted[*which]; ++*which) {
        const struct column_name *name = read_options_name(options, wanted[*which], true);
        if (!name) continue;
        *column = columns->named[name - options->name];
        return STATUS_OK;
    }
    for (int k = 0; k < 2; ++k)
        for (*which = 0; wanted[*which]; ++*which) {
            const int status = find(columns, column, names, wanted[*which], compare[k]);
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

/* Finds a column by a name that may have its unit behind it. says: the name says the unit of a column whose header has
 * none. */
static int find_with_unit(struct columns *columns, const struct lines *lines, const struct fields *names,
                          const char *wanted, bool says, size_t *column) {
    const int status = find(columns, column, names, wanted, strcmp);
    const char *unit;
    size_t bare, length;
    if (status || *column < names->n) return status;
    const bool has = unit_behind(wanted, &bare, &unit, &length) && length > 0 && length < UNIT_LENGTH;
    for (size_t c = 0; has && c < names->n && *column == names->n; ++c) {
        if (strlen(names->at[c]) != bare || memcmp(names->at[c], wanted, bare) != 0) continue;
        if (says && !*columns->unit[c]) memcpy(columns->unit[c], unit, length);
        if (strlen(columns->unit[c]) == length && memcmp(columns->unit[c], unit, length) == 0) *column = c;
    }
    return *column == names->n ? column_missing(lines, names, wanted) : STATUS_OK;
}

static int find_radius(struct columns *columns, const struct lines *lines, const struct fields *names,
                       const struct read_options *options) {
    static const char *const radius[] = {"r", "radius", "diameter", "d", NULL};
    int which;
    if (options->no_radius) return STATUS_OK;
    const int status = find_any(columns, &columns->radius, &which, names, options, radius);
    if (!status && columns->radius == names->n)
        return column_missing(lines, names, "r, radius, d or diameter; --radius or --columns r=NAME gives radii");
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
    free(columns->factor);
    free(columns->named);
    free(columns->ruled);
    free(columns->twin);
    free(columns->unit);
    columns_free_kept(columns);
}

/* Begins to look for columns: none has been found. */
static int columns_begin(struct columns *columns, const struct fields *names, char *const *units,
                         const struct read_options *options) {
    columns->width = names->n;
    columns->twins = 0;
    bool good = true;
    columns->extra = memory_resized(columns->extra, (options->extras + 1) * sizeof *columns->extra, &good);
    columns->factor = memory_resized(columns->factor, (options->extras + 1) * sizeof *columns->factor, &good);
    columns->named = memory_resized(columns->named, (options->names + 1) * sizeof *columns->named, &good);
    columns->ruled = memory_resized(columns->ruled, (options->rules + 1) * sizeof *columns->ruled, &good);
    columns->unit = memory_resized(columns->unit, (names->n + 1) * sizeof *columns->unit, &good);
    if (!good) return message_memory();
    memset(columns->unit, 0, names->n * sizeof *columns->unit);
    for (size_t c = 0; units && c < names->n; ++c) snprintf(columns->unit[c], UNIT_LENGTH, "%s", units[c]);
    return STATUS_OK;
}

/* Finds the columns that the user has named: those of options->name, the further columns, and those of the rules. */
static int find_given(struct columns *columns, const struct lines *lines, const struct fields *names,
                      const struct read_options *options) {
    int status = STATUS_OK;
    for (size_t k = 0; k < options->names && !status; ++k)
        status = find_with_unit(columns, lines, names, options->name[k].name, true, &columns->named[k]);
    for (size_t k = 0; k < options->extras + options->rules && !status; ++k) {
        const bool extra = k < options->extras;
        const char *wanted = extra ? options->extra[k] : options->rule[k - options->extras].column;
        size_t *column = extra ? &columns->extra[k] : &columns->ruled[k - options->extras];
        const struct column_name *name = read_options_name(options, wanted, false);
        if (name)
            *column = columns->named[name - options->name];
        else
            status = find_with_unit(columns, lines, names, wanted, false, column);
    }
    return status;
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

/* Finds the unit of lengths, which must be the same in all columns of lengths and in the file. */
static int find_unit(const struct columns *columns, const struct lines *lines, const struct fields *names,
                     const struct read_options *options, struct bed *bed) {
    const char *unit = columns->unit[columns->coordinate[0]];
    const size_t lengths[] = {columns->coordinate[1], columns->coordinate[2],
                              options->no_radius ? columns->coordinate[0] : columns->radius};
    double metres, of_file;
    for (int k = 0; k < 3; ++k)
        if (strcmp(columns->unit[lengths[k]], unit) != 0)
            return message_at(STATUS_INPUT, lines->name, lines->number,
                              "lengths of more than one unit: %.40s in [%.10s], %.40s in [%.10s]",
                              names->at[columns->coordinate[0]], unit, names->at[lengths[k]],
                              columns->unit[lengths[k]]);
    if (bed->units[0] && *unit && unit_of_length(unit, &metres) && unit_of_length(bed->units, &of_file) &&
        metres != of_file)
        return message_at(STATUS_INPUT, lines->name, lines->number,
                          "--columns says that lengths are in [%.10s], but the units of the file are %.20s", unit,
                          bed->units);
    if (*unit && !bed->units[0]) snprintf(bed->units, sizeof bed->units, "%s", unit);
    return STATUS_OK;
}

int columns_factor(const struct lines *lines, const struct read_options *options, size_t k, const char *unit,
                   const char *lengths, double *factor) {
    const char *expected = options->unit ? options->unit[k] : NULL;
    if (expected && strcmp(expected, UNIT_OF_LENGTH) == 0) expected = *lengths ? lengths : NULL;
    *factor = 1;
    if (options->any_unit || unit_none(unit) || (expected && strcmp(unit, expected) == 0)) return STATUS_OK;
    if (expected && unit_factor(unit, expected, factor)) return STATUS_OK;
    const bool temperature = expected && (unit_is(expected, "K") || unit_is(expected, "C"));
    return message_at(STATUS_INPUT, lines->name, lines->number,
                      "the column %.40s is in [%.20s], but is taken as [%.20s]%s", options->extra[k], unit,
                      expected ? expected : "-", temperature ? "; see --temperature-unit" : "");
}

static int find_factors(struct columns *columns, const struct lines *lines, const struct read_options *options) {
    int status = STATUS_OK;
    for (size_t k = 0; k < options->extras && !status; ++k)
        status = columns_factor(lines, options, k, columns->unit[columns->extra[k]],
                                columns->unit[columns->coordinate[0]], &columns->factor[k]);
    return status;
}

int columns_find(struct columns *columns, const struct lines *lines, const struct fields *names, char *const *units,
                 const struct read_options *options, struct bed *bed) {
    static const char *const id[] = {"id", NULL};
    int which, status = columns_begin(columns, names, units, options);
    if (!status) status = find_given(columns, lines, names, options);
    for (int axis = 0; axis < 3 && !status; ++axis) {
        size_t *column = &columns->coordinate[axis];
        status = find_any(columns, column, &which, names, options, coordinate[axis]);
        if (status) return status;
        if (*column == names->n) return column_missing(lines, names, coordinate[axis][0]);
        columns->scaled[axis] = which == 2 || which == 3;
        if (columns->scaled[axis] && bed->low[axis] == bed->high[axis])
            return message_at(STATUS_INPUT, lines->name, lines->number,
                              "the scaled coordinate %s needs a box, and no box is given before", names->at[*column]);
    }
    if (!status) status = find_radius(columns, lines, names, options);
    if (!status) status = find_any(columns, &columns->id, &which, names, options, id);
    if (!status) status = find_kept(columns, names, options);
    if (!status) status = find_factors(columns, lines, options);
    return status ? status : find_unit(columns, lines, names, options, bed);
}

/* Reads a number of a row. */
static int columns_number(struct columns *columns, const struct lines *lines, const char *what, char *text,
                          double *value) {
    return lines_decimal(lines, what, text, columns->commas ? &columns->mark : NULL, value);
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

/* Whether two texts are equal, or are the same number. */
static bool same_value(const char *one, const char *other) {
    double first, second;
    return strcmp(one, other) == 0 || (number_read(one, &first) && number_read(other, &second) && first == second);
}

/* Whether the rules allow a row. */
static bool allowed(const struct columns *columns, const struct fields *row, const struct read_options *options) {
    for (size_t k = 0; k < options->rules; ++k)
        if (same_value(row->at[columns->ruled[k]], options->rule[k].value) == options->rule[k].skip) return false;
    return true;
}

/* Refuses a row in which columns of one name differ. */
static int check_twins(const struct columns *columns, const struct lines *lines, const struct fields *row) {
    for (size_t k = 0; k < columns->twins; ++k) {
        const struct twin *t = &columns->twin[k];
        if (same_value(row->at[t->first], row->at[t->second])) continue;
        return message_at(STATUS_INPUT, lines->name, lines->number,
                          "columns %zu and %zu are both named %.40s, and differ: '%.40s' and '%.40s'", t->first + 1,
                          t->second + 1, t->name, row->at[t->first], row->at[t->second]);
    }
    return STATUS_OK;
}

/* Reads the further columns of the last sphere. */
static int add_extras(struct columns *columns, const struct lines *lines, const struct fields *row,
                      const struct read_options *options, struct bed *bed) {
    for (size_t k = 0; k < options->extras; ++k) {
        char *text = row->at[columns->extra[k]];
        double *value = &bed->extra[(bed->n - 1) * options->extras + k];
        *value = NAN;
        if (is_missing(options, k, text)) continue;
        const int status = columns_number(columns, lines, options->extra[k], text, value);
        if (status) return status;
        *value *= columns->factor[k];
        if (isfinite(*value)) continue;
        return message_at(STATUS_INPUT, lines->name, lines->number, "%s is not finite in the expected unit",
                          options->extra[k]);
    }
    return STATUS_OK;
}

int columns_add(struct columns *columns, const struct lines *lines, const struct fields *row,
                const struct read_options *options, struct bed *bed) {
    static const char *const axes[] = {"x", "y", "z"};
    if (row->n != columns->width)
        return message_at(STATUS_INPUT, lines->name, lines->number, "%zu fields where the header names %zu columns",
                          row->n, columns->width);
    if (!allowed(columns, row, options)) return STATUS_OK;
    int status = check_twins(columns, lines, row);
    double centre[3] = {0};
    for (int axis = 0; axis < 3 && !status; ++axis) {
        status = columns_number(columns, lines, axes[axis], row->at[columns->coordinate[axis]], &centre[axis]);
        if (columns->scaled[axis]) centre[axis] = bed->low[axis] + centre[axis] * (bed->high[axis] - bed->low[axis]);
    }
    struct bed_sphere sphere = {.x = centre[0], .y = centre[1], .z = centre[2], .line = lines->number};
    bed->ids = columns->id < columns->width && !options->positions;
    if (!status && !options->no_radius)
        status = columns_number(columns, lines, "the radius", row->at[columns->radius], &sphere.r);
    sphere.r *= columns->radius_unit;
    if (!status && bed->ids) status = lines_whole(lines, "the id", row->at[columns->id], &sphere.id);
    if (columns->keeps > 0) bed->kept_names = columns->kept_names;
    if (!status) status = columns_add_sphere(lines, options, &sphere, bed);
    if (!status) status = add_extras(columns, lines, row, options, bed);
    for (size_t k = 0; k < columns->keeps; ++k) columns->text[k] = row->at[columns->kept[k]];
    return !status && columns->keeps > 0 ? bed_keep(bed, columns->text, columns->keeps) : status;
}
