/* dense_lanes.h - visible areas if many arcs bound the open region, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WINDOW_DENSE_LANES_H
#define FIBRAD_WINDOW_DENSE_LANES_H

#include "base/lanes/laned.h"
#include "window/areas.h"

/* Begins a window. which[0], which[1] ...: `count` discs whose radii are known, from front to back. */
void LANED(fibrad_dense_begin)(fibrad_areas *areas, const uint32_t *which, uint32_t count, const double *r);

/* Computes the window again, up to its first `circles` circles. False: the window is degenerate. When
 * areas->dense.live is 0, nothing is open. areas->overflow: there is no room. */
bool LANED(fibrad_dense_resolve)(fibrad_areas *areas, uint32_t circles);

/* Hides what the disc of circle areas->circles covers. The circle has been written. False: a decision is degenerate. */
bool LANED(fibrad_dense_hide)(fibrad_areas *areas);

/* Adds the open region to the pieces, as if a circle `rest` had hidden it. */
void LANED(fibrad_dense_rest)(fibrad_areas *areas, uint32_t rest);

#endif
