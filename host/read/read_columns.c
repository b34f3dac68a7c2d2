/* read_columns.c - rows of named columns become spheres; shared by all readers of text. SPDX-License-Identifier: MIT */
#include "read/read_format.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "bed/units.h"
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

/* Finds a column by name. If there are several, it is the first one, and columns_add checks that all are equal.
 * *column: columns->width if there is none. */
static int find(struct columns *columns, size_t *column, const char *wanted, compare_names *compare) {
    *column = columns->width;
    for (size_t k = 0; k < columns->width; ++k) {
        if (compare(columns->header->at[k], wanted) != 0) continue;
        if (*column == columns->width) {
            *column = k;
            continue;
        }
        bool good = true;
        columns->twin = memory_grown(columns->twin, columns->twins, sizeof *columns->twin, &good);
        if (!good) return message_memory();
        columns->twin[columns->twins++] = (struct twin){*column, k, wanted};
    }
    return STATUS_OK;
}

/* Finds a column by the first of several names that the header has. The names end with NULL. Columns of options->name
 * go before all others, names in the same case before names in another case. *which: index of the name. *column:
 * columns->width if there is none. */
static int find_any(struct source *source, size_t *column, int *which, const char *const wanted[]) {
    compare_names *const compare[] = {strcmp, strcasecmp};
    struct columns *columns = &source->columns;
    for (*which = 0; wanted[*which]; ++*which) {
        const struct column_name *name = read_options_name(&source->options, wanted[*which], true);
        if (!name) continue;
        *column = columns->named[name - source->options.name];
        return STATUS_OK;
    }
    for (int k = 0; k < 2; ++k)
        for (*which = 0; wanted[*which]; ++*which) {
            const int status = find(columns, column, wanted[*which], compare[k]);
            if (status || *column != columns->width) return status;
        }
    return STATUS_OK;
}

static int column_missing(const struct source *source, const char *wanted) {
    char list[NAMES_LISTED], hint[HINT_ROOM], table[HINT_ROOM];
    const char *const *known = (const char *const *)source->columns.header->at;
    const size_t n = source->columns.width;
    return source_fail(source, "the header names no column %.60s%s there are %s%s", wanted,
                       name_hint(hint, "", wanted, strlen(wanted), known, n), names_list(list, known, n),
                       table_hint(table, "", wanted));
}

/* Finds a column by a name that may have its unit behind it. says: the name says the unit of a column whose header has
 * none. */
static int find_with_unit(struct source *source, const char *wanted, bool says, size_t *column) {
    struct columns *columns = &source->columns;
    const int status = find(columns, column, wanted, strcmp);
    const char *unit;
    size_t bare, length;
    if (status || *column < columns->width) return status;
    const bool has = unit_behind(wanted, &bare, &unit, &length) && length > 0 && length < UNIT_LENGTH;
    for (size_t c = 0; has && c < columns->width && *column == columns->width; ++c) {
        const char *name = columns->header->at[c];
        if (strlen(name) != bare || memcmp(name, wanted, bare) != 0) continue;
        if (says && !*columns->unit[c]) memcpy(columns->unit[c], unit, length);
        if (strlen(columns->unit[c]) == length && memcmp(columns->unit[c], unit, length) == 0) *column = c;
    }
    return *column == columns->width ? column_missing(source, wanted) : STATUS_OK;
}

static int find_radius(struct source *source) {
    static const char *const radius[] = {"r", "radius", "diameter", "d", NULL};
    int which;
    if (source->options.no_radius) return STATUS_OK;
    const int status = find_any(source, &source->columns.radius, &which, radius);
    if (!status && source->columns.radius == source->columns.width)
        return column_missing(source, "r, radius, d or diameter; --radius or --columns r=NAME gives radii");
    source->columns.radius_unit = which >= 2 ? 0.5 : 1;
    return status;
}

void columns_free(struct columns *columns) {
    free(columns->wanted);
    free(columns->factor);
    free(columns->named);
    free(columns->twin);
    free(columns->unit);
    free(columns->kept);
    free(columns->text);
    free(columns->kept_names);
}

/* Begins to look for columns: none has been found. */
static int columns_begin(struct source *source, const struct fields *names, char *const *units) {
    const struct read_options *options = &source->options;
    struct columns *c = &source->columns;
    size_t room = 1;
    bool good = true;
    for (size_t k = 0; k < names->n; ++k) room += strlen(names->at[k]) + 1;
    c->header = names;
    c->width = names->n;
    c->twins = c->keeps = 0;
    c->wanted = memory_resized(c->wanted, (options->extras + options->rules + 1) * sizeof *c->wanted, &good);
    c->factor = memory_resized(c->factor, (options->extras + 1) * sizeof *c->factor, &good);
    c->named = memory_resized(c->named, (options->names + 1) * sizeof *c->named, &good);
    c->unit = memory_resized(c->unit, (names->n + 1) * sizeof *c->unit, &good);
    c->kept = memory_resized(c->kept, (names->n + 1) * sizeof *c->kept, &good);
    c->text = memory_resized(c->text, (names->n + 1) * sizeof *c->text, &good);
    c->kept_names = memory_resized(c->kept_names, room, &good);
    if (!good) return message_memory();
    memset(c->unit, 0, names->n * sizeof *c->unit);
    for (size_t k = 0; units && k < names->n; ++k) snprintf(c->unit[k], UNIT_LENGTH, "%s", units[k]);
    return STATUS_OK;
}

