/* scene.h - the inside of a scene: spheres in the order of a cell grid. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SCENE_SCENE_H
#define FIBRAD_SCENE_SCENE_H

#include "base/port.h"
#include "fibrad.h"

#define FIBRAD_NONE UINT32_MAX

/* Spheres whose radii differ by less than a factor two share a level, a grid of its own with cells to their measure:
 * a small sphere among large ones does not search cells as wide as the large ones need. */
#define FIBRAD_LEVELS 32

typedef struct fibrad_level {
    double radius_max;
    double cell[3], inverse[3]; /* size of a cell [L] and its inverse */
    int32_t cells[3];
    uint32_t first_cell;   /* where its cells begin in scene->start; x runs fastest */
    uint32_t first_sphere; /* where its spheres begin */
} fibrad_level;

/* The convex region within the walls. */
typedef struct fibrad_container {
    bool walls;             /* whether there are any */
    double low[3], high[3]; /* of the planes [L]; infinite where there is none */
    double axis[2], radius; /* of the cylinder [L]; radius infinite: none */
} fibrad_container;

struct fibrad_scene {
    fibrad_scene_facts facts;
    double period[3], low[3], high[3]; /* box of the centres; on a periodic axis high = low + period */
    double box_low[3], box_high[3];    /* box of the grid: the same without stray spheres */
    fibrad_container container;
    double spacing; /* cube root of the volume per sphere [L] */
    uint32_t levels;
    fibrad_level level[FIBRAD_LEVELS]; /* by ascending radius; empty ones left out */
    double *x, *y, *z, *r;             /* [n] in cell order */
    uint32_t *order;                   /* [n] the caller's index of each */
    uint32_t *place;                   /* [n] where the caller's sphere i stands */
    uint32_t *start;                   /* [cells + 1] */
};

#endif
