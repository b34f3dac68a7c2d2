/* transient.c - a bed whose temperatures change with time: its data, and powers by factors and patches.
 * SPDX-License-Identifier: MIT */
#include "simple/transient.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "simple/job.h"

#define FACTORS_TOLERANCE 0.01
#define ROUGH_TOLERANCE   0.03 /* of factors that patches correct */
#define POINTS            128  /* points of beams for corrections: these are few, so they may be accurate */
#define CHANGED           0.1  /* relative change of powers after which they are corrected again */
#define SMALL             1e-3 /* part of the emission below which powers need no correction */
#define PI                3.14159265358979323846

int fibrad_transient_begin(fibrad_transient *t) {
    if (!t) return FIBRAD_E_ARGUMENT;
    if (t->busy) return FIBRAD_E_STATE;
    t->busy = true;
    return FIBRAD_OK;
}

int fibrad_transient_end(fibrad_transient *t, int status) {
    t->busy = false;
    return status;
}

/* The progress of a span is counted in steps. Sweeps within a step are not shown. */
static int forward_progress(void *transient, const char *stage, uint64_t done, uint64_t total) {
    const fibrad_transient *t = transient;
    if (strcmp(stage, "sweeps") == 0 || !t->run.progress) return 0;
    return t->run.progress(t->run.context, stage, done, total);
}

static fibrad_run run_of(fibrad_transient *t) {
    return (fibrad_run){.threads = t->run.threads, .progress = forward_progress, .context = t};
}

/* Allocates all arrays, in one block. */
static int take_arrays(fibrad_transient *t) {
    double **const of_spheres[] = {&t->area,     &t->emissivity, &t->now,     &t->slope,    &t->base,
                                   &t->first,    &t->guess,      &t->storage, &t->source,   &t->found,
                                   &t->power,    &t->given,      &t->allowed, &t->solution, &t->correction,
                                   &t->compared, &t->by_patches, &t->conducts};
    double **const of_walls[] = {&t->wall_emissivity, &t->wall_correction, &t->wall_compared, &t->wall_power,
                                 &t->wall_stage}; /* the last one has four per wall */
    const size_t spheres = sizeof of_spheres / sizeof *of_spheres, walls = sizeof of_walls / sizeof *of_walls;
    double *next = calloc(spheres * t->n + (walls + 3) * t->walls + 1, sizeof *next);
    t->doubles = next;
    if (!next) return FIBRAD_E_MEMORY;
    for (size_t k = 0; k < spheres; ++k, next += t->n) *of_spheres[k] = next;
    for (size_t k = 0; k < walls; ++k, next += t->walls) *of_walls[k] = next;
    return FIBRAD_OK;
}

/* Takes the areas of a bed, and forgets the factors of the last one. */
static void forget_factors(fibrad_transient *t, const fibrad_spheres *s) {
    const size_t stride = s->stride_r ? s->stride_r : 1;
    for (size_t i = 0; i < s->n; ++i) t->area[i] = 4 * PI * s->r[i * stride] * s->r[i * stride];
    fibrad_network_free(t->network);
    t->network = NULL;
    t->corrected = false;
}

/* Whether the method exists, and factors are those of spheres of one temperature, from their own paths. */
static bool time_config_valid(const fibrad_transient_config *config) {
    const fibrad_exchange_rule *rule = &config->exchange;
    return config->method >= FIBRAD_TRANSIENT_CORRECTED && config->method <= FIBRAD_TRANSIENT_FACTORS &&
           !rule->conductivity && !rule->node_emissivity && !rule->known;
}

