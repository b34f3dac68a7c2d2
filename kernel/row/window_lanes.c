/* window_lanes.c - computes one window of a beam. Compiled once per instruction set. SPDX-License-Identifier: MIT
 *
 * The window is the projection of sphere i along the direction. The spheres ahead project discs on it. Spheres are
 * found shell by shell. After a shell all discs down to some depth are known. These discs are taken from front to
 * back. Most windows are covered before a second shell is needed. */
#include FIBRAD_LANES_HEADER
#include "base/lanes/below.h"
#include "base/sort.h"
#include "row/mesh_share_lanes.h"
#include "near/near_lanes.h"
#include "row/window_lanes.h"
#include "window/clip_lanes.h"
#include "window/dense_lanes.h"
#include "mask/masks_lanes.h"
#include "window/points_lanes.h"

/* Rows of fewer windows than this look at the whole first shell: lists of octants cost more than they save. */
#define WINDOWS_LISTED 64

static const fibrad_sight *sight_of(fibrad_workspace *work, const double w[3]) {
    return work->windows < WINDOWS_LISTED ? &work->near.all : LANED(fibrad_near_sight)(&work->near, w);
}

/* Appends the discs of one shell that come before the window. A cull in floats comes first. Its result is a list of
 * places, used afterwards. For most vectors this avoids a branch that would be mispredicted. */
static void cull_for_window(fibrad_workspace *work, const double frame[9], uint32_t shell) {
    fibrad_sight sight = work->near.all;
    size_t begin = shell > 0 ? work->near.end[shell - 1] : 0, end = work->near.end[shell];
    if (shell == 0) sight = *sight_of(work, frame + 6), end = sight.count;
    uint32_t *from = work->disc.near + work->disc.count, *to = from;
    vf wx = vf_set1((float)frame[6]), wy = vf_set1((float)frame[7]), wz = vf_set1((float)frame[8]);
    for (size_t j = begin; j < end; j += VF_LANES) {
        vf depth = wx * vf_load(sight.x + j) + wy * vf_load(sight.y + j) + wz * vf_load(sight.z + j);
        uint32_t bits = vf_lt_bits(vf_load(sight.e + j), depth);
        to += vn_compress(to, bits, sight.near + j);
    }
    LANED(fibrad_near_discs)(work, frame, (uint32_t)(to - from));
}

/* The same for masks. All that they need of a disc are floats. */
static void cull_for_masks(fibrad_workspace *work, const double frame[9], uint32_t shell) {
    const fibrad_discs disc = work->disc;
    fibrad_sight sight = work->near.all;
    size_t begin = shell > 0 ? work->near.end[shell - 1] : 0, end = work->near.end[shell];
    uint32_t n = disc.count;
    if (shell == 0) sight = *sight_of(work, frame + 6), end = sight.count;
    const vf ux = vf_set1((float)frame[0]), uy = vf_set1((float)frame[1]), uz = vf_set1((float)frame[2]);
    const vf vx = vf_set1((float)frame[3]), vy = vf_set1((float)frame[4]), vz = vf_set1((float)frame[5]);
    const vf wx = vf_set1((float)frame[6]), wy = vf_set1((float)frame[7]), wz = vf_set1((float)frame[8]);
    for (size_t j = begin; j < end; j += VF_LANES) {
        const vf x = vf_load(sight.x + j), y = vf_load(sight.y + j), z = vf_load(sight.z + j);
        const vf depth = wx * x + wy * y + wz * z;
        const uint32_t bits = vf_lt_bits(vf_load(sight.e + j), depth);
        const uint32_t at = n < disc.capacity ? n : disc.capacity; /* discs beyond the capacity are only counted */
        vf_compress(disc.fu + at, bits, ux * x + uy * y + uz * z);
        vf_compress(disc.fv + at, bits, vx * x + vy * y + vz * z);
        vf_compress(disc.fdepth + at, bits, depth);
        vf_compress(disc.square + at, bits, vf_load(sight.square + j));
        n += vn_compress(disc.near + at, bits, sight.near + j);
    }
    work->disc.count = n;
}

