/* arrangement_lanes.c - exact visible areas of discs in a window by accounts of circles. Compiled once per instruction
 * set. SPDX-License-Identifier: MIT
 *
 * The open region - what no disc covers so far - is known by its boundary: arcs of the window's circle and of the
 * circles of discs. A new disc k, seen against circle m (in lanes over all m), covers of that circle nothing, all, or
 * the arc between the two points where the circles meet; and disc m covers of circle k the rest of a like kind, between
 * the same two points. From this follow
 *   - what is seen of circle k: all of it less what the older discs and the outside of the window hide;
 *   - what disc k takes of each arc that bounds the open region.
 * The former join the boundary of the open region, the latter leave it. An arc on its way out has been seen of its own
 * disc up to here and bounds the visible part of disc k from now on, so it is integrated then, once for both.
 *
 * Each circle keeps its own account, and two circles share nothing but the two points where they meet. A wrong decision
 * about an arc as short as rounding costs an area as small as rounding, and nothing further: there is no chain of arcs
 * that could break, and multiple points, tangent and identical circles need no special care.
 *
 * The place of a direction (x, y) of unit length on its circle is told by y on the right quarter, and by -x, -y, x on
 * the top, left and bottom quarters with what makes it continuous: it rises counter-clockwise by about the angle, and
 * jumps back at the lower right diagonal, from END to BEGIN. Arcs are cut there and opposite, at MIDDLE, so that none
 * is longer than half a circle and none passes the jump. */
#include FIBRAD_LANES_HEADER
#include "base/lanes/below.h"
#include "window/arc_lanes.h"
#include "window/arrangement_lanes.h"

#define DIAGONAL 0.70710678118654752
#define BEGIN    (-DIAGONAL)
#define MIDDLE   (3 * DIAGONAL)
#define END      (7 * DIAGONAL)
#define AROUND   (8 * DIAGONAL)

/* As `from` of an interval, and minus it as `to`: the whole circle, or nothing of it. */
#define ALL     -16.0
#define NOTHING 16.0

/* Arcs this short are given up: they stem from rounding, and would keep windows open for nothing. */
#define SHORT 1e-15

static _Alignas(FIBRAD_ALIGNMENT) const double lane_number[8] = {0, 1, 2, 3, 4, 5, 6, 7};

static inline vd place(vd x, vd y) {
    vd zero = vd_set1(0);
    vd sides = vd_select(vd_lt(x, zero), 4 * DIAGONAL - y, y);
    vd ends = vd_select(vd_lt(y, zero), 6 * DIAGONAL + x, 2 * DIAGONAL - x);
    return vd_select(vd_lt(vd_abs(x), vd_abs(y)), ends, sides);
}

/* The length of an interval shows if rounding has turned it round: less than half a circle (and not a little more than
 * none) where the cosine of its half-width is positive, more than half where it is negative. Writes ALL or NOTHING
 * then.
 */
static inline void set_right(vd cosine, vd *from, vd *to) {
    vd zero = vd_set1(0), length = *to - *from;
    length = vd_select(vd_lt(length, zero), length + AROUND, length);
    vm narrow = vd_lt(zero, cosine), nothing = narrow & vd_lt(vd_set1(0.75 * AROUND), length);
    vm all = vm_not(narrow) & vd_lt(length, vd_set1(0.25 * AROUND));
    *from = vd_select(nothing, vd_set1(NOTHING), vd_select(all, vd_set1(ALL), *from));
    *to = vd_select(nothing, vd_set1(-NOTHING), vd_select(all, vd_set1(-ALL), *to));
}

/* What circle k, about (x, y) with radius r, does to all circles so far and they to it. Two circles at distance d meet
 * at c_m + f d -+ h d', d' being d turned left; f = (d^2 + r_m^2 - r^2)/(2 d^2), and h from the product of sum and
 * difference, without cancellation where they are nearly tangent. Returns false if an older disc contains disc k. */
