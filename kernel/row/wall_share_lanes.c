/* wall_share_lanes.c - which walls the open part of a window meets. Compiled once per instruction set.
 * SPDX-License-Identifier: MIT
 *
 * A window has one direction, but it stands for all directions that are nearest to its own. For far walls only the
 * direction counts: with one direction per window their factors would jump, and the error would fall as n^-0.75. So
 * each open point of the window has a direction of its own, from a disc of directions about that of the window.
 * These discs together cover the sphere about once. The open part of a window changes with the direction, to first
 * order by its slope. So a wall gets two terms: the open part times its share of the lines, and the slope times the
 * difference between the mean direction of its lines and that of all lines. docs/methods.md section 9. */
#include FIBRAD_LANES_HEADER
#include "row/wall_share_lanes.h"
#include "row/wall_window.h"
#include "ray/tracer.h"
#include "sample/direction.h"
#include "window/points_lanes.h"

#define WALL_POINTS   128u
#define HORIZON_LINES 6   /* lines that are followed across the horizon, about */
#define HIDDEN_POINTS 64u /* of windows without an open part */

/* Rotates the axes u and v of a frame. Coordinates in the frame rotate the other way. */
static void rotate_frame(double frame[9], double cos, double sin) {
    for (int axis = 0; axis < 3; axis++) {
        double u = frame[axis], v = frame[3 + axis];
        frame[axis] = cos * u + sin * v, frame[3 + axis] = cos * v - sin * u;
    }
}

/* All points of a window, all open. */
static void all_points(uint32_t count, fibrad_points *points) {
    points->count = points->open = count;
    for (uint32_t word = 0; word < count / 64; word++) points->seen[word] = UINT64_MAX;
    (void)fibrad_disc_points_get(count, &points->set);
}

/* The points of the window that no disc of `work` covers. If there is no such point, all points. */
static void open_points(const fibrad_workspace *work, double cos, double sin, fibrad_points *points) {
    const fibrad_discs *disc = &work->disc;
    all_points(WALL_POINTS, points);
    for (uint32_t k = 0; k < disc->count && points->open > 0; k++) {
        double u = disc->u[k], v = disc->v[k];
        LANED(fibrad_points_disc)(points, cos * u + sin * v, cos * v - sin * u, disc->r[k]);
    }
    if (points->open == 0) all_points(WALL_POINTS, points);
}

/* Lines in the frame of sphere i. */
typedef struct wall_lines {
    vd origin[3], w[3];
    vd wide[3];           /* directions that fill the whole disc; they decide the octant */
    vd u, v;              /* difference of w from the direction of the window */
    vd away[3], rate[3];  /* distances of the walls ahead, and how fast lines approach them */
    vd share[4], nearest; /* share of the planes across each axis and of the cylinder; length to the nearest wall */
} wall_lines;

static vd quotient(vd a, vd b) {
    vm none = vd_le(b, vd_set1(0));
    return vd_select(none, vd_set1(__builtin_inf()), a / vd_select(none, vd_set1(1), b));
}

/* The share of the first of two walls. It is between 0 and 1 for lines that pass near the edge between the walls. */
static vd share_at_edge(vd passing, double sharpness) {
    return 0.5 + 0.5 * vd_max(vd_set1(-1), vd_min(vd_set1(1), passing * sharpness));
}

/* The shares of the end of a cylinder and of the cylinder. */
static void share_round(const fibrad_wall_window *window, const fibrad_wall_view *view, wall_lines *lines) {
    const vd zero = vd_set1(0), away = lines->away[2], rate = lines->rate[2];
    vd x = lines->origin[0] - view->axis[0], y = lines->origin[1] - view->axis[1];
    vd along = x * rate + lines->w[0] * away, across = y * rate + lines->w[1] * away;
    vd end = share_at_edge(view->radius * rate - vd_sqrt(along * along + across * across), window->sharpness[2]);
    lines->share[0] = lines->share[1] = zero;
    lines->share[2] = vd_select(vd_lt(away, vd_set1(FIBRAD_FAR_AWAY)), end, zero);
    lines->share[3] = 1 - lines->share[2];
}

