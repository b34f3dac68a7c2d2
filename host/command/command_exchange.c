/* command_exchange.c - `fibrad exchange`: exchange factors of grey spheres. SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "bed/bed.h"
#include "bed/property_option.h"
#include "bed/wall_option.h"
#include "cli/message.h"
#include "cli/output.h"
#include "command/bed_options.h"
#include "command/commands.h"
#include "compute/exchange_rows.h"
#include "write/write.h"

enum { KEY_DROP = KEY_OWN };

static const struct option table[] = {
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
    {KEY_SEED, "seed", "S", "another number, other paths [0]"},
    {OPTION_PERIODIC},
    {OPTION_FRAME},
    {OPTION_THREADS},
    {'o', "output", "OUT", "the factors: .csv, .mtx, .npz (SciPy) [summary only]"},
    {OPTION_IDS},
    {OPTION_PROGRESS},
    {OPTION_HELP},
    {0, NULL, NULL, NULL}};

struct request {
    struct bed_options bed;
    const char *wall_emissivity;
    write_function *write;
    struct quantity emissivity;
    struct wall_order order;
    fibrad_exchange_rule rule;
    double drop;
    bool counted; /* --rays or --directions was given */
    struct run_options run;
};

static int help(void) {
    puts("fibrad exchange FILE --emissivity E|COLUMN [options]\n\n"
         "Exchange factors between all spheres of FILE, which are grey and diffuse: D_ij is the fraction of what "
         "sphere i\n"
         "emits that sphere j absorbs, directly or after any number of reflections. FILE as for fibrad bed.\n");
    options_print(table);
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

static int take_option(struct request *request, const struct options *options, int key) {
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
        return options_number("--error", value, 1e-5, 1, &request->rule.error);
    case KEY_WALL_EMISSIVITY:
        request->wall_emissivity = value;
        return STATUS_OK;
    case KEY_RAW:
        request->run.raw = true;
        return STATUS_OK;
    case KEY_DROP:
        return options_number("--drop", value, 0, 1, &request->drop);
    case KEY_SEED:
        return options_whole("--seed", value, 0, UINT64_MAX, &request->rule.seed);
    default:
        return bed_options_take(&request->bed, options, key);
    }
}

static int check_request(struct request *request) {
    if (!request->bed.file) return message(STATUS_USAGE, "which FILE? see fibrad exchange --help");
    if (!request->emissivity.given) return message(STATUS_USAGE, "which --emissivity? see fibrad exchange --help");
    if (request->rule.error > 0 && request->counted)
        return message(STATUS_USAGE, "--error finds rays and directions itself; leave out --rays and --directions");
    if (request->drop > 0 && request->run.raw)
        return message(STATUS_USAGE, "--drop needs rows that are averaged, not --raw");
    request->emissivity.place = bed_options_column(&request->bed, request->emissivity.column);
    request->write = write_find(request->bed.out, NULL);
    const bool known = request->write && request->write != write_vtp;
    return bed_options_output(&request->bed, known, ".csv, .mtx and .npz");
}

static int parse(struct request *request, int argc, char **argv) {
    struct options options = {.command = "exchange", .table = table, .argc = argc, .argv = argv};
    *request = (struct request){.bed.frame = -1};
    int status = STATUS_OK;
    for (int key; !status && (key = options_next(&options)) != OPTIONS_END;)
        status = take_option(request, &options, key);
    return status ? status : check_request(request);
}

static void print_summary(const struct request *request, const struct bed *bed, const struct result *result,
                          uint64_t rays) {
    printf("%s: radii %g to %g, %s rows, %s\n", request->run.file, result->facts.radius_min, result->facts.radius_max,
           request->run.raw ? "raw" : "reciprocal", fibrad_isa_name(result->facts.isa));
    printf("spheres %" PRIu32 "\n", bed->n);
    printf("nonzeros %" PRIu64 "\n", result->rows.start[result->rows.n]);
    printf("directions %" PRIu32 "\n", result->directions);
    printf("rays %" PRIu64 "\n", rays);
    printf("threads %d\n", result->threads);
    printf("seconds %.17g\n", result->seconds);
    printf("row_sum_min %.17g\n", result->row_sum_min);
    printf("row_sum_max %.17g\n", result->row_sum_max);
    printf("escaped_mean %.17g\n", result->escaped_mean);
    for (uint32_t k = 0; k < request->order.count; ++k) {
        const uint32_t wall = request->order.wall[k];
        printf("wall_%s %.17g %.17g\n", wall_name(wall), result->wall_mean[wall], result->facts.wall_area[wall]);
    }
    printf("closure_max %.17g\n", result->closure_max);
    printf("reciprocity_max %.17g\n", result->reciprocity_max);
    double square = 0;
    for (uint32_t i = 0; i < bed->n; ++i) square += result->error[i] * result->error[i] / bed->n;
    printf("error_rms %.17g\n", sqrt(square));
    printf("error_estimate %.17g\n", result->error_estimate);
}

static int compute_and_write(struct request *request, const struct bed *bed, struct result *result) {
    struct output out = {0};
    uint64_t rays = 0;
    int status = output_open(&out, request->bed.out);
    if (!status) status = run_exchange(bed, &request->run, &request->rule, request->drop, result, &rays);
    const struct contents contents = {bed, result, request->bed.ids, &request->order, &request->rule};
    if (!status && request->bed.out) status = request->write(out.file, &contents);
    status = output_close(&out, status);
    if (!status) print_summary(request, bed, result, rays);
    return status;
}

static int run(struct request *request) {
    struct bed bed = {0};
    struct result result = {0};
    double *emissivity = NULL;
    request->run.file = request->bed.name;
    request->run.threads = request->bed.threads;
    request->run.progress = request->bed.progress;
    int status = bed_options_read(&request->bed, &bed);
    if (!status) status = walls_of(&request->bed.walls, &bed, request->run.file, &request->run.walls, &request->order);
    if (!status) status = emissivity_walls(request->wall_emissivity, &request->order, request->rule.wall_emissivity);
    if (!status) status = emissivity_of(&request->emissivity, &bed, request->run.file, &emissivity);
    request->rule.emissivity = emissivity;
    if (!status) status = compute_and_write(request, &bed, &result);
    free(emissivity);
    result_free(&result);
    bed_free(&bed);
    return status;
}

int command_exchange(int argc, char **argv) {
    struct request request;
    const int status = parse(&request, argc, argv);
    if (status) return status == STATUS_HELP ? help() : status;
    return run(&request);
}
