/* walls.h - the walls of a scene: planes and a cylinder that bound a convex container. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SCENE_WALLS_H
#define FIBRAD_SCENE_WALLS_H

#include "scene/scene.h"

/* Whether bodies, openings and periods of a configuration fit together; FIBRAD_E_ARGUMENT, _UNSUPPORTED, _ENDLESS. */
int fibrad_walls_check(const fibrad_scene_config *config);

/* Sets scene->container, slot and wall_area from bodies and openings found valid; scene->period is set already. */
void fibrad_walls_build(fibrad_scene *scene, const fibrad_scene_config *config);

/* Whether a place [L] lies within the walls, or on one. */
bool fibrad_walls_hold(const fibrad_container *container, const double at[3]);

/* Whether a sphere reaches beyond no opening, but for rounding. */
bool fibrad_walls_hold_ball(const fibrad_container *container, const double centre[3], double radius);

/* The largest coordinate of a wall [L], the cylinder's radius included. */
double fibrad_walls_reach(const fibrad_container *container);

/* The wall through which the ray from `origin` [L] along w (of any length but 0) leaves the container;
 * FIBRAD_NONE: through none. *distance >= 0 in lengths of w; infinity if none. Which wall it is depends on the
 * line alone, not on where on it the origin lies, but for origins beyond a cylinder that the line misses: an origin
 * beyond a wall leaves at once if w points outwards there, else the ray enters first. */
uint32_t fibrad_walls_exit(const fibrad_scene *scene, const double origin[3], const double w[3], double *distance);

/* The unit normal of a wall at a place on it [L], inwards. */
void fibrad_wall_normal(const fibrad_scene *scene, uint32_t wall, const double at[3], double normal[3]);

#endif
