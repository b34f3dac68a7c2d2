/* discs.h - the discs before a window. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WINDOW_DISCS_H
#define FIBRAD_WINDOW_DISCS_H

#include "base/port.h"

#define FIBRAD_LANES_MAX 16 /* whole vectors are written at the end of a list */

/* Discs before the current window: the shadows of spheres, u and v being their centres across the direction. */
typedef struct fibrad_discs {
    double *depth, *u, *v, *r; /* [capacity + FIBRAD_LANES_MAX]; the depth is -1 once a disc is resolved, ... */
    double *resolved;          /* [same] ... and then stands here */
    float *fu, *fv, *square;   /* [same] position and r^2 for points */
    uint32_t *near;            /* [same, and room for all near spheres] position in the near list */
    uint32_t *order;           /* [same] which is the first, the second ... from front to back */
    uint32_t *hidden_points;   /* [same] number of points that the first, the second ... hides */
    uint32_t *occluder;        /* [same] which of them hide any */
    uint64_t *key[2];          /* [same] scratch of the sort by depth */
    uint32_t capacity;
    uint32_t count; /* may exceed the capacity */
} fibrad_discs;

#endif
