/* pieces_lanes.c - divides a stretch of a circle into pieces, and adds their areas. Compiled once per instruction set.
 * SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "base/constants.h"
#include "base/sort.h"
#include "silhouette/order_lanes.h"
#include "silhouette/pieces_lanes.h"

/* The number of the lowest bit that is set. x is not 0. */
static inline uint32_t lowest_bit(uint64_t x) { return (uint32_t)__builtin_ctzll(x); }

/* ---- pieces ----------------------------------------------------------------------------------------------------- */

/* Each disc is a bit of a word, which has one half for each side. The bits are in the order of the depths. */
#define HALF  32u
#define RANKS 30u /* number of discs of a side that have a bit; the next bit stands for the surroundings */

/* Lists the ends of all arcs, and after them a place beyond all ends. */
static void list_ends(fibrad_circles *c) {
    fibrad_circle_ends *ends = &c->ends;
    size_t n = 0;
    for (uint32_t side = 0; side < 2; side++) {
        const fibrad_circle_discs *disc = &c->seen[side];
        const size_t count = disc->count;
        double *at = ends->at + n;
        for (size_t k = 0; k < count; k += VD_LANES) vd_storeu(at + k, vd_load(disc->from + k));
        for (size_t k = 0; k < count; k += VD_LANES) vd_storeu(at + count + k, vd_load(disc->to + k));
        n += 2 * count;
    }
    for (size_t k = 0; k < n; k += VD_LANES) vd_store_float(ends->key + k, vd_load(ends->at + k));
    ends->at[n] = __builtin_inf();
    ends->count = (uint32_t)n;
}

/* Finds the bits of the discs whose ends are listed. Returns the bits of those that cover the beginning of the stretch.
 * What lies beyond all spheres covers the whole stretch. */
static uint64_t find_bits(fibrad_circles *c) {
    uint64_t covers = 0;
    size_t n = 0;
    for (uint32_t side = 0; side < 2; side++) {
        const fibrad_circle_discs *disc = &c->seen[side];
        const uint64_t lowest = side == 0 ? 1 : 1ull << HALF;
        const size_t count = disc->count;
        uint64_t *own = c->ends.own + n, *nearer = c->ends.nearer + n;
        for (size_t k = 0; k < count; k++) {
            const uint64_t bit = lowest << disc->rank[k];
            own[k] = own[count + k] = bit;
            nearer[k] = nearer[count + k] = bit - lowest;
            covers |= bit & (0 - (uint64_t)(disc->to[k] < disc->from[k]));
        }
        covers |= lowest << count;
        n += 2 * count;
    }
    return covers;
}

/* Walks along a stretch whose ends are all at different places. An end is seen if no nearer disc covers it. */
static void find_pieces(fibrad_circles *c) {
    const fibrad_circle_ends *ends = &c->ends;
    const uint32_t *order = c->order;
    fibrad_circle_pieces *to = &c->pieces;
    uint64_t covers = find_bits(c);
    const double end = c->stretch.end;
    size_t n = 1;
    to->at[0] = c->stretch.begin, c->key[0] = covers;
    for (size_t k = *order; ends->at[k] < end; k = *++order) {
        covers ^= ends->own[k];
        to->at[n] = ends->at[k], c->key[n] = covers;
        n += (covers & ends->nearer[k]) == 0;
    }
    to->count = (uint32_t)n;
    for (size_t k = 0; k < n; k++) {
        to->first[k] = c->seen[0].number[lowest_bit(c->key[k])];
        to->next[k] = c->seen[1].number[lowest_bit(c->key[k] >> HALF)];
    }
}

/* The nearest disc of a set. The surroundings are one of the discs. */
static uint32_t nearest_in_set(const uint64_t *set) {
    uint32_t word = 0;
    while (set[word] == 0) word++;
    return 64 * word + lowest_bit(set[word]);
}

/* Sorts the ends exactly by place. */
static void sort_ends(const fibrad_circle_ends *ends, uint32_t *order) {
    for (uint32_t k = 0; k < ends->count; k++) order[k] = k;
    for (uint64_t gap = fibrad_sort_first_gap(ends->count); gap > 0; gap = fibrad_sort_next_gap(gap))
        for (uint64_t k = gap; k < ends->count; k++) {
            uint32_t moving = order[k];
            uint64_t at = k;
            for (; at >= gap && ends->at[moving] < ends->at[order[at - gap]]; at -= gap) order[at] = order[at - gap];
            order[at] = moving;
        }
    order[ends->count] = ends->count;
}

