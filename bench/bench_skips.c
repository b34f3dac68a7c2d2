/* bench_skips.c - what is saved by each thing that is left out. SPDX-License-Identifier: MIT
 *
 *     bench_skips [quick | windows]
 *
 * CSV on standard output, one thread: processor time with and without each skip that can be turned off by an argument,
 * and rows of sparse scenes against the number of spheres. `windows`: one line, microseconds per window in the middle
 * of a random bed and a hash of the rows, for bench/skips.sh, which turns the others off in the source. */
#include <math.h>

#include "bed/packing.h"
#include "bench.h"
#include "cli/message.h"
#include "compute/rows.h"

enum { ENTRIES = 100000, SAMPLE = 200, DIRECTIONS = 100 };

struct rows_of {
    struct bed bed;
    fibrad_scene *scene;
    fibrad_work *work;
    double scene_seconds;
};

/* Makes scene and work memory for a bed that is given. */
static int begin(struct rows_of *rows, const fibrad_work_config *work_config) {
    const struct bed *bed = &rows->bed;
    const fibrad_scene_config config = {.spheres = bed->n, .period = {bed->period[0], bed->period[1], bed->period[2]}};
    const fibrad_spheres views = {bed->x, bed->y, bed->z, bed->r, bed->n};
    const size_t scene_size = fibrad_scene_size(&config), work_size = fibrad_work_size(work_config);
    void *scene_block = run_block(scene_size), *work_block = run_block(work_size);
    if (!scene_block || !work_block) return message_memory();
    const double begun = bench_thread_seconds();
    const int status = fibrad_scene_init(&rows->scene, scene_block, scene_size, &config, &views, NULL);
    rows->scene_seconds = bench_thread_seconds() - begun;
    if (status || fibrad_work_init(&rows->work, work_block, work_size, work_config))
        return message(STATUS_INPUT, "the bed is refused: %s", fibrad_status_text(status));
    return STATUS_OK;
}

static void end(struct rows_of *rows) { /* both begin at their blocks */
    free(rows->scene);
    free(rows->work);
    rows->scene = NULL;
    rows->work = NULL;
}

/* FNV-1a over the bytes of a row. */
static uint64_t hash(uint64_t h, const void *bytes, size_t count) {
    for (size_t k = 0; k < count; ++k) h = (h ^ ((const unsigned char *)bytes)[k]) * 0x100000001b3u;
    return h;
}

/* Microseconds a row, over every `step`th row from `first`: the least of three rounds, as others may use the machine.
 */
static double time_rows(const struct rows_of *rows, uint32_t first, uint32_t step, const fibrad_beam_rule *beam,
                        const fibrad_surface_rule *surface, uint64_t *bits, double *entries) {
    static uint32_t col[ENTRIES];
    static double f[ENTRIES];
    double least = INFINITY;
    for (int round = 0; round < 3; ++round) {
        uint32_t count = 0;
        *bits = 0xcbf29ce484222325u;
        *entries = 0;
        const double begun = bench_thread_seconds();
        for (uint32_t i = first; i < rows->bed.n && count < SAMPLE; i += step, ++count) {
            fibrad_row row = {.col = col, .f = f, .capacity = ENTRIES};
            const int status = beam ? fibrad_beam_row(rows->scene, rows->work, i, beam, &row)
                                    : fibrad_surface_row(rows->scene, rows->work, i, surface, &row);
            if (status) exit(message(STATUS_INPUT, "row %u: %s", i, fibrad_status_text(status)));
            *bits = hash(hash(*bits, col, row.length * sizeof *col), f, row.length * sizeof *f);
            *entries += row.length;
        }
        least = fmin(least, 1e6 * (bench_thread_seconds() - begun) / count);
        *entries /= count;
    }
    return least;
}

static void print(const char *what, double with, double without, bool same) {
    printf("%s,%.1f,%.1f,%.2f,%s\n", what, with, without, without / with, same ? "same bits" : "other bits");
    fflush(stdout);
}

/* The random bed without its periods, and the rows of spheres in its middle half along every axis first. */
static int make_bed(struct rows_of *rows, uint32_t n) {
    bed_init(&rows->bed, false, 0);
    const int status = bed_make_packing(&rows->bed, n, 0.8, 1.2, 0.55, 1);
    for (int axis = 0; axis < 3; ++axis) rows->bed.period[axis] = 0;
    return status;
}

static int windows(void) {
    struct rows_of rows = {.scene = NULL};
    int status = make_bed(&rows, 10000);
    if (!status) status = begin(&rows, &(fibrad_work_config){.near = 1024, .discs = 4096, .entries = 10000});
    if (status) return status;
    uint64_t bits;
    double entries;
    const fibrad_beam_rule rule = {.directions = DIRECTIONS};
    const double us = time_rows(&rows, 0, 50, &rule, NULL, &bits, &entries);
    printf("%.3f %016llx\n", us / DIRECTIONS, (unsigned long long)bits);
    end(&rows);
    bed_free(&rows.bed);
    return STATUS_OK;
}

