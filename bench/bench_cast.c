/* bench_cast.c - rays: error against their number, nanoseconds per ray. SPDX-License-Identifier: MIT
 *
 *     bench_cast [quick]
 *
 * The bench writes CSV to standard output. Lines `pair` have unit spheres at the centre distances 2 ... 6. Their error
 * is that of F12 in per cent, as root mean square over 24 orientations of the pair. Lines `bed` have random periodic
 * beds of 1,000 to 20,000 spheres, radii 0.8-1.2, solid fraction 0.55. Their error is the root mean square of the
 * Euclidean errors of 20 rows, against 10,000 beams. Seconds are those of one thread in the rows. */
#include "bed/packing.h"
#include "bench_bed.h"

enum { ORIENTATIONS = 24, ROWS = 20 };

static void bench_pair(fibrad_work *work, int random, uint32_t rays, int h) {
    double exact = 0, error = 0, estimate = 0, seconds = 0;
    fibrad_row row = bench_arrays(2);
    bench_check("pair", fibrad_pair_exact(1, 1, h - 2, &exact));
    for (uint32_t k = 0; k < ORIENTATIONS; ++k) {
        double x[2] = {0}, y[2] = {0}, z[2] = {0}, r[2] = {1, 1}, w[3] = {0};
        const fibrad_cast_rule rule = {.rays = rays, .random = random, .seed = k};
        void *block;
        fibrad_direction(k, ORIENTATIONS, w);
        x[1] = h * w[0], y[1] = h * w[1], z[1] = h * w[2];
        const struct bed pair = {.n = 2, .x = x, .y = y, .z = z, .r = r};
        const fibrad_scene *scene = bench_scene(&pair, FIBRAD_ISA_BEST, &block);
        const double begun = bench_thread_seconds();
        bench_row(scene, work, &(struct bench_method){.cast = &rule}, 0, &row);
        seconds += bench_thread_seconds() - begun;
        error += pow((row.length > 0 ? row.f[0] : 0) / exact - 1, 2) / ORIENTATIONS;
        estimate += pow(row.error / exact, 2) / ORIENTATIONS;
        free(block);
    }
    printf("pair,%s,%d,%u,%.4f,%.4f,%.1f\n", random ? "mc" : "cast", h, rays, 100 * sqrt(error), 100 * sqrt(estimate),
           1e9 * seconds / rays / ORIENTATIONS);
    fflush(stdout);
    free(row.col);
    free(row.f);
}

static void bench_rays(const fibrad_scene *scene, fibrad_work *work, uint32_t n, const fibrad_row truth[ROWS],
                       const fibrad_cast_rule *rule) {
    const struct bench_method method = {.name = rule->random ? "mc" : "cast", .cast = rule};
    double error = 0, estimate = 0, seconds = 0;
    fibrad_row row = bench_arrays(n);
    for (uint32_t i = 0; i < ROWS; ++i) {
        const double begun = bench_thread_seconds();
        bench_row(scene, work, &method, i * (n / ROWS), &row);
        seconds += bench_thread_seconds() - begun;
        error += pow(bench_distance(bench_row_entries(&row), bench_row_entries(&truth[i])), 2) / ROWS;
        estimate += row.error * row.error / ROWS;
    }
    printf("bed,%s,%u,%u,%.3g,%.3g,%.1f\n", method.name, n, rule->rays, sqrt(error), sqrt(estimate),
           1e9 * seconds / rule->rays / ROWS);
    fflush(stdout);
    free(row.col);
    free(row.f);
}

static int bench_bed(fibrad_work *work, uint32_t n, bool quick) {
    static const uint32_t rays[] = {10000, 100000, 1000000};
    const fibrad_beam_rule fine = {.directions = quick ? 1000 : 10000};
    fibrad_row truth[ROWS];
    struct bed bed = bed_empty();
    void *block;
    const int status = bed_make_packing(&bed, n, .8, 1.2, .55, 1);
    if (status) return status;
    const fibrad_scene *scene = bench_scene(&bed, FIBRAD_ISA_BEST, &block);
    for (uint32_t i = 0; i < ROWS; ++i) {
        truth[i] = bench_arrays(n);
        bench_row(scene, work, &(struct bench_method){.beam = &fine}, i * (n / ROWS), &truth[i]);
    }
    for (int random = 0; random <= 1; ++random)
        for (int r = 0; r < (quick ? 1 : 3 - random); ++r)
            bench_rays(scene, work, n, truth, &(fibrad_cast_rule){.rays = rays[r], .random = random});
    for (uint32_t i = 0; i < ROWS; ++i) {
        free(truth[i].col);
        free(truth[i].f);
    }
    free(block);
    bed_free(&bed);
    return 0;
}

int main(int argc, char **argv) {
    static const uint32_t rays[] = {20000, 200000, 4000000}, spheres[] = {1000, 5000, 20000};
    const bool quick = argc > 1 && strcmp(argv[1], "quick") == 0;
    fibrad_work work = BENCH_GROWING;
    int status = 0;
    bench_preamble("bench_cast: pairs: error in per cent of F12; beds: Euclidean error of a row", 1);
    puts("scene,method,distance_or_spheres,rays,error,error_estimate,nanoseconds_per_ray");
    for (int random = 0; random <= 1; ++random)
        for (int r = 0; r < (quick ? 1 : 3 - random);
             ++r) /* so many random rays would take as long and show nothing new */
            for (int h = 2; h <= 6; ++h) bench_pair(&work, random, rays[r], h);
    for (size_t s = 0; s < (quick ? 1 : sizeof spheres / sizeof *spheres) && !status; ++s)
        status = bench_bed(&work, spheres[s], quick);
    free(work.memory.block);
    return status;
}
