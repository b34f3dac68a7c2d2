/* beyond.c - spheres that lie beyond a closed mesh. SPDX-License-Identifier: MIT
 *
 * Follow a ray from a sphere in its right place. The ray leaves each mesh that encloses the bed through the inner side,
 * once more often than it enters. It enters each other mesh as often as it leaves. */
#include "frames/warnings.h"

#include <math.h>

#include "cli/message.h"
#include "simple/bed.h"

enum { CROSSINGS_MOST = 10000 };
#define STEP_BEHIND 1e-6 /* in mean edges: the ray goes on from a point so far behind the triangle that it has met */

/* Finds a direction across open axes only. False: all axes are periodic. */
static bool open_direction(const struct bed *bed, double w[3]) {
    const double any[3] = {0.4330127, 0.5590170, 0.7071068};
    double square = 0;
    for (int axis = 0; axis < 3; ++axis) {
        w[axis] = bed->period[axis] > 0 ? 0 : any[axis];
        square += w[axis] * w[axis];
    }
    for (int axis = 0; axis < 3; ++axis) w[axis] /= sqrt(square);
    return square > 0;
}

/* How much more often a ray leaves closed meshes through their inner sides than it enters them. */
static int64_t times_left(const fibrad_scene *scene, const struct meshes *meshes, const double from[3],
                          const double w[3]) {
    double at[3] = {from[0], from[1], from[2]};
    fibrad_triangle_hit hit;
    int64_t times = 0;
    for (int k = 0; k < CROSSINGS_MOST; ++k) {
        if (fibrad_triangle_ray(scene, at, w, INFINITY, &hit) || hit.triangle == UINT32_MAX) break;
        const double on = hit.distance + STEP_BEHIND * mesh_of_triangle(meshes, hit.triangle)->surface.mean_edge;
        times += meshes_side(meshes, hit.triangle, hit.back);
        for (int axis = 0; axis < 3; ++axis) at[axis] += on * w[axis];
    }
    return times;
}

static void look_for_one(const struct bed *bed, const struct meshes *meshes, const fibrad_scene *scene,
                         const double w[3], const char *file) {
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double centre[3] = {bed->x[i], bed->y[i], bed->z[i]};
        if (times_left(scene, meshes, centre, w) == meshes->enclosing) continue;
        const char *name = meshes_beyond(meshes, centre, bed->r[i], bed->period);
        if (!name) continue;
        message_at(STATUS_OK, file, bed->line[i], "warning: all of sphere %lld lies beyond wall %s",
                   (long long)bed_name(bed, i), name);
        return;
    }
}

void warn_beyond(const fibrad_bed *made, const struct bed *bed, const struct walls *walls, const char *file) {
    bool any = false;
    double w[3];
    for (uint32_t t = 0; walls->meshes && t < walls->meshes->triangles.n && !any; ++t)
        any = meshes_side(walls->meshes, t, false) != 0;
    if (any && open_direction(bed, w)) look_for_one(bed, walls->meshes, made->scene, w, file);
}
