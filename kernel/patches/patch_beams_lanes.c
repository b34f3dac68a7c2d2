/* patch_beams_lanes.c - the patches that the beams of a sphere and the rays of walls connect. Compiled once per
 * instruction set. SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "base/vector.h"
#include "patches/subdivision.h"
#include "patches/patch_beams_lanes.h"
#include "patches/pencils.h"
#include "ray/tracer.h"
#include "row/mesh_share_lanes.h"
#include "row/wall_share_lanes.h"
#include "sample/direction.h"
#include "scene/walls.h"
#include "row/window_lanes.h"

#define HIT_POINTS 64 /* points of a window that are treated together, a "word" */

/* Points of a word whose beams are kept: the disc that each beam meets, and where it meets the sphere. */
struct hit_window {
    _Alignas(64) double u[HIT_POINTS], v[HIT_POINTS], w[HIT_POINTS];    /* normals in the frame of the window */
    _Alignas(64) double face[HIT_POINTS], x[HIT_POINTS], y[HIT_POINTS]; /* of the cube; place on it [squares] */
    uint32_t point[HIT_POINTS], disc[HIT_POINTS];
    uint32_t count;
    uint64_t behind; /* bits of points where beams leave their own sphere behind a wall */
    uint64_t inside; /* the same inside another member of its clump; there are no such beams */
    uint64_t wrong;  /* the same of points whose first disc is not what the beam meets, in a clump */
};

/* Finds the patch numbers, 0 to 6 side^2 - 1, of the normals of all points. */
static void number_patches_of(struct hit_window *p, const double frame[9], uint32_t side, uint16_t *patch) {
    const vd zero = vd_set1(0), one = vd_set1(1), half = vd_set1(.5 * side);
    double axes[9];
    fibrad_patch_turn(frame, axes);
    for (uint32_t k = 0; k < p->count; k += VD_LANES) {
        vd u = vd_load(p->u + k), v = vd_load(p->v + k), w = vd_load(p->w + k), n[3], size[3];
        for (int axis = 0; axis < 3; axis++) {
            n[axis] = u * axes[axis] + v * axes[3 + axis] + w * axes[6 + axis];
            size[axis] = vd_abs(n[axis]);
        }
        vm second = vd_lt(size[0], size[1]);
        vd largest = vd_max(size[0], size[1]), high = vd_select(second, n[1], n[0]);
        vm third = vd_lt(largest, size[2]);
        largest = vd_max(largest, size[2]), high = vd_select(third, n[2], high);
        vd face = vd_select(third, vd_set1(4), vd_select(second, vd_set1(2), zero));
        vd a = vd_select(third, n[0], vd_select(second, n[0], n[1])) / largest;
        vd b = vd_select(third, n[1], n[2]) / largest;
        /* t (5 - t^2)/4 is nearly proportional to the angle, atan t */
        a *= 1.25 - .25 * (a * a);
        b *= 1.25 - .25 * (b * b);
        vd_store(p->face + k, face + vd_select(vd_lt(high, zero), one, zero));
        vd_store(p->x + k, vd_max(a + one, zero) * half);
        vd_store(p->y + k, vd_max(b + one, zero) * half);
    }
    for (uint32_t k = 0; k < p->count; k++)
        patch[k] = (uint16_t)fibrad_patch_number((uint32_t)p->face[k], (uint32_t)p->x[k], (uint32_t)p->y[k], side);
}

/* Counts a beam of window k that meets a fine patch. Returns the beam. */
static fibrad_heat_beam fine_beam(const fibrad_heat *heat, fibrad_workspace *work, uint32_t k, uint16_t from,
                                  uint32_t fine) {
    const uint32_t row = fibrad_heat_row_of_fine(heat, fine), entry = fibrad_entries_of(&work->entries, row);
    fibrad_entries_add(&work->entries, entry, k, 1);
    return (fibrad_heat_beam){entry, from,
                              (uint16_t)(fine - FIBRAD_HEAT_FOUR * heat->division.fine[row - heat->spheres].first)};
}

