/* result.c - hands out powers, temperatures and what errors they may have. SPDX-License-Identifier: MIT */
#include "heat/problem.h"

/* Errors over what they are told from, as measured: docs/heat.md. */
#define PATCH_ERROR .2
#define BEAM_ERROR  .2
#define FEW_ERROR   .25

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
    const double each = heat->group == 1 ? 2.0 * heat->beams / heat->config.patches : __builtin_inf();
    const double few = FEW_ERROR / each * fibrad_sqrt(reflected / fibrad_max(1, spheres));
    result->error_patches = PATCH_ERROR * fibrad_sqrt(patches / fibrad_max(1, spheres));
    result->error_beams = fibrad_sqrt((BEAM_ERROR * BEAM_ERROR * beams + few * few * square) / fibrad_max(1, spheres));
    result->sweeps = heat->sweeps;
    result->residual = heat->scale > 0 ? fibrad_sqrt(heat->slope / heat->scale) : 0;
    return FIBRAD_OK;
}
