/* sphere_conduction.c - spheres that conduct, so that their surfaces are not at one temperature.
 * SPDX-License-Identifier: MIT
 *
 * The inside is steady, and sources are spread evenly inside. If the surface temperature T is a harmonic of degree l,
 * the flux k l T/r is conducted inwards. Emission is linear in T about the mean T0 of the surface. Let w = N J/A be the
 * flux that is absorbed, E the emission, d the diameter and K = k/(4 d sigma T0^3). Then w = 2 K l E in degree l. With
 * J = E + (1 - eps) w/eps,
 *
 *     w = g J,   1/g = 1/eps_l - 1,   1/eps_l = 1/eps + 1/(2 K l).
 *
 * If light of the flux a is absorbed besides, w + a is conducted, and w = g (J - a/(2 K l)).
 *
 * A film takes h (T - T0) out of the pattern besides. Then l + h R/k stands for l, R being the radius.
 *
 * The mean over a surface has the emissivity eps itself. 1/(2 K) is called unevenness here. It is 0 for a sphere at one
 * temperature. */
#include "heat/solution.h"

#define NUMBERS (FIBRAD_HARMONICS_WITHIN + 1)

/* Below EVEN, the unevenness of a sphere changes no result. Below LEAST, it changes no flux that is absorbed: then
 * LEAST takes its place, since black spheres have gains in proportion to its inverse. */
#define EVEN  1e-9
#define LEAST 1e-6

/* Harmonics of the present level. */
static const fibrad_harmonics *harmonics_of(const fibrad_heat *heat) {
    return &heat->harmonics[heat->solution.group > 1];
}

/* The degree of number k of a filter, plus h R/k of a film. */
static double degree_of(const fibrad_heat *heat, uint32_t b, uint32_t k) {
    return (k < FIBRAD_HARMONICS_DEGREES ? k : fibrad_harmonics_within(harmonics_of(heat))) + fibrad_heat_biot(heat, b);
}

/* Filters values on the patches of sphere b. */
static double filter_sphere(const fibrad_heat *heat, uint32_t b, const double by[NUMBERS], const double *pattern,
                            double *to) {
    const uint32_t first = heat->first[b], fine = heat->division.first_four[b];
    const fibrad_harmonics_patches on = {heat->solution.area + first, heat->config.patches, heat->first[b + 1] - first,
                                         heat->division.on_patch + fine};
    return fibrad_harmonics_filter(harmonics_of(heat), &on, by, pattern + first, to != NULL ? to + first : NULL);
}

/* g by degree. It is 0 for the mean, which solve.c treats. */
static void find_gains(const fibrad_heat *heat, uint32_t b, double by[NUMBERS]) {
    const double eps = heat->sources.emissivity[b];
    by[0] = 0;
    for (uint32_t k = 1; k < NUMBERS; k++) {
        const double uneven = fibrad_max(heat->sources.unevenness[b], LEAST) / degree_of(heat, b, k);
        by[k] = eps / (1 - eps + eps * uneven);
    }
}

double fibrad_heat_largest_gain(const fibrad_heat *heat, uint32_t b) {
    double by[NUMBERS];
    find_gains(heat, b, by);
    return by[FIBRAD_HARMONICS_WITHIN];
}

/* 1/(1 + g) by degree. For the mean it is 0 as well. */
static void find_dampings(const fibrad_heat *heat, uint32_t b, double by[NUMBERS]) {
    find_gains(heat, b, by);
    for (uint32_t k = 1; k < NUMBERS; k++) by[k] = 1 / (1 + by[k]);
}

double fibrad_heat_sent_back(const fibrad_heat *heat, uint32_t body) {
    const double eps = heat->sources.emissivity[body];
    const double uneven = fibrad_heat_conducts(heat, body) ? heat->sources.unevenness[body] / (2 * heat->side) : 0;
    return 1 - eps / (1 + eps * uneven);
}

/* The unevenness of a sphere at its present emission. */
static double unevenness_of(const fibrad_heat *heat, uint32_t b) {
    const double t = fibrad_heat_temperature(heat, heat->sources.emission[b]);
    const double slope = t > 0 && heat->sources.emissivity[b] > 0 ? 4 * heat->sources.sigma * t * t * t : 0;
    const double uneven = heat->scene->r[b] * slope / heat->sources.conductivity[b];
    return uneven > EVEN ? uneven : 0;
}

double fibrad_heat_find_unevenness(fibrad_heat *heat, double least) {
    double change = 0;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        const double last = heat->sources.unevenness[b];
        change = fibrad_max(change, fibrad_abs(unevenness_of(heat, b) - last) / fibrad_max(last, EVEN));
    }
    if (!(change > least)) return change;
    heat->sources.conducts = false;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        heat->sources.unevenness[b] = unevenness_of(heat, b);
        heat->sources.conducts = heat->sources.conducts || heat->sources.conductivity[b] < __builtin_inf();
    }
    return change;
}

/* Replaces values on patches of a sphere by the means of groups that share one J. */
static void average_groups(const fibrad_heat *heat, uint32_t b, double *value) {
    const uint32_t end = heat->first[b + 1], group = heat->solution.group;
    for (uint32_t a = heat->first[b]; a < end && group > 1; a += group) {
        double sum = 0, area = 0;
        for (uint32_t k = a; k < a + group; k++)
            sum += heat->solution.area[k] * value[k], area += heat->solution.area[k];
        for (uint32_t k = a; k < a + group; k++) value[k] = area > 0 ? sum / area : 0;
    }
}

