/* steady_contacts.c - conductivity of a bed by radiation and contacts together, between two plates.
 * SPDX-License-Identifier: MIT */
#include <gsl/gsl_fit.h>
#include <gsl/gsl_math.h>
#include <math.h>
#include <stdlib.h>

#include "bed/bed_scene.h"
#include "bed/conduction.h"
#include "bed/jump.h"
#include "cli/message.h"
#include "heat/steady.h"

enum { FITTED_LEAST = 40, DIRECTIONS_ALL = 400 };
/* Temperatures of the ends over their mean: so near that k_s and k_gas are the same everywhere. */
#define HOT_END  1.0005
#define COLD_END 0.9995
/* A flow that is so small over the largest one is none. */
#define IDLE 1e-6

/* A bed between plates, whose spheres next to a plate have its temperature. */
struct between {
    struct bed_options *options;
    const struct bed *bed; /* open along the axis */
    const struct total_problem *problem;
    int axis;
    struct walls plates, walls; /* walls: the plates, and then the sides */
    struct contact_state contacts;
    fibrad_heat_sources sources;
    fibrad_heat_result result;
    double plate[WALLS_MAX]; /* [K] of walls; NaN: a side */
    unsigned char insulated[WALLS_MAX];
    double *given, *power, *emissivity, *conductivity;  /* [spheres] */
    double *gained, *error, *temperature, *at, *fitted; /* [spheres] */
    double plate_power[WALLS_MAX], plate_error[WALLS_MAX];
};

/* The end to which a sphere belongs: 0 the lower one, 1 the upper one, 2 none. */
static int plate_of(const struct between *b, uint32_t i) {
    const double at = bed_centres(b->bed, b->axis)[i], d = b->problem->diameter;
    return at - b->plates.wall[0].plane.at < 1.5 * d ? 0 : b->plates.wall[1].plane.at - at < 1.5 * d ? 1 : 2;
}

static int take_room(struct between *b) {
    double **const of_spheres[] = {&b->given, &b->power,       &b->emissivity, &b->conductivity, &b->gained,
                                   &b->error, &b->temperature, &b->at,         &b->fitted};
    bool there = true;
    for (size_t k = 0; k < sizeof of_spheres / sizeof *of_spheres; ++k) {
        *of_spheres[k] = calloc(b->bed->n + (size_t)1, sizeof(double));
        there = there && *of_spheres[k];
    }
    return there ? STATUS_OK : message_memory();
}

static void free_room(struct between *b) {
    double *const of_spheres[] = {b->given, b->power,       b->emissivity, b->conductivity, b->gained,
                                  b->error, b->temperature, b->at,         b->fitted};
    for (size_t k = 0; k < sizeof of_spheres / sizeof *of_spheres; ++k) free(of_spheres[k]);
    contacts_free(&b->contacts);
}

/* Contacts of a file that join both ends across the period, which is now open, are left out. */
static void cut_contacts(struct between *b, double period) {
    const struct bed *bed = b->bed;
    for (uint32_t k = 0; k < b->contacts.listed; ++k) {
        const uint32_t i = b->contacts.first[k], j = b->contacts.second[k];
        if (i < bed->n && j < bed->n && 2 * fabs(bed_centres(bed, b->axis)[i] - bed_centres(bed, b->axis)[j]) > period)
            b->contacts.conductance[k] = 0;
    }
}

/* Warns if the temperature of the bed is beyond the end of a table. */
static void warn_ends(struct bed_options *options, struct contact_state *contacts, const struct bed *bed,
                      const double *temperature) {
    struct table_excess excess[2] = {{0}};
    contacts_excess(contacts, bed, temperature, NULL, excess);
    contacts_warn(&options->warned, excess);
}

static int set_up(struct between *b, double period) {
    const struct total_problem *p = b->problem;
    const struct bed *bed = b->bed;
    int status = take_room(b);
    if (status) return status;
    fibrad_heat_sources_init(&b->sources);
    for (uint32_t i = 0; i < bed->n; ++i) {
        b->given[i] = p->temperature;
        if (p->relative)
            b->conductivity[i] = p->relative[i] * 8 * bed->r[i] * FIBRAD_STEFAN_BOLTZMANN * gsl_pow_3(p->temperature);
    }
    b->plate[0] = b->plate[1] = p->temperature;
    b->sources.temperature = b->given, b->sources.wall_temperature = b->plate;
    status = contacts_begin(&b->contacts, p->contacts, b->options, bed, &b->plates, p->solid,
                            1 / (p->metres * p->metres), &b->sources);
    if (status) return status;
    warn_ends(b->options, &b->contacts, bed, b->given);
    cut_contacts(b, period);
    for (uint32_t k = 2; k < b->walls.count; ++k) b->plate[k] = NAN, b->insulated[k] = 1;
    b->sources.insulated = b->insulated;
    b->plate[0] = HOT_END * p->temperature, b->plate[1] = COLD_END * p->temperature;
    for (uint32_t i = 0; i < bed->n; ++i) {
        const int end = plate_of(b, i);
        b->given[i] = end < 2 ? b->plate[end] : NAN;
        b->power[i] = end < 2 ? NAN : 0;
    }
    b->sources.surroundings = p->temperature;
    b->sources.emissivity = b->emissivity, b->sources.power = b->power;
    b->sources.conductivity = p->relative ? b->conductivity : NULL;
    b->result = (fibrad_heat_result){.power = b->gained,
                                     .power_error = b->error,
                                     .temperature = b->temperature,
                                     .wall_power = b->plate_power,
                                     .wall_error = b->plate_error,
                                     .contact_flow = b->contacts.flow};
    return STATUS_OK;
}

