/* pairs.h - what pairs of spheres exchange, in whole numbers. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SILHOUETTE_PAIRS_H
#define FIBRAD_SILHOUETTE_PAIRS_H

#include "base/random.h"
#include "scene/scene.h"

/* The area that two spheres exchange is counted in units of 2^-44 of the square of the smaller radius. Sums of 65,536
 * lines stay below 2^63. Whole numbers add up to the same bits in any order. */
#define FIBRAD_PAIR_UNITS 0x1p44

/* What lies beyond all spheres has the name FIBRAD_NONE. Sometimes it matters along which line and in which sense it is
 * seen. Then its name is FIBRAD_PAIR_OPEN + 2 line + sense. The sense is 0 along the line and 1 against it. */
#define FIBRAD_PAIR_OPEN 0x80000000u
static inline bool fibrad_pair_opens(uint32_t name) { return name >= FIBRAD_PAIR_OPEN; }

/* A pair in a collection. `first` is less than `second`. Both are positions in scene order, or names. */
typedef struct fibrad_pair {
    uint32_t first, second;
    int64_t sum[2]; /* over even and over odd lines */
} fibrad_pair;

/* The pairs of a collection; NULL if it has no block. */
static inline fibrad_pair *fibrad_pairs_of(const fibrad_pairs *pairs) {
    unsigned char *block = pairs->memory.block;
    return block == NULL ? NULL : (fibrad_pair *)(void *)(block + ((size_t) - (uintptr_t)block & 7));
}

/* The sums of a pair in the table of a task. The table has open addressing. */
typedef struct fibrad_pair_sum {
    uint64_t key; /* first << 32 | second; UINT64_MAX: free */
    int64_t sum[2];
} fibrad_pair_sum;

typedef struct fibrad_pair_table {
    fibrad_pair_sum *slot; /* [slots], a power of two */
    uint32_t slots, used;
    int shift; /* 64 less the bits of `slots` */
} fibrad_pair_table;

/* Whether a table has room for so many more pairs, and keeps a fourth of its slots free. */
static inline bool fibrad_pair_room(const fibrad_pair_table *table, uint32_t pairs) {
    return table->used + pairs <= table->slots / 4 * 3;
}

static inline uint64_t fibrad_pair_key(uint32_t i, uint32_t j) {
    const uint32_t low = i < j ? i : j, high = i < j ? j : i; /* no branch: it could not be predicted */
    return (uint64_t)low << 32 | high;
}

/* The slot where a search for a key begins. */
static inline uint32_t fibrad_pair_place(const fibrad_pair_table *table, uint64_t key) {
    key *= FIBRAD_GOLDEN;
    key = (key ^ key >> 32) * FIBRAD_GOLDEN; /* one product would place pairs of neighbours side by side */
    return (uint32_t)(key >> table->shift);
}

/* The slot of a key. The search begins at a slot. */
static inline fibrad_pair_sum *fibrad_pair_slot(fibrad_pair_table *table, uint64_t key, uint32_t at) {
    while (table->slot[at].key != key) {
        if (table->slot[at].key == UINT64_MAX) {
            table->slot[at].key = key;
            table->used++;
            break;
        }
        at = (at + 1) & (table->slots - 1);
    }
    return &table->slot[at];
}

/* Adds what a pair exchanges over even and over odd lines. */
static inline void fibrad_pair_add(fibrad_pair_table *table, uint32_t i, uint32_t j, int64_t even, int64_t odd) {
    const uint64_t key = fibrad_pair_key(i, j);
    fibrad_pair_sum *slot = fibrad_pair_slot(table, key, fibrad_pair_place(table, key));
    slot->sum[0] += even, slot->sum[1] += odd;
}

#endif