/* Does the same as find_pieces, for any number of discs, and for ends at one place. */
static void find_pieces_of_many(fibrad_circles *c) {
    const fibrad_circle_ends *ends = &c->ends;
    fibrad_circle_pieces *to = &c->pieces;
    uint64_t covers[2][FIBRAD_CIRCLE_ROOM / 64 + 1] = {{0}};
    uint32_t n = 0, before = UINT32_MAX;
    double at = c->stretch.begin;
    for (uint32_t side = 0; side < 2; side++) {
        const fibrad_circle_discs *disc = &c->seen[side];
        covers[side][disc->count / 64] |= 1ull << disc->count % 64;
        for (uint32_t k = 0; k < disc->count; k++)
            covers[side][disc->rank[k] / 64] |= (uint64_t)(disc->to[k] < disc->from[k]) << disc->rank[k] % 64;
    }
    sort_ends(ends, c->order);
    for (const uint32_t *order = c->order;; order++) {
        const uint32_t end = *order;
        const double next = fibrad_min(ends->at[end], c->stretch.end);
        const uint32_t behind = nearest_in_set(covers[0]), ahead = nearest_in_set(covers[1]),
                       met = behind << 16 | ahead;
        if (next > at && met != before) {
            to->at[n] = at, to->first[n] = c->seen[0].number[behind], to->next[n++] = c->seen[1].number[ahead];
            before = met;
        }
        if (next == c->stretch.end) break;
        at = next;
        const uint32_t side = end >= 2 * c->seen[0].count, count = c->seen[side].count;
        const uint32_t own = end - side * 2 * c->seen[0].count,
                       rank = c->seen[side].rank[own < count ? own : own - count];
        covers[side][rank / 64] ^= 1ull << rank % 64;
    }
    to->count = n;
}

void LANED(fibrad_pieces_divide)(fibrad_circles *c) {
    const bool few = c->seen[0].count <= RANKS && c->seen[1].count <= RANKS;
    list_ends(c);
    if (few && fibrad_order_keys(c->ends.key, c->ends.count, c->rank, c->order))
        find_pieces(c);
    else
        find_pieces_of_many(c);
    fibrad_circle_pieces *piece = &c->pieces;
    uint32_t k = piece->count;
    do /* vectors are computed as a whole, so these must have values */
        piece->at[k] = c->stretch.end, piece->first[k] = piece->next[k] = 0;
    while (++k % VD_LANES != 0);
}

double LANED(fibrad_pieces_deepest)(const fibrad_circles *c, int side) {
    const uint32_t *met = side == 0 ? c->pieces.first : c->pieces.next;
    double most = 0;
    for (uint32_t k = 0; k < c->pieces.count; k++) most = fibrad_max(most, c->seen[side].depth[met[k]]);
    return most;
}

/* ---- areas ------------------------------------------------------------------------------------------------------ */

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
#pragma GCC unroll 12
    for (int k = 11; k >= 0; k--) sum = sum * square + factor[k];
    vd angle = vd_select(far, vd_set1(FIBRAD_PI / 4), vd_set1(0)) + near * sum;
    return vd_select(vd_lt(x, vd_set1(0)), 0 - angle, angle);
}

/* The angles where pieces begin, with cosine and sine. */
static void find_angles(fibrad_circles *c) {
    fibrad_circle_pieces *piece = &c->pieces;
    for (uint32_t k = 0; k <= piece->count; k += VD_LANES) {
        vd at = vd_load(piece->at + k);
        vm far = vd_lt(vd_set1(1), at);
        vd tangent = vd_select(far, at - 2, at), square = tangent * tangent, inverse = 1 / (1 + square);
        vd sign = vd_select(far, vd_set1(-1), vd_set1(1));
        vd_store(piece->angle + k, 2 * arc_tangent(tangent) + vd_select(far, vd_set1(FIBRAD_PI), vd_set1(0)));
        vd_store(piece->cosine + k, sign * ((1 - square) * inverse));
        vd_store(piece->sine + k, sign * (2 * tangent * inverse));
    }
}

/* the lowest digit of this double counts whole numbers; numbers from -2^51 to 2^51 are added to it */
#define UNITS 0x1.8p52

/* Finds the areas that arcs add, in units of the pairs. About a point o, the area of an arc is
 *   r^2 (t2 - t1)/2 - r (o_x (sin t2 - sin t1) - o_y (cos t2 - cos t1))/2.
 * The origin of a pair is the centre of the smaller sphere. If both are equal, it is the centre of the one that is met
 * first. */
