/* mesh_share_lanes.c - what triangles take of a window from spheres and from the open part. Compiled once per
 * instruction set. SPDX-License-Identifier: MIT
 *
 * Each point of the window has a line along the direction of the window. The line begins where it leaves sphere i
 * and ends at what it meets first. A sphere loses its visible area times the share of its points that triangles
 * hide. So areas stay exact where no triangle hides them. Lines that meet no sphere get directions of their own if
 * what they meet is far, as lines among walls do: docs/methods.md section 9. */
#include FIBRAD_LANES_HEADER
#include "facing/faces_lanes.h"
#include "facing/lines_lanes.h"
#include "row/mesh_share_lanes.h"
#include "row/wall_window.h"
#include "scene/walls.h"
#include "window/points_lanes.h"

/* The line of a point [L]. */
static void line_of_point(const fibrad_workspace *work, const double frame[9], const fibrad_points *points, uint32_t p,
                          double origin[3], double w[3]) {
    const fibrad_met *met = work->met;
    const double u = points->set.x[p], v = points->set.y[p], s = fibrad_point_exit(points, p);
    for (int axis = 0; axis < 3; axis++) {
        const double *f = frame + axis;
        origin[axis] = work->centre[axis] + work->unit * (u * f[0] + v * f[3] + s * f[6]);
        w[axis] = f[6] + met->aside[0][p] * f[0] + met->aside[1][p] * f[3];
    }
}

/* Whether a line that meets no sphere meets its triangle before any wall. */
static bool before_walls(const fibrad_workspace *work, const double frame[9], const fibrad_points *points, uint32_t p) {
    const fibrad_met *met = work->met;
    double origin[3], w[3], distance;
    if (!work->scene->container.walls || met->depth[p] < -1) return true;
    line_of_point(work, frame, points, p, origin, w);
    fibrad_walls_exit(work->scene, origin, w, &distance);
    return (met->depth[p] - fibrad_point_exit(points, p)) * work->unit < distance;
}

static double depth_of_disc(const fibrad_workspace *work, uint32_t disc) {
    const fibrad_discs *d = &work->disc;
    return d->depth[disc] < 0 ? d->resolved[disc] : d->depth[disc];
}

/* Those of the points given by bits, in word `word`, that meet a triangle before sphere `disc`. The others lose
 * their triangle. */
static uint64_t before_disc(fibrad_workspace *work, const fibrad_points *points, uint32_t word, uint64_t bits,
                            uint32_t disc) {
    fibrad_met *met = work->met;
    const fibrad_discs *d = &work->disc;
    const double depth = depth_of_disc(work, disc), r = d->r[disc];
    uint64_t taken = 0;
    for (uint64_t rest = bits; rest != 0; rest &= rest - 1) {
        const uint32_t p = 64 * word + (uint32_t)__builtin_ctzll(rest);
        if (met->side[p] == FIBRAD_NO_SIDE) continue;
        const double x = points->set.x[p] - d->u[disc], y = points->set.y[p] - d->v[disc];
        if (met->depth[p] < depth - fibrad_sqrt(fibrad_max(0, r * r - x * x - y * y)))
            taken |= UINT64_C(1) << p % 64;
        else
            met->side[p] = FIBRAD_NO_SIDE;
    }
    return taken;
}

static void add_weights(fibrad_met *met, const uint64_t taken[4], double weight) {
    for (uint32_t word = 0; word < 4; word++)
        for (uint64_t rest = taken[word]; rest != 0; rest &= rest - 1)
            met->weight[64 * word + (uint32_t)__builtin_ctzll(rest)] += weight;
}

/* The point that is nearest to the centre of a disc. */
static uint32_t nearest_point(const fibrad_points *points, double u, double v) {
    double least = __builtin_inf();
    uint32_t nearest = 0;
    for (uint32_t p = 0; p < points->count; p++) {
        const double x = points->set.x[p] - u, y = points->set.y[p] - v, square = x * x + y * y;
        if (square < least) least = square, nearest = p;
    }
    return nearest;
}

/* Adds a disc that is seen only between points. The point nearest to it decides whether the disc or a triangle is
 * seen. */
