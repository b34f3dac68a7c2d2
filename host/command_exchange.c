/* command_exchange.c - `fibrad exchange`: exchange factors of grey spheres. SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bed.h"
#include "commands.h"
#include "interrupt.h"
#include "message.h"
#include "options.h"
#include "quantities.h"
#include "read.h"
#include "run_exchange.h"
#include "walls.h"
#include "write.h"

enum { KEY_ERROR = KEY_OWN, KEY_WALL, KEY_PERIODIC, KEY_FRAME, KEY_THREADS, KEY_RAW, KEY_DROP, KEY_IDS, KEY_PROGRESS };

static const struct option table[] = {
    {OPTION_EMISSIVITY},
    {KEY_RAYS, "rays", "N", "paths from each sphere; error ~ N^-0.5 [400]"},
    {KEY_DIRECTIONS, "directions", "N", "beam directions for the first leg of all paths, 8 to 65536 [50]"},
    {KEY_ERROR, "error", "E",
     "as many of both as bring the estimated Euclidean error of a row to E (of the worst to 1.3 E or so), 1e-5 to 1 "
     "[none]"},
    {KEY_WALL, "wall", WALLS_ARGUMENT, WALLS_HELP},
    {OPTION_WALL_EMISSIVITY},
    {KEY_RAW, "raw", NULL, "do not average D_ij and D_ji [averaged and closed: A_i e_i D_ij = A_j e_j D_ji]"},
    {KEY_DROP, "drop", "D", "give entries below D back to the others; rows stay closed and reciprocal [0]"},
    {KEY_SEED, "seed", "S", "another number, other paths [0]"},
    {KEY_PERIODIC, "periodic", "LX,LY,LZ", "box lengths, 0 for an open axis; or none [as the file says]"},
    {KEY_FRAME, "frame", "K", "frame of a dump, from 0 [the last]"},
    {KEY_THREADS, "threads", "T", "threads, 1 to 1024 [all cores]"},
    {'o', "output", "OUT", "the factors: .csv, .mtx, .npz (SciPy) [summary only]"},
    {KEY_IDS, "ids", NULL, "in .csv, name spheres by the file's ids [by positions from 0]"},
    {KEY_PROGRESS, "progress", NULL, "show progress also when standard error is no terminal [off]"},
    {KEY_HELP, "help", NULL, "this text"},
    {0, NULL, NULL, NULL}};

struct request {
    const char *file, *out, *wall_emissivity;
    write_function *write;
    struct quantity emissivity;
    bool periodic; /* --periodic was given */
    double period[3];
    struct wall_options walls;
    struct wall_order order;
    fibrad_exchange_rule rule;
    double drop;
    bool counted; /* --rays or --directions was given */
    struct read_options read;
    struct run_options run;
    bool help;
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
    uint64_t whole = 0;
    int status = STATUS_OK;
    switch (key) {
    case OPTIONS_POSITIONAL:
        if (request->file) return message(STATUS_USAGE, "one FILE only, not also '%.60s'", value);
        request->file = value;
        break;
    case KEY_HELP:
        request->help = true;
        break;
    case KEY_EMISSIVITY:
        return emissivity_option(value, &request->emissivity);
    case KEY_RAYS:
        status = options_whole("--rays", value, 1, FIBRAD_PATHS_MAX, &whole);
        request->rule.paths = (uint32_t)whole;
        request->counted = true;
        break;
    case KEY_DIRECTIONS:
        status = options_whole("--directions", value, FIBRAD_DIRECTIONS_MIN, FIBRAD_DIRECTIONS_MAX, &whole);
        request->rule.directions = (uint32_t)whole;
        request->counted = true;
        break;
    case KEY_ERROR:
        return options_number("--error", value, 1e-5, 1, &request->rule.error);
    case KEY_WALL:
        return walls_option(value, &request->walls);
    case KEY_WALL_EMISSIVITY:
        request->wall_emissivity = value;
        break;
    case KEY_RAW:
        request->run.raw = true;
        break;
    case KEY_DROP:
        return options_number("--drop", value, 0, 1, &request->drop);
    case KEY_SEED:
        return options_whole("--seed", value, 0, UINT64_MAX, &request->rule.seed);
    case KEY_PERIODIC:
        request->periodic = true;
        return options_periodic(value, request->period);
    case KEY_FRAME:
        status = options_whole("--frame", value, 0, INT64_MAX, &whole);
        request->read.frame = (int64_t)whole;
        break;
    case KEY_THREADS:
        status = options_whole("--threads", value, 1, 1024, &whole);
        request->run.threads = (int)whole;
        break;
    case KEY_IDS:
        request->read.ids = true;
        break;
    case KEY_PROGRESS:
        request->run.progress = true;
        break;
    case 'o':
        request->out = value;
        break;
    default:
        status = STATUS_USAGE;
        break; /* OPTIONS_BAD: the message is out */
    }
    return status;
}

