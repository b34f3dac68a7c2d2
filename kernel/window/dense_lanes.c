/* dense_lanes.c - exact visible areas of discs in a window by clipping, where many arcs bound the open region. Compiled
 * once per instruction set. SPDX-License-Identifier: MIT
 *
 * As in clip_lanes.c a new disc cuts the boundary of the open region. But a grid over the window knows where arcs are,
 * so that a disc looks at those in its neighbourhood alone, and time goes with the number of discs. Arcs stand in the
 * cell of the middle of their chord, in blocks, which are compared with the disc in lanes; what is cut is then cut one
 * by one. A disc that cuts nothing is open or hidden as one of its points is: discs are known by cell, too.
 *
 * Decisions have margins as there, but in units of the circles at hand, since thousands of small discs make many
 * decisions. */
#include FIBRAD_LANES_HEADER
#include "base/constants.h"
#include "base/lanes/below.h"
#include "base/sort.h"
#include "window/arc_lanes.h"
#include "window/dense_lanes.h"

/* Decisions closer than this are degenerate: DENSE_MARGIN relative to the smaller circle, and DENSE_ROUNDING to the
 * larger one, whose rounding it is. */
#define DENSE_MARGIN   1e-10
#define DENSE_ROUNDING 1e-14
#define DENSE_ANGLE    1e-9 /* between two points of a circle */

/* Cells over the radius of the window: as many as the mean radius of discs goes into it, times this; and not many more
 * than there are discs. */
#define DENSE_FINENESS   1.0
#define DENSE_CELLS      4u
#define DENSE_CELLS_MOST 1024u

static uint32_t cell_along(const fibrad_dense *grid, double x) {
    const double at = (x + 1) * grid->scale, last = grid->cells - 1;
    return (uint32_t)fibrad_min(fibrad_max(at, 0), last);
}

/* A block of a cell with a free slot, a new one if there is none; FIBRAD_DENSE_NONE if there is no room. */
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

/* Puts an arc into the cell of the middle of its chord. */
static void put_arc(fibrad_areas *areas, const dense_circle *c, double px, double py, double qx, double qy) {
    fibrad_dense *grid = &areas->dense;
    const uint32_t column = cell_along(grid, c->x + 0.5 * (px + qx)), line = cell_along(grid, c->y + 0.5 * (py + qy));
    const uint32_t block = block_with_room(grid, line * grid->cells + column);
    if (block == FIBRAD_DENSE_NONE) {
        areas->overflow = true;
        return;
    }
    const uint32_t lane = (uint32_t)__builtin_ctz(~grid->alive[block]);
    fibrad_dense_block *b = &grid->block[block];
    grid->alive[block] |= 1u << lane;
    b->px[lane] = px, b->py[lane] = py, b->qx[lane] = qx, b->qy[lane] = qy;
    b->cx[lane] = c->x, b->cy[lane] = c->y, b->r[lane] = c->r, b->circle[lane] = c->number;
    grid->live++;
    const double dx = qx - px, dy = qy - py, square = dx * dx + dy * dy;
    if (square > 4 * grid->reach * grid->reach) grid->reach = 0.5 * fibrad_sqrt(square);
}

/* Adds an arc in parts that are shorter than a third of the circle, and than a cell. */
static void add_parts(fibrad_areas *areas, const dense_circle *c, double px, double py, double qx, double qy) {
    double end[64][2];
    end[0][0] = qx, end[0][1] = qy;
    const double square = c->r * c->r, least = fibrad_max(-0.5 * square, square - 0.5 * areas->dense.longest);
    for (int left = 0; left >= 0;) {
        const double ex = end[left][0], ey = end[left][1];
        if (left < 63 && (px * ey - py * ex <= 0 || px * ex + py * ey < least)) { /* halve it */
            const double ux = ey - py, uy = px - ex, scale = c->r / fibrad_sqrt(ux * ux + uy * uy);
            left++;
            end[left][0] = ux * scale, end[left][1] = uy * scale;
            continue;
        }
        put_arc(areas, c, px, py, ex, ey);
        px = ex, py = ey, left--;
    }
}

/* Adds the arc from p to q. False if they are too close to distinguish a short arc from a whole circle. */
static bool add_joint(fibrad_areas *areas, const dense_circle *c, const fibrad_dense_cut *p,
                      const fibrad_dense_cut *q) {
    const double cross = p->x * q->y - p->y * q->x, dot = p->x * q->x + p->y * q->y;
    if (fibrad_abs(cross) <= DENSE_ANGLE * (c->r * c->r) && dot > 0) return false;
    add_parts(areas, c, p->x, p->y, q->x, q->y);
    return true;
}

