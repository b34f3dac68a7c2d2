/* command_conductivity.c - `fibrad conductivity`: effective radiative conductivity of a bed of grey spheres.
 * SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bed/conduction.h"
#include "bed/property_option.h"
#include "cli/message.h"
#include "cli/output.h"
#include "command/bed_options.h"
#include "command/commands.h"

enum { KEY_AXIS = KEY_OWN, KEY_CONDUCTIVITY_TEMPERATURE, KEY_MAX_RAYS };

static const struct option conductivity_table[] = {
    {OPTION_EMISSIVITY},
    {KEY_CONDUCTIVITY_TEMPERATURE, "temperature", "T", "mean temperature [K], for k [none: F_E alone]"},
    {KEY_AXIS, "axis", "x|y|z", "F_E along this axis alone, and --error for it alone [all three]"},
    {KEY_RAYS, "rays", "N", "paths from each sphere; error ~ N^-0.5 [as many as --error takes]"},
    {KEY_ERROR, "error", "E", "as many as bring the estimated standard errors to E of F_E, 1e-4 to 1 [0.003]"},
    {KEY_MAX_RAYS, "max-rays", "N", "no more rays in all than about so many for --error [5e7]"},
    {KEY_SEED, "seed", "S", "another number, other paths and directions [0]"},
    {OPTION_PERIODIC},
    {OPTION_FRAME},
    {OPTION_THREADS},
    {'o', "output", "OUT", "F_E and k per axis: .csv or .json [summary only]"},
    {OPTION_PROGRESS},
    {OPTION_HELP},
    {0, NULL, NULL, NULL}};

struct conductivity_request {
    struct bed_options bed;
    struct quantity emissivity;
    double temperature; /* [K]; below 0: not given */
    double metre;       /* of the file's unit of length */
    struct conduction_rule rule;
};

static int conductivity_help(void) {
    puts("fibrad conductivity FILE --emissivity E|COLUMN [options]\n\n"
         "Exchange factor F_E = k/(4 sigma T^3 d) along each axis, k being the radiative conductivity [W/(m K)] of a "
         "bed of\n"
         "grey diffuse spheres, each of one temperature (their own conductivity is large), and d the mean diameter "
         "[m].\n"
         "FILE as for fibrad bed.\n");
    options_print(conductivity_table);
    printf(
        "\nThe result is that of a linear field of temperature. With open axes only spheres at least %g mean "
        "diameters inside\n"
        "the outermost centres emit; all absorb. Where a periodic bed has gaps, flights may be so long that F_E along "
        "them\n"
        "does not exist or its standard error cannot be estimated: a warning says so.\n",
        CONDUCTION_MARGIN);
    puts("Standard output ends with lines `key value`, the last of them F_E_x, F_E_y, F_E_z, F_E_x_error, "
         "F_E_y_error,\n"
         "F_E_z_error (standard errors, estimated); `unreliable`: the axes whose errors are not to be relied on. With\n"
         "--temperature k_x ... k_z_error [W/(m K)] come before.\n\n"
         "Examples:\n"
         "  fibrad conductivity packing.dump --emissivity 0.8\n"
         "  fibrad conductivity packing.dump --emissivity 0.8 --axis z --temperature 1200 -o k.csv\n"
         "  fibrad conductivity cell.csv --periodic 2,2,2 --emissivity 0.4 --error 0.001");
    return STATUS_OK;
}

static int take_axis(const char *text, int *axis) {
    if (strcmp(text, "x") != 0 && strcmp(text, "y") != 0 && strcmp(text, "z") != 0)
        return message(STATUS_USAGE, "--axis: '%.40s' is none of x, y and z", text);
    *axis = text[0] - 'x';
    return STATUS_OK;
}

/* Whole numbers, also those such as 2e8. */
static int take_rays(const char *text, uint64_t *rays) {
    double value;
    const int status = options_number("--max-rays", text, 1, 1e15, &value);
    *rays = (uint64_t)value;
    return status;
}

