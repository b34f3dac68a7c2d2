/* near_lanes.c - shells of spheres near the one in hand. Compiled once per instruction set. SPDX-License-Identifier:
 * MIT
 */
#include FIBRAD_LANES_HEADER
#include "bed/near_lanes.h"

/* What the sieves compare, for spheres [from, to) of the list. They are in floats and may let a sphere pass that the
 * exact test then refuses, but not the other way round: three products and two sums err by less than 4 ulp of the
 * distance, squares of them by less than 40 of its square. Beyond the range of floats they let all pass. */
static void floats(fibrad_near *near, uint32_t from, uint32_t to) {
    const vd one = vd_set1(1), zero = vd_set1(0);
    for (uint32_t k = from; k < to; k += VD_LANES) {
        vd x = vd_load(near->x + k), y = vd_load(near->y + k), z = vd_load(near->z + k), r = vd_load(near->r + k);
        vd square = vd_add(vd_add(vd_mul(x, x), vd_mul(y, y)), vd_mul(z, z)), wide = vd_add(one, r);
        vd size = vd_add(vd_add(vd_abs(x), vd_abs(y)), vd_abs(z)); /* at least the distance */
        vd e = vd_sqrt(vd_max(vd_sub(square, vd_mul(wide, wide)), zero)), about = vd_add(one, size);
        vd q = vd_sub(vd_add(square, one), vd_mul(r, r));
        vm small = vd_lt(size, vd_set1(1e18));
        vd_store_float(near->fx + k, vd_select(small, x, zero));
        vd_store_float(near->fy + k, vd_select(small, y, zero));
        vd_store_float(near->fz + k, vd_select(small, z, zero));
        vd_store_float(near->fe + k, vd_select(small, vd_sub(e, vd_mul(vd_set1(1e-6), size)), vd_set1(-1)));
        q = vd_sub(q, vd_mul(vd_set1(4e-6), vd_mul(about, about)));
        vd_store_float(near->fq + k, vd_select(small, q, vd_set1(-FLT_MAX)));
    }
}

/* Appends those of spheres [begin, end) whose squared emergence lies in (from, to]. False: no room. */
static bool collect(fibrad_work *work, const fibrad_walk *walk, double from, double to, uint32_t *count) {
    const fibrad_near near = work->near; /* copies: what is stored cannot change their pointers */
    const fibrad_scene scene = *work->scene;
    uint32_t n = *count;
    bool image = walk->shift[0] != 0 || walk->shift[1] != 0 || walk->shift[2] != 0;
    vd inverse = vd_set1(work->inverse), reach = vd_set1(work->reach * work->reach);
    for (uint32_t j = walk->begin; j < walk->end; j += VD_LANES) {
        vd x = vd_sub(vd_loadu(scene.x + j), vd_set1(work->centre[0]));
        vd y = vd_sub(vd_loadu(scene.y + j), vd_set1(work->centre[1]));
        vd z = vd_sub(vd_loadu(scene.z + j), vd_set1(work->centre[2]));
        x = vd_mul(vd_add(x, vd_set1(walk->shift[0])), inverse);
        y = vd_mul(vd_add(y, vd_set1(walk->shift[1])), inverse);
        z = vd_mul(vd_add(z, vd_set1(walk->shift[2])), inverse);
        vd r = vd_mul(vd_loadu(scene.r + j), inverse), wide = vd_add(vd_set1(1), r);
        vd square = vd_add(vd_add(vd_mul(x, x), vd_mul(y, y)), vd_mul(z, z)), e = vd_sub(square, vd_mul(wide, wide));
        uint32_t bits = vm_bits(vm_and(vm_and(vd_lt(vd_set1(from), e), vd_le(e, vd_set1(to))), vd_le(square, reach)));
        if (walk->end - j < VD_LANES) bits &= (1u << (walk->end - j)) - 1;
        if (!image && work->place - j < VD_LANES) bits &= ~(1u << (work->place - j));
        if (n + VD_LANES > near.capacity) return false;
        vd_compress(near.x + n, bits, x);
        vd_compress(near.y + n, bits, y);
        vd_compress(near.z + n, bits, z);
        vd_compress(near.r + n, bits, r);
        n += vd_compress_places(near.sphere + n, bits, j);
    }
    *count = n;
    return true;
}

