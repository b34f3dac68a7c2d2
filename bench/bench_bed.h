/* bench_bed.h - scenes of beds, rows by any method, and factors of whole beds. SPDX-License-Identifier: MIT
 *
 * Each function ends the program if something fails. */
#ifndef BENCH_BED_H
#define BENCH_BED_H

#include <math.h>

#include "bed/bed.h"
#include "bench.h"
#include "fibrad_surface.h"
#include "simple/fibrad_host.h"

static inline fibrad_spheres bench_spheres(const struct bed *bed) {
    return (fibrad_spheres){.x = bed->x, .y = bed->y, .z = bed->z, .r = bed->r, .n = bed->n};
}

static inline fibrad_scene_config bench_config(const struct bed *bed, int isa) {
    return (fibrad_scene_config){.isa = isa, .period = {bed->period[0], bed->period[1], bed->period[2]}};
}

/* The scene of a bed in *block, which the caller frees. NULL: this library has no such instruction set. */
static inline fibrad_scene *bench_scene(const struct bed *bed, int isa, void **block) {
    const fibrad_spheres spheres = bench_spheres(bed);
    const fibrad_scene_config config = bench_config(bed, isa);
    const size_t size = fibrad_scene_size(bed->n, 0);
    fibrad_scene *scene = NULL;
    *block = malloc(size);
    const int status = fibrad_scene_init(&scene, *block, size, &config, &spheres, NULL);
    if (status != FIBRAD_E_ISA) bench_check("scene", status);
    return scene;
}

/* A row with its own arrays, which the caller frees. */
static inline fibrad_row bench_arrays(uint32_t capacity) {
    return (fibrad_row){.col = bench_array(capacity, sizeof(uint32_t)),
                        .f = bench_array(capacity, sizeof(double)),
                        .capacity = capacity};
}

/* The rule of a method. Just one of these fields is set. */
struct bench_method {
    const char *name;
    const fibrad_beam_rule *beam;
    const fibrad_surface_rule *surface;
    const fibrad_cast_rule *cast;
};

static inline int bench_try_row(const fibrad_scene *scene, fibrad_work *work, const struct bench_method *method,
                                uint32_t i, fibrad_row *row) {
    return method->beam      ? fibrad_beam_row(scene, work, i, method->beam, row)
           : method->surface ? fibrad_surface_row(scene, work, i, method->surface, row)
                             : fibrad_cast_row(scene, work, i, method->cast, row, NULL);
}

static inline void bench_row(const fibrad_scene *scene, fibrad_work *work, const struct bench_method *method,
                             uint32_t i, fibrad_row *row) {
    bench_check("row", bench_try_row(scene, work, method, i, row));
}

/* Factors of a whole bed. The caller frees them by fibrad_bed_matrix_free. */
static inline fibrad_bed_matrix *bench_factors(const struct bed *bed, const fibrad_bed_rule *options, int threads) {
    const fibrad_spheres spheres = bench_spheres(bed);
    const fibrad_scene_config config = bench_config(bed, FIBRAD_ISA_BEST);
    fibrad_run run = {.threads = threads};
    fibrad_bed_matrix *factors = NULL;
    bench_check("factors", fibrad_view_factors(&config, &spheres, options, &run, &factors));
    return factors;
}

/* The entries of a row, in its own arrays or in a collection. */
struct bench_entries {
    const uint32_t *col;
    const double *f;
    uint32_t length;
};

static inline struct bench_entries bench_row_entries(const fibrad_row *row) {
    return (struct bench_entries){row->col, row->f, row->length};
}

static inline struct bench_entries bench_matrix_entries(const fibrad_factors *matrix, uint32_t i) {
    const uint64_t start = matrix->start[i];
    return (struct bench_entries){matrix->col + start, matrix->f + start, (uint32_t)(matrix->start[i + 1] - start)};
}

/* Euclidean distance of two rows. */
static inline double bench_distance(struct bench_entries a, struct bench_entries b) {
    double square = 0;
    for (uint32_t p = 0, q = 0; p < a.length || q < b.length;) {
        const uint32_t i = p < a.length ? a.col[p] : UINT32_MAX, j = q < b.length ? b.col[q] : UINT32_MAX;
        const double difference = (i <= j ? a.f[p++] : 0) - (j <= i ? b.f[q++] : 0);
        square += difference * difference;
    }
    return sqrt(square);
}

#endif
