/* progress.h - a bar on standard error with rate and time left. SPDX-License-Identifier: MIT */
#ifndef PROGRESS_H
#define PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

struct progress {
    bool forced; /* for progress_stage: show the bar even if standard error is no terminal */
    bool quiet;  /* for progress_stage: never show it */
    bool on;
    const char *what; /* plural of what is counted */
    uint64_t total;
    uint64_t done;
    double begun, shown; /* [s] */
};

/* At most ten times a second; for one thread only. */
void progress_show(struct progress *progress, uint64_t done);

/* Leaves no trace of the bar on a terminal, and its last state elsewhere. */
void progress_end(struct progress *progress, uint64_t done);

/* A fibrad_progress of the library, whose context is a struct progress: one bar after the other, a mere count for
 * stages of unknown length. Asks to stop when a signal has come. */
int progress_stage(void *progress, const char *stage, uint64_t done, uint64_t total);

/* Ends a bar that an error has left. */
void progress_stop(struct progress *progress);

/* A clock that only goes forward [s]. */
double progress_clock(void);

#endif
