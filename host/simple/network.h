/* network.h - radiation by exchange factors, as a network of conductances. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_NETWORK_H
#define FIBRAD_SIMPLE_NETWORK_H

#include "simple/team.h"

typedef struct fibrad_network fibrad_network;

/* Makes a network of exchange factors of spheres. emissivity, area [n]: of the spheres. The network owns the factors
 * and frees them. After an error the caller still owns the factors. Errors: _MEMORY. */
int fibrad_network_new(fibrad_network **network, fibrad_bed_matrix *factors, const double *emissivity,
                       const double *area);
void fibrad_network_free(fibrad_network *network);

/* Finds powers and temperatures like fibrad_bed_solve. All walls have temperatures in `sources`; their powers are
 * those from spheres alone. Spheres of unknown temperature have storage > 0 and a reference. allowed [n]: power that
 * each sphere may miss. Errors: _UNSOLVABLE: a temperature is below 0 K, or the iteration does not converge; the result
 * is written then, too. */
int fibrad_network_solve(fibrad_network *network, fibrad_team *team, const fibrad_heat_sources *sources,
                         const double *allowed, fibrad_heat_result *result);

#endif
