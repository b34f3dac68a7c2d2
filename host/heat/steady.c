/* steady.c - effective conductivity of a bed between two plates; no sphere gains or loses heat.
 * SPDX-License-Identifier: MIT */
#include "heat/steady.h"

#include <gsl/gsl_fit.h>
#include <gsl/gsl_math.h>
#include <math.h>
#include <stdlib.h>

#include "bed/bed_scene.h"
#include "bed/conductivity.h"
#include "cli/message.h"

enum { FITTED_MIN = 40 };

bool steady_possible(const struct bed *bed, const struct walls *walls, int axis) {
    return !isnan(conduction_width(bed, walls, (axis + 1) % 3)) && !isnan(conduction_width(bed, walls, (axis + 2) % 3));
}

struct walls steady_walls(const struct bed *bed, const struct walls *sides, int axis) {
    struct walls walls = {.count = 2};
    for (int k = 0; k < 2; ++k)
        walls.wall[k] = (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane = {axis, k, bed_reach(bed, axis, k == 1)}};
    for (uint32_t k = 0; sides && k < sides->count; ++k) walls.wall[walls.count++] = sides->wall[k];
    return walls;
}

double steady_area(const struct bed *bed, const struct walls *sides, int axis) {
    return conduction_width(bed, sides, (axis + 1) % 3) * conduction_width(bed, sides, (axis + 2) % 3);
}

/* T^4 of a temperature T, 0 at the upper plate and 1 at the lower one. */
static double steady_share(double t, const double plate[2]) {
    return (gsl_pow_4(t) - gsl_pow_4(plate[1])) / (gsl_pow_4(plate[0]) - gsl_pow_4(plate[1]));
}

/* Finds sigma T^4 of the spheres if it is 1 at the lower plate and 0 at the upper one, and the powers of the plates. */
static int steady_solve(struct bed_options *options, const struct bed *bed, const struct walls *walls,
                        const double *emissivity, const double *relative, uint32_t directions, double *emission,
                        double power[WALLS_MAX], double error[WALLS_MAX]) {
    fibrad_run run = bed_options_run(options);
    const size_t n = bed->n;
    double *given = calloc(4 * n + 1, sizeof *given);
    if (!given) return message_memory();
    double *unknown = given + n, *gained = unknown + n, *conductivity = gained + n;
    double plate[WALLS_MAX] = {relative ? STEADY_HOT : 1, relative ? STEADY_COLD : 0}, black[WALLS_MAX] = {1, 1};
    unsigned char insulated[WALLS_MAX] = {0};
    for (uint32_t k = 2; k < walls->count; ++k) plate[k] = NAN, insulated[k] = 1;
    for (uint32_t i = 0; i < bed->n; ++i) {
        unknown[i] = NAN;
        conductivity[i] = relative ? relative[i] * 8 * bed->r[i] : INFINITY; /* sigma and T between the plates are 1 */
    }
    fibrad_heat_sources sources;
    fibrad_heat_sources_init(&sources);
    sources.sigma = 1, sources.surroundings = relative ? 1 : 0;
    sources.conductivity = relative ? conductivity : NULL;
    sources.temperature = unknown, sources.emissivity = emissivity, sources.power = given;
    sources.wall_temperature = plate, sources.wall_emissivity = black, sources.insulated = insulated;
    fibrad_heat_result result = {.power = gained, .wall_power = power, .wall_error = error, .temperature = emission};
    const int status = bed_solve(bed, walls, directions, &sources, &run, &result);
    for (uint32_t i = 0; i < bed->n && !status; ++i) emission[i] = steady_share(emission[i], plate);
    for (int k = 0; k < 2; ++k) {
        power[k] /= gsl_pow_4(plate[0]) - gsl_pow_4(plate[1]);
        error[k] /= gsl_pow_4(plate[0]) - gsl_pow_4(plate[1]);
    }
    free(given);
    return bed_options_status(options, bed, status, &run.fault);
}

int steady_fit(const struct bed *bed, const char *file, int axis, const struct walls *plates, double unit,
               double *values, double *place, struct steady_line *line) {
    const double low = plates->wall[0].plane.at, high = plates->wall[1].plane.at, *centre = bed_centres(bed, axis);
    double c0, cov00, cov01, cov11, squares;
    *line = (struct steady_line){0};
    for (uint32_t i = 0; i < bed->n; ++i) {
        if (isnan(values[i]) || fabs(centre[i] - (low + high) / 2) > (high - low) / 4) continue;
        place[line->spheres] = centre[i] * unit;
        values[line->spheres++] = values[i];
    }
    if (line->spheres < FITTED_MIN)
        return message_at(STATUS_INPUT, file, 0, "%u spheres in the inner half along %c are too few for a line",
                          line->spheres, 'x' + axis);
    gsl_fit_linear(place, 1, values, 1, line->spheres, &c0, &line->slope, &cov00, &cov01, &cov11, &squares);
    line->error = sqrt(cov11);
    return STATUS_OK;
}

/* F_E of an open bed from one number of directions. Its error is that of the line and that of the powers. */
static int steady_factor(struct bed_options *options, const struct bed *bed, const struct walls *sides,
                         const double *emissivity, const double *relative, int axis, uint32_t directions,
                         struct steady *steady) {
    const struct walls walls = steady_walls(bed, sides, axis);
    double *emission = malloc(bed->n * sizeof *emission), *place = malloc(bed->n * sizeof *place);
    double power[WALLS_MAX], error[WALLS_MAX], diameter = 0;
    struct steady_line line;
    int status = emission && place ? STATUS_OK : message_memory();
    if (!status) status = steady_solve(options, bed, &walls, emissivity, relative, directions, emission, power, error);
    if (!status) status = steady_fit(bed, options->name, axis, &walls, 1, emission, place, &line);
    if (!status) {
        steady->spheres = line.spheres;
        for (uint32_t i = 0; i < bed->n; ++i) diameter += 2 * bed->r[i] / bed->n;
        steady->factor = power[1] / (steady_area(bed, sides, axis) * diameter * -line.slope);
        steady->error = steady->factor * hypot(line.error / line.slope, error[1] / power[1]);
    }
    free(emission);
    free(place);
    return status;
}

int steady_conduction(struct bed_options *options, const struct bed *bed, const struct walls *walls,
                      const double *emissivity, const double *relative, int axis, struct steady *steady) {
    const double begun = progress_clock();
    struct bed open = *bed;
    struct steady rough = {0};
    open.period[axis] = 0;
    int status = steady_factor(options, &open, walls, emissivity, relative, axis, STEADY_DIRECTIONS / 2, &rough);
    if (!status) status = steady_factor(options, &open, walls, emissivity, relative, axis, STEADY_DIRECTIONS, steady);
    steady->error = hypot(steady->error, steady->factor - rough.factor);
    steady->seconds = progress_clock() - begun;
    return status;
}
