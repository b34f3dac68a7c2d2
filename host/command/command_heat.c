/* command_heat.c - `fibrad heat`: net radiative powers of grey spheres and walls. SPDX-License-Identifier: MIT */
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "command/bed_options.h"
#include "command/commands.h"
#include "command/heat_run.h"
#include "plot/plot_heat.h"

enum { KEY_TEMPERATURE = KEY_OWN, KEY_AMBIENT, KEY_WALL_TEMPERATURE, KEY_MODEL, KEY_PATCHES };

static const struct option heat_table[] = {
    {OPTION_EMISSIVITY},
    {KEY_TEMPERATURE, "temperature", "T", "of all spheres; or TYPE:T,... ; or the file's column of that name"},
    {KEY_AMBIENT, "ambient", "T",
     "of the surroundings, which are black; needed unless walls and periods close the bed"},
    {OPTION_WALL},
    {KEY_WALL_TEMPERATURE, "wall-temperature", "LIST",
     "of the walls: zmin=1200,300: one number for all others; every wall needs one"},
    {OPTION_WALL_EMISSIVITY},
    {OPTION_TEMPERATURE_UNIT},
    {KEY_MODEL, "model", "NAME",
     "patches: reflected light goes from point to point; spheres: one radiosity each, for emissivities near 1 "
     "[patches]"},
    {KEY_PATCHES, "patches", "P", "of a sphere: 24, 96 or 384 [96]"},
    {KEY_DIRECTIONS, "directions", "N", "of beams, 8 to 65536 [168]"},
    {KEY_POINTS, "points", "M", "beams per direction: 64, 128 or 256 [64]"},
    {KEY_ERROR, "error", "E",
     "as many directions and patches as bring the estimated error of the powers to E times their root mean square or "
     "less, 1e-5 to 1; at the least to 1e-3 E of what is emitted [none]"},
    OPTIONS_INPUT,
    {'o', "output", "OUT", "powers: .csv .dump (OVITO) .vtp (ParaView) .json; - [summary only]"},
    {OPTION_FORMAT},
    {KEY_PLOT, "plot", "OUT", "a picture, .svg or .png, by gnuplot [none]"},
    OPTIONS_RUN,
    {0, NULL, NULL, NULL}};

struct heat_request {
    struct bed_options bed;
    const char *plot, *wall_temperature, *wall_emissivity;
    struct quantity emissivity, temperature;
    double zero;         /* 0 of the unit of temperature [K] */
    const char *ambient; /* NULL: not given */
    bool counted;        /* --directions, --points or --patches was given */
    struct heat_problem problem;
    struct output picture;
};

static int heat_help(void) {
    puts("fibrad heat FILE... --emissivity E --temperature T --ambient T [options]\n\n"
         "Net radiative power of every sphere of FILE, of walls and of the surroundings, all grey and diffuse, in "
         "watts;\n"
         "positive where heat is gained. Temperatures in kelvins, lengths in the unit of the file.\n");
    options_print(heat_table);
    puts("\n" FILES_MORE "\n" WALLS_MORE "The .csv holds i,T_K,q_W,body: spheres by name, the surroundings i = -1, "
         "walls i = -2, -3 ... with their names "
         "in\n"
         "the column `body`. All q add up to zero. Spheres of emissivity 0 reflect all and gain nothing.\n"
         "Several frames go into one .csv, .dump or .json, with their numbers, or into one file each where OUT has a "
         "*.\n"
         "Standard output ends with a summary of each, one `key value` a line. In it balance and error are relative to "
         "what\n"
         "the spheres emit, or to what they absorb where that is more.\n\n"
         "Examples:\n"
         "  fibrad heat packing.dump --emissivity 0.8 --temperature v_T --ambient 300 -o q.csv\n"
         "  fibrad heat 'bed.*.dump.gz' --frame all --emissivity 0.8 --temperature v_T --ambient 300 -o q.csv\n"
         "  fibrad heat spheres.csv --length-unit mm --emissivity eps --temperature T --temperature-unit C \\\n"
         "      --wall box --wall-temperature zmin=900,20 -o q.csv\n"
         "  fibrad heat packing.dump --emissivity 1:0.3,2:0.9 --temperature v_T --wall zmin,cylinder:0,0,0.48 \\\n"
         "      --wall-temperature zmin=1200,cylinder=600 --wall-emissivity cylinder=0.4 --ambient 300 --error 0.005 "
         "-o q.vtp");
    return STATUS_OK;
}

static int take_patches(const char *text, uint32_t *patches) {
    const int status = options_count("--patches", text, 1, UINT32_MAX, patches);
    if (!status && *patches != 24 && *patches != 96 && *patches != 384)
        return message(STATUS_USAGE, "--patches: %.40s is not built in; 24, 96 and 384 are", text);
    return status;
}

