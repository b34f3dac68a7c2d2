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
    /* the run: spheres [begin, end), shifted by whole periods; image: by at least one */
    uint32_t begin, end;
    int32_t periods[3];
    double shift[3];
    bool image;
} fibrad_walk;

/* Starts a walk over the box from low to high [L]. */
void fibrad_walk_begin(fibrad_walk *walk, const fibrad_scene *scene, const fibrad_level *level, const double low[3],
                       const double high[3]);

/* Starts a walk over the box about two points whose faces lie `wide` [L] beyond them. For a cube the points are one. */
static inline void fibrad_walk_about(fibrad_walk *walk, const fibrad_scene *scene, const fibrad_level *level,
                                     const double from[3], const double to[3], double wide) {
    double low[3], high[3];
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = fibrad_min(from[axis], to[axis]) - wide;
        high[axis] = fibrad_max(from[axis], to[axis]) + wide;
    }
    fibrad_walk_begin(walk, scene, level, low, high);
}

/* Goes to the next run that has spheres. False: no run is left. */
bool fibrad_walk_next(fibrad_walk *walk);

#endif
