/* light.c - the light that comes to spheres and walls straight from outside. SPDX-License-Identifier: MIT */
#include "light/light.h"
#include "base/constants.h"

int fibrad_light_check(const fibrad_scene *scene, const fibrad_light *light, fibrad_fault *fault) {
    if (scene == NULL || light == NULL) return FIBRAD_E_ARGUMENT;
    if (!fibrad_scene_ready(scene)) return FIBRAD_E_STATE;
    const uint32_t n = scene->facts.spheres;
    fibrad_fault found = {n, n, UINT32_MAX, 0, fibrad_light_why(scene, light)};
    if (found.why == FIBRAD_WHY_UNSAID && light->shape == FIBRAD_LIGHT_DISC) {
        const uint32_t before = fibrad_light_obstacle(scene, light);
        if (before != FIBRAD_NONE) found.first = found.second = before, found.why = FIBRAD_WHY_FOOTPRINT;
    }
    if (fault != NULL) *fault = found;
    return found.why == FIBRAD_WHY_UNSAID ? FIBRAD_OK : FIBRAD_E_ARGUMENT;
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

/* Adds what one sphere takes in one direction. */
static int take_one(const fibrad_scene *scene, fibrad_workspace *space, uint32_t place, double *power,
                    fibrad_light_ends *kept) {
    fibrad_footprint *f = fibrad_light_footprint(space);
    const double centre[3] = {scene->x[place], scene->y[place], scene->z[place]};
    double area[FIBRAD_SLOTS] = {0}, open = 0, uv[2];
    const int status =
        FIBRAD_VERSION_OF(fibrad_sunlit, scene->facts.isa)(scene, space, place, f->frame, NULL, &open, &f->unshadowed);
    if (status != FIBRAD_OK) return status;
    fibrad_footprint_place(f, centre, uv);
    if (open > 0) fibrad_footprint_share(f, &space->areas, open, uv, scene->r[place], area);
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++) *power += f->flux * area[slot];
    fibrad_light_add_ends(scene, area, f->flux, kept);
    return FIBRAD_OK;
}

/* All directions of a light, once. Errors: as of one sphere; FIBRAD_E_ARGUMENT: no open face lets the light in. */
static int take_all(const fibrad_scene *scene, fibrad_workspace *space, const fibrad_light *light, uint32_t from,
                    uint32_t to, double *power, fibrad_light_ends *kept) {
    const uint32_t count = fibrad_light_count(light);
    double all = 0;
    int status = FIBRAD_OK;
    *kept = (fibrad_light_ends){0};
    fibrad_zero(power, (to - from) * sizeof *power);
    for (uint32_t k = 0; k < count && status == FIBRAD_OK; k++) {
        fibrad_footprint_make(fibrad_light_footprint(space), scene, light, k);
        all += fibrad_footprint_area(fibrad_light_footprint(space));
        for (uint32_t i = from; i < to && status == FIBRAD_OK; i++)
            status = take_one(scene, space, scene->place[i], &power[i - from], kept);
    }
    for (uint32_t i = from; i < to; i++) kept->spheres += power[i - from];
    return status != FIBRAD_OK || all > 0 ? status : FIBRAD_E_ARGUMENT;
}

/* The powers are added up in work memory, so that an error leaves those of the caller as they are. */
int fibrad_light_spheres(const fibrad_scene *scene, fibrad_work *work, const fibrad_light *light, uint32_t from,
                         uint32_t to, double *power, fibrad_light_ends *kept) {
    fibrad_workspace *space;
    fibrad_light_ends sum;
    if (work == NULL || kept == NULL || (to > from && power == NULL)) return FIBRAD_E_ARGUMENT;
    int status = fibrad_light_check(scene, light, NULL);
    if (status == FIBRAD_OK && (from > to || to > scene->facts.spheres)) status = FIBRAD_E_ARGUMENT;
    const size_t bytes = (to - from) * sizeof *power;
    if (status == FIBRAD_OK) status = fibrad_light_open(scene, work, bytes, &space);
    while (status == FIBRAD_OK) {
        status = take_all(scene, space, light, from, to, fibrad_light_scratch(space), &sum);
        if (status != FIBRAD_E_WORK) break;
        status = fibrad_light_grow(work, bytes, &space);
    }
    if (status != FIBRAD_OK) return status;
    if (bytes > 0) fibrad_copy(power, fibrad_light_scratch(space), bytes);
    *kept = sum;
    return FIBRAD_OK;
}
