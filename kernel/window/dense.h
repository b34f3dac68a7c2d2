/* dense.h - the boundary of the open region where many arcs bound it: arcs and discs by the cells of a grid over the
 * window. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WINDOW_DENSE_H
#define FIBRAD_WINDOW_DENSE_H

#include "base/arena.h"
#include "base/port.h"

#define FIBRAD_DENSE_BLOCK 8u          /* arcs that are stored side by side */
#define FIBRAD_DENSE_NONE  0xffffffffu /* no block, no disc */
#define FIBRAD_DENSE_FULL  0xfffffffeu /* of a cell: it lies within one disc */

/* Arcs as in fibrad_boundary, each in a slot of its own, in any order. */
typedef struct fibrad_dense_block {
    _Alignas(FIBRAD_ALIGNMENT) double px[FIBRAD_DENSE_BLOCK], py[FIBRAD_DENSE_BLOCK];
    double qx[FIBRAD_DENSE_BLOCK], qy[FIBRAD_DENSE_BLOCK];
    double cx[FIBRAD_DENSE_BLOCK], cy[FIBRAD_DENSE_BLOCK], r[FIBRAD_DENSE_BLOCK], circle[FIBRAD_DENSE_BLOCK];
} fibrad_dense_block;

/* A disc that overlaps a cell. */
typedef struct fibrad_dense_disc {
    uint32_t circle, next;
} fibrad_dense_disc;

/* A point where a circle on the boundary meets the new disc, relative to its centre; and, if `rest`, where the part of
 * the arc in `slot` that goes on from there ends. */
typedef struct fibrad_dense_cut {
    double x, y, qx, qy;
    double ahead;         /* pseudo-angle, 0 to 4 */
    uint32_t block, lane; /* its slot */
    bool leaves, rest;    /* the walk along the boundary leaves the disc here, or enters it */
} fibrad_dense_cut;

/* Each arc is in a block of the cell where the middle of its chord is. No chord is longer than a cell is wide. */
typedef struct fibrad_dense {
    uint32_t cells_most, blocks_most, discs_most, cuts_most; /* capacities */
    uint32_t cells;                                          /* along each axis */
    uint32_t enough;              /* circles for which they are enough; with more the window is begun again */
    uint32_t blocks, discs, cuts; /* in use */
    uint32_t live;                /* arcs of the boundary */
    double scale;                 /* cells over the width of the window, 2 */
    double longest, reach;        /* chord that is allowed, squared; half of the longest there is */
    uint32_t *first_block;        /* [cells^2] of each cell */
    uint32_t *first_disc;         /* [cells^2] */
    fibrad_dense_block *block;    /* [blocks_most] */
    uint32_t *alive, *next;       /* [blocks_most] bit l: slot l holds an arc; the cell's next block */
    fibrad_dense_disc *disc;
    fibrad_dense_cut *cut;
    bool on;      /* the window in hand is resolved here */
    bool written; /* its arrays stand where the arrangement's are to be */
} fibrad_dense;

void fibrad_dense_layout(fibrad_dense *dense, fibrad_arena *arena, uint32_t discs);

#endif
