/* command_heat.c - `fibrad heat`: net radiative powers of grey spheres and walls. SPDX-License-Identifier: MIT */
#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "frames/bed_options.h"
#include "frames/solid_option.h"
#include "command/commands.h"
#include "heat/heat_given.h"
#include "heat/heat_time.h"
#include "heat/heat_run.h"
#include "plot/plot_heat.h"

struct heat_request {
    struct bed_options bed;
    struct given_options given;
    struct time_options time;
    struct light_options light;
    struct contact_options contacts;
    struct face face;
    const char *wall_emissivity;
    struct quantity emissivity, solid;
    struct heat_problem problem;
};

static int take_patches(const char *text, void *of_sphere) {
    uint32_t *patches = of_sphere;
    const int status = options_count("--patches", text, 1, UINT32_MAX, patches);
    if (!status && *patches != 24 && *patches != 96 && *patches != 384)
        return message(STATUS_USAGE, "--patches: %.40s is not built in; 24, 96 and 384 are", text);
    return status;
}

static int take_model(const char *text, void *heat_problem) {
    struct heat_problem *problem = heat_problem;
    problem->sources.uniform = strcmp(text, "spheres") == 0;
    problem->by_patches = problem->sources.uniform || strcmp(text, "patches") == 0;
    problem->by_factors = strcmp(text, "factors") == 0;
    if (problem->by_patches || problem->by_factors) return STATUS_OK;
    return message(STATUS_USAGE, "--model: '%.40s' is none of patches, spheres and factors", text);
}

static const struct option heat_table[] = {
    {OPTION_EMISSIVITY_CURVES(struct heat_request, emissivity)},
    {OPTION_SOLID_CONDUCTIVITY(struct heat_request, solid)},
    {0, "temperature", "T",
     "temperature of all spheres, or TYPE:T,..., or a column of the file, blank or nan for spheres of --power",
     TO_FUNCTION(temperature_option, struct heat_request, given.temperature)},
    {0, "power", "W",
     "power that spheres of unknown temperature give off from inside, a number, TYPE:W,..., or a column of the "
     "file, blank or nan for spheres of --temperature [W]",
     TO_FUNCTION(given_power_option, struct heat_request, given.power)},
    {0, "ambient", "T", "temperature of the black surroundings; needed unless walls and periods close the bed",
     TO_TEXT(struct heat_request, given.ambient)},
    OPTIONS_WALL,
    {0, "wall-temperature", "LIST",
     "temperatures of walls, zmin=1200,zmax=insulated,300 for example; a number without a name is for all others; "
     "NAME=triangles:FILE is a column of temperatures, one for each triangle of the mesh",
     TO_TEXT(struct heat_request, given.wall_temperature)},
    {0, "wall-power", "LIST", "powers that walls of unknown temperature give off, zmin=500 for example [W]",
     TO_TEXT(struct heat_request, given.wall_power)},
    {OPTION_WALL_EMISSIVITY(struct heat_request, wall_emissivity)},
    {OPTION_TEMPERATURE_UNIT(struct heat_request, given.zero)},
    OPTIONS_LIGHT(struct heat_request),
    OPTIONS_CONTACTS(struct heat_request),
    {0, "face", NULL, "find the emissivity of the open face of the bed, which has one temperature",
     TO_FLAG(struct heat_request, face.wanted)},
    {0, "model", "NAME",
     "patches (reflections from point to point), spheres (one radiosity for each sphere, for emissivities near 1) or, "
     "with --until, factors (exchange factors, powers 2 to 5 % off) [patches; with --until factors "
     "corrected by patches]",
     TO_FUNCTION(take_model, struct heat_request, problem)},
    {0, "patches", "P", "patches of each sphere, 24, 96 or 384 [" TEXT_OF(FIBRAD_HEAT_PATCHES_DEFAULT) "]",
     TO_FUNCTION(take_patches, struct heat_request, problem.config.patches)},
    {0, "directions", "N",
     "directions of beams, " TEXT_DIRECTIONS
     " [" TEXT_OF(FIBRAD_HEAT_DIRECTIONS_DEFAULT) "; 112 if the mean emissivity is 0.35 or less]",
     TO_COUNT(struct heat_request, problem.config.directions, FIBRAD_DIRECTIONS_MIN, FIBRAD_DIRECTIONS_MAX)},
    {0, "points", "M", "points of each beam, 64, 128 or 256 [64; with --until 128]",
     TO_FUNCTION(option_points, struct heat_request, problem.config.points)},
    {0, "wall-rays", "N",
     "least number of rays from all walls, up to 2^30; errors of triangles fall as N^-0.5 [" TEXT_OF(
         FIBRAD_WALL_RAYS_DEFAULT) ", more with many "
                                   "beams or patches, or insulated walls]",
     TO_COUNT(struct heat_request, problem.config.wall_rays, 1, FIBRAD_WALL_RAYS_MAX)},
    {0, "error", "E",
     "error allowed in powers, estimated, relative to their root mean square, 1e-5 to 1; directions and patches are "
     "added until it is met; see below [none]",
     TO_NUMBER(struct heat_request, problem.error, 1e-5, 1)},
    OPTIONS_TIME(struct heat_request),
    OPTIONS_INPUT,
    {OPTION_BED_OUTPUT(
        "write the powers: .csv .dump (OVITO) .vtp (ParaView) .json, - for standard output [summary only]")},
    {OPTION_BED_FORMAT},
    {OPTION_PLOT("draw a picture by gnuplot, .svg or .png [none]")},
    {OPTION_SLICE},
    OPTIONS_RUN,
    {.name = NULL}};

