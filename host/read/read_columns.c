/* read_columns.c - rows of named columns become spheres; shared by all readers. SPDX-License-Identifier: MIT */
#include "read/read_columns.h"

#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

/* Finds a column; it is `width` if there is none. */
static int find(size_t *column, const struct lines *lines, const struct fields *names, const char *wanted) {
    *column = names->n;
    for (size_t k = 0; k < names->n; ++k) {
        if (strcmp(names->at[k], wanted) != 0) continue;
        if (*column != names->n)
            return message_at(STATUS_INPUT, lines->name, lines->number, "two columns are named %.40s", wanted);
        *column = k;
    }
    return STATUS_OK;
}

/* Finds the first column that is there of several names, ended by NULL; `which` tells the one. */
static int find_any(size_t *column, int *which, const struct lines *lines, const struct fields *names,
                    const char *const wanted[]) {
    for (*which = 0; wanted[*which]; ++*which) {
        const int status = find(column, lines, names, wanted[*which]);
        if (status || *column != names->n) return status;
    }
    return message_at(STATUS_INPUT, lines->name, lines->number, "the header names no column %s", wanted[0]);
}

int columns_find(struct columns *columns, const struct lines *lines, const struct fields *names,
                 const struct read_options *options) {
    static const char *const coordinate[3][5] = {
        {"x", "xu", "xs", "xsu", NULL}, {"y", "yu", "ys", "ysu", NULL}, {"z", "zu", "zs", "zsu", NULL}};
    static const char *const radius[] = {"r", "radius", "diameter", NULL};
    int which;
    columns->width = names->n;
    for (int axis = 0; axis < 3; ++axis) {
        const int status = find_any(&columns->place[axis], &which, lines, names, coordinate[axis]);
        if (status) return status;
        columns->scaled[axis] = which >= 2;
    }
    int status = find_any(&columns->radius, &which, lines, names, radius);
    if (status) return status;
    columns->radius_unit = which == 2 ? 0.5 : 1;
    status = find(&columns->id, lines, names, "id");
    if (status) return status;
    if (options->extras == 0) return STATUS_OK;
    size_t *extra = realloc(columns->extra, options->extras * sizeof *extra);
    if (!extra) return message_memory();
    columns->extra = extra;
    for (size_t k = 0; k < options->extras; ++k) {
        status = find_any(&extra[k], &which, lines, names, (const char *const[]){options->extra[k], NULL});
        if (status) return status;
    }
    return STATUS_OK;
}

int columns_add(const struct columns *columns, const struct lines *lines, const struct fields *row,
                const struct read_options *options, struct bed *bed) {
    static const char *const axes[] = {"x", "y", "z"};
    if (row->n != columns->width)
        return message_at(STATUS_INPUT, lines->name, lines->number, "%zu fields where the header names %zu columns",
                          row->n, columns->width);
    double centre[3];
    for (int axis = 0; axis < 3; ++axis) {
        const int status = lines_number(lines, axes[axis], row->at[columns->place[axis]], &centre[axis]);
        if (status) return status;
        if (columns->scaled[axis]) centre[axis] = bed->low[axis] + centre[axis] * (bed->high[axis] - bed->low[axis]);
    }
    struct bed_sphere sphere = {.x = centre[0], .y = centre[1], .z = centre[2], .line = lines->number};
    int status = lines_number(lines, "the radius", row->at[columns->radius], &sphere.r);
    if (status) return status;
    sphere.r *= columns->radius_unit;
    if (!(sphere.r > 0))
        return message_at(STATUS_INPUT, lines->name, lines->number, "the radius is %g; it must be above 0", sphere.r);
    bed->ids = columns->id < columns->width && !options->positions;
    if (bed->ids) {
        status = lines_whole(lines, "the id", row->at[columns->id], &sphere.id);
        if (status) return status;
    }
    status = bed_add(bed, &sphere);
    for (size_t k = 0; k < options->extras && !status; ++k)
        status = lines_number(lines, options->extra[k], row->at[columns->extra[k]],
                              &bed->extra[(bed->n - 1) * options->extras + k]);
    return status;
}
