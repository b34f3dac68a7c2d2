/* places.h - the lanes that a mask selects out of four, for instruction sets that cannot compress.
 * SPDX-License-Identifier: MIT
 */
#ifndef FIBRAD_PLACES_H
#define FIBRAD_PLACES_H

#include <stdint.h>
#include "base/port.h"

typedef uint32_t fibrad_four __attribute__((vector_size(16)));

/* The lanes 0 to 3 whose bits are set, one after another from the first. */
static inline fibrad_four fibrad_named_lanes(uint32_t bits) {
    static const fibrad_four lane[16] = {{0}, {0},    {1},    {0, 1},    {2},    {0, 2},    {1, 2},    {0, 1, 2},
                                         {3}, {0, 3}, {1, 3}, {0, 1, 3}, {2, 3}, {0, 2, 3}, {1, 2, 3}, {0, 1, 2, 3}};
    return lane[bits];
}

/* Writes first + l to p for each lane l whose bit is set, one after another. p has room for four. A loop over the
 * bits would end in a branch that the processor nearly always predicts wrongly. */
static inline void fibrad_compress_places(uint32_t *p, uint32_t bits, uint32_t first) {
    const fibrad_four there = fibrad_named_lanes(bits) + first;
    fibrad_copy(p, &there, sizeof there);
}

/* Writes from[l] to p for each lane l whose bit is set, likewise. */
static inline void fibrad_compress_four(uint32_t *p, uint32_t bits, const uint32_t from[4]) {
    const fibrad_four lane = fibrad_named_lanes(bits);
    for (int l = 0; l < 4; l++) p[l] = from[lane[l]];
}

/* How many of four bits are set, for instruction sets that cannot count bits. */
static inline uint32_t fibrad_count_four(uint32_t bits) { return (uint32_t)(0x4332322132212110 >> 4 * bits & 15); }

#endif