static void find_areas(fibrad_circles *c) {
    const fibrad_circle_discs *behind = &c->seen[0], *ahead = &c->seen[1];
    fibrad_circle_pieces *piece = &c->pieces;
    const uint32_t behinds = behind->count + 1, aheads = ahead->count + 1;
    const vd own = vd_set1(FIBRAD_PAIR_UNITS / (c->r * c->r));
    const double half = c->r / 2;
    for (uint32_t k = 0; k < piece->count; k += VD_LANES) {
        const uint32_t *first = piece->first + k, *next = piece->next + k;
        vd turn = vd_loadu(piece->angle + k + 1) - vd_load(piece->angle + k);
        vd sine = half * (vd_loadu(piece->sine + k + 1) - vd_load(piece->sine + k));
        vd cosine = half * (vd_loadu(piece->cosine + k + 1) - vd_load(piece->cosine + k));
        vd area = half * c->r * turn, units = area * own;
        vd u_a = vd_choose(behind->u, behinds, first), v_a = vd_choose(behind->v, behinds, first);
        vd u_b = vd_choose(ahead->u, aheads, next), v_b = vd_choose(ahead->v, aheads, next);
        vd per_a = vd_choose(behind->weight, behinds, first), per_b = vd_choose(ahead->weight, aheads, next);
        vd area_a = (area - (u_a * sine - v_a * cosine)) * per_a, area_b = (area - (u_b * sine - v_b * cosine)) * per_b;
        vd_store(piece->behind + k, vd_select(vd_le(own, per_a), area_a, units) + UNITS);
        vd_store(piece->ahead + k, vd_select(vd_le(per_b, own), units, area_b) + UNITS);
        vd_store(piece->past + k, vd_select(vd_le(per_b, per_a), area_a, area_b) + UNITS);
    }
}

/* The whole number that was added to UNITS. */
static inline int64_t units_of(double sum) {
    const double none = UNITS;
    int64_t bits, zero;
    fibrad_copy(&bits, &sum, sizeof bits);
    fibrad_copy(&zero, &none, sizeof zero);
    return bits - zero;
}

/* The area of a piece about an origin, in units of a pair. */
static double piece_area(const fibrad_circles *c, uint32_t k, const fibrad_circle_discs *disc, uint32_t origin) {
    const fibrad_circle_pieces *piece = &c->pieces;
    const double sine = piece->sine[k + 1] - piece->sine[k], cosine = piece->cosine[k + 1] - piece->cosine[k];
    const double half = c->r / 2, area = half * c->r * (piece->angle[k + 1] - piece->angle[k]);
    return (area - half * (disc->u[origin] * sine - disc->v[origin] * cosine)) * disc->weight[origin];
}

/* No two discs of both sides lie farther apart than this. A disc is listed if a tangent to both spheres is at most
 * `known` long. All radii are less than 2. */
static double deepest_listed(const fibrad_circles *c) { return (c->side[0].known + c->side[1].known + 2) * c->r + 4; }

/* If two spheres lie farther apart than lines are followed, they exchange nothing. A piece then takes its area from
 * what each of them exchanges with what lies beyond all spheres. */
static void part_distant(fibrad_circles *c, fibrad_pair_table *table) {
    const fibrad_circle_discs *behind = &c->seen[0], *ahead = &c->seen[1];
    fibrad_circle_pieces *piece = &c->pieces;
    for (uint32_t k = 0; k < piece->count; k++) {
        const uint32_t a = piece->first[k], b = piece->next[k];
        if (a == behind->count || b == ahead->count || behind->depth[a] + ahead->depth[b] <= c->farthest) continue;
        const int64_t of_a = units_of(piece_area(c, k, behind, a) + UNITS);
        const int64_t of_b = units_of(piece_area(c, k, ahead, b) + UNITS);
        const int64_t even = c->half == 0 ? -1 : 0, odd = -1 - even;
        fibrad_pair_add(table, c->near.sphere[behind->slot[a]], c->side[1].nothing, even * of_a, odd * of_a);
        fibrad_pair_add(table, c->near.sphere[ahead->slot[b]], c->side[0].nothing, even * of_b, odd * of_b);
        piece->past[k] = UNITS;
    }
}

/* Adds the areas of all pieces. The slots of the table are fetched ahead, since they are seldom in the nearest
 * cache. */
static void add_pieces(fibrad_circles *c, fibrad_pair_table *table) {
    const fibrad_circle_discs *behind = &c->seen[0], *ahead = &c->seen[1];
    const fibrad_circle_pieces *piece = &c->pieces;
    const size_t count = piece->count;
    int64_t *sum = c->near.sum[c->half];
    for (size_t k = 0; k < count; k++) {
        const uint32_t first = behind->slot[piece->first[k]], next = ahead->slot[piece->next[k]];
        const uint64_t key = fibrad_pair_key(c->near.sphere[first], c->near.sphere[next]);
        c->key[k] = key;
        c->rank[k] = fibrad_pair_place(table, key);
        __builtin_prefetch(&table->slot[c->rank[k]], 1);
        sum[first] += units_of(piece->behind[k]);
        sum[next] += units_of(piece->ahead[k]);
    }
    for (size_t k = 0; k < count; k++) /* what lies beyond all spheres exchanges nothing with itself */
        if (!fibrad_pair_opens((uint32_t)(c->key[k] >> 32)))
            fibrad_pair_slot(table, c->key[k], c->rank[k])->sum[c->half] -= units_of(piece->past[k]);
}

void LANED(fibrad_pieces_add)(fibrad_circles *c, fibrad_pair_table *table) {
    find_angles(c);
    find_areas(c);
    if (deepest_listed(c) > c->farthest) part_distant(c, table);
    add_pieces(c, table);
}
