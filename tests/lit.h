/* lit.h - what spheres and walls take of a light first. SPDX-License-Identifier: MIT */
#ifndef TESTS_LIT_H
#define TESTS_LIT_H

#include "fibrad_light.h"
#include "scenes.h"

/* What a light does in a bed. The whole is computed on one thread. */
struct lit {
    double *power;
    fibrad_light_ends ends, empty;
    int status;
    fibrad_fault fault;
};

static inline void lit_free(struct lit *lit) { free(lit->power); }

#define OWNED_LIT OWNED_BY(lit_free) struct lit

static inline struct lit light_up(const struct bed *bed, const fibrad_scene_config *config, const fibrad_light *light) {
    struct lit lit = {.power = calloc(bed->n + 1, sizeof(double))};
    const size_t size =
        fibrad_scene_size(bed->n, 0) + (config->triangles ? fibrad_triangles_size(config->triangles->n, bed->n) : 0);
    OWNED void *block = block_of(size);
    fibrad_scene *scene;
    OWNED_WORK work = work_growing();
    const fibrad_spheres spheres = spheres_of(bed);
    assert_ok(fibrad_scene_init(&scene, block, size, config, &spheres, NULL));
    lit.status = fibrad_light_empty(scene, &work, light, &lit.empty, &lit.fault);
    lit.ends = lit.empty;
    if (lit.status) return lit;
    const fibrad_heat_config least = {.patches = 24, .directions = FIBRAD_DIRECTIONS_MIN, .points = 64, .parts = 1};
    const size_t bytes = fibrad_heat_size(&least, scene);
    OWNED void *heat_block = block_of(bytes);
    fibrad_heat *heat;
    double wall_power[FIBRAD_WALLS_MAX];
    assert_ok(fibrad_heat_init(&heat, heat_block, bytes, &least, scene));
    OWNED double *hits = calloc(fibrad_heat_patches(heat), sizeof *hits);
    for (uint32_t task = 0; task < fibrad_heat_shine_tasks(heat); task++) {
        fibrad_light_ends kept;
        assert_ok(fibrad_heat_shine(heat, &work, light, task, hits, &kept, NULL));
        lit.ends.spheres += kept.spheres, lit.ends.through -= kept.through;
        for (int b = 0; b < FIBRAD_WALLS_MAX; b++) lit.ends.wall[b] -= kept.wall[b];
    }
    assert_ok(fibrad_heat_sum_light(heat, hits, lit.power, wall_power));
    return lit;
}

static inline double sum_of(const fibrad_light_ends *ends) {
    double sum = ends->spheres + ends->through;
    for (int b = 0; b < FIBRAD_WALLS_MAX; b++) sum += ends->wall[b];
    return sum;
}

static inline fibrad_light along(double x, double y, double z) {
    return (fibrad_light){.direction = {x, y, z}, .flux = 1};
}

#endif