/* Adds a whole circle. Its parts begin in directions that are not on any symmetry of a bed. */
static void add_whole(fibrad_areas *areas, const dense_circle *c) {
    static const double corner[4][2] = {{0x1.e921dd42f09bap-1, 0x1.2e9cd95baba34p-2},
                                        {-0x1.7799ed83d9d3ap-1, 0x1.5bf2a3a493975p-1},
                                        {-0x1.c61fbefc5b202p-3, -0x1.f34110526968fp-1},
                                        {0x1.e921dd42f09bap-1, 0x1.2e9cd95baba34p-2}};
    for (int n = 0; n < 3; n++)
        add_parts(areas, c, c->r * corner[n][0], c->r * corner[n][1], c->r * corner[n + 1][0], c->r * corner[n + 1][1]);
}

/* Gives a part of an arc to the pieces of the new disc. */
static void hide_part(fibrad_areas *areas, const fibrad_dense_block *b, uint32_t lane, double px, double py, double qx,
                      double qy) {
    fibrad_pieces *pieces = areas->pieces;
    const uint32_t n = pieces->count++;
    pieces->px[n] = px, pieces->py[n] = py, pieces->qx[n] = qx, pieces->qy[n] = qy;
    pieces->cx[n] = b->cx[lane], pieces->cy[n] = b->cy[lane], pieces->r[n] = b->r[lane];
    pieces->circle[n] = b->circle[lane], pieces->occluder[n] = areas->circles;
    if (pieces->count == FIBRAD_PIECES) LANED(fibrad_areas_integrate)(areas);
}

/* The arcs of a block that the new disc touches, as bits. */
typedef struct dense_touch {
    uint32_t p_in, q_in, twice, degenerate;
} dense_touch;

/* Which arcs have ends inside the disc or are cut twice: as in clip_lanes.c, but whether an end is inside is decided by
 * its distance from the disc's centre, which is exact to rounding of the disc's radius for circles of any size. */
static dense_touch classify_block(const fibrad_dense_block *b, uint32_t alive, double x, double y, double r) {
    dense_touch touch = {0, 0, 0, 0};
    const vd zero = vd_set1(0), radius = vd_set1(r);
    for (uint32_t o = 0; o < FIBRAD_DENSE_BLOCK; o += VD_LANES) {
        const uint32_t lanes = alive >> o & vd_lanes_below(VD_LANES);
        if (lanes == 0) continue;
        const vd px = vd_load(b->px + o), py = vd_load(b->py + o);
        const vd qx = vd_load(b->qx + o), qy = vd_load(b->qy + o);
        const vd dx = x - vd_load(b->cx + o), dy = y - vd_load(b->cy + o), own = vd_load(b->r + o);
        const vd p_far = (px - dx) * (px - dx) + (py - dy) * (py - dy) - r * r;
        const vd q_far = (qx - dx) * (qx - dx) + (qy - dy) * (qy - dy) - r * r;
        const vd square = dx * dx + dy * dy, sum = own + r, difference = own - r;
        const vd meeting = (sum * sum - square) * (square - difference * difference);
        const vm p_in = vd_lt(p_far, zero), q_in = vd_lt(q_far, zero);
        const vm before = vd_lt(zero, px * dy - py * dx), after = vd_lt(qx * dy - qy * dx, zero);
        const vm may = (p_in & q_in & vm_not(before | after)) | (vm_not(p_in | q_in) & before & after);
        const vd wide = vd_max(own, radius), narrow = vd_min(own, radius), ww = wide * wide, nn = narrow * narrow;
        const vd near = 2 * DENSE_MARGIN * r * r + 2 * DENSE_ROUNDING * wide;
        const vd tangent = DENSE_MARGIN * (nn * ww) + 10 * DENSE_ROUNDING * (ww * ww);
        const vm close = vd_le(vd_abs(p_far), near) | vd_le(vd_abs(q_far), near);
        touch.p_in |= (vm_bits(p_in) & lanes) << o;
        touch.q_in |= (vm_bits(q_in) & lanes) << o;
        touch.twice |= (vm_bits(may & vd_lt(zero, meeting)) & lanes) << o;
        touch.degenerate |= (vm_bits(close | (may & vd_le(vd_abs(meeting), tangent))) & lanes) << o;
    }
    return touch;
}

/* Adds a cut. False if there is no room. */
static fibrad_dense_cut *add_cut(fibrad_areas *areas, uint32_t block, uint32_t lane, double x, double y, bool leaves) {
    fibrad_dense *grid = &areas->dense;
    if (grid->cuts == grid->cuts_most) {
        areas->overflow = true;
        grid->cuts = 0; /* the row begins anew, with more room */
    }
    fibrad_dense_cut *cut = &grid->cut[grid->cuts++];
    *cut = (fibrad_dense_cut){.x = x, .y = y, .block = block, .lane = lane, .leaves = leaves};
    return cut;
}

