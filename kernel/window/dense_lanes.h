/* dense_lanes.h - visible areas where many arcs bound the open region, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WINDOW_DENSE_LANES_H
#define FIBRAD_WINDOW_DENSE_LANES_H

#include "base/lanes/laned.h"
#include "window/areas.h"

/* Begins a window of which the radii of `count` discs are known, from front to back: which[0], which[1] ... */
void LANED(fibrad_dense_begin)(fibrad_areas *areas, const uint32_t *which, uint32_t count, const double *r);

/* Resolves the window anew, up to its first `circles` circles. False: it is degenerate. Nothing is open any more once
 * areas->dense.live is 0; areas->overflow: there is no room. */
bool LANED(fibrad_dense_resolve)(fibrad_areas *areas, uint32_t circles);

/* Hides what the disc of circle areas->circles covers, which has been written there. False: degenerate. */
bool LANED(fibrad_dense_hide)(fibrad_areas *areas);

/* Adds what is still open to the pieces, as hidden by a circle `rest`. */
void LANED(fibrad_dense_rest)(fibrad_areas *areas, uint32_t rest);

#endif
