/* triangle_views.c - view factors from triangles to spheres, walls and surroundings. SPDX-License-Identifier: MIT */
#include "base/elementary.h"
#include "base/sobol.h"
#include "base/vector.h"
#include "ray/tracer.h"
#include "scene/walls.h"

#define RAYS_MOST (1u << 30)

/* A direction by the cosine law: the sum of the normal and an even point of the unit sphere, normalised. */
static bool direction_from(const double normal[3], const double x[2], double w[3]) {
    fibrad_even_direction(x, w);
    for (int axis = 0; axis < 3; axis++) w[axis] += normal[axis];
    const double length = fibrad_sqrt(fibrad_dot(w, w));
    for (int axis = 0; axis < 3; axis++) w[axis] /= length;
    return length > 1e-9;
}

/* Counts of what rays meet. */
typedef struct view_counts {
    uint32_t rays, spheres, walls;
} view_counts;

/* Counts what a ray meets. FIBRAD_E_BACK: *seen is the index of the triangle. */
static int count_ray(const fibrad_scene *scene, uint32_t side, const double point[3], const double w[3],
                     view_counts *counts, uint32_t *seen) {
    double distance;
    fibrad_hit hit = {.sphere = FIBRAD_NONE};
    FIBRAD_VERSION_OF(fibrad_trace_point, scene->facts.isa)(scene, NULL, point, w, fibrad_side_triangle(side), &hit);
    counts->rays++;
    if (hit.sphere != FIBRAD_NONE) {
        counts->spheres++;
        return FIBRAD_OK;
    }
    const uint32_t wall = scene->container.walls ? fibrad_walls_exit(scene, point, w, &distance) : FIBRAD_NONE;
    const bool meshed = hit.side != FIBRAD_NO_SIDE && (wall == FIBRAD_NONE || hit.distance < distance);
    counts->walls += meshed || (wall != FIBRAD_NONE && !fibrad_is_opening(&scene->container, wall));
    *seen = meshed ? fibrad_side_triangle(hit.side) : *seen;
    return meshed && fibrad_scene_slot(scene, hit.side) == FIBRAD_NONE ? FIBRAD_E_BACK : FIBRAD_OK;
}

static int view_of_side(const fibrad_scene *scene, const fibrad_sobol *sobol, uint32_t side, uint32_t rays,
                        fibrad_side_view *view, uint32_t *seen) {
    const fibrad_mesh *mesh = &scene->mesh;
    const uint64_t shift = fibrad_mix(fibrad_side_given(mesh, side));
    view_counts counts = {0, 0, 0};
    double normal[3], point[3], w[3], x[4];
    uint32_t bits[8] = {0};
    int status = FIBRAD_OK;
    *view = (fibrad_side_view){__builtin_nan(""), __builtin_nan(""), __builtin_nan("")};
    if (fibrad_scene_slot(scene, side) == FIBRAD_NONE ||
        !(fibrad_mesh_triangle_area(mesh, fibrad_side_triangle(side)) > 0))
        return FIBRAD_OK;
    fibrad_mesh_normal(mesh, side, normal);
    for (uint32_t k = 0; k < rays && status == FIBRAD_OK; k++) {
        fibrad_sobol_move(sobol, k > 0 ? k - 1 : 0, k, bits);
        for (uint64_t d = 0; d < 4; d++)
            x[d] = fibrad_fraction(((uint64_t)bits[d] << 32 | UINT64_C(1) << 31) ^ fibrad_mix(shift + d));
        fibrad_mesh_triangle_point(mesh, fibrad_side_triangle(side), x, point);
        if (!fibrad_walls_hold(&scene->container, point) || !direction_from(normal, x + 2, w)) continue;
        status = count_ray(scene, side, point, w, &counts, seen);
    }
    if (status != FIBRAD_OK || counts.rays == 0) return status;
    view->spheres = (double)counts.spheres / counts.rays;
    view->walls = (double)counts.walls / counts.rays;
    view->escaped = (double)(counts.rays - counts.spheres - counts.walls) / counts.rays;
    return FIBRAD_OK;
}

int fibrad_triangle_views(const fibrad_scene *scene, uint32_t place, uint32_t rays, uint32_t *triangle,
                          fibrad_side_view view[2]) {
    fibrad_sobol sobol;
    if (scene == NULL || triangle == NULL || view == NULL || rays < 1 || rays > RAYS_MOST) return FIBRAD_E_ARGUMENT;
    if (!fibrad_scene_ready(scene)) return FIBRAD_E_STATE;
    if (place >= scene->mesh.triangles) return FIBRAD_E_ARGUMENT;
    fibrad_side_view own[2];
    uint32_t seen = place;
    int status = FIBRAD_OK;
    fibrad_sobol_make(&sobol);
    for (uint32_t back = 0; back < 2 && status == FIBRAD_OK; back++)
        status = view_of_side(scene, &sobol, fibrad_side(place, back), rays, &own[back], &seen);
    *triangle = scene->mesh.number[status == FIBRAD_E_BACK ? seen : place];
    if (status == FIBRAD_OK) view[0] = own[0], view[1] = own[1];
    return status;
}
