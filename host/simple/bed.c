/* bed.c - a bed: its scene and its threads. SPDX-License-Identifier: MIT */
#include "simple/bed.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "simple/contact_list.h"

int fibrad_bed_begin(fibrad_bed *bed) {
    if (!bed) return FIBRAD_E_ARGUMENT;
    if (bed->busy) return FIBRAD_E_STATE;
    bed->busy = true;
    bed->fault = (fibrad_fault){bed->facts.spheres, bed->facts.spheres, UINT32_MAX, 0, 0};
    return FIBRAD_OK;
}

int fibrad_bed_end(fibrad_bed *bed, int status) {
    bed->busy = false;
    return status;
}

/* Copies `size` bytes to *place, a multiple of 8 bytes further on each time, and has *pointer point to them. Without a
 * place counts the bytes alone. */
static void copy_bytes(char **place, size_t *count, const void **pointer, size_t size) {
    *count += (size + 7) / 8 * 8;
    if (!*place || !size) return;
    memcpy(*place, *pointer, size);
    *pointer = *place;
    *place += (size + 7) / 8 * 8;
}

/* Copies a strided array of n doubles in the same way. */
static void copy_doubles(char **place, size_t *count, const double **pointer, size_t n, size_t stride) {
    double *to = (double *)(void *)*place;
    *count += n * sizeof *to;
    if (!to || !n) return;
    for (size_t i = 0; i < n; ++i) to[i] = (*pointer)[i * stride];
    *pointer = to;
    *place += n * sizeof *to;
}

/* What was given of a bed, as its contacts are found from it. */
struct given {
    fibrad_scene_config config;
    fibrad_spheres spheres;
    fibrad_triangles triangles;
};

/* Copies all arrays behind `given` to `place`; NULL: only counts. Returns the bytes. */
static size_t copy_given(struct given *given, char *place) {
    fibrad_spheres *s = &given->spheres;
    fibrad_triangles *t = &given->triangles;
    const size_t stride = s->stride ? s->stride : 1, stride_r = s->stride_r ? s->stride_r : 1,
                 stride_t = t->stride ? t->stride : 1;
    size_t count = 0;
    copy_doubles(&place, &count, &s->x, s->n, stride);
    copy_doubles(&place, &count, &s->y, s->n, stride);
    copy_doubles(&place, &count, &s->z, s->n, stride);
    copy_doubles(&place, &count, &s->r, s->n, stride_r);
    copy_bytes(&place, &count, (const void **)&s->clump, s->clump ? s->n * sizeof *s->clump : 0);
    copy_bytes(&place, &count, (const void **)&given->config.wall, given->config.walls * sizeof *given->config.wall);
    copy_doubles(&place, &count, &t->x, t->vertices, stride_t);
    copy_doubles(&place, &count, &t->y, t->vertices, stride_t);
    copy_doubles(&place, &count, &t->z, t->vertices, stride_t);
    copy_bytes(&place, &count, (const void **)&t->corner, 3 * (size_t)t->n * sizeof *t->corner);
    copy_bytes(&place, &count, (const void **)&t->front, (size_t)t->n * sizeof *t->front);
    copy_bytes(&place, &count, (const void **)&t->back, t->back ? (size_t)t->n * sizeof *t->back : 0);
    return count;
}

/* Keeps a copy of a config and of spheres that the scene has accepted. Errors: _MEMORY. */
static int keep_given(const fibrad_scene_config *config, const fibrad_spheres *spheres, struct given **out) {
    struct given given = {.spheres = *spheres};
    if (config) given.config = *config;
    if (config && config->triangles) given.triangles = *config->triangles;
    struct given *kept = malloc(sizeof *kept + copy_given(&given, NULL));
    if (!kept) return FIBRAD_E_MEMORY;
    copy_given(&given, (char *)(kept + 1));
    given.spheres.stride = given.spheres.stride_r = given.triangles.stride = 0;
    given.spheres.id = NULL;
    *kept = given;
    kept->config.triangles = given.triangles.n > 0 ? &kept->triangles : NULL;
    *out = kept;
    return FIBRAD_OK;
}

