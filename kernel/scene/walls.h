/* walls.h - the planes and the cylinder of a scene. They bound a convex container. SPDX-License-Identifier: MIT
 *
 * A new kind of wall needs: a check (fibrad_walls_check), its data in fibrad_container (fibrad_walls_build), the
 * point where a line meets it (fibrad_walls_exit), its normal, its area, its points, and its distance from a point.
 * Meshes are in mesh/mesh.h. surroundings.h has the slot in which a ray ends, whatever it meets. */
#ifndef FIBRAD_SCENE_WALLS_H
#define FIBRAD_SCENE_WALLS_H

#include "scene/scene.h"

/* Whether walls, openings and periods of a configuration fit together. Errors: FIBRAD_E_ARGUMENT, _UNSUPPORTED,
 * _ENDLESS. */
int fibrad_walls_check(const fibrad_scene_config *config);

/* Sets scene->container, slot and wall_area from walls and openings that are valid. scene->period is set before. */
void fibrad_walls_build(fibrad_scene *scene, const fibrad_scene_config *config);

/* Whether a point [L] lies within the walls or on one of them. */
bool fibrad_walls_hold(const fibrad_container *container, const double at[3]);

/* The distance [L] of a point from the wall of a slot, positive inside. Infinity: there is no such wall. */
double fibrad_walls_away(const fibrad_container *container, uint32_t slot, const double at[3]);

/* Whether a sphere reaches beyond no opening. Rounding errors do not count. */
bool fibrad_walls_hold_ball(const fibrad_container *container, const double centre[3], double radius);

/* The fraction of a sphere's surface that lies behind the wall of a slot. For the cylinder, the plane that touches
 * it next to the sphere takes its place. 0: the sphere lies before the wall, but for rounding. */
double fibrad_walls_cap(const fibrad_container *container, uint32_t slot, const double centre[3], double radius);

/* Whether a wall cuts a sphere, so that a cap of the sphere lies behind the wall. scene->cut tells it of the spheres of
 * a scene. */
bool fibrad_walls_cut(const fibrad_container *container, const double centre[3], double radius);

/* The wall behind which a point of a sphere lies, or FIBRAD_NONE. The sphere is at `place`, and n is the outward
 * normal of the point. If several walls cut off the point, the first on the way from the centre counts. at: out:
 * where the radius meets this wall [L]. All radiation of such a point goes to this wall. No line from elsewhere ends
 * at such a point. */
uint32_t fibrad_walls_behind(const fibrad_scene *scene, uint32_t place, const double n[3], double at[3]);

/* The largest coordinate of a wall [L], the cylinder's radius included. */
double fibrad_walls_reach(const fibrad_container *container);

/* The wall through which a ray leaves the container. FIBRAD_NONE: the ray meets no wall. The ray goes from `origin`
 * [L] along w, which is not 0. distance: out: to the wall, in lengths of w; infinity if there is none. The wall
 * depends on the line alone, not on the place of the origin. Only if the origin lies outside a cylinder that the
 * line misses, this is not so. An origin beyond a wall leaves at once if w points outwards there. Otherwise the ray
 * first enters the container. */
uint32_t fibrad_walls_exit(const fibrad_scene *scene, const double origin[3], const double w[3], double *distance);

/* The unit normal of a wall at a point on it [L]. It points inwards. */
void fibrad_wall_normal(const fibrad_scene *scene, uint32_t wall, const double at[3], double normal[3]);

/* The axis along edge 0 or edge 1 of a plane, and along edge 1 of the cylinder. Edge 0 of the cylinder goes around it.
 */
static inline uint32_t fibrad_wall_along(const fibrad_container *container, uint32_t wall, uint32_t edge) {
    return wall == FIBRAD_CYLINDER ? fibrad_cylinder_axis(container->turn, 2) : fibrad_face_along(wall, edge);
}

/* Moves a point [L] across the cylinder, to u and v from its axis. */
void fibrad_wall_about(const fibrad_container *container, double u, double v, double at[3]);

/* The point [L] of a wall at two coordinates along its edges [L; turns around the cylinder]. */
void fibrad_wall_point(const fibrad_container *container, uint32_t wall, const double coordinate[2], double at[3]);

/* The point [L] of a wall for two numbers from 0 to 1. Evenly spread numbers give evenly spread points on the part of
 * the wall inside all others, within one period of each periodic axis. */
void fibrad_wall_even_point(const fibrad_scene *scene, uint32_t wall, const double share[2], double at[3]);

#endif