/* Fills the floats of discs that a walk has found. */
static void round_found(fibrad_discs *disc, uint32_t from) {
    for (uint32_t k = from; k < disc->count && disc->count <= disc->capacity; k++) {
        disc->fu[k] = (float)disc->u[k], disc->fv[k] = (float)disc->v[k], disc->fdepth[k] = (float)disc->depth[k];
        disc->square[k] = (float)(disc->r[k] * disc->r[k]);
    }
}

/* Removes those discs from number `from` on that do not lie ahead. Only spheres that overlap sphere i may. */
static void drop_not_ahead(fibrad_workspace *work, uint32_t from) {
    const fibrad_discs disc = work->disc;
    uint32_t to = from, all_ahead = 1;
    for (uint32_t k = from; k < disc.count; k++) all_ahead &= disc.fdepth[k] > 0;
    for (uint32_t k = from; k < disc.count && !all_ahead; k++) {
        disc.fu[to] = disc.fu[k], disc.fv[to] = disc.fv[k], disc.fdepth[to] = disc.fdepth[k];
        disc.square[to] = disc.square[k], disc.near[to] = disc.near[k];
        to += fibrad_work_ahead(work, disc.fdepth[k], disc.fu[k], disc.fv[k], fibrad_work_sphere(work, k));
    }
    if (!all_ahead) work->disc.count = to;
}

/* Whether a disc lies in front of another. At equal depths discs of spheres that do not interpenetrate do not
 * overlap but may touch, so their order is fixed too. Discs that have been used stay in front. */
static bool disc_before(const fibrad_workspace *work, uint32_t k, uint32_t other) {
    const fibrad_discs *disc = &work->disc;
    if (disc->depth[k] != disc->depth[other]) return disc->depth[k] < disc->depth[other];
    const double at[2] = {disc->u[k], disc->v[k]}, at_other[2] = {disc->u[other], disc->v[other]};
    return fibrad_scene_tie(work->scene, fibrad_work_sphere(work, k), at, fibrad_work_sphere(work, other), at_other, 2);
}

/* Sorts positions [from, to) of the order. */
static void sort_discs_by_insertion(fibrad_workspace *work, uint32_t from, uint32_t to) {
    uint32_t *order = work->disc.order + from;
    const uint32_t count = to - from;
    for (uint64_t gap = fibrad_sort_first_gap(count); gap > 0; gap = fibrad_sort_next_gap(gap))
        for (uint64_t k = gap; k < count; k++) {
            uint32_t moving = order[k];
            uint64_t at = k;
            for (; at >= gap && disc_before(work, moving, order[at - gap]); at -= gap) order[at] = order[at - gap];
            order[at] = moving;
        }
}

/* Sorts many discs by their depths as floats, digit by digit: the bits of floats >= 0 ascend as the floats do. Then
 * insertion sorts depths that are equal as floats. */
static void sort_discs_by_digits(fibrad_workspace *work) {
    const fibrad_discs *disc = &work->disc;
    uint32_t resolved = 0, count = 0, largest = 0;
    for (uint32_t k = 0; k < disc->count; k++) {
        union {
            float depth;
            uint32_t bits;
        } key = {(float)disc->depth[k] + 0.0f}; /* so that there is no negative zero */
        if (disc->depth[k] < 0) {
            disc->order[resolved++] = k;
            continue;
        }
        disc->key[0][count++] = (uint64_t)key.bits << 32 | k;
        if (key.bits > largest) largest = key.bits;
    }
    const uint64_t *key = fibrad_sort_keys(disc->key[0], disc->key[1], count, 32, largest);
    for (uint32_t from = 0, to; from < count; from = to) {
        for (to = from; to < count && key[to] >> 32 == key[from] >> 32; to++)
            disc->order[resolved + to] = (uint32_t)key[to];
        if (to > from + 1) sort_discs_by_insertion(work, resolved + from, resolved + to);
    }
}

