/* team.h - the threads of a call, and the memory of each thread. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SIMPLE_TEAM_H
#define FIBRAD_SIMPLE_TEAM_H

#include "simple/heap.h"

#define TEAM_INTERVAL 0.05 /* shortest time between two calls of the progress function in a stage [s] */

/* The lowest task that failed in a thread. */
typedef struct fibrad_team_error {
    uint32_t task;
    int status;
    uint32_t triangle; /* of FIBRAD_E_BACK; else UINT32_MAX */
} fibrad_team_error;

typedef struct fibrad_team {
    int threads;
    fibrad_progress *progress;
    void *context;
    fibrad_work *work;        /* [threads] */
    fibrad_rows *rows;        /* [threads] */
    fibrad_scratch *store;    /* [threads] memory of the rows */
    fibrad_team_error *error; /* [threads] */
    uint32_t triangle;        /* of FIBRAD_E_BACK in the last run; else UINT32_MAX */
} fibrad_team;

/* Makes a team of run->threads threads. run NULL: defaults. Close the team also after an error. Errors: _ARGUMENT,
 * _MEMORY. */
int fibrad_team_open(fibrad_team *team, const fibrad_run *run);
void fibrad_team_close(fibrad_team *team);

/* Keeps rows in files of a folder; folder NULL: on the heap. Call it before the first row. Errors: as
 * fibrad_scratch_open. */
int fibrad_team_scratch(fibrad_team *team, const char *folder);

/* Frees the rows. */
void fibrad_team_forget(fibrad_team *team);

/* Does a task. No other thread uses work[thread] and rows[thread] of the team meanwhile. Returns a status. */
typedef int fibrad_team_task(void *job, int thread, uint32_t task);

/* Does all tasks [0, tasks). A thread takes `chunk` tasks at a time. stage: name for the progress function; NULL: no
 * progress. failed: may be NULL; *failed: the lowest task that failed, the same for any schedule; `tasks` if none has
 * failed. Returns FIBRAD_OK, the status of that task, or FIBRAD_E_CANCELLED. */
int fibrad_team_run(fibrad_team *team, const char *stage, uint32_t tasks, int chunk, fibrad_team_task *task, void *job,
                    uint32_t *failed);

/* A fibrad_parallel whose context is a team. */
void fibrad_team_share(void *team, uint32_t pieces, fibrad_piece *piece, void *job);

/* Calls the progress function, if there is one. Returns FIBRAD_OK or FIBRAD_E_CANCELLED. */
int fibrad_team_report(const fibrad_team *team, const char *stage, uint64_t done, uint64_t total);

#endif
