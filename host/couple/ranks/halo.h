/* halo.h - particles of other ranks and periodic images near the particles of this rank.
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_HALO_H
#define FIBRAD_COUPLE_HALO_H

#include <stdbool.h>

#include "couple/ranks/collective.h"

/* Where a rank has a particle: the rank, and the index there. */
typedef struct fibrad_place {
    uint32_t rank, index;
} fibrad_place;

/* A particle in a message. It consists of words alone, so that coordinates are doubles with a stride. */
typedef struct fibrad_particle {
    uint64_t id;
    double x[3], radius;             /* [L] */
    double emissivity, conductivity; /* k*; of contacts: power/(L K) */
    union {
        double node;        /* the emissivity of the node, fibrad_node_emissivity */
        double temperature; /* K, of contacts */
    };
    fibrad_place owner; /* set by fibrad_halo and fibrad_gather: where its owner has it */
} fibrad_particle;

/* Particles as spheres. id: out, [n]; NULL: they get no ids */
static inline fibrad_spheres fibrad_particle_spheres(const fibrad_particle *p, size_t n, uint64_t *id) {
    const uint32_t stride = sizeof *p / sizeof(double);
    for (size_t i = 0; i < n && id; ++i) id[i] = p[i].id;
    return (fibrad_spheres){&p->x[0], &p->x[1], &p->x[2], &p->radius, (uint32_t)n, stride, stride, id};
}

/* Collective. Appends to particle[own] the particles of other ranks, and the periodic images of particles of all ranks,
 * within `reach` of the box of the centres of particle[own]. Their order depends on who owns which particle. An image
 * has the coordinates x + s period with integers s, whoever owns the particle. once: no images are appended, but each
 * particle of another rank that is within reach, or has an image there. period 0: the axis is open. sent: scratch.
 * *halo: number appended. Errors, on all ranks: _MEMORY. Cost: own particles times neighbouring ranks. */
int fibrad_halo(MPI_Comm comm, const double period[3], double reach, bool once, fibrad_block *particle, size_t own,
                fibrad_block *sent, size_t *halo);

/* Collective. Appends to particle[own] all particles of other ranks, in the order of ranks. No image is appended.
 * *others: number appended; *first: number of those of lower ranks. Errors, on all ranks: _MEMORY. */
int fibrad_gather(MPI_Comm comm, fibrad_block *particle, size_t own, size_t *others, size_t *first);

#endif
