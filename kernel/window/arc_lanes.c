/* arc_lanes.c - areas from pieces of boundary. Compiled once per instruction set. SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "window/arc_lanes.h"

void LANED(fibrad_areas_integrate)(fibrad_areas *areas) {
    fibrad_pieces *p = areas->pieces;
    double *sum = areas->area;
    for (uint32_t k = 0; k < p->count; k += VD_LANES) {
        fibrad_arc_lanes a = {vd_load(p->px + k), vd_load(p->py + k), vd_load(p->qx + k), vd_load(p->qy + k),
                              vd_load(p->cx + k), vd_load(p->cy + k), vd_load(p->r + k),  vd_load(p->circle + k)};
        vd area = fibrad_arc_area(&a);
        /* the open region lies to the left of arcs of the window and to the right of arcs of discs */
        vd_store_numbers(p->from + k, a.circle);
        vd_store_numbers(p->to + k, vd_load(p->occluder + k));
        vd_store(p->r + k, vd_select(vd_lt(a.circle, vd_set1(1)), area, 0 - area));
    }
    for (uint32_t k = 0; k < p->count; k++) {
        sum[p->from[k]] -= p->r[k];
        sum[p->to[k]] += p->r[k];
    }
    p->count = 0;
}

void LANED(fibrad_arcs_add)(fibrad_areas *areas, uint32_t bits, const fibrad_arc_lanes *a, uint32_t k) {
    fibrad_arcs_append(areas, bits, a, k);
}
