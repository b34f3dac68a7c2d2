/* record.h - the records of a collection of rows. SPDX-License-Identifier: MIT
 *
 * A record is this head, the factors to walls, the factors to spheres, the columns and, if the row is along lines, the
 * differences of halves, padded to 8 bytes. Records follow each other from the first 8-byte boundary of the block on.
 */
#ifndef FIBRAD_ROWS_RECORD_H
#define FIBRAD_ROWS_RECORD_H

#include "fibrad.h"
#include "base/port.h"

typedef struct fibrad_record {
    uint32_t sphere, length, walls, lines;
    uint64_t symmetric;
    uint64_t scene; /* hash of the scene of the row; 0: none */
    double escaped, beyond, error, noise, shares;
} fibrad_record;

static inline const double *fibrad_record_wall(const fibrad_record *record) { return (const double *)(record + 1); }
static inline const double *fibrad_record_f(const fibrad_record *record) {
    return fibrad_record_wall(record) + record->walls;
}
static inline const uint32_t *fibrad_record_col(const fibrad_record *record) {
    return (const uint32_t *)(const void *)(fibrad_record_f(record) + record->length);
}

/* In place of half the difference of an exact factor. */
#define FIBRAD_HALF_EXACT __builtin_inff()

/* NULL: the row is not along lines. */
static inline const float *fibrad_record_half(const fibrad_record *record) {
    return record->lines > 0 ? (const float *)(const void *)(fibrad_record_col(record) + record->length) : NULL;
}

/* Bytes of a record. lines: of the row. */
static inline size_t fibrad_record_size(uint32_t length, uint32_t walls, uint32_t lines) {
    const size_t words = lines > 0 ? 2 * (size_t)length : length; /* of 4 bytes */
    return sizeof(fibrad_record) + ((size_t)walls + length) * sizeof(double) + (words + 1) / 2 * 8;
}

/* The first record at or after byte `at` of a collection. NULL: there is none. *at: out: where the next record
 * begins. */
const fibrad_record *fibrad_rows_next(const fibrad_rows *rows, size_t *at);

/* Makes the free space of a collection into the arrays of a row, with the largest capacity possible. False: not even
 * an empty row fits. */
bool fibrad_rows_open(const fibrad_rows *rows, uint32_t walls, fibrad_row *row);

/* Makes room for one more row of `length` entries. Errors: FIBRAD_E_CAPACITY: memory.needed is written. _MEMORY. */
int fibrad_rows_reserve(fibrad_rows *rows, uint32_t length, uint32_t walls);

/* Appends the row that has been written into the arrays of fibrad_rows_open. */
void fibrad_rows_commit(fibrad_rows *rows, uint64_t scene, uint32_t walls, const fibrad_row *row);

/* Whether the records are where they were written. If the caller has moved the block to another alignment, this is
 * false until a row is appended. */
bool fibrad_rows_settled(const fibrad_rows *rows);

#endif
