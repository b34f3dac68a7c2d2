/* read_vtk.c - beds from VTK files, legacy or XML, with points and an array of radii. SPDX-License-Identifier: MIT
 *
 * The spheres of a .pvtp, .pvtu or .vtm file are in other files, its pieces. A .pvd file names files and their times.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "cli/spelling.h"
#include "read/read_format.h"
#include "read/vtk/vtk_grid.h"
#include "text/read_number.h"
#include "text/unit.h"

enum { RADIUS, DIAMETER, ID, GHOST, EXTRAS, DEEPEST = 3 /* files that files name */ };

/* A VTK file that is read into a bed. */
struct vtk_file {
    struct source *source;
    struct bed *bed;
    struct vtk_wanted *wanted; /* radii, diameters, ids, ghosts, further columns, columns of rules */
    size_t count;
    double *factor; /* [extras] from the units of further columns to the expected ones */
    bool begun;     /* a piece with points has been read */
    int depth;      /* of pieces */
};

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

static bool is_series(const struct source *source) { return is_xml(source) && begins_near(source, "<Collection"); }

/* Refuses a piece that lacks an array. */
static int vtk_check(const struct vtk_file *file, const struct vtk_grid *grid) {
    const struct vtk_wanted *wanted = file->wanted;
    const bool ids = wanted[ID].values && !file->source->options.positions;
    if (!grid->points) return vtk_fail(grid, NULL, "this VTK file has no points");
    char table[HINT_ROOM];
    for (size_t k = 0; k < file->count; ++k)
        if (wanted[k].name && !wanted[k].values)
            return vtk_fail(grid, NULL, "there is no array %.40s on the points%s", wanted[k].name,
                            table_hint(table, "", wanted[k].name));
    if (!file->source->options.no_radius && !wanted[RADIUS].values && !wanted[DIAMETER].values)
        return vtk_fail(grid, NULL,
                        "this VTK file has no array radius or diameter on its points; --radius gives radii, or "
                        "--columns r=NAME");
    if (file->begun && file->bed->ids != ids)
        return vtk_fail(grid, NULL, "some pieces have an array of ids and others have none");
    return STATUS_OK;
}

/* Refuses a number of point i that is not finite. */
static int vtk_finite(const struct vtk_grid *grid, const char *what, uint64_t i, double value) {
    if (isfinite(value)) return STATUS_OK;
    return vtk_fail(grid, NULL, "%s of point %llu is not finite", what, (unsigned long long)i);
}

/* Whether the rules allow point i. A ghost is a point of another piece, or hidden. */
static bool point_allowed(const struct vtk_file *file, uint64_t i) {
    const struct read_options *options = &file->source->options;
    if (file->wanted[GHOST].values && file->wanted[GHOST].values[i] != 0) return false;
    for (size_t k = 0; k < options->rules; ++k) {
        double value;
        const bool number = number_read(options->rule[k].value, &value);
        if ((number && file->wanted[EXTRAS + options->extras + k].values[i] == value) == options->rule[k].skip)
            return false;
    }
    return true;
}

static int add_point(const struct vtk_file *file, const struct vtk_grid *grid, uint64_t i) {
    const struct vtk_wanted *wanted = file->wanted;
    const struct read_options *options = &file->source->options;
    struct bed *bed = file->bed;
    const double *centre = &grid->points[3 * i];
    struct bed_sphere sphere = {.x = centre[0], .y = centre[1], .z = centre[2]};
    int status = vtk_finite(grid, "a coordinate", i, sphere.x + sphere.y + sphere.z);
    if (!options->no_radius) {
        sphere.r = wanted[RADIUS].values ? wanted[RADIUS].values[i] : wanted[DIAMETER].values[i] / 2;
        if (!status) status = vtk_finite(grid, "the radius", i, sphere.r);
    }
    if (bed->ids) {
        const double id = wanted[ID].values[i];
        if (!status && !(fabs(id) < 9e15 && id == floor(id)))
            status = vtk_fail(grid, NULL, "the id of point %llu is %g", (unsigned long long)i, id);
        if (!status) sphere.id = (int64_t)id;
    }
    if (!status) status = columns_add_sphere(file->source, &sphere, bed);
    for (size_t k = 0; k < bed->extras && !status; ++k) {
        const double value = wanted[EXTRAS + k].values[i] * file->factor[k];
        bed->extra[(bed->n - 1) * bed->extras + k] = value;
        if (!isfinite(value) && options->some && options->some[k]) continue; /* missing, or out of its range */
        status = vtk_finite(grid, wanted[EXTRAS + k].name, i, value);
    }
    return status;
}

