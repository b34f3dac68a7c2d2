/* command_heat.c - `fibrad heat`: net radiative powers of grey spheres and walls. SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bed/bed_scene.h"
#include "bed/property_option.h"
#include "cli/message.h"
#include "cli/output.h"
#include "command/bed_options.h"
#include "command/commands.h"
#include "write/outputs.h"

enum { KEY_TEMPERATURE = KEY_OWN, KEY_AMBIENT, KEY_WALL_TEMPERATURE, KEY_MODEL, KEY_PATCHES };

static const struct option heat_table[] = {
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
    {OPTION_FORMAT},
    {OPTION_IDS},
    {OPTION_PROGRESS},
    {OPTION_HELP},
    {0, NULL, NULL, NULL}};

struct heat_request {
    struct bed_options bed;
    const char *wall_temperature, *wall_emissivity;
    struct quantity emissivity, temperature;
    struct walls walls;
    bool counted;              /* --directions, --points or --patches was given */
    fibrad_heat_config config; /* with --error, where to begin */
    fibrad_heat_sources sources;
    double error; /* wanted of the powers, over their root mean square; 0: config as it is */
};

static int heat_help(void) {
    puts("fibrad heat FILE --emissivity E --temperature T [options]\n\n"
         "Net radiative power of every sphere of FILE, of walls and of the surroundings, all grey and diffuse.\n"
         "SI units: metres, kelvins, watts; q is positive where heat is gained.\n");
    options_print(heat_table);
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

static int heat_take(struct heat_request *request, const struct options *options, int key) {
    const char *value = options->value;
    int status = STATUS_OK;
    struct beam_options beam = {0};
    switch (key) {
    case KEY_EMISSIVITY:
        return emissivity_option(value, &request->emissivity);
    case KEY_TEMPERATURE:
        return temperature_option(value, &request->temperature);
    case KEY_AMBIENT:
        return options_number("--ambient", value, 0, TEMPERATURE_MAX, &request->sources.surroundings);
    case KEY_WALL_TEMPERATURE:
        request->wall_temperature = value;
        break;
    case KEY_WALL_EMISSIVITY:
        request->wall_emissivity = value;
        break;
    case KEY_MODEL:
        request->sources.uniform = strcmp(value, "spheres") == 0;
        if (!request->sources.uniform && strcmp(value, "patches") != 0)
            status = message(STATUS_USAGE, "--model: '%.40s' is neither patches nor spheres", value);
        break;
    case KEY_PATCHES:
        request->counted = true;
        return take_patches(value, &request->config.patches);
    case KEY_DIRECTIONS:
    case KEY_POINTS:
        request->counted = true;
        status = options_beam(key, value, &beam);
        if (key == KEY_DIRECTIONS) request->config.directions = beam.directions;
        if (key == KEY_POINTS) request->config.points = beam.points;
        break;
    case KEY_ERROR:
        return options_number("--error", value, 1e-5, 1, &request->error);
    default:
        return bed_options_take(&request->bed, options, key);
    }
    return status;
}

static int heat_check_request(struct heat_request *request) {
    if (!request->bed.file) return message(STATUS_USAGE, "which FILE? see fibrad heat --help");
    if (!request->emissivity.given) return message(STATUS_USAGE, "which --emissivity? see fibrad heat --help");
    if (!request->temperature.given) return message(STATUS_USAGE, "which --temperature? see fibrad heat --help");
    if (request->error > 0 && request->counted)
        return message(STATUS_USAGE,
                       "--error finds directions and patches itself; leave out --directions, --points and --patches");
    if (request->error > 0 && request->sources.uniform)
        return message(STATUS_USAGE,
                       "--error is for --model patches: one radiosity per sphere has an error of its own");
    request->emissivity.place = bed_options_column(&request->bed, request->emissivity.column);
    request->temperature.place = bed_options_column(&request->bed, request->temperature.column);
    return bed_options_output(&request->bed, CONTENT_HEAT);
}

static int heat_parse(struct heat_request *request, int argc, char **argv) {
    struct options options = {.command = "heat", .table = heat_table, .argc = argc, .argv = argv};
    *request = (struct heat_request){.bed.frame = -1, .config = {.directions = 168, .points = 64, .patches = 96}};
    fibrad_heat_sources_init(&request->sources);
    request->sources.surroundings = 0;
    int status = STATUS_OK;
    for (int key; !status && (key = options_next(&options)) != OPTIONS_END;) status = heat_take(request, &options, key);
    if (request->error > 0 && !request->counted) request->config.directions = 72;
    return status ? status : heat_check_request(request);
}

/* Powers, and what is said of them. */
struct heat_report {
    fibrad_heat_result result;
    fibrad_heat_config config; /* as used in the end */
    fibrad_scene_facts facts;
    double seconds;              /* computing, without reading and writing */
    double mean_square, largest; /* of the spheres: root mean square [W]; of all: largest [W] */
    double balance;              /* sum of all powers over the largest */
    double error_estimate;       /* of the powers, over their root mean square */
};

static void heat_summarise(const struct bed *bed, const struct walls *walls, struct heat_report *report) {
    const fibrad_heat_result *result = &report->result;
    double square = 0, sum = result->surroundings_power;
    report->largest = fabs(sum);
    for (uint32_t k = 0; k < walls->count; ++k) {
        sum += result->body_power[k];
        report->largest = fmax(report->largest, fabs(result->body_power[k]));
    }
    for (uint32_t i = 0; i < bed->n; ++i) {
        sum += result->power[i];
        square += result->power[i] * result->power[i];
        report->largest = fmax(report->largest, fabs(result->power[i]));
    }
    report->mean_square = sqrt(square / bed->n);
    report->balance = report->largest > 0 ? sum / report->largest : 0;
    const double error = hypot(result->error_patches, result->error_beams);
    report->error_estimate = report->mean_square > 0 ? error / report->mean_square : 0;
}

static int heat_once(struct heat_request *request, const struct bed *bed, struct heat_report *report) {
    const fibrad_scene_config scene = bed_scene(bed, &request->walls);
    const fibrad_spheres spheres = bed_spheres(bed);
    fibrad_run run = bed_options_run(&request->bed);
    fibrad_radiation *radiation;
    int status = fibrad_radiation_new(&radiation, &scene, &spheres, &report->config, &run);
    if (!status) status = fibrad_radiation_solve(radiation, &request->sources, &report->result);
    fibrad_radiation_describe(radiation, &report->facts, &run.fault);
    fibrad_radiation_free(radiation);
    if (!status) heat_summarise(bed, &request->walls, report);
    return bed_options_status(&request->bed, bed, status, &run.fault);
}

/* More of what makes the larger part of the error. False: there is no more. */
static bool heat_refine(struct heat_report *report) {
    fibrad_heat_config *config = &report->config;
    const bool beams = report->result.error_beams > report->result.error_patches;
    if ((beams || config->patches == 384) && config->directions <= FIBRAD_DIRECTIONS_MAX / 4)
        config->directions *= 2;
    else if (config->patches < 384)
        config->patches *= 4;
    else
        return false;
    return true;
}

static int heat_compute(struct heat_request *request, const struct bed *bed, struct heat_report *report) {
    const double begun = progress_clock();
    report->config = request->config;
    int status = heat_once(request, bed, report);
    while (!status && request->error > 0 && report->error_estimate > request->error && heat_refine(report))
        status = heat_once(request, bed, report);
    report->seconds = progress_clock() - begun;
    return status;
}

static void heat_print(const struct heat_request *request, const struct bed *bed, const struct heat_report *report) {
    const fibrad_heat_result *result = &report->result;
    printf("%s: radii %g to %g, %s\n", request->bed.name, report->facts.radius_min, report->facts.radius_max,
           fibrad_isa_name(report->facts.isa));
    printf("spheres %" PRIu32 "\n", bed->n);
    printf("model %s\n", request->sources.uniform ? "spheres" : "patches");
    printf("patches %" PRIu32 "\n", report->config.patches);
    printf("directions %" PRIu32 "\n", report->config.directions);
    printf("points %" PRIu32 "\n", report->config.points);
    printf("threads %d\n", request->bed.threads ? request->bed.threads : omp_get_max_threads());
    printf("seconds %.17g\n", report->seconds);
    printf("sweeps %" PRIu32 "\n", result->sweeps);
    printf("residual %.17g\n", result->residual);
    printf("power_rms %.17g\n", report->mean_square);
    printf("power_largest %.17g\n", report->largest);
    printf("surroundings %.17g %.17g\n", result->surroundings_power, request->sources.surroundings);
    for (uint32_t k = 0; k < request->walls.count; ++k)
        printf("wall_%s %.17g %.17g\n", wall_name(&request->walls.body[k]), result->body_power[k],
               request->sources.body_temperature[k]);
    printf("balance %.17g\n", report->balance);
    printf("error_estimate %.17g\n", report->error_estimate);
}

static int heat_write(struct heat_request *request, const struct bed *bed, struct heat_report *report) {
    struct outputs *out = &request->bed.outputs;
    int status = outputs_open(out);
    if (!status) status = heat_compute(request, bed, report);
    if (!status && request->error > 0 && report->error_estimate > request->error)
        fprintf(stderr, "fibrad: %s: warning: the estimated error is %.3g\n", request->bed.name,
                report->error_estimate);
    const struct contents contents = {
        .bed = bed, .walls = &request->walls, .sources = &request->sources, .result = &report->result};
    if (!status) status = outputs_write(out, &contents, bed->frame);
    status = outputs_close(out, status);
    if (!status) heat_print(request, bed, report);
    return status;
}

static int heat_run(struct heat_request *request) {
    struct bed bed = {0};
    struct heat_report report = {0};
    fibrad_heat_sources *sources = &request->sources;
    double *emissivity = NULL, *temperature = NULL, *power = NULL;
    double wall_temperature[WALLS_MAX], wall_emissivity[WALLS_MAX], wall_power[WALLS_MAX];
    const char *file = request->bed.name;
    int status = bed_options_read(&request->bed, &bed);
    if (!status) status = walls_of(&request->bed.walls, &bed, file, &request->walls);
    const uint32_t walls = request->walls.count;
    if (!status) status = temperature_walls(request->wall_temperature, walls, sources->surroundings, wall_temperature);
    if (!status) status = emissivity_walls(request->wall_emissivity, walls, wall_emissivity);
    if (!status) status = emissivity_of(&request->emissivity, &bed, file, &emissivity);
    if (!status) status = temperature_of(&request->temperature, &bed, file, &temperature);
    if (!status) power = malloc(bed.n * sizeof *power);
    if (!status && !power) status = message_memory();
    sources->emissivity = emissivity, sources->temperature = temperature;
    sources->body_emissivity = wall_emissivity, sources->body_temperature = wall_temperature;
    report.result = (fibrad_heat_result){.power = power, .body_power = wall_power};
    if (!status) status = heat_write(request, &bed, &report);
    free(emissivity);
    free(temperature);
    free(power);
    bed_free(&bed);
    return status;
}

int command_heat(int argc, char **argv) {
    struct heat_request request;
    const int status = heat_parse(&request, argc, argv);
    if (status) return status == STATUS_HELP ? heat_help() : status;
    return heat_run(&request);
}
