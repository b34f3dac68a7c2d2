/* vtp_text.h - arrays in the text of a .vtp file. SPDX-License-Identifier: MIT */
#ifndef TEST_VTP_TEXT_H
#define TEST_VTP_TEXT_H

#include "suite.h"

/* Decodes the first n values, of 8 bytes each, of the inline binary array of a name. Returns the length of the array,
 * which is at least n. If it is n, nothing follows. */
static inline uint64_t vtp_array(const char *text, const char *name, void *values, size_t n) {
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *at = strstr(text, formatted("Name=\"%s\"", name));
    ck_assert_msg(at != NULL, "there is no array %s", name);
    at = strchr(at, '>') + 2;
    OWNED unsigned char *bytes = calloc(8 + 8 * n + 3, 1);
    uint64_t length;
    uint32_t bits = 0;
    for (size_t k = 0, to = 0; to < 8 + 8 * n; ++at) {
        const char *digit = *at ? strchr(digits, *at) : NULL;
        ck_assert_msg(digit || *at == '=', "the array %s is too short", name);
        bits = bits << 6 | (digit ? (uint32_t)(digit - digits) : 0);
        if (++k % 4) continue;
        for (int shift = 16; shift >= 0; shift -= 8) bytes[to++] = bits >> shift & 255;
    }
    memcpy(&length, bytes, sizeof length);
    memcpy(values, bytes + 8, 8 * n);
    ck_assert_uint_ge(length, 8 * n);
    if (length == 8 * n) ck_assert_int_eq(*at, '\n');
    return length / 8;
}

#endif
