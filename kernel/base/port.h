/* port.h - all that the kernel takes from the C library and the compiler. SPDX-License-Identifier: MIT
 *
 * A target with its own ideas names a header of its own: -DFIBRAD_PORT_HEADER='"my_port.h"'; it then defines
 * fibrad_sqrt, fibrad_copy and fibrad_zero as below. The square root must round correctly (IEEE 754). */
#ifndef FIBRAD_BASE_PORT_H
#define FIBRAD_BASE_PORT_H

#include <float.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* 16: half precision has its own arithmetic, and all other types theirs */
#if FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16
#error "fibrad needs arithmetic in the precision of its types (on 32-bit x86: -msse2 -mfpmath=sse)"
#endif

#if defined(FIBRAD_PORT_HEADER)
#include FIBRAD_PORT_HEADER
#elif !defined(FIBRAD_PORT_GIVEN) /* by whoever includes this */

/* With -fno-math-errno this is a single instruction where the machine has one, else a call of sqrt. */
static inline double fibrad_sqrt(double x) { return __builtin_sqrt(x); }

/* Copies bytes between blocks that do not overlap. */
static inline void fibrad_copy(void *to, const void *from, size_t bytes) { __builtin_memcpy(to, from, bytes); }

static inline void fibrad_zero(void *to, size_t bytes) { __builtin_memset(to, 0, bytes); }

#endif

/* For the few functions whose calls would cost more than they do, and which the compiler takes for too long. */
#define FIBRAD_INLINE static inline __attribute__((always_inline))

/* From here on never a call: plain C, and a builtin that clears the sign bit. */

static inline double fibrad_abs(double x) { return __builtin_fabs(x); }
static inline double fibrad_min(double a, double b) { return a < b ? a : b; }
static inline double fibrad_max(double a, double b) { return a > b ? a : b; }

/* Adds to a sum that several threads add to at once; returns what it was before. */
static inline size_t fibrad_add_at_once(size_t *sum, size_t more) {
    return __atomic_fetch_add(sum, more, __ATOMIC_SEQ_CST);
}

/* False for NaN and the infinities. */
static inline bool fibrad_finite(double x) { return x - x == 0; }

/* How many bits are set. gcc makes this one instruction where there is one; the builtin would be a call of
 * libgcc where there is none. */
static inline uint32_t fibrad_count_bits(uint64_t x) {
    x -= x >> 1 & 0x5555555555555555;
    x = (x & 0x3333333333333333) + (x >> 2 & 0x3333333333333333);
    x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0f;
    return (uint32_t)(x * 0x0101010101010101 >> 56);
}

/* The largest whole number not above x; from 2^52 on every number is whole. NaN gives NaN. */
static inline double fibrad_floor(double x) {
    if (!(fibrad_abs(x) < 0x1p52)) return x;
    double whole = (double)(int64_t)x;
    return whole > x ? whole - 1 : whole;
}

#endif