static void share_gap(fibrad_workspace *work, const fibrad_points *points, uint32_t disc, uint32_t k, double area) {
    const fibrad_met *met = work->met;
    const uint32_t p = nearest_point(points, work->disc.u[disc], work->disc.v[disc]);
    if (met->side[p] != FIBRAD_NO_SIDE && met->depth[p] < depth_of_disc(work, disc))
        work->met->weight[p] += area;
    else
        fibrad_work_accumulate(work, disc, k, area);
}

/* The points of a word that are still seen and lie in a disc. They are no longer seen afterwards. */
static uint64_t take_seen(const fibrad_workspace *work, fibrad_points *points, uint32_t word, uint32_t disc) {
    const fibrad_discs *of = &work->disc;
    const uint64_t within = LANED(fibrad_points_within)(points, word, of->u[disc], of->v[disc], of->r[disc]);
    const uint64_t bits = points->seen[word] & within;
    points->seen[word] &= ~bits;
    return bits;
}

/* What triangles take from one disc. area: its visible area; 0: points count. The points of the disc are no longer
 * seen afterwards. Returns the number of its points. If it has no points, nothing is done. */
static uint32_t share_disc(fibrad_workspace *work, fibrad_points *points, uint32_t disc, uint32_t k, double area) {
    uint64_t taken[4] = {0};
    uint32_t own = 0, lost = 0;
    for (uint32_t word = 0; word < points->count / 64; word++) {
        const uint64_t bits = take_seen(work, points, word, disc);
        taken[word] = before_disc(work, points, word, bits, disc);
        own += fibrad_count_bits(bits), lost += fibrad_count_bits(taken[word]);
    }
    if (area > 0 && own > 0) {
        add_weights(work->met, taken, area / own);
        if (lost < own) fibrad_work_accumulate(work, disc, k, lost > 0 ? area / own * (own - lost) : area);
    } else if (lost > 0) {
        add_weights(work->met, taken, 1);
        fibrad_work_accumulate(work, disc, k, -(double)lost);
    }
    return own;
}

/* How wide the directions of open lines spread if the nearest thing that they meet is at some depth. */
static double spread_at(double depth, uint32_t n) {
    const double wide = FIBRAD_WINDOW_SPREAD / fibrad_sqrt(n),
                 ratio = FIBRAD_WINDOW_NEAR / fibrad_max(depth * wide, 1e-300);
    return ratio < 1 && depth < __builtin_inf() ? wide * fibrad_sqrt(1 - ratio * ratio) : 0;
}

static void see_all(fibrad_points *points) {
    for (uint32_t word = 0; word < points->count / 64; word++) points->seen[word] = UINT64_MAX;
}

/* What triangles take from the open part. open: the size of this part. */
static double share_open(fibrad_workspace *work, const double frame[9], fibrad_points *points, uint32_t k,
                         double open) {
    fibrad_met *met = work->met;
    uint64_t taken[4] = {0};
    uint32_t own = 0, lost = 0;
    for (uint32_t p = 0; p < points->count; p++) {
        if ((points->seen[p / 64] >> p % 64 & 1) == 0) continue;
        own++;
        if (met->side[p] == FIBRAD_NO_SIDE) continue;
        if (before_walls(work, frame, points, p))
            taken[p / 64] |= UINT64_C(1) << p % 64, lost++;
        else
            met->side[p] = FIBRAD_NO_SIDE;
    }
    if (own == 0) { /* the part is too small for points: it ends where the deepest line ends */
        const uint32_t slot =
            met->deepest != FIBRAD_NO_SIDE ? fibrad_scene_slot(work->scene, met->deepest) : FIBRAD_NONE;
        if (slot == FIBRAD_NONE) { /* all points share it with the walls alike */
            see_all(points);
            points->open = points->count;
            return open;
        }
        const uint32_t entry = fibrad_entries_of(&work->entries, work->scene->facts.spheres + slot);
        fibrad_entries_add(&work->entries, entry, k, open);
        return 0;
    }
    for (uint32_t word = 0; word < 4; word++) points->seen[word] &= ~taken[word];
    points->open = own - lost;
    add_weights(met, taken, open / own);
    return lost < own ? open / own * (own - lost) : 0;
}

