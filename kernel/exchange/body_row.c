/* body_row.c - what a wall's emission is absorbed by, along paths. SPDX-License-Identifier: MIT
 *
 * Paths come in parts, each of even points moved at random on its own, so that the spread of the parts is that of their
 * mean. */
#include "exchange/paths.h"

#define FIRST_BODY_PATHS 8192u

/* Checks the arguments. */
static int body_begin(const fibrad_scene *scene, uint32_t body, const fibrad_exchange_rule *rule, uint32_t part,
                      double wall_emissivity[FIBRAD_SLOTS]) {
    if (scene == NULL || rule == NULL) return FIBRAD_E_ARGUMENT;
    if (!fibrad_scene_ready(scene)) return FIBRAD_E_STATE;
    if (body >= scene->facts.bodies || part >= FIBRAD_BODY_PARTS || rule->paths > FIBRAD_PATHS_MAX)
        return FIBRAD_E_ARGUMENT;
    for (uint32_t b = 0; b < scene->facts.bodies; b++) {
        const double emissivity = rule->body_emissivity != NULL ? rule->body_emissivity[b] : 1;
        if (!(emissivity >= 0 && emissivity <= 1)) return FIBRAD_E_ARGUMENT;
        wall_emissivity[scene->slot[b]] = emissivity;
    }
    const bool whole = fibrad_finite(scene->wall_area[scene->slot[body]]) && !scene->region && rule->cutoff == 0;
    return whole ? FIBRAD_OK : FIBRAD_E_UNSUPPORTED;
}

int fibrad_exchange_body(const fibrad_scene *scene, fibrad_work *work, uint32_t body, const fibrad_exchange_rule *rule,
                         uint32_t part, fibrad_body_row *row) {
    double wall_emissivity[FIBRAD_SLOTS] = {0};
    fibrad_workspace *space;
    int status = body_begin(scene, body, rule, part, wall_emissivity);
    if (status == FIBRAD_OK && (work == NULL || row == NULL)) status = FIBRAD_E_ARGUMENT;
    if (status == FIBRAD_OK)
        status = fibrad_work_open(work, scene, fibrad_tracer_least(), fibrad_tracer_best(scene), &space);
    if (status != FIBRAD_OK) return status;
    *row = (fibrad_body_row){0};
    if (wall_emissivity[scene->slot[body]] == 0) return FIBRAD_OK;

    fibrad_sobol sobol;
    fibrad_sobol_make(&sobol);
    const uint32_t wanted = rule->paths > 0 ? rule->paths : FIRST_BODY_PATHS;
    const uint32_t slot = scene->slot[body], count = (wanted + FIBRAD_BODY_PARTS - 1) / FIBRAD_BODY_PARTS;
    const uint64_t own = (uint64_t)slot * FIBRAD_BODY_PARTS + part; /* no sphere's number: from the highest down */
    fibrad_paths paths = {.tracer = fibrad_tracer_of(space, scene),
                          .place = FIBRAD_NONE,
                          .from = slot,
                          .sobol = &sobol,
                          .emissivity = rule->emissivity,
                          .wall_emissivity = wall_emissivity,
                          .stream = fibrad_random_start(rule->seed, UINT64_MAX - own),
                          .first = true,
                          .back = UINT32_MAX};
    FIBRAD_VERSION_OF(fibrad_paths_follow, scene->facts.isa)(&paths, 0, count);
    work->triangle = paths.back;
    if (paths.back != UINT32_MAX) return FIBRAD_E_BACK;
    double sum = paths.absorbed + paths.escaped + paths.beyond; /* the number of paths, but for Russian roulette */
    for (uint32_t k = 0; k < FIBRAD_SLOTS; k++) sum += paths.wall[k];
    if (!fibrad_finite(sum)) return FIBRAD_E_ARGUMENT; /* an emissivity on the way was NaN */
    row->rays = paths.rays;
    if (sum == 0) {
        row->escaped = 1;
        return FIBRAD_OK;
    }
    row->spheres = paths.absorbed / sum;
    row->escaped = (paths.escaped + paths.beyond) / sum;
    for (uint32_t b = 0; b < scene->facts.bodies; b++) row->body[b] = paths.wall[scene->slot[b]] / sum;
    return FIBRAD_OK;
}

int fibrad_exchange_body_mean(const fibrad_body_row part[FIBRAD_BODY_PARTS], fibrad_body_row *mean) {
    if (part == NULL || mean == NULL) return FIBRAD_E_ARGUMENT;
    fibrad_body_row sum = {0};
    for (uint32_t p = 0; p < FIBRAD_BODY_PARTS; p++) {
        for (uint32_t b = 0; b < FIBRAD_BODIES_MAX; b++) sum.body[b] += part[p].body[b] / FIBRAD_BODY_PARTS;
        sum.spheres += part[p].spheres / FIBRAD_BODY_PARTS;
        sum.escaped += part[p].escaped / FIBRAD_BODY_PARTS;
        sum.rays += part[p].rays;
    }
    double square = 0;
    for (uint32_t p = 0; p < FIBRAD_BODY_PARTS; p++) {
        const double escaped = part[p].escaped - sum.escaped, spheres = part[p].spheres - sum.spheres;
        square += escaped * escaped + spheres * spheres;
        for (uint32_t b = 0; b < FIBRAD_BODIES_MAX; b++) {
            const double difference = part[p].body[b] - sum.body[b];
            square += difference * difference;
        }
    }
    sum.error = fibrad_sqrt(square / (FIBRAD_BODY_PARTS * (FIBRAD_BODY_PARTS - 1)));
    *mean = sum;
    return FIBRAD_OK;
}
