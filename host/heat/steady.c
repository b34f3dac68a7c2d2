/* steady.c - effective conductivity of a bed between two plates; no sphere gains or loses heat.
 * SPDX-License-Identifier: MIT */
#include "heat/steady.h"

#include <gsl/gsl_fit.h>
#include <gsl/gsl_math.h>
#include <math.h>
#include <stdlib.h>

#include "bed/bed_scene.h"
#include "bed/conduction.h"
#include "cli/message.h"

enum { FITTED_MIN = 40, DIRECTIONS = 400 };

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

/* Temperatures of the plates over their mean. They differ so little that k* of spheres is the same everywhere. */
#define HOTTER 1.0005
#define COLDER 0.9995

/* T^4 of a temperature T, 0 at the upper plate and 1 at the lower one. */
static double steady_share(double t, const double plate[2]) {
    return (gsl_pow_4(t) - gsl_pow_4(plate[1])) / (gsl_pow_4(plate[0]) - gsl_pow_4(plate[1]));
}

/* Finds sigma T^4 of the spheres if it is 1 at the lower plate and 0 at the upper one, and the powers of the plates. */
static int steady_solve(struct bed_options *options, const struct bed *bed, const struct walls *walls,
                        const double *emissivity, const double *relative, uint32_t directions, double *emission,
                        double power[WALLS_MAX], double error[WALLS_MAX]) {
    const fibrad_scene_config scene = bed_scene(bed, walls);
    const fibrad_spheres spheres = bed_spheres(bed);
    fibrad_run run = bed_options_run(options);
    fibrad_radiation *radiation = NULL;
    double *unknown = malloc(bed->n * sizeof *unknown), *given = calloc(bed->n, sizeof *given);
    double *gained = malloc(bed->n * sizeof *gained), *conductivity = malloc(bed->n * sizeof *conductivity);
    double plate[WALLS_MAX] = {relative ? HOTTER : 1, relative ? COLDER : 0}, black[WALLS_MAX] = {1, 1};
    unsigned char insulated[WALLS_MAX] = {0};
    for (uint32_t k = 2; k < walls->count; ++k) plate[k] = NAN, insulated[k] = 1;
    int status = unknown && given && gained && conductivity ? FIBRAD_OK : FIBRAD_E_MEMORY;
    for (uint32_t i = 0; i < bed->n && !status; ++i) {
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
    const fibrad_heat_config config = {.directions = directions};
    if (!status) status = fibrad_radiation_new(&radiation, &scene, &spheres, &config, &run);
    if (!status) status = fibrad_radiation_solve(radiation, &sources, &result);
    for (uint32_t i = 0; i < bed->n && !status; ++i) emission[i] = steady_share(emission[i], plate);
    for (int k = 0; k < 2; ++k) {
        power[k] /= gsl_pow_4(plate[0]) - gsl_pow_4(plate[1]);
        error[k] /= gsl_pow_4(plate[0]) - gsl_pow_4(plate[1]);
    }
    fibrad_radiation_free(radiation);
    free(unknown);
    free(given);
    free(gained);
    free(conductivity);
    return bed_options_status(options, bed, status, &run.fault);
}

/* Fits a straight line to sigma T^4 of the spheres of the inner half. */
static void steady_fit(const struct bed *bed, int axis, const struct walls *walls, double *emission, double *place,
                       struct steady *steady, double *slope, double *slope_error) {
    const double low = walls->wall[0].plane.at, high = walls->wall[1].plane.at, *centre = bed_centres(bed, axis);
    double c0, cov00, cov01, cov11, squares;
    size_t n = 0;
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double at = centre[i];
        if (isnan(emission[i]) || fabs(at - (low + high) / 2) > (high - low) / 4) continue;
        place[n] = at;
        emission[n++] = emission[i];
    }
    steady->spheres = (uint32_t)n;
    if (n < FITTED_MIN) return;
    gsl_fit_linear(place, 1, emission, 1, n, &c0, slope, &cov00, &cov01, &cov11, &squares);
    *slope_error = sqrt(cov11);
}

/* F_E of an open bed from one number of directions. Its error is that of the line and that of the powers. */
static int steady_factor(struct bed_options *options, const struct bed *bed, const struct walls *sides,
                         const double *emissivity, const double *relative, int axis, uint32_t directions,
                         struct steady *steady) {
    const struct walls walls = steady_walls(bed, sides, axis);
    double *emission = malloc(bed->n * sizeof *emission), *place = malloc(bed->n * sizeof *place);
    double power[WALLS_MAX], error[WALLS_MAX], diameter = 0, slope = NAN, slope_error = NAN;
    int status = emission && place ? STATUS_OK : message_memory();
    if (!status) status = steady_solve(options, bed, &walls, emissivity, relative, directions, emission, power, error);
    if (!status) steady_fit(bed, axis, &walls, emission, place, steady, &slope, &slope_error);
    if (!status && steady->spheres < FITTED_MIN)
        status =
            message_at(STATUS_INPUT, options->name, 0, "%u spheres in the inner half along %c are too few for a line",
                       steady->spheres, 'x' + axis);
    if (!status) {
        for (uint32_t i = 0; i < bed->n; ++i) diameter += 2 * bed->r[i] / bed->n;
        steady->factor = power[1] / (steady_area(bed, sides, axis) * diameter * -slope);
        steady->error = steady->factor * hypot(slope_error / slope, error[1] / power[1]);
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
    int status = steady_factor(options, &open, walls, emissivity, relative, axis, DIRECTIONS / 2, &rough);
    if (!status) status = steady_factor(options, &open, walls, emissivity, relative, axis, DIRECTIONS, steady);
    steady->error = hypot(steady->error, steady->factor - rough.factor);
    steady->seconds = progress_clock() - begun;
    return status;
}