/* Disc number c of those that may be seen in a window. By areas if points->count is 0, otherwise by points.
 * FIBRAD_NONE: the disc is not seen. */
static uint32_t seen_disc(const fibrad_workspace *work, const fibrad_points *points, uint32_t c) {
    if (points->count > 0) return points->occluder[c];
    return c > 0 && work->areas.area[c] > 0 ? work->areas.whose[c] : FIBRAD_NONE;
}

static uint32_t seen_discs(const fibrad_workspace *work, const fibrad_points *points) {
    return points->count > 0 ? points->occluders : work->areas.circles;
}

/* The deepest disc that is seen. FIBRAD_NONE: no disc is seen. */
static uint32_t deepest_disc(const fibrad_workspace *work, const fibrad_points *points) {
    const uint32_t discs = seen_discs(work, points);
    uint32_t deepest = FIBRAD_NONE;
    for (uint32_t c = 0; c < discs; c++) {
        const uint32_t disc = seen_disc(work, points, c);
        if (disc == FIBRAD_NONE) continue;
        if (deepest == FIBRAD_NONE || depth_of_disc(work, disc) > depth_of_disc(work, deepest)) deepest = disc;
    }
    return deepest;
}

/* Whether no triangle comes before a window that sees nothing deeper than a disc. Each part of this window is
 * certainly nearer to sphere i, or to the sphere of the disc, than any triangle is. */
static bool clear_to_disc(const fibrad_workspace *work, uint32_t disc) {
    const fibrad_discs *d = &work->disc;
    const double own = work->clear_mesh * work->clear_mesh - 1, depth = depth_of_disc(work, disc);
    const double aside = 1 + fibrad_sqrt(d->u[disc] * d->u[disc] + d->v[disc] * d->v[disc]);
    const double clear = work->scene->clear[fibrad_work_sphere(work, disc)] * d->r[disc];
    if (!(own > 0 && clear > 0)) return false;
    const double left = fibrad_max(0, depth - fibrad_sqrt(own));
    return left * left + aside * aside < clear * clear * (1 - 1e-9);
}

/* Limits the lines of the points of a disc that are still seen to the depth of the disc. The points are no longer
 * seen afterwards. */
static void limit_points(fibrad_workspace *work, fibrad_points *points, uint32_t disc) {
    const double depth = depth_of_disc(work, disc);
    for (uint32_t word = 0; word < points->count / 64; word++) {
        const uint64_t bits = take_seen(work, points, word, disc);
        for (uint64_t rest = bits; rest != 0; rest &= rest - 1)
            work->met->depth[64 * word + (uint32_t)__builtin_ctzll(rest)] = depth;
    }
}

/* What a search has found before a window. */
typedef struct mesh_found {
    fibrad_face_search search;
    bool listed;   /* whether the list has the first triangles */
    bool more;     /* whether there may be more triangles */
    double spread; /* how wide the directions of open lines spread */
    double at;     /* how deep the things are that open lines meet */
} mesh_found;

/* Lets the lines that are laid out meet all triangles down to a depth. */
static void meet_found(fibrad_workspace *work, mesh_found *found, double deepest) {
    fibrad_lines *lines = &work->met->lines;
    fibrad_face_search *search = &found->search;
    const double spread = lines->parallel > 0 ? 0 : found->spread, slack = search->slack * (1 + spread * found->at);
    bool more = found->more;
    if (!found->listed) {
        LANED(fibrad_faces_begin)(work, search->frame, deepest, 1.0001 * spread, 0, search);
        more = LANED(fibrad_faces_next)(work, search);
    }
    search->most = lines->count / FIBRAD_LINE_BLOCK;
    for (LANED(fibrad_lines_meet)(work, slack); more; LANED(fibrad_lines_meet)(work, slack)) {
        search->deepest = fibrad_min(search->deepest, LANED(fibrad_lines_last)(lines));
        more = LANED(fibrad_faces_next)(work, search);
        found->listed = false;
    }
    if (search->rest < search->deepest) LANED(fibrad_lines_follow)(work, search->frame, search->rest, search->deepest);
}

/* Finds what the lines of all points of a window meet. given: which points the discs hide; the last disc is at depth
 * `last`. Returns whether a line meets a triangle. */
