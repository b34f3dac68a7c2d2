/* cast_lanes.h - rows by rays, one version per instruction set. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_RAY_CAST_LANES_H
#define FIBRAD_RAY_CAST_LANES_H

#include "row/work.h"

/* fibrad_cast_row with arguments that have been checked and defaults filled in. */
typedef int fibrad_cast_function(const fibrad_scene *scene, fibrad_workspace *work, uint32_t i,
                                 const fibrad_cast_rule *rule, fibrad_row *row, const fibrad_cast_means *means);

fibrad_cast_function fibrad_cast_row_scalar, fibrad_cast_row_sse2, fibrad_cast_row_avx2, fibrad_cast_row_avx512;

#endif