static int near_spheres(uint32_t n) {
    struct rows_of rows = {.scene = NULL};
    uint64_t bits[2];
    double us[2], entries;
    int status = make_bed(&rows, n);
    const fibrad_beam_rule rule = {.directions = DIRECTIONS};
    for (int off = 0; off < 2 && !status; ++off) {
        status = begin(&rows, &(fibrad_work_config){.near = off ? 1 : 1024, .discs = 1024, .entries = n});
        if (!status) us[off] = time_rows(&rows, 0, n / SAMPLE, &rule, NULL, &bits[off], &entries);
        end(&rows);
    }
    if (!status) print("near spheres listed once per row", us[0], us[1], bits[0] == bits[1]);
    bed_free(&rows.bed);
    return status;
}

static int surface(uint32_t n) {
    static const struct {
        const char *what;
        uint32_t flags;
    } skips[] = {{"surface: exact where nothing is in between", FIBRAD_SURFACE_NO_EXACT},
                 {"surface: zero where one sphere hides all", FIBRAD_SURFACE_NO_HIDDEN},
                 {"surface: obstacles out of the way", FIBRAD_SURFACE_NO_REGION},
                 {"surface: nodes beyond the horizon", FIBRAD_SURFACE_NO_HORIZON},
                 {"surface: all four", FIBRAD_SURFACE_NO_EXACT | FIBRAD_SURFACE_NO_HIDDEN | FIBRAD_SURFACE_NO_REGION |
                                           FIBRAD_SURFACE_NO_HORIZON}};
    struct rows_of rows = {.scene = NULL};
    int status = make_bed(&rows, n);
    if (!status) status = begin(&rows, NULL);
    uint64_t bits[2];
    double us[2], entries;
    const uint32_t step = n / 20;
    us[0] = status ? 0 : time_rows(&rows, 0, step, NULL, &(fibrad_surface_rule){.cutoff = 6}, &bits[0], &entries);
    for (size_t k = 0; k < sizeof skips / sizeof *skips && !status; ++k) {
        us[1] = time_rows(&rows, 0, step, NULL, &(fibrad_surface_rule){.cutoff = 6, .flags = skips[k].flags}, &bits[1],
                          &entries);
        print(skips[k].what, us[0], us[1], bits[0] == bits[1]);
    }
    end(&rows);
    bed_free(&rows.bed);
    return status;
}

/* Ten rows instead of all, the scene included. */
static int targets(uint32_t n) {
    struct rows_of rows = {.scene = NULL};
    int status = make_bed(&rows, n);
    if (!status) status = begin(&rows, NULL);
    if (status) return status;
    uint64_t bits;
    double entries;
    const fibrad_beam_rule rule = {.directions = DIRECTIONS};
    const double us = time_rows(&rows, 0, n / SAMPLE, &rule, NULL, &bits, &entries);
    print("10 targets only", 10 * us + 1e6 * rows.scene_seconds, n * us + 1e6 * rows.scene_seconds, true);
    end(&rows);
    bed_free(&rows.bed);
    return STATUS_OK;
}

static int sparse(uint32_t n) {
    struct rows_of rows = {.scene = NULL};
    bed_init(&rows.bed, false, 0);
    int status = bed_make_packing(&rows.bed, n, 0.8, 1.2, 0.01, 1);
    if (!status) status = begin(&rows, &(fibrad_work_config){.near = 1024, .discs = 1024, .entries = 8192});
    if (status) return status;
    uint64_t bits;
    double entries;
    const fibrad_beam_rule rule = {.directions = DIRECTIONS};
    const double us = time_rows(&rows, 0, n / SAMPLE, &rule, NULL, &bits, &entries);
    printf("sparse %u,%.1f,%.0f,%.3f,%.1f\n", n, us, entries, 1e6 * rows.scene_seconds / n,
           n * (1e-6 * us) + rows.scene_seconds);
    fflush(stdout);
    end(&rows);
    bed_free(&rows.bed);
    return STATUS_OK;
}

int main(int argc, char **argv) {
    const bool quick = argc == 2 && strcmp(argv[1], "quick") == 0;
    if (argc == 2 && strcmp(argv[1], "windows") == 0) return windows();
    bench_preamble("bench_skips: random beds, radii 0.8-1.2; packed to 0.55 and open, or to 0.01 and periodic", 1);
    puts("# packed: beam with 100 directions, microseconds a row; surface with 55 nodes, cutoff 6");
    puts("skip,us_with,us_without,ratio,result");
    int status = near_spheres(quick ? 400 : 4000);
    if (!status) status = targets(quick ? 400 : 4000);
    if (!status) status = surface(quick ? 200 : 1000);
    puts("# sparse: seconds for all rows by the mean of 200; then 100 directions, exact areas");
    puts("scene,us_per_row,entries_per_row,scene_us_per_sphere,seconds_all_rows");
    for (uint32_t n = 10000; n <= 1000000 && !status; n *= quick ? 1000 : 10) status = sparse(n);
    return status;
}
