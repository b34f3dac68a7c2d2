/* rows.h - rows of a bed by its threads, and their matrix. All functions are called within a call of the bed, and set
 * bed->fault. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_ROWS_H
#define FIBRAD_SIMPLE_ROWS_H

#include "simple/bed.h"

/* A method: computes row i into row->rows and adds to *rays the rays it has traced. Returns a status. */
typedef int fibrad_row_method(const void *rule, const fibrad_scene *scene, fibrad_work *work, uint32_t i,
                              fibrad_row *row, uint64_t *rays);

/* The method of beams, by a fibrad_beam_rule. Only this method divides a long row over the threads. */
fibrad_row_method fibrad_row_by_beams;

/* Facts of the rows computed, as in fibrad_bed_matrix. */
typedef struct fibrad_rows_report {
    uint64_t rows; /* their number */
    uint32_t directions;
    uint64_t fallbacks, rays;
    double closure_error;
} fibrad_rows_report;

/* Empties the collections of the team and computes rows into them. wanted [spheres]: not 0: this row is computed; NULL:
 * all rows. Errors: those of the rows. */
int fibrad_bed_rows(fibrad_bed *bed, fibrad_row_method *row, const void *rule, const unsigned char *wanted,
                    fibrad_rows_report *report);

/* The matrix along the largest set of lines errs as much as a matrix along so many directions. */
#define FIBRAD_DIRECTIONS_AS_LINES (FIBRAD_LINES_EVEN_MAX / 2 * 3)

/* Empties the collections of the team and computes all rows of a matrix into them, along as many lines as the rule has
 * directions, at most FIBRAD_LINES_EVEN_MAX. With more than FIBRAD_DIRECTIONS_AS_LINES, rows have directions. beam
 * NULL: the defaults. Errors: as fibrad_bed_rows. */
int fibrad_bed_line_rows(fibrad_bed *bed, const fibrad_beam_rule *beam, fibrad_rows_report *report);

/* Makes the matrix of the rows that the team has collected. Errors: as fibrad_matrix_init, _MEMORY. */
int fibrad_bed_average(fibrad_bed *bed, const fibrad_matrix_rule *rule, const fibrad_rows_report *report,
                       fibrad_bed_matrix **factors);

/* Computes all rows as fibrad_bed_line_rows, and their matrix. The worst row has, after averaging, an estimated error
 * of at most rule->tolerance, unless FIBRAD_DIRECTIONS_MAX directions do not suffice. Errors: as fibrad_bed_rows and
 * fibrad_bed_average. */
int fibrad_bed_tolerance_rows(fibrad_bed *bed, const fibrad_beam_rule *rule, const fibrad_matrix_rule *average,
                              fibrad_bed_matrix **factors);

/* Computes exchange factors, rule->tolerance being above 0, and their matrix. The worst row has, after averaging, an
 * estimated error of at most rule->tolerance, unless more paths no longer help. Errors: as fibrad_bed_rows and
 * fibrad_bed_average. */
int fibrad_bed_exchange_rows(fibrad_bed *bed, fibrad_row_method *row, const fibrad_exchange_rule *rule,
                             const fibrad_matrix_rule *average, fibrad_bed_matrix **factors);

/* Computes the rows of all walls of finite area, by rule->paths paths from each wall. With a tolerance above 0 a wall
 * gets more paths until its error is at most `tolerance`. row [walls]: out. Errors: as fibrad_exchange_wall. */
int fibrad_bed_wall_rows(fibrad_bed *bed, const fibrad_wall_rule *rule, double tolerance, fibrad_wall_row *row);

/* The number of paths from a wall: `paths`, scaled by the number of spheres and rounded up to a power of two. */
uint32_t fibrad_bed_wall_paths(const fibrad_bed *bed, uint64_t paths);

#endif
