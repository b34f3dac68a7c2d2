/* wall_share_lanes.c - which walls the open part of a window meets. Compiled once per instruction set.
 * SPDX-License-Identifier: MIT
 *
 * A window has one direction, but stands for all that are nearer to its own than to others. Far walls differ by
 * direction alone: with one direction their factors would jump, and err as n^-0.75. Therefore each open point of the
 * window is traced in a direction of its own, from a disc about that of the window; such discs cover the sphere about
 * once. Where spheres hide part of a window, its neighbours are hidden in part too, and the disc is smaller, or walls
 * would be visible that are hidden. The open area does not depend on this. docs/methods.md section 9. */
#include FIBRAD_LANES_HEADER
#include "base/constants.h"
#include "row/wall_share_lanes.h"
#include "sample/direction.h"
#include "scene/walls.h"
#include "window/points_lanes.h"

#define WALL_POINTS 128u

/* Radius of the disc of directions, times sqrt n, if the window is open; for discs as large as the share of a direction
 * in the sphere it would be 2. */
#define WALL_SPREAD 2.25

/* Half width of the band, likewise. F to a plane across x or y then errs by 4e-4 at n = 233. */
#define WALL_BAND 4.0

/* Walls across one axis only, and a window that stands for a band of directions of some half width: the share of the
 * band that rises along the axis, with weights (1 - x^2)^2 over it. */
static double rising_share(double slope, double width) {
    if (!(fibrad_abs(slope) < width)) return slope > 0 ? 1 : slope < 0 ? 0 : 0.5;
    double x = slope / width, square = x * x;
    return 0.5 + 15.0 / 16 * x * (1 - square * (2.0 / 3 - square / 5));
}

/* The only axis with walls, or 3. */
static int only_axis(const fibrad_container *c) {
    int only = 3, axes = c->radius < __builtin_inf() ? 2 : 0;
    for (int axis = 0; axis < 3; axis++)
        if (c->low[axis] > -__builtin_inf() || c->high[axis] < __builtin_inf()) only = axis, axes++;
    return axes == 1 ? only : 3;
}

/* Rotates the axes u, v of a frame; coordinates in it rotate the other way. */
static void rotate_frame(double frame[9], double cos, double sin) {
    for (int axis = 0; axis < 3; axis++) {
        double u = frame[axis], v = frame[3 + axis];
        frame[axis] = cos * u + sin * v, frame[3 + axis] = cos * v - sin * u;
    }
}

/* The points of the window that no disc of `work` covers; all of them if there is none. */
static fibrad_points open_points_of(const fibrad_workspace *work, double cos, double sin) {
    fibrad_points points = {.count = WALL_POINTS, .open = WALL_POINTS, .seen = {UINT64_MAX, UINT64_MAX}};
    (void)fibrad_disc_points_get(WALL_POINTS, &points.set);
    const fibrad_discs *disc = &work->disc;
    for (uint32_t k = 0; k < disc->count && points.open > 0; k++) {
        double u = disc->u[k], v = disc->v[k];
        LANED(fibrad_points_disc)(&points, cos * u + sin * v, cos * v - sin * u, disc->r[k]);
    }
    if (points.open == 0) points.open = WALL_POINTS, points.seen[0] = points.seen[1] = UINT64_MAX;
    return points;
}

/* The walls, and where lines are cut, in the frame of sphere i: in units of its radius, from its centre. */
typedef struct wall_view {
    double low[3], high[3], axis[2], radius;
    bool cut;
    double known_low[3], known_high[3], ball; /* the radius of the latter */
} wall_view;

static wall_view wall_view_of(const fibrad_workspace *work) {
    const fibrad_scene *scene = work->scene;
    const fibrad_container *c = &scene->container;
    wall_view view = {.radius = c->radius * work->inverse, .cut = work->cut, .ball = work->reach};
    for (int axis = 0; axis < 3; axis++) {
        view.low[axis] = (c->low[axis] - work->centre[axis]) * work->inverse;
        view.high[axis] = (c->high[axis] - work->centre[axis]) * work->inverse;
        view.known_low[axis] = (scene->known_low[axis] - work->centre[axis]) * work->inverse;
        view.known_high[axis] = (scene->known_high[axis] - work->centre[axis]) * work->inverse;
        if (!(view.known_low[axis] <= 0 && view.known_high[axis] >= 0)) view.ball = 0; /* i lies outside itself */
    }
    for (int axis = 0; axis < 2; axis++) view.axis[axis] = (c->axis[axis] - work->centre[axis]) * work->inverse;
    return view;
}

