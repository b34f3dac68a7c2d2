/* segments_lanes.h - first segments of paths, taken from the windows of a beam row. SPDX-License-Identifier: MIT
 *
 * Each segment has four coordinates. Two tell in which direction the path goes on. They are those of an additive
 * recurrence. Two tell where in its window the beam passes. These are random. With a recurrence for them, too, the
 * noise of rows doubled where its steps matched those of the directions, as with 50 windows and 100 segments. */
#ifndef FIBRAD_WORKSPACE_SEGMENTS_LANES_H
#define FIBRAD_WORKSPACE_SEGMENTS_LANES_H

#include "base/lanes/below.h"
#include "base/lanes/laned.h"
#include "base/lanes/turn.h"
#include "base/random.h"
#include "workspace/workspace.h"

/* Makes the first coordinates of normals along the axes of windows, and the even points. */
static void LANED(begin_segments)(fibrad_segments *segments) {
    segments->length = 0;
    for (uint32_t k = 0; k < segments->wanted; k += VD_LANES) {
        _Alignas(64) double at[4][VD_LANES], to[4][VD_LANES];
        vd cosine, sine;
        for (uint32_t lane = 0; lane < VD_LANES; lane++)
            for (int d = 0; d < 4; d++) {
                const uint64_t x = segments->shift[d] + (k + lane) * fibrad_quasirandom_step(4, d);
                at[d][lane] = fibrad_fraction(d < 2 ? fibrad_mix(x) : x);
            }
        vd ring = vd_sqrt(vd_load(at[0])), height = vd_load(at[2]);
        vd_turn(vd_load(at[1]), &cosine, &sine);
        vd_store(to[0], ring * cosine);
        vd_store(to[1], ring * sine);
        ring = vd_sqrt(4 * height * (1 - height));
        vd_turn(vd_load(at[3]), &cosine, &sine);
        vd_store(to[2], ring * cosine);
        vd_store(to[3], ring * sine);
        for (uint32_t lane = 0; lane < VD_LANES && k + lane < segments->wanted; lane++)
            segments->segment[k + lane] =
                (fibrad_segment){.weight = 1,
                                 .n = {to[0][lane], to[1][lane]},
                                 .even = {to[2][lane], to[3][lane], 1 - (at[2][lane] + at[2][lane])}};
    }
}

/* The first disc at the point (x, y) of the present window. FIBRAD_NONE: there is none. */
static uint32_t LANED(first_disc)(const fibrad_discs *disc, double x, double y, double *depth) {
    const vd at_x = vd_set1(x), at_y = vd_set1(y);
    uint32_t first = FIBRAD_NONE;
    *depth = __builtin_inf();
    for (uint32_t k = 0; k < disc->count; k += VD_LANES) {
        const vd dx = at_x - vd_load(disc->u + k), dy = at_y - vd_load(disc->v + k), r = vd_load(disc->r + k);
        uint32_t bits = vm_bits(vd_lt(dx * dx + dy * dy, r * r)) & vd_lanes_below(disc->count - k);
        for (; bits != 0; bits &= bits - 1) {
            const uint32_t one = k + (uint32_t)__builtin_ctz(bits);
            const double here = disc->depth[one] < 0 ? disc->resolved[one] : disc->depth[one];
            if (here < *depth) *depth = here, first = one;
        }
    }
    return first;
}

/* Takes the segments of window k. open: a part of the window is open, so all spheres that it meets have been found. */
static void LANED(take_segments)(fibrad_workspace *work, const double frame[9], uint32_t k, bool open) {
    fibrad_segments *segments = &work->segments;
    const fibrad_discs *disc = &work->disc;
    const uint32_t end = (uint32_t)((uint64_t)segments->wanted * (k + 1) / work->windows);
    for (uint32_t at = segments->length; at < end; at++) {
        fibrad_segment *segment = &segments->segment[at];
        double depth;
        const double x = segment->n[0], y = segment->n[1], up = fibrad_sqrt(fibrad_max(0, 1 - (x * x + y * y)));
        const uint32_t first = LANED(first_disc)(disc, x, y, &depth);
        segment->sphere = first != FIBRAD_NONE ? fibrad_work_sphere(work, first) : FIBRAD_NONE;
        segment->open = open && first == FIBRAD_NONE;
        for (int axis = 0; axis < 3; axis++) {
            const double *from = frame + axis;
            segment->w[axis] = from[6];
            segment->n[axis] = x * from[0] + y * from[3] + up * from[6];
            if (first != FIBRAD_NONE)
                segment->centre[axis] = disc->u[first] * from[0] + disc->v[first] * from[3] + depth * from[6];
        }
    }
    segments->length = end;
}

#endif
