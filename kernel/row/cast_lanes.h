/* cast_lanes.h - rows by rays, one version per instruction set. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_CAST_LANES_H
#define FIBRAD_ROW_CAST_LANES_H

#include "row/row.h"

/* A completed rule, and the place for the means. NULL: no means are wanted. */
typedef struct fibrad_cast_task {
    fibrad_cast_rule rule;
    const fibrad_cast_means *means;
} fibrad_cast_task;

/* Row i by rays. Errors: _CAPACITY, _WORK. */
typedef int fibrad_cast_function(const fibrad_scene *scene, fibrad_workspace *work, uint32_t i,
                                 const fibrad_cast_task *task, fibrad_row *row);
FIBRAD_DECLARE_VERSIONS(fibrad_cast_function, fibrad_cast_lanes);

#endif
