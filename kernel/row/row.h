/* row.h - the common part of all methods for rows: memory that grows, and the place where a row is written.
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_ROW_H
#define FIBRAD_ROW_ROW_H

#include "workspace/workspace.h"

/* A method: computes row i into the arrays and fields of `row`. row->beyond is 0 before the call. After _CAPACITY
 * row->length is the capacity that suffices. After _WORK space->needed is the plan that suffices. */
typedef int fibrad_row_function(const fibrad_scene *scene, fibrad_workspace *space, uint32_t i, const void *rule,
                                fibrad_row *row);

/* A method with its rule. extra_min and extra_best [bytes] are the least and the best extra work memory. */
typedef struct fibrad_row_method {
    fibrad_row_function *compute;
    const void *rule;
    size_t extra_min, extra_best;
} fibrad_row_method;

/* Row i by a method. Work memory and a collection grow if they can. Errors: as fibrad_beam_row. */
int fibrad_row_run(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const fibrad_row_method *method,
                   fibrad_row *row);

/* FIBRAD_OK, or FIBRAD_E_SUM if the factors of a row do not add up to 1. Every row ends with this check. */
int fibrad_row_checked(const fibrad_scene *scene, const fibrad_row *row);
int fibrad_sum_checked(double sum);

/* A row in scratch memory. Its arrays lie in parts of `entries` that only rays use otherwise. They are valid until
 * fibrad_work_begin. wall [FIBRAD_WALLS_MAX]. */
fibrad_row fibrad_row_scratch(fibrad_workspace *space, double *wall);

/* Copies a row into the row of the caller. After FIBRAD_E_CAPACITY only the length is copied. */
int fibrad_row_give(const fibrad_scene *scene, const fibrad_row *row, fibrad_row *to);

/* Gives walls what belongs to the caps of spheres behind them: the caps of sphere i at `place`, and those of the
 * spheres of its row. To be called before fibrad_row_walls. */
void fibrad_row_cut(const fibrad_scene *scene, uint32_t place, double wall[FIBRAD_SLOTS], fibrad_row *row);

/* Sets the factors to walls from the factors by slot. Factors of openings are moved to row->escaped. */
void fibrad_row_walls(const fibrad_scene *scene, double wall[FIBRAD_SLOTS], fibrad_row *row);

#endif
