/* command_bed.c - `fibrad bed`: view factors of all spheres of a file. SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bed/bed_scene.h"
#include "cli/message.h"
#include "cli/output.h"
#include "cli/targets.h"
#include "command/bed_options.h"
#include "command/commands.h"
#include "plot/plot_bed.h"
#include "write/write.h"

enum { KEY_CUTOFF = KEY_OWN, KEY_TARGETS };

static const struct option bed_table[] = {
    {KEY_METHOD, "method", "NAME",
     "beam: along Fibonacci directions; surface: between nodes; cast: quasi-random rays; mc: random rays [beam]"},
    {KEY_DIRECTIONS, "directions", "N", "beam: directions, 8 to 65536; error ~ N^-1.5 [233]"},
    {KEY_AREAS, "areas", "KIND", "beam: visible areas exact, or by points (faster, less accurate) [exact]"},
    {KEY_ERROR, "error", "E",
     "beam: as many directions as bring the estimated Euclidean error of every row to E or less, 1e-7 to 1 [none]"},
    {KEY_POINTS, "points", "M", "beam: points per window: 64, 128 or 256; implies --areas points [256]"},
    {KEY_NF, "nf", "N", "surface: nodes, a Fibonacci number from 8 to 987 [55]"},
    {KEY_NO_CORRECTION, "no-correction", NULL, "surface: the plain sums [corrected by the exact unblocked factor]"},
    {KEY_RAYS, "rays", "N", "cast, mc: rays from each sphere; error ~ N^-0.6, N^-0.5 [20000]"},
    {KEY_SEED, "seed", "S", "cast, mc: another number, other rays [0]"},
    {KEY_CUTOFF, "cutoff", "D", "spheres with centres farther apart than D do not see each other [none]"},
    {KEY_TARGETS, "targets", "LIST", "rows wanted, such as 3,7,10-19, or all; a list implies --raw [all]"},
    {KEY_RAW, "raw", NULL, "do not average F_ij and F_ji [averaged: A_i F_ij = A_j F_ji]"},
    {OPTION_PERIODIC},
    {OPTION_WALL},
    {OPTION_FRAME},
    {OPTION_THREADS},
    {'o', "output", "OUT", "the matrix: .csv, .mtx, .npz (SciPy); the spheres: .vtp [summary only]"},
    {OPTION_FORMAT},
    {OPTION_IDS},
    {KEY_PLOT, "plot", "OUT", "a picture, .svg or .png, by gnuplot [none]"},
    {OPTION_PROGRESS},
    {OPTION_HELP},
    {0, NULL, NULL, NULL}};

struct bed_request {
    struct bed_options bed;
    const char *plot, *targets;
    enum method method;
    struct beam_options beam;
    fibrad_beam_rule beam_rule;
    fibrad_surface_rule surface;
    fibrad_cast_rule cast;
    double cutoff, error; /* 0: none */
    bool beam_given, surface_given, cast_given;
    struct walls walls;
    fibrad_bed_options options;
};

static int bed_help(void) {
    puts("fibrad bed FILE [options]\n\n"
         "View factors between all spheres of FILE: .csv with a header x,y,z,r, a LAMMPS or LIGGGHTS text dump,\n"
         "YADE text (#format x_y_z_r), or - for standard input. Positions count from 0 in the order of the file.\n");
    options_print(bed_table);
    puts("\n" WALLS_MORE
         "F to a wall is what arrives there directly. In .csv walls are j = -2, -3 ... in the order given and the\n"
         "surroundings j = -1, so that rows add up to 1; i = -2, -3 ... from walls of finite area to spheres; in .vtp "
         "an\n"
         "array for each wall. .mtx and .npz hold spheres only. What leaves a --cutoff is beyond: after the walls in\n"
         ".csv, `beyond_mean` in the summary.\n\n"
         "Standard output ends with a summary, one `key value` a line; `wall_NAME`: mean F from a sphere, area.\n\n"
         "Examples:\n"
         "  fibrad bed packing.dump -o F.mtx --plot bed.png\n"
         "  fibrad bed packing.dump --error 0.001 -o F.mtx\n"
         "  fibrad bed spheres.csv --directions 987 --periodic 12,12,0 -o F.csv\n"
         "  fibrad bed packing.dump --wall auto -o F.csv\n"
         "  fibrad bed spheres.csv --wall cylinder:0,0,25,zmin=0 -o F.csv\n"
         "  fibrad bed packing.dump --method cast --rays 200000 -o F.csv\n"
         "  fibrad bed packing.dump --frame 3 --targets 0,7,100-199 -o rows.csv\n"
         "  zcat packing.dump.gz | fibrad bed - --points 128 -o bed.vtp");
    return STATUS_OK;
}