/* The shares of three planes. A plane gets what it comes before both others. Near a corner a part is left, which all
 * three share. A plane that does not exist comes last. */
FIBRAD_INLINE void share_planes(const fibrad_wall_window *window, wall_lines *lines) {
    const vd zero = vd_set1(0), half = vd_set1(0.5), one = vd_set1(1), far = vd_set1(FIBRAD_FAR_AWAY);
    const vd *away = lines->away, *rate = lines->rate;
    vd first[3], left = one; /* share of axis a before axis a + 1 */
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3;
        vm a_far = vd_le(far, away[a]), b_far = vd_le(far, away[b]);
        vd share = share_at_edge(away[b] * rate[a] - away[a] * rate[b], window->sharpness[a]);
        first[a] = vd_select(a_far, vd_select(b_far, half, zero), vd_select(b_far, one, share));
    }
    for (int a = 0; a < 3; a++) {
        lines->share[a] = first[a] * (1 - first[(a + 2) % 3]);
        left = left - lines->share[a];
    }
    for (int a = 0; a < 3; a++) lines->share[a] += left * (1.0 / 3);
    lines->share[3] = zero;
}

/* The length of lines within the cylinder. */
static vd exit_cylinder(const fibrad_wall_view *view, const wall_lines *lines) {
    const vd zero = vd_set1(0);
    vd x = lines->origin[0] - view->axis[0], y = lines->origin[1] - view->axis[1];
    vd across = lines->w[0] * lines->w[0] + lines->w[1] * lines->w[1], along = x * lines->w[0] + y * lines->w[1];
    vd inside = view->radius * view->radius - (x * x + y * y);
    vd root = vd_sqrt(vd_max(along * along + across * inside, zero));
    vm ahead = vd_lt(zero, along);
    return quotient(vd_select(ahead, inside, root - along), vd_select(ahead, along + root, across));
}

/* Which walls lines meet. */
FIBRAD_INLINE void meet_walls(const fibrad_wall_window *window, const fibrad_wall_view *view, bool round,
                              wall_lines *lines) {
    for (int axis = 0; axis < 3; axis++) {
        vd w = lines->w[axis], o = lines->origin[axis];
        vd away = vd_select(vd_lt(w, vd_set1(0)), o - view->low[axis], view->high[axis] - o);
        lines->rate[axis] = vd_abs(w), lines->away[axis] = vd_min(vd_set1(FIBRAD_FAR_AWAY), away);
    }
    if (round)
        share_round(window, view, lines);
    else
        share_planes(window, lines);
    if (!view->cut) return;
    lines->nearest = vd_set1(__builtin_inf());
    if (round) lines->nearest = exit_cylinder(view, lines);
    for (int axis = 0; axis < 3; axis++) {
        vd length = quotient(lines->away[axis], lines->rate[axis]);
        lines->nearest = vd_min(length, lines->nearest);
    }
}

/* The length at which lines leave the ball of the cutoff. */
static vd exit_ball(const fibrad_wall_view *view, const vd origin[3], const vd w[3]) {
    const vd zero = vd_set1(0);
    if (!(view->ball < __builtin_inf())) return vd_set1(__builtin_inf());
    vd along = origin[0] * w[0] + origin[1] * w[1] + origin[2] * w[2];
    vd square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    vd inside = view->ball * view->ball - (origin[0] * origin[0] + origin[1] * origin[1] + origin[2] * origin[2]);
    return vd_max((vd_sqrt(vd_max(along * along + square * inside, zero)) - along) / square, zero);
}

