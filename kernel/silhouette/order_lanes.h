/* order_lanes.h - sorts numbers by keys in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_SILHOUETTE_ORDER_LANES_H
#define FIBRAD_SILHOUETTE_ORDER_LANES_H

#include <stdbool.h>
#include <stddef.h>

/* The number of vectors that share what is the same in all lanes. */
#define FIBRAD_ORDER_BLOCK (VF_LANES == 16 ? 1 : VF_LANES == 8 ? 2 : 4)

/* Sorts numbers from 0 on by their keys. To do so, it counts for each key, in lanes, how many keys are less. False:
 * some keys are equal, and the order is not written. Keys and ranks are written up to the next block, and keys four
 * beyond it. */
static inline bool fibrad_order_keys(float *key, size_t count, uint32_t *rank, uint32_t *order) {
    size_t sum = 0;
    for (size_t b = 0; b < FIBRAD_ORDER_BLOCK; b++) vf_storeu(key + count + b * VF_LANES, vf_set1(__builtin_inff()));
    for (size_t k = 0; k < count; k += FIBRAD_ORDER_BLOCK * VF_LANES) {
        vf at[FIBRAD_ORDER_BLOCK];
        vn before[FIBRAD_ORDER_BLOCK];
#pragma GCC unroll 4
        for (int b = 0; b < FIBRAD_ORDER_BLOCK; b++) at[b] = vf_load(key + k + b * VF_LANES), before[b] = vn_set1(0);
        for (size_t j = 0; j < count; j += 4) {
#pragma GCC unroll 4
            for (size_t l = 0; l < 4; l++) {
                const vf other = vf_set1(key[j + l]);
#pragma GCC unroll 4
                for (int b = 0; b < FIBRAD_ORDER_BLOCK; b++) before[b] = vn_count_lt(before[b], other, at[b]);
            }
        }
#pragma GCC unroll 4
        for (int b = 0; b < FIBRAD_ORDER_BLOCK; b++) vn_store(rank + k + b * VF_LANES, before[b]);
    }
    for (size_t k = 0; k < count; k++) {
        const size_t own = rank[k];
        order[own] = (uint32_t)k, sum += own;
    }
    order[count] = (uint32_t)count;
    return sum == count * (count - 1) / 2; /* equal keys share the lowest of their ranks */
}

#endif
