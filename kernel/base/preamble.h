/* preamble.h - the beginning of fibrad.c, the kernel in two files. SPDX-License-Identifier: MIT
 *
 * Pragmas do here what flags do in the Makefile. Products and sums are rounded one by one. gcc 12 fuses them in vectors
 * that it makes itself, whatever the first pragma says. Square roots are instructions, not calls that may set errno. */
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#elif defined(__GNUC__)
#pragma GCC optimize("fp-contract=off")
#if defined(__FMA__) || defined(__FMA4__) || defined(__AVX512F__)
#pragma GCC optimize("no-tree-vectorize")
#endif
#endif

#if defined(__x86_64__)
#include <immintrin.h>
#define FIBRAD_WITH_SSE2
#define FIBRAD_WITH_AVX2
#define FIBRAD_WITH_AVX512
#elif defined(__aarch64__)
#include <arm_neon.h>
#define FIBRAD_WITH_NEON
#endif

#define FIBRAD_PORT_GIVEN
#include <stddef.h>
#if defined(__x86_64__)
static inline double fibrad_sqrt(double x) { return _mm_cvtsd_f64(_mm_sqrt_pd(_mm_set_sd(x))); }
#elif defined(__aarch64__)
static inline double fibrad_sqrt(double x) {
    __asm__("fsqrt %d0, %d1" : "=w"(x) : "w"(x));
    return x;
}
#elif defined(__i386__) && defined(__SSE2__)
static inline double fibrad_sqrt(double x) {
    __asm__("sqrtsd %1, %0" : "=x"(x) : "x"(x));
    return x;
}
#elif defined(__ARM_FP) && __ARM_FP & 8 /* double precision */
static inline double fibrad_sqrt(double x) {
    __asm__("vsqrt.f64 %P0, %P1" : "=w"(x) : "w"(x));
    return x;
}
#else                                   /* the program is linked with -lm */
static inline double fibrad_sqrt(double x) { return __builtin_sqrt(x); }
#endif
static inline void fibrad_copy(void *to, const void *from, size_t bytes) { __builtin_memcpy(to, from, bytes); }
static inline void fibrad_zero(void *to, size_t bytes) { __builtin_memset(to, 0, bytes); }
