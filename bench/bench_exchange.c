/* bench_exchange.c - exchange factors of grey spheres: error against time. SPDX-License-Identifier: MIT
 *
 * CSV on standard output. Random periodic bed of 2,000 equal spheres, solid fraction 0.586; root mean square of the
 * Euclidean error of ROWS rows, not averaged with their partners, the truth being 6,400 beams and 2,000,000 paths;
 * error as estimated; seconds of one thread for a row; rays traced for a row, without beams. Methods: analog    random
 * paths, each absorbed as a whole where a random number says so expected  quasi-random paths that leave at each surface
 * what it absorbs beam      fibrad_exchange_row: the first leg by beams, the others by such paths */
#include <math.h>

#include "base/elementary.h"
#include "bed/packing.h"
#include "bench.h"
#include "exchange/paths.h"
#include "cli/message.h"
#include "compute/exchange_rows.h"

enum { ROWS = 24 };

struct bench {
    uint32_t n;
    fibrad_scene *scene;
    fibrad_work *work;
    fibrad_tracer *tracer;
    double *emissivity, *truth, *sum;
    uint32_t *col;
    double *f;
};

static int open_bench(struct bench *bench, const struct bed *bed) {
    const fibrad_scene_config config = {.spheres = bed->n, .period = {bed->period[0], bed->period[1], bed->period[2]}};
    const fibrad_work_config room = {.entries = bed->n};
    const fibrad_spheres spheres = {bed->x, bed->y, bed->z, bed->r, bed->n};
    const size_t size[3] = {fibrad_scene_size(&config), fibrad_work_size(&room), fibrad_tracer_size(NULL)};
    void *block[3];
    for (int k = 0; k < 3; ++k) block[k] = run_block(size[k]);
    *bench = (struct bench){.n = bed->n};
    bench->emissivity = calloc(bed->n, sizeof(double));
    bench->truth = calloc((size_t)bed->n * ROWS, sizeof(double));
    bench->sum = calloc(bed->n, sizeof(double));
    bench->col = calloc(bed->n, sizeof(uint32_t));
    bench->f = calloc(bed->n, sizeof(double));
    if (!block[0] || !block[1] || !block[2] || !bench->emissivity || !bench->truth || !bench->sum || !bench->col ||
        !bench->f)
        return message_memory();
    int status = fibrad_scene_init(&bench->scene, block[0], size[0], &config, &spheres, NULL);
    if (!status) status = fibrad_work_init(&bench->work, block[1], size[1], &room);
    if (!status) status = fibrad_tracer_init(&bench->tracer, block[2], size[2], NULL, bench->scene);
    return status ? message(STATUS_INPUT, "%s", fibrad_status_text(status)) : STATUS_OK;
}

static uint32_t target(const struct bench *bench, uint32_t k) { return k * (bench->n / ROWS); }

/* What a method makes of row i: into bench->sum, its estimated error and its rays. */
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
    (void)directions;
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
            fibrad_trace_avx512(bench->tracer, place, n, w, &hit);
            ++*rays;
            place = hit.sphere;
            memcpy(n, hit.normal, sizeof n);
        } while (place != FIBRAD_NONE && fibrad_random_next(&random) >= bench->emissivity[bench->scene->order[place]]);
        if (place != FIBRAD_NONE) bench->sum[bench->scene->order[place]] += 1.0 / paths;
    }
    *error = 1 / sqrt(paths);
}

static void expected(struct bench *bench, uint32_t i, uint32_t paths, uint32_t directions, double *error,
                     uint64_t *rays) {
    static const double walls[FIBRAD_WALLS];
    fibrad_paths state = {.tracer = bench->tracer,
                          .place = bench->scene->place[i],
                          .emissivity = bench->emissivity,
                          .wall_emissivity = walls,
                          .stream = fibrad_random_start(1, i),
                          .first = true,
                          .entries = &bench->work->entries};
    fibrad_row row = {.col = bench->col, .f = bench->f, .capacity = bench->n};
    (void)directions;
    fibrad_work_begin(bench->work, bench->scene, state.place, 0, (fibrad_stride){0});
    fibrad_paths_follow(&state, 0, paths);
    fibrad_entries_row(bench->work, 1.0 / paths, &row);
    for (uint32_t k = 0; k < row.length; ++k) bench->sum[row.col[k]] += row.f[k];
    *error = row.error;
    *rays = state.rays;
}

