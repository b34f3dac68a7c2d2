/* surface_lanes.h - the two loops of the surface method that run in lanes. SPDX-License-Identifier: MIT
 *
 * Pair frame: sphere 1 is the unit sphere at the origin (all lengths are in its radii), sphere 2 has radius r2 and
 * centre (0, 0, d), d >= 1 + r2. */
#ifndef FIBRAD_SURFACE_SURFACE_LANES_H
#define FIBRAD_SURFACE_SURFACE_LANES_H

#include "base/dispatch.h"
#include "fibrad_surface.h"
#include "sample/tables.h"

/* Further flags of a rule. Each switches off something that saves time. They change no bit of the factor. Tests
 * prove this, and benches measure what each saves. */
enum {
    FIBRAD_SURFACE_NO_HORIZON = 2, /* visit nodes that cannot see the other sphere too */
    FIBRAD_SURFACE_NO_REGION = 4,  /* test rays against obstacles that they cannot meet too */
    FIBRAD_SURFACE_NO_EXACT = 8,   /* integrate also if no obstacle is in between */
    FIBRAD_SURFACE_NO_HIDDEN = 16  /* test each ray also if one obstacle hides the whole sphere */
};

/* Spheres in arrays on 64-byte boundaries, which can be read up to a multiple of 8. */
typedef struct fibrad_obstacles {
    double *x, *y, *z, *r;
    uint32_t n;
} fibrad_obstacles;

/* The transformation into the pair frame: the centre of sphere 1, the rows of the rotation times 1/r1, and 1/r1. */
typedef struct fibrad_surface_frame {
    double origin[3], x[3], y[3], z[3], scale;
} fibrad_surface_frame;

/* One pair of spheres to be integrated. */
typedef struct fibrad_surface_task {
    fibrad_surface_nodes nodes;
    double r2, d;
    uint32_t flags;             /* fibrad_surface_flags */
    fibrad_obstacles obstacles; /* in the pair frame, from the filter */
    fibrad_obstacles of_node;   /* room for the same number of obstacles */
} fibrad_surface_task;

/* Sums of tau' tau' cos cos/e^2 over the pairs of nodes. Index 0: sphere 2 as it is. Index 1: sphere 2 turned by pi. */
typedef struct fibrad_surface_sums {
    double open[2], seen[2]; /* without the obstacles, and with them */
    uint64_t rays, tests;    /* rays between nodes that face each other; ray-sphere tests */
} fibrad_surface_sums;

/* Fills task->obstacles with the spheres of `all` that reach into the space between the two spheres. Number `self`
 * is one of the two and is left out. True: one of the obstacles hides all of sphere 2. */
typedef bool fibrad_surface_filter_function(fibrad_surface_task *task, const fibrad_surface_frame *frame,
                                            const fibrad_obstacles *all, uint32_t self);

typedef void fibrad_surface_sum_function(const fibrad_surface_task *task, fibrad_surface_sums *sums);

FIBRAD_DECLARE_VERSIONS(fibrad_surface_filter_function, fibrad_surface_filter);
FIBRAD_DECLARE_VERSIONS(fibrad_surface_sum_function, fibrad_surface_sum);

#endif
