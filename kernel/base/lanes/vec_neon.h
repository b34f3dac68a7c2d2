/* vec_neon.h - aarch64: two doubles, four floats. Operations: vec_scalar.h. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_VEC_NEON_H
#define FIBRAD_VEC_NEON_H

#include <arm_neon.h>
#include <stdbool.h>
#include <stdint.h>
#include "base/lanes/vec_four.h"

#define VD_LANES 2
#define VF_LANES 4

typedef float64x2_t vd;
typedef uint64x2_t vm;
typedef float32x4_t vf;
typedef uint32x4_t vw;
typedef uint32x4_t vn;

static inline vd vd_set1(double a) { return vdupq_n_f64(a); }
static inline vd vd_load(const double *p) { return vld1q_f64(p); }
static inline vd vd_lookup(const double *table, uint32_t size, vd k) {
    const uint64x2_t i = vcvtq_u64_f64(k);
    (void)size;
    return vcombine_f64(vld1_f64(table + vgetq_lane_u64(i, 0)), vld1_f64(table + vgetq_lane_u64(i, 1)));
}
static inline void vd_compress(double *p, uint32_t bits, vd a) {
    vst1q_lane_f64(p, a, 0);
    vst1q_lane_f64(p + (bits & 1), a, 1);
}
static inline vd vd_replace(vd a, uint32_t lane, double x) {
    static const uint64_t ones[4] = {0, UINT64_MAX, 0, 0};
    return vbslq_f64(vld1q_u64(ones + 1 - lane), vdupq_n_f64(x), a);
}
static inline vd vd_gather(const double *table, const uint32_t *k) {
    return vcombine_f64(vld1_f64(table + k[0]), vld1_f64(table + k[1]));
}
static inline vd vd_loadu(const double *p) { return vld1q_f64(p); }
static inline void vd_store(double *p, vd a) { vst1q_f64(p, a); }
static inline void vd_storeu(double *p, vd a) { vst1q_f64(p, a); }
static inline vd vd_load_float(const float *p) { return vcvt_f64_f32(vld1_f32(p)); }
static inline vd vd_load_short(const uint16_t *p) { return (vd){p[0], p[1]}; }
static inline void vd_store_float(float *p, vd a) { vst1_f32(p, vcvt_f32_f64(a)); }
static inline void vd_store_numbers(uint32_t *p, vd a) { vst1_u32(p, vmovn_u64(vcvtq_u64_f64(a))); }
static inline vd vd_sqrt(vd a) { return vsqrtq_f64(a); }
static inline vd vd_min(vd a, vd b) { return vbslq_f64(vcltq_f64(a, b), a, b); }
static inline vd vd_max(vd a, vd b) { return vbslq_f64(vcgtq_f64(a, b), a, b); }
static inline vd vd_abs(vd a) { return vabsq_f64(a); }
static inline vm vd_lt(vd a, vd b) { return vcltq_f64(a, b); }
static inline vm vd_le(vd a, vd b) { return vcleq_f64(a, b); }
static inline vd vd_select(vm m, vd a, vd b) { return vbslq_f64(m, a, b); }
static inline vm vm_not(vm a) { return ~a; }
static inline uint32_t vm_bits(vm a) { /* a lane is two halves of a word */
    return (uint32_t)(vget_lane_u64(vreinterpret_u64_u32(vmovn_u64(a)), 0) >> 31) & 3;
}

/* Bit l is set if lane l of the mask is set. */
static inline uint32_t vn_mask_bits(uint32x4_t mask) {
    const uint32x4_t bit = {1, 2, 4, 8};
    return vaddvq_u32(mask & bit);
}
static inline vf vf_set1(float a) { return vdupq_n_f32(a); }
static inline vf vf_load(const float *p) { return vld1q_f32(p); }
static inline void vf_storeu(float *p, vf a) { vst1q_f32(p, a); }
static inline vf vf_sqrt(vf a) { return vsqrtq_f32(a); }
static inline vf vf_min(vf a, vf b) { return vbslq_f32(vcltq_f32(a, b), a, b); }
static inline vw vf_lt(vf a, vf b) { return vcltq_f32(a, b); }
static inline vf vf_select(vw m, vf a, vf b) { return vbslq_f32(m, a, b); }
static inline vf vf_max(vf a, vf b) { return vbslq_f32(vcgtq_f32(a, b), a, b); }
static inline uint32_t vf_lt_bits(vf a, vf b) { return vn_mask_bits(vcltq_f32(a, b)); }
static inline vn vn_zero(void) { return vdupq_n_u32(0); }
static inline vn vn_load(const uint32_t *p) { return vld1q_u32(p); }
static inline void vn_store(uint32_t *p, vn n) { vst1q_u32(p, n); }
static inline uint32_t vn_some_bits(const uint32_t *p) {
    const uint32x4_t n = vld1q_u32(p);
    return vn_mask_bits(vtstq_u32(n, n));
}
static inline vn vn_count_lt(vn n, vf a, vf b) { return vsubq_u32(n, vcltq_f32(a, b)); }
/* Shifts by 32 and more leave no bits. */
static inline vn vn_below(vf k) {
    const int32x4_t by = vcvtnq_s32_f32(vf_min(vf_max(k, vf_set1(0)), vf_set1(32)));
    return ~vshlq_u32(vdupq_n_u32(UINT32_MAX), by);
}
static inline bool vn_none(vn n) { return vmaxvq_u32(n) == 0; }
static inline uint32_t vn_count_bits(const vn *n, uint32_t count) {
    uint8x16_t bytes = vdupq_n_u8(0);
    for (uint32_t k = 0; k < count; k++) bytes = vaddq_u8(bytes, vcntq_u8(vreinterpretq_u8_u32(n[k])));
    return vaddlvq_u8(bytes);
}
static inline void vf_compress(float *p, uint32_t bits, vf a) {
    _Alignas(16) uint32_t lane[4];
    vst1q_u32(lane, vreinterpretq_u32_f32(a));
    fibrad_compress_four((uint32_t *)(void *)p, bits, lane);
}

#endif
