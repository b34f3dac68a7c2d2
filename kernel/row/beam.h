/* beam.h - beam rows for other methods. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_BEAM_H
#define FIBRAD_ROW_BEAM_H

#include "row/row.h"

/* Completes and checks a rule. given NULL: all defaults. Errors: _ARGUMENT. */
int fibrad_beam_complete(const fibrad_beam_rule *given, fibrad_beam_rule *rule);

/* Row i by a completed rule, without regard to the tolerance. This is the method of fibrad_beam_row. exact: pairs that
 * nothing can come between have exact factors. */
int fibrad_beam_compute(const fibrad_scene *scene, fibrad_workspace *space, uint32_t i, const fibrad_beam_rule *rule,
                        bool exact, fibrad_row *row);

#endif
