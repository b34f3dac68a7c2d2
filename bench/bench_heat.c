/* bench_heat.c - error of net powers against time, for patches, directions and points. SPDX-License-Identifier: MIT
 *
 * A random bed of 500 equal spheres in a periodic box, solid fraction 0.58, temperatures at random; the reference has
 * 384 patches, 400 directions of 128 points. `quick` takes a smaller bed and a smaller reference. */
#include <math.h>

#include "bed/packing.h"
#include "bench.h"

enum { PARTS = 8 };

struct heat {
    fibrad_heat *heat;
    double traced, solved; /* [s] */
    size_t bytes;
    fibrad_heat_result result;
};

static void *block_of(size_t size) {
    void *block = aligned_alloc(64, (size + 63) / 64 * 64);
    if (!size || !block) exit(1);
    return block;
}

static void check(int status) {
    if (status == FIBRAD_OK) return;
    fprintf(stderr, "bench_heat: %s\n", fibrad_status_text(status));
    exit(1);
}

static fibrad_scene *scene_of(const struct bed *bed) {
    fibrad_scene_config config = {.spheres = bed->n, .period = {bed->period[0], bed->period[1], bed->period[2]}};
    fibrad_spheres spheres = {bed->x, bed->y, bed->z, bed->r, bed->n};
    fibrad_scene *scene;
    size_t size = fibrad_scene_size(&config);
    check(fibrad_scene_init(&scene, block_of(size), size, &config, &spheres, NULL));
    return scene;
}

static struct heat solve(const fibrad_scene *scene, const fibrad_heat_config *config,
                         const fibrad_heat_sources *sources, double *power) {
    struct heat heat = {.bytes = fibrad_heat_size(config, scene), .result.power = power};
    fibrad_work *work;
    size_t size = fibrad_work_size(NULL);
    double begun = bench_thread_seconds();
    check(fibrad_work_init(&work, block_of(size), size, NULL));
    check(fibrad_heat_init(&heat.heat, block_of(heat.bytes), heat.bytes, config, scene));
    for (uint32_t task = 0; task < fibrad_heat_tasks(heat.heat); task++)
        check(fibrad_heat_trace(heat.heat, work, task));
    heat.traced = bench_thread_seconds() - begun;
    check(fibrad_heat_begin(heat.heat, sources));
    do
        for (uint32_t part = 0; part < PARTS; part++) fibrad_heat_sweep(heat.heat, part);
    while (fibrad_heat_step(heat.heat));
    heat.solved = bench_thread_seconds() - begun - heat.traced;
    check(fibrad_heat_read(heat.heat, &heat.result));
    free(work);
    free(heat.heat);
    return heat;
}

static double mean_square(const double *a, const double *b, uint32_t n) {
    double sum = 0;
    for (uint32_t i = 0; i < n; i++) sum += (a[i] - (b ? b[i] : 0)) * (a[i] - (b ? b[i] : 0));
    return sqrt(sum / n);
}

int main(int argc, char **argv) {
    static const uint32_t patches[] = {24, 96, 384},
                          rules[][2] = {{36, 64}, {72, 64}, {168, 64}, {288, 64}, {72, 128}, {168, 128}};
    static const double emissivities[] = {.3, .8};
    const bool quick = argc > 1 && strcmp(argv[1], "quick") == 0;
    struct bed bed;
    bed_init(&bed, false, 0);
    if (bed_make_packing(&bed, quick ? 100 : 500, 1, 1, .58, 1) != 0) return 1;
    fibrad_scene *scene = scene_of(&bed);
    double *temperature = malloc(bed.n * sizeof(double)), *emissivity = malloc(bed.n * sizeof(double));
    double *truth = malloc(bed.n * sizeof(double)), *power = malloc(bed.n * sizeof(double));
    if (!temperature || !emissivity || !truth || !power) return 1;
    bench_preamble("net powers: error over their root mean square, and processor seconds of one thread", 1);
    puts("emissivity,patches,directions,points,trace_s,solve_s,sweeps,bytes_per_sphere,error,estimate");
    for (size_t e = 0; e < 2; e++) {
        for (uint32_t i = 0; i < bed.n; i++)
            temperature[i] = 1 + bed_make_random(3, i), emissivity[i] = emissivities[e];
        const fibrad_heat_sources sources = {.temperature = temperature, .emissivity = emissivity, .sigma = 1};
        const fibrad_heat_config fine = {quick ? 100 : 400, quick ? 64 : 128, quick ? 96 : 384, PARTS};
        solve(scene, &fine, &sources, truth);
        const double size = mean_square(truth, NULL, bed.n);
        for (size_t p = 0; p < (quick ? 1 : sizeof patches / sizeof *patches); p++)
            for (size_t k = 0; k < (quick ? 2 : sizeof rules / sizeof *rules); k++) {
                const fibrad_heat_config config = {rules[k][0], rules[k][1], patches[p], PARTS};
                const struct heat heat = solve(scene, &config, &sources, power);
                printf("%g,%u,%u,%u,%.3f,%.3f,%u,%zu,%.2e,%.2e\n", emissivities[e], config.patches, config.directions,
                       config.points, heat.traced, heat.solved, heat.result.sweeps, heat.bytes / bed.n,
                       mean_square(power, truth, bed.n) / size,
                       hypot(heat.result.error_patches, heat.result.error_beams) / size);
            }
    }
    free(temperature), free(emissivity), free(truth), free(power), free(scene);
    bed_free(&bed);
    return 0;
}
