/* clip_lanes.c - exact visible areas of discs in a window by clipping its open region. Compiled once per instruction
 * set. SPDX-License-Identifier: MIT
 *
 * The open region is the part that no disc covers so far. Its boundary represents it: arcs on the circle of the
 * window and on the circles of discs. A new disc cuts these arcs, in lanes over the arcs. The parts inside the disc
 * leave the boundary. They also bound the visible part of the disc. Think of a walk along the boundary with the open
 * region on the left. Where the walk enters the disc, the new boundary follows the circle of the disc, clockwise, to
 * the next point where the old boundary leaves the disc.
 *
 * An arc is cut once if one of its ends is inside the disc. If both ends are outside, it may be cut twice, near the
 * direction of the disc. If both are inside, it may be cut twice, near the opposite direction. So divisions and
 * roots decide where an arc is cut, but never whether it is cut.
 *
 * Clipping fails where rounding decides. So all decisions have a margin far above rounding errors. A window with a
 * decision within its margin is degenerate. The arrangement of circles computes it again. */
#include FIBRAD_LANES_HEADER
#include "base/lanes/below.h"
#include "window/arc_lanes.h"
#include "window/arrangement_lanes.h"
#include "window/clip_lanes.h"
#include "window/dense_lanes.h"

#define SQRT_3_4     0.86602540378443865
#define CLIP_CLOSURE 1e-12 /* errors of areas above this bound show that the areas are wrong */

/* Decisions that are closer than this are degenerate. They compare distances of points and circles, relative to the
 * radii for tangent circles. CLIP_ROUNDING is the bound for errors that grow with the square of a large radius. */
#define CLIP_MARGIN   1e-10
#define CLIP_ROUNDING 1e-14
/* For discs with larger radii the rounding errors are too large. */
#define CLIP_RADIUS_MAX 1000.0

static inline void put_lane(double *array, uint32_t slot, double value) {
    double *vector = array + slot / VD_LANES * VD_LANES;
    vd_store(vector, vd_replace(vd_load(vector), slot % VD_LANES, value));
}

/* Puts an arc into a free slot. False: there is no free slot. */
static inline bool add_arc(fibrad_boundary *b, double px, double py, double qx, double qy, double cx, double cy,
                           double r, double circle) {
    uint32_t slot = (uint32_t)__builtin_ctzll(~b->alive);
    if (slot == FIBRAD_BOUNDARY) return false;
    put_lane(b->px, slot, px), put_lane(b->py, slot, py), put_lane(b->qx, slot, qx), put_lane(b->qy, slot, qy);
    put_lane(b->cx, slot, cx), put_lane(b->cy, slot, cy), put_lane(b->r, slot, r), put_lane(b->circle, slot, circle);
    uint64_t bit = UINT64_C(1) << slot;
    b->alive |= bit;
    b->window = circle < 1 ? b->window | bit : b->window & ~bit;
    return true;
}

/* Moves arcs to lower slots if they then need eight slots fewer. */
static inline void close_up_slots(fibrad_boundary *b) {
    uint32_t last = (63 - (uint32_t)__builtin_clzll(b->alive)) / 8 * 8;
    if (fibrad_count_bits(b->alive) > last) return;
    for (uint64_t bits = b->alive >> last << last; bits != 0; bits &= bits - 1) {
        uint32_t k = (uint32_t)__builtin_ctzll(bits);
        b->alive &= ~(UINT64_C(1) << k);
        add_arc(b, b->px[k], b->py[k], b->qx[k], b->qy[k], b->cx[k], b->cy[k], b->r[k], b->circle[k]);
    }
}

