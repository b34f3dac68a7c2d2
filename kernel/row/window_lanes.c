/* window_lanes.c - what one window of a beam sees. Compiled once per instruction set. SPDX-License-Identifier: MIT
 *
 * Per direction, the window is the shadow disc of sphere i; the spheres ahead throw discs on it, nearest first. They
 * are looked up shell by shell: after a shell everything is known down to some depth, the discs up to there are settled
 * in the order of their depth, and most windows are covered before a second shell is asked for. */
#include FIBRAD_LANES_HEADER
#include "base/sort.h"
#include "row/neighbours_lanes.h"
#include "row/window_lanes.h"
#include "window/clip_lanes.h"

/* Appends the discs of one shell that come before the window. That the places are listed before they are used spares
 * one mispredicted branch for most vectors. */
static void sieve(fibrad_workspace *work, const double frame[9], uint32_t shell) {
    const fibrad_near *near = &work->near;
    const float *x = near->fx, *y = near->fy, *z = near->fz, *e = near->fe;
    uint32_t *from = work->disc.near + work->disc.count, *to = from;
    vf wx = vf_set1((float)frame[6]), wy = vf_set1((float)frame[7]), wz = vf_set1((float)frame[8]);
    size_t end = near->end[shell];
    for (size_t j = shell == 0 ? 0 : near->end[shell - 1]; j < end; j += VF_LANES) {
        vf depth = vf_add(vf_add(vf_mul(wx, vf_load(x + j)), vf_mul(wy, vf_load(y + j))), vf_mul(wz, vf_load(z + j)));
        uint32_t bits = vf_lt_bits(vf_load(e + j), depth);
        to += vf_compress_places(to, bits, (uint32_t)j);
    }
    LANED(fibrad_near_discs)(work, frame, (uint32_t)(to - from));
}

/* Front to back. At equal depths discs of spheres that do not interpenetrate do not overlap; a fixed order all the
 * same, since they may touch. Settled ones stay in front. */
static bool before(const fibrad_workspace *work, uint32_t k, uint32_t other) {
    const fibrad_discs *disc = &work->disc;
    if (disc->depth[k] != disc->depth[other]) return disc->depth[k] < disc->depth[other];
    uint32_t sphere = fibrad_work_sphere(work, k), second = fibrad_work_sphere(work, other);
    if (sphere != second) return work->scene->order[sphere] < work->scene->order[second];
    return disc->u[k] != disc->u[other] ? disc->u[k] < disc->u[other] : disc->v[k] < disc->v[other];
}

static void sort_by_insertion(fibrad_workspace *work) {
    uint32_t *order = work->disc.order, count = work->disc.count;
    for (uint32_t k = 0; k < count; k++) order[k] = k;
    for (uint64_t gap = fibrad_sort_first_gap(count); gap > 0; gap = fibrad_sort_next_gap(gap))
        for (uint64_t k = gap; k < count; k++) {
            uint32_t moving = order[k];
            uint64_t to = k;
            for (; to >= gap && before(work, moving, order[to - gap]); to -= gap) order[to] = order[to - gap];
            order[to] = moving;
        }
}

/* Lists all but the settled discs in order. Up to RANKED discs are sorted by counting, in lanes, how many lie before
 * each, which no branch depends on; insertion mispredicted 38 branches a window. Depths that floats do not tell apart
 * share a rank, and the ranks add up to less than they should. What makes the list whole eights, so that the number of
 * rounds can be predicted, is deeper than all. */
