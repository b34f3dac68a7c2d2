/* dense_lanes.c - exact visible areas of discs in a window by clipping, if many arcs bound the open region. Compiled
 * once per instruction set. SPDX-License-Identifier: MIT
 *
 * As in clip_lanes.c, a new disc cuts the boundary of the open region. Here the arcs near the disc are found first,
 * by a comparison in floats of sixteen arcs at a time. If there are very many arcs, a grid over the window tells
 * where they are. So the time grows with the number of discs. An arc belongs to the cell with the middle of its
 * chord. The arcs of a cell form blocks. A disc that cuts no arc is either open or hidden as a whole, which one of
 * its points tells. For this test a finer grid knows the discs by cell.
 *
 * Decisions have margins as in clip_lanes.c, but in units of the circles compared, since thousands of small discs
 * make many decisions. */
#include FIBRAD_LANES_HEADER
#include "base/lanes/below.h"
#include "base/sort.h"
#include "window/arc_lanes.h"
#include "window/dense_lanes.h"

/* Decisions that are closer than this are degenerate. DENSE_MARGIN is relative to the smaller circle. DENSE_ROUNDING
 * is relative to the larger circle, which causes the rounding errors. */
#define DENSE_MARGIN   1e-10
#define DENSE_ROUNDING 1e-14
#define DENSE_ANGLE    1e-9 /* between two points of a circle */

/* The number of cells for discs over the width of the window is this number times half the width over the mean
 * radius of the discs. It is bounded by about the number of discs. Cells for arcs are twice as wide. */
#define DENSE_FINENESS    1.0
#define DENSE_CELLS       4u
#define DENSE_CELLS_MOST  1024u
#define DENSE_CELLS_LEAST 6u /* with fewer cells than this one cell has all arcs */
#define DENSE_MORE        4u /* number of discs in all over the discs known when a window begins, usually at most */

/* The cell of a coordinate. cells: number of cells over the width of the window. */
static uint32_t cell_along(uint32_t cells, double x) {
    const double at = (x + 1) * 0.5 * cells, last = cells - 1;
    return (uint32_t)fibrad_min(fibrad_max(at, 0), last);
}

/* The cell of a point. */
static uint32_t cell_of(uint32_t cells, double x, double y) {
    return cells == 1 ? 0 : cell_along(cells, y) * cells + cell_along(cells, x);
}

/* A block of a cell with a free slot, if necessary a new block. FIBRAD_DENSE_NONE: there is no room. */
static uint32_t block_with_room(fibrad_dense *grid, uint32_t cell) {
    uint32_t block = grid->first_block[cell];
    while (block != FIBRAD_DENSE_NONE && grid->alive[block] == (1u << FIBRAD_DENSE_BLOCK) - 1)
        block = grid->next[block];
    if (block != FIBRAD_DENSE_NONE || grid->blocks == grid->blocks_most) return block;
    block = grid->blocks++;
    grid->alive[block] = 0;
    grid->next[block] = grid->first_block[cell];
    grid->first_block[cell] = block;
    return block;
}

typedef struct dense_circle {
    double x, y, r, number;
} dense_circle;

/* Writes the middle of the chord of an arc and half its length as floats. Their errors are below DENSE_SLACK. The
 * arc, and each part of it that may remain, lies within half a chord of this middle. */
#define DENSE_SLACK 1e-6
static void put_middle(fibrad_dense *grid, uint32_t slot, double x, double y, double half) {
    grid->mx[slot] = (float)x, grid->my[slot] = (float)y;
    grid->half[slot] = (float)(half + DENSE_SLACK);
}

