/* bench_skips.c - the time that each skipped step saves. SPDX-License-Identifier: MIT
 *
 *     bench_skips [quick | windows]
 *
 * The bench writes CSV to standard output, on one thread. It has the processor time with and without each skip that an
 * argument can turn off. It also has rows of sparse scenes against the number of spheres. With `windows` it writes one
 * line: microseconds per window in the middle of a random bed, and a hash of the rows. bench/skips.sh uses this line.
 * It turns the other skips off in the source. */
#include "bed/packing.h"
#include "bench_bed.h"
#include "surface/surface_lanes.h"

enum { SAMPLE = 200, DIRECTIONS = 100 };

struct rows_of {
    struct bed bed;
    fibrad_scene *scene;
    void *block;      /* of the scene */
    fibrad_work work; /* that grows; fixed: see row_by */
    fibrad_row row;   /* with room for all entries */
    double scene_seconds;
};

/* Makes the scene of a given bed. */
static void begin(struct rows_of *rows) {
    const double begun = bench_thread_seconds();
    rows->scene = bench_scene(&rows->bed, FIBRAD_ISA_BEST, &rows->block);
    rows->scene_seconds = bench_thread_seconds() - begun;
    rows->work = (fibrad_work)BENCH_GROWING;
    rows->row = bench_arrays(rows->bed.n);
}

static void end(struct rows_of *rows) {
    free(rows->block);
    free(rows->work.memory.block);
    free(rows->row.col);
    free(rows->row.f);
    bed_free(&rows->bed);
}

/* Computes row i. Fixed work memory gets the least size that the row needs. Such memory has no room for near spheres.
 */
static void row_by(struct rows_of *rows, const struct bench_method *method, uint32_t i) {
    fibrad_memory *memory = &rows->work.memory;
    int status = bench_try_row(rows->scene, &rows->work, method, i, &rows->row);
    while (status == FIBRAD_E_WORK) {
        free(memory->block);
        memory->size = memory->needed;
        memory->block = bench_array(memory->size, 1);
        status = bench_try_row(rows->scene, &rows->work, method, i, &rows->row);
    }
    bench_check("row", status);
}

/* FNV-1a over the bytes of a row. */
static uint64_t hash(uint64_t h, const void *bytes, size_t count) {
    for (size_t k = 0; k < count; ++k) h = (h ^ ((const unsigned char *)bytes)[k]) * 0x100000001b3u;
    return h;
}

/* Microseconds a row, over every `step`th row: the least of three rounds, since others may use the machine. */
static double time_rows(struct rows_of *rows, uint32_t step, const struct bench_method *method, uint64_t *bits,
                        double *entries) {
    const fibrad_row *row = &rows->row;
    double least = INFINITY;
    for (int round = 0; round < 3; ++round) {
        uint32_t count = 0;
        *bits = 0xcbf29ce484222325u;
        *entries = 0;
        const double begun = bench_thread_seconds();
        for (uint32_t i = 0; i < rows->bed.n && count < SAMPLE; i += step, ++count) {
            row_by(rows, method, i);
            *bits = hash(hash(*bits, row->col, row->length * sizeof *row->col), row->f, row->length * sizeof *row->f);
            *entries += row->length;
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

/* The random bed without its periods. */
static int make_bed(struct rows_of *rows, uint32_t n) {
    rows->bed = bed_empty();
    const int status = bed_make_packing(&rows->bed, n, 0.8, 1.2, 0.55, 1);
    for (int axis = 0; axis < 3; ++axis) rows->bed.period[axis] = 0;
    return status;
}

static const fibrad_beam_rule beam_rule = {.directions = DIRECTIONS};
static const struct bench_method beam = {.beam = &beam_rule};

static int windows(void) {
    struct rows_of rows;
    const int status = make_bed(&rows, 10000);
    if (status) return status;
    uint64_t bits;
    double entries;
    begin(&rows);
    const double us = time_rows(&rows, 50, &beam, &bits, &entries);
    printf("%.3f %016llx\n", us / DIRECTIONS, (unsigned long long)bits);
    end(&rows);
    return 0;
}

static int near_spheres(uint32_t n) {
    struct rows_of rows;
    uint64_t bits[2];
    double us[2], entries;
    const int status = make_bed(&rows, n);
    if (status) return status;
    begin(&rows);
    for (int off = 0; off < 2; ++off) {
        us[off] = time_rows(&rows, n / SAMPLE, &beam, &bits[off], &entries);
        free(rows.work.memory.block);
        rows.work = (fibrad_work){0};
    }
    print("near spheres listed once per row", us[0], us[1], bits[0] == bits[1]);
    end(&rows);
    return 0;
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
    struct rows_of rows;
    const int status = make_bed(&rows, n);
    if (status) return status;
    uint64_t bits[2];
    double us[2], entries;
    fibrad_surface_rule rule = {.cutoff = 6};
    const struct bench_method method = {.surface = &rule};
    begin(&rows);
    us[0] = time_rows(&rows, n / 20, &method, &bits[0], &entries);
    for (size_t k = 0; k < sizeof skips / sizeof *skips; ++k) {
        rule.flags = skips[k].flags;
        us[1] = time_rows(&rows, n / 20, &method, &bits[1], &entries);
        print(skips[k].what, us[0], us[1], bits[0] == bits[1]);
    }
    end(&rows);
    return 0;
}

/* Ten rows instead of all, the scene included. */
static int targets(uint32_t n) {
    struct rows_of rows;
    const int status = make_bed(&rows, n);
    if (status) return status;
    uint64_t bits;
    double entries;
    begin(&rows);
    const double us = time_rows(&rows, n / SAMPLE, &beam, &bits, &entries);
    print("10 targets only", 10 * us + 1e6 * rows.scene_seconds, n * us + 1e6 * rows.scene_seconds, true);
    end(&rows);
    return 0;
}

static int sparse(uint32_t n) {
    struct rows_of rows;
    rows.bed = bed_empty();
    const int status = bed_make_packing(&rows.bed, n, 0.8, 1.2, 0.01, 1);
    if (status) return status;
    uint64_t bits;
    double entries;
    begin(&rows);
    const double us = time_rows(&rows, n / SAMPLE, &beam, &bits, &entries);
    printf("sparse %u,%.1f,%.0f,%.3f,%.1f\n", n, us, entries, 1e6 * rows.scene_seconds / n,
           n * (1e-6 * us) + rows.scene_seconds);
    fflush(stdout);
    end(&rows);
    return 0;
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
