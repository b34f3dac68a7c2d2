/* arrangement_lanes.c - exact visible areas of discs in a window by the arrangement of their circles. Compiled once
 * per instruction set. SPDX-License-Identifier: MIT
 *
 * The open region is the part that no disc covers so far. Its boundary represents it: arcs on the circle of the
 * window and on the circles of discs. A new disc k is compared with each circle m, in lanes over all m. Disc k
 * covers nothing of circle m, all of it, or the arc between the two points where the circles meet. Disc m covers the
 * corresponding part of circle k, between the same two points. Two results follow:
 *   - The visible part of circle k is the circle without what the older discs and the outside of the window hide.
 *   - Of each arc on the boundary of the open region, disc k hides a part.
 * The former arcs join the boundary of the open region. The latter leave it. Until then they bounded the visible
 * part of their own disc, from then on they bound the visible part of disc k. So they are integrated then, once for
 * both discs.
 *
 * Each circle has its own list of intervals. Two circles share only the two points where they meet. A wrong decision
 * about an arc as short as a rounding error costs an area as small as a rounding error, and has no other effect. No
 * chain of arcs can break. Multiple points, tangent circles and identical circles need no special treatment.
 *
 * A pseudo-angle gives the position of a unit vector (x, y) on its circle. It is y on the right quarter, and -x, -y
 * and x plus constants on the top, left and bottom quarters, so that it is continuous. It rises counter-clockwise by
 * about the angle. At the lower right diagonal it jumps from ANGLE_END to ANGLE_BEGIN. Arcs are cut there and at the
 * opposite point, ANGLE_MIDDLE. So no arc is longer than half a circle, and no arc passes the jump. */
#include FIBRAD_LANES_HEADER
#include "base/lanes/below.h"
#include "window/arc_lanes.h"
#include "window/arrangement_lanes.h"

#define DIAGONAL     0.70710678118654752
#define ANGLE_BEGIN  (-DIAGONAL)
#define ANGLE_MIDDLE (3 * DIAGONAL)
#define ANGLE_END    (7 * DIAGONAL)
#define ANGLE_TURN   (8 * DIAGONAL)

/* Marks of intervals: `from` is this number and `to` is minus this number. The whole circle, or nothing of it. */
#define INTERVAL_ALL  -16.0
#define INTERVAL_NONE 16.0

/* Shorter arcs are left out. They come from rounding and would keep windows open. */
#define ARC_SHORTEST 1e-15

static _Alignas(FIBRAD_ALIGNMENT) const double lane_number[8] = {0, 1, 2, 3, 4, 5, 6, 7};

static inline vd pseudo_angle(vd x, vd y) {
    vd zero = vd_set1(0);
    vd sides = vd_select(vd_lt(x, zero), 4 * DIAGONAL - y, y);
    vd ends = vd_select(vd_lt(y, zero), 6 * DIAGONAL + x, 2 * DIAGONAL - x);
    return vd_select(vd_lt(vd_abs(x), vd_abs(y)), ends, sides);
}

/* Pseudo-angles between which the disc and the circle overlap. */
typedef struct interval_lanes {
    vd from, to;
} interval_lanes;

/* The interval from (px, py) to (qx, qy). cosine: of half its width. If the cosine is positive, the interval is less
 * than half a circle, otherwise more. If the interval found contradicts this, rounding has reversed it. A reversed
 * interval is INTERVAL_NONE or INTERVAL_ALL. */
static inline interval_lanes interval_of(vd cosine, vd px, vd py, vd qx, vd qy) {
    vd from = pseudo_angle(px, py), to = pseudo_angle(qx, qy), zero = vd_set1(0), length = to - from;
    length = vd_select(vd_lt(length, zero), length + ANGLE_TURN, length);
    vm narrow = vd_lt(zero, cosine), none = narrow & vd_lt(vd_set1(0.75 * ANGLE_TURN), length);
    vm all = vm_not(narrow) & vd_lt(length, vd_set1(0.25 * ANGLE_TURN));
    from = vd_select(none, vd_set1(INTERVAL_NONE), vd_select(all, vd_set1(INTERVAL_ALL), from));
    to = vd_select(none, vd_set1(-INTERVAL_NONE), vd_select(all, vd_set1(-INTERVAL_ALL), to));
    return (interval_lanes){from, to};
}

