/* progress.c - a bar on standard error with rate and time left. SPDX-License-Identifier: MIT */
#include "cli/progress.h"

#include <stdio.h>
#include <time.h>
#include <unistd.h>

#include "cli/interrupt.h"

double progress_clock(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* The bar appears if standard error is a terminal, or if `forced`. */
static void progress_begin(struct progress *progress, bool forced, const char *what, uint64_t total) {
    const double now = progress_clock();
    *progress = (struct progress){.forced = forced,
                                  .on = forced || isatty(STDERR_FILENO),
                                  .what = what,
                                  .total = total,
                                  .begun = now,
                                  .shown = now};
}

static void draw_bar(const struct progress *progress, uint64_t done, double now) {
    enum { WIDTH = 30 };
    const double passed = now - progress->begun;
    const double rate = passed > 0 ? (double)done / passed : 0;
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

void progress_show(struct progress *progress, uint64_t done) {
    progress->done = done;
    if (!progress->on) return;
    const double now = progress_clock();
    if (now - progress->shown < 0.1) return;
    progress->shown = now;
    draw_bar(progress, done, now);
}

void progress_end(struct progress *progress, uint64_t done) {
    if (!progress->on) return;
    if (isatty(STDERR_FILENO)) {
        fprintf(stderr, "\r%80s\r", "");
    } else {
        draw_bar(progress, done, progress_clock());
        fputc('\n', stderr);
    }
    progress->on = false;
}

int progress_stage(void *context, const char *stage, uint64_t done, uint64_t total) {
    struct progress *progress = context;
    if (progress->quiet) return interrupt_status() != 0;
    if (done == 0) {
        progress_stop(progress);
        progress_begin(progress, progress->forced, stage, total);
    }
    if (total > 0 && done == total)
        progress_end(progress, done);
    else
        progress_show(progress, done);
    return interrupt_status() != 0;
}

void progress_stop(struct progress *progress) { progress_end(progress, progress->done); }
