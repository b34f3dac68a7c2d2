/* heat_run.h - powers of one bed in watts, and what they have in common. SPDX-License-Identifier: MIT */
#ifndef HEAT_RUN_H
#define HEAT_RUN_H

#include "frames/bed_options.h"
#include "heat/triangle_heat.h"

/* What is to be solved. */
struct heat_problem {
    struct walls walls;
    fibrad_heat_config config;   /* directions 0: by emissivities, or to begin with if an error is wanted */
    fibrad_heat_sources sources; /* [K]; surroundings NaN: nothing gets there */
    /* in time only: tables that walls [walls.count] and surroundings follow, n = 0: none; 0 of their unit [K] */
    const struct curve *wall_curve, *ambient_curve;
    double zero;
    double *emissivity; /* [spheres] as in sources; in and out where it follows the temperature, by */
    const struct quantity *of_emissivity;
    bool by_patches,
        by_factors; /* asked for; in time only: neither is factors, unless a wall's temperature is wanted */
    double error;   /* wanted of powers and of sigma T^4 that is found, over their root mean squares; 0: config as is */
};

/* Powers, and what is said of them. */
struct heat_report {
    fibrad_heat_result result;    /* [W] */
    struct side_arrays triangles; /* if wanted */
    fibrad_heat_config config;    /* as used in the end */
    fibrad_scene_facts facts;
    double metres;             /* in: of the bed's unit of length */
    double seconds;            /* computing, without reading and writing */
    double error_reached;      /* of the one wanted, as that is meant */
    double power_rms, largest; /* of the spheres: root mean square; of all: largest [W] */
    double emitted;            /* by the spheres [W] */
    double throughput;         /* root mean square of what a sphere emits, or absorbs where that is more [W] */
    double balance, error;     /* sum of all powers; root mean square error of a sphere's [W] */
    double wall_error; /* of the wall that is worst off, over the larger of its power and what it absorbs, or of its
                        * sigma T^4 if that was found */
    double balance_of_emission;                                   /* over the sum of what the spheres emit or absorb */
    uint32_t unknown;                                             /* spheres whose temperatures were found; */
    double coldest, hottest, temperature_mean, temperature_error; /* the latter root mean square [K] */
    double emission_error;                                        /* of their sigma T^4, both root mean square */
};

/* Emissivities of the spheres that follow temperatures [K], at these; NaN: left as they are. */
void heat_emissivities(const struct heat_problem *problem, const struct bed *bed, const double *temperature,
                       double *emissivity);

/* Solves it for a bed, more and more accurately if an error is wanted; report->result has arrays of the caller, all
 * of them. Status 0, STATUS_INPUT if no temperatures have the powers given, STATUS_MEMORY, or as bed_options_status. */
int heat_run(struct bed_options *asked, const struct heat_problem *problem, const struct bed *bed,
             struct heat_report *report);

#endif
