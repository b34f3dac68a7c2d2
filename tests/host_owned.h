/* host_owned.h - OWNED variables (owned.h) of the simple layer, and calls of it that tests make often.
 * SPDX-License-Identifier: MIT */
#ifndef TESTS_HOST_OWNED_H
#define TESTS_HOST_OWNED_H

#include "owned.h"
#include "simple/fibrad_host.h"

static inline void factors_free(fibrad_bed_matrix **factors) { fibrad_bed_matrix_free(*factors); }
static inline void made_free(fibrad_bed **made) { fibrad_bed_free(*made); }

#define OWNED_FACTORS OWNED_BY(factors_free) fibrad_bed_matrix
#define OWNED_MADE    OWNED_BY(made_free) fibrad_bed

/* A bed whose beams are traced. After an error *made is NULL. */
static inline int made_with(fibrad_bed **made, const fibrad_scene_config *config, const fibrad_spheres *spheres,
                            const fibrad_heat_config *beams, fibrad_run *run) {
    int status = fibrad_bed_new(made, config, spheres, run);
    if (status) return status;
    status = fibrad_bed_beams(*made, beams);
    if (!status) return status;
    if (run) fibrad_bed_describe(*made, NULL, &run->fault);
    fibrad_bed_free(*made);
    *made = NULL;
    return status;
}

static inline int made_settle(fibrad_bed *made, const fibrad_heat_sources *sources, fibrad_emissivity_law *follow,
                              void *context, double *emissivity, double *wall_emissivity, fibrad_heat_result *result) {
    fibrad_law law = {follow, context, emissivity, wall_emissivity};
    return fibrad_bed_solve(made, sources, &law, result);
}

static inline int exchange_of(const fibrad_scene_config *config, const fibrad_spheres *spheres,
                              const fibrad_exchange_rule *rule, const fibrad_bed_rule *how, fibrad_run *run,
                              fibrad_bed_matrix **factors) {
    fibrad_bed_rule filled = how ? *how : (fibrad_bed_rule){0};
    filled.exchange = rule;
    return fibrad_view_factors(config, spheres, &filled, run, factors);
}

#endif