static void beam(struct bench *bench, uint32_t i, uint32_t paths, uint32_t directions, double *error, uint64_t *rays) {
    const fibrad_exchange_rule rule = {
        .emissivity = bench->emissivity, .directions = directions, .paths = paths, .seed = paths > 100000};
    fibrad_row row = {.col = bench->col, .f = bench->f, .capacity = bench->n};
    const int status = fibrad_exchange_row(bench->tracer, bench->work, i, &rule, &row, rays);
    if (status) message(STATUS_INPUT, "row %u: %s", i, fibrad_status_text(status));
    for (uint32_t k = 0; k < row.length; ++k) bench->sum[row.col[k]] += row.f[k];
    *error = row.error;
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
static int measure_rows(const struct bench *bench, const struct bed *bed, double emissivity) {
    const struct run_options options = {.file = "bench", .threads = 2};
    const fibrad_exchange_rule rule = {.emissivity = bench->emissivity, .error = .01, .seed = 7};
    struct result result;
    uint64_t rays;
    double error = 0, size = 0, estimate = 0;
    const int status = run_exchange(bed, &options, &rule, 0, &result, &rays);
    for (uint32_t k = 0; k < ROWS && !status; ++k) {
        const uint32_t i = target(bench, k);
        const double *truth = bench->truth + (size_t)k * bench->n;
        uint64_t at = result.rows.start[i];
        for (uint32_t j = 0; j < bench->n; ++j) {
            const bool here = at < result.rows.start[i + 1] && result.rows.col[at] == j;
            error += pow((here ? result.rows.f[at++] : 0) - truth[j], 2) / ROWS;
            size += truth[j] * truth[j] / ROWS;
        }
        estimate += result.error[i] * result.error[i] / ROWS;
    }
    if (!status)
        printf("rows,%.1f,%u,0,%.3e,%.3e,%.3e,%.3e,%.0f\n", emissivity, result.directions, sqrt(error),
               sqrt(error / size), sqrt(estimate), result.seconds, (double)rays / bed->n);
    fflush(stdout);
    result_free(&result);
    return status;
}

static void find_truth(struct bench *bench) {
    for (uint32_t k = 0; k < ROWS; ++k) {
        double error;
        uint64_t rays;
        memset(bench->sum, 0, bench->n * sizeof *bench->sum);
        beam(bench, target(bench, k), 600000, 3200, &error, &rays);
        memcpy(bench->truth + (size_t)k * bench->n, bench->sum, bench->n * sizeof *bench->sum);
    }
}

int main(int argc, char **argv) {
    const bool quick = argc > 1 && strcmp(argv[1], "quick") == 0;
    struct bench bench;
    struct bed bed;
    bed_init(&bed, false, 0);
    int status = bed_make_packing(&bed, quick ? 200 : 2000, 1, 1, .586, 1);
    if (!status) status = open_bench(&bench, &bed);
    if (status) return status;
    bench_preamble("exchange factors of grey spheres: error against time", 1);
    puts("method,emissivity,directions,paths,error,relative_error,error_estimate,seconds,rays");
    for (double emissivity = .3; emissivity < .9; emissivity += .5) {
        for (uint32_t i = 0; i < bed.n; ++i) bench.emissivity[i] = emissivity;
        find_truth(&bench);
        for (uint32_t paths = 100; paths <= (quick ? 100 : 100000); paths *= 10)
            measure(&bench, "analog", analog, emissivity, paths, 0);
        for (uint32_t paths = 100; paths <= (quick ? 100 : 100000); paths *= 10)
            measure(&bench, "expected", expected, emissivity, paths, 0);
        for (uint32_t paths = 100, directions = 25; paths <= (quick ? 100 : 100000); paths *= 10, directions *= 4)
            measure(&bench, "beam", beam, emissivity, paths, directions);
        if (!status) status = measure_rows(&bench, &bed, emissivity);
        if (quick || status) break;
    }
    return status;
}
