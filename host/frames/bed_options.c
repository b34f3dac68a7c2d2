/* bed_options.c - options that all commands about beds share. SPDX-License-Identifier: MIT */
#define _GNU_SOURCE /* strverscmp; NOLINT(bugprone-reserved-identifier) */
#include "frames/bed_options.h"

#include <ctype.h>
#include <errno.h>
#include <glob.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "bed/bed_scene.h"
#include "plot/gnuplot.h"

int bed_radius_option(const char *text, void *radius) {
    return quantity_option("--radius", text, FIBRAD_LENGTH_MIN, FIBRAD_LENGTH_MAX, radius);
}

int bed_clump_option(const char *text, void *clump) {
    struct quantity *quantity = clump;
    *quantity = (struct quantity){.given = true, .column = text};
    if (isalpha((unsigned char)*text) || *text == '_') return STATUS_OK;
    return message(STATUS_USAGE, "--clump: '%.60s' is not the name of a column", text);
}

int bed_period_option(const char *text, void *bed_options) {
    struct bed_options *options = bed_options;
    double *period = options->period;
    int count = 3;
    const int status = strcmp(text, "none") == 0 ? STATUS_OK : options_numbers("--periodic", text, 3, period, &count);
    options->periodic = true;
    if (status) return status;
    if (count != 3 || period[0] < 0 || period[1] < 0 || period[2] < 0)
        return message(STATUS_USAGE, "--periodic: '%.60s' is neither none nor three lengths LX,LY,LZ", text);
    return STATUS_OK;
}

static int add_file(struct bed_options *options, const char *name) {
    for (size_t k = 0; k < options->files; ++k)
        if (strcmp(name, "-") == 0 && strcmp(options->file[k], name) == 0)
            return message(STATUS_USAGE, "standard input can be read once only");
    const int spared = output_spare(name);
    if (spared) return spared;
    char **file = realloc(options->file, (options->files + 1) * sizeof *file);
    if (!file) return message_memory();
    options->file = file;
    file[options->files] = strdup(name);
    return file[options->files++] ? STATUS_OK : message_memory();
}

/* Orders names by the numbers in them: bed.200.dump stands before bed.1000.dump. */
static int order_of_names(const void *a, const void *b) { return strverscmp(*(char *const *)a, *(char *const *)b); }

/* Takes the name of a file, or a pattern in quotes that the shell has not expanded. */
int bed_files_option(const char *name, void *options) {
    struct stat there;
    glob_t found;
    if (!strpbrk(name, "*?[") || stat(name, &there) == 0) return add_file(options, name);
    if (glob(name, 0, NULL, &found) != 0) return message_at(STATUS_FILE, name, 0, "no file has such a name");
    qsort(found.gl_pathv, found.gl_pathc, sizeof *found.gl_pathv, order_of_names);
    int status = STATUS_OK;
    for (size_t k = 0; k < found.gl_pathc && !status; ++k) status = add_file(options, found.gl_pathv[k]);
    globfree(&found);
    return status;
}

/* Reads --frame: K, all, A:B, A:B:STEP or -1. */
int bed_frames_option(const char *text, void *bed_options) {
    struct bed_options *options = bed_options;
    struct frames frames = {0, INT64_MAX, 1};
    char *end = (char *)text;
    const char *digits = "0123456789";
    options->range = strcmp(text, "all") == 0 || strchr(text, ':');
    if (strcmp(text, "-1") == 0 || strcmp(text, "all") == 0) {
        options->frames = options->range ? frames : (struct frames){0};
        return STATUS_OK;
    }
    if (strspn(text, digits) > 0) frames.begin = strtoll(text, &end, 10);
    bool good = (*end == 0 && end != text) || *end == ':';
    if (*end == 0) frames.end = frames.begin < INT64_MAX ? frames.begin + 1 : frames.begin;
    if (*end == ':' && strspn(++end, digits) > 0) frames.end = strtoll(end, &end, 10);
    if (*end == ':' && strspn(++end, digits) > 0) frames.step = strtoll(end, &end, 10);
    good = good && *end == 0 && frames.begin < frames.end && frames.step > 0;
    if (!good) return message(STATUS_USAGE, "--frame: '%.40s' is none of K, all, A:B, A:B:STEP, -1", text);
    options->frames = frames;
    return STATUS_OK;
}

