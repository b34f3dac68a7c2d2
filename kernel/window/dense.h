/* dense.h - the boundary of the open region where many arcs bound it: arcs and discs by the cells of a grid over the
 * window. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WINDOW_DENSE_H
#define FIBRAD_WINDOW_DENSE_H

#include "base/arena.h"
#include "base/port.h"

#define FIBRAD_DENSE_BLOCK 16u         /* slots for arcs that are stored side by side */
#define FIBRAD_DENSE_NONE  0xffffffffu /* no block, no disc */
#define FIBRAD_DENSE_FULL  0xfffffffeu /* of a cell: it lies within one disc */

/* A disc that overlaps a cell. */
typedef struct fibrad_dense_disc {
    uint32_t circle, next;
} fibrad_dense_disc;

/* A point where a circle on the boundary meets the new disc, relative to its centre; and, unless that is
 * FIBRAD_DENSE_STAYS, what becomes of the part of the arc that goes on from there, and where that ends. */
typedef enum fibrad_dense_part { FIBRAD_DENSE_STAYS, FIBRAD_DENSE_OPEN, FIBRAD_DENSE_HIDDEN } fibrad_dense_part;
typedef struct fibrad_dense_cut {
    double x, y, qx, qy;
    double ahead; /* pseudo-angle, 0 to 4 */
    uint32_t slot;
    fibrad_dense_part rest;
    bool leaves; /* the walk along the boundary leaves the disc here, or enters it */
} fibrad_dense_cut;

/* Arcs as in fibrad_boundary, each in a slot of its own, in blocks of slots. Each arc is in a block of the cell where
 * the middle of its chord is. No chord is longer than a cell is wide. */
typedef struct fibrad_dense {
    uint32_t cells_most, blocks_most, discs_most, cuts_most; /* capacities */
    uint32_t cells, fine;                                    /* along each axis: for arcs, for discs */
    uint32_t enough;              /* circles for which they are enough; with more the window is begun again */
    uint32_t blocks, discs, cuts; /* in use */
    uint32_t live;                /* arcs of the boundary */
    double longest, reach;        /* chord that is allowed, squared; half of the longest there is */
    double *px, *py, *qx, *qy, *cx, *cy, *r, *circle; /* [16 blocks_most] */
    float *mx, *my, *half;  /* [same] the middle of the chord, and a little more than half of it: no point of the arc is
                               farther from there */
    uint32_t *near;         /* [same and more] slots of arcs near the new disc */
    uint32_t *alive, *next; /* [blocks_most] bit l: slot l holds an arc; the cell's next block */
    uint32_t *first_block, *first_disc; /* [cells^2], [fine^2] of each cell */
    fibrad_dense_disc *disc;
    fibrad_dense_cut *cut;
    bool on;      /* the window in hand is resolved here */
    bool written; /* its arrays stand where the arrangement's are to be */
} fibrad_dense;

#endif
