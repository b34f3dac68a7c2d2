/* vec_avx2.h - four doubles, eight floats. What the operations are: vec_scalar.h. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_VEC_AVX2_H
#define FIBRAD_VEC_AVX2_H

#include <stdbool.h>
#include <stdint.h>
#include <immintrin.h>
#include "base/lanes/places.h"

#define VD_LANES 4
#define VF_LANES 8

#define MM(operation) _mm256_##operation

typedef __m256d vd;
typedef __m256i vm; /* integers have & and | */
typedef __m256 vf;
typedef __m256i vw;
typedef __m256i vn;

#include "base/lanes/vec_x86.h"

static inline vd vd_lookup(const double *table, uint32_t size, vd k) {
    __m128i i = _mm256_cvttpd_epi32(k);
    (void)size;
    return _mm256_set_pd(table[_mm_extract_epi32(i, 3)], table[_mm_extract_epi32(i, 2)], table[_mm_extract_epi32(i, 1)],
                         table[_mm_extract_epi32(i, 0)]);
}
static inline void vd_compress(double *p, uint32_t bits, vd a) {
    /* the halves of doubles that move to the front */
    static const uint32_t half[16][8] = {{0},
                                         {0, 1},
                                         {2, 3},
                                         {0, 1, 2, 3},
                                         {4, 5},
                                         {0, 1, 4, 5},
                                         {2, 3, 4, 5},
                                         {0, 1, 2, 3, 4, 5},
                                         {6, 7},
                                         {0, 1, 6, 7},
                                         {2, 3, 6, 7},
                                         {0, 1, 2, 3, 6, 7},
                                         {4, 5, 6, 7},
                                         {0, 1, 4, 5, 6, 7},
                                         {2, 3, 4, 5, 6, 7},
                                         {0, 1, 2, 3, 4, 5, 6, 7}};
    __m256i order = _mm256_loadu_si256((const __m256i *)(const void *)half[bits & 15]);
    _mm256_storeu_ps((float *)(void *)p, _mm256_permutevar8x32_ps(_mm256_castpd_ps(a), order));
}
static inline vd vd_replace(vd a, uint32_t lane, double x) {
    static const uint64_t ones[8] = {0, 0, 0, UINT64_MAX};
    __m256d there = _mm256_loadu_pd((const double *)(const void *)(ones + 3 - lane));
    return _mm256_blendv_pd(a, _mm256_set1_pd(x), there);
}
static inline uint32_t vd_compress_places(uint32_t *p, uint32_t bits, uint32_t first) {
    fibrad_compress_places(p, bits, first);
    return fibrad_count_bits(bits);
}
static inline vd vd_gather(const double *table, const uint32_t *k) {
    return _mm256_set_pd(table[k[3]], table[k[2]], table[k[1]], table[k[0]]);
}
static inline vd vd_load_float(const float *p) { return _mm256_cvtps_pd(_mm_load_ps(p)); }
static inline vd vd_load_short(const uint16_t *p) {
    return _mm256_cvtepi32_pd(_mm_cvtepu16_epi32(_mm_loadl_epi64((const __m128i *)(const void *)p)));
}
static inline void vd_store_float(float *p, vd a) { _mm_store_ps(p, _mm256_cvtpd_ps(a)); }
static inline void vd_store_numbers(uint32_t *p, vd a) {
    _mm_store_si128((__m128i *)(void *)p, _mm256_cvttpd_epi32(a));
}
static inline vd vd_abs(vd a) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), a); }
static inline vm vd_lt(vd a, vd b) { return _mm256_castpd_si256(_mm256_cmp_pd(a, b, _CMP_LT_OQ)); }
static inline vm vd_le(vd a, vd b) { return _mm256_castpd_si256(_mm256_cmp_pd(a, b, _CMP_LE_OQ)); }
static inline vd vd_select(vm m, vd a, vd b) { return _mm256_blendv_pd(b, a, _mm256_castsi256_pd(m)); }
static inline vm vm_not(vm a) { return ~a; }
static inline uint32_t vm_bits(vm a) { return (uint32_t)_mm256_movemask_pd(_mm256_castsi256_pd(a)); }

static inline vw vf_lt(vf a, vf b) { return _mm256_castps_si256(_mm256_cmp_ps(a, b, _CMP_LT_OQ)); }
static inline vf vf_select(vw m, vf a, vf b) { return _mm256_blendv_ps(b, a, _mm256_castsi256_ps(m)); }
static inline uint32_t vf_lt_bits(vf a, vf b) { return (uint32_t)_mm256_movemask_ps(_mm256_cmp_ps(a, b, _CMP_LT_OQ)); }
static inline vn vn_zero(void) { return _mm256_setzero_si256(); }
static inline vn vn_load(const uint32_t *p) { return _mm256_load_si256((const __m256i *)(const void *)p); }
static inline void vn_store(uint32_t *p, vn n) { _mm256_store_si256((__m256i *)(void *)p, n); }
static inline uint32_t vn_some_bits(const uint32_t *p) {
    __m256i n = _mm256_loadu_si256((const __m256i *)(const void *)p);
    return ~(uint32_t)_mm256_movemask_ps(_mm256_castsi256_ps(_mm256_cmpeq_epi32(n, _mm256_setzero_si256()))) & 255;
}
static inline vn vn_count_lt(vn n, vf a, vf b) {
    return _mm256_sub_epi32(n, _mm256_castps_si256(_mm256_cmp_ps(a, b, _CMP_LT_OQ)));
}
/* Shifts by 32 and more leave no bits. */
static inline vn vn_below(vf k) {
    const vn by = MM(max_epi32)(MM(cvtps_epi32)(k), vn_zero()), all = MM(set1_epi32)(-1);
    return MM(andnot_si256)(MM(sllv_epi32)(all, by), all);
}
static inline bool vn_none(vn n) { return _mm256_testz_si256(n, n); }
/* Words are counted by ordinary instructions, which leave vector units to the caller. */
static inline uint32_t vn_count_bits(const vn *n, uint32_t count) {
    uint32_t bits = 0;
#pragma GCC unroll 16
    for (uint32_t k = 0; k < count; k++) {
        _Alignas(32) uint64_t word[4];
        _mm256_store_si256((__m256i *)(void *)word, n[k]);
#pragma GCC unroll 4
        for (int l = 0; l < 4; l++) bits += fibrad_count_bits(word[l]);
    }
    return bits;
}
static inline void vf_compress(float *p, uint32_t bits, vf a) {
    __m128 low = _mm256_castps256_ps128(a), high = _mm256_extractf128_ps(a, 1);
    _mm_storeu_ps(p, _mm_permutevar_ps(low, (__m128i)fibrad_named_lanes(bits & 15)));
    _mm_storeu_ps(p + fibrad_count_bits(bits & 15), _mm_permutevar_ps(high, (__m128i)fibrad_named_lanes(bits >> 4)));
}
static inline uint32_t vn_compress(uint32_t *p, uint32_t bits, const uint32_t *from) {
    vf_compress((float *)(void *)p, bits, _mm256_load_ps((const float *)(const void *)from));
    return fibrad_count_bits(bits);
}
static inline uint32_t vf_compress_places(uint32_t *p, uint32_t bits, uint32_t first) {
    fibrad_compress_places(p, bits & 15, first);
    fibrad_compress_places(p + fibrad_count_bits(bits & 15), bits >> 4, first + 4);
    return fibrad_count_bits(bits);
}

#endif
