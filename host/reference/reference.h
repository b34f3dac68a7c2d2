/* reference.h - view factors of blocked scenes by adaptive quadrature, slow and accurate. SPDX-License-Identifier: MIT
 *
 * The directional form, S_ij = (1/pi) integral of the visible area of j in i's window over all directions, with visible
 * areas by exact slicing and adaptive cubature over the directions: neither shares anything with the kernel's beams.
 * Tests and benches measure the kernel by it; `fibrad pair` takes it for pairs with obstacles.
 *
 * Space is open; a periodic image is a sphere of its own. Spheres ahead of i are ordered front to back by the depth of
 * their centres; overlapping ones are taken as they are, but make the integrand jump: tolerances below 1e-5 then cost
 * ten times the directions per digit, except in a pair for the overlap of the two. All lengths in one unit, whichever.
 * Errors: a reference_status. Threads: any number of calls at once. Memory: 8 n^2
 * bytes and some: leave out beforehand what is out of reach of i, beyond a few thousand. */
#ifndef REFERENCE_H
#define REFERENCE_H

#include <stdint.h>

#include "fibrad.h"

enum reference_status {
    REFERENCE_OK = 0,
    REFERENCE_ARGUMENT = 1,   /* an index out of range, spheres i and j one inside the other, or equal centres */
    REFERENCE_MEMORY = 2,     /* malloc returned NULL */
    REFERENCE_UNCONVERGED = 3 /* max_evaluations reached: the outputs are set, and `error` tells how good they are */
};

/* Effort and outcome of a computation. */
struct reference_rule {
    double tolerance;         /* row: of each F; pair: of F over the unobstructed F */
    uint64_t max_evaluations; /* directions, each 2 to 50 microseconds */
};

struct reference_report {
    double error;         /* estimated, as `tolerance` is meant; seldom exceeded, often ten times too large */
    uint64_t evaluations; /* directions taken */
};

/* All F from sphere i: f[j] for j [0, n), 0 where nothing is seen, and the fraction that meets no sphere, measured as
 * uncovered area. 1e-6 takes some 10^4 to 10^5 directions, each further digit about 2.5 times as many or more. */
int reference_row(const fibrad_spheres *spheres, uint32_t i, const struct reference_rule *rule, double *f,
                  double *escaped, struct reference_report *report);

/* F from sphere i to sphere j, all others being obstacles: polar coordinates about the line of centres, in which the
 * unobstructed part is smooth, over the directions in which the two discs overlap. */
int reference_pair(const fibrad_spheres *spheres, uint32_t i, uint32_t j, const struct reference_rule *rule, double *f,
                   struct reference_report *report);

/* Visible areas in one window, the unit disc about the origin: area[k] of the disc of centre (u[k], v[k]) and radius
 * r[k], nearest first, and the rest that stays open. By exact slicing, error some 1e-15 times the largest radius. */
int reference_window(uint32_t n, const double *u, const double *v, const double *r, double *area, double *rest);

#endif
