/* circle_lanes.h - follows the circles of one sphere. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SILHOUETTE_CIRCLE_LANES_H
#define FIBRAD_SILHOUETTE_CIRCLE_LANES_H

#include "base/dispatch.h"
#include "base/lanes/laned.h"
#include "silhouette/circle.h"

/* The shell is so deep that nine circles of ten in a dense bed need no more. Walks go twice as deep each time. */
#define FIBRAD_CIRCLE_STRIDE ((fibrad_stride){4.4, 2})

/* Adds to a table what the circles of a sphere give along lines [*from, to). The sphere is given by its position in
 * scene order. *from becomes the line at which the table was full, or `to`. After an error the table is of no use.
 * Errors: FIBRAD_E_WORK (work->needed is set), FIBRAD_E_UNSUPPORTED (a circle touches too many discs). */
typedef int fibrad_circle_function(fibrad_workspace *work, fibrad_circles *c, uint32_t place, const fibrad_line *line,
                                   uint32_t *from, uint32_t to, fibrad_pair_table *table);
FIBRAD_DECLARE_VERSIONS(fibrad_circle_function, fibrad_circle_lines);

#endif