/* The points of a word whose beams are kept: all, or half of them. The halves are the numbers with an even and with an
 * odd number of ones (Thue, Morse). They take turns. */
static uint64_t kept_points(uint32_t turn, uint32_t thin) {
    const uint64_t half = 0x9669699669969669;
    return thin == 1 ? UINT64_MAX : turn % 2 == 0 ? half : ~half;
}

/* The points of a word whose beams end on a triangle. */
static uint64_t meshed_points(const fibrad_workspace *work, uint32_t word) {
    uint64_t bits = 0;
    if (work->met == NULL || !work->met->any) return 0;
    for (uint32_t p = 0; p < HIT_POINTS; p++)
        bits |= (uint64_t)(work->met->side[HIT_POINTS * word + p] != FIBRAD_NO_SIDE) << p;
    return bits;
}

/* Which of the given points lie behind a wall. The points are on the sphere at `place`, whose disc is u, v, r. side: 1:
 * where beams leave the sphere; -1: where beams arrive there. */
static uint64_t points_behind(const fibrad_workspace *work, const double frame[9], const float *x, const float *y,
                              uint64_t points, uint32_t place, const double disc[3], double side) {
    const fibrad_scene *scene = work->scene;
    double at[3];
    uint64_t behind = 0;
    if (!scene->cut[place]) return 0;
    const double centre[3] = {scene->x[place], scene->y[place], scene->z[place]};
    for (; points != 0; points &= points - 1) {
        const uint32_t p = (uint32_t)__builtin_ctzll(points);
        const double u = x[p] - disc[0], v = y[p] - disc[1];
        const double up = side * fibrad_sqrt(fibrad_max(0, disc[2] * disc[2] - (u * u + v * v)));
        for (int axis = 0; axis < 3; axis++)
            at[axis] = centre[axis] + work->unit * (u * frame[axis] + v * frame[3 + axis] + up * frame[6 + axis]);
        if (!fibrad_walls_hold(&scene->container, at)) behind |= points & (0 - points);
    }
    return behind;
}

/* Which of the given points of a sphere lie inside another member of its clump. side: as for points_behind. */
static uint64_t points_inside(const fibrad_heat *heat, const double frame[9], const float *x, const float *y,
                              uint64_t points, uint32_t place, const double disc[3], double side) {
    uint64_t inside = 0;
    for (size_t k = heat->clumps.first_cap[place]; k < heat->clumps.first_cap[place + 1]; k++) {
        const fibrad_heat_cap *cap = &heat->clumps.cap[k];
        const double a = fibrad_dot(cap->at, frame), b = fibrad_dot(cap->at, frame + 3),
                     c = side * fibrad_dot(cap->at, frame + 6);
        for (uint64_t left = points & ~inside; left != 0; left &= left - 1) {
            const uint32_t p = (uint32_t)__builtin_ctzll(left);
            const double u = (x[p] - disc[0]) / disc[2], v = (y[p] - disc[1]) / disc[2];
            const double up = fibrad_sqrt(fibrad_max(0, 1 - (u * u + v * v)));
            if (a * u + b * v + c * up > cap->beyond) inside |= left & (0 - left);
        }
    }
    return inside;
}

/* Takes points away from the disc that hides them. */
static void take_from_disc(fibrad_workspace *work, uint32_t disc, uint32_t k, uint64_t bits) {
    for (; bits != 0; bits &= bits - 1)
        fibrad_entries_add(&work->entries, work->near.entry[work->disc.near[disc]], k, -1);
}

/* Lists the points of a word whose beams are kept, each with the first disc that covers it. Kept are the points in
 * `kept`, at least one point of each sphere that this window sees for the first time (its entry is `known` or later),
 * and all points on spheres with fine patches. Points behind a wall count as open. Discs are in the order of their
 * centres. On a clump the first disc may be a part of a sphere that lies inside another one. */
