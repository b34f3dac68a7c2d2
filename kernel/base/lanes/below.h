/* below.h - the first lanes of a vector, for the ends of lists. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_LANES_BELOW_H
#define FIBRAD_LANES_BELOW_H

/* The first n lanes of a vd, as bits. */
static inline uint32_t vd_lanes_below(uint32_t n) {
    uint32_t lanes = n < VD_LANES ? n : VD_LANES;
    return (1u << lanes) - 1;
}

#endif
