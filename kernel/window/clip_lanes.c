/* clip_lanes.c - exact visible areas of discs in a window by clipping its open region. Compiled once per instruction
 * set. SPDX-License-Identifier: MIT
 *
 * The open region - what no disc covers so far - is known by its boundary: arcs of the window's circle and of the
 * circles of discs. A new disc cuts them, in lanes over the arcs: the parts inside it leave the boundary, and are
 * pieces of the boundary of what is seen of it. Walk along the boundary, the open region on the left: where the walk
 * enters the disc, the boundary now goes on along the disc's circle, clockwise, to the next point where it leaves.
 *
 * An arc is cut once if one of its ends is inside the disc. If both are outside it may be cut twice, about the
 * direction in which the disc lies; if both are inside, about the opposite one. So divisions and roots say where an arc
 * is cut, but never whether.
 *
 * This breaks where rounding decides. All decisions therefore have a margin, far above rounding; a window in which one
 * of them is too close is done again by accounts. */
#include FIBRAD_LANES_HEADER
#include "base/lanes/below.h"
#include "window/arc_lanes.h"
#include "window/arrangement_lanes.h"
#include "window/clip_lanes.h"

#define PI       3.14159265358979323846
#define SQRT_3_4 0.86602540378443865
#define CLOSURE  1e-12

/* Decisions closer than this are in doubt: distances of points and circles, relative to the radii for tangent ones.
 * ROUNDING: the same for what rounds with the square of a large radius. */
#define MARGIN   1e-10
#define ROUNDING 1e-14
/* Discs of larger radius round too much. */
#define LARGEST 1000.0

static inline void put(double *array, uint32_t slot, double value) {
    double *vector = array + slot / VD_LANES * VD_LANES;
    vd_store(vector, vd_replace(vd_load(vector), slot % VD_LANES, value));
}

/* Puts an arc into a free slot. False if there is none. */
static inline bool add(fibrad_boundary *b, double px, double py, double qx, double qy, double cx, double cy, double r,
                       double circle) {
    uint32_t slot = (uint32_t)__builtin_ctzll(~b->alive);
    if (slot == FIBRAD_BOUNDARY) return false;
    put(b->px, slot, px), put(b->py, slot, py), put(b->qx, slot, qx), put(b->qy, slot, qy);
    put(b->cx, slot, cx), put(b->cy, slot, cy), put(b->r, slot, r), put(b->circle, slot, circle);
    uint64_t bit = UINT64_C(1) << slot;
    b->alive |= bit;
    b->window = circle < 1 ? b->window | bit : b->window & ~bit;
    return true;
}

/* Moves arcs to lower slots if they fit into eight slots fewer. */
static inline void close_up(fibrad_boundary *b) {
    uint32_t last = (63 - (uint32_t)__builtin_clzll(b->alive)) / 8 * 8;
    if (fibrad_count_bits(b->alive) > last) return;
    for (uint64_t bits = b->alive >> last << last; bits != 0; bits &= bits - 1) {
        uint32_t k = (uint32_t)__builtin_ctzll(bits);
        b->alive &= ~(UINT64_C(1) << k);
        add(b, b->px[k], b->py[k], b->qx[k], b->qy[k], b->cx[k], b->cy[k], b->r[k], b->circle[k]);
    }
}

/* Adds an arc of half a circle or more in four parts. */
static bool add_parts(fibrad_boundary *b, double px, double py, double qx, double qy, double cx, double cy, double r,
                      double circle) {
    double point[5][2] = {{px, py}, {0, 0}, {0, 0}, {0, 0}, {qx, qy}};
    for (int step = 4; step > 1; step /= 2)
        for (int from = 0; from < 4; from += step) {
            const double *p = point[from], *q = point[from + step];
            double ux = q[1] - p[1], uy = p[0] - q[0], scale = r / fibrad_sqrt(ux * ux + uy * uy);
            point[from + step / 2][0] = ux * scale, point[from + step / 2][1] = uy * scale;
        }
    bool done = true;
    for (int n = 0; n < 4 && done; n++)
        done = add(b, point[n][0], point[n][1], point[n + 1][0], point[n + 1][1], cx, cy, r, circle);
    return done;
}

