/* progress.h - a bar on standard error with rate and time left. SPDX-License-Identifier: MIT */
#ifndef PROGRESS_H
#define PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

struct progress {
    bool quiet;       /* never show the bar */
    bool on;          /* the bar is shown */
    const char *what; /* name of the things counted, in the plural */
    uint64_t total;
    double begun, shown; /* times of the beginning and of the last drawing [s] */
};

/* A fibrad_progress whose context is a struct progress, for one thread. Each stage has a bar on a terminal, or a count
 * if its length is not known, at most ten times a second. Returns not 0, to stop the library, after a signal. */
int progress_stage(void *progress, const char *stage, uint64_t done, uint64_t total);

/* Ends a bar that is still shown, as after an error. */
void progress_stop(struct progress *progress);

/* A clock that only goes forward [s]. */
double progress_clock(void);

#endif