/* How far lines go along an axis until they leave [low, high]. */
static vd exit_slab(double low, double high, vd origin, vd w) {
    const vd zero = vd_set1(0);
    vm level = vd_le(vd_abs(w), zero);
    vd at = vd_select(vd_lt(w, zero), vd_set1(low), vd_set1(high));
    return vd_select(level, vd_set1(__builtin_inf()), (at - origin) / vd_select(level, vd_set1(1), w));
}

/* The walls through which lines leave, as fibrad_walls_exit has it for one, and how far it is to them. */
static vd exit_walls(const wall_view *view, const vd origin[3], const vd w[3], vd *distance) {
    const vd zero = vd_set1(0);
    vd least = vd_set1(__builtin_inf()), wall = vd_set1(FIBRAD_WALLS);
    for (int axis = 0; axis < 3; axis++) {
        vd t = exit_slab(view->low[axis], view->high[axis], origin[axis], w[axis]);
        vm nearer = vd_lt(t, least);
        vd number = vd_select(vd_lt(w[axis], zero), vd_set1(2 * axis), vd_set1(2 * axis + 1));
        least = vd_select(nearer, t, least), wall = vd_select(nearer, number, wall);
    }
    *distance = least;
    if (!(view->radius < __builtin_inf())) return wall;
    vd x = origin[0] - view->axis[0], y = origin[1] - view->axis[1];
    vd across = w[0] * w[0] + w[1] * w[1], along = x * w[0] + y * w[1];
    vd inside = view->radius * view->radius - (x * x + y * y);
    vd root = vd_sqrt(vd_max(along * along + across * inside, zero));
    vm away = vd_lt(zero, along), level = vd_le(across, zero);
    vd t = vd_select(away, inside, root - along) / vd_select(away, along + root, across);
    vm nearer = vd_lt(vd_select(level, vd_set1(__builtin_inf()), t), least);
    *distance = vd_select(nearer, t, least);
    return vd_select(nearer, vd_set1(FIBRAD_CYLINDER), wall);
}

/* How far it is to where lines leave the ball and the known region. */
static vd exit_known(const wall_view *view, const vd origin[3], const vd w[3]) {
    const vd zero = vd_set1(0);
    vd least = vd_set1(__builtin_inf());
    if (view->ball < __builtin_inf()) {
        vd along = origin[0] * w[0] + origin[1] * w[1] + origin[2] * w[2];
        vd square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
        vd inside = view->ball * view->ball - (origin[0] * origin[0] + origin[1] * origin[1] + origin[2] * origin[2]);
        least = (vd_sqrt(vd_max(along * along + square * inside, zero)) - along) / square;
    }
    for (int axis = 0; axis < 3; axis++) {
        vd t = exit_slab(view->known_low[axis], view->known_high[axis], origin[axis], w[axis]);
        least = vd_select(vd_lt(t, least), t, least);
    }
    return vd_max(least, zero);
}

/* A line in the frame of sphere i. */
typedef struct wall_line {
    double origin[3], w[3];
} wall_line;

/* One of the lines in lanes. */
static wall_line line_of_lane(const vd origin[3], const vd w[3], int lane) {
    _Alignas(64) double at[VD_LANES], along[VD_LANES];
    wall_line line;
    for (int axis = 0; axis < 3; axis++) {
        vd_store(at, origin[axis]);
        vd_store(along, w[axis]);
        line.origin[axis] = at[lane], line.w[axis] = along[lane];
    }
    return line;
}

/* Lines that are cut before they meet a wall, by the wall they would meet: how many, and the first of them. */
typedef struct cut_lines {
    uint32_t count[FIBRAD_WALLS + 1];
    wall_line first[FIBRAD_WALLS + 1];
} cut_lines;

