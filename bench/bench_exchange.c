/* bench_exchange.c - exchange factors of grey spheres: error against time. SPDX-License-Identifier: MIT
 *
 *     bench_exchange [quick]
 *
 * The bench writes CSV to standard output. The bed is a random periodic bed of 2,000 equal spheres, solid fraction
 * 0.586. The true error is the root mean square of the Euclidean errors of ROWS raw rows, against 3,200 beams and
 * 600,000 paths. Further columns are the estimated error, the seconds of one thread for a row, and the rays traced for
 * a row, without beams. The methods are
 *   analog    random paths; each path is absorbed as a whole when a random number says so
 *   expected  quasi-random paths that leave at each surface what the surface absorbs
 *   beam      fibrad_exchange_row: beams for the first segment, quasi-random paths for the others
 *   rows      fibrad_exchange_factors: all rows of the bed, tolerance 0.01, two threads; directions are the most of a
 * row */
#include "base/elementary.h"
#include "bed/packing.h"
#include "bench_bed.h"
#include "exchange/paths.h"
#include "row/row.h"

enum { ROWS = 24 };

struct bench {
    uint32_t n;
    const fibrad_scene *scene;
    fibrad_work work;
    fibrad_row row;
    double *emissivity, *truth, *sum;
};

static struct bench open_bench(const struct bed *bed) {
    void *block; /* kept until the end */
    return (struct bench){.n = bed->n,
                          .scene = bench_scene(bed, FIBRAD_ISA_BEST, &block),
                          .work = BENCH_GROWING,
                          .row = bench_arrays(bed->n),
                          .emissivity = bench_array(bed->n, sizeof(double)),
                          .truth = bench_array((size_t)bed->n * ROWS, sizeof(double)),
                          .sum = bench_array(bed->n, sizeof(double))};
}

static uint32_t target(const struct bench *bench, uint32_t k) { return k * (bench->n / ROWS); }

/* Computes row i by a method: entries go into bench->sum, with the estimated error and the rays. */
typedef void method(struct bench *bench, uint32_t i, uint32_t paths, uint32_t directions, double *error,
                    uint64_t *rays);

static void point(fibrad_random *random, double at[3]) {
    const double z = 1 - 2 * fibrad_random_next(random), ring = sqrt(1 - z * z);
    double sine, cosine;
    fibrad_sincos_turn(fibrad_random_next(random), &sine, &cosine);
    at[0] = ring * cosine, at[1] = ring * sine, at[2] = z;
}

static void analog(struct bench *bench, uint32_t i, uint32_t paths, uint32_t directions, double *error,
                   uint64_t *rays) {
    fibrad_random random = fibrad_random_start(1, i);
    fibrad_trace_function *trace = FIBRAD_VERSION_OF(fibrad_trace, bench->scene->facts.isa);
    fibrad_workspace *space;
    (void)directions;
    bench_check("work", fibrad_work_open(&bench->work, bench->scene, fibrad_tracer_least(),
                                         fibrad_tracer_best(bench->scene), &space));
    fibrad_tracer *tracer = fibrad_tracer_of(space, bench->scene);
    for (uint32_t k = 0; k < paths; ++k) {
        uint32_t place = bench->scene->place[i];
        fibrad_hit hit;
        double n[3], w[3];
        point(&random, n);
        do {
            point(&random, w);
            for (int axis = 0; axis < 3; ++axis) w[axis] += n[axis];
            const double inverse = 1 / sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
            for (int axis = 0; axis < 3; ++axis) w[axis] *= inverse;
            trace(bench->scene, tracer, place, n, w, &hit);
            ++*rays;
            place = hit.sphere;
            memcpy(n, hit.normal, sizeof n);
        } while (place != FIBRAD_NONE && fibrad_random_next(&random) >= bench->emissivity[bench->scene->order[place]]);
        if (place != FIBRAD_NONE) bench->sum[bench->scene->order[place]] += 1.0 / paths;
    }
    *error = 1 / sqrt(paths);
}

/* Adds bench->row. */
static void add_row(struct bench *bench, double *error) {
    const fibrad_row *row = &bench->row;
    for (uint32_t k = 0; k < row->length; ++k) bench->sum[row->col[k]] += row->f[k];
    *error = row->error;
}

struct expected_rule {
    const double *emissivity;
    uint32_t paths;
    uint64_t *rays;
};

static int expected_row(const fibrad_scene *scene, fibrad_workspace *space, uint32_t i, const void *of,
                        fibrad_row *row) {
    static const double walls[FIBRAD_WALLS];
    const struct expected_rule *rule = of;
    fibrad_paths state = {.tracer = fibrad_tracer_of(space, scene),
                          .place = scene->place[i],
                          .emissivity = rule->emissivity,
                          .wall_emissivity = walls,
                          .stream = fibrad_random_start(1, i),
                          .first = true,
                          .entries = &space->entries};
    fibrad_work_begin(space, scene, state.place, 0, (fibrad_stride){0});
    FIBRAD_VERSION_OF(fibrad_paths_follow, scene->facts.isa)(&state, 0, rule->paths);
    *rule->rays = state.rays;
    const int status = fibrad_work_entries_missed(space);
    return status ? status : fibrad_entries_row(&space->entries, scene, 1.0 / rule->paths, row);
}

