/* wall_sum.c - solid angles of walls, seen from within, and view factors to walls. SPDX-License-Identifier: MIT */
#include "sums/wall_sum.h"
#include "base/elementary.h"

#define HARDLY 1e-4 /* of a window: weight of the prior where hardly any line has met a region */

void fibrad_wall_sums_begin(fibrad_wall_sums *sums, uint32_t windows) {
    fibrad_zero(sums, offsetof(fibrad_wall_sums, hidden) + (windows / 64 + 1) * sizeof *sums->hidden);
}

int fibrad_walls_only(const fibrad_container *c) {
    int only = 3, axes = c->radius < __builtin_inf() ? 2 : 0;
    for (int axis = 0; axis < 3; axis++)
        if (c->low[axis] > -__builtin_inf() || c->high[axis] < __builtin_inf()) only = axis, axes++;
    return axes == 1 ? only : 3;
}

/* Whether no line is cut before it meets a wall: the ball contains the sphere and the container. */
static bool all_within(const fibrad_wall_view *view) {
    double farthest = 0;
    for (int axis = 0; axis < 3; axis++) {
        const bool round = view->round && axis < 2;
        const double low = fibrad_min(-1, round ? view->axis[axis] - view->radius : view->low[axis]);
        const double high = fibrad_max(1, round ? view->axis[axis] + view->radius : view->high[axis]);
        const double far = fibrad_max(-low, high);
        farthest += far * far;
    }
    return farthest <= view->ball * view->ball && fibrad_finite(farthest);
}

fibrad_wall_view fibrad_wall_view_of(const fibrad_scene *scene, uint32_t place, bool cut, double ball) {
    const fibrad_container *c = &scene->container;
    const double centre[3] = {scene->x[place], scene->y[place], scene->z[place]}, inverse = 1 / scene->r[place];
    fibrad_wall_view view = {
        .turn = c->turn, .radius = c->radius * inverse, .round = c->radius < __builtin_inf(), .ball = ball};
    for (uint32_t a = 0; a < 3; a++) {
        const uint32_t axis = fibrad_cylinder_axis(c->turn, a);
        view.low[a] = (c->low[axis] - centre[axis]) * inverse;
        view.high[a] = (c->high[axis] - centre[axis]) * inverse;
        if (a < 2) view.axis[a] = (c->axis[a] - centre[axis]) * inverse;
    }
    view.cut = cut && !all_within(&view);
    view.only = view.cut ? 3 : fibrad_walls_only(c);
    return view;
}

/* The distance of a plane. The centre may lie on the plane, or beyond it by rounding. */
static double distance_to(const fibrad_wall_view *view, int axis, bool up) {
    const double away = up ? view->high[axis] : -view->low[axis];
    return fibrad_max(fibrad_min(away, FIBRAD_FAR_AWAY), 1 / FIBRAD_FAR_AWAY);
}

static double off_axis(const fibrad_wall_view *view) {
    return fibrad_sqrt(view->axis[0] * view->axis[0] + view->axis[1] * view->axis[1]);
}

/* The solid angle of a rectangle across an axis at distance a. It extends from the foot of the perpendicular to b
 * and c. */
static double corner_angle(double a, double b, double c) {
    return fibrad_quarter_angle(a * fibrad_sqrt(a * a + b * b + c * c), b * c);
}

/* The solid angle over 4 pi of a disc at distance d whose axis is at distance s. This is the mean of 1 - d/sqrt(d^2
 * + rho^2) over the azimuths about the foot of the perpendicular, where rho is the distance to the rim. By symmetry
 * half of the azimuths suffice. For a point near the rim, rho has a bend at pi/2. So the nodes are close together
 * there, and at 0 and pi. */
static double disc_sky(double d, double s, double radius) {
    enum { NODES = 32 };
    const double inside = radius * radius - s * s;
    double sum = 0;
    for (int half = 0; half < 2; half++)
        for (int k = 0; k < NODES; k++) {
            const double u = (k + 0.5) / NODES, x = u * u * u * (10 - u * (15 - 6 * u));
            const double weight = 30 * u * u * (1 - u) * (1 - u);
            double sine, cosine;
            fibrad_sincos_turn(0.25 * x, &sine, &cosine);
            const double root = fibrad_sqrt(fibrad_max(0, radius * radius - s * s * sine * sine));
            const double rho = half == 0 ? fibrad_max(0, inside) / (root + s * cosine) : root + s * cosine;
            const double slant = fibrad_sqrt(d * d + rho * rho);
            sum += weight * (rho * rho / (slant * (slant + d)));
        }
    return sum / (4 * NODES);
}

/* The solid angles of the regions from the centre, over 4 pi. This is the share of `all` that each region should
 * have. */
