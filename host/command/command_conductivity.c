/* command_conductivity.c - `fibrad conductivity`: effective radiative conductivity of a bed of grey spheres.
 * SPDX-License-Identifier: MIT */
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "command/commands.h"
#include "conductivity/plates.h"
#include "contact_options/contact_option.h"

enum { TEMPERATURES_MAX = 1000 };

struct conductivity_request {
    struct bed_options bed;
    struct quantity emissivity, solid;
    const char *at;                       /* --temperature; NULL: not given */
    double zero;                          /* 0 of the unit of temperature [K] */
    double temperature[TEMPERATURES_MAX]; /* [temperatures] [K]; NaN: F_E only */
    int temperatures;
    struct walls walls;
    struct conduction_rule rule;
    bool steady;
    struct contact_options contacts;
};

static int take_axis(const char *text, void *axis) {
    if (strcmp(text, "x") != 0 && strcmp(text, "y") != 0 && strcmp(text, "z") != 0)
        return message(STATUS_USAGE, "--axis: '%.40s' is none of x, y and z", text);
    *(int *)axis = text[0] - 'x';
    return STATUS_OK;
}

/* Reads --max-rays, which may be written like 2e8. */
static int take_rays(const char *text, void *rays) {
    double value;
    const int status = options_number("--max-rays", text, 1, 1e15, &value);
    *(uint64_t *)rays = (uint64_t)value;
    return status;
}

static const struct option conductivity_table[] = {
    {OPTION_EMISSIVITY(struct conductivity_request, emissivity)},
    {0, "temperature", "T",
     "mean temperature, for k; or several: a list T,T,... or FROM:TO:STEP; outputs have all of them [none: F_E only]",
     TO_TEXT(struct conductivity_request, at)},
    {OPTION_TEMPERATURE_UNIT(struct conductivity_request, zero)},
    {0, "axis", "x|y|z", "axis of F_E and of --error [all three]",
     TO_FUNCTION(take_axis, struct conductivity_request, rule.axis)},
    {0, "error", "E", "standard error allowed, relative to F_E; 1e-4 to 1; paths are added until it is met [0.003]",
     TO_NUMBER(struct conductivity_request, rule.error, 1e-4, 1)},
    {OPTION_SOLID_CONDUCTIVITY(struct conductivity_request, solid)},
    {0, "steady", NULL,
     "compute also F_E of the bed between two black plates; for spheres whose net power is 0, along each axis whose "
     "other two axes are periodic or end at walls",
     TO_FLAG(struct conductivity_request, steady)},
    {0, "wall", "LIST",
     "sides of the bed, which reflect all: cylinder:X,Y,R, box, xmin ...; as in fibrad heat, none of them across the "
     "axis of F_E [none]",
     TO_FUNCTION(walls_option, struct bed_options, walls)},
    OPTIONS_CONTACTS(struct conductivity_request),
    OPTIONS_INPUT,
    {OPTION_BED_OUTPUT("write F_E and k of each axis: .csv .json, - for standard output [summary only]")},
    OPTIONS_RUN,
    OPTIONS_RARE,
    {0, "rays", "N", "paths from each sphere; the error falls as N^-0.5 [as many as --error needs]",
     TO_WHOLE(struct conductivity_request, rule.paths, 1, FIBRAD_PATHS_MAX)},
    {0, "max-rays", "N", "approximate limit of the rays that --error may take in all [5e7]",
     TO_FUNCTION(take_rays, struct conductivity_request, rule.max_rays)},
    {0, "seed", "S", "seed of paths and directions [0]", TO_WHOLE(struct conductivity_request, rule.seed, 0, INFINITY)},
    OPTIONS_CONTACTS_RARE(struct conductivity_request),
    OPTIONS_INPUT_RARE,
    {OPTION_BED_FORMAT},
    {.name = NULL}};

