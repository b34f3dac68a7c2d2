/* transient.h - the fields of a bed whose temperatures change with time. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_TRANSIENT_H
#define FIBRAD_SIMPLE_TRANSIENT_H

#include <stdbool.h>

#include "simple/heap.h"
#include "simple/network.h"

struct fibrad_transient {
    fibrad_transient_config config;
    fibrad_run run;
    fibrad_team team;
    uint32_t n, walls;
    fibrad_fault fault;
    /* A copy of the bed: factors are computed later, when emissivities are known. */
    fibrad_scene_config scene;
    fibrad_wall *wall;       /* [walls] */
    fibrad_plane opening[6]; /* [scene.openings] */
    fibrad_triangle_copy mesh;
    double *at[4]; /* [n] x, y, z, r */
    bool named;    /* spheres have ids */
    uint64_t *id;  /* [n] if named */
    fibrad_scene_facts facts;
    double *doubles;                      /* the block of all arrays of doubles */
    double *area;                         /* [n] */
    double *emissivity, *wall_emissivity; /* [n], [walls] of the network or of the law */
    fibrad_network *network;              /* NULL: none yet */
    fibrad_radiation *radiation;          /* powers by patches; NULL: the method is FACTORS */
    /* The last correction: power by patches minus power by factors. */
    bool corrected;                       /* there is one */
    double *correction, *wall_correction; /* [n], [walls] */
    double surroundings_correction;
    double *compared, *wall_compared; /* [n], [walls] powers by factors at the last correction */
    double *by_patches;               /* [n] powers by patches at the last correction */
    double *wall_power;               /* [walls] powers by factors now */
    /* Steps (stepper.c). */
    double step;                   /* proposed for the next span [s]; 0: none */
    double *now;                   /* [n] temperatures at the beginning of the step */
    double *slope;                 /* [n] dT/dt at the end of the last step; at first 0 */
    double *base;                  /* [n] temperatures at which a stage starts */
    double *first;                 /* [n] change of temperature in the first stage */
    double *guess;                 /* [n] temperatures about which Newton's method is linear */
    double *given, *hold, *source; /* [n] the linear problem: temperatures (NaN: unknown), holds, powers */
    double *allowed;               /* [n] power that a sphere may miss in the solution of the linear problem */
    double *found, *power;         /* [n] temperatures and powers of the linear problem */
    double *solution;              /* [n] temperatures of the stage, which keep the energy */
    double *conducts;              /* [n] what contacts conduct from a sphere for each kelvin [W/K] */
    double *wall_stage;            /* [4 walls] temperatures, powers of each stage, energies of the span */
    bool busy;                     /* within a call, see fibrad_transient_begin */
};

/* Begins a call that ends with fibrad_transient_end. A function of the caller that runs within a call can begin no
 * other: FIBRAD_E_STATE. */
int fibrad_transient_begin(fibrad_transient *transient);

/* Returns the status. */
int fibrad_transient_end(fibrad_transient *transient, int status);

/* Computes factors for these sources unless the method needs none or they are there. Errors: as
 * fibrad_exchange_factors. */
int fibrad_transient_prepare(fibrad_transient *transient, const fibrad_heat_sources *sources);

/* Corrects factors by patches at the temperatures of the sources, all of which are known. Does nothing if powers have
 * changed little since the last correction, or if the method is not CORRECTED. Counts corrections in *corrections.
 * Errors: as fibrad_radiation_solve. */
int fibrad_transient_compare(fibrad_transient *transient, const fibrad_heat_sources *sources, uint64_t *corrections);

/* Finds powers and temperatures of sources whose spheres have a hold, by factors or by patches. Errors: as
 * fibrad_network_solve or fibrad_radiation_solve. */
int fibrad_transient_solve(fibrad_transient *transient, const fibrad_heat_sources *sources, fibrad_heat_result *result);

#endif
