/* pieces_lanes.h - pieces of boundary to integrate, in lanes. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_BED_PIECES_LANES_H
#define FIBRAD_BED_PIECES_LANES_H

#include "base/lanes/laned.h"
#include "bed/areas.h"

/* Green's theorem for the pieces so far: what each takes from its circle's area[] and adds to its taker's. */
void LANED(fibrad_pieces_integrate)(fibrad_areas *areas);

/* Appends a circle. */
static inline void fibrad_areas_add_circle(fibrad_areas *areas, uint32_t whose, double x, double y, double r) {
    uint32_t k = areas->circles;
    areas->x[k] = x, areas->y[k] = y, areas->r[k] = r, areas->area[k] = 0;
    areas->whose[k] = whose;
}

/* Arcs in lanes; fibrad_pieces explains them. */
typedef struct fibrad_piece_lanes {
    vd px, py, qx, qy, cx, cy, r, circle;
} fibrad_piece_lanes;

/* Gives the lanes named by bits to circle k. */
static inline void fibrad_pieces_give(fibrad_areas *areas, uint32_t bits, const fibrad_piece_lanes *s, uint32_t k) {
    fibrad_pieces *pieces = areas->pieces;
    uint32_t n = pieces->count;
    vd_compress(pieces->px + n, bits, s->px);
    vd_compress(pieces->py + n, bits, s->py);
    vd_compress(pieces->qx + n, bits, s->qx);
    vd_compress(pieces->qy + n, bits, s->qy);
    vd_compress(pieces->cx + n, bits, s->cx);
    vd_compress(pieces->cy + n, bits, s->cy);
    vd_compress(pieces->r + n, bits, s->r);
    vd_compress(pieces->circle + n, bits, s->circle);
    vd_storeu(pieces->taker + n, vd_set1(k));
    pieces->count = n + fibrad_count_bits(bits);
    if (pieces->count >= FIBRAD_PIECES) LANED(fibrad_pieces_integrate)(areas);
}

#endif
