/* circle_lanes.c - follows the circle in which a sphere appears along a line. Compiled once per instruction set.
 * SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "base/constants.h"
#include "base/lanes/below.h"
#include "base/sort.h"
#include "silhouette/circle_lanes.h"
#include "work/neighbours_lanes.h"

#define NOWHERE 9.0 /* an arc from and to here covers nothing */

/* ---- discs ------------------------------------------------------------------------------------------------------ */

/* Rounds to the grid of projected centres. */
static inline vd on_grid(const fibrad_circles *c, vd x) { return (x + c->grid) - c->grid; }

/* The component of near spheres along an axis of the line's frame, relative to the sphere in hand. */
static inline vd component_across(const fibrad_circles *c, int axis, vd x, vd y, vd z, const uint32_t *place) {
    const double *across = c->across + 3 * axis, *shift = c->shift[axis];
    vd at = on_grid(c, across[0] * x + across[1] * y + across[2] * z);
    if (c->periodic)
        at += shift[0] * vd_gather(c->near.away[0], place) + shift[1] * vd_gather(c->near.away[1], place) +
              shift[2] * vd_gather(c->near.away[2], place);
    return at - c->centre[axis];
}

/* Of spheres at the same depth, the lower id is in front; of images of one sphere, the one less shifted. */
static bool tie_lies_ahead(const fibrad_workspace *work, const fibrad_circles *c, uint32_t place) {
    const uint64_t rank = fibrad_scene_rank(work->scene, c->near.sphere[place]);
    const uint64_t own = fibrad_scene_rank(work->scene, work->place);
    if (rank != own) return rank > own;
    for (int axis = 0; axis < 3; axis++)
        if (c->near.away[axis][place] != 0) return c->near.away[axis][place] > 0;
    return false;
}

/* Which of the lanes, all at depth 0, lie on a side. */
static uint32_t ties_on_side(const fibrad_workspace *work, const fibrad_circles *c, const uint32_t *place,
                             uint32_t bits, double sense) {
    uint32_t kept = 0;
    for (uint32_t l = 0; l < VD_LANES; l++)
        if (bits >> l & 1 && tie_lies_ahead(work, c, place[l]) == (sense > 0)) kept |= 1u << l;
    return kept;
}

/* Whether discs may touch a stretch of the circle. */
static inline vm near_stretch(const fibrad_circle_stretch *stretch, vd u, vd v, vd r) {
    vd reach = r + stretch->radius;
    u -= stretch->u, v -= stretch->v;
    return vd_lt(u * u + v * v, reach * reach);
}

/* Appends the near spheres at `place` whose discs touch the circle from one side. Of two circles that coincide the one
 * farther along the line counts as the larger one. There must be room for `count` discs and a vector. */
static void find_discs(const fibrad_workspace *work, fibrad_circles *c, fibrad_circle_side *side, uint32_t *place,
                       uint32_t count) {
    fibrad_circle_discs *to = &side->found;
    const vd own = vd_set1(c->r), zero = vd_set1(0);
    const bool part = c->stretch.radius < __builtin_inf();
    uint32_t n = to->count;
    uint32_t after[VD_LANES]; /* read, too, in the last vector */
    fibrad_copy(after, place + count, sizeof after);
    for (uint32_t k = 0; k < VD_LANES; k++) place[count + k] = 0;
    for (uint32_t k = 0; k < count; k += VD_LANES) {
        const uint32_t *at = place + k;
        vd x = vd_gather(c->near.home[0], at), y = vd_gather(c->near.home[1], at), z = vd_gather(c->near.home[2], at);
        vd u = component_across(c, 0, x, y, z, at), v = component_across(c, 1, x, y, z, at);
        vd depth = side->sense * component_across(c, 2, x, y, z, at), r = vd_gather(c->near.radius, at);
        vd square = u * u + v * v, sum = r + own, larger = r - own, least = vd_max(zero, 0 - larger);
        vm touches = vd_lt(square, sum * sum) & vd_lt(least * least, square);
        if (part) touches = touches & near_stretch(&c->stretch, u, v, r);
        if (side->sense > 0)
            touches = touches | (vd_le(square, zero) & vd_le(zero, larger));
        else
            touches = touches | (vd_le(square, zero) & vd_lt(zero, larger));
        const uint32_t tied = vm_bits(touches & vd_le(depth, zero) & vd_le(zero, depth)) & vd_lanes_below(count - k);
        uint32_t bits = vm_bits(touches & vd_lt(zero, depth)) & vd_lanes_below(count - k);
        if (tied != 0) bits |= ties_on_side(work, c, at, tied, side->sense);
        if (bits == 0) continue;
        vd_compress(to->u + n, bits, u);
        vd_compress(to->v + n, bits, v);
        vd_compress(to->depth + n, bits, depth);
        vd_compress(to->r + n, bits, r);
        n += vd_compress_places(to->slot + n, bits, k);
    }
    for (uint32_t k = to->count; k < n; k++) {
        const uint32_t at = place[to->slot[k]];
        to->slot[k] = at, to->sphere[k] = c->near.sphere[at];
    }
    to->count = n;
    fibrad_copy(place + count, after, sizeof after);
}

