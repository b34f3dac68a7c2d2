/* command_factors.c - `fibrad factors`: view factors, or exchange factors of grey spheres. SPDX-License-Identifier: MIT
 */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/targets.h"
#include "command/commands.h"
#include "frames/solid_option.h"
#include "plot/plot_bed.h"
#include "simple/bed.h"

/* Methods of view factors by name, in the order of the enum. */
enum method { METHOD_BEAM, METHOD_CAST, METHOD_MC, METHODS };
static const char *const method_names[METHODS] = {"beam", "cast", "mc"};

struct factors_request {
    struct bed_options bed;
    const char *targets;
    enum method method;
    fibrad_beam_rule beam; /* 0: not given */
    fibrad_cast_rule cast;
    const char *areas, *seed; /* NULL: not given */
    double cutoff, error;     /* 0: none */
    struct quantity emissivity, solid, temperature;
    double zero; /* 0 of the unit of temperature [K] */
    bool raw;
    struct walls walls;
    fibrad_exchange_rule rule; /* of exchange factors */
    fibrad_bed_rule options;
};

static int take_method(const char *text, void *method) {
    for (int k = 0; k < METHODS; ++k)
        if (strcmp(text, method_names[k]) == 0) {
            *(enum method *)method = (enum method)k;
            return STATUS_OK;
        }
    return message(STATUS_USAGE, "--method: '%.40s' is none of beam, cast and mc; fibrad pair has exact and surface",
                   text);
}

/* Takes the argument of --targets, unless it is `all`. */
static int take_targets(const char *text, void *targets) {
    const bool all = strcmp(text, "all") == 0;
    *(const char **)targets = all ? NULL : text;
    return all ? STATUS_OK : targets_mark(text, NULL, 0, "", NULL);
}

#define LINES_USED    TEXT_OF(FIBRAD_LINES_DEFAULT) " lines, " TEXT_OF(FIBRAD_LINES_AMONG_WALLS) " among walls"
#define EXCHANGE_USED TEXT_OF(FIBRAD_EXCHANGE_DIRECTIONS_DEFAULT)

static const struct option factors_table[] = {
    {OPTION_EMISSIVITY(struct factors_request, emissivity)},
    {OPTION_WALL},
    {0, "error", "E",
     "error allowed in every row, estimated, 1e-7 to 1; directions and rays are added until it is met; exchange "
     "factors from 1e-5 on [none]",
     TO_NUMBER(struct factors_request, error, 1e-7, 1)},
    {0, "method", "NAME", "beam (parallel beams), cast (quasi-random rays) or mc (random rays) [beam]",
     TO_FUNCTION(take_method, struct factors_request, method)},
    {0, "cutoff", "D", "spheres with centres farther apart than D do not see each other [none]",
     TO_NUMBER(struct factors_request, cutoff, FIBRAD_LENGTH_MIN, FIBRAD_LENGTH_MAX)},
    {0, "targets", "LIST", "rows that are wanted, 3,7,10-19 for example; a list implies --raw [all]",
     TO_FUNCTION(take_targets, struct factors_request, targets)},
    {0, "raw", NULL, "leave the rows as they were computed [averaged and closed: A_i e_i D_ij = A_j e_j D_ji]",
     TO_FLAG(struct factors_request, raw)},
    {0, "drop", "D", "drop pairs of entries if both are below D, and enlarge the others; rows stay closed [0]",
     TO_NUMBER(struct factors_request, options.drop, 0, 1)},
    {OPTION_CLUMP},
    {OPTION_SOLID_CONDUCTIVITY(struct factors_request, solid)},
    {0, "temperature", "T",
     "mean temperatures of the spheres, for --solid-conductivity; a number, or TYPE:T,..., or a column of the file",
     TO_FUNCTION(temperature_option, struct factors_request, temperature)},
    OPTIONS_INPUT,
    {OPTION_BED_OUTPUT("write the matrix (.csv .mtx .npz .json, - for standard output) or the "
                       "spheres (.vtp) [summary only]")},
    {OPTION_PLOT("draw a picture by gnuplot, .svg or .png [none]")},
    OPTIONS_RUN,
    OPTIONS_RARE,
    {0, "directions", "N",
     "beam: number of directions, " TEXT_DIRECTIONS
     "; if all rows are computed, number of lines, which are directions and their opposites; the error falls as "
     "N^-1.5 [" TEXT_OF(FIBRAD_DIRECTIONS_DEFAULT) " directions; " LINES_USED
                                                   ", more for few spheres; exchange factors " EXCHANGE_USED
                                                   " directions]",
     TO_COUNT(struct factors_request, beam.directions, FIBRAD_DIRECTIONS_MIN, FIBRAD_DIRECTIONS_MAX)},
    {0, "areas", "KIND", "beam: visible areas, exact or points [exact; along lines points, up to 724 lines]",
     TO_TEXT(struct factors_request, areas)},
    {0, "points", "M",
     "beam: rays along each direction, 64, 128 or 256; along lines masks of 16, 32 or 64 chords; implies --areas "
     "points [256]",
     TO_FUNCTION(option_points, struct factors_request, beam.points)},
    {0, "rays", "N",
     "cast, mc: rays from a sphere; the error falls as N^-0.6 (cast) or N^-0.5 (mc) [" TEXT_OF(
         FIBRAD_RAYS_DEFAULT) "; exchange factors 400 paths]",
     TO_COUNT(struct factors_request, cast.rays, 1, UINT32_MAX)},
    {0, "seed", "S", "cast, mc, and exchange factors: seed of the rays [0]", TO_TEXT(struct factors_request, seed)},
    {OPTION_TEMPERATURE_UNIT(struct factors_request, zero)},
    {OPTION_WALL_VTP},
    OPTIONS_INPUT_RARE,
    {OPTION_BED_FORMAT},
    {OPTION_SLICE},
    {OPTION_SCRATCH},
    {.name = NULL}};