/* Traces the open points of window k, in directions from a disc of radius `spread`, and counts the walls they meet. */
static void follow_wall_points(const fibrad_points *points, const wall_view *view, const double frame[9], double spread,
                               uint32_t k, uint32_t count[FIBRAD_WALLS + 1], cut_lines *cuts) {
    for (uint32_t word = 0; word < points->count / 64; word++) {
        if (points->seen[word] == 0) continue;
        _Alignas(64) float a[64], b[64];
        for (uint32_t lane = 0; lane < 64; lane++) {
            const uint32_t q = fibrad_points_partner(points->count, 64 * word + lane, k);
            a[lane] = points->set.x[q], b[lane] = points->set.y[q];
        }
        uint64_t packed = 0; /* eight counts of at most 64 */
        for (uint32_t lane = 0; lane < 64; lane += VD_LANES) {
            uint32_t p = 64 * word + lane, bits = (uint32_t)(points->seen[word] >> lane) & ((1u << VD_LANES) - 1);
            if (bits == 0) continue;
            vd u = vd_load_float(points->set.x + p), v = vd_load_float(points->set.y + p), origin[3], w[3];
            vd du = vd_load_float(a + lane) * spread;
            vd dv = vd_load_float(b + lane) * spread;
            for (int axis = 0; axis < 3; axis++) {
                vd along_u = vd_set1(frame[axis]), along_v = vd_set1(frame[3 + axis]);
                origin[axis] = u * along_u + v * along_v;
                w[axis] = frame[6 + axis] + (du * along_u + dv * along_v);
            }
            _Alignas(64) double wall[VD_LANES];
            vd distance;
            vd_store(wall, exit_walls(view, origin, w, &distance));
            if (view->cut) {
                uint32_t cut = bits & vm_bits(vd_lt(exit_known(view, origin, w), distance));
                bits &= ~cut;
                for (; cut != 0; cut &= cut - 1) {
                    const int at = __builtin_ctz(cut), number = (int)wall[at];
                    if (cuts->count[number]++ == 0) cuts->first[number] = line_of_lane(origin, w, at);
                }
            }
            for (; bits != 0; bits &= bits - 1) packed += UINT64_C(1) << 8 * (int)wall[__builtin_ctz(bits)];
        }
        for (uint32_t wall = 0; wall <= FIBRAD_WALLS; wall++) count[wall] += (uint32_t)(packed >> 8 * wall & 255);
    }
}

void LANED(fibrad_walls_share)(fibrad_workspace *work, const double frame[9], const fibrad_points *points, uint32_t k,
                               uint32_t n, bool turned, double rest) {
    if (rest == 0) return;
    const fibrad_container *container = &work->scene->container;
    const double open = rest / (points->count > 0 ? points->count : FIBRAD_PI), step = open / fibrad_sqrt(n);
    const int only = work->cut ? 3 : only_axis(container);
    if (only < 3) {
        /* across z no band is needed: directions pair off, but for the one that lies level, if they are not turned */
        const double band = only == 2 && !turned ? 0 : WALL_BAND * step;
        const double up = rest * rising_share(frame[6 + only], band), down = rest - up;
        work->wall[container->high[only] < __builtin_inf() ? 2 * only + 1 : FIBRAD_WALLS] += up;
        work->wall[container->low[only] > -__builtin_inf() ? 2 * only : FIBRAD_WALLS] += down;
        return;
    }
    double axes[9], cos, sin;
    fibrad_copy(axes, frame, sizeof axes);
    fibrad_points own = *points;
    if (points->count == 0) {
        fibrad_azimuth(5 * k % FIBRAD_DIRECTIONS_MAX, &cos, &sin);
        rotate_frame(axes, cos, sin);
        own = open_points_of(work, cos, sin);
    }
    const wall_view view = wall_view_of(work);
    uint32_t count[FIBRAD_WALLS + 1] = {0};
    cut_lines cuts;
    for (uint32_t wall = 0; wall <= FIBRAD_WALLS; wall++) cuts.count[wall] = 0;
    follow_wall_points(&own, &view, axes, WALL_SPREAD * step, k, count, &cuts);
    for (uint32_t wall = 0; wall <= FIBRAD_WALLS; wall++) {
        work->wall[wall] += rest * count[wall] / own.open;
        if (cuts.count[wall] == 0) continue; /* the way of one decides for all that would meet the same wall */
        const wall_line *first = &cuts.first[wall];
        work->wall[fibrad_work_met(work, first->origin, first->w)] += rest * cuts.count[wall] / own.open;
    }
}