static int check_request(struct request *request) {
    if (!request->file) return message(STATUS_USAGE, "which FILE? see fibrad exchange --help");
    if (!request->emissivity.given) return message(STATUS_USAGE, "which --emissivity? see fibrad exchange --help");
    if (request->rule.error > 0 && request->counted)
        return message(STATUS_USAGE, "--error finds rays and directions itself; leave out --rays and --directions");
    if (request->drop > 0 && request->run.raw)
        return message(STATUS_USAGE, "--drop needs rows that are averaged, not --raw");
    if (request->out) {
        request->write = write_find(request->out, NULL);
        if (!request->write || request->write == write_vtp)
            return message_at(STATUS_USAGE, request->out, 0, "unknown ending; there are .csv, .mtx and .npz");
        if (output_same(request->file, request->out))
            return message_at(STATUS_USAGE, request->out, 0, "is the bed itself; it would be replaced");
    }
    if (request->read.ids && request->write != write_csv) return message(STATUS_USAGE, "--ids is for -o OUT.csv only");
    if (request->emissivity.column) {
        request->read.extra = &request->emissivity.column;
        request->read.extras = 1;
    }
    return STATUS_OK;
}

static int parse(struct request *request, int argc, char **argv) {
    struct options options = {.command = "exchange", .table = table, .argc = argc, .argv = argv};
    *request = (struct request){.read.frame = -1};
    for (int key; (key = options_next(&options)) != OPTIONS_END;) {
        const int status = take_option(request, &options, key);
        if (status || request->help) return status;
    }
    return check_request(request);
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
    int status = output_open(&out, request->out);
    if (!status) status = run_exchange(bed, &request->run, &request->rule, request->drop, result, &rays);
    const struct contents contents = {bed, result, request->read.ids, &request->order, &request->rule};
    if (!status && request->out) status = request->write(out.file, &contents);
    status = output_close(&out, status);
    if (!status) print_summary(request, bed, result, rays);
    return status;
}

static int run(struct request *request, struct bed *bed, struct result *result) {
    double *emissivity = NULL;
    request->run.file = strcmp(request->file, "-") ? request->file : "standard input";
    int status = read_bed(request->file, &request->read, bed);
    if (status) return status;
    if (request->periodic) memcpy(bed->period, request->period, sizeof bed->period);
    status = walls_of(&request->walls, bed, request->run.file, &request->run.walls, &request->order);
    if (!status) status = emissivity_walls(request->wall_emissivity, &request->order, request->rule.wall_emissivity);
    if (!status) status = emissivity_of(&request->emissivity, bed, request->run.file, &emissivity);
    request->rule.emissivity = emissivity;
    if (!status) status = compute_and_write(request, bed, result);
    free(emissivity);
    return status;
}

int command_exchange(int argc, char **argv) {
    struct request request;
    struct bed bed = {0};
    struct result result = {0};
    int status = parse(&request, argc, argv);
    if (status) return status;
    if (request.help) return help();
    interrupt_catch();
    status = run(&request, &bed, &result);
    result_free(&result);
    bed_free(&bed);
    return status;
}