static int factors_help(void) {
    options_help(
        "factors",
        "fibrad factors FILE... [options]\n\n"
        "View factors between all spheres of FILE. F_ij is the fraction of what sphere i sends out that meets\n"
        "sphere j first. With --emissivity exchange factors: the spheres are grey and diffuse, and D_ij is the\n"
        "fraction that sphere j absorbs, directly or after reflections.\n",
        factors_table,
        (const char *const[]){
            FILES_MORE, WALLS_MORE WALLS_OF_EMISSIVITY,
            "In .csv the surroundings are j = -1 and walls are j = -2, -3, ... with their names in the column `body`, "
            "so\n"
            "that rows add up to 1. Rows i = -2, -3, ... are those of walls that are not endless. With --targets or\n"
            "--cutoff there are no such rows. .vtp has an array for each wall. .mtx has spheres only. `beyond` is the\n"
            "fraction that leaves the cutoff and whose end is not followed.\n",
            "With --emissivity the net power of sphere i is the sum over j of A_i e_i D_ij sigma (T_j^4 - T_i^4), "
            "with\n"
            "A_i = 4 pi r_i^2 in square metres and T in kelvins. A sphere of emissivity 0 reflects everything. It has "
            "no\n"
            "row and no column. --rays and --seed are then those of paths.\n",
            "--clump: A clump is one body: its spheres may lie within one another, and what they hide of each other\n"
            "is no surface. It has one row and one column, by the number of the clump; F_ii is what it sends to\n"
            "itself. `A_i` is the area that is exposed. If a sphere that is alone has such a number for its id, "
            "clumps\n"
            "have the ids of their first spheres.\n",
            "--solid-conductivity: Temperatures differ from point to point of each sphere. Then n_i takes the place "
            "of\n"
            "e_i (`node_emissivity` in .npz and .json), and N_i takes the place of sigma T_i^4. The net power q_i of\n"
            "sphere i is the sum over j of A_i n_i D_ij (N_j - N_i), with N_i = sigma T_i^4 - (1/n_i - 1/e_i) "
            "q_i/A_i.\n"
            "So the powers follow from a linear system. Walls and surroundings have N = sigma T^4. The factors are "
            "for\n"
            "k* = k_s/(4 d sigma T^3) at --temperature, whatever temperatures they are used with.\n",
            "Several frames go into one .csv or .json with their numbers. If OUT has a *, each frame has a file.\n"
            "Standard output ends with a summary of each frame, one `key value` on a line. `wall_NAME_F` is the mean\n"
            "over spheres.\n",
            NULL},
        "Examples:\n"
        "  fibrad factors packing.dump --error 0.001 -o F.mtx --plot bed.png\n"
        "  fibrad factors packing.dump --emissivity 1:0.8,2:0.3 --wall auto:emissivity=0.9 -o D.csv\n"
        "  fibrad factors spheres.csv --periodic 12,12,0 --wall zmin:at=0 -o F.csv\n"
        "  fibrad factors pebbles.csv --length-unit m --emissivity 0.8 --temperature T --solid-conductivity 30\n"
        "  fibrad factors settled.dump --clump id_multisphere -o F.npz\n"
        "  fibrad factors packing.dump.gz --frame all -o 'F.*.npz'\n");
    return STATUS_OK;
}

