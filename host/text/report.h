/* report.h - what a command says at its end: lines `key value`, and the same as JSON. SPDX-License-Identifier: MIT
 *
 * Lines have as many digits as a figure carries, JSON has all of them. */
#ifndef REPORT_H
#define REPORT_H

#include <stdint.h>
#include <stdio.h>

struct report {
    FILE *text, *json; /* NULL: not wanted */
    int runs, entries; /* begun in all, of this run */
};

/* The JSON as a whole: an object with the program's version, the command and an array of runs. */
void report_open(struct report *report, const char *command);
void report_close(struct report *report);

/* One run, such as a frame: what is reported in between belongs to it. Its JSON ends with the list `warnings` of all
 * that were said since the run before. */
void report_begin(struct report *report);
void report_end(struct report *report);

/* A line each. A key has letters, digits and _; its unit, where there is one, is its end: `power_rms_W`. */
void report_text(struct report *report, const char *key, const char *text);
void report_count(struct report *report, const char *key, uint64_t count);
void report_whole(struct report *report, const char *key, int64_t number);

/* A figure with so many digits. */
void report_value(struct report *report, const char *key, double value, int digits);

/* A figure with the digits that its error leaves it, one uncertain one among them; error 0: six. */
void report_measured(struct report *report, const char *key, double value, double error);

/* An error that was asked for: that one, and the estimate `got` of what has come of it, with a warning, in the JSON as
 * all are, where that is above `limit`. of: of what it is, and maybe what would help. file NULL: none. */
void report_wanted(struct report *report, const char *file, double wanted, double limit, double got, const char *of);

/* Three figures in one line. */
void report_vector(struct report *report, const char *key, const double value[3]);

#endif
