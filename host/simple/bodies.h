/* bodies.h - clumps, and spheres that are alone, as bodies with one row each. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_BODIES_H
#define FIBRAD_SIMPLE_BODIES_H

#include "simple/team.h"

/* The bodies of a bed, in the order of their first spheres. */
typedef struct fibrad_bodies {
    uint32_t n;
    uint32_t *body; /* [spheres], the body of each */
    uint32_t *start,
        *member;  /* [n + 1], [spheres]: spheres of body b are member[start[b]] to member[start[b + 1] - 1] */
    double *area; /* L^2, [n], exposed */
} fibrad_bodies;

/* Finds the bodies of the spheres of a scene. Free them with free(). Without clumps they are NULL. Errors: _MEMORY. */
int fibrad_bodies_find(const fibrad_scene *scene, const fibrad_spheres *spheres, fibrad_bodies **bodies);

/* Makes the rows of bodies from the rows of their spheres that the team has collected. These go. walls: their number;
 * scratch: as in fibrad_bed_rule. Errors: _MEMORY, and as fibrad_scratch_open. */
int fibrad_bodies_merge(const fibrad_bodies *bodies, const fibrad_spheres *spheres, uint32_t walls, const char *scratch,
                        fibrad_team *team);

#endif
