/* pieces_lanes.c - areas from pieces of boundary. Compiled once per instruction set. SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "bed/pieces_lanes.h"

/* The area between an arc and its chord, arcs of up to half a circle: r^2 (v - sin v cos v), v being half the arc's
 * angle; that is chord^3/(8 r) G(cos v), cos v from the distance of the chord from the centre, which is `across`/chord.
 * Nothing cancels. G(c) = (v - sin v cos v)/sin^3 v is a polynomial in c - 1/2, fitted at Chebyshev nodes of [0, 1],
 * relative error 4e-17. */
static inline vd segment(vd square, vd across, vd r) {
    static const double G[] = {0x1.e4259befcea59p-1,  -0x1.8d0a1d75b80aap-1, 0x1.328fb170bfe51p-1, -0x1.c9f32443c65b6p-2,
                               0x1.4ef243bcd36fcp-2,  -0x1.e2ee13c10e666p-3, 0x1.587d60e162f52p-3, -0x1.e787b95003deep-4,
                               0x1.56cd30a9dde00p-4,  -0x1.df9c80b2c853ep-5, 0x1.4e188ca33cac6p-5, -0x1.cfcdde3045df5p-6,
                               0x1.40f9113577a59p-6,  -0x1.bb4f883dee62cp-7, 0x1.314d8202970c4p-7, -0x1.a0d605c8b41d0p-8,
                               0x1.1e04c77a0929ap-8,  -0x1.a15c00b3fb255p-9, 0x1.1d66ec91e9b04p-9, -0x1.edcde8f7eb6c8p-11,
                               0x1.51bb92f2f032dp-11, -0x1.58123f80e4f72p-10, 0x1.d422ed61cbf73p-11};
    vd inverse = vd_div(vd_set1(1), vd_max(vd_mul(vd_sqrt(square), r), vd_set1(1e-300)));
    vd x = vd_sub(vd_mul(across, inverse), vd_set1(0.5)), xx = vd_mul(x, x);
    vd even = vd_set1(G[22]), odd = vd_set1(G[21]);
#define STEP(k) even = vd_add(vd_mul(even, xx), vd_set1(G[k])), odd = vd_add(vd_mul(odd, xx), vd_set1(G[k - 1]))
    STEP(20), STEP(18), STEP(16), STEP(14), STEP(12), STEP(10), STEP(8), STEP(6), STEP(4), STEP(2);
#undef STEP
    vd g = vd_add(vd_add(vd_mul(even, xx), vd_set1(G[0])), vd_mul(odd, x));
    return vd_mul(vd_mul(vd_mul(square, square), inverse), vd_mul(g, vd_set1(0.125)));
}

void LANED(fibrad_pieces_integrate)(fibrad_areas *areas) {
    fibrad_pieces *p = areas->pieces;
    vd one = vd_set1(1), half = vd_set1(0.5);
    for (uint32_t k = 0; k < p->count; k += VD_LANES) {
        vd px = vd_load(p->px + k), py = vd_load(p->py + k), qx = vd_load(p->qx + k), qy = vd_load(p->qy + k);
        vd dx = vd_sub(qx, px), dy = vd_sub(qy, py), across = vd_sub(vd_mul(px, qy), vd_mul(py, qx));
        vd arc = segment(vd_add(vd_mul(dx, dx), vd_mul(dy, dy)), across, vd_load(p->r + k));
        vd shift = vd_sub(vd_mul(vd_load(p->cx + k), dy), vd_mul(vd_load(p->cy + k), dx));
        vd area = vd_add(arc, vd_mul(half, vd_add(across, shift)));
        /* the open region is on the left of the window's arcs, on the right of discs' */
        area = vd_select(vd_lt(vd_load(p->circle + k), one), area, vd_sub(vd_set1(0), area));
        vd_store(p->r + k, area); /* where it is of no use any more */
    }
    for (uint32_t k = 0; k < p->count; k++) {
        areas->area[(uint32_t)p->circle[k]] -= p->r[k];
        areas->area[(uint32_t)p->taker[k]] += p->r[k];
    }
    p->count = 0;
}