static int take_points_of(struct vtk_grid *grid, void *vtk_file) {
    struct vtk_file *file = vtk_file;
    if (grid->n == 0) return STATUS_OK;
    int status = vtk_check(file, grid);
    if (status) return status;
    file->bed->ids = file->wanted[ID].values && !file->source->options.positions;
    file->begun = true;
    for (uint64_t i = 0; i < grid->n && !status; ++i)
        if (point_allowed(file, i)) status = add_point(file, grid, i);
    return status;
}

typedef int read_grid(struct vtk_grid *grid);
static int read_piece(const char *source, void *vtk_file);

/* Reads the file of file->source. */
static int read_file(struct vtk_file *file, read_grid *read) {
    struct vtk_grid grid = {.file = file->source->lines.name, .wanted = file->wanted, .count = file->count};
    grid.take = take_points_of, grid.open = file->depth < DEEPEST ? read_piece : NULL, grid.context = file;
    char *text;
    size_t size;
    int status = lines_rest(&file->source->lines, &text, &size);
    if (!status && file->source->lines.truncated) status = source_ends(file->source, "");
    if (status) return status;
    grid.text = text;
    grid.end = text + size;
    status = read(&grid);
    free(grid.points);
    return status;
}

/* Reads a piece. Its name is relative to the folder of the file that names it. */
static int read_piece(const char *source, void *vtk_file) {
    struct vtk_file *file = vtk_file;
    struct source *whole = file->source, piece = {.options = whole->options};
    const char *slash = *source == '/' ? NULL : strrchr(whole->lines.name, '/');
    const int folder = slash ? (int)(slash + 1 - whole->lines.name) : 0;
    const size_t room = strlen(whole->lines.name) + strlen(source) + 1;
    struct stat there;
    char *path = malloc(room);
    if (!path) return message_memory();
    snprintf(path, room, "%.*s%s", folder, whole->lines.name, source);
    int status = STATUS_OK;
    if (stat(path, &there) == 0 && !S_ISREG(there.st_mode))
        status = message_at(STATUS_INPUT, whole->lines.name, 0, "its piece %.200s is no file", path);
    if (!status) status = lines_open(&piece.lines, path);
    if (!status && !is_xml(&piece)) status = source_fail(&piece, "this piece is no XML file of VTK");
    file->source = &piece, ++file->depth;
    if (!status) status = read_file(file, vtk_read_xml);
    file->source = whole, --file->depth;
    lines_close(&piece.lines);
    free(path);
    return status;
}

/* The unit behind the name of a wanted array. "": it has none. */
static void unit_of(const struct vtk_wanted *wanted, char unit[UNIT_LENGTH]) {
    size_t bare, length;
    const char *text;
    unit[0] = 0;
    if (wanted->name && unit_behind(wanted->name, &bare, &text, &length))
        snprintf(unit, UNIT_LENGTH, "%.*s", (int)(length < UNIT_LENGTH ? length : UNIT_LENGTH - 1), text);
}

