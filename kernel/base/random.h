/* random.h - numbers that depend on a seed and a counter alone. SPDX-License-Identifier: MIT
 *
 * Nothing is carried from one bundle of rays to the next, so that work may be shared out in any way. */
#ifndef FIBRAD_BASE_RANDOM_H
#define FIBRAD_BASE_RANDOM_H

#include "base/port.h"

/* A permutation of the 64-bit numbers in which every bit hangs on every other: variant 13 of D. Stafford, "Better bit
 * mixing" (2011), as used by G. L. Steele et al., OOPSLA 2014, "Fast splittable pseudorandom number generators". */
static inline uint64_t fibrad_mix(uint64_t x) {
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

/* The upper 53 bits of x as a fraction in [0, 1). */
static inline double fibrad_fraction(uint64_t x) { return (double)(int64_t)(x >> 11) * 0x1p-53; }

/* A stream of random numbers: draw k of stream s is mix(start(seed, s) + k odd constant). */
typedef struct fibrad_random {
    uint64_t counter;
} fibrad_random;

static inline fibrad_random fibrad_random_start(uint64_t seed, uint64_t stream) {
    return (fibrad_random){fibrad_mix(fibrad_mix(seed + 0x9e3779b97f4a7c15u) + stream)};
}

/* The next number, in [0, 1). */
static inline double fibrad_random_next(fibrad_random *random) {
    random->counter += 0x9e3779b97f4a7c15u;
    return fibrad_fraction(fibrad_mix(random->counter));
}

/* Number n ahead of the stream, 64 random bits, without moving it. */
static inline uint64_t fibrad_random_ahead(fibrad_random random, uint64_t n) {
    return fibrad_mix(random.counter + (n + 1) * 0x9e3779b97f4a7c15u);
}

/* Coordinate d [0, 5) of point k of a five-dimensional sequence that fills the unit cube evenly, whatever its first
 * point: multiples of g^-(d+1) modulo 1, g^6 = g + 1 (M. Roberts, "The unreasonable effectiveness of quasirandom
 * sequences", 2018), moved as a whole by the seed. */
static inline double fibrad_quasirandom(uint64_t seed, uint64_t k, int d) {
    static const uint64_t step[5] = {0xe19b01aa9d42c633u, 0xc6d1d6c8ed0c9631u, 0xaf36d01ef7518dbbu, 0x9a69443f36f710e6u,
                                     0x881403b9339bd42du};
    return fibrad_fraction(k * step[d] + fibrad_mix(seed ^ step[d]));
}

#endif
