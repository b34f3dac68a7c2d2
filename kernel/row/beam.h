/* beam.h - the windows of a beam rule. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_BEAM_H
#define FIBRAD_ROW_BEAM_H

#include "base/port.h"

/* The axes of window k of a rule: two unit vectors across its direction, and the direction. points: 0 for exact areas.
 */
void fibrad_beam_frame(uint32_t k, uint32_t directions, uint32_t points, double frame[9]);

#endif
