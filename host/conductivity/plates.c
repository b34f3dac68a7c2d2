/* plates.c - conductivity of a bed between two black plates; no sphere gains or loses heat.
 * SPDX-License-Identifier: MIT */
#include "conductivity/plates.h"

#include <gsl/gsl_fit.h>
#include <gsl/gsl_math.h>
#include <stdlib.h>

#include "bed/bed_scene.h"
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
    const struct plates *plates;
    const struct plates_problem *problem;
    fibrad_heat_sources sources;
    fibrad_heat_result result;
    double plate[WALLS_MAX], black[WALLS_MAX]; /* of walls: temperature [K], NaN of a side; emissivity */
    unsigned char insulated[WALLS_MAX];
    double *given, *power, *emissivity, *conductivity;   /* [spheres] */
    double *gained, *error, *temperature, *at, *through; /* [spheres] */
    uint32_t contacts;
    uint32_t *first, *second;   /* [contacts] */
    double *conductance, *flow; /* [contacts] */
    double plate_power[WALLS_MAX], plate_error[WALLS_MAX];
    double diameter;
    uint32_t fitted;
};

bool plates_possible(const struct bed *bed, const struct walls *sides, int axis) {
    return !isnan(conduction_width(bed, sides, (axis + 1) % 3)) && !isnan(conduction_width(bed, sides, (axis + 2) % 3));
}

int plates_open(struct plates *plates, const struct bed *bed, const struct walls *sides, int axis, fibrad_run *run) {
    *plates = (struct plates){.bed = *bed, .period = bed->period[axis], .axis = axis, .walls.count = 2};
    struct walls *walls = &plates->walls;
    plates->bed.period[axis] = 0;
    for (int k = 0; k < 2; ++k)
        walls->wall[k] = (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane = {axis, k, bed_reach(bed, axis, k == 1)}};
    for (uint32_t k = 0; sides && k < sides->count; ++k) walls->wall[walls->count++] = sides->wall[k];
    const fibrad_scene_config scene = bed_scene(&plates->bed, walls);
    const fibrad_spheres spheres = bed_spheres(bed);
    return fibrad_bed_new(&plates->made, &scene, &spheres, run);
}

void plates_close(struct plates *plates) { fibrad_bed_free(plates->made); }

/* The plate that a sphere is at: 0 the lower one, 1 the upper one, 2 none. */
static int plate_of(const struct between *b, uint32_t i) {
    const double at = bed_centres(&b->plates->bed, b->plates->axis)[i], near = 1.5 * b->diameter;
    if (at - b->plates->walls.wall[0].plane.at < near) return 0;
    return b->plates->walls.wall[1].plane.at - at < near ? 1 : 2;
}

/* All arrays lie in two blocks, which begin with `given` and `first`. */
static int take_room(struct between *b) {
    double **const of_spheres[] = {&b->given, &b->power,       &b->emissivity, &b->conductivity, &b->gained,
                                   &b->error, &b->temperature, &b->at,         &b->through};
    const size_t n = b->plates->bed.n, arrays = sizeof of_spheres / sizeof *of_spheres, m = b->problem->contacts;
    double *block = calloc(arrays * n + 2 * m + 1, sizeof *block);
    b->first = calloc(2 * m + 1, sizeof *b->first);
    if (!block || !b->first) {
        free(block);
        return FIBRAD_E_MEMORY;
    }
    for (size_t k = 0; k < arrays; ++k) *of_spheres[k] = block + k * n;
    b->conductance = block + arrays * n, b->flow = b->conductance + m, b->second = b->first + m;
    return FIBRAD_OK;
}

/* Takes over contacts, but for those with sides and across the period. */
static void take_contacts(struct between *b) {
    const struct plates_problem *p = b->problem;
    const double *centre = bed_centres(&b->plates->bed, b->plates->axis), period = b->plates->period;
    const uint32_t n = b->plates->bed.n;
    for (uint32_t k = 0; k < p->contacts; ++k) {
        const uint32_t i = p->first[k], j = p->second[k];
        if (i >= n + 2 || j >= n + 2) continue;
        if (period > 0 && i < n && j < n && 2 * fabs(centre[i] - centre[j]) > period) continue;
        b->first[b->contacts] = i, b->second[b->contacts] = j, b->conductance[b->contacts++] = p->conductance[k];
    }
}

static void set_up(struct between *b) {
    const struct plates_problem *p = b->problem;
    const struct bed *bed = &b->plates->bed;
    take_contacts(b);
    for (uint32_t k = 2; k < b->plates->walls.count; ++k) b->plate[k] = NAN, b->insulated[k] = 1;
    b->plate[0] = HOT * p->temperature, b->plate[1] = COLD * p->temperature;
    for (uint32_t i = 0; i < bed->n; ++i) {
        const int end = plate_of(b, i);
        b->given[i] = end < 2 ? b->plate[end] : NAN;
        b->power[i] = end < 2 ? NAN : 0;
        if (p->relative)
            b->conductivity[i] = p->relative[i] * 8 * bed->r[i] * FIBRAD_STEFAN_BOLTZMANN * gsl_pow_3(p->temperature);
    }
    fibrad_heat_sources_init(&b->sources);
    b->sources.temperature = b->given, b->sources.power = b->power, b->sources.emissivity = b->emissivity;
    b->sources.wall_temperature = b->plate, b->sources.wall_emissivity = b->black, b->sources.insulated = b->insulated;
    b->sources.surroundings = p->temperature;
    b->sources.contact_first = b->first, b->sources.contact_second = b->second;
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
    const uint32_t n = b->plates->bed.n;
    double most = 0, *through = b->through;
    for (uint32_t i = 0; i < n; ++i) through[i] = 0;
    for (uint32_t k = 0; k < b->contacts; ++k) {
        const uint32_t ends[2] = {b->first[k], b->second[k]};
        most = fmax(most, fabs(b->flow[k]));
        for (int e = 0; e < 2; ++e)
            if (ends[e] < n) through[ends[e]] += fabs(b->flow[k]);
    }
    for (uint32_t i = 0; i < n; ++i)
        if (through[i] <= IDLE * most) b->temperature[i] = NAN;
}

