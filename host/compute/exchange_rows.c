/* exchange_rows.c - exchange factors and their reach for a whole bed. SPDX-License-Identifier: MIT */
#include "compute/exchange_rows.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "cli/progress.h"

/* What a thread has: its tracer is made when its first row comes, for only then is there a scene. */
struct tracing_thread {
    void *block;
    fibrad_tracer *tracer; /* NULL: not made yet */
    uint64_t rays;
};

struct tracing {
    const fibrad_exchange_rule *rule;
    fibrad_tracer_config config;
    size_t size; /* of a block */
    int threads;
    struct tracing_thread *thread; /* [threads] */
    fibrad_spread *spread;         /* [n], when that is asked for */
};

static void close_tracing(struct tracing *tracing) {
    for (int t = 0; tracing->thread && t < tracing->threads; ++t) free(tracing->thread[t].block);
    free(tracing->thread);
}

static int open_tracing(struct tracing *tracing, const struct bed *bed, const struct run_options *options,
                        const fibrad_exchange_rule *rule) {
    *tracing = (struct tracing){.rule = rule, .config.lists = bed->n < 4096 ? bed->n : 4096};
    tracing->size = fibrad_tracer_size(&tracing->config);
    tracing->threads = options->threads ? options->threads : omp_get_max_threads();
    tracing->thread = calloc((size_t)tracing->threads, sizeof *tracing->thread);
    if (!tracing->thread) return message_memory();
    for (int t = 0; t < tracing->threads; ++t) {
        tracing->thread[t].block = run_block(tracing->size);
        if (!tracing->thread[t].block) return message_memory();
    }
    return STATUS_OK;
}

/* What this thread has, with a tracer; a status of the kernel. */
static int own_thread(struct tracing *tracing, const fibrad_scene *scene, struct tracing_thread **own) {
    *own = &tracing->thread[omp_get_thread_num()];
    if ((*own)->tracer) return FIBRAD_OK;
    return fibrad_tracer_init(&(*own)->tracer, (*own)->block, tracing->size, &tracing->config, scene);
}

static int exchange_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const void *rule, fibrad_row *row) {
    struct tracing *tracing = *(struct tracing *const *)rule;
    struct tracing_thread *own;
    uint64_t rays = 0;
    int status = own_thread(tracing, scene, &own);
    if (!status) status = fibrad_exchange_row(own->tracer, work, i, tracing->rule, row, &rays);
    own->rays += rays;
    return status;
}

static int spread_row(const fibrad_scene *scene, fibrad_work *work, uint32_t i, const void *rule, fibrad_row *row) {
    struct tracing *tracing = *(struct tracing *const *)rule;
    struct tracing_thread *own;
    int status = own_thread(tracing, scene, &own);
    (void)work;
    row->length = row->directions = 0;
    row->escaped = row->error = 0;
    memset(row->wall, 0, sizeof row->wall);
    if (!status) status = fibrad_exchange_spread(own->tracer, i, tracing->rule, &tracing->spread[i]);
    return status;
}

/* The error there may be in a row to be averaged, over that of the mean, which is smaller by the square root of 2, the
 * errors of partners being independent; SPARE of it is kept for rows that come out worse than most. */
#define BEFORE_AVERAGING 1.1
#define SPARE            1.2

/* Memory of an average: the matrix, with room for the diagonal, and numbers per row. */
struct mean {
    fibrad_rows rows;
    double *radius, *target, *scratch; /* [n] [n] [3 n] */
};

static bool make_mean(struct mean *mean, const fibrad_rows *raw) {
    const size_t n = raw->n;
    mean->rows = (fibrad_rows){.n = raw->n, .capacity = 2 * raw->start[n] + n};
    mean->rows.start = malloc((n + 1) * sizeof *mean->rows.start);
    mean->rows.col = malloc(mean->rows.capacity * sizeof *mean->rows.col);
    mean->rows.f = malloc(mean->rows.capacity * sizeof *mean->rows.f);
    mean->radius = malloc(n * sizeof *mean->radius);
    mean->target = malloc(n * sizeof *mean->target);
    mean->scratch = malloc(3 * n * sizeof *mean->scratch);
    return mean->rows.start && mean->rows.col && mean->rows.f && mean->radius && mean->target && mean->scratch;
}

