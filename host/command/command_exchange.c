/* command_exchange.c - `fibrad exchange`: exchange factors of grey spheres. SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "bed/bed_scene.h"
#include "bed/property_option.h"
#include "cli/message.h"
#include "cli/output.h"
#include "command/bed_options.h"
#include "command/commands.h"
#include "write/write.h"

enum { KEY_DROP = KEY_OWN };

static const struct option exchange_table[] = {
    {OPTION_EMISSIVITY},
    {KEY_RAYS, "rays", "N", "paths from each sphere; error ~ N^-0.5 [400]"},
    {KEY_DIRECTIONS, "directions", "N", "beam directions for the first leg of all paths, 8 to 65536 [50]"},
    {KEY_ERROR, "error", "E",
     "as many of both as bring the estimated Euclidean error of a row to E (of the worst to 1.3 E or so), 1e-5 to 1 "
     "[none]"},
    {OPTION_WALL},
    {OPTION_WALL_EMISSIVITY},
    {KEY_RAW, "raw", NULL, "do not average D_ij and D_ji [averaged and closed: A_i e_i D_ij = A_j e_j D_ji]"},
    {KEY_DROP, "drop", "D", "give entries below D back to the others; rows stay closed and reciprocal [0]"},
    {KEY_SEED, "seed", "S", "another number, other paths and directions [0]"},
    {OPTION_PERIODIC},
    {OPTION_FRAME},
    {OPTION_THREADS},
    {'o', "output", "OUT", "the factors: .csv, .mtx, .npz (SciPy) [summary only]"},
    {OPTION_FORMAT},
    {OPTION_IDS},
    {OPTION_PROGRESS},
    {OPTION_HELP},
    {0, NULL, NULL, NULL}};

struct exchange_request {
    struct bed_options bed;
    const char *wall_emissivity;
    struct quantity emissivity;
    struct walls walls;
    fibrad_exchange_rule rule;
    fibrad_bed_options options;
    bool counted; /* --rays or --directions was given */
};

static int exchange_help(void) {
    puts("fibrad exchange FILE --emissivity E|COLUMN [options]\n\n"
         "Exchange factors between all spheres of FILE, which are grey and diffuse: D_ij is the fraction of what "
         "sphere i\n"
         "emits that sphere j absorbs, directly or after any number of reflections. FILE as for fibrad bed.\n");
    options_print(exchange_table);
    puts("\nThe .csv holds i,j,D: spheres by position from 0, the surroundings j = -1, walls j = -2, -3 ... in the "
         "order\n"
         "given; then from walls of finite area to spheres, i = -2, -3 ... .mtx and .npz hold spheres only. Net power "
         "to i\n"
         "is sum over j of A_i e_i D_ij sigma (T_j^4 - T_i^4), A_i = 4 pi r_i^2 in metres and T in kelvins.\n"
         "Standard output ends with a summary, one `key value` a line.\n\n"
         "Examples:\n"
         "  fibrad exchange packing.dump --emissivity 0.8 --error 0.01 -o D.csv\n"
         "  fibrad exchange packing.csv --emissivity e --wall box --wall-emissivity 0.3 --rays 2000 -o D.npz");
    return STATUS_OK;
}

static int exchange_take(struct exchange_request *request, const struct options *options, int key) {
    const char *value = options->value;
    switch (key) {
    case KEY_EMISSIVITY:
        return emissivity_option(value, &request->emissivity);
    case KEY_RAYS:
        request->counted = true;
        return options_count("--rays", value, 1, FIBRAD_PATHS_MAX, &request->rule.paths);
    case KEY_DIRECTIONS:
        request->counted = true;
        return options_count("--directions", value, FIBRAD_DIRECTIONS_MIN, FIBRAD_DIRECTIONS_MAX,
                             &request->rule.directions);
    case KEY_ERROR:
        return options_number("--error", value, 1e-5, 1, &request->rule.tolerance);
    case KEY_WALL_EMISSIVITY:
        request->wall_emissivity = value;
        return STATUS_OK;
    case KEY_RAW:
        request->options.raw = 1;
        return STATUS_OK;
    case KEY_DROP:
        return options_number("--drop", value, 0, 1, &request->options.drop);
    case KEY_SEED:
        return options_whole("--seed", value, 0, UINT64_MAX, &request->rule.seed);
    default:
        return bed_options_take(&request->bed, options, key);
    }
}

