/* team.h - the threads of a call, and what each has of its own. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_TEAM_H
#define FIBRAD_SIMPLE_TEAM_H

#include "simple/heap.h"

#define TEAM_INTERVAL 0.05 /* between two calls of the progress function in a stage [s] */

/* Error of the lowest task that failed in a thread. */
typedef struct fibrad_team_error {
    uint32_t task;
    int status;
    uint32_t triangle; /* of FIBRAD_E_BACK; else UINT32_MAX */
} fibrad_team_error;

typedef struct fibrad_team {
    int threads;
    fibrad_progress *progress;
    void *context;
    uint32_t before;          /* tasks done before those of the run in hand, for progress */
    fibrad_work *work;        /* [threads] growing */
    fibrad_rows *rows;        /* [threads] growing */
    fibrad_scratch *store;    /* [threads] of the rows */
    fibrad_team_error *error; /* [threads] */
    uint32_t triangle;        /* of the last run that failed: the one whose back was seen, or UINT32_MAX */
} fibrad_team;

/* Makes the team that `run` (NULL: defaults) asks for. Close it also after an error. Errors: _ARGUMENT, _MEMORY. */
int fibrad_team_open(fibrad_team *team, const fibrad_run *run);
void fibrad_team_close(fibrad_team *team);

/* Rows, of which there are none yet, go into files of a folder; NULL: they stay on the heap. Errors: as
 * fibrad_scratch_open. */
int fibrad_team_scratch(fibrad_team *team, const char *folder);

/* Task `task` by thread `thread`, whose work and rows no other one uses. A status. */
typedef int fibrad_team_task(void *job, int thread, uint32_t task);

/* Does all tasks [0, tasks), handed to the threads `chunk` at a time. stage: for progress; NULL: no progress. Returns
 * the error of the lowest task that fails, whatever the threads (*failed, unless NULL, is that task; else `tasks`), or
 * FIBRAD_E_CANCELLED. */
int fibrad_team_run(fibrad_team *team, const char *stage, uint32_t tasks, int chunk, fibrad_team_task *task, void *job,
                    uint32_t *failed);

/* A fibrad_parallel of a team. */
void fibrad_team_share(void *team, uint32_t pieces, fibrad_piece *piece, void *job);

/* Calls the progress function, if there is one. FIBRAD_OK or FIBRAD_E_CANCELLED. */
int fibrad_team_report(const fibrad_team *team, const char *stage, uint64_t done, uint64_t total);

#endif