void LANED(fibrad_near_extend)(fibrad_work *work) {
    const fibrad_scene *scene = work->scene;
    fibrad_near *near = &work->near;
    uint32_t shell = near->shells, begin = shell > 0 ? near->end[shell - 1] : 0, count = begin;
    double from = shell > 0 ? near->limit[shell - 1] : 0;
    double to = shell > 0 ? work->growth * from : work->step;
    near->full = shell == FIBRAD_SHELLS;
    for (uint32_t l = 0; l < scene->levels && !near->full; l++) {
        double wide = 1 + scene->level[l].radius_max * work->inverse;
        double ball = fibrad_min(fibrad_sqrt(to * to + wide * wide), work->reach) * work->unit, low[3], high[3];
        for (int axis = 0; axis < 3; axis++)
            low[axis] = work->centre[axis] - ball, high[axis] = work->centre[axis] + ball;
        fibrad_walk walk;
        fibrad_walk_begin(&walk, scene, &scene->level[l], low, high);
        while (!near->full && fibrad_walk_next(&walk))
            near->full = !collect(work, &walk, shell > 0 ? from * from : -__builtin_inf(), to * to, &count);
    }
    if (near->full) return;
    for (; count % 16 != 0; count++) { /* the capacity is a multiple of 16 */
        near->x[count] = near->y[count] = near->z[count] = near->r[count] = 0;
        near->sphere[count] = 0;
    }
    floats(near, begin, count);
    for (uint32_t k = begin; k < count; k++) near->entry[k] = FIBRAD_NONE;
    near->end[shell] = count;
    near->limit[shell] = to;
    near->shells++;
}

/* Leaves out the discs from number `from` on that do not overlap the window or do not lie ahead. */
static void leave_out(fibrad_work *work, uint32_t from) {
    const fibrad_discs disc = work->disc;
    uint32_t to = from;
    for (uint32_t k = from; k < disc.count; k++) {
        double depth = disc.depth[k], u = disc.u[k], v = disc.v[k], wide = 1 + disc.r[k];
        disc.depth[to] = depth, disc.u[to] = u, disc.v[to] = v, disc.r[to] = disc.r[k], disc.near[to] = disc.near[k];
        to += u * u + v * v < wide * wide && fibrad_work_ahead(work, depth, u, v, fibrad_work_sphere(work, k));
    }
    work->disc.count = to;
}

static inline vd along(const double a[3], vd x, vd y, vd z) {
    return vd_add(vd_add(vd_mul(vd_set1(a[0]), x), vd_mul(vd_set1(a[1]), y)), vd_mul(vd_set1(a[2]), z));
}

void LANED(fibrad_near_discs)(fibrad_work *work, const double frame[9], uint32_t found) {
    const fibrad_near near = work->near; /* copies: what is stored cannot change their pointers */
    const fibrad_discs disc = work->disc;
    uint32_t from = disc.count, end = from + found;
    if (end > disc.capacity) {
        work->disc.count = end;
        return;
    }
    fibrad_zero(disc.near + end, VD_LANES * sizeof *disc.near); /* looked up, too, in the last vector */
    uint32_t outside = 0;                                       /* of the window, or not surely ahead */
    for (uint32_t k = from; k < end; k += VD_LANES) {
        const uint32_t *place = disc.near + k;
        vd x = vd_gather(near.x, place), y = vd_gather(near.y, place), z = vd_gather(near.z, place);
        vd u = along(frame, x, y, z), v = along(frame + 3, x, y, z), depth = along(frame + 6, x, y, z);
        vd r = vd_gather(near.r, place), wide = vd_add(vd_set1(1), r);
        vm overlaps = vd_lt(vd_add(vd_mul(u, u), vd_mul(v, v)), vd_mul(wide, wide));
        vm ahead = vd_lt(vd_set1(0), depth);
        vd_storeu(disc.u + k, u);
        vd_storeu(disc.v + k, v);
        vd_storeu(disc.r + k, r);
        vd_storeu(disc.depth + k, depth);
        uint32_t lanes = end - k < VD_LANES ? end - k : VD_LANES;
        outside |= ~vm_bits(vm_and(overlaps, ahead)) & ((1u << lanes) - 1);
    }
    work->disc.count = end;
    if (outside != 0) leave_out(work, from);
}