static int conductivity_help(void) {
    static_assert(CONDUCTION_MARGIN == 4 && CONDUCTION_MARGIN_WALK == 8, "the text has these numbers");
    options_help(
        "conductivity",
        "fibrad conductivity FILE... --emissivity E [options]\n\n"
        "Exchange factor F_E = k/(4 sigma T^3 d) of a bed of grey diffuse spheres along each axis. k is the\n"
        "radiative conductivity of the bed [W/(m K)]. d is the mean diameter of the spheres [m]. Each sphere has\n"
        "one temperature, unless --solid-conductivity says how well it conducts.\n",
        conductivity_table,
        (const char *const[]){
            FILES_MORE, WALLS_MORE,
            "F_E is found with temperatures that rise linearly along the axis. All spheres absorb. Along open axes\n"
            "only spheres deep inside the bed emit, 4 mean diameters or more from the outermost centres (8 with\n"
            "--solid-conductivity). With --axis, the bed may be too thin for this along another axis. Spheres at any\n"
            "place along that other axis then emit. Where a periodic bed has gaps, flights may be so long that F_E\n"
            "does not exist, or that its standard error cannot be estimated. Then there is a warning.\n",
            "A bed in a container loses radiation through its sides, unless --wall has them: F_E is then that of a\n"
            "tube or a box that goes on along the axis, over the area within the walls. Walls reflect diffusely.\n",
            "Standard output ends with lines `key value`. F_E_x, F_E_y and F_E_z are the exchange factors.\n"
            "F_E_x_error, F_E_y_error and F_E_z_error are their estimated standard errors. `unreliable` names the\n"
            "axes whose F_E or error is not reliable. There, .csv has `reliable` 0 and the reason in `warning`.\n"
            "With --temperature there are also k_x_W_mK to k_z_W_mK and k_x_W_mK_error to k_z_W_mK_error. With\n"
            "--solid-conductivity k_star is k_s/(4 d sigma T^3), and F_E is that of spheres whose temperatures differ\n"
            "from point to point. Without --solid-conductivity, if the unit of length is known, the line\n"
            "`isothermal` has a k_s. Above this k_s, F_E with one temperature for each sphere is right to 5 %.\n",
            CONTACTS_MORE
            "With --contacts or --gas-conductivity, --steady finds k_total of the bed with radiation and contacts,\n"
            "k_radiation without contacts and k_conduction without radiation. Spheres within a diameter of a plate\n"
            "have its temperature.\n",
            NULL},
        "Examples:\n"
        "  fibrad conductivity packing.dump --emissivity 0.8 --axis z --temperature 1200 -o k.csv\n"
        "  fibrad conductivity pebbles.dump --emissivity 0.8 --steady --temperature 1000 --contacts hertz \\\n"
        "      --contact-conductivity 30 --contact-scale 0.05\n"
        "  fibrad conductivity pebbles.dump --emissivity 0.8 --temperature 300:2000:100 --solid-conductivity 30\n"
        "  fibrad conductivity tube.dump --emissivity 0.8 --wall cylinder:0,0,0.03 --steady\n");
    return STATUS_OK;
}

/* Reads --temperature: a number, a list, or FROM:TO:STEP. */
static int take_temperatures(struct conductivity_request *request) {
    double *t = request->temperature, range[3];
    char from[80] = "";
    int status = STATUS_OK, count = 0;
    request->temperatures = 1;
    t[0] = NAN;
    if (!request->at) return STATUS_OK;
    if (strchr(request->at, ':')) {
        snprintf(from, sizeof from, "%s", request->at);
        for (char *colon; (colon = strchr(from, ':'));) *colon = ',';
        status = options_numbers("--temperature", from, 3, range, &count);
        const double steps = floor((range[1] - range[0]) / range[2] * (1 + 1e-12));
        if (!status && (count != 3 || !(range[2] > 0 && steps >= 0 && steps < TEMPERATURES_MAX)))
            return message(STATUS_USAGE,
                           "--temperature: '%.40s' is not FROM:TO:STEP, which ascends, with at most %d temperatures",
                           request->at, TEMPERATURES_MAX);
        if (!status) request->temperatures = 1 + (int)steps;
        for (int k = 0; k < request->temperatures && !status; ++k) t[k] = range[0] + k * range[2];
    } else {
        status = options_numbers("--temperature", request->at, TEMPERATURES_MAX, t, &request->temperatures);
    }
    for (int k = 0; k < request->temperatures && !status; ++k) {
        t[k] += request->zero;
        if (!(t[k] >= 0 && t[k] <= TEMPERATURE_MAX))
            return message(STATUS_USAGE, "--temperature: %g is not within %g and %g", t[k] - request->zero,
                           0 - request->zero, TEMPERATURE_MAX);
    }
    return status;
}

