/* moving_rows.c - rows of a bed that moves, those of which motion has changed little kept. SPDX-License-Identifier: MIT
 */
#include "bed/moving_rows.h"

#include <omp.h>
#include <stdlib.h>
#include <string.h>

#include "bed/bed_scene.h"
#include "cli/message.h"
#include "simple/heap.h"

enum { KEPT, DUE, DONE };

static int moving_scene(const struct bed *bed, fibrad_scene **scene, void **block) {
    const fibrad_scene_config config = bed_scene(bed, NULL);
    const fibrad_spheres spheres = bed_spheres(bed);
    fibrad_fault fault = {bed->n, bed->n, UINT32_MAX, 0, 0};
    return bed_status(bed, "bed", fibrad_heap_scene(scene, block, &config, &spheres, &fault), &fault);
}

/* Computes row i into arrays of its length. A status of the kernel. */
static int moving_row(struct moving *moving, int thread, uint32_t i) {
    fibrad_row *fresh = &moving->fresh[i], row = {.rows = &moving->rows[thread]};
    fibrad_rows_clear(row.rows);
    const int status = fibrad_beam_row(moving->scene, &moving->work[thread], i, &moving->rule, &row);
    if (status) return status;
    *fresh = row;
    fresh->rows = NULL;
    fresh->body = NULL;
    fresh->capacity = row.length;
    fresh->col = malloc((row.length + 1) * sizeof *fresh->col);
    fresh->f = malloc((row.length + 1) * sizeof *fresh->f);
    if (!fresh->col || !fresh->f) return FIBRAD_E_MEMORY;
    memcpy(fresh->col, row.col, row.length * sizeof *fresh->col);
    memcpy(fresh->f, row.f, row.length * sizeof *fresh->f);
    return FIBRAD_OK;
}

static void free_row(fibrad_row *row) {
    free(row->col);
    free(row->f);
    *row = (fibrad_row){0};
}

static int compute_due(struct moving *moving) {
    int status = FIBRAD_OK;
#pragma omp parallel for schedule(dynamic, 16) num_threads(moving->threads)
    for (uint32_t i = 0; i < moving->n; ++i) {
        int stop;
#pragma omp atomic read
        stop = status;
        if (moving->due[i] != DUE || stop) continue;
        stop = moving_row(moving, omp_get_thread_num(), i);
        if (stop) {
#pragma omp atomic write
            status = stop;
        }
    }
    if (status == FIBRAD_E_MEMORY) return message_memory();
    return status ? message(STATUS_INPUT, "the moved bed: %s", fibrad_status_text(status)) : STATUS_OK;
}

/* Computes the rows that are due, hands on what they tell of others, and notes which of these are due now. */
static int compute_round(struct moving *moving, double error, uint32_t *due) {
    const int status = compute_due(moving);
    if (status) return status;
    for (uint32_t i = 0; i < moving->n; ++i) {
        if (moving->due[i] != DUE) continue;
        if (error > 0) fibrad_drift_partners(moving->scene, i, &moving->row[i], &moving->fresh[i], moving->error);
        free_row(&moving->row[i]);
        moving->row[i] = moving->fresh[i];
        moving->fresh[i] = (fibrad_row){0};
        moving->due[i] = DONE;
        moving->redone++;
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

static int compute_rounds(struct moving *moving, double error, uint32_t due) {
    int status = STATUS_OK;
    for (moving->redone = moving->rounds = 0; due && !status; moving->rounds++)
        status = compute_round(moving, error, &due);
    return status;
}

int moving_begin(struct moving *moving, const struct bed *bed, const fibrad_beam_rule *rule, int threads) {
    const uint32_t n = bed->n;
    *moving = (struct moving){.n = n, .threads = threads ? threads : omp_get_max_threads(), .rule = *rule};
    moving->row = calloc(n, sizeof *moving->row);
    moving->fresh = calloc(n, sizeof *moving->fresh);
    moving->error = calloc(n, sizeof *moving->error);
    moving->due = malloc(n);
    moving->work = calloc((size_t)moving->threads, sizeof *moving->work);
    moving->rows = calloc((size_t)moving->threads, sizeof *moving->rows);
    if (!moving->row || !moving->fresh || !moving->error || !moving->due || !moving->work || !moving->rows)
        return message_memory();
    for (int t = 0; t < moving->threads; ++t)
        moving->work[t].memory.resize = moving->rows[t].memory.resize = fibrad_heap_resize;
    const int status = moving_scene(bed, &moving->scene, &moving->block);
    memset(moving->due, DUE, n);
    return status ? status : compute_rounds(moving, 0, n);
}

/* Which rows are due by their estimated errors. */
static uint32_t mark_due(struct moving *moving, const fibrad_scene *before, double error) {
    uint32_t due = 0;
#pragma omp parallel for reduction(+ : due) num_threads(moving->threads)
    for (uint32_t i = 0; i < moving->n; ++i) {
        double step = 0;
        fibrad_drift_row(before, moving->scene, i, moving->row[i].col, moving->row[i].length, &step);
        moving->error[i] += step;
        moving->due[i] = error > 0 && !(moving->error[i] > error) ? KEPT : DUE;
        due += moving->due[i];
    }
    return due;
}

int moving_step(struct moving *moving, const struct bed *bed, double error) {
    fibrad_scene *now;
    void *block;
    if (bed->n != moving->n) return message(STATUS_INPUT, "the moved bed has another number of spheres");
    const int status = moving_scene(bed, &now, &block);
    if (status) return status;
    const fibrad_scene *before = moving->scene;
    void *old = moving->block;
    moving->scene = now;
    moving->block = block;
    const uint32_t due = mark_due(moving, before, error);
    free(old);
    return compute_rounds(moving, error, due);
}

void moving_end(struct moving *moving) {
    for (uint32_t i = 0; i < moving->n && moving->row && moving->fresh; ++i) {
        free_row(&moving->row[i]);
        free_row(&moving->fresh[i]);
    }
    for (int t = 0; t < moving->threads && moving->work && moving->rows; ++t) {
        free(moving->work[t].memory.block);
        free(moving->rows[t].memory.block);
    }
    free(moving->work);
    free(moving->rows);
    free(moving->block);
    free(moving->row);
    free(moving->fresh);
    free(moving->error);
    free(moving->due);
    *moving = (struct moving){0};
}