static void free_mean(struct mean *mean) {
    free(mean->rows.start);
    free(mean->rows.col);
    free(mean->rows.f);
    free(mean->radius);
    free(mean->target);
    free(mean->scratch);
}

/* Puts reciprocal, closed rows in the place of the raw ones. */
static int average(const struct bed *bed, const double *emissivity, double drop, struct mean *mean,
                   struct result *result) {
    fibrad_rows rows = mean->rows;
    for (uint32_t i = 0; i < bed->n; ++i) {
        mean->radius[i] = bed->r[i] * sqrt(emissivity[i]);
        mean->target[i] = result->row_sum[i];
    }
    int status = fibrad_rows_average(&result->rows, mean->radius, &rows);
    if (!status) status = fibrad_rows_balance(&rows, mean->target, mean->scratch);
    if (!status) status = fibrad_rows_close(&rows, mean->radius, result->wall, result->escaped);
    for (uint32_t i = 0; i < bed->n && !status; ++i)
        result->error[i] = fmax(SPARE * rows_distance(&rows, &result->rows, i), 0.5 * result->error[i]);
    if (!status && drop > 0) status = fibrad_rows_drop(&rows, mean->radius, drop, mean->scratch);
    if (status) return message(STATUS_INPUT, "averaging the rows: %s", fibrad_status_text(status));
    mean->rows = result->rows; /* to be freed */
    result->rows = rows;
    result->row_sum_min = INFINITY;
    result->row_sum_max = -INFINITY;
    result->closure_max = result->error_estimate = 0;
    for (uint32_t i = 0; i < bed->n; ++i) {
        double sum = 0, all = result->escaped[i];
        for (uint64_t k = result->rows.start[i]; k < result->rows.start[i + 1]; ++k) sum += result->rows.f[k];
        for (int wall = 0; wall < FIBRAD_WALLS; ++wall) all += result->wall[i][wall];
        result->row_sum[i] = sum;
        result->row_sum_min = fmin(result->row_sum_min, sum);
        result->row_sum_max = fmax(result->row_sum_max, sum);
        result->closure_max = fmax(result->closure_max, fabs(sum + all - 1));
        result->error_estimate = fmax(result->error_estimate, result->error[i]);
    }
    return STATUS_OK;
}

int run_exchange(const struct bed *bed, const struct run_options *options, const fibrad_exchange_rule *rule,
                 double drop, struct result *result, uint64_t *rays) {
    struct run_options raw = *options;
    fibrad_exchange_rule finer = *rule;
    struct tracing tracing, *handle = &tracing;
    struct mean mean = {0};
    *result = (struct result){0};
    if (!options->raw) finer.error *= BEFORE_AVERAGING;
    int status = open_tracing(&tracing, bed, options, &finer);
    raw.raw = true;
    raw.method = (struct row_method){"exchange", exchange_row, &handle, false, NULL};
    if (!status) status = run_rows(bed, &raw, result);
    const double begun = progress_clock();
    if (!status && !options->raw) {
        status =
            make_mean(&mean, &result->rows) ? average(bed, rule->emissivity, drop, &mean, result) : message_memory();
        if (!status) fibrad_rows_reciprocity(&result->rows, mean.radius, &result->reciprocity_max);
        free_mean(&mean);
    }
    result->seconds += progress_clock() - begun;
    *rays = 0;
    for (int t = 0; tracing.thread && t < tracing.threads; ++t) *rays += tracing.thread[t].rays;
    close_tracing(&tracing);
    return status;
}

int run_spread(const struct bed *bed, const struct run_options *options, const fibrad_exchange_rule *rule,
               fibrad_spread *spread, struct result *result) {
    struct run_options raw = *options;
    struct tracing tracing, *handle = &tracing;
    *result = (struct result){0};
    int status = open_tracing(&tracing, bed, options, rule);
    tracing.spread = spread;
    raw.raw = true;
    raw.method = (struct row_method){"paths", spread_row, &handle, false, NULL};
    if (!status) status = run_rows(bed, &raw, result);
    close_tracing(&tracing);
    return status;
}