static void find_hit_discs(const fibrad_heat *heat, fibrad_workspace *work, const double frame[9],
                           fibrad_points *points, uint32_t window, uint32_t word, uint64_t kept, uint32_t known,
                           struct hit_window *p) {
    const float *x = points->set.x + HIT_POINTS * word, *y = points->set.y + HIT_POINTS * word;
    uint64_t left = ~(points->seen[word] | meshed_points(work, word));
    p->count = 0;
    for (uint32_t t = 0; left != 0; t++) {
        const uint32_t k = points->occluder[t];
        const double r = work->disc.r[k];
        vf u = vf_set1((float)work->disc.u[k]), v = vf_set1((float)work->disc.v[k]), square = vf_set1((float)(r * r));
        uint64_t hidden = 0;
        for (uint32_t lane = 0; lane < HIT_POINTS; lane += VF_LANES) {
            vf dx = vf_load(x + lane) - u, dy = vf_load(y + lane) - v;
            hidden |= (uint64_t)vf_lt_bits(dx * dx + dy * dy, square) << lane;
        }
        hidden &= left;
        left &= ~hidden;
        const double disc[] = {work->disc.u[k], work->disc.v[k], r};
        const uint64_t behind =
            (hidden & p->behind) | points_behind(work, frame, x, y, hidden, fibrad_work_sphere(work, k), disc, -1);
        uint64_t lost = behind;
        if (heat->clumps.some) {
            const uint64_t wrong =
                points_inside(heat, frame, x, y, hidden & ~(behind | p->inside), fibrad_work_sphere(work, k), disc, -1);
            p->wrong |= wrong, lost |= wrong | (hidden & p->inside);
        }
        if (lost != 0) take_from_disc(work, k, window, lost);
        points->seen[word] |= behind;
        hidden &= ~lost;
        uint64_t bits = heat->division.root[fibrad_work_sphere(work, k)] == FIBRAD_NONE ? hidden & kept : hidden;
        if (bits == 0 && work->near.entry[work->disc.near[k]] >= known) bits = hidden & (0 - hidden);
        for (; bits != 0; bits &= bits - 1)
            p->point[p->count] = (uint32_t)__builtin_ctzll(bits), p->disc[p->count++] = k;
    }
    points->seen[word] = (points->seen[word] | p->behind) & ~p->inside;
}

/* Finds the normals where the beams of points x, y meet their spheres. */
static void find_hit_normals(const fibrad_workspace *work, const float *x, const float *y, struct hit_window *p) {
    for (uint32_t k = 0; k < p->count; k++) {
        const uint32_t d = p->disc[k];
        const double inverse = 1 / work->disc.r[d];
        p->u[k] = (x[p->point[k]] - work->disc.u[d]) * inverse, p->v[k] = (y[p->point[k]] - work->disc.v[d]) * inverse;
    }
    for (uint32_t k = p->count; k % VD_LANES != 0; k++) p->u[k] = p->v[k] = 0;
    for (uint32_t k = 0; k < p->count; k += VD_LANES) {
        vd u = vd_load(p->u + k), v = vd_load(p->v + k), square = vd_max(vd_set1(0), 1 - (u * u + v * v));
        vd_store(p->w + k, 0 - vd_sqrt(square));
    }
}

/* A window stands for all directions that are nearer to its own than to another. This is too coarse for far walls,
 * which have several patches within these directions. So the beam of each open point has a direction of its own, from a
 * disc about the direction of the window. The density falls towards the rim of the disc. Another point of the set
 * chooses the direction. If spheres hide a part of the window, they hide a part of its neighbours, too. The disc is
 * then smaller. Otherwise beams would meet walls that are hidden: docs/methods.md section 9. */
#define HIT_SPREAD 2.25 /* radius of the disc if the window is open, times sqrt n */

/* Whether two directions from a point meet different walls, and one of them rises and the other falls across a plane.
 * Between them other spheres may come in view, at any distance. */
static bool crosses_horizon(const fibrad_scene *scene, const double origin[3], const double a[3], const double b[3]) {
    const fibrad_container *c = &scene->container;
    bool crosses = false;
    double distance;
    for (int axis = 0; axis < 3; axis++)
        if (c->low[axis] > -__builtin_inf() || c->high[axis] < __builtin_inf()) crosses |= a[axis] * b[axis] < 0;
    return crosses && fibrad_walls_exit(scene, origin, a, &distance) != fibrad_walls_exit(scene, origin, b, &distance);
}

