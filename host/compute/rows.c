/* rows.c - rows of view factors of a whole bed, by OpenMP over its spheres. SPDX-License-Identifier: MIT
 *
 * Each thread appends the rows it computes to a store of its own; afterwards they are copied in order into one matrix.
 * A row does not depend on who computes it, so neither does the matrix. */
#include "compute/rows.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/progress.h"
#include "compute/average.h"

/* Rows of one thread, one behind the other. */
struct store {
    uint32_t *col;
    double *f;
    size_t used, capacity;
    uint32_t directions; /* the most that a row took */
    uint64_t fallbacks;  /* of all its rows */
    fibrad_work *work;
    void *block; /* of the work */
};

/* Where a row is. */
struct place {
    size_t begin;
    uint32_t length;
    int thread;
};

/* Spheres this much larger than the mean radius are computed by the method's rule for large ones. */
#define LARGE 3.0

struct run {
    const struct bed *bed;
    const struct run_options *options;
    struct result *result;
    fibrad_scene *scene;
    struct store *stores; /* [threads] */
    struct place *places; /* [n] */
    double *weight;       /* [n] of each row in the mean of both; NULL: the same for all */
    double large;         /* spheres above this radius count as large */
    int status;           /* the first trouble of any thread */
};

void *run_block(size_t size) { return aligned_alloc(64, (size + 63) / 64 * 64); }

bool run_work(fibrad_work **work, void **block, const fibrad_work_config *config) {
    const size_t size = fibrad_work_size(config);
    free(*block);
    *work = NULL;
    *block = size ? run_block(size) : NULL;
    return *block && fibrad_work_init(work, *block, size, config) == FIBRAD_OK;
}

/* Turns a kernel's fault into a message that names the sphere's line. */
static int refuse(const struct bed *bed, const char *file, int status, const fibrad_fault *fault) {
    const uint32_t first = fault->first, second = fault->second;
    if (status == FIBRAD_E_GEOMETRY && first >= bed->n)
        return message_at(STATUS_INPUT, file, 0, "the periodic box is smaller than a sphere's radius");
    if (first >= bed->n || second >= bed->n)
        return message_at(STATUS_INPUT, file, 0, "this bed and box cannot be computed: %s", fibrad_status_text(status));
    if (status != FIBRAD_E_GEOMETRY)
        return message_at(STATUS_INPUT, file, bed->line[first], "sphere %u: %s", first, fibrad_status_text(status));
    const uint32_t later = bed->line[first] < bed->line[second] ? second : first;
    const uint32_t other = later == first ? second : first;
    if (later == other)
        return message_at(STATUS_INPUT, file, bed->line[later], "sphere %u reaches its own image in the periodic box",
                          later);
    const bool equal =
        bed->x[first] == bed->x[second] && bed->y[first] == bed->y[second] && bed->z[first] == bed->z[second];
    return message_at(STATUS_INPUT, file, bed->line[later],
                      equal ? "sphere %u has the same centre as sphere %u of line %llu"
                            : "sphere %u and sphere %u of line %llu: the centre of one lies inside the other",
                      later, other, (unsigned long long)bed->line[other]);
}

int run_scene(const struct bed *bed, const fibrad_walls *walls, const char *file, fibrad_scene **scene, void **block) {
    const fibrad_scene_config config = {
        .spheres = bed->n, .period = {bed->period[0], bed->period[1], bed->period[2]}, .walls = *walls};
    const fibrad_spheres spheres = {bed->x, bed->y, bed->z, bed->r, bed->n};
    fibrad_fault fault = {bed->n, bed->n};
    const size_t size = fibrad_scene_size(&config);
    if (size == 0) return refuse(bed, file, FIBRAD_E_ARGUMENT, &fault);
    *block = run_block(size);
    if (!*block) return message_memory();
    const int status = fibrad_scene_init(scene, *block, size, &config, &spheres, &fault);
    return status ? refuse(bed, file, status, &fault) : STATUS_OK;
}

static bool make_work(struct store *store, const fibrad_work_config *config) {
    return run_work(&store->work, &store->block, config);
}