/* Lists in order all discs that have not been used. Up to DISCS_RANKED discs are sorted by counting how many lie
 * before each, in lanes and without branches. Insertion mispredicted 38 branches a window. Depths that are equal as
 * floats have the same rank. Then the sum of all ranks is too small, which shows it. The list is padded to a
 * multiple of eight with depths beyond all others, so that the number of rounds is easy to predict. */
#define DISCS_RANKED 256
static void sort_discs(fibrad_workspace *work, uint32_t resolved, bool masked) {
    _Alignas(64) uint32_t rank[DISCS_RANKED + FIBRAD_LANES_MAX];
    const fibrad_discs disc = work->disc;
    float *key = disc.fdepth;
    uint32_t count = disc.count, eights = (count + 7) / 8 * 8, *order = disc.order;
    if (resolved == count) return;
    if (count <= DISCS_RANKED) {
        for (uint32_t k = 0; k < count && !masked; k += VD_LANES) vd_store_float(key + k, vd_load(disc.depth + k));
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
        if (sum == (count * (count - 1) - resolved * (resolved - 1)) / 2 + (eights - count) * count) return;
    }
    for (uint32_t k = 0; k < count && masked; k++)
        disc.depth[k] = disc.fdepth[k], disc.u[k] = disc.fu[k], disc.v[k] = disc.fv[k];
    sort_discs_by_digits(work);
}

/* The number of discs that are not deeper than `depth`. */
static uint32_t discs_down_to(const fibrad_discs *disc, double depth) {
    uint32_t count = 0;
    for (uint32_t k = 0; k < disc->count; k += VD_LANES)
        count += fibrad_count_bits(vm_bits(vd_le(vd_load(disc->depth + k), vd_set1(depth))) &
                                   vd_lanes_below(disc->count - k));
    return count;
}

/* Hides what discs [from, return) cover, those down to `depth`. *open: out: false if the window is covered. */
static uint32_t resolve_discs(fibrad_workspace *work, fibrad_points *points, uint32_t window, uint32_t from,
                              double depth, bool *open) {
    const fibrad_discs disc = work->disc;
    uint32_t to;
    if (points->count == 0) {
        to = discs_down_to(&disc, depth);
        to = from + LANED(fibrad_areas_discs)(&work->areas, 0, disc.order + from, to - from, disc.u, disc.v, disc.r);
        *open = work->areas.open;
    } else {
        to = LANED(fibrad_points_discs)(points, &work->disc, from, depth);
        *open = points->open > 0;
        uint32_t *end = disc.occluder; /* discs beyond `to` hide no point */
        for (uint32_t d = from; d < to; d += VF_LANES)
            end += vf_compress_places(end, vn_some_bits(disc.hidden_points + d), d);
        for (const uint32_t *rank = disc.occluder; rank < end; rank++) {
            uint32_t k = disc.order[*rank];
            fibrad_work_accumulate(work, k, window, (int32_t)disc.hidden_points[*rank]);
            points->occluder[points->occluders++] = k;
        }
    }
    if (*open)
        for (uint32_t d = from; d < to; d++) {
            const uint32_t k = disc.order[d];
            disc.resolved[k] = disc.depth[k], disc.depth[k] = -1;
        }
    return to;
}

/* Finds and sorts the discs of one more shell. *known: out: the depth down to which all are listed. */
static void find_shell(fibrad_workspace *work, const double frame[9], uint32_t shell, bool masked, uint32_t resolved,
                       double *known, double *horizon) {
    const uint32_t from = work->disc.count;
    if (shell == work->near.shells && fibrad_near_pays(&work->near)) LANED(fibrad_near_extend)(work);
    if (shell < work->near.shells) {
        if (masked)
            cull_for_masks(work, frame, shell);
        else
            cull_for_window(work, frame, shell);
        *known = work->near.limit[shell];
    } else {
        const double to = fibrad_near_further(work, *known);
        LANED(fibrad_near_walk)(work, frame, &(fibrad_tube){.radius = 1}, *known, to);
        if (masked) round_found(&work->disc, from);
        *known = to;
    }
    if (work->disc.count > work->disc.capacity) return;
    if (masked) drop_not_ahead(work, from);
    if (*known >= work->clear) *horizon = fibrad_near_horizon(work, frame + 6);
    sort_discs(work, resolved, masked);
}

