/* surroundings.h - where rays end that meet no sphere of a scene: at a wall, in the open, or beyond what is known.
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SCENE_SURROUNDINGS_H
#define FIBRAD_SCENE_SURROUNDINGS_H

#include "scene/scene.h"

/* Whether known region and occupancy of a configuration are valid; FIBRAD_E_ARGUMENT. */
int fibrad_surroundings_check(const fibrad_scene_config *config);

/* Sets scene->known_low, known_high and occupancy from a valid configuration; centres and radii are measured already.
 */
void fibrad_surroundings_build(fibrad_scene *scene, const fibrad_scene_config *config);

/* The length at which a ray from o along w (of any length but 0), in lengths of w, leaves the ball of some radius about
 * the origin; -1: o is outside. Lengths are in a unit in which squares neither overflow nor vanish; radius infinity:
 * infinity. */
double fibrad_ball_exit(const double o[3], const double w[3], double radius);

/* The same for the known region, in the scene's coordinates [L]. */
double fibrad_region_exit(const fibrad_scene *scene, const double o[3], const double w[3]);

/* What the ray from `origin` [L] along w meets that meets no sphere up to the length `ball`, nor before it leaves the
 * known region: the wall it meets until then; else, where the occupancy leaves its way clear, what lies at the end of
 * it, and FIBRAD_BEYOND if not. *distance: to the wall, as of fibrad_walls_exit. */
uint32_t fibrad_surroundings_met(const fibrad_scene *scene, const double origin[3], const double w[3], double ball,
                                 double *distance);

/* The same for a ray along the unit vector w that meets a triangle at some length before any sphere: the slot of its
 * side, a wall's if that comes first, FIBRAD_BEYOND if its way there is neither known nor clear, or FIBRAD_NONE if the
 * side is nobody's. */
uint32_t fibrad_surroundings_side(const fibrad_scene *scene, const double origin[3], const double w[3], double ball,
                                  uint32_t side, double length, double *distance);

#endif
