/* message.c - exit statuses, error messages and warnings. SPDX-License-Identifier: MIT */
#include "cli/message.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void (*redirected)(void *context, const char *line);
static void *redirected_context;

enum { WARNINGS = 32 }; /* largest number of warnings that are kept */
static char *warning[WARNINGS];
static size_t warnings;

void message_redirect(void (*to)(void *context, const char *line), void *context) {
    redirected = to;
    redirected_context = context;
}

/* Prints one line, also if names and tokens in it have control characters. */
static void print_line(int status, const char *prefix, const char *format, va_list arguments) {
    char text[1536];
    const int begun = snprintf(text, sizeof text, "%s", prefix);
    vsnprintf(text + begun, sizeof text - (size_t)begun, format, arguments);
    for (char *c = text; *c; ++c)
        if ((unsigned char)*c < ' ' || *c == 127) *c = '?';
    if (status == STATUS_OK && warnings < WARNINGS && (warning[warnings] = strdup(text))) ++warnings;
    if (redirected)
        redirected(redirected_context, text);
    else
        fprintf(stderr, "fibrad: %s\n", text);
}

int message(int status, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    print_line(status, "", format, arguments);
    va_end(arguments);
    return status;
}

int message_at(int status, const char *file, uint64_t line, const char *format, ...) {
    char place[512];
    if (line)
        snprintf(place, sizeof place, "%.480s:%llu: ", file, (unsigned long long)line);
    else
        snprintf(place, sizeof place, "%.480s: ", file);
    va_list arguments;
    va_start(arguments, format);
    print_line(status, place, format, arguments);
    va_end(arguments);
    return status;
}

int message_memory(void) { return message(STATUS_MEMORY, "out of memory"); }

const char *message_warning(size_t k) { return k < warnings ? warning[k] : NULL; }

void message_forget_warnings(void) {
    while (warnings > 0) free(warning[--warnings]);
}