/* Puts an arc into the cell with the middle of its chord. */
static void put_arc(fibrad_areas *areas, const dense_circle *c, double px, double py, double qx, double qy) {
    fibrad_dense *grid = &areas->dense;
    const double x = c->x + 0.5 * (px + qx), y = c->y + 0.5 * (py + qy), dx = qx - px, dy = qy - py;
    const uint32_t block = block_with_room(grid, cell_of(grid->cells, x, y));
    if (block == FIBRAD_DENSE_NONE) {
        areas->overflow = true;
        return;
    }
    const uint32_t lane = (uint32_t)__builtin_ctz(~grid->alive[block]), k = block * FIBRAD_DENSE_BLOCK + lane;
    const double half = 0.5 * fibrad_sqrt(dx * dx + dy * dy);
    grid->alive[block] |= 1u << lane;
    grid->px[k] = px, grid->py[k] = py, grid->qx[k] = qx, grid->qy[k] = qy;
    grid->cx[k] = c->x, grid->cy[k] = c->y, grid->r[k] = c->r, grid->circle[k] = c->number;
    put_middle(grid, k, x, y, half);
    grid->live++;
    if (half > grid->reach) grid->reach = half;
}

/* Adds an arc as parts that are shorter than a third of the circle and shorter than a cell. */
static void add_parts(fibrad_areas *areas, const dense_circle *c, double px, double py, double qx, double qy) {
    double end[64][2];
    end[0][0] = qx, end[0][1] = qy;
    const double square = c->r * c->r, least = fibrad_max(-0.5 * square, square - 0.5 * areas->dense.longest);
    for (int left = 0; left >= 0;) {
        const double ex = end[left][0], ey = end[left][1];
        if (left < 63 && (px * ey - py * ex <= 0 || px * ex + py * ey < least)) { /* halve the arc */
            const double ux = ey - py, uy = px - ex, scale = c->r / fibrad_sqrt(ux * ux + uy * uy);
            left++;
            end[left][0] = ux * scale, end[left][1] = uy * scale;
            continue;
        }
        put_arc(areas, c, px, py, ex, ey);
        px = ex, py = ey, left--;
    }
}

/* Adds the arc from p to q. False: the points are too close to tell a short arc from a whole circle. */
static bool add_joint(fibrad_areas *areas, const dense_circle *c, const fibrad_dense_cut *p,
                      const fibrad_dense_cut *q) {
    const double cross = p->x * q->y - p->y * q->x, dot = p->x * q->x + p->y * q->y;
    if (fibrad_abs(cross) <= DENSE_ANGLE * (c->r * c->r) && dot > 0) return false;
    add_parts(areas, c, p->x, p->y, q->x, q->y);
    return true;
}

/* Adds a whole circle. */
static void add_whole(fibrad_areas *areas, const dense_circle *c) {
    const double(*corner)[2] = fibrad_areas_corner;
    for (int n = 0; n < 3; n++)
        add_parts(areas, c, c->r * corner[n][0], c->r * corner[n][1], c->r * corner[n + 1][0], c->r * corner[n + 1][1]);
}

/* Appends a part of an arc to the pieces that the new disc hides. */
static void hide_part(fibrad_areas *areas, uint32_t slot, double px, double py, double qx, double qy) {
    const fibrad_dense *grid = &areas->dense;
    fibrad_pieces *pieces = areas->pieces;
    const uint32_t n = pieces->count++;
    pieces->px[n] = px, pieces->py[n] = py, pieces->qx[n] = qx, pieces->qy[n] = qy;
    pieces->cx[n] = grid->cx[slot], pieces->cy[n] = grid->cy[slot], pieces->r[n] = grid->r[slot];
    pieces->circle[n] = grid->circle[slot], pieces->occluder[n] = areas->circles;
    if (pieces->count == FIBRAD_PIECES) LANED(fibrad_areas_integrate)(areas);
}

/* The cells that meet a square about a disc. half: half the width of the square. */
typedef struct dense_range {
    uint32_t column[2], line[2];
} dense_range;

static dense_range range_of(uint32_t cells, const dense_circle *disc, double half) {
    if (cells == 1) return (dense_range){{0, 0}, {0, 0}};
    return (dense_range){{cell_along(cells, disc->x - half), cell_along(cells, disc->x + half)},
                         {cell_along(cells, disc->y - half), cell_along(cells, disc->y + half)}};
}

