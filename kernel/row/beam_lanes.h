/* beam_lanes.h - beam rows, one version per instruction set. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_BEAM_LANES_H
#define FIBRAD_ROW_BEAM_LANES_H

#include "base/dispatch.h"
#include "row/row.h"

/* Windows [from, to) of a row: into the row; or what they add to its sums into a list; or a row of all windows from the
 * lists of its parts. */
typedef struct fibrad_beam_range {
    uint32_t from, to;
    fibrad_addends *addends;     /* NULL: the row */
    const fibrad_row_part *part; /* [parts] NULL: windows are resolved */
    uint32_t parts;
} fibrad_beam_range;

/* Adds to the row in hand what its parts have listed. */
void fibrad_beam_replay(fibrad_workspace *work, const fibrad_beam_range *range, uint32_t windows, double open[2]);

/* Row i by a beam rule whose numbers have been completed and checked, into a row with bodies. The factors to walls are
 * left in space->wall by slot, too. Errors: _TABLE, _CAPACITY, _WORK. */
typedef int fibrad_beam_function(const fibrad_scene *scene, fibrad_workspace *work, uint32_t i,
                                 const fibrad_beam_rule *rule, const fibrad_beam_range *range, fibrad_row *row);
FIBRAD_DECLARE_VERSIONS(fibrad_beam_function, fibrad_beam_lanes);

#endif
