/* discs_lanes.h - the discs that may be seen from a circle. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SILHOUETTE_DISCS_LANES_H
#define FIBRAD_SILHOUETTE_DISCS_LANES_H

#include "base/lanes/laned.h"
#include "silhouette/circle.h"

/* The place where more discs may be added. It leaves whole vectors of each instruction set. */
static inline uint32_t fibrad_discs_end(const fibrad_circle_side *side) {
    return (side->last + FIBRAD_LANES_MAX - 1) / FIBRAD_LANES_MAX * FIBRAD_LANES_MAX;
}

/* Adds near spheres to those of a side. There must be room, and a vector of places must follow. */
void LANED(fibrad_discs_add)(const fibrad_circles *c, fibrad_circle_side *side, const uint32_t *place, uint32_t count);

/* Removes discs that touch no sector. */
void LANED(fibrad_discs_leave_touching)(fibrad_circle_side *side);

/* Finds whether the known discs of a side certainly leave nothing open, or certainly leave something open. */
void LANED(fibrad_discs_judge)(fibrad_circle_side *side);

/* Finds the discs of a side that may be seen, c->seen[number], with their arcs, in the order of their depths. Left out
 * are the discs whose sectors nearer discs cover. */
void LANED(fibrad_discs_see)(const fibrad_workspace *work, fibrad_circles *c, uint32_t number);

#endif