/* Lists the near spheres of a shell that overlap the beam of the sphere in hand, by a cull in floats. */
static uint32_t cull_shell(fibrad_workspace *work, const double w[3], uint32_t shell, uint32_t *place) {
    fibrad_sight sight = work->near.all;
    size_t begin = shell > 0 ? work->near.end[shell - 1] : 0, end = work->near.end[shell];
    if (shell == 0) sight = *LANED(fibrad_near_sight)(&work->near, w), end = sight.count;
    uint32_t *to = place;
    vf wx = vf_set1((float)w[0]), wy = vf_set1((float)w[1]), wz = vf_set1((float)w[2]);
    for (size_t j = begin; j < end; j += VF_LANES) {
        vf depth = wx * vf_load(sight.x + j) + wy * vf_load(sight.y + j) + wz * vf_load(sight.z + j);
        to += vn_compress(to, vf_lt_bits(vf_load(sight.e + j), depth), sight.near + j);
    }
    return (uint32_t)(to - place);
}

/* ---- order by depth --------------------------------------------------------------------------------------------- */

/* Whether found disc k is nearer than another one. At equal depths the lower id is in front, as seen along the line. */
static bool disc_nearer(const fibrad_workspace *work, const fibrad_circles *c, const fibrad_circle_side *side,
                        uint32_t k, uint32_t other) {
    const fibrad_circle_discs *disc = &side->found;
    if (disc->depth[k] != disc->depth[other]) return disc->depth[k] < disc->depth[other];
    const uint64_t rank = fibrad_scene_rank(work->scene, disc->sphere[k]);
    const uint64_t second = fibrad_scene_rank(work->scene, disc->sphere[other]);
    if (rank != second) return (rank < second) == (side->sense > 0);
    for (int axis = 0; axis < 3; axis++) {
        const double away = c->near.away[axis][disc->slot[k]], there = c->near.away[axis][disc->slot[other]];
        if (away != there) return (away < there) == (side->sense > 0);
    }
    return false;
}

/* Sorts discs [from, to) of an order that is nearly right. */
static void order_discs_by_insertion(const fibrad_workspace *work, const fibrad_circles *c,
                                     const fibrad_circle_side *side, uint32_t *order, uint32_t count) {
    for (uint64_t gap = fibrad_sort_first_gap(count); gap > 0; gap = fibrad_sort_next_gap(gap))
        for (uint64_t k = gap; k < count; k++) {
            uint32_t moving = order[k];
            uint64_t at = k;
            for (; at >= gap && disc_nearer(work, c, side, moving, order[at - gap]); at -= gap)
                order[at] = order[at - gap];
            order[at] = moving;
        }
}

/* Counts, in lanes, how many numbers lie before each. Numbers that are equal share a rank, and the ranks then add up
 * to less than they should: false. */
static bool rank_depths(const fibrad_circle_discs *disc, uint32_t *rank) {
    _Alignas(64) float key[FIBRAD_CIRCLE_ROOM];
    const uint32_t count = disc->count, eights = (count + 7) / 8 * 8;
    for (uint32_t k = 0; k < count; k += VD_LANES) vd_store_float(key + k, vd_load(disc->depth + k));
    for (uint32_t k = 0; k < 8; k++) key[count + k] = __builtin_inff();
    for (uint32_t k = 0; k < eights; k += VF_LANES) {
        vf at = vf_load(key + k);
        vn before = vn_zero();
        for (uint32_t j = 0; j < eights; j += 8)
#pragma GCC unroll 8
            for (uint32_t l = 0; l < 8; l++) before = vn_count_lt(before, vf_set1(key[j + l]), at);
        vn_store(rank + k, before);
    }
    uint32_t sum = 0;
    for (uint32_t k = 0; k < count; k++) sum += rank[k];
    return sum == count * (count - 1) / 2;
}

/* Lists the discs of a side nearest first. */
static void order_discs(const fibrad_workspace *work, fibrad_circles *c, fibrad_circle_side *side) {
    const fibrad_circle_discs *from = &side->found;
    fibrad_circle_discs *to = &side->sorted;
    const uint32_t count = from->count;
    uint32_t order[FIBRAD_CIRCLE_ROOM];
    if (!rank_depths(from, c->rank)) {
        for (uint32_t k = 0; k < count; k++) order[k] = k;
        order_discs_by_insertion(work, c, side, order, count);
        for (uint32_t k = 0; k < count; k++) c->rank[order[k]] = k;
    }
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t rank = c->rank[k];
        to->u[rank] = from->u[k], to->v[rank] = from->v[k], to->depth[rank] = from->depth[k];
        to->r[rank] = from->r[k], to->slot[rank] = from->slot[k], to->sphere[rank] = from->sphere[k];
    }
    to->count = count;
}

