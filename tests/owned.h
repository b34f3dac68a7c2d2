/* owned.h - variables of tests that free what they have at the end of their block. SPDX-License-Identifier: MIT
 *
 * OWNED before a pointer: its block is freed. OWNED_BY(function) before another variable: the function gets its
 * address.
 */
#ifndef TESTS_OWNED_H
#define TESTS_OWNED_H

#include <check.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static inline void free_owned(void *pointer) {
    void *block;
    memcpy(&block, pointer, sizeof block);
    free(block);
}

#define OWNED              OWNED_BY(free_owned)
#define OWNED_BY(function) __attribute__((cleanup(function)))

/* Types with the functions that free them, of bed.h, scenes.h, part_beds.h and this file. */
#define OWNED_BED    OWNED_BY(bed_free) struct bed
#define OWNED_WORK   OWNED_BY(work_free) fibrad_work
#define OWNED_ROW    OWNED_BY(row_free) fibrad_row
#define OWNED_ROWS   OWNED_BY(rows_free) fibrad_rows
#define OWNED_MATRIX OWNED_BY(matrix_free) struct matrix
#define OWNED_PART   OWNED_BY(part_free) struct part
#define OWNED_NAMED  OWNED_BY(named_free) struct named_row
#define OWNED_FIXED  OWNED_BY(work_free_fixed) fibrad_work
#define OWNED_FILE   OWNED_BY(file_close) FILE

/* A file of the test, opened as by fopen. OWNED_FILE closes the file. */
static inline FILE *opened(const char *path, const char *mode) {
    FILE *file = fopen(path, mode);
    ck_assert_msg(file != NULL, "%s cannot be opened", path);
    return file;
}

static inline void file_close(FILE **file) {
    if (*file != NULL) fclose(*file);
}

#endif
