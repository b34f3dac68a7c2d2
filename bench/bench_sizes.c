/* bench_sizes.c - rows of beds of two sizes of spheres, against those of one. SPDX-License-Identifier: MIT
 *
 *     bench_sizes [quick]
 *
 * CSV on standard output. Periodic random beds, solid fraction 0.55, in which spheres of radius 1 and of radius `ratio`
 * take up equal volumes; 100 directions, exact areas, one thread. For each size: rows, entries of a row, processor time
 * of a row and of an entry; and its ratio to the time of an entry in the bed of equal spheres. `fewer`: large spheres
 * with a fourth of the directions, as the program has them. */
#include <math.h>

#include "bed/packing.h"
#include "bench.h"
#include "cli/message.h"
#include "compute/rows.h"

enum { DIRECTIONS = 100, CAPACITY = 100000 };

struct cost {
    double seconds, entries;
    uint32_t rows;
};

/* Adds row i to the cost. */
static int add(struct cost *cost, const fibrad_scene *scene, fibrad_work *work, uint32_t i, uint32_t directions) {
    static uint32_t col[CAPACITY];
    static double f[CAPACITY];
    fibrad_row row = {.col = col, .f = f, .capacity = CAPACITY};
    const fibrad_beam_rule rule = {.directions = directions};
    const double begun = bench_thread_seconds();
    const int status = fibrad_beam_row(scene, work, i, &rule, &row);
    if (status) return message(STATUS_INPUT, "row %u: %s", i, fibrad_status_text(status));
    cost->seconds += bench_thread_seconds() - begun;
    cost->entries += row.length;
    cost->rows++;
    return STATUS_OK;
}

static void print(double ratio, const char *size, const struct cost *cost, double equal) {
    printf("%g,%s,%u,%.0f,%.1f,%.3f,%.2f\n", ratio, size, cost->rows, cost->entries / cost->rows,
           1e6 * cost->seconds / cost->rows, 1e6 * cost->seconds / cost->entries,
           cost->seconds / cost->entries / equal);
    fflush(stdout);
}

/* Large spheres come first in the bed. Of the small ones, every `skip`th is enough. */
static int bench(double ratio, uint32_t large, uint32_t skip, double *equal) {
    struct bed bed;
    bed_init(&bed, false, 0);
    int status =
        ratio > 1 ? bed_make_two_sizes(&bed, large, ratio, 0.55, 1) : bed_make_packing(&bed, large, 1, 1, 0.55, 1);
    if (status) return status;
    const fibrad_scene_config config = {.spheres = bed.n, .period = {bed.period[0], bed.period[1], bed.period[2]}};
    const fibrad_work_config work_config = {.near = 16384, .discs = 16384, .entries = bed.n};
    const fibrad_spheres views = {bed.x, bed.y, bed.z, bed.r, bed.n};
    const size_t scene_size = fibrad_scene_size(&config), work_size = fibrad_work_size(&work_config);
    void *scene_block = run_block(scene_size), *work_block = run_block(work_size);
    fibrad_scene *scene = NULL;
    fibrad_work *work = NULL;
    if (!scene_block || !work_block)
        status = message_memory();
    else if (fibrad_scene_init(&scene, scene_block, scene_size, &config, &views, NULL) ||
             fibrad_work_init(&work, work_block, work_size, &work_config))
        status = message(STATUS_INPUT, "the bed is refused");
    struct cost large_cost = {0}, fewer_cost = {0}, small_cost = {0};
    const uint32_t split = ratio > 1 ? large : 0;
    for (uint32_t i = 0; i < split && !status; ++i) status = add(&large_cost, scene, work, i, DIRECTIONS);
    for (uint32_t i = 0; i < split && !status; ++i) status = add(&fewer_cost, scene, work, i, DIRECTIONS / 4);
    for (uint32_t i = split; i < bed.n && !status; i += skip) status = add(&small_cost, scene, work, i, DIRECTIONS);
    if (!status) {
        const double scale = (double)(bed.n - split) / small_cost.rows, entries = small_cost.entries * scale;
        struct cost all = {large_cost.seconds + scale * small_cost.seconds, large_cost.entries + entries, bed.n};
        if (ratio <= 1) *equal = all.seconds / all.entries;
        if (split > 0) print(ratio, "large", &large_cost, *equal);
        if (split > 0) print(ratio, "small", &small_cost, *equal);
        print(ratio, "all", &all, *equal);
        all.seconds += fewer_cost.seconds - large_cost.seconds;
        if (split > 0) print(ratio, "all; fewer", &all, *equal);
    }
    free(scene_block);
    free(work_block);
    bed_free(&bed);
    return status;
}

int main(int argc, char **argv) {
    const bool quick = argc == 2 && strcmp(argv[1], "quick") == 0;
    bench_preamble("bench_sizes: periodic random beds, 100 directions, exact areas", 1);
    puts("ratio,size,rows,entries_per_row,us_per_row,us_per_entry,over_equal");
    double equal = 1;
    int status = bench(1, quick ? 200 : 2000, 1, &equal);
    if (!status) status = bench(4, quick ? 4 : 40, quick ? 4 : 2, &equal);
    if (!status && !quick) status = bench(10, 10, 10, &equal);
    return status;
}
