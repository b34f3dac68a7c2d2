/* reference.h - view factors of blocked scenes by adaptive quadrature, slow and accurate. SPDX-License-Identifier: MIT
 *
 * The view factor is (1/pi) times the integral over all directions of the visible area of j in the window of i. Visible
 * areas come from exact slicing, the integral from adaptive cubature. Neither shares anything with the kernel's beams.
 * Tests and benches compare the kernel with this reference. `fibrad pair` uses it for pairs with obstacles.
 *
 * Space is open; a periodic image is a sphere of its own. Spheres are ordered front to back by the depth of their
 * centres. Spheres may overlap. The integrand then jumps, and each digit below a tolerance of 1e-5 takes ten times as
 * many directions. An overlap of the two spheres of a pair does no harm.
 *
 * Units     all lengths in one unit
 * Errors    a reference_status
 * Threads   any number of calls at once
 * Memory    about 8 n^2 bytes: of more than some thousand spheres leave out those that i cannot see */
#ifndef REFERENCE_H
#define REFERENCE_H

#include "fibrad.h"

enum reference_status {
    REFERENCE_OK = 0,
    REFERENCE_ARGUMENT = 1,   /* an index is out of range, sphere i or j lies inside the other, or centres are equal */
    REFERENCE_MEMORY = 2,     /* malloc returned NULL */
    REFERENCE_UNCONVERGED = 3 /* max_evaluations was reached; outputs are set with the error in the report */
};

/* The effort of a computation. */
struct reference_rule {
    double tolerance;         /* error allowed; row: in each F; pair: in F over the unobstructed F */
    uint64_t max_evaluations; /* largest number of directions; each takes 2 to 50 microseconds */
};

/* The outcome of a computation. */
struct reference_report {
    double error;         /* estimated, as `tolerance`; the true error is seldom larger and often ten times smaller */
    uint64_t evaluations; /* number of directions */
};

/* All view factors from sphere i, f[n], and the fraction that meets no sphere, measured as open area. A tolerance of
 * 1e-6 takes some 10^4 to 10^5 directions, each further digit at least 2.5 times as many. */
int reference_row(const fibrad_spheres *spheres, uint32_t i, const struct reference_rule *rule, double *f,
                  double *escaped, struct reference_report *report);

/* The view factor from sphere i to sphere j; all other spheres are obstacles. The integral is over the directions in
 * which both discs overlap, in polar coordinates about the line of centres. In these the unobstructed part is smooth.
 */
int reference_pair(const fibrad_spheres *spheres, uint32_t i, uint32_t j, const struct reference_rule *rule, double *f,
                   struct reference_report *report);

/* Visible areas in one window, the unit disc about the origin. area[k]: of the disc of centre (u[k], v[k]) and radius
 * r[k]; discs are in the order front to back. rest: the open area. The method is exact slicing, with an error of some
 * 1e-15 times the largest radius. */
int reference_window(uint32_t n, const double *u, const double *v, const double *r, double *area, double *rest);

#endif