/* Adds an arc of half a circle or more as four arcs. */
static bool add_large_arc(fibrad_boundary *b, double px, double py, double qx, double qy, double cx, double cy,
                          double r, double circle) {
    double point[5][2] = {{px, py}, {0, 0}, {0, 0}, {0, 0}, {qx, qy}};
    for (int step = 4; step > 1; step /= 2)
        for (int from = 0; from < 4; from += step) {
            const double *p = point[from], *q = point[from + step];
            double ux = q[1] - p[1], uy = p[0] - q[0], scale = r / fibrad_sqrt(ux * ux + uy * uy);
            point[from + step / 2][0] = ux * scale, point[from + step / 2][1] = uy * scale;
        }
    bool done = true;
    for (int n = 0; n < 4 && done; n++)
        done = add_arc(b, point[n][0], point[n][1], point[n + 1][0], point[n + 1][1], cx, cy, r, circle);
    return done;
}

/* The slot among `enters` whose point is next, counter-clockwise from (px, py), on the circle of disc k. (px, py)
 * lies on this circle and is relative to its centre. NO_SLOT: a decision is degenerate. */
#define NO_SLOT FIBRAD_BOUNDARY
static uint32_t next_entry(const fibrad_boundary *b, uint64_t enters, uint64_t window, double px, double py, double r) {
    double least = 4, margin = CLIP_MARGIN + CLIP_MARGIN / r;
    uint32_t nearest = NO_SLOT;
    for (uint64_t bits = enters; bits != 0; bits &= bits - 1) {
        uint32_t k = (uint32_t)__builtin_ctzll(bits), at = ~window >> k & 1;
        double qx = b->cut[at][0][k], qy = b->cut[at][1][k], cross = px * qy - py * qx, dot = px * qx + py * qy;
        double sum = fibrad_abs(cross) + fibrad_abs(dot);
        double ahead = cross >= 0 ? 1 - dot / sum : 3 + dot / sum; /* pseudo-angle, 0 to 4 */
        if (!(ahead > margin && ahead < 4 - margin)) return NO_SLOT;
        if (ahead < least) least = ahead, nearest = k;
    }
    return nearest;
}

/* Adds to the boundary an arc of disc k. The arc goes counter-clockwise from the point where slot p leaves the disc
 * to the point where slot q enters it. False: the points are too close to tell a short arc from a whole circle, or
 * no slot is free. */
static inline bool join_slots(fibrad_boundary *b, uint64_t window, uint32_t p, uint32_t q, double x, double y, double r,
                              double k) {
    uint32_t at_p = window >> p & 1, at_q = ~window >> q & 1; /* cut[1]: where the arc of the slot leaves the disc */
    double px = b->cut[at_p][0][p], py = b->cut[at_p][1][p], qx = b->cut[at_q][0][q], qy = b->cut[at_q][1][q];
    double cross = px * qy - py * qx, dot = px * qx + py * qy, near = CLIP_MARGIN * r;
    if (cross > near) return add_arc(b, px, py, qx, qy, x, y, r, k);
    if (dot > 0 && cross >= -near) return false;
    return add_large_arc(b, px, py, qx, qy, x, y, r, k);
}

/* Joins each of several points where the boundary leaves the disc with the next point where it enters. False: the
 * points do not alternate. */
static bool join_several(fibrad_boundary *b, uint64_t leaves, uint64_t enters, double x, double y, double r, double k) {
    const uint64_t window = b->window;
    uint64_t left = enters;
    for (uint64_t bits = leaves; bits != 0; bits &= bits - 1) {
        uint32_t p = (uint32_t)__builtin_ctzll(bits), at = window >> p & 1;
        uint32_t q = next_entry(b, enters, window, b->cut[at][0][p], b->cut[at][1][p], r);
        if (q == NO_SLOT || (left >> q & 1) == 0 || !join_slots(b, window, p, q, x, y, r, k)) return false;
        left &= ~(UINT64_C(1) << q);
    }
    return left == 0;
}

/* Whether a point within the window is open: it lies in no disc before k. */
static bool is_open(const fibrad_areas *areas, uint32_t k, double x, double y) {
    uint32_t inside = 0;
    for (uint32_t m = 0; m < k; m += VD_LANES) {
        vd r = vd_load(areas->r + m), dx = x - vd_load(areas->x + m), dy = y - vd_load(areas->y + m);
        vm in = vd_lt(dx * dx + dy * dy, r * r);
        inside |= vm_bits(in) & vd_lanes_below(k - m) & (m == 0 ? ~1u : ~0u);
    }
    return inside == 0;
}