/* Lists the arcs of a block that may meet the new disc, since their middles are near enough. */
FIBRAD_INLINE uint32_t list_block(const fibrad_dense *grid, uint32_t block, const dense_circle *disc, uint32_t count) {
    const vf x = vf_set1((float)disc->x), y = vf_set1((float)disc->y);
    const vf r = vf_set1((float)(disc->r * (1 + DENSE_SLACK) + DENSE_SLACK));
    for (uint32_t o = 0; o < FIBRAD_DENSE_BLOCK; o += VF_LANES) {
        const uint32_t slot = block * FIBRAD_DENSE_BLOCK + o;
        const vf dx = vf_load(grid->mx + slot) - x, dy = vf_load(grid->my + slot) - y;
        const vf near = vf_load(grid->half + slot) + r;
        const uint32_t lanes = grid->alive[block] >> o & vf_lt_bits(dx * dx + dy * dy, near * near);
        count += vf_compress_places(grid->near + count, lanes, slot);
    }
    return count;
}

/* Lists the arcs that may meet the new disc. */
static uint32_t list_near(const fibrad_dense *grid, const dense_circle *disc) {
    const dense_range range = range_of(grid->cells, disc, disc->r + grid->reach * (1 + DENSE_SLACK));
    uint32_t count = 0;
    for (uint32_t line = range.line[0]; line <= range.line[1]; line++)
        for (uint32_t column = range.column[0]; column <= range.column[1]; column++) {
            uint32_t block = grid->first_block[line * grid->cells + column];
            for (; block != FIBRAD_DENSE_NONE; block = grid->next[block]) count = list_block(grid, block, disc, count);
        }
    return count;
}

/* A vector of arcs in comparison with the new disc. */
typedef struct dense_case {
    vd dx, dy, square, sum, difference; /* vector between the centres and its square; sum and difference of the radii */
    vm p_in, q_in, twice, degenerate;   /* ends inside the disc; whether both cuts are on the arc; within a margin */
} dense_case;

/* Finds the arcs that have ends inside the disc or that are cut twice, as in clip_lanes.c. But here the distance of
 * an end from the centre of the disc tells whether the end is inside. For circles of all sizes the error of this
 * distance is a rounding error of the disc's radius. Only the ends p are checked for margins, since each q is the p
 * of another arc. */
FIBRAD_INLINE dense_case classify_lanes(const fibrad_arc_lanes *a, const dense_circle *disc) {
    const vd zero = vd_set1(0), radius = vd_set1(disc->r), own = a->r;
    dense_case c = {.dx = disc->x - a->cx, .dy = disc->y - a->cy, .sum = own + radius, .difference = own - radius};
    const vd px = a->px - c.dx, py = a->py - c.dy, qx = a->qx - c.dx, qy = a->qy - c.dy;
    const vd p_far = px * px + py * py - disc->r * disc->r, q_far = qx * qx + qy * qy - disc->r * disc->r;
    c.square = c.dx * c.dx + c.dy * c.dy;
    const vd meeting = (c.sum * c.sum - c.square) * (c.square - c.difference * c.difference);
    c.p_in = vd_lt(p_far, zero), c.q_in = vd_lt(q_far, zero);
    const vm before = vd_lt(zero, a->px * c.dy - a->py * c.dx), after = vd_lt(a->qx * c.dy - a->qy * c.dx, zero);
    const vm may = (c.p_in & c.q_in & vm_not(before | after)) | (vm_not(c.p_in | c.q_in) & before & after);
    c.twice = may & vd_lt(zero, meeting);
    const vd wide = vd_max(own, radius), narrow = vd_min(own, radius), ww = wide * wide, nn = narrow * narrow;
    const vd near = 2 * DENSE_MARGIN * disc->r * disc->r + 2 * DENSE_ROUNDING * wide;
    const vd tangent = DENSE_MARGIN * (nn * ww) + 10 * DENSE_ROUNDING * (ww * ww);
    c.degenerate = vd_le(vd_abs(p_far), near) | (may & vd_le(vd_abs(meeting), tangent));
    return c;
}