int fibrad_transient_new(fibrad_transient **transient, const fibrad_scene_config *scene, const fibrad_spheres *spheres,
                         const fibrad_transient_config *config, fibrad_run *run) {
    if (!transient) return FIBRAD_E_ARGUMENT;
    *transient = NULL;
    if (!spheres || (scene && scene->walls > 0 && !scene->wall)) return FIBRAD_E_ARGUMENT;
    fibrad_transient *t = calloc(1, sizeof *t);
    if (!t) return FIBRAD_E_MEMORY;
    if (config) t->config = *config;
    if (t->config.method == FIBRAD_TRANSIENT_CORRECTED && t->config.heat.points == 0) t->config.heat.points = POINTS;
    if (t->config.exchange.tolerance == 0 && t->config.exchange.directions == 0 && t->config.exchange.paths == 0)
        t->config.exchange.tolerance =
            t->config.method == FIBRAD_TRANSIENT_FACTORS ? FACTORS_TOLERANCE : ROUGH_TOLERANCE;
    if (run) t->run = *run;
    fibrad_run own = run_of(t);
    int status = time_config_valid(&t->config) ? FIBRAD_OK : FIBRAD_E_ARGUMENT;
    if (!status)
        status = fibrad_radiation_make(&t->radiation, scene, spheres, &t->config.heat,
                                       t->config.method != FIBRAD_TRANSIENT_FACTORS, &own);
    t->n = spheres->n, t->walls = scene ? scene->walls : 0;
    if (!status) status = take_arrays(t);
    if (!status) forget_factors(t, spheres);
    t->placed = true;
    if (run) run->fault = own.fault;
    if (status)
        fibrad_transient_free(t);
    else
        *transient = t;
    return status;
}

/* A bed that is refused leaves the last one. */
static int move_both(fibrad_transient *t, const fibrad_scene_config *config, const fibrad_spheres *spheres) {
    const fibrad_scene *before = t->radiation->scene;
    const int status = fibrad_radiation_move(t->radiation, config, spheres);
    t->fault = t->radiation->fault;
    if (t->radiation->scene == before) return status;
    forget_factors(t, spheres);
    t->placed = !status;
    return status;
}

int fibrad_transient_move(fibrad_transient *t, const fibrad_scene_config *scene, const fibrad_spheres *spheres) {
    if (!t || !spheres || spheres->n != t->n || (scene ? scene->walls : 0) != t->walls) return FIBRAD_E_ARGUMENT;
    if (t->walls > 0 && !scene->wall) return FIBRAD_E_ARGUMENT;
    const int status = fibrad_transient_begin(t);
    return status ? status : fibrad_transient_end(t, move_both(t, scene, spheres));
}

/* Whether there are factors for the emissivities of the sources. */
static bool same_surfaces(const fibrad_transient *t, const fibrad_heat_sources *s) {
    bool same = t->network != NULL;
    for (uint32_t i = 0; i < t->n && same; ++i) same = t->emissivity[i] == s->emissivity[i];
    for (uint32_t b = 0; b < t->walls && same; ++b) same = t->wall_emissivity[b] == s->wall_emissivity[b];
    return same;
}

/* Computes factors for the emissivities of the sources. */
static int make_network(fibrad_transient *t, const fibrad_heat_sources *s) {
    fibrad_run run = run_of(t);
    fibrad_bed_factors *factors;
    fibrad_exchange_rule rule = t->config.exchange;
    rule.emissivity = s->emissivity;
    rule.wall_emissivity = s->wall_emissivity;
    fibrad_network_free(t->network);
    t->network = NULL;
    t->corrected = false;
    int status = fibrad_job_exchange_of(t->radiation->scene, &rule, &run, &factors);
    t->fault = run.fault;
    if (status) return status;
    status = fibrad_network_new(&t->network, factors, s->emissivity, t->area);
    if (status) fibrad_bed_free(factors);
    for (uint32_t i = 0; i < t->n; ++i) t->emissivity[i] = s->emissivity[i];
    for (uint32_t b = 0; b < t->walls; ++b) t->wall_emissivity[b] = s->wall_emissivity[b];
    return status;
}

