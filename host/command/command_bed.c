/* command_bed.c - `fibrad bed`: view factors of all spheres of a file. SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bed/bed_scene.h"
#include "simple/bed.h"
#include "cli/message.h"
#include "cli/output.h"
#include "cli/targets.h"
#include "frames/bed_options.h"
#include "command/commands.h"
#include "plot/plot_bed.h"
#include "write/write.h"

struct bed_request {
    struct bed_options bed;
    const char *targets;
    struct method_options methods;
    double cutoff, error; /* 0: none */
    bool raw;
    struct walls walls;
    fibrad_bed_rule options;
};

/* Takes the argument of --targets, unless it is `all`. */
static int take_targets(const char *text, void *targets) {
    const bool all = strcmp(text, "all") == 0;
    *(const char **)targets = all ? NULL : text;
    return all ? STATUS_OK : targets_mark(text, NULL, 0, "", NULL);
}

static const struct option bed_table[] = {
    {0, "method", "NAME",
     "beam (parallel beams), surface (nodes on surfaces), cast (quasi-random rays) or mc (random rays) [beam]",
     TO_FUNCTION(option_method, struct bed_request, methods.method)},
    OPTIONS_METHODS(struct bed_request),
    {0, "error", "E",
     "beam: error allowed in every row, estimated, 1e-7 to 1; directions are added until it is met [none]",
     TO_NUMBER(struct bed_request, error, 1e-7, 1)},
    {0, "cutoff", "D", "spheres with centres farther apart than D do not see each other [none]",
     TO_NUMBER(struct bed_request, cutoff, FIBRAD_LENGTH_MIN, FIBRAD_LENGTH_MAX)},
    {0, "targets", "LIST", "rows that are wanted, 3,7,10-19 for example; a list implies --raw [all]",
     TO_FUNCTION(take_targets, struct bed_request, targets)},
    {0, "raw", NULL, "leave the rows as they were computed [averaged and closed: A_i F_ij = A_j F_ji]",
     TO_FLAG(struct bed_request, raw)},
    {0, "drop", "D", "drop pairs of entries if both are below D, and enlarge the others; rows stay closed [0]",
     TO_NUMBER(struct bed_request, options.drop, 0, 1)},
    OPTIONS_WALL,
    OPTIONS_INPUT,
    {OPTION_BED_OUTPUT(
        "write the matrix (.csv .mtx .npz .json, - for standard output) or the spheres (.vtp) [summary only]")},
    {OPTION_BED_FORMAT},
    {OPTION_PLOT("draw a picture by gnuplot, .svg or .png [none]")},
    {OPTION_SLICE},
    {OPTION_SCRATCH},
    OPTIONS_RUN,
    {.name = NULL}};

static int bed_help(void) {
    puts("fibrad bed FILE... [options]\n\n"
         "View factors between all spheres of FILE.\n");
    options_print(bed_table);
    puts("\n" FILES_MORE "\n" WALLS_MORE "\n"
         "A factor to a wall is the fraction that arrives there directly. In .csv the surroundings are j = -1 and\n"
         "walls are j = -2, -3, ... with their names in the column `body`, so that rows add up to 1. Rows i = -2,\n"
         "-3, ... are those of walls that are not endless. With --targets or --cutoff there are no such rows. .vtp\n"
         "has an array for each wall. .mtx has spheres only. `beyond` is the fraction that leaves the cutoff and\n"
         "whose end is not followed.\n"
         "\n"
         "Several frames go into one .csv or .json with their numbers. If OUT has a *, each frame has a file.\n"
         "Standard output ends with a summary of each frame, one `key value` on a line. `wall_NAME_F` is the mean\n"
         "over spheres.\n"
         "\n"
         "Examples:\n"
         "  fibrad bed packing.dump -o F.mtx --plot bed.png\n"
         "  fibrad bed packing.dump --error 0.001 -o F.mtx -o F.csv --json F.json\n"
         "  fibrad bed spheres.csv --directions 987 --periodic 12,12,0 -o F.csv\n"
         "  fibrad bed packing.dump --wall auto -o F.csv\n"
         "  fibrad bed spheres.csv --wall cylinder:0,0,25,zmin=0 -o F.csv\n"
         "  fibrad bed packing.dump --method cast --rays 200000 -o F.csv\n"
         "  fibrad bed packing.dump --frame 3 --targets 1,7,100-199 -o rows.csv\n"
         "  fibrad bed packing.dump.gz --frame all -o 'F.*.npz'");
    return STATUS_OK;
}