static int take_model(const char *text, int *uniform) {
    *uniform = strcmp(text, "spheres") == 0;
    if (*uniform || strcmp(text, "patches") == 0) return STATUS_OK;
    return message(STATUS_USAGE, "--model: '%.40s' is neither patches nor spheres", text);
}

static int take_beams(struct heat_request *request, const char *text, int key) {
    struct beam_options beam = {0};
    const int status = options_beam(key, text, &beam);
    request->counted = true;
    if (key == KEY_DIRECTIONS) request->problem.config.directions = beam.directions;
    if (key == KEY_POINTS) request->problem.config.points = beam.points;
    return status;
}

static int heat_take(struct heat_request *request, const struct options *options, int key) {
    const char *value = options->value;
    switch (key) {
    case KEY_EMISSIVITY:
        return quantity_option("--emissivity", value, 0, 1, &request->emissivity);
    case KEY_TEMPERATURE: /* its unit is not known yet */
        return quantity_option("--temperature", value, -KELVIN_OF_0_CELSIUS, TEMPERATURE_MAX, &request->temperature);
    case KEY_TEMPERATURE_UNIT:
        return temperature_unit_option(value, &request->zero);
    case KEY_AMBIENT:
        request->ambient = value;
        return STATUS_OK;
    case KEY_WALL_TEMPERATURE:
        request->wall_temperature = value;
        return STATUS_OK;
    case KEY_WALL_EMISSIVITY:
        request->wall_emissivity = value;
        return STATUS_OK;
    case KEY_MODEL:
        return take_model(value, &request->problem.sources.uniform);
    case KEY_PATCHES:
        request->counted = true;
        return take_patches(value, &request->problem.config.patches);
    case KEY_DIRECTIONS:
    case KEY_POINTS:
        return take_beams(request, value, key);
    case KEY_ERROR:
        return options_number("--error", value, 1e-5, 1, &request->problem.error);
    case KEY_PLOT:
        request->plot = value;
        return STATUS_OK;
    default:
        return bed_options_take(&request->bed, options, key);
    }
}

/* The temperature of the surroundings, if it was given; else NaN. */
static int take_ambient(struct heat_request *request) {
    double *ambient = &request->problem.sources.surroundings;
    *ambient = NAN;
    if (!request->ambient) return STATUS_OK;
    const int status = options_number("--ambient", request->ambient, 0 - request->zero, TEMPERATURE_MAX, ambient);
    *ambient += request->zero;
    return status;
}

static int heat_check_request(struct heat_request *request) {
    const int status = bed_options_check(&request->bed, "heat", CONTENT_HEAT, request->plot);
    if (status) return status;
    if (!request->emissivity.given) return message(STATUS_USAGE, "which --emissivity? see fibrad heat --help");
    if (!request->temperature.given) return message(STATUS_USAGE, "which --temperature? see fibrad heat --help");
    if (request->temperature.value < -request->zero)
        return message(STATUS_USAGE, "--temperature: %g is below absolute zero", request->temperature.value);
    if (request->problem.error > 0 && request->counted)
        return message(STATUS_USAGE,
                       "--error finds directions and patches itself; leave out --directions, --points and --patches");
    if (request->problem.error > 0 && request->problem.sources.uniform)
        return message(STATUS_USAGE,
                       "--error is for --model patches: one radiosity per sphere has an error of its own");
    request->emissivity.place = bed_options_column(&request->bed, request->emissivity.column, NULL);
    request->temperature.place =
        bed_options_column(&request->bed, request->temperature.column, request->zero > 0 ? "C" : "K");
    if (request->problem.error > 0) request->problem.config.directions = 72;
    return take_ambient(request);
}

static int heat_parse(struct heat_request *request, int argc, char **argv) {
    struct options options = {.command = "heat", .table = heat_table, .argc = argc, .argv = argv};
    *request = (struct heat_request){.problem.config = {.directions = 168, .points = 64, .patches = 96}};
    fibrad_heat_sources_init(&request->problem.sources);
    int status = STATUS_OK;
    for (int key; !status && (key = options_next(&options)) != OPTIONS_END;) status = heat_take(request, &options, key);
    return status ? status : heat_check_request(request);
}