/* Which of the slots `enters` has the next point counter-clockwise from (px, py) on the circle of disc k, which is as
 * far from its centre; NONE if one is too close to tell. */
#define NONE FIBRAD_BOUNDARY
static uint32_t next(const fibrad_boundary *b, uint64_t enters, uint64_t window, double px, double py, double r) {
    double least = 4, margin = MARGIN + MARGIN / r;
    uint32_t nearest = NONE;
    for (uint64_t bits = enters; bits != 0; bits &= bits - 1) {
        uint32_t k = (uint32_t)__builtin_ctzll(bits), at = ~window >> k & 1;
        double qx = b->cut[at][0][k], qy = b->cut[at][1][k], turn = px * qy - py * qx, level = px * qx + py * qy;
        double sum = fibrad_abs(turn) + fibrad_abs(level);
        double ahead = turn >= 0 ? 1 - level / sum : 3 + level / sum; /* rises with the angle, 0 to 4 */
        if (!(ahead > margin && ahead < 4 - margin)) return NONE;
        if (ahead < least) least = ahead, nearest = k;
    }
    return nearest;
}

/* Adds to the boundary the arc of disc k from where slot p leaves the disc counter-clockwise to where slot q enters it.
 * False if these are too close to tell a short arc from a whole circle, or there are no slots. */
static inline bool join(fibrad_boundary *b, uint64_t window, uint32_t p, uint32_t q, double x, double y, double r,
                        double k) {
    uint32_t at_p = window >> p & 1, at_q = ~window >> q & 1; /* cut[1]: where the arc itself leaves the disc */
    double px = b->cut[at_p][0][p], py = b->cut[at_p][1][p], qx = b->cut[at_q][0][q], qy = b->cut[at_q][1][q];
    double turn = px * qy - py * qx, level = px * qx + py * qy, near = MARGIN * r;
    if (turn > near) return add(b, px, py, qx, qy, x, y, r, k);
    if (level > 0 && turn >= -near) return false;
    return add_parts(b, px, py, qx, qy, x, y, r, k);
}

/* Joins several points where the boundary leaves the disc each with the next one where it enters it. False if they do
 * not alternate. */
static bool join_several(fibrad_boundary *b, uint64_t leaves, uint64_t enters, double x, double y, double r, double k) {
    const uint64_t window = b->window;
    uint64_t left = enters;
    for (uint64_t bits = leaves; bits != 0; bits &= bits - 1) {
        uint32_t p = (uint32_t)__builtin_ctzll(bits), at = window >> p & 1;
        uint32_t q = next(b, enters, window, b->cut[at][0][p], b->cut[at][1][p], r);
        if (q == NONE || (left >> q & 1) == 0 || !join(b, window, p, q, x, y, r, k)) return false;
        left &= ~(UINT64_C(1) << q);
    }
    return left == 0;
}

/* Whether a point within the window is open: in none of the discs before k. */
static bool is_open(const fibrad_areas *areas, uint32_t k, double x, double y) {
    uint32_t inside = 0;
    for (uint32_t m = 0; m < k; m += VD_LANES) {
        vd r = vd_load(areas->r + m), dx = x - vd_load(areas->x + m);
        vd dy = y - vd_load(areas->y + m);
        vm in = vd_lt(dx * dx + dy * dy, r * r);
        inside |= vm_bits(in) & vd_lanes_below(k - m) & (m == 0 ? ~1u : ~0u);
    }
    return inside == 0;
}

