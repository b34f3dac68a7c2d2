/* clumps.h - bodies of spheres: how much of each member is exposed, and what belongs together.
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SCENE_CLUMPS_H
#define FIBRAD_SCENE_CLUMPS_H

#include "scene/scene.h"

/* Takes the arrays of clumps of n spheres from the arena. */
void fibrad_clumps_layout(fibrad_arena *arena, uint32_t n, fibrad_clumps *clumps);

/* Finds what is exposed of members, and the facts of clumps. FIBRAD_E_GEOMETRY: a clump touches its own image;
 * *sphere: a member. */
int fibrad_clumps_build(fibrad_scene *scene, uint32_t *sphere);

#endif
