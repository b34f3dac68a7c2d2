/* steady.c - effective conductivity of a bed between two plates; no sphere gains or loses heat.
 * SPDX-License-Identifier: MIT */
#include "heat/steady.h"

#include <gsl/gsl_fit.h>
#include <gsl/gsl_math.h>
#include <math.h>
#include <stdlib.h>

#include "bed/bed_scene.h"
#include "cli/message.h"

enum { FITTED_MIN = 40, DIRECTIONS = 400 };

bool steady_possible(const struct bed *bed, int axis) {
    return bed->period[(axis + 1) % 3] > 0 && bed->period[(axis + 2) % 3] > 0;
}

static double steady_place(const struct bed *bed, int axis, uint32_t i) {
    return (axis == 0 ? bed->x : axis == 1 ? bed->y : bed->z)[i];
}

struct walls steady_plates(const struct bed *bed, int axis) {
    double end[2] = {INFINITY, -INFINITY};
    for (uint32_t i = 0; i < bed->n; ++i) {
        end[0] = fmin(end[0], steady_place(bed, axis, i) - bed->r[i]);
        end[1] = fmax(end[1], steady_place(bed, axis, i) + bed->r[i]);
    }
    struct walls plates = {.count = 2};
    for (int k = 0; k < 2; ++k) plates.body[k] = (fibrad_body){.kind = FIBRAD_BODY_PLANE, .plane = {axis, k, end[k]}};
    return plates;
}

/* Temperatures of the plates over their mean. They differ so little that k* of spheres is the same everywhere. */
#define HOTTER 1.0005
#define COLDER 0.9995

/* T^4 of a temperature T, 0 at the upper plate and 1 at the lower one. */
static double steady_share(double t, const double plate[2]) {
    return (gsl_pow_4(t) - gsl_pow_4(plate[1])) / (gsl_pow_4(plate[0]) - gsl_pow_4(plate[1]));
}

/* Finds sigma T^4 of the spheres if it is 1 at the lower plate and 0 at the upper one, and the powers of the plates. */
static int steady_solve(struct bed_options *options, const struct bed *bed, const struct walls *plates,
                        const double *emissivity, const double *relative, uint32_t directions, double *emission,
                        double power[2], double error[2]) {
    const fibrad_scene_config scene = bed_scene(bed, plates);
    const fibrad_spheres spheres = bed_spheres(bed);
    fibrad_run run = bed_options_run(options);
    fibrad_radiation *radiation = NULL;
    double *unknown = malloc(bed->n * sizeof *unknown), *given = calloc(bed->n, sizeof *given);
    double *gained = malloc(bed->n * sizeof *gained), *conductivity = malloc(bed->n * sizeof *conductivity);
    const double plate[2] = {relative ? HOTTER : 1, relative ? COLDER : 0};
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
    sources.body_temperature = plate, sources.body_emissivity = (const double[]){1, 1};
    fibrad_heat_result result = {.power = gained, .body_power = power, .body_error = error, .temperature = emission};
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
static void steady_fit(const struct bed *bed, int axis, const struct walls *plates, double *emission, double *place,
                       struct steady *steady, double *slope, double *slope_error) {
    const double low = plates->body[0].plane.at, high = plates->body[1].plane.at;
    double c0, cov00, cov01, cov11, squares;
    size_t n = 0;
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double at = steady_place(bed, axis, i);
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
static int steady_factor(struct bed_options *options, const struct bed *bed, const double *emissivity,
                         const double *relative, int axis, uint32_t directions, struct steady *steady) {
    const struct walls plates = steady_plates(bed, axis);
    double *emission = malloc(bed->n * sizeof *emission), *place = malloc(bed->n * sizeof *place);
    double power[2], error[2], diameter = 0, slope = NAN, slope_error = NAN;
    int status = emission && place ? STATUS_OK : message_memory();
    if (!status) status = steady_solve(options, bed, &plates, emissivity, relative, directions, emission, power, error);
    if (!status) steady_fit(bed, axis, &plates, emission, place, steady, &slope, &slope_error);
    if (!status && steady->spheres < FITTED_MIN)
        status =
            message_at(STATUS_INPUT, options->name, 0, "%u spheres in the inner half along %c are too few for a line",
                       steady->spheres, 'x' + axis);
    if (!status) {
        for (uint32_t i = 0; i < bed->n; ++i) diameter += 2 * bed->r[i] / bed->n;
        const double area = bed->period[(axis + 1) % 3] * bed->period[(axis + 2) % 3];
        steady->factor = power[1] / (area * diameter * -slope);
        steady->error = steady->factor * hypot(slope_error / slope, error[1] / power[1]);
    }
    free(emission);
    free(place);
    return status;
}

int steady_conduction(struct bed_options *options, const struct bed *bed, const double *emissivity,
                      const double *relative, int axis, struct steady *steady) {
    const double begun = progress_clock();
    struct bed open = *bed;
    struct steady rough = {0};
    open.period[axis] = 0;
    int status = steady_factor(options, &open, emissivity, relative, axis, DIRECTIONS / 2, &rough);
    if (!status) status = steady_factor(options, &open, emissivity, relative, axis, DIRECTIONS, steady);
    steady->error = hypot(steady->error, steady->factor - rough.factor);
    steady->seconds = progress_clock() - begun;
    return status;
}