static bool meet_window(fibrad_workspace *work, mesh_found *found, const fibrad_points *given, fibrad_points *points,
                        uint32_t k, double last, bool open) {
    fibrad_met *met = work->met;
    const uint32_t discs = seen_discs(work, given);
    const bool together = found->spread == 0; /* open lines are like the others */
    const double limit = open && together ? __builtin_inf() : -__builtin_inf();
    uint32_t own = 0, meet = 0;
    for (uint32_t p = 0; p < points->count; p++) {
        met->depth[p] = limit, met->side[p] = FIBRAD_NO_SIDE, met->weight[p] = 0;
        met->aside[0][p] = met->aside[1][p] = 0;
    }
    for (uint32_t c = 0; c < discs; c++)
        if (seen_disc(work, given, c) != FIBRAD_NONE) limit_points(work, points, seen_disc(work, given, c));
    for (uint32_t word = 0; word < points->count / 64; word++) own += fibrad_count_bits(points->seen[word]);
    met->deepest = FIBRAD_NO_SIDE;
    if (found->search.shallow <= last || (open && together && own > 0)) {
        LANED(fibrad_lines_parallel)(met, points, met->depth);
        meet_found(work, found, open && together && own > 0 ? __builtin_inf() : last);
        meet += LANED(fibrad_lines_tell)(met);
    }
    if (open && !together && own > 0) {
        LANED(fibrad_lines_spread)(met, points, points->seen, k, found->spread, found->at);
        meet_found(work, found, __builtin_inf());
        meet += LANED(fibrad_lines_tell)(met);
    }
    if (open && own == 0) { /* the part is too small for points: it ends where the deepest line ends */
        LANED(fibrad_lines_parallel)(met, points, NULL);
        meet_found(work, found, __builtin_inf());
        met->deepest = LANED(fibrad_lines_deepest)(&met->lines);
    }
    return meet > 0 || met->deepest != FIBRAD_NO_SIDE;
}

/* Searches for triangles before a window down to a depth. False: there are none. */
static bool find_faces(fibrad_workspace *work, const double frame[9], double deepest, bool open, mesh_found *found) {
    fibrad_face_search *search = &found->search;
    const bool spreads = open && !work->turned;
    const double wide = spreads ? 1.0001 * FIBRAD_WINDOW_SPREAD / fibrad_sqrt(work->windows) : 0;
    const double near = spreads ? FIBRAD_WINDOW_NEAR / wide : __builtin_inf();
    LANED(fibrad_faces_begin)(work, frame, deepest, wide, near, search);
    found->more = LANED(fibrad_faces_next)(work, search);
    found->listed = true;
    while (found->more && !(search->nearest < near)) {
        search->deepest = fibrad_min(search->deepest, search->nearest);
        found->more = LANED(fibrad_faces_next)(work, search);
        found->listed = false;
    }
    found->at = fibrad_min(search->nearest, search->rest); /* beyond this depth nothing has been searched */
    found->spread = spreads ? spread_at(found->at, work->windows) : 0;
    if (found->more || !found->listed || search->rest < __builtin_inf()) search->shallow = -__builtin_inf();
    return found->at < __builtin_inf();
}

/* The number of points that a window by areas uses if there are n windows. */
static uint32_t points_of(uint32_t n) { return n <= 600 ? 64 : n <= 1400 ? 128 : 256; }