/* The new disc in all lanes, with the margins of its decisions. */
typedef struct clip_disc {
    vd x, y, r, near, tangent;
} clip_disc;

static inline clip_disc disc_in_lanes(double x, double y, double r, double widest) {
    const double square = widest * widest;
    return (clip_disc){vd_set1(x), vd_set1(y), vd_set1(r), vd_set1(CLIP_MARGIN * r + CLIP_ROUNDING * square),
                       vd_set1(CLIP_MARGIN * square)};
}

/* A vector of arcs in comparison with the new disc. */
typedef struct clip_case {
    vd px, py, qx, qy, cx, cy, r;       /* the arcs */
    vd dx, dy, square, sum, difference; /* vector between the centres and its square; sum and difference of the radii */
    vd middle;                          /* p.d of the two points where the circles meet */
    vm p_in, q_in, any_in, cut_twice;   /* ends inside the disc; whether both cuts are on the arc */
    vm degenerate; /* within a margin; only the end p is checked, since each q is the p of another arc */
} clip_case;

/* An end p is inside if p.d > middle. The circles meet if the distance middle/d is less than the radius. */
FIBRAD_INLINE clip_case classify_arcs(const fibrad_boundary *b, uint32_t o, const clip_disc *disc) {
    clip_case c;
    c.px = vd_load(b->px + o), c.py = vd_load(b->py + o), c.qx = vd_load(b->qx + o), c.qy = vd_load(b->qy + o);
    c.cx = vd_load(b->cx + o), c.cy = vd_load(b->cy + o), c.r = vd_load(b->r + o);
    const vd zero = vd_set1(0);
    c.dx = disc->x - c.cx, c.dy = disc->y - c.cy, c.square = c.dx * c.dx + c.dy * c.dy;
    c.sum = c.r + disc->r, c.difference = c.r - disc->r;
    c.middle = 0.5 * (c.square + c.sum * c.difference);
    vd p_along = c.px * c.dx + c.py * c.dy, p_across = c.px * c.dy - c.py * c.dx;
    vd q_along = c.qx * c.dx + c.qy * c.dy, q_across = c.qx * c.dy - c.qy * c.dx;
    vd meeting = c.r * c.r * c.square - c.middle * c.middle;
    c.p_in = vd_lt(c.middle, p_along), c.q_in = vd_lt(c.middle, q_along), c.any_in = c.p_in | c.q_in;
    vm meet = vd_lt(zero, meeting), p_before = vd_lt(zero, p_across), q_after = vd_lt(q_across, zero);
    vm towards = p_before & q_after, away = vm_not(p_before | q_after);
    c.cut_twice = meet & ((c.p_in & c.q_in & away) | (vm_not(c.any_in) & towards));
    c.degenerate = vd_le(vd_abs(p_along - c.middle), disc->near) | vd_le(vd_abs(meeting), disc->tangent * c.square);
    return c;
}

/* Cuts a vector of arcs. The parts that remain stay in their slots, except the second parts of arcs that are cut
 * twice. The parts inside the disc, or their first parts, go to the pieces that disc k hides. */
