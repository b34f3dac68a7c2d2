/* circle_lanes.c - follows the circle in which a sphere appears along a line. Compiled once per instruction set.
 * SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "base/constants.h"
#include "base/lanes/below.h"
#include "base/sort.h"
#include "silhouette/circle_lanes.h"
#include "work/neighbours_lanes.h"

#define NOWHERE 9.0    /* a place beyond the end of a circle, as are places a little below it */
#define TINY    1e-200 /* smaller squares count as 0, since numbers near 0 lose digits */

/* The number of the lowest bit that is set. x is not 0. */
static inline uint32_t lowest_bit(uint64_t x) { return (uint32_t)__builtin_ctzll(x); }

/* ---- discs and their arcs --------------------------------------------------------------------------------------- */

/* The component of near spheres along an axis of the line's frame, relative to the sphere in hand. away: how many
 * periods away the spheres are; NULL: all are at home. */
static inline vd component_across(const fibrad_circles *c, int axis, const vd ball[4], const vd *away) {
    const double *across = c->across + 3 * axis, *shift = c->shift[axis];
    vd at = ((across[0] * ball[0] + across[1] * ball[1] + across[2] * ball[2]) + c->grid) - c->grid;
    if (away != NULL) at += shift[0] * away[0] + shift[1] * away[1] + shift[2] * away[2];
    return at - c->centre[axis];
}

/* Of two spheres at the same depth, the one with the lower id is in front. Of two images of one sphere, the one that is
 * shifted less is in front. */
static bool tie_lies_ahead(const fibrad_workspace *work, const fibrad_circles *c, uint32_t place) {
    const uint64_t rank = fibrad_scene_rank(work->scene, c->near.sphere[place]);
    const uint64_t own = fibrad_scene_rank(work->scene, work->place);
    if (rank != own) return rank > own;
    for (int axis = 0; axis < 3; axis++)
        if (c->near.away[place][axis] != 0) return c->near.away[place][axis] > 0;
    return false;
}

/* The place of a point (cosine, sine)/size of the unit circle. */
static inline vd circle_place(vd cosine, vd sine, vd size) {
    vd tangent = sine / (size + vd_abs(cosine));
    return vd_select(vd_lt(cosine, vd_set1(0)), 2 - tangent, tangent);
}

/* Cuts the arcs of discs to the stretch in hand. Ends outside it are moved to `far`, a place beyond all ends for each
 * disc. `to` stays less than `from` if the disc covers the beginning of the stretch. */
static inline void cut_to_stretch(const fibrad_circle_stretch *stretch, vd far, vm wraps, vd *from, vd *to, vm *covers,
                                  vm *touches) {
    const vd begin = vd_set1(stretch->begin), end = vd_set1(stretch->end);
    vm past_from = vd_le(*from, begin), past_to = vd_le(*to, begin);
    vm within = (past_from & vm_not(past_to)) | (wraps & (past_from | vm_not(past_to)));
    vm from_outside = past_from | vd_le(end, *from), to_outside = past_to | vd_le(end, *to);
    vm none = from_outside & to_outside;
    *covers = *covers | (*touches & none & within);
    *touches = *touches & vm_not(none);
    *from = vd_select(from_outside, far + 1, *from);
    *to = vd_select(to_outside, far, *to);
}

/* Finds the arc of the circle that each of some discs covers. Of two circles at distance x the half angle h of the
 * arc has
 *   cos h = (x^2 + r^2 - R^2)/(2 x r),   sin h = sqrt(((R + r)^2 - x^2)(x^2 - (R - r)^2))/(2 x r).
 * The factors are the same numbers on both circles, so that circles that nearly touch agree. Of two circles that
 * coincide the one farther along the line counts as the larger one. Discs that are not there, or do not cover any of
 * the stretch, get an empty arc at `far`, a place beyond all ends for each disc. */