/* Goes over to another scene. Beams and lists of the last one are old. */
static int place_bed(fibrad_bed *bed, const fibrad_scene_config *config, const fibrad_spheres *spheres) {
    fibrad_scene *scene;
    void *block;
    struct given *given = NULL;
    fibrad_bodies *bodies = NULL;
    const uint32_t n = spheres->n;
    bed->fault = (fibrad_fault){n, n, UINT32_MAX, 0, 0};
    if (bed->scene && (n != bed->facts.spheres || (config ? config->walls : 0) != bed->facts.walls))
        return FIBRAD_E_ARGUMENT;
    int status = fibrad_heap_scene(&scene, &block, config, spheres, &bed->fault);
    if (!status) status = keep_given(config, spheres, &given);
    if (!status) status = fibrad_bodies_find(scene, spheres, &bodies);
    if (!status && bed->heat) status = fibrad_heat_move(bed->heat, scene);
    if (status && status != FIBRAD_E_SIZE) {
        free(block);
        free(given);
        free(bodies);
        return status;
    }
    if (status) { /* the moved walls need a larger block */
        free(bed->heat_block);
        bed->heat = NULL, bed->heat_block = NULL;
    }
    free(bed->scene_block);
    free(bed->given);
    free(bed->bodies);
    bed->scene = scene, bed->scene_block = block, bed->given = given, bed->bodies = bodies;
    bed->config = given->config, bed->spheres = given->spheres;
    bed->traced = false;
    fibrad_scene_describe(scene, &bed->facts);
    fibrad_stepping_move(bed);
    memset(bed->warning, 0, sizeof bed->warning);
    free(bed->contacts);
    bed->contacts = NULL;
    return FIBRAD_OK;
}

int fibrad_bed_new(fibrad_bed **out, const fibrad_scene_config *config, const fibrad_spheres *spheres,
                   fibrad_run *run) {
    if (!out) return FIBRAD_E_ARGUMENT;
    *out = NULL;
    if (run && spheres) run->fault = (fibrad_fault){spheres->n, spheres->n, UINT32_MAX, 0, 0};
    fibrad_bed *bed = spheres ? calloc(1, sizeof *bed) : NULL;
    if (!bed) return spheres ? FIBRAD_E_MEMORY : FIBRAD_E_ARGUMENT;
    int status = fibrad_team_open(&bed->team, run);
    if (!status) status = place_bed(bed, config, spheres);
    if (run && status) run->fault = bed->fault;
    if (status)
        fibrad_bed_free(bed);
    else
        *out = bed;
    return status;
}

int fibrad_bed_move(fibrad_bed *bed, const fibrad_scene_config *config, const fibrad_spheres *spheres) {
    if (!spheres) return FIBRAD_E_ARGUMENT;
    const int status = fibrad_bed_begin(bed);
    return status ? status : fibrad_bed_end(bed, place_bed(bed, config, spheres));
}

void fibrad_bed_describe(const fibrad_bed *bed, fibrad_scene_facts *facts, fibrad_fault *fault) {
    if (bed && facts) *facts = bed->facts;
    if (bed && fault) *fault = bed->fault;
}

uint32_t fibrad_bed_bodies(const fibrad_bed *bed, uint32_t *body) {
    if (!bed) return 0;
    for (uint32_t i = 0; i < bed->facts.spheres && body; ++i) body[i] = bed->bodies ? bed->bodies->body[i] : i;
    return bed->bodies ? bed->bodies->n : bed->facts.spheres;
}

int fibrad_bed_surfaces(const fibrad_bed *bed, double *area, double *volume) {
    if (!bed) return FIBRAD_E_ARGUMENT;
    for (uint32_t i = 0; i < bed->facts.spheres; ++i) {
        if (area) area[i] = fibrad_scene_exposed_area(bed->scene, i);
        if (volume) volume[i] = fibrad_scene_volume(bed->scene, i);
    }
    return FIBRAD_OK;
}

void fibrad_bed_free(fibrad_bed *bed) {
    if (!bed) return;
    fibrad_team_close(&bed->team);
    fibrad_stepping_free(&bed->stepping);
    free(bed->contacts);
    free(bed->heat_block);
    free(bed->scene_block);
    free(bed->given);
    free(bed->bodies);
    free(bed->light);
    free(bed->places);
    free(bed);
}

int fibrad_bed_contacts(fibrad_bed *bed, const fibrad_contact_rule *rule, const fibrad_contact_list **list) {
    if (!list) return FIBRAD_E_ARGUMENT;
    *list = NULL;
    int status = fibrad_bed_begin(bed);
    if (status) return status;
    free(bed->contacts);
    bed->contacts = NULL;
    status = fibrad_contacts_find(&bed->config, &bed->spheres, rule, &bed->contacts);
    *list = bed->contacts;
    return fibrad_bed_end(bed, status);
}

double fibrad_bed_wall_area(const fibrad_bed *bed, uint32_t wall) {
    return bed && wall < bed->facts.walls ? fibrad_scene_wall_area(bed->scene, wall) : NAN;
}