/* Lets disc k, whose circle has been added, take its part of the open region. False: in doubt. */
FIBRAD_INLINE bool clip(fibrad_areas *areas, uint32_t k, double x, double y, double r) {
    fibrad_boundary *b = areas->boundary;
    const uint64_t alive = b->alive;
    const uint32_t slots = 64 - (uint32_t)__builtin_clzll(alive);
    uint64_t p_inside = 0, q_inside = 0, twice = 0, doubt = 0;
    if (r > areas->widest) areas->widest = r;
    const vd u = vd_set1(x), v = vd_set1(y), radius = vd_set1(r);
    const double widest = areas->widest * areas->widest;
    const vd near = vd_set1(MARGIN * r + ROUNDING * widest), tangent = vd_set1(MARGIN * widest), zero = vd_set1(0),
             half = vd_set1(0.5);
    for (uint32_t o = 0; o < slots; o += VD_LANES) {
        vd px = vd_load(b->px + o), py = vd_load(b->py + o), qx = vd_load(b->qx + o), qy = vd_load(b->qy + o);
        vd cx = vd_load(b->cx + o), cy = vd_load(b->cy + o), c_r = vd_load(b->r + o);
        /* an end p is inside if p.d > middle; both circles meet if the distance middle/d is less than the radius */
        vd dx = u - cx, dy = v - cy, square = dx * dx + dy * dy;
        vd sum = c_r + radius, difference = c_r - radius;
        vd middle = half * (square + sum * difference);
        vd p_along = px * dx + py * dy, q_along = qx * dx + qy * dy;
        vd p_across = px * dy - py * dx, q_across = qx * dy - qy * dx;
        vd meeting = c_r * c_r * square - middle * middle;
        vm p_in = vd_lt(middle, p_along), q_in = vd_lt(middle, q_along), meet = vd_lt(zero, meeting);
        vm p_before = vd_lt(zero, p_across), q_after = vd_lt(q_across, zero);
        vm towards = p_before & q_after, away = vm_not(p_before | q_after);
        vm any_in = p_in | q_in, both_in = p_in & q_in;
        vm cut_twice = meet & ((both_in & away) | (vm_not(any_in) & towards));
        vm close = vd_le(vd_abs(p_along - middle), near) | vd_le(vd_abs(meeting), tangent * square);
        uint32_t lanes = (uint32_t)(alive >> o) & vd_lanes_below(VD_LANES);
        uint32_t touching = vm_bits(any_in | cut_twice) & lanes;
        doubt |= vm_bits(close) & lanes;
        if (touching == 0) continue;

        /* the points s, where the circle enters the disc counter-clockwise, and e, where it leaves */
        vd outer = sum * sum - square, inner = square - difference * difference;
        vd scale = half / square, f = (middle + middle) * scale;
        vd h = vd_sqrt(vd_max(outer * inner, zero)) * scale;
        vd fx = f * dx, fy = f * dy, hx = h * dx, hy = h * dy;
        vd sx = fx + hy, sy = fy - hx, ex = fx - hy, ey = fy + hx;
        vd_store(b->cut[0][0] + o, sx - dx);
        vd_store(b->cut[0][1] + o, sy - dy);
        vd_store(b->cut[1][0] + o, ex - dx);
        vd_store(b->cut[1][1] + o, ey - dy);
        vd_store(b->old_qx + o, qx);
        vd_store(b->old_qy + o, qy);
        vm ends_early = q_in | cut_twice, goes_on = q_in & vm_not(cut_twice);
        vd_store(b->px + o, vd_select(p_in, ex, px));
        vd_store(b->py + o, vd_select(p_in, ey, py));
        vd_store(b->qx + o, vd_select(ends_early, sx, qx));
        vd_store(b->qy + o, vd_select(ends_early, sy, qy));
        fibrad_arc_lanes piece = {.px = vd_select(p_in, px, sx),
                                  .py = vd_select(p_in, py, sy),
                                  .qx = vd_select(goes_on, qx, ex),
                                  .qy = vd_select(goes_on, qy, ey),
                                  .cx = cx,
                                  .cy = cy,
                                  .r = c_r,
                                  .circle = vd_load(b->circle + o)};
        fibrad_arcs_append(areas, touching, &piece, k);
        p_inside |= (uint64_t)(vm_bits(p_in) & lanes) << o;
        q_inside |= (uint64_t)(vm_bits(q_in) & lanes) << o;
        twice |= (uint64_t)(vm_bits(cut_twice) & lanes) << o;
    }
    if (doubt != 0) return false;
    const uint64_t starts = (q_inside & ~p_inside) | twice, ends = (p_inside & ~q_inside) | twice;
    b->alive = alive & ~(p_inside & q_inside & ~twice);
    if ((starts | ends) == 0) { /* the disc's circle is all hidden or all open */
        bool island = r < 1 && x * x + y * y < (1 - r) * (1 - r) && is_open(areas, k, x + r, y);
        bool done = true;
        for (int n = 0; n < 3 && island; n++) {
            static const double corner[4][2] = {{1, 0}, {-0.5, SQRT_3_4}, {-0.5, -SQRT_3_4}, {1, 0}};
            const double *p = corner[n], *q = corner[n + 1];
            done = done && add(b, r * p[0], r * p[1], r * q[0], r * q[1], x, y, r, k);
        }
        areas->circles += island || b->alive != alive;
        return done;
    }

    areas->circles++;
    for (uint64_t bits = twice; bits != 0; bits &= bits - 1) { /* what is beyond the cut in the middle */
        uint32_t a = (uint32_t)__builtin_ctzll(bits);
        double dx = x - b->cx[a], dy = y - b->cy[a];
        if (p_inside >> a & 1) {
            fibrad_arc_lanes piece = {vd_set1(b->cut[0][0][a] + dx),
                                      vd_set1(b->cut[0][1][a] + dy),
                                      vd_set1(b->old_qx[a]),
                                      vd_set1(b->old_qy[a]),
                                      vd_set1(b->cx[a]),
                                      vd_set1(b->cy[a]),
                                      vd_set1(b->r[a]),
                                      vd_set1(b->circle[a])};
            LANED(fibrad_arcs_give)(areas, 1, &piece, k);
        } else if (!add(b, b->cut[1][0][a] + dx, b->cut[1][1][a] + dy, b->old_qx[a], b->old_qy[a], b->cx[a], b->cy[a],
                        b->r[a], b->circle[a])) {
            return false;
        }
    }
    const uint64_t leaves = (starts & ~b->window) | (ends & b->window);
    const uint64_t enters = (starts & b->window) | (ends & ~b->window);
    bool one = leaves != 0 && (leaves & (leaves - 1)) == 0 && enters != 0 && (enters & (enters - 1)) == 0;
    if (!one) return join_several(b, leaves, enters, x, y, r, k);
    return join(b, b->window, (uint32_t)__builtin_ctzll(leaves), (uint32_t)__builtin_ctzll(enters), x, y, r, k);
}