int bed_unit_option(const char *text, void *unit) {
    double metres;
    if (!unit_of_length(text, &metres) || metres == 0)
        return message(STATUS_USAGE, "--length-unit: '%.40s' is none of " UNITS_LENGTH, text);
    *(const char **)unit = text;
    return STATUS_OK;
}

int bed_scratch_option(const char *folder, void *scratch) {
    struct stat there;
    *(const char **)scratch = folder;
    if (stat(folder, &there) != 0 || access(folder, W_OK | X_OK) != 0)
        return message_at(STATUS_FILE, folder, 0, "%s", strerror(errno));
    return S_ISDIR(there.st_mode) ? STATUS_OK : message_at(STATUS_FILE, folder, 0, "is not a folder");
}

int bed_meshes_option(const char *path, void *bed_options) {
    struct bed_options *options = bed_options;
    options->wall_vtp = true;
    return outputs_add_meshes(path, &options->outputs);
}

void bed_options_quantity(struct bed_options *options, struct quantity *quantity, const char *unit) {
    size_t k = 0;
    if (!quantity->column) return;
    if (quantity->types) unit = NULL;
    while (k < options->columns && (unit || options->unit[k] || strcmp(options->column[k], quantity->column) != 0)) ++k;
    if (k == options->columns) ++options->columns;
    options->column[k] = quantity->column;
    options->unit[k] = unit;
    if (quantity->some && !quantity->types) options->some[k] = true;
    quantity->index = k;
}

const char *bed_options_column(const struct bed_options *options, const struct quantity *quantity) {
    const struct column_options *columns = &options->columns_of_file;
    for (size_t k = 0; quantity->column && k < columns->names; ++k)
        if (strcmp(columns->name[k].known, quantity->column) == 0) return columns->name[k].name;
    return quantity->column;
}

/* Whether the run may have several frames. */
static bool is_series(const struct bed_options *options) { return options->range || options->files > 1; }

int bed_options_check(struct bed_options *options, const char *command, enum content content) {
    const char *picture = options->outputs.picture;
    options->command = command;
    options->progress.quiet = options->quiet;
    if (options->files == 0) return message(STATUS_USAGE, "FILE is missing; see fibrad %s --help", command);
    bed_options_quantity(options, &options->radius, UNIT_OF_LENGTH);
    bed_options_quantity(options, &options->clump, NULL);
    if (picture && !plot_ending(picture))
        return message_at(STATUS_USAGE, picture, 0, "unknown ending; there are .svg and .png");
    if (picture && is_series(options)) return message(STATUS_USAGE, "--plot shows one frame; choose it by --frame");
    if (options->slice.axis && !picture) return message(STATUS_USAGE, "--slice needs --plot");
    if (options->timed && is_series(options))
        return message(STATUS_USAGE, "--until begins with one frame; choose it by --frame");
    int status = walls_settle(&options->walls);
    if (!status && options->wall_vtp && !options->walls.walls.meshes)
        return message(STATUS_USAGE, "--wall-vtp: there is no --wall mesh:FILE");
    if (!status && options->radius.given) status = columns_check(&options->columns_of_file);
    if (status) return status;
    return outputs_check(&options->outputs, content, is_series(options) || options->timed);
}

