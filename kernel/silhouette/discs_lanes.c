/* discs_lanes.c - the discs that may be seen from a circle, and the arcs that they cover. Compiled once per instruction
 * set. SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "base/sort.h"
#include "silhouette/discs_lanes.h"
#include "silhouette/order_lanes.h"

#define NOWHERE 9.0    /* a place beyond the end of a circle, as are places a little below it */
#define TINY    1e-200 /* smaller squares count as 0, since numbers near 0 lose digits */

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
static inline vf sector_place(vf at) { return vf_min(vf_set1(FIBRAD_CIRCLE_SECTORS), vf_max(vf_set1(0), at)); }

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
    vf low = depth - error, high = depth + error;
    inner = vn_select(covers, all, vn_select(vague, none, inner));
    /* unknown discs may hide it, or it may lie on the other side */
    inner = vn_select(vf_lt(vf_set1((float)side->known), high) | vf_lt(low, vf_set1(0)), none, inner);
    vn_store(side->inner + to, inner);
    vn_store(side->outer + to, vn_select(misses, none, vn_select(covers | vague, all, outer)));
    vf_storeu(side->low + to, low);
    vf_storeu(side->high + to, high);
}

/* Ends the list of discs of a side. */
static void end_side(fibrad_circle_side *side, uint32_t last) {
    side->last = last;
    fibrad_zero(side->inner + last, FIBRAD_LANES_MAX * sizeof *side->inner);
    fibrad_zero(side->outer + last, FIBRAD_LANES_MAX * sizeof *side->outer);
}

static inline vf along_axis(const double a[3], const vf x[4]) {
    return (float)a[0] * x[0] + (float)a[1] * x[1] + (float)a[2] * x[2];
}

void LANED(fibrad_discs_add)(const fibrad_circles *c, fibrad_circle_side *side, const uint32_t *place, uint32_t count) {
    const uint32_t first = fibrad_discs_end(side);
    for (uint32_t k = 0; k < count; k += VF_LANES) {
        vf x[4];
        vf_gather_four(c->near.seen, place + k, x);
        look_at_discs(c, side, first + k, along_axis(c->frame, x), along_axis(c->frame + 3, x),
                      (float)side->sense * along_axis(c->frame + 6, x), x[3]);
    }
    fibrad_copy(side->slot + first, place, count * sizeof *place);
    end_side(side, first + count);
}

void LANED(fibrad_discs_leave_touching)(fibrad_circle_side *side) {
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
/* For each disc finds the sectors that certainly nearer discs cover together. */
static inline void find_covered(const fibrad_circle_side *side, uint32_t *covered) {
    const size_t count = side->last;
    for (size_t k = 0; k < count; k += FIBRAD_ORDER_BLOCK * VF_LANES) {
        vf at[FIBRAD_ORDER_BLOCK];
        vn all[FIBRAD_ORDER_BLOCK];
#pragma GCC unroll 4
        for (int b = 0; b < FIBRAD_ORDER_BLOCK; b++) at[b] = vf_load(side->low + k + b * VF_LANES), all[b] = vn_set1(0);
        for (size_t m = 0; m < count; m += 4) {
#pragma GCC unroll 4
            for (size_t l = 0; l < 4; l++) {
                const vn inner = vn_set1(side->inner[m + l]);
                const vf high = vf_set1(side->high[m + l]);
#pragma GCC unroll 4
                for (int b = 0; b < FIBRAD_ORDER_BLOCK; b++) all[b] = vn_or_lt(all[b], inner, high, at[b]);
            }
        }
#pragma GCC unroll 4
        for (int b = 0; b < FIBRAD_ORDER_BLOCK; b++) vn_store(covered + k + b * VF_LANES, all[b]);
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

void LANED(fibrad_discs_judge)(fibrad_circle_side *side) {
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

/* Sorts the discs of a side from the nearest to the farthest. */
static void order_seen(const fibrad_workspace *work, const fibrad_circles *c, fibrad_circle_discs *disc, bool ahead) {
    const uint32_t count = disc->count;
    uint32_t *order = disc->number;
    if (!fibrad_order_keys(disc->key, count, disc->rank, order)) {
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

void LANED(fibrad_discs_see)(const fibrad_workspace *work, fibrad_circles *c, uint32_t number) {
    find_seen(work, c, number, &c->seen[number]);
    order_seen(work, c, &c->seen[number], number == 1);
}
