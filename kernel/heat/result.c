/* result.c - hands out powers, temperatures and what errors they may have. SPDX-License-Identifier: MIT */
#include "base/port.h"
#include "heat/solve.h"

/* Errors over what they are told from, as measured: docs/heat.md. */
#define PATCH_ERROR .2
#define BEAM_ERROR  .2
#define FEW_ERROR   .25

static double squared(double x) { return x * x; }

/* Estimated error of the temperature of a body whose power is given: what extrapolation changed of its emission, and
 * what its beams miss, over what it would then emit more. */
static double temperature_error_of(const fibrad_heat *heat, uint32_t b, double power_error) {
    const double t = heat->temperature[b], slope = 4 * heat->sigma * t * t * t;
    if (!(heat->hold[b] >= 0) || !(slope > 0)) return 0;
    double area = 0;
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) area += heat->area[a];
    const double change = PATCH_ERROR * (heat->emission[b] - heat->coarse_emission[b]);
    const double missed = power_error / (heat->emissivity[b] * area + heat->hold[b]);
    return fibrad_sqrt(squared(change) + squared(missed)) / slope;
}

/* The temperature at which an insulated wall would emit what it sends back. */
static double insulated_temperature(const fibrad_heat *heat, uint32_t b) {
    double sum = 0, area = 0;
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
        sum += heat->area[a] * heat->radiosity[a], area += heat->area[a];
    return fibrad_heat_temperature(heat, area > 0 ? sum / area : 0);
}

/* Temperatures and their errors. Returns whether all that are unknown were found. */
static bool read_temperatures(const fibrad_heat *heat, const fibrad_heat_result *result) {
    bool found = true;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        const uint32_t i = heat->order[b];
        if (heat->hold[b] >= 0) found = found && heat->temperature[b] >= 0;
        if (result->temperature != NULL) result->temperature[i] = heat->temperature[b];
        if (result->temperature_error != NULL)
            result->temperature_error[i] = temperature_error_of(heat, b, BEAM_ERROR * fibrad_abs(heat->halves[b]));
    }
    for (uint32_t k = 0; k < heat->given_bodies; k++) {
        const uint32_t slot = heat->slot[k], b = fibrad_heat_wall_body(heat, slot);
        if (heat->hold[b] >= 0) found = found && heat->temperature[b] >= 0;
        if (result->body_temperature != NULL)
            result->body_temperature[k] = heat->insulated[slot] ? insulated_temperature(heat, b) : heat->temperature[b];
        if (result->body_temperature_error != NULL)
            result->body_temperature_error[k] = temperature_error_of(heat, b, 0);
    }
    return found;
}

int fibrad_heat_read(const fibrad_heat *heat, fibrad_heat_result *result) {
    if (heat == NULL || result == NULL || (heat->spheres > 0 && result->power == NULL)) return FIBRAD_E_ARGUMENT;
    if (heat->given_bodies > 0 && result->body_power == NULL) return FIBRAD_E_ARGUMENT;
    if (heat->phase != FIBRAD_HEAT_DONE || !fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    const uint32_t spheres = heat->spheres, open = heat->bodies - 1;
    double patches = 0, beams = 0, square = 0, reflected = 0;
    for (uint32_t b = 0; b < spheres; b++) {
        const double change = heat->power[b] - heat->coarse[b];
        result->power[heat->order[b]] = heat->power[b];
        patches += change * change, square += heat->power[b] * heat->power[b], reflected += 1 - heat->emissivity[b];
        beams += heat->halves[b] * heat->halves[b];
    }
    result->surroundings_power = heat->power[open];
    for (uint32_t b = 0; b < heat->given_bodies; b++) {
        const uint32_t k = heat->slot[b], beyond = fibrad_heat_beyond(heat, k), a = heat->first[beyond];
        result->body_power[b] = heat->power[fibrad_heat_wall_body(heat, k)];
        if (a == heat->first[beyond + 1]) continue;
        /* beyond its patches the wall takes eps of what comes and reflects the rest to the surroundings */
        const double less = heat->radiosity[a] - heat->wall_emission[k];
        const double absorbed = heat->wall_emissivity[k] * (heat->net[a] + heat->area[a] * less);
        result->body_power[b] += absorbed;
        result->surroundings_power += heat->power[beyond] - absorbed;
    }
    /* patches that few beams leave send too much back along each; not so if there is one radiosity per body */
    const double each = heat->group == 1 ? 2.0 * heat->beams / heat->thin / heat->config.patches : __builtin_inf();
    const double few = FEW_ERROR / each * fibrad_sqrt(reflected / fibrad_max(1, spheres));
    result->error_patches = PATCH_ERROR * fibrad_sqrt(patches / fibrad_max(1, spheres));
    result->error_beams = fibrad_sqrt((BEAM_ERROR * BEAM_ERROR * beams + few * few * square) / fibrad_max(1, spheres));
    result->sweeps = heat->sweeps;
    result->residual = heat->scale > 0 ? fibrad_sqrt(heat->slope / heat->scale) : 0;
    return read_temperatures(heat, result) ? FIBRAD_OK : FIBRAD_E_UNSOLVABLE;
}
