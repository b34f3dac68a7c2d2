/* beam.h - beam rows, one version per instruction set, and for other methods. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_BEAM_H
#define FIBRAD_ROW_BEAM_H

#include "row/row.h"

/* Completes and checks a rule. given NULL: all defaults. Errors: _ARGUMENT. */
int fibrad_beam_complete(const fibrad_beam_rule *given, fibrad_beam_rule *rule);

/* Row i by a completed rule, without regard to the tolerance. This is the method of fibrad_beam_row. exact: pairs that
 * nothing can come between have exact factors. */
int fibrad_beam_compute(const fibrad_scene *scene, fibrad_workspace *space, uint32_t i, const fibrad_beam_rule *rule,
                        bool exact, fibrad_row *row);

/* Row i by a beam rule that has been completed and checked, into a row with walls. The factors to walls are also
 * left in space->wall by slot. exact: pairs that nothing can come between have exact factors. Errors: _TABLE,
 * _CAPACITY, _WORK. */
typedef int fibrad_beam_function(const fibrad_scene *scene, fibrad_workspace *work, uint32_t i,
                                 const fibrad_beam_rule *rule, bool exact, fibrad_row *row);
FIBRAD_DECLARE_VERSIONS(fibrad_beam_function, fibrad_beam_lanes);

#endif
