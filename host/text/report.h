/* report.h - the summary of a command: lines `key value`, and JSON. SPDX-License-Identifier: MIT
 *
 * Lines have as many digits as the error of a value leaves. JSON has all digits. */
#ifndef REPORT_H
#define REPORT_H

#include <stdint.h>
#include <stdio.h>

struct report {
    FILE *text, *json; /* NULL: not written */
    int runs;          /* runs begun so far */
    int entries;       /* entries of the current run so far */
    char key[80];      /* of report_key */
};

/* Begin and end the JSON: an object with the version of the program, the command and an array of runs. */
void report_open(struct report *report, const char *command);
void report_close(struct report *report);

/* Begin and end one run, such as a frame. Its JSON ends with the list `warnings` of all warnings since the last run. */
void report_begin(struct report *report);
void report_end(struct report *report);

/* Makes a key of a name or a number, as printf does. The key is valid until the next call. */
const char *report_key(struct report *report, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Write one line each. A key has letters, digits and _. A key ends with the unit, if there is one: `power_rms_W`. */
void report_text(struct report *report, const char *key, const char *text);
void report_count(struct report *report, const char *key, uint64_t count);
void report_whole(struct report *report, const char *key, int64_t number);

/* Writes a value with `digits` significant digits. */
void report_value(struct report *report, const char *key, double value, int digits);

/* Writes a value with the digits that its error leaves, one uncertain digit included. error 0: six digits. */
void report_measured(struct report *report, const char *key, double value, double error);

/* Writes the error of --error (wanted) and the estimated error of the result (got). Warns if `got` is above `limit`.
 * of: names in the warning whose error it is, and may say what would help. file: for the warning; NULL: none. */
void report_wanted(struct report *report, const char *file, double wanted, double limit, double got, const char *of);

/* Writes three values in one line. */
void report_vector(struct report *report, const char *key, const double value[3]);

#endif