double LANED(fibrad_mesh_share)(fibrad_workspace *work, const double frame[9], fibrad_points *points, uint32_t k,
                                double open) {
    fibrad_met *met = work->met;
    const bool by_areas = points->count == 0;
    fibrad_points *used = by_areas ? &met->points : points;
    const uint32_t disc = deepest_disc(work, points);
    const double last = disc != FIBRAD_NONE ? depth_of_disc(work, disc) : 0;
    const double deepest = open > 0 ? __builtin_inf() : last;
    mesh_found found;
    if (!fibrad_mesh_near(work, deepest)) return open;
    if (!(open > 0) && disc != FIBRAD_NONE && clear_to_disc(work, disc)) return open;
    if (!find_faces(work, frame, deepest, open > 0, &found)) return open;
    met->points.count = by_areas ? points_of(work->windows) : points->count;
    (void)fibrad_disc_points_get(met->points.count, &met->points.set);
    see_all(used);
    met->any = meet_window(work, &found, points, used, k, last, open > 0) || found.spread > 0;
    if (!met->any) return open;
    const uint32_t discs = seen_discs(work, points);
    uint32_t *own = work->disc.hidden_points; /* for windows by points only */
    see_all(used);
    for (uint32_t c = 0; c < discs; c++)
        if (seen_disc(work, points, c) != FIBRAD_NONE)
            own[c] = share_disc(work, used, seen_disc(work, points, c), k, by_areas ? work->areas.area[c] : 0);
    const double rest = open > 0 ? share_open(work, frame, used, k, open) : 0;
    for (uint32_t c = 0; by_areas && c < discs; c++)
        if (seen_disc(work, points, c) != FIBRAD_NONE && own[c] == 0)
            share_gap(work, used, seen_disc(work, points, c), k, work->areas.area[c]);
    return rest;
}

void LANED(fibrad_mesh_line)(const fibrad_workspace *work, const double frame[9], uint32_t p, double origin[3],
                             double w[3]) {
    line_of_point(work, frame, &work->met->points, p, origin, w);
}

void LANED(fibrad_mesh_place)(const fibrad_workspace *work, const double frame[9], uint32_t p, double at[3]) {
    const fibrad_met *met = work->met;
    const bool cut = met->depth[p] < -1; /* the triangle lies on the way from the centre to the surface */
    double origin[3], w[3];
    line_of_point(work, frame, &met->points, p, origin, w);
    for (int axis = 0; axis < 3; axis++) {
        const double centre = work->centre[axis];
        at[axis] = cut ? centre + (met->depth[p] + 2) * (origin[axis] - centre)
                       : origin[axis] + (met->depth[p] - fibrad_point_exit(&met->points, p)) * work->unit * w[axis];
    }
}

/* The slot at which a line from the point p ends that meets a triangle at its depth. */
static uint32_t slot_along(const fibrad_workspace *work, uint32_t p, const double origin[3], const double w[3]) {
    const fibrad_met *met = work->met;
    double from[3], distance;
    for (int axis = 0; axis < 3; axis++) from[axis] = (origin[axis] - work->centre[axis]) * work->inverse;
    const double length = (met->depth[p] - fibrad_point_exit(&met->points, p)) * work->unit;
    const double ball = fibrad_ball_exit(from, w, work->reach) * work->unit;
    return fibrad_surroundings_side(work->scene, origin, w, ball, met->side[p], length, &distance);
}

/* The slot of what a line meets. This may be beyond the cutoff. */
static uint32_t slot_met(const fibrad_workspace *work, const double frame[9], uint32_t p) {
    double origin[3], w[3];
    if (!work->cut || work->met->depth[p] < -1) return fibrad_scene_slot(work->scene, work->met->side[p]);
    line_of_point(work, frame, &work->met->points, p, origin, w);
    const uint32_t met = slot_along(work, p, origin, w);
    if (work->scene->occupancy.mark == NULL) return met;
    return fibrad_surroundings_of_window(met, slot_along(work, p, origin, frame + 6));
}

void LANED(fibrad_mesh_count)(fibrad_workspace *work, const double frame[9], uint32_t k) {
    const fibrad_scene *scene = work->scene;
    fibrad_met *met = work->met;
    const fibrad_points *points = &met->points;
    double weight[FIBRAD_SLOTS] = {0}; /* added as one term, which is rounded once */
    for (uint32_t p = 0; p < points->count; p++) {
        const uint32_t side = met->side[p];
        if (side == FIBRAD_NO_SIDE) continue;
        const uint32_t slot = slot_met(work, frame, p);
        if (slot == FIBRAD_NONE) {
            if (work->back == UINT32_MAX) work->back = fibrad_side_number(&scene->mesh, side);
            continue;
        }
        weight[slot] += met->weight[p];
    }
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++)
        if (weight[slot] != 0)
            fibrad_entries_add(&work->entries, fibrad_entries_of(&work->entries, scene->facts.spheres + slot), k,
                               weight[slot]);
}