static int exchange_check(struct exchange_request *request) {
    if (!request->bed.file) return message(STATUS_USAGE, "which FILE? see fibrad exchange --help");
    if (!request->emissivity.given) return message(STATUS_USAGE, "which --emissivity? see fibrad exchange --help");
    if (request->rule.tolerance > 0 && request->counted)
        return message(STATUS_USAGE, "--error finds rays and directions itself; leave out --rays and --directions");
    if (request->options.drop > 0 && request->options.raw)
        return message(STATUS_USAGE, "--drop needs rows that are averaged, not --raw");
    request->emissivity.place = bed_options_column(&request->bed, request->emissivity.column);
    return bed_options_output(&request->bed, CONTENT_MATRIX);
}

static int exchange_parse(struct exchange_request *request, int argc, char **argv) {
    struct options options = {.command = "exchange", .table = exchange_table, .argc = argc, .argv = argv};
    *request = (struct exchange_request){.bed.frame = -1};
    int status = STATUS_OK;
    for (int key; !status && (key = options_next(&options)) != OPTIONS_END;)
        status = exchange_take(request, &options, key);
    return status ? status : exchange_check(request);
}

static void exchange_print(const struct exchange_request *request, const struct contents *what) {
    const fibrad_bed_factors *factors = what->factors;
    const fibrad_scene_facts *facts = &factors->facts;
    struct summary summary;
    summary_make(&summary, what);
    printf("%s: radii %g to %g, %s rows, %s\n", request->bed.name, facts->radius_min, facts->radius_max,
           request->options.raw ? "raw" : "reciprocal", fibrad_isa_name(facts->isa));
    printf("spheres %" PRIu32 "\n", facts->spheres);
    printf("nonzeros %" PRIu64 "\n", factors->matrix.start[facts->spheres]);
    printf("directions %" PRIu32 "\n", factors->directions);
    printf("rays %" PRIu64 "\n", factors->rays);
    printf("threads %d\n", factors->threads);
    printf("seconds %.17g\n", factors->seconds);
    printf("row_sum_min %.17g\n", summary.row_sum_min);
    printf("row_sum_max %.17g\n", summary.row_sum_max);
    printf("escaped_mean %.17g\n", summary.escaped_mean);
    summary_print_walls(&summary, what);
    printf("closure_max %.17g\n", summary.closure_max);
    printf("reciprocity_max %.17g\n", factors->reciprocity_error);
    printf("error_rms %.17g\n", summary.error_rms);
    printf("error_estimate %.17g\n", summary.error_max);
}

static int exchange_solve(struct exchange_request *request, const struct bed *bed, fibrad_bed_factors **factors) {
    const fibrad_scene_config scene = bed_scene(bed, &request->walls);
    const fibrad_spheres spheres = bed_spheres(bed);
    fibrad_run run = bed_options_run(&request->bed);
    const int status = fibrad_exchange_factors(&scene, &spheres, &request->rule, &request->options, &run, factors);
    return bed_options_status(&request->bed, bed, status, &run.fault);
}

static int exchange_write(struct exchange_request *request, const struct bed *bed) {
    struct outputs *out = &request->bed.outputs;
    fibrad_bed_factors *factors = NULL;
    int status = outputs_open(out);
    if (!status) status = exchange_solve(request, bed, &factors);
    const struct contents what = {.bed = bed, .factors = factors, .walls = &request->walls, .grey = &request->rule};
    if (!status) status = outputs_write(out, &what, bed->frame);
    status = outputs_close(out, status);
    if (!status) exchange_print(request, &what);
    fibrad_bed_free(factors);
    return status;
}

static int exchange_run(struct exchange_request *request) {
    struct bed bed = {0};
    double *emissivity = NULL, wall_emissivity[WALLS_MAX];
    const char *file = request->bed.name;
    int status = bed_options_read(&request->bed, &bed);
    if (!status) status = walls_of(&request->bed.walls, &bed, file, &request->walls);
    if (!status) status = emissivity_walls(request->wall_emissivity, request->walls.count, wall_emissivity);
    if (!status) status = emissivity_of(&request->emissivity, &bed, file, &emissivity);
    request->rule.emissivity = emissivity;
    request->rule.body_emissivity = wall_emissivity;
    if (!status) status = exchange_write(request, &bed);
    free(emissivity);
    bed_free(&bed);
    return status;
}

int command_exchange(int argc, char **argv) {
    struct exchange_request request;
    const int status = exchange_parse(&request, argc, argv);
    if (status) return status == STATUS_HELP ? exchange_help() : status;
    return exchange_run(&request);
}