static bool make_room(struct store *store, size_t entries) {
    if (store->capacity - store->used >= entries) return true;
    const size_t capacity = 2 * store->capacity + entries;
    uint32_t *col = realloc(store->col, capacity * sizeof *col);
    if (col) store->col = col;
    double *f = realloc(store->f, capacity * sizeof *f);
    if (f) store->f = f;
    if (col && f) store->capacity = capacity;
    return col && f;
}

/* Computes row i to the end of the store; what turns out too small is made larger. */
static int add_row(struct run *run, struct store *store, uint32_t i) {
    fibrad_row row = {.length = 64};
    for (;;) {
        if (!make_room(store, row.length)) return STATUS_MEMORY;
        const size_t room = store->capacity - store->used;
        row.col = store->col + store->used;
        row.f = store->f + store->used;
        row.capacity = room < UINT32_MAX ? (uint32_t)room : UINT32_MAX;
        const struct row_method *method = &run->options->method;
        const void *rule = run->bed->r[i] > run->large ? method->large_rule : method->rule;
        const int status = method->row(run->scene, store->work, i, rule, &row);
        if (status == FIBRAD_OK) break;
        if (status != FIBRAD_E_CAPACITY) return message(STATUS_INPUT, "row %u: %s", i, fibrad_status_text(status));
        if (row.length) continue;
        fibrad_work_config config;
        fibrad_work_needed(store->work, &config);
        if (!make_work(store, &config)) return STATUS_MEMORY;
    }
    run->places[i] = (struct place){store->used, row.length, omp_get_thread_num()};
    run->result->escaped[i] = row.escaped;
    memcpy(run->result->wall[i], row.wall, sizeof row.wall);
    run->result->error[i] = row.error;
    if (run->weight) run->weight[i] = pow(row.directions, 3);
    store->directions = row.directions > store->directions ? row.directions : store->directions;
    store->fallbacks += row.fallbacks;
    store->used += row.length;
    return STATUS_OK;
}

/* The error of a beam row falls as directions^-1.5, so weights are directions^3. A window of a large sphere among small
 * ones meets hundreds of discs, all of which are seen back: with fewer directions for its row it is they who count. */
static int choose_large(struct run *run) {
    const struct bed *bed = run->bed;
    double sum = 0;
    run->large = INFINITY;
    if (!run->options->method.large_rule || run->options->raw) return STATUS_OK;
    for (uint32_t i = 0; i < bed->n; ++i) sum += bed->r[i];
    if (!(run->result->facts.radius_max > LARGE * sum / bed->n)) return STATUS_OK;
    run->large = LARGE * sum / bed->n;
    run->weight = calloc(bed->n, sizeof *run->weight);
    return run->weight ? STATUS_OK : message_memory();
}

static void compute_rows(struct run *run, uint64_t rows) {
    const uint32_t n = run->bed->n;
    const bool *wanted = run->result->wanted;
    struct progress progress;
    uint64_t done = 0;
    int stop = STATUS_OK;
    progress_begin(&progress, run->options->progress, "rows", rows);
#pragma omp parallel num_threads(run->result->threads)
    {
        struct store *store = &run->stores[omp_get_thread_num()];
        int status = make_work(store, NULL) ? STATUS_OK : STATUS_MEMORY;
#pragma omp for schedule(dynamic, 16)
        for (uint32_t k = 0; k < n; ++k) {
            const uint32_t i = fibrad_scene_sphere(run->scene, k);
            int stopped;
#pragma omp atomic read
            stopped = stop;
            if (!wanted[i] || stopped) continue;
            if (!status) status = interrupt_status();
            if (!status) status = add_row(run, store, i);
            uint64_t count;
#pragma omp atomic capture
            count = ++done;
            if (omp_get_thread_num() == 0) progress_show(&progress, count);
            if (status) {
#pragma omp atomic write
                stop = status;
            }
        }
    }
    progress_end(&progress, done);
    run->status = stop;
    if (stop == STATUS_MEMORY) message_memory();
}

