/* command_exchange.c - `fibrad exchange`: exchange factors of grey spheres. SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/message.h"
#include "command/commands.h"
#include "frames/solid_option.h"
#include "plot/plot_bed.h"
#include "write/write.h"

struct exchange_request {
    struct bed_options bed;
    const char *wall_emissivity;
    struct quantity emissivity, solid, temperature;
    double zero; /* 0 of the unit of temperature [K] */
    struct walls walls;
    fibrad_exchange_rule rule;
    fibrad_bed_rule options;
    bool raw;
};

static const struct option exchange_table[] = {
    {OPTION_EMISSIVITY(struct exchange_request, emissivity)},
    {OPTION_SOLID_CONDUCTIVITY(struct exchange_request, solid)},
    {0, "temperature", "T",
     "mean temperatures of the spheres, for --solid-conductivity: a number, or TYPE:T,..., or a column of the file",
     TO_FUNCTION(temperature_option, struct exchange_request, temperature)},
    {OPTION_TEMPERATURE_UNIT(struct exchange_request, zero)},
    {0, "rays", "N", "paths from each sphere, for reflections; the error falls as N^-0.5 [400]",
     TO_COUNT(struct exchange_request, rule.paths, 1, FIBRAD_PATHS_MAX)},
    {0, "directions", "N",
     "directions of beams, for the way to the first surface, " TEXT_DIRECTIONS
     " [" TEXT_OF(FIBRAD_EXCHANGE_DIRECTIONS_DEFAULT) "]",
     TO_COUNT(struct exchange_request, rule.directions, FIBRAD_DIRECTIONS_MIN, FIBRAD_DIRECTIONS_MAX)},
    {0, "error", "E",
     "error allowed in every row, estimated, 1e-5 to 1; rays and directions are added until it is met [none]",
     TO_NUMBER(struct exchange_request, rule.tolerance, 1e-5, 1)},
    OPTIONS_WALL,
    {OPTION_WALL_EMISSIVITY(struct exchange_request, wall_emissivity)},
    {0, "raw", NULL, "leave the rows as they were computed [averaged and closed: A_i e_i D_ij = A_j e_j D_ji]",
     TO_FLAG(struct exchange_request, raw)},
    {0, "drop", "D", "drop pairs of entries if both are below D, and enlarge the others; rows stay closed [0]",
     TO_NUMBER(struct exchange_request, options.drop, 0, 1)},
    {0, "seed", "S", "seed of paths and directions [0]", TO_WHOLE(struct exchange_request, rule.seed, 0, INFINITY)},
    OPTIONS_INPUT,
    {OPTION_BED_OUTPUT("write the factors (.csv .mtx .npz .json, - for standard output) or the spheres (.vtp) [summary "
                       "only]")},
    {OPTION_BED_FORMAT},
    {OPTION_PLOT("draw the bed and its factors by gnuplot, .svg or .png [none]")},
    {OPTION_SLICE},
    {OPTION_SCRATCH},
    OPTIONS_RUN,
    {.name = NULL}};

static int exchange_help(void) {
    puts("fibrad exchange FILE... --emissivity E [options]\n\n"
         "Exchange factors between all spheres of FILE. The spheres are grey and diffuse. D_ij is the fraction of\n"
         "the emission of sphere i that sphere j absorbs, directly or after reflections.\n");
    options_print(exchange_table);
    puts("\n" FILES_MORE "\n" WALLS_MORE "\n"
         "The .csv has the columns i,j,D,body. The surroundings are j = -1. Walls are j = -2, -3, ... with their\n"
         "names in the column `body`. Rows i = -2, -3, ... are those of walls that are not endless. .mtx has\n"
         "spheres only.\n"
         "\n"
         "The net power of sphere i is the sum over j of A_i e_i D_ij sigma (T_j^4 - T_i^4), with A_i = 4 pi r_i^2\n"
         "in square metres and T in kelvins. A sphere of emissivity 0 reflects everything. It has no row and no\n"
         "column.\n"
         "\n"
         "--solid-conductivity: Temperatures differ from point to point of each sphere. Then n_i takes the place of\n"
         "e_i (`node_emissivity` in .npz and .json), and N_i takes the place of sigma T_i^4. The net power q_i of\n"
         "sphere i is the sum over j of A_i n_i D_ij (N_j - N_i), with N_i = sigma T_i^4 - (1/n_i - 1/e_i) q_i/A_i.\n"
         "So the powers follow from a linear system. Walls and surroundings have N = sigma T^4. The factors are for\n"
         "k* = k_s/(4 d sigma T^3) at --temperature, whatever temperatures they are used with.\n"
         "\n"
         "Several frames go into one .csv or .json with their numbers. If OUT has a *, each frame has a file.\n"
         "Standard output ends with a summary of each frame, one `key value` on a line.\n"
         "\n"
         "Examples:\n"
         "  fibrad exchange packing.dump --emissivity 0.8 --error 0.01 -o D.csv\n"
         "  fibrad exchange packing.dump --emissivity 1:0.8,2:0.3 --frame all -o 'D.*.npz'\n"
         "  fibrad exchange pebbles.csv --length-unit m --emissivity 0.8 --temperature T --solid-conductivity 30 -o "
         "D.npz\n"
         "  fibrad exchange packing.csv --emissivity e --wall box --wall-emissivity zmin=0.3,0.9 --rays 2000 -o D.npz");
    return STATUS_OK;
}