/* The points where each of a vector of arcs enters the new disc counter-clockwise, and where it leaves it. Relative
 * to the centre of the arc and to that of the disc. */
typedef struct dense_points {
    _Alignas(FIBRAD_ALIGNMENT) double sx[VD_LANES], sy[VD_LANES], ex[VD_LANES], ey[VD_LANES];
    double from_sx[VD_LANES], from_sy[VD_LANES], from_ex[VD_LANES], from_ey[VD_LANES];
} dense_points;

/* Appends the parts inside the disc, or their first parts, to the pieces that the disc hides. */
FIBRAD_INLINE void cut_lanes(fibrad_areas *areas, const fibrad_arc_lanes *a, const dense_case *c, uint32_t touching,
                             dense_points *at) {
    const vd scale = 0.5 / c->square, f = (c->square + c->sum * c->difference) * scale;
    const vd outer = c->sum * c->sum - c->square, inner = c->square - c->difference * c->difference;
    const vd h = vd_sqrt(vd_max(outer * inner, vd_set1(0))) * scale;
    const vd fx = f * c->dx, fy = f * c->dy, hx = h * c->dx, hy = h * c->dy;
    const vd sx = fx + hy, sy = fy - hx, ex = fx - hy, ey = fy + hx;
    vd_store(at->sx, sx), vd_store(at->sy, sy), vd_store(at->ex, ex), vd_store(at->ey, ey);
    vd_store(at->from_sx, sx - c->dx), vd_store(at->from_sy, sy - c->dy);
    vd_store(at->from_ex, ex - c->dx), vd_store(at->from_ey, ey - c->dy);
    const vm q_hidden = c->q_in & vm_not(c->twice);
    fibrad_arc_lanes hidden = *a;
    hidden.px = vd_select(c->p_in, a->px, sx), hidden.py = vd_select(c->p_in, a->py, sy);
    hidden.qx = vd_select(q_hidden, a->qx, ex), hidden.qy = vd_select(q_hidden, a->qy, ey);
    fibrad_arcs_append(areas, touching, &hidden, areas->circles);
}

/* Adds a cut. */
static fibrad_dense_cut *add_cut(fibrad_areas *areas, uint32_t slot, double x, double y, bool leaves) {
    fibrad_dense *grid = &areas->dense;
    if (grid->cuts == grid->cuts_most) {
        areas->overflow = true;
        grid->cuts = 0; /* the row will begin again with more room */
    }
    fibrad_dense_cut *cut = &grid->cut[grid->cuts++];
    cut->x = x, cut->y = y, cut->slot = slot, cut->leaves = leaves, cut->rest = FIBRAD_DENSE_STAYS;
    return cut;
}

/* Ends the step of an arc in lane l. The part outside the disc stays in the slot. If there are two such parts, the
 * first one stays. A walk with the open region on its left goes counter-clockwise along the circle of the window,
 * and clockwise along circles of discs. */
static void cut_slot(fibrad_areas *areas, uint32_t slot, uint32_t l, bool p_in, bool q_in, bool twice,
                     const dense_points *at) {
    fibrad_dense *grid = &areas->dense;
    const bool window = grid->circle[slot] < 1;
    if (p_in && q_in && !twice) {
        grid->alive[slot / FIBRAD_DENSE_BLOCK] &= ~(1u << slot % FIBRAD_DENSE_BLOCK);
        grid->live--;
        return;
    }
    if (q_in || twice) {
        fibrad_dense_cut *cut = add_cut(areas, slot, at->from_sx[l], at->from_sy[l], !window);
        if (p_in) cut->rest = FIBRAD_DENSE_HIDDEN, cut->qx = grid->qx[slot], cut->qy = grid->qy[slot];
    }
    if (p_in || twice) {
        fibrad_dense_cut *cut = add_cut(areas, slot, at->from_ex[l], at->from_ey[l], window);
        if (!p_in) cut->rest = FIBRAD_DENSE_OPEN, cut->qx = grid->qx[slot], cut->qy = grid->qy[slot];
    }
    if (p_in) grid->px[slot] = at->ex[l], grid->py[slot] = at->ey[l];
    if (q_in || twice) grid->qx[slot] = at->sx[l], grid->qy[slot] = at->sy[l];
}

