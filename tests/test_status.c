/* test_status.c - status codes, their texts, the version and the names of instruction sets.
 * SPDX-License-Identifier: MIT */
#include "fibrad.h"
#include "suite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GONE (-3) /* was FIBRAD_E_ALIGNMENT */

TEST(numbers_never_change) {
    ck_assert_int_eq(FIBRAD_OK, 0);
    ck_assert_int_eq(FIBRAD_E_ARGUMENT, -1);
    ck_assert_int_eq(FIBRAD_E_SIZE, -2);
    ck_assert_int_eq(FIBRAD_E_CAPACITY, -4);
    ck_assert_int_eq(FIBRAD_E_TABLE, -5);
    ck_assert_int_eq(FIBRAD_E_GEOMETRY, -6);
    ck_assert_int_eq(FIBRAD_E_WORK, -7);
    ck_assert_int_eq(FIBRAD_E_STATE, -8);
    ck_assert_int_eq(FIBRAD_E_ISA, -9);
    ck_assert_int_eq(FIBRAD_E_UNSUPPORTED, -10);
    ck_assert_int_eq(FIBRAD_E_MEMORY, -11);
    ck_assert_int_eq(FIBRAD_E_CANCELLED, -12);
    ck_assert_int_eq(FIBRAD_E_UNSOLVABLE, -13);
    ck_assert_int_eq(FIBRAD_E_BACK, -14);
    ck_assert_int_eq(FIBRAD_E_SUM, -15);
    ck_assert_int_eq(FIBRAD_E_ENDLESS, -16);
    ck_assert_int_eq(FIBRAD_E_FILE, -17);
}

TEST(each_status_has_its_own_text) {
    for (int a = FIBRAD_E_FILE; a <= FIBRAD_OK; a++) {
        if (a == GONE) continue;
        const char *text = fibrad_status_text(a);
        ck_assert_uint_gt(strlen(text), 0);
        ck_assert_int_ne(text[strlen(text) - 1], '.');
        ck_assert_str_ne(text, fibrad_status_text(1));
        for (int b = FIBRAD_E_FILE; b < a; b++) ck_assert_str_ne(text, fibrad_status_text(b));
    }
}

TEST(other_numbers_have_a_text) {
    static const int others[] = {1, 1000, -100, -1000, -2147483647 - 1, 2147483647};
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        ck_assert_ptr_nonnull(fibrad_status_text(others[i]));
        ck_assert_str_eq(fibrad_status_text(others[i]), fibrad_status_text(1));
    }
}

TEST(version_is_the_headers) {
    int major, minor, patch, read = -1;
    ck_assert_str_eq(fibrad_version(), FIBRAD_VERSION);
    ck_assert_int_eq(sscanf(fibrad_version(), "%d.%d.%d%n", &major, &minor, &patch, &read), 3);
    ck_assert_int_eq(read, (int)strlen(fibrad_version()));
}

TEST(instruction_sets_have_names) {
    static const char *const names[] = {"best", "scalar", "sse2", "avx2", "avx512", "neon"};
    for (int isa = FIBRAD_ISA_BEST; isa <= FIBRAD_ISA_NEON; isa++) ck_assert_str_eq(fibrad_isa_name(isa), names[isa]);
    ck_assert_str_eq(fibrad_isa_name(-1), "?");
    ck_assert_str_eq(fibrad_isa_name(6), "?");
}