/* Frees what the threads have gathered; the directions and fallbacks of the rows are kept. */
static void free_stores(struct run *run) {
    for (int t = 0; run->stores && t < run->result->threads; ++t) {
        if (run->stores[t].directions > run->result->directions) run->result->directions = run->stores[t].directions;
        run->result->fallbacks += run->stores[t].fallbacks;
        free(run->stores[t].col);
        free(run->stores[t].f);
        free(run->stores[t].block);
    }
    free(run->stores);
    run->stores = NULL;
}

/* Copies the rows of all threads into one matrix, in order. */
static int assemble(struct run *run) {
    fibrad_rows *rows = &run->result->rows;
    const uint32_t n = run->bed->n;
    rows->n = n;
    rows->start = malloc(((size_t)n + 1) * sizeof *rows->start);
    if (!rows->start) return message_memory();
    rows->start[0] = 0;
    for (uint32_t i = 0; i < n; ++i) rows->start[i + 1] = rows->start[i] + run->places[i].length;
    rows->capacity = rows->start[n];
    rows->col = malloc((rows->capacity + 1) * sizeof *rows->col);
    rows->f = malloc((rows->capacity + 1) * sizeof *rows->f);
    if (!rows->col || !rows->f) return message_memory();
#pragma omp parallel for num_threads(run->result->threads) schedule(static)
    for (uint32_t i = 0; i < n; ++i) {
        const struct place *place = &run->places[i];
        const struct store *store = &run->stores[place->thread];
        if (place->length == 0) continue;
        memcpy(rows->col + rows->start[i], store->col + place->begin, place->length * sizeof *rows->col);
        memcpy(rows->f + rows->start[i], store->f + place->begin, place->length * sizeof *rows->f);
    }
    free_stores(run); /* averaging needs the memory */
    return STATUS_OK;
}

double rows_distance(const fibrad_rows *a, const fibrad_rows *b, uint32_t i) {
    double square = 0;
    for (uint64_t p = a->start[i], q = b->start[i]; p < a->start[i + 1] || q < b->start[i + 1];) {
        const uint32_t j = p < a->start[i + 1] ? a->col[p] : UINT32_MAX;
        const uint32_t k = q < b->start[i + 1] ? b->col[q] : UINT32_MAX;
        const double difference = (j <= k ? a->f[p++] : 0) - (k <= j ? b->f[q++] : 0);
        square += difference * difference;
    }
    return sqrt(square);
}

/* The two estimates of S_ij differ by about twice the error of their mean; where they have weights, the own one is off
 * the mean by sqrt(w_j/w_i) times the error of that. The factor takes in the worst rows of hundred, and the raw
 * estimate the rows whose two errors are equal by symmetry: docs/accuracy.md. */
static void estimate(struct run *run, const fibrad_rows *mean) {
    const fibrad_rows *raw = &run->result->rows;
#pragma omp parallel for num_threads(run->result->threads) schedule(static)
    for (uint32_t i = 0; i < mean->n; ++i) {
        double square = 0, weight = run->weight ? run->weight[i] : 1, most = weight;
        uint64_t p = raw->start[i]; /* the columns of a raw row are among those of the mean */
        for (uint64_t k = mean->start[i]; k < mean->start[i + 1]; ++k) {
            const uint32_t j = mean->col[k];
            const bool own = p < raw->start[i + 1] && raw->col[p] == j;
            const double difference = mean->f[k] - (own ? raw->f[p++] : 0);
            const double other = run->weight ? run->weight[j] : 1;
            square += difference * difference * weight / other;
            most = fmax(most, other);
        }
        run->result->error[i] = fmax(1.6 * sqrt(square), 0.5 * sqrt(weight / most) * run->result->error[i]);
    }
}

/* Replaces the rows by reciprocal ones with row sums of at most 1. */
static int average(struct run *run) {
    fibrad_rows *raw = &run->result->rows, mean;
    double *scratch = malloc(raw->n * sizeof *scratch);
    int status = average_rows(raw, run->bed->r, run->weight, run->result->threads, &mean), kernel = FIBRAD_OK;
    if (!status && !scratch) status = message_memory();
    if (!status) kernel = fibrad_rows_limit(&mean, scratch);
    if (!status && !kernel) kernel = fibrad_rows_close(&mean, run->bed->r, run->result->wall, run->result->escaped);
    if (kernel) status = message(STATUS_INPUT, "averaging the rows: %s", fibrad_status_text(kernel));
    free(scratch);
    if (!status && !run->options->method.mirrored) estimate(run, &mean);
    rows_free(status ? &mean : raw);
    if (!status) *raw = mean;
    return status;
}

