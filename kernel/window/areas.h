/* areas.h - exact visible areas of discs in a window, front to back. SPDX-License-Identifier: MIT
 *
 * The window is the unit disc about the origin. Its open region is what no disc covers so far. Discs are handed over
 * front to back, and each hides its part of the open region. There are two methods: clipping (clip_lanes.c), fast,
 * which detects degenerate windows; and the arrangement of circles (arrangement_lanes.c), which no configuration
 * disturbs and which resolves those windows again. docs/methods.md section 4 explains both. */
#ifndef FIBRAD_WINDOW_AREAS_H
#define FIBRAD_WINDOW_AREAS_H

#include "base/arena.h"
#include "base/port.h"
#include "window/dense.h"

#define FIBRAD_PIECES 48 /* pieces summed at a time, about */

/* Pieces of the open region's boundary that discs have hidden. By Green's theorem each adds its area to its occluder,
 * the disc that has hidden it, and subtracts it from the disc of its circle. Room for a vector more. */
typedef struct fibrad_pieces {
    _Alignas(FIBRAD_ALIGNMENT) double px[FIBRAD_PIECES + 8], py[FIBRAD_PIECES + 8];
    double qx[FIBRAD_PIECES + 8], qy[FIBRAD_PIECES + 8];
    double cx[FIBRAD_PIECES + 8], cy[FIBRAD_PIECES + 8], r[FIBRAD_PIECES + 8];
    double circle[FIBRAD_PIECES + 8], occluder[FIBRAD_PIECES + 8]; /* numbers, ... */
    uint32_t from[FIBRAD_PIECES + 8], to[FIBRAD_PIECES + 8];       /* ... the same while they are summed */
    uint32_t count;
} fibrad_pieces;

#define FIBRAD_BOUNDARY 48 /* arcs that bound the open region, at most, while clipping */

/* The boundary of the open region while clipping: arcs counter-clockwise from c + p to c + q about c, shorter than half
 * a circle, each in a slot of its own, in no particular order. */
typedef struct fibrad_boundary {
    _Alignas(FIBRAD_ALIGNMENT) double px[FIBRAD_BOUNDARY], py[FIBRAD_BOUNDARY];
    double qx[FIBRAD_BOUNDARY], qy[FIBRAD_BOUNDARY];
    double cx[FIBRAD_BOUNDARY], cy[FIBRAD_BOUNDARY], r[FIBRAD_BOUNDARY], circle[FIBRAD_BOUNDARY];
    double cut[2][2][FIBRAD_BOUNDARY]; /* x, y of where each enters and leaves the new disc, relative to its centre, */
    double old_qx[FIBRAD_BOUNDARY], old_qy[FIBRAD_BOUNDARY]; /* and where it ended before */
    uint64_t alive, window;                                  /* bit k: slot k holds an arc; it is one of the window's */
} fibrad_boundary;

/* Arcs of the arrangement, each counter-clockwise from p to q on a circle (its number) and at most half of it; a and b
 * are the pseudo-angles of p and q on it. */
typedef struct fibrad_arcs {
    double *a, *b, *px, *py, *qx, *qy, *circle;
    uint32_t count;
} fibrad_arcs;

/* Intervals of the new disc's circle that are hidden, and the circles that bound what hides them. */
typedef struct fibrad_intervals {
    double *from, *to, *circle; /* pseudo-angles; number */
    uint32_t count;
    bool all; /* the whole circle is hidden */
} fibrad_intervals;

typedef struct fibrad_arrangement {
    uint32_t arcs;             /* capacities: arcs that bound the open region, ... */
    uint32_t seconds;          /* ... second parts at a time */
    double *inverse;           /* [discs + 2] 1/r of each circle */
    double *from, *to;         /* [discs + 2] what the new disc covers of each circle, as pseudo-angles, ... */
    double *sx, *sy, *ex, *ey; /* ... and the points where that begins and ends */
    fibrad_intervals hidden;   /* [discs + 1] */
    fibrad_arcs open, left;    /* [arcs] the boundary of the open region; what remains of it outside a new disc */
    fibrad_arcs second[2];     /* [seconds] second parts of arcs cut in three, that stay or go: temporary */
} fibrad_arrangement;

typedef struct fibrad_areas {
    uint32_t discs;    /* capacity: discs of a window */
    uint32_t circles;  /* the window, and the discs whose circles may bound the open region */
    double *x, *y, *r; /* [discs + 2] circle 0 is the window */
    double *area;      /* [discs + 2] visible area of each; of the window: -pi */
    uint32_t *whose;   /* [discs + 2] the caller's number of each */
    fibrad_pieces *pieces;
    fibrad_boundary *boundary;
    fibrad_arrangement arrangement; /* it and `dense` share memory */
    fibrad_dense dense;
    double widest;      /* the largest radius so far */
    bool open;          /* something of the window is */
    bool degenerate;    /* the current window is resolved by the arrangement */
    bool overflow;      /* too many arcs for the memory: start again with more discs */
    uint32_t fallbacks; /* degenerate windows since the caller set this to 0 */
} fibrad_areas;

void fibrad_areas_layout(fibrad_areas *areas, fibrad_arena *arena, uint32_t discs);

/* Clears what dense clipping has left in the arrangement's lists of arcs. Lanes beyond their count look up a circle,
 * too: there must be one of that number. */
void fibrad_areas_clear_arcs(fibrad_areas *areas);

/* An arc that bounds the open region of a completed window: counter-clockwise from c + p to c + q about c, at most half
 * a circle. The open region is on its left if the circle is the window, else on its right. */
typedef struct fibrad_open_arc {
    uint32_t circle; /* its number; 0: the window */
    double p[2], q[2], c[2], r;
    double chord[2]; /* q - p */
} fibrad_open_arc;

/* The arcs that bound the open region of a completed window, one after the other in a fixed order. *at begins with 0.
 * False: there are no more. */
bool fibrad_areas_next(const fibrad_areas *areas, uint32_t *at, fibrad_open_arc *arc);

/* How fast the open area of a completed window grows as the window's direction turns: slope[0] towards u, slope[1]
 * towards v, per radian. A disc at depth t then moves by -t; what its open rim passes over is covered. depth: of the
 * discs, by the caller's numbers. */
void fibrad_areas_slope(const fibrad_areas *areas, const double *depth, double slope[2]);

/* Appends a circle. */
static inline void fibrad_areas_add_circle(fibrad_areas *areas, uint32_t whose, double x, double y, double r) {
    uint32_t k = areas->circles;
    areas->x[k] = x, areas->y[k] = y, areas->r[k] = r, areas->area[k] = 0;
    areas->whose[k] = whose;
}

#endif
