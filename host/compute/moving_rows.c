/* moving_rows.c - rows of a bed that moves, those of which motion has changed little kept. SPDX-License-Identifier: MIT
 */
#include "compute/moving_rows.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "compute/rows.h"

enum { KEPT, DUE, DONE };
enum { ROW = 1024 }; /* entries for which room is made at first */

static int make_scene(fibrad_scene **scene, void *block, size_t size, const fibrad_scene_config *config,
                      const struct bed *bed) {
    const fibrad_spheres spheres = {bed->x, bed->y, bed->z, bed->r, bed->n};
    const int status = fibrad_scene_init(scene, block, size, config, &spheres, NULL);
    return status ? message(STATUS_INPUT, "the moved bed: %s", fibrad_status_text(status)) : STATUS_OK;
}

static fibrad_scene_config config_of(const struct bed *bed) {
    return (fibrad_scene_config){.spheres = bed->n, .period = {bed->period[0], bed->period[1], bed->period[2]}};
}

static bool make_work(fibrad_work **work, const fibrad_work_config *config) {
    void *block = *work; /* work memory begins at its block */
    return run_work(work, &block, config);
}

static bool make_room(fibrad_row *row, uint32_t capacity) {
    free(row->col);
    free(row->f);
    *row = (fibrad_row){.col = malloc((capacity + 1) * sizeof *row->col),
                        .f = malloc((capacity + 1) * sizeof *row->f),
                        .capacity = capacity};
    return row->col && row->f;
}

static int add_row(struct moving *moving, fibrad_work **work, uint32_t i) {
    fibrad_row *row = &moving->fresh[i];
    if (!make_room(row, moving->row[i].length ? moving->row[i].length + 64 : ROW)) return STATUS_MEMORY;
    for (;;) {
        const int status = fibrad_beam_row(moving->scene, *work, i, &moving->rule, row);
        if (status == FIBRAD_OK) break;
        if (status != FIBRAD_E_CAPACITY) return message(STATUS_INPUT, "row %u: %s", i, fibrad_status_text(status));
        if (row->length) {
            if (!make_room(row, row->length)) return STATUS_MEMORY;
            continue;
        }
        fibrad_work_config config;
        fibrad_work_needed(*work, &config);
        if (!make_work(work, &config)) return STATUS_MEMORY;
    }
    row->capacity = row->length;
    uint32_t *col = realloc(row->col, (row->length + 1) * sizeof *col);
    if (col) row->col = col;
    double *f = realloc(row->f, (row->length + 1) * sizeof *f);
    if (f) row->f = f;
    return STATUS_OK;
}

/* Computes the rows that are due, hands on what they tell of others, and notes which of these are due now. */
static int round_of_rows(struct moving *moving, double error, uint32_t *due) {
    int status = STATUS_OK;
#pragma omp parallel for schedule(dynamic, 16) num_threads(moving->threads)
    for (uint32_t i = 0; i < moving->n; ++i) {
        int stop;
#pragma omp atomic read
        stop = status;
        if (moving->due[i] != DUE || stop) continue;
        stop = add_row(moving, &moving->work[omp_get_thread_num()], i);
        if (stop) {
#pragma omp atomic write
            status = stop;
        }
    }
    if (status) return status;
    for (uint32_t i = 0; i < moving->n; ++i) {
        if (moving->due[i] != DUE) continue;
        const fibrad_row old = moving->row[i];
        if (error > 0) fibrad_moved_seen(moving->scene, i, &old, &moving->fresh[i], moving->error);
        moving->row[i] = moving->fresh[i];
        moving->fresh[i] = (fibrad_row){0};
        moving->due[i] = DONE;
        moving->redone++;
        free(old.col);
        free(old.f);
    }
    *due = 0;
    for (uint32_t i = 0; i < moving->n; ++i) {
        if (moving->due[i] == DONE) moving->error[i] = 0;
        if (!(moving->error[i] > error)) continue;
        moving->due[i] = DUE;
        ++*due;
    }
    return STATUS_OK;
}

