/* wall_window.c - the disc of directions that a window stands for, which walls need. SPDX-License-Identifier: MIT */
#include "row/wall_window.h"

/* Half width of the band of directions for walls across one axis, times sqrt n. */
#define WALL_BAND 4.0

/* Both walls at an edge share the lines near it, over a tenth of the disc and of the window. This makes up for the
 * small number of points, 128. */
#define WALL_SOFT 0.1
/* How far directions of parallel lines spread. It is not 0, so that lines along an edge of two walls belong to both. */
#define WALL_PARALLEL 1e-3

/* The part of the slope that counts. With a half, the means over all places of an edge among the directions are
 * right to second order. A little more is better, because the correction is limited. */
#define WALL_SLOPE 0.6

static fibrad_wall_course course_of(const fibrad_wall_view *view, const double w[3]) {
    fibrad_wall_course course;
    for (int axis = 0; axis < 3; axis++) {
        const double low = fibrad_min(FIBRAD_FAR_AWAY, -view->low[axis]),
                     high = fibrad_min(FIBRAD_FAR_AWAY, view->high[axis]);
        course.rate[axis] = fibrad_abs(w[axis]);
        course.ahead[axis] = w[axis] < 0 ? low : high, course.behind[axis] = w[axis] < 0 ? high : low;
    }
    return course;
}

/* How the line from the centre passes the edge between two planes. passing > 0: the line meets the first plane.
 * passing/distance is the sine of the angle to the edge. */
typedef struct wall_edge {
    double passing, square; /* squared distance of the edge */
} wall_edge;

static wall_edge edge_of_planes(double first, double first_rate, double second, double second_rate) {
    return (wall_edge){second * first_rate - first * second_rate, first * first + second * second};
}

/* The same for the edge between the end of a cylinder and the cylinder. */
static wall_edge edge_of_end(const fibrad_wall_view *view, const fibrad_wall_course *course, const double w[3]) {
    const double x = -view->axis[0], y = -view->axis[1], away = course->ahead[2], rate = course->rate[2];
    const double along = x * rate + w[0] * away, across = y * rate + w[1] * away;
    const double size = fibrad_max(fibrad_sqrt(along * along + across * across), 1e-300);
    const double clear = view->radius - (along * x + across * y) / size;
    return (wall_edge){view->radius * rate - size, away * away + clear * clear};
}

/* How much of the disc of directions is needed at an edge. The angle over which the lines of the window pass the
 * edge and the radius of the needed disc add up, as squares, to that of the whole disc. */
static double needed_at(const wall_edge *edge, double wide) {
    return fibrad_max(0, 1 - FIBRAD_WINDOW_NEAR * FIBRAD_WINDOW_NEAR / (edge->square * wide * wide));
}

/* The same for a window. Mostly the nearest edge decides. */
static double needed_of(const fibrad_wall_view *view, const fibrad_wall_course *course, const double w[3],
                        double wide) {
    double sum = 0, weights = 0;
    if (view->round) {
        const wall_edge edge = edge_of_end(view, course, w);
        return needed_at(&edge, wide);
    }
    for (int a = 0; a < 3; a++) {
        const int b = (a + 1) % 3;
        const wall_edge edge = edge_of_planes(course->ahead[a], course->rate[a], course->ahead[b], course->rate[b]);
        const double angle = edge.passing * edge.passing / edge.square + wide * wide, weight = 1 / (angle * angle);
        sum += weight * needed_at(&edge, wide), weights += weight;
    }
    return sum / weights;
}

/* The factor by which `passing` is multiplied so that it changes by one over half the width in which lines change
 * from one wall to the other. */
static double sharpness_of(const fibrad_wall_window *window, double first, double second) {
    const double soft = WALL_SOFT * window->spread, length = WALL_SOFT * fibrad_min(1, 15 / fibrad_sqrt(window->n));
    return 1 / fibrad_sqrt(soft * soft * (first * first + second * second) + length * length);
}

void fibrad_wall_window_begin(fibrad_wall_window *window, const fibrad_wall_view *view, const double frame[9]) {
    const double *w = window->frame + 6;
    window->direction = frame + 6;
    for (uint32_t k = 0; k < 9; k++) window->frame[k] = frame[k - k % 3 + fibrad_cylinder_axis(view->turn, k % 3)];
    window->wide = window->parallel ? WALL_PARALLEL : window->part * FIBRAD_WINDOW_SPREAD / fibrad_sqrt(window->n);
    for (int axis = 0; axis < 2; axis++) window->slope[axis] *= WALL_SLOPE;
    if (view->only < 3) return;
    window->course = course_of(view, w);
    window->spread = window->wide * fibrad_sqrt(needed_of(view, &window->course, w, window->wide));
}

void fibrad_wall_window_sharpen(fibrad_wall_window *window, const fibrad_wall_view *view) {
    fibrad_wall_course course = window->course;
    for (int axis = 0; axis < 3; axis++) /* lines on both sides: not too soft for the nearer one */
        if (course.rate[axis] < window->wide) course.ahead[axis] = fibrad_min(course.ahead[axis], course.behind[axis]);
    for (int axis = 0; axis < 3; axis++)
        window->sharpness[axis] = sharpness_of(window, course.ahead[axis], course.ahead[(axis + 1) % 3]);
    if (view->round) window->sharpness[2] = sharpness_of(window, course.ahead[2], view->radius);
}