/* The conductivity from what the upper plate and the spheres at it gain, and from the gradient in the inner half. The
 * error is that of the line and that of the powers. */
static void read_conductivity(struct between *b, struct conduction_value *value) {
    const struct plates *plates = b->plates;
    const double low = plates->walls.wall[0].plane.at, high = plates->walls.wall[1].plane.at,
                 *centre = bed_centres(&plates->bed, plates->axis);
    double gained = b->plate_power[1], square = gsl_pow_2(b->plate_error[1]);
    double level, slope, cov00, cov01, variance, squares;
    uint32_t n = 0;
    for (uint32_t i = 0; i < plates->bed.n; ++i) {
        if (plate_of(b, i) == 1) gained += b->gained[i], square += gsl_pow_2(b->error[i]);
        if (plate_of(b, i) < 2 || isnan(b->temperature[i]) || fabs(centre[i] - (low + high) / 2) > (high - low) / 4)
            continue;
        b->at[n] = centre[i], b->temperature[n++] = b->temperature[i];
    }
    b->fitted = n;
    *value = (struct conduction_value){NAN, NAN};
    if (n < PLATES_FITTED) return;
    gsl_fit_linear(b->at, 1, b->temperature, 1, n, &level, &slope, &cov00, &cov01, &variance, &squares);
    const double area = conduction_width(&plates->bed, &plates->walls, (plates->axis + 1) % 3) *
                        conduction_width(&plates->bed, &plates->walls, (plates->axis + 2) % 3);
    value->k = gained / (area * -slope);
    value->error = fabs(value->k) * hypot(sqrt(variance) / slope, gained != 0 ? sqrt(square) / gained : 0);
}

static int solve(struct between *b, bool radiates, bool touches, struct conduction_value *value) {
    fibrad_heat_sources sources = b->sources;
    for (uint32_t i = 0; i < b->plates->bed.n; ++i)
        b->emissivity[i] = fmax(radiates ? b->problem->emissivity[i] : 0, HARDLY_RADIATES);
    b->black[0] = b->black[1] = radiates; /* sides reflect */
    sources.contacts = touches ? b->contacts : 0;
    if (!radiates) sources.tolerance = 1e-10;
    if (radiates && b->problem->relative) sources.conductivity = b->conductivity;
    const int status = fibrad_bed_solve(b->plates->made, &sources, NULL, &b->result);
    if (status) return status;
    if (!radiates) drop_idle(b);
    read_conductivity(b, value);
    return FIBRAD_OK;
}

/* Solves along so many directions. */
static int solve_all(struct between *b, uint32_t directions, struct conduction_plates *result) {
    const fibrad_heat_config config = {.directions = directions};
    int status = fibrad_bed_beams(b->plates->made, &config);
    if (status) return status;
    if (directions == DIRECTIONS_CONTACTS) return solve(b, false, true, &result->conduction);
    status = solve(b, true, false, &result->radiation);
    return status || b->contacts == 0 ? status : solve(b, true, true, &result->both);
}

/* Adds the difference from a rougher solution to an error. */
static void add_error(struct conduction_value *value, const struct conduction_value *rough) {
    value->error = hypot(value->error, value->k - rough->k);
}

int plates_conduct(const struct plates *plates, const struct plates_problem *problem,
                   struct conduction_plates *result) {
    struct between b = {.plates = plates, .problem = problem};
    struct conduction_plates rough = {.spheres = 0};
    const double begun = progress_clock();
    *result = (struct conduction_plates){.touches = problem->touches};
    b.diameter = bed_diameter(&plates->bed);
    int status = take_room(&b);
    if (!status) set_up(&b);
    if (!status && b.contacts > 0) status = solve_all(&b, DIRECTIONS_CONTACTS, result);
    if (!status) status = solve_all(&b, DIRECTIONS_ROUGH, &rough);
    if (!status) status = solve_all(&b, DIRECTIONS, result);
    add_error(&result->radiation, &rough.radiation);
    add_error(&result->both, &rough.both);
    if (b.contacts == 0) result->both = result->radiation;
    const double unit = 4 * FIBRAD_STEFAN_BOLTZMANN * gsl_pow_3(problem->temperature) * b.diameter;
    result->factor = (struct conduction_value){result->radiation.k / unit, result->radiation.error / unit};
    result->contacts = b.contacts, result->spheres = b.fitted;
    result->seconds = progress_clock() - begun;
    free(b.given);
    free(b.first);
    return status;
}
