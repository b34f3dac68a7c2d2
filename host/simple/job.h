/* job.h - a bed being computed: its scene, its threads and the rows they collect. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_JOB_H
#define FIBRAD_SIMPLE_JOB_H

#include <stdbool.h>

#include "simple/team.h"

typedef struct fibrad_job {
    fibrad_scene *scene;
    void *block; /* of the scene */
    fibrad_scene_facts facts;
    fibrad_team team;
    fibrad_run *run;
    const fibrad_spheres *spheres;
    const char *scratch; /* a folder for rows and matrix; NULL: in memory */
    double begun;        /* [s] */
} fibrad_job;

/* Makes a scene and a team. Close it also after an error. Errors: as fibrad_view_factors; run->fault is set. */
int fibrad_job_open(fibrad_job *job, const fibrad_scene_config *config, const fibrad_spheres *spheres, fibrad_run *run);

/* Rows and matrix go into files of a folder; NULL: they stay in memory. Errors: as fibrad_scratch_open. */
int fibrad_job_scratch(fibrad_job *job, const char *folder);
void fibrad_job_close(fibrad_job *job);

/* Row i by some method; into row->rows or elsewhere. A status. */
typedef int fibrad_job_row(const void *rule, const fibrad_scene *scene, fibrad_work *work, uint32_t i, fibrad_row *row,
                           uint64_t *rays);

/* Row i by a fibrad_beam_rule, the one kind that is divided over the threads where it is long. */
fibrad_job_row fibrad_job_beam_row;

/* What is known of rows besides the matrix. */
typedef struct fibrad_job_report {
    uint64_t rows;
    uint32_t directions;
    uint64_t fallbacks, rays;
    double closure_error;
} fibrad_job_report;

/* Computes rows, those wanted ([spheres] not 0; NULL: all), into the collections of the team, which are emptied first.
 * error: NULL, or [spheres] out: estimated error of each row; 0 of others. Errors: those of the rows; run->fault is
 * set. */
int fibrad_job_rows(fibrad_job *job, fibrad_job_row *row, const void *rule, const unsigned char *wanted, double *error,
                    fibrad_job_report *report);

/* Makes the matrix of the rows that the team has collected. Errors: as fibrad_matrix_init, _MEMORY. */
int fibrad_job_factors(fibrad_job *job, const fibrad_matrix_rule *rule, const fibrad_job_report *report,
                       fibrad_bed_factors **factors);

/* Rows by the beam rule such that the worst averaged one has an estimated error of rule->tolerance or less, if
 * FIBRAD_DIRECTIONS_MAX suffices, and their matrix. Errors: as the two above. */
int fibrad_job_tolerance(fibrad_job *job, fibrad_job_row *row, const fibrad_beam_rule *rule,
                         const fibrad_matrix_rule *average, fibrad_bed_factors **factors);

/* Likewise of exchange factors, with rule->tolerance > 0, as long as more paths make the worst error smaller. */
int fibrad_job_exchange(fibrad_job *job, fibrad_job_row *row, const fibrad_exchange_rule *rule,
                        const fibrad_matrix_rule *average, fibrad_bed_factors **factors);

/* Rows of all bodies that have bounds, by rule->paths paths from each, or more until no error is above rule->tolerance
 * (0: none); row [bodies] out. Errors: as fibrad_exchange_body. */
int fibrad_job_bodies(fibrad_job *job, const fibrad_exchange_rule *rule, fibrad_body_row *row);

/* `paths`, less in small beds and more in large ones. */
uint32_t fibrad_job_body_paths(const fibrad_job *job, uint64_t paths);

#endif
