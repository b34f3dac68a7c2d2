/* lit.h - what spheres and walls take of a light first. SPDX-License-Identifier: MIT */
#ifndef TESTS_LIT_H
#define TESTS_LIT_H

#include "fibrad_light.h"
#include "scenes.h"

/* What a light does in a bed. The whole is computed on one thread, in ranges of seven spheres. */
struct lit {
    double *power;
    fibrad_light_ends ends, empty;
    int status;
    fibrad_fault fault;
};

enum { RANGE = 7 };

static inline void *grow(void *context, void *block, size_t size) {
    (void)context;
    return realloc(block, size);
}

static inline struct lit light_up(const struct bed *bed, const fibrad_scene_config *config, const fibrad_light *light) {
    struct lit lit = {.power = calloc(bed->n + 1, sizeof(double))};
    const size_t size =
        fibrad_scene_size(bed->n, 0) + (config->triangles ? fibrad_triangles_size(config->triangles->n, bed->n) : 0);
    void *block = block_of(size);
    fibrad_scene *scene;
    fibrad_work work = {.memory = {.resize = grow}};
    const fibrad_spheres spheres = {.x = bed->x, .y = bed->y, .z = bed->z, .r = bed->r, .n = bed->n};
    ck_assert_int_eq(fibrad_scene_init(&scene, block, size, config, &spheres, NULL), 0);
    lit.status = fibrad_light_empty(scene, &work, light, &lit.empty, &lit.fault);
    lit.ends = lit.empty;
    for (uint32_t from = 0; from < bed->n && lit.status == 0; from += RANGE) {
        const uint32_t to = from + RANGE < bed->n ? from + RANGE : bed->n;
        fibrad_light_ends kept;
        ck_assert_int_eq(fibrad_light_spheres(scene, &work, light, from, to, lit.power + from, &kept), 0);
        lit.ends.spheres += kept.spheres, lit.ends.through -= kept.through;
        for (int b = 0; b < FIBRAD_BODIES_MAX; b++) lit.ends.body[b] -= kept.body[b];
    }
    free(block), free(work.memory.block);
    return lit;
}

static inline double sum_of(const fibrad_light_ends *ends) {
    double sum = ends->spheres + ends->through;
    for (int b = 0; b < FIBRAD_BODIES_MAX; b++) sum += ends->body[b];
    return sum;
}

static inline fibrad_light along(double x, double y, double z) {
    return (fibrad_light){.direction = {x, y, z}, .flux = 1};
}

#endif
