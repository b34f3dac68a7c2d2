/* areas.c - lays out the memory for visible areas. SPDX-License-Identifier: MIT */
#include "window/areas.h"

#define AREA_LANES 8 /* of the widest vectors: whole vectors are written at the end of a list */

/* K circles bound a plane region by at most 6 K arcs, each of which may be cut twice. That is the worst case; windows
 * of beds have about one arc per disc. */
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

void fibrad_areas_layout(fibrad_areas *areas, fibrad_arena *arena, uint32_t discs) {
    size_t circles =
        (size_t)discs + 2 < 2 * AREA_LANES ? 2 * AREA_LANES : (size_t)discs + 2; /* lookups load two vectors */
    areas->discs = discs;
    areas->x = doubles(arena, circles), areas->y = doubles(arena, circles), areas->r = doubles(arena, circles);
    areas->area = doubles(arena, circles);
    areas->whose = fibrad_arena_take(arena, circles, sizeof(uint32_t));
    areas->pieces = fibrad_arena_take(arena, 1, sizeof *areas->pieces);
    areas->boundary = fibrad_arena_take(arena, 1, sizeof *areas->boundary);
    lay_out_arrangement(&areas->arrangement, arena, discs, circles);
}