/* ---- arcs ------------------------------------------------------------------------------------------------------- */

/* The place of a point of the unit circle, on its grid. */
static inline vd circle_place(vd cosine, vd sine) {
    vd tangent = sine / (1 + vd_abs(cosine));
    vd at = vd_select(vd_lt(cosine, vd_set1(0)), 2 - tangent, tangent);
    at = (at + 5) - 5;
    return vd_select(vd_le(vd_set1(FIBRAD_CIRCLE_END), at), at - 4, at);
}

/* The arcs that the discs cover. Of two circles at distance x the half angle h of the arc has
 *   cos h = (x^2 + r^2 - R^2)/(2 x r),   sin h = sqrt((R - x + r)(R + x - r)(x + r - R)(x + R + r))/(2 x r).
 * The factors are differences of the same numbers on both circles, so that circles that nearly touch agree. */
static void find_arcs(const fibrad_circles *c, int side, fibrad_circle_discs *disc) {
    const vd own = vd_set1(c->r), zero = vd_set1(0);
    for (uint32_t k = 0; k < disc->count; k += VD_LANES) {
        vd u = vd_load(disc->u + k), v = vd_load(disc->v + k), r = vd_load(disc->r + k);
        vd square = u * u + v * v, x = vd_sqrt(square), sum = r + own, larger = r - own;
        vm all = vd_le(x, larger);
        vd root = vd_sqrt(vd_max(zero, ((sum - x) * (x + larger)) * ((x - larger) * (x + sum))));
        vd inverse = 0.5 / (square * own);
        vd along = (square - larger * sum) * inverse;
        root *= inverse;
        vd from = circle_place(u * along + v * root, v * along - u * root);
        vd to = circle_place(u * along - v * root, v * along + u * root);
        vd length = to - from;
        length = vd_select(vd_lt(length, zero), length + 4, length);
        /* the ends of an arc that is nearly empty, or nearly all, may have changed places */
        vm wide = vd_lt(along, zero);
        length = vd_select(wide & vd_lt(length, vd_set1(1)), vd_set1(4), length);
        length = vd_select(vm_not(wide) & vd_lt(vd_set1(3), length), zero, length);
        from = vd_select(all, vd_set1(FIBRAD_CIRCLE_BEGIN), from);
        to = vd_select(all, vd_set1(FIBRAD_CIRCLE_END), from + length);
        vd_store(disc->from + k, from);
        vd_store(disc->to + k, to);
        vd_store(disc->again + k, to - 4);
        vd_store(disc->weight + k, FIBRAD_PAIR_UNITS / (r * r));
    }
    const uint32_t end = disc->count;
    disc->u[end] = disc->v[end] = disc->weight[end] = 0;
    disc->r[end] = disc->depth[end] = __builtin_inf();
    disc->from[end] = disc->to[end] = NOWHERE, disc->again[end] = -NOWHERE;
    disc->slot[end] = c->near.nothing + (uint32_t)side, disc->sphere[end] = c->side[side].nothing;
}

/* ---- ends ------------------------------------------------------------------------------------------------------- */

/* Where the nearest disc that covers a place takes the place of one farther away. */
static inline vd nearer_of(const fibrad_circle_discs *disc, uint32_t m, vd at, vd met) {
    vm covers =
        (vd_le(vd_set1(disc->from[m]), at) & vd_lt(at, vd_set1(disc->to[m]))) | vd_lt(at, vd_set1(disc->again[m]));
    return vd_select(covers, vd_set1(m), met);
}

/* The nearest discs that cover the places of two vectors. */
static inline void find_nearest(const fibrad_circle_discs *disc, const vd at[2], vd met[2]) {
    vd first = vd_set1(disc->count), second = first;
    for (uint32_t m = disc->count; m-- > 0;) {
        first = nearer_of(disc, m, at[0], first);
        second = nearer_of(disc, m, at[1], second);
    }
    met[0] = first, met[1] = second;
}

