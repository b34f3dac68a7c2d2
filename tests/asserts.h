/* asserts.h - assertions that tests share. SPDX-License-Identifier: MIT */
#ifndef TESTS_ASSERTS_H
#define TESTS_ASSERTS_H

#include <check.h>
#include <math.h>
#include <string.h>

#define PI 3.14159265358979323846

/* A call of the library succeeds. */
#define assert_ok(call) ck_assert_int_eq(call, FIBRAD_OK)

/* A call of the library says that an argument is not valid. */
#define assert_invalid(call) ck_assert_int_eq(call, FIBRAD_E_ARGUMENT)

/* A value differs from the truth by no more than a fraction of the truth. */
static inline void assert_near(double value, double truth, double fraction) {
    ck_assert_msg(fabs(value - truth) <= fraction * fabs(truth), "%.9g instead of %.9g, off by %.3g", value, truth,
                  value / truth - 1);
}

static inline void assert_has(const char *text, const char *words) {
    ck_assert_msg(strstr(text, words) != NULL, "'%s' has no '%s'", text, words);
}

static inline void assert_lacks(const char *text, const char *words) {
    ck_assert_msg(strstr(text, words) == NULL, "'%s' has '%s'", text, words);
}

static inline void assert_begins(const char *text, const char *words) {
    ck_assert_msg(strncmp(text, words, strlen(words)) == 0, "'%s' does not begin with '%s'", text, words);
}

#endif
