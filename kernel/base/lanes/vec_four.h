/* vec_four.h - operations of the instruction sets with two doubles and four floats. What they are: vec_scalar.h.
 * SPDX-License-Identifier: MIT */
#include "base/lanes/places.h"

static inline uint32_t vd_compress_places(uint32_t *p, uint32_t bits, uint32_t first) {
    p[0] = first + (bits == 2);
    p[1] = first + 1;
    return (bits & 1) + (bits >> 1);
}
static inline uint32_t vn_compress(uint32_t *p, uint32_t bits, const uint32_t *from) {
    fibrad_compress_four(p, bits, from);
    return fibrad_count_four(bits);
}
static inline uint32_t vf_compress_places(uint32_t *p, uint32_t bits, uint32_t first) {
    fibrad_compress_places(p, bits, first);
    return fibrad_count_four(bits);
}
