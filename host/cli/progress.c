/* progress.c - a bar on standard error with rate and time left. SPDX-License-Identifier: MIT */
#include "cli/progress.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

#include "cli/message.h"

double progress_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static void draw_bar(const struct progress *progress, uint64_t done, double now) {
    enum { WIDTH = 30 };
    const double passed = now - progress->begun, rate = passed > 0 ? (double)done / passed : 0;
    if (progress->total == 0) {
        fprintf(stderr, "\r%llu %s, %.0f/s ", (unsigned long long)done, progress->what, rate);
        fflush(stderr);
        return;
    }
    const double part = (double)done / (double)progress->total;
    const double left = rate > 0 ? (double)(progress->total - done) / rate : 0;
    char bar[WIDTH + 1] = "";
    for (int k = 0; k < WIDTH; ++k) bar[k] = k < part * WIDTH ? '#' : '.';
    fprintf(stderr, "\r[%s] %3.0f %%  %llu of %llu %s, %.0f/s, %d:%02d left ", bar, 100 * part,
            (unsigned long long)done, (unsigned long long)progress->total, progress->what, rate, (int)left / 60,
            (int)left % 60);
    fflush(stderr);
}

int progress_stage(void *context, const char *stage, uint64_t done, uint64_t total) {
    struct progress *progress = context;
    const double now = progress_clock();
    if (done == 0) {
        progress_stop(progress);
        progress->on = !progress->quiet && isatty(STDERR_FILENO);
        progress->what = stage, progress->total = total, progress->begun = progress->shown = now;
    }
    if (total > 0 && done == total) progress_stop(progress);
    if (progress->on && now - progress->shown >= 0.1) {
        progress->shown = now;
        draw_bar(progress, done, now);
    }
    return interrupt_status() != 0;
}

void progress_stop(struct progress *progress) {
    if (progress->on) fprintf(stderr, "\r%80s\r", "");
    progress->on = false;
}
