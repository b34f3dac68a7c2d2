/* lit_bed.c - what a bed absorbs of light from outside, and its profile along an axis. SPDX-License-Identifier: MIT */
#include <gsl/gsl_math.h>
#include <stdlib.h>
#include <string.h>

#include "heat/heat.h"

int light_begin(struct heat *h) {
    const struct light_options *options = &h->light;
    const uint32_t n = h->bed->n;
    struct light_state *state = &h->lit;
    int status = STATUS_OK;
    if (options->lights == 0) return STATUS_OK;
    if (options->absorptivity.given) {
        status = quantity_values(&options->absorptivity, h->bed, h->options.name, "absorptivity", 0, 0, 1,
                                 &state->absorptivity);
    } else {
        state->absorptivity = malloc((n + (size_t)1) * sizeof(double));
        if (state->absorptivity) memcpy(state->absorptivity, h->emissivity, n * sizeof(double));
    }
    for (uint32_t k = 0; k < h->walls.count; ++k) {
        const double absorptivity = h->walls.said[k].absorptivity;
        state->of_walls[k] = isnan(absorptivity) ? h->wall_emissivity[k] : absorptivity;
    }
    state->absorbed = calloc(4 * (n + (size_t)1), sizeof(double));
    if (state->absorbed)
        state->first = state->absorbed + n, state->error = state->first + n, state->power = state->error + n;
    state->options = options;
    return !status && !(state->absorptivity && state->absorbed) ? message_memory() : status;
}

void light_free(struct light_state *state) {
    free(state->absorptivity);
    free(state->absorbed);
    *state = (struct light_state){0};
}

/* The powers of thermal radiation: what is given, and what is absorbed of the light. */
static void add_absorbed(struct heat *h, fibrad_heat_sources *sources) {
    struct light_state *state = &h->lit;
    for (uint32_t i = 0; i < h->bed->n; ++i)
        state->power[i] = (sources->power ? sources->power[i] : NAN) + state->absorbed[i];
    for (uint32_t k = 0; k < h->walls.count; ++k)
        state->wall_power[k] = (sources->wall_power ? sources->wall_power[k] : NAN) + state->wall[k];
    sources->power = state->power, sources->wall_power = state->wall_power;
    sources->absorbed = state->result.patches;
}

int light_absorb(struct heat *h, double unit, fibrad_heat_sources *sources) {
    struct light_state *state = &h->lit;
    const struct light_options *options = state->options;
    fibrad_light scaled[LIGHTS_MAX];
    if (!options) return FIBRAD_OK;
    for (uint32_t k = 0; k < options->lights; ++k) scaled[k] = options->light[k], scaled[k].flux *= unit;
    fibrad_light_sources light = {.lights = options->lights, .light = scaled, .absorptivity = state->absorptivity};
    light.wall_absorptivity = state->of_walls;
    state->result = (fibrad_light_result){.absorbed = state->absorbed, .wall_absorbed = state->wall};
    state->result.absorbed_first = state->first, state->result.wall_absorbed_first = state->wall_first;
    state->result.absorbed_error = state->error, state->result.wall_absorbed_error = state->wall_error;
    const int status = fibrad_bed_shine(h->made, &light, &state->result);
    state->failed = status;
    if (!status) add_absorbed(h, sources);
    return status;
}

int light_refuse(const struct heat *h, int status, const fibrad_fault *fault) {
    const uint32_t light = h->lit.result.lights + 1;
    if (!h->lit.failed) return STATUS_OK;
    if (status == FIBRAD_E_UNSOLVABLE)
        return message(STATUS_USAGE, "--irradiate: nothing absorbs the light, and it cannot leave");
    switch (fault->why) {
    case FIBRAD_WHY_DARK:
        return message(STATUS_USAGE,
                       "--irradiate: no open face lets light %u in; it needs an opening where it comes from, such as "
                       "zmax:open, or zmax:open:at=H at the rim of side walls",
                       light);
    case FIBRAD_WHY_FOOTPRINT:
        return message(STATUS_USAGE,
                       "--irradiate: the disc of light %u lies inside the bed: sphere %lld is before it; move the disc "
                       "against the light",
                       light, (long long)bed_name(h->bed, fault->first));
    case FIBRAD_WHY_LIGHT:
        return message(STATUS_USAGE,
                       "--irradiate: light %u: a number is out of range, or its beam is wider than a period", light);
    default:
        return STATUS_OK;
    }
}

void light_scale(struct heat *h, double factor) {
    struct light_state *state = &h->lit;
    fibrad_light_result *r = &state->result;
    if (!state->options) return;
    for (uint32_t i = 0; i < h->bed->n; ++i)
        state->absorbed[i] *= factor, state->first[i] *= factor, state->error[i] *= factor;
    for (uint32_t k = 0; k < h->walls.count; ++k)
        state->wall[k] *= factor, state->wall_first[k] *= factor, state->wall_error[k] *= factor;
    r->incident *= factor, r->transmitted *= factor, r->reflected *= factor, r->error *= factor;
    r->error_patches *= factor;
}