static void expected(struct bench *bench, uint32_t i, uint32_t paths, uint32_t directions, double *error,
                     uint64_t *rays) {
    const struct expected_rule rule = {bench->emissivity, paths, rays};
    const fibrad_row_method how = {expected_row, &rule, fibrad_tracer_least(), fibrad_tracer_best(bench->scene)};
    (void)directions;
    bench_check("row", fibrad_row_run(bench->scene, &bench->work, i, &how, &bench->row));
    add_row(bench, error);
}

static void beam(struct bench *bench, uint32_t i, uint32_t paths, uint32_t directions, double *error, uint64_t *rays) {
    const fibrad_exchange_rule rule = {
        .emissivity = bench->emissivity, .directions = directions, .paths = paths, .seed = paths > 100000};
    bench_check("row", fibrad_exchange_row(bench->scene, &bench->work, i, &rule, &bench->row, rays));
    add_row(bench, error);
}

static void measure(struct bench *bench, const char *name, method *run, double emissivity, uint32_t paths,
                    uint32_t directions) {
    double error = 0, estimate = 0, seconds = 0, size = 0;
    uint64_t rays = 0;
    for (uint32_t k = 0; k < ROWS; ++k) {
        memset(bench->sum, 0, bench->n * sizeof *bench->sum);
        const double *truth = bench->truth + (size_t)k * bench->n, begun = bench_thread_seconds();
        double guess = 0;
        uint64_t traced = 0;
        run(bench, target(bench, k), paths, directions, &guess, &traced);
        seconds += bench_thread_seconds() - begun;
        for (uint32_t j = 0; j < bench->n; ++j) {
            error += pow(bench->sum[j] - truth[j], 2) / ROWS;
            size += truth[j] * truth[j] / ROWS;
        }
        estimate += guess * guess / ROWS;
        rays += traced;
    }
    printf("%s,%.1f,%u,%u,%.3e,%.3e,%.3e,%.3e,%.0f\n", name, emissivity, directions, paths, sqrt(error),
           sqrt(error / size), sqrt(estimate), seconds / ROWS, (double)rays / ROWS);
    fflush(stdout);
}

/* All rows of the bed at once. */
static void measure_rows(const struct bench *bench, const struct bed *bed, double emissivity) {
    const fibrad_exchange_rule rule = {.emissivity = bench->emissivity, .tolerance = .01, .seed = 7};
    const fibrad_spheres spheres = bench_spheres(bed);
    const fibrad_scene_config config = bench_config(bed, FIBRAD_ISA_BEST);
    fibrad_run run = {.threads = 2};
    fibrad_bed_matrix *factors;
    double error = 0, size = 0, estimate = 0;
    bench_check("factors",
                fibrad_view_factors(&config, &spheres, &(fibrad_bed_rule){.exchange = &rule}, &run, &factors));
    for (uint32_t k = 0; k < ROWS; ++k) {
        const uint32_t i = target(bench, k);
        const double *truth = bench->truth + (size_t)k * bench->n;
        const struct bench_entries row = bench_matrix_entries(&factors->matrix, i);
        for (uint32_t j = 0, at = 0; j < bench->n; ++j) {
            const bool here = at < row.length && row.col[at] == j;
            error += pow((here ? row.f[at++] : 0) - truth[j], 2) / ROWS;
            size += truth[j] * truth[j] / ROWS;
        }
        estimate += factors->matrix.error[i] * factors->matrix.error[i] / ROWS;
    }
    printf("rows,%.1f,%u,0,%.3e,%.3e,%.3e,%.3e,%.0f\n", emissivity, factors->directions, sqrt(error),
           sqrt(error / size), sqrt(estimate), factors->seconds, (double)factors->rays / bed->n);
    fflush(stdout);
    fibrad_bed_matrix_free(factors);
}

static void find_truth(struct bench *bench, uint32_t paths) {
    for (uint32_t k = 0; k < ROWS; ++k) {
        double error;
        uint64_t rays;
        memset(bench->sum, 0, bench->n * sizeof *bench->sum);
        beam(bench, target(bench, k), paths, 3200, &error, &rays);
        memcpy(bench->truth + (size_t)k * bench->n, bench->sum, bench->n * sizeof *bench->sum);
    }
}

int main(int argc, char **argv) {
    const bool quick = argc > 1 && strcmp(argv[1], "quick") == 0;
    struct bed bed = bed_empty();
    const int status = bed_make_packing(&bed, quick ? 200 : 2000, 1, 1, .586, 1);
    if (status) return status;
    struct bench bench = open_bench(&bed);
    bench_preamble("exchange factors of grey spheres: error against time", 1);
    puts("method,emissivity,directions,paths,error,relative_error,error_estimate,seconds,rays");
    for (double emissivity = .3; emissivity < .9; emissivity += .5) {
        for (uint32_t i = 0; i < bed.n; ++i) bench.emissivity[i] = emissivity;
        find_truth(&bench, quick ? 101000 : 600000);
        for (uint32_t paths = 100; paths <= (quick ? 100 : 100000); paths *= 10)
            measure(&bench, "analog", analog, emissivity, paths, 0);
        for (uint32_t paths = 100; paths <= (quick ? 100 : 100000); paths *= 10)
            measure(&bench, "expected", expected, emissivity, paths, 0);
        for (uint32_t paths = 100, directions = 25; paths <= (quick ? 100 : 100000); paths *= 10, directions *= 4)
            measure(&bench, "beam", beam, emissivity, paths, directions);
        measure_rows(&bench, &bed, emissivity);
        if (quick) break;
    }
    return 0;
}