/* Puts periods, unit and radii of the options into a bed that was read. */
static int complete_bed(struct bed_options *options, struct bed *bed) {
    if (options->periodic) warn_periods(&options->warned, bed, options->period);
    if (options->periodic) memcpy(bed->period, options->period, sizeof bed->period);
    if (!bed->units[0] && options->length_unit)
        snprintf(bed->units, sizeof bed->units, "%s", options->length_unit); /* outputs show the unit */
    const char *unit = bed_options_unit(options, bed);
    if (!unit || !unit_of_length(unit, &bed->metres)) bed->metres = 0;
    const struct quantity *clump = &options->clump;
    int status = STATUS_OK;
    if (clump->given)
        status = bed_take_clumps(bed, options->name, clump->index, strcmp(clump->column, "id_multisphere") == 0);
    if (status || !options->radius.given) return status;
    double *radius; /* copied: bed->r has room for larger frames, which must stay */
    status = quantity_values(&options->radius, bed, options->name, "radius", 0, FIBRAD_LENGTH_MIN, FIBRAD_LENGTH_MAX,
                             &radius);
    if (!status) memcpy(bed->r, radius, bed->n * sizeof *radius);
    free(radius);
    return status;
}

static int run_file(struct bed_options *options, const char *path, struct bed *bed, bed_options_frame *frame,
                    void *request) {
    const struct column_options *columns = &options->columns_of_file;
    struct read_options read = {.frames = options->frames, .positions = options->positions};
    read.periods_given = options->periodic, read.no_radius = options->radius.given, read.series = options->files > 1;
    read.extra = options->column, read.unit = options->unit, read.some = options->some, read.extras = options->columns;
    read.name = columns->name, read.names = columns->names, read.rule = columns->rule, read.rules = columns->rules;
    read.keep = outputs_keep(&options->outputs);
    struct reader *reader;
    bool more = true;
    options->name = options->warned.file = lines_name(path);
    int status = reader_open(&reader, path, &read);
    while (!status) {
        status = reader_next(reader, bed, &more);
        if (status || !more) break;
        if (options->files > 1) bed->frame = options->frames_done; /* counted through all files */
        warn_frame(&options->warned, bed);
        status = complete_bed(options, bed);
        if (!status) status = plot_plane_check(&options->slice, bed);
        if (!status) status = frame(request, bed);
        ++options->frames_done;
    }
    reader_close(reader);
    return status;
}

/* Outputs are opened first: a path that cannot be written is an error before any work is done. */
static int run_frames(struct bed_options *options, bed_options_frame *frame, void *request) {
    struct bed bed = bed_empty();
    int status = output_open(&options->picture, options->outputs.picture);
    if (!status) status = outputs_open(&options->outputs);
    options->report = outputs_report(&options->outputs, options->quiet);
    if (!status) report_open(&options->report, options->command);
    for (size_t k = 0; k < options->files && !status; ++k)
        status = run_file(options, options->file[k], &bed, frame, request);
    if (!status && options->frames_done == 0)
        status = message(STATUS_INPUT, "there are no spheres in any of the files");
    if (!status) report_close(&options->report);
    bed_free(&bed);
    status = outputs_close(&options->outputs, status);
    return output_close(&options->picture, status);
}

int bed_options_end(struct bed_options *options, int status, int (*help)(void), bed_options_frame *frame,
                    void *request) {
    if (!status)
        status = run_frames(options, frame, request);
    else if (status == STATUS_HELP)
        status = help();
    for (size_t k = 0; k < options->files; ++k) free(options->file[k]);
    free(options->file);
    column_options_free(&options->columns_of_file);
    walls_free(&options->walls);
    return status;
}

fibrad_run bed_options_run(struct bed_options *options) {
    return (fibrad_run){.threads = options->threads, .progress = progress_stage, .context = &options->progress};
}

int bed_options_status(struct bed_options *options, const struct bed *bed, int status, const fibrad_fault *fault) {
    progress_stop(&options->progress);
    const struct walls *walls = &options->walls.walls;
    if (status && walls->meshes && fault->triangle != UINT32_MAX) {
        bool planes = false;
        for (uint32_t w = 0; w < walls->count; ++w) planes |= walls->wall[w].kind == FIBRAD_WALL_PLANE;
        return meshes_refuse(walls->meshes, status, fault->triangle, planes);
    }
    if (status == FIBRAD_E_ENDLESS) return walls_refuse_endless(walls, bed);
    if (status == FIBRAD_E_MEMORY && options->scratch)
        return message_at(STATUS_MEMORY, options->scratch, 0, "there is no more room on this disk, or in memory");
    return bed_status(bed, options->name, status, fault);
}

