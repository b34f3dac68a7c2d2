/* plates.c - conductivity of a bed between two black plates; no sphere gains or loses heat.
 * SPDX-License-Identifier: MIT */
#include "conductivity/plates.h"

#include <gsl/gsl_fit.h>
#include <gsl/gsl_math.h>
#include <stdlib.h>

#include "cli/progress.h"

/* Temperatures of the plates over their mean. They differ so little that conductivities are the same everywhere. */
#define HOT  1.0005
#define COLD 0.9995

/* The least emissivity of a sphere: those that reflect all and touch only each other need a temperature. */
#define HARDLY_RADIATES 1e-12

/* A flow that is so small over the largest one is none. */
#define IDLE 1e-6

/* Directions of beams: of contacts alone, of a rough solution and of the solution. */
enum { DIRECTIONS_CONTACTS = 8, DIRECTIONS_ROUGH = 200, DIRECTIONS = 400 };

struct between {
    const struct plates_problem *problem;
    struct bed bed; /* that of the problem, open along the axis; its arrays are not its own */
    int axis;
    struct walls walls;
    fibrad_heat_sources sources;
    fibrad_heat_result result;
    double plate[WALLS_MAX], black[WALLS_MAX]; /* of walls: temperature [K], NaN of a side; emissivity */
    unsigned char insulated[WALLS_MAX];
    double *given, *power, *emissivity, *conductivity;   /* [spheres] */
    double *gained, *error, *temperature, *at, *through; /* [spheres] */
    double *conductance, *flow;                          /* [contacts] */
    double plate_power[WALLS_MAX], plate_error[WALLS_MAX];
    double diameter;
    uint32_t fitted;
};

bool plates_possible(const struct bed *bed, const struct walls *sides, int axis) {
    return !isnan(conduction_width(bed, sides, (axis + 1) % 3)) && !isnan(conduction_width(bed, sides, (axis + 2) % 3));
}

struct walls plates_walls(const struct bed *bed, const struct walls *sides, int axis) {
    struct walls walls = {.count = 2};
    for (int k = 0; k < 2; ++k)
        walls.wall[k] = (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane = {axis, k, bed_reach(bed, axis, k == 1)}};
    for (uint32_t k = 0; sides && k < sides->count; ++k) walls.wall[walls.count++] = sides->wall[k];
    return walls;
}

/* The plate that a sphere is at: 0 the lower one, 1 the upper one, 2 none. */
static int plate_of(const struct between *b, uint32_t i) {
    const double at = bed_centres(&b->bed, b->axis)[i];
    return at - b->walls.wall[0].plane.at < 1.5 * b->diameter   ? 0
           : b->walls.wall[1].plane.at - at < 1.5 * b->diameter ? 1
                                                                : 2;
}

/* All arrays lie in one block, which begins with `given`. */
static int take_room(struct between *b) {
    double **const of_spheres[] = {&b->given, &b->power,       &b->emissivity, &b->conductivity, &b->gained,
                                   &b->error, &b->temperature, &b->at,         &b->through};
    const size_t n = b->bed.n, arrays = sizeof of_spheres / sizeof *of_spheres;
    double *block = calloc(arrays * n + 2 * (size_t)b->problem->contacts + 1, sizeof *block);
    for (size_t k = 0; block && k < arrays; ++k) *of_spheres[k] = block + k * n;
    if (block) b->conductance = block + arrays * n, b->flow = b->conductance + b->problem->contacts;
    return block ? FIBRAD_OK : FIBRAD_E_MEMORY;
}

static void set_up(struct between *b) {
    const struct plates_problem *p = b->problem;
    const double *centre = bed_centres(&b->bed, b->axis), period = p->bed->period[b->axis];
    for (uint32_t k = 0; k < p->contacts; ++k) {
        const uint32_t i = p->first[k], j = p->second[k];
        const bool across = period > 0 && i < b->bed.n && j < b->bed.n && 2 * fabs(centre[i] - centre[j]) > period;
        b->conductance[k] = across ? 0 : p->conductance[k];
    }
    for (uint32_t k = 2; k < b->walls.count; ++k) b->plate[k] = NAN, b->insulated[k] = 1;
    b->plate[0] = HOT * p->temperature, b->plate[1] = COLD * p->temperature;
    for (uint32_t i = 0; i < b->bed.n; ++i) {
        const int end = plate_of(b, i);
        b->given[i] = end < 2 ? b->plate[end] : NAN;
        b->power[i] = end < 2 ? NAN : 0;
        if (p->relative)
            b->conductivity[i] = p->relative[i] * 8 * b->bed.r[i] * FIBRAD_STEFAN_BOLTZMANN * gsl_pow_3(p->temperature);
    }
    fibrad_heat_sources_init(&b->sources);
    b->sources.temperature = b->given, b->sources.power = b->power, b->sources.emissivity = b->emissivity;
    b->sources.wall_temperature = b->plate, b->sources.wall_emissivity = b->black, b->sources.insulated = b->insulated;
    b->sources.surroundings = p->temperature;
    b->sources.contact_first = p->first, b->sources.contact_second = p->second;
    b->sources.conductance = b->conductance;
    b->result = (fibrad_heat_result){.power = b->gained,
                                     .power_error = b->error,
                                     .temperature = b->temperature,
                                     .wall_power = b->plate_power,
                                     .wall_error = b->plate_error,
                                     .contact_flow = b->flow};
}

/* Takes the temperatures away from spheres through which nothing is conducted. They are not on a way between the ends,
 * so they say nothing of the gradient. */
