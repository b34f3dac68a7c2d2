/* surface_lanes.c - the two loops of the surface method that run in lanes. SPDX-License-Identifier: MIT
 *
 * Eight partial sums whatever the width of a vector, so that no bit depends on it. What is left out to save time is
 * left out with a margin above rounding: it could not have changed a bit of the sums either. */
#include FIBRAD_LANES_HEADER
#include "base/lanes/laned.h"
#include "surface/surface_lanes.h"

#define GROUP  8
#define STEPS  (GROUP / VD_LANES)
#define MARGIN 1e-12

static vd dot(vd ax, vd ay, vd az, vd bx, vd by, vd bz) {
    return vd_add(vd_add(vd_mul(ax, bx), vd_mul(ay, by)), vd_mul(az, bz));
}

static vd rotated(const double row[3], vd x, vd y, vd z) {
    return dot(vd_set1(row[0]), vd_set1(row[1]), vd_set1(row[2]), x, y, z);
}

/* The lanes of a vector at position k that are among the first n. */
static uint32_t lanes_below(uint32_t n, uint32_t k) {
    return n - k < VD_LANES ? (1u << (n - k)) - 1 : (1u << VD_LANES) - 1;
}

static void append(fibrad_obstacles *list, uint32_t lanes, vd x, vd y, vd z, vd r) {
    _Alignas(64) double copy[4][GROUP];
    vd_store(copy[0], x);
    vd_store(copy[1], y);
    vd_store(copy[2], z);
    vd_store(copy[3], r);
    for (uint32_t l = 0; l < VD_LANES; l++) {
        if ((lanes >> l & 1) == 0) continue;
        list->x[list->n] = copy[0][l];
        list->y[list->n] = copy[1][l];
        list->z[list->n] = copy[2][l];
        list->r[list->n] = copy[3][l];
        list->n++;
    }
}

/* The two spheres touch a common cone, whose normals rise by asin(slope) above the planes z = const. Rays between
 * points that face each other run inside the cone, between its two circles of contact: an obstacle that reaches into
 * this body is kept. An obstacle that covers the cross-section of the cone in the plane of its own centre, with the
 * spheres on either side of that plane, hides the pair. */
bool LANED(fibrad_surface_filter)(fibrad_surface_task *task, const fibrad_surface_frame *frame,
                                  const fibrad_obstacles *all, uint32_t self) {
    const double slope = (1 - task->r2) / task->d;
    const vd sine = vd_set1(slope), cosine = vd_set1(fibrad_sqrt((1 - slope) * (1 + slope)));
    const vd low = sine, high = vd_set1(task->d + task->r2 * slope), one = vd_set1(1);
    bool hidden = false;
    task->obstacles.n = 0;
    for (uint32_t k = 0; k < all->n; k += VD_LANES) {
        const vd cx = vd_sub(vd_load(all->x + k), vd_set1(frame->origin[0]));
        const vd cy = vd_sub(vd_load(all->y + k), vd_set1(frame->origin[1]));
        const vd cz = vd_sub(vd_load(all->z + k), vd_set1(frame->origin[2]));
        const vd x = rotated(frame->x, cx, cy, cz), y = rotated(frame->y, cx, cy, cz);
        const vd z = rotated(frame->z, cx, cy, cz), r = vd_mul(vd_load(all->r + k), vd_set1(frame->scale));
        const vd aside = vd_sqrt(vd_add(vd_mul(x, x), vd_mul(y, y)));
        const vd slack = vd_mul(vd_set1(MARGIN), vd_add(vd_add(aside, vd_abs(z)), vd_add(high, r)));
        const vd wide = vd_add(r, slack), depth = vd_sub(one, vd_mul(z, sine)); /* from axis to cone */
        const vm in_cone = vd_lt(vd_sub(vd_mul(aside, cosine), depth), wide);
        const vm between = vm_and(vd_lt(low, vd_add(z, wide)), vd_lt(vd_sub(z, wide), high));
        const vm covers = vm_and(vd_le(vd_add(vd_mul(vd_add(aside, slack), cosine), depth), vd_mul(r, cosine)),
                                 vm_and(vd_le(one, z), vd_le(z, vd_set1(task->d - task->r2))));
        uint32_t valid = lanes_below(all->n, k);
        if (self - k < VD_LANES) valid &= ~(1u << (self - k));
        if ((vm_bits(covers) & valid) != 0) hidden = true;
        uint32_t keep = task->flags & FIBRAD_SURFACE_NO_REGION ? valid : valid & vm_bits(vm_and(in_cone, between));
        if (keep != 0) append(&task->obstacles, keep, x, y, z, r);
    }
    return hidden;
}

