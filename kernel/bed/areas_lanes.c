/* areas_lanes.c - exact visible areas of discs in a window by clipping its open region. Compiled once per instruction
 * set. SPDX-License-Identifier: MIT
 *
 * The open region - what no disc covers so far - is known by its boundary: arcs of the window's circle and of the
 * circles of discs, walked with the region on the left. A new disc cuts them, in lanes over the arcs: the parts inside
 * it leave the boundary, and are pieces of the boundary of what is seen of it. Where the walk enters the disc, the new
 * boundary goes on along the disc's circle, clockwise, to the next point where the walk leaves it.
 *
 * An arc is cut once if one of its ends is inside the disc. If both are outside it may be cut twice, about the
 * direction in which the disc lies; if both are inside, about the opposite one. So divisions and roots say where an arc
 * is cut, but never whether. Ends shared by two arcs have the same bits, and get the same answer.
 *
 * This breaks where rounding decides. All decisions therefore have a margin, a million times the rounding; a window in
 * which one of them is too close is done again by accounts. */
#include FIBRAD_LANES_HEADER
#include "bed/accounts_lanes.h"
#include "bed/areas_lanes.h"
#include "bed/pieces_lanes.h"

#define PI     3.14159265358979323846
#define MARGIN 1e-10
/* Discs of larger radius round too much for the margin. */
#define LARGEST 1000.0
#define CLOSURE 1e-12

/* The cosine of the angle of the longest arc, about 154 degrees: arcs have to be shorter than half a circle. */
#define LONGEST (-0.9)

/* The lanes below n. */
static inline uint32_t lanes_below(uint32_t n) {
    uint32_t lanes = n < VD_LANES ? n : VD_LANES;
    return (1u << lanes) - 1;
}

static inline void put(double *array, uint32_t slot, double value) {
    double *vector = array + slot / VD_LANES * VD_LANES;
    vd_store(vector, vd_replace(vd_load(vector), slot % VD_LANES, value));
}

