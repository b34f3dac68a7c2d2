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

/* What every row ends with: FIBRAD_OK, or FIBRAD_E_SUM if its factors do not add up to one. */
int fibrad_row_checked(const fibrad_scene *scene, const fibrad_row *row);
int fibrad_sum_checked(double sum);

/* A row that is not the caller's: its arrays are scratch in which entries find room that no call but that of rays
 * uses, until entries begin anew; body [FIBRAD_BODIES_MAX]. */
fibrad_row fibrad_row_scratch(fibrad_workspace *space, double *body);

/* Copies a row of a scene into the caller's. FIBRAD_E_CAPACITY: its length alone. */
int fibrad_row_give(const fibrad_scene *scene, const fibrad_row *row, fibrad_row *to);

/* What walls get of the caps behind them, and no one else: those of sphere i at `place`, and of the spheres of its row.
 * To be called before fibrad_row_bodies. */
void fibrad_row_cut(const fibrad_scene *scene, uint32_t place, double wall[FIBRAD_SLOTS], fibrad_row *row);

/* The factors to bodies from those by slot. Those of openings are moved to row->escaped. */
void fibrad_row_bodies(const fibrad_scene *scene, double wall[FIBRAD_SLOTS], fibrad_row *row);

#endif
