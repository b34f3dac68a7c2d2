/* areas.c - lays out the memory for visible areas. SPDX-License-Identifier: MIT */
#include "window/areas.h"

#define AREA_LANES 8 /* of the widest vectors; at the end of a list whole vectors are written */

/* K circles bound a plane region by at most 6 K arcs, each of which may be cut twice. That is the worst case.
 * Windows of beds have about one arc per disc. */
#define ARCS_PER_DISC 4u

static double *doubles(fibrad_arena *arena, size_t count) { return fibrad_arena_take(arena, count, sizeof(double)); }

static fibrad_arcs take_arcs(fibrad_arena *arena, size_t count) {
    fibrad_arcs arcs;
    arcs.a = doubles(arena, count), arcs.b = doubles(arena, count);
    arcs.px = doubles(arena, count), arcs.py = doubles(arena, count);
    arcs.qx = doubles(arena, count), arcs.qy = doubles(arena, count);
    arcs.circle = doubles(arena, count);
    arcs.count = 0;
    return arcs;
}

static void lay_out_arrangement(fibrad_arrangement *arrangement, fibrad_arena *arena, uint32_t discs, size_t circles) {
    arrangement->arcs = ARCS_PER_DISC * discs + 4 * AREA_LANES;
    size_t arcs = (size_t)arrangement->arcs + AREA_LANES;
    arrangement->inverse = doubles(arena, circles);
    arrangement->from = doubles(arena, circles), arrangement->to = doubles(arena, circles);
    arrangement->sx = doubles(arena, circles), arrangement->sy = doubles(arena, circles);
    arrangement->ex = doubles(arena, circles), arrangement->ey = doubles(arena, circles);
    arrangement->hidden.from = doubles(arena, circles + AREA_LANES),
    arrangement->hidden.to = doubles(arena, circles + AREA_LANES);
    arrangement->hidden.circle = doubles(arena, circles + AREA_LANES);
    arrangement->open = take_arcs(arena, arcs);
    arrangement->left = take_arcs(arena, arcs);
    arrangement->seconds = arrangement->arcs / 4;
    arrangement->second[0] = take_arcs(arena, arrangement->seconds + AREA_LANES);
    arrangement->second[1] = take_arcs(arena, arrangement->seconds + AREA_LANES);
}

static void dense_layout(fibrad_dense *dense, fibrad_arena *arena, uint32_t discs) {
    dense->cells_most = 4 * discs, dense->blocks_most = discs / 8 * 3 + 8, dense->discs_most = 8 * discs,
    dense->cuts_most = discs / 2 + 1;
    const size_t slots = (size_t)FIBRAD_DENSE_BLOCK * dense->blocks_most;
    dense->px = doubles(arena, slots), dense->py = doubles(arena, slots);
    dense->qx = doubles(arena, slots), dense->qy = doubles(arena, slots);
    dense->cx = doubles(arena, slots), dense->cy = doubles(arena, slots);
    dense->r = doubles(arena, slots), dense->circle = doubles(arena, slots);
    dense->mx = fibrad_arena_take(arena, slots, sizeof(float)),
    dense->my = fibrad_arena_take(arena, slots, sizeof(float));
    dense->half = fibrad_arena_take(arena, slots, sizeof(float));
    dense->near = fibrad_arena_take(arena, slots + 2 * AREA_LANES, sizeof(uint32_t));
    dense->alive = fibrad_arena_take(arena, dense->blocks_most, sizeof(uint32_t));
    dense->next = fibrad_arena_take(arena, dense->blocks_most, sizeof(uint32_t));
    dense->first_block = fibrad_arena_take(arena, dense->cells_most, sizeof(uint32_t));
    dense->first_disc = fibrad_arena_take(arena, dense->cells_most, sizeof(uint32_t));
    dense->disc = fibrad_arena_take(arena, dense->discs_most, sizeof *dense->disc);
    dense->cut = fibrad_arena_take(arena, dense->cuts_most, sizeof *dense->cut);
}