/* One of the lines in a vector. */
static fibrad_wall_line line_of_lane(const fibrad_wall_view *view, const wall_lines *lines, int lane) {
    _Alignas(64) double at[VD_LANES], along[VD_LANES];
    fibrad_wall_line line;
    for (uint32_t a = 0; a < 3; a++) {
        const uint32_t axis = fibrad_cylinder_axis(view->turn, a);
        vd_store(at, lines->origin[a]);
        vd_store(along, lines->w[a]);
        line.origin[axis] = at[lane], line.w[axis] = along[lane];
    }
    return line;
}

static void begin_sums(const fibrad_wall_window *window, const fibrad_wall_view *view, fibrad_point_sums *sums) {
    sums->octants = 0;
    for (uint32_t octant = 0; octant < 8; octant++) {
        if (!fibrad_wall_window_has(window, view, octant)) continue;
        fibrad_octant_sums *part = &sums->part[sums->octants++];
        fibrad_zero(part, sizeof *part);
        part->octant = octant;
    }
    for (uint32_t wall = 0; wall <= FIBRAD_WALLS; wall++) sums->cuts[wall] = 0;
}

static inline void add_lanes(double *at, vd x) { vd_store(at, vd_load(at) + x); }

/* 1 where x has the sign of an octant along an axis, else 0. */
static vd on_side(vd x, uint32_t octant, uint32_t axis) {
    const uint32_t up = octant >> axis & 1;
    return vd_select(vd_lt(x, vd_set1(0)), vd_set1(1 - up), vd_set1(up));
}

/* Adds the lines of an octant. Which wall they meet depends on w. If there are several octants, `wide` decides the
 * octant along axes other than that of the wall. So a wall nearby gets lines of both octants. hidden: adds to `all`
 * only. */
FIBRAD_INLINE void add_octant(const wall_lines *lines, bool round, bool several, bool hidden, vd weight, uint32_t place,
                              fibrad_octant_sums *part) {
    const uint32_t begin = round ? 2 : 0, end = round ? 4 : 3;
    vd own[3], wide[3];
    for (uint32_t axis = 0; axis < 3; axis++) own[axis] = wide[axis] = vd_set1(1);
    for (uint32_t axis = begin; axis < 3 && several; axis++) {
        own[axis] = on_side(lines->w[axis], part->octant, axis);
        wide[axis] = on_side(lines->wide[axis], part->octant, axis);
    }
#pragma GCC unroll 3
    for (uint32_t n = begin; n < end; n++) {
        vd all = lines->share[n];
        for (uint32_t axis = begin; axis < 3 && several; axis++) {
            if (axis == n)
                all = all * own[axis];
            else
                all = all * wide[axis];
        }
        add_lanes(part->all[n] + place, all);
        if (hidden) continue;
        vd open = all * weight;
        add_lanes(part->open[n] + place, open);
        add_lanes(part->u[n] + place, open * lines->u);
        add_lanes(part->v[n] + place, open * lines->v);
    }
}

/* Counts the lines given by bits. These lines are cut. */
static void add_cuts(const fibrad_wall_view *view, const wall_lines *lines, uint32_t bits, fibrad_point_sums *sums) {
    for (; bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        const fibrad_wall_line line = line_of_lane(view, lines, lane);
        uint32_t wall = FIBRAD_WALLS;
        double most = 0;
        for (uint32_t n = 0; n < 4; n++) {
            _Alignas(64) double share[VD_LANES];
            vd_store(share, lines->share[n]);
            if (!(share[lane] > most)) continue;
            const bool up = n < 3 && line.w[fibrad_cylinder_axis(view->turn, n)] >= 0;
            const bool there = n == 3 || (up ? view->high[n] : -view->low[n]) < __builtin_inf();
            most = share[lane];
            wall = n == 3 ? FIBRAD_CYLINDER : there ? fibrad_face(n, up) : FIBRAD_WALLS;
        }
        if (sums->cuts[wall]++ == 0) sums->first_cut[wall] = line;
    }
}