static bool meet(fibrad_areas *areas, double x, double y, double r, double inverse) {
    vd r_k = vd_set1(r), inverse_k = vd_set1(inverse), half = vd_set1(0.5), zero = vd_set1(0);
    fibrad_intervals *hidden = &areas->arrangement.hidden;
    hidden->count = 0;
    hidden->all = false;
    for (uint32_t m = 0; m < areas->circles; m += VD_LANES) {
        vd c_x = vd_load(areas->x + m), c_y = vd_load(areas->y + m), r_m = vd_load(areas->r + m);
        vd dx = x - c_x, dy = y - c_y;
        vd sum = r_m + r_k, difference = r_m - r_k;
        vd square = dx * dx + dy * dy;
        vd outer = sum * sum - square, inner = square - difference * difference;
        vm apart = vd_le(outer, zero), nested = vd_le(inner, zero), whole = apart | nested;
        uint32_t lanes = vd_lanes_below(areas->circles - m);
        uint32_t containing = vm_bits(nested & vd_le(zero, difference)) & lanes;
        if (containing & (m == 0 ? ~1u : ~0u)) return false; /* to lie within the window hides nothing */

        vd scale = half / square, power = sum * difference; /* r_m^2 - r^2 */
        vd f = (square + power) * scale, g = (square - power) * scale;
        vd h = vd_sqrt(vd_max(outer, zero) * vd_max(inner, zero)) * scale;
        vd hx = h * dx, hy = h * dy, fx = f * dx, fy = f * dy;
        vd gx = g * dx, gy = g * dy, inverse_m = vd_load(areas->arrangement.inverse + m);
        vd sx = fx + hy, sy = fy - hx, ex = fx - hy, ey = fy + hx;
        vd_store(areas->arrangement.sx + m, c_x + sx);
        vd_store(areas->arrangement.sy + m, c_y + sy);
        vd_store(areas->arrangement.ex + m, c_x + ex);
        vd_store(areas->arrangement.ey + m, c_y + ey);

        vd from = place(sx * inverse_m, sy * inverse_m);
        vd to = place(ex * inverse_m, ey * inverse_m);
        set_right(f, &from, &to);
        vm m_inside = nested & vd_le(difference, zero);
        from = vd_select(m_inside, vd_set1(ALL), vd_select(whole, vd_set1(NOTHING), from));
        to = vd_select(m_inside, vd_set1(-ALL), vd_select(whole, vd_set1(-NOTHING), to));
        vd_store(areas->arrangement.from + m, from);
        vd_store(areas->arrangement.to + m, to);

        vd own_from = place((zero - (gx + hy)) * inverse_k, (hx - gy) * inverse_k);
        vd own_to = place((hy - gx) * inverse_k, (zero - (gy + hx)) * inverse_k);
        set_right(g, &own_from, &own_to);
        if (m == 0) { /* the window hides what lies without */
            vm first = vd_lt(vd_load(lane_number), half);
            vd swap = own_from;
            own_from = vd_select(first, own_to, own_from);
            own_to = vd_select(first, swap, own_to);
        }
        uint32_t crossing = lanes & ~vm_bits(whole), all = vm_bits(vd_lt(own_from, vd_set1(BEGIN - 1))) & crossing;
        if (all != 0) hidden->all = true;
        vm empty = (vd_le(own_from, own_to) & vd_le(own_to, own_from)) | vd_lt(vd_set1(END + 1), own_from);
        uint32_t some = crossing & ~vm_bits(empty), count = hidden->count;
        vd_compress(hidden->from + count, some, own_from);
        vd_compress(hidden->to + count, some, own_to);
        vd_compress(hidden->circle + count, some, vd_load(lane_number) + m);
        hidden->count = count + fibrad_count_bits(some);
    }
    return true;
}