/* Circle k in comparison with circles m, in lanes over m. Two circles at distance d meet at c_m + f d -+ h d', where
 * d' is d turned left, f = (d^2 + r_m^2 - r^2)/(2 d^2) and g = 1 - f. h comes from the product of a sum and a
 * difference, so that nothing cancels for nearly tangent circles. */
typedef struct circle_pairs {
    vd x, y, difference; /* circles m; r_m - r */
    vd f, g, fx, fy, gx, gy, hx, hy;
    vm nested, whole; /* nested: one circle lies within the other; whole: nested or apart */
} circle_pairs;

FIBRAD_INLINE circle_pairs pairs_of(const fibrad_areas *areas, uint32_t m, vd x, vd y, vd r) {
    circle_pairs p;
    p.x = vd_load(areas->x + m), p.y = vd_load(areas->y + m);
    vd r_m = vd_load(areas->r + m), zero = vd_set1(0);
    vd dx = x - p.x, dy = y - p.y, square = dx * dx + dy * dy;
    vd sum = r_m + r;
    p.difference = r_m - r;
    vd outer = sum * sum - square, inner = square - p.difference * p.difference;
    p.nested = vd_le(inner, zero), p.whole = vd_le(outer, zero) | p.nested;
    vd scale = 0.5 / square, power = sum * p.difference; /* r_m^2 - r^2 */
    p.f = (square + power) * scale, p.g = (square - power) * scale;
    vd h = vd_sqrt(vd_max(outer, zero) * vd_max(inner, zero)) * scale;
    p.fx = p.f * dx, p.fy = p.f * dy, p.gx = p.g * dx, p.gy = p.g * dy, p.hx = h * dx, p.hy = h * dy;
    return p;
}

/* Writes the interval of each circle m that disc k covers, and its end points. */
FIBRAD_INLINE void write_covered(fibrad_arrangement *a, uint32_t m, const circle_pairs *p) {
    vd sx = p->fx + p->hy, sy = p->fy - p->hx, ex = p->fx - p->hy, ey = p->fy + p->hx;
    vd_store(a->sx + m, p->x + sx);
    vd_store(a->sy + m, p->y + sy);
    vd_store(a->ex + m, p->x + ex);
    vd_store(a->ey + m, p->y + ey);
    vd inverse = vd_load(a->inverse + m);
    interval_lanes covered = interval_of(p->f, sx * inverse, sy * inverse, ex * inverse, ey * inverse);
    vm m_inside = p->nested & vd_le(p->difference, vd_set1(0));
    vd from = vd_select(p->whole, vd_set1(INTERVAL_NONE), covered.from);
    vd to = vd_select(p->whole, vd_set1(-INTERVAL_NONE), covered.to);
    vd_store(a->from + m, vd_select(m_inside, vd_set1(INTERVAL_ALL), from));
    vd_store(a->to + m, vd_select(m_inside, vd_set1(-INTERVAL_ALL), to));
}