/* Chooses the rule of view factors. Refuses options of other methods and of exchange factors. */
static int choose_view(struct factors_request *request) {
    const char *areas = request->areas;
    fibrad_beam_rule *beam = &request->beam;
    fibrad_cast_rule *cast = &request->cast;
    const bool exact = areas && strcmp(areas, "exact") == 0, points = areas && strcmp(areas, "points") == 0;
    const bool beams = request->method == METHOD_BEAM;
    if (request->solid.given || request->temperature.given || walls_keys(&request->bed.walls) & WALL_EMISSIVITY)
        return message(STATUS_USAGE, "%s needs --emissivity",
                       request->solid.given         ? "--solid-conductivity"
                       : request->temperature.given ? "--temperature"
                                                    : "--wall: emissivity");
    if (request->error > 0 && !beams) return message(STATUS_USAGE, "--error is for --method beam");
    if (request->error > 0 && beam->directions > 0)
        return message(STATUS_USAGE, "--error chooses the directions; leave out --directions");
    if (areas && !exact && !points) return message(STATUS_USAGE, "--areas: '%.40s' is neither exact nor points", areas);
    if ((beam->directions || beam->points || areas) && !beams)
        return message(STATUS_USAGE, "--directions, --areas and --points are for --method beam");
    if ((cast->rays || request->seed) && beams)
        return message(STATUS_USAGE, "--rays and --seed are for --method cast and mc");
    if (exact && beam->points) return message(STATUS_USAGE, "--points contradicts --areas exact");
    if (exact) beam->chords = FIBRAD_CHORDS_NONE;
    if (points && !beam->points) beam->points = 256;
    if (!cast->rays) cast->rays = FIBRAD_RAYS_DEFAULT;
    cast->random = request->method == METHOD_MC;
    beam->tolerance = request->error;
    beam->cutoff = cast->cutoff = request->cutoff;
    request->options.cast = beams ? NULL : cast;
    request->options.beam = beams ? beam : NULL;
    return request->seed ? options_whole("--seed", request->seed, 0, UINT64_MAX, &cast->seed) : STATUS_OK;
}

/* The same for exchange factors. */
static int choose_exchange(struct factors_request *request) {
    fibrad_exchange_rule *rule = &request->rule;
    *rule = (fibrad_exchange_rule){
        .paths = request->cast.rays, .directions = request->beam.directions, .tolerance = request->error};
    request->options.exchange = rule;
    if (request->method != METHOD_BEAM || request->areas || request->beam.points || request->cutoff > 0)
        return message(STATUS_USAGE,
                       "--method, --areas, --points and --cutoff are for view factors; leave them out, or "
                       "--emissivity");
    if (rule->paths > FIBRAD_PATHS_MAX)
        return message(STATUS_USAGE, "--rays: %" PRIu32 " is above %d, the most for exchange factors", rule->paths,
                       FIBRAD_PATHS_MAX);
    if (request->error > 0 && request->error < 1e-5)
        return message(STATUS_USAGE, "--error: %g is not within 1e-05 and 1, as for exchange factors", request->error);
    if (request->error > 0 && (rule->paths > 0 || rule->directions > 0))
        return message(STATUS_USAGE, "--error chooses rays and directions; leave out --rays and --directions");
    if (request->solid.given != request->temperature.given)
        return message(STATUS_USAGE, "--solid-conductivity and --temperature need each other; %s is missing",
                       request->solid.given ? "--temperature" : "--solid-conductivity");
    return request->seed ? options_whole("--seed", request->seed, 0, UINT64_MAX, &rule->seed) : STATUS_OK;
}

