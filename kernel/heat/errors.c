/* errors.c - what errors the powers of a solution may have. SPDX-License-Identifier: MIT
 *
 * By how much even and odd beams of a body differ, and what patches change of the power of a sphere, is one sample of
 * the error of its power, and may be small by chance. Errors of bodies of one kind turn out to be as what they
 * exchange, times a normal number. So the estimate is, in squares, one half what the body's own sample says, one half
 * what all samples together say. What patches change of the power of a wall is smooth, and stands for itself. */
#include "heat/errors.h"

/* Errors over what they are told from, as measured: docs/heat.md. */
#define PATCH_ERROR  .2 /* with PATCHES */
#define PATCHES      96.0
#define WALL_PATCHES .5 /* of walls over that of spheres */
#define BEAM_ERROR   .7
#define FEW_ERROR    .25 /* times sqrt(1 - eps), over beams per patch: patches that few leave send back along each */
#define SAMPLES      3   /* with fewer of a kind, those of the other kind make up for them */

static double heat_square(double x) { return x * x; }

/* Areas of patches, and how their radiosities are spread. */
typedef struct heat_spread {
    double area, mean, variance;
} heat_spread;

/* Errors of the spheres or of the walls, and what they exchange: sums of squares. */
typedef struct heat_pool {
    double samples, errors, exchanges;
} heat_pool;

typedef struct heat_errors {
    heat_spread all;
    double few;        /* error over power and sqrt(1 - eps) */
    double walls;      /* error of what walls send out */
    heat_pool pool[2]; /* of spheres, of walls */
} heat_errors;

static heat_spread spread_over(const fibrad_heat *heat, uint32_t begin, uint32_t end) {
    heat_spread s = {0, 0, 0};
    for (uint32_t a = begin; a < end; a++) s.area += heat->area[a], s.mean += heat->area[a] * heat->radiosity[a];
    if (!(s.area > 0)) return s;
    s.mean /= s.area;
    for (uint32_t a = begin; a < end; a++)
        s.variance += heat->area[a] / s.area * heat_square(heat->radiosity[a] - s.mean);
    return s;
}

static heat_spread spread_of(const fibrad_heat *heat, uint32_t b) {
    return spread_over(heat, heat->first[b], heat->first[b + 1]);
}

/* Emissivity times area times how far the radiosities of all are from the body's own. */
static double exchange_of(const fibrad_heat *heat, const heat_errors *errors, uint32_t b) {
    const heat_spread own = spread_of(heat, b);
    return heat->emissivity[b] * own.area *
           fibrad_sqrt(errors->all.variance + heat_square(own.mean - errors->all.mean));
}

double fibrad_heat_beam_error(const fibrad_heat *heat, uint32_t b) {
    return BEAM_ERROR * heat->emissivity[b] * fibrad_abs(heat->halves[b]);
}

/* The fewer the patches, the less they tell. */
double fibrad_heat_patch_error(const fibrad_heat *heat, double change) {
    return PATCH_ERROR * fibrad_sqrt(fibrad_sqrt(PATCHES / heat->config.patches)) * change;
}

static double patch_error(const fibrad_heat *heat, uint32_t b) {
    const double change = heat->power[b] - heat->coarse[b];
    return (b < heat->spheres ? 1 : WALL_PATCHES) * fibrad_heat_patch_error(heat, change);
}

/* Square of the error that a body's own beams and patches tell, and the walls it sees. */
static double own_error(const fibrad_heat *heat, const heat_errors *errors, uint32_t b) {
    const double eps = heat->emissivity[b];
    const double few = b < heat->spheres ? errors->few * heat->power[b] : 0;
    const double seen = errors->all.area > 0 ? eps * spread_of(heat, b).area / errors->all.area : 0;
    const double patches = b < heat->spheres ? patch_error(heat, b) : 0;
    return heat_square(fibrad_heat_beam_error(heat, b)) + heat_square(patches) + (1 - eps) * heat_square(few) +
           heat_square(seen * errors->walls);
}

static heat_errors errors_of(const fibrad_heat *heat) {
    const uint32_t end = heat->spheres + FIBRAD_WALLS; /* of bodies that have patches of their own */
    heat_errors errors = {.all = spread_over(heat, 0, heat->first[end])};
    if (heat->group == 1) errors.few = FEW_ERROR * heat->config.patches * heat->thin / (2.0 * heat->beams);
    for (uint32_t b = heat->spheres; b < end; b++)
        errors.walls += heat_square((1 - heat->emissivity[b]) * BEAM_ERROR * heat->halves[b]);
    errors.walls = fibrad_sqrt(errors.walls);
    for (uint32_t b = 0; b < end; b++) {
        heat_pool *pool = &errors.pool[b >= heat->spheres];
        const double exchange = exchange_of(heat, &errors, b);
        if (!(exchange > 0) || heat->hold[b] >= 0) continue;
        pool->samples++, pool->errors += own_error(heat, &errors, b), pool->exchanges += heat_square(exchange);
    }
    return errors;
}

/* Square of the estimated error of a body's power. */
static double power_error_of(const fibrad_heat *heat, const heat_errors *errors, uint32_t b) {
    if (heat->hold[b] >= 0) return 0; /* it is given */
    const double exchange = exchange_of(heat, errors, b);
    const int own = b >= heat->spheres;
    double sum = 0, samples = 0;
    for (int kind = 0; kind < 2; kind++) {
        const heat_pool *pool = &errors->pool[kind];
        if (!(pool->exchanges > 0)) continue;
        const double weight = kind == own ? pool->samples : fibrad_max(0, SAMPLES - errors->pool[own].samples);
        sum += weight * pool->errors / pool->exchanges, samples += weight;
    }
    const double pooled = samples > 0 ? sum / samples * heat_square(exchange) : 0;
    const double smooth = b < heat->spheres ? 0 : patch_error(heat, b);
    return exchange > 0 ? heat_square(smooth) + (own_error(heat, errors, b) + pooled) / 2 : 0;
}

void fibrad_heat_read_errors(const fibrad_heat *heat, fibrad_heat_result *result) {
    const heat_errors errors = errors_of(heat);
    const double spheres = fibrad_max(1, heat->spheres);
    double patches = 0, all = 0;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        const double square = power_error_of(heat, &errors, b);
        if (result->power_error != NULL) result->power_error[heat->order[b]] = fibrad_sqrt(square);
        if (square > 0) patches += heat_square(patch_error(heat, b));
        all += square;
    }
    for (uint32_t k = 0; k < heat->given_bodies && result->body_error != NULL; k++)
        result->body_error[k] = fibrad_sqrt(power_error_of(heat, &errors, fibrad_heat_wall_body(heat, heat->slot[k])));
    patches = fibrad_min(patches, all);
    result->error_patches = fibrad_sqrt(patches / spheres);
    result->error_beams = fibrad_sqrt((all - patches) / spheres);
}
