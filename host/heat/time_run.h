/* time_run.h - a run of one bed in time, span by span. SPDX-License-Identifier: MIT */
#ifndef TIME_RUN_H
#define TIME_RUN_H

#include "heat/heat.h"
#include "plot/plot_heat.h"

/* State of a run in time. */
struct time_run {
    struct heat *heat;
    struct bed bed;              /* what outputs show: its frame is the number of the output */
    fibrad_heat_sources sources; /* at m->now */
    double square_metres;        /* square of the bed's unit of length [m2] */
    fibrad_span span;
    fibrad_law law;
    double begun;                                     /* [s] of the clock, when the run began */
    double now, next;                                 /* [s] since the beginning; the end of the span */
    double shown;                                     /* [s] time of the last powers in heat->result */
    double wall[WALLS_MAX];                           /* temperatures of walls now [K] */
    double wall_next[WALLS_MAX], wall_end[WALLS_MAX]; /* [K] at the end of the span: as given; as found */
    double surroundings_next;                         /* [K] at the end of the span */
    double wall_energy[WALLS_MAX];                    /* gained by walls during the last span [J] */
    double energy[WALLS_MAX];                         /* gained by walls since the beginning [J] */
    double surroundings_energy;                       /* gained by the surroundings since the beginning [J] */
    double gas_energy;                                /* gained by the gas of films since the beginning [J] */
    uint64_t steps, refused, sweeps, corrections;     /* sums over spans, as in fibrad_span */
    double error;                                     /* largest fibrad_span.error */
    struct time_point *point;                         /* [points] of the picture */
    size_t points;
    bool failed; /* memory for points ran out */
    struct table_excess excess[TABLES];
    double lag;                       /* largest r^2/(pi^2 alpha) of spheres that conduct [s]; 0: none conducts */
    double *specific;                 /* [spheres] heat capacities [J/(kg K)] */
    fibrad_store *store;              /* tables and latent heats of spheres; NULL: none */
    uint32_t *store_of;               /* [spheres] */
    double *melted, *stored, *gained; /* [spheres] of the span; [J]; [J] since the beginning */
    double wall_capacity[WALLS_MAX];  /* [J/K] */
    double wall_power[WALLS_MAX];     /* for the solution of time_write; NaN where heat is stored */
    double held_energy;               /* gained by held spheres since the beginning [J] */
};

/* Begins a run at 0 s with a bed of heat_begin: finds what spheres store, traces beams, and absorbs light. m is zeroed
 * except for m->heat, and must not move. Call time_end also after an error. Status 0, STATUS_USAGE, STATUS_INPUT with
 * the line of a sphere, or as bed_options_status. */
int time_begin(struct time_run *m);
void time_end(struct time_run *m);

/* Goes from m->now to a later time. time_try changes m->span and the arrays to which it points. If the caller sets the
 * temperatures and melted fractions back, it may call time_try again. time_keep then makes that time `now`, and adds up
 * what was gained. Status as time_begin. */
int time_try(struct time_run *m, double time);
void time_keep(struct time_run *m);

/* Computes the powers at m->now, and writes all outputs. */
int time_write(struct time_run *m);

/* Reports a run from 0 s to m->now: draws the picture, warns, and prints the summary. Status 0 or STATUS_FILE. */
int time_report(struct time_run *m);

#endif
