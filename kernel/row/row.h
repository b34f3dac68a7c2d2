/* row.h - what the methods for rows have in common: memory that grows, and where rows go. SPDX-License-Identifier: MIT
 */
#ifndef FIBRAD_ROW_ROW_H
#define FIBRAD_ROW_ROW_H

#include "work/work.h"

/* Computes row i into the arrays of `row`: length, escaped, error, body and what else it fills in; beyond is 0 before
 * it. Errors: _CAPACITY (row->length), _WORK (space->needed), others. */
typedef int fibrad_row_function(const fibrad_scene *scene, fibrad_workspace *space, uint32_t i, const void *rule,
                                fibrad_row *row);

/* A method with its rule, and the extra bytes it wants in work memory. */
typedef struct fibrad_row_method {
    fibrad_row_function *compute;
    const void *rule;
    size_t extra_min, extra_best;
} fibrad_row_method;

/* Row i by a method, with work memory and a collection that grow if they can. Errors: as fibrad_beam_row has them. */
int fibrad_row_run(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_row_method *method,
                   fibrad_row *row);

/* The factors to bodies from those by slot. */
void fibrad_row_bodies(const fibrad_scene *scene, const double wall[FIBRAD_SLOTS], fibrad_row *row);

#endif
