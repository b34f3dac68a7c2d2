/* surface.h - what pairs and rows by the surface method share. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SURFACE_SURFACE_H
#define FIBRAD_SURFACE_SURFACE_H

#include "surface/surface_lanes.h"

/* The laned functions of one instruction set. */
typedef struct fibrad_surface_lanes {
    fibrad_surface_filter_function *filter;
    fibrad_surface_sum_function *sum;
} fibrad_surface_lanes;

/* The functions of an instruction set of this build. The machine is not checked. */
fibrad_surface_lanes fibrad_surface_lanes_of(int isa);

/* The nodes of a rule. nodes 0 in the rule: the default number. Errors: FIBRAD_E_ARGUMENT: unknown flags. _TABLE. */
int fibrad_surface_nodes_of(const fibrad_surface_rule *rule, fibrad_surface_nodes *nodes);

/* F12 by the nodes and flags of the task. Its lists of obstacles must have room for all obstacles of `all`. The
 * other arguments are as for fibrad_surface_filter. */
int fibrad_surface_factor(fibrad_surface_task *task, fibrad_surface_lanes lanes, double r1, double r2, double gap,
                          const fibrad_surface_frame *frame, const fibrad_obstacles *all, uint32_t self, double *f12,
                          fibrad_surface_facts *facts);

#endif
