/* grid_walk.h - cells of the grid of a scene, and the walk through them. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SCENE_GRID_WALK_H
#define FIBRAD_SCENE_GRID_WALK_H

#include "scene/scene.h"

/* The cell of a coordinate [L] along an axis. On a periodic axis the cell may be one of an image, outside [0,
 * cells). */
int32_t fibrad_grid_cell(const fibrad_scene *scene, const fibrad_level *level, int axis, double c);

/* A walk through the cells of one level that meet a box. The walk visits runs of spheres that lie one after another
 * in memory. */
typedef struct fibrad_walk {
    const fibrad_scene *scene;
    const fibrad_level *level;
    int32_t low[3], high[3], at[3]; /* cells; those outside [0, cells) are periodic images */
    /* the run: spheres [begin, end), shifted by whole periods */
    uint32_t begin, end;
    double shift[3];
} fibrad_walk;

/* Starts a walk over the box from low to high [L]. */
void fibrad_walk_begin(fibrad_walk *walk, const fibrad_scene *scene, const fibrad_level *level, const double low[3],
                       const double high[3]);

/* Starts a walk over the cube about a centre, whose edges are twice the reach [L]. */
static inline void fibrad_walk_about(fibrad_walk *walk, const fibrad_scene *scene, const fibrad_level *level,
                                     const double centre[3], double reach) {
    const double low[3] = {centre[0] - reach, centre[1] - reach, centre[2] - reach},
                 high[3] = {centre[0] + reach, centre[1] + reach, centre[2] + reach};
    fibrad_walk_begin(walk, scene, level, low, high);
}

/* Goes to the next run that has spheres. False: no run is left. */
bool fibrad_walk_next(fibrad_walk *walk);

#endif
