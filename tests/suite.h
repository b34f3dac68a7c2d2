/* suite.h - a test program of libcheck: its cases, and what its main returns. SPDX-License-Identifier: MIT */
#ifndef TESTS_SUITE_H
#define TESTS_SUITE_H

#include <check.h>
#include <stdlib.h>

/* A further case of the suite. Each test has 300 seconds, unless CK_DEFAULT_TIMEOUT says otherwise: it takes seconds,
 * and a slow or loaded machine is no failure. */
static inline TCase *suite_case(Suite *suite, const char *name) {
    setenv("CK_DEFAULT_TIMEOUT", "300", 0);
    TCase *tcase = tcase_create(name);
    suite_add_tcase(suite, tcase);
    return tcase;
}

/* Runs all cases. Returns the exit status. */
static inline int suite_run(Suite *suite) {
    SRunner *runner = srunner_create(suite);
    srunner_run_all(runner, CK_ENV);
    int failed = srunner_ntests_failed(runner);
    srunner_free(runner);
    return failed != 0;
}

#endif
