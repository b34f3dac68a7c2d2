/* clump_heat.c - heat of clumps: their areas and volumes, and results by body. SPDX-License-Identifier: MIT */
#include <gsl/gsl_math.h>
#include <stdlib.h>

#include "heat/heat.h"

int clumps_begin(struct heat *h) {
    struct clump_state *state = &h->clumps;
    const uint32_t n = h->bed->n;
    if (!h->bed->clump) return STATUS_OK;
    state->body = calloc((size_t)n + 1, sizeof *state->body);
    state->area = calloc(2 * (size_t)n + 1, sizeof *state->area), state->volume = state->area + n;
    if (!state->body || !state->area) return message_memory();
    state->n = fibrad_bed_bodies(h->made, state->body);
    fibrad_bed_surfaces(h->made, state->area, state->volume);
    return STATUS_OK;
}

void clumps_free(struct clump_state *state) {
    free(state->body);
    free(state->area);
    free(state->metres);
    bed_free(&state->bodies);
}

double heat_area(const struct heat *h, uint32_t i) {
    const double metres = h->bed->metres;
    return h->clumps.area ? h->clumps.area[i] * gsl_pow_2(metres) : 4 * M_PI * gsl_pow_2(h->bed->r[i] * metres);
}

double heat_volume(const struct heat *h, uint32_t i) {
    const double metres = h->bed->metres;
    return h->clumps.area ? h->clumps.volume[i] * gsl_pow_3(metres) : 4. / 3 * M_PI * gsl_pow_3(h->bed->r[i] * metres);
}

/* Adds the result of sphere i to its body. If the temperature was found, the power of the body is given. */
static void add_member(struct heat *h, uint32_t i, bool found, double *area) {
    const fibrad_heat_result *from = &h->result;
    fibrad_heat_result *to = &h->clumps.result;
    const uint32_t b = h->clumps.body[i];
    area[b] += h->clumps.metres[i];
    to->temperature[b] = from->temperature[i], to->temperature_error[b] = from->temperature_error[i];
    to->power[b] += from->power[i];
    to->power_error[b] = found ? 0 : hypot(to->power_error[b], from->power_error[i]);
    if (from->conducted) to->conducted[b] += from->conducted[i];
    if (from->convected) to->convected[b] += from->convected[i];
}

int clumps_result(struct heat *h, const struct bed *bed, struct contents *what) {
    enum { ARRAYS = 8 };
    struct clump_state *state = &h->clumps;
    fibrad_heat_result *to = &state->result;
    double *area, *melted,
        **const of_bodies[ARRAYS] = {&area,          &to->conducted,   &to->temperature, &melted,
                                     &to->convected, &to->power_error, &to->power,       &to->temperature_error};
    if (!h->bed->clump) return STATUS_OK;
    free(state->metres);
    *to = h->result;
    state->metres = calloc(h->bed->n + ARRAYS * (size_t)state->n + 1, sizeof *state->metres);
    if (!state->metres) return message_memory();
    for (size_t k = 0; k < ARRAYS; ++k) *of_bodies[k] = state->metres + h->bed->n + k * state->n;
    for (uint32_t i = 0; i < h->bed->n; ++i) {
        state->metres[i] = state->area[i] * gsl_pow_2(bed->metres);
        add_member(h, i, isnan(what->sources->temperature[i]), area);
        if (what->melted) melted[state->body[i]] = what->melted[i]; /* all members are equally melted */
    }
    if (!h->result.conducted) to->conducted = NULL;
    if (!h->result.convected) to->convected = NULL;
    what->area = state->metres;
    if (h->members) return STATUS_OK;
    bed_free(&state->bodies);
    what->bodies = &state->bodies, what->of_bodies = to, what->area_of_bodies = area;
    what->melted_of_bodies = what->melted ? melted : NULL;
    const int status = bed_bodies(bed, state->n, state->body, area, &state->bodies);
    state->bodies.frame = bed->frame, state->bodies.timestep = bed->timestep;
    return status;
}
