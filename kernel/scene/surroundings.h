/* surroundings.h - where rays end that meet no sphere of a scene: at a wall, in the surroundings, or in the unknown.
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SCENE_SURROUNDINGS_H
#define FIBRAD_SCENE_SURROUNDINGS_H

#include "scene/scene.h"

/* Checks the occupancy of a configuration. Errors: FIBRAD_E_ARGUMENT. */
int fibrad_surroundings_check(const fibrad_scene_config *config);

/* Sets scene->occupancy from a valid configuration. Centres and radii must be measured. */
void fibrad_surroundings_build(fibrad_scene *scene, const fibrad_scene_config *config);

/* The length at which a ray from o along w leaves the ball about the origin. The length is in units of |w|. w is not 0.
 * -1: o lies outside the ball. Infinity: the radius is infinite. The unit of o, w and radius must be such that squares
 * neither overflow nor vanish. */
double fibrad_ball_exit(const double o[3], const double w[3], double radius);

/* The slot at which a ray ends that meets no sphere within the cutoff. A wall within the length `ball` is the end.
 * Otherwise the occupancy decides. If no marked cell lies on the way on, the end is the wall there or FIBRAD_ESCAPED.
 * If a marked cell lies there, the end is FIBRAD_BEYOND. Input    origin [L], w ball: [L] Output   distance: to the
 * wall, as of fibrad_walls_exit */
uint32_t fibrad_surroundings_met(const fibrad_scene *scene, const double origin[3], const double w[3], double ball,
                                 double *distance);

/* The slot at which a line of a window ends. The line has its own direction, along which it ends at `met`. A line from
 * the same point in the direction of the window ends at `along`. The direction of the window decides whether the way is
 * clear of marked cells, as it decides which nearer spheres hide the line. In its own direction the line may pass
 * through such a sphere into marked cells. */
FIBRAD_INLINE uint32_t fibrad_surroundings_of_window(uint32_t met, uint32_t along) {
    return met == FIBRAD_BEYOND || along == FIBRAD_BEYOND ? along : met;
}

/* The slot at which a ray ends that meets the side of a triangle at some length, before any sphere. This is the slot of
 * the side, or of a plane or the cylinder if that comes first. FIBRAD_BEYOND: beyond the cutoff, and the way there is
 * not clear. FIBRAD_NONE: the side belongs to no wall. w is a unit vector. */
uint32_t fibrad_surroundings_side(const fibrad_scene *scene, const double origin[3], const double w[3], double ball,
                                  uint32_t side, double length, double *distance);

#endif
