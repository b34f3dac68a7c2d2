/* beam_lanes.h - beam rows, one version per instruction set. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_BEAM_LANES_H
#define FIBRAD_ROW_BEAM_LANES_H

#include "base/dispatch.h"
#include "row/row.h"

/* Which windows to compute, [from, to), and where results go. Or the parts that make up the row. */
typedef struct fibrad_beam_range {
    uint32_t from, to;
    fibrad_row_part *kept;       /* where the sums go; NULL: results go into the row */
    const fibrad_row_part *part; /* [parts] */
    uint32_t parts;
    bool exact; /* pairs that nothing can come between have exact factors */
} fibrad_beam_range;

/* Sums over the windows of a row so far. */
typedef struct fibrad_beam_sums {
    double open[2];  /* what meets nothing in even and in odd windows */
    double whole[2]; /* sizes of even and of odd windows, in points of masks or as areas */
    double seen;     /* number of spheres that windows have seen, by masks */
} fibrad_beam_sums;

/* Keeps all sums over the windows of a part. Sets part->used. Errors: _CAPACITY, _MEMORY. */
int fibrad_beam_keep(const fibrad_workspace *work, const fibrad_beam_sums *sums, fibrad_row_part *part);

/* Adds the sums that a part has kept to those of the present row. */
void fibrad_beam_add_kept(fibrad_workspace *work, const fibrad_row_part *part, fibrad_beam_sums *sums);

/* Row i by a beam rule that has been completed and checked, into a row with walls. The factors to walls are also
 * left in space->wall by slot. Errors: _TABLE, _CAPACITY, _WORK. */
typedef int fibrad_beam_function(const fibrad_scene *scene, fibrad_workspace *work, uint32_t i,
                                 const fibrad_beam_rule *rule, const fibrad_beam_range *range, fibrad_row *row);
FIBRAD_DECLARE_VERSIONS(fibrad_beam_function, fibrad_beam_lanes);

#endif
