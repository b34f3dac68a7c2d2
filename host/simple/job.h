/* job.h - the computation of a bed: its scene, its threads and the rows that they collect.
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_JOB_H
#define FIBRAD_SIMPLE_JOB_H

#include <stdbool.h>

#include "simple/team.h"

typedef struct fibrad_job {
    fibrad_scene *scene;
    void *block; /* of the scene; NULL: the scene is not the job's */
    fibrad_scene_facts facts;
    fibrad_team team;
    fibrad_run *run;
    const fibrad_spheres *spheres; /* for beams */
    const char *scratch;           /* a folder for rows and matrix; NULL: in memory */
    double begun;                  /* time of fibrad_job_open [s] */
} fibrad_job;

/* Makes a scene and a team. Close the job also after an error. Errors: as fibrad_view_factors; run->fault is set. */
int fibrad_job_open(fibrad_job *job, const fibrad_scene_config *config, const fibrad_spheres *spheres, fibrad_run *run);

/* The exchange factors of a scene that stays the caller's, as fibrad_exchange_factors with the default options. */
int fibrad_job_exchange_of(fibrad_scene *scene, const fibrad_exchange_rule *rule, fibrad_run *run,
                           fibrad_bed_factors **factors);

/* Keeps rows and matrix in files of a folder. folder NULL: in memory. Errors: as fibrad_scratch_open. */
int fibrad_job_scratch(fibrad_job *job, const char *folder);
void fibrad_job_close(fibrad_job *job);

/* A method: computes row i into row->rows and adds to *rays the rays it has traced. Returns a status. */
typedef int fibrad_job_row(const void *rule, const fibrad_scene *scene, fibrad_work *work, uint32_t i, fibrad_row *row,
                           uint64_t *rays);

/* The method of beams, by a fibrad_beam_rule. Only this method divides a long row over the threads. */
fibrad_job_row fibrad_job_beam_row;

/* Facts of the rows computed, as in fibrad_bed_factors. */
typedef struct fibrad_job_report {
    uint64_t rows; /* their number */
    uint32_t directions;
    uint64_t fallbacks, rays;
    double closure_error;
} fibrad_job_report;

/* Empties the collections of the team and computes rows into them. wanted [spheres]: not 0: this row is computed; NULL:
 * all rows. error [spheres], out: estimated errors, 0 for rows that are not computed; may be NULL. Errors: those of the
 * rows; run->fault is set. */
int fibrad_job_rows(fibrad_job *job, fibrad_job_row *row, const void *rule, const unsigned char *wanted, double *error,
                    fibrad_job_report *report);

/* The matrix along the largest set of lines errs as much as a matrix along so many directions. */
#define FIBRAD_DIRECTIONS_AS_LINES (FIBRAD_LINES_EVEN_MAX / 2 * 3)

/* Empties the collections of the team and computes all rows of a matrix into them, along as many lines as the rule has
 * directions, at most FIBRAD_LINES_EVEN_MAX. With more than FIBRAD_DIRECTIONS_AS_LINES, rows have directions. beam
 * NULL: the defaults.
 * Errors: as fibrad_job_rows. */
int fibrad_job_line_rows(fibrad_job *job, const fibrad_beam_rule *beam, fibrad_job_report *report);

/* Makes the matrix of the rows that the team has collected. Errors: as fibrad_matrix_init, _MEMORY. */
int fibrad_job_factors(fibrad_job *job, const fibrad_matrix_rule *rule, const fibrad_job_report *report,
                       fibrad_bed_factors **factors);

/* Computes all rows as fibrad_job_line_rows, and their matrix. The worst row has, after averaging, an estimated error
 * of at most rule->tolerance, unless FIBRAD_DIRECTIONS_MAX directions do not suffice. Errors: as fibrad_job_rows and
 * fibrad_job_factors. */
int fibrad_job_tolerance(fibrad_job *job, const fibrad_beam_rule *rule, const fibrad_matrix_rule *average,
                         fibrad_bed_factors **factors);

/* Computes exchange factors, rule->tolerance being above 0, and their matrix. The worst row has, after averaging, an
 * estimated error of at most rule->tolerance, unless more paths no longer help. Errors: as fibrad_job_rows and
 * fibrad_job_factors. */
int fibrad_job_exchange(fibrad_job *job, fibrad_job_row *row, const fibrad_exchange_rule *rule,
                        const fibrad_matrix_rule *average, fibrad_bed_factors **factors);

/* Computes the rows of all walls of finite area, by rule->paths paths from each wall. With a tolerance above 0 a wall
 * gets more paths until its error is at most `tolerance`. row [walls]: out. Errors: as fibrad_exchange_wall. */
int fibrad_job_walls(fibrad_job *job, const fibrad_wall_rule *rule, double tolerance, fibrad_wall_row *row);

/* The number of paths from a wall: `paths`, scaled by the number of spheres and rounded up to a power of two. */
uint32_t fibrad_job_wall_paths(const fibrad_job *job, uint64_t paths);

#endif