/* Appends an arc, in two pieces if it passes MIDDLE, the point (mx, my). */
static void add(fibrad_arcs *arcs, double a, double b, double px, double py, double qx, double qy, double circle,
                double mx, double my) {
    if (b - a <= SHORT) return;
    bool cut = a < MIDDLE && MIDDLE < b;
    uint32_t k = arcs->count, n = k + 1;
    arcs->a[k] = a, arcs->px[k] = px, arcs->py[k] = py, arcs->circle[k] = circle;
    arcs->b[k] = cut ? MIDDLE : b, arcs->qx[k] = cut ? mx : qx, arcs->qy[k] = cut ? my : qy;
    arcs->a[n] = MIDDLE, arcs->px[n] = mx, arcs->py[n] = my, arcs->circle[n] = circle;
    arcs->b[n] = b, arcs->qx[n] = qx, arcs->qy[n] = qy;
    arcs->count = n + cut;
}

/* Adds what is seen of the new circle to the boundary of the open region: each visible arc begins where one hidden
 * interval ends and no other goes on, and ends where the next one begins. These are exact statements about the numbers
 * at hand; rounding cannot make them contradict each other. Returns false if nothing is seen. */
static bool see(fibrad_areas *areas, double x, double y, double r) {
    const fibrad_intervals *h = &areas->arrangement.hidden;
    fibrad_arcs *open = &areas->arrangement.open;
    uint32_t intervals = h->count, before = open->count;
    if (h->all) return false;
    double k = areas->circles, d = r * DIAGONAL, jx = x + d, jy = y - d, mx = x - d, my = y + d;
    if (intervals == 0) add(open, BEGIN, END, jx, jy, jx, jy, k, mx, my);
    for (uint32_t i = 0; i < intervals; i += VD_LANES) {
        vd to = vd_load(h->to + i);
        uint32_t hidden = 0;
        for (uint32_t j = 0; j < intervals; j++) {
            /* does interval j hold the ends of others? Its own end for later ones only, so that the first of equal ends
             * remains */
            vd f = vd_set1(h->from[j]), t = vd_set1(h->to[j]);
            uint32_t not_later = j < i ? 0 : vd_lanes_below(j - i + 1);
            uint32_t after = vm_bits(vd_le(f, to)),
                     before_end = vm_bits(vd_lt(to, t)) | (vm_bits(vd_le(to, t)) & ~not_later);
            uint32_t passes_jump = 0u - (h->to[j] < h->from[j]);
            hidden |= (after & before_end) | ((after | before_end) & passes_jump);
        }
        for (uint32_t bits = vd_lanes_below(intervals - i) & ~hidden; bits != 0; bits &= bits - 1) {
            uint32_t begin = i + (uint32_t)__builtin_ctz(bits), end = 0;
            double a = h->to[begin], nearest = 2 * AROUND;
            for (uint32_t j = 0; j < intervals; j++) {
                double ahead = h->from[j] - a;
                ahead = ahead < 0 ? ahead + AROUND : ahead;
                end = ahead < nearest ? j : end;
                nearest = fibrad_min(ahead, nearest);
            }
            /* what disc m hides runs from the end of what is covered of its circle to the beginning; window: reverse */
            uint32_t m = (uint32_t)h->circle[begin], n = (uint32_t)h->circle[end];
            double b = h->from[end], px = m == 0 ? areas->arrangement.ex[m] : areas->arrangement.sx[m],
                   py = m == 0 ? areas->arrangement.ey[m] : areas->arrangement.sy[m];
            double qx = n == 0 ? areas->arrangement.sx[n] : areas->arrangement.ex[n],
                   qy = n == 0 ? areas->arrangement.sy[n] : areas->arrangement.ey[n];
            if (open->count + 4 > areas->arrangement.arcs) {
                areas->overflow = true;
                return false;
            }
            add(open, a, b < a ? END : b, px, py, b < a ? jx : qx, b < a ? jy : qy, k, mx, my);
            if (b < a) add(open, BEGIN, b, jx, jy, qx, qy, k, mx, my);
        }
    }
    return open->count > before;
}