static void heat_print(struct heat_request *request, const struct bed *bed, const struct heat_report *heat) {
    const fibrad_heat_result *result = &heat->result;
    const fibrad_heat_sources *sources = &request->problem.sources;
    struct report *report = &request->bed.report;
    bed_options_report(&request->bed, bed, &request->problem.walls, &heat->facts);
    report_text(report, "model", sources->uniform ? "spheres" : "patches");
    quantity_report(&request->emissivity, "emissivity", report);
    quantity_report(&request->temperature, request->zero > 0 ? "temperature_C" : "temperature_K", report);
    if (request->ambient) report_value(report, "surroundings_K", sources->surroundings, 6);
    wall_values_report(&request->problem.walls, sources->body_temperature, "_K", 6, report);
    wall_values_report(&request->problem.walls, sources->body_emissivity, "_emissivity", 6, report);
    report_count(report, "patches", heat->config.patches);
    report_count(report, "directions", heat->config.directions);
    report_count(report, "points", heat->config.points);
    report_count(report, "threads", (uint64_t)(request->bed.threads ? request->bed.threads : omp_get_max_threads()));
    report_value(report, "seconds", heat->seconds, 3);
    report_count(report, "sweeps", result->sweeps);
    report_value(report, "residual", result->residual, 2);
    report_value(report, "emitted_W", heat->emitted, 6);
    report_measured(report, "power_rms_W", heat->power_rms, heat->error);
    report_measured(report, "power_largest_W", heat->largest, heat->error);
    if (request->ambient) report_measured(report, "surroundings_W", result->surroundings_power, heat->error);
    wall_values_report(&request->problem.walls, result->body_power, "_W", 6, report);
    report_value(report, "balance_of_emission", heat->balance_of_emission, 2);
    report_value(report, "error_of_emission", heat->throughput > 0 ? heat->error / heat->throughput : 0, 2);
    report_value(report, "error_rms_W", heat->error, 2);
    report_end(report);
}

static int heat_picture(const struct heat_request *request, const struct bed *bed, const struct heat_report *report) {
    const struct heat_problem *problem = &request->problem;
    const struct heat_shown shown = {.bed = bed,
                                     .walls = &problem->walls,
                                     .metres = report->metres,
                                     .temperature = problem->sources.temperature,
                                     .power = report->result.power,
                                     .wall_temperature = problem->sources.body_temperature,
                                     .wall_power = report->result.body_power,
                                     .surroundings_temperature = problem->sources.surroundings,
                                     .surroundings_power = request->ambient ? report->result.surroundings_power : NAN};
    return plot_heat(&request->picture, request->bed.name, &shown);
}

static int heat_solve(struct heat_request *request, struct bed *bed, struct heat_report *report) {
    int status = heat_run(&request->bed, &request->problem, bed, report);
    struct contents what = {
        .walls = &request->problem.walls, .sources = &request->problem.sources, .result = &report->result};
    if (!status) status = bed_options_write(&request->bed, bed, &what);
    if (!status && request->plot) status = heat_picture(request, bed, report);
    if (!status) heat_print(request, bed, report);
    return status;
}

/* Every wall needs a temperature, and so do the surroundings if something can get there. */
static int heat_temperatures(struct heat_request *request, const struct bed *bed, double *wall_temperature) {
    const int status = wall_values("--wall-temperature", request->wall_temperature, NAN, 0 - request->zero,
                                   TEMPERATURE_MAX, &request->problem.walls, wall_temperature);
    for (uint32_t k = 0; k < request->problem.walls.count && !status; ++k) wall_temperature[k] += request->zero;
    if (!status && !request->ambient && !walls_closed(&request->problem.walls, bed))
        return message(STATUS_USAGE, "which --ambient? the bed is open: its surroundings need a temperature");
    return status;
}

static int heat_frame(void *heat_request, struct bed *bed) {
    struct heat_request *request = heat_request;
    struct heat_report report = {0};
    fibrad_heat_sources *sources = &request->problem.sources;
    double *emissivity = NULL, *temperature = NULL, *power = NULL;
    double wall_temperature[WALLS_MAX], wall_emissivity[WALLS_MAX], wall_power[WALLS_MAX];
    const char *file = request->bed.name;
    int status = walls_of(&request->bed.walls, bed, file, &request->problem.walls);
    if (!status) status = heat_temperatures(request, bed, wall_temperature);
    if (!status) status = wall_emissivities(request->wall_emissivity, &request->problem.walls, wall_emissivity);
    if (!status) status = quantity_values(&request->emissivity, bed, file, "emissivity", 0, 0, 1, &emissivity);
    if (!status)
        status = quantity_values(&request->temperature, bed, file, "temperature in kelvins", request->zero, 0,
                                 TEMPERATURE_MAX, &temperature);
    if (!status) power = malloc(bed->n * sizeof *power);
    if (!status && !power) status = message_memory();
    sources->emissivity = emissivity, sources->temperature = temperature;
    sources->body_emissivity = wall_emissivity, sources->body_temperature = wall_temperature;
    report.result = (fibrad_heat_result){.power = power, .body_power = wall_power};
    if (!status) status = heat_solve(request, bed, &report);
    free(emissivity);
    free(temperature);
    free(power);
    return status;
}

int command_heat(int argc, char **argv) {
    struct heat_request request;
    int status = heat_parse(&request, argc, argv);
    if (status == STATUS_HELP) {
        status = heat_help();
    } else if (!status) {
        status = output_open(&request.picture, request.plot);
        if (!status) status = bed_options_frames(&request.bed, "heat", heat_frame, &request);
        status = output_close(&request.picture, status);
    }
    bed_options_free(&request.bed);
    return status;
}
