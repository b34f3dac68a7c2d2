/* read_vtk.c - beds from VTK files, legacy or XML, with points and an array of radii. SPDX-License-Identifier: MIT */
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "cli/spelling.h"
#include "read/read_format.h"
#include "read/vtk/vtk_grid.h"

enum { RADIUS, DIAMETER, ID, EXTRAS };

/* Whether a text is within the first 1000 bytes of the file. */
static bool begins_near(const struct source *source, const char *wanted) {
    char head[1000];
    size_t size;
    const char *begin = source_begin(source, &size);
    if (size > sizeof head - 1) size = sizeof head - 1;
    memcpy(head, begin, size);
    head[size] = 0;
    return strstr(head, wanted) != NULL;
}

static bool is_legacy(const struct source *source) { return source_begins(source, "# vtk DataFile"); }

static bool is_xml(const struct source *source) { return begins_near(source, "<VTKFile"); }

static int vtk_check(const struct source *source, const struct vtk_grid *grid) {
    const struct vtk_wanted *wanted = grid->wanted;
    if (!grid->points && grid->n > 0) return vtk_fail(grid, NULL, "this VTK file has no points");
    if (grid->n == 0) return STATUS_OK;
    if (!source->options.no_radius && !wanted[RADIUS].values && !wanted[DIAMETER].values)
        return vtk_fail(grid, NULL,
                        "this VTK file has no array radius or diameter on its points; --radius gives radii");
    char table[HINT_ROOM];
    for (size_t k = EXTRAS; k < grid->count; ++k)
        if (!wanted[k].values)
            return vtk_fail(grid, NULL, "there is no array %.40s on the points%s", wanted[k].name,
                            table_hint(table, "", wanted[k].name));
    return STATUS_OK;
}

/* Refuses a number of point i that is not finite. */
static int vtk_finite(const struct vtk_grid *grid, const char *what, uint64_t i, double value) {
    if (isfinite(value)) return STATUS_OK;
    return vtk_fail(grid, NULL, "%s of point %llu is not finite", what, (unsigned long long)i);
}

static int add_point(const struct source *source, const struct vtk_grid *grid, uint64_t i, struct bed *bed) {
    const struct vtk_wanted *wanted = grid->wanted;
    const double *centre = &grid->points[3 * i];
    struct bed_sphere sphere = {.x = centre[0], .y = centre[1], .z = centre[2]};
    int status = vtk_finite(grid, "a coordinate", i, sphere.x + sphere.y + sphere.z);
    if (!source->options.no_radius) {
        sphere.r = wanted[RADIUS].values ? wanted[RADIUS].values[i] : wanted[DIAMETER].values[i] / 2;
        if (!status) status = vtk_finite(grid, "the radius", i, sphere.r);
    }
    if (bed->ids) {
        const double id = wanted[ID].values[i];
        if (!status && !(fabs(id) < 9e15 && id == floor(id)))
            status = vtk_fail(grid, NULL, "the id of point %llu is %g", (unsigned long long)i, id);
        if (!status) sphere.id = (int64_t)id;
    }
    if (!status) status = columns_add_sphere(&source->lines, &source->options, &sphere, bed);
    for (size_t k = 0; k < bed->extras && !status; ++k) {
        const double value = wanted[EXTRAS + k].values[i];
        bed->extra[(bed->n - 1) * bed->extras + k] = value;
        if (isnan(value) && source->options.some && source->options.some[k]) continue; /* missing */
        status = vtk_finite(grid, wanted[EXTRAS + k].name, i, value);
    }
    return status;
}

static int read_grid(struct source *source, int (*read)(struct vtk_grid *), struct bed *bed) {
    static const char *const radius[] = {"radius", "radii", "r", NULL}, *const diameter[] = {"diameter", "d", NULL},
                             *const id[] = {"id", NULL};
    struct vtk_grid grid = {.file = source->lines.name, .count = EXTRAS + source->options.extras};
    char *text;
    size_t size;
    grid.wanted = calloc(grid.count, sizeof *grid.wanted);
    int status = grid.wanted ? lines_rest(&source->lines, &text, &size) : message_memory();
    if (!status && source->lines.truncated) status = source_ends(source, "");
    if (!status) {
        grid.text = text;
        grid.end = text + size;
        grid.wanted[RADIUS].names = radius;
        grid.wanted[DIAMETER].names = diameter;
        grid.wanted[ID].names = id;
        for (size_t k = 0; k < source->options.extras; ++k) grid.wanted[EXTRAS + k].name = source->options.extra[k];
        status = read(&grid);
    }
    if (!status) status = vtk_check(source, &grid);
    bed->ids = !status && grid.wanted[ID].values && !source->options.positions;
    for (uint64_t i = 0; i < grid.n && !status; ++i) status = add_point(source, &grid, i, bed);
    for (size_t k = 0; grid.wanted && k < grid.count; ++k) free(grid.wanted[k].values);
    free(grid.wanted);
    free(grid.points);
    return status;
}

static int read_legacy(struct source *source, struct bed *bed) { return read_grid(source, vtk_read_legacy, bed); }

static int read_xml(struct source *source, struct bed *bed) { return read_grid(source, vtk_read_xml, bed); }

const struct format format_vtk = {is_legacy, NULL, read_legacy}, format_vtk_xml = {is_xml, NULL, read_xml};