static void sky_of_regions(const fibrad_wall_view *view, double sky[FIBRAD_REGIONS]) {
    fibrad_zero(sky, FIBRAD_REGIONS * sizeof *sky);
    for (int octant = 0; octant < 8; octant++) {
        double d[3], *of = sky + 4 * octant;
        for (int axis = 0; axis < 3; axis++) d[axis] = distance_to(view, axis, octant >> axis & 1);
        if (view->only < 3) {
            if (octant == 0 || octant == 1 << view->only) of[view->only] = 0.5;
        } else if (!view->round) {
            for (int n = 0; n < 3; n++) of[n] = corner_angle(d[n], d[(n + 1) % 3], d[(n + 2) % 3]) / (4 * FIBRAD_PI);
        } else if (octant == 0 || octant == 4) {
            of[2] = d[2] < FIBRAD_FAR_AWAY ? disc_sky(d[2], off_axis(view), view->radius) : 0;
            of[3] = 0.5 - of[2];
        }
    }
}

double fibrad_wall_nearest(const fibrad_wall_view *view) {
    double nearest = view->radius - off_axis(view);
    for (int axis = 0; axis < 3; axis++) nearest = fibrad_min(nearest, fibrad_min(view->high[axis], -view->low[axis]));
    return nearest;
}

double fibrad_wall_apart(const fibrad_wall_view *view) {
    if (view->cut) return 0;
    if (view->only < 3) return 1;
    const double nearest = fibrad_max(1 / FIBRAD_FAR_AWAY, fibrad_min(1, fibrad_wall_nearest(view)));
    return fibrad_max(0, 1 - 5 * (1 - nearest));
}

/* The slot of the wall through which a region is met, or FIBRAD_ESCAPED. */
static uint32_t slot_of_region(const fibrad_wall_view *view, uint32_t region) {
    const uint32_t axis = region % 4, up = region / 4 >> axis & 1;
    if (axis == 3) return FIBRAD_CYLINDER;
    const double away = up ? view->high[axis] : -view->low[axis];
    return away < __builtin_inf() ? fibrad_face(fibrad_cylinder_axis(view->turn, axis), up) : FIBRAD_ESCAPED;
}

static double all_parts(const double part[4]) { return (part[0] + part[2]) + (part[1] + part[3]); }

/* The open part of each region over what it would be if nothing were hidden. A region that hardly any line has met
 * gets the value of its octant. */
static void open_means(const fibrad_wall_sums *sums, double mean[FIBRAD_REGIONS]) {
    for (uint32_t octant = 0; octant < FIBRAD_REGIONS; octant += 4) {
        double open = 0, there = 0;
        for (uint32_t region = octant; region < octant + 4; region++)
            open += all_parts(sums->open[region]), there += all_parts(sums->all[region]);
        const double prior = there > 0 ? open / there : 0;
        for (uint32_t region = octant; region < octant + 4; region++)
            mean[region] = (fibrad_max(0, all_parts(sums->open[region])) + HARDLY * prior) /
                           (fibrad_max(0, all_parts(sums->all[region])) + HARDLY);
    }
}

void fibrad_wall_factors(const fibrad_wall_sums *sums, const fibrad_wall_view *view, uint32_t windows, double apart,
                         double wall[FIBRAD_SLOTS], double parts[2]) {
    double sky[FIBRAD_REGIONS] = {0}, mean[FIBRAD_REGIONS], got[FIBRAD_REGIONS], rest[FIBRAD_WALLS + 1][4];
    double open = 0, sum = 0, mixed = 0, whole = 0;
    if (apart > 0) sky_of_regions(view, sky);
    open_means(sums, mean);
    fibrad_zero(rest, sizeof rest);
    for (uint32_t region = 0; region < FIBRAD_REGIONS; region++) {
        const double *part = sums->open[region], *all = sums->all[region], opened = all_parts(part);
        got[region] = opened + apart * (windows * sky[region] * mean[region] - opened);
        open += opened, sum += got[region], mixed += sums->mixed[region];
        for (int p = 0; p < 4; p++) /* what the solid angle knows is no error */
            rest[slot_of_region(view, region)][p] += part[p] - apart * mean[region] * all[p];
    }
    for (uint32_t region = 0; region < FIBRAD_REGIONS; region++) {
        const double left = mixed > 0 ? (open - sum) * (sums->mixed[region] / mixed) : 0;
        got[region] = fibrad_max(0, got[region] + left);
        whole += got[region];
    }
    for (uint32_t region = 0; region < FIBRAD_REGIONS && whole > 0; region++)
        wall[slot_of_region(view, region)] += got[region] * (open / whole);
    parts[0] = parts[1] = 0;
    for (uint32_t slot = 0; slot < FIBRAD_WALLS; slot++) {
        const double *p = rest[slot], half = p[0] + p[2] - p[1] - p[3], even = p[0] - p[2], odd = p[1] - p[3];
        parts[0] += half * half, parts[1] += even * even + odd * odd;
    }
}