/* Sets the weight of open lines that are cut to 0, and counts them. */
static vd weight_uncut(const fibrad_wall_view *view, const wall_lines *lines, vd weight, fibrad_point_sums *sums) {
    vm cut = vd_lt(exit_ball(view, lines->origin, lines->w), lines->nearest);
    add_cuts(view, lines, vm_bits(cut & vd_lt(vd_set1(0), weight)), sums);
    return vd_select(cut, vd_set1(0), weight);
}

/* Traces the points of a window in directions from its disc. */
FIBRAD_INLINE void follow_points(const fibrad_points *points, const fibrad_wall_view *view, bool round,
                                 const double frame[9], const fibrad_wall_window *window, fibrad_point_sums *sums) {
    const bool hidden = window->open == 0, several = sums->octants > 1;
    for (uint32_t word = 0; word < points->count / 64; word++) {
        _Alignas(64) float a[64], b[64], open[64];
        for (uint32_t lane = 0; lane < 64; lane++) {
            const uint32_t q = fibrad_points_partner(points->count, 64 * word + lane, window->k);
            a[lane] = points->set.x[q], b[lane] = points->set.y[q];
            open[lane] = (float)(int32_t)(points->seen[word] >> lane & 1);
        }
        for (uint32_t lane = 0; lane < 64; lane += VD_LANES) {
            const uint32_t p = 64 * word + lane;
            vd u = vd_load_float(points->set.x + p), v = vd_load_float(points->set.y + p);
            vd aside_u = vd_load_float(a + lane), aside_v = vd_load_float(b + lane),
               weight = vd_load_float(open + lane);
            wall_lines lines; /* no initial value: clearing it took a tenth of the time of walls */
            lines.u = aside_u * window->spread, lines.v = aside_v * window->spread;
            for (int axis = 0; axis < 3; axis++) {
                vd along_u = vd_set1(frame[axis]), along_v = vd_set1(frame[3 + axis]);
                vd aside = aside_u * along_u + aside_v * along_v;
                lines.origin[axis] = u * along_u + v * along_v;
                lines.w[axis] = frame[6 + axis] + aside * window->spread;
                lines.wide[axis] = frame[6 + axis] + aside * window->wide;
            }
            meet_walls(window, view, round, &lines);
            if (view->cut && !hidden) weight = weight_uncut(view, &lines, weight, sums);
            for (uint32_t part = 0; part < sums->octants; part++)
                add_octant(&lines, round, several, hidden, weight, lane % 8, &sums->part[part]);
        }
    }
}

static double of_eight(const double *s) { return ((s[0] + s[4]) + (s[1] + s[5])) + ((s[2] + s[6]) + (s[3] + s[7])); }

/* Adds to the regions what the points of a window tell. The open part is divided in proportion to open points. To
 * this is added the slope times the difference between the mean direction of a wall's points and that of all points,
 * limited so that no region gets less than nothing. */
static void add_points(fibrad_wall_room *walls, const fibrad_points *points, const fibrad_wall_window *window,
                       const double slope[2]) {
    const fibrad_point_sums *sums = &walls->window;
    double shares = 0, mean_u = 0, mean_v = 0;
    for (uint32_t part = 0; part < sums->octants; part++)
        for (int n = 0; n < 4; n++) {
            shares += of_eight(sums->part[part].open[n]);
            mean_u += of_eight(sums->part[part].u[n]), mean_v += of_eight(sums->part[part].v[n]);
        }
    if (shares > 0) mean_u /= shares, mean_v /= shares;
    const double steepest = 1.5 * window->spread * fibrad_sqrt(slope[0] * slope[0] + slope[1] * slope[1]);
    const double counts = steepest > window->open ? window->open / steepest : 1, each = 1.0 / points->open;
    for (uint32_t part = 0; part < sums->octants; part++)
        for (uint32_t n = walls->view.round ? 2 : 0; n < (walls->view.round ? 4u : 3u); n++) {
            const fibrad_octant_sums *of = &sums->part[part];
            const double open = of_eight(of->open[n]), all = of_eight(of->all[n]) / points->count;
            const double u = of_eight(of->u[n]) - open * mean_u, v = of_eight(of->v[n]) - open * mean_v;
            const double got = (window->open * open + counts * (slope[0] * u + slope[1] * v)) * each;
            fibrad_wall_window_add(window, 4 * of->octant + n, got, all, &walls->sums);
        }
}

