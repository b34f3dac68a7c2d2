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

/* How far a place is from the wall of a slot [L], inwards; infinity: there is no such wall. */
double fibrad_walls_away(const fibrad_container *container, uint32_t slot, const double at[3]);

/* Whether a sphere reaches beyond no opening, but for rounding. */
bool fibrad_walls_hold_ball(const fibrad_container *container, const double centre[3], double radius);

/* The fraction of a sphere's surface that lies behind the wall of a slot; 0: no more than rounding does. Of a cylinder
 * with `radius` R it is that behind the plane that touches it there. */
double fibrad_walls_cap(const fibrad_container *container, uint32_t slot, const double centre[3], double radius);

/* Whether a wall cuts a sphere: a cap of it lies behind. */
bool fibrad_walls_cut(const fibrad_container *container, const double centre[3], double radius);

/* The same of the sphere at `place`. */
static inline bool fibrad_walls_cut_place(const fibrad_scene *scene, uint32_t place) {
    const double centre[3] = {scene->x[place], scene->y[place], scene->z[place]};
    return scene->container.cuts && fibrad_walls_cut(&scene->container, centre, scene->r[place]);
}

/* The wall behind which the point of the sphere at `place` with outward normal n lies, the first that the radius
 * crosses, at `at`; FIBRAD_NONE: none. What such a point sends out goes to that wall, whatever the direction, and no
 * line from elsewhere ends there. */
uint32_t fibrad_walls_behind(const fibrad_scene *scene, uint32_t place, const double n[3], double at[3]);

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
