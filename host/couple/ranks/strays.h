/* strays.h - particles with which a simulation goes on, but of which no scene can be made as they are: those beyond
 * walls, and those whose centre lies inside another. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_STRAYS_H
#define FIBRAD_COUPLE_STRAYS_H

#include <stdbool.h>

#include "couple/ranks/halo.h"

/* The walls and openings around a bed, the same on all ranks. The place of each opening is known. */
typedef struct fibrad_bounds {
    const fibrad_wall *wall;     /* [walls] */
    const fibrad_plane *opening; /* [openings] */
    uint32_t walls, openings;
    int cylinder; /* as in fibrad_insitu_bed */
} fibrad_bounds;

/* What happened to some particles of a bed: their number, and a sentence about the one with the least id. */
typedef struct fibrad_remark {
    uint64_t count, id;
    char message[FIBRAD_MESSAGE];
} fibrad_remark;

/* Whether a particle lies within the bounds: its centre inside all planes and the cylinder, all of it before all
 * openings. If not, message[FIBRAD_MESSAGE] gets a sentence with its id, its place and the wall, and *opening tells
 * whether an opening is at fault. */
bool fibrad_bounds_hold(const fibrad_bounds *bounds, const fibrad_particle *particle, bool *opening, char *message);

/* Counts a particle, and keeps the sentence if no particle of a lower id was counted before. */
void fibrad_remark_add(fibrad_remark *remark, uint64_t id, const char *message);

/* Collective. Makes the remark that of all ranks together. */
void fibrad_remark_agree(MPI_Comm comm, fibrad_remark *remark);

/* For each of the first `own` particles finds to what part its radius must be reduced so that no centre lies inside
 * another particle: part[i] is 1, or else the least d/max(r_i, r_j) of all particles j at a distance d < max(r_i, r_j).
 * With radii reduced so, each centre lies on the other surface or outside. All particles within the largest radius of
 * own ones must be among particle[all]. Images of a particle do not count as others. remark: own particles with a part
 * below 1; after an error a sentence. Errors: _GEOMETRY: particles have tens of centres inside; _MEMORY. */
int fibrad_overlaps(const fibrad_particle *particle, size_t own, size_t all, double *part, fibrad_remark *remark);

#endif