/* The patch that the beam of open point p of window k meets. */
static uint32_t escape_patch(const fibrad_heat *heat, const fibrad_workspace *work, const double frame[9],
                             const fibrad_points *points, uint32_t k, uint32_t p) {
    const fibrad_disc_points *set = &points->set;
    const double x = set->x[p], y = set->y[p], up = fibrad_sqrt(fibrad_max(0, 1 - (x * x + y * y)));
    double n[3], origin[3], w[3];
    if (!heat->scene->container.walls) return fibrad_heat_open(heat);
    for (int axis = 0; axis < 3; axis++) n[axis] = x * frame[axis] + y * frame[3 + axis] + up * frame[6 + axis];
    const uint32_t behind = fibrad_walls_behind(heat->scene, work->place, n, origin);
    if (behind != FIBRAD_NONE) return fibrad_heat_wall_patch(heat, behind, origin, false);
    if (work->met != NULL && work->met->any &&
        (work->met->aside[0][p] != 0 || work->met->aside[1][p] != 0)) { /* on the line that meets no triangle */
        LANED(fibrad_mesh_line)(work, frame, p, origin, w);
        return fibrad_heat_ends(heat, origin, w, FIBRAD_NO_SIDE, 0);
    }
    const uint32_t other = fibrad_points_partner(heat->config.points, p, k);
    const double a = set->x[other], b = set->y[other];
    const double rare = fibrad_sqrt(1 + fibrad_sqrt(fibrad_max(0, 1 - (a * a + b * b))));
    const double open = (double)points->open / points->count;
    const double spread = HIT_SPREAD * open / (fibrad_sqrt(heat->config.directions) * rare);
    const double du = spread * a, dv = spread * b;
    for (int axis = 0; axis < 3; axis++) {
        const double e = frame[axis], f = frame[3 + axis], g = frame[6 + axis];
        origin[axis] = work->centre[axis] + work->unit * n[axis];
        w[axis] = g + (du * e + dv * f);
    }
    if (crosses_horizon(heat->scene, origin, frame + 6, w)) {
        const double length = fibrad_sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]), at[2] = {x, y};
        const double way[3] = {w[0] / length, w[1] / length, w[2] / length};
        if (!LANED(fibrad_beam_turned)(work, frame, at, way))
            return fibrad_heat_ends(heat, origin, frame + 6, FIBRAD_NO_SIDE, 0);
    }
    return fibrad_heat_ends(heat, origin, w, FIBRAD_NO_SIDE, 0);
}

/* Keeps the beams of a word of window k that meet spheres. Returns the end of the beams that are kept. */
static fibrad_heat_beam *keep_hits(const fibrad_heat *heat, fibrad_workspace *work, const double frame[9],
                                   fibrad_points *points, uint32_t k, uint32_t word, uint64_t kept, uint32_t known,
                                   struct hit_window *window, fibrad_heat_beam *beam) {
    static const double disc[] = {0, 0, 1};
    uint16_t patch[HIT_POINTS];
    const uint16_t *leave = heat->leave + (size_t)k * points->count + HIT_POINTS * word;
    const float *x = points->set.x + HIT_POINTS * word, *y = points->set.y + HIT_POINTS * word;
    window->behind = points_behind(work, frame, x, y, UINT64_MAX, work->place, disc, 1);
    window->inside = heat->clumps.some ? points_inside(heat, frame, x, y, UINT64_MAX, work->place, disc, 1) : 0;
    window->wrong = 0;
    find_hit_discs(heat, work, frame, points, k, word, kept, known, window);
    find_hit_normals(work, x, y, window);
    number_patches_of(window, frame, heat->side, patch);
    for (uint32_t p = 0; p < window->count; p++) {
        const uint32_t sphere = fibrad_work_sphere(work, window->disc[p]), from = leave[window->point[p]];
        const uint32_t entry = work->near.entry[work->disc.near[window->disc[p]]];
        const bool left_out = fibrad_heat_is_divided(heat, work->place, from / FIBRAD_HEAT_FOUR);
        uint32_t fine = FIBRAD_NONE;
        if (heat->division.root[sphere] != FIBRAD_NONE)
            fine = fibrad_heat_fine_number(
                heat, sphere,
                fibrad_heat_patch_on_face(heat, sphere, patch[p], (double[]){window->x[p], window->y[p]}));
        if (left_out || fine != FIBRAD_NONE) fibrad_entries_add(&work->entries, entry, k, -1);
        if (left_out) continue;
        *beam++ = fine != FIBRAD_NONE ? fine_beam(heat, work, k, (uint16_t)from, fine)
                                      : (fibrad_heat_beam){entry, (uint16_t)from, patch[p]};
    }
    return beam;
}

