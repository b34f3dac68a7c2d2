/* beam_lanes.c - a row of view factors by parallel beams. Compiled once per instruction set. SPDX-License-Identifier:
 * MIT
 *
 * Per direction, the window is the shadow disc of sphere i; the spheres ahead throw discs on it, nearest first. They
 * are looked up shell by shell: after a shell everything is known down to some depth, the discs up to there are settled
 * in the order of their depth, and most windows are covered before a second shell is asked for. */
#include FIBRAD_LANES_HEADER
#include "base/sort.h"
#include "bed/areas_lanes.h"
#include "bed/beam_lanes.h"
#include "bed/near_lanes.h"
#include "bed/points_lanes.h"
#include "bed/walls_lanes.h"
#include "sample/direction.h"

#define PI 3.14159265358979323846

/* Appends the discs of one shell that come before the window. That the places are listed before they are used spares
 * one mispredicted branch for most vectors. */
static void sieve(fibrad_work *work, const double frame[9], uint32_t shell) {
    const fibrad_near near = work->near; /* a copy: what is stored cannot change its pointers */
    vf wx = vf_set1((float)frame[6]), wy = vf_set1((float)frame[7]), wz = vf_set1((float)frame[8]);
    uint32_t found = 0, end = near.end[shell];
    for (uint32_t j = shell == 0 ? 0 : near.end[shell - 1]; j < end; j += VF_LANES) {
        vf depth = vf_add(vf_add(vf_mul(wx, vf_load(near.fx + j)), vf_mul(wy, vf_load(near.fy + j))),
                          vf_mul(wz, vf_load(near.fz + j)));
        uint32_t bits = vf_lt_bits(vf_load(near.fe + j), depth);
        found += vf_compress_places(near.found + found, bits, j);
    }
    for (uint32_t n = 0; n < found; n++) {
        uint32_t k = near.found[n];
        fibrad_work_add_disc(work, frame, near.x[k], near.y[k], near.z[k], near.r[k], (uint32_t)near.sphere[k]);
    }
}

/* Front to back. At equal depths discs of spheres that do not interpenetrate do not overlap; a fixed order all the
 * same, since they may touch. Settled ones stay in front. */
static bool before(const fibrad_work *work, uint32_t k, uint32_t other) {
    const fibrad_disc *a = &work->disc[k], *b = &work->disc[other];
    if (work->depth[k] != work->depth[other]) return work->depth[k] < work->depth[other];
    if (a->sphere != b->sphere) return a->sphere < b->sphere;
    return a->u != b->u ? a->u < b->u : a->v < b->v;
}

static void sort_by_insertion(fibrad_work *work) {
    uint32_t *order = work->order;
    for (uint32_t k = 0; k < work->discs; k++) order[k] = k;
    for (uint64_t gap = fibrad_sort_first_gap(work->discs); gap > 0; gap = fibrad_sort_next_gap(gap))
        for (uint64_t k = gap; k < work->discs; k++) {
            uint32_t moving = order[k];
            uint64_t to = k;
            for (; to >= gap && before(work, moving, order[to - gap]); to -= gap) order[to] = order[to - gap];
            order[to] = moving;
        }
}

/* Lists all but the settled discs in order. Up to RANKED discs are sorted by counting, in lanes, how many lie before
 * each, which no branch depends on; insertion mispredicted 38 branches a window. Equal depths would share a rank. */
#define RANKED 64
static void sort(fibrad_work *work, uint32_t settled) {
    _Alignas(64) double rank[RANKED];
    const double *depth = work->depth;
    uint32_t count = work->discs;
    if (settled == count) return;
    if (count <= RANKED) {
        uint64_t taken = (UINT64_C(1) << settled) - 1;
        for (uint32_t k = 0; k < count; k += VD_LANES) {
            vd at = vd_load(depth + k), sum = vd_set1(0);
            for (uint32_t j = 0; j < count; j++)
                sum = vd_add(sum, vd_select(vd_lt(vd_set1(depth[j]), at), vd_set1(1), vd_set1(0)));
            vd_store(rank + k, sum);
        }
        for (uint32_t k = 0; k < count; k++) {
            uint32_t to = (uint32_t)rank[k];
            work->order[to] = k;
            taken |= UINT64_C(1) << to;
        }
        if (taken == UINT64_MAX >> (64 - count)) return;
    }
    sort_by_insertion(work);
}

/* Settles discs [from, return) of the window, the ones down to `depth`. False in *open once the window is covered. */
static uint32_t settle(fibrad_work *work, fibrad_points *points, uint32_t window, uint32_t from, double depth,
                       bool *open) {
    for (; *open && from < work->discs && work->depth[work->order[from]] <= depth; from++) {
        uint32_t k = work->order[from];
        const fibrad_disc *d = &work->disc[k];
        work->depth[k] = -1;
        if (points->count == 0) {
            *open = LANED(fibrad_areas_disc)(&work->areas, k, d->u, d->v, d->r);
        } else {
            uint32_t hits = LANED(fibrad_points_disc)(points, d->u, d->v, d->r);
            if (hits > 0) fibrad_entries_add(&work->entries, d->sphere, window, hits);
            *open = points->open > 0;
        }
    }
    return from;
}