static int heat_help(void) {
    puts("fibrad heat FILE... --emissivity E --temperature T --ambient T [options]\n\n"
         "Net radiative powers [W] of all spheres of FILE, of walls and of the surroundings, all grey and diffuse.\n"
         "A net power is above 0 where heat is gained. Where a power is given, the temperature is found [K].\n");
    options_print(heat_table);
    puts("\n" FILES_MORE "\n" WALLS_MORE "\n"
         "Each sphere has a temperature or a power. With both options, each sphere has a value from one of them.\n"
         "Example: --temperature 1:600 --power 2:5 gives 600 K to spheres of type 1, and 5 W to those of type 2.\n"
         "Columns have a blank or nan where the other option counts. A single number beside a list or a column is\n"
         "for the spheres that the list or column leaves out. A power is given off from inside, so the net power\n"
         "is its negative. An insulated wall sends back all that arrives, point by point. A sphere of emissivity 0\n"
         "reflects everything, gains nothing and has no temperature.\n"
         "\n"
         "--error E holds for the powers of the spheres together, for each wall, for the surroundings if a wall is\n"
         "insulated, and for T^4 where temperatures are found. Each error is relative to a root mean square. Where\n"
         "powers are below 1e-3 of what spheres emit or absorb, errors are relative to 1e-3 of what they emit or\n"
         "absorb.\n"
         "\n" LIGHT_MORE);
    puts(CONTACTS_MORE
         "\n"
         "--until: Each sphere stores specific heat times density times volume. --temperature is that at the\n"
         "beginning, and --power heats the spheres. @TABLE, two columns of seconds and temperatures, may stand for\n"
         "the temperature of a wall (zmin=@TABLE) or of the surroundings. The .csv then has the time in its first\n"
         "column. A series of .vtp has a .pvd for ParaView.\n");
    puts("@TABLE: A header has names and units, `t [min],T [C]` or `k [W/(m K)],T [K]`, and says which column is\n"
         "which. Beyond the ends of a table its first or last value is taken, with a warning.\n"
         "\n"
         "--solid-conductivity: Spheres conduct, and T_K is the mean over the surface. A power comes from a source\n"
         "that is spread evenly inside. Outputs have the least and the largest temperature of the surface, the\n"
         "temperature of the centre, and their estimated errors: T_min_K, T_max_K, T_surface_error_K,\n"
         "T_centre_K, T_centre_error_K. The unit of length must be known.\n"
         "\n"
         "The .csv has the columns i,T_K,q_W,q_error_W,T_error_K,body, with estimated errors. The surroundings are\n"
         "i = -1. Walls are i = -2, -3, ... with their names in the column `body`. All q_W add up to zero.\n"
         "\n"
         "Several frames go into one .csv, .dump or .json with their numbers. If OUT has a *, each frame has a\n"
         "file. Standard output ends with a summary of each frame, one `key value` on a line. Its balance and\n"
         "error are relative to what the spheres emit, or to what they absorb if that is more.\n");
    puts(
        "\nExamples:\n"
        "  fibrad heat packing.dump --emissivity 0.8 --temperature v_T --ambient 300 -o q.csv\n"
        "  fibrad heat 'bed.*.dump.gz' --frame all --emissivity 0.8 --temperature v_T --ambient 300 -o q.csv\n"
        "  fibrad heat packing.dump --emissivity 0.8 --power 40 --ambient 300 --wall box \\\n"
        "      --wall-temperature zmin=1200,insulated -o q.csv\n"
        "  fibrad heat spheres.csv --length-unit mm --emissivity eps --temperature T --temperature-unit C \\\n"
        "      --wall box --wall-temperature zmin=900,20 -o q.csv\n"
        "  fibrad heat packing.dump --emissivity 0.8 --temperature 1200 --ambient @room.csv --until 3600 \\\n"
        "      --heat-capacity 800 --density 2500 --every 60 -o 'cool.*.vtp' -o cool.csv --plot cool.png\n"
        "  fibrad heat pebbles.csv --length-unit m --emissivity 0.8 --solid-conductivity 30 --power 500 \\\n"
        "      --ambient 900 -o q.csv\n"
        "  fibrad heat packing.dump --emissivity 1:0.3,2:0.9 --temperature v_T --wall zmin,zmax=open,cylinder:0,0,0.48 "
        "\\\n"
        "      --wall-temperature zmin=1200,cylinder=600 --wall-emissivity cylinder=0.4 --ambient 300 --error 0.005 "
        "-o q.vtp");
    return STATUS_OK;
}