/* Appends the intervals of circle k that discs m hide. For the window, its outside hides. */
FIBRAD_INLINE void append_hidden(fibrad_intervals *hidden, uint32_t m, uint32_t lanes, const circle_pairs *p,
                                 vd inverse) {
    vd zero = vd_set1(0), number = vd_load(lane_number);
    interval_lanes own = interval_of(p->g, (zero - (p->gx + p->hy)) * inverse, (p->hx - p->gy) * inverse,
                                     (p->hy - p->gx) * inverse, (zero - (p->gy + p->hx)) * inverse);
    if (m == 0) {
        vm window = vd_lt(number, vd_set1(0.5));
        vd swap = own.from;
        own.from = vd_select(window, own.to, own.from);
        own.to = vd_select(window, swap, own.to);
    }
    uint32_t crossing = lanes & ~vm_bits(p->whole);
    if ((vm_bits(vd_lt(own.from, vd_set1(ANGLE_BEGIN - 1))) & crossing) != 0) hidden->all = true;
    vm empty = (vd_le(own.from, own.to) & vd_le(own.to, own.from)) | vd_lt(vd_set1(ANGLE_END + 1), own.from);
    uint32_t some = crossing & ~vm_bits(empty), count = hidden->count;
    vd_compress(hidden->from + count, some, own.from);
    vd_compress(hidden->to + count, some, own.to);
    vd_compress(hidden->circle + count, some, number + m);
    hidden->count = count + fibrad_count_bits(some);
}

/* Finds what disc k, about (x, y) with radius r, covers of all circles so far, and what their discs cover of its
 * circle. False: an older disc contains disc k. */
static bool intersect_circles(fibrad_areas *areas, double x, double y, double r, double inverse) {
    fibrad_intervals *hidden = &areas->arrangement.hidden;
    hidden->count = 0;
    hidden->all = false;
    for (uint32_t m = 0; m < areas->circles; m += VD_LANES) {
        const circle_pairs p = pairs_of(areas, m, vd_set1(x), vd_set1(y), vd_set1(r));
        uint32_t lanes = vd_lanes_below(areas->circles - m);
        uint32_t containing = vm_bits(p.nested & vd_le(vd_set1(0), p.difference)) & lanes;
        if (containing & (m == 0 ? ~1u : ~0u)) return false; /* the window contains disc k without hiding it */
        write_covered(&areas->arrangement, m, &p);
        append_hidden(hidden, m, lanes, &p, vd_set1(inverse));
    }
    return true;
}

/* Appends an arc. If it passes ANGLE_MIDDLE, the point (mx, my), it is appended in two pieces. */
static void append_open(fibrad_arcs *arcs, double a, double b, double px, double py, double qx, double qy,
                        double circle, double mx, double my) {
    if (b - a <= ARC_SHORTEST) return;
    bool cut = a < ANGLE_MIDDLE && ANGLE_MIDDLE < b;
    uint32_t k = arcs->count, n = k + 1;
    arcs->a[k] = a, arcs->px[k] = px, arcs->py[k] = py, arcs->circle[k] = circle;
    arcs->b[k] = cut ? ANGLE_MIDDLE : b, arcs->qx[k] = cut ? mx : qx, arcs->qy[k] = cut ? my : qy;
    arcs->a[n] = ANGLE_MIDDLE, arcs->px[n] = mx, arcs->py[n] = my, arcs->circle[n] = circle;
    arcs->b[n] = b, arcs->qx[n] = qx, arcs->qy[n] = qy;
    arcs->count = n + cut;
}

/* Which of the intervals i, i + 1 ..., in lanes, end inside another interval. Of equal ends the first one remains,
 * since an interval contains its own end only for later intervals. */
static inline uint32_t ends_hidden(const fibrad_intervals *h, uint32_t i) {
    vd to = vd_load(h->to + i);
    uint32_t hidden = 0;
    for (uint32_t j = 0; j < h->count; j++) {
        vd f = vd_set1(h->from[j]), t = vd_set1(h->to[j]);
        uint32_t not_later = j < i ? 0 : vd_lanes_below(j - i + 1);
        uint32_t after = vm_bits(vd_le(f, to));
        uint32_t before_end = vm_bits(vd_lt(to, t)) | (vm_bits(vd_le(to, t)) & ~not_later);
        uint32_t passes_jump = 0u - (h->to[j] < h->from[j]);
        hidden |= (after & before_end) | ((after | before_end) & passes_jump);
    }
    return hidden;
}

