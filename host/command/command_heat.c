/* command_heat.c - `fibrad heat`: net radiative powers of grey spheres and walls. SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bed/property_option.h"
#include "bed/wall_option.h"
#include "cli/message.h"
#include "cli/output.h"
#include "command/bed_options.h"
#include "command/commands.h"
#include "compute/heat_powers.h"
#include "write/write_heat.h"

enum { KEY_TEMPERATURE = KEY_OWN, KEY_AMBIENT, KEY_WALL_TEMPERATURE, KEY_MODEL, KEY_PATCHES };

static const struct option table[] = {
    {OPTION_EMISSIVITY},
    {KEY_TEMPERATURE, "temperature", "T|COLUMN", "of all spheres [K], or the file's column of that name"},
    {KEY_AMBIENT, "ambient", "T", "temperature of the surroundings, which are black [0 K]"},
    {OPTION_WALL},
    {KEY_WALL_TEMPERATURE, "wall-temperature", "LIST",
     "temperatures of the walls in the order given; the last one is that of all further [K; as the surroundings]"},
    {OPTION_WALL_EMISSIVITY},
    {KEY_MODEL, "model", "NAME",
     "patches: reflected light goes from point to point; spheres: one radiosity each, for emissivities near 1 "
     "[patches]"},
    {KEY_PATCHES, "patches", "P", "of a sphere: 24, 96 or 384 [96]"},
    {KEY_DIRECTIONS, "directions", "N", "of beams, 8 to 65536 [168]"},
    {KEY_POINTS, "points", "M", "beams per direction: 64, 128 or 256 [64]"},
    {KEY_ERROR, "error", "E",
     "as many directions and patches as bring the estimated error of the powers to E times their root mean square or "
     "less, 1e-5 to 1 [none]"},
    {OPTION_PERIODIC},
    {OPTION_FRAME},
    {OPTION_THREADS},
    {'o', "output", "OUT", "powers: .csv (i,T,q) or .vtp (ParaView) [summary only]"},
    {OPTION_IDS},
    {OPTION_PROGRESS},
    {OPTION_HELP},
    {0, NULL, NULL, NULL}};

struct request {
    struct bed_options bed;
    const char *wall_temperature, *wall_emissivity;
    write_heat_function *write;
    struct quantity emissivity, temperature;
    struct wall_order order;
    bool counted; /* --directions, --points or --patches was given */
    struct heat_options heat;
};

static int help(void) {
    puts("fibrad heat FILE --emissivity E --temperature T [options]\n\n"
         "Net radiative power of every sphere of FILE, of walls and of the surroundings, all grey and diffuse.\n"
         "SI units: metres, kelvins, watts; q is positive where heat is gained.\n");
    options_print(table);
    puts("\nIn .csv the surroundings are i = -1 and the walls -2, -3 ... in the order given. All q add up to zero.\n"
         "Standard output ends with a summary, one `key value` a line; `wall_NAME`: power and temperature.\n\n"
         "Examples:\n"
         "  fibrad heat packing.dump --emissivity 0.8 --temperature v_T --ambient 300 -o q.csv\n"
         "  fibrad heat spheres.csv --emissivity eps --temperature T --wall auto --wall-temperature 900 -o q.csv\n"
         "  fibrad heat packing.dump --emissivity 0.3 --temperature v_T --wall zmin,cylinder:0,0,0.48 \\\n"
         "      --wall-temperature 1200,600 --wall-emissivity 0.9,0.4 --error 0.005 -o q.vtp");
    return STATUS_OK;
}

static int take_patches(const char *text, uint32_t *patches) {
    const int status = options_count("--patches", text, 1, UINT32_MAX, patches);
    if (!status && *patches != 24 && *patches != 96 && *patches != 384)
        return message(STATUS_USAGE, "--patches: %.40s is not built in; 24, 96 and 384 are", text);
    return status;
}

static int take_option(struct request *request, const struct options *options, int key) {
    const char *value = options->value;
    int status = STATUS_OK;
    struct beam_options beam = {0};
    switch (key) {
    case KEY_EMISSIVITY:
        return emissivity_option(value, &request->emissivity);
    case KEY_TEMPERATURE:
        return temperature_option(value, &request->temperature);
    case KEY_AMBIENT:
        return options_number("--ambient", value, 0, TEMPERATURE_MAX, &request->heat.sources.surroundings);
    case KEY_WALL_TEMPERATURE:
        request->wall_temperature = value;
        break;
    case KEY_WALL_EMISSIVITY:
        request->wall_emissivity = value;
        break;
    case KEY_MODEL:
        request->heat.sources.uniform = strcmp(value, "spheres") == 0;
        if (!request->heat.sources.uniform && strcmp(value, "patches") != 0)
            status = message(STATUS_USAGE, "--model: '%.40s' is neither patches nor spheres", value);
        break;
    case KEY_PATCHES:
        request->counted = true;
        return take_patches(value, &request->heat.config.patches);
    case KEY_DIRECTIONS:
    case KEY_POINTS:
        request->counted = true;
        status = options_beam(key, value, &beam);
        if (key == KEY_DIRECTIONS) request->heat.config.directions = beam.directions;
        if (key == KEY_POINTS) request->heat.config.points = beam.points;
        break;
    case KEY_ERROR:
        return options_number("--error", value, 1e-5, 1, &request->heat.error);
    default:
        return bed_options_take(&request->bed, options, key);
    }
    return status;
}