/* Says which arrays are radii, diameters and ids: those that --columns names, or else those of usual names. */
static int want_usual(struct vtk_file *file) {
    static const char *const radius[] = {"radius", "radii", "r", NULL}, *const diameter[] = {"diameter", "d", NULL},
                             *const id[] = {"id", NULL}, *const ghost[] = {"vtkGhostType", NULL},
                             *const position[] = {"x", "y", "z", NULL};
    const char *const *const names[] = {radius, diameter, id, ghost};
    const struct read_options *options = &file->source->options;
    const struct column_name *given;
    struct vtk_wanted *wanted = file->wanted;
    char unit[UNIT_LENGTH];
    for (const char *const *name = position; *name; ++name)
        if ((given = read_options_name(options, *name, true)))
            return message_at(STATUS_INPUT, file->source->lines.name, 0,
                              "--columns %s=%.40s: positions in a VTK file are its points", given->known, given->name);
    for (int k = 0; k < EXTRAS; ++k) {
        for (const char *const *name = names[k]; *name; ++name)
            if ((given = read_options_name(options, *name, true))) wanted[k].name = given->name;
        if (!wanted[k].name) wanted[k].names = names[k];
        if (k > DIAMETER) continue;
        unit_of(&wanted[k], unit);
        if (*unit) snprintf(file->bed->units, sizeof file->bed->units, "%.15s", unit);
    }
    if (wanted[RADIUS].name) wanted[DIAMETER].names = NULL;
    if (wanted[DIAMETER].name) wanted[RADIUS].names = NULL;
    return STATUS_OK;
}

/* Says which arrays are wanted, and finds the factors of their units. */
static int want(struct vtk_file *file) {
    const struct read_options *options = &file->source->options;
    char unit[UNIT_LENGTH];
    int status = want_usual(file);
    for (size_t k = 0; k < options->extras + options->rules && !status; ++k) {
        const char *name = read_options_wanted(options, k);
        const struct column_name *given = read_options_name(options, name, false);
        file->wanted[EXTRAS + k].name = given ? given->name : name;
        unit_of(&file->wanted[EXTRAS + k], unit);
        if (k < options->extras) status = columns_factor(file->source, k, unit, file->bed->units, &file->factor[k]);
    }
    return status;
}

/* Goes through the files of the next time, and reads them if there is a vtk_file. */
static int next_time(struct source *source, struct vtk_file *reads) {
    char first[XML_WORD], time[XML_WORD], name[XML_WORD];
    bool more;
    int status = STATUS_OK;
    source->found = FOUND_END;
    while (!status && !(status = lines_next(&source->lines, &more)) && more) {
        const char *text = source->lines.text;
        if (!vtk_next_set(&text, time, name)) continue;
        if (strstr(text, "<DataSet")) return source_fail(source, "each DataSet must stand on a line of its own");
        if (source->found == FOUND_FRAME && strcmp(time, first) != 0) return lines_hold(&source->lines), STATUS_OK;
        memcpy(first, time, sizeof first);
        source->found = FOUND_FRAME;
        if (reads) status = read_piece(name, reads);
    }
    return status;
}

static int skip_series(struct source *source) { return next_time(source, NULL); }

/* read NULL: a series. */
static int read_vtk(struct source *source, read_grid *read, struct bed *bed) {
    const struct read_options *options = &source->options;
    struct vtk_file file = {.source = source, .bed = bed, .count = EXTRAS + options->extras + options->rules};
    file.wanted = calloc(file.count, sizeof *file.wanted);
    file.factor = calloc(options->extras + 1, sizeof *file.factor);
    int status = file.wanted && file.factor ? want(&file) : message_memory();
    if (!status) status = read ? read_file(&file, read) : next_time(source, &file);
    for (size_t k = 0; file.wanted && k < file.count; ++k) free(file.wanted[k].values);
    free(file.wanted);
    free(file.factor);
    return status;
}

static int read_legacy(struct source *source, struct bed *bed) { return read_vtk(source, vtk_read_legacy, bed); }

static int read_xml(struct source *source, struct bed *bed) { return read_vtk(source, vtk_read_xml, bed); }

static int read_series(struct source *source, struct bed *bed) { return read_vtk(source, NULL, bed); }

const struct format format_vtk = {is_legacy, NULL, read_legacy}, format_vtk_xml = {is_xml, NULL, read_xml},
                    format_vtk_series = {is_series, skip_series, read_series};
