/* surface_lanes.c - the two loops of the surface method that run in lanes. SPDX-License-Identifier: MIT
 *
 * There are eight partial sums for all vector widths, so that no bit depends on the width. Terms are left out only
 * if a margin above rounding shows that they are 0. So this changes no bit either. */
#include FIBRAD_LANES_HEADER
#include "base/lanes/below.h"
#include "base/lanes/laned.h"
#include "surface/surface_lanes.h"

#define PARTIAL_SUMS   8
#define SURFACE_STEPS  (PARTIAL_SUMS / VD_LANES) /* number of vectors for the partial sums */
#define SURFACE_MARGIN 1e-12

static vd dot(vd ax, vd ay, vd az, vd bx, vd by, vd bz) { return ax * bx + ay * by + az * bz; }

static vd dot_row(const double row[3], vd x, vd y, vd z) { return row[0] * x + row[1] * y + row[2] * z; }

static void append_obstacles(fibrad_obstacles *list, uint32_t lanes, vd x, vd y, vd z, vd r) {
    _Alignas(64) double copy[4][VD_LANES];
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

/* A cone touches both spheres. Its normals are inclined by asin(slope) to the planes z = const. Rays between points
 * that face each other lie inside the cone, between its two circles of contact. Obstacles that overlap this wall are
 * kept. An obstacle hides the pair if it covers the cross-section of the cone in the plane of its own centre and if
 * the spheres lie on different sides of this plane. */
bool LANED(fibrad_surface_filter)(fibrad_surface_task *task, const fibrad_surface_frame *frame,
                                  const fibrad_obstacles *all, uint32_t self) {
    const double slope = (1 - task->r2) / task->d;
    const vd sine = vd_set1(slope), cosine = vd_set1(fibrad_sqrt((1 - slope) * (1 + slope)));
    const vd low = sine, high = vd_set1(task->d + task->r2 * slope), one = vd_set1(1);
    bool hidden = false;
    task->obstacles.n = 0;
    for (uint32_t k = 0; k < all->n; k += VD_LANES) {
        const vd cx = vd_load(all->x + k) - frame->origin[0], cy = vd_load(all->y + k) - frame->origin[1];
        const vd cz = vd_load(all->z + k) - frame->origin[2];
        const vd x = dot_row(frame->x, cx, cy, cz), y = dot_row(frame->y, cx, cy, cz);
        const vd z = dot_row(frame->z, cx, cy, cz), r = vd_load(all->r + k) * frame->scale;
        const vd aside = vd_sqrt(x * x + y * y), slack = SURFACE_MARGIN * (aside + vd_abs(z) + (high + r));
        const vd wide = r + slack, depth = one - z * sine; /* from the axis to the cone */
        const vm in_cone = vd_lt(aside * cosine - depth, wide), between = vd_lt(low, z + wide) & vd_lt(z - wide, high);
        const vm covers =
            vd_le((aside + slack) * cosine + depth, r * cosine) & vd_le(one, z) & vd_le(z, vd_set1(task->d - task->r2));
        uint32_t valid = vd_lanes_below(all->n - k);
        if (self - k < VD_LANES) valid &= ~(1u << (self - k));
        if ((vm_bits(covers) & valid) != 0) hidden = true;
        uint32_t keep = task->flags & FIBRAD_SURFACE_NO_REGION ? valid : valid & vm_bits(in_cone & between);
        if (keep != 0) append_obstacles(&task->obstacles, keep, x, y, z, r);
    }
    return hidden;
}

/* Fills `list` with the obstacles that can hide a part of sphere 2 from the node (x, y, z) of sphere 1. The positions
 * in the list are relative to the node. The power c^2 - r^2 takes the place of the radius. Returns true if all of
 * sphere 2 is hidden. As seen from the node, sphere 2 and an obstacle are two cones. The scalar product of their axes
 * tells whether they are apart and whether one lies within the other. Obstacles below the horizon of the node do not
 * count. The farthest visible points of sphere 2 are as far as a tangent is long. Obstacles beyond them do not count.
 * From a node inside an obstacle nothing is visible. */
static bool obstacles_of_node(const fibrad_surface_task *task, double x, double y, double z, fibrad_obstacles *list) {
    const fibrad_obstacles *all = &task->obstacles;
    const double axis_z = task->d - z, far2 = x * x + y * y + axis_z * axis_z;
    const double tangent2 = fibrad_max(0, far2 - task->r2 * task->r2), tangent = fibrad_sqrt(tangent2);
    const double front = fibrad_sqrt(far2) - task->r2;
    const vd px = vd_set1(x), py = vd_set1(y), pz = vd_set1(z), zero = vd_set1(0), far = vd_set1(far2);
    const vd ax = zero - px, ay = zero - py, az = vd_set1(axis_z), tt = vd_set1(tangent2), r2 = vd_set1(task->r2);
    list->n = 0;
    for (uint32_t k = 0; k < all->n; k += VD_LANES) {
        const vd cx = vd_load(all->x + k) - px, cy = vd_load(all->y + k) - py;
        const vd cz = vd_load(all->z + k) - pz, r = vd_load(all->r + k), rr = r * r;
        const vd cc = dot(cx, cy, cz, cx, cy, cz), power = cc - rr, slack = SURFACE_MARGIN * (cc + far);
        const vd axes = dot(cx, cy, cz, ax, ay, az), height = dot(cx, cy, cz, px, py, pz);
        const vd cosines = vd_sqrt(vd_max(power, zero) * tt), sines = r * r2, extent = tt + 2 * tangent * r;
        const vm inside = vd_lt(power, zero);
        const vm apart =
            vd_lt(axes + sines + slack, cosines) | vd_lt(extent + slack, power) | vd_lt(height + r + slack, zero);
        const vm covers = vd_lt(cosines + slack, axes - sines) & vd_lt(r2 * r2 * cc, rr * far) &
                          vd_lt(cc + slack, vd_set1(front * front));
        uint32_t valid = vd_lanes_below(all->n - k), keep = valid;
        if ((vm_bits(inside) & valid) != 0) return true;
        if ((vm_bits(covers) & valid) != 0 && (task->flags & FIBRAD_SURFACE_NO_HIDDEN) == 0) return true;
        if ((task->flags & FIBRAD_SURFACE_NO_REGION) == 0) keep &= ~vm_bits(apart);
        if (keep != 0) append_obstacles(list, keep, cx, cy, cz, power);
    }
    return false;
}

/* The lanes whose ray e meets obstacle o before the ray ends. p > 0 is the power of the beginning of the ray, c the
 * centre, and b = c.e. The line meets the sphere if b^2 > p e^2, and ahead of the beginning if b > 0. It does so
 * before the end of e if e^2 > p, or if the end is inside the sphere: p + e^2 < 2 b. The last two conditions
 * together are 2 max(b, e^2) > p + e^2. */
static vm meets_obstacle(const fibrad_obstacles *list, uint32_t o, vd ex, vd ey, vd ez, vd ee, vd half_ee) {
    const vd p = vd_set1(list->r[o]), half_p = vd_set1(0.5 * list->r[o]);
    const vd b = dot_row((double[3]){list->x[o], list->y[o], list->z[o]}, ex, ey, ez);
    return vd_lt(vd_set1(0), b) & vd_lt(p * ee, b * b) & vd_lt(half_p, vd_max(b, ee) - half_ee);
}

static double sum_of_parts(const vd part[SURFACE_STEPS]) {
    _Alignas(64) double s[PARTIAL_SUMS];
    for (uint32_t step = 0; step < SURFACE_STEPS; step++) vd_store(s + step * VD_LANES, part[step]);
    return ((s[0] + s[4]) + (s[2] + s[6])) + ((s[1] + s[5]) + (s[3] + s[7]));
}

/* A node of sphere 1 in all lanes: its position, its normal times its weight, and the obstacles that hide parts of
 * sphere 2. */
typedef struct surface_origin {
    vd px, py, nx, ny, nz;
    bool hidden; /* whether all of sphere 2 is hidden */
    const fibrad_obstacles *near;
} surface_origin;

/* Adds to the partial sums *open and *seen the rays from a node to the nodes u of sphere 2, which are relative to
 * its centre. ez: height of these nodes above the node. */
FIBRAD_INLINE void add_rays(const surface_origin *from, vd ux, vd uy, vd uz, vd ez, vd weight, vd *open, vd *seen,
                            fibrad_surface_sums *sums) {
    const vd zero = vd_set1(0), ex = ux - from->px, ey = uy - from->py;
    const vd cos1 = dot(from->nx, from->ny, from->nz, ex, ey, ez), cos2 = zero - dot(ux, uy, uz, ex, ey, ez);
    const vm facing = vd_lt(zero, cos1) & vd_lt(zero, cos2);
    if (vm_bits(facing) == 0) return;
    sums->rays += VD_LANES;
    const vd ee = dot(ex, ey, ez, ex, ey, ez), half_ee = 0.5 * ee;
    const vd g = vd_select(facing, cos1 * cos2 * weight / (ee * ee), zero);
    *open += g;
    if (from->hidden) return;
    vm clear = facing;
    for (uint32_t o = 0; o < from->near->n && vm_bits(clear) != 0; o++) {
        clear &= vm_not(meets_obstacle(from->near, o, ex, ey, ez, ee, half_ee));
        sums->tests += VD_LANES;
    }
    *seen += vd_select(clear, g, zero);
}

/* Takes the nodes of sphere 1 one by one. For each it takes the nodes of sphere 2, and these nodes turned by pi
 * about the line of centres. The nodes of both spheres are in order of z. The horizons are the circles where the
 * common cone touches the spheres. So they exclude the first or the last nodes of a list. */
void LANED(fibrad_surface_sum)(const fibrad_surface_task *task, fibrad_surface_sums *sums) {
    const fibrad_surface_nodes *nodes = &task->nodes;
    const double horizon = (1 - task->r2) / task->d;
    uint32_t first = 0, end = nodes->n;
    if ((task->flags & FIBRAD_SURFACE_NO_HORIZON) == 0) {
        while (first < nodes->n && nodes->z[first] < horizon - SURFACE_MARGIN) first++;
        while (end > 0 && nodes->z[end - 1] > horizon + SURFACE_MARGIN) end--;
    }
    fibrad_obstacles near = task->of_node;
    const vd zero = vd_set1(0);
    vd open[2][SURFACE_STEPS], seen[2][SURFACE_STEPS];
    for (uint32_t step = 0; step < SURFACE_STEPS; step++)
        open[0][step] = open[1][step] = seen[0][step] = seen[1][step] = zero;
    sums->rays = sums->tests = 0;

    for (uint32_t k = first; k < nodes->n; k++) {
        const double x = nodes->ring[k] * nodes->cos[k], y = nodes->ring[k] * nodes->sin[k], z = nodes->z[k];
        const vd px = vd_set1(x), py = vd_set1(y), weight1 = vd_set1(nodes->weight[k]);
        const bool hidden = obstacles_of_node(task, x, y, z, &near);
        const surface_origin from = {px, py, weight1 * px, weight1 * py, weight1 * z, hidden, &near};
        for (uint32_t group = 0; group < end; group += PARTIAL_SUMS)
            for (uint32_t step = 0; step < SURFACE_STEPS; step++) {
                const uint32_t l = group + step * VD_LANES;
                const vd ring = task->r2 * vd_load(nodes->ring + l), weight2 = vd_load(nodes->weight + l);
                const vd uz = task->r2 * vd_load(nodes->z + l), ez = uz + (task->d - z);
                vd ux = ring * vd_load(nodes->cos + l), uy = ring * vd_load(nodes->sin + l);
                for (uint32_t turn = 0; turn < 2; turn++, ux = zero - ux, uy = zero - uy)
                    add_rays(&from, ux, uy, uz, ez, weight2, &open[turn][step], &seen[turn][step], sums);
            }
    }
    for (uint32_t turn = 0; turn < 2; turn++) {
        sums->open[turn] = sum_of_parts(open[turn]);
        sums->seen[turn] = sum_of_parts(seen[turn]);
    }
#if VD_LANES >= 4
    /* gcc 12 does not do this after calls of static functions. SSE code of the caller would then take three times as
     * long. */
    _mm256_zeroupper();
#endif
}
