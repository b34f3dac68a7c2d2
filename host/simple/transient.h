/* transient.h - the inside of a bed whose temperatures change with time. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_TRANSIENT_H
#define FIBRAD_SIMPLE_TRANSIENT_H

#include <stdbool.h>

#include "simple/heap.h"
#include "simple/network.h"

struct fibrad_transient {
    fibrad_transient_config config;
    fibrad_run run;
    fibrad_team team;
    uint32_t n, bodies;
    fibrad_fault fault;
    /* the bed: copies, since factors are made when emissivities are known */
    fibrad_scene_config scene;
    fibrad_body *body;       /* [bodies] */
    fibrad_plane opening[6]; /* [scene.openings] likewise */
    fibrad_triangle_copy mesh;
    double *at[4]; /* [n] x, y, z, r */
    uint64_t *id;  /* [n] if named */
    bool named;
    double *doubles; /* all arrays of doubles here and below */
    fibrad_scene_facts facts;
    double *area;                         /* [n] */
    double *emissivity, *body_emissivity; /* [n], [bodies] of the network */
    fibrad_network *network;              /* NULL: none yet */
    fibrad_radiation *radiation;          /* of patches; NULL: factors alone */
    /* what powers by patches have more than by factors, when they were compared */
    bool corrected;
    double *correction, *compared, *by_patches;           /* [n]; the powers then by factors; by patches */
    double *wall_correction, *wall_compared, *wall_power; /* [bodies] likewise */
    double surroundings_correction;
    /* of steps, march.c; [n] each */
    double step;                      /* proposed; 0: none */
    double *now;                      /* temperatures */
    double *slope;                    /* of temperatures at the end of the last step; 0 to begin with */
    double *base, *first, *guess;     /* what a stage starts from; temperatures of the first stage; those in hand */
    double *given, *hold, *source;    /* the linear problem of a stage: temperatures (NaN: unknown), holds, powers */
    double *allowed;                  /* of it: what may be missing of the powers */
    double *found, *power, *solution; /* its temperatures and powers; the temperatures that go with the powers */
    double *wall;                     /* [bodies] each: temperatures, powers of both stages */
};

/* Makes sure that there are beams or factors for these sources. Errors: as fibrad_exchange_factors. */
int fibrad_transient_prepare(fibrad_transient *transient, const fibrad_heat_sources *sources);

/* Compares factors with patches at the temperatures of the sources, all given, if powers have changed much since it was
 * done last; *corrections counts how often. Errors: as fibrad_radiation_solve. */
int fibrad_transient_compare(fibrad_transient *transient, const fibrad_heat_sources *sources, uint64_t *corrections);

/* Powers and temperatures of sources whose spheres have a hold, by factors or patches; t->allowed as in network.h. */
int fibrad_transient_solve(fibrad_transient *transient, const fibrad_heat_sources *sources, fibrad_heat_result *result);

#endif