static inline void find_arcs(const fibrad_circles *c, double sense, vd u, vd v, vd r, vm there, vd far, vd *from,
                             vd *to) {
    const vd own = vd_set1(c->r), zero = vd_set1(0), tiny = vd_set1(TINY);
    vd square = u * u + v * v, sum = r + own, larger = r - own;
    vd apart = sum * sum - square, within = square - larger * larger;
    vm covers = vd_le(within, tiny) & there, touches = vd_lt(tiny, apart) & vd_lt(tiny, within) & there;
    covers = covers & (sense > 0 ? vd_le(zero, larger) : vd_lt(zero, larger));
    vd along = square - larger * sum, root = vd_sqrt(vd_max(zero, apart * within)), size = 2 * c->r * square;
    vd u_along = u * along, v_along = v * along, u_root = u * root, v_root = v * root;
    vd begin = circle_place(u_along + v_root, v_along - u_root, size);
    vd end = circle_place(u_along - v_root, v_along + u_root, size);
    vd step = end - begin;
    vm wraps = vd_lt(step, zero), narrow = vd_le(zero, along);
    /* the ends of an arc that is nearly empty, or nearly all, may have changed places */
    covers = covers | (touches & vd_lt(along, zero) & vd_le(zero, step) & vd_lt(step, vd_set1(1)));
    touches = touches & vm_not(narrow & wraps & vd_lt(vd_set1(-1), step));
    if (c->stretch.radius < __builtin_inf()) cut_to_stretch(&c->stretch, far, wraps, &begin, &end, &covers, &touches);
    *from = vd_select(covers, vd_set1(NOWHERE - 2 + sense), vd_select(touches, begin, far));
    *to = vd_select(covers, vd_set1(NOWHERE - 3 + sense), vd_select(touches, end, far + 1));
}

