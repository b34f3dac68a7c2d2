/* random.h - numbers that depend on a seed and a counter alone. SPDX-License-Identifier: MIT
 *
 * A number depends on no number before it. So threads may share the work in any way. */
#ifndef FIBRAD_BASE_RANDOM_H
#define FIBRAD_BASE_RANDOM_H

#include "base/port.h"

#define FIBRAD_GOLDEN UINT64_C(0x9e3779b97f4a7c15) /* 2^64 over the golden ratio, made odd */

/* A permutation of the 64-bit numbers in which each bit depends on all bits. Source: variant 13 of D. Stafford, "Better
 * bit mixing" (2011), as used by G. L. Steele et al., OOPSLA 2014, "Fast splittable pseudorandom number generators". */
static inline uint64_t fibrad_mix(uint64_t x) {
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

/* The upper 53 bits of x as a fraction in [0, 1). */
static inline double fibrad_fraction(uint64_t x) { return (double)(int64_t)(x >> 11) * 0x1p-53; }

/* A hash of several words: the hash of those before, and one more word. Quicker than fibrad_mix. Apply fibrad_mix to
 * the last hash. */
static inline uint64_t fibrad_hash_word(uint64_t hash, uint64_t word) {
    hash = (hash ^ word) * FIBRAD_GOLDEN;
    return hash ^ hash >> 32;
}

static inline uint64_t fibrad_hash_number(uint64_t hash, double number) {
    uint64_t word;
    fibrad_copy(&word, &number, sizeof word);
    return fibrad_hash_word(hash, word);
}

/* A stream of random numbers. Number k, counted from 1, is mix(mix(mix(seed + GOLDEN) + stream) + k GOLDEN). */
typedef struct fibrad_random {
    uint64_t counter;
} fibrad_random;

static inline fibrad_random fibrad_random_start(uint64_t seed, uint64_t stream) {
    return (fibrad_random){fibrad_mix(fibrad_mix(seed + FIBRAD_GOLDEN) + stream)};
}

/* The next number, in [0, 1). */
static inline double fibrad_random_next(fibrad_random *random) {
    random->counter += FIBRAD_GOLDEN;
    return fibrad_fraction(fibrad_mix(random->counter));
}

/* 64 random bits, number n of those that follow, from 0. The stream does not move. */
static inline uint64_t fibrad_random_ahead(fibrad_random random, uint64_t n) {
    return fibrad_mix(random.counter + (n + 1) * FIBRAD_GOLDEN);
}

/* Step of coordinate d of an additive recurrence in 4 or 5 dimensions, in units of 2^-64. The multiples k step of all
 * coordinates, modulo 1, fill the unit cube evenly for any number of points and from any first point. The steps are
 * g^-1 ... g^-D with g^(D+1) = g + 1. Source: M. Roberts, "The unreasonable effectiveness of quasirandom sequences"
 * (2018). */
static inline uint64_t fibrad_quasirandom_step(int dimensions, int d) {
    static const uint64_t step[2][5] = {
        {0xdb4f0b9175ae2165u, 0xbbe0563303a4615fu, 0xa0f2ec75a1fe1575u, 0x89e182857d9ed689u, 0},
        {0xe19b01aa9d42c633u, 0xc6d1d6c8ed0c9631u, 0xaf36d01ef7518dbbu, 0x9a69443f36f710e6u, 0x881403b9339bd42du}};
    return step[dimensions - 4][d];
}

/* Coordinate d of point k of this sequence, in [0, 1). The seed moves all points together. */
static inline double fibrad_quasirandom(int dimensions, int d, uint64_t k, uint64_t seed) {
    const uint64_t step = fibrad_quasirandom_step(dimensions, d);
    return fibrad_fraction(k * step + fibrad_mix(seed ^ step));
}

#endif
