/* bare.c - memory functions and square roots for targets without a C library. SPDX-License-Identifier: MIT */
#include <stdint.h>

#include "smoke_port.h"

void *memcpy(void *restrict to, const void *restrict from, size_t bytes) {
    for (size_t k = 0; k < bytes; k++) ((unsigned char *)to)[k] = ((const unsigned char *)from)[k];
    return to;
}

void *memmove(void *to, const void *from, size_t bytes) {
    unsigned char *a = to;
    const unsigned char *b = from;
    if ((uintptr_t)a <= (uintptr_t)b)
        for (size_t k = 0; k < bytes; k++) a[k] = b[k];
    else
        for (size_t k = bytes; k-- > 0;) a[k] = b[k];
    return to;
}

void *memset(void *to, int byte, size_t bytes) {
    for (size_t k = 0; k < bytes; k++) ((unsigned char *)to)[k] = (unsigned char)byte;
    return to;
}

/* The root of m 2^e, m in [2^52, 2^54), e even, has 53 bits: the largest q with q^2 <= m 2^52 and a rounding bit. The
 * remainder is kept as one would by hand, two bits of the argument at a time. */
double smoke_sqrt(double x) {
    union {
        double value;
        uint64_t bits;
    } view = {x};
    if (!(x > 0) || x > 0x1.fffffffffffffp1023) return x == 0 || x > 0 ? x : (x - x) / (x - x);
    int scale = 0;
    if (x < 0x1p-1022) view.value = x * 0x1p108, scale = 54;
    int exponent = (int)(view.bits >> 52) - 1023;
    uint64_t m = (view.bits & 0xfffffffffffff) | 0x10000000000000;
    if (exponent & 1) m <<= 1, exponent--;
    uint64_t root = 0, rest = 0;
    for (int step = 0; step < 54; step++) { /* 53 bits and one to round by */
        rest = rest << 2 | (m >> 52 & 3);   /* bits 53 and 52, before the binary point first */
        m = m << 2 & 0x3fffffffffffff;
        uint64_t trial = root << 2 | 1;
        root <<= 1;
        if (rest >= trial) rest -= trial, root |= 1;
    }
    root = (root >> 1) + (root & 1); /* never a tie: a root of 54 bits is not exact */
    view.bits = ((uint64_t)(exponent / 2 - scale + 1022) << 52) + root; /* the leading bit of the root adds one */
    return view.value;
}
