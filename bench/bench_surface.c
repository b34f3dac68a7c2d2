/* bench_surface.c - what does the surface method cost: a pair, a ray-sphere test, a bed? SPDX-License-Identifier: MIT
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include "bed/packing.h"
#include "fibrad.h"

static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

enum { OBSTACLES = 64 };
static _Alignas(64) double scratch[FIBRAD_SURFACE_SCRATCH(OBSTACLES)];

static void bench_pair(const char *what, int isa, double gap, const fibrad_spheres *obstacles,
                       const fibrad_surface_rule *given) {
    fibrad_surface_rule rule = *given;
    rule.isa = isa;
    fibrad_surface_facts facts;
    double best = INFINITY, f12 = 0;
    for (int round = 0; round < 7; ++round) { /* the best of some: others may use the machine */
        const double begun = seconds();
        enum { TIMES = 500 };
        for (int k = 0; k < TIMES; ++k)
            if (fibrad_surface_pair(1, 1, gap, obstacles, &rule, scratch, &f12, &facts) != FIBRAD_OK) exit(1);
        best = fmin(best, (seconds() - begun) / TIMES);
    }
    printf("%s,%s,%.3f,%llu,%llu,%.3g,%.3g\n", what, fibrad_isa_name(isa), 1e6 * best, (unsigned long long)facts.rays,
           (unsigned long long)facts.tests, (double)facts.tests / best, facts.error / f12);
}

static void bench_pairs(int isa) {
    /* one obstacle in the way of a touching pair, touching both */
    double x[OBSTACLES] = {sqrt(3)}, y[OBSTACLES] = {0}, z[OBSTACLES] = {1}, r[OBSTACLES] = {1};
    const fibrad_spheres one = {x, y, z, r, 1};
    bench_pair("touching pair with one obstacle 55", isa, 0, &one, &(fibrad_surface_rule){0});
    bench_pair("touching pair with one obstacle 987", isa, 0, &one, &(fibrad_surface_rule){.nodes = 987});
    /* many behind sphere 2, which hide nothing and are all tested */
    for (int k = 0; k < OBSTACLES; ++k) x[k] = 0.1 * (k % 8), y[k] = 0.1 * (k / 8), z[k] = 6, r[k] = 0.1;
    const fibrad_spheres many = {x, y, z, r, OBSTACLES};
    bench_pair("every ray against 64 obstacles 55", isa, 1, &many,
               &(fibrad_surface_rule){.flags = FIBRAD_SURFACE_NO_REGION});
}

static void bench_bed(const struct bed *bed, int isa, double cutoff, uint32_t flags) {
    const fibrad_scene_config config = {.spheres = bed->n, .isa = isa};
    const fibrad_spheres spheres = {bed->x, bed->y, bed->z, bed->r, bed->n};
    const size_t scene_size = fibrad_scene_size(&config), work_size = fibrad_work_size(NULL);
    void *scene_block = aligned_alloc(64, (scene_size + 63) / 64 * 64), *work_block = aligned_alloc(64, work_size);
    fibrad_scene *scene;
    fibrad_work *work;
    static uint32_t col[1024];
    static double f[1024];
    if (!scene_block || !work_block ||
        fibrad_scene_init(&scene, scene_block, scene_size, &config, &spheres, NULL) != FIBRAD_OK ||
        fibrad_work_init(&work, work_block, work_size, NULL) != FIBRAD_OK)
        exit(1);
    const fibrad_surface_rule rule = {.cutoff = cutoff, .flags = flags};
    uint64_t entries = 0;
    double error = 0;
    const double begun = seconds();
    for (uint32_t i = 0; i < bed->n; ++i) {
        fibrad_row row = {.col = col, .f = f, .capacity = 1024};
        if (fibrad_surface_row(scene, work, i, &rule, &row) != FIBRAD_OK) exit(1);
        entries += row.length;
        error += row.error * row.error / bed->n;
    }
    const double took = seconds() - begun;
    printf("bed of %u; D = %g; flags %u,%s,%.3f,%llu,,,%.3g\n", bed->n, cutoff, flags, fibrad_isa_name(isa), 1e6 * took,
           (unsigned long long)entries, sqrt(error));
    free(scene_block);
    free(work_block);
}

int main(void) {
    printf("# fibrad %s, widest instruction set %s, one thread\n", fibrad_version(),
           fibrad_isa_name((int)fibrad_isa_best()));
    printf("# error: estimated, relative (pair) or Euclidean (row, root mean square)\n");
    puts("what,isa,microseconds,rays_or_entries,tests,tests_per_second,error");
    for (int isa = FIBRAD_ISA_SCALAR; isa <= (int)fibrad_isa_best(); ++isa) bench_pairs(isa);
    struct bed bed;
    bed_init(&bed, false, 0);
    if (bed_make_packing(&bed, 1000, .8, 1.2, .55, 1) != 0) return 1;
    for (int isa = FIBRAD_ISA_SCALAR; isa <= (int)fibrad_isa_best(); ++isa) bench_bed(&bed, isa, 6, 0);
    bench_bed(&bed, (int)fibrad_isa_best(), 6,
              FIBRAD_SURFACE_NO_HORIZON | FIBRAD_SURFACE_NO_REGION | FIBRAD_SURFACE_NO_EXACT |
                  FIBRAD_SURFACE_NO_HIDDEN);
    bench_bed(&bed, (int)fibrad_isa_best(), 0, 0);
    bed_free(&bed);
    return 0;
}