void fibrad_areas_layout(fibrad_areas *areas, fibrad_arena *arena, uint32_t discs) {
    size_t circles =
        (size_t)discs + 2 < 2 * AREA_LANES ? 2 * AREA_LANES : (size_t)discs + 2; /* lookups load two vectors */
    areas->discs = discs;
    areas->x = doubles(arena, circles), areas->y = doubles(arena, circles), areas->r = doubles(arena, circles);
    areas->area = doubles(arena, circles);
    areas->whose = fibrad_arena_take(arena, circles, sizeof(uint32_t));
    areas->pieces = fibrad_arena_take(arena, 1, sizeof *areas->pieces);
    areas->boundary = fibrad_arena_take(arena, 1, sizeof *areas->boundary);
    const size_t used = arena->used;
    lay_out_arrangement(&areas->arrangement, arena, discs, circles);
    const size_t end = arena->used;
    arena->used = used; /* a window uses the arrangement or `dense`, never both */
    dense_layout(&areas->dense, arena, discs);
    if (arena->used < end) arena->used = end;
    areas->dense.written = false;
}

void fibrad_areas_clear_arcs(fibrad_areas *areas) {
    const fibrad_arrangement *a = &areas->arrangement;
    const fibrad_arcs *list[] = {&a->open, &a->left, &a->second[0], &a->second[1]};
    for (int n = 0; n < 4; n++)
        fibrad_zero(list[n]->circle, ((size_t)(n < 2 ? a->arcs : a->seconds) + AREA_LANES) * sizeof(double));
    areas->dense.written = false;
}

static fibrad_open_arc arc_of(double circle, const double *p[2], const double *q[2], const double c[2], double r,
                              uint32_t k) {
    const double px = p[0][k], py = p[1][k], qx = q[0][k], qy = q[1][k];
    return (fibrad_open_arc){(uint32_t)circle, {px, py}, {qx, qy}, {c[0], c[1]}, r, {qx - px, qy - py}};
}

static bool next_dense(const fibrad_dense *grid, uint32_t *at, fibrad_open_arc *arc) {
    while (*at < grid->blocks * FIBRAD_DENSE_BLOCK) {
        const uint32_t k = (*at)++;
        if ((grid->alive[k / FIBRAD_DENSE_BLOCK] >> k % FIBRAD_DENSE_BLOCK & 1) == 0) continue;
        const double *p[2] = {grid->px, grid->py}, *q[2] = {grid->qx, grid->qy}, c[2] = {grid->cx[k], grid->cy[k]};
        *arc = arc_of(grid->circle[k], p, q, c, grid->r[k], k);
        return true;
    }
    return false;
}

static bool next_clipped(const fibrad_boundary *b, uint32_t *at, fibrad_open_arc *arc) {
    while (*at < FIBRAD_BOUNDARY) {
        const uint32_t k = (*at)++;
        if ((b->alive >> k & 1) == 0) continue;
        const double *p[2] = {b->px, b->py}, *q[2] = {b->qx, b->qy}, c[2] = {b->cx[k], b->cy[k]};
        *arc = arc_of(b->circle[k], p, q, c, b->r[k], k);
        return true;
    }
    return false;
}

/* The arrangement has points of the window in the place of those about the centre. */
static bool next_arranged(const fibrad_areas *areas, uint32_t *at, fibrad_open_arc *arc) {
    const fibrad_arcs *open = &areas->arrangement.open;
    if (*at >= open->count) return false;
    const uint32_t k = (*at)++, m = (uint32_t)open->circle[k];
    const double *p[2] = {open->px, open->py}, *q[2] = {open->qx, open->qy}, c[2] = {areas->x[m], areas->y[m]};
    *arc = arc_of(open->circle[k], p, q, c, areas->r[m], k);
    for (int axis = 0; axis < 2; axis++) arc->p[axis] -= c[axis], arc->q[axis] -= c[axis];
    return true;
}

bool fibrad_areas_next(const fibrad_areas *areas, uint32_t *at, fibrad_open_arc *arc) {
    if (areas->degenerate) return next_arranged(areas, at, arc);
    return areas->dense.on ? next_dense(&areas->dense, at, arc) : next_clipped(areas->boundary, at, arc);
}

/* An arc on the circle of a disc contributes the integral of the normal along the arc, times the depth of the disc. The
 * circle of the window does not move. */
void fibrad_areas_slope(const fibrad_areas *areas, const double *depth, double slope[2]) {
    fibrad_open_arc arc;
    slope[0] = slope[1] = 0;
    for (uint32_t at = 0; fibrad_areas_next(areas, &at, &arc);) {
        if (arc.circle == 0) continue;
        const double t = depth[areas->whose[arc.circle]];
        slope[0] += t * arc.chord[1], slope[1] -= t * arc.chord[0];
    }
}
