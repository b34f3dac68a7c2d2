/* vec_sse2.h - two doubles, four floats. What the operations are: vec_scalar.h. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_VEC_SSE2_H
#define FIBRAD_VEC_SSE2_H

#include <stdbool.h>
#include <stdint.h>
#include <immintrin.h>
#include "base/lanes/vec_four.h"

#define VD_LANES 2
#define VF_LANES 4

#define MM(operation) _mm_##operation

typedef __m128d vd;
typedef __m128i vm; /* integers have & and | */
typedef __m128 vf;
typedef __m128i vw;
typedef __m128i vn;

#include "base/lanes/vec_x86.h"

static inline vd vd_lookup(const double *table, uint32_t size, vd k) {
    (void)size;
    return _mm_set_pd(table[(uint32_t)_mm_cvtsd_f64(_mm_unpackhi_pd(k, k))], table[(uint32_t)_mm_cvtsd_f64(k)]);
}
static inline void vd_compress(double *p, uint32_t bits, vd a) {
    static const uint64_t second[4] = {0, 0, UINT64_MAX, 0}; /* where the second lane moves to the front */
    __m128d high = _mm_castsi128_pd(_mm_loadl_epi64((const __m128i *)(const void *)(second + bits)));
    __m128d front = _mm_or_pd(_mm_and_pd(high, _mm_unpackhi_pd(a, a)), _mm_andnot_pd(high, a));
    _mm_storeu_pd(p, front);
}
static inline vd vd_replace(vd a, uint32_t lane, double x) {
    static const uint64_t ones[4] = {0, UINT64_MAX, 0, 0};
    __m128d there = _mm_loadu_pd((const double *)(const void *)(ones + 1 - lane));
    return _mm_or_pd(_mm_and_pd(there, _mm_set1_pd(x)), _mm_andnot_pd(there, a));
}
static inline vd vd_gather(const double *table, const uint32_t *k) { return _mm_set_pd(table[k[1]], table[k[0]]); }
static inline vd vd_load_float(const float *p) {
    return _mm_cvtps_pd(_mm_castsi128_ps(_mm_loadl_epi64((const __m128i *)(const void *)p)));
}
static inline vd vd_load_short(const uint16_t *p) { return _mm_set_pd(p[1], p[0]); }
static inline void vd_store_float(float *p, vd a) { _mm_storel_pi((__m64 *)(void *)p, _mm_cvtpd_ps(a)); }
static inline void vd_store_numbers(uint32_t *p, vd a) { _mm_storel_epi64((__m128i *)(void *)p, _mm_cvttpd_epi32(a)); }
static inline vd vd_abs(vd a) { return _mm_andnot_pd(_mm_set1_pd(-0.0), a); }
static inline vm vd_lt(vd a, vd b) { return _mm_castpd_si128(_mm_cmplt_pd(a, b)); }
static inline vm vd_le(vd a, vd b) { return _mm_castpd_si128(_mm_cmple_pd(a, b)); }
static inline vd vd_select(vm m, vd a, vd b) {
    __m128d set = _mm_castsi128_pd(m);
    return _mm_or_pd(_mm_and_pd(set, a), _mm_andnot_pd(set, b));
}
static inline vm vm_not(vm a) { return ~a; }
static inline uint32_t vm_bits(vm a) { return (uint32_t)_mm_movemask_pd(_mm_castsi128_pd(a)); }

static inline vw vf_lt(vf a, vf b) { return _mm_castps_si128(_mm_cmplt_ps(a, b)); }
static inline vf vf_select(vw m, vf a, vf b) {
    __m128 set = _mm_castsi128_ps(m);
    return _mm_or_ps(_mm_and_ps(set, a), _mm_andnot_ps(set, b));
}
static inline uint32_t vf_lt_bits(vf a, vf b) { return (uint32_t)_mm_movemask_ps(_mm_cmplt_ps(a, b)); }
static inline vn vn_zero(void) { return _mm_setzero_si128(); }
static inline vn vn_load(const uint32_t *p) { return _mm_load_si128((const __m128i *)(const void *)p); }
/* The exponent of a float is shifted into its place. 2^31 comes out right, too: it is what x86 gives for no number. */
static inline vn vn_power_of_two(vf k) {
    __m128i exponent = _mm_add_epi32(_mm_cvtps_epi32(k), _mm_set1_epi32(127));
    return _mm_cvttps_epi32(_mm_castsi128_ps(_mm_slli_epi32(exponent, 23)));
}
static inline void vn_store(uint32_t *p, vn n) { _mm_store_si128((__m128i *)(void *)p, n); }
static inline uint32_t vn_some_bits(const uint32_t *p) {
    __m128i n = _mm_loadu_si128((const __m128i *)(const void *)p);
    return ~(uint32_t)_mm_movemask_ps(_mm_castsi128_ps(_mm_cmpeq_epi32(n, _mm_setzero_si128()))) & 15;
}
static inline vn vn_count_lt(vn n, vf a, vf b) { return _mm_sub_epi32(n, _mm_castps_si128(_mm_cmplt_ps(a, b))); }
/* Lanes cannot be shifted one by one here, so a power of two loses one. */
static inline vn vn_below(vf k) {
    const __m128 whole = _mm_min_ps(_mm_max_ps(k, _mm_setzero_ps()), _mm_set1_ps(32));
    const __m128i below = _mm_sub_epi32(vn_power_of_two(whole), _mm_set1_epi32(1));
    return _mm_or_si128(below, _mm_castps_si128(_mm_cmpge_ps(whole, _mm_set1_ps(31.5f))));
}
static inline bool vn_none(vn n) { return _mm_movemask_epi8(_mm_cmpeq_epi32(n, _mm_setzero_si128())) == 0xffff; }
static inline uint32_t vn_count_bits(const vn *n, uint32_t count) {
    const __m128i one = _mm_set1_epi8(0x55), two = _mm_set1_epi8(0x33), four = _mm_set1_epi8(0x0f);
    __m128i bytes = _mm_setzero_si128();
    for (uint32_t k = 0; k < count; k++) {
        __m128i part = _mm_sub_epi8(n[k], _mm_and_si128(_mm_srli_epi32(n[k], 1), one));
        part = _mm_add_epi8(_mm_and_si128(part, two), _mm_and_si128(_mm_srli_epi32(part, 2), two));
        bytes = _mm_add_epi8(bytes, _mm_and_si128(_mm_add_epi8(part, _mm_srli_epi32(part, 4)), four));
    }
    const __m128i sum = _mm_sad_epu8(bytes, _mm_setzero_si128());
    return (uint32_t)_mm_cvtsi128_si32(_mm_add_epi64(sum, _mm_unpackhi_epi64(sum, sum)));
}
static inline void vf_compress(float *p, uint32_t bits, vf a) {
    _Alignas(16) uint32_t lane[4];
    vn_store(lane, _mm_castps_si128(a));
    fibrad_compress_four((uint32_t *)(void *)p, bits, lane);
}

#endif
