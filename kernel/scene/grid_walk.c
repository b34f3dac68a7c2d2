/* grid_walk.c - walks through the cells of a scene. SPDX-License-Identifier: MIT */
#include "scene/grid_walk.h"

int32_t fibrad_grid_cell(const fibrad_scene *scene, const fibrad_level *level, int axis, double c) {
    const bool periodic = scene->period[axis] > 0;
    const double cell = (c - scene->box_low[axis] + (periodic ? 0 : level->radius_max)) * level->inverse[axis];
    if (!periodic) return (int32_t)fibrad_max(0, fibrad_min(cell, level->cells[axis] - 1));
    return (int32_t)fibrad_max(-1e9, fibrad_min(fibrad_floor(cell), 1e9));
}

void fibrad_walk_begin(fibrad_walk *walk, const fibrad_scene *scene, const fibrad_level *level, const double low[3],
                       const double high[3]) {
    walk->scene = scene;
    walk->level = level;
    for (int axis = 0; axis < 3; axis++) {
        walk->low[axis] = walk->at[axis] = fibrad_grid_cell(scene, level, axis, low[axis]);
        walk->high[axis] = fibrad_grid_cell(scene, level, axis, high[axis]);
    }
}

/* The cell of the box for the cell of the walk along an axis, and the shift of that periodic image. */
static inline int32_t cell_of_image(fibrad_walk *walk, int axis) {
    const int32_t cells = walk->level->cells[axis], at = walk->at[axis];
    const bool within = (uint32_t)at < (uint32_t)cells;
    const int32_t periods = within ? 0 : at < 0 ? -((cells - 1 - at) / cells) : at / cells;
    walk->periods[axis] = periods;
    walk->shift[axis] = within ? 0 : periods * walk->scene->period[axis];
    return at - periods * cells;
}

bool fibrad_walk_next(fibrad_walk *walk) {
    const fibrad_level *level = walk->level;
    while (walk->at[2] <= walk->high[2]) {
        const int32_t x = cell_of_image(walk, 0), y = cell_of_image(walk, 1), z = cell_of_image(walk, 2);
        walk->image = walk->periods[0] != 0 || walk->periods[1] != 0 || walk->periods[2] != 0;
        int32_t run = level->cells[0] - x; /* to the end of the box, or to the end of the walk */
        if (run > walk->high[0] - walk->at[0] + 1) run = walk->high[0] - walk->at[0] + 1;
        uint32_t row =
            level->first_cell + (uint32_t)level->cells[0] * ((uint32_t)level->cells[1] * (uint32_t)z + (uint32_t)y);
        walk->begin = walk->scene->start[row + (uint32_t)x];
        walk->end = walk->scene->start[row + (uint32_t)x + (uint32_t)run];
        walk->at[0] += run;
        if (walk->at[0] > walk->high[0]) {
            walk->at[0] = walk->low[0];
            if (++walk->at[1] > walk->high[1]) {
                walk->at[1] = walk->low[1];
                walk->at[2]++;
            }
        }
        if (walk->begin < walk->end) return true;
    }
    return false;
}
