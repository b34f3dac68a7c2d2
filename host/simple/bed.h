/* bed.h - the fields of a bed, and what the files of the simple layer share. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_BED_H
#define FIBRAD_SIMPLE_BED_H

#include "simple/bodies.h"
#include "simple/network.h"
#include "simple/store.h"

/* What steps in time need (stepper.c, corrected.c). */
typedef struct fibrad_stepping {
    double *area;                         /* [n] first of the block of all arrays */
    double *emissivity, *wall_emissivity; /* [n], [walls] of the network or of the law */
    fibrad_network *network;              /* NULL: none yet */
    uint64_t steps;                       /* taken since the bed was made or moved */
    bool by_factors;                      /* exchange factors that patches correct; else patches alone */
    /* The last correction: power by patches minus power by factors. */
    bool corrected;                       /* there is one */
    double *correction, *wall_correction; /* [n], [walls] */
    double surroundings_correction;
    double *compared, *wall_compared; /* [n], [walls] powers by factors at the last correction */
    double *by_patches;               /* [n] powers by patches at the last correction */
    double *wall_power;               /* [walls] powers by factors now */
    double step;                      /* proposed for the next span [s]; 0: none */
    /* Heats are those stored for a capacity of 1, without a store the temperatures. */
    double *now;                      /* [n] heats at the beginning of the step */
    double *slope;                    /* [n] dheat/dt at the end of the last step; at first 0 */
    double *base;                     /* [n] heats at which a stage starts */
    double *first;                    /* [n] change of heat in the first stage */
    double *heat, *guess;             /* [n] heats and temperatures about which Newton's method is linear */
    double *given, *storage, *source; /* [n] the linear problem: temperatures (NaN: unknown), storage, powers */
    double *allowed;                  /* [n] power that a sphere may miss in the solution of the linear problem */
    double *found, *power;            /* [n] temperatures and powers of the linear problem */
    double *solution;                 /* [n] heats of the stage, which keep the energy */
    double *warmth;                   /* [n] temperatures of `now` */
    double *conducts;                 /* [n] what contacts and films conduct from a sphere for each kelvin [W/K] */
    double *gas, *wall_gas;           /* [n], [walls] temperatures of the gas at films in a stage [K] */
    /* [walls] of walls with a capacity: temperatures at the beginning of the step, where a stage starts, and found */
    double *wall_now, *wall_base, *wall_found;
    double *wall_given;             /* [walls] given powers [W] */
    double *wall_film, *wall_mixed; /* [walls] films that stand for capacities, and other films [W/K]; their gas [K] */
    double *wall_convected;         /* [walls] through these films [W] */
    double *wall_seen;              /* [walls] temperatures that a law sees */
    double *wall_stage;             /* [4 walls] temperatures, powers of each stage, energies of the span */
} fibrad_stepping;

struct fibrad_bed {
    fibrad_team team;
    fibrad_fault fault;
    bool busy; /* within a call, see fibrad_bed_begin */
    /* ---- the scene ---- */
    fibrad_scene *scene;
    void *scene_block;
    fibrad_scene_facts facts;
    fibrad_scene_config config; /* what was given, copied into `given`, for searches of the host */
    fibrad_spheres spheres;
    void *given;
    const char *scratch;   /* a folder for rows and matrix of the present call; NULL: in memory */
    double begun;          /* time at which the present call for factors began [s] */
    fibrad_bodies *bodies; /* NULL: there are no clumps */
    /* ---- heat ---- */
    fibrad_heat_config beams; /* how finely heat is resolved */
    fibrad_heat *heat;        /* NULL: none yet */
    void *heat_block;
    size_t heat_size; /* bytes of heat_block */
    bool traced;      /* its beams are those of the scene */
    double *light;    /* [patches] of the last fibrad_bed_shine; NULL: none */
    double *places;   /* memory of fibrad_heat_sources.contact_places in the last solution; NULL: none */
    fibrad_stepping stepping;
    fibrad_warning warning[FIBRAD_WARNINGS_MAX]; /* by code - 1; code 0: none */
    /* ---- contacts ---- */
    fibrad_contact_list *contacts; /* NULL: none yet */
};

/* Begins a call that ends with fibrad_bed_end. A function of the caller that runs within a call can begin no other:
 * FIBRAD_E_STATE. */
int fibrad_bed_begin(fibrad_bed *bed);

/* Returns the status. */
int fibrad_bed_end(fibrad_bed *bed, int status);

/* Has beams traced if there are none of the scene. Errors: as fibrad_heat_init and fibrad_heat_trace; _CANCELLED. */
int fibrad_bed_trace(fibrad_bed *bed);

/* fibrad_bed_solve without a law, within a call. */
int fibrad_bed_solve_now(fibrad_bed *bed, const fibrad_heat_sources *sources, fibrad_heat_result *result);

/* Finds a solution, which fibrad_heat_read then reads. */
int fibrad_bed_find(fibrad_bed *bed, const fibrad_heat_sources *sources);

/* Exchange factors of all spheres, within a call. Errors: as fibrad_bed_factors. */
int fibrad_bed_exchange(fibrad_bed *bed, const fibrad_exchange_rule *rule, fibrad_bed_matrix **matrix);

/* Forgets what steps in time knew of the last positions. */
void fibrad_stepping_move(fibrad_bed *bed);
void fibrad_stepping_free(fibrad_stepping *stepping);

/* Allocates the arrays of steps in time, unless they are there. Errors: _MEMORY. */
int fibrad_stepping_make(fibrad_bed *bed);

/* Computes factors for these sources unless patches serve alone or factors are there. Errors: as fibrad_bed_factors. */
int fibrad_stepping_prepare(fibrad_bed *bed, const fibrad_heat_sources *sources);

/* Corrects factors by patches at the temperatures of the sources, all of which are known. Does nothing if powers have
 * changed little since the last correction, or if there are no factors. Counts corrections in *corrections.
 * Errors: as fibrad_bed_solve. */
int fibrad_stepping_compare(fibrad_bed *bed, const fibrad_heat_sources *sources, uint64_t *corrections);

/* Finds powers and temperatures of sources whose spheres have storage, by factors or by patches. Errors: as
 * fibrad_network_solve or fibrad_bed_solve. */
int fibrad_stepping_solve(fibrad_bed *bed, const fibrad_heat_sources *sources, fibrad_heat_result *result);

/* Finds warnings: of sources, of which spheres have `temperature` (NULL: none is given); of surfaces that conduct; of
 * heat capacities; of factors. Those of positions and walls are found by fibrad_bed_warnings. */
void fibrad_bed_warn_of_sources(fibrad_bed *bed, const fibrad_heat_sources *sources, const double *temperature);
void fibrad_bed_warn_of_surfaces(fibrad_bed *bed, const fibrad_heat_result *result);
void fibrad_bed_warn_of_stores(fibrad_bed *bed, const double *capacity);
void fibrad_bed_warn_of_rows(fibrad_bed *bed, const fibrad_factors *matrix);

/* What all triangles of a bed see: fibrad_triangle_views of each. rays: from each side. view[2 triangles]: element 2 t
 * is the front and 2 t + 1 the back of the caller's triangle t. Errors: as fibrad_triangle_views; _CANCELLED. */
int fibrad_bed_views(fibrad_bed *bed, uint32_t rays, fibrad_side_view *view);

#endif
