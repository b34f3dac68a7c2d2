/* tolerance.h - as many directions as a stated error takes. SPDX-License-Identifier: MIT */
#ifndef TOLERANCE_H
#define TOLERANCE_H

#include "compute/rows.h"

/* run_rows by the beam method, `rule` without its directions, such that no row's estimated Euclidean error is above
 * `error` > 0, or FIBRAD_DIRECTIONS_MAX directions are taken; result->error_estimate tells. Raw rows take what each of
 * them needs. Rows to be averaged take one number of directions, for only then are their sums at most 1: that which
 * the worst rows of a pilot need, and more if the estimates then turn out too large. options->method is not looked at.
 */
int tolerance_rows(const struct bed *bed, const struct run_options *options, const fibrad_beam_rule *rule, double error,
                   struct result *result);

#endif
