/* pencils.h - how the beams of a sphere are kept. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_PATCHES_PENCILS_H
#define FIBRAD_PATCHES_PENCILS_H

#include "patches/problem.h"

/* A beam that is kept: the entry of the row that it belongs to, the patch that it leaves, and the patch that it meets.
 * Patches are numbered within their row or block. */
typedef struct fibrad_heat_beam {
    uint32_t entry;
    uint16_t from, to;
} fibrad_heat_beam;

/* Bytes for the pencils of all rows and the links. They suffice for most beds. */
size_t fibrad_heat_room(const fibrad_heat *heat);

/* Bytes of work->extra that a row takes. The beams of the row come first. */
size_t fibrad_heat_scratch(const fibrad_heat *heat);

/* Scales the beams to spheres that nothing can come between, so that their sum is exact, and those to all that is no
 * sphere by the opposite. A sphere that no beam meets gets one along the line of centres. Returns the number of beams
 * in work->extra, of which there were `count`. Entries that find no room are counted in entries.missed. */
uint32_t fibrad_heat_free_beams(fibrad_heat *heat, fibrad_workspace *work, uint32_t count);

/* Writes the pencils of the row in `work` from the `count` beams in work->extra. Each entry must have a beam at least.
 * FIBRAD_E_SIZE: there is no room. */
int fibrad_heat_keep(fibrad_heat *heat, const fibrad_workspace *work, uint32_t place, uint32_t count);

/* Lists for each row the pencils of other parts that end on it. */
void fibrad_heat_link_pencils(fibrad_heat *heat);

#endif
