/* grid.h - sums that are the same in any order. SPDX-License-Identifier: MIT
 *
 * A sum in floating point depends on the order of its terms, unless each addition is exact. So terms are rounded to
 * whole multiples of one small unit before they are added. Equal terms of many windows would all be rounded the same
 * way. So each window shifts its terms by a part of the unit before that, evenly over all windows: the errors then
 * cancel. */
#ifndef FIBRAD_SUMS_GRID_H
#define FIBRAD_SUMS_GRID_H

#include "base/elementary.h"

/* Zeroed: terms stay as they are. */
typedef struct fibrad_grid {
    double middle; /* 3/4 of a power of two p: numbers from p/2 to p have the unit 2^-53 p as their last place */
    double shift;  /* -1/2 to 1/2 units */
} fibrad_grid;

/* `middle` for terms whose absolute values add up to at most `most`, above 0. Sums up to p are exact. */
static inline double fibrad_grid_middle(double most) {
    uint64_t bits;
    fibrad_copy(&bits, &most, sizeof bits);
    return 0.75 * fibrad_power_of_two((int64_t)(bits >> 52) - 1022);
}

/* The grid of window k. Multiples of the golden ratio are spread evenly. Odd multiples are never half a unit. */
static inline fibrad_grid fibrad_grid_of(double middle, uint32_t k) {
    const double share = (double)((2 * k + 1) * 2654435769u) * 0x1p-32;
    return (fibrad_grid){middle, (share - 0.5) * (middle * 0x1p-53 / 0.75)};
}

static inline double fibrad_on_grid(double term, fibrad_grid grid) {
    return term + grid.shift + grid.middle - grid.middle;
}

#endif