static int all_rounds(struct moving *moving, double error, uint32_t due) {
    int status = STATUS_OK;
    for (moving->redone = moving->rounds = 0; due && !status; moving->rounds++)
        status = round_of_rows(moving, error, &due);
    return status == STATUS_MEMORY ? message_memory() : status;
}

int moving_begin(struct moving *moving, const struct bed *bed, const fibrad_beam_rule *rule, int threads) {
    const uint32_t n = bed->n;
    *moving = (struct moving){.n = n, .threads = threads ? threads : omp_get_max_threads(), .rule = *rule};
    const fibrad_scene_config config = config_of(bed);
    const size_t size = fibrad_scene_size(&config);
    if (size == 0) return message(STATUS_INPUT, "the bed cannot be computed");
    moving->block = run_block(size);
    moving->spare = run_block(size);
    moving->row = calloc(n, sizeof *moving->row);
    moving->fresh = calloc(n, sizeof *moving->fresh);
    moving->error = calloc(n, sizeof *moving->error);
    moving->reach = calloc(n, sizeof *moving->reach);
    moving->due = malloc(n);
    moving->scratch = malloc(2 * (size_t)n);
    moving->work = calloc((size_t)moving->threads, sizeof(void *));
    if (!moving->block || !moving->spare || !moving->row || !moving->fresh || !moving->error || !moving->reach ||
        !moving->due || !moving->scratch || !moving->work)
        return message_memory();
    for (int t = 0; t < moving->threads; ++t)
        if (!make_work(&moving->work[t], NULL)) return message_memory();
    const int status = make_scene(&moving->scene, moving->block, size, &config, bed);
    memset(moving->due, DUE, n);
    return status ? status : all_rounds(moving, 0, n);
}

/* Which rows are due: by their estimated errors, or by their bits. */
static uint32_t mark_due(struct moving *moving, const fibrad_scene *before, double error) {
    uint32_t due = 0;
    if (error == 0) {
        for (uint32_t i = 0; i < moving->n; ++i) moving->reach[i] = moving->row[i].reach;
        fibrad_moved_same(before, moving->scene, moving->reach, moving->scratch, moving->due);
        for (uint32_t i = 0; i < moving->n; ++i) due += moving->due[i] = moving->due[i] ? KEPT : DUE;
        return due;
    }
#pragma omp parallel for reduction(+ : due) num_threads(moving->threads)
    for (uint32_t i = 0; i < moving->n; ++i) {
        double step = 0;
        fibrad_moved_error(before, moving->scene, i, &moving->row[i], &step);
        moving->error[i] += step;
        moving->due[i] = moving->error[i] > error ? DUE : KEPT;
        due += moving->due[i];
    }
    return due;
}

int moving_step(struct moving *moving, const struct bed *bed, double error) {
    if (bed->n != moving->n) return message(STATUS_INPUT, "the moved bed has another number of spheres");
    const fibrad_scene_config config = config_of(bed);
    const fibrad_scene *before = moving->scene;
    const int status = make_scene(&moving->scene, moving->spare, fibrad_scene_size(&config), &config, bed);
    if (status) return status;
    void *block = moving->block;
    moving->block = moving->spare;
    moving->spare = block;
    return all_rounds(moving, error, mark_due(moving, before, error));
}

void moving_end(struct moving *moving) {
    for (uint32_t i = 0; i < moving->n && moving->row && moving->fresh; ++i) {
        free(moving->row[i].col);
        free(moving->row[i].f);
        free(moving->fresh[i].col);
        free(moving->fresh[i].f);
    }
    for (int t = 0; t < moving->threads && moving->work; ++t) free(moving->work[t]);
    free(moving->work);
    free(moving->block);
    free(moving->spare);
    free(moving->row);
    free(moving->fresh);
    free(moving->error);
    free(moving->reach);
    free(moving->due);
    free(moving->scratch);
    *moving = (struct moving){0};
}