/* Puts an arc into a free slot. False if there is none. */
static inline bool add(fibrad_boundary *b, double px, double py, double qx, double qy, double x, double y, double r,
                       double circle) {
    if (~b->alive == 0) return false;
    uint32_t slot = (uint32_t)__builtin_ctzll(~b->alive);
    put(b->px, slot, px), put(b->py, slot, py), put(b->qx, slot, qx), put(b->qy, slot, qy);
    put(b->cx, slot, x), put(b->cy, slot, y), put(b->r, slot, r), put(b->circle, slot, circle);
    b->alive |= UINT64_C(1) << slot;
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

/* Adds the arc of disc k clockwise from p to q. In four parts if it is longer than half its circle, in two if it is
 * nearly as long. False: no slots, or p and q too close to tell a short arc from a whole circle. */
static bool join(fibrad_areas *areas, uint32_t k, double px, double py, double qx, double qy) {
    fibrad_boundary *b = areas->boundary;
    double x = areas->x[k], y = areas->y[k], r = areas->r[k];
    double ax = px - x, ay = py - y, bx = qx - x, by = qy - y, turn = ay * bx - ax * by, level = ax * bx + ay * by;
    double near = MARGIN * r;
    if (turn > near && level > LONGEST * r * r) return add(b, px, py, qx, qy, x, y, r, k);
    if (level > 0 && turn >= -near && turn <= near) return false;

    double point[5][2] = {{px, py}, {0, 0}, {0, 0}, {0, 0}, {qx, qy}};
    bool half = turn > 0;
    for (int step = 4; step >= (half ? 4 : 2); step /= 2)
        for (int from = 0; from < 4; from += step) {
            const double *p = point[from], *q = point[from + step];
            double ux = p[1] - q[1], uy = q[0] - p[0], scale = r / fibrad_sqrt(ux * ux + uy * uy);
            point[from + step / 2][0] = x + ux * scale, point[from + step / 2][1] = y + uy * scale;
        }
    bool done = true;
    for (int from = 0, step = half ? 2 : 1; from < 4; from += step) {
        const double *p = point[from], *q = point[from + step];
        done = done && add(b, p[0], p[1], q[0], q[1], x, y, r, k);
    }
    return done;
}

/* How far it is clockwise from (ax, ay) to (bx, by), in quarters that rise with the angle. */
static double clockwise(double ax, double ay, double bx, double by) {
    double turn = ay * bx - ax * by, level = ax * bx + ay * by, sum = fibrad_abs(turn) + fibrad_abs(level);
    return turn >= 0 ? 1 - level / sum : 3 + level / sum;
}

/* Joins several points where the boundary enters disc k with those where it leaves it: each with the next one
 * clockwise. False if they do not alternate, or are too close to tell. */
static bool join_several(fibrad_areas *areas, uint32_t k, uint64_t enters, uint64_t leaves) {
    const fibrad_boundary *b = areas->boundary;
    double x = areas->x[k], y = areas->y[k], margin = MARGIN + MARGIN / areas->r[k];
    uint64_t used = 0;
    for (uint64_t from = enters; from != 0; from &= from - 1) {
        uint32_t p = (uint32_t)__builtin_ctzll(from), nearest = 0;
        double px = b->enter_x[p], py = b->enter_y[p], least = 4;
        for (uint64_t to = leaves; to != 0; to &= to - 1) {
            uint32_t q = (uint32_t)__builtin_ctzll(to);
            double ahead = clockwise(px - x, py - y, b->leave_x[q] - x, b->leave_y[q] - y);
            if (!(ahead > margin && ahead < 4 - margin)) return false;
            if (ahead < least) least = ahead, nearest = q;
        }
        uint64_t bit = UINT64_C(1) << nearest;
        if ((used & bit) != 0 || !join(areas, k, px, py, b->leave_x[nearest], b->leave_y[nearest])) return false;
        used |= bit;
    }
    return used == leaves;
}

/* Whether a point within the window is open: in no disc but the new one, k. *doubtful if that is too close to tell. */
static bool is_open(const fibrad_areas *areas, uint32_t k, double x, double y, bool *doubtful) {
    uint32_t inside = 0, close = 0;
    for (uint32_t m = 0; m < k; m += VD_LANES) {
        vd r = vd_load(areas->r + m), dx = vd_sub(vd_set1(x), vd_load(areas->x + m));
        vd dy = vd_sub(vd_set1(y), vd_load(areas->y + m));
        vd power = vd_sub(vd_add(vd_mul(dx, dx), vd_mul(dy, dy)), vd_mul(r, r));
        vd near = vd_mul(vd_set1(MARGIN), vd_mul(r, vd_add(vd_set1(1), r)));
        uint32_t discs = lanes_below(k - m) & (m == 0 ? ~1u : ~0u);
        inside |= vm_bits(vd_lt(power, vd_sub(vd_set1(0), near))) & discs;
        close |= vm_bits(vd_le(power, near)) & discs;
    }
    if (inside == 0 && close != 0) *doubtful = true;
    return inside == 0;
}

/* Lets disc k, whose circle has been added, take its part of the open region. False: in doubt. */
static bool clip(fibrad_areas *areas, uint32_t k) {
    double x = areas->x[k], y = areas->y[k], r = areas->r[k];
    fibrad_boundary *b = areas->boundary;
    uint64_t enters = 0, leaves = 0, twice = 0, gone = 0, touched = 0, doubt = 0;
    uint64_t alive = b->alive;
    uint32_t slots = 64 - (uint32_t)__builtin_clzll(alive);
    vd u = vd_set1(x), v = vd_set1(y), radius = vd_set1(r), square_r = vd_set1(r * r), zero = vd_set1(0);
    vd near = vd_set1(MARGIN * r * (1 + r)), half = vd_set1(0.5);
    for (uint32_t o = 0; o < slots; o += VD_LANES) {
        vd px = vd_load(b->px + o), py = vd_load(b->py + o), qx = vd_load(b->qx + o), qy = vd_load(b->qy + o);
        vd cx = vd_load(b->cx + o), cy = vd_load(b->cy + o), c_r = vd_load(b->r + o), circle = vd_load(b->circle + o);
        /* ends inside the disc */
        vd pu = vd_sub(px, u), pv = vd_sub(py, v), qu = vd_sub(qx, u), qv = vd_sub(qy, v);
        vd p_power = vd_sub(vd_add(vd_mul(pu, pu), vd_mul(pv, pv)), square_r);
        vd q_power = vd_sub(vd_add(vd_mul(qu, qu), vd_mul(qv, qv)), square_r);
        vm p_in = vd_lt(p_power, zero), q_in = vd_lt(q_power, zero);
        /* (tx, ty): the direction of the disc from the arc's centre, turned a quarter ahead */
        vd dx = vd_sub(u, cx), dy = vd_sub(v, cy);
        vm window = vd_lt(circle, half);
        vd tx = vd_select(window, vd_sub(zero, dy), dy), ty = vd_select(window, dx, vd_sub(zero, dx));
        vd p_ahead = vd_add(vd_mul(vd_sub(px, cx), tx), vd_mul(vd_sub(py, cy), ty));
        vd q_ahead = vd_add(vd_mul(vd_sub(qx, cx), tx), vd_mul(vd_sub(qy, cy), ty));
        /* the circles meet if this is positive */
        vd square = vd_add(vd_mul(dx, dx), vd_mul(dy, dy)), sum = vd_add(c_r, radius), difference = vd_sub(c_r, radius);
        vd outer = vd_sub(vd_mul(sum, sum), square), inner = vd_sub(square, vd_mul(difference, difference));
        vd product = vd_mul(outer, inner);
        vm meet = vd_lt(zero, product);
        vm towards = vm_and(vd_lt(p_ahead, zero), vd_lt(zero, q_ahead));
        vm away = vm_and(vd_lt(q_ahead, zero), vd_lt(zero, p_ahead));
        vm both_in = vm_and(p_in, q_in), any_in = vm_or(p_in, q_in);
        vm middle = vm_and(meet, vm_or(vm_and(both_in, away), vm_and(vm_not(any_in), towards)));

        vm close = vm_or(vd_le(vd_abs(p_power), near), vd_le(vd_min(vd_abs(outer), vd_abs(inner)),
                                                             vd_mul(vd_set1(MARGIN), sum)));
        uint32_t lanes = (uint32_t)(alive >> o) & lanes_below(VD_LANES);
        uint32_t touching = vm_bits(vm_or(any_in, middle)) & lanes;
        doubt |= vm_bits(close) & lanes;
        if (touching == 0) continue;

        vd scale = vd_div(half, square);
        vd f = vd_mul(vd_add(square, vd_mul(sum, difference)), scale);
        vd h = vd_mul(vd_sqrt(vd_max(product, zero)), scale);
        vd fx = vd_add(cx, vd_mul(f, dx)), fy = vd_add(cy, vd_mul(f, dy)), hx = vd_mul(h, tx), hy = vd_mul(h, ty);
        vd ix = vd_sub(fx, hx), iy = vd_sub(fy, hy), lx = vd_add(fx, hx), ly = vd_add(fy, hy);
        vd_store(b->enter_x + o, ix);
        vd_store(b->enter_y + o, iy);
        vd_store(b->leave_x + o, lx);
        vd_store(b->leave_y + o, ly);
        vd_store(b->end_x + o, qx);
        vd_store(b->end_y + o, qy);
        vm ends_early = vm_or(q_in, middle), goes_on = vm_and(q_in, vm_not(middle));
        vd_store(b->px + o, vd_select(p_in, lx, px));
        vd_store(b->py + o, vd_select(p_in, ly, py));
        vd_store(b->qx + o, vd_select(ends_early, ix, qx));
        vd_store(b->qy + o, vd_select(ends_early, iy, qy));
        fibrad_piece_lanes piece = {.px = vd_select(p_in, px, ix),
                                    .py = vd_select(p_in, py, iy),
                                    .qx = vd_select(goes_on, qx, lx),
                                    .qy = vd_select(goes_on, qy, ly),
                                    .cx = cx,
                                    .cy = cy,
                                    .r = c_r,
                                    .circle = circle};
        fibrad_pieces_give(areas, touching, &piece, k);
        uint32_t p_bits = vm_bits(p_in) & lanes, q_bits = vm_bits(q_in) & lanes, m_bits = vm_bits(middle) & lanes;
        touched |= (uint64_t)touching << o;
        enters |= (uint64_t)((q_bits & ~p_bits) | m_bits) << o;
        leaves |= (uint64_t)((p_bits & ~q_bits) | m_bits) << o;
        twice |= (uint64_t)m_bits << o;
        gone |= (uint64_t)(p_bits & q_bits & ~m_bits) << o;
    }
    if (doubt != 0) return false;
    if (enters == 0) {
        b->alive = alive & ~gone;
        /* the disc's circle is all hidden or all open */
        bool island = false, doubtful = false;
        if (r < 1 && x * x + y * y < (1 - r) * (1 - r)) island = is_open(areas, k, x + r, y, &doubtful);
        if (leaves != 0 || doubtful) return false;
        if (island) {
            double far = 0x1.bb67ae8584caap-1 * r; /* sqrt(3/4) */
            double px = x + r, qx = x - r / 2, low = y - far, high = y + far;
            if (!add(b, px, y, qx, low, x, y, r, k) || !add(b, qx, low, qx, high, x, y, r, k) ||
                !add(b, qx, high, px, y, x, y, r, k))
                return false;
        }
        if (touched != 0 || island) areas->circles++;
        return true;
    }

    areas->circles++;
    b->alive = alive & ~gone;
    for (uint64_t bits = twice; bits != 0; bits &= bits - 1) { /* what is beyond the cut in the middle */
        uint32_t a = (uint32_t)__builtin_ctzll(bits);
        if (b->px[a] == b->leave_x[a] && b->py[a] == b->leave_y[a]) { /* it goes */
            fibrad_piece_lanes piece = {
                .px = vd_set1(b->enter_x[a]), .py = vd_set1(b->enter_y[a]),
                .qx = vd_set1(b->end_x[a]),   .qy = vd_set1(b->end_y[a]),
                .cx = vd_set1(b->cx[a]),      .cy = vd_set1(b->cy[a]),
                .r = vd_set1(b->r[a]),        .circle = vd_set1(b->circle[a])};
            fibrad_pieces_give(areas, 1, &piece, k);
        } else if (!add(b, b->leave_x[a], b->leave_y[a], b->end_x[a], b->end_y[a], b->cx[a], b->cy[a], b->r[a],
                        b->circle[a]))
            return false;
    }
    if ((enters & (enters - 1)) != 0 || (leaves & (leaves - 1)) != 0 || leaves == 0)
        return join_several(areas, k, enters, leaves);
    uint32_t from = (uint32_t)__builtin_ctzll(enters), to = (uint32_t)__builtin_ctzll(leaves);
    return join(areas, k, b->enter_x[from], b->enter_y[from], b->leave_x[to], b->leave_y[to]);
}

/* Does the window again, up to its first `circles` circles, by accounts. */
static bool redo(fibrad_areas *areas, uint32_t circles) {
    bool open = true;
    areas->doubtful = true;
    areas->fallbacks++;
    LANED(fibrad_accounts_begin)(areas);
    for (uint32_t k = 1; k < circles && open; k++) /* which keeps no more circles than have been read */
        open = LANED(fibrad_accounts_disc)(areas, areas->whose[k], areas->x[k], areas->y[k], areas->r[k]);
    return open;
}

void LANED(fibrad_areas_begin)(fibrad_areas *areas) {
    /* three arcs, that begin where no symmetry of a bed does */
    static _Alignas(FIBRAD_ALIGNMENT) const double start_x[8] = {0x1.e921dd42f09bap-1, -0x1.7799ed83d9d3ap-1,
                                                                 -0x1.c61fbefc5b202p-3};
    static _Alignas(FIBRAD_ALIGNMENT) const double start_y[8] = {0x1.2e9cd95baba34p-2, 0x1.5bf2a3a493975p-1,
                                                                 -0x1.f34110526968fp-1};
    static _Alignas(FIBRAD_ALIGNMENT) const double end_x[8] = {-0x1.7799ed83d9d3ap-1, -0x1.c61fbefc5b202p-3,
                                                               0x1.e921dd42f09bap-1};
    static _Alignas(FIBRAD_ALIGNMENT) const double end_y[8] = {0x1.5bf2a3a493975p-1, -0x1.f34110526968fp-1,
                                                               0x1.2e9cd95baba34p-2};
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
    b->alive = 7;
    areas->pieces->count = 0;
    areas->doubtful = false;
    areas->circles = 0;
    fibrad_areas_add_circle(areas, 0, 0, 0, 1);
    areas->circles = 1;
}

bool LANED(fibrad_areas_disc)(fibrad_areas *areas, uint32_t whose, double x, double y, double r) {
    if (areas->doubtful) return LANED(fibrad_accounts_disc)(areas, whose, x, y, r);
    if (areas->boundary->alive == 0) return false;
    uint32_t k = areas->circles;
    fibrad_areas_add_circle(areas, whose, x, y, r);
    if (r > LARGEST || !clip(areas, k)) return redo(areas, k + 1);
    if (areas->boundary->alive == 0) return false;
    close_up(areas->boundary);
    return true;
}

/* What is still open, as the area of the last circle; false if the areas cannot be right. */
static bool complete(fibrad_areas *areas) {
    fibrad_boundary *b = areas->boundary;
    uint32_t rest = areas->circles;
    fibrad_areas_add_circle(areas, 0, 0, 0, 1);
    for (uint32_t o = 0; b->alive >> o != 0; o += VD_LANES) {
        fibrad_piece_lanes piece = {vd_load(b->px + o), vd_load(b->py + o), vd_load(b->qx + o), vd_load(b->qy + o),
                                    vd_load(b->cx + o), vd_load(b->cy + o), vd_load(b->r + o),  vd_load(b->circle + o)};
        fibrad_pieces_give(areas, (uint32_t)(b->alive >> o) & lanes_below(VD_LANES), &piece, rest);
        if (o + VD_LANES >= 64) break;
    }
    LANED(fibrad_pieces_integrate)(areas);
    double least = 0;
    for (uint32_t k = 1; k <= rest; k++) least = fibrad_min(least, areas->area[k]);
    return least > -CLOSURE && fibrad_abs(areas->area[0] + PI) < CLOSURE;
}

double LANED(fibrad_areas_end)(fibrad_areas *areas) {
    if (!areas->doubtful) {
        if (complete(areas)) return areas->area[areas->circles];
        redo(areas, areas->circles);
    }
    return LANED(fibrad_accounts_end)(areas);
}