/* Chooses the rule of the method. Refuses options of other methods. */
static int bed_choose(struct bed_request *request) {
    struct method_options *methods = &request->methods;
    fibrad_beam_rule *beam = &methods->beam;
    if (methods->method == METHOD_EXACT) return message(STATUS_USAGE, "--method exact is for pairs only");
    if (request->error > 0 && methods->method != METHOD_BEAM)
        return message(STATUS_USAGE, "--error is for --method beam");
    if (request->error > 0 && beam->directions > 0)
        return message(STATUS_USAGE, "--error chooses the directions; leave out --directions");
    beam->tolerance = request->error;
    beam->cutoff = methods->surface.cutoff = methods->cast.cutoff = request->cutoff;
    if (methods->method != METHOD_BEAM)
        request->options.cast = &methods->cast;
    else
        request->options.beam = beam;
    return methods_check(methods);
}

/* Checks that need no computation. */
static int bed_check(struct bed_request *request) {
    int status = bed_options_check(&request->bed, "bed", CONTENT_MATRIX);
    if (status) return status;
    request->options.raw = request->raw || request->targets;
    if (request->options.drop > 0 && request->options.raw)
        return message(STATUS_USAGE, "--drop needs rows that are averaged, not --raw or --targets");
    return bed_choose(request);
}

static int bed_parse(struct bed_request *request, int argc, char **argv) {
    *request = (struct bed_request){.methods.method = METHOD_BEAM};
    const int status = options_read("bed", bed_table, argc, argv, request);
    return status ? status : bed_check(request);
}

static void bed_report(struct bed_request *request, const struct contents *what, const struct summary *summary) {
    static const char *const methods[] = {"exact", "beam", "surface", "cast", "mc"};
    const fibrad_bed_matrix *factors = what->factors;
    struct report *report = &request->bed.report;
    bed_options_report(&request->bed, what->bed, what->walls, &factors->facts);
    report_text(report, "method", methods[request->methods.method]);
    if (request->methods.method == METHOD_BEAM)
        report_count(report, "directions", factors->directions);
    else if (request->methods.method == METHOD_SURFACE)
        report_count(report, "nf", request->methods.surface.nodes);
    else
        report_count(report, "rays", request->methods.cast.rays);
    if (request->methods.beam.points > 0) report_count(report, "points", request->methods.beam.points);
    if (request->cutoff > 0) report_value(report, "cutoff", request->cutoff, 9);
    if (request->error > 0)
        report_wanted(report, request->bed.name, request->error, request->error,
                      fmax(summary->error_max, summary->wall_error_max), "a row, and there are no more directions");
    report_text(report, "rows", request->options.raw ? "raw" : "reciprocal");
    report_count(report, "threads", (uint64_t)factors->threads);
    report_value(report, "seconds", factors->seconds, 3);
    summary_report(summary, what, report);
    if (request->methods.method == METHOD_BEAM) report_count(report, "fallbacks", factors->fallbacks);
    report_end(report);
}

/* Rays from each side of a triangle. Few sides have more rays each. */
enum { VIEW_RAYS = 256, VIEW_RAYS_MOST = 1 << 14, VIEW_RAYS_IN_ALL = 1 << 19 };

static uint32_t view_rays(uint32_t sides) {
    const uint32_t rays = VIEW_RAYS_IN_ALL / sides;
    return rays < VIEW_RAYS ? VIEW_RAYS : rays > VIEW_RAYS_MOST ? VIEW_RAYS_MOST : rays;
}

static double mean_of_two(double a, double b) { return (a + b) / 2; }

