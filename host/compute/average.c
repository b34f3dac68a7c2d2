/* average.c - reciprocal rows of a whole bed, by OpenMP: each thread averages some of the rows into a stretch of
 * the result's arrays, and the stretches are moved together. SPDX-License-Identifier: MIT */
#include "compute/average.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"

/* The most there are: each reads through the whole matrix, and has ends of all its rows. */
enum { PARTS = 16 };

struct part {
    uint32_t begin, end; /* rows */
    uint64_t offset;     /* where its stretch begins */
    fibrad_rows rows;
    int status;
};

/* The first row at or after the entry. */
static uint32_t row_of(const fibrad_rows *rows, uint64_t entry) {
    uint32_t low = 0, high = rows->n;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (rows->start[middle] < entry)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* The most entries that rows [begin, end) of the mean can have. */
static uint64_t most_entries(const fibrad_rows *raw, uint32_t begin, uint32_t end) {
    uint64_t count = raw->start[end] - raw->start[begin];
    for (uint64_t k = 0; k < raw->start[raw->n]; ++k) count += raw->col[k] >= begin && raw->col[k] < end;
    return count;
}

static bool make_parts(const fibrad_rows *raw, int count, const fibrad_rows *mean, struct part *parts) {
    const uint64_t share = raw->start[raw->n] / (uint64_t)count;
#pragma omp parallel for num_threads(count) schedule(static, 1)
    for (int p = 0; p < count; ++p) {
        struct part *part = &parts[p];
        part->begin = p ? row_of(raw, share * (uint64_t)p) : 0;
        part->end = p + 1 < count ? row_of(raw, share * (uint64_t)(p + 1)) : raw->n;
        part->rows = (fibrad_rows){.n = raw->n, .capacity = most_entries(raw, part->begin, part->end)};
        part->rows.start = malloc(((size_t)raw->n + 1) * sizeof *part->rows.start);
    }
    bool room = true;
    uint64_t offset = 0;
    for (struct part *part = parts; part < parts + count; offset += part++->rows.capacity) {
        part->offset = offset;
        part->rows.col = mean->col + offset;
        part->rows.f = mean->f + offset;
        room = room && part->rows.start;
    }
    return room;
}

/* Moves a part behind the ones before it, which end where it begins. */
static void move(const struct part *part, fibrad_rows *mean) {
    const uint64_t to = mean->start[part->begin], length = part->rows.start[part->end];
    memmove(mean->col + to, mean->col + part->offset, length * sizeof *mean->col);
    memmove(mean->f + to, mean->f + part->offset, length * sizeof *mean->f);
    for (uint32_t i = part->begin; i < part->end; ++i) mean->start[i + 1] = to + part->rows.start[i + 1];
}

int average_rows(const fibrad_rows *raw, const double *r, const double *weight, int threads, fibrad_rows *mean) {
    const int count = threads < PARTS ? threads : PARTS;
    struct part parts[PARTS] = {0};
    *mean = (fibrad_rows){.n = raw->n, .capacity = 2 * raw->start[raw->n]};
    mean->start = calloc((size_t)mean->n + 1, sizeof *mean->start);
    mean->col = malloc((mean->capacity + 1) * sizeof *mean->col);
    mean->f = malloc((mean->capacity + 1) * sizeof *mean->f);
    int status = STATUS_OK;
    if (!mean->start || !mean->col || !mean->f || !make_parts(raw, count, mean, parts)) status = message_memory();
    if (!status) {
#pragma omp parallel for num_threads(count) schedule(static, 1)
        for (int p = 0; p < count; ++p)
            parts[p].status = fibrad_rows_average_part(raw, r, weight, parts[p].begin, parts[p].end, &parts[p].rows);
    }
    for (int p = 0; p < count && !status; ++p) {
        if (parts[p].status)
            status = message(STATUS_INPUT, "averaging the rows: %s", fibrad_status_text(parts[p].status));
        else
            move(&parts[p], mean);
    }
    for (int p = 0; p < count; ++p) free(parts[p].rows.start);
    return status;
}

void rows_free(fibrad_rows *rows) {
    free(rows->start);
    free(rows->col);
    free(rows->f);
    *rows = (fibrad_rows){0};
}