FIBRAD_INLINE void cut_arcs(fibrad_areas *areas, uint32_t o, const clip_case *c, uint32_t touching, uint32_t k) {
    fibrad_boundary *b = areas->boundary;
    /* s: where the circle enters the disc counter-clockwise; e: where it leaves the disc */
    vd outer = c->sum * c->sum - c->square, inner = c->square - c->difference * c->difference;
    vd scale = 0.5 / c->square, f = (c->middle + c->middle) * scale;
    vd h = vd_sqrt(vd_max(outer * inner, vd_set1(0))) * scale;
    vd fx = f * c->dx, fy = f * c->dy, hx = h * c->dx, hy = h * c->dy;
    vd sx = fx + hy, sy = fy - hx, ex = fx - hy, ey = fy + hx;
    vd_store(b->cut[0][0] + o, sx - c->dx);
    vd_store(b->cut[0][1] + o, sy - c->dy);
    vd_store(b->cut[1][0] + o, ex - c->dx);
    vd_store(b->cut[1][1] + o, ey - c->dy);
    vd_store(b->old_qx + o, c->qx);
    vd_store(b->old_qy + o, c->qy);
    vm q_cut = c->q_in | c->cut_twice, q_hidden = c->q_in & vm_not(c->cut_twice);
    vd_store(b->px + o, vd_select(c->p_in, ex, c->px));
    vd_store(b->py + o, vd_select(c->p_in, ey, c->py));
    vd_store(b->qx + o, vd_select(q_cut, sx, c->qx));
    vd_store(b->qy + o, vd_select(q_cut, sy, c->qy));
    fibrad_arc_lanes piece = {.px = vd_select(c->p_in, c->px, sx),
                              .py = vd_select(c->p_in, c->py, sy),
                              .qx = vd_select(q_hidden, c->qx, ex),
                              .qy = vd_select(q_hidden, c->qy, ey),
                              .cx = c->cx,
                              .cy = c->cy,
                              .r = c->r,
                              .circle = vd_load(b->circle + o)};
    fibrad_arcs_append(areas, touching, &piece, k);
}

/* Adds the second part of arc a, which follows the cut in the middle. If the arc begins inside the disc, about (x,
 * y), the part goes to the pieces that disc k hides. Otherwise it goes to the boundary. False: no slot is free. */
FIBRAD_INLINE bool add_second_part(fibrad_areas *areas, uint32_t a, bool p_inside, double x, double y, uint32_t k) {
    fibrad_boundary *b = areas->boundary;
    double dx = x - b->cx[a], dy = y - b->cy[a];
    if (!p_inside)
        return add_arc(b, b->cut[1][0][a] + dx, b->cut[1][1][a] + dy, b->old_qx[a], b->old_qy[a], b->cx[a], b->cy[a],
                       b->r[a], b->circle[a]);
    fibrad_arc_lanes piece = {.px = vd_set1(b->cut[0][0][a] + dx),
                              .py = vd_set1(b->cut[0][1][a] + dy),
                              .qx = vd_set1(b->old_qx[a]),
                              .qy = vd_set1(b->old_qy[a]),
                              .cx = vd_set1(b->cx[a]),
                              .cy = vd_set1(b->cy[a]),
                              .r = vd_set1(b->r[a]),
                              .circle = vd_set1(b->circle[a])};
    LANED(fibrad_arcs_add)(areas, 1, &piece, k);
    return true;
}

/* Ends the step of a disc that cuts no arc. The circle of the disc is then wholly hidden or wholly open. If it is
 * open, the disc is an island, and its circle joins the boundary as three arcs. False: no slot is free. */
FIBRAD_INLINE bool add_island(fibrad_areas *areas, bool changed, uint32_t k, double x, double y, double r) {
    static const double corner[4][2] = {{1, 0}, {-0.5, SQRT_3_4}, {-0.5, -SQRT_3_4}, {1, 0}};
    bool island = r < 1 && x * x + y * y < (1 - r) * (1 - r) && is_open(areas, k, x + r, y);
    bool done = true;
    for (int n = 0; n < 3 && island; n++) {
        const double *p = corner[n], *q = corner[n + 1];
        done = done && add_arc(areas->boundary, r * p[0], r * p[1], r * q[0], r * q[1], x, y, r, k);
    }
    areas->circles += island || changed;
    return done;
}

static inline bool is_single(uint64_t bits) { return bits != 0 && (bits & (bits - 1)) == 0; }