/* Cuts the arc in a slot, of which an end is inside the disc or both cuts are on it: what is outside stays in the slot,
 * but for the second part of two. The arc's circle enters the disc at s and leaves it at e, counter-clockwise; a walk
 * with the open region on its left goes that way along the window's circle, and the other way along discs'. */
static void cut_arc(fibrad_areas *areas, uint32_t block, uint32_t lane, bool p_in, bool q_in,
                    const dense_circle *disc) {
    fibrad_dense_block *b = &areas->dense.block[block];
    const double dx = disc->x - b->cx[lane], dy = disc->y - b->cy[lane], r = b->r[lane];
    const double square = dx * dx + dy * dy, sum = r + disc->r, difference = r - disc->r, scale = 0.5 / square;
    const double outer = sum * sum - square, inner = square - difference * difference;
    const double f = (square + sum * difference) * scale, h = fibrad_sqrt(fibrad_max(outer * inner, 0)) * scale;
    const double sx = f * dx + h * dy, sy = f * dy - h * dx, ex = f * dx - h * dy, ey = f * dy + h * dx;
    const double px = b->px[lane], py = b->py[lane], qx = b->qx[lane], qy = b->qy[lane];
    const bool window = b->circle[lane] < 1, twice = p_in == q_in;
    if (p_in) hide_part(areas, b, lane, px, py, ex, ey);
    if (q_in) hide_part(areas, b, lane, sx, sy, qx, qy);
    if (twice && !p_in) hide_part(areas, b, lane, sx, sy, ex, ey);
    if (p_in || twice) {
        fibrad_dense_cut *end = add_cut(areas, block, lane, ex - dx, ey - dy, window);
        end->rest = !p_in, end->qx = qx, end->qy = qy;
        if (p_in) b->px[lane] = ex, b->py[lane] = ey;
    }
    if (q_in || twice) {
        add_cut(areas, block, lane, sx - dx, sy - dy, !window);
        b->qx[lane] = sx, b->qy[lane] = sy;
    }
}

/* Cuts the arcs of a block. False: degenerate. *changed: some arc was touched. */
static bool cut_block(fibrad_areas *areas, uint32_t block, const dense_circle *disc, bool *changed) {
    fibrad_dense *grid = &areas->dense;
    const fibrad_dense_block *b = &grid->block[block];
    const dense_touch touch = classify_block(b, grid->alive[block], disc->x, disc->y, disc->r);
    if (touch.degenerate != 0) return false;
    for (uint32_t bits = touch.p_in | touch.q_in | touch.twice; bits != 0; bits &= bits - 1) {
        const uint32_t lane = (uint32_t)__builtin_ctz(bits);
        const bool p_in = touch.p_in >> lane & 1, q_in = touch.q_in >> lane & 1, twice = touch.twice >> lane & 1;
        *changed = true;
        if (!p_in || !q_in || twice) {
            cut_arc(areas, block, lane, p_in, q_in, disc);
            continue;
        }
        hide_part(areas, b, lane, b->px[lane], b->py[lane], b->qx[lane], b->qy[lane]);
        grid->alive[block] &= ~(1u << lane);
        grid->live--;
    }
    return true;
}

/* The cells that a square of half width `half` about a disc overlaps. */
typedef struct dense_range {
    uint32_t column[2], line[2];
} dense_range;

static dense_range range_of(const fibrad_dense *grid, const dense_circle *disc, double half) {
    return (dense_range){{cell_along(grid, disc->x - half), cell_along(grid, disc->x + half)},
                         {cell_along(grid, disc->y - half), cell_along(grid, disc->y + half)}};
}