/* Adds what discs hide to the counts of the near list, or to entries if a walk has found the sphere. */
static void count_hidden(fibrad_workspace *work, uint32_t window) {
    const fibrad_discs disc = work->disc;
    for (uint32_t k = 0; k < disc.count; k++) {
        work->masks.regions += disc.hidden_points[k] > 0;
        if (disc.near[k] < work->near.capacity)
            work->near.count[disc.near[k]][window % 2] += disc.hidden_points[k];
        else if (disc.hidden_points[k] > 0)
            fibrad_work_accumulate(work, k, 2 + window % 2, disc.hidden_points[k]);
    }
}

bool LANED(fibrad_mask_window)(fibrad_workspace *work, const double frame[9], uint32_t k) {
    fibrad_masks *masks = &work->masks;
    fibrad_discs *disc = &work->disc;
    uint32_t resolved = 0;
    double known = -1, horizon = __builtin_inf();
    disc->count = 0;
    for (uint32_t shell = 0; masks->open > 0 && known < horizon; shell++) {
        const uint32_t before = disc->count;
        find_shell(work, frame, shell, true, resolved, &known, &horizon);
        if (disc->count > disc->capacity) return true;
        fibrad_zero(disc->hidden_points + before, (disc->count - before) * sizeof *disc->hidden_points);
        const uint32_t from = resolved;
        resolved = LANED(fibrad_masks_discs)(masks, disc, from, (float)fibrad_min(known, horizon));
        for (uint32_t d = from; d < resolved && masks->open > 0; d++) disc->fdepth[disc->order[d]] = -1;
    }
    if (fibrad_mesh_near(work, masks->open > 0 ? __builtin_inf() : known)) return false;
    if (k != FIBRAD_NONE) count_hidden(work, k);
    return true;
}

/* Windows with more discs than this in the first shell mostly have many arcs. */
#define DISCS_DENSE 44

double LANED(fibrad_beam_window)(fibrad_workspace *work, const double frame[9], fibrad_points *points, uint32_t k) {
    work->disc.count = 0;
    if (points->count == 0) LANED(fibrad_areas_begin)(&work->areas);
    points->open = points->count;
    points->occluders = 0;
    for (uint32_t word = 0; word < points->count / 64; word++) points->seen[word] = UINT64_MAX;

    bool open = true;
    uint32_t resolved = 0;
    double known = -1, horizon = __builtin_inf(); /* all spheres with a minimum depth of at most `known` are listed */
    for (uint32_t shell = 0; open && known < horizon; shell++) {
        find_shell(work, frame, shell, false, resolved, &known, &horizon);
        if (work->disc.count > work->disc.capacity) break;
        if (shell == 0 && work->disc.count > DISCS_DENSE && points->count == 0)
            LANED(fibrad_dense_begin)(&work->areas, work->disc.order, work->disc.count, work->disc.r);
        resolved = resolve_discs(work, points, k, resolved, fibrad_min(known, horizon), &open);
    }
    const bool near = fibrad_mesh_near(work, open ? __builtin_inf() : known);
    if (work->met != NULL) work->met->any = false;
    double rest = work->bare = points->count > 0 ? points->open : LANED(fibrad_areas_end)(&work->areas);
    if (points->count > 0) return near ? LANED(fibrad_mesh_share)(work, frame, points, k, rest) : rest;
    if (near) rest = LANED(fibrad_mesh_share)(work, frame, points, k, rest);
    if (near && work->met->any) return rest;
    for (uint32_t c = 1; c < work->areas.circles && k != FIBRAD_NONE; c++)
        if (work->areas.area[c] > 0) fibrad_work_accumulate(work, work->areas.whose[c], k, work->areas.area[c]);
    return rest;
}
