/* light.c - the light that comes to spheres and walls straight from outside. SPDX-License-Identifier: MIT */
#include "light/light.h"

int fibrad_light_check(const fibrad_scene *scene, const fibrad_light *light, fibrad_fault *fault) {
    if (scene == NULL || light == NULL) return FIBRAD_E_ARGUMENT;
    if (!fibrad_scene_ready(scene)) return FIBRAD_E_STATE;
    const uint32_t n = scene->facts.spheres;
    fibrad_fault found = {n, n, UINT32_MAX, 0, fibrad_light_why(scene, light)};
    if (found.why == FIBRAD_WHY_UNSAID && light->shape == FIBRAD_LIGHT_DISC) {
        const uint32_t before = fibrad_light_obstacle(scene, light);
        if (before != FIBRAD_NONE) found.first = found.second = before, found.why = FIBRAD_WHY_FOOTPRINT;
    }
    if (scene->facts.clumps > 0) found.why = FIBRAD_WHY_CLUMP_LIGHT; /* discs do not tell on which member light falls */
    if (fault != NULL) *fault = found;
    return found.why == FIBRAD_WHY_UNSAID        ? FIBRAD_OK
           : found.why == FIBRAD_WHY_CLUMP_LIGHT ? FIBRAD_E_UNSUPPORTED
                                                 : FIBRAD_E_ARGUMENT;
}

/* Gives the polygons of windows the room that is left after `extra` bytes of scratch. */
static void place_polygons(fibrad_workspace *space, size_t extra) {
    fibrad_unshadowed *unshadowed = &fibrad_light_footprint(space)->unshadowed;
    unsigned char *at = (unsigned char *)fibrad_light_scratch(space) +
                        (extra + FIBRAD_ALIGNMENT - 1) / FIBRAD_ALIGNMENT * FIBRAD_ALIGNMENT;
    const size_t used = (size_t)(at - (unsigned char *)space->extra);
    *unshadowed = (fibrad_unshadowed){.whole = true, .polygon = (void *)at};
    unshadowed->room =
        used < space->plan.extra ? (uint32_t)((space->plan.extra - used) / sizeof *unshadowed->polygon) : 0;
}

int fibrad_light_open(const fibrad_scene *scene, fibrad_work *work, size_t extra, fibrad_workspace **space) {
    const size_t polygons = scene->mesh.triangles > 0 ? FIBRAD_UNSHADOWED_FIRST * sizeof(fibrad_unshadowed_polygon) : 0;
    const size_t bytes = sizeof(fibrad_footprint) + 2 * FIBRAD_ALIGNMENT + extra + polygons;
    const int status = fibrad_work_open(work, scene, bytes, bytes, space);
    if (status != FIBRAD_OK) return status;
    (*space)->extra_owner = 0; /* who used `extra` before must write it again */
    place_polygons(*space, extra);
    return FIBRAD_OK;
}

int fibrad_light_grow(fibrad_work *work, size_t extra, fibrad_workspace **space) {
    const int status = fibrad_work_grow(work, space);
    if (status == FIBRAD_OK) place_polygons(*space, extra);
    return status;
}

fibrad_footprint *fibrad_light_footprint(const fibrad_workspace *space) {
    unsigned char *at = space->extra;
    return (void *)(at + fibrad_arena_lead(at));
}

double *fibrad_light_scratch(const fibrad_workspace *space) {
    return (void *)((unsigned char *)fibrad_light_footprint(space) + sizeof(fibrad_footprint));
}

void fibrad_light_add_ends(const fibrad_scene *scene, const double area[FIBRAD_SLOTS], double flux,
                           fibrad_light_ends *ends) {
    ends->through += flux * area[FIBRAD_ESCAPED];
    for (uint32_t b = 0; b < scene->facts.walls; b++) ends->wall[b] += flux * area[scene->slot[b]];
}

int fibrad_light_empty(const fibrad_scene *scene, fibrad_work *work, const fibrad_light *light, fibrad_light_ends *ends,
                       fibrad_fault *fault) {
    fibrad_workspace *space;
    if (work == NULL || ends == NULL) return FIBRAD_E_ARGUMENT;
    int status = fibrad_light_check(scene, light, fault);
    if (status == FIBRAD_OK) status = fibrad_light_open(scene, work, 0, &space);
    if (status != FIBRAD_OK) return status;
    fibrad_footprint *f = fibrad_light_footprint(space);
    const uint32_t count = fibrad_light_count(light);
    fibrad_light_ends sum = {0};
    double all = 0;
    for (uint32_t k = 0; k < count; k++) {
        double area[FIBRAD_SLOTS] = {0};
        fibrad_footprint_make(f, scene, light, k);
        for (uint32_t p = 0; p < f->pieces; p++) area[f->piece[p].slot] += f->piece[p].sign * f->piece[p].area;
        all += fibrad_footprint_area(f);
        fibrad_light_add_ends(scene, area, f->flux, &sum);
    }
    if (!(all > 0)) {
        if (fault != NULL) fault->why = FIBRAD_WHY_DARK;
        return FIBRAD_E_ARGUMENT;
    }
    *ends = sum;
    return FIBRAD_OK;
}
