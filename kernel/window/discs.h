/* discs.h - the discs before a window. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WINDOW_DISCS_H
#define FIBRAD_WINDOW_DISCS_H

#include "base/port.h"

#define FIBRAD_LANES_MAX 16 /* at the end of a list whole vectors are written */

/* Discs before the current window. A disc is the projection of a sphere along the direction. u and v: its centre. */
typedef struct fibrad_discs {
    double *depth, *u, *v, *r; /* [capacity + FIBRAD_LANES_MAX]; the depth becomes -1 when the disc has been used */
    double *resolved;          /* [same] the depth of discs that have been used */
    float *fu, *fv, *square;   /* [same] position and r^2 for points */
    float *fdepth;             /* [same] depth, by which discs are sorted */
    uint32_t *near;            /* [same, and room for all near spheres] index in the near list */
    uint32_t *order;           /* [same] the first disc, the second ... from front to back */
    uint32_t *hidden_points;   /* [same] number of points that the first disc, the second ... hides; with masks: that
                                  disc 0, disc 1 ... hides */
    uint32_t *occluder;        /* [same] which of them hide points */
    uint64_t *key[2];          /* [same] scratch of the sort by depth */
    uint32_t capacity;
    uint32_t count; /* may exceed the capacity */
} fibrad_discs;

#endif