/* The interval that begins next, counter-clockwise from the pseudo-angle a. */
static inline uint32_t next_interval(const fibrad_intervals *h, double a) {
    uint32_t next = 0;
    double nearest = 2 * ANGLE_TURN;
    for (uint32_t j = 0; j < h->count; j++) {
        double ahead = h->from[j] - a;
        ahead = ahead < 0 ? ahead + ANGLE_TURN : ahead;
        next = ahead < nearest ? j : next;
        nearest = fibrad_min(ahead, nearest);
    }
    return next;
}

/* Adds the visible part of the new circle to the boundary of the open region. A visible arc begins at the end of a
 * hidden interval that lies inside no other interval. It ends where the next hidden interval begins. These
 * statements are exact for the numbers as they are, so rounding cannot make them contradict each other. False:
 * nothing is visible. */
static bool add_visible(fibrad_areas *areas, double x, double y, double r) {
    const fibrad_arrangement *a = &areas->arrangement;
    const fibrad_intervals *h = &a->hidden;
    fibrad_arcs *open = &areas->arrangement.open;
    uint32_t before = open->count;
    if (h->all) return false;
    double k = areas->circles, d = r * DIAGONAL, jx = x + d, jy = y - d, mx = x - d, my = y + d;
    if (h->count == 0) append_open(open, ANGLE_BEGIN, ANGLE_END, jx, jy, jx, jy, k, mx, my);
    for (uint32_t i = 0; i < h->count; i += VD_LANES)
        for (uint32_t bits = vd_lanes_below(h->count - i) & ~ends_hidden(h, i); bits != 0; bits &= bits - 1) {
            uint32_t begin = i + (uint32_t)__builtin_ctz(bits);
            double from = h->to[begin];
            uint32_t end = next_interval(h, from);
            /* disc m hides from the end of the covered interval of its circle to the beginning; the window does the
             * reverse */
            uint32_t m = (uint32_t)h->circle[begin], n = (uint32_t)h->circle[end];
            double to = h->from[end];
            double px = m == 0 ? a->ex[m] : a->sx[m], py = m == 0 ? a->ey[m] : a->sy[m];
            double qx = n == 0 ? a->sx[n] : a->ex[n], qy = n == 0 ? a->sy[n] : a->ey[n];
            if (open->count + 4 > a->arcs) {
                areas->overflow = true;
                return false;
            }
            bool jump = to < from;
            append_open(open, from, jump ? ANGLE_END : to, px, py, jump ? jx : qx, jump ? jy : qy, k, mx, my);
            if (jump) append_open(open, ANGLE_BEGIN, to, jx, jy, qx, qy, k, mx, my);
        }
    return open->count > before;
}

/* Arcs in lanes. */
typedef struct arc_vector {
    vd a, b, px, py, qx, qy, circle;
} arc_vector;

static inline arc_vector load_arcs(const fibrad_arcs *arcs, uint32_t k) {
    return (arc_vector){vd_load(arcs->a + k),  vd_load(arcs->b + k),  vd_load(arcs->px + k),    vd_load(arcs->py + k),
                        vd_load(arcs->qx + k), vd_load(arcs->qy + k), vd_load(arcs->circle + k)};
}

/* Appends the lanes given by bits. */
static inline void append_arcs(fibrad_arcs *arcs, uint32_t bits, const arc_vector *s) {
    uint32_t k = arcs->count;
    vd_compress(arcs->a + k, bits, s->a);
    vd_compress(arcs->b + k, bits, s->b);
    vd_compress(arcs->px + k, bits, s->px);
    vd_compress(arcs->py + k, bits, s->py);
    vd_compress(arcs->qx + k, bits, s->qx);
    vd_compress(arcs->qy + k, bits, s->qy);
    vd_compress(arcs->circle + k, bits, s->circle);
    arcs->count = k + fibrad_count_bits(bits);
}