FIBRAD_INLINE fibrad_arc_lanes gather_slots(const fibrad_dense *grid, const uint32_t *slot) {
    return (fibrad_arc_lanes){vd_gather(grid->px, slot), vd_gather(grid->py, slot),    vd_gather(grid->qx, slot),
                              vd_gather(grid->qy, slot), vd_gather(grid->cx, slot),    vd_gather(grid->cy, slot),
                              vd_gather(grid->r, slot),  vd_gather(grid->circle, slot)};
}

/* Cuts the arcs that the new disc touches. False: a decision is degenerate. *changed: whether there are such arcs. */
static bool cut_boundary(fibrad_areas *areas, const dense_circle *disc, bool *changed) {
    const fibrad_dense *grid = &areas->dense;
    const uint32_t count = list_near(grid, disc);
    fibrad_zero(grid->near + count, VD_LANES * sizeof *grid->near); /* the last vector also reads these */
    for (uint32_t n = 0; n < count; n += VD_LANES) {
        const uint32_t *slot = grid->near + n, lanes = vd_lanes_below(count - n);
        const fibrad_arc_lanes a = gather_slots(grid, slot);
        const dense_case c = classify_lanes(&a, disc);
        const uint32_t p_in = vm_bits(c.p_in), q_in = vm_bits(c.q_in), twice = vm_bits(c.twice);
        if ((vm_bits(c.degenerate) & lanes) != 0) return false;
        uint32_t bits = (p_in | q_in | twice) & lanes;
        if (bits == 0) continue;
        *changed = true;
        dense_points at;
        cut_lanes(areas, &a, &c, bits, &at);
        for (; bits != 0; bits &= bits - 1) {
            const uint32_t l = (uint32_t)__builtin_ctz(bits);
            cut_slot(areas, slot[l], l, p_in >> l & 1, q_in >> l & 1, twice >> l & 1, &at);
        }
    }
    return true;
}

static void sort_cuts(fibrad_dense *grid) {
    fibrad_dense_cut *cut = grid->cut;
    for (uint32_t n = 0; n < grid->cuts; n++) {
        const double x = cut[n].x, y = cut[n].y, part = x / (fibrad_abs(x) + fibrad_abs(y));
        cut[n].ahead = y >= 0 ? 1 - part : 3 + part;
    }
    for (uint64_t gap = fibrad_sort_first_gap(grid->cuts); gap > 0; gap = fibrad_sort_next_gap(gap))
        for (uint64_t n = gap; n < grid->cuts; n++) {
            const fibrad_dense_cut moving = cut[n];
            uint64_t to = n;
            for (; to >= gap && moving.ahead < cut[to - gap].ahead; to -= gap) cut[to] = cut[to - gap];
            cut[to] = moving;
        }
}

/* Joins each point where the boundary leaves the disc with the next point, counter-clockwise, where it enters the
 * disc. False: the points do not alternate or are too close. */
static bool join_cuts(fibrad_areas *areas, const dense_circle *disc) {
    fibrad_dense *grid = &areas->dense;
    const fibrad_dense_cut *cut = grid->cut;
    const uint32_t count = grid->cuts;
    if (count > 2) sort_cuts(grid);
    for (uint32_t n = 0; n < count; n++) {
        const uint32_t after = n + 1 < count ? n + 1 : 0;
        if (cut[n].leaves == cut[after].leaves) return false;
        if (count > 2 && n + 1 < count && cut[after].ahead - cut[n].ahead < DENSE_ANGLE) return false;
        if (cut[n].leaves && !add_joint(areas, disc, &cut[n], &cut[after])) return false;
    }
    return true;
}

