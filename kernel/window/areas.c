/* areas.c - lays out the memory for visible areas. SPDX-License-Identifier: MIT */
#include "window/areas.h"

#define LANES 8 /* the most that a vector has; whole vectors are written at the end of a list */

/* K circles bound a plane region by at most 6 K arcs, each of which may be cut twice; that is for the worst
 * arrangement, windows of beds have about one arc per disc. */
#define ARCS_PER_DISC 4u

static double *doubles(fibrad_arena *arena, size_t count) { return fibrad_arena_take(arena, count, sizeof(double)); }

static fibrad_arcs arcs_of(fibrad_arena *arena, size_t count) {
    fibrad_arcs arcs;
    arcs.a = doubles(arena, count), arcs.b = doubles(arena, count);
    arcs.px = doubles(arena, count), arcs.py = doubles(arena, count);
    arcs.qx = doubles(arena, count), arcs.qy = doubles(arena, count);
    arcs.circle = doubles(arena, count);
    arcs.count = 0;
    return arcs;
}

static void accounts_layout(fibrad_accounts *accounts, fibrad_arena *arena, uint32_t discs, size_t circles) {
    accounts->arcs = ARCS_PER_DISC * discs + 4 * LANES;
    size_t arcs = (size_t)accounts->arcs + LANES;
    accounts->inverse = doubles(arena, circles);
    accounts->from = doubles(arena, circles), accounts->to = doubles(arena, circles);
    accounts->sx = doubles(arena, circles), accounts->sy = doubles(arena, circles);
    accounts->ex = doubles(arena, circles), accounts->ey = doubles(arena, circles);
    accounts->hidden.from = doubles(arena, circles + LANES), accounts->hidden.to = doubles(arena, circles + LANES);
    accounts->hidden.circle = doubles(arena, circles + LANES);
    accounts->open = arcs_of(arena, arcs);
    accounts->left = arcs_of(arena, arcs);
    accounts->seconds = accounts->arcs / 4;
    accounts->second[0] = arcs_of(arena, accounts->seconds + LANES);
    accounts->second[1] = arcs_of(arena, accounts->seconds + LANES);
}

void fibrad_areas_layout(fibrad_areas *areas, fibrad_arena *arena, uint32_t discs) {
    size_t circles = (size_t)discs + 2 < 2 * LANES ? 2 * LANES : (size_t)discs + 2; /* lookups load two vectors */
    areas->discs = discs;
    areas->x = doubles(arena, circles), areas->y = doubles(arena, circles), areas->r = doubles(arena, circles);
    areas->area = doubles(arena, circles);
    areas->whose = fibrad_arena_take(arena, circles, sizeof(uint32_t));
    areas->pieces = fibrad_arena_take(arena, 1, sizeof *areas->pieces);
    areas->boundary = fibrad_arena_take(arena, 1, sizeof *areas->boundary);
    accounts_layout(&areas->accounts, arena, discs, circles);
}
