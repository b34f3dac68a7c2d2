/* clump_caps.c - spheres that are one body: their leaders, and what of them lies inside one another.
 * SPDX-License-Identifier: MIT
 *
 * Members of a clump hide parts of each other. The part of a sphere inside another one is a cap. Whatever leaves or
 * meets a cap is no radiation. Lines that meet a clump meet it first outside of all caps. */
#include "patches/clump_caps.h"
#include "base/sort.h"
#include "base/vector.h"
#include "scene/grid_walk.h"

/* Finds the caps of the sphere at a place. to: where they are written; NULL: they are only counted. */
static size_t caps_of(const fibrad_scene *scene, uint32_t i, fibrad_heat_cap *to) {
    const double r = scene->r[i], centre[3] = {scene->x[i], scene->y[i], scene->z[i]};
    size_t count = 0;
    for (uint32_t l = 0; l < scene->levels && scene->clump[i] != 0; l++) {
        fibrad_walk walk;
        fibrad_walk_about(&walk, scene, &scene->level[l], centre, centre, r + scene->level[l].radius_max);
        while (fibrad_walk_next(&walk))
            for (uint32_t j = walk.begin; j < walk.end; j++) {
                const double size = scene->r[j] / r, at[3] = {(scene->x[j] + walk.shift[0] - centre[0]) / r,
                                                              (scene->y[j] + walk.shift[1] - centre[1]) / r,
                                                              (scene->z[j] + walk.shift[2] - centre[2]) / r};
                const double square = fibrad_dot(at, at), beyond = (1 + square - size * size) / 2;
                if ((j == i && !walk.image) || !fibrad_one_clump(scene, i, j)) continue;
                if (square >= (1 + size) * (1 + size) || beyond * fibrad_abs(beyond) >= square) continue;
                if (to != NULL) to[count] = (fibrad_heat_cap){{at[0], at[1], at[2]}, beyond};
                count++;
            }
    }
    return count;
}

size_t fibrad_heat_count_caps(const fibrad_scene *scene) {
    size_t count = 0;
    for (uint32_t i = 0; i < scene->facts.spheres && scene->clump != NULL; i++) count += caps_of(scene, i, NULL);
    return count;
}

/* Finds the leaders. key: [2 spheres] */
static void find_leaders(fibrad_heat *heat, uint64_t *key) {
    const uint32_t n = heat->spheres, *clump = heat->scene->clump;
    uint32_t members = 0;
    for (uint32_t b = 0; b < n; b++) {
        heat->clumps.leader[b] = FIBRAD_NONE;
        if (clump[b] != 0) key[members++] = (uint64_t)clump[b] << 32 | b;
    }
    const uint64_t *sorted = fibrad_sort_keys(key, key + n, members, 32, UINT32_MAX);
    for (uint32_t k = 0, first = 0; k < members; k++) {
        if (sorted[k] >> 32 != sorted[first] >> 32) first = k;
        if (k == first) continue;
        heat->clumps.leader[(uint32_t)sorted[k]] = heat->clumps.leader[(uint32_t)sorted[first]] =
            (uint32_t)sorted[first];
        heat->clumps.some = true;
    }
}

void fibrad_heat_find_clumps(fibrad_heat *heat) {
    const fibrad_scene *scene = heat->scene;
    heat->clumps.some = false;
    if (scene->clump == NULL) return;
    find_leaders(heat, (void *)heat->solution.gathered);
    heat->clumps.first_cap[0] = 0;
    for (uint32_t b = 0; b < heat->spheres; b++)
        heat->clumps.first_cap[b + 1] =
            heat->clumps.first_cap[b] + caps_of(scene, b, heat->clumps.cap + heat->clumps.first_cap[b]);
}