/* What an entry of the raw rows takes while rows are averaged. */
enum { ENTRY_BYTES = 48 };

int bed_options_make(struct bed_options *options, const struct bed *bed, const struct walls *walls, fibrad_bed **made) {
    const fibrad_scene_config scene = bed_scene(bed, walls);
    const fibrad_spheres spheres = bed_spheres(bed);
    fibrad_run run = bed_options_run(options);
    const int status = fibrad_bed_new(made, &scene, &spheres, &run);
    if (!status) warn_made(&options->warned, bed, walls, *made, true);
    if (!status) warn_beyond(*made, bed, walls, options->name);
    return bed_options_status(options, bed, status, &run.fault);
}

int bed_options_made(struct bed_options *options, const struct bed *bed, const fibrad_bed *made, int status) {
    fibrad_fault fault;
    fibrad_bed_describe(made, NULL, &fault);
    return bed_options_status(options, bed, status, &fault);
}

/* Refuses a bed whose rows will not fit into memory, or onto the disk of rows->scratch. */
static int check_room(struct bed_options *options, const struct bed *bed, fibrad_bed *made,
                      const fibrad_bed_rule *rows) {
    enum { SAMPLE = 16, ENTRIES_MANY = 2000 };
    fibrad_bed_rule some = *rows;
    fibrad_bed_matrix *factors = NULL;
    const double left = rows->scratch ? disk_left(rows->scratch) : memory_left();
    if (rows->wanted || (double)bed->n * ENTRIES_MANY * ENTRY_BYTES < left) return STATUS_OK;
    unsigned char *marks = calloc(bed->n, 1);
    if (!marks) return message_memory();
    for (uint32_t k = 0; k < SAMPLE; ++k) marks[(uint64_t)bed->n * k / SAMPLE] = 1;
    some.wanted = marks;
    int status = bed_options_made(options, bed, made, fibrad_bed_factors(made, &some, &factors));
    const double bytes = status ? 0 : (double)factors->matrix.start[factors->matrix.n] / SAMPLE * bed->n * ENTRY_BYTES;
    if (!status)
        status = rows->scratch
                     ? disk_check(rows->scratch, bytes)
                     : memory_check(
                           bytes, "--cutoff, fewer directions or rays, or --targets take less; --scratch takes a disk");
    fibrad_bed_matrix_free(factors);
    free(marks);
    return status;
}

int bed_options_factors(struct bed_options *options, const struct bed *bed, const struct walls *walls, fibrad_bed *made,
                        fibrad_bed_rule *rows, fibrad_bed_matrix **factors) {
    *factors = NULL;
    rows->scratch = options->scratch, rows->walls = 1;
    int status = check_room(options, bed, made, rows);
    if (!status) status = bed_options_made(options, bed, made, fibrad_bed_factors(made, rows, factors));
    if (!status) warn_made(&options->warned, bed, walls, made, true);
    return status;
}

const char *bed_options_unit(const struct bed_options *options, const struct bed *bed) {
    double metres = 0;
    const bool by_file = bed->units[0] && (!unit_of_length(bed->units, &metres) || metres > 0);
    return by_file ? bed->units : options->length_unit;
}

int bed_options_metres(struct bed_options *options, struct bed *bed, const char *needed) {
    const char *unit = bed_options_unit(options, bed);
    double other;
    if (!unit && bed->units[0])
        return message_at(STATUS_USAGE, options->name, 0,
                          "units %.20s have no fixed length in metres; --length-unit gives the length", bed->units);
    if (!unit && needed)
        return message_at(STATUS_USAGE, options->name, 0,
                          "the file names no unit of length, which %s; --length-unit gives it", needed);
    if (unit && bed->metres == 0) return message_at(STATUS_USAGE, options->name, 0, "unknown units '%.20s'", unit);
    if (unit && options->length_unit && unit_of_length(options->length_unit, &other) && other != bed->metres)
        return message_at(STATUS_USAGE, options->name, 0,
                          "its units are %.20s; --length-unit is for files that name none", unit);
    if (!unit) warn_unit(&options->warned, bed);
    if (!unit) bed->metres = 1;
    if (options->metres > 0 && options->metres != bed->metres)
        return message_at(STATUS_USAGE, options->name, 0,
                          "the unit of length is %g m, but that of the files before is %g m", bed->metres,
                          options->metres);
    options->metres = bed->metres;
    return STATUS_OK;
}

