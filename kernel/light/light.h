/* light.h - light from outside: what the calls share. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_LIGHT_LIGHT_H
#define FIBRAD_LIGHT_LIGHT_H

#include "patches/problem.h"
#include "light/footprint.h"
#include "light/sunlit_lanes.h"

/* Checks a scene and a light, but not whether light comes in. Errors and fault: as fibrad_light_empty. */
int fibrad_light_check(const fibrad_scene *scene, const fibrad_light *light, fibrad_fault *fault);

/* Lays out work memory with room for a footprint and `extra` bytes of scratch. */
int fibrad_light_open(const fibrad_scene *scene, fibrad_work *work, size_t extra, fibrad_workspace **space);

/* The same after FIBRAD_E_WORK, larger. What it held is lost. */
int fibrad_light_grow(fibrad_work *work, size_t extra, fibrad_workspace **space);

fibrad_footprint *fibrad_light_footprint(const fibrad_workspace *space);
double *fibrad_light_scratch(const fibrad_workspace *space);

/* Adds areas by slot [L^2], times a flux. */
void fibrad_light_add_ends(const fibrad_scene *scene, const double area[FIBRAD_SLOTS], double flux,
                           fibrad_light_ends *ends);

/* What light of flux 1 along a frame brings to one of the patches of a four, if nothing is before it, times the number
 * of these patches. middle: out: the mean of u and v of its normals, times that. */
double fibrad_light_falls_on(const fibrad_heat *heat, const double frame[9], const fibrad_heat_four *four,
                             uint32_t patch, double middle[2]);

#endif
