/* read_columns.c - rows of named columns become spheres; shared by all readers of text. SPDX-License-Identifier: MIT */
#include "read/read_columns.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "cli/message.h"

typedef int compare_names(const char *, const char *);

/* Finds a column; it is `width` if there is none. */
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

/* Finds the first column that is there of several names, ended by NULL, as they are written before any case; `which`
 * says the one; *column is `width` if there is none. */
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

static int column_missing(const struct lines *lines, const char *wanted) {
    return message_at(STATUS_INPUT, lines->name, lines->number, "the header names no column %s", wanted);
}

static int find_radius(struct columns *columns, const struct lines *lines, const struct fields *names,
                       const struct read_options *options) {
    static const char *const radius[] = {"r", "radius", "diameter", "d", NULL};
    int which;
    if (options->no_radius) return STATUS_OK;
    const int status = find_any(&columns->radius, &which, lines, names, radius);
    if (!status && columns->radius == names->n)
        return column_missing(lines, "r, radius, d or diameter; --radius gives radii");
    columns->radius_unit = which >= 2 ? 0.5 : 1;
    return status;
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
        if (extra[k] == names->n) return column_missing(lines, options->extra[k]);
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
        const int status = find_any(&columns->place[axis], &which, lines, names, coordinate[axis]);
        if (status) return status;
        if (columns->place[axis] == names->n) return column_missing(lines, coordinate[axis][0]);
        columns->scaled[axis] = which == 2 || which == 3;
        if (columns->scaled[axis] && bed->low[axis] == bed->high[axis])
            return message_at(STATUS_INPUT, lines->name, lines->number,
                              "the scaled coordinate %s needs a box, of which nothing is said before",
                              names->at[columns->place[axis]]);
    }
    int status = find_radius(columns, lines, names, options);
    if (!status) status = find_any(&columns->id, &which, lines, names, id);
    return status ? status : find_extras(columns, lines, names, options);
}

/* A number of a row. In files where commas may be decimal, points and commas do not mix. */
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
        const int status = columns_number(columns, lines, axes[axis], row->at[columns->place[axis]], &centre[axis]);
        if (status) return status;
        if (columns->scaled[axis]) centre[axis] = bed->low[axis] + centre[axis] * (bed->high[axis] - bed->low[axis]);
    }
    struct bed_sphere sphere = {.x = centre[0], .y = centre[1], .z = centre[2], .line = lines->number};
    bed->ids = columns->id < columns->width && !options->positions;
    int status = STATUS_OK;
    if (!options->no_radius) status = columns_number(columns, lines, "the radius", row->at[columns->radius], &sphere.r);
    sphere.r *= columns->radius_unit;
    if (!status && bed->ids) status = lines_whole(lines, "the id", row->at[columns->id], &sphere.id);
    if (!status) status = columns_add_sphere(lines, options, &sphere, bed);
    for (size_t k = 0; k < options->extras && !status; ++k)
        status = columns_number(columns, lines, options->extra[k], row->at[columns->extra[k]],
                                &bed->extra[(bed->n - 1) * options->extras + k]);
    return status;
}
