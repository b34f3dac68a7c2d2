/* exact_gsl.h - the unobstructed view factor by GSL's adaptive quadrature. SPDX-License-Identifier: MIT */
#ifndef EXACT_GSL_H
#define EXACT_GSL_H

/* The mean over all directions of the area common to both shadow discs. gap > -2 min(r1, r2). Slow (a millisecond) and
 * independent of the kernel; `fibrad pair --check` and the tests compare both. Lengths are in the caller's unit. *f12
 * is the view factor from sphere 1 to sphere 2, *abserr GSL's estimate of its error. Returns 0 or a GSL error code
 * (gsl_strerror); outputs are set only with 0. Only one thread may call it at a time: it switches off GSL's error
 * handler meanwhile. */
int exact_gsl_lens(double r1, double r2, double gap, double *f12, double *abserr);

#endif