bool fibrad_wall_window_has(const fibrad_wall_window *window, const fibrad_wall_view *view, uint32_t octant) {
    if (view->round && octant % 4 != 0) return false;
    for (int axis = view->round ? 2 : 0; axis < 3; axis++) {
        const double w = window->frame[6 + axis];
        if (octant >> axis & 1 ? w <= -window->wide : w >= window->wide) return false;
    }
    return true;
}

void fibrad_wall_window_add(const fibrad_wall_window *window, uint32_t region, double open, double share,
                            fibrad_wall_sums *sums) {
    const double mixed = window->open * window->hidden * share;
    const fibrad_grid *grid = window->grid;
    fibrad_wall_add(sums->open[region], window->k, window->end, open, grid[1]);
    fibrad_wall_add(sums->all[region], window->k, window->end, share * window->weight, grid[0]);
    sums->mixed[region] += fibrad_on_grid(mixed, grid[2]);
}

/* The part of a band of directions that rises along an axis. The weights are (1 - x^2)^2 over the half width of the
 * band. slope: of the middle of the band. */
static double rising_share(double slope, double width) {
    if (!(fibrad_abs(slope) < width)) return slope > 0 ? 1 : slope < 0 ? 0 : 0.5;
    double x = slope / width, square = x * x;
    const double share = 0.5 + 15.0 / 16 * x * (1 - square * (2.0 / 3 - square / 5));
    return fibrad_max(0, fibrad_min(1, share));
}

double fibrad_wall_window_band(const fibrad_wall_window *window, const fibrad_wall_view *view, bool turned) {
    const double band = turned || view->only == 3 ? 0 : WALL_BAND / fibrad_sqrt(window->n);
    return fibrad_abs(window->frame[6 + view->only % 3]) < band ? band : 0;
}

/* All walls are planes across one axis: a band of directions tells the shares. Of what the band has across the horizon
 * only the part that meets nothing counts there. */
static void add_band(const fibrad_wall_window *window, int axis, fibrad_wall_sums *sums) {
    const double level = window->frame[6 + axis], side = level > 0 ? 1 : level < 0 ? 0 : 0.5;
    const double up = rising_share(level, window->band), part = side + window->through * (up - side);
    const uint32_t low = (uint32_t)axis, high = low + (4u << axis);
    fibrad_wall_window_add(window, high, window->open * part, up, sums);
    fibrad_wall_window_add(window, low, window->open * (1 - part), 1 - up, sums);
}

/* Whether all lines of the window meet the first wall of an edge (1) or the second (-1). 0: neither, or it is not
 * sure. */
static int sole_at(const fibrad_wall_window *window, const wall_edge *edge) {
    const double reach = (1 + WALL_SOFT) * window->spread, far = fibrad_sqrt(edge->square) + 1;
    const double margin = reach * far + 1 + WALL_SOFT;
    return edge->passing > margin ? 1 : edge->passing < -margin ? -1 : 0;
}

/* The axis of the plane that all lines of the window meet, or 3 for the cylinder. 4: lines meet several walls. */
static uint32_t sole_wall(const fibrad_wall_window *window, const fibrad_wall_view *view) {
    const fibrad_wall_course *course = &window->course;
    const double *ahead = course->ahead, *rate = course->rate;
    if (view->round) {
        const bool open = ahead[2] >= FIBRAD_FAR_AWAY, open_too = course->behind[2] >= FIBRAD_FAR_AWAY;
        if (rate[2] < window->wide) return open && open_too ? 3 : 4;
        if (open) return 3;
        wall_edge edge = edge_of_end(view, course, window->frame + 6);
        edge.square = fibrad_max(edge.square, 4 * view->radius * view->radius + ahead[2] * ahead[2]);
        const int sole = sole_at(window, &edge);
        return sole > 0 ? 2 : sole < 0 ? 3 : 4;
    }
    uint32_t a = ahead[1] * rate[0] < ahead[0] * rate[1] ? 1 : 0;
    if (ahead[2] * rate[a] < ahead[a] * rate[2]) a = 2;
    if (rate[a] < window->wide || ahead[a] >= FIBRAD_FAR_AWAY) return 4;
    for (uint32_t b = 0; b < 3; b++) {
        const wall_edge to = edge_of_planes(ahead[a], rate[a], ahead[b], rate[b]);
        const wall_edge back = edge_of_planes(ahead[a], rate[a], course->behind[b], 0);
        if (b == a) continue;
        if (ahead[b] < FIBRAD_FAR_AWAY && sole_at(window, &to) < 1) return 4;
        if (rate[b] < window->wide && course->behind[b] < FIBRAD_FAR_AWAY && sole_at(window, &back) < 1) return 4;
    }
    return a;
}

bool fibrad_wall_window_simple(const fibrad_wall_window *window, const fibrad_wall_view *view, fibrad_wall_sums *sums) {
    if (view->only < 3) {
        add_band(window, view->only, sums);
        return true;
    }
    const uint32_t sole = view->cut ? 4 : sole_wall(window, view);
    if (sole == 4) return false;
    for (uint32_t octant = 0; octant < 8; octant++) {
        if (!fibrad_wall_window_has(window, view, octant)) continue;
        double share = 1;
        for (uint32_t axis = view->round ? 2 : 0; axis < 3; axis++) {
            const double w = window->frame[6 + axis], up = rising_share(w, axis == sole ? 0 : window->wide);
            share *= octant >> axis & 1 ? up : 1 - up;
        }
        fibrad_wall_window_add(window, 4 * octant + sole, window->open * share, share, sums);
    }
    return true;
}