static void drop_idle(struct between *b) {
    const struct plates_problem *p = b->problem;
    double most = 0, *through = b->through;
    for (uint32_t i = 0; i < b->bed.n; ++i) through[i] = 0;
    for (uint32_t k = 0; k < p->contacts; ++k) {
        const uint32_t ends[2] = {p->first[k], p->second[k]};
        most = fmax(most, fabs(b->flow[k]));
        for (int e = 0; e < 2; ++e)
            if (ends[e] < b->bed.n) through[ends[e]] += fabs(b->flow[k]);
    }
    for (uint32_t i = 0; i < b->bed.n; ++i)
        if (through[i] <= IDLE * most) b->temperature[i] = NAN;
}

/* The conductivity from what the upper plate and the spheres at it gain, and from the gradient in the inner half. The
 * error is that of the line and that of the powers. */
static void read_conductivity(struct between *b, struct conduction_value *value) {
    const double low = b->walls.wall[0].plane.at, high = b->walls.wall[1].plane.at,
                 *centre = bed_centres(&b->bed, b->axis);
    double gained = b->plate_power[1], square = gsl_pow_2(b->plate_error[1]);
    double level, slope, cov00, cov01, variance, squares;
    uint32_t n = 0;
    for (uint32_t i = 0; i < b->bed.n; ++i) {
        if (plate_of(b, i) == 1) gained += b->gained[i], square += gsl_pow_2(b->error[i]);
        if (plate_of(b, i) < 2 || isnan(b->temperature[i]) || fabs(centre[i] - (low + high) / 2) > (high - low) / 4)
            continue;
        b->at[n] = centre[i], b->temperature[n++] = b->temperature[i];
    }
    b->fitted = n;
    *value = (struct conduction_value){NAN, NAN};
    if (n < PLATES_FITTED) return;
    gsl_fit_linear(b->at, 1, b->temperature, 1, n, &level, &slope, &cov00, &cov01, &variance, &squares);
    const double area = conduction_width(&b->bed, b->problem->sides, (b->axis + 1) % 3) *
                        conduction_width(&b->bed, b->problem->sides, (b->axis + 2) % 3);
    value->k = gained / (area * -slope);
    value->error = fabs(value->k) * hypot(sqrt(variance) / slope, gained != 0 ? sqrt(square) / gained : 0);
}

static int solve(struct between *b, fibrad_bed *made, bool radiates, bool touches, struct conduction_value *value) {
    fibrad_heat_sources sources = b->sources;
    for (uint32_t i = 0; i < b->bed.n; ++i)
        b->emissivity[i] = fmax(radiates ? b->problem->emissivity[i] : 0, HARDLY_RADIATES);
    b->black[0] = b->black[1] = radiates; /* sides reflect */
    sources.contacts = touches ? b->problem->contacts : 0;
    if (!radiates) sources.tolerance = 1e-10;
    if (radiates && b->problem->relative) sources.conductivity = b->conductivity;
    const int status = fibrad_bed_solve(made, &sources, NULL, &b->result);
    if (status) return status;
    if (!radiates) drop_idle(b);
    read_conductivity(b, value);
    return FIBRAD_OK;
}

/* Solves along so many directions. */
static int solve_all(struct between *b, fibrad_bed *made, uint32_t directions, struct conduction_plates *result) {
    const fibrad_heat_config config = {.directions = directions};
    const bool alone = directions == DIRECTIONS_CONTACTS;
    int status = fibrad_bed_beams(made, &config);
    if (!status && alone) status = solve(b, made, false, true, &result->conduction);
    if (!status && !alone) status = solve(b, made, true, false, &result->radiation);
    if (!status && !alone && b->problem->contacts > 0) status = solve(b, made, true, true, &result->both);
    return status;
}

/* Adds the difference from a rougher solution to an error. */
static void add_error(struct conduction_value *value, const struct conduction_value *rough) {
    value->error = hypot(value->error, value->k - rough->k);
}

int plates_conduct(const struct plates_problem *problem, fibrad_bed *made, int axis, struct conduction_plates *result) {
    struct between b = {.problem = problem, .bed = *problem->bed, .axis = axis};
    struct conduction_plates rough = {.spheres = 0};
    const double begun = progress_clock();
    *result = (struct conduction_plates){.touches = problem->touches, .contacts = problem->contacts};
    b.bed.period[axis] = 0;
    b.walls = plates_walls(&b.bed, problem->sides, axis);
    for (uint32_t i = 0; i < b.bed.n; ++i) b.diameter += 2 * b.bed.r[i] / b.bed.n;
    int status = take_room(&b);
    if (!status) set_up(&b);
    if (!status && problem->contacts > 0) status = solve_all(&b, made, DIRECTIONS_CONTACTS, result);
    if (!status && problem->emissivity) status = solve_all(&b, made, DIRECTIONS_ROUGH, &rough);
    if (!status && problem->emissivity) status = solve_all(&b, made, DIRECTIONS, result);
    add_error(&result->radiation, &rough.radiation);
    add_error(&result->both, &rough.both);
    if (problem->contacts == 0) result->both = result->radiation;
    const double unit = 4 * FIBRAD_STEFAN_BOLTZMANN * gsl_pow_3(problem->temperature) * b.diameter;
    result->factor = (struct conduction_value){result->radiation.k / unit, result->radiation.error / unit};
    result->spheres = b.fitted;
    result->seconds = progress_clock() - begun;
    free(b.given);
    return status;
}
