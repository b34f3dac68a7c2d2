/* dense.h - the boundary of the open region if many arcs bound it. A grid over the window holds arcs and discs by
 * cells. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WINDOW_DENSE_H
#define FIBRAD_WINDOW_DENSE_H

#include "base/arena.h"

#define FIBRAD_DENSE_BLOCK 16u         /* slots for arcs, stored side by side */
#define FIBRAD_DENSE_NONE  0xffffffffu /* no block, no disc */
#define FIBRAD_DENSE_FULL  0xfffffffeu /* for a cell: it lies within one disc */

/* A disc that overlaps a cell. */
typedef struct fibrad_dense_disc {
    uint32_t circle, next;
} fibrad_dense_disc;

/* A point where a circle of the boundary meets the new disc, relative to the centre of the disc. `rest` says what
 * becomes of the part of the arc that follows: it stays, it becomes open, or it is hidden. In the latter two cases
 * (qx, qy) is the end of this part. */
typedef enum fibrad_dense_part { FIBRAD_DENSE_STAYS, FIBRAD_DENSE_OPEN, FIBRAD_DENSE_HIDDEN } fibrad_dense_part;
typedef struct fibrad_dense_cut {
    double x, y, qx, qy;
    double ahead; /* pseudo-angle, 0 to 4 */
    uint32_t slot;
    fibrad_dense_part rest;
    bool leaves; /* whether the walk along the boundary leaves the disc here; otherwise it enters the disc */
} fibrad_dense_cut;

/* Arcs as in fibrad_boundary. Each has a slot, and slots form blocks. A block belongs to the cell where the middles
 * of the chords of its arcs lie. No chord is longer than a cell is wide. */
typedef struct fibrad_dense {
    uint32_t cells_most, blocks_most, discs_most, cuts_most; /* capacities */
    uint32_t cells, fine;                                    /* number of cells along each axis: for arcs, for discs */
    uint32_t enough; /* number of circles for which these cells suffice; with more circles the window begins again */
    uint32_t blocks, discs, cuts; /* in use */
    uint32_t live;                /* longest: the longest chord allowed, squared. reach: half of the longest chord */
    double longest, reach;        /* longest chord allowed, squared; half of the longest chord */
    double *px, *py, *qx, *qy, *cx, *cy, *r, *circle; /* [16 blocks_most] */
    float *mx, *my, *half;  /* [same] the middle of the chord, and the distance that no point of the arc exceeds */
    uint32_t *near;         /* [same and more] slots of arcs near the new disc */
    uint32_t *alive, *next; /* [blocks_most] bit l: slot l holds an arc; the cell's next block */
    uint32_t *first_block, *first_disc; /* [cells^2] and [fine^2], of each cell */
    fibrad_dense_disc *disc;
    fibrad_dense_cut *cut;
    bool on;      /* whether dense clipping computes the current window */
    bool written; /* whether its arrays have been written where those of the arrangement will be */
} fibrad_dense;

#endif
