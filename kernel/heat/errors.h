/* errors.h - estimated errors of powers and temperatures. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_HEAT_ERRORS_H
#define FIBRAD_HEAT_ERRORS_H

#include "heat/solution.h"

/* Errors over differences between even and odd samples, of beams and of rays: constants of the model in errors.c. */
#define FIBRAD_HEAT_BEAM_ERROR .7
#define FIBRAD_HEAT_RAY_ERROR  1.75

/* Differences of the rays of fine patches and of meshes are added to those of beams of spheres, whose error is a
 * smaller part of the difference. So they are enlarged by this factor. */
#define FIBRAD_HEAT_RAYS_WEIGHT (FIBRAD_HEAT_RAY_ERROR / FIBRAD_HEAT_BEAM_ERROR)

/* The area of patches, and mean and variance of their radiosities. */
typedef struct fibrad_heat_spread {
    double area, mean, variance;
} fibrad_heat_spread;

/* Number of samples, sum of their squared errors, sum of squares of what they exchange. */
typedef struct fibrad_heat_pool {
    double samples, errors, exchanges;
} fibrad_heat_pool;

/* What estimates of single surfaces need of all of them. Where there are two numbers, the first is that of spheres, the
 * second that of walls. */
typedef struct fibrad_heat_errors {
    /* squares of the differences between even and odd rays, summed over all walls that send rays: of the power of each
     * body that is not a sphere, and of that of the surroundings */
    double rays[FIBRAD_HEAT_OTHERS], outside;
    bool meets[FIBRAD_HEAT_OTHERS]; /* of these bodies, whether own rays that meet spheres count */
    double outside_area;            /* L^2, for which the rays between walls and surroundings stand */
    fibrad_heat_spread all;
    double few;    /* error over power of a sphere among spheres that reflect all, from few beams per patch */
    double dim[2]; /* mean reflectivity by area */
    double walls;  /* error of what walls send out */
    fibrad_heat_pool pool[2];
    /* of surfaces whose temperature is found: */
    double given;      /* mean emission of all other surfaces, weighted by power */
    double common;     /* relative error of differences from it, which all have in common */
    double sampled[2]; /* squares from beams and rays, over squared differences of radiosities */
    double changed;    /* mean square from extrapolation of spheres, which also serves insulated walls */
} fibrad_heat_errors;

/* Finds what all estimates need, and contacts.error of the solution. */
void fibrad_heat_find_errors(const fibrad_heat *heat, fibrad_heat_errors *errors);

/* The square of the estimated error of what a surface gains by radiation. */
double fibrad_heat_radiated_error(const fibrad_heat *heat, const fibrad_heat_errors *errors, uint32_t body);

/* The estimated error of the power of a surface, contacts included, and of the surroundings. */
double fibrad_heat_power_error(const fibrad_heat *heat, const fibrad_heat_errors *errors, uint32_t body);
double fibrad_heat_surroundings_error(const fibrad_heat *heat, const fibrad_heat_errors *errors);

/* Root mean squares of the parts of these errors over all spheres: from patches, and from all else. */
void fibrad_heat_mean_errors(const fibrad_heat *heat, const fibrad_heat_errors *errors, double *of_patches,
                             double *of_beams);

/* The estimated error of a temperature [K]. 0: it was given. */
double fibrad_heat_temperature_error(const fibrad_heat *heat, const fibrad_heat_errors *errors, uint32_t body,
                                     double temperature);

/* The estimated error of what a contact conducts. */
double fibrad_heat_flow_error(const fibrad_heat *heat, uint32_t contact);

/* The estimated error of the emission of the hottest or coldest place of a sphere. value, patch: emissions, minus the
 * mean of the surface, of this place and of the patch that is hottest or coldest. open: the place does not face a
 * neighbour, so patches tell its light. */
double fibrad_heat_place_error(const fibrad_heat *heat, uint32_t sphere, double value, double patch, bool open);

/* The same of a spot of contact, over its difference from the mean: two spheres that touch, tests/test_spots.c. */
#define FIBRAD_HEAT_SPOT_ERROR .05

#endif
