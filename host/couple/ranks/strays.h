/* strays.h - particles beyond walls, and what is said of particles of which no scene can be made as they are.
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_COUPLE_STRAYS_H
#define FIBRAD_COUPLE_STRAYS_H

#include <stdbool.h>

#include "couple/ranks/halo.h"

/* The walls and openings around a bed, the same on all ranks. The place of each opening is known. */
typedef struct fibrad_bounds {
    const fibrad_wall *wall;     /* [walls] */
    const fibrad_plane *opening; /* [openings] */
    uint32_t walls, openings;
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

#endif