/* Checks that need no computation. */
static int factors_check(struct factors_request *request) {
    bed_options_quantity(&request->bed, &request->emissivity, NULL);
    bed_options_quantity(&request->bed, &request->solid, SOLID_UNIT);
    bed_options_quantity(&request->bed, &request->temperature, temperature_unit(request->zero));
    const int status = bed_options_check(&request->bed, "factors", CONTENT_MATRIX);
    if (status) return status;
    request->options.raw = request->raw || request->targets;
    if (request->bed.clump.given && (request->emissivity.given || request->targets))
        return message(STATUS_USAGE,
                       request->targets ? "--targets: rows of clumps are computed all together; leave it out"
                                        : "--emissivity: exchange factors of clumps are not computed; leave it out, or "
                                          "use fibrad heat");
    if (request->options.drop > 0 && request->options.raw)
        return message(STATUS_USAGE, "--drop needs rows that are averaged, not --raw or --targets");
    return request->emissivity.given ? choose_exchange(request) : choose_view(request);
}

/* Powers by factors of nodes may err far more than rows: a node of emissivity n exchanges little of what the sphere
 * does, and what it exchanges follows from small differences. Let x be the part of a row that goes to walls and
 * surroundings, and m = n/e. Errors of powers, over their root mean square, turned out to be those of rows times
 * sqrt(1/(m (m + (1 - m) x))), if temperatures differ from sphere to sphere. docs/methods.md section 27. */
static double power_error(const struct factors_request *request, const fibrad_factors *matrix) {
    const double *surface = request->rule.emissivity, *node = request->rule.node_emissivity;
    double square = 0;
    uint32_t rows = 0;
    for (uint32_t i = 0; i < matrix->n; ++i) {
        double spheres = 0;
        for (uint64_t k = matrix->start[i]; k < matrix->start[i + 1]; ++k) spheres += matrix->f[k];
        const double m = surface[i] > 0 ? node[i] / surface[i] : 0, x = fmax(0, 1 - spheres);
        if (m > 0) square += matrix->error[i] * matrix->error[i] / (m * (m + (1 - m) * x)), ++rows;
    }
    return rows > 0 ? sqrt(square / rows) : 0;
}

#define POWERS_WRONG .03 /* error of powers above which there is a warning */

/* Reports conductivities of the solid, emissivities of nodes, and the error of powers that follow from them. */
static void report_solid(struct factors_request *request, const fibrad_factors *matrix) {
    const uint32_t n = matrix->n;
    const double error = power_error(request, matrix);
    const double *relative = request->rule.conductivity, *node = request->rule.node_emissivity;
    struct report *report = &request->bed.report;
    struct k_star all = {0};
    double mean_node = 0;
    for (uint32_t i = 0; i < n; ++i) k_star_add(&all, relative[i]), mean_node += node[i] / n;
    quantity_report(&request->temperature, request->zero > 0 ? "temperature_C" : "temperature_K", report);
    solid_report(&request->solid, &all, report);
    report_value(report, "node_emissivity", mean_node, 6);
    report_value(report, "error_of_powers", error, 2);
    if (error > POWERS_WRONG)
        message_at(
            STATUS_OK, request->bed.name, 0,
            "warning: powers by these factors are off by about %.2g of their root mean square, since the spheres "
            "conduct badly; a smaller --error helps, or heat --solid-conductivity",
            error);
}

