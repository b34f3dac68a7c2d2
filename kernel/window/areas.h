/* areas.h - exact visible areas of discs in a window. SPDX-License-Identifier: MIT
 *
 * The window is the unit disc about the origin. Its open region is the part that no disc covers so far. The caller
 * hands over discs from front to back. Each disc hides its part of the open region. There are two methods. Clipping
 * (clip_lanes.c) is fast and detects degenerate windows. The arrangement of circles (arrangement_lanes.c) works for
 * all configurations and computes the degenerate windows again. docs/methods.md section 4 explains both. */
#ifndef FIBRAD_WINDOW_AREAS_H
#define FIBRAD_WINDOW_AREAS_H

#include "window/dense.h"

#define FIBRAD_PIECES 48 /* approximate number of pieces that are integrated together */

/* Pieces of the open region's boundary that discs have hidden. The occluder is the disc that has hidden a piece. By
 * Green's theorem each piece adds an area to its occluder and subtracts it from the disc on whose circle the piece
 * lies. There is room for one more vector. */
typedef struct fibrad_pieces {
    _Alignas(FIBRAD_ALIGNMENT) double px[FIBRAD_PIECES + 8], py[FIBRAD_PIECES + 8];
    double qx[FIBRAD_PIECES + 8], qy[FIBRAD_PIECES + 8];
    double cx[FIBRAD_PIECES + 8], cy[FIBRAD_PIECES + 8], r[FIBRAD_PIECES + 8];
    double circle[FIBRAD_PIECES + 8], occluder[FIBRAD_PIECES + 8]; /* numbers of circles and occluders */
    uint32_t from[FIBRAD_PIECES + 8], to[FIBRAD_PIECES + 8];       /* the same numbers during the integration */
    uint32_t count;
} fibrad_pieces;

#define FIBRAD_BOUNDARY 48 /* largest number of arcs that bound the open region in clipping */

/* The boundary of the open region in clipping. An arc goes counter-clockwise about c from c + p to c + q and is
 * shorter than half a circle. Each arc has a slot. The slots have no particular order. */
typedef struct fibrad_boundary {
    _Alignas(FIBRAD_ALIGNMENT) double px[FIBRAD_BOUNDARY], py[FIBRAD_BOUNDARY];
    double qx[FIBRAD_BOUNDARY], qy[FIBRAD_BOUNDARY];
    double cx[FIBRAD_BOUNDARY], cy[FIBRAD_BOUNDARY], r[FIBRAD_BOUNDARY], circle[FIBRAD_BOUNDARY];
    double cut[2][2][FIBRAD_BOUNDARY]; /* x and y of the points where each arc enters and leaves the new disc, relative
                                          to the centre of the disc */
    double old_qx[FIBRAD_BOUNDARY], old_qy[FIBRAD_BOUNDARY]; /* where each arc ended before the new disc */
    uint64_t alive,
        window; /* alive: bit k: slot k holds an arc. window: bit k: this arc lies on the circle of the window */
} fibrad_boundary;

/* Arcs of the arrangement. Each goes counter-clockwise from p to q on a circle, given by its number, and is at most
 * half of the circle. a and b are the pseudo-angles of p and q on this circle. */
typedef struct fibrad_arcs {
    double *a, *b, *px, *py, *qx, *qy, *circle;
    uint32_t count;
} fibrad_arcs;

/* Intervals of the new disc's circle that are hidden. circle: the circles of the discs that hide them. */
typedef struct fibrad_intervals {
    double *from, *to, *circle; /* pseudo-angles, and the number of a circle */
    uint32_t count;
    bool all; /* the whole circle is hidden */
} fibrad_intervals;

typedef struct fibrad_arrangement {
    uint32_t arcs;             /* capacity: arcs that bound the open region */
    uint32_t seconds;          /* capacity: second parts at a time */
    double *inverse;           /* [discs + 2] 1/r of each circle */
    double *from, *to;         /* [discs + 2] the interval of each circle that the new disc covers, as pseudo-angles */
    double *sx, *sy, *ex, *ey; /* the points where this interval begins and ends */
    fibrad_intervals hidden;   /* [discs + 1] */
    fibrad_arcs open, left;    /* [arcs] the boundary of the open region, and the part of it outside a new disc */
    fibrad_arcs second[2]; /* [seconds] second parts of arcs that are cut in three: those that stay and those that are
                              hidden; temporary */
} fibrad_arrangement;

typedef struct fibrad_areas {
    uint32_t discs;    /* capacity: discs of a window */
    uint32_t circles;  /* number of circles: the window, and the discs whose circles may bound the open region */
    double *x, *y, *r; /* [discs + 2] circle 0 is the window */
    double *area;      /* [discs + 2] visible area of each; that of the window is -pi */
    uint32_t *whose;   /* [discs + 2] the caller's number of each */
    fibrad_pieces *pieces;
    fibrad_boundary *boundary;
    fibrad_arrangement arrangement; /* the arrangement and `dense` share memory */
    fibrad_dense dense;
    double widest;      /* the largest radius so far */
    bool open;          /* whether a part of the window is open */
    bool degenerate;    /* whether the arrangement computes this window */
    bool overflow;      /* the memory is too small for the arcs: start again with more discs */
    uint32_t fallbacks; /* degenerate windows since the caller set this to 0 */
} fibrad_areas;

void fibrad_areas_layout(fibrad_areas *areas, fibrad_arena *arena, uint32_t discs);

/* Clears what dense clipping has left in the arrangement's lists of arcs. Lanes beyond the end of a list look up a
 * circle too, so each number in a list must belong to a circle. */
void fibrad_areas_clear_arcs(fibrad_areas *areas);

/* An arc that bounds the open region of a completed window. It goes counter-clockwise about c from c + p to c + q and
 * is at most half a circle. The open region lies to its left if the circle is the window, otherwise to its right. */
typedef struct fibrad_open_arc {
    uint32_t circle; /* its number; 0: the window */
    double p[2], q[2], c[2], r;
    double chord[2]; /* q - p */
} fibrad_open_arc;

/* Goes through the arcs that bound the open region of a completed window, in a fixed order. *at: 0 for the first arc.
 * False: no arc is left. */
bool fibrad_areas_next(const fibrad_areas *areas, uint32_t *at, fibrad_open_arc *arc);

/* The growth of the open area of a completed window as the direction of the window turns: slope[0] towards u and
 * slope[1] towards v, per radian. A disc at depth t then moves by -t. The disc covers what its open rim passes over.
 * depth: of the discs, by the caller's numbers. */
void fibrad_areas_slope(const fibrad_areas *areas, const double *depth, double slope[2]);

/* Appends a circle. */
static inline void fibrad_areas_add_circle(fibrad_areas *areas, uint32_t whose, double x, double y, double r) {
    uint32_t k = areas->circles;
    areas->x[k] = x, areas->y[k] = y, areas->r[k] = r, areas->area[k] = 0;
    areas->whose[k] = whose;
}

#endif
