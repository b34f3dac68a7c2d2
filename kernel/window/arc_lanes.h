/* arc_lanes.h - contributions of arcs to areas, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WINDOW_ARC_LANES_H
#define FIBRAD_WINDOW_ARC_LANES_H

#include "base/lanes/laned.h"
#include "window/areas.h"

/* Arcs counter-clockwise about c from c + p to c + q, at most half a circle. circle: the number of the circle. */
typedef struct fibrad_arc_lanes {
    vd px, py, qx, qy, cx, cy, r, circle;
} fibrad_arc_lanes;

/* Three arcs of the unit circle. Their ends lie on no symmetry of a bed. */
static const double fibrad_areas_corner[4][2] = {{0x1.e921dd42f09bap-1, 0x1.2e9cd95baba34p-2},
                                                 {-0x1.7799ed83d9d3ap-1, 0x1.5bf2a3a493975p-1},
                                                 {-0x1.c61fbefc5b202p-3, -0x1.f34110526968fp-1},
                                                 {0x1.e921dd42f09bap-1, 0x1.2e9cd95baba34p-2}};

/* atan(t) for t from 0 to tan(pi/8), by a polynomial through Chebyshev nodes. The relative error is 7e-17. Even and odd
 * powers of t^2 have a sum each. */
static inline vd fibrad_atan_lanes(vd t) {
    static const double ATAN[] = {0x1.0000000000000p+0,  -0x1.55555555551d9p-2, 0x1.9999999933cacp-3,
                                  -0x1.249249003cd48p-3, 0x1.c71c646ead620p-4,  -0x1.745ba79b91c34p-4,
                                  0x1.3afaddd7ea785p-4,  -0x1.0ffaaea631d14p-4, 0x1.d1f09979b889ap-5,
                                  -0x1.640c82dcf0b1cp-5, 0x1.59ee37d6e78cbp-6};
    vd x = t * t, xx = x * x;
    vd even = vd_set1(ATAN[10]), odd = vd_set1(ATAN[9]);
    even = even * xx + ATAN[8], odd = odd * xx + ATAN[7];
    even = even * xx + ATAN[6], odd = odd * xx + ATAN[5];
    even = even * xx + ATAN[4], odd = odd * xx + ATAN[3];
    even = even * xx + ATAN[2], odd = odd * xx + ATAN[1];
    even = even * xx + ATAN[0];
    return t * (even + odd * x);
}

/* Green's theorem: half the integral of x dy - y dx along an arc of angle v is (r^2 v + c x (q - p))/2. The angle v
 * is the nearest multiple of a right angle plus 2 atan(t), t being at most tan(pi/8). */
static inline vd fibrad_arc_area(const fibrad_arc_lanes *a) {
    vd zero = vd_set1(0), eighth = vd_set1(0x1.921fb54442d18p-1), quarter = vd_set1(0x1.921fb54442d18p+0);
    vd dx = a->qx - a->px, dy = a->qy - a->py, square = a->r * a->r;
    vd sine = a->px * dy - a->py * dx; /* r^2 sin v and r^2 cos v */
    vd cosine = a->px * a->qx + a->py * a->qy;
    vd minus_sine = zero - sine, minus_cosine = zero - cosine;
    vm acute = vd_lt(sine, cosine), straight = vd_lt(cosine, minus_sine);
    vd opposite = vd_select(acute, sine, vd_select(straight, minus_sine, minus_cosine));
    vd adjacent = vd_select(acute, cosine, vd_select(straight, minus_cosine, sine));
    vd nearest = vd_select(acute, zero, vd_select(straight, quarter, eighth)); /* half of that multiple */
    vd half_angle = nearest + fibrad_atan_lanes(opposite / (square + adjacent));
    vd shift = a->cx * dy - a->cy * dx;
    return square * half_angle + 0.5 * shift;
}

/* Adds the contributions of all pieces to the areas of their discs. */
void LANED(fibrad_areas_integrate)(fibrad_areas *areas);

/* Appends the arcs of the lanes given by bits to the pieces that disc k hides. This is inline for the one caller
 * whose time counts. fibrad_arcs_add does the same as a function. */
static inline void fibrad_arcs_append(fibrad_areas *areas, uint32_t bits, const fibrad_arc_lanes *a, uint32_t k) {
    fibrad_pieces *pieces = areas->pieces;
    uint32_t n = pieces->count;
    vd_compress(pieces->px + n, bits, a->px);
    vd_compress(pieces->py + n, bits, a->py);
    vd_compress(pieces->qx + n, bits, a->qx);
    vd_compress(pieces->qy + n, bits, a->qy);
    vd_compress(pieces->cx + n, bits, a->cx);
    vd_compress(pieces->cy + n, bits, a->cy);
    vd_compress(pieces->r + n, bits, a->r);
    vd_compress(pieces->circle + n, bits, a->circle);
    vd_storeu(pieces->occluder + n, vd_set1(k));
    pieces->count = n + fibrad_count_bits(bits);
    if (pieces->count >= FIBRAD_PIECES) LANED(fibrad_areas_integrate)(areas);
}

void LANED(fibrad_arcs_add)(fibrad_areas *areas, uint32_t bits, const fibrad_arc_lanes *a, uint32_t k);

#endif
