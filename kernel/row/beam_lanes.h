/* beam_lanes.h - beam rows, one version per instruction set. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_BEAM_LANES_H
#define FIBRAD_ROW_BEAM_LANES_H

#include "row/work.h"

/* fibrad_beam_row with arguments that have been checked. points: 0 for exact areas. */
typedef int fibrad_beam_function(const fibrad_scene *scene, fibrad_workspace *work, uint32_t i, uint32_t directions,
                                 uint32_t points, double cutoff, fibrad_row *row);

fibrad_beam_function fibrad_beam_row_scalar, fibrad_beam_row_sse2, fibrad_beam_row_avx2, fibrad_beam_row_avx512;

#endif
