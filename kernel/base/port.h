/* port.h - all that the kernel takes from the C library and the compiler. SPDX-License-Identifier: MIT
 *
 * For another target, -DFIBRAD_PORT_HEADER='"my_port.h"' names a header that defines fibrad_sqrt, fibrad_copy and
 * fibrad_zero as below. The square root must round correctly (IEEE 754). So must all arithmetic, and NaN and infinity
 * must be told from numbers: with -ffast-math, -Ofast and the like the kernel does not compile. */
#ifndef FIBRAD_BASE_PORT_H
#define FIBRAD_BASE_PORT_H

#include <float.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* 16: only half precision is computed in another precision */
#if FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16
#error "fibrad needs arithmetic in the precision of its types (on 32-bit x86: -msse2 -mfpmath=sse)"
#endif

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) ||                               \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__)
#error "fibrad needs IEEE 754 arithmetic with NaN and infinity: compile it without -ffast-math and -Ofast"
#endif

#if defined(FIBRAD_PORT_HEADER)
#include FIBRAD_PORT_HEADER
#elif !defined(FIBRAD_PORT_GIVEN) /* a file that includes this one may define the functions */

/* One instruction if the machine has one and -fno-math-errno is set. Otherwise a call of sqrt. */
static inline double fibrad_sqrt(double x) { return __builtin_sqrt(x); }

/* Copies bytes between blocks that do not overlap. */
static inline void fibrad_copy(void *to, const void *from, size_t bytes) { __builtin_memcpy(to, from, bytes); }

static inline void fibrad_zero(void *to, size_t bytes) { __builtin_memset(to, 0, bytes); }

#endif

#define FIBRAD_PI 3.14159265358979323846

/* For few functions: a call would take longer than the function itself, but the compiler would make a call. */
#define FIBRAD_INLINE static inline __attribute__((always_inline))

/* The functions below never need a library. */

static inline double fibrad_abs(double x) { return __builtin_fabs(x); }
static inline double fibrad_min(double a, double b) { return a < b ? a : b; }
static inline double fibrad_max(double a, double b) { return a > b ? a : b; }

/* Adds to a sum that several threads add to at once; returns what it was before. */
static inline size_t fibrad_add_at_once(size_t *sum, size_t more) {
    return __atomic_fetch_add(sum, more, __ATOMIC_SEQ_CST);
}

/* False for NaN and the infinities. */
static inline bool fibrad_finite(double x) { return x - x == 0; }

/* The number of set bits. gcc makes one instruction of this where there is one. The builtin may call libgcc instead. */
static inline uint32_t fibrad_count_bits(uint64_t x) {
    x -= x >> 1 & 0x5555555555555555;
    x = (x & 0x3333333333333333) + (x >> 2 & 0x3333333333333333);
    x = (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0f;
    return (uint32_t)(x * 0x0101010101010101 >> 56);
}

/* The largest whole number not above x. From 2^52 on every double is a whole number. NaN gives NaN. */
static inline double fibrad_floor(double x) {
    if (!(fibrad_abs(x) < 0x1p52)) return x;
    double whole = (double)(int64_t)x;
    return whole > x ? whole - 1 : whole;
}

#endif
