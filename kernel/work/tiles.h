/* tiles.h - rays that leave the tiles of planes, which all rows share. SPDX-License-Identifier: MIT
 *
 * A plane is divided into square tiles. A tile is divided into 64 squares. One ray leaves from each square. The points
 * of a tile and their directions are evenly spread together. A path that meets a tile goes on with the ray of the
 * square that it has met. So one ray serves the paths of all rows. */
#ifndef FIBRAD_WORK_TILES_H
#define FIBRAD_WORK_TILES_H

#include "base/sobol.h"

#define FIBRAD_TILE_SIDE 8u /* squares along a side */
#define FIBRAD_TILE_RAYS (FIBRAD_TILE_SIDE * FIBRAD_TILE_SIDE)
#define FIBRAD_TILE_WAYS 4u    /* places in memory that a tile may have */
#define FIBRAD_TILES     2048u /* places of all tiles, a power of two */

/* The rays of a tile, by square. */
typedef struct fibrad_tile {
    float at[2][FIBRAD_TILE_RAYS];     /* where the ray begins, along the edges of the plane from the tile's corner, in
                                          sides */
    float w[3][FIBRAD_TILE_RAYS];      /* its direction, a unit vector */
    float normal[3][FIBRAD_TILE_RAYS]; /* where it meets a sphere */
    float length[FIBRAD_TILE_RAYS];    /* L, up to there, rounded up */
    uint32_t sphere[FIBRAD_TILE_RAYS]; /* the place of this sphere; FIBRAD_NONE: it meets none */
} fibrad_tile;

/* The tiles in work memory. */
typedef struct fibrad_tiles {
    fibrad_tile *tile; /* [FIBRAD_TILES] */
    uint64_t *key;     /* [FIBRAD_TILES], of seed, plane and position; 0: there is no tile */
    uint32_t made;     /* number of tiles made so far */
    uint64_t scene;    /* hash of the scene to which they belong */
    uint64_t seed;     /* of their random numbers */
    double side;       /* L */
    fibrad_sobol sobol;
} fibrad_tiles;

/* Begins with tiles of a side [L]. Tiles of an earlier call stay if scene, side and seed are the same. */
static inline void fibrad_tiles_begin(fibrad_tiles *tiles, uint64_t scene, double side, uint64_t seed) {
    if (tiles->scene == scene && tiles->seed == seed && tiles->side == side) return;
    tiles->scene = scene, tiles->seed = seed, tiles->side = side;
    fibrad_sobol_make(&tiles->sobol);
    for (uint32_t k = 0; k < FIBRAD_TILES; k++) tiles->key[k] = 0;
}

#define FIBRAD_ARRIVALS_WINDOW 16u   /* most of a window */
#define FIBRAD_ARRIVALS        2304u /* most of a row */

/* Where beams of a row arrive at a plane. */
typedef struct fibrad_arrival {
    double point[3]; /* L */
    double weight;   /* number of beams for which this one stands */
    uint32_t plane;  /* its slot */
} fibrad_arrival;

/* The arrivals that a beam row takes from its windows. */
typedef struct fibrad_arrivals {
    uint32_t planes; /* bit k: the row takes those at the plane of slot k */
    uint32_t length;
    fibrad_arrival *arrival; /* [FIBRAD_ARRIVALS] */
} fibrad_arrivals;

#endif