const char *read_options_wanted(const struct read_options *options, size_t k) {
    return k < options->extras ? options->extra[k] : options->rule[k - options->extras].column;
}

/* Finds the columns that the user has named: those of options->name, the further columns, and those of the rules. */
static int find_given(struct source *source) {
    const struct read_options *options = &source->options;
    struct columns *columns = &source->columns;
    int status = STATUS_OK;
    for (size_t k = 0; k < options->names && !status; ++k)
        status = find_with_unit(source, options->name[k].name, true, &columns->named[k]);
    for (size_t k = 0; k < options->extras + options->rules && !status; ++k) {
        const char *wanted = read_options_wanted(options, k);
        const struct column_name *name = read_options_name(options, wanted, false);
        if (name)
            columns->wanted[k] = columns->named[name - options->name];
        else
            status = find_with_unit(source, wanted, false, &columns->wanted[k]);
    }
    return status;
}

/* Finds the columns that are kept as text: all but coordinates, radii, ids and those that write_dump writes. */
static void find_kept(struct columns *columns, bool no_radius) {
    static const char *const own[] = {"", "id", "x", "y", "z", "radius", "T_K", "q_W"};
    char *to = columns->kept_names;
    for (size_t k = 0; k < columns->width; ++k) {
        const char *name = columns->header->at[k];
        bool used = k == columns->coordinate[0] || k == columns->coordinate[1] || k == columns->coordinate[2] ||
                    k == columns->id || (!no_radius && k == columns->radius);
        for (size_t c = 0; c < sizeof own / sizeof *own; ++c) used = used || strcmp(name, own[c]) == 0;
        if (used) continue;
        if (columns->keeps > 0) *to++ = ' ';
        for (; *name; ++name) *to++ = (char)(*name == ' ' || *name == '\t' ? '_' : *name);
        columns->kept[columns->keeps++] = k;
    }
    *to = 0;
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
static int find_unit(const struct source *source, struct bed *bed) {
    const struct columns *columns = &source->columns;
    const size_t first = columns->coordinate[0], lengths[] = {columns->coordinate[1], columns->coordinate[2],
                                                              source->options.no_radius ? first : columns->radius};
    const char *unit = columns->unit[first];
    double metres, of_file;
    for (int k = 0; k < 3; ++k)
        if (strcmp(columns->unit[lengths[k]], unit) != 0)
            return source_fail(source, "lengths of more than one unit: %.40s in [%.10s], %.40s in [%.10s]",
                               columns->header->at[first], unit, columns->header->at[lengths[k]],
                               columns->unit[lengths[k]]);
    if (bed->units[0] && *unit && unit_of_length(unit, &metres) && unit_of_length(bed->units, &of_file) &&
        metres != of_file)
        return source_fail(source, "--columns says that lengths are in [%.10s], but the units of the file are %.20s",
                           unit, bed->units);
    if (*unit && !bed->units[0]) snprintf(bed->units, sizeof bed->units, "%s", unit);
    return STATUS_OK;
}

int columns_factor(const struct source *source, size_t k, const char *unit, const char *lengths, double *factor) {
    const struct read_options *options = &source->options;
    const char *expected = options->unit ? options->unit[k] : NULL;
    if (expected && strcmp(expected, UNIT_OF_LENGTH) == 0) expected = *lengths ? lengths : NULL;
    *factor = 1;
    if (options->any_unit || unit_none(unit) || (expected && strcmp(unit, expected) == 0)) return STATUS_OK;
    if (expected && unit_factor(unit, expected, factor)) return STATUS_OK;
    return source_fail(source, "the column %.40s is in [%.20s], but is taken as [%.20s]%s", options->extra[k], unit,
                       expected ? expected : "-",
                       expected && unit_temperature(expected) ? "; see --temperature-unit" : "");
}

int columns_find(struct source *source, const struct fields *names, char *const *units, struct bed *bed) {
    static const char *const id[] = {"id", NULL};
    struct columns *columns = &source->columns;
    int which, status = columns_begin(source, names, units);
    if (!status) status = find_given(source);
    for (int axis = 0; axis < 3 && !status; ++axis) {
        size_t *column = &columns->coordinate[axis];
        status = find_any(source, column, &which, coordinate[axis]);
        if (status) return status;
        if (*column == names->n) return column_missing(source, coordinate[axis][0]);
        columns->scaled[axis] = which == 2 || which == 3;
        if (columns->scaled[axis] && bed->low[axis] == bed->high[axis])
            return source_fail(source, "the scaled coordinate %s needs a box, and no box is given before",
                               names->at[*column]);
    }
    if (!status) status = find_radius(source);
    if (!status) status = find_any(source, &columns->id, &which, id);
    if (!status && source->options.keep) find_kept(columns, source->options.no_radius);
    for (size_t k = 0; k < source->options.extras && !status; ++k)
        status = columns_factor(source, k, columns->unit[columns->wanted[k]], columns->unit[columns->coordinate[0]],
                                &columns->factor[k]);
    return status ? status : find_unit(source, bed);
}

/* Reads a number of a row. */
static int columns_number(struct source *source, const char *what, size_t column, double *value) {
    struct columns *columns = &source->columns;
    return lines_decimal(&source->lines, what, source->fields.at[column], columns->commas ? &columns->mark : NULL,
                         value);
}

int columns_add_sphere(const struct source *source, struct bed_sphere *sphere, struct bed *bed) {
    if (source->options.no_radius)
        sphere->r = NAN;
    else if (!(sphere->r > 0))
        return message_at(STATUS_INPUT, source->lines.name, sphere->line, "the radius is %g; it must be above 0",
                          sphere->r);
    return bed_add(bed, sphere);
}

/* Whether two texts are equal, or are the same number. */
static bool same_value(const char *one, const char *other) {
    double first, second;
    return strcmp(one, other) == 0 || (number_read(one, &first) && number_read(other, &second) && first == second);
}

/* Whether the rules allow a row. */
static bool allowed(const struct source *source) {
    const struct read_options *options = &source->options;
    const size_t *ruled = source->columns.wanted + options->extras;
    for (size_t k = 0; k < options->rules; ++k)
        if (same_value(source->fields.at[ruled[k]], options->rule[k].value) == options->rule[k].skip) return false;
    return true;
}

/* Refuses a row in which columns of one name differ. */
static int check_twins(const struct source *source) {
    for (size_t k = 0; k < source->columns.twins; ++k) {
        const struct twin *t = &source->columns.twin[k];
        const char *first = source->fields.at[t->first], *second = source->fields.at[t->second];
        if (!same_value(first, second))
            return source_fail(source, "columns %zu and %zu are both named %.40s, and differ: '%.40s' and '%.40s'",
                               t->first + 1, t->second + 1, t->name, first, second);
    }
    return STATUS_OK;
}

/* Whether a text stands for a missing value, which is NaN, or for infinity. */
static bool is_no_number(const char *text, double *value) {
    const bool infinite = strcasecmp(text, "inf") == 0 || strcasecmp(text, "infinity") == 0;
    *value = infinite ? INFINITY : NAN;
    return infinite || *text == 0 || strcasecmp(text, "nan") == 0;
}

/* Reads the further columns of the last sphere. */
static int add_extras(struct source *source, struct bed *bed) {
    const struct read_options *options = &source->options;
    for (size_t k = 0; k < options->extras; ++k) {
        const char *text = source->fields.at[source->columns.wanted[k]];
        double *value = &bed->extra[(bed->n - 1) * options->extras + k];
        if (options->some && options->some[k] && is_no_number(text, value)) continue;
        const int status = columns_number(source, options->extra[k], source->columns.wanted[k], value);
        if (status) return status;
        *value *= source->columns.factor[k];
        if (!isfinite(*value)) return source_fail(source, "%s is not finite in the expected unit", options->extra[k]);
    }
    return STATUS_OK;
}

int columns_add(struct source *source, struct bed *bed) {
    static const char *const axes[] = {"x", "y", "z"};
    const struct fields *row = &source->fields;
    struct columns *columns = &source->columns;
    if (row->n != columns->width)
        return source_fail(source, "%zu fields where the header names %zu columns", row->n, columns->width);
    if (!allowed(source)) return STATUS_OK;
    int status = check_twins(source);
    double centre[3] = {0};
    for (int axis = 0; axis < 3 && !status; ++axis) {
        status = columns_number(source, axes[axis], columns->coordinate[axis], &centre[axis]);
        if (columns->scaled[axis]) centre[axis] = bed->low[axis] + centre[axis] * (bed->high[axis] - bed->low[axis]);
    }
    struct bed_sphere sphere = {.x = centre[0], .y = centre[1], .z = centre[2], .line = source->lines.number};
    bed->ids = columns->id < columns->width && !source->options.positions;
    if (!status && !source->options.no_radius)
        status = columns_number(source, "the radius", columns->radius, &sphere.r);
    sphere.r *= columns->radius_unit;
    if (!status && bed->ids) status = lines_whole(&source->lines, "the id", row->at[columns->id], &sphere.id);
    if (columns->keeps > 0) bed->kept_names = columns->kept_names;
    if (!status) status = columns_add_sphere(source, &sphere, bed);
    if (!status) status = add_extras(source, bed);
    for (size_t k = 0; k < columns->keeps; ++k) columns->text[k] = row->at[columns->kept[k]];
    return !status && columns->keeps > 0 ? bed_keep(bed, columns->text, columns->keeps) : status;
}