static inline arc_vector select_arcs(vm m, const arc_vector *s, const arc_vector *t) {
    return (arc_vector){vd_select(m, s->a, t->a),
                        vd_select(m, s->b, t->b),
                        vd_select(m, s->px, t->px),
                        vd_select(m, s->py, t->py),
                        vd_select(m, s->qx, t->qx),
                        vd_select(m, s->qy, t->qy),
                        s->circle};
}

static inline uint32_t nonempty_arcs(const arc_vector *s) { return vm_bits(vd_lt(s->a, s->b)); }

/* Appends the lanes given by bits to the pieces of circle k. */
static void hide_arcs(fibrad_areas *areas, uint32_t bits, const arc_vector *s, uint32_t k) {
    uint32_t size = areas->circles + 1; /* the new circle, or the circle of the rest */
    vd x = vd_lookup(areas->x, size, s->circle), y = vd_lookup(areas->y, size, s->circle);
    fibrad_arc_lanes piece = {.px = s->px - x,
                              .py = s->py - y,
                              .qx = s->qx - x,
                              .qy = s->qy - y,
                              .cx = x,
                              .cy = y,
                              .r = vd_lookup(areas->r, size, s->circle),
                              .circle = s->circle};
    LANED(fibrad_arcs_add)(areas, bits, &piece, k);
}

/* Moves a whole list to the pieces of circle k. */
static void hide_list(fibrad_areas *areas, fibrad_arcs *list, uint32_t k) {
    for (uint32_t o = 0; o < list->count; o += VD_LANES) {
        arc_vector s = load_arcs(list, o);
        hide_arcs(areas, vd_lanes_below(list->count - o), &s, k);
    }
    list->count = 0;
}

/* The parts of arcs: `below`, `between` and `above` the bounds of the interval that is covered of their circle.
 * Usually `between` is covered. In the lanes of `round` the interval passes the jump, and the two others are
 * covered. */
typedef struct arc_parts {
    arc_vector below, between, above;
    vm round;
} arc_parts;

FIBRAD_INLINE arc_parts cut_at_interval(const fibrad_areas *areas, const arc_vector *s) {
    const fibrad_arrangement *a = &areas->arrangement;
    uint32_t size = areas->circles;
    vd from = vd_lookup(a->from, size, s->circle), to = vd_lookup(a->to, size, s->circle);
    vd sx = vd_lookup(a->sx, size, s->circle), sy = vd_lookup(a->sy, size, s->circle);
    vd ex = vd_lookup(a->ex, size, s->circle), ey = vd_lookup(a->ey, size, s->circle);
    vm round = vd_lt(to, from);
    vd low = vd_min(from, to), high = vd_max(from, to), tiny = vd_set1(ARC_SHORTEST);
    vd lx = vd_select(round, ex, sx), ly = vd_select(round, ey, sy);
    vd hx = vd_select(round, sx, ex), hy = vd_select(round, sy, ey);
    /* a bound that does not cut moves to the end of the arc; if nothing lies between the bounds, the whole arc is
     * below */
    vm low_below = vd_le(low - s->a, tiny), high_above = vd_le(s->b - high, tiny);
    vm none = vd_le(high - s->a, tiny) | vd_le(high - low, tiny) | vd_le(s->b - low, tiny);
    high_above |= none;
    low = vd_select(none, s->b, vd_select(low_below, s->a, low));
    lx = vd_select(none, s->qx, vd_select(low_below, s->px, lx));
    ly = vd_select(none, s->qy, vd_select(low_below, s->py, ly));
    high = vd_select(high_above, s->b, high);
    hx = vd_select(high_above, s->qx, hx);
    hy = vd_select(high_above, s->qy, hy);
    return (arc_parts){{s->a, low, s->px, s->py, lx, ly, s->circle},
                       {low, high, lx, ly, hx, hy, s->circle},
                       {high, s->b, hx, hy, s->qx, s->qy, s->circle},
                       round};
}

/* Removes from the boundary what lies in disc k. Each part of an arc may be missing. First and second parts are
 * listed in the order of the arcs, whatever the number of lanes. Returns whether something was removed. */
