/* test_status.c - status codes, their texts, the version and the names of instruction sets.
 * SPDX-License-Identifier: MIT */
#include "fibrad.h"
#include "suite.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The numbers of codes never change. Each has a text of its own, and others share one. */
TEST(numbers_and_texts) {
    static const int codes[] = {FIBRAD_E_ARGUMENT,    FIBRAD_E_SIZE,   FIBRAD_E_CAPACITY,  FIBRAD_E_TABLE,
                                FIBRAD_E_GEOMETRY,    FIBRAD_E_WORK,   FIBRAD_E_STATE,     FIBRAD_E_ISA,
                                FIBRAD_E_UNSUPPORTED, FIBRAD_E_MEMORY, FIBRAD_E_CANCELLED, FIBRAD_E_UNSOLVABLE,
                                FIBRAD_E_BACK,        FIBRAD_E_SUM,    FIBRAD_E_ENDLESS,   FIBRAD_E_FILE,
                                FIBRAD_E_UNSETTLED};
    static const int others[] = {1000, -100, -3, -2147483647 - 1, 2147483647};
    ck_assert_int_eq(FIBRAD_OK, 0);
    for (int a = 0; a < 17; a++) {
        const char *text = fibrad_status_text(codes[a]);
        ck_assert_int_eq(codes[a], a < 2 ? -1 - a : -2 - a); /* -3 is no longer used */
        ck_assert(strlen(text) > 0 && text[strlen(text) - 1] != '.');
        ck_assert_str_ne(text, fibrad_status_text(1));
        for (int b = 0; b < a; b++) ck_assert_str_ne(text, fibrad_status_text(codes[b]));
    }
    for (int i = 0; i < 5; i++) ck_assert_str_eq(fibrad_status_text(others[i]), fibrad_status_text(1));
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