/* Whether a point within the window is open: it lies in no disc so far. */
static bool place_is_open(const fibrad_areas *areas, double x, double y) {
    const fibrad_dense *grid = &areas->dense;
    uint32_t at = grid->first_disc[cell_of(grid->fine, x, y)];
    for (; at < FIBRAD_DENSE_FULL; at = grid->disc[at].next) {
        const uint32_t m = grid->disc[at].circle;
        const double dx = x - areas->x[m], dy = y - areas->y[m];
        if (dx * dx + dy * dy < areas->r[m] * areas->r[m]) return false;
    }
    return at == FIBRAD_DENSE_NONE;
}

/* Enters a disc into the cells that it overlaps. */
static void enter_disc(fibrad_areas *areas, const dense_circle *disc) {
    fibrad_dense *grid = &areas->dense;
    const dense_range range = range_of(grid->fine, disc, disc->r);
    const double wide = 2.0 / grid->fine, square = disc->r * disc->r;
    for (uint32_t line = range.line[0]; line <= range.line[1]; line++)
        for (uint32_t column = range.column[0]; column <= range.column[1]; column++) {
            uint32_t *first = &grid->first_disc[line * grid->fine + column];
            if (*first == FIBRAD_DENSE_FULL) continue;
            const double dx = fibrad_abs((column + 0.5) * wide - 1 - disc->x) + 0.5 * wide;
            const double dy = fibrad_abs((line + 0.5) * wide - 1 - disc->y) + 0.5 * wide;
            if (dx * dx + dy * dy < square) {
                *first = FIBRAD_DENSE_FULL;
                continue;
            }
            if (grid->discs == grid->discs_most) {
                areas->overflow = true;
                return;
            }
            grid->disc[grid->discs] = (fibrad_dense_disc){areas->circles, *first};
            *first = grid->discs++;
        }
}

/* Ends the part of an arc that follows its two cuts. cut: the first of them. */
static void end_rest(fibrad_areas *areas, const dense_circle *disc, const fibrad_dense_cut *cut) {
    const fibrad_dense *grid = &areas->dense;
    const uint32_t k = cut->slot;
    const dense_circle old = {grid->cx[k], grid->cy[k], grid->r[k], grid->circle[k]};
    const double px = cut->x + (disc->x - old.x), py = cut->y + (disc->y - old.y);
    if (cut->rest == FIBRAD_DENSE_OPEN)
        put_arc(areas, &old, px, py, cut->qx, cut->qy);
    else
        hide_part(areas, k, px, py, cut->qx, cut->qy);
}

/* Removes from the open region its part inside the disc of the last circle. Keeps the circle if a part of it is
 * visible. False: a decision is degenerate. */
static bool hide_dense_disc(fibrad_areas *areas) {
    fibrad_dense *grid = &areas->dense;
    const uint32_t k = areas->circles;
    const dense_circle disc = {areas->x[k], areas->y[k], areas->r[k], k};
    bool changed = false;
    grid->cuts = 0;
    if (!cut_boundary(areas, &disc, &changed)) return false;
    for (uint32_t n = 0; n < grid->cuts; n++)
        if (grid->cut[n].rest != FIBRAD_DENSE_STAYS) end_rest(areas, &disc, &grid->cut[n]);
    if (grid->cuts > 0) {
        if (!join_cuts(areas, &disc)) return false;
    } else if (disc.r < 1 && disc.x * disc.x + disc.y * disc.y < (1 - disc.r) * (1 - disc.r) &&
               place_is_open(areas, disc.x + disc.r, disc.y)) {
        add_whole(areas, &disc);
        changed = true;
    }
    if (!changed) return true;
    enter_disc(areas, &disc);
    areas->circles++;
    return true;
}