int fibrad_transient_prepare(fibrad_transient *t, const fibrad_heat_sources *sources) {
    if (!t->placed) return FIBRAD_E_STATE;
    if (t->config.method == FIBRAD_TRANSIENT_PATCHES || same_surfaces(t, sources)) return FIBRAD_OK;
    return make_network(t, sources);
}

static double sum_of_squares(const double *values, uint32_t n) {
    double sum = 0;
    for (uint32_t i = 0; i < n; ++i) sum += values[i] * values[i];
    return sum;
}

/* Whether powers by factors (t->power, t->wall_power) have changed much since the last correction. */
static bool powers_changed(const fibrad_transient *t, const fibrad_heat_sources *s) {
    double change = 0, emitted = 0;
    for (uint32_t i = 0; i < t->n; ++i) {
        const double square = s->temperature[i] * s->temperature[i], less = t->power[i] - t->compared[i];
        const double emission = t->area[i] * s->emissivity[i] * s->sigma * square * square;
        change += less * less, emitted += emission * emission;
    }
    for (uint32_t b = 0; b < t->walls; ++b) {
        const double less = t->wall_power[b] - t->wall_compared[b];
        change += less * less;
    }
    const double most =
        sum_of_squares(t->power, t->n) + sum_of_squares(t->wall_power, t->walls) + SMALL * SMALL * emitted;
    return change > CHANGED * CHANGED * most;
}

int fibrad_transient_compare(fibrad_transient *t, const fibrad_heat_sources *s, uint64_t *corrections) {
    if (t->config.method != FIBRAD_TRANSIENT_CORRECTED) return FIBRAD_OK;
    fibrad_heat_result factors = {.power = t->power, .wall_power = t->wall_power};
    fibrad_heat_result patches = {.power = t->by_patches, .wall_power = t->wall_correction};
    int status = fibrad_network_solve(t->network, &t->radiation->team, s, t->allowed, &factors);
    if (status || (t->corrected && !powers_changed(t, s))) return status;
    fibrad_heat_sources given = *s; /* a sphere has a temperature or a power, not both */
    given.power = NULL;
    status = fibrad_radiation_solve(t->radiation, &given, &patches);
    if (status) return status;
    for (uint32_t i = 0; i < t->n; ++i) {
        t->correction[i] = t->by_patches[i] - t->power[i];
        t->compared[i] = t->power[i];
    }
    for (uint32_t b = 0; b < t->walls; ++b) {
        t->wall_correction[b] -= t->wall_power[b];
        t->wall_compared[b] = t->wall_power[b];
    }
    t->surroundings_correction = patches.surroundings_power - factors.surroundings_power;
    t->corrected = true;
    ++*corrections;
    return FIBRAD_OK;
}

int fibrad_transient_solve(fibrad_transient *t, const fibrad_heat_sources *sources, fibrad_heat_result *result) {
    if (t->config.method == FIBRAD_TRANSIENT_PATCHES) return fibrad_radiation_solve(t->radiation, sources, result);
    for (uint32_t i = 0; i < t->n && t->corrected; ++i) t->source[i] += t->correction[i];
    const int status = fibrad_network_solve(t->network, &t->radiation->team, sources, t->allowed, result);
    for (uint32_t i = 0; i < t->n && t->corrected; ++i) result->power[i] += t->correction[i];
    for (uint32_t b = 0; b < t->walls && t->corrected; ++b) result->wall_power[b] += t->wall_correction[b];
    if (t->corrected) result->surroundings_power += t->surroundings_correction;
    return status;
}

void fibrad_transient_describe(const fibrad_transient *t, fibrad_scene_facts *facts, fibrad_fault *fault) {
    if (!t) return;
    fibrad_radiation_describe(t->radiation, facts, NULL);
    if (fault) *fault = t->fault;
}

void fibrad_transient_free(fibrad_transient *t) {
    if (!t) return;
    free(t->doubles);
    fibrad_network_free(t->network);
    fibrad_radiation_free(t->radiation);
    free(t);
}