static double row_sum(const fibrad_rows *rows, uint32_t i) {
    double sum = 0;
    for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; ++k) sum += rows->f[k];
    return sum;
}

static void check_closure(struct run *run) {
    struct result *result = run->result;
    for (uint32_t i = 0; i < run->bed->n; ++i) {
        if (!result->wanted[i]) continue;
        double sum = row_sum(&result->rows, i) + result->escaped[i];
        for (int wall = 0; wall < FIBRAD_WALLS; ++wall) sum += result->wall[i][wall];
        result->closure_max = fmax(result->closure_max, fabs(sum - 1));
    }
}

static void summarise(struct run *run, uint64_t rows) {
    struct result *result = run->result;
    result->row_sum_min = INFINITY;
    result->row_sum_max = -INFINITY;
    double escaped = 0;
    for (uint32_t i = 0; i < run->bed->n; ++i) {
        const double sum = result->row_sum[i] = row_sum(&result->rows, i);
        if (!result->wanted[i]) continue;
        for (int wall = 0; wall < FIBRAD_WALLS; ++wall) result->wall_mean[wall] += result->wall[i][wall] / (double)rows;
        result->row_sum_min = fmin(result->row_sum_min, sum);
        result->row_sum_max = fmax(result->row_sum_max, sum);
        result->error_estimate = fmax(result->error_estimate, result->error[i]);
        escaped += result->escaped[i];
    }
    result->escaped_mean = escaped / (double)rows;
    result->reciprocity_max = NAN;
    if (rows == run->bed->n) fibrad_rows_reciprocity(&result->rows, run->bed->r, &result->reciprocity_max);
}

static int compute(struct run *run, void **block) {
    struct result *result = run->result;
    const uint32_t n = run->bed->n;
    uint64_t rows = 0;
    const double begun = progress_clock();
    run->stores = calloc((size_t)result->threads, sizeof *run->stores);
    run->places = calloc(n, sizeof *run->places);
    result->error = calloc(n, sizeof *result->error);
    result->wanted = calloc(n, sizeof *result->wanted);
    result->row_sum = calloc(n, sizeof *result->row_sum);
    result->escaped = calloc(n, sizeof *result->escaped);
    result->wall = calloc(n, sizeof *result->wall);
    if (!run->stores || !run->places || !result->error || !result->wanted || !result->row_sum || !result->escaped ||
        !result->wall)
        return message_memory();
    for (uint32_t i = 0; i < n; ++i) {
        result->wanted[i] = !run->options->wanted || run->options->wanted[i];
        rows += result->wanted[i];
    }
    int status = run_scene(run->bed, &run->options->walls, run->options->file, &run->scene, block);
    if (!status) fibrad_scene_describe(run->scene, &result->facts);
    if (!status) status = choose_large(run);
    if (status) return status;
    compute_rows(run, rows);
    if (run->status) return run->status;
    status = assemble(run);
    if (status) return status;
    check_closure(run);
    if (!run->options->raw) status = average(run);
    if (status) return status;
    result->seconds = progress_clock() - begun;
    summarise(run, rows);
    return interrupt_status();
}

int run_rows(const struct bed *bed, const struct run_options *options, struct result *result) {
    *result = (struct result){.threads = options->threads ? options->threads : omp_get_max_threads()};
    struct run run = {.bed = bed, .options = options, .result = result};
    void *block = NULL;
    const int status = compute(&run, &block);
    free_stores(&run);
    free(run.places);
    free(run.weight);
    free(block);
    return status;
}

void result_free(struct result *result) {
    rows_free(&result->rows);
    free(result->wanted);
    free(result->row_sum);
    free(result->error);
    free(result->escaped);
    free(result->wall);
    *result = (struct result){0};
}
