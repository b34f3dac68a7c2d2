/* sorted_rows.c - writes all rows of the files PREFIX.0.rows, PREFIX.1.rows, ... as bytes, in the order of their ids.
 * So two divisions of one bed can be compared: sorted_rows PREFIX > BYTES. SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "rows_file.h"

enum { RANKS = 64 };
static fibrad_rows_head head[RANKS];
static uint64_t *words[RANKS]; /* all after the head */

typedef struct place {
    uint64_t id, row, rank;
} place;

static void stop(const char *what) {
    fprintf(stderr, "sorted_rows: %s\n", what);
    exit(1);
}

static void *room(uint64_t size) {
    void *block = malloc(size + 1);
    if (!block) stop("no memory");
    return block;
}

static void read_rank(const char *prefix, uint64_t rank) {
    char name[1024];
    snprintf(name, sizeof name, "%s.%d.rows", prefix, (int)rank);
    FILE *file = fopen(name, "rb");
    fibrad_rows_head *const h = &head[rank];
    if (!file || fread(h, sizeof *h, 1, file) != 1) stop(name);
    if (memcmp(h->magic, FIBRAD_ROWS_MAGIC, sizeof h->magic) != 0 || h->rank != rank || h->ranks > RANKS) stop(name);
    const uint64_t count = h->rows * (10 + h->walls) + 1 + 2 * h->entries;
    words[rank] = room(8 * count);
    if (fread(words[rank], 8, count, file) != count || fgetc(file) != EOF) stop(name);
    fclose(file);
}

static int by_id(const void *a, const void *b) {
    const uint64_t left = ((const place *)a)->id, right = ((const place *)b)->id;
    return (left > right) - (left < right);
}

static void put(const uint64_t *from, uint64_t count) {
    if (fwrite(from, 8, count, stdout) != count) stop("standard output");
}

static void put_row(const place *p) {
    const fibrad_rows_head *const h = &head[p->rank];
    const uint64_t *start = words[p->rank] + h->rows, *col = start + h->rows + 1, *f = col + h->entries;
    const uint64_t *wall = f + h->entries, *scalars = wall + h->rows * h->walls, *x = scalars + 5 * h->rows;
    const uint64_t first = start[p->row], length = start[p->row + 1] - first;
    put(&p->id, 1);
    put(&length, 1);
    put(col + first, length);
    put(f + first, length);
    put(wall + p->row * h->walls, h->walls);
    for (int k = 0; k < 5; k++) put(scalars + (uint64_t)k * h->rows + p->row, 1); /* escaped, ..., emissivity */
    put(x + 3 * p->row, 3);
}

int main(int count, char **argument) {
    if (count != 2) stop("sorted_rows PREFIX");
    read_rank(argument[1], 0);
    uint64_t rows = head[0].rows, ranks = head[0].ranks;
    for (uint64_t rank = 1; rank < ranks; rank++) {
        read_rank(argument[1], rank);
        rows += head[rank].rows;
    }
    place *places = room(rows * sizeof *places);
    rows = 0;
    for (uint64_t rank = 0; rank < ranks; rank++)
        for (uint64_t i = 0; i < head[rank].rows; i++) places[rows++] = (place){words[rank][i], i, rank};
    qsort(places, rows, sizeof *places, by_id);
    for (uint64_t i = 0; i < rows; i++) put_row(&places[i]);
    for (uint64_t rank = 0; rank < ranks; rank++) free(words[rank]);
    free(places);
    return 0;
}