/* Does the window again, up to its first `circles` circles, by accounts. */
static bool redo(fibrad_areas *areas, uint32_t circles) {
    bool open = true;
    areas->degenerate = true;
    areas->fallbacks++;
    LANED(fibrad_arrangement_begin)(areas);
    for (uint32_t k = 1; k < circles && open; k++) /* which keeps no more circles than have been read */
        open = LANED(fibrad_arrangement_disc)(areas, areas->whose[k], areas->x[k], areas->y[k], areas->r[k]);
    return open;
}

void LANED(fibrad_areas_begin)(fibrad_areas *areas) {
    /* three arcs, that begin where no symmetry of a bed does */
    static _Alignas(FIBRAD_ALIGNMENT)
        const double start_x[8] = {0x1.e921dd42f09bap-1, -0x1.7799ed83d9d3ap-1, -0x1.c61fbefc5b202p-3};
    static _Alignas(FIBRAD_ALIGNMENT)
        const double start_y[8] = {0x1.2e9cd95baba34p-2, 0x1.5bf2a3a493975p-1, -0x1.f34110526968fp-1};
    static _Alignas(FIBRAD_ALIGNMENT)
        const double end_x[8] = {-0x1.7799ed83d9d3ap-1, -0x1.c61fbefc5b202p-3, 0x1.e921dd42f09bap-1};
    static _Alignas(FIBRAD_ALIGNMENT)
        const double end_y[8] = {0x1.5bf2a3a493975p-1, -0x1.f34110526968fp-1, 0x1.2e9cd95baba34p-2};
    fibrad_boundary *b = areas->boundary;
    vd zero = vd_set1(0);
    for (uint32_t o = 0; o < 3; o += VD_LANES) {
        vd_store(b->px + o, vd_load(start_x + o));
        vd_store(b->py + o, vd_load(start_y + o));
        vd_store(b->qx + o, vd_load(end_x + o));
        vd_store(b->qy + o, vd_load(end_y + o));
        vd_store(b->cx + o, zero);
        vd_store(b->cy + o, zero);
        vd_store(b->r + o, vd_set1(1));
        vd_store(b->circle + o, zero);
    }
    b->alive = b->window = 7;
    areas->widest = 1;
    areas->pieces->count = 0;
    areas->open = true;
    areas->degenerate = areas->overflow = false;
    areas->circles = 0;
    fibrad_areas_add_circle(areas, 0, 0, 0, 1);
    areas->circles = 1;
}

