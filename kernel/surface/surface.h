/* surface.h - the surface method between pairs and rows. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SURFACE_SURFACE_H
#define FIBRAD_SURFACE_SURFACE_H

#include "surface/surface_lanes.h"

/* The laned functions of one instruction set. */
typedef struct fibrad_surface_lanes {
    fibrad_surface_filter_function *filter;
    fibrad_surface_sum_function *sum;
} fibrad_surface_lanes;

/* Those of an instruction set of this build. Whether the machine has it is not asked. */
fibrad_surface_lanes fibrad_surface_lanes_of(int isa);

/* The nodes of a rule, its default number included. FIBRAD_E_ARGUMENT for unknown flags, _TABLE. */
int fibrad_surface_nodes_of(const fibrad_surface_rule *rule, fibrad_surface_nodes *nodes);

/* F12 by the rule of the task (nodes, flags), whose lists of obstacles have room for all of `all`; the rest as
 * fibrad_surface_filter has it. */
int fibrad_surface_factor(fibrad_surface_task *task, fibrad_surface_lanes lanes, double r1, double r2, double gap,
                          const fibrad_surface_frame *frame, const fibrad_obstacles *all, uint32_t self, double *f12,
                          fibrad_surface_facts *facts);

#endif
