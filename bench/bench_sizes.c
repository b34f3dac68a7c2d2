/* bench_sizes.c - rows of beds of two sizes of spheres, against those of one size. SPDX-License-Identifier: MIT
 *
 *     bench_sizes [quick]
 *
 * The bench writes CSV to standard output. The beds are periodic random beds, solid fraction 0.55. In each bed, spheres
 * of radius 1 and of radius `ratio` take up equal volumes. Rows have 100 directions and exact areas, on one thread. For
 * each size there are the number of rows, the entries of a row, the processor time of a row and that of an entry. The
 * last column is the time of an entry over that in the bed of equal spheres. The size "whole" stands for all rows of
 * the bed at once, along lines, with their matrix.
 *
 * Then all rows of a shell are computed, averaged, with 50 directions, by one thread and by two. The shell has a sphere
 * of radius 1 and 20,000 spheres of radius 5e-4, at random 0.6e-3 to 21e-3 above its surface. */
#include "bed/packing.h"
#include "bench_bed.h"

enum { DIRECTIONS = 100 };

struct cost {
    double seconds, entries;
    uint32_t rows;
};

/* Adds row i to the cost. */
static void add(struct cost *cost, const fibrad_scene *scene, fibrad_work *work, uint32_t i, uint32_t directions,
                fibrad_row *row) {
    const fibrad_beam_rule rule = {.directions = directions};
    const double begun = bench_thread_seconds();
    bench_check("row", fibrad_beam_row(scene, work, i, &rule, row));
    cost->seconds += bench_thread_seconds() - begun;
    cost->entries += row->length;
    cost->rows++;
}

static void print(double ratio, const char *size, const struct cost *cost, double equal) {
    printf("%g,%s,%u,%.0f,%.1f,%.3f,%.2f\n", ratio, size, cost->rows, cost->entries / cost->rows,
           1e6 * cost->seconds / cost->rows, 1e6 * cost->seconds / cost->entries,
           cost->seconds / cost->entries / equal);
    fflush(stdout);
}

/* All rows at once. whole: time of an entry, which the bed of equal spheres sets. */
static void bench_whole(double ratio, const struct bed *bed, double *whole) {
    const fibrad_spheres spheres = bench_spheres(bed);
    const fibrad_scene_config config = bench_config(bed, FIBRAD_ISA_BEST);
    const fibrad_bed_rule options = {.beam = &(fibrad_beam_rule){.directions = DIRECTIONS}};
    fibrad_run run = {.threads = 1};
    fibrad_bed_matrix *factors;
    const double begun = bench_thread_seconds();
    bench_check("whole", fibrad_view_factors(&config, &spheres, &options, &run, &factors));
    const struct cost cost = {bench_thread_seconds() - begun, (double)factors->matrix.start[bed->n], bed->n};
    if (ratio <= 1) *whole = cost.seconds / cost.entries;
    print(ratio, "whole", &cost, *whole);
    fibrad_bed_matrix_free(factors);
}

/* Large spheres come first in the bed. Every `skip`th small sphere is enough. equal: times of an entry of single rows,
 * and of all rows at once. */
static int bench(double ratio, uint32_t large, uint32_t skip, double equal[2]) {
    struct bed bed = bed_empty();
    const int status =
        ratio > 1 ? bed_make_two_sizes(&bed, large, ratio, 0.55, 1) : bed_make_packing(&bed, large, 1, 1, 0.55, 1);
    if (status) return status;
    void *block;
    const fibrad_scene *scene = bench_scene(&bed, FIBRAD_ISA_BEST, &block);
    fibrad_work work = BENCH_GROWING;
    fibrad_row row = bench_arrays(bed.n);
    struct cost large_cost = {0}, small_cost = {0}, first = {0};
    const uint32_t split = ratio > 1 ? large : 0;
    for (uint32_t i = 0; i < split; ++i) add(&first, scene, &work, i, DIRECTIONS / 4, &row); /* memory grows */
    for (uint32_t i = 0; i < split; ++i) add(&large_cost, scene, &work, i, DIRECTIONS, &row);
    for (uint32_t i = split; i < bed.n; i += skip) add(&small_cost, scene, &work, i, DIRECTIONS, &row);
    const double scale = (double)(bed.n - split) / small_cost.rows, entries = small_cost.entries * scale;
    const struct cost all = {large_cost.seconds + scale * small_cost.seconds, large_cost.entries + entries, bed.n};
    if (ratio <= 1) equal[0] = all.seconds / all.entries;
    if (split > 0) print(ratio, "large", &large_cost, equal[0]);
    if (split > 0) print(ratio, "small", &small_cost, equal[0]);
    print(ratio, "all", &all, equal[0]);
    bench_whole(ratio, &bed, &equal[1]);
    free(work.memory.block);
    free(row.col);
    free(row.f);
    free(block);
    bed_free(&bed);
    return 0;
}

/* A sphere of radius 1, and `count` of radius 5e-4 about it that do not overlap. */
static int make_shell(struct bed *bed, uint32_t count) {
    const double r = 5e-4, low = 0.6e-3, high = 21e-3;
    int status = bed_add(bed, &(struct bed_sphere){.r = 1});
    for (uint64_t at = 0; bed->n <= count && !status; at += 3) {
        const double z = 2 * bed_make_random(1, at) - 1, angle = 6.283185307179586 * bed_make_random(1, at + 1);
        const double d = 1 + low + (high - low) * bed_make_random(1, at + 2), side = d * sqrt(1 - z * z);
        const struct bed_sphere sphere = {.x = side * cos(angle), .y = side * sin(angle), .z = d * z, .r = r};
        bool fits = true;
        for (uint32_t j = 1; j < bed->n && fits; ++j) {
            const double dx = bed->x[j] - sphere.x, dy = bed->y[j] - sphere.y, dz = bed->z[j] - sphere.z;
            fits = dx * dx + dy * dy + dz * dz > 4 * r * r;
        }
        if (fits) status = bed_add(bed, &sphere);
    }
    return status;
}

static int bench_shell(uint32_t count) {
    struct bed bed = bed_empty();
    const int status = make_shell(&bed, count);
    const fibrad_spheres spheres = bench_spheres(&bed);
    const fibrad_bed_rule options = {.beam = &(fibrad_beam_rule){.directions = 50}};
    puts("shell_of,threads,seconds");
    for (int threads = 1; threads <= 2 && !status; ++threads) {
        fibrad_run run = {.threads = threads};
        fibrad_bed_matrix *factors;
        bench_check("shell", fibrad_view_factors(NULL, &spheres, &options, &run, &factors));
        printf("%u,%d,%.2f\n", count, threads, factors->seconds);
        fibrad_bed_matrix_free(factors);
    }
    bed_free(&bed);
    return status;
}

int main(int argc, char **argv) {
    const bool quick = argc == 2 && strcmp(argv[1], "quick") == 0;
    bench_preamble("bench_sizes: periodic random beds, 100 directions, exact areas", 1);
    puts("ratio,size,rows,entries_per_row,us_per_row,us_per_entry,over_equal");
    double equal[2] = {1, 1};
    int status = bench(1, quick ? 200 : 2000, 1, equal);
    if (!status) status = bench(4, quick ? 4 : 40, quick ? 4 : 2, equal);
    if (!status && !quick) status = bench(10, 10, 10, equal);
    if (!status) status = bench_shell(quick ? 500 : 20000);
    return status;
}