/* Counts a beam of window k to a patch that belongs to no sphere. Keeps the beam if `kept`, or if it is the first one
 * to its block of patches. */
static fibrad_heat_beam *keep_other(const fibrad_heat *heat, fibrad_workspace *work, uint32_t k, uint16_t from,
                                    uint32_t patch, bool kept, fibrad_heat_beam *beam) {
    const uint32_t fine = fibrad_heat_fine_of(heat, patch);
    if (fine != FIBRAD_NONE) {
        *beam = fine_beam(heat, work, k, from, fine);
        return beam + 1;
    }
    const uint32_t known = work->entries.length, to = (patch - fibrad_heat_others(heat)) % FIBRAD_HEAT_BLOCK;
    const uint32_t entry = fibrad_entries_of(&work->entries, fibrad_heat_other(heat, patch));
    fibrad_entries_add(&work->entries, entry, k, 1);
    if (kept || entry == known) *beam++ = (fibrad_heat_beam){entry, from, (uint16_t)to};
    return beam;
}

/* Keeps all beams of a word that meet triangles. */
static fibrad_heat_beam *keep_meshed(const fibrad_heat *heat, fibrad_workspace *work, const double frame[9],
                                     const fibrad_points *points, uint32_t k, uint32_t word, uint64_t inside,
                                     fibrad_heat_beam *beam) {
    const uint16_t *leave = heat->leave + (size_t)k * heat->config.points + HIT_POINTS * word;
    for (uint64_t bits = meshed_points(work, word) & ~(points->seen[word] | inside); bits != 0; bits &= bits - 1) {
        const uint32_t p = (uint32_t)__builtin_ctzll(bits), side = work->met->side[HIT_POINTS * word + p];
        double at[3];
        if (fibrad_heat_is_divided(heat, work->place, leave[p] / FIBRAD_HEAT_FOUR)) continue;
        LANED(fibrad_mesh_place)(work, frame, HIT_POINTS * word + p, at);
        const uint32_t patch = fibrad_heat_mesh_patch(heat, side, at);
        if (patch == FIBRAD_NONE)
            work->back = fibrad_side_number(&heat->scene->mesh, side);
        else
            beam = keep_other(heat, work, k, leave[p], patch, true, beam);
    }
    return beam;
}

/* Keeps the beams of a word that meet neither a sphere nor a triangle. If there are walls, it keeps all of them. */
static fibrad_heat_beam *keep_escapes(const fibrad_heat *heat, fibrad_workspace *work, const double frame[9],
                                      const fibrad_points *points, uint32_t k, uint32_t word, uint64_t kept,
                                      fibrad_heat_beam *beam) {
    const uint16_t *leave = heat->leave + (size_t)k * points->count + HIT_POINTS * word;
    if (heat->scene->container.walls) kept = UINT64_MAX;
    for (uint64_t bits = points->seen[word]; bits != 0; bits &= bits - 1) {
        const uint32_t p = (uint32_t)__builtin_ctzll(bits);
        if (fibrad_heat_is_divided(heat, work->place, leave[p] / FIBRAD_HEAT_FOUR)) continue;
        const uint32_t patch = escape_patch(heat, work, frame, points, k, HIT_POINTS * word + p);
        beam = keep_other(heat, work, k, leave[p], patch, (kept >> p & 1) != 0, beam);
    }
    return beam;
}