/* Appends the ends of arcs of a side that no nearer disc of this side hides. */
static void list_ends(const fibrad_circle_discs *disc, int side, double begin, double end, fibrad_circle_ends *ends) {
    _Alignas(64) static const double number[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    uint32_t n = ends->count;
    for (uint32_t k = 0; k < disc->count; k += VD_LANES) {
        vd own = vd_load(number) + k, from = vd_load(disc->from + k), to = vd_load(disc->to + k);
        to = vd_select(vd_le(vd_set1(FIBRAD_CIRCLE_END), to), to - 4, to);
        const vd at[2] = {from, to};
        vd met[2];
        find_nearest(disc, at, met);
        for (int which = 0; which < 2; which++) {
            vm seen = vd_le(own, met[which]) & vd_lt(vd_set1(begin), at[which]) & vd_lt(at[which], vd_set1(end));
            const uint32_t bits = vm_bits(seen) & vd_lanes_below(disc->count - k);
            vd_compress(ends->at + n, bits, at[which]);
            vd_compress(ends->met[side] + n, bits, met[which]);
            n += fibrad_count_bits(bits);
        }
    }
    ends->count = n;
}

/* Finds what ends [from, to) meet on a side. */
static void meet(const fibrad_circle_discs *disc, int side, fibrad_circle_ends *ends, uint32_t from, uint32_t to) {
    for (uint32_t k = from; k < to; k += 2 * VD_LANES) {
        const vd at[2] = {vd_loadu(ends->at + k), vd_loadu(ends->at + k + VD_LANES)};
        vd met[2];
        find_nearest(disc, at, met);
        vd_storeu(ends->met[side] + k, met[0]);
        vd_storeu(ends->met[side] + k + VD_LANES, met[1]);
    }
}

/* Finds the ends on [begin, end) of the circle, the first at `begin`, and what is met from each of them on. Lanes
 * beyond the count are written, too, so that the order of these steps matters. */
static void find_ends(fibrad_circles *c, double begin, double end) {
    fibrad_circle_ends *ends = &c->ends;
    const fibrad_circle_discs *behind = &c->side[0].sorted, *ahead = &c->side[1].sorted;
    ends->at[0] = begin;
    meet(behind, 0, ends, 0, 1);
    ends->count = 1;
    list_ends(behind, 0, begin, end, ends);
    const uint32_t count = ends->count;
    meet(ahead, 1, ends, 0, count);
    list_ends(ahead, 1, begin, end, ends);
    meet(behind, 0, ends, count, ends->count);
}

/* The greatest depth that is met on a side; infinity: something beyond all spheres is. */
static double deepest_met(const fibrad_circles *c, int side) {
    vd deepest = vd_set1(0);
    double most = 0;
    _Alignas(64) double lane[VD_LANES];
    for (uint32_t k = 0; k < c->ends.count; k += VD_LANES) {
        _Alignas(64) static const double number[8] = {0, 1, 2, 3, 4, 5, 6, 7};
        vm there = vd_lt(vd_load(number) + k, vd_set1(c->ends.count));
        deepest = vd_max(deepest, vd_select(there, vd_load(c->ends.met[side] + k), vd_set1(0)));
    }
    vd_store(lane, deepest);
    for (int l = 0; l < VD_LANES; l++) most = fibrad_max(most, lane[l]);
    return c->side[side].sorted.depth[(uint32_t)most];
}

/* ---- pieces ----------------------------------------------------------------------------------------------------- */

/* Sorts the ends by place. Ends at one place meet the same, so that their order does not matter. */
static void sort_ends_by_insertion(fibrad_circles *c) {
    const fibrad_circle_ends *from = &c->ends;
    uint32_t order[FIBRAD_CIRCLE_ENDS];
    for (uint32_t k = 0; k < from->count; k++) order[k] = k;
    for (uint64_t gap = fibrad_sort_first_gap(from->count); gap > 0; gap = fibrad_sort_next_gap(gap))
        for (uint64_t k = gap; k < from->count; k++) {
            uint32_t moving = order[k];
            uint64_t at = k;
            for (; at >= gap && from->at[moving] < from->at[order[at - gap]]; at -= gap) order[at] = order[at - gap];
            order[at] = moving;
        }
    for (uint32_t k = 0; k < from->count; k++) c->rank[order[k]] = k;
}

#define ENDS_RANKED 64
static void sort_ends(fibrad_circles *c, double end) {
    fibrad_circle_ends *from = &c->ends, *to = &c->sorted;
    const uint32_t count = from->count;
    uint32_t sum = 0;
    if (count <= ENDS_RANKED) {
        for (uint32_t k = 0; k < count; k += VD_LANES) {
            vd at = vd_load(from->at + k), rank = vd_set1(0);
            for (uint32_t j = 0; j < count; j++)
                rank += vd_select(vd_lt(vd_set1(from->at[j]), at), vd_set1(1), vd_set1(0));
            vd_store_numbers(c->rank + k, rank);
        }
        for (uint32_t k = 0; k < count; k++) sum += c->rank[k];
    }
    if (sum != count * (count - 1) / 2 || count > ENDS_RANKED) sort_ends_by_insertion(c);
    for (uint32_t k = 0; k < count; k++) {
        const uint32_t rank = c->rank[k];
        to->at[rank] = from->at[k], to->met[0][rank] = from->met[0][k], to->met[1][rank] = from->met[1][k];
    }
    for (uint32_t k = count; k < count + FIBRAD_LANES_MAX; k++) /* computed, too, in whole vectors */
        to->at[k] = end, to->met[0][k] = to->met[1][k] = 0;
    to->count = count;
}

/* Chebyshev's approximation of atan(x)/x in powers of x^2 for |x| <= tan(pi/8): to 3e-18. */
static inline vd arc_tangent(vd x) {
    static const double factor[] = {0x1p+0,
                                    -0x1.5555555555554p-2,
                                    0x1.9999999999566p-3,
                                    -0x1.2492492470754p-3,
                                    0x1.c71c71b563986p-4,
                                    -0x1.745d1480b7932p-4,
                                    0x1.3b1369d8f07f5p-4,
                                    -0x1.110c3a7ccdb74p-4,
                                    0x1.e16e24513a73ep-5,
                                    -0x1.ab66f999273fbp-5,
                                    0x1.70995e9961734p-5,
                                    -0x1.118357ca27436p-5,
                                    0x1.ef3f736798094p-7};
    vd size = vd_abs(x);
    vm far = vd_lt(vd_set1(0x1.a827999fcef32p-2), size);
    vd near = vd_select(far, (size - 1) / (size + 1), size), square = near * near, sum = vd_set1(factor[12]);
    for (int k = 11; k >= 0; k--) sum = sum * square + factor[k];
    vd angle = vd_select(far, vd_set1(FIBRAD_PI / 4), vd_set1(0)) + near * sum;
    return vd_select(vd_lt(x, vd_set1(0)), 0 - angle, angle);
}

/* The angles of the ends, with cosine and sine. */
static void find_angles(fibrad_circles *c) {
    for (uint32_t k = 0; k <= c->sorted.count; k += VD_LANES) {
        vd at = vd_load(c->sorted.at + k);
        vm far = vd_lt(vd_set1(1), at);
        vd tangent = vd_select(far, at - 2, at), square = tangent * tangent, inverse = 1 / (1 + square);
        vd sign = vd_select(far, vd_set1(-1), vd_set1(1));
        vd_store(c->angle + k, 2 * arc_tangent(tangent) + vd_select(far, vd_set1(FIBRAD_PI), vd_set1(0)));
        vd_store(c->cosine + k, sign * ((1 - square) * inverse));
        vd_store(c->sine + k, sign * (2 * tangent * inverse));
    }
}

/* Number of `whole` as a whole number, for |whole| < 2^51. */
static inline int64_t units_of(double whole) {
    const double magic = 0x1.8p52;
    int64_t bits, zero;
    whole += magic;
    fibrad_copy(&bits, &whole, sizeof bits);
    fibrad_copy(&zero, &magic, sizeof zero);
    return bits - zero;
}

/* A property of discs, and of what lies beyond all spheres. */
static inline vd look_up(const double *table, uint32_t count, vd number) { return vd_lookup(table, count + 1, number); }

/* The areas that arcs add, in units of the pairs. About a point o, that of an arc is
 *   r^2 (t2 - t1)/2 - r (o_x (sin t2 - sin t1) - o_y (cos t2 - cos t1))/2.
 * The origin of a pair is the centre of the smaller sphere; of equal ones, of the one that is met first. */
static void find_areas(fibrad_circles *c) {
    const fibrad_circle_discs *behind = &c->side[0].sorted, *ahead = &c->side[1].sorted;
    const vd own = vd_set1(c->r), weight = vd_set1(FIBRAD_PAIR_UNITS / (c->r * c->r));
    const double half = c->r / 2;
    for (uint32_t k = 0; k < c->sorted.count; k += VD_LANES) {
        vd first = vd_load(c->sorted.met[0] + k), next = vd_load(c->sorted.met[1] + k);
        vd turn = vd_loadu(c->angle + k + 1) - vd_load(c->angle + k);
        vd sine = vd_loadu(c->sine + k + 1) - vd_load(c->sine + k);
        vd cosine = vd_loadu(c->cosine + k + 1) - vd_load(c->cosine + k);
        vd area = half * c->r * turn;
        vd r_a = look_up(behind->r, behind->count, first), r_b = look_up(ahead->r, ahead->count, next);
        vd area_a = area - half * (look_up(behind->u, behind->count, first) * sine -
                                   look_up(behind->v, behind->count, first) * cosine);
        vd area_b = area - half * (look_up(ahead->u, ahead->count, next) * sine -
                                   look_up(ahead->v, ahead->count, next) * cosine);
        vd units = area * weight;
        area_a *= look_up(behind->weight, behind->count, first);
        area_b *= look_up(ahead->weight, ahead->count, next);
        vd_store(c->behind + k, vd_select(vd_le(r_a, own), area_a, units));
        vd_store(c->ahead + k, vd_select(vd_le(own, r_b), units, area_b));
        vd_store(c->past + k, vd_select(vd_le(r_a, r_b), area_a, area_b));
        vd_store_numbers(c->index[0] + k, first);
        vd_store_numbers(c->index[1] + k, next);
    }
}

/* Adds the areas of all pieces. The table is asked for its slots ahead, since they are seldom in the nearest cache. */
static void add_pieces(fibrad_circles *c, fibrad_pair_table *table) {
    const fibrad_circle_discs *behind = &c->side[0].sorted, *ahead = &c->side[1].sorted;
    const uint32_t count = c->sorted.count;
    int64_t *sum = c->near.sum[c->half];
    for (uint32_t k = 0; k < count; k++) {
        const uint64_t key = fibrad_pair_key(behind->sphere[c->index[0][k]], ahead->sphere[c->index[1][k]]);
        c->key[k] = key;
        c->rank[k] = fibrad_pair_place(table, key);
        __builtin_prefetch(&table->slot[c->rank[k]], 1);
    }
    for (uint32_t k = 0; k < count; k++) {
        sum[behind->slot[c->index[0][k]]] += units_of(c->behind[k]);
        sum[ahead->slot[c->index[1][k]]] += units_of(c->ahead[k]);
    }
    for (uint32_t k = 0; k < count; k++) /* what lies beyond all spheres exchanges nothing with itself */
        if (!fibrad_pair_opens((uint32_t)(c->key[k] >> 32)))
            fibrad_pair_slot(table, c->key[k], c->rank[k])->sum[c->half] -= units_of(c->past[k]);
}

/* ---- the circle ------------------------------------------------------------------------------------------------- */

/* Takes the spheres of a new shell over. */
static void take_shell(const fibrad_workspace *work, fibrad_circles *c) {
    const fibrad_scene *scene = work->scene;
    const double *coordinate[3] = {scene->x, scene->y, scene->z};
    const uint32_t end = work->near.end[work->near.shells - 1];
    for (uint32_t k = c->homes; k < end; k++) {
        const uint32_t j = c->near.sphere[k] = work->near.sphere[k];
        const double place[3] = {work->near.x[k], work->near.y[k], work->near.z[k]};
        c->near.radius[k] = scene->r[j] * c->scale;
        c->near.sum[0][k] = c->near.sum[1][k] = 0;
        for (int axis = 0; axis < 3; axis++) {
            const double at = coordinate[axis][j];
            c->near.home[axis][k] = (at - c->origin[axis]) * c->scale;
            c->near.away[axis][k] = 0;
            if (scene->period[axis] > 0)
                c->near.away[axis][k] =
                    fibrad_floor((place[axis] * work->unit + (work->centre[axis] - at)) / scene->period[axis] + .5);
        }
    }
    c->homes = end;
}

/* Takes the spheres that a march has found over, as near ones. The first of their places. */
static uint32_t take_marched(const fibrad_workspace *work, fibrad_circles *c, const double frame[9]) {
    const fibrad_scene *scene = work->scene;
    const fibrad_discs *disc = &work->disc;
    const double *coordinate[3] = {scene->x, scene->y, scene->z};
    const uint32_t first = c->marched;
    for (uint32_t k = 0; k < disc->count; k++) {
        const uint32_t at = c->marched++, j = c->near.sphere[at] = fibrad_work_sphere(work, k);
        c->near.radius[at] = scene->r[j] * c->scale;
        c->near.sum[0][at] = c->near.sum[1][at] = 0;
        for (int axis = 0; axis < 3; axis++) {
            const double home = coordinate[axis][j];
            const double place =
                disc->u[k] * frame[axis] + disc->v[k] * frame[3 + axis] + disc->depth[k] * frame[6 + axis];
            c->near.home[axis][at] = (home - c->origin[axis]) * c->scale;
            c->near.away[axis][at] = 0;
            if (scene->period[axis] > 0)
                c->near.away[axis][at] =
                    fibrad_floor((place * work->unit + (work->centre[axis] - home)) / scene->period[axis] + .5);
        }
    }
    return first;
}

/* Adds what the sphere exchanges with a near one, over all lines or since the last time. */
static void add_sums(fibrad_circles *c, uint32_t own, uint32_t from, uint32_t to, fibrad_pair_table *table) {
    for (uint32_t k = from; k < to; k++) {
        if (c->near.sum[0][k] == 0 && c->near.sum[1][k] == 0) continue;
        for (uint32_t half = 0; half < 2; half++)
            fibrad_pair_add(table, own, c->near.sphere[k], half, c->near.sum[half][k]);
        c->near.sum[0][k] = c->near.sum[1][k] = 0;
    }
}

/* What a march must look at. Seen from behind, the second axis of the frame is turned round. */
static fibrad_tube tube_of(const fibrad_circles *c, double sense) {
    const fibrad_circle_stretch *stretch = &c->stretch;
    const double inverse = 1 / c->r;
    if (!(stretch->radius < __builtin_inf())) return (fibrad_tube){.radius = 1};
    return (fibrad_tube){stretch->u * inverse, sense * stretch->v * inverse, stretch->radius * inverse};
}

/* Leaves of the discs found on a side those that are seen somewhere on the stretch. */
static void prune(const fibrad_workspace *work, fibrad_circles *c, int side) {
    const fibrad_circle_discs *from = &c->side[side].sorted;
    fibrad_circle_discs *to = &c->side[side].found;
    bool seen[FIBRAD_CIRCLE_ROOM] = {false};
    uint32_t n = 0;
    order_discs(work, c, &c->side[side]);
    find_arcs(c, side, &c->side[side].sorted);
    c->ends.at[0] = c->stretch.begin;
    meet(from, side, &c->ends, 0, 1);
    c->ends.count = 1;
    list_ends(from, side, c->stretch.begin, c->stretch.end, &c->ends);
    for (uint32_t k = 0; k < c->ends.count; k++) seen[(uint32_t)c->ends.met[side][k]] = true;
    for (uint32_t k = 0; k < from->count; k++) {
        if (!seen[k]) continue;
        to->u[n] = from->u[k], to->v[n] = from->v[k], to->depth[n] = from->depth[k], to->r[n] = from->r[k];
        to->slot[n] = from->slot[k], to->sphere[n++] = from->sphere[k];
    }
    to->count = n;
}

/* Finds discs among near spheres, as many at a time as there is room for. False: too many touch the stretch. */
static bool find_among(const fibrad_workspace *work, fibrad_circles *c, int side, uint32_t *place, uint32_t count) {
    const fibrad_circle_discs *found = &c->side[side].found;
    for (uint32_t k = 0, some; k < count; k += some) {
        uint32_t room = FIBRAD_CIRCLE_DISCS - VD_LANES - found->count;
        if (room < count - k && room < FIBRAD_CIRCLE_DISCS / 2) {
            prune(work, c, side);
            room = FIBRAD_CIRCLE_DISCS - VD_LANES - found->count;
            if (room < FIBRAD_CIRCLE_DISCS / 4) return false;
        }
        some = room < count - k ? room : count - k;
        find_discs(work, c, &c->side[side], place + k, some);
    }
    return true;
}

#define SHORTEST 1e-6 /* stretch of a circle */
#define TOO_MANY (-1) /* discs touch the stretch of the circle, which must be shorter */

/* Finds the discs of one more shell, or of a march on sides that are not done. TOO_MANY */
static int find_more(fibrad_workspace *work, fibrad_circles *c, uint32_t shell, const bool done[2]) {
    uint32_t *place = work->disc.near;
    double w[9];
    if (shell == work->near.shells && fibrad_near_pays(&work->near)) {
        LANED(fibrad_near_extend)(work);
        if (!work->near.full) take_shell(work, c);
    }
    for (int s = 0; s < 2; s++) {
        fibrad_circle_side *side = &c->side[s];
        const double sense = side->sense;
        for (int k = 0; k < 9; k++) w[k] = k < 3 ? c->frame[k] : sense * c->frame[k];
        uint32_t count;
        if (shell < work->near.shells) {
            count = cull_shell(work, w + 6, shell, place);
            side->known = work->near.limit[shell];
        } else {
            if (done[s]) continue;
            const double to = fibrad_near_further(work, side->known);
            work->disc.count = 0;
            const fibrad_tube tube = tube_of(c, sense);
            LANED(fibrad_near_march)(work, w, &tube, side->known, to);
            side->known = to;
            count = work->disc.count;
            if (c->marched + count > c->near.nothing) return TOO_MANY;
            if (count > work->disc.capacity) return fibrad_work_discs_missed(work);
            const uint32_t first = take_marched(work, c, w);
            for (uint32_t k = 0; k < count; k++) place[k] = first + k;
        }
        if (side->known >= work->clear && side->horizon == __builtin_inf())
            side->horizon = fibrad_near_horizon(work, w + 6);
        if (!find_among(work, c, s, place, count)) return TOO_MANY;
    }
    return FIBRAD_OK;
}

static void begin_line(fibrad_circles *c, const fibrad_line *line, uint32_t number) {
    c->frame = line->frame;
    c->half = number % 2;
    for (uint32_t s = 0; s < 2; s++) {
        c->side[s].nothing = c->apart ? FIBRAD_PAIR_OPEN + 2 * number + 1 - s : FIBRAD_NONE;
        c->near.sphere[c->near.nothing + s] = c->side[s].nothing;
    }
    for (int axis = 0; axis < 3; axis++) {
        const double *a = line->frame + 3 * axis;
        for (int k = 0; k < 3; k++) {
            c->across[3 * axis + k] = a[k];
            c->shift[axis][k] = (a[k] * c->period[k] + c->grid) - c->grid;
        }
        c->centre[axis] = ((a[0] * c->at[0] + a[1] * c->at[1] + a[2] * c->at[2]) + c->grid) - c->grid;
    }
}

/* A point of the circle. */
static void point_at(double place, double r, double point[2]) {
    const bool far = place > 1;
    const double tangent = far ? place - 2 : place, scale = (far ? -r : r) / (1 + tangent * tangent);
    point[0] = scale * (1 - tangent * tangent), point[1] = scale * 2 * tangent;
}

static double chord_between(const double a[2], const double b[2]) {
    return fibrad_sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]));
}