/* Arcs in lanes. */
typedef struct arcs_in_lanes {
    vd a, b, px, py, qx, qy, circle;
} arcs_in_lanes;

static inline arcs_in_lanes load(const fibrad_arcs *arcs, uint32_t k) {
    return (arcs_in_lanes){vd_load(arcs->a + k),     vd_load(arcs->b + k),  vd_load(arcs->px + k),
                           vd_load(arcs->py + k),    vd_load(arcs->qx + k), vd_load(arcs->qy + k),
                           vd_load(arcs->circle + k)};
}

/* Appends the lanes named by bits. */
static inline void append(fibrad_arcs *arcs, uint32_t bits, const arcs_in_lanes *s) {
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

static inline arcs_in_lanes select(vm m, const arcs_in_lanes *s, const arcs_in_lanes *t) {
    return (arcs_in_lanes){vd_select(m, s->a, t->a),
                           vd_select(m, s->b, t->b),
                           vd_select(m, s->px, t->px),
                           vd_select(m, s->py, t->py),
                           vd_select(m, s->qx, t->qx),
                           vd_select(m, s->qy, t->qy),
                           s->circle};
}

static inline uint32_t rising(const arcs_in_lanes *s) { return vm_bits(vd_lt(s->a, s->b)); }

/* Gives the lanes named by bits to circle k. */
static void give(fibrad_areas *areas, uint32_t bits, const arcs_in_lanes *s, uint32_t k) {
    uint32_t size = areas->circles + 1; /* the new one, or the rest */
    vd x = vd_lookup(areas->x, size, s->circle), y = vd_lookup(areas->y, size, s->circle);
    fibrad_arc_lanes piece = {s->px - x, s->py - y, s->qx - x, s->qy - y, x, y, vd_lookup(areas->r, size, s->circle),
                              s->circle};
    LANED(fibrad_arcs_give)(areas, bits, &piece, k);
}

/* Gives a whole list to circle k. */
static void give_all(fibrad_areas *areas, fibrad_arcs *list, uint32_t k) {
    for (uint32_t o = 0; o < list->count; o += VD_LANES) {
        arcs_in_lanes s = load(list, o);
        give(areas, vd_lanes_below(list->count - o), &s, k);
    }
    list->count = 0;
}

/* Takes from the boundary what lies in disc k. In order, an arc has a part below the bounds of the interval covered of
 * its circle, one between and one above; any may be missing. Covered is the one between, or, if the interval passes the
 * jump, are the two others. First parts and second ones are listed in turn, in the order of the arcs, whatever the
 * number of lanes. Returns whether there was anything to take. */
static bool take(fibrad_areas *areas, uint32_t k) {
    const fibrad_arcs open = areas->arrangement.open;
    fibrad_arcs *left = &areas->arrangement.left, *second = areas->arrangement.second;
    uint32_t size = areas->circles, any = 0;
    if (2 * open.count > areas->arrangement.arcs) {
        areas->overflow = true;
        return true;
    }
    vd tiny = vd_set1(SHORT);
    left->count = second[0].count = second[1].count = 0;
    for (uint32_t o = 0; o < open.count; o += VD_LANES) {
        arcs_in_lanes s = load(&open, o);
        vd from = vd_lookup(areas->arrangement.from, size, s.circle),
           to = vd_lookup(areas->arrangement.to, size, s.circle);
        vd sx = vd_lookup(areas->arrangement.sx, size, s.circle), sy = vd_lookup(areas->arrangement.sy, size, s.circle);
        vd ex = vd_lookup(areas->arrangement.ex, size, s.circle), ey = vd_lookup(areas->arrangement.ey, size, s.circle);
        vm round = vd_lt(to, from);
        vd low = vd_min(from, to), high = vd_max(from, to);
        vd lx = vd_select(round, ex, sx), ly = vd_select(round, ey, sy);
        vd hx = vd_select(round, sx, ex), hy = vd_select(round, sy, ey);
        /* a bound that does not cut goes to the end of the arc; if nothing is between them, all of the arc is below */
        vm low_below = vd_le(low - s.a, tiny), high_above = vd_le(s.b - high, tiny);
        vm none = vd_le(high - s.a, tiny) | vd_le(high - low, tiny);
        none |= vd_le(s.b - low, tiny);
        high_above |= none;
        low = vd_select(none, s.b, vd_select(low_below, s.a, low));
        lx = vd_select(none, s.qx, vd_select(low_below, s.px, lx));
        ly = vd_select(none, s.qy, vd_select(low_below, s.py, ly));
        high = vd_select(high_above, s.b, high);
        hx = vd_select(high_above, s.qx, hx);
        hy = vd_select(high_above, s.qy, hy);

        arcs_in_lanes below = {s.a, low, s.px, s.py, lx, ly, s.circle};
        arcs_in_lanes between = {low, high, lx, ly, hx, hy, s.circle};
        arcs_in_lanes above = {high, s.b, hx, hy, s.qx, s.qy, s.circle};
        arcs_in_lanes stays = select(round, &between, &below), goes = select(round, &below, &between);
        uint32_t lanes = vd_lanes_below(open.count - o), rounds = vm_bits(round), seconds = rising(&above) & lanes;
        uint32_t going = rising(&goes) & lanes;
        append(left, rising(&stays) & lanes, &stays);
        any |= going | (seconds & rounds);
        if (going != 0) give(areas, going, &goes, k);
        if (seconds == 0) continue;
        append(&second[0], seconds & ~rounds, &above);
        append(&second[1], seconds & rounds, &above);
        if (second[0].count > areas->arrangement.seconds || second[1].count > areas->arrangement.seconds) {
            areas->overflow = true;
            return true;
        }
    }
    if (any == 0) return false;
    give_all(areas, &second[1], k);
    for (uint32_t o = 0; o < second[0].count; o += VD_LANES) {
        arcs_in_lanes s = load(&second[0], o);
        append(left, vd_lanes_below(second[0].count - o), &s);
    }
    areas->arrangement.open = *left;
    *left = open;
    return true;
}

void LANED(fibrad_arrangement_begin)(fibrad_areas *areas) {
    areas->circles = 0;
    areas->arrangement.open.count = areas->pieces->count = 0;
    fibrad_areas_add_circle(areas, 0, 0, 0, 1);
    areas->arrangement.inverse[0] = 1;
    areas->circles = 1;
    double d = DIAGONAL;
    add(&areas->arrangement.open, BEGIN, END, d, -d, d, -d, 0, -d, d);
}

bool LANED(fibrad_arrangement_disc)(fibrad_areas *areas, uint32_t whose, double x, double y, double r) {
    double sum = 1 + r, inverse = 1 / r;
    if (areas->arrangement.open.count == 0) return false;
    if (sum * sum - (x * x + y * y) <= 0 || !meet(areas, x, y, r, inverse)) return true;

    uint32_t k = areas->circles;
    fibrad_areas_add_circle(areas, whose, x, y, r);
    areas->arrangement.inverse[k] = inverse;
    bool any;
    if (areas->arrangement.from[0] == ALL) { /* the window lies within the disc */
        give_all(areas, &areas->arrangement.open, k);
        any = true;
    } else {
        any = take(areas, k);
        if (!areas->overflow && see(areas, x, y, r)) any = true;
    }
    if (any) areas->circles++;
    if (areas->overflow) areas->arrangement.open.count = 0;
    return areas->arrangement.open.count > 0;
}

double LANED(fibrad_arrangement_end)(fibrad_areas *areas) {
    uint32_t rest = areas->circles;
    fibrad_areas_add_circle(areas, 0, 0, 0, 1);
    give_all(areas, &areas->arrangement.open, rest);
    LANED(fibrad_areas_integrate)(areas);
    return areas->area[rest];
}
