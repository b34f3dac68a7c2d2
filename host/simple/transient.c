/* transient.c - a bed whose temperatures change with time: its data, and powers by factors and patches.
 * SPDX-License-Identifier: MIT */
#include "simple/transient.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "simple/heap.h"

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

/* Allocates all arrays. Those of doubles lie in one block. */
static int take_arrays(fibrad_transient *t) {
    double **const of_spheres[] = {
        &t->at[0],   &t->at[1],    &t->at[2],      &t->at[3],    &t->area,       &t->emissivity, &t->now,   &t->slope,
        &t->base,    &t->first,    &t->guess,      &t->hold,     &t->source,     &t->found,      &t->power, &t->given,
        &t->allowed, &t->solution, &t->correction, &t->compared, &t->by_patches, &t->conducts};
    double **const of_walls[] = {&t->wall_emissivity, &t->wall_correction, &t->wall_compared, &t->wall_power,
                                 &t->wall_stage}; /* the last one has four per wall */
    const size_t spheres = sizeof of_spheres / sizeof *of_spheres, walls = sizeof of_walls / sizeof *of_walls;
    double *next = calloc(spheres * t->n + (walls + 3) * t->walls + 1, sizeof *next);
    t->doubles = next;
    t->wall = calloc((size_t)t->walls + 1, sizeof *t->wall);
    t->id = calloc((size_t)t->n + 1, sizeof *t->id);
    if (!next || !t->wall || !t->id) return FIBRAD_E_MEMORY;
    for (size_t k = 0; k < spheres; ++k, next += t->n) *of_spheres[k] = next;
    for (size_t k = 0; k < walls; ++k, next += t->walls) *of_walls[k] = next;
    return FIBRAD_OK;
}

static void copy_bed(fibrad_transient *t, const fibrad_scene_config *scene, const fibrad_spheres *s) {
    const size_t stride = s->stride ? s->stride : 1, stride_r = s->stride_r ? s->stride_r : 1;
    for (size_t i = 0; i < s->n; ++i) {
        t->at[0][i] = s->x[i * stride], t->at[1][i] = s->y[i * stride], t->at[2][i] = s->z[i * stride];
        t->at[3][i] = s->r[i * stride_r];
        t->area[i] = 4 * PI * t->at[3][i] * t->at[3][i];
        if (s->id) t->id[i] = s->id[i];
    }
    t->named = s->id != NULL;
    if (scene) t->scene = *scene;
    for (uint32_t b = 0; b < t->walls; ++b) t->wall[b] = scene->wall[b];
    for (uint32_t k = 0; k < t->scene.openings; ++k) t->opening[k] = scene->opening[k];
    t->scene.wall = t->wall, t->scene.opening = t->opening;
    t->scene.triangles = &t->mesh.triangles;
}

/* Checks that a scene can be made of a bed, and keeps the facts of that scene. */
static int check_placed(fibrad_transient *t, const fibrad_scene_config *config, const fibrad_spheres *spheres) {
    fibrad_scene *scene;
    void *block;
    t->fault = (fibrad_fault){spheres->n, spheres->n, UINT32_MAX, 0, 0};
    const int status = fibrad_heap_scene(&scene, &block, config, spheres, &t->fault);
    if (!status) fibrad_scene_describe(scene, &t->facts);
    free(block);
    return status;
}

/* Takes a bed: traces its beams unless the method is FACTORS, and copies it. After an error the last bed stays. */
static int place(fibrad_transient *t, const fibrad_scene_config *scene, const fibrad_spheres *spheres) {
    fibrad_triangle_copy mesh = {.block = NULL};
    int status = check_placed(t, scene, spheres);
    if (!status) status = fibrad_heap_triangles(&mesh, scene ? scene->triangles : NULL);
    if (!status && t->config.method != FIBRAD_TRANSIENT_FACTORS) {
        fibrad_run run = run_of(t);
        if (t->radiation) {
            status = fibrad_radiation_move(t->radiation, scene, spheres);
            fibrad_radiation_describe(t->radiation, NULL, &t->fault);
        } else {
            status = fibrad_radiation_new(&t->radiation, scene, spheres, &t->config.heat, &run);
            t->fault = run.fault;
        }
    }
    if (status) {
        free(mesh.block);
        return status;
    }
    free(t->mesh.block);
    t->mesh = mesh;
    fibrad_network_free(t->network);
    t->network = NULL;
    t->corrected = false;
    copy_bed(t, scene, spheres);
    return FIBRAD_OK;
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
    t->n = spheres->n;
    t->walls = scene ? scene->walls : 0;
    const fibrad_run own = run_of(t);
    int status = time_config_valid(&t->config) ? fibrad_team_open(&t->team, &own) : FIBRAD_E_ARGUMENT;
    if (!status) status = take_arrays(t);
    if (!status) status = place(t, scene, spheres);
    if (run) run->fault = t->fault;
    if (status)
        fibrad_transient_free(t);
    else
        *transient = t;
    return status;
}

int fibrad_transient_move(fibrad_transient *t, const fibrad_scene_config *scene, const fibrad_spheres *spheres) {
    if (!t || !spheres || spheres->n != t->n || (scene ? scene->walls : 0) != t->walls) return FIBRAD_E_ARGUMENT;
    if (t->walls > 0 && !scene->wall) return FIBRAD_E_ARGUMENT;
    const int status = fibrad_transient_begin(t);
    return status ? status : fibrad_transient_end(t, place(t, scene, spheres));
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
    const fibrad_spheres spheres = {t->at[0], t->at[1], t->at[2], t->at[3], .n = t->n, .id = t->named ? t->id : NULL};
    fibrad_run run = run_of(t);
    fibrad_bed_factors *factors;
    fibrad_exchange_rule rule = t->config.exchange;
    rule.emissivity = s->emissivity;
    rule.wall_emissivity = s->wall_emissivity;
    fibrad_network_free(t->network);
    t->network = NULL;
    t->corrected = false;
    int status = fibrad_exchange_factors(&t->scene, &spheres, &rule, NULL, &run, &factors);
    t->fault = run.fault;
    if (status) return status;
    status = fibrad_network_new(&t->network, factors, s->emissivity, t->area);
    if (status) fibrad_bed_free(factors);
    for (uint32_t i = 0; i < t->n; ++i) t->emissivity[i] = s->emissivity[i];
    for (uint32_t b = 0; b < t->walls; ++b) t->wall_emissivity[b] = s->wall_emissivity[b];
    return status;
}

int fibrad_transient_prepare(fibrad_transient *t, const fibrad_heat_sources *sources) {
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
    int status = fibrad_network_solve(t->network, &t->team, s, t->allowed, &factors);
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
    const int status = fibrad_network_solve(t->network, &t->team, sources, t->allowed, result);
    for (uint32_t i = 0; i < t->n && t->corrected; ++i) result->power[i] += t->correction[i];
    for (uint32_t b = 0; b < t->walls && t->corrected; ++b) result->wall_power[b] += t->wall_correction[b];
    if (t->corrected) result->surroundings_power += t->surroundings_correction;
    return status;
}

void fibrad_transient_describe(const fibrad_transient *t, fibrad_scene_facts *facts, fibrad_fault *fault) {
    if (!t) return;
    if (facts) *facts = t->facts;
    if (fault) *fault = t->fault;
}

void fibrad_transient_free(fibrad_transient *t) {
    if (!t) return;
    free(t->doubles);
    free(t->wall);
    free(t->mesh.block);
    free(t->id);
    fibrad_network_free(t->network);
    fibrad_radiation_free(t->radiation);
    fibrad_team_close(&t->team);
    free(t);
}