/* Outputs that show one temperature only. */
static int check_outputs(const struct conductivity_request *request) {
    const struct outputs *outputs = &request->bed.outputs;
    if (request->temperatures == 1) return STATUS_OK;
    for (size_t k = 0; k < outputs->count; ++k)
        if (outputs->to[k].star)
            return message_at(STATUS_USAGE, outputs->to[k].path, 0,
                              "a file for each frame has one temperature; --temperature has several");
    return STATUS_OK;
}

static int conductivity_parse(struct conductivity_request *request, int argc, char **argv) {
    *request = (struct conductivity_request){.rule.axis = -1};
    struct conduction_rule *rule = &request->rule;
    int status = options_read("conductivity", conductivity_table, argc, argv, request);
    if (status) return status;
    status = take_temperatures(request);
    if (status) return status;
    if (!request->emissivity.given && request->bed.files > 0)
        return message(STATUS_USAGE, "--emissivity is missing; see fibrad conductivity --help");
    if (contacts_given(&request->contacts) && !(request->steady && request->at))
        return message(STATUS_USAGE, "--contacts and --gas-conductivity need --steady and --temperature");
    for (int k = 0; k < request->temperatures; ++k)
        if (contacts_given(&request->contacts) && !(request->temperature[k] > 0))
            return message(STATUS_USAGE, "--contacts and --gas-conductivity need a --temperature above 0 K");
    if (request->contacts.flows) return message(STATUS_USAGE, "--contact-flows is an option of fibrad heat");
    if (request->solid.given && !request->at) return message(STATUS_USAGE, "--solid-conductivity needs --temperature");
    if (rule->error > 0 && rule->paths > 0) return message(STATUS_USAGE, "--error chooses the rays; leave out --rays");
    if (rule->max_rays > 0 && rule->paths > 0)
        return message(STATUS_USAGE, "--max-rays is for --error; leave out --rays");
    if (rule->error == 0) rule->error = 0.003;
    if (rule->max_rays == 0) rule->max_rays = 50000000;
    bed_options_quantity(&request->bed, &request->emissivity, NULL);
    bed_options_quantity(&request->bed, &request->solid, SOLID_UNIT);
    status = contacts_check(&request->contacts, &request->bed, request->solid.given);
    if (!status) status = bed_options_check(&request->bed, "conductivity", CONTENT_CONDUCTION);
    return status ? status : check_outputs(request);
}

/* Lists the axes with flights of one of these kinds, such as "xz". Returns their number. */
static int axes_with(const struct conduction *result, unsigned kinds, char axes[4]) {
    int count = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (conduction_wants(result, axis) && conduction_flights(result, axis) & kinds)
            axes[count++] = (char)('x' + axis);
    axes[count] = 0;
    return count;
}

/* Reports values of the wanted axes, then their errors under keys that end with _error. */
static void report_axes(struct report *report, const struct conduction *result, const char *name, const char *unit,
                        const double value[3], const double error[3]) {
    for (int axis = 0; axis < 3; ++axis)
        if (conduction_wants(result, axis))
            report_measured(report, report_key(report, "%s_%c%s", name, 'x' + axis, unit), value[axis], error[axis]);
    for (int axis = 0; axis < 3; ++axis)
        if (conduction_wants(result, axis))
            report_value(report, report_key(report, "%s_%c%s_error", name, 'x' + axis, unit), error[axis], 2);
}

/* Reports what was found between plates along an axis. */
static void report_plates(struct report *report, int axis, const struct conduction_plates *plates) {
    static const char *const names[] = {"F_E_steady_%c", "k_total_%c_W_mK", "k_radiation_%c_W_mK",
                                        "k_conduction_%c_W_mK"};
    const struct conduction_value *const of[] = {&plates->factor, &plates->both, &plates->radiation,
                                                 &plates->conduction};
    if (plates->spheres == 0) return;
    report_value(report, report_key(report, "seconds_steady_%c", 'x' + axis), plates->seconds, 3);
    if (plates->touches) report_count(report, report_key(report, "contacts_%c", 'x' + axis), plates->contacts);
    for (int k = 0; k < (plates->touches ? 4 : 1); ++k) {
        char name[40];
        snprintf(name, sizeof name, names[k], 'x' + axis);
        report_measured(report, report_key(report, "%s", name), of[k]->k, of[k]->error);
        report_value(report, report_key(report, "%s_error", name), of[k]->error, 2);
    }
}

