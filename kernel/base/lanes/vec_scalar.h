/* clang-format off */
/* vec_scalar.h - lanes of one: the portable version that all others must equal bit for bit. SPDX-License-Identifier: MIT
 *
 * The operations every vec_*.h offers, none of which mixes lanes, so that a result does not depend on their number:
 *   vd   VD_LANES doubles    + - * / (a number beside a vector stands for itself in every lane)
 *                            vd_set1 vd_load vd_store vd_sqrt vd_min vd_max vd_abs
 *                            vd_loadu vd_storeu (any address), vd_load_float vd_store_float (rounded)
 *                            vd_store_numbers(p, a): whole numbers >= 0 as uint32_t
 *                            vd_load_short (whole numbers of 16 bits)
 *                            vd_lt vd_le (masks) vd_select(mask, if set, if clear)
 *                            vd_lookup(table, size, k): table[k] for lanes of whole numbers k < size (< the table's
 *                            length in lanes whose result is not used); the table is a whole number of vectors long
 *                            vd_gather(table, k): table[k[l]] for lane l
 *                            vd_compress(p, bits, a): the lanes given by bits side by side at p, which has room for all
 *                            vd_replace(a, lane, x): a with x in one lane
 *                            vd_compress_places(p, bits, first): first + l for them; returns how many
 *   vm   a mask of vd lanes  & | vm_not vm_bits (bit l = lane l)
 *   vf   VF_LANES floats     + - * / vf_set1 vf_load vf_storeu vf_sqrt vf_min vf_max
 *                            vf_lt (mask) vf_lt_bits (bit l = lane l) vf_select(mask, if set, if clear)
 *                            vf_compress(p, bits, a), vf_compress_places(p, bits, first): as those of vd
 *   vw   a mask of vf lanes  & |
 *   vn   VF_LANES numbers    vn_zero vn_load vn_store
 *                            vn_count_lt(n, a, b): n, and one more where a < b
 *                            vn_compress(p, bits, from): those of the numbers at `from`; returns how many
 *                            vn_some_bits(p): which of those at p, any address, are not 0
 *                            & | ~
 *                            vn_below(k): the bits below k, the float k rounded to a whole number, |k| < 2^31; none if k <= 0,
 *                            all 32 if k >= 32
 *                            vn_none(n): whether all are 0
 *                            vn_count_bits(n, count): bits that are set in `count` vectors, 1 to 16
 * Other loads and stores are aligned to the vector. min and max are (a < b ? a : b) and (a > b ? a : b), as x86 has them.
 * 0 - a, not -a, where a sign turns: the zero it makes is positive. */
/* clang-format on */
#ifndef FIBRAD_VEC_SCALAR_H
#define FIBRAD_VEC_SCALAR_H

#include <stdbool.h>
#include <stdint.h>
#include "base/port.h"

#define VD_LANES 1
#define VF_LANES 1

typedef double vd;
typedef int vm;
typedef float vf;
typedef int vw;
typedef uint32_t vn;

static inline vd vd_set1(double a) { return a; }
static inline vd vd_load(const double *p) { return *p; }
static inline vd vd_lookup(const double *table, uint32_t size, vd k) { return (void)size, table[(uint32_t)k]; }
static inline void vd_compress(double *p, uint32_t bits, vd a) {
    (void)bits, *p = a; /* there is room, and no branch */
}
static inline vd vd_replace(vd a, uint32_t lane, double x) { return (void)a, (void)lane, x; }
static inline uint32_t vd_compress_places(uint32_t *p, uint32_t bits, uint32_t first) {
    *p = first;
    return bits;
}
static inline vd vd_gather(const double *table, const uint32_t *k) { return table[*k]; }
static inline vd vd_loadu(const double *p) { return *p; }
static inline void vd_store(double *p, vd a) { *p = a; }
static inline void vd_storeu(double *p, vd a) { *p = a; }
static inline vd vd_load_float(const float *p) { return *p; }
static inline vd vd_load_short(const uint16_t *p) { return *p; }
static inline void vd_store_float(float *p, vd a) { *p = (float)a; }
static inline void vd_store_numbers(uint32_t *p, vd a) { *p = (uint32_t)a; }
static inline vd vd_sqrt(vd a) { return fibrad_sqrt(a); }
static inline vd vd_min(vd a, vd b) { return a < b ? a : b; }
static inline vd vd_max(vd a, vd b) { return a > b ? a : b; }
static inline vd vd_abs(vd a) { return __builtin_fabs(a); }
static inline vm vd_lt(vd a, vd b) { return a < b; }
static inline vm vd_le(vd a, vd b) { return a <= b; }
static inline vd vd_select(vm m, vd a, vd b) { return m ? a : b; }
static inline vm vm_not(vm a) { return !a; }
static inline uint32_t vm_bits(vm a) { return (uint32_t)a; }

static inline vf vf_set1(float a) { return a; }
static inline vf vf_load(const float *p) { return *p; }
static inline void vf_storeu(float *p, vf a) { *p = a; }
static inline vf vf_sqrt(vf a) { return (float)fibrad_sqrt(a); } /* rounded twice, and yet right (Figueroa 1995) */
static inline vf vf_min(vf a, vf b) { return a < b ? a : b; }
static inline vf vf_max(vf a, vf b) { return a > b ? a : b; }
static inline vw vf_lt(vf a, vf b) { return a < b; }
static inline vf vf_select(vw m, vf a, vf b) { return m ? a : b; }
static inline uint32_t vf_lt_bits(vf a, vf b) { return a < b; }
static inline vn vn_zero(void) { return 0; }
static inline vn vn_load(const uint32_t *p) { return *p; }
static inline void vn_store(uint32_t *p, vn n) { *p = n; }
static inline uint32_t vn_some_bits(const uint32_t *p) { return *p != 0; }
static inline vn vn_count_lt(vn n, vf a, vf b) { return n + (a < b); }
static inline vn vn_below(vf k) {
    uint32_t bits;
    k = (k > 0 ? k < 32 ? k : 32 : 0) + 0x1.8p23f;
    fibrad_copy(&bits, &k, sizeof bits);
    return (uint32_t)((UINT64_C(1) << (bits & 63)) - 1);
}
static inline bool vn_none(vn n) { return n == 0; }
static inline uint32_t vn_count_bits(const vn *n, uint32_t count) {
    uint32_t bits = 0;
    for (uint32_t k = 0; k < count; k++) bits += fibrad_count_bits(n[k]);
    return bits;
}
static inline void vf_compress(float *p, uint32_t bits, vf a) { (void)bits, *p = a; }
static inline uint32_t vn_compress(uint32_t *p, uint32_t bits, const uint32_t *from) {
    *p = *from;
    return bits;
}
static inline uint32_t vf_compress_places(uint32_t *p, uint32_t bits, uint32_t first) {
    return vd_compress_places(p, bits, first);
}

#endif