static int conductivity_take(struct conductivity_request *request, const struct options *options, int key) {
    const char *value = options->value;
    struct conduction_rule *rule = &request->rule;
    switch (key) {
    case KEY_EMISSIVITY:
        return emissivity_option(value, &request->emissivity);
    case KEY_CONDUCTIVITY_TEMPERATURE:
        return options_number("--temperature", value, 0, TEMPERATURE_MAX, &request->temperature);
    case KEY_AXIS:
        return take_axis(value, &rule->axis);
    case KEY_RAYS:
        return options_whole("--rays", value, 1, FIBRAD_PATHS_MAX, &rule->paths);
    case KEY_ERROR:
        return options_number("--error", value, 1e-4, 1, &rule->error);
    case KEY_MAX_RAYS:
        return take_rays(value, &rule->max_rays);
    case KEY_SEED:
        return options_whole("--seed", value, 0, UINT64_MAX, &rule->seed);
    default:
        return bed_options_take(&request->bed, options, key);
    }
}

static int conductivity_parse(struct conductivity_request *request, int argc, char **argv) {
    struct options options = {.command = "conductivity", .table = conductivity_table, .argc = argc, .argv = argv};
    *request = (struct conductivity_request){.bed.frame = -1, .temperature = -1, .metre = 1, .rule.axis = -1};
    struct conduction_rule *rule = &request->rule;
    int status = STATUS_OK;
    for (int key; !status && (key = options_next(&options)) != OPTIONS_END;)
        status = conductivity_take(request, &options, key);
    if (status) return status;
    if (!request->bed.file) return message(STATUS_USAGE, "which FILE? see fibrad conductivity --help");
    if (!request->emissivity.given) return message(STATUS_USAGE, "which --emissivity? see fibrad conductivity --help");
    if (rule->error > 0 && rule->paths > 0)
        return message(STATUS_USAGE, "--error finds the rays itself; leave out --rays");
    if (rule->max_rays > 0 && rule->paths > 0)
        return message(STATUS_USAGE, "--max-rays is for --error; leave out --rays");
    if (rule->error == 0) rule->error = 0.003;
    if (rule->max_rays == 0) rule->max_rays = 50000000;
    request->emissivity.place = bed_options_column(&request->bed, request->emissivity.column);
    const bool known = output_ends(request->bed.out, ".csv") || output_ends(request->bed.out, ".json");
    return bed_options_output(&request->bed, known, ".csv and .json");
}

static bool is_wanted(const struct conductivity_request *request, int axis) {
    return request->rule.axis < 0 || request->rule.axis == axis;
}

/* The axes with some of these kinds of flights, such as "xz"; how many there are. */
static int axes_with(const struct conductivity_request *request, const struct conduction *result, unsigned kinds,
                     char axes[4]) {
    int count = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (is_wanted(request, axis) && conduction_flights(result, axis) & kinds) axes[count++] = (char)('x' + axis);
    axes[count] = 0;
    return count;
}

/* A line PREFIX axis SUFFIX value for each axis that is wanted. */
static void print_axes(const struct conductivity_request *request, const char *prefix, const char *suffix,
                       const double value[3]) {
    for (int axis = 0; axis < 3; ++axis)
        if (is_wanted(request, axis)) printf("%s%c%s %.17g\n", prefix, 'x' + axis, suffix, value[axis]);
}

static void conductivity_print(const struct conductivity_request *request, const struct bed *bed,
                               const struct conduction *result) {
    char unreliable[4];
    printf("%s: paths of grey diffuse radiation in a linear field of temperature\n", request->bed.name);
    printf("spheres %" PRIu32 "\n", bed->n);
    printf("emitters %" PRIu32 "\n", result->emitters);
    printf("diameter %.17g\n", result->diameter);
    printf("solid_fraction %.17g\n", result->solid_fraction);
    printf("paths %" PRIu64 "\n", result->paths);
    printf("rays %" PRIu64 "\n", result->rays);
    printf("seconds %.17g\n", result->seconds);
    printf("escaped %.17g\n", result->escaped);
    axes_with(request, result, FLIGHTS_ENDLESS | FLIGHTS_RARE, unreliable);
    printf("unreliable %s\n", *unreliable ? unreliable : "none");
    if (request->temperature >= 0) {
        printf("temperature %.17g\n", request->temperature);
        print_axes(request, "k_", "", result->k);
        print_axes(request, "k_", "_error", result->k_error);
    }
    print_axes(request, "F_E_", "", result->factor);
    print_axes(request, "F_E_", "_error", result->error);
}

