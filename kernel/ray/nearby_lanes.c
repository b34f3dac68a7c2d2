/* nearby_lanes.c - makes lists of the spheres near a ball. Compiled once per instruction set.
 * SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "base/lanes/below.h"
#include "near/cull_lanes.h"
#include "ray/tracer.h"
#include "scene/grid_walk.h"

/* A list has the spheres up to REACH mean spacings beyond the surface of its ball, or as many as it has room for. */
#define REACH 1.8

/* Candidates are put in order by their clearance, in so many steps. */
#define STEPS 64

/* Lists the spheres with a clearance of at most `limit` radii from the ball. False: there is no room. */
static bool gather_candidates(const fibrad_tracer *tracer, const fibrad_ball *from, double limit, uint32_t *count) {
    const fibrad_scene scene = *tracer->scene;
    const fibrad_candidates to = tracer->candidates;
    const double *centre = from->centre;
    const vd inverse = vd_set1(1 / from->radius), most = vd_set1(limit);
    uint32_t n = 0, told = 0;
    for (uint32_t l = 0; l < scene.levels; l++) {
        fibrad_walk walk;
        fibrad_walk_about(&walk, tracer->scene, &scene.level[l], centre, centre,
                          limit * from->radius + scene.level[l].radius_max);
        while (fibrad_walk_next(&walk)) {
            for (uint32_t j = walk.begin; j < walk.end; j += VD_LANES) {
                const vd x = (vd_loadu(scene.x + j) - centre[0] + walk.shift[0]) * inverse;
                const vd y = (vd_loadu(scene.y + j) - centre[1] + walk.shift[1]) * inverse;
                const vd z = (vd_loadu(scene.z + j) - centre[2] + walk.shift[2]) * inverse;
                const vd r = vd_loadu(scene.r + j) * inverse, clearance = vd_sqrt(x * x + y * y + z * z) - r;
                uint32_t bits = vm_bits(vd_le(clearance, most)) & vd_lanes_below(walk.end - j);
                if (!walk.image && from->place - j < VD_LANES) bits &= ~(1u << (from->place - j));
                if (n + VD_LANES > FIBRAD_CANDIDATES) return false;
                vd_compress(to.x + n, bits, x);
                vd_compress(to.y + n, bits, y);
                vd_compress(to.z + n, bits, z);
                vd_compress(to.r + n, bits, r);
                vd_compress(to.clearance + n, bits, clearance);
                n += vd_compress_places(to.sphere + n, bits, j);
            }
            for (; told < n; told++)
                for (int axis = 0; axis < 3; axis++) to.periods[told][axis] = (int8_t)walk.periods[axis];
        }
    }
    *count = n;
    return true;
}

/* Sorts candidates by clearance, but for the order within a step. */
static void order_candidates(const fibrad_candidates *of, uint32_t count, double limit) {
    uint32_t end[STEPS + 1] = {0};
    const double scale = (STEPS - 1) / limit;
    for (uint32_t k = 0; k < count; k++) {
        of->step[k] = (uint8_t)fibrad_max(0, of->clearance[k] * scale);
        end[of->step[k] + 1]++;
    }
    for (uint32_t step = 1; step < STEPS; step++) end[step] += end[step - 1];
    for (uint32_t k = 0; k < count; k++) of->order[end[of->step[k]]++] = (uint16_t)k;
}

/* Rays start at distance 1 from the centre. The other terms allow for rounding. */
static double length_for(double clearance) { return clearance * (1 - 1e-9) - 1 - 1e-9; }

void LANED(fibrad_nearby_make)(const fibrad_tracer *tracer, const fibrad_ball *from, fibrad_nearby *list) {
    const fibrad_scene *scene = tracer->scene;
    const fibrad_candidates *of = &tracer->candidates;
    double reach = REACH * scene->spacing / from->radius;
    for (int axis = 0; axis < 3; axis++) /* the numbers of periods must fit into bytes */
        if (scene->period[axis] > 0) reach = fibrad_min(reach, 60 * scene->period[axis] / from->radius);
    double limit = 1 + reach;
    uint32_t count = 0;
    while (!gather_candidates(tracer, from, limit, &count)) {
        if (limit > 1.001) {
            limit = 1 + (limit - 1) / 2;
        } else { /* hundreds of small spheres touch this sphere: the grid serves its rays */
            count = 0, limit = 0;
            break;
        }
    }
    order_candidates(of, count, limit);
    for (uint32_t k = 0; k < count; k += VD_LANES) {
        const vd x = vd_load(of->x + k), y = vd_load(of->y + k), z = vd_load(of->z + k);
        const sphere_cull cull = cull_of_sphere(x, y, z, vd_load(of->r + k));
        vd_store_float(of->fx + k, cull.x);
        vd_store_float(of->fy + k, cull.y);
        vd_store_float(of->fz + k, cull.z);
        vd_store_float(of->fq + k, cull.q);
    }
    const uint32_t listed = count < FIBRAD_NEARBY ? count : FIBRAD_NEARBY;
    for (uint32_t k = listed; k < count; k++) limit = fibrad_min(limit, of->clearance[of->order[k]]);
    double farthest = 1;
    list->groups = (listed + FIBRAD_GROUP - 1) / FIBRAD_GROUP;
    list->clear[list->groups] = length_for(limit);
    for (uint32_t g = list->groups; g-- > 0;) {
        fibrad_nearby_group *group = &list->group[g];
        double least = limit;
        for (uint32_t k = 0; k < FIBRAD_GROUP; k++) {
            const bool there = g * FIBRAD_GROUP + k < listed;
            const uint32_t s = there ? of->order[g * FIBRAD_GROUP + k] : 0;
            group->x[k] = of->fx[s], group->y[k] = of->fy[s], group->z[k] = of->fz[s];
            group->q[k] = there ? of->fq[s] : FLT_MAX;
            group->sphere[k] = of->sphere[s];
            fibrad_copy(group->periods[k], of->periods[s], sizeof group->periods[k]);
            least = fibrad_min(least, of->clearance[s]);
            farthest = fibrad_max(farthest, of->clearance[s] + of->r[s]);
        }
        list->clear[g] = fibrad_min(length_for(least), list->clear[g + 1]);
    }
    list->behind = (float)(2e-6 * fibrad_min(farthest, 1e18));
}
