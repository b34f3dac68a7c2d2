/* rows.c - a collection of rows in one block, fixed or growing. SPDX-License-Identifier: MIT */
#include "base/arena.h"
#include "rows/record.h"

/* Bytes before the first record. */
static size_t lead_of(const fibrad_rows *rows) { return (size_t) - (uintptr_t)rows->memory.block & 7; }

/* The end of the last record. NULL: there is no block. */
static unsigned char *end_of(const fibrad_rows *rows) {
    unsigned char *block = rows->memory.block;
    return block == NULL ? NULL : block + lead_of(rows) + rows->used;
}

static size_t free_bytes(const fibrad_rows *rows) {
    const size_t taken = lead_of(rows) + rows->used;
    return rows->memory.block != NULL && rows->memory.size > taken ? rows->memory.size - taken : 0;
}

bool fibrad_rows_settled(const fibrad_rows *rows) { return rows->used == 0 || rows->lead == lead_of(rows); }

/* Moves the records to the first boundary of a block whose alignment has changed. */
static void settle_rows(fibrad_rows *rows) {
    unsigned char *block = rows->memory.block;
    if (!fibrad_rows_settled(rows)) __builtin_memmove(block + lead_of(rows), block + rows->lead, rows->used);
    rows->lead = lead_of(rows);
}

bool fibrad_rows_open(const fibrad_rows *rows, uint32_t walls, fibrad_row *row) {
    if (!fibrad_rows_settled(rows)) return false;
    const size_t space = free_bytes(rows), head = fibrad_record_size(0, walls, 0);
    if (space < head) return false;
    const size_t capacity = (space - head) / (sizeof *row->f + sizeof *row->col + sizeof *row->half);
    row->wall = (double *)(void *)(end_of(rows) + sizeof(fibrad_record));
    row->f = row->wall + walls;
    row->capacity = capacity < FIBRAD_SPHERES_MAX ? (uint32_t)capacity : FIBRAD_SPHERES_MAX;
    row->capacity -= row->capacity % 2;
    row->col = (uint32_t *)(void *)(row->f + row->capacity);
    row->half = (float *)(void *)(row->col + row->capacity);
    return true;
}

int fibrad_rows_reserve(fibrad_rows *rows, uint32_t length, uint32_t walls) {
    /* 8 bytes for another alignment of the block, 16 for rounding of the capacity */
    const size_t needed = rows->used + fibrad_record_size(length, walls, 1) + 24;
    const int status = fibrad_memory_reserve(&rows->memory, needed);
    if (status == FIBRAD_OK) settle_rows(rows);
    return status;
}

void fibrad_rows_commit(fibrad_rows *rows, uint64_t scene, uint32_t walls, const fibrad_row *row) {
    rows->lead = lead_of(rows);
    rows->serial++;
    fibrad_record *record = (fibrad_record *)(void *)end_of(rows);
    *record = (fibrad_record){.sphere = row->sphere, .length = row->length, .walls = walls, .scene = scene};
    record->lines = row->half != NULL ? row->lines : 0, record->symmetric = row->symmetric != 0;
    record->escaped = row->escaped, record->beyond = row->beyond;
    record->error = row->error, record->noise = row->noise, record->shares = row->shares;
    uint32_t *col = (uint32_t *)(void *)(row->f + row->length);
    __builtin_memmove(col, row->col, row->length * sizeof *row->col);
    if (record->lines > 0) __builtin_memmove(col + row->length, row->half, row->length * sizeof *row->half);
    rows->used += fibrad_record_size(row->length, walls, record->lines);
    rows->count++;
    rows->entries += row->length;
}

const fibrad_record *fibrad_rows_next(const fibrad_rows *rows, size_t *at) {
    if (*at >= rows->used || rows->memory.block == NULL) return NULL;
    const unsigned char *first = (const unsigned char *)rows->memory.block + lead_of(rows);
    const fibrad_record *record = (const fibrad_record *)(const void *)(first + *at);
    *at += fibrad_record_size(record->length, record->walls, record->lines);
    return record;
}

int fibrad_rows_read(fibrad_rows *rows, size_t *at, fibrad_row *row) {
    if (rows == NULL || at == NULL || row == NULL) return 0;
    const size_t begin = *at;
    const fibrad_record *record = fibrad_rows_next(rows, at);
    if (record == NULL) return 0;
    unsigned char *own = (unsigned char *)rows->memory.block + lead_of(rows) + begin; /* the record to be written */
    double *wall = (double *)(void *)(own + sizeof *record), *f = wall + record->walls;
    uint32_t *col = (uint32_t *)(void *)(f + record->length);
    *row = (fibrad_row){.wall = wall, .f = f, .col = col, .sphere = record->sphere, .length = record->length};
    row->escaped = record->escaped, row->beyond = record->beyond, row->symmetric = record->symmetric != 0;
    row->error = record->error, row->noise = record->noise, row->shares = record->shares, row->lines = record->lines;
    if (record->lines > 0) row->half = (float *)(void *)(col + record->length);
    return 1;
}

static bool row_valid(const fibrad_row *row, uint32_t walls) {
    if (row->length > 0 && (row->col == NULL || row->f == NULL)) return false;
    if ((walls > 0 && row->wall == NULL) || row->length > FIBRAD_SPHERES_MAX) return false;
    for (uint32_t k = 0; k < row->length; k++)
        if (!(row->f[k] >= 0 && row->f[k] <= 1.01) || (k > 0 && row->col[k] <= row->col[k - 1])) return false;
    for (uint32_t k = 0; k < walls; k++)
        if (!(row->wall[k] >= 0 && row->wall[k] <= 1.01)) return false;
    return fibrad_abs(row->escaped) <= 1.01 && fibrad_abs(row->beyond) <= 1.01 && row->error >= 0;
}

int fibrad_rows_add(fibrad_rows *rows, const fibrad_row *row, uint32_t walls) {
    if (rows == NULL || row == NULL || row->rows != NULL || !row_valid(row, walls)) return FIBRAD_E_ARGUMENT;
    if (!fibrad_memory_valid(&rows->memory)) return FIBRAD_E_ARGUMENT;
    fibrad_row to = *row;
    int status = fibrad_rows_reserve(rows, row->length, walls);
    if (status != FIBRAD_OK) return status;
    fibrad_rows_open(rows, walls, &to);
    if (row->half == NULL || row->lines == 0) to.half = NULL;
    if (walls > 0) fibrad_copy(to.wall, row->wall, walls * sizeof *to.wall);
    if (row->length > 0) {
        fibrad_copy(to.f, row->f, row->length * sizeof *to.f);
        fibrad_copy(to.col, row->col, row->length * sizeof *to.col);
        if (to.half != NULL) fibrad_copy(to.half, row->half, row->length * sizeof *to.half);
    }
    fibrad_rows_commit(rows, 0, walls, &to);
    return FIBRAD_OK;
}

void fibrad_rows_clear(fibrad_rows *rows) {
    if (rows == NULL) return;
    rows->serial++;
    rows->used = rows->count = 0;
    rows->entries = 0;
}