static void conductivity_report(struct conductivity_request *request, const struct bed *bed,
                                const struct conduction *result) {
    struct report *report = &request->bed.report;
    char unreliable[4];
    bed_options_report(&request->bed, bed, &request->walls, NULL);
    quantity_report(&request->emissivity, "emissivity", report);
    if (request->solid.given) solid_report(&request->solid, &result->k_star, report);
    report_count(report, "emitters", result->emitters);
    report_value(report, "diameter", result->diameter, 6);
    report_value(report, "solid_fraction", result->solid_fraction, 4);
    report_count(report, "seed", request->rule.seed);
    report_count(report, "paths", result->paths);
    report_count(report, "rays", result->rays);
    report_value(report, "seconds", result->seconds, 3);
    report_value(report, "escaped", result->escaped, 2);
    if (request->rule.paths == 0)
        report_wanted(report, request->bed.name, request->rule.error, result->stopped ? request->rule.error : INFINITY,
                      conduction_worst(&request->rule, result), "F_E; more --max-rays would help");
    axes_with(result, FLIGHTS_ENDLESS | FLIGHTS_RARE | FLIGHTS_LEAVING, unreliable);
    report_text(report, "unreliable", *unreliable ? unreliable : "none");
    if (!isnan(result->isothermal)) {
        char text[80];
        snprintf(text, sizeof text, "right to 5 %% for k_s above %.3g W/(m K)",
                 result->isothermal * pow(result->temperature, 3));
        report_text(report, "isothermal", text);
    }
    if (!isnan(result->temperature)) {
        report_value(report, "temperature_K", result->temperature, 6);
        report_axes(report, result, "k", "_W_mK", result->k, result->k_error);
    }
    for (int axis = 0; axis < 3; ++axis) report_plates(report, axis, &result->plates[axis]);
    report_axes(report, result, "F_E", "", result->factor, result->error);
    report_end(report);
}

static void conductivity_warn(const struct conductivity_request *request, const struct conduction *result) {
    const char *file = request->bed.name;
    char axes[4];
    if (axes_with(result, FLIGHTS_LEAVING, axes) && result->flights > 0)
        message_at(STATUS_OK, file, 0, "warning: %.2g of the paths leave the bed; a larger bed has a surer F_E",
                   result->escaped);
    else if (*axes)
        message_at(STATUS_OK, file, 0, "warning: %.2g of what the core emits leaves the bed; F_E is too low%s",
                   result->escaped,
                   request->walls.count > 0 ? ""
                                            : ". --wall closes the sides of a container, cylinder:X,Y,R for example");
    if (axes_with(result, FLIGHTS_ENDLESS, axes))
        message_at(STATUS_OK, file, 0,
                   "warning: F_E along %s does not exist: flights through a gap across the whole bed have no mean "
                   "square length. F_E is given for flights of up to 100 periods. Its standard error is unreliable",
                   axes);
    if (axes_with(result, FLIGHTS_RARE, axes))
        message_at(STATUS_OK, file, 0,
                   "warning: F_E along %s rests on a few long flights, as through a channel without spheres. Its "
                   "standard error is unreliable",
                   axes);
}

/* Follows the paths of a bed. Refuses a bed that emits nothing. */
static int conductivity_follow(struct conductivity_request *request, const struct bed *bed, const unsigned char *emits,
                               struct conduction *result) {
    fibrad_run run = bed_options_run(&request->bed);
    bool emitting = false;
    for (uint32_t i = 0; i < bed->n; ++i) emitting |= emits[i] && request->rule.emissivity[i] > 0;
    if (!emitting) return message_at(STATUS_INPUT, request->bed.name, 0, "the emissivities are all 0: nothing flows");
    const int status = conduction_follow(bed, emits, &request->rule, &run, result);
    return bed_options_status(&request->bed, bed, status, &run.fault);
}