#define RANKED 64
static void sort(fibrad_workspace *work, uint32_t settled) {
    _Alignas(64) float key[RANKED + FIBRAD_LANES_MAX];
    _Alignas(64) uint32_t rank[RANKED + FIBRAD_LANES_MAX];
    const double *depth = work->disc.depth;
    uint32_t count = work->disc.count, eights = (count + 7) / 8 * 8, *order = work->disc.order;
    if (settled == count) return;
    if (count <= RANKED) {
        for (uint32_t k = 0; k < count; k += VD_LANES) vd_store_float(key + k, vd_load(depth + k));
        for (uint32_t k = 0; k < 8; k++) key[count + k] = __builtin_inff();
        for (uint32_t k = 0; k < eights; k += VF_LANES) {
            vf at = vf_load(key + k);
            vn before_it = vn_zero();
            for (uint32_t j = 0; j < eights; j += 8)
#pragma GCC unroll 8
                for (uint32_t l = 0; l < 8; l++) before_it = vn_count_lt(before_it, vf_set1(key[j + l]), at);
            vn_store(rank + k, before_it);
        }
        uint32_t sum = 0;
        for (uint32_t k = 0; k < eights; k += 8)
#pragma GCC unroll 8
            for (uint32_t l = 0; l < 8; l++) {
                order[rank[k + l]] = k + l;
                sum += rank[k + l];
            }
        if (sum == (count * (count - 1) - settled * (settled - 1)) / 2 + (eights - count) * count) return;
    }
    sort_by_insertion(work);
}

/* Settles discs [from, return) of the window, the ones down to `depth`. False in *open once the window is covered. */
static uint32_t settle(fibrad_workspace *work, fibrad_points *points, uint32_t window, uint32_t from, double depth,
                       bool *open) {
    const fibrad_discs disc = work->disc;
    uint32_t to = from;
    if (points->count == 0) {
        while (to < disc.count && disc.depth[disc.order[to]] <= depth) to++;
        to = from + LANED(fibrad_areas_discs)(&work->areas, 0, disc.order + from, to - from, disc.u, disc.v, disc.r);
        *open = work->areas.open;
    } else {
        to = LANED(fibrad_points_take)(points, &work->disc, from, depth);
        *open = points->open > 0;
        uint32_t *end = disc.taker; /* beyond `to` there are no hits */
        for (uint32_t d = from; d < to; d += VF_LANES) end += vf_compress_places(end, vn_some_bits(disc.hits + d), d);
        for (const uint32_t *taker = disc.taker; taker < end; taker++) {
            uint32_t k = disc.order[*taker];
            fibrad_work_see(work, k, window, (int32_t)disc.hits[*taker]);
            points->taker[points->takers++] = k;
        }
    }
    if (*open)
        for (uint32_t d = from; d < to; d++) disc.depth[disc.order[d]] = -1;
    return to;
}

/* One window: adds what it sees to the entries and returns what stays open, an area or a number of points. */
static double look(fibrad_workspace *work, const double frame[9], fibrad_points *points, uint32_t k) {
    work->disc.count = 0;
    if (points->count == 0) LANED(fibrad_areas_begin)(&work->areas);
    points->open = points->count;
    points->takers = 0;
    for (uint32_t word = 0; word < points->count / 64; word++) points->seen[word] = UINT64_MAX;

    bool open = true;
    uint32_t settled = 0;
    double known = -1, horizon = __builtin_inf(); /* all that emerges down to `known` has been looked up */
    for (uint32_t shell = 0; open && known < horizon; shell++) {
        if (shell == work->near.shells && fibrad_near_pays(&work->near)) LANED(fibrad_near_extend)(work);
        if (shell < work->near.shells) {
            sieve(work, frame, shell);
            known = work->near.limit[shell];
        } else {
            double to = known < 0 ? work->step : work->growth * known;
            LANED(fibrad_near_march)(work, frame, &(fibrad_tube){.radius = 1}, known, to);
            known = to;
        }
        if (work->disc.count > work->disc.capacity) break;
        if (known >= work->clear) horizon = fibrad_near_horizon(work, frame + 6);
        sort(work, settled);
        settled = settle(work, points, k, settled, known < horizon ? known : __builtin_inf(), &open);
    }
    if (points->count > 0) return points->open;
    double rest = LANED(fibrad_areas_end)(&work->areas);
    for (uint32_t c = 1; c < work->areas.circles; c++)
        if (work->areas.area[c] > 0) fibrad_work_see(work, work->areas.whose[c], k, work->areas.area[c]);
    return rest;
}

double LANED(fibrad_beam_window)(fibrad_workspace *work, const double frame[9], fibrad_points *points, uint32_t k) {
    return look(work, frame, points, k);
}
