/* network.h - radiation by exchange factors, as a network of conductances. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_NETWORK_H
#define FIBRAD_SIMPLE_NETWORK_H

#include "simple/team.h"

typedef struct fibrad_network fibrad_network;

/* Takes the exchange factors D of spheres of these emissivities and areas [n], and frees them with itself; after an
 * error they are still the caller's. Errors: _MEMORY. */
int fibrad_network_new(fibrad_network **network, fibrad_bed_factors *factors, const double *emissivity,
                       const double *area);
void fibrad_network_free(fibrad_network *network);

/* Powers and temperatures as fibrad_radiation_solve has them, of sources whose walls all have temperatures; walls gain
 * from spheres alone. Spheres of unknown temperature have a hold > 0 and a reference. allowed: [n] what may be missing
 * of the power of each. Errors: _UNSOLVABLE: below zero, or no end; then all is written. */
int fibrad_network_solve(fibrad_network *network, fibrad_team *team, const fibrad_heat_sources *sources,
                         const double *allowed, fibrad_heat_result *result);

#endif
