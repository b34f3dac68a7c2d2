/* corrected.c - powers for steps in time: by exchange factors that patches correct, or by patches alone.
 * SPDX-License-Identifier: MIT */
#include "simple/bed.h"

#define ROUGH_TOLERANCE 0.03 /* of factors that patches correct */
#define CHANGED         0.1  /* relative change of powers after which they are corrected again */
#define SMALL           1e-3 /* part of the emission below which powers need no correction */

/* Whether there are factors for the emissivities of the sources. */
static bool same_surfaces(const fibrad_bed *bed, const fibrad_heat_sources *s) {
    const fibrad_stepping *t = &bed->stepping;
    bool same = t->network != NULL;
    for (uint32_t i = 0; i < bed->facts.spheres && same; ++i) same = t->emissivity[i] == s->emissivity[i];
    for (uint32_t b = 0; b < bed->facts.walls && same; ++b) same = t->wall_emissivity[b] == s->wall_emissivity[b];
    return same;
}

/* Computes factors for the emissivities of the sources. */
static int make_network(fibrad_bed *bed, const fibrad_heat_sources *s) {
    fibrad_stepping *t = &bed->stepping;
    fibrad_bed_matrix *factors;
    const fibrad_exchange_rule rule = {
        .tolerance = ROUGH_TOLERANCE, .emissivity = s->emissivity, .wall_emissivity = s->wall_emissivity};
    fibrad_network_free(t->network);
    t->network = NULL;
    t->corrected = false;
    int status = fibrad_bed_exchange(bed, &rule, &factors);
    if (status) return status;
    status = fibrad_network_new(&t->network, factors, s->emissivity, t->area);
    if (status) fibrad_bed_matrix_free(factors);
    for (uint32_t i = 0; i < bed->facts.spheres; ++i) t->emissivity[i] = s->emissivity[i];
    for (uint32_t b = 0; b < bed->facts.walls; ++b) t->wall_emissivity[b] = s->wall_emissivity[b];
    return status;
}

int fibrad_stepping_prepare(fibrad_bed *bed, const fibrad_heat_sources *sources) {
    if (!bed->stepping.by_factors || same_surfaces(bed, sources)) return FIBRAD_OK;
    return make_network(bed, sources);
}

static double sum_of_squares(const double *values, uint32_t n) {
    double sum = 0;
    for (uint32_t i = 0; i < n; ++i) sum += values[i] * values[i];
    return sum;
}

/* Whether powers by factors (t->power, t->wall_power) have changed much since the last correction. */
static bool powers_changed(const fibrad_bed *bed, const fibrad_heat_sources *s) {
    const fibrad_stepping *t = &bed->stepping;
    double change = 0, emitted = 0;
    for (uint32_t i = 0; i < bed->facts.spheres; ++i) {
        const double square = s->temperature[i] * s->temperature[i], less = t->power[i] - t->compared[i];
        const double emission = t->area[i] * s->emissivity[i] * s->sigma * square * square;
        change += less * less, emitted += emission * emission;
    }
    for (uint32_t b = 0; b < bed->facts.walls; ++b) {
        const double less = t->wall_power[b] - t->wall_compared[b];
        change += less * less;
    }
    const double most = sum_of_squares(t->power, bed->facts.spheres) + sum_of_squares(t->wall_power, bed->facts.walls) +
                        SMALL * SMALL * emitted;
    return change > CHANGED * CHANGED * most;
}

int fibrad_stepping_compare(fibrad_bed *bed, const fibrad_heat_sources *s, uint64_t *corrections) {
    fibrad_stepping *t = &bed->stepping;
    if (!t->by_factors) return FIBRAD_OK;
    fibrad_heat_result factors = {.power = t->power, .wall_power = t->wall_power};
    fibrad_heat_result patches = {.power = t->by_patches, .wall_power = t->wall_correction};
    int status = fibrad_network_solve(t->network, &bed->team, s, t->allowed, &factors);
    if (status || (t->corrected && !powers_changed(bed, s))) return status;
    fibrad_heat_sources given = *s; /* a sphere has a temperature or a power, not both */
    given.power = NULL, given.no_errors = 1;
    status = fibrad_bed_solve_now(bed, &given, &patches);
    if (status) return status;
    for (uint32_t i = 0; i < bed->facts.spheres; ++i) {
        t->correction[i] = t->by_patches[i] - t->power[i];
        t->compared[i] = t->power[i];
    }
    for (uint32_t b = 0; b < bed->facts.walls; ++b) {
        t->wall_correction[b] -= t->wall_power[b];
        t->wall_compared[b] = t->wall_power[b];
    }
    t->surroundings_correction = patches.surroundings_power - factors.surroundings_power;
    t->corrected = true;
    ++*corrections;
    return FIBRAD_OK;
}

int fibrad_stepping_solve(fibrad_bed *bed, const fibrad_heat_sources *sources, fibrad_heat_result *result) {
    fibrad_stepping *t = &bed->stepping;
    if (!t->by_factors) return fibrad_bed_solve_now(bed, sources, result);
    for (uint32_t i = 0; i < bed->facts.spheres && t->corrected; ++i) t->source[i] += t->correction[i];
    const int status = fibrad_network_solve(t->network, &bed->team, sources, t->allowed, result);
    for (uint32_t i = 0; i < bed->facts.spheres && t->corrected; ++i) result->power[i] += t->correction[i];
    for (uint32_t b = 0; b < bed->facts.walls && t->corrected; ++b) result->wall_power[b] += t->wall_correction[b];
    if (t->corrected) result->surroundings_power += t->surroundings_correction;
    return status;
}
