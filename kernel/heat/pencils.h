/* pencils.h - how the beams of a sphere are kept. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_HEAT_PENCILS_H
#define FIBRAD_HEAT_PENCILS_H

#include "heat/problem.h"

/* Beams that are kept: the entry of the row they belong to, the patch they leave, and the one they meet of that body.
 */
typedef struct fibrad_heat_beam {
    uint32_t entry;
    uint16_t from, to;
} fibrad_heat_beam;

/* Bytes for the pencils of all spheres and the links: enough for most beds. */
size_t fibrad_heat_room(const fibrad_heat *heat);

/* Bytes of work->extra that a row takes: first come the beams, as many as a sphere has at the most. */
size_t fibrad_heat_scratch(const fibrad_heat *heat);

/* Keeps the `count` beams there of the row in `work`, one at least of each of its entries. FIBRAD_E_SIZE: there is no
 * room. */
int fibrad_heat_keep(fibrad_heat *heat, const fibrad_workspace *work, uint32_t place, uint32_t count);

/* Lists for each sphere the pencils of other parts that end on it. */
void fibrad_heat_link_pencils(fibrad_heat *heat);

#endif