static int heat_check_request(struct heat_request *request) {
    request->bed.timed = request->given.timed = request->time.until > 0;
    request->problem.zero = request->given.zero;
    const fibrad_heat_config *config = &request->problem.config;
    const bool counted = config->directions > 0 || config->points > 0 || config->patches > 0 || config->wall_rays > 0;
    int status = bed_options_check(&request->bed, "heat", CONTENT_HEAT);
    if (status) return status;
    if (request->given.timed && request->problem.error > 0)
        return message(STATUS_USAGE, "--error is for powers at one time, not for --until");
    if (request->given.timed && request->face.wanted)
        return message(STATUS_USAGE, "--face is for powers at one time, not for --until");
    if (!request->given.timed && request->problem.by_factors)
        return message(STATUS_USAGE, "--model factors is for --until");
    if (!request->emissivity.given) return message(STATUS_USAGE, "--emissivity is missing; see fibrad heat --help");
    if (request->problem.error > 0 && counted)
        return message(
            STATUS_USAGE,
            "--error chooses directions and patches; leave out --directions, --points, --patches and --wall-rays");
    if (request->problem.error > 0 && request->problem.sources.uniform)
        return message(STATUS_USAGE,
                       "--error is for --model patches; --model spheres has an error that no directions reduce");
    if (request->solid.given && (request->problem.sources.uniform || request->problem.by_factors))
        return message(STATUS_USAGE,
                       "--solid-conductivity is for --model patches: in other models a sphere has no sides");
    if (contacts_given(&request->contacts) && request->problem.by_factors)
        return message(STATUS_USAGE, "--model factors has no contacts; use --model patches");
    bed_options_quantity(&request->bed, &request->emissivity, NULL);
    bed_options_quantity(&request->bed, &request->solid, SOLID_UNIT);
    status = contacts_check(&request->contacts, &request->bed, request->solid.given);
    if (!status) status = time_check(&request->time, &request->bed);
    if (!status) status = light_check(&request->light, &request->bed, &request->emissivity);
    if (!status) status = given_check(&request->given, &request->bed);
    return status ? status : given_ambient(&request->given, &request->problem.sources.surroundings);
}

static int heat_parse(struct heat_request *request, int argc, char **argv) {
    *request = (struct heat_request){.bed.files = 0};
    fibrad_heat_sources_init(&request->problem.sources);
    int status = options_read("heat", heat_table, argc, argv, request);
    if (!status) status = heat_check_request(request);
    if (request->problem.config.patches == 0) request->problem.config.patches = FIBRAD_HEAT_PATCHES_DEFAULT;
    return status;
}