static int exchange_check(struct exchange_request *request) {
    if (!request->emissivity.given && request->bed.files > 0)
        return message(STATUS_USAGE, "--emissivity is missing; see fibrad exchange --help");
    if (request->rule.tolerance > 0 && (request->rule.paths > 0 || request->rule.directions > 0))
        return message(STATUS_USAGE, "--error chooses rays and directions; leave out --rays and --directions");
    request->options.raw = request->raw;
    if (request->options.drop > 0 && request->raw)
        return message(STATUS_USAGE, "--drop needs rows that are averaged, not --raw");
    if (request->solid.given != request->temperature.given)
        return message(STATUS_USAGE, "--solid-conductivity and --temperature need each other; %s is missing",
                       request->solid.given ? "--temperature" : "--solid-conductivity");
    bed_options_quantity(&request->bed, &request->emissivity, NULL);
    bed_options_quantity(&request->bed, &request->solid, SOLID_UNIT);
    bed_options_quantity(&request->bed, &request->temperature, temperature_unit(request->zero));
    return bed_options_check(&request->bed, "exchange", CONTENT_MATRIX);
}

static int exchange_parse(struct exchange_request *request, int argc, char **argv) {
    const int status = options_read("exchange", exchange_table, argc, argv, request);
    return status ? status : exchange_check(request);
}

/* Powers by factors of nodes may err far more than rows: a node of emissivity n exchanges little of what the sphere
 * does, and what it exchanges follows from small differences. Let x be the part of a row that goes to walls and
 * surroundings, and m = n/e. Errors of powers, over their root mean square, turned out to be those of rows times
 * sqrt(1/(m (m + (1 - m) x))), if temperatures differ from sphere to sphere. docs/methods_heat.md section 15. */
static double exchange_power_error(const struct exchange_request *request, const fibrad_factors *matrix) {
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
static void exchange_report_solid(struct exchange_request *request, const fibrad_factors *matrix) {
    const uint32_t n = matrix->n;
    const double error = exchange_power_error(request, matrix);
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

static void exchange_report(struct exchange_request *request, const struct contents *what) {
    const fibrad_bed_matrix *factors = what->factors;
    struct report *report = &request->bed.report;
    struct summary summary;
    summary_make(&summary, what);
    bed_options_report(&request->bed, what->bed, what->walls, &factors->facts);
    quantity_report(&request->emissivity, "emissivity", report);
    wall_values_report(what->walls, request->rule.wall_emissivity, "_emissivity", 6, report);
    if (request->solid.given) exchange_report_solid(request, &factors->matrix);
    report_count(report, "directions", factors->directions);
    report_count(report, "rays", factors->rays);
    if (request->rule.tolerance > 0)
        report_wanted(report, request->bed.name, request->rule.tolerance, request->rule.tolerance,
                      fmax(summary.error_max, summary.wall_error_max), "the worst row");
    report_count(report, "seed", request->rule.seed);
    report_text(report, "rows", request->options.raw ? "raw" : "reciprocal");
    report_count(report, "threads", (uint64_t)factors->threads);
    report_value(report, "seconds", factors->seconds, 3);
    summary_report(&summary, what, report);
    report_end(report);
}

/* Computes the factors of one frame and writes them to all outputs. */
static int exchange_matrix(struct exchange_request *request, struct bed *bed) {
    fibrad_bed *made;
    fibrad_bed_matrix *factors = NULL;
    request->options.exchange = &request->rule;
    int status = bed_options_make(&request->bed, bed, &request->walls, &made);
    if (!status) status = bed_options_factors(&request->bed, bed, &request->walls, made, &request->options, &factors);
    struct contents what = {.factors = factors, .walls = &request->walls, .grey = &request->rule};
    if (!status) status = bed_options_write(&request->bed, bed, &what);
    if (!status && request->bed.outputs.picture)
        status = plot_bed(&request->bed.picture, request->bed.name, &what, &request->bed.slice);
    if (!status) exchange_report(request, &what);
    fibrad_bed_matrix_free(factors);
    fibrad_bed_free(made);
    return status;
}

/* With --solid-conductivity finds k* and the emissivity of the node of each sphere, *relative [2 n]. Free it also after
 * an error. */
static int exchange_solid(struct exchange_request *request, struct bed *bed, double **relative) {
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

static int exchange_frame(void *exchange_request, struct bed *bed) {
    struct exchange_request *request = exchange_request;
    double *emissivity = NULL, *relative = NULL, wall_emissivity[WALLS_MAX];
    const char *file = request->bed.name;
    int status = bed_options_walls(&request->bed, bed, &request->walls);
    if (!status) status = wall_emissivities(request->wall_emissivity, &request->walls, wall_emissivity);
    if (!status) status = quantity_values(&request->emissivity, bed, file, "emissivity", 0, 0, 1, &emissivity);
    request->rule.emissivity = emissivity;
    request->rule.wall_emissivity = wall_emissivity;
    if (!status) status = exchange_solid(request, bed, &relative);
    if (!status) status = exchange_matrix(request, bed);
    free(emissivity);
    free(relative);
    return status;
}

int command_exchange(int argc, char **argv) {
    struct exchange_request request = {0};
    const int status = exchange_parse(&request, argc, argv);
    const int ended = bed_options_end(&request.bed, status, exchange_help, exchange_frame, &request);
    quantity_free(&request.solid);
    return ended;
}
