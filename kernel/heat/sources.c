/* sources.c - what radiates, and where radiosities begin. SPDX-License-Identifier: MIT */
#include "heat/solve.h"

#define HEAT_TOLERANCE  1e-3
#define HEAT_SWEEPS_MAX 1000u

void fibrad_heat_sources_init(fibrad_heat_sources *sources) {
    if (sources == NULL) return;
    *sources = (fibrad_heat_sources){.surroundings = __builtin_nan(""), .sigma = FIBRAD_STEFAN_BOLTZMANN};
}

static bool is_share(double x) { return x >= 0 && x <= 1; }

/* Within these bounds no square of an emission, nor its product with areas, leaves the range of doubles. */
static bool is_temperature(double t) { return t >= 0 && t <= 1e20; }
static bool is_sigma(double sigma) { return sigma >= 1e-30 && sigma <= 1e30; }

static bool sources_valid(const fibrad_heat *heat, const fibrad_heat_sources *s) {
    const uint32_t bodies = heat->given_bodies;
    if (heat->spheres > 0 && (s->temperature == NULL || s->emissivity == NULL)) return false;
    if (bodies > 0 && (s->body_temperature == NULL || s->body_emissivity == NULL)) return false;
    for (uint32_t i = 0; i < heat->spheres; i++)
        if (!is_temperature(s->temperature[i]) || !is_share(s->emissivity[i])) return false;
    for (uint32_t b = 0; b < bodies; b++)
        if (!is_temperature(s->body_temperature[b]) || !is_share(s->body_emissivity[b])) return false;
    return is_temperature(s->surroundings) && is_sigma(s->sigma) && s->tolerance >= 0 && s->tolerance < 1;
}

/* sigma (T^4 - T0^4), T0 being that of the surroundings: all emission and radiosity is counted from theirs. */
static double emission_of(const fibrad_heat_sources *s, double t) {
    const double t0 = s->surroundings;
    return s->sigma * (t * t + t0 * t0) * (t + t0) * (t - t0);
}

/* Widens a range of emissions by that of a body, if it emits. */
static void widen_range(double range[2], double eps, double emission) {
    if (eps > 0) range[0] = fibrad_min(range[0], emission), range[1] = fibrad_max(range[1], emission);
}

/* The middle of what spheres and walls emit, where the radiosities of those that reflect all begin: so nothing flows
 * where all that emit do so alike. 0: none of them emits. */
static double middle_emission(const fibrad_heat *heat, const fibrad_heat_sources *s) {
    double range[2] = {__builtin_inf(), -__builtin_inf()};
    for (uint32_t i = 0; i < heat->spheres; i++)
        widen_range(range, s->emissivity[i], emission_of(s, s->temperature[i]));
    for (uint32_t b = 0; b < heat->given_bodies; b++)
        widen_range(range, s->body_emissivity[b], emission_of(s, s->body_temperature[b]));
    return range[0] <= range[1] ? range[0] + 0.5 * (range[1] - range[0]) : 0;
}

/* Emissivity and emission of a body; `middle` for one that reflects all, whose own plays no part. What lies beyond the
 * patches of a wall receives no more than the surroundings send, its area being infinite; so it is like a black body of
 * that radiosity. */
static void set_body(fibrad_heat *heat, const fibrad_heat_sources *s, double middle, uint32_t b) {
    const uint32_t spheres = heat->spheres;
    double eps = 1, emission = 0;
    if (b < spheres) {
        const uint32_t i = heat->order[b];
        eps = s->emissivity[i], emission = emission_of(s, s->temperature[i]);
    } else if (b + 1 < heat->bodies) {
        const uint32_t wall = (b - spheres) % FIBRAD_WALLS;
        const double wall_eps = heat->wall_emissivity[wall], wall_emission = heat->wall_emission[wall];
        if (b < spheres + FIBRAD_WALLS)
            eps = wall_eps, emission = wall_emission;
        else
            emission = wall_eps * wall_emission;
    }
    if (eps == 0) emission = middle;
    /* an earlier solution goes up or down with the emission; the coarser level begins with what it had of it */
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) {
        if (heat->warm && !s->uniform && eps < 1)
            heat->radiosity[a] += emission - heat->emission[b] - heat->detail[a];
        else
            heat->radiosity[a] = emission, heat->detail[a] = 0;
    }
    heat->emissivity[b] = eps, heat->emission[b] = emission;
}

int fibrad_heat_begin(fibrad_heat *heat, const fibrad_heat_sources *sources) {
    if (heat == NULL || sources == NULL || !sources_valid(heat, sources)) return FIBRAD_E_ARGUMENT;
    if (!fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    for (uint32_t task = 0; task < fibrad_heat_tasks(heat); task++)
        if (!heat->traced[task]) return FIBRAD_E_STATE;
    fibrad_zero(heat->wall_emissivity, sizeof heat->wall_emissivity);
    fibrad_zero(heat->wall_emission, sizeof heat->wall_emission);
    for (uint32_t b = 0; b < heat->given_bodies; b++) {
        heat->wall_emissivity[heat->slot[b]] = sources->body_emissivity[b];
        heat->wall_emission[heat->slot[b]] = emission_of(sources, sources->body_temperature[b]);
    }
    const double middle = middle_emission(heat, sources);
    for (uint32_t b = 0; b < heat->bodies; b++) set_body(heat, sources, middle, b);
    heat->group = sources->uniform ? UINT32_MAX : 4;
    heat->tolerance = sources->tolerance > 0 ? sources->tolerance : HEAT_TOLERANCE;
    heat->limit = sources->sweeps_max > 0 ? sources->sweeps_max : HEAT_SWEEPS_MAX;
    heat->sweeps = 0;
    heat->warm = false;
    fibrad_zero(heat->swept, heat->config.parts);
    fibrad_heat_start(heat);
    return FIBRAD_OK;
}