/* The area that a ray stands for that ends in a row. 0: it does not count. */
static double area_to_row(const fibrad_heat *heat, uint32_t slot, uint32_t row) {
    const double density = slot < FIBRAD_WALLS ? 0 : fibrad_heat_sees(heat, slot - FIBRAD_MESHES, row);
    return density > 0 ? 1 / (density + heat->density[row]) : 0;
}

/* Ends a ray of a mesh at the sphere that it meets. A ray that starts inside the sphere ends there if the side of the
 * mesh faces the centre: beams from the cap behind the mesh arrive at this side. */
static void end_at_sphere(const fibrad_heat *heat, uint32_t slot, uint32_t side, const fibrad_hit *hit,
                          fibrad_heat_ray *ray) {
    double n[3];
    fibrad_mesh_normal(&heat->scene->mesh, side, n);
    if (hit->distance == 0 && !(fibrad_dot(n, hit->centre) > 0)) return;
    ray->to = fibrad_heat_patch_at(heat, hit->sphere, hit->normal);
    const uint32_t fine = fibrad_heat_fine_number(heat, hit->sphere, ray->to);
    ray->area = area_to_row(heat, slot, fine != FIBRAD_NONE ? fibrad_heat_row_of_fine(heat, fine) : hit->sphere);
}

/* Follows ray k of the wall of a slot. ray: out: the patches that it connects. */
static int follow_ray(const fibrad_heat *heat, fibrad_workspace *work, uint32_t slot, uint32_t k, double density,
                      fibrad_heat_ray *ray) {
    uint32_t side = FIBRAD_NO_SIDE;
    double origin[3], w[3];
    fibrad_hit hit;
    *ray = (fibrad_heat_ray){0, 0, 0};
    const bool starts = slot < FIBRAD_WALLS ? fibrad_heat_wall_ray(heat, slot, k, origin, w)
                                            : fibrad_heat_mesh_ray(heat, slot - FIBRAD_MESHES, k, origin, w, &side);
    if (!starts) return FIBRAD_OK;
    LANED(fibrad_trace_point)
    (heat->scene, NULL, origin, w, side == FIBRAD_NO_SIDE ? side : fibrad_side_triangle(side), &hit);
    if (hit.sphere != FIBRAD_NONE && side == FIBRAD_NO_SIDE) return FIBRAD_OK;
    ray->from = slot < FIBRAD_WALLS ? fibrad_heat_wall_patch(heat, slot, origin, true)
                                    : fibrad_heat_mesh_patch(heat, side, origin);
    if (fibrad_heat_fine_of(heat, ray->from) != FIBRAD_NONE) return FIBRAD_OK; /* these have rays of their own */
    if (hit.sphere != FIBRAD_NONE) {
        end_at_sphere(heat, slot, side, &hit, ray);
        return FIBRAD_OK;
    }
    ray->to = fibrad_heat_ends(heat, origin, w, hit.side, hit.distance);
    if (ray->to == FIBRAD_NONE) {
        work->back = fibrad_side_number(&heat->scene->mesh, hit.side);
        return FIBRAD_E_BACK;
    }
    const uint32_t fine = fibrad_heat_fine_of(heat, ray->to);
    ray->area = fine != FIBRAD_NONE ? area_to_row(heat, slot, fibrad_heat_row_of_fine(heat, fine))
                                    : 1 / (density + fibrad_heat_wall_density(heat, ray->to));
    return FIBRAD_OK;
}

/* Follows a ray of a row of fine fours, and keeps it at *next, which moves on. False: the ray meets a side that belongs
 * to no wall. A ray from a wall into the cap of a sphere behind it is left out: beams of the cap tell what the two
 * exchange. */