/* Fills `list` with the obstacles that can hide some of sphere 2 from the node (x, y, z) of sphere 1, relative to the
 * node and with its power |c|^2 - r^2 in place of the radius; true if all of sphere 2 is hidden. From the node, sphere
 * 2 and an obstacle are two cones; whether they are apart, or one within the other, shows in the scalar product of
 * their axes. An obstacle is also out of the way below the horizon of the node, or beyond the farthest points of
 * sphere 2 that the node can see, which are a tangent's length away. A node inside an obstacle sees nothing. */
static bool obstacles_of_node(const fibrad_surface_task *task, double x, double y, double z, fibrad_obstacles *list) {
    const fibrad_obstacles *all = &task->obstacles;
    const double axis_z = task->d - z, far2 = x * x + y * y + axis_z * axis_z;
    const double tangent2 = fibrad_max(0, far2 - task->r2 * task->r2), tangent = fibrad_sqrt(tangent2);
    const double front = fibrad_sqrt(far2) - task->r2;
    const vd px = vd_set1(x), py = vd_set1(y), pz = vd_set1(z), zero = vd_set1(0), far = vd_set1(far2);
    const vd ax = vd_sub(zero, px), ay = vd_sub(zero, py), az = vd_set1(axis_z);
    const vd tt = vd_set1(tangent2), r2 = vd_set1(task->r2);
    list->n = 0;
    for (uint32_t k = 0; k < all->n; k += VD_LANES) {
        const vd cx = vd_sub(vd_load(all->x + k), px), cy = vd_sub(vd_load(all->y + k), py);
        const vd cz = vd_sub(vd_load(all->z + k), pz), r = vd_load(all->r + k), rr = vd_mul(r, r);
        const vd cc = dot(cx, cy, cz, cx, cy, cz), power = vd_sub(cc, rr);
        const vd slack = vd_mul(vd_set1(MARGIN), vd_add(cc, far));
        const vd axes = dot(cx, cy, cz, ax, ay, az), height = dot(cx, cy, cz, px, py, pz);
        const vd cosines = vd_sqrt(vd_mul(vd_max(power, zero), tt)), sines = vd_mul(r, r2);
        const vd reach = vd_add(tt, vd_mul(vd_set1(2 * tangent), r));
        const vm inside = vd_lt(power, zero);
        const vm apart =
            vm_or(vd_lt(vd_add(vd_add(axes, sines), slack), cosines),
                  vm_or(vd_lt(vd_add(reach, slack), power), vd_lt(vd_add(vd_add(height, r), slack), zero)));
        const vm covers = vm_and(vd_lt(vd_add(cosines, slack), vd_sub(axes, sines)),
                                 vm_and(vd_lt(vd_mul(vd_mul(r2, r2), cc), vd_mul(rr, far)),
                                        vd_lt(vd_add(cc, slack), vd_set1(front * front))));
        uint32_t valid = lanes_below(all->n, k), keep = valid;
        if ((vm_bits(inside) & valid) != 0) return true;
        if ((vm_bits(covers) & valid) != 0 && (task->flags & FIBRAD_SURFACE_NO_HIDDEN) == 0) return true;
        if ((task->flags & FIBRAD_SURFACE_NO_REGION) == 0) keep &= ~vm_bits(apart);
        if (keep != 0) append(list, keep, cx, cy, cz, power);
    }
    return false;
}

/* The lanes whose ray e meets obstacle o before it ends. With p > 0 the power of its beginning, c the centre and
 * b = c.e, the line meets the sphere if b^2 > p e^2; ahead of the beginning if b > 0; and before the end of e if either
 * e^2 > p or the end is inside the sphere, p + e^2 < 2 b: in one, 2 max(b, e^2) > p + e^2. */
static vm meets(const fibrad_obstacles *list, uint32_t o, vd ex, vd ey, vd ez, vd ee, vd half_ee) {
    const vd p = vd_set1(list->r[o]), half_p = vd_set1(0.5 * list->r[o]);
    const vd b = rotated((double[3]){list->x[o], list->y[o], list->z[o]}, ex, ey, ez);
    return vm_and(vm_and(vd_lt(vd_set1(0), b), vd_lt(vd_mul(p, ee), vd_mul(b, b))),
                  vd_lt(half_p, vd_sub(vd_max(b, ee), half_ee)));
}

