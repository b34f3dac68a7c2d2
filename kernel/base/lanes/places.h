/* places.h - the lanes that a mask selects out of four, for instruction sets that cannot compress.
 * SPDX-License-Identifier: MIT
 */
#ifndef FIBRAD_PLACES_H
#define FIBRAD_PLACES_H

#include <emmintrin.h>
#include <stdint.h>
#include "base/port.h"

/* first + l for the lanes l < 4 given by bits, side by side at p, which has room for all; returns how many. The branch
 * at the end of a loop over the bits would nearly always be mispredicted. */
static inline uint32_t fibrad_compress_places(uint32_t *p, uint32_t bits, uint32_t first) {
    static const _Alignas(16)
        uint32_t lane[16][4] = {{0}, {0},    {1},    {0, 1},    {2},    {0, 2},    {1, 2},    {0, 1, 2},
                                {3}, {0, 3}, {1, 3}, {0, 1, 3}, {2, 3}, {0, 2, 3}, {1, 2, 3}, {0, 1, 2, 3}};
    __m128i named = _mm_load_si128((const __m128i *)(const void *)lane[bits]);
    _mm_storeu_si128((__m128i *)(void *)p, _mm_add_epi32(named, _mm_set1_epi32((int)first)));
    return fibrad_count_bits(bits);
}

#endif