static int bed_take(struct bed_request *request, const struct options *options, int key) {
    const char *value = options->value;
    int status = STATUS_OK;
    switch (key) {
    case KEY_METHOD:
        status = options_method(value, &request->method);
        if (!status && request->method == METHOD_EXACT)
            status = message(STATUS_USAGE, "--method %s is for pairs only", value);
        break;
    case KEY_DIRECTIONS:
    case KEY_AREAS:
    case KEY_POINTS:
        request->beam_given = true;
        return options_beam(key, value, &request->beam);
    case KEY_NF:
    case KEY_NO_CORRECTION:
        request->surface_given = true;
        return options_surface(key, value, &request->surface);
    case KEY_RAYS:
    case KEY_SEED:
        request->cast_given = true;
        return options_cast(key, value, &request->cast);
    case KEY_CUTOFF:
        return options_number("--cutoff", value, 1e-150, 1e150, &request->cutoff);
    case KEY_ERROR:
        return options_number("--error", value, 1e-7, 1, &request->error);
    case KEY_TARGETS:
        request->targets = strcmp(value, "all") == 0 ? NULL : value;
        if (request->targets) status = targets_mark(value, 0, NULL);
        break;
    case KEY_RAW:
        request->options.raw = 1;
        break;
    case KEY_PLOT:
        request->plot = value;
        break;
    default:
        return bed_options_take(&request->bed, options, key);
    }
    return status;
}

/* The rule of the method; options of other methods are refused. */
static int bed_choose(struct bed_request *request) {
    fibrad_beam_rule *beam = &request->beam_rule;
    if (request->beam_given && request->method != METHOD_BEAM)
        return message(STATUS_USAGE, "--directions, --areas and --points are for --method beam");
    if (request->error > 0 && request->method != METHOD_BEAM)
        return message(STATUS_USAGE, "--error is for --method beam");
    if (request->error > 0 && request->beam.directions > 0)
        return message(STATUS_USAGE, "--error finds the directions itself; leave out --directions");
    if (request->surface_given && request->method != METHOD_SURFACE)
        return message(STATUS_USAGE, "--nf and --no-correction are for --method surface");
    if (request->cast_given && request->method != METHOD_CAST && request->method != METHOD_MC)
        return message(STATUS_USAGE, "--rays and --seed are for --method cast and mc");
    beam->cutoff = request->surface.cutoff = request->cast.cutoff = request->cutoff;
    request->cast.random = request->method == METHOD_MC;
    if (request->method == METHOD_SURFACE)
        request->options.surface = &request->surface;
    else if (request->method != METHOD_BEAM)
        request->options.cast = &request->cast;
    else
        request->options.beam = beam;
    const int status = options_beam_rule(&request->beam, beam);
    beam->tolerance = request->error;
    if (request->error > 0) beam->directions = 0; /* as many as it takes */
    return status;
}

/* What can be found wrong before any work is done. */
static int bed_check(struct bed_request *request) {
    if (!request->bed.file) return message(STATUS_USAGE, "which FILE? see fibrad bed --help");
    const int status = bed_options_output(&request->bed, CONTENT_MATRIX);
    if (status) return status;
    if (request->plot && !plot_ending(request->plot))
        return message_at(STATUS_USAGE, request->plot, 0, "unknown ending; there are .svg and .png");
    if (request->targets) request->options.raw = 1;
    return bed_choose(request);
}

static int bed_parse(struct bed_request *request, int argc, char **argv) {
    struct options options = {.command = "bed", .table = bed_table, .argc = argc, .argv = argv};
    *request = (struct bed_request){.method = METHOD_BEAM, .surface.nodes = 55, .cast.rays = 20000, .bed.frame = -1};
    int status = STATUS_OK;
    for (int key; !status && (key = options_next(&options)) != OPTIONS_END;) status = bed_take(request, &options, key);
    return status ? status : bed_check(request);
}

static void warn_of_overlap(const char *file, const struct bed *bed, const fibrad_scene_facts *facts) {
    if (facts->overlap_max == 0) return;
    const uint64_t line[2] = {bed->line[facts->overlap_pair[0]], bed->line[facts->overlap_pair[1]]};
    fprintf(stderr, "fibrad: %s: largest overlap %.3g of a radius, lines %" PRIu64 " and %" PRIu64 "%s\n", file,
            facts->overlap_max, line[0], line[1], facts->overlap_max > 0.05 ? ": warning: above 5 %" : "");
}