/* Conductivities between plates along an axis, in W/(m K). Without a temperature there is F_E alone. */
static int conductivity_plates(struct conductivity_request *request, const struct bed *bed, double kelvins, int axis,
                               struct conduction_plates *found) {
    const double any = kelvins > 0 ? kelvins : 1000, metres = bed->metres > 0 ? bed->metres : 1;
    double *at = malloc(((size_t)bed->n + 1) * sizeof *at), of_walls[WALLS_MAX];
    struct contact_state contacts = {0};
    struct table_excess excess[2] = {{0}};
    struct plates plates;
    fibrad_run run = bed_options_run(&request->bed);
    fibrad_heat_sources sources = {.temperature = at, .wall_temperature = of_walls};
    if (!at) return message_memory();
    for (uint32_t i = 0; i < bed->n; ++i) at[i] = any;
    for (int k = 0; k < WALLS_MAX; ++k) of_walls[k] = any;
    int status = plates_open(&plates, bed, &request->walls, axis, &run);
    status = bed_options_status(&request->bed, bed, status, &run.fault);
    if (!status)
        status = contacts_begin(&contacts, &request->contacts, &request->bed, &plates.bed, plates.made, &plates.walls,
                                &request->solid, 1 / (metres * metres), &sources);
    if (!status) {
        contacts_excess(&contacts, bed, at, NULL, excess);
        contacts_warn(&request->bed.warned, excess);
        const struct plates_problem problem = {request->rule.emissivity,
                                               request->rule.conductivity,
                                               any,
                                               contacts_given(&request->contacts),
                                               contacts.n,
                                               contacts.first,
                                               contacts.second,
                                               contacts.conductance};
        status = plates_conduct(&plates, &problem, found);
        fibrad_bed_describe(plates.made, NULL, &run.fault);
        const int refused = contacts_refuse(&contacts, &request->bed, bed, &plates.walls, status, &run.fault);
        status = refused ? refused : bed_options_status(&request->bed, bed, status, &run.fault);
    }
    struct conduction_value *const in_metres[] = {&found->radiation, &found->conduction, &found->both};
    for (int k = 0; k < 3 && !status; ++k) in_metres[k]->k *= metres, in_metres[k]->error *= metres;
    contacts_free(&contacts);
    plates_close(&plates);
    free(at);
    if (!status && found->spheres < PLATES_FITTED)
        return message_at(STATUS_INPUT, request->bed.name, 0,
                          "%u spheres in the inner half along %c are too few for a line", found->spheres, 'x' + axis);
    return status;
}

/* With --steady computes conductivities between plates along each wanted axis for which it is possible. */
static int conductivity_steady(struct conductivity_request *request, const struct bed *bed, double kelvins,
                               struct conduction *result) {
    int status = STATUS_OK;
    bool any = false;
    for (int axis = 0; axis < 3 && !status && request->steady; ++axis) {
        if (!conduction_wants(result, axis) || !plates_possible(bed, &request->walls, axis)) continue;
        any = true;
        status = conductivity_plates(request, bed, kelvins, axis, &result->plates[axis]);
    }
    if (request->steady && !any)
        return message_at(STATUS_USAGE, request->bed.name, 0,
                          "--steady: the two axes across it must be periodic or end at walls");
    return status;
}

/* With --solid-conductivity finds k* of all spheres, *relative [n]. Free it also after an error. */
static int conductivity_solid(struct conductivity_request *request, const struct bed *bed, double kelvins,
                              double **relative) {
    if (!request->solid.given) return STATUS_OK;
    if (request->walls.count > 0)
        return message(STATUS_USAGE, "--solid-conductivity: paths of spheres that conduct know no walls; leave out "
                                     "--wall, or --solid-conductivity");
    double *temperature = malloc(bed->n * sizeof *temperature);
    *relative = malloc(bed->n * sizeof **relative);
    int status = temperature && *relative ? STATUS_OK : message_memory();
    for (uint32_t i = 0; i < bed->n && !status; ++i) temperature[i] = kelvins;
    if (!status) status = solid_relative(&request->bed, bed, &request->solid, temperature, *relative);
    free(temperature);
    return status;
}

/* Whether a wall lies across an axis. */
static bool has_wall_across(const struct walls *walls, int axis) {
    for (uint32_t k = 0; k < walls->count; ++k)
        if (wall_across(&walls->wall[k], axis)) return true;
    return false;
}

