/* suite.h - a test program of libcheck: its tests and its main. SPDX-License-Identifier: MIT
 *
 * TEST(name) {...} is a test. LOOP_TEST(name, count) {...} is one that runs for _i from 0 below count. Both need no
 * other entry: a function before main adds the test to the suite. FIXTURE(before, after) has functions that are called
 * before and after each test of the program; either may be NULL. */
#ifndef TESTS_SUITE_H
#define TESTS_SUITE_H

#include <check.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include "asserts.h"
#include "owned.h"

#define TEST(name) LOOP_TEST(name, 1)

#define LOOP_TEST(name, count)                                                                                         \
    static void name(int _i);                                                                                          \
    BEFORE_MAIN(name##_is_added) {                                                                                     \
        static const TTest test = {#name, name, __FILE__, __LINE__};                                                   \
        tcase_add_loop_test(suite_case(), &test, 0, (int)(count));                                                     \
    }                                                                                                                  \
    static void name(int _i CK_ATTRIBUTE_UNUSED)

#define FIXTURE(before, after)                                                                                         \
    BEFORE_MAIN(fixture_is_added) { tcase_add_checked_fixture(suite_case(), before, after); }

#define BEFORE_MAIN(name) __attribute__((constructor)) static void name(void)

/* All tests of the program. Each has 300 seconds, unless CK_DEFAULT_TIMEOUT says otherwise: it takes seconds, and a
 * slow or loaded machine is no failure. */
static inline TCase *suite_case(void) {
    static TCase *all;
    setenv("CK_DEFAULT_TIMEOUT", "300", 0);
    if (!all) all = tcase_create("all");
    return all;
}

/* A text as by printf. The text lasts until 64 others have been made. */
__attribute__((format(printf, 1, 2))) static inline const char *formatted(const char *format, ...) {
    static char texts[64][700];
    static int next;
    va_list arguments;
    next = (next + 1) % 64;
    va_start(arguments, format);
    vsnprintf(texts[next], sizeof texts[next], format, arguments);
    va_end(arguments);
    return texts[next];
}

/* What takes long: `make nightly` (NIGHTLY in the environment) has all of it, other runs have some. */
static inline uint64_t by_night(uint64_t all, uint64_t some) { return getenv("NIGHTLY") ? all : some; }

int main(int argc, char **argv) {
    Suite *suite = suite_create(argc > 0 ? argv[0] : "");
    suite_add_tcase(suite, suite_case());
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    const int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed != 0;
}

#endif