/* Chooses the grid and empties it. discs: number of discs. sum: sum of their radii, where each radius counts as 1 at
 * most. */
static void begin_dense(fibrad_areas *areas, uint32_t discs, double sum) {
    fibrad_dense *grid = &areas->dense;
    uint32_t cells = DENSE_CELLS, enough = 16 * cells * cells;
    for (; discs > enough && cells < DENSE_CELLS_MOST; enough *= 16) cells *= 4;
    const double finest = discs > 0 ? fibrad_max(DENSE_CELLS, DENSE_FINENESS * discs / sum) : DENSE_CELLS_MOST;
    const bool coarse = cells < finest && cells < DENSE_CELLS_MOST;
    grid->fine = coarse ? cells : (uint32_t)fibrad_min(finest, cells);
    grid->cells = grid->fine / 2;
    if (grid->fine < DENSE_CELLS_LEAST) grid->fine = grid->cells = 1;
    grid->enough = coarse ? enough : UINT32_MAX;
    grid->blocks = grid->discs = grid->live = 0;
    grid->reach = 0;
    grid->longest = 4.0 / (grid->cells * grid->cells);
    areas->overflow = grid->fine * grid->fine > grid->cells_most;
    for (uint32_t cell = 0; cell < grid->fine * grid->fine && !areas->overflow; cell++)
        grid->first_block[cell] = grid->first_disc[cell] = FIBRAD_DENSE_NONE;
    areas->dense.on = areas->dense.written = true;
    areas->boundary->alive = UINT64_MAX;
    areas->pieces->count = 0;
    areas->circles = 0;
    fibrad_areas_add_circle(areas, 0, 0, 0, 1);
    if (!areas->overflow) add_whole(areas, &(dense_circle){0, 0, 1, 0});
    areas->circles = 1;
}

void LANED(fibrad_dense_begin)(fibrad_areas *areas, const uint32_t *which, uint32_t count, const double *r) {
    double sum = 0;
    for (uint32_t n = 0; n < count; n++) sum += fibrad_min(r[which[n]], 1);
    begin_dense(areas, DENSE_MORE * count, DENSE_MORE * sum);
    areas->open = !areas->overflow;
}

bool LANED(fibrad_dense_resolve)(fibrad_areas *areas, uint32_t circles) {
    double sum = 0;
    for (uint32_t k = 1; k < circles; k++) sum += fibrad_min(areas->r[k], 1);
    begin_dense(areas, circles - 1, sum);
    for (uint32_t k = 1; k < circles && !areas->overflow && areas->dense.live > 0; k++) {
        fibrad_areas_add_circle(areas, areas->whose[k], areas->x[k], areas->y[k], areas->r[k]);
        if (!hide_dense_disc(areas)) return false;
    }
    return true;
}

bool LANED(fibrad_dense_hide)(fibrad_areas *areas) {
    if (areas->circles > areas->dense.enough) return LANED(fibrad_dense_resolve)(areas, areas->circles + 1);
    return hide_dense_disc(areas);
}

void LANED(fibrad_dense_rest)(fibrad_areas *areas, uint32_t rest) {
    const fibrad_dense *grid = &areas->dense;
    for (uint32_t n = 0; n < grid->blocks; n++)
        for (uint32_t o = 0; grid->alive[n] >> o != 0; o += VD_LANES) {
            const uint32_t k = n * FIBRAD_DENSE_BLOCK + o;
            const fibrad_arc_lanes piece = {vd_load(grid->px + k), vd_load(grid->py + k),    vd_load(grid->qx + k),
                                            vd_load(grid->qy + k), vd_load(grid->cx + k),    vd_load(grid->cy + k),
                                            vd_load(grid->r + k),  vd_load(grid->circle + k)};
            LANED(fibrad_arcs_add)(areas, grid->alive[n] >> o & vd_lanes_below(VD_LANES), &piece, rest);
        }
}
