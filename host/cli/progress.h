/* progress.h - a bar on standard error with rate and time left. SPDX-License-Identifier: MIT */
#ifndef PROGRESS_H
#define PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

struct progress {
    bool on;
    const char *what; /* plural of what is counted */
    uint64_t total;
    double begun, shown; /* [s] */
};

/* The bar appears if standard error is a terminal, or if `forced`. */
void progress_begin(struct progress *progress, bool forced, const char *what, uint64_t total);

/* At most ten times a second; for one thread only. */
void progress_show(struct progress *progress, uint64_t done);

/* Leaves no trace of the bar on a terminal, and its last state elsewhere. */
void progress_end(struct progress *progress, uint64_t done);

/* A clock that only goes forward [s]. */
double progress_clock(void);

#endif