/* Reports conductivities of the solid, and extreme temperatures of surfaces and centres. */
static void heat_print_solid(struct heat_request *request, const struct bed *bed, const struct heat_report *heat) {
    struct report *report = &request->bed.report;
    struct k_star all = {0};
    for (uint32_t i = 0; i < bed->n; ++i) /* a sphere that reflects all has no temperature */
        k_star_add(&all, fibrad_relative_conductivity(request->problem.solid[i], bed->r[i] * heat->metres,
                                                      heat->result.temperature[i], FIBRAD_STEFAN_BOLTZMANN));
    if (all.spheres > 0) solid_report(&request->solid, &all, report);
    if (heat->surface_max < 0) return; /* all spheres reflect everything */
    report_measured(report, "surface_min_K", heat->surface_min, heat->surface_error);
    report_measured(report, "surface_max_K", heat->surface_max, heat->surface_error);
    report_measured(report, "surface_span_K", heat->surface_span, heat->surface_error);
    report_value(report, "error_surface_rms_K", heat->surface_error, 2);
    report_measured(report, "centre_max_K", heat->centre_max, heat->surface_error);
}

static void heat_print(struct heat_request *request, const struct bed *bed, const struct heat_report *heat) {
    const fibrad_heat_result *result = &heat->result;
    const fibrad_heat_sources *sources = &request->problem.sources;
    struct report *report = &request->bed.report;
    bed_options_report(&request->bed, bed, &request->problem.walls, &heat->facts);
    report_text(report, "model", sources->uniform ? "spheres" : "patches");
    quantity_report(&request->emissivity, "emissivity", report);
    quantity_report(&request->given.temperature, request->given.zero > 0 ? "temperature_C" : "temperature_K", report);
    quantity_report(&request->given.power, "power_W", report);
    if (request->given.ambient) report_value(report, "surroundings_K", sources->surroundings, 6);
    wall_values_report(&request->problem.walls, result->wall_temperature, "_K", 6, report);
    wall_values_report(&request->problem.walls, sources->wall_emissivity, "_emissivity", 6, report);
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
    if (request->given.ambient) {
        report_measured(report, "surroundings_W", result->surroundings_power, result->surroundings_error);
        report_value(report, "surroundings_error_W", result->surroundings_error, 2);
    }
    wall_values_report(&request->problem.walls, result->wall_power, "_W", 6, report);
    wall_values_report(&request->problem.walls, result->wall_error, "_error_W", 2, report);
    for (uint32_t k = 0; k < request->problem.walls.count; ++k) {
        if (!wall_endless(&request->problem.walls, bed, &request->problem.walls.wall[k])) continue;
        report_value(report, report_key(report, "wall_%s_part_m2", wall_name(&request->problem.walls, k)),
                     result->wall_area[k], 6);
    }
    if (heat->unknown) {
        report_measured(report, "temperature_min_K", heat->coldest, heat->temperature_error);
        report_measured(report, "temperature_mean_K", heat->temperature_mean, heat->temperature_error);
        report_measured(report, "temperature_max_K", heat->hottest, heat->temperature_error);
        report_value(report, "error_temperature_rms_K", heat->temperature_error, 2);
    }
    face_report(&request->face, heat->metres, report);
    light_report(request->problem.light, &request->problem.walls, bed->n, report);
    contacts_report(request->problem.contacts, bed, &request->problem.walls, report);
    if (request->problem.solid) heat_print_solid(request, bed, heat);
    report_value(report, "balance_of_emission", heat->balance_of_emission, 2);
    report_value(report, "error_of_emission", heat->throughput > 0 ? heat->error / heat->throughput : 0, 2);
    report_value(report, "error_rms_W", heat->error, 2);
    if (request->problem.error > 0)
        report_wanted(report, request->bed.name, request->problem.error, request->problem.error, heat->error_reached,
                      "the powers of spheres, of a wall or of the T^4 that were found");
    report_end(report);
}