/* Removes from the open region the part inside disc k, whose circle has been added. False: a decision is degenerate. */
FIBRAD_INLINE bool clip_disc_out(fibrad_areas *areas, uint32_t k, double x, double y, double r) {
    fibrad_boundary *b = areas->boundary;
    const uint64_t alive = b->alive;
    const uint32_t slots = 64 - (uint32_t)__builtin_clzll(alive);
    uint64_t p_inside = 0, q_inside = 0, twice = 0, degenerate = 0;
    if (r > areas->widest) areas->widest = r;
    const clip_disc disc = disc_in_lanes(x, y, r, areas->widest);
    for (uint32_t o = 0; o < slots; o += VD_LANES) {
        const clip_case c = classify_arcs(b, o, &disc);
        uint32_t lanes = (uint32_t)(alive >> o) & vd_lanes_below(VD_LANES);
        uint32_t touching = vm_bits(c.any_in | c.cut_twice) & lanes;
        degenerate |= vm_bits(c.degenerate) & lanes;
        if (touching == 0) continue;
        cut_arcs(areas, o, &c, touching, k);
        p_inside |= (uint64_t)(vm_bits(c.p_in) & lanes) << o;
        q_inside |= (uint64_t)(vm_bits(c.q_in) & lanes) << o;
        twice |= (uint64_t)(vm_bits(c.cut_twice) & lanes) << o;
    }
    if (degenerate != 0) return false;
    const uint64_t starts = (q_inside & ~p_inside) | twice, ends = (p_inside & ~q_inside) | twice;
    b->alive = alive & ~(p_inside & q_inside & ~twice);
    if ((starts | ends) == 0) return add_island(areas, b->alive != alive, k, x, y, r);

    areas->circles++;
    for (uint64_t bits = twice; bits != 0; bits &= bits - 1) {
        uint32_t a = (uint32_t)__builtin_ctzll(bits);
        if (!add_second_part(areas, a, p_inside >> a & 1, x, y, k)) return false;
    }
    const uint64_t leaves = (starts & ~b->window) | (ends & b->window);
    const uint64_t enters = (starts & b->window) | (ends & ~b->window);
    if (!is_single(leaves) || !is_single(enters)) return join_several(b, leaves, enters, x, y, r, k);
    return join_slots(b, b->window, (uint32_t)__builtin_ctzll(leaves), (uint32_t)__builtin_ctzll(enters), x, y, r, k);
}

/* Whether dense clipping has left a part open. */
static bool is_open_dense(const fibrad_areas *areas) { return areas->dense.live > 0 && !areas->overflow; }

/* Computes the window again with the arrangement, up to its first `circles` circles. */
static bool arrange_again(fibrad_areas *areas, uint32_t circles) {
    bool open = true;
    areas->degenerate = true;
    areas->fallbacks++;
    LANED(fibrad_arrangement_begin)(areas);
    for (uint32_t k = 1; k < circles && open; k++) /* the arrangement stores no more circles than it has read */
        open = LANED(fibrad_arrangement_disc)(areas, areas->whose[k], areas->x[k], areas->y[k], areas->r[k]);
    return open;
}

/* Computes the window again. If only the slots were too few, dense clipping does it. */
static bool resolve_again(fibrad_areas *areas, uint32_t circles) {
    if (!areas->dense.on && areas->boundary->alive == (UINT64_C(1) << FIBRAD_BOUNDARY) - 1 &&
        areas->r[circles - 1] <= CLIP_RADIUS_MAX && LANED(fibrad_dense_resolve)(areas, circles))
        return is_open_dense(areas);
    return arrange_again(areas, circles);
}

void LANED(fibrad_areas_begin)(fibrad_areas *areas) {
    const double(*corner)[2] = fibrad_areas_corner;
    fibrad_boundary *b = areas->boundary;
    for (uint32_t n = 0; n < 3; n++) {
        b->px[n] = corner[n][0], b->py[n] = corner[n][1], b->qx[n] = corner[n + 1][0], b->qy[n] = corner[n + 1][1];
        b->cx[n] = b->cy[n] = b->circle[n] = 0, b->r[n] = 1;
    }
    b->alive = b->window = 7;
    areas->widest = 1;
    areas->pieces->count = 0;
    areas->open = true;
    areas->degenerate = areas->overflow = areas->dense.on = false;
    areas->circles = 0;
    fibrad_areas_add_circle(areas, 0, 0, 0, 1);
    areas->circles = 1;
}

