/* bench_surface.c - times of the surface method: a pair, a test of a ray against a sphere, a bed.
 * SPDX-License-Identifier: MIT
 *
 *     bench_surface [quick] */
#include "bed/packing.h"
#include "bench_bed.h"
#include "surface/surface_lanes.h"

enum { OBSTACLES = 64 };
static double scratch[FIBRAD_SURFACE_SCRATCH(OBSTACLES)];

static void bench_pair(const char *what, int isa, double gap, const fibrad_spheres *obstacles,
                       const fibrad_surface_rule *given, int times) {
    fibrad_surface_rule rule = *given;
    rule.isa = isa;
    fibrad_surface_facts facts;
    double best = INFINITY, f12 = 0;
    for (int round = 0; round < 7; ++round) { /* the best of several rounds, since others may use the machine */
        const double begun = bench_thread_seconds();
        for (int k = 0; k < times; ++k)
            bench_check("pair", fibrad_surface_pair(1, 1, gap, obstacles, &rule, scratch, &f12, &facts));
        best = fmin(best, (bench_thread_seconds() - begun) / times);
    }
    printf("%s,%s,%.3f,%llu,%llu,%.3g,%.3g\n", what, fibrad_isa_name(isa), 1e6 * best, (unsigned long long)facts.rays,
           (unsigned long long)facts.tests, (double)facts.tests / best, facts.error / f12);
}

static void bench_pairs(int isa, int times) {
    /* one obstacle in the way of a touching pair; it touches both spheres */
    double x[OBSTACLES] = {sqrt(3)}, y[OBSTACLES] = {0}, z[OBSTACLES] = {1}, r[OBSTACLES] = {1};
    const fibrad_spheres one = {x, y, z, r, .n = 1};
    bench_pair("touching pair with one obstacle 55", isa, 0, &one, &(fibrad_surface_rule){0}, times);
    bench_pair("touching pair with one obstacle 987", isa, 0, &one, &(fibrad_surface_rule){.nodes = 987}, times);
    /* many obstacles behind sphere 2, which hide nothing and are all tested */
    for (int k = 0; k < OBSTACLES; ++k) x[k] = 0.1 * (k % 8), y[k] = 0.1 * (k / 8), z[k] = 6, r[k] = 0.1;
    const fibrad_spheres many = {x, y, z, r, .n = OBSTACLES};
    bench_pair("every ray against 64 obstacles 55", isa, 1, &many,
               &(fibrad_surface_rule){.flags = FIBRAD_SURFACE_NO_REGION}, times);
}

static void bench_bed(const struct bed *bed, int isa, double cutoff, uint32_t flags) {
    void *block;
    const fibrad_scene *scene = bench_scene(bed, isa, &block);
    if (!scene) return;
    fibrad_work work = BENCH_GROWING;
    fibrad_row row = bench_arrays(bed->n);
    const fibrad_surface_rule rule = {.cutoff = cutoff, .flags = flags};
    uint64_t entries = 0;
    double error = 0;
    const double begun = bench_thread_seconds();
    for (uint32_t i = 0; i < bed->n; ++i) {
        bench_check("row", fibrad_surface_row(scene, &work, i, &rule, &row));
        entries += row.length;
        error += row.error * row.error / bed->n;
    }
    const double took = bench_thread_seconds() - begun;
    printf("bed of %u; D = %g; flags %u,%s,%.3f,%llu,,,%.3g\n", bed->n, cutoff, flags, fibrad_isa_name(isa), 1e6 * took,
           (unsigned long long)entries, sqrt(error));
    free(work.memory.block);
    free(row.col);
    free(row.f);
    free(block);
}

int main(int argc, char **argv) {
    const bool quick = argc > 1 && strcmp(argv[1], "quick") == 0;
    printf("# fibrad %s, widest instruction set %s, one thread\n", fibrad_version(),
           fibrad_isa_name((int)fibrad_isa_best()));
    printf("# error: estimated, relative (pair) or Euclidean (row, root mean square)\n");
    puts("what,isa,microseconds,rays_or_entries,tests,tests_per_second,error");
    for (int isa = FIBRAD_ISA_SCALAR; isa <= (int)fibrad_isa_best(); ++isa) bench_pairs(isa, quick ? 10 : 500);
    struct bed bed = bed_empty();
    if (bed_make_packing(&bed, quick ? 200 : 1000, .8, 1.2, .55, 1) != 0) return 1;
    memset(bed.period, 0, sizeof bed.period);
    for (int isa = FIBRAD_ISA_SCALAR; isa <= (int)fibrad_isa_best(); ++isa) bench_bed(&bed, isa, 6, 0);
    bench_bed(&bed, (int)fibrad_isa_best(), 6,
              FIBRAD_SURFACE_NO_HORIZON | FIBRAD_SURFACE_NO_REGION | FIBRAD_SURFACE_NO_EXACT |
                  FIBRAD_SURFACE_NO_HIDDEN);
    bench_bed(&bed, (int)fibrad_isa_best(), 0, 0);
    bed_free(&bed);
    return 0;
}
