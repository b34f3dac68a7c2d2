/* points_lanes.c - points of a window that spheres hide. Compiled once per instruction set.
 * SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "base/lanes/below.h"
#include "points/points_lanes.h"

/* Which of the 64 points from (x, y) on lie within a disc. square: the square of its radius. The sum keeps the bits
 * in an ordinary register, where `or` would move them to mask registers and back. */
static inline uint64_t points_within(const float *x, const float *y, float at_x, float at_y, float square) {
    vf u = vf_set1(at_x), v = vf_set1(at_y), square_r = vf_set1(square);
    uint64_t bits = 0;
#pragma GCC unroll 64
    for (uint32_t lane = 0; lane < 64; lane += VF_LANES) {
        vf dx = u - vf_load(x + lane), dy = v - vf_load(y + lane);
        bits += (uint64_t)vf_lt_bits(dx * dx + dy * dy, square_r) << lane;
    }
    return bits;
}

uint64_t LANED(fibrad_points_within)(const fibrad_points *points, uint32_t word, double x, double y, double r) {
    return points_within(points->set.x + 64 * word, points->set.y + 64 * word, (float)x, (float)y, (float)(r * r));
}

void LANED(fibrad_points_disc)(fibrad_points *points, double x, double y, double r) {
    points->open = 0;
    for (uint32_t word = 0; word < points->count / 64; word++) {
        const float *at_x = points->set.x + 64 * word, *at_y = points->set.y + 64 * word;
        points->seen[word] &= ~points_within(at_x, at_y, (float)x, (float)y, (float)(r * r));
        points->open += fibrad_count_bits(points->seen[word]);
    }
}

/* Writes the discs as floats. Returns the number of discs that are not deeper than `depth`. */
static inline uint32_t round_discs(const fibrad_discs *disc, double depth) {
    const fibrad_discs discs = *disc; /* a copy, so that the compiler sees that stores do not change its pointers */
    uint32_t count = 0;
    for (uint32_t k = 0; k < discs.count; k += VD_LANES) {
        vd r = vd_load(discs.r + k);
        count += fibrad_count_bits(vm_bits(vd_le(vd_load(discs.depth + k), vd_set1(depth))) &
                                   vd_lanes_below(discs.count - k));
        vd_store_float(discs.fu + k, vd_load(discs.u + k));
        vd_store_float(discs.fv + k, vd_load(discs.v + k));
        vd_store_float(discs.square + k, r * r);
    }
    return count;
}

/* Takes 64 points at a time. They stay in registers. When all of them are hidden, the next 64 follow. */
uint32_t LANED(fibrad_points_discs)(fibrad_points *points, const fibrad_discs *disc, uint32_t from, double depth) {
    const fibrad_discs discs = *disc; /* a copy, so that the compiler sees that stores do not change its pointers */
    const uint32_t to = round_discs(&discs, depth);
    for (uint32_t d = from; d < to; d += 16) fibrad_zero(discs.hidden_points + d, 16 * sizeof *discs.hidden_points);
    points->open = 0;
    for (uint32_t word = 0; word < points->count / 64; word++) {
        const float *x = points->set.x + 64 * word, *y = points->set.y + 64 * word;
        uint64_t seen = points->seen[word];
        for (uint32_t d = from; d < to && seen != 0; d++) {
            uint32_t k = discs.order[d];
            uint64_t hidden = seen & points_within(x, y, discs.fu[k], discs.fv[k], discs.square[k]);
            discs.hidden_points[d] += fibrad_count_bits(hidden);
            seen -= hidden;
        }
        points->seen[word] = seen;
        points->open += fibrad_count_bits(seen);
    }
    return to;
}