/* Computes what each side of the triangles of walls sees: spheres and surroundings. */
static int bed_views(struct bed_request *request, const struct bed *bed, fibrad_bed *made, struct side_arrays *views) {
    enum { TO_SPHERES, OUT, QUANTITIES };
    static const struct side_quantity quantity[QUANTITIES] = {
        [TO_SPHERES] = {.name = {"F_spheres", "F_spheres_front", "F_spheres_back"}, .join = mean_of_two},
        [OUT] = {.name = {"F_surroundings", "F_surroundings_front", "F_surroundings_back"}, .join = mean_of_two}};
    const struct fibrad_triangles *triangles = &request->walls.meshes->triangles;
    const uint32_t sides = 2 * triangles->n;
    fibrad_fault fault;
    fibrad_side_view *view = malloc(sides * sizeof *view);
    int status = view ? side_arrays_begin(views, triangles, quantity, QUANTITIES) : message_memory();
    if (!status) {
        status = fibrad_bed_views(made, view_rays(sides), view);
        fibrad_bed_describe(made, NULL, &fault);
        status = bed_options_status(&request->bed, bed, status, &fault);
    }
    for (uint32_t s = 0; s < sides && !status; ++s) {
        views->quantity[TO_SPHERES].side[s] = view[s].spheres;
        views->quantity[OUT].side[s] = view[s].escaped;
    }
    if (!status) side_arrays_show(views);
    free(view);
    return status;
}

/* Computes the matrix of one frame and writes it to all outputs. */
static int bed_matrix(struct bed_request *request, struct bed *bed) {
    fibrad_bed *made;
    fibrad_bed_matrix *factors = NULL;
    struct contents what = {.wanted = request->options.wanted, .walls = &request->walls};
    struct side_arrays views = {0};
    struct summary summary;
    int status = bed_options_make(&request->bed, bed, &request->walls, &made);
    if (!status) status = bed_options_factors(&request->bed, bed, &request->walls, made, &request->options, &factors);
    if (status) {
        fibrad_bed_free(made);
        return status;
    }
    what.factors = factors;
    summary_make(&summary, &what);
    what.of_sides = &views;
    if (request->bed.wall_vtp) status = bed_views(request, bed, made, &views);
    if (!status) status = bed_options_write(&request->bed, bed, &what);
    if (!status && request->bed.outputs.picture)
        status = plot_bed(&request->bed.picture, request->bed.name, &what, &request->bed.slice);
    if (!status) bed_report(request, &what, &summary);
    side_arrays_free(&views);
    fibrad_bed_matrix_free(factors);
    fibrad_bed_free(made);
    return status;
}

static int bed_frame(void *bed_request, struct bed *bed) {
    struct bed_request *request = bed_request;
    const bool periodic = bed->period[0] > 0 || bed->period[1] > 0 || bed->period[2] > 0;
    if (request->methods.method == METHOD_SURFACE && request->cutoff == 0 && periodic)
        return message(STATUS_USAGE, "--method surface needs a --cutoff in a periodic box");
    int status = bed_options_walls(&request->bed, bed, &request->walls);
    if (status) return status;
    if (request->methods.method == METHOD_SURFACE && request->walls.count + request->walls.openings > 0)
        return message(STATUS_USAGE, "--wall is for the methods beam, cast and mc");
    unsigned char *marks = NULL;
    if (request->targets) {
        char where[600];
        snprintf(where, sizeof where, "frame %lld of %.560s", (long long)bed->frame, request->bed.name);
        marks = calloc(bed->n, 1);
        status =
            marks ? targets_mark(request->targets, bed->ids ? bed->id : NULL, bed->n, where, marks) : message_memory();
    }
    request->options.wanted = marks;
    if (!status) status = bed_matrix(request, bed);
    free(marks);
    return status;
}

int command_bed(int argc, char **argv) {
    struct bed_request request;
    const int status = bed_parse(&request, argc, argv);
    return bed_options_end(&request.bed, status, bed_help, bed_frame, &request);
}