static void report_exchange(struct factors_request *request, const struct contents *what) {
    struct report *report = &request->bed.report;
    quantity_report(&request->emissivity, "emissivity", report);
    wall_values_report(what->walls, request->rule.wall_emissivity, "_emissivity", 6, report);
    if (request->solid.given) report_solid(request, &what->factors->matrix);
    report_count(report, "directions", what->factors->directions);
    report_count(report, "rays", what->factors->rays);
    report_count(report, "seed", request->rule.seed);
}

static void report_view(struct factors_request *request, const struct contents *what) {
    const bool beam = request->method == METHOD_BEAM;
    struct report *report = &request->bed.report;
    report_text(report, "method", method_names[request->method]);
    report_count(report, beam ? "directions" : "rays", beam ? what->factors->directions : request->cast.rays);
    if (request->beam.points > 0) report_count(report, "points", request->beam.points);
    if (request->cutoff > 0) report_value(report, "cutoff", request->cutoff, 9);
}

static void factors_report(struct factors_request *request, const struct bed *bed, const struct contents *what,
                           const struct summary *summary) {
    const fibrad_bed_matrix *factors = what->factors;
    struct report *report = &request->bed.report;
    bed_options_report(&request->bed, bed, what->walls, &factors->facts);
    if (what->grey)
        report_exchange(request, what);
    else
        report_view(request, what);
    if (request->error > 0)
        report_wanted(report, request->bed.name, request->error, request->error,
                      fmax(summary->error_max, summary->wall_error_max),
                      what->grey ? "the worst row" : "a row, and there are no more directions");
    report_text(report, "rows", request->options.raw ? "raw" : "reciprocal");
    report_count(report, "threads", (uint64_t)factors->threads);
    report_value(report, "seconds", factors->seconds, 3);
    summary_report(summary, what, report);
    if (request->options.beam) report_count(report, "fallbacks", factors->fallbacks);
    report_end(report);
}

/* Rays from each side of a triangle. Few sides have more rays each. */
enum { VIEW_RAYS = 256, VIEW_RAYS_MOST = 1 << 14, VIEW_RAYS_IN_ALL = 1 << 19 };

static double mean_of_two(double a, double b) { return (a + b) / 2; }

/* Computes what each side of the triangles of walls sees: spheres and surroundings. */
static int find_views(struct factors_request *request, const struct bed *bed, fibrad_bed *made,
                      struct side_arrays *views) {
    enum { TO_SPHERES, OUT, QUANTITIES };
    static const struct side_quantity quantity[QUANTITIES] = {
        [TO_SPHERES] = {.name = {"F_spheres", "F_spheres_front", "F_spheres_back"}, .join = mean_of_two},
        [OUT] = {.name = {"F_surroundings", "F_surroundings_front", "F_surroundings_back"}, .join = mean_of_two}};
    const struct fibrad_triangles *triangles = &request->walls.meshes->triangles;
    const uint32_t sides = 2 * triangles->n;
    const double rays = fmin(fmax(VIEW_RAYS_IN_ALL / sides, VIEW_RAYS), VIEW_RAYS_MOST);
    fibrad_side_view *view = malloc(sides * sizeof *view);
    int status = view ? side_arrays_begin(views, triangles, quantity, QUANTITIES) : message_memory();
    if (!status) status = bed_options_made(&request->bed, bed, made, fibrad_bed_views(made, (uint32_t)rays, view));
    for (uint32_t s = 0; s < sides && !status; ++s) {
        views->quantity[TO_SPHERES].side[s] = view[s].spheres;
        views->quantity[OUT].side[s] = view[s].escaped;
    }
    if (!status) side_arrays_show(views);
    free(view);
    return status;
}