/* Places the sides of the bed. They end where the spheres end along the axis of F_E, which is the only one without a
 * wall across it, or that of --axis. */
static int conductivity_walls(struct conductivity_request *request, const struct bed *bed) {
    struct walls *walls = &request->walls;
    int *axis = &request->rule.axis, open = 0, last = 0;
    const int status = bed_options_walls(&request->bed, bed, walls);
    if (status || walls->count == 0) return status;
    if (walls->meshes) return message(STATUS_USAGE, "--wall: F_E is known for planes and a cylinder, not for meshes");
    for (int k = 0; k < 3; ++k)
        if (!has_wall_across(walls, k)) ++open, last = k;
    if (*axis < 0 && open == 1) *axis = last;
    if (*axis < 0) return message(STATUS_USAGE, "--wall: F_E is along one axis without a wall across it; give --axis");
    if (has_wall_across(walls, *axis))
        return message(STATUS_USAGE, "--wall: F_E along %c has no wall across %c; only the sides can be walls",
                       'x' + *axis, 'x' + *axis);
    for (int upper = 0; upper < 2 && walls->openings == 0 && !(bed->period[*axis] > 0); ++upper)
        walls->opening[upper] = (fibrad_plane){*axis, upper, bed_reach(bed, *axis, upper == 1)};
    if (!(bed->period[*axis] > 0) && walls->openings == 0) walls->openings = 2;
    return STATUS_OK;
}

/* F_E and k at one temperature. NaN: F_E alone. `emits` has room for all spheres. */
static int conductivity_at(struct conductivity_request *request, struct bed *bed, double kelvins, unsigned char *emits,
                           struct conduction *result) {
    const char *file = request->bed.name;
    const double margin = request->solid.given ? CONDUCTION_MARGIN_WALK : CONDUCTION_MARGIN;
    double *emissivity = NULL, *relative = NULL;
    int status = quantity_values(&request->emissivity, bed, file, "emissivity", 0, 0, 1, &emissivity);
    if (!status) status = conductivity_solid(request, bed, kelvins, &relative);
    request->rule.emissivity = emissivity, request->rule.conductivity = relative, request->rule.walls = &request->walls;
    request->rule.isothermal = !request->solid.given && kelvins > 0 && bed_options_unit(&request->bed, bed);
    if (!status) status = conduction_emitters(bed, &request->walls, request->rule.axis, margin, file, emits, result);
    if (!status) status = conductivity_follow(request, bed, emits, result);
    if (!status && request->at) conduction_at(result, bed, kelvins);
    if (!status) status = conductivity_steady(request, bed, kelvins, result);
    free(emissivity);
    free(relative);
    return status;
}

static int conductivity_frame(void *conductivity_request, struct bed *bed) {
    struct conductivity_request *request = conductivity_request;
    struct conduction result;
    struct contents what = {.conduction = &result};
    unsigned char *emits = calloc(bed->n, 1);
    const char *needs = request->solid.given ? SOLID_NEEDS : contacts_given(&request->contacts) ? CONTACTS_NEED : NULL;
    int status = emits ? conductivity_walls(request, bed) : message_memory();
    if (!status && request->at) status = bed_options_metres(&request->bed, bed, needs);
    for (int k = 0; k < request->temperatures && !status; ++k) {
        const double kelvins = request->temperature[k];
        const bool again = /* if each sphere has one temperature, F_E is that of the first temperature */
            k > 0 && !request->solid.given && !contacts_given(&request->contacts) && result.temperature > 0;
        if (again)
            conduction_at(&result, bed, kelvins);
        else
            status = conductivity_at(request, bed, kelvins, emits, &result);
        if (!status) status = bed_options_write(&request->bed, bed, &what);
        if (status) break;
        if (!again) conductivity_warn(request, &result);
        conductivity_report(request, bed, &result);
    }
    free(emits);
    return status;
}

int command_conductivity(int argc, char **argv) {
    struct conductivity_request request;
    const int status = conductivity_parse(&request, argc, argv);
    const int ended = bed_options_end(&request.bed, status, conductivity_help, conductivity_frame, &request);
    quantity_free(&request.solid);
    quantity_free(&request.contacts.conductivity);
    curve_free(&request.contacts.gas_curve);
    return ended;
}