/* Finds the discs of the near spheres that are listed in seen->slot. */
static void find_discs(const fibrad_workspace *work, const fibrad_circles *c, uint32_t number,
                       fibrad_circle_discs *disc) {
    _Alignas(64) static const double lane[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    const double sense = c->side[number].sense;
    const vd zero = vd_set1(0), farthest = vd_set1(c->farthest);
    const uint32_t count = disc->count;
    vd_copy_numbers(disc->slot + count, c->near.fill);
    for (uint32_t k = 0; k < count; k += VD_LANES) {
        const uint32_t *at = disc->slot + k;
        vd ball[4], images[4], *away = c->images ? images : NULL, from, to;
        vd_gather_four(c->near.ball, at, ball);
        if (c->images) vd_gather_four(c->near.away, at, images);
        vd u = component_across(c, 0, ball, away), v = component_across(c, 1, ball, away), r = ball[3];
        vd depth = sense * component_across(c, 2, ball, away);
        const uint32_t tied = vm_bits(vd_le(depth, zero) & vd_le(zero, depth));
        for (uint32_t l = 0; tied >> l != 0; l++)
            if (tied >> l & 1 && tie_lies_ahead(work, c, at[l]) != (sense > 0)) depth = vd_replace(depth, l, -1);
        vd far = NOWHERE + 2 * (vd_load(lane) + (number * FIBRAD_CIRCLE_ROOM + k));
        find_arcs(c, sense, u, v, r, vd_le(zero, depth) & vd_le(depth, farthest), far, &from, &to);
        vd_store(disc->u + k, u);
        vd_store(disc->v + k, v);
        vd_store(disc->depth + k, depth);
        vd_store_float(disc->key + k, depth);
        vd_store(disc->weight + k, FIBRAD_PAIR_UNITS / (r * r));
        vd_store(disc->from + k, from);
        vd_store(disc->to + k, to);
    }
    disc->u[count] = disc->v[count] = disc->weight[count] = 0;
    disc->depth[count] = __builtin_inf();
    disc->slot[count] = c->near.nothing + number;
}

/* ---- discs that may be seen ------------------------------------------------------------------------------------- */

/* Sectors of a stretch, as bits of a number. */
#define SECTORS    30
#define ALL_AROUND 0x3fffffffu
#define BOTH_ENDS  0x20000001u /* the first sector and the last one */

/* LENGTH_ERROR bounds the error of a length, over the sum of coordinates and radius. PLACE_ERROR bounds the error of a
 * place, in sectors. */
#define LENGTH_ERROR 4e-7f
#define PLACE_ERROR  0.1f

static inline vf float_place(vf cosine, vf sine, vf size) {
    vf tangent = sine / (size + vf_abs(cosine));
    return vf_select(vf_lt(cosine, vf_set1(0)), 2 - tangent, tangent);
}

/* A place in sectors from the beginning of the stretch. Places outside the stretch become its ends. */
static inline vf sector_place(vf at) { return vf_min(vf_set1(SECTORS), vf_max(vf_set1(0), at)); }

/* The sectors that an arc certainly covers whole, and those that it may touch. */
static inline void find_sectors(const fibrad_circle_stretch *stretch, vf from, vf to, vn *inner, vn *outer) {
    const float per = (float)stretch->sectors, begin = (float)stretch->begin;
    const vn none = vn_zero(), all = vn_set1(ALL_AROUND);
    vw wraps = vf_lt(to, from);
    /* one end of the arc may have passed the place where a turn begins */
    vw passed = vf_lt(vf_set1(2 - PLACE_ERROR / per), vf_max(vf_abs(from - 1), vf_abs(to - 1)));
    from = (from - begin) * per, to = (to - begin) * per;
    vf first = sector_place(from + (PLACE_ERROR + 0.5f)), last = sector_place(to - (PLACE_ERROR + 0.5f));
    vn covered = vn_sub(vn_power_of_two(last), vn_power_of_two(first));
    covered = vn_select(wraps, vn_sub(all, vn_sub(none, covered)), vn_select(vf_lt(first, last), covered, none));
    first = sector_place(from - (PLACE_ERROR + 0.5f)), last = sector_place(to + (PLACE_ERROR + 0.5f));
    vn open = vn_select(vf_lt(last, first), vn_sub(vn_power_of_two(first), vn_power_of_two(last)), none);
    vn touched = vn_select(wraps, vn_sub(all, open), vn_sub(vn_power_of_two(last), vn_power_of_two(first)));
    *inner = vn_select(passed, covered & vn_set1(~BOTH_ENDS), covered);
    *outer = vn_select(passed, touched | vn_set1(BOTH_ENDS), touched);
}

/* Finds, in floats, which sectors some discs certainly cover and which they may touch. If the floats are not accurate
 * enough for a disc, it covers none and may touch all. Lengths are in radii of the sphere in hand. */
static inline void look_at_discs(const fibrad_circles *c, fibrad_circle_side *side, uint32_t to, vf u, vf v, vf depth,
                                 vf r) {
    const float per = (float)c->stretch.sectors, gap = 2 * PLACE_ERROR / per;
    const vn none = vn_zero(), all = vn_set1(ALL_AROUND);
    vf error = LENGTH_ERROR * (vf_abs(u) + vf_abs(v) + vf_abs(depth) + r), small = 100 * error;
    vf square = u * u + v * v, x = vf_sqrt(square), sum = r + 1, larger = r - 1;
    vf apart = (sum - x) * (sum + x), within = (x - larger) * (x + larger), along = within - 2 * larger;
    vf root = vf_sqrt(vf_max(vf_set1(0), apart * within)), size = 2 * square;
    vf u_along = u * along, v_along = v * along, u_root = u * root, v_root = v * root;
    vf from = float_place(u_along + v_root, v_along - u_root, size);
    vf end = float_place(u_along - v_root, v_along + u_root, size), step = vf_abs(end - from);
    /* where two circles nearly touch, places err by about the root of the error of a length */
    vw vague = vf_lt(vf_set1(2 * PLACE_ERROR * PLACE_ERROR), error * vf_min(r, vf_set1(1)) * (per * per));
    vague = vague | vf_lt(x, small) | vf_lt(step, vf_set1(gap)) | vf_lt(vf_set1(4 - gap), step);
    vw covers = vf_lt(x + error, larger) & vf_lt(small, x);
    vw misses = (vf_lt(sum + error, x) | vf_lt(x + error, 0 - larger)) & vf_lt(small, x);
    vn inner, outer;
    find_sectors(&c->stretch, from, end, &inner, &outer);
    vf high = depth + error;
    inner = vn_select(covers, all, vn_select(vague, none, inner));
    inner = vn_select(vf_lt(vf_set1((float)side->known), high), none, inner); /* unknown discs may hide it */
    vn_store(side->inner + to, inner);
    vn_store(side->outer + to, vn_select(misses, none, vn_select(covers | vague, all, outer)));
    vf_storeu(side->low + to, depth - error);
    vf_storeu(side->high + to, high);
}

/* Ends the list of discs of a side. */
static void end_side(fibrad_circle_side *side, uint32_t last) {
    side->last = last;
    fibrad_zero(side->inner + last, FIBRAD_LANES_MAX * sizeof *side->inner);
    fibrad_zero(side->outer + last, FIBRAD_LANES_MAX * sizeof *side->outer);
}

/* The place where more discs may be added. It leaves whole vectors of each instruction set. */
static uint32_t side_end(const fibrad_circle_side *side) {
    return (side->last + FIBRAD_LANES_MAX - 1) / FIBRAD_LANES_MAX * FIBRAD_LANES_MAX;
}

static inline vf along_axis(const double a[3], const vf x[4]) {
    return (float)a[0] * x[0] + (float)a[1] * x[1] + (float)a[2] * x[2];
}

/* Adds near spheres to those of a side. There must be room, and a vector of places must follow. */
static void add_discs(const fibrad_circles *c, fibrad_circle_side *side, const uint32_t *place, uint32_t count) {
    const uint32_t first = side_end(side);
    for (uint32_t k = 0; k < count; k += VF_LANES) {
        vf x[4];
        vf_gather_four(c->near.seen, place + k, x);
        look_at_discs(c, side, first + k, along_axis(c->frame, x), along_axis(c->frame + 3, x),
                      (float)side->sense * along_axis(c->frame + 6, x), x[3]);
    }
    fibrad_copy(side->slot + first, place, count * sizeof *place);
    end_side(side, first + count);
}

/* Removes discs that touch no sector. */
static void leave_touching(fibrad_circle_side *side) {
    uint32_t n = 0;
    for (uint32_t k = 0; k < side->last; k += VF_LANES) {
        const uint32_t bits = vn_some_bits(side->outer + k);
        vf_compress(side->low + n, bits, vf_load(side->low + k));
        vf_compress(side->high + n, bits, vf_load(side->high + k));
        vn_compress(side->inner + n, bits, side->inner + k);
        vn_compress(side->slot + n, bits, side->slot + k);
        n += vn_compress(side->outer + n, bits, side->outer + k);
    }
    end_side(side, n);
}

#define BLOCK (VF_LANES == 16 ? 1 : VF_LANES == 8 ? 2 : 4) /* vectors that share what is the same in all lanes */

/* For each disc finds the sectors that certainly nearer discs cover together. */
static inline void find_covered(const fibrad_circle_side *side, uint32_t *covered) {
    const size_t count = side->last;
    for (size_t k = 0; k < count; k += BLOCK * VF_LANES) {
        vf at[BLOCK];
        vn all[BLOCK];
#pragma GCC unroll 4
        for (int b = 0; b < BLOCK; b++) at[b] = vf_load(side->low + k + b * VF_LANES), all[b] = vn_set1(0);
        for (size_t m = 0; m < count; m += 4) {
#pragma GCC unroll 4
            for (size_t l = 0; l < 4; l++) {
                const vn inner = vn_set1(side->inner[m + l]);
                const vf high = vf_set1(side->high[m + l]);
#pragma GCC unroll 4
                for (int b = 0; b < BLOCK; b++) all[b] = vn_or_lt(all[b], inner, high, at[b]);
            }
        }
#pragma GCC unroll 4
        for (int b = 0; b < BLOCK; b++) vn_store(covered + k + b * VF_LANES, all[b]);
    }
}

/* Finds the discs of a side, except those whose sectors nearer discs cover. */
static void find_seen(const fibrad_workspace *work, const fibrad_circles *c, uint32_t number,
                      fibrad_circle_discs *seen) {
    _Alignas(64) uint32_t covered[FIBRAD_CIRCLE_ROOM];
    const fibrad_circle_side *side = &c->side[number];
    uint32_t n = 0;
    find_covered(side, covered);
    for (uint32_t k = 0; k < side->last; k += VF_LANES) {
        const uint32_t bits = vn_beyond_bits(vn_load(side->outer + k), vn_load(covered + k));
        n += vn_compress(seen->slot + n, bits, side->slot + k);
    }
    seen->count = n;
    find_discs(work, c, number, seen);
}

/* Finds whether the known discs of a side certainly leave nothing open, or certainly leave something open. */
static void judge_side(fibrad_circle_side *side) {
    const size_t count = side->last;
    uint32_t inner = 0, outer = 0;
    for (size_t m = 0; m < count; m += 4)
#pragma GCC unroll 4
        for (size_t l = 0; l < 4; l++) inner |= side->inner[m + l], outer |= side->outer[m + l];
    side->closed = inner == ALL_AROUND;
    side->open = (outer & ALL_AROUND) != ALL_AROUND;
}

/* Whether disc k is nearer than another one. At equal depths the lower id is in front, as seen along the line. */
static bool disc_nearer(const fibrad_workspace *work, const fibrad_circles *c, const fibrad_circle_discs *disc,
                        bool ahead, uint32_t k, uint32_t other) {
    if (disc->depth[k] != disc->depth[other]) return disc->depth[k] < disc->depth[other];
    const uint32_t at = disc->slot[k], there = disc->slot[other];
    const uint64_t rank = fibrad_scene_rank(work->scene, c->near.sphere[at]);
    const uint64_t second = fibrad_scene_rank(work->scene, c->near.sphere[there]);
    if (rank != second) return (rank < second) == ahead;
    for (int axis = 0; axis < 3; axis++) {
        const double one = c->near.away[at][axis], other_one = c->near.away[there][axis];
        if (one != other_one) return (one < other_one) == ahead;
    }
    return false;
}

/* Sorts numbers from 0 on by their keys. To do so, it counts for each key, in lanes, how many keys are less. False:
 * some keys are equal, and the order is not written. Keys and ranks are written up to the next block, and keys four
 * beyond it. */
static inline bool order_keys(float *key, size_t count, uint32_t *rank, uint32_t *order) {
    size_t sum = 0;
    for (size_t b = 0; b < BLOCK; b++) vf_storeu(key + count + b * VF_LANES, vf_set1(__builtin_inff()));
    for (size_t k = 0; k < count; k += BLOCK * VF_LANES) {
        vf at[BLOCK];
        vn before[BLOCK];
#pragma GCC unroll 4
        for (int b = 0; b < BLOCK; b++) at[b] = vf_load(key + k + b * VF_LANES), before[b] = vn_set1(0);
        for (size_t j = 0; j < count; j += 4) {
#pragma GCC unroll 4
            for (size_t l = 0; l < 4; l++) {
                const vf other = vf_set1(key[j + l]);
#pragma GCC unroll 4
                for (int b = 0; b < BLOCK; b++) before[b] = vn_count_lt(before[b], other, at[b]);
            }
        }
#pragma GCC unroll 4
        for (int b = 0; b < BLOCK; b++) vn_store(rank + k + b * VF_LANES, before[b]);
    }
    for (size_t k = 0; k < count; k++) {
        const size_t own = rank[k];
        order[own] = (uint32_t)k, sum += own;
    }
    order[count] = (uint32_t)count;
    return sum == count * (count - 1) / 2; /* equal keys share the lowest of their ranks */
}

/* Sorts the discs of a side from the nearest to the farthest. */
static void order_seen(const fibrad_workspace *work, const fibrad_circles *c, fibrad_circle_discs *disc, bool ahead) {
    const uint32_t count = disc->count;
    uint32_t *order = disc->number;
    if (!order_keys(disc->key, count, disc->rank, order)) {
        for (uint32_t k = 0; k < count; k++) order[k] = k;
        for (uint64_t gap = fibrad_sort_first_gap(count); gap > 0; gap = fibrad_sort_next_gap(gap))
            for (uint64_t k = gap; k < count; k++) {
                uint32_t moving = order[k];
                uint64_t at = k;
                for (; at >= gap && disc_nearer(work, c, disc, ahead, moving, order[at - gap]); at -= gap)
                    order[at] = order[at - gap];
                order[at] = moving;
            }
        for (uint32_t k = 0; k < count; k++) disc->rank[order[k]] = k;
    }
}

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

/* Divides the stretch into pieces on which nothing changes. */
static void divide_stretch(fibrad_circles *c) {
    const bool few = c->seen[0].count <= RANKS && c->seen[1].count <= RANKS;
    list_ends(c);
    if (few && order_keys(c->ends.key, c->ends.count, c->rank, c->order))
        find_pieces(c);
    else
        find_pieces_of_many(c);
    fibrad_circle_pieces *piece = &c->pieces;
    uint32_t k = piece->count;
    do /* vectors are computed as a whole, so these must have values */
        piece->at[k] = c->stretch.end, piece->first[k] = piece->next[k] = 0;
    while (++k % VD_LANES != 0);
}

/* The greatest depth that is met on a side. Infinity: the lines of some piece meet no sphere. */
static double deepest_met(const fibrad_circles *c, int side) {
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

/* ---- the circle ------------------------------------------------------------------------------------------------- */

/* Enters a near sphere j as element k. place: relative to the sphere in hand, in radii of that sphere. r: in these
 * radii, too. */
static void take_near(const fibrad_workspace *work, fibrad_circles *c, uint32_t k, uint32_t j, const double place[3],
                      double r) {
    const fibrad_scene *scene = work->scene;
    const double home[3] = {scene->x[j], scene->y[j], scene->z[j]};
    c->near.sphere[k] = j;
    c->near.sum[0][k] = c->near.sum[1][k] = 0;
    c->near.ball[k][3] = scene->r[j] * c->scale;
    c->near.seen[k][3] = (float)r;
    for (int axis = 0; axis < 3; axis++) {
        const double at = place[axis] * work->unit + (work->centre[axis] - home[axis]), period = scene->period[axis];
        const double away = period > 0 ? fibrad_floor(at / period + .5) : 0;
        c->near.ball[k][axis] = (home[axis] - c->origin[axis]) * c->scale;
        c->near.away[k][axis] = away;
        c->near.seen[k][axis] = (float)place[axis];
        c->images = c->images || away != 0;
    }
}

/* Enters the near spheres of the shell. Elements of radius 0 fill the shell up. */
static void take_shell(const fibrad_workspace *work, fibrad_circles *c) {
    const fibrad_near *near = &work->near;
    c->homes = near->end[0];
    for (uint32_t k = 0; k < c->homes; k++) {
        const double place[3] = {near->x[k], near->y[k], near->z[k]};
        if (near->r[k] > 0)
            take_near(work, c, k, near->sphere[k], place, near->r[k]);
        else
            c->near.sum[0][k] = c->near.sum[1][k] = 0;
    }
}

/* Enters the spheres that a march has found among the near ones. Returns the first of their places. */
static uint32_t take_marched(const fibrad_workspace *work, fibrad_circles *c, const double frame[9]) {
    const fibrad_discs *disc = &work->disc;
    const uint32_t first = c->marched;
    for (uint32_t k = 0; k < disc->count; k++) {
        double place[3];
        for (int axis = 0; axis < 3; axis++)
            place[axis] = disc->u[k] * frame[axis] + disc->v[k] * frame[3 + axis] + disc->depth[k] * frame[6 + axis];
        take_near(work, c, c->marched++, fibrad_work_sphere(work, k), place, disc->r[k]);
    }
    return first;
}

/* Adds what the sphere has exchanged with some near ones since the last call. */
static void add_sums(fibrad_circles *c, uint32_t own, uint32_t from, uint32_t to, fibrad_pair_table *table) {
    for (uint32_t k = from; k < to; k++) {
        if (c->near.sum[0][k] == 0 && c->near.sum[1][k] == 0) continue;
        fibrad_pair_add(table, own, c->near.sphere[k], c->near.sum[0][k], c->near.sum[1][k]);
        c->near.sum[0][k] = c->near.sum[1][k] = 0;
    }
}

/* The part of the beam that a march must look at. Seen from behind, the second axis of the frame is reversed. */
static fibrad_tube tube_of(const fibrad_circles *c, double sense) {
    const fibrad_circle_stretch *stretch = &c->stretch;
    const double inverse = 1 / c->r;
    if (!(stretch->radius < __builtin_inf())) return (fibrad_tube){.radius = 1};
    return (fibrad_tube){stretch->u * inverse, sense * stretch->v * inverse, stretch->radius * inverse};
}

/* Lists the near spheres of the shell that overlap the beam of the sphere in hand, by a cull in floats. */
static uint32_t cull_shell(fibrad_workspace *work, const fibrad_circles *c, double sense, uint32_t *place) {
    const double *d = c->frame + 6, w[3] = {sense * d[0], sense * d[1], sense * d[2]};
    const fibrad_sight sight = *LANED(fibrad_near_sight)(&work->near, w);
    const vf wx = vf_set1((float)w[0]), wy = vf_set1((float)w[1]), wz = vf_set1((float)w[2]);
    uint32_t n = 0;
    for (uint32_t j = 0; j < sight.count; j += VF_LANES) {
        vf depth = wx * vf_load(sight.x + j) + wy * vf_load(sight.y + j) + wz * vf_load(sight.z + j);
        n += vn_compress(place + n, vf_lt_bits(vf_load(sight.e + j), depth), sight.near + j);
    }
    return n;
}

/* Keeps, of the known discs of a side, those that are seen somewhere on the stretch. */
static void prune(const fibrad_workspace *work, fibrad_circles *c, uint32_t number) {
    fibrad_circle_side *side = &c->side[number];
    fibrad_circle_discs *seen = &c->seen[number];
    bool met[FIBRAD_CIRCLE_ROOM] = {false};
    find_seen(work, c, number, seen);
    order_seen(work, c, seen, number == 1);
    c->seen[1 - number].count = c->seen[1 - number].number[0] = 0;
    divide_stretch(c);
    for (uint32_t k = 0; k < c->pieces.count; k++) met[(number == 0 ? c->pieces.first : c->pieces.next)[k]] = true;
    for (uint32_t k = 0, n = 0; k < side->last; k++) {
        const bool listed = n < seen->count && side->slot[k] == seen->slot[n];
        if (!listed || !met[n]) side->outer[k] = 0;
        n += listed;
    }
    leave_touching(side);
}

/* Adds discs that were just found, as many at a time as there is room for. False: too many discs touch the stretch. */
static bool add_found(const fibrad_workspace *work, fibrad_circles *c, uint32_t number, uint32_t *place,
                      uint32_t count) {
    fibrad_circle_side *side = &c->side[number];
    const bool many = count > 2 * FIBRAD_LANES_MAX;
    fibrad_copy(place + count, c->near.fill, sizeof c->near.fill);
    for (uint32_t k = 0, some; k < count; k += some) {
        uint32_t room = FIBRAD_CIRCLE_DISCS - side_end(side);
        if (room < count - k && room < FIBRAD_CIRCLE_DISCS / 2) {
            prune(work, c, number);
            room = FIBRAD_CIRCLE_DISCS - side_end(side);
            if (room < FIBRAD_CIRCLE_DISCS / 4) return false;
        }
        some = room < count - k ? room : count - k;
        add_discs(c, side, place + k, some);
        if (many) leave_touching(side);
    }
    return true;
}

#define SHORTEST 1e-6 /* stretch of a circle */
#define TOO_MANY (-1) /* the error: too many discs touch the stretch, which must be shorter */

/* Finds the discs of the shell on a side. Error: TOO_MANY. */
static int find_in_shell(fibrad_workspace *work, fibrad_circles *c, uint32_t number) {
    uint32_t *place = work->disc.near;
    const double sense = c->side[number].sense;
    const uint32_t count = cull_shell(work, c, sense, place);
    c->side[number].known = work->near.limit[0];
    return add_found(work, c, number, place, count) ? FIBRAD_OK : TOO_MANY;
}

/* Finds the discs of a march on a side. Error: TOO_MANY. */
static int find_by_march(fibrad_workspace *work, fibrad_circles *c, uint32_t number) {
    fibrad_circle_side *side = &c->side[number];
    const fibrad_tube tube = tube_of(c, side->sense);
    const double to = fibrad_near_further(work, side->known);
    uint32_t *place = work->disc.near;
    double w[9];
    for (int k = 0; k < 9; k++) w[k] = k < 3 ? c->frame[k] : side->sense * c->frame[k];
    work->disc.count = 0;
    LANED(fibrad_near_walk)(work, w, &tube, side->known, to);
    side->known = to;
    const uint32_t count = work->disc.count;
    if (c->marched + count > c->near.nowhere) return TOO_MANY;
    if (count > work->disc.capacity) return fibrad_work_discs_missed(work);
    const uint32_t first = take_marched(work, c, w);
    for (uint32_t k = 0; k < count; k++) place[k] = first + k;
    return add_found(work, c, number, place, count) ? FIBRAD_OK : TOO_MANY;
}

/* Finds the discs of the next shell. If there is none, finds those of a march on each side that is not done. Few
 * circles need more than one shell. Error: TOO_MANY. */
static int find_more(fibrad_workspace *work, fibrad_circles *c, uint32_t shell, const bool done[2]) {
    int status = FIBRAD_OK;
    if (shell == 0 && work->near.shells == 0 && !work->near.full) {
        LANED(fibrad_near_extend)(work);
        if (!work->near.full) take_shell(work, c);
    }
    for (uint32_t side = 0; side < 2 && status == FIBRAD_OK; side++)
        if (shell < work->near.shells)
            status = find_in_shell(work, c, side);
        else if (!done[side])
            status = find_by_march(work, c, side);
    return status;
}

/* Whether there is no disc deeper than the known ones. */
static bool at_horizon(const fibrad_workspace *work, const fibrad_circle_side *side, const double d[3]) {
    const double w[3] = {side->sense * d[0], side->sense * d[1], side->sense * d[2]};
    return side->known >= work->clear && side->known >= fibrad_near_horizon(work, w);
}

/* Finds what is met on the stretch, and on which sides deeper discs cannot change this. */
static void meet(fibrad_workspace *work, fibrad_circles *c, bool done[2]) {
    bool open = false, closed = true;
    for (int s = 0; s < 2; s++) {
        judge_side(&c->side[s]);
        done[s] = c->side[s].closed || at_horizon(work, &c->side[s], c->frame + 6);
        open = open || (!done[s] && c->side[s].open);
        closed = closed && (done[s] || c->side[s].open);
    }
    if (open && closed) return; /* it is known already on which sides to look further */
    for (uint32_t s = 0; s < 2; s++) {
        find_seen(work, c, s, &c->seen[s]);
        order_seen(work, c, &c->seen[s], s == 1);
    }
    divide_stretch(c);
    for (int s = 0; s < 2; s++) done[s] = done[s] || deepest_met(c, s) <= c->side[s].known * (1 - 1e-12) * c->r;
}

static void begin_line(fibrad_circles *c, const fibrad_line *line, uint32_t number) {
    c->frame = line->frame;
    c->half = number % 2;
    for (uint32_t s = 0; s < 2; s++) {
        c->side[s].nothing = c->apart ? FIBRAD_PAIR_OPEN + 2 * number + 1 - s : FIBRAD_NONE;
        c->near.sphere[c->near.nothing + s] = c->side[s].nothing;
    }
    fibrad_copy(c->across, line->frame, sizeof c->across);
    for (int axis = 0; axis < 3; axis++) {
        const double *a = c->across + 3 * axis;
        c->centre[axis] = a[0] * c->at[0] + a[1] * c->at[1] + a[2] * c->at[2];
        c->centre[axis] = (c->centre[axis] + c->grid) - c->grid;
        for (int k = 0; k < 3; k++) c->shift[axis][k] = (a[k] * c->period[k] + c->grid) - c->grid;
    }
    c->farthest = __builtin_inf();
    for (int axis = 0; axis < 3; axis++)
        if (c->period[axis] > 0 && line->frame[6 + axis] != 0)
            c->farthest = fibrad_min(c->farthest, FIBRAD_PERIODS * c->period[axis] / fibrad_abs(line->frame[6 + axis]));
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

/* Begins a stretch of the circle between two places. */
static void begin_stretch(fibrad_circles *c, double begin, double end) {
    c->stretch = (fibrad_circle_stretch){.begin = begin, .end = end, .radius = __builtin_inf()};
    c->stretch.sectors = SECTORS / (end - begin);
    if (end - begin < FIBRAD_CIRCLE_END - FIBRAD_CIRCLE_BEGIN) {
        double first[2], middle[2], last[2];
        point_at(begin, c->r, first);
        point_at((begin + end) / 2, c->r, middle);
        point_at(end, c->r, last);
        c->stretch.u = middle[0], c->stretch.v = middle[1];
        c->stretch.radius = fibrad_max(chord_between(first, middle), chord_between(middle, last)) + 1e-12 * c->r;
    }
    for (int s = 0; s < 2; s++) {
        c->side[s].last = 0;
        c->side[s].known = -1;
        c->side[s].sense = s == 0 ? -1 : 1;
    }
}

/* Adds the contribution of a stretch of the present sphere's circle along the present line. Error: TOO_MANY. */
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
        meet(work, c, done);
    }
    find_angles(c);
    find_areas(c);
    if (deepest_listed(c) > c->farthest) part_distant(c, table);
    add_pieces(c, table);
    if (c->marched > first_marched) add_sums(c, work->place, first_marched, c->marched, table);
    c->marched = first_marched;
    return FIBRAD_OK;
}

/* Follows the line in hand as long as the table has room. If too many discs touch a stretch, it is made shorter. */
static int follow_line(fibrad_workspace *work, fibrad_circles *c, fibrad_pair_table *table) {
    double step = c->step;
    while (c->next < c->end && fibrad_pair_room(table, FIBRAD_CIRCLE_ENDS)) {
        const double end = c->next + step < c->end - SHORTEST ? c->next + step : c->end;
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
    c->homes = 0, c->marched = work->near.capacity, c->images = false;
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