/* Computes the matrix of one frame and writes it to all outputs. */
static int write_matrix(struct factors_request *request, struct bed *bed) {
    fibrad_bed *made;
    fibrad_bed_matrix *factors = NULL;
    struct side_arrays views = {0};
    struct summary summary;
    struct bed bodies = {0};
    int status = bed_options_make(&request->bed, bed, &request->walls, &made);
    if (!status) status = bed_options_factors(&request->bed, bed, &request->walls, made, &request->options, &factors);
    if (!status && request->bed.wall_vtp && !request->emissivity.given) status = find_views(request, bed, made, &views);
    const bool clumps = factors && factors->body;
    struct contents what = {.bed = bed, .factors = factors, .walls = &request->walls, .of_sides = &views};
    what.wanted = request->options.wanted, what.grey = request->options.exchange;
    if (!status && clumps) status = bed_bodies(bed, factors->matrix.n, factors->body, factors->area, &bodies);
    const struct array exposed = {"area.npy", "f8", clumps ? factors->area : NULL, bodies.n, 0};
    what.array = &exposed, what.arrays = clumps;
    if (!status) status = bed_options_write(&request->bed, clumps ? &bodies : bed, &what);
    if (!status && request->bed.outputs.picture)
        status = plot_bed(&request->bed.picture, request->bed.name, &what, &request->bed.slice);
    if (!status) {
        summary_make(&summary, &what);
        factors_report(request, bed, &what, &summary);
    }
    bed_free(&bodies);
    side_arrays_free(&views);
    fibrad_bed_matrix_free(factors);
    fibrad_bed_free(made);
    return status;
}

/* With --solid-conductivity finds k* and the emissivity of the node of each sphere, *relative [2 n]. Free it also after
 * an error. */
static int find_nodes(struct factors_request *request, struct bed *bed, double **relative) {
    fibrad_exchange_rule *rule = &request->rule;
    double *temperature = NULL;
    if (!request->solid.given) return STATUS_OK;
    double *node = (*relative = malloc(2 * bed->n * sizeof **relative)) ? *relative + bed->n : NULL;
    int status = node ? STATUS_OK : message_memory();
    if (!status)
        status = quantity_values(&request->temperature, bed, request->bed.name, "temperature in kelvins", request->zero,
                                 0, TEMPERATURE_MAX, &temperature);
    if (!status) status = bed_options_metres(&request->bed, bed, SOLID_NEEDS);
    if (!status) status = solid_relative(&request->bed, bed, &request->solid, temperature, *relative);
    for (uint32_t i = 0; i < bed->n && !status; ++i)
        node[i] = fibrad_node_emissivity(rule->emissivity[i], (*relative)[i]);
    rule->conductivity = *relative, rule->node_emissivity = node;
    free(temperature);
    return status;
}

/* Finds the emissivities, if there are any. */
static int find_grey(struct factors_request *request, struct bed *bed, double **emissivity, double *wall_emissivity,
                     double **relative) {
    if (!request->emissivity.given) return STATUS_OK;
    const int status = quantity_values(&request->emissivity, bed, request->bed.name, "emissivity", 0, 0, 1, emissivity);
    for (uint32_t k = 0; k < request->walls.count; ++k) wall_emissivity[k] = request->walls.said[k].emissivity;
    request->rule.emissivity = *emissivity, request->rule.wall_emissivity = wall_emissivity;
    return status ? status : find_nodes(request, bed, relative);
}

static int factors_frame(void *factors_request, struct bed *bed) {
    struct factors_request *request = factors_request;
    double *emissivity = NULL, *relative = NULL, wall_emissivity[WALLS_MAX];
    unsigned char *marks = NULL;
    int status = bed_options_walls(&request->bed, bed, &request->walls);
    if (!status) status = find_grey(request, bed, &emissivity, wall_emissivity, &relative);
    if (!status && request->targets) {
        char where[600];
        snprintf(where, sizeof where, "frame %lld of %.560s", (long long)bed->frame, request->bed.name);
        marks = calloc(bed->n, 1);
        status =
            marks ? targets_mark(request->targets, bed->ids ? bed->id : NULL, bed->n, where, marks) : message_memory();
    }
    request->options.wanted = marks;
    if (!status) status = write_matrix(request, bed);
    free(marks);
    free(emissivity);
    free(relative);
    return status;
}

int command_factors(int argc, char **argv) {
    struct factors_request request = {.bed.walls.keys = WALL_EMISSIVITY};
    int status = options_read("factors", factors_table, argc, argv, &request);
    if (!status) status = factors_check(&request);
    const int ended = bed_options_end(&request.bed, status, factors_help, factors_frame, &request);
    quantity_free(&request.solid);
    return ended;
}