static int check_request(struct request *request) {
    if (!request->bed.file) return message(STATUS_USAGE, "which FILE? see fibrad heat --help");
    if (!request->emissivity.given) return message(STATUS_USAGE, "which --emissivity? see fibrad heat --help");
    if (!request->temperature.given) return message(STATUS_USAGE, "which --temperature? see fibrad heat --help");
    if (request->heat.error > 0 && request->counted)
        return message(STATUS_USAGE,
                       "--error finds directions and patches itself; leave out --directions, --points and --patches");
    if (request->heat.error > 0 && request->heat.sources.uniform)
        return message(STATUS_USAGE,
                       "--error is for --model patches: one radiosity per sphere has an error of its own");
    request->emissivity.place = bed_options_column(&request->bed, request->emissivity.column);
    request->temperature.place = bed_options_column(&request->bed, request->temperature.column);
    request->write = output_ends(request->bed.out, ".csv")   ? write_heat_csv
                     : output_ends(request->bed.out, ".vtp") ? write_heat_vtp
                                                             : NULL;
    return bed_options_output(&request->bed, request->write, ".csv and .vtp");
}

static int parse(struct request *request, int argc, char **argv) {
    struct options options = {.command = "heat", .table = table, .argc = argc, .argv = argv};
    *request = (struct request){.bed.frame = -1,
                                .heat.config = {.directions = 168, .points = 64, .patches = 96},
                                .heat.sources.sigma = FIBRAD_STEFAN_BOLTZMANN};
    int status = STATUS_OK;
    for (int key; !status && (key = options_next(&options)) != OPTIONS_END;)
        status = take_option(request, &options, key);
    if (request->heat.error > 0 && !request->counted) request->heat.config.directions = 72;
    return status ? status : check_request(request);
}

static void print_summary(const struct request *request, const struct bed *bed, const struct heat_report *report) {
    const fibrad_heat_result *heat = &report->heat;
    printf("%s: radii %g to %g, %s\n", request->heat.file, report->facts.radius_min, report->facts.radius_max,
           fibrad_isa_name(report->facts.isa));
    printf("spheres %" PRIu32 "\n", bed->n);
    printf("model %s\n", request->heat.sources.uniform ? "spheres" : "patches");
    printf("patches %" PRIu32 "\n", report->config.patches);
    printf("directions %" PRIu32 "\n", report->config.directions);
    printf("points %" PRIu32 "\n", report->config.points);
    printf("threads %d\n", report->threads);
    printf("seconds %.17g\n", report->seconds);
    printf("sweeps %" PRIu32 "\n", heat->sweeps);
    printf("residual %.17g\n", heat->residual);
    printf("power_rms %.17g\n", report->mean_square);
    printf("power_largest %.17g\n", report->largest);
    printf("surroundings %.17g %.17g\n", heat->surroundings_power, request->heat.sources.surroundings);
    for (uint32_t k = 0; k < request->order.count; ++k) {
        const uint32_t wall = request->order.wall[k];
        printf("wall_%s %.17g %.17g\n", wall_name(wall), heat->wall_power[wall],
               request->heat.sources.wall_temperature[wall]);
    }
    printf("balance %.17g\n", report->balance);
    printf("error_estimate %.17g\n", report->error_estimate);
}

static int compute_and_write(struct request *request, const struct bed *bed, struct heat_report *report) {
    struct output out = {0};
    int status = output_open(&out, request->bed.out);
    if (!status) status = run_heat(bed, &request->heat, report);
    if (!status && request->heat.error > 0 && report->error_estimate > request->heat.error)
        fprintf(stderr, "fibrad: %s: warning: the estimated error is %.3g\n", request->heat.file,
                report->error_estimate);
    const struct heat_contents contents = {bed, &request->heat, report, &request->order, request->bed.ids};
    if (!status && request->bed.out) status = request->write(out.file, &contents);
    status = output_close(&out, status);
    if (!status) print_summary(request, bed, report);
    return status;
}

static int run(struct request *request) {
    struct bed bed = {0};
    struct heat_report report = {0};
    fibrad_heat_sources *sources = &request->heat.sources;
    double *emissivity = NULL, *temperature = NULL;
    request->heat.file = request->bed.name;
    request->heat.threads = request->bed.threads;
    request->heat.progress = request->bed.progress;
    int status = bed_options_read(&request->bed, &bed);
    if (!status)
        status = walls_of(&request->bed.walls, &bed, request->heat.file, &request->heat.walls, &request->order);
    if (!status)
        status = temperature_walls(request->wall_temperature, &request->order, sources->surroundings,
                                   sources->wall_temperature);
    if (!status) status = emissivity_walls(request->wall_emissivity, &request->order, sources->wall_emissivity);
    if (!status) status = emissivity_of(&request->emissivity, &bed, request->heat.file, &emissivity);
    if (!status) status = temperature_of(&request->temperature, &bed, request->heat.file, &temperature);
    sources->emissivity = emissivity;
    sources->temperature = temperature;
    if (!status) status = compute_and_write(request, &bed, &report);
    free(emissivity);
    free(temperature);
    heat_report_free(&report);
    bed_free(&bed);
    return status;
}

int command_heat(int argc, char **argv) {
    struct request request;
    const int status = parse(&request, argc, argv);
    if (status) return status == STATUS_HELP ? help() : status;
    return run(&request);
}
