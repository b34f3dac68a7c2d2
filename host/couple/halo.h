/* halo.h - particles of other ranks, and images, near those of this rank. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_HALO_H
#define FIBRAD_COUPLE_HALO_H

#include "couple/collective.h"

/* A particle as it is sent: 6 words, so that coordinates are strided doubles. */
typedef struct fibrad_particle {
    uint64_t id;
    double x[3], radius, emissivity; /* [L] */
} fibrad_particle;

/* Collective. Appends to particle[own] those of all ranks, this one included, and their periodic images that lie within
 * `reach` of the box of the centres of particle[own], in an order that depends on who owns what. The image of a
 * particle has the coordinates x + s period, s being integers, whoever owns it. period[.] 0: open. sent: scratch.
 * *halo: how many were appended. Errors, on all ranks: _MEMORY. Cost: own particles times neighbours. */
int fibrad_halo(MPI_Comm comm, const double period[3], double reach, fibrad_block *particle, size_t own,
                fibrad_block *sent, size_t *halo);

#endif