/* Hides what one disc covers in a window that dense clipping or the arrangement computes. False: nothing is open. */
static bool hide_slowly(fibrad_areas *areas, uint32_t whose, double x, double y, double r) {
    if (areas->degenerate) return LANED(fibrad_arrangement_disc)(areas, whose, x, y, r);
    const uint32_t k = areas->circles;
    fibrad_areas_add_circle(areas, whose, x, y, r);
    if (r <= CLIP_RADIUS_MAX && LANED(fibrad_dense_hide)(areas)) return is_open_dense(areas);
    return resolve_again(areas, k + 1);
}

/* Hides what one disc covers, in any window. False: nothing is open. */
FIBRAD_INLINE bool hide_disc(fibrad_areas *areas, uint32_t whose, double x, double y, double r) {
    if (areas->degenerate || areas->dense.on) return hide_slowly(areas, whose, x, y, r);
    uint32_t k = areas->circles;
    fibrad_areas_add_circle(areas, whose, x, y, r);
    if (r > CLIP_RADIUS_MAX || !clip_disc_out(areas, k, x, y, r)) return resolve_again(areas, k + 1);
    if (areas->boundary->alive == 0) return false;
    close_up_slots(areas->boundary);
    return true;
}

/* The loop is inside the function, since a call for each disc takes a twentieth of the instructions. */
uint32_t LANED(fibrad_areas_discs)(fibrad_areas *areas, uint32_t first, const uint32_t *which, uint32_t count,
                                   const double *x, const double *y, const double *r) {
    uint32_t n = 0;
    for (; n < count && areas->open; n++) {
        uint32_t k = which[n];
        areas->open = hide_disc(areas, first + k, x[k], y[k], r[k]);
    }
    return n;
}

/* Adds the open area, as the area of a last circle. False: the areas cannot be right. */
static bool complete_areas(fibrad_areas *areas) {
    fibrad_boundary *b = areas->boundary;
    uint32_t rest = areas->circles;
    fibrad_areas_add_circle(areas, 0, 0, 0, 1);
    if (areas->dense.on) LANED(fibrad_dense_rest)(areas, rest);
    for (uint32_t o = 0; !areas->dense.on && b->alive >> o != 0; o += VD_LANES) {
        fibrad_arc_lanes piece = {vd_load(b->px + o), vd_load(b->py + o), vd_load(b->qx + o), vd_load(b->qy + o),
                                  vd_load(b->cx + o), vd_load(b->cy + o), vd_load(b->r + o),  vd_load(b->circle + o)};
        LANED(fibrad_arcs_add)(areas, (uint32_t)(b->alive >> o) & vd_lanes_below(VD_LANES), &piece, rest);
    }
    LANED(fibrad_areas_integrate)(areas);
    uint32_t wrong = 0;
    for (uint32_t m = 0; m <= rest; m += VD_LANES) {
        uint32_t right = vm_bits(vd_lt(vd_set1(-CLIP_CLOSURE), vd_load(areas->area + m))) | (m == 0);
        wrong |= ~right & vd_lanes_below(rest + 1 - m);
    }
    return fibrad_abs(areas->area[0] + FIBRAD_PI) < CLIP_CLOSURE && wrong == 0;
}

double LANED(fibrad_areas_end)(fibrad_areas *areas) {
    if (areas->overflow) return 0;
    if (!areas->degenerate) {
        if (complete_areas(areas)) return areas->area[areas->circles];
        arrange_again(areas, areas->circles);
    }
    return LANED(fibrad_arrangement_end)(areas);
}