/* Begins a stretch of the circle, at most to a place. */
static void begin_stretch(fibrad_circles *c, double begin, double end) {
    c->stretch = (fibrad_circle_stretch){.begin = begin, .end = end, .radius = __builtin_inf()};
    if (end - begin < FIBRAD_CIRCLE_END - FIBRAD_CIRCLE_BEGIN) {
        double first[2], middle[2], last[2];
        point_at(begin, c->r, first);
        point_at((begin + end) / 2, c->r, middle);
        point_at(end, c->r, last);
        c->stretch.u = middle[0], c->stretch.v = middle[1];
        c->stretch.radius = fibrad_max(chord_between(first, middle), chord_between(middle, last)) + 1e-12 * c->r;
    }
    for (int s = 0; s < 2; s++) {
        c->side[s].found.count = 0;
        c->side[s].known = -1, c->side[s].horizon = __builtin_inf();
        c->side[s].sense = s == 0 ? -1 : 1;
    }
}

/* Adds what a stretch of the circle of the sphere in hand says along the line in hand. TOO_MANY */
static int follow(fibrad_workspace *work, fibrad_circles *c, double begin, double end, fibrad_pair_table *table) {
    bool done[2] = {false, false};
    const uint32_t first_marched = c->marched;
    begin_stretch(c, begin, end);
    for (uint32_t shell = 0; !(done[0] && done[1]); shell++) {
        const int status = find_more(work, c, shell, done);
        if (status != FIBRAD_OK) {
            c->marched = first_marched;
            return status;
        }
        for (int s = 0; s < 2; s++) {
            order_discs(work, c, &c->side[s]);
            find_arcs(c, s, &c->side[s].sorted);
        }
        find_ends(c, begin, end);
        for (int s = 0; s < 2; s++) {
            const fibrad_circle_side *side = &c->side[s];
            done[s] = side->known >= side->horizon || deepest_met(c, s) <= side->known * (1 - 1e-12) * c->r;
        }
    }
    sort_ends(c, end);
    find_angles(c);
    find_areas(c);
    add_pieces(c, table);
    if (c->marched > first_marched) add_sums(c, work->place, first_marched, c->marched, table);
    c->marched = first_marched;
    return FIBRAD_OK;
}

