/* bench_cast.c - rays: error against their number, nanoseconds per ray. SPDX-License-Identifier: MIT
 *
 * CSV on standard output. `pair`: unit spheres at centre distance 2 ... 6; the error is that of F12 in per cent, root
 * mean square over 24 orientations of the pair. `bed`: random periodic beds of 1,000 to 20,000 spheres, radii 0.8-1.2,
 * solid fraction 0.55; root mean square of the Euclidean error of 20 rows, the truth being 10,000 beams. Seconds are
 * those of one thread in the rows. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bed/packing.h"
#include "cli/message.h"
#include "compute/rows.h"

enum { ORIENTATIONS = 24, ROWS = 20 };

static double processor_seconds(void) { return (double)clock() / CLOCKS_PER_SEC; }

struct memory {
    fibrad_scene *scene;
    fibrad_work *work;
    void *scene_block, *work_block;
};

static int open_scene(struct memory *memory, const struct bed *bed) {
    fibrad_scene_config config = {.spheres = bed->n};
    memcpy(config.period, bed->period, sizeof config.period);
    const fibrad_spheres spheres = {bed->x, bed->y, bed->z, bed->r, bed->n};
    const size_t size = fibrad_scene_size(&config), work_size = fibrad_work_size(NULL);
    memory->scene_block = run_block(size);
    memory->work_block = run_block(work_size);
    if (!memory->scene_block || !memory->work_block) return message_memory();
    int status = fibrad_scene_init(&memory->scene, memory->scene_block, size, &config, &spheres, NULL);
    if (!status) status = fibrad_work_init(&memory->work, memory->work_block, work_size, NULL);
    return status ? message(STATUS_INPUT, "%s", fibrad_status_text(status)) : STATUS_OK;
}

static void close_scene(struct memory *memory) {
    free(memory->scene_block);
    free(memory->work_block);
}

static int row_by(struct memory *memory, const struct row_method *method, uint32_t i, fibrad_row *row) {
    const int status = method->row(memory->scene, memory->work, i, method->rule, row);
    return status ? message(STATUS_INPUT, "row %u: %s", i, fibrad_status_text(status)) : STATUS_OK;
}

static int bench_pair(int random, uint32_t rays, int h) {
    double exact = 0, error = 0, estimate = 0, seconds = 0;
    fibrad_pair_exact(1, 1, h - 2, &exact);
    for (uint32_t k = 0; k < ORIENTATIONS; ++k) {
        double w[3] = {0};
        uint32_t col[2];
        double f[2] = {0};
        fibrad_row row = {.col = col, .f = f, .capacity = 2};
        const fibrad_cast_rule rule = {.rays = rays, .random = random, .seed = k};
        const struct row_method method = method_cast(&rule);
        struct memory memory;
        struct bed bed;
        bed_init(&bed, false, 0);
        fibrad_direction(k, ORIENTATIONS, w);
        int status = bed_add(&bed, &(struct bed_sphere){.r = 1});
        if (!status) status = bed_add(&bed, &(struct bed_sphere){.x = h * w[0], .y = h * w[1], .z = h * w[2], .r = 1});
        if (!status) status = open_scene(&memory, &bed);
        const double begun = processor_seconds();
        if (!status) status = row_by(&memory, &method, 0, &row);
        if (status) return status;
        seconds += processor_seconds() - begun;
        error += pow(f[0] / exact - 1, 2) / ORIENTATIONS;
        estimate += pow(row.error / exact, 2) / ORIENTATIONS;
        close_scene(&memory);
        bed_free(&bed);
    }
    printf("pair,%s,%d,%u,%.4f,%.4f,%.1f\n", random ? "mc" : "cast", h, rays, 100 * sqrt(error), 100 * sqrt(estimate),
           1e9 * seconds / rays / ORIENTATIONS);
    fflush(stdout);
    return STATUS_OK;
}

/* Euclidean distance of a row from a full one. */
static double distance(const fibrad_row *row, const double *full, uint32_t n) {
    double square = 0;
    for (uint32_t j = 0, k = 0; j < n; ++j) {
        const double f = k < row->length && row->col[k] == j ? row->f[k++] : 0;
        square += (f - full[j]) * (f - full[j]);
    }
    return sqrt(square);
}

static int bench_bed(uint32_t n) {
    static const uint32_t rays[] = {10000, 100000, 1000000};
    const fibrad_beam_rule fine = {.directions = 10000};
    const struct row_method beam = method_beam(&fine);
    struct memory memory;
    struct bed bed;
    bed_init(&bed, false, 0);
    uint32_t *col = calloc(n, sizeof *col);
    double *f = calloc(n, sizeof *f), *truth = calloc((size_t)n * ROWS, sizeof *truth);
    if (!col || !f || !truth) return message_memory();
    fibrad_row row = {.col = col, .f = f, .capacity = n};
    int status = bed_make_packing(&bed, n, .8, 1.2, .55, 1);
    if (!status) status = open_scene(&memory, &bed);
    for (uint32_t i = 0; i < ROWS && !status; ++i) {
        status = row_by(&memory, &beam, i * (n / ROWS), &row);
        for (uint32_t k = 0; k < row.length; ++k) truth[(size_t)i * n + col[k]] = f[k];
    }
    for (int random = 0; random <= 1; ++random)
        for (int r = 0; r < 3 - random && !status; ++r) {
            const fibrad_cast_rule rule = {.rays = rays[r], .random = random};
            const struct row_method cast = method_cast(&rule);
            double error = 0, estimate = 0, seconds = 0;
            for (uint32_t i = 0; i < ROWS && !status; ++i) {
                const double begun = processor_seconds();
                status = row_by(&memory, &cast, i * (n / ROWS), &row);
                seconds += processor_seconds() - begun;
                error += pow(distance(&row, truth + (size_t)i * n, n), 2) / ROWS;
                estimate += row.error * row.error / ROWS;
            }
            printf("bed,%s,%u,%u,%.3g,%.3g,%.1f\n", cast.name, n, rays[r], sqrt(error), sqrt(estimate),
                   1e9 * seconds / rays[r] / ROWS);
            fflush(stdout);
        }
    free(col);
    free(f);
    free(truth);
    close_scene(&memory);
    bed_free(&bed);
    return status;
}

int main(void) {
    static const uint32_t rays[] = {20000, 200000, 4000000}, spheres[] = {1000, 5000, 20000};
    int status = STATUS_OK;
    printf("# fibrad %s, %s; one thread; pairs: error in per cent of F12; beds: Euclidean error of a row\n",
           fibrad_version(), fibrad_isa_name((int)fibrad_isa_best()));
    puts("scene,method,distance_or_spheres,rays,error,error_estimate,nanoseconds_per_ray");
    for (int random = 0; random <= 1; ++random)
        for (int r = 0; r < 3 - random; ++r) /* the most rays at random take as long, for nothing new */
            for (int h = 2; h <= 6 && !status; ++h) status = bench_pair(random, rays[r], h);
    for (size_t s = 0; s < sizeof spheres / sizeof *spheres && !status; ++s) status = bench_bed(spheres[s]);
    return status;
}