/* The conductivity from what the upper end gains, and from the gradient of temperature in the inner half. The error is
 * that of the line and, as a part of `gained`, that of the powers. */
static int read_total(const struct between *b, struct conduction_value *total) {
    const struct bed *bed = b->bed;
    const double low = b->plates.wall[0].plane.at, high = b->plates.wall[1].plane.at, metres = b->problem->metres;
    double c0, slope, cov00, cov01, cov11, squares, gained = b->plate_power[1], square = gsl_pow_2(b->plate_error[1]);
    size_t n = 0;
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double at = bed_centres(bed, b->axis)[i];
        if (plate_of(b, i) == 1) gained += b->gained[i], square += gsl_pow_2(b->error[i]);
        if (plate_of(b, i) < 2 || isnan(b->temperature[i]) || fabs(at - (low + high) / 2) > (high - low) / 4) continue;
        b->at[n] = at * metres, b->fitted[n++] = b->temperature[i];
    }
    if (n < FITTED_LEAST)
        return message_at(STATUS_INPUT, b->options->name, 0,
                          "%zu spheres in the inner half along %c are too few for a line", n, 'x' + b->axis);
    gsl_fit_linear(b->at, 1, b->fitted, 1, n, &c0, &slope, &cov00, &cov01, &cov11, &squares);
    const double area = steady_area(bed, b->problem->sides, b->axis);
    total->k = gained / (area * -slope); /* lengths of both cancel: W/L2 per area in L2 */
    total->error = fabs(total->k) * hypot(sqrt(cov11) / slope, gained != 0 ? sqrt(square) / gained : 0);
    return STATUS_OK;
}

/* Takes the temperatures away from spheres through which nothing is conducted. They are not on a way between the ends,
 * so they say nothing of the gradient. */
static void drop_idle(struct between *b) {
    double most = 0, *through = b->fitted;
    for (uint32_t i = 0; i < b->bed->n; ++i) through[i] = 0;
    for (uint32_t k = 0; k < b->contacts.n; ++k) {
        const uint32_t ends[2] = {b->contacts.first[k], b->contacts.second[k]};
        most = fmax(most, fabs(b->contacts.flow[k]));
        for (int e = 0; e < 2; ++e)
            if (ends[e] < b->bed->n) through[ends[e]] += fabs(b->contacts.flow[k]);
    }
    for (uint32_t i = 0; i < b->bed->n; ++i)
        if (through[i] <= IDLE * most) b->temperature[i] = NAN;
}

/* One conductivity: by radiation, contacts, or both. */
static int solve_total(struct between *b, bool radiates, bool touches, uint32_t directions,
                       struct conduction_value *total) {
    const fibrad_scene_config scene = bed_scene(b->bed, &b->walls);
    const fibrad_spheres spheres = bed_spheres(b->bed);
    const double black[WALLS_MAX] = {radiates ? 1 : 0, radiates ? 1 : 0}; /* sides reflect */
    fibrad_run run = bed_options_run(b->options);
    fibrad_radiation *radiation = NULL;
    fibrad_heat_sources sources = b->sources;
    const fibrad_heat_config config = {.directions = directions};
    for (uint32_t i = 0; i < b->bed->n; ++i)
        b->emissivity[i] = fmax(radiates ? b->problem->emissivity[i] : 0, HARDLY_RADIATES);
    sources.wall_emissivity = black;
    if (!touches) sources.contacts = 0;
    if (!radiates) sources.conductivity = NULL, sources.tolerance = 1e-10;
    int status = fibrad_radiation_new(&radiation, &scene, &spheres, &config, &run);
    if (!status) status = fibrad_radiation_solve(radiation, &sources, &b->result);
    fibrad_radiation_describe(radiation, NULL, &run.fault);
    fibrad_radiation_free(radiation);
    const int refused = contacts_refuse(&b->contacts, b->options, b->bed, &b->plates, status, &run.fault);
    if (refused) return refused;
    status = bed_options_status(b->options, b->bed, status, &run.fault);
    if (status) return status;
    if (!radiates) drop_idle(b);
    return read_total(b, total);
}