static bool cut_boundary(fibrad_areas *areas, const dense_circle *disc, bool *changed) {
    const fibrad_dense *grid = &areas->dense;
    const dense_range range = range_of(grid, disc, disc->r + grid->reach * (1 + DENSE_MARGIN));
    for (uint32_t line = range.line[0]; line <= range.line[1]; line++)
        for (uint32_t column = range.column[0]; column <= range.column[1]; column++) {
            uint32_t block = grid->first_block[line * grid->cells + column];
            for (; block != FIBRAD_DENSE_NONE; block = grid->next[block])
                if (grid->alive[block] != 0 && !cut_block(areas, block, disc, changed)) return false;
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

/* Joins each point where the boundary leaves the disc with the next one, counter-clockwise, where it enters it. False
 * if they do not alternate, or are too close. */
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

/* Whether a point within the window is open: in no disc so far. */
static bool place_is_open(const fibrad_areas *areas, double x, double y) {
    const fibrad_dense *grid = &areas->dense;
    uint32_t at = grid->first_disc[cell_along(grid, y) * grid->cells + cell_along(grid, x)];
    for (; at < FIBRAD_DENSE_FULL; at = grid->disc[at].next) {
        const uint32_t m = grid->disc[at].circle;
        const double dx = x - areas->x[m], dy = y - areas->y[m];
        if (dx * dx + dy * dy < areas->r[m] * areas->r[m]) return false;
    }
    return at == FIBRAD_DENSE_NONE;
}

/* Enters a disc into the cells it overlaps. */
static void enter_disc(fibrad_areas *areas, const dense_circle *disc) {
    fibrad_dense *grid = &areas->dense;
    const dense_range range = range_of(grid, disc, disc->r);
    const double wide = 1 / grid->scale, square = disc->r * disc->r;
    for (uint32_t line = range.line[0]; line <= range.line[1]; line++)
        for (uint32_t column = range.column[0]; column <= range.column[1]; column++) {
            uint32_t *first = &grid->first_disc[line * grid->cells + column];
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

/* Removes from the open region its part inside the disc of the circle that has been written, and keeps the circle if
 * there is any. False: degenerate. */
static bool hide_dense_disc(fibrad_areas *areas) {
    fibrad_dense *grid = &areas->dense;
    const uint32_t k = areas->circles;
    const dense_circle disc = {areas->x[k], areas->y[k], areas->r[k], k};
    bool changed = false;
    grid->cuts = 0;
    if (!cut_boundary(areas, &disc, &changed)) return false;
    for (uint32_t n = 0; n < grid->cuts; n++) {
        const fibrad_dense_cut *cut = &grid->cut[n];
        const fibrad_dense_block *b = &grid->block[cut->block];
        const uint32_t lane = cut->lane;
        const dense_circle old = {b->cx[lane], b->cy[lane], b->r[lane], b->circle[lane]};
        if (cut->rest) put_arc(areas, &old, cut->x + (disc.x - old.x), cut->y + (disc.y - old.y), cut->qx, cut->qy);
    }
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

/* Chooses the grid for the first `circles` circles, and empties it. */
static void begin_dense(fibrad_areas *areas, uint32_t circles) {
    fibrad_dense *grid = &areas->dense;
    double sum = 0;
    for (uint32_t k = 1; k < circles; k++) sum += fibrad_min(areas->r[k], 1);
    uint32_t cells = DENSE_CELLS, enough = 4 * cells * cells;
    for (; circles > enough && cells < DENSE_CELLS_MOST; enough *= 16) cells *= 4;
    const double finest =
        circles > 1 ? fibrad_max(DENSE_CELLS, DENSE_FINENESS * (circles - 1) / sum) : DENSE_CELLS_MOST;
    const bool coarse = cells < finest && cells < DENSE_CELLS_MOST;
    grid->cells = coarse ? cells : (uint32_t)fibrad_min(finest, cells);
    grid->enough = coarse ? enough : UINT32_MAX;
    grid->blocks = grid->discs = grid->live = 0;
    grid->scale = 0.5 * grid->cells;
    grid->reach = 0;
    grid->longest = 1 / (grid->scale * grid->scale);
    areas->overflow = grid->cells * grid->cells > grid->cells_most;
    for (uint32_t cell = 0; cell < grid->cells * grid->cells && !areas->overflow; cell++)
        grid->first_block[cell] = grid->first_disc[cell] = FIBRAD_DENSE_NONE;
    areas->pieces->count = 0;
    areas->circles = 0;
    fibrad_areas_add_circle(areas, 0, 0, 0, 1);
    if (!areas->overflow) add_whole(areas, &(dense_circle){0, 0, 1, 0});
    areas->circles = 1;
}

bool LANED(fibrad_dense_resolve)(fibrad_areas *areas, uint32_t circles) {
    areas->dense.on = areas->dense.written = true;
    begin_dense(areas, circles);
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
            const fibrad_dense_block *b = &grid->block[n];
            const fibrad_arc_lanes piece = {vd_load(b->px + o), vd_load(b->py + o),    vd_load(b->qx + o),
                                            vd_load(b->qy + o), vd_load(b->cx + o),    vd_load(b->cy + o),
                                            vd_load(b->r + o),  vd_load(b->circle + o)};
            LANED(fibrad_arcs_add)(areas, grid->alive[n] >> o & vd_lanes_below(VD_LANES), &piece, rest);
        }
}
