/* one_file.h - for tests of readers: a file, and the messages about it on standard error.
 * SPDX-License-Identifier: MIT */
#ifndef TESTS_ONE_FILE_H
#define TESTS_ONE_FILE_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "suite.h"

static char path[200];  /* the file */
static char said[4096]; /* text on standard error between the last begin_catching and end_catching */
static FILE *caught;
static int screen;

static inline void make_file(void) {
    const char *build = getenv("BUILD");
    snprintf(path, sizeof path, "%.100s/tests/file_XXXXXX", build ? build : "build");
    const int file = mkstemp(path);
    ck_assert_int_ge(file, 0);
    close(file);
}

static inline void remove_file(void) { unlink(path); }

static inline void write_file(const char *text, size_t size) {
    OWNED_FILE *file = opened(path, "wb");
    ck_assert_uint_eq(fwrite(text, 1, size, file), size);
}

/* Standard error goes to `said` from here to end_catching. */
static inline void begin_catching(void) {
    caught = tmpfile();
    fflush(stderr);
    screen = dup(STDERR_FILENO);
    dup2(fileno(caught), STDERR_FILENO);
}

static inline void end_catching(void) {
    dup2(screen, STDERR_FILENO);
    close(screen);
    rewind(caught);
    said[fread(said, 1, sizeof said - 1, caught)] = 0;
    fclose(caught);
}

#endif