static bool keep_fine_ray(const fibrad_heat *heat, fibrad_workspace *work, uint32_t body,
                          const fibrad_heat_fine_rays *ray, fibrad_heat_beam **next) {
    const fibrad_scene *scene = heat->scene;
    const bool sphere = body < heat->spheres;
    fibrad_heat_beam *beam = *next;
    fibrad_hit hit;
    double at[3];
    const uint32_t behind = sphere ? fibrad_walls_behind(scene, body, ray->normal, at) : FIBRAD_NONE;
    beam->from = (uint16_t)ray->patch;
    if (behind != FIBRAD_NONE) {
        *next = keep_other(heat, work, ray->k, beam->from, fibrad_heat_wall_patch(heat, behind, at, false), true, beam);
        return true;
    }
    if (sphere)
        LANED(fibrad_trace)(scene, NULL, body, ray->normal, ray->direction, &hit);
    else
        LANED(fibrad_trace_point)(scene, NULL, ray->at, ray->direction, FIBRAD_NO_SIDE, &hit);
    if (hit.sphere != FIBRAD_NONE && !sphere && hit.distance == 0 && scene->container.cuts) return true;
    if (hit.sphere != FIBRAD_NONE && sphere && hit.distance == 0 && fibrad_one_clump(scene, body, hit.sphere))
        return true;
    *next = beam + 1;
    if (hit.sphere != FIBRAD_NONE) {
        const uint32_t patch = fibrad_heat_patch_at(heat, hit.sphere, hit.normal);
        const uint32_t fine = fibrad_heat_fine_number(heat, hit.sphere, patch);
        if (fine != FIBRAD_NONE) {
            *beam = fine_beam(heat, work, ray->k, beam->from, fine);
            return true;
        }
        beam->entry = fibrad_entries_of(&work->entries, hit.sphere),
        beam->to = (uint16_t)(patch - heat->first[hit.sphere]);
        fibrad_entries_add(&work->entries, beam->entry, ray->k, 1);
        return true;
    }
    const double centre[3] = {sphere ? scene->x[body] : 0, sphere ? scene->y[body] : 0, sphere ? scene->z[body] : 0};
    const double origin[3] = {centre[0] + ray->at[0], centre[1] + ray->at[1], centre[2] + ray->at[2]};
    const double length = hit.side != FIBRAD_NO_SIDE ? hit.distance : 0;
    const uint32_t to = fibrad_heat_ends(heat, origin, ray->direction, hit.side, length);
    if (to != FIBRAD_NONE)
        keep_other(heat, work, ray->k, beam->from, to, true, beam);
    else
        work->back = fibrad_side_number(&scene->mesh, hit.side);
    return to != FIBRAD_NONE;
}

/* Follows the beams of window k whose first disc is wrong, as rays. False: as for keep_fine_ray. */
static bool keep_wrong(const fibrad_heat *heat, fibrad_workspace *work, const double frame[9],
                       const fibrad_points *points, uint32_t k, uint32_t word, uint64_t wrong,
                       fibrad_heat_beam **next) {
    const uint16_t *leave = heat->leave + (size_t)k * points->count + HIT_POINTS * word;
    const double r = work->unit;
    for (; wrong != 0; wrong &= wrong - 1) {
        const uint32_t p = HIT_POINTS * word + (uint32_t)__builtin_ctzll(wrong), patch = leave[p - HIT_POINTS * word];
        const double x = points->set.x[p], y = points->set.y[p], up = fibrad_sqrt(fibrad_max(0, 1 - (x * x + y * y)));
        fibrad_heat_fine_rays ray = {.patch = patch, .k = k};
        if (fibrad_heat_is_divided(heat, work->place, patch / FIBRAD_HEAT_FOUR)) continue;
        for (int axis = 0; axis < 3; axis++) {
            ray.normal[axis] = x * frame[axis] + y * frame[3 + axis] + up * frame[6 + axis];
            ray.at[axis] = r * ray.normal[axis], ray.direction[axis] = frame[6 + axis];
        }
        if (!keep_fine_ray(heat, work, work->place, &ray, next)) return false;
    }
    return true;
}

