/* sort.h - sorts numbers and the entries of a row by column. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_BASE_SORT_H
#define FIBRAD_BASE_SORT_H

#include <stdint.h>

/* Shell's method: insertion with falling gaps. It sorts in place in about count^1.3 steps, and in fewer steps if the
 * keys are nearly sorted. The gaps are Tokuda's (1992): h = 2.25 h + 1, rounded. These functions return the first
 * gap, and the gap after `gap`. After 1 follows 0. */
static inline uint64_t fibrad_sort_first_gap(uint64_t count) {
    uint64_t gap = 1;
    while (gap < count / 3) gap = 9 * gap / 4 + 1;
    return gap;
}
static inline uint64_t fibrad_sort_next_gap(uint64_t gap) { return gap == 1 ? 0 : 4 * gap / 9 + (gap == 2); }

/* Sorts keys by the number above their lowest `low` bits, up to 8 bits at a time. Equal keys keep their order. largest:
 * bound of this number. Returns the array that holds the result, `key` or `other`. For 135 columns below 20,000 this
 * takes a third of the time of Shell's method, whose branches cannot be predicted. */
static inline uint64_t *fibrad_sort_keys(uint64_t *key, uint64_t *other, uint32_t count, int low, uint64_t largest) {
    int bits = 0;
    while (bits < 64 - low && largest >> bits != 0) bits++;
    const int passes = (bits + 7) / 8, wide = passes > 0 ? (bits + passes - 1) / passes : 0;
    const uint64_t last = (UINT64_C(1) << wide) - 1; /* of the digits of a pass */
    for (int pass = 0; pass < passes; pass++) {
        const int shift = low + pass * wide;
        uint32_t end[257] = {0};
        for (uint32_t k = 0; k < count; k++) end[(key[k] >> shift & last) + 1]++;
        for (uint64_t digit = 1; digit <= last; digit++) end[digit] += end[digit - 1];
        for (uint32_t k = 0; k < count; k++) other[end[key[k] >> shift & last]++] = key[k];
        uint64_t *sorted = other;
        other = key, key = sorted;
    }
    return key;
}

#endif
