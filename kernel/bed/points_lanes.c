/* points_lanes.c - points of a window that a sphere hides. Compiled once per instruction set.
 * SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "base/port.h"
#include "bed/points_lanes.h"

uint32_t LANED(fibrad_points_disc)(fibrad_points *points, double x, double y, double r) {
    vf u = vf_set1((float)x), v = vf_set1((float)y), square = vf_set1((float)(r * r));
    uint32_t hits = 0;
    for (uint32_t word = 0; word < points->count / 64; word++) {
        uint64_t seen = points->seen[word], hidden = 0;
        if (seen == 0) continue;
        for (uint32_t lane = 0; lane < 64; lane += VF_LANES) {
            vf dx = vf_sub(vf_load(points->set.x + 64 * word + lane), u);
            vf dy = vf_sub(vf_load(points->set.y + 64 * word + lane), v);
            hidden |= (uint64_t)vf_lt_bits(vf_add(vf_mul(dx, dx), vf_mul(dy, dy)), square) << lane;
        }
        hits += fibrad_count_bits(seen & hidden);
        points->seen[word] = seen & ~hidden;
    }
    points->open -= hits;
    return hits;
}