/* The slot at which a line ends that is cut. */
static uint32_t end_of_cut(const fibrad_workspace *work, const fibrad_wall_line *line, const double direction[3]) {
    const uint32_t met = fibrad_work_met(work, line->origin, line->w, work->walls->view.ball);
    if (work->scene->occupancy.mark == NULL) return met;
    return fibrad_surroundings_of_window(met, fibrad_work_met(work, line->origin, direction, work->reach));
}

/* Divides a window between walls by lines. */
static void share_by_lines(fibrad_workspace *work, const fibrad_points *points, fibrad_wall_window *window) {
    fibrad_wall_room *walls = work->walls;
    fibrad_wall_window_sharpen(window, &walls->view);
    fibrad_point_sums *sums = &walls->window;
    double axes[9], cos = 1, sin = 0;
    fibrad_copy(axes, window->frame, sizeof axes);
    if (points->count == 0) {
        fibrad_azimuth(5 * window->k % FIBRAD_DIRECTIONS_MAX, &cos, &sin);
        rotate_frame(axes, cos, sin);
        open_points(work, cos, sin, &walls->points);
        points = &walls->points;
    }
    const double slope[2] = {cos * window->slope[0] + sin * window->slope[1],
                             cos * window->slope[1] - sin * window->slope[0]};
    begin_sums(window, &walls->view, sums);
    if (walls->view.round)
        follow_points(points, &walls->view, true, axes, window, sums);
    else
        follow_points(points, &walls->view, false, axes, window, sums);
    add_points(walls, points, window, slope);
    for (uint32_t wall = 0; wall <= FIBRAD_WALLS; wall++) {
        if (sums->cuts[wall] == 0)
            continue; /* the way of one line decides for all lines that would meet the same wall */
        const fibrad_wall_line *first = &sums->first_cut[wall];
        fibrad_work_slot(work, end_of_cut(work, first, window->direction),
                         window->open * sums->cuts[wall] / points->open);
    }
}

bool LANED(fibrad_beam_turned)(const fibrad_workspace *work, const double frame[9], const double p[2],
                               const double way[3]) {
    const double *u = frame, *v = frame + 3, *w = frame + 6;
    const double up = fibrad_sqrt(fibrad_max(0, 1 - (p[0] * p[0] + p[1] * p[1])));
    double n[3], along = 0, cosine = 1;
    fibrad_hit hit;
    for (int k = 0; k < 3; k++) {
        n[k] = p[0] * u[k] + p[1] * v[k];
        along += n[k] * way[k], cosine += w[k] * way[k];
    }
    for (int k = 0; k < 3; k++) n[k] += up * way[k] - along / cosine * (w[k] + way[k]);
    LANED(fibrad_trace)(work->scene, NULL, work->place, n, way, &hit);
    return hit.sphere == FIBRAD_NONE && hit.side == FIBRAD_NO_SIDE;
}

/* The part of the lines of a band across the horizon that meet nothing. What is open may end there: a sphere on top of
 * a wide bed sees the sky above the horizon and other spheres below it. So some lines are followed, from open points.
 * The more of the band lies there, the more lines. */