/* Lets one disc take its part. False once nothing is open. */
FIBRAD_INLINE bool take(fibrad_areas *areas, uint32_t whose, double x, double y, double r) {
    if (areas->degenerate) return LANED(fibrad_arrangement_disc)(areas, whose, x, y, r);
    uint32_t k = areas->circles;
    fibrad_areas_add_circle(areas, whose, x, y, r);
    if (r > LARGEST || !clip(areas, k, x, y, r)) return redo(areas, k + 1);
    if (areas->boundary->alive == 0) return false;
    close_up(areas->boundary);
    return true;
}

/* A loop in here, since a call for each disc takes a twentieth of the instructions. */
uint32_t LANED(fibrad_areas_discs)(fibrad_areas *areas, uint32_t first, const uint32_t *which, uint32_t count,
                                   const double *x, const double *y, const double *r) {
    uint32_t n = 0;
    for (; n < count && areas->open; n++) {
        uint32_t k = which[n];
        areas->open = take(areas, first + k, x[k], y[k], r[k]);
    }
    return n;
}

bool LANED(fibrad_areas_disc)(fibrad_areas *areas, uint32_t whose, double x, double y, double r) {
    LANED(fibrad_areas_discs)(areas, whose, &(uint32_t){0}, 1, &x, &y, &r);
    return areas->open;
}

/* What is still open, as the area of the last circle; false if the areas cannot be right. */
static bool complete(fibrad_areas *areas) {
    fibrad_boundary *b = areas->boundary;
    uint32_t rest = areas->circles;
    fibrad_areas_add_circle(areas, 0, 0, 0, 1);
    for (uint32_t o = 0; b->alive >> o != 0; o += VD_LANES) {
        fibrad_arc_lanes piece = {vd_load(b->px + o), vd_load(b->py + o), vd_load(b->qx + o), vd_load(b->qy + o),
                                  vd_load(b->cx + o), vd_load(b->cy + o), vd_load(b->r + o),  vd_load(b->circle + o)};
        LANED(fibrad_arcs_give)(areas, (uint32_t)(b->alive >> o) & vd_lanes_below(VD_LANES), &piece, rest);
    }
    LANED(fibrad_areas_integrate)(areas);
    bool right = fibrad_abs(areas->area[0] + PI) < CLOSURE;
    for (uint32_t k = 1; k <= rest; k++) right = right & (areas->area[k] > -CLOSURE);
    return right;
}

double LANED(fibrad_areas_end)(fibrad_areas *areas) {
    if (!areas->degenerate) {
        if (complete(areas)) return areas->area[areas->circles];
        redo(areas, areas->circles);
    }
    return LANED(fibrad_arrangement_end)(areas);
}