static int follow_beams_of(fibrad_heat *heat, fibrad_workspace *work, uint32_t place) {
    fibrad_heat_beam *const first = work->extra, *beam = first;
    fibrad_points points = {.count = heat->config.points};
    fibrad_disc_points_get(points.count, &points.set);
    work->areas.overflow = false;
    work->windows = heat->config.directions;
    work->extra_owner = 0;
    fibrad_work_begin(work, heat->scene, place, 0, FIBRAD_BEAM_STRIDE);
    /* a turn by chance: the spheres of a lattice, which are all alike, must not all keep the same half */
    const uint32_t turn = (uint32_t)(fibrad_mix(fibrad_scene_rank(heat->scene, place)) & 1);
    for (uint32_t k = 0; k < heat->config.directions; k++) {
        /* spheres that triangles or clumps have hidden so far have not been seen, so that each window may see them for
         * the first time */
        const uint32_t known = heat->triangles > 0 || heat->clumps.some ? 0 : work->entries.length;
        struct hit_window window;
        double frame[9];
        fibrad_beam_frame(k, heat->config.directions, points.count, frame);
        work->entries.end = k == 0 || k + 1 == heat->config.directions;
        LANED(fibrad_beam_window)(work, frame, &points, k);
        if (work->disc.count > work->disc.capacity) return fibrad_work_discs_missed(work);
        for (uint32_t word = 0; word < points.count / HIT_POINTS; word++) {
            const uint64_t kept =
                kept_points(turn + k + word, heat->division.root[place] == FIBRAD_NONE ? heat->thin : 1);
            beam = keep_hits(heat, work, frame, &points, k, word, kept, known, &window, beam);
            beam = keep_meshed(heat, work, frame, &points, k, word, window.inside, beam);
            beam = keep_escapes(heat, work, frame, &points, k, word, kept, beam);
            if (!keep_wrong(heat, work, frame, &points, k, word, window.wrong, &beam)) return FIBRAD_E_BACK;
        }
    }
    if (work->back != UINT32_MAX) return FIBRAD_E_BACK;
    const uint32_t count = fibrad_heat_free_beams(heat, work, (uint32_t)(beam - first));
    if (work->entries.missed > 0) return fibrad_work_entries_missed(work);
    return fibrad_heat_keep(heat, work, place, count);
}

/* Follows the rays of a row of fine fours. */
static int follow_fine_row(fibrad_heat *heat, fibrad_workspace *work, uint32_t row) {
    const uint32_t body = fibrad_heat_body_of_row(heat, row);
    fibrad_heat_beam *const first = work->extra, *beam = first;
    fibrad_heat_fine_rays ray = {.left = 0};
    work->extra_owner = 0;
    fibrad_work_begin(work, heat->scene, body < heat->spheres ? body : 0, 0, FIBRAD_BEAM_STRIDE);
    while (fibrad_heat_fine_ray(heat, row, &ray))
        if (!keep_fine_ray(heat, work, body, &ray, &beam)) return FIBRAD_E_BACK;
    if (work->entries.missed == 0) return fibrad_heat_keep(heat, work, row, (uint32_t)(beam - first));
    work->needed.entries = work->entries.capacity + work->entries.missed;
    return FIBRAD_E_WORK;
}

static int follow_wall_rays(fibrad_heat *heat, fibrad_workspace *work, uint32_t task) {
    int status = FIBRAD_OK;
    for (uint32_t slot = 0; slot < FIBRAD_MESHES + heat->meshes; slot++) {
        const fibrad_heat_rays *sent = &heat->sent[slot];
        uint32_t from = task * FIBRAD_HEAT_TASK, to = from + FIBRAD_HEAT_TASK;
        if (from < sent->first) from = sent->first;
        if (to > sent->first + sent->count) to = sent->first + sent->count;
        for (uint32_t k = from; k < to && status == FIBRAD_OK; k++)
            status = follow_ray(heat, work, slot, k - sent->first, sent->density, &heat->ray[k]);
    }
    return status;
}

int LANED(fibrad_heat_follow)(fibrad_heat *heat, fibrad_workspace *work, uint32_t task) {
    const fibrad_scene *scene = heat->scene;
    if (task < scene->facts.spheres) return follow_beams_of(heat, work, task);
    if (task < heat->rows) return follow_fine_row(heat, work, task);
    return follow_wall_rays(heat, work, task - heat->rows);
}