static double part_through(fibrad_workspace *work, const double frame[9], const fibrad_points *points,
                           const fibrad_wall_window *window) {
    const int axis = work->walls->view.only;
    const double level = frame[6 + axis], x = fibrad_abs(level) / window->band;
    const uint32_t lines = 1 + (uint32_t)(HORIZON_LINES * (1 - x) * (1 - x));
    double free = 0, all = 0;
    if (points->count == 0) open_points(work, 1, 0, &work->walls->points), points = &work->walls->points;
    for (uint32_t p = 0, seen = 0, line = 0; p < points->count && line < lines; p++) {
        if ((points->seen[p / 64] >> p % 64 & 1) == 0 || ++seen * lines < (line + 1) * points->open) continue;
        const double at[2] = {points->set.x[p], points->set.y[p]};
        const double away = (1 - x) * (line++ + 0.5) / lines, t = x + away, weight = (1 - t * t) * (1 - t * t);
        const double to = level > 0 ? -away * window->band : away * window->band;
        const double flat = fibrad_sqrt((1 - to * to) / (1 - level * level));
        double way[3];
        for (int k = 0; k < 3; k++) way[k] = k == axis ? to : flat * frame[6 + k];
        if (LANED(fibrad_beam_turned)(work, frame, at, way)) free += weight;
        all += weight;
    }
    return all > 0 ? free / all : 0;
}

/* Adds a window of which the fields from `k` to `slope` are set. */
static void share_window(fibrad_workspace *work, const double frame[9], const fibrad_points *points,
                         fibrad_wall_window *window) {
    fibrad_wall_room *walls = work->walls;
    fibrad_wall_window_begin(window, &walls->view, frame);
    window->band = fibrad_wall_window_band(window, &walls->view, work->turned);
    if (window->band > 0 && window->open > 0) window->through = part_through(work, frame, points, window);
    if (!fibrad_wall_window_simple(window, &walls->view, &walls->sums)) share_by_lines(work, points, window);
}

void LANED(fibrad_walls_share)(fibrad_workspace *work, const double frame[9], const fibrad_points *points, uint32_t k,
                               const fibrad_window_set *set, double rest, double whole) {
    if (rest == 0) {
        work->walls->sums.hidden[k / 64] |= UINT64_C(1) << k % 64;
        return;
    }
    fibrad_wall_window window = {.k = k, .n = set->directions, .open = rest, .part = 1};
    window.weight = whole / set->whole;
    window.end = work->entries.end;
    window.parallel = work->parallel;
    window.hidden = fibrad_max(0, whole - rest);
    if (points->count > 0) window.part = 0.4 + 0.6 * rest / whole;
    if (work->walls->view.cut)
        window.part *= 1.25; /* there is no solid angle here that corrects the unevenness of the discs */
    if (points->count == 0 && work->walls->view.only == 3)
        fibrad_areas_slope(&work->areas, work->disc.resolved, window.slope);
    for (int axis = 0; axis < 2; axis++) window.slope[axis] *= whole / FIBRAD_PI;
    share_window(work, frame, points, &window);
}

/* Adds to `all` of the regions what hidden windows would see. */
static void add_hidden(fibrad_workspace *work, const fibrad_window_set *set) {
    fibrad_points *all = &work->walls->points;
    all_points(HIDDEN_POINTS, all);
    for (uint32_t k = 0; k < set->directions; k++) {
        if ((work->walls->sums.hidden[k / 64] >> k % 64 & 1) == 0) continue;
        double frame[9];
        set->frame(set->from, k, HIDDEN_POINTS, frame);
        fibrad_wall_window window = {.k = k, .n = set->directions, .hidden = 1, .weight = 1, .part = 1};
        window.end = set->ends && (k == 0 || k == set->directions - 1);
        share_window(work, frame, all, &window);
    }
}

void LANED(fibrad_walls_complete)(fibrad_workspace *work, const fibrad_window_set *set, double parts[2]) {
    double open = 0;
    for (uint32_t region = 0; region < FIBRAD_REGIONS; region++)
        for (int part = 0; part < 4; part++) open += work->walls->sums.open[region][part];
    parts[0] = parts[1] = 0;
    if (!(open > 0)) return;
    const double apart = work->parallel ? 0 : fibrad_wall_apart(&work->walls->view);
    if (apart > 0) add_hidden(work, set);
    fibrad_wall_factors(&work->walls->sums, &work->walls->view, set->directions, apart, work->wall, parts);
}