/* One window: adds what it sees to the entries and returns what stays open, an area or a number of points. */
static double look(fibrad_work *work, const double frame[9], fibrad_points *points, uint32_t k) {
    work->discs = 0;
    if (points->count == 0) LANED(fibrad_areas_begin)(&work->areas);
    points->open = points->count;
    for (uint32_t word = 0; word < points->count / 64; word++) points->seen[word] = UINT64_MAX;

    bool open = true;
    uint32_t settled = 0;
    double known = -1, horizon = __builtin_inf(); /* all that emerges down to `known` has been looked up */
    for (uint32_t shell = 0; open && known < horizon; shell++) {
        if (shell == work->near.shells && !work->near.full) LANED(fibrad_near_extend)(work);
        if (shell < work->near.shells) {
            sieve(work, frame, shell);
            known = work->near.limit[shell];
        } else {
            double to = known < 0 ? work->step : FIBRAD_GROWTH * known;
            fibrad_near_march(work, frame, &(fibrad_tube){.radius = 1}, known, to);
            known = to;
        }
        if (work->discs > work->config.discs) break;
        if (known >= work->clear) horizon = fibrad_near_horizon(work, frame + 6);
        sort(work, settled);
        settled = settle(work, points, k, settled, known < horizon ? known : __builtin_inf(), &open);
    }
    if (points->count > 0) return points->open;
    double rest = LANED(fibrad_areas_end)(&work->areas);
    for (uint32_t c = 1; c < work->areas.circles; c++)
        if (work->areas.area[c] > 0)
            fibrad_entries_add(&work->entries, work->disc[work->areas.whose[c]].sphere, k, work->areas.area[c]);
    return rest;
}

/* Turns the axes of window k by an angle of its own, so that its points do not lie as those of its neighbours. By five
 * golden angles a window the error is least of what was tried: half of that without, at 2000 directions of 256 points.
 */
static void turn(double frame[9], uint32_t k) {
    double cos, sin;
    fibrad_azimuth(5 * k % FIBRAD_DIRECTIONS_MAX, &cos, &sin);
    for (int axis = 0; axis < 3; axis++) {
        double u = frame[axis], v = frame[3 + axis];
        frame[axis] = cos * u + sin * v, frame[3 + axis] = cos * v - sin * u;
    }
}

/* Notes what discs the row lacked, if it did. */
static bool lacking(fibrad_work *work) {
    bool crowded = work->discs > work->config.discs || work->areas.overflow;
    if (crowded && work->config.discs > 0)
        work->needed.discs = work->discs > 2 * work->config.discs ? work->discs : 2 * work->config.discs;
    return crowded;
}

int LANED(fibrad_beam_row)(const fibrad_scene *scene, fibrad_work *work, uint32_t i, uint32_t directions,
                           uint32_t points, double cutoff, fibrad_row *row) {
    fibrad_points window = {.count = points};
    if (points > 0) {
        int built_in = fibrad_disc_points_get(points, &window.set);
        if (built_in != FIBRAD_OK) return built_in;
    }
    work->areas.overflow = false;
    work->areas.fallbacks = 0;
    fibrad_work_begin(work, scene, scene->place[i], cutoff);
    double open[2] = {0, 0};
    for (uint32_t k = 0; k < directions; k++) {
        fibrad_polar d = fibrad_direction_polar(k, directions);
        double frame[9] = {-d.sin, d.cos, 0, -d.z * d.cos, -d.z * d.sin, d.ring, d.ring * d.cos, d.ring * d.sin, d.z};
        if (points > 0) turn(frame, k);
        work->entries.end = k == 0 || k == directions - 1;
        double rest = look(work, frame, &window, k);
        if (lacking(work)) return row->length = 0, FIBRAD_E_CAPACITY;
        if (scene->container.walls)
            LANED(fibrad_walls_share)(work, frame, &window, k, directions, rest);
        else
            open[k % 2] += rest;
    }
    if (work->entries.missed > 0) {
        uint64_t enough = (uint64_t)work->entries.capacity + work->entries.missed;
        work->needed.entries = (uint32_t)(enough < scene->facts.spheres ? enough : scene->facts.spheres);
        return row->length = 0, FIBRAD_E_CAPACITY;
    }
    double scale = points > 0 ? 1.0 / ((double)directions * points) : 1 / (directions * PI);
    int status = fibrad_entries_row(work, scale, row);
    if (status != FIBRAD_OK) return status;
    row->escaped = (open[0] + open[1] + work->wall[FIBRAD_WALLS]) * scale;
    for (int wall = 0; wall < FIBRAD_WALLS; wall++) row->wall[wall] = fibrad_max(0, work->wall[wall]) * scale;
    row->error *= fibrad_entries_gain(&work->entries);
    row->directions = directions;
    row->fallbacks = work->areas.fallbacks;
    return FIBRAD_OK;
}
