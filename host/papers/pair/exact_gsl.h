/* exact_gsl.h - the unobstructed view factor by GSL's adaptive quadrature, in two ways. SPDX-License-Identifier: MIT
 *
 * Both ways are slow (a millisecond) and independent of the kernel and of each other. `fibrad pair --check` and the
 * tests compare both with the kernel. Lengths are in the caller's unit. *f12 is the view factor from sphere 1 to sphere
 * 2. *abserr is GSL's estimate of the error of *f12. Both functions return 0 or a GSL error code (gsl_strerror);
 * outputs are set only with 0. Only one thread may call them at a time: they switch off GSL's error handler meanwhile.
 */
#ifndef EXACT_GSL_H
#define EXACT_GSL_H

/* The mean over sphere 1 of the classical factor from a plane element to a sphere, which the plane may cut. gap >= 0.
 */
int exact_gsl_polar(double r1, double r2, double gap, double *f12, double *abserr);

/* The mean over all directions of the area common to both shadow discs. gap > -2 min(r1, r2). */
int exact_gsl_lens(double r1, double r2, double gap, double *f12, double *abserr);

#endif
