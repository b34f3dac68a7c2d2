/* exchange_rows.h - exchange factors and their reach for a whole bed. SPDX-License-Identifier: MIT */
#ifndef EXCHANGE_ROWS_H
#define EXCHANGE_ROWS_H

#include "compute/rows.h"

/* Exchange factors of all spheres by fibrad_exchange_row, in result->rows.f, result->wall and result->escaped.
 * options->method is not looked at. Unless options->raw, rows are averaged such that A_i e_i D_ij = A_j e_j D_ji and
 * then balanced such that they close with what walls and surroundings take in the raw rows; rule->error is meant for
 * the rows as they are in the end. Entries below `drop` (0: none) are then given back to the others. rays: how many
 * were traced. Status as run_rows. */
int run_exchange(const struct bed *bed, const struct run_options *options, const fibrad_exchange_rule *rule,
                 double drop, struct result *result, uint64_t *rays);

/* fibrad_exchange_spread of all spheres for which options->wanted says so, into spread [n]; the rest of the result,
 * whose rows are empty, tells of threads, seconds and the scene. Status as run_rows. */
int run_spread(const struct bed *bed, const struct run_options *options, const fibrad_exchange_rule *rule,
               fibrad_spread *spread, struct result *result);

#endif