/* The flux that each patch of a sphere absorbs. */
static void find_fluxes(const fibrad_heat *heat, uint32_t b, double *flux) {
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
        flux[a] = heat->solution.area[a] > 0 ? heat->solution.net[a] / heat->solution.area[a] : 0;
}

/* Subtracts from values on a sphere their mean, which would leave rounding errors in products. */
static void take_mean_off(const fibrad_heat *heat, uint32_t b, double *value) {
    const double mean = fibrad_heat_mean(heat, b, value);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) value[a] -= mean;
}

double fibrad_heat_pattern_residual(fibrad_heat *heat, uint32_t b, double shift) {
    double by[NUMBERS], *change = heat->solution.source, *residual = heat->solution.gathered, slope = 0;
    find_fluxes(heat, b, residual);
    find_gains(heat, b, by);
    filter_sphere(heat, b, by, heat->solution.radiosity, change);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) residual[a] -= change[a];
    take_mean_off(heat, b, residual);
    average_groups(heat, b, residual);
    find_dampings(heat, b, by);
    filter_sphere(heat, b, by, residual, change);
    average_groups(heat, b, change);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) {
        slope += heat->solution.area[a] * residual[a] * change[a];
        change[a] += shift;
    }
    return slope;
}

double fibrad_heat_pattern_curvature(const fibrad_heat *heat, uint32_t b) {
    double by[NUMBERS];
    find_gains(heat, b, by);
    return filter_sphere(heat, b, by, heat->solution.direction, NULL);
}

/* The ratio of the pattern of emission to the pattern of J, by degree: g/(2 K l). */
static void find_emitted(const fibrad_heat *heat, uint32_t b, double by[NUMBERS]) {
    find_gains(heat, b, by);
    for (uint32_t k = 1; k < NUMBERS; k++) by[k] *= heat->sources.unevenness[b] / degree_of(heat, b, k);
}

double fibrad_heat_entering(const fibrad_heat *heat, uint32_t a) {
    return (heat->sources.absorbed != NULL ? heat->sources.absorbed[a] : 0) +
           (heat->spots.entering != NULL ? heat->spots.entering[a] : 0);
}

/* Filters the power per area that enters patches of a sphere. Overwrites heat->solution.gathered. */
static double filter_absorbed(fibrad_heat *heat, uint32_t b, const double by[NUMBERS], double *to) {
    double *flux = heat->solution.gathered;
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
        flux[a] = heat->solution.area[a] > 0 ? fibrad_heat_entering(heat, a) / heat->solution.area[a] : 0;
    take_mean_off(heat, b, flux);
    return filter_sphere(heat, b, by, flux, to);
}

/* As find_emitted. Light is taken to be even within the patches of the cube: it has few points on a fine patch. */
static void find_heated(const fibrad_heat *heat, uint32_t b, double by[NUMBERS]) {
    find_emitted(heat, b, by);
    by[FIBRAD_HARMONICS_WITHIN] = 0;
}

void fibrad_heat_stand_for_absorbed(fibrad_heat *heat, uint32_t b, double share) {
    double by[NUMBERS], *more = heat->solution.source;
    find_heated(heat, b, by);
    filter_absorbed(heat, b, by, more);
    take_mean_off(heat, b, more);
    average_groups(heat, b, more);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
        heat->solution.net[a] += share * heat->solution.area[a] * more[a];
}

double fibrad_heat_add_absorbed(fibrad_heat *heat, uint32_t b) {
    double by[NUMBERS], damping[NUMBERS];
    fibrad_heat_stand_for_absorbed(heat, b, 1);
    find_heated(heat, b, by);
    find_dampings(heat, b, damping);
    for (uint32_t k = 0; k < NUMBERS; k++) by[k] *= by[k] * damping[k];
    return filter_absorbed(heat, b, by, NULL);
}

/* Adds to the emissions of a sphere what light adds to them. */
static void add_heated(fibrad_heat *heat, uint32_t b, double *emission) {
    double by[NUMBERS], *more = heat->solution.source;
    find_heated(heat, b, by);
    for (uint32_t k = 1; k < FIBRAD_HARMONICS_WITHIN; k++)
        by[k] = (1 - by[k]) * heat->sources.unevenness[b] / degree_of(heat, b, k);
    filter_absorbed(heat, b, by, more);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) emission[a] += more[a];
}

void fibrad_heat_find_spans(fibrad_heat *heat) {
    double *emission = heat->solution.direction;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        fibrad_heat_span *span = &heat->solution.span[b];
        double by[NUMBERS], low = 0, high = 0;
        if (fibrad_heat_conducts(heat, b)) {
            find_emitted(heat, b, by);
            filter_sphere(heat, b, by, heat->solution.radiosity, emission);
            if (fibrad_heat_is_entered(heat)) add_heated(heat, b, emission);
            average_groups(heat, b, emission);
            for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
                low = fibrad_min(low, emission[a]), high = fibrad_max(high, emission[a]);
        }
        span->low = low, span->high = high;
    }
}
