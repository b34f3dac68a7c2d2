/* errors.h - what errors the powers of a solution may have. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_HEAT_ERRORS_H
#define FIBRAD_HEAT_ERRORS_H

#include "heat/problem.h"

/* Estimated error that patches leave in what extrapolation to patches without size has changed by `change` from the
 * coarser level to the finer one. */
double fibrad_heat_patch_error(const fibrad_heat *heat, double change);

/* Estimated error of what body b absorbs, from the halves of its beams and rays. */
double fibrad_heat_beam_error(const fibrad_heat *heat, uint32_t b);

/* Estimated errors of all powers: result->power_error, body_error, error_patches and error_beams. */
void fibrad_heat_read_errors(const fibrad_heat *heat, fibrad_heat_result *result);

#endif