static double total(const vd part[STEPS]) {
    _Alignas(64) double s[GROUP];
    for (uint32_t step = 0; step < STEPS; step++) vd_store(s + step * VD_LANES, part[step]);
    return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
}

/* Node by node of sphere 1, over the nodes of sphere 2 and these turned by pi about the line of centres. The nodes of
 * both lie in order of z, so the horizons, which are the circles where the common cone touches, cut off a head or a
 * tail of the list. */
void LANED(fibrad_surface_sum)(const fibrad_surface_task *task, fibrad_surface_sums *sums) {
    const fibrad_surface_nodes *nodes = &task->nodes;
    const double horizon = (1 - task->r2) / task->d;
    uint32_t first = 0, end = nodes->n;
    if ((task->flags & FIBRAD_SURFACE_NO_HORIZON) == 0) {
        while (first < nodes->n && nodes->z[first] < horizon - MARGIN) first++;
        while (end > 0 && nodes->z[end - 1] > horizon + MARGIN) end--;
    }
    fibrad_obstacles near = task->of_node;
    const vd zero = vd_set1(0);
    vd open[2][STEPS], seen[2][STEPS];
    for (uint32_t step = 0; step < STEPS; step++) open[0][step] = open[1][step] = seen[0][step] = seen[1][step] = zero;
    sums->rays = sums->tests = 0;

    for (uint32_t k = first; k < nodes->n; k++) {
        const double x = nodes->ring[k] * nodes->cos[k], y = nodes->ring[k] * nodes->sin[k], z = nodes->z[k];
        const bool hidden = obstacles_of_node(task, x, y, z, &near);
        const vd px = vd_set1(x), py = vd_set1(y), weight1 = vd_set1(nodes->weight[k]);
        const vd nx = vd_mul(weight1, px), ny = vd_mul(weight1, py), nz = vd_mul(weight1, vd_set1(z));
        for (uint32_t group = 0; group < end; group += GROUP)
            for (uint32_t step = 0; step < STEPS; step++) {
                const uint32_t l = group + step * VD_LANES;
                const vd ring = vd_mul(vd_set1(task->r2), vd_load(nodes->ring + l));
                const vd x2 = vd_mul(ring, vd_load(nodes->cos + l)), y2 = vd_mul(ring, vd_load(nodes->sin + l));
                const vd uz = vd_mul(vd_set1(task->r2), vd_load(nodes->z + l));
                const vd ez = vd_add(uz, vd_set1(task->d - z)), weight2 = vd_load(nodes->weight + l);
                for (uint32_t turn = 0; turn < 2; turn++) {
                    const vd ux = turn == 0 ? x2 : vd_sub(zero, x2), uy = turn == 0 ? y2 : vd_sub(zero, y2);
                    const vd ex = vd_sub(ux, px), ey = vd_sub(uy, py);
                    const vd cos1 = dot(nx, ny, nz, ex, ey, ez), cos2 = vd_sub(zero, dot(ux, uy, uz, ex, ey, ez));
                    const vm facing = vm_and(vd_lt(zero, cos1), vd_lt(zero, cos2));
                    if (vm_bits(facing) == 0) continue;
                    sums->rays += VD_LANES;
                    const vd ee = dot(ex, ey, ez, ex, ey, ez), half_ee = vd_mul(vd_set1(0.5), ee);
                    const vd quotient = vd_div(vd_mul(vd_mul(cos1, cos2), weight2), vd_mul(ee, ee));
                    const vd g = vd_select(facing, quotient, zero);
                    open[turn][step] = vd_add(open[turn][step], g);
                    if (hidden) continue;
                    vm clear = facing;
                    for (uint32_t o = 0; o < near.n && vm_bits(clear) != 0; o++) {
                        clear = vm_and(clear, vm_not(meets(&near, o, ex, ey, ez, ee, half_ee)));
                        sums->tests += VD_LANES;
                    }
                    seen[turn][step] = vd_add(seen[turn][step], vd_select(clear, g, zero));
                }
            }
    }
    for (uint32_t turn = 0; turn < 2; turn++) {
        sums->open[turn] = total(open[turn]);
        sums->seen[turn] = total(seen[turn]);
    }
#if VD_LANES >= 4
    /* gcc 12 does not do this after calls of static functions, and then SSE code of the caller runs at a third of its
     * speed */
    _mm256_zeroupper();
#endif
}