/* Follows the line in hand as far as the table has room. Stretches become shorter where too many discs touch them. */
static int follow_line(fibrad_workspace *work, fibrad_circles *c, fibrad_pair_table *table) {
    double step = c->step;
    while (c->next < c->end && fibrad_pair_room(table, FIBRAD_CIRCLE_ENDS)) {
        const double end = fibrad_min(c->end, ((c->next + step) + 5) - 5); /* on the grid of places */
        const int status = follow(work, c, c->next, end, table);
        if (status == TOO_MANY) {
            step = (end - c->next) / 2;
            if (step < SHORTEST) return FIBRAD_E_UNSUPPORTED;
            continue;
        }
        if (status != FIBRAD_OK) return status;
        c->next = end;
        step = fibrad_min(c->step, 2 * step);
    }
    return FIBRAD_OK;
}

int LANED(fibrad_circle_lines)(fibrad_workspace *work, fibrad_circles *c, uint32_t place, const fibrad_line *line,
                               uint32_t *from, uint32_t to, fibrad_pair_table *table) {
    const fibrad_scene *scene = c->scene;
    const double at[3] = {scene->x[place], scene->y[place], scene->z[place]};
    fibrad_work_begin(work, scene, place, 0, FIBRAD_CIRCLE_STRIDE);
    for (int axis = 0; axis < 3; axis++) c->at[axis] = (at[axis] - c->origin[axis]) * c->scale;
    c->r = scene->r[place] * c->scale;
    c->homes = 0, c->marched = work->near.capacity;
    for (uint32_t k = c->near.nothing; k < c->near.nothing + 2; k++) c->near.sum[0][k] = c->near.sum[1][k] = 0;
    for (; *from < to && fibrad_pair_room(table, FIBRAD_CIRCLE_ENDS); ++*from, c->next = c->begin) {
        begin_line(c, &line[*from], *from);
        const int status = follow_line(work, c, table);
        if (status != FIBRAD_OK) return status;
        if (c->apart) add_sums(c, work->place, c->near.nothing, c->near.nothing + 2, table);
        if (c->next < c->end) break;
    }
    add_sums(c, work->place, 0, c->homes, table);
    add_sums(c, work->place, c->near.nothing, c->near.nothing + 2, table);
    return FIBRAD_OK;
}
