/* bench_heat.c - error of net powers against time, for patches, directions and points. SPDX-License-Identifier: MIT
 *
 *     bench_heat [quick | copies N...]
 *
 * The bench writes CSV to standard output. Without arguments, the bed is a random bed of 500 equal spheres in a
 * periodic box, solid fraction 0.58, at random temperatures. With `quick` it has 100 spheres. With `copies N` there are
 * N copies, side by side, of a settled bed of 2,000 spheres with the temperatures of its file. This bed is periodic to
 * both sides and open to 300 K above and below. 10 copies take a minute and 0.4 GB. 500 copies are a million spheres;
 * with emissivity 0.8 alone they take a quarter of an hour and 17 GB. Run the bench where tests/data is.
 *
 * The reference has 384 patches and 400 directions of 128 points. For copies it is computed for one copy, since all
 * copies have the same powers. */
#include <malloc.h>
#include <unistd.h>

#include "bed/packing.h"
#include "../tests/copies.h"
#include "bench_bed.h"
#include "read/read.h"

enum { PARTS = 8 };

enum { MANY = 100 }; /* copies: one emissivity suffices */

struct heat {
    double traced, solved; /* [s] */
    double bytes;          /* bytes of the block that were used */
    fibrad_heat_result result;
};

static double resident(void) {
    double all = 0, here = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file && fscanf(file, "%lf %lf", &all, &here) != 2) here = 0;
    if (file) fclose(file);
    return here * (double)sysconf(_SC_PAGESIZE);
}

static struct heat solve(const fibrad_scene *scene, const fibrad_heat_config *config,
                         const fibrad_heat_sources *sources, double *power) {
    struct heat took = {.bytes = -resident(), .result.power = power};
    const size_t size = fibrad_heat_size(config, scene);
    fibrad_work work = BENCH_GROWING;
    fibrad_heat *heat;
    const double begun = bench_thread_seconds();
    void *block = malloc(size); /* the system clears pages when they are used */
    bench_check("heat", fibrad_heat_init(&heat, block, size, config, scene));
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
    took.bytes += resident();
    free(block);
    return took;
}

static double mean_square(const double *a, const double *b, uint32_t n) {
    double sum = 0;
    for (uint32_t i = 0; i < n; i++) sum += (a[i] - (b ? b[i] : 0)) * (a[i] - (b ? b[i] : 0));
    return sqrt(sum / n);
}

static void print_heat(const fibrad_scene *scene, uint32_t n, const fibrad_heat_config *config,
                       const fibrad_heat_sources *sources, const double *truth, double *power) {
    const double size = mean_square(truth, NULL, n);
    const struct heat heat = solve(scene, config, sources, power);
    printf("%u,%g,%u,%u,%u,%.3f,%.3f,%u,%.0f,%.2e,%.2e\n", n, sources->emissivity[0], config->patches,
           config->directions, config->points, heat.traced, heat.solved, heat.result.sweeps, heat.bytes / n,
           mean_square(power, truth, n) / size, hypot(heat.result.error_patches, heat.result.error_beams) / size);
    fflush(stdout);
}

static const fibrad_heat_config reference = {.directions = 400, .points = 128, .patches = 384, .parts = PARTS};
static const double emissivities[] = {.3, .8};

static void fill(double *values, uint32_t n, double value) {
    for (uint32_t i = 0; i < n; i++) values[i] = value;
}

