/* average_omp.c - reciprocal rows of a whole bed, by OpenMP: each thread averages some of the rows into a stretch of
 * the result's arrays, and the stretches are moved together. SPDX-License-Identifier: MIT */
#include "average_omp.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "message.h"

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

static bool make_parts(const fibrad_rows *raw, int threads, fibrad_rows *mean, struct part *parts) {
    const uint64_t entries = raw->start[raw->n];
    bool room = true;
#pragma omp parallel for num_threads(threads) schedule(static, 1)
    for (int t = 0; t < threads; ++t) {
        struct part *part = &parts[t];
        part->begin = t ? row_of(raw, entries / (uint64_t)threads * (uint64_t)t) : 0;
        part->end = t + 1 < threads ? row_of(raw, entries / (uint64_t)threads * (uint64_t)(t + 1)) : raw->n;
        part->rows = (fibrad_rows){.n = raw->n, .capacity = most_entries(raw, part->begin, part->end)};
        part->rows.start = malloc(((size_t)raw->n + 1) * sizeof *part->rows.start);
    }
    uint64_t offset = 0;
    for (int t = 0; t < threads; ++t) {
        struct part *part = &parts[t];
        part->offset = offset;
        part->rows.col = mean->col + offset;
        part->rows.f = mean->f + offset;
        offset += part->rows.capacity;
        room = room && part->rows.start;
    }
    return room;
}

int average_rows(const fibrad_rows *raw, const double *r, const double *weight, int threads, fibrad_rows *mean) {
    struct part *parts = calloc((size_t)threads, sizeof *parts);
    *mean = (fibrad_rows){.n = raw->n, .capacity = 2 * raw->start[raw->n]};
    mean->start = malloc(((size_t)mean->n + 1) * sizeof *mean->start);
    mean->col = malloc((mean->capacity + 1) * sizeof *mean->col);
    mean->f = malloc((mean->capacity + 1) * sizeof *mean->f);
    int status = parts && mean->start && mean->col && mean->f && make_parts(raw, threads, mean, parts)
                     ? STATUS_OK
                     : message_memory();
    if (!status) {
#pragma omp parallel for num_threads(threads) schedule(static, 1)
        for (int t = 0; t < threads; ++t) {
            struct part *part = &parts[t];
            part->status = fibrad_rows_average_part(raw, r, weight, part->begin, part->end, &part->rows);
        }
        mean->start[0] = 0;
    }
    for (int t = 0; t < threads && !status; ++t) {
        const struct part *part = &parts[t];
        if (part->status) status = message(STATUS_INPUT, "averaging the rows: %s", fibrad_status_text(part->status));
        const uint64_t to = mean->start[part->begin], length = status ? 0 : part->rows.start[part->end];
        memmove(mean->col + to, mean->col + part->offset, length * sizeof *mean->col);
        memmove(mean->f + to, mean->f + part->offset, length * sizeof *mean->f);
        for (uint32_t i = part->begin; i < part->end && !status; ++i) mean->start[i + 1] = to + part->rows.start[i + 1];
    }
    for (int t = 0; parts && t < threads; ++t) free(parts[t].rows.start);
    free(parts);
    return status;
}

void rows_free(fibrad_rows *rows) {
    free(rows->start);
    free(rows->col);
    free(rows->f);
    *rows = (fibrad_rows){0};
}