/* Adds the error of the absorbed light to that of a temperature that was found. conducts: what contacts and films
 * conduct for each kelvin. */
static void add_to_temperature(const struct heat *h, double area, double emissivity, double conducts, double light,
                               double temperature, double *error) {
    const double slope = 4 * h->sources.sigma * gsl_pow_3(temperature) * area * emissivity + conducts;
    if (slope > 0) *error = hypot(*error, light / slope);
}

/* The same of all temperatures. */
static void add_to_temperatures(struct heat *h) {
    const fibrad_heat_sources *s = &h->sources;
    const fibrad_heat_result *r = &h->result;
    const struct light_state *state = &h->lit;
    double *conducts = calloc(h->bed->n + WALLS_MAX, sizeof *conducts);
    for (uint32_t i = 0; conducts && s->film && i < h->bed->n; ++i) conducts[i] = s->film[i];
    for (uint32_t k = 0; conducts && s->wall_film && k < h->walls.count; ++k) conducts[h->bed->n + k] = s->wall_film[k];
    for (uint32_t k = 0; conducts && k < s->contacts; ++k)
        for (int end = 0; end < 2 && s->contact_first[k] != s->contact_second[k]; ++end)
            conducts[end ? s->contact_second[k] : s->contact_first[k]] += s->conductance[k];
    for (uint32_t i = 0; i < h->bed->n && conducts; ++i) {
        double *const errors[] = {r->temperature_error, r->surface_error, r->centre_error};
        const double area = 4 * M_PI * gsl_pow_2(h->bed->r[i]);
        for (int k = 0; k < 3 && isnan(s->temperature[i]); ++k)
            if (errors[k])
                add_to_temperature(h, area, s->emissivity[i], conducts[i], state->error[i], r->temperature[i],
                                   &errors[k][i]);
    }
    for (uint32_t k = 0; k < h->walls.count && conducts; ++k)
        if (isnan(s->wall_temperature[k]) && !s->insulated[k])
            add_to_temperature(h, r->wall_area[k], s->wall_emissivity[k], conducts[h->bed->n + k], state->wall_error[k],
                               r->wall_temperature[k], &r->wall_temperature_error[k]);
    free(conducts);
}

void light_add(struct heat *h) {
    const struct light_state *state = &h->lit;
    const fibrad_light_result *light = &state->result;
    const uint32_t spheres = h->bed->n;
    fibrad_heat_result *result = &h->result;
    double square = 0;
    if (!state->options) return;
    if (!h->given.timed) add_to_temperatures(h);
    for (uint32_t i = 0; i < spheres; ++i) {
        result->power[i] += state->absorbed[i];
        if (isnan(h->sources.temperature[i])) continue;
        result->power_error[i] = hypot(result->power_error[i], state->error[i]);
        square += state->error[i] * state->error[i];
    }
    square /= spheres > 0 ? spheres : 1;
    const double patches = fmin(light->error_patches, sqrt(square));
    result->error_patches = hypot(result->error_patches, patches);
    result->error_beams = hypot(result->error_beams, sqrt(square - patches * patches));
    for (uint32_t k = 0; k < h->walls.count; ++k) {
        if (h->sources.insulated[k]) continue; /* it gives off what it absorbs */
        result->wall_power[k] += state->wall[k];
        result->wall_absorbed[k] += state->wall[k];
        if (!isnan(h->sources.wall_temperature[k]))
            result->wall_error[k] = hypot(result->wall_error[k], state->wall_error[k]);
    }
    result->surroundings_power += light->reflected + light->transmitted - light->incident;
    result->surroundings_error = hypot(result->surroundings_error, light->error);
}

void light_report(struct heat *h) {
    const struct light_state *state = &h->lit;
    const fibrad_light_result *light = &state->result;
    struct report *report = &h->options.report;
    const double all = light->incident > 0 ? light->incident : 1;
    double sum = 0, first = 0;
    if (!state->options) return;
    for (uint32_t i = 0; i < h->bed->n; ++i) sum += state->absorbed[i], first += state->first[i];
    for (uint32_t k = 0; k < h->walls.count; ++k) sum += state->wall[k], first += state->wall_first[k];
    report_value(report, "irradiated_W", light->incident, 6);
    quantity_report(&state->options->absorptivity, "absorptivity", report);
    wall_values_report(&h->walls, state->of_walls, "_absorptivity", 6, report);
    report_value(report, "absorbed_first_W", first, 6);
    report_value(report, "absorbed_W", sum, 6);
    wall_values_report(&h->walls, state->wall, "_absorbed_W", 6, report);
    report_measured(report, "absorbed", sum / all, light->error / all);
    report_measured(report, "reflected", light->reflected / all, light->error / all);
    report_value(report, "transmitted", light->transmitted / all, 6);
    report_value(report, "balance_of_light", (sum + light->reflected + light->transmitted) / all - 1, 2);
}
