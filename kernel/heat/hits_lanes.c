/* hits_lanes.c - where the beams of a sphere go, and which patches they connect. Compiled once per instruction set.
 * SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "heat/hits_lanes.h"
#include "heat/sphere_patch.h"
#include "heat/wall_patch.h"
#include "ray/tracer.h"
#include "sample/direction.h"
#include "row/window_lanes.h"

#define POINTS 64                          /* of a window at a time */
#define SHELLS ((fibrad_stride){3.9, 1.5}) /* as for rows of beams */

/* Some points of a window: which disc hides each, and where on the sphere it is met. */
struct window {
    _Alignas(64) double u[POINTS], v[POINTS], w[POINTS]; /* normals in the frame of the window */
    _Alignas(64) double face[POINTS], x[POINTS], y[POINTS];
    uint32_t disc[POINTS]; /* FIBRAD_NONE: no sphere is met */
};

/* Patch numbers, 0 to 6 side^2 - 1, of the normals of all points. */
static void number(struct window *p, const double frame[9], uint32_t side, uint16_t *patch) {
    const vd zero = vd_set1(0), one = vd_set1(1), half = vd_set1(.5 * side);
    double axes[9];
    fibrad_patch_turn(frame, axes);
    for (uint32_t k = 0; k < POINTS; k += VD_LANES) {
        vd u = vd_load(p->u + k), v = vd_load(p->v + k), w = vd_load(p->w + k), n[3], size[3];
        for (int axis = 0; axis < 3; axis++) {
            n[axis] = vd_add(vd_add(vd_mul(u, vd_set1(axes[axis])), vd_mul(v, vd_set1(axes[3 + axis]))),
                             vd_mul(w, vd_set1(axes[6 + axis])));
            size[axis] = vd_abs(n[axis]);
        }
        vm second = vd_lt(size[0], size[1]);
        vd largest = vd_max(size[0], size[1]), high = vd_select(second, n[1], n[0]);
        vm third = vd_lt(largest, size[2]);
        largest = vd_max(largest, size[2]), high = vd_select(third, n[2], high);
        vd face = vd_select(third, vd_set1(4), vd_select(second, vd_set1(2), zero));
        vd a = vd_div(vd_select(third, n[0], vd_select(second, n[0], n[1])), largest);
        vd b = vd_div(vd_select(third, n[1], n[2]), largest);
        /* t (5 - t^2)/4 is nearly proportional to the angle, atan t */
        a = vd_mul(a, vd_sub(vd_set1(1.25), vd_mul(vd_set1(.25), vd_mul(a, a))));
        b = vd_mul(b, vd_sub(vd_set1(1.25), vd_mul(vd_set1(.25), vd_mul(b, b))));
        vd_store(p->face + k, vd_add(face, vd_select(vd_lt(high, zero), one, zero)));
        vd_store(p->x + k, vd_mul(vd_max(vd_add(a, one), zero), half));
        vd_store(p->y + k, vd_mul(vd_max(vd_add(b, one), zero), half));
    }
    for (uint32_t k = 0; k < POINTS; k++)
        patch[k] = (uint16_t)fibrad_patch_number((uint32_t)p->face[k], (uint32_t)p->x[k], (uint32_t)p->y[k], side);
}

/* Which disc hides each point of a word: the first that covers it. */
static void find_discs(const fibrad_workspace *work, const fibrad_points *points, uint32_t word, struct window *p) {
    uint64_t left = ~points->seen[word];
    for (uint32_t k = 0; k < POINTS; k++) p->disc[k] = FIBRAD_NONE;
    for (uint32_t t = 0; left != 0; t++) {
        const uint32_t k = points->taker[t];
        const double r = work->disc.r[k];
        vf u = vf_set1((float)work->disc.u[k]), v = vf_set1((float)work->disc.v[k]), square = vf_set1((float)(r * r));
        uint64_t hidden = 0;
        for (uint32_t lane = 0; lane < POINTS; lane += VF_LANES) {
            vf dx = vf_sub(vf_load(points->set.x + POINTS * word + lane), u);
            vf dy = vf_sub(vf_load(points->set.y + POINTS * word + lane), v);
            hidden |= (uint64_t)vf_lt_bits(vf_add(vf_mul(dx, dx), vf_mul(dy, dy)), square) << lane;
        }
        for (uint64_t take = hidden & left; take != 0; take &= take - 1) p->disc[__builtin_ctzll(take)] = k;
        left &= ~hidden;
    }
}

/* Normals where the points x, y meet their discs. */
static void find_normals(const fibrad_workspace *work, const float *x, const float *y, struct window *p) {
    for (uint32_t k = 0; k < POINTS; k++) {
        const uint32_t d = p->disc[k];
        p->u[k] = p->v[k] = 0;
        if (d == FIBRAD_NONE) continue;
        const double inverse = 1 / work->disc.r[d];
        p->u[k] = (x[k] - work->disc.u[d]) * inverse, p->v[k] = (y[k] - work->disc.v[d]) * inverse;
    }
    for (uint32_t k = 0; k < POINTS; k += VD_LANES) {
        vd u = vd_load(p->u + k), v = vd_load(p->v + k);
        vd square = vd_max(vd_set1(0), vd_sub(vd_set1(1), vd_add(vd_mul(u, u), vd_mul(v, v))));
        vd_store(p->w + k, vd_sub(vd_set1(0), vd_sqrt(square)));
    }
}