/* The same from two numbers of directions, whose difference is part of the error. */
static int solve_twice(struct between *b, bool touches, struct conduction_value *total) {
    struct conduction_value rough = {0, 0};
    int status = solve_total(b, true, touches, DIRECTIONS_ALL / 2, &rough);
    if (!status) status = solve_total(b, true, touches, DIRECTIONS_ALL, total);
    total->error = hypot(total->error, total->k - rough.k);
    return status;
}

/* Between plates. Spheres next to a plate have its temperature. */
static int total_of_plates(struct bed_options *options, const struct bed *bed, const struct total_problem *problem,
                           int axis, struct conduction_total *total) {
    struct bed open = *bed;
    open.period[axis] = 0;
    struct between b = {.options = options, .bed = &open, .problem = problem, .axis = axis};
    b.plates = steady_walls(&open, NULL, axis);
    b.walls = steady_walls(&open, problem->sides, axis);
    int status = set_up(&b, bed->period[axis] > 0 ? bed->period[axis] : INFINITY);
    if (!status) status = solve_total(&b, false, true, 8, &total->conduction);
    if (!status) status = solve_twice(&b, false, &total->radiation);
    if (!status) status = solve_twice(&b, true, &total->both);
    total->contacts = b.contacts.n;
    free_room(&b);
    return status;
}

/* Whether a bed is so long that the middle one of three periods does not see the ends, and that no contact is as long
 * as half a period. */
static bool long_period(const struct bed *bed, const struct total_problem *problem, int axis) {
    double largest = 0;
    for (uint32_t i = 0; i < bed->n; ++i) largest = fmax(largest, bed->r[i]);
    return bed->period[axis] >= fmax(CONDUCTION_MARGIN * problem->diameter, 6 * largest) && !problem->relative;
}

/* The same from two numbers of directions, whose difference is part of the error. */
static int joint_twice(const struct bed *bed, const struct jump_contacts *network, struct jump_radiation *radiation,
                       int axis, double volume, fibrad_run *run, double *k, double *error) {
    double rough;
    radiation->directions = DIRECTIONS_ALL / 4;
    int status = jump_joint(bed, network, radiation, axis, volume, run, &rough);
    radiation->directions = DIRECTIONS_ALL / 2;
    if (!status) status = jump_joint(bed, network, radiation, axis, volume, run, k);
    *error = *k - rough;
    return status;
}

/* All temperatures rise by the same amount from one period to the next. */
static int total_of_periods(struct bed_options *options, const struct bed *bed, const struct total_problem *p, int axis,
                            struct conduction_total *total) {
    double *at = malloc(((size_t)bed->n + 1) * sizeof *at);
    const double metres = p->metres, volume = steady_area(bed, p->sides, axis) * bed->period[axis];
    struct contact_state contacts = {0};
    const struct walls none = {.count = 0};
    fibrad_run run = bed_options_run(options);
    fibrad_heat_sources sources;
    if (!at) return message_memory();
    for (uint32_t i = 0; i < bed->n; ++i) at[i] = p->temperature;
    fibrad_heat_sources_init(&sources);
    sources.temperature = at;
    int status = contacts_begin(&contacts, p->contacts, options, bed, &none, p->solid, 1 / (metres * metres), &sources);
    if (!status) warn_ends(options, &contacts, bed, at);
    const struct jump_contacts network = {contacts.n, contacts.first, contacts.second, contacts.conductance},
                               empty = {0};
    struct jump_radiation radiation = {
        .emissivity = p->emissivity, .sides = p->sides, .temperature = p->temperature, .linear = p->linear.k / metres};
    double k[3] = {0}, error[3] = {0};
    if (!status) {
        status = jump_conductivity(bed, &network, axis, volume, &k[0]);
        if (!status) status = joint_twice(bed, &empty, &radiation, axis, volume, &run, &k[1], &error[1]);
        if (!status) status = joint_twice(bed, &network, &radiation, axis, volume, &run, &k[2], &error[2]);
        status = bed_options_status(options, bed, status, &run.fault);
    }
    total->conduction = (struct conduction_value){k[0] * metres, 1e-9 * k[0] * metres};
    total->radiation = (struct conduction_value){k[1] * metres, hypot(error[1] * metres, p->linear.error)};
    total->both = (struct conduction_value){k[2] * metres, hypot(error[2] * metres, p->linear.error)};
    total->contacts = contacts.n;
    contacts_free(&contacts);
    free(at);
    return status;
}

int steady_contacts(struct bed_options *options, const struct bed *bed, const struct total_problem *problem, int axis,
                    struct conduction_total *total) {
    total->periodic = long_period(bed, problem, axis);
    const int status = (total->periodic ? total_of_periods : total_of_plates)(options, bed, problem, axis, total);
    total->computed = !status;
    return status;
}
