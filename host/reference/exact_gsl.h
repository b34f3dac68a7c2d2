/* exact_gsl.h - the unobstructed view factor by GSL's adaptive quadrature, two ways. SPDX-License-Identifier: MIT
 *
 * Slow (a millisecond) and independent of the kernel and of each other: `fibrad pair --check` and the tests compare.
 * Lengths in the caller's unit; *f12 is the view factor from sphere 1 to sphere 2, *abserr GSL's estimate of its error.
 * Both return 0 or a GSL error code (gsl_strerror); outputs are set only if 0. Not for several threads at once: GSL's
 * error handler is switched off meanwhile. */
#ifndef EXACT_GSL_H
#define EXACT_GSL_H

/* The mean over sphere 1 of the classical factor from a plane element to a sphere, a whole or a cut one. gap >= 0. */
int exact_gsl_polar(double r1, double r2, double gap, double *f12, double *abserr);

/* The mean over all directions of the area common to the two shadow discs. gap > -2 min(r1, r2). */
int exact_gsl_lens(double r1, double r2, double gap, double *f12, double *abserr);

#endif