/* Runs all settings on a random bed. */
static void bench_settings(bool quick) {
    static const uint32_t patches[] = {24, 96, 384},
                          rules[][2] = {{36, 64}, {72, 64}, {168, 64}, {288, 64}, {72, 128}, {168, 128}};
    const fibrad_heat_config less = {.directions = 100, .points = 64, .patches = 96, .parts = PARTS};
    struct bed bed = bed_empty();
    if (bed_make_packing(&bed, quick ? 100 : 500, 1, 1, .58, 1) != 0) exit(1);
    void *block;
    const fibrad_scene *scene = bench_scene(&bed, FIBRAD_ISA_BEST, &block);
    double *temperature = bench_array(bed.n, sizeof(double)), *emissivity = bench_array(bed.n, sizeof(double));
    double *truth = bench_array(bed.n, sizeof(double)), *power = bench_array(bed.n, sizeof(double));
    const fibrad_heat_sources sources = {.temperature = temperature, .emissivity = emissivity, .sigma = 1};
    for (uint32_t i = 0; i < bed.n; i++) temperature[i] = 1 + bed_make_random(3, i);
    for (size_t e = 0; e < 2; e++) {
        fill(emissivity, bed.n, emissivities[e]);
        solve(scene, quick ? &less : &reference, &sources, truth);
        for (size_t p = 0; p < (quick ? 1 : sizeof patches / sizeof *patches); p++)
            for (size_t k = 0; k < (quick ? 2 : sizeof rules / sizeof *rules); k++)
                print_heat(scene, bed.n,
                           &(fibrad_heat_config){
                               .directions = rules[k][0], .points = rules[k][1], .patches = patches[p], .parts = PARTS},
                           &sources, truth, power);
    }
    free(temperature), free(emissivity), free(truth), free(power), free(block);
    bed_free(&bed);
}

/* The settled bed. bed->extra has its temperatures. */
static void read_tile(struct bed *tile) {
    static const char *const column[] = {"v_T"};
    *tile = bed_empty();
    if (read_bed("tests/data/monoper2000.dump", &(struct read_options){.extra = column, .extras = 1}, tile) != 0)
        exit(1);
    tile->period[2] = 0;
}

/* Runs the defaults on copies of a settled bed. */
static void bench_copies(uint32_t copies) {
    struct bed tile, bed = bed_empty();
    void *tile_block, *block;
    uint32_t wide = 1;
    while ((wide + 1) * (wide + 1) <= copies || copies % wide != 0) wide++;
    read_tile(&tile);
    if (bed_make_copies(&bed, &tile, (const uint32_t[]){copies / wide, wide, 1}) != 0) exit(1);
    const fibrad_scene *tile_scene = bench_scene(&tile, FIBRAD_ISA_BEST, &tile_block);
    const fibrad_scene *scene = bench_scene(&bed, FIBRAD_ISA_BEST, &block);
    double *temperature = bench_array(bed.n, sizeof(double)), *emissivity = bench_array(bed.n, sizeof(double));
    double *truth = bench_array(bed.n, sizeof(double)), *power = bench_array(bed.n, sizeof(double));
    fibrad_heat_sources sources = {.emissivity = emissivity, .surroundings = 300, .sigma = 5.670374419e-8};
    for (size_t e = copies > MANY; e < 2; e++) {
        fill(emissivity, bed.n, emissivities[e]);
        sources.temperature = tile.extra;
        solve(tile_scene, &reference, &sources, power);
        for (uint32_t i = 0; i < bed.n; i++) truth[i] = power[i / copies], temperature[i] = tile.extra[i / copies];
        sources.temperature = temperature;
        print_heat(scene, bed.n, &(fibrad_heat_config){.directions = 168, .points = 64, .patches = 96, .parts = PARTS},
                   &sources, truth, power);
    }
    free(temperature), free(emissivity), free(truth), free(power), free(block), free(tile_block);
    bed_free(&bed);
    bed_free(&tile);
}

int main(int argc, char **argv) {
    const bool copies = argc > 2 && strcmp(argv[1], "copies") == 0;
    mallopt(M_MMAP_THRESHOLD,
            1 << 16); /* large blocks come from the system each time, so that each run pays for its pages */
    bench_preamble("net powers: error over their root mean square, and processor seconds of one thread", 1);
    puts("spheres,emissivity,patches,directions,points,trace_s,solve_s,sweeps,bytes_per_sphere,error,estimate");
    for (int k = 2; k < argc && copies; k++) bench_copies((uint32_t)strtoul(argv[k], NULL, 10));
    if (!copies) bench_settings(argc > 1 && strcmp(argv[1], "quick") == 0);
    return 0;
}
