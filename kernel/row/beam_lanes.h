/* beam_lanes.h - beam rows, one version per instruction set. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_BEAM_LANES_H
#define FIBRAD_ROW_BEAM_LANES_H

#include "base/dispatch.h"
#include "row/row.h"

/* Which windows to compute, [from, to), and where results go: into the row, or as terms into a list. With parts, the
 * row is made from the lists of all parts and no window is computed. */
typedef struct fibrad_beam_range {
    uint32_t from, to;
    fibrad_addends *addends;     /* NULL: results go into the row */
    const fibrad_row_part *part; /* [parts]; NULL: windows are computed */
    uint32_t parts;
    bool exact; /* pairs that nothing can come between have exact factors */
} fibrad_beam_range;

/* Sums over the windows of a row so far. */
typedef struct fibrad_beam_sums {
    double open[2];  /* what meets nothing in even and in odd windows */
    double whole[2]; /* sizes of even and of odd windows, in points of masks or as areas */
} fibrad_beam_sums;

/* Adds the terms that the parts have listed to the sums of the present row. last: the number of the last window, if the
 * first and the last one count half in differences of even and odd windows. Else 0. */
void fibrad_beam_replay(fibrad_workspace *work, const fibrad_beam_range *range, uint32_t last, fibrad_beam_sums *sums);

/* Row i by a beam rule that has been completed and checked, into a row with walls. The factors to walls are also
 * left in space->wall by slot. Errors: _TABLE, _CAPACITY, _WORK. */
typedef int fibrad_beam_function(const fibrad_scene *scene, fibrad_workspace *work, uint32_t i,
                                 const fibrad_beam_rule *rule, const fibrad_beam_range *range, fibrad_row *row);
FIBRAD_DECLARE_VERSIONS(fibrad_beam_function, fibrad_beam_lanes);

#endif
