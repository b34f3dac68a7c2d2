/* areas.c - lays out the memory for visible areas. SPDX-License-Identifier: MIT */
#include "window/areas.h"

#define AREA_LANES 8 /* of the widest vectors; at the end of a list whole vectors are written */

/* K circles bound a plane region by at most 6 K arcs, each of which may be cut twice. That is the worst case.
 * Windows of beds have about one arc per disc. */
#define ARCS_PER_DISC 4u

static void take_arcs(fibrad_arena *arena, size_t count, fibrad_arcs *arcs) {
    fibrad_arena_doubles(
        arena, count,
        (double **const[]){&arcs->a, &arcs->b, &arcs->px, &arcs->py, &arcs->qx, &arcs->qy, &arcs->circle, NULL});
    arcs->count = 0;
}

static void lay_out_arrangement(fibrad_arrangement *a, fibrad_arena *arena, uint32_t discs, size_t circles) {
    a->arcs = ARCS_PER_DISC * discs + 4 * AREA_LANES;
    a->seconds = a->arcs / 4;
    fibrad_arena_doubles(arena, circles,
                         (double **const[]){&a->inverse, &a->from, &a->to, &a->sx, &a->sy, &a->ex, &a->ey, NULL});
    fibrad_arena_doubles(arena, circles + AREA_LANES,
                         (double **const[]){&a->hidden.from, &a->hidden.to, &a->hidden.circle, NULL});
    take_arcs(arena, (size_t)a->arcs + AREA_LANES, &a->open);
    take_arcs(arena, (size_t)a->arcs + AREA_LANES, &a->left);
    for (int k = 0; k < 2; k++) take_arcs(arena, a->seconds + AREA_LANES, &a->second[k]);
}

static void dense_layout(fibrad_dense *d, fibrad_arena *arena, uint32_t discs) {
    d->cells_most = 4 * discs, d->blocks_most = discs / 8 * 3 + 8, d->discs_most = 8 * discs,
    d->cuts_most = discs / 2 + 1;
    const size_t slots = (size_t)FIBRAD_DENSE_BLOCK * d->blocks_most;
    fibrad_arena_doubles(arena, slots,
                         (double **const[]){&d->px, &d->py, &d->qx, &d->qy, &d->cx, &d->cy, &d->r, &d->circle, NULL});
    fibrad_arena_floats(arena, slots, (float **const[]){&d->mx, &d->my, &d->half, NULL});
    d->near = fibrad_arena_take(arena, slots + 2 * AREA_LANES, sizeof(uint32_t));
    fibrad_arena_words(arena, d->blocks_most, (uint32_t * *const[]){&d->alive, &d->next, NULL});
    fibrad_arena_words(arena, d->cells_most, (uint32_t * *const[]){&d->first_block, &d->first_disc, NULL});
    d->disc = fibrad_arena_take(arena, d->discs_most, sizeof *d->disc);
    d->cut = fibrad_arena_take(arena, d->cuts_most, sizeof *d->cut);
}

void fibrad_areas_layout(fibrad_areas *areas, fibrad_arena *arena, uint32_t discs) {
    size_t circles =
        (size_t)discs + 2 < 2 * AREA_LANES ? 2 * AREA_LANES : (size_t)discs + 2; /* lookups load two vectors */
    areas->discs = discs;
    fibrad_arena_doubles(arena, circles, (double **const[]){&areas->x, &areas->y, &areas->r, &areas->area, NULL});
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
