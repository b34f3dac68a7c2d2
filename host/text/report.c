/* report.c - the summary of a command: lines `key value`, and JSON. SPDX-License-Identifier: MIT */
#include "text/report.h"

#include <inttypes.h>
#include <math.h>
#include <stdarg.h>

#include "cli/message.h"
#include "fibrad.h"
#include "text/text.h"

void report_open(struct report *report, const char *command) {
    if (!report->json) return;
    fprintf(report->json, "{\"fibrad\": \"%s\", \"command\": \"%s\", \"runs\": [", fibrad_version(), command);
}

void report_close(struct report *report) {
    if (report->json) fputs("\n]}\n", report->json);
}

void report_begin(struct report *report) {
    report->entries = 0;
    if (report->json) fputs(report->runs > 0 ? ",\n{" : "\n{", report->json);
    if (report->text && report->runs > 0) putc('\n', report->text);
    ++report->runs;
}

/* For JSON only: warnings have been printed on standard error. */
static void report_warnings(const struct report *report) {
    const char *text;
    fprintf(report->json, "%s\"warnings\": [", report->entries > 0 ? ", " : "");
    for (size_t k = 0; (text = message_warning(k)); ++k) {
        if (k > 0) fputs(", ", report->json);
        text_json(report->json, text);
    }
    putc(']', report->json);
}

void report_end(struct report *report) {
    if (report->json) {
        report_warnings(report);
        putc('}', report->json);
    }
    message_forget_warnings();
    if (report->text) fflush(report->text);
}

const char *report_key(struct report *report, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(report->key, sizeof report->key, format, arguments);
    va_end(arguments);
    return report->key;
}

/* Begins an entry of the JSON and a line of the text. */
static void begin_entry(struct report *report, const char *key) {
    if (report->json) fprintf(report->json, "%s\"%s\": ", report->entries > 0 ? ", " : "", key);
    if (report->text) fprintf(report->text, "%s ", key);
    ++report->entries;
}

static void end_entry(const struct report *report) {
    if (report->text) putc('\n', report->text);
}

void report_text(struct report *report, const char *key, const char *text) {
    begin_entry(report, key);
    if (report->json) text_json(report->json, text);
    for (const char *c = text; report->text && *c; ++c)
        putc((unsigned char)*c < ' ' || *c == 127 ? '?' : *c, report->text);
    end_entry(report);
}

void report_whole(struct report *report, const char *key, int64_t number) {
    begin_entry(report, key);
    if (report->json) fprintf(report->json, "%" PRId64, number);
    if (report->text) fprintf(report->text, "%" PRId64, number);
    end_entry(report);
}

void report_count(struct report *report, const char *key, uint64_t count) { report_whole(report, key, (int64_t)count); }

void report_value(struct report *report, const char *key, double value, int digits) {
    begin_entry(report, key);
    if (report->json) text_json_real(report->json, value);
    if (report->text) fprintf(report->text, "%.*g", digits, value);
    end_entry(report);
}

void report_measured(struct report *report, const char *key, double value, double error) {
    const double scale = log10(fabs(value) / error);
    report_value(report, key, value, !isfinite(scale) ? 6 : scale > 14 ? 15 : scale < 0 ? 1 : 1 + (int)ceil(scale));
}

void report_wanted(struct report *report, const char *file, double wanted, double limit, double got, const char *of) {
    report_value(report, "error_wanted", wanted, 6);
    report_value(report, "error_reached", got, 2);
    if (got <= limit) return;
    const char *format = "warning: --error %g is not reached: %.2g is the estimated error of %s";
    if (file)
        message_at(STATUS_OK, file, 0, format, wanted, got, of);
    else
        message(STATUS_OK, format, wanted, got, of);
}

void report_vector(struct report *report, const char *key, const double value[3]) {
    begin_entry(report, key);
    for (int axis = 0; axis < 3; ++axis) {
        if (report->json) fputs(axis == 0 ? "[" : ", ", report->json), text_json_real(report->json, value[axis]);
        if (report->text) fprintf(report->text, axis == 0 ? "%.9g" : " %.9g", value[axis]);
    }
    if (report->json) putc(']', report->json);
    end_entry(report);
}
