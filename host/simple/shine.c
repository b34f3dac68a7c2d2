/* shine.c - what a bed absorbs of light from outside. SPDX-License-Identifier: MIT */
#include <stdlib.h>

#include "simple/radiation.h"

#define LIGHT_TOLERANCE 1e-5

/* One light that falls on a bed. */
struct shine_tasks {
    fibrad_radiation *radiation;
    const fibrad_light *light;
    double *hits;
    fibrad_light_ends *kept; /* [tasks] */
};

static int shine_task(void *tasks, int thread, uint32_t task) {
    const struct shine_tasks *t = tasks;
    return fibrad_heat_shine(t->radiation->heat, &t->radiation->team.work[thread], t->light, task, t->hits,
                             &t->kept[task]);
}

/* Takes from `ends` what the spheres of a task keep. */
static void take_kept(const fibrad_light_ends *kept, uint32_t bodies, fibrad_light_ends *ends) {
    ends->spheres += kept->spheres;
    ends->through -= kept->through;
    for (uint32_t b = 0; b < bodies; ++b) ends->body[b] -= kept->body[b];
}

/* Adds the first hits of one light, and what it brings and what of it leaves at once to the result. */
static int shine_one(struct shine_tasks *t, uint32_t bodies, fibrad_light_result *result) {
    fibrad_radiation *r = t->radiation;
    fibrad_light_ends ends;
    const uint32_t tasks = fibrad_heat_shine_tasks(r->heat);
    int status = fibrad_light_empty(r->scene, &r->team.work[0], t->light, &ends, &r->fault);
    if (status) return status;
    result->incident += ends.through;
    for (uint32_t b = 0; b < bodies; ++b) result->incident += ends.body[b];
    status = fibrad_team_run(&r->team, "light", tasks, 1, shine_task, t, NULL);
    for (uint32_t k = 0; k < tasks && !status; ++k) take_kept(&t->kept[k], bodies, &ends);
    if (!status) status = fibrad_heat_shine_walls(r->heat, &r->team.work[0], t->light, &ends, t->hits);
    if (ends.through > 0) result->transmitted += ends.through;
    return status;
}

/* First hits of all lights on all patches. */
static int shine_all(fibrad_radiation *r, const fibrad_light_sources *s, uint32_t bodies, fibrad_light_result *result) {
    struct shine_tasks tasks = {r, NULL, r->light, calloc(fibrad_heat_shine_tasks(r->heat) + (size_t)1,
                                                          sizeof(fibrad_light_ends))};
    int status = tasks.kept ? FIBRAD_OK : FIBRAD_E_MEMORY;
    for (uint32_t k = 0; k < s->lights && !status; ++k) {
        tasks.light = &s->light[k];
        status = shine_one(&tasks, bodies, result);
    }
    free(tasks.kept);
    return status;
}

/* Solves for what is absorbed: temperatures are 0, and absorptivities stand for emissivities. */
static int absorb(fibrad_radiation *r, const fibrad_light_sources *s, uint32_t bodies, fibrad_light_result *result) {
    double *zero = calloc(r->n + bodies + (size_t)1, sizeof *zero);
    if (!zero) return FIBRAD_E_MEMORY;
    fibrad_heat_sources sources;
    fibrad_heat_sources_init(&sources);
    sources.temperature = zero, sources.body_temperature = zero + r->n, sources.surroundings = 0;
    sources.emissivity = s->absorptivity, sources.body_emissivity = s->body_absorptivity;
    sources.tolerance = s->tolerance > 0 ? s->tolerance : LIGHT_TOLERANCE, sources.uniform = s->uniform;
    sources.light = r->light;
    fibrad_heat_result solved = {.power = result->absorbed,
                                 .body_power = result->body_absorbed,
                                 .power_error = result->absorbed_error,
                                 .body_error = result->body_absorbed_error};
    const int status = fibrad_radiation_solve(r, &sources, &solved);
    result->reflected = solved.surroundings_power, result->error = solved.surroundings_error;
    result->sweeps = solved.sweeps;
    free(zero);
    return status;
}

static bool shine_valid(const fibrad_radiation *r, const fibrad_light_sources *s, uint32_t bodies,
                        const fibrad_light_result *result) {
    return (s->light || s->lights == 0) && (r->n == 0 || (s->absorptivity && result->absorbed && result->absorbed_first)) &&
           (bodies == 0 || (s->body_absorptivity && result->body_absorbed && result->body_absorbed_first));
}

int fibrad_radiation_shine(fibrad_radiation *r, const fibrad_light_sources *s, fibrad_light_result *result) {
    fibrad_scene_facts facts;
    if (!r || !s || !result) return FIBRAD_E_ARGUMENT;
    if (!r->heat) return FIBRAD_E_STATE;
    fibrad_scene_describe(r->scene, &facts);
    if (!shine_valid(r, s, facts.bodies, result)) return FIBRAD_E_ARGUMENT;
    free(r->light);
    r->light = calloc(fibrad_heat_patches(r->heat) + (size_t)1, sizeof *r->light);
    if (!r->light) return FIBRAD_E_MEMORY;
    result->incident = result->transmitted = 0, result->insulated = NULL;
    int status = shine_all(r, s, facts.bodies, result);
    if (!status) status = fibrad_heat_sum_light(r->heat, r->light, result->absorbed_first, result->body_absorbed_first);
    for (uint32_t i = 0; i < r->n && !status; ++i) result->absorbed_first[i] *= s->absorptivity[i];
    for (uint32_t b = 0; b < facts.bodies && !status; ++b) result->body_absorbed_first[b] *= s->body_absorptivity[b];
    if (!status) status = absorb(r, s, facts.bodies, result);
    if (status || !s->insulated) return status;
    result->insulated = r->light;
    return fibrad_heat_keep_light(r->heat, s->insulated, r->light);
}