static void bed_print(const struct bed_request *request, const struct contents *what, const struct summary *summary) {
    const fibrad_bed_factors *factors = what->factors;
    const fibrad_scene_facts *facts = &factors->facts;
    printf("%s: radii %g to %g, %s rows, %s\n", request->bed.name, facts->radius_min, facts->radius_max,
           request->options.raw ? "raw" : "reciprocal", fibrad_isa_name(facts->isa));
    printf("spheres %" PRIu32 "\n", facts->spheres);
    printf("nonzeros %" PRIu64 "\n", factors->matrix.start[facts->spheres]);
    if (request->method == METHOD_BEAM)
        printf("directions %" PRIu32 "\n", factors->directions);
    else if (request->method == METHOD_SURFACE)
        printf("nf %" PRIu32 "\n", request->surface.nodes);
    else
        printf("rays %" PRIu32 "\n", request->cast.rays);
    printf("threads %d\n", factors->threads);
    printf("seconds %.17g\n", factors->seconds);
    printf("row_sum_min %.17g\n", summary->row_sum_min);
    printf("row_sum_max %.17g\n", summary->row_sum_max);
    printf("escaped_mean %.17g\n", summary->escaped_mean);
    if (request->cutoff > 0) printf("beyond_mean %.17g\n", summary->beyond_mean);
    printf("closure_max %.17g\n", factors->closure_error);
    printf("reciprocity_max %.17g\n", factors->reciprocity_error);
    printf("error_estimate %.17g\n", summary->error_max);
    summary_print_walls(summary, what);
    printf("fallbacks %" PRIu64 "\n", factors->fallbacks);
}

static int bed_compute(struct bed_request *request, const struct bed *bed, fibrad_bed_factors **factors) {
    const fibrad_scene_config scene = bed_scene(bed, &request->walls);
    const fibrad_spheres spheres = bed_spheres(bed);
    fibrad_run run = bed_options_run(&request->bed);
    const int status = fibrad_view_factors(&scene, &spheres, &request->options, &run, factors);
    return bed_options_status(&request->bed, bed, status, &run.fault);
}

/* Opens the outputs before the work, so that a path that cannot be written costs no time. */
static int bed_write(struct bed_request *request, struct contents *what, fibrad_bed_factors **factors) {
    struct outputs *out = &request->bed.outputs;
    struct output plot = {0};
    struct summary summary = {0};
    int status = outputs_open(out);
    if (!status) status = output_open(&plot, request->plot);
    if (!status) status = bed_compute(request, what->bed, factors);
    if (!status) {
        what->factors = *factors;
        summary_make(&summary, what);
        warn_of_overlap(request->bed.name, what->bed, &what->factors->facts);
    }
    if (!status && request->error > 0 && summary.error_max > request->error)
        fprintf(stderr, "fibrad: %s: warning: %d directions were not enough for --error %g\n", request->bed.name,
                FIBRAD_DIRECTIONS_MAX, request->error);
    if (!status) status = outputs_write(out, what, what->bed->frame);
    if (!status && request->plot) status = plot_bed(&plot, request->bed.file, what);
    status = outputs_close(out, status);
    status = output_close(&plot, status);
    if (!status) bed_print(request, what, &summary);
    return status;
}

static int bed_run(struct bed_request *request, struct bed *bed, fibrad_bed_factors **factors) {
    int status = bed_options_read(&request->bed, bed);
    if (status) return status;
    if (request->method == METHOD_SURFACE && request->cutoff == 0 &&
        (bed->period[0] > 0 || bed->period[1] > 0 || bed->period[2] > 0))
        return message(STATUS_USAGE, "--method surface needs a --cutoff in a periodic box");
    status = walls_of(&request->bed.walls, bed, request->bed.name, &request->walls);
    if (status) return status;
    if (request->method == METHOD_SURFACE && request->walls.count > 0)
        return message(STATUS_USAGE, "--wall is for the methods beam, cast and mc");
    unsigned char *marks = NULL;
    if (request->targets) {
        marks = calloc(bed->n, 1);
        status = marks ? targets_mark(request->targets, bed->n, marks) : message_memory();
    }
    request->options.wanted = marks;
    struct contents what = {.bed = bed, .wanted = marks, .walls = &request->walls};
    if (!status) status = bed_write(request, &what, factors);
    free(marks);
    return status;
}

int command_bed(int argc, char **argv) {
    struct bed_request request;
    struct bed bed = {0};
    fibrad_bed_factors *factors = NULL;
    int status = bed_parse(&request, argc, argv);
    if (status) return status == STATUS_HELP ? bed_help() : status;
    status = bed_run(&request, &bed, &factors);
    fibrad_bed_free(factors);
    bed_free(&bed);
    return status;
}