/* A window stands for all directions nearer to its own than to others. To tell far walls apart, the beam of each open
 * point goes in a direction of its own, from a disc about that of the window, thinning out towards its rim; which one,
 * another point of the set says. Without that a sphere sees a plane with an error of up to 1 % at 168 directions; with
 * it the error is 0.06 %. */
#define SPREAD  4.5 /* radius of the disc, times sqrt n */
#define PAIRING 45u
#define SHIFT   21u

/* The patch that the beam of open point p of window k meets. */
static uint32_t escape(const fibrad_heat *heat, const fibrad_workspace *work, const double frame[9],
                       const fibrad_disc_points *set, uint32_t k, uint32_t p) {
    if (!heat->scene->container.walls) return fibrad_heat_open(heat);
    const uint32_t other = (PAIRING * p + SHIFT * k) & (heat->config.points - 1);
    const double x = set->x[p], y = set->y[p], up = fibrad_sqrt(fibrad_max(0, 1 - (x * x + y * y)));
    const double a = set->x[other], b = set->y[other];
    const double rare = fibrad_sqrt(1 + fibrad_sqrt(fibrad_max(0, 1 - (a * a + b * b))));
    const double spread = SPREAD / (fibrad_sqrt(heat->config.directions) * rare), du = spread * a, dv = spread * b;
    double origin[3], w[3];
    for (int axis = 0; axis < 3; axis++) {
        const double e = frame[axis], f = frame[3 + axis], g = frame[6 + axis];
        origin[axis] = work->centre[axis] + work->unit * (x * e + y * f + up * g);
        w[axis] = g + (du * e + dv * f);
    }
    return fibrad_heat_leaves(heat, origin, w);
}

static int follow_beams(fibrad_heat *heat, fibrad_workspace *work, uint32_t place) {
    fibrad_points points = {.count = heat->config.points};
    struct window window;
    uint16_t patch[POINTS];
    fibrad_disc_points_get(points.count, &points.set);
    work->areas.overflow = false;
    fibrad_work_begin(work, heat->scene, place, 0, SHELLS);
    for (uint32_t k = 0; k < heat->config.directions; k++) {
        double frame[9];
        fibrad_beam_frame(k, heat->config.directions, points.count, frame);
        LANED(fibrad_beam_window)(work, frame, &points, 0);
        if (work->disc.count > work->disc.capacity) return fibrad_work_discs_missed(work);
        uint32_t *hit = heat->hit + (size_t)place * heat->beams + (size_t)k * points.count;
        for (uint32_t word = 0; word < points.count / POINTS; word++, hit += POINTS) {
            find_discs(work, &points, word, &window);
            find_normals(work, points.set.x + POINTS * word, points.set.y + POINTS * word, &window);
            number(&window, frame, heat->side, patch);
            for (uint32_t p = 0; p < POINTS; p++) {
                if (window.disc[p] == FIBRAD_NONE)
                    hit[p] = escape(heat, work, frame, &points.set, k, POINTS * word + p);
                else
                    hit[p] = fibrad_work_sphere(work, window.disc[p]) * heat->config.patches + patch[p];
            }
        }
    }
    return FIBRAD_OK;
}

static void follow_rays(fibrad_heat *heat, uint32_t task) {
    for (uint32_t wall = 0; wall < FIBRAD_WALLS; wall++) {
        const fibrad_heat_wall *part = &heat->wall[wall];
        uint32_t from = task * FIBRAD_HEAT_TASK, to = from + FIBRAD_HEAT_TASK;
        if (from < part->first_ray) from = part->first_ray;
        if (to > part->first_ray + part->rays) to = part->first_ray + part->rays;
        for (uint32_t k = from; k < to; k++) {
            fibrad_heat_ray *ray = &heat->ray[k];
            double origin[3], w[3];
            fibrad_hit hit;
            *ray = (fibrad_heat_ray){0, 0, 0};
            if (!fibrad_heat_wall_ray(heat, wall, k - part->first_ray, origin, w)) continue;
            LANED(fibrad_trace_point)(heat->scene, origin, w, &hit);
            if (hit.sphere != FIBRAD_NONE) continue;
            ray->from = fibrad_heat_wall_patch(heat, wall, origin);
            ray->to = fibrad_heat_leaves(heat, origin, w);
            ray->area = 1 / (part->density + fibrad_heat_wall_density(heat, ray->to));
        }
    }
}

int LANED(fibrad_heat_follow)(fibrad_heat *heat, fibrad_workspace *work, uint32_t task) {
    const fibrad_scene *scene = heat->scene;
    if (task < scene->facts.spheres) return follow_beams(heat, work, scene->place[task]);
    follow_rays(heat, task - scene->facts.spheres);
    return FIBRAD_OK;
}