static void conductivity_warn(const struct conductivity_request *request, const struct conduction *result) {
    const char *file = request->bed.name;
    char axes[4];
    if (result->escaped > 1e-3)
        fprintf(stderr, "fibrad: %s: warning: %.2g of what the core emits leaves the bed; F_E is too low\n", file,
                result->escaped);
    if (axes_with(request, result, FLIGHTS_ENDLESS, axes))
        fprintf(stderr,
                "fibrad: %s: warning: F_E along %s does not exist: flights through a gap across the whole bed have no "
                "mean square length; it is given for flights of up to 100 periods, its standard error is unreliable\n",
                file, axes);
    if (axes_with(request, result, FLIGHTS_RARE, axes))
        fprintf(stderr,
                "fibrad: %s: warning: F_E along %s rests on a few long flights, as through a channel without spheres; "
                "its standard error is unreliable\n",
                file, axes);
    if (result->stopped)
        fprintf(stderr, "fibrad: %s: warning: stopped at --max-rays %g with a standard error of %.2g of F_E, not %g\n",
                file, (double)request->rule.max_rays, conduction_worst(&request->rule, result), request->rule.error);
}

static void write_csv_axes(FILE *file, const struct conductivity_request *request, const struct conduction *result) {
    fputs("axis,F_E,F_E_error,k_W_mK,k_error\n", file);
    for (int axis = 0; axis < 3; ++axis) {
        if (!is_wanted(request, axis)) continue;
        fprintf(file, "%c,%.17g,%.17g,", 'x' + axis, result->factor[axis], result->error[axis]);
        if (request->temperature >= 0)
            fprintf(file, "%.17g,%.17g\n", result->k[axis], result->k_error[axis]);
        else
            fputs(",\n", file);
    }
}

static void write_json_axes(FILE *file, const struct conductivity_request *request, const struct conduction *result) {
    const char *comma = "";
    fprintf(file,
            "{\"spheres_emitting\": %" PRIu32 ", \"diameter\": %.17g, \"solid_fraction\": %.17g, \"rays\": %" PRIu64
            ",\n \"axes\": [",
            result->emitters, result->diameter, result->solid_fraction, result->rays);
    for (int axis = 0; axis < 3; ++axis) {
        if (!is_wanted(request, axis)) continue;
        fprintf(file, "%s\n  {\"axis\": \"%c\", \"F_E\": %.17g, \"F_E_error\": %.17g, \"error_reliable\": %s", comma,
                'x' + axis, result->factor[axis], result->error[axis],
                conduction_flights(result, axis) == FLIGHTS_SETTLED ? "true" : "false");
        if (request->temperature >= 0)
            fprintf(file, ", \"k_W_mK\": %.17g, \"k_error\": %.17g", result->k[axis], result->k_error[axis]);
        fputc('}', file);
        comma = ",";
    }
    fputs("]}\n", file);
}

static int conductivity_write(const struct conductivity_request *request, const struct conduction *result) {
    struct output output;
    int status = output_open(&output, request->bed.out);
    if (!status && output.file)
        (output_ends(request->bed.out, ".csv") ? write_csv_axes : write_json_axes)(output.file, request, result);
    return output_close(&output, status);
}

static int conductivity_compute(struct conductivity_request *request, const struct bed *bed,
                                struct conduction *result) {
    const char *file = request->bed.name;
    double *emissivity = NULL;
    unsigned char *emits = calloc(bed->n, 1);
    int status = emits ? STATUS_OK : message_memory();
    if (!status) status = emissivity_of(&request->emissivity, bed, file, &emissivity);
    if (!status) status = conduction_emitters(bed, file, emits, result);
    if (!status) {
        fibrad_run run = bed_options_run(&request->bed);
        request->rule.emissivity = emissivity;
        status = conduction_follow(bed, emits, &request->rule, &run, result);
        status = bed_options_status(&request->bed, bed, status, &run.fault);
    }
    if (!status && request->temperature >= 0) conduction_at(result, request->temperature, request->metre);
    free(emits);
    free(emissivity);
    return status;
}

int command_conductivity(int argc, char **argv) {
    struct conductivity_request request;
    struct conduction result;
    struct bed bed = {0};
    int status = conductivity_parse(&request, argc, argv);
    if (status) return status == STATUS_HELP ? conductivity_help() : status;
    status = bed_options_read(&request.bed, &bed);
    if (!status) status = conductivity_compute(&request, &bed, &result);
    if (!status) status = conductivity_write(&request, &result);
    if (!status) {
        conductivity_warn(&request, &result);
        conductivity_print(&request, &bed, &result);
    }
    bed_free(&bed);
    return status;
}
