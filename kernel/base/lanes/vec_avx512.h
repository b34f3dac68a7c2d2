/* vec_avx512.h - eight doubles, sixteen floats. What the operations are: vec_scalar.h. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_VEC_AVX512_H
#define FIBRAD_VEC_AVX512_H

#include <stdbool.h>
#include <stdint.h>
#include <immintrin.h>

#define VD_LANES 8
#define VF_LANES 16

#define MM(operation) _mm512_##operation

typedef __m512d vd;
typedef __mmask8 vm;
typedef __m512 vf;
typedef __mmask16 vw;
typedef __m512i vn;

#include "base/lanes/vec_x86.h"

/* Tables of one or two vectors stay in registers. A gather would wait until all stores to the table have ended. */
static inline vd vd_lookup(const double *table, uint32_t size, vd k) {
    __m512i index = _mm512_cvttpd_epi64(k);
    if (size > 16) return _mm512_i64gather_pd(index, table, 8);
    if (size > 8) return _mm512_permutex2var_pd(vd_load(table), index, vd_load(table + 8));
    return _mm512_permutexvar_pd(index, vd_load(table));
}
static inline void vd_compress(double *p, uint32_t bits, vd a) {
    _mm512_storeu_pd(p, _mm512_maskz_compress_pd((__mmask8)bits, a));
}
/* The empty statement keeps the compiler from a masked store, which would delay the next load. */
static inline vd vd_replace(vd a, uint32_t lane, double x) {
    a = _mm512_mask_mov_pd(a, (__mmask8)(1u << lane), _mm512_set1_pd(x));
    __asm__("" : "+v"(a));
    return a;
}
static inline uint32_t vd_compress_places(uint32_t *p, uint32_t bits, uint32_t first) {
    __m256i place = _mm256_add_epi32(_mm256_set1_epi32((int)first), _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7));
    _mm256_storeu_si256((__m256i *)(void *)p, _mm256_maskz_compress_epi32((__mmask8)bits, place));
    return (uint32_t)_mm_popcnt_u32(bits);
}
static inline vd vd_gather(const double *table, const uint32_t *k) {
    return _mm512_i32gather_pd(_mm256_loadu_si256((const __m256i *)(const void *)k), table, 8);
}
static inline vd vd_load_float(const float *p) { return _mm512_cvtps_pd(_mm256_load_ps(p)); }
static inline vd vd_load_short(const uint16_t *p) {
    return _mm512_cvtepi32_pd(_mm256_cvtepu16_epi32(_mm_load_si128((const __m128i *)(const void *)p)));
}
static inline void vd_store_float(float *p, vd a) { _mm256_store_ps(p, _mm512_cvtpd_ps(a)); }
static inline void vd_store_numbers(uint32_t *p, vd a) {
    _mm256_store_si256((__m256i *)(void *)p, _mm512_cvttpd_epi32(a));
}
static inline vd vd_abs(vd a) { return _mm512_abs_pd(a); }
static inline vm vd_lt(vd a, vd b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
static inline vm vd_le(vd a, vd b) { return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ); }
static inline vd vd_select(vm m, vd a, vd b) { return _mm512_mask_blend_pd(m, b, a); }
static inline vm vm_not(vm a) { return (vm)~a; }
static inline uint32_t vm_bits(vm a) { return a; }

static inline vw vf_lt(vf a, vf b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
static inline vf vf_select(vw m, vf a, vf b) { return _mm512_mask_blend_ps(m, b, a); }
static inline uint32_t vf_lt_bits(vf a, vf b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
static inline vn vn_zero(void) { return _mm512_setzero_si512(); }
static inline vn vn_load(const uint32_t *p) { return _mm512_load_si512(p); }
static inline void vn_store(uint32_t *p, vn n) { _mm512_store_si512((__m512i *)(void *)p, n); }
static inline uint32_t vn_some_bits(const uint32_t *p) {
    __m512i n = _mm512_loadu_si512(p);
    return _mm512_test_epi32_mask(n, n);
}
static inline vn vn_count_lt(vn n, vf a, vf b) {
    return _mm512_mask_add_epi32(n, _mm512_cmp_ps_mask(b, a, _CMP_GT_OQ), n, _mm512_set1_epi32(1));
}
/* Shifts by 32 and more leave no bits. */
static inline vn vn_below(vf k) {
    const vn by = MM(max_epi32)(MM(cvtps_epi32)(k), vn_zero()), all = MM(set1_epi32)(-1);
    return MM(andnot_si512)(MM(sllv_epi32)(all, by), all);
}
static inline bool vn_none(vn n) { return _mm512_test_epi32_mask(n, n) == 0; }
/* Words are counted by ordinary instructions, which leave vector units to the caller. */
static inline uint32_t vn_count_bits(const vn *n, uint32_t count) {
    uint32_t bits = 0;
#pragma GCC unroll 16
    for (uint32_t k = 0; k < count; k++) {
        _Alignas(64) uint64_t word[8];
        _mm512_store_si512(word, n[k]);
#pragma GCC unroll 8
        for (int l = 0; l < 8; l++) bits += (uint32_t)_mm_popcnt_u64(word[l]);
    }
    return bits;
}
static inline void vf_compress(float *p, uint32_t bits, vf a) {
    _mm512_storeu_ps(p, _mm512_maskz_compress_ps((__mmask16)bits, a));
}
static inline uint32_t vn_compress(uint32_t *p, uint32_t bits, const uint32_t *from) {
    _mm512_storeu_si512(p, _mm512_maskz_compress_epi32((__mmask16)bits, _mm512_load_si512(from)));
    return (uint32_t)_mm_popcnt_u32(bits);
}
static inline uint32_t vf_compress_places(uint32_t *p, uint32_t bits, uint32_t first) {
    __m512i lane = _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    __m512i place = _mm512_add_epi32(_mm512_set1_epi32((int)first), lane);
    _mm512_storeu_si512(p, _mm512_maskz_compress_epi32((__mmask16)bits, place));
    return (uint32_t)_mm_popcnt_u32(bits);
}

#endif
