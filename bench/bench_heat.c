/* bench_heat.c - error of net powers against time, for patches, directions and points. SPDX-License-Identifier: MIT
 *
 * A random bed of 500 equal spheres in a periodic box, solid fraction 0.58, temperatures at random; the reference has
 * 384 patches, 400 directions of 128 points. `quick` takes a smaller bed and a smaller reference. */
#include "bed/packing.h"
#include "bench_bed.h"

enum { PARTS = 8 };

struct heat {
    double traced, solved; /* [s] */
    size_t bytes;
    fibrad_heat_result result;
};

static struct heat solve(const fibrad_scene *scene, const fibrad_heat_config *config,
                         const fibrad_heat_sources *sources, double *power) {
    struct heat took = {.bytes = fibrad_heat_size(config, scene), .result.power = power};
    fibrad_work work = BENCH_GROWING;
    fibrad_heat *heat;
    const double begun = bench_thread_seconds();
    void *block = malloc(took.bytes); /* pages are cleared where they are used */
    bench_check("heat", fibrad_heat_init(&heat, block, took.bytes, config, scene));
    for (uint32_t task = 0; task < fibrad_heat_tasks(heat); task++)
        bench_check("trace", fibrad_heat_trace(heat, &work, task));
    took.traced = bench_thread_seconds() - begun;
    bench_check("begin", fibrad_heat_begin(heat, sources));
    for (int solved = 0; !solved;) {
        for (uint32_t part = 0; part < PARTS; part++) bench_check("sweep", fibrad_heat_sweep(heat, part));
        bench_check("step", fibrad_heat_step(heat, &solved));
    }
    took.solved = bench_thread_seconds() - begun - took.traced;
    bench_check("read", fibrad_heat_read(heat, &took.result));
    free(work.memory.block);
    free(block);
    return took;
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
    bed_init(&bed);
    if (bed_make_packing(&bed, quick ? 100 : 500, 1, 1, .58, 1) != 0) return 1;
    void *block;
    const fibrad_scene *scene = bench_scene(&bed, FIBRAD_ISA_BEST, &block);
    double *temperature = bench_array(bed.n, sizeof(double)), *emissivity = bench_array(bed.n, sizeof(double));
    double *truth = bench_array(bed.n, sizeof(double)), *power = bench_array(bed.n, sizeof(double));
    bench_preamble("net powers: error over their root mean square, and processor seconds of one thread", 1);
    puts("emissivity,patches,directions,points,trace_s,solve_s,sweeps,bytes_per_sphere,error,estimate");
    for (size_t e = 0; e < 2; e++) {
        for (uint32_t i = 0; i < bed.n; i++)
            temperature[i] = 1 + bed_make_random(3, i), emissivity[i] = emissivities[e];
        const fibrad_heat_sources sources = {.temperature = temperature, .emissivity = emissivity, .sigma = 1};
        const fibrad_heat_config fine = {
            .directions = quick ? 100 : 400, .points = quick ? 64 : 128, .patches = quick ? 96 : 384, .parts = PARTS};
        solve(scene, &fine, &sources, truth);
        const double size = mean_square(truth, NULL, bed.n);
        for (size_t p = 0; p < (quick ? 1 : sizeof patches / sizeof *patches); p++)
            for (size_t k = 0; k < (quick ? 2 : sizeof rules / sizeof *rules); k++) {
                const fibrad_heat_config config = {
                    .directions = rules[k][0], .points = rules[k][1], .patches = patches[p], .parts = PARTS};
                const struct heat heat = solve(scene, &config, &sources, power);
                printf("%g,%u,%u,%u,%.3f,%.3f,%u,%zu,%.2e,%.2e\n", emissivities[e], config.patches, config.directions,
                       config.points, heat.traced, heat.solved, heat.result.sweeps, heat.bytes / bed.n,
                       mean_square(power, truth, bed.n) / size,
                       hypot(heat.result.error_patches, heat.result.error_beams) / size);
            }
    }
    free(temperature), free(emissivity), free(truth), free(power), free(block);
    bed_free(&bed);
    return 0;
}