int bed_options_write(struct bed_options *options, const struct bed *bed, struct contents *what) {
    what->bed = bed;
    what->file = options->files > 1 ? options->name : NULL;
    what->series = is_series(options);
    return outputs_write(&options->outputs, what);
}

int bed_options_walls(struct bed_options *options, const struct bed *bed, struct walls *walls) {
    const fibrad_spheres spheres = bed_spheres(bed);
    const int status = walls_of(&options->walls, bed, options->name, walls);
    if (!status) warn_box(&options->warned, walls);
    if (status || !walls->meshes) return status;
    return meshes_face(walls->meshes, &spheres, bed->period);
}

static void report_mesh(struct report *report, const struct walls *walls, uint32_t k) {
    const struct mesh *mesh = mesh_of_wall(walls->meshes, k);
    const char *name = wall_name(walls, k);
    double low[3], high[3];
    mesh_extents(walls->meshes, k, low, high);
    report_text(report, report_key(report, "wall_%s_file", name), mesh->file);
    report_count(report, report_key(report, "wall_%s_triangles", name), mesh_triangles(mesh, k));
    report_vector(report, report_key(report, "wall_%s_low", name), low);
    report_vector(report, report_key(report, "wall_%s_high", name), high);
}

static void report_wall(struct report *report, const struct walls *walls, uint32_t k) {
    const fibrad_wall *wall = &walls->wall[k];
    const char *key = report_key(report, "wall_%s_at", wall_name(walls, k));
    if (wall->kind == FIBRAD_WALL_MESH)
        report_mesh(report, walls, k);
    else if (wall->kind == FIBRAD_WALL_CYLINDER)
        report_vector(report, key, (const double[]){wall->cylinder.x, wall->cylinder.y, wall->cylinder.radius});
    else
        report_value(report, key, wall->plane.at, 9);
}

void bed_options_report(struct bed_options *options, const struct bed *bed, const struct walls *walls,
                        const fibrad_scene_facts *facts) {
    struct report *report = &options->report;
    const char *unit = bed_options_unit(options, bed);
    report_begin(report);
    report_text(report, "file", options->name);
    report_whole(report, "frame", bed->frame);
    if (bed->timestep >= 0) report_whole(report, "timestep", bed->timestep);
    report_count(report, "spheres", bed->n);
    report_text(report, "named_by", bed->ids ? "ids" : "positions");
    if (facts && options->clump.given) report_count(report, "clumps", facts->clumps);
    report_text(report, "length_unit", unit ? unit : bed->units[0] ? bed->units : "not said");
    if (facts) report_value(report, "radius_min", facts->radius_min, 6);
    if (facts) report_value(report, "radius_max", facts->radius_max, 6);
    if (facts && facts->overlap_max > 0) report_value(report, "overlap_max", facts->overlap_max, 3);
    if (bed->low[0] < bed->high[0]) {
        report_vector(report, "box_low", bed->low);
        report_vector(report, "box_high", bed->high);
    }
    report_vector(report, "periods", bed->period);
    for (uint32_t k = 0; k < walls->count; ++k) report_wall(report, walls, k);
    for (uint32_t k = 0; k < walls->openings; ++k)
        report_value(report, report_key(report, "open_%s_at", plane_name(&walls->opening[k])), walls->opening[k].at, 9);
    if (facts) report_text(report, "instruction_set", fibrad_isa_name(facts->isa));
}