static int heat_picture(const struct heat_request *request, const struct bed *bed, const struct heat_report *report) {
    const struct heat_problem *problem = &request->problem;
    const struct heat_shown shown = {.bed = bed,
                                     .walls = &problem->walls,
                                     .metres = report->metres,
                                     .temperature = report->result.temperature,
                                     .power = report->result.power,
                                     .wall_temperature = report->result.wall_temperature,
                                     .wall_power = report->result.wall_power,
                                     .surroundings_temperature = problem->sources.surroundings,
                                     .surroundings_power =
                                         request->given.ambient ? report->result.surroundings_power : NAN,
                                     .found = report->unknown > 0,
                                     .absorbed = problem->light->options ? problem->light->absorbed : NULL,
                                     .plane = request->bed.slice};
    return plot_heat(&request->bed.picture, request->bed.name, &shown);
}

static int heat_solve(struct heat_request *request, struct bed *bed, struct heat_report *report) {
    int status = heat_run(&request->bed, &request->problem, bed, report);
    struct contents what = {.walls = &request->problem.walls,
                            .sources = &request->problem.sources,
                            .result = &report->result,
                            .light = request->problem.light->options ? &request->problem.light->result : NULL,
                            .of_sides = &report->triangles};
    if (!status) status = bed_options_write(&request->bed, bed, &what);
    if (!status && request->bed.outputs.picture) status = heat_picture(request, bed, report);
    if (!status) status = light_profile(request->problem.light, bed, request->bed.name);
    if (!status) status = contacts_write(request->problem.contacts, bed, &request->problem.walls);
    if (!status) heat_print(request, bed, report);
    return status;
}

/* Arrays of a result for spheres: the last INSIDE are of spheres that conduct. */
enum { ARRAYS = 9, INSIDE = 5 };
static double **heat_array(fibrad_heat_result *result, size_t k) {
    double **const of_spheres[ARRAYS] = {&result->power,
                                         &result->temperature,
                                         &result->power_error,
                                         &result->temperature_error,
                                         &result->least_temperature,
                                         &result->largest_temperature,
                                         &result->centre_temperature,
                                         &result->surface_error,
                                         &result->centre_error};
    return of_spheres[k];
}

/* Allocates the arrays of a result for n spheres. */
static int heat_arrays(fibrad_heat_result *result, uint32_t n, bool conducts) {
    int status = STATUS_OK;
    for (size_t k = 0; k < (conducts ? ARRAYS : ARRAYS - INSIDE); ++k) {
        double **array = heat_array(result, k);
        *array = calloc(n, sizeof(double));
        if (!*array && !status) status = message_memory();
    }
    return status;
}

/* Finds the conductivities of the solid, and allocates room for them in the unit of the library. In time powers are in
 * watts, and sigma has the square of the unit of length. */
static int heat_solid(struct heat_request *request, const struct bed *bed) {
    struct heat_problem *problem = &request->problem;
    double metres;
    problem->solid = problem->conductivity = NULL;
    problem->of_solid = &request->solid;
    problem->sources.conductivity = NULL;
    if (!request->solid.given) return STATUS_OK;
    const int status = solid_values(&request->bed, bed, &request->solid, &problem->solid, &metres);
    if (status) return status;
    problem->sources.conductivity = problem->conductivity = calloc(bed->n, sizeof *problem->conductivity);
    problem->per_watt = request->given.timed ? metres : 1 / metres;
    for (uint32_t i = 0; i < bed->n && problem->conductivity; ++i)
        problem->conductivity[i] = problem->solid[i] * problem->per_watt;
    return problem->conductivity ? STATUS_OK : message_memory();
}

/* Warns of temperatures about the bed. If none is given within a closed bed, that of the surroundings is the level. */
static void warn_outside(struct heat_request *request, const struct bed *bed, const struct given *given) {
    struct warned *warned = &request->bed.warned;
    const struct walls *walls = &request->problem.walls;
    bool known = false;
    for (uint32_t i = 0; i < bed->n && !known; ++i) known = !isnan(given->temperature[i]);
    for (uint32_t k = 0; k < walls->count; ++k) {
        known = known || !isnan(given->wall_temperature[k]);
        if (request->given.zero == 0) warn_around(warned, wall_name(walls, k), given->wall_temperature[k]);
    }
    if (request->given.ambient && request->given.zero == 0)
        warn_around(warned, "--ambient", request->problem.sources.surroundings);
    if (request->given.ambient && known && walls_closed(walls, bed)) warn_closed(warned);
}

