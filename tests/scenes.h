/* scenes.h - scenes and rows for tests: beds in, matrices out. SPDX-License-Identifier: MIT */
#ifndef TESTS_SCENES_H
#define TESTS_SCENES_H

#include <check.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "bed/packing.h"
#include "fibrad.h"

static inline void *block_of(size_t size) {
    void *block = aligned_alloc(64, (size + 63) / 64 * 64);
    ck_assert_ptr_nonnull(block);
    return block;
}

static inline void add_sphere(struct bed *bed, double x, double y, double z, double r) {
    ck_assert_int_eq(bed_add(bed, &(struct bed_sphere){.x = x, .y = y, .z = z, .r = r}), 0);
}

/* A bed of the spheres listed, (x, y, z, r) each. */
static inline struct bed bed_of(uint32_t n, const double spheres[][4]) {
    struct bed bed;
    bed_init(&bed, false, 0);
    for (uint32_t i = 0; i < n; i++) add_sphere(&bed, spheres[i][0], spheres[i][1], spheres[i][2], spheres[i][3]);
    return bed;
}

/* A cubic lattice of touching unit spheres about the origin, the first sphere there: 'p' simple, 'i' body-centred, 'f'
 * face-centred, out to centre distance `reach`. */
static inline struct bed lattice(char kind, double reach) {
    static const double basis[4][3] = {{0, 0, 0}, {0, .5, .5}, {.5, 0, .5}, {.5, .5, 0}}, centre[3] = {.5, .5, .5};
    double side = kind == 'p' ? 2 : kind == 'i' ? 4 / sqrt(3) : 2 * sqrt(2);
    int sites = kind == 'p' ? 1 : kind == 'i' ? 2 : 4, span = (int)(reach / side) + 1;
    struct bed bed;
    bed_init(&bed, false, 0);
    add_sphere(&bed, 0, 0, 0, 1);
    for (int i = -span; i <= span; i++)
        for (int j = -span; j <= span; j++)
            for (int k = -span; k <= span; k++)
                for (int s = 0; s < sites; s++) {
                    const double *b = kind == 'i' && s == 1 ? centre : basis[s];
                    double x = (i + b[0]) * side, y = (j + b[1]) * side, z = (k + b[2]) * side;
                    double d = sqrt(x * x + y * y + z * z);
                    if (d > 0 && d <= reach * (1 + 1e-12)) add_sphere(&bed, x, y, z, 1);
                }
    return bed;
}

/* A random bed of n spheres, radii in [low, high], solid fraction given; open, or periodic as made. */
static inline struct bed packing(uint32_t n, double low, double high, double fraction, uint64_t seed, bool periodic) {
    struct bed bed;
    bed_init(&bed, false, 0);
    ck_assert_int_eq(bed_make_packing(&bed, n, low, high, fraction, seed), 0);
    for (int axis = 0; axis < 3 && !periodic; axis++) bed.period[axis] = 0;
    return bed;
}

/* A few large spheres, and n - 6 small ones strewn about them, in a unit cube. */
static inline struct bed strewn(uint32_t n, uint64_t seed) {
    struct bed bed = bed_of(0, NULL);
    for (uint64_t at = 0; bed.n < n; at += 4) {
        double c[3], r = bed.n < 6 ? .2 : .01 + .01 * bed_make_random(seed, at);
        bool fits = true;
        for (uint64_t axis = 0; axis < 3; axis++) c[axis] = bed_make_random(seed, at + 1 + axis);
        for (uint32_t j = 0; j < bed.n && fits; j++) {
            double x = c[0] - bed.x[j], y = c[1] - bed.y[j], z = c[2] - bed.z[j], sum = r + bed.r[j];
            fits = x * x + y * y + z * z > sum * sum;
        }
        if (fits) add_sphere(&bed, c[0], c[1], c[2], r);
    }
    return bed;
}

static inline fibrad_scene *scene_of(const struct bed *bed, int isa) {
    fibrad_scene_config config = {.spheres = bed->n, .isa = isa};
    memcpy(config.period, bed->period, sizeof config.period);
    size_t size = fibrad_scene_size(&config);
    ck_assert_uint_gt(size, 0);
    fibrad_spheres spheres = {bed->x, bed->y, bed->z, bed->r, bed->n};
    fibrad_scene *scene = NULL;
    void *block = block_of(size);
    ck_assert_int_eq(fibrad_scene_init(&scene, block, size, &config, &spheres, NULL), FIBRAD_OK);
    ck_assert_ptr_eq(scene, block); /* so that free(scene) frees the block */
    return scene;
}

static inline fibrad_work *work_of(const fibrad_work_config *config) {
    size_t size = fibrad_work_size(config);
    ck_assert_uint_gt(size, 0);
    fibrad_work *work = NULL;
    void *block = block_of(size);
    ck_assert_int_eq(fibrad_work_init(&work, block, size, config), FIBRAD_OK);
    ck_assert_ptr_eq(work, block);
    return work;
}

static inline fibrad_row row_of(uint32_t capacity) {
    return (fibrad_row){
        .col = calloc(capacity, sizeof(uint32_t)), .f = calloc(capacity, sizeof(double)), .capacity = capacity};
}

static inline void row_free(fibrad_row *row) {
    free(row->col);
    free(row->f);
}

static inline double row_sum(const fibrad_row *row) {
    double sum = 0;
    for (uint32_t k = 0; k < row->length; k++) sum += row->f[k];
    return sum;
}

static inline double row_factor(const fibrad_row *row, uint32_t j) {
    for (uint32_t k = 0; k < row->length; k++)
        if (row->col[k] == j) return row->f[k];
    return 0;
}

/* Euclidean distance of two rows of a scene of n spheres. */
static inline double row_distance(const fibrad_row *a, const fibrad_row *b) {
    double square = 0;
    uint32_t p = 0, q = 0;
    while (p < a->length || q < b->length) {
        uint32_t i = p < a->length ? a->col[p] : UINT32_MAX, j = q < b->length ? b->col[q] : UINT32_MAX;
        double difference = (i <= j ? a->f[p++] : 0) - (j <= i ? b->f[q++] : 0);
        square += difference * difference;
    }
    return sqrt(square);
}

static inline bool same_bits(const fibrad_row *a, const fibrad_row *b) {
    return a->length == b->length && memcmp(a->col, b->col, a->length * sizeof *a->col) == 0 &&
           memcmp(a->f, b->f, a->length * sizeof *a->f) == 0 &&
           memcmp(&a->escaped, &b->escaped, sizeof a->escaped) == 0 &&
           memcmp(&a->error, &b->error, sizeof a->error) == 0;
}

#endif