static bool remove_covered(fibrad_areas *areas, uint32_t k) {
    const fibrad_arcs open = areas->arrangement.open;
    fibrad_arcs *left = &areas->arrangement.left, *second = areas->arrangement.second;
    const uint32_t room = areas->arrangement.seconds;
    uint32_t any = 0;
    areas->overflow = areas->overflow || 2 * open.count > areas->arrangement.arcs;
    if (areas->overflow) return true;
    left->count = second[0].count = second[1].count = 0;
    for (uint32_t o = 0; o < open.count; o += VD_LANES) {
        const arc_vector s = load_arcs(&open, o);
        const arc_parts part = cut_at_interval(areas, &s);
        const arc_vector stays = select_arcs(part.round, &part.between, &part.below);
        const arc_vector goes = select_arcs(part.round, &part.below, &part.between);
        uint32_t lanes = vd_lanes_below(open.count - o), rounds = vm_bits(part.round);
        uint32_t going = nonempty_arcs(&goes) & lanes, seconds = nonempty_arcs(&part.above) & lanes;
        append_arcs(left, nonempty_arcs(&stays) & lanes, &stays);
        any |= going | (seconds & rounds);
        if (going != 0) hide_arcs(areas, going, &goes, k);
        if (seconds == 0) continue;
        append_arcs(&second[0], seconds & ~rounds, &part.above);
        append_arcs(&second[1], seconds & rounds, &part.above);
        areas->overflow = second[0].count > room || second[1].count > room;
        if (areas->overflow) return true;
    }
    if (any == 0) return false;
    hide_list(areas, &second[1], k);
    for (uint32_t o = 0; o < second[0].count; o += VD_LANES) {
        arc_vector s = load_arcs(&second[0], o);
        append_arcs(left, vd_lanes_below(second[0].count - o), &s);
    }
    areas->arrangement.open = *left;
    *left = open;
    return true;
}

void LANED(fibrad_arrangement_begin)(fibrad_areas *areas) {
    if (areas->dense.written) fibrad_areas_clear_arcs(areas);
    areas->circles = 0;
    areas->arrangement.open.count = areas->pieces->count = 0;
    fibrad_areas_add_circle(areas, 0, 0, 0, 1);
    areas->arrangement.inverse[0] = 1;
    areas->circles = 1;
    double d = DIAGONAL;
    append_open(&areas->arrangement.open, ANGLE_BEGIN, ANGLE_END, d, -d, d, -d, 0, -d, d);
}

bool LANED(fibrad_arrangement_disc)(fibrad_areas *areas, uint32_t whose, double x, double y, double r) {
    double sum = 1 + r, inverse = 1 / r;
    if (areas->arrangement.open.count == 0) return false;
    if (sum * sum - (x * x + y * y) <= 0 || !intersect_circles(areas, x, y, r, inverse)) return true;

    uint32_t k = areas->circles;
    fibrad_areas_add_circle(areas, whose, x, y, r);
    areas->arrangement.inverse[k] = inverse;
    bool any;
    if (areas->arrangement.from[0] == INTERVAL_ALL) { /* the window lies within the disc */
        hide_list(areas, &areas->arrangement.open, k);
        any = true;
    } else {
        any = remove_covered(areas, k);
        if (!areas->overflow && add_visible(areas, x, y, r)) any = true;
    }
    if (any) areas->circles++;
    if (areas->overflow) areas->arrangement.open.count = 0;
    return areas->arrangement.open.count > 0;
}

double LANED(fibrad_arrangement_end)(fibrad_areas *areas) {
    const uint32_t rest = areas->circles, arcs = areas->arrangement.open.count;
    fibrad_areas_add_circle(areas, 0, 0, 0, 1);
    hide_list(areas, &areas->arrangement.open, rest);
    LANED(fibrad_areas_integrate)(areas);
    areas->arrangement.open.count = arcs; /* for fibrad_areas_slope */
    return areas->area[rest];
}