static int heat_frame(void *heat_request, struct bed *bed) {
    struct heat_request *request = heat_request;
    struct heat_report report = {0};
    struct walls *walls = &request->problem.walls;
    fibrad_heat_sources *sources = &request->problem.sources;
    struct given given = {0};
    struct light_state light = {0};
    struct contact_state contacts = {0};
    double *emissivity = NULL, of_walls[7][WALLS_MAX] = {{0}};
    const char *file = request->bed.name;
    int status = bed_options_walls(&request->bed, bed, walls);
    if (!status) status = given_values(&request->given, bed, file, walls, &given);
    if (!status && !request->given.ambient && !walls_closed(walls, bed))
        status =
            message(STATUS_USAGE, "--ambient is missing: the bed is open, and the surroundings need a temperature");
    if (!status) status = wall_emissivities(request->wall_emissivity, walls, of_walls[0]);
    if (!status) status = quantity_values(&request->emissivity, bed, file, "emissivity", 0, 0, 1, &emissivity);
    if (!status) status = face_begin(&request->face, bed, walls);
    if (!status) status = light_begin(&light, &request->light, bed, file, walls, emissivity, of_walls[0]);
    const bool checked = !request->given.timed && !contacts_given(&request->contacts); /* contacts: by the library */
    if (!status && checked) status = given_reflectors(&given, emissivity, walls, of_walls[0], bed, file);
    if (!status) status = bed_options_metres(&request->bed, bed, &report.metres);
    if (!status)
        warn_temperatures(&request->bed.warned, bed, bed_options_column(&request->bed, &request->given.temperature),
                          request->given.zero, given.temperature);
    if (!status) warn_outside(request, bed, &given);
    if (!status) status = heat_arrays(&report.result, bed->n, request->solid.given);
    if (!status) status = heat_solid(request, bed);
    if (!status && request->bed.wall_vtp) status = triangle_heat_begin(&report.triangles, walls);
    if (!status) {
        given_heat_sources(&given, bed->n, request->given.timed ? 1 : report.metres, sources);
        sources->emissivity = emissivity, sources->wall_emissivity = of_walls[0];
        const double per_watt = request->given.timed ? 1 : 1 / (report.metres * report.metres);
        status = contacts_begin(&contacts, &request->contacts, &request->bed, bed, walls, &request->solid, per_watt,
                                sources);
        contacts_result(&contacts, &report.result);
        request->problem.contacts = &contacts;
        request->problem.wall_curve = given.tables.curve,
        request->problem.ambient_curve = &request->given.ambient_curve;
        request->problem.light = &light, request->problem.face = &request->face;
        request->problem.emissivity = emissivity, request->problem.of_emissivity = &request->emissivity;
        report.result.wall_power = of_walls[1], report.result.wall_temperature = of_walls[2];
        report.result.wall_absorbed = of_walls[5], report.result.wall_area = of_walls[6];
        report.result.wall_error = of_walls[3], report.result.wall_temperature_error = of_walls[4];
    }
    if (!status) {
        status = request->given.timed ? heat_in_time(&request->bed, &request->time, &request->problem, bed, &report,
                                                     request->bed.outputs.picture ? &request->bed.picture : NULL)
                                      : heat_solve(request, bed, &report);
    }
    free(emissivity);
    light_free(&light);
    contacts_free(&contacts);
    given_free(&given);
    free(request->problem.solid);
    free(request->problem.conductivity);
    request->problem.solid = request->problem.conductivity = NULL;
    for (size_t k = 0; k < ARRAYS; ++k) free(*heat_array(&report.result, k));
    side_arrays_free(&report.triangles);
    return status;
}

int command_heat(int argc, char **argv) {
    struct heat_request request;
    const int status = heat_parse(&request, argc, argv);
    const int ended = bed_options_end(&request.bed, status, heat_help, heat_frame, &request);
    quantity_free(&request.emissivity);
    quantity_free(&request.solid);
    quantity_free(&request.contacts.conductivity);
    curve_free(&request.contacts.gas_curve);
    curve_free(&request.given.ambient_curve);
    return ended;
}
