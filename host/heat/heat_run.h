/* heat_run.h - net powers of one bed in watts, and their summary. SPDX-License-Identifier: MIT */
#ifndef HEAT_RUN_H
#define HEAT_RUN_H

#include "contact_options/contact_option.h"
#include "heat/face.h"
#include "heat/light_option.h"
#include "heat/triangle_heat.h"

/* The heat problem of a bed. */
struct heat_problem {
    struct walls walls;
    fibrad_heat_config config;   /* directions 0: chosen by the emissivities of the bed */
    fibrad_heat_sources sources; /* [K]; surroundings NaN: the bed is closed */
    /* in time only: tables of the temperatures of walls [walls.count] and of the surroundings; n = 0: no table */
    const struct curve *wall_curve, *ambient_curve;
    double zero;                          /* [K] 0 of the unit of the tables */
    double *emissivity;                   /* [spheres] sources.emissivity; changes where a table over T is given */
    const struct quantity *of_emissivity; /* the option, which has the tables */
    struct face *face;                    /* results for the open face */
    struct light_state *light;            /* light from outside; its options NULL: there is none */
    /* [spheres] conductivities of the solid [W/(m K)], which change where a table over T is given, and the same in the
     * unit of sources.conductivity; NULL: spheres have one temperature each */
    double *solid, *conductivity;
    double per_watt;                 /* sources.conductivity over solid */
    const struct quantity *of_solid; /* the option, which has the tables */
    struct contact_state *contacts;  /* what conducts between spheres; options NULL: nothing does */
    bool by_patches, by_factors;     /* --model; in time only: neither means corrected factors */
    /* --error: error allowed in powers, and in sigma T^4 of temperatures that are found, over their root mean squares;
     * 0: not given */
    double error;
};

/* Powers, and the figures of the summary. */
struct heat_report {
    fibrad_heat_result result;    /* [W] */
    struct side_arrays triangles; /* if an output has triangles */
    fibrad_heat_config config;    /* the last one used */
    fibrad_scene_facts facts;
    double metres;        /* in: the bed's unit of length [m] */
    double seconds;       /* time of computing, without reading and writing [s] */
    double error_reached; /* the error in the sense of heat_problem.error */
    double power_rms;     /* root mean square power of a sphere [W] */
    double largest;       /* largest power of a sphere, a wall or the surroundings [W] */
    double emitted;       /* emitted by all spheres [W] */
    double throughput;    /* root mean square over spheres of the larger of emitted and absorbed power [W] */
    double balance;       /* sum of all powers [W] */
    double error;         /* root mean square error of a sphere's power [W] */
    /* largest error of a wall: that of its power over the larger of power and absorbed power, or, where the temperature
     * was found, that of sigma T^4, relative */
    double wall_error;
    double balance_of_emission; /* balance over the sum of the larger of emitted and absorbed power of each sphere */
    uint32_t unknown;           /* spheres whose temperatures were found; the figures below are of these spheres */
    double coldest, hottest, temperature_mean; /* [K] */
    double temperature_error;                  /* root mean square error [K] */
    double emission_error;                     /* root mean square error of sigma T^4 over its root mean square */
    /* of spheres that conduct */
    double surface_min, surface_max; /* [K] least and largest temperature of all surfaces */
    double surface_span;             /* [K] largest difference on the surface of a sphere */
    double surface_error;            /* [K] root mean square error of least and largest temperatures */
    double centre_max;               /* [K] */
};

/* Sets emissivities and conductivities of spheres that have tables to those at their temperatures. */
void heat_properties(const struct heat_problem *problem, const struct bed *bed, const double *temperature,
                     double *emissivity);

/* Finds how far spheres and contacts are beyond the ends of tables of emissivities and conductivities, as
 * quantity_excess, and warns of it. */
enum { TABLES = 4 };
void heat_excess_of(const struct heat_problem *problem, const struct bed *bed, const double *temperature,
                    const double *wall_temperature, struct table_excess excess[TABLES]);
void heat_warn_excess(struct warned *warned, const struct table_excess excess[TABLES]);

/* Solves the problem of a bed. With problem->error, solves again with more beams and patches until the estimated error
 * is small enough. The caller sets report->metres and all arrays of report->result. Status 0, STATUS_INPUT if no
 * temperatures above 0 K have the given powers, STATUS_MEMORY, or as bed_options_status. */
int heat_run(struct bed_options *options, const struct heat_problem *problem, const struct bed *bed,
             struct heat_report *report);

#endif
