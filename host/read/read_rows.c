/* read_rows.c - joins the rows that the ranks of a simulation wrote. SPDX-License-Identifier: MIT
 *
 * First the heads are read: they tell whether these are the files of all ranks of one step. Then ids are read, which
 * give each sphere its number. Then rows are read one by one, so that entries are in memory once. */
#include "read/read_rows.h"

#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/interrupt.h"
#include "cli/message.h"
#include "cli/output.h"
#include "couple/rows_file.h"
#include "simple/fibrad_host.h"

enum { WORD = 8 };

struct rank_file {
    const char *path;
    fibrad_rows_head head;
};

/* An id, and the index of the file that has its row. */
struct owner {
    uint64_t id;
    size_t file;
};

/* Memory for `count` elements. NULL: there is not enough memory, not even for count 0. */
static void *joined_memory(uint64_t count, size_t size) {
    return count < SIZE_MAX / size ? malloc((size_t)count * size + 1) : NULL;
}

static int file_read(const struct rank_file *rank_file, FILE *file, void *to, uint64_t words) {
    if (fread(to, WORD, (size_t)words, file) == words) return STATUS_OK;
    return message_at(STATUS_FILE, rank_file->path, 0, "%s", ferror(file) ? strerror(errno) : "ends too early");
}

/* Opens a file and goes to a word behind the head. Status 0 or STATUS_FILE. */
static int file_open(const struct rank_file *rank_file, uint64_t word, FILE **file) {
    *file = fopen(rank_file->path, "rb");
    if (*file && fseeko(*file, (off_t)(sizeof rank_file->head + WORD * word), SEEK_SET) == 0) return STATUS_OK;
    return message_at(STATUS_FILE, rank_file->path, 0, "%s", strerror(errno));
}

/* ---- heads ------------------------------------------------------------------------------------------------------ */

static int check_size(const struct rank_file *rank_file, uint64_t bytes) {
    const fibrad_rows_head *head = &rank_file->head;
    const uint64_t most = bytes / WORD;
    if (head->rows > most || head->entries > most)
        return message_at(STATUS_INPUT, rank_file->path, 0, "ends too early");
    const uint64_t words = sizeof *head / WORD + 1 + 2 * head->entries + (10 + head->walls) * head->rows;
    if (bytes < WORD * words)
        return message_at(STATUS_INPUT, rank_file->path, 0, "ends too early, after %" PRIu64 " of %" PRIu64 " bytes",
                          bytes, WORD * words);
    if (bytes > WORD * words)
        return message_at(STATUS_INPUT, rank_file->path, 0, "has %" PRIu64 " bytes too many", bytes - WORD * words);
    return STATUS_OK;
}

static int check_head(const struct rank_file *rank_file, uint64_t bytes) {
    const fibrad_rows_head *head = &rank_file->head;
    if (bytes < sizeof *head || memcmp(head->magic, FIBRAD_ROWS_MAGIC, sizeof head->magic) != 0)
        return message_at(STATUS_INPUT, rank_file->path, 0, "is no file of rows");
    if (head->rank >= head->ranks || head->emissive > 1 || head->walls > FIBRAD_WALLS_MAX ||
        !(head->cutoff >= 0 && head->cutoff < INFINITY))
        return message_at(STATUS_INPUT, rank_file->path, 0, "its head is damaged");
    return check_size(rank_file, bytes);
}

static int read_head(struct rank_file *rank_file) {
    const int spared = output_spare(rank_file->path);
    if (spared) return spared;
    FILE *file = fopen(rank_file->path, "rb");
    if (!file) return message_at(STATUS_FILE, rank_file->path, 0, "%s", strerror(errno));
    const size_t got = fread(&rank_file->head, 1, sizeof rank_file->head, file);
    const int sought = fseeko(file, 0, SEEK_END);
    const off_t bytes = ftello(file);
    fclose(file);
    if (sought != 0 || bytes < 0)
        return message_at(STATUS_FILE, rank_file->path, 0, "cannot be read twice; a regular file is needed");
    return check_head(rank_file, got < sizeof rank_file->head ? got : (uint64_t)bytes);
}

/* The first difference between two heads that belongs to different steps or runs. NULL: there is none. */
static const char *head_difference(const fibrad_rows_head *a, const fibrad_rows_head *b) {
    if (a->ranks != b->ranks) return "another number of ranks";
    if (a->step != b->step) return "another step";
    if (a->walls != b->walls) return "another number of walls";
    if (a->emissive != b->emissive) return "another kind of factors";
    return a->cutoff != b->cutoff ? "another cutoff" : NULL;
}

static int compare_files(const void *a, const void *b) {
    const uint64_t left = ((const struct rank_file *)a)->head.rank, right = ((const struct rank_file *)b)->head.rank;
    return (left > right) - (left < right);
}

/* Sorts the files by rank. Each rank must be there once. */
static int order_files(struct rank_file *rank_file, size_t count) {
    for (size_t k = 1; k < count; ++k) {
        const char *difference = head_difference(&rank_file[0].head, &rank_file[k].head);
        if (difference)
            return message_at(STATUS_INPUT, rank_file[k].path, 0, "has %s than %.200s", difference, rank_file[0].path);
    }
    qsort(rank_file, count, sizeof *rank_file, compare_files);
    for (size_t k = 0; k < count; ++k) {
        if (k > 0 && rank_file[k].head.rank == rank_file[k - 1].head.rank)
            return message_at(STATUS_INPUT, rank_file[k].path, 0, "has the rows of rank %" PRIu64 ", as %.200s has",
                              rank_file[k].head.rank, rank_file[k - 1].path);
        if (rank_file[k].head.rank != k) break;
    }
    for (size_t k = 0; k < rank_file[0].head.ranks; ++k)
        if (k >= count || rank_file[k].head.rank != k)
            return message_at(STATUS_INPUT, rank_file[0].path, 0,
                              "is one of %" PRIu64 " files; the file of rank %zu is missing", rank_file[0].head.ranks,
                              k);
    return STATUS_OK;
}

/* ---- ids -------------------------------------------------------------------------------------------------------- */

/* Compares ids, or structures that begin with an id. */
static int compare_joined(const void *a, const void *b) {
    const uint64_t left = *(const uint64_t *)a, right = *(const uint64_t *)b;
    return (left > right) - (left < right);
}

/* Reads the ids of one file. id: room for them. */
static int own_ids(const struct rank_file *rank_file, size_t index, struct owner *owner, uint64_t *id) {
    FILE *file;
    int status = file_open(rank_file, 0, &file);
    if (!status) status = file_read(rank_file, file, id, rank_file->head.rows);
    if (file) fclose(file);
    for (uint64_t k = 0; !status && k < rank_file->head.rows; ++k) owner[k] = (struct owner){id[k], index};
    return status;
}

/* Reads all ids and sorts them into joined->id. Each id must be there once. */
static int order_ids(const struct rank_file *rank_file, struct owner *owner, struct joined *joined) {
    size_t n = 0;
    for (size_t k = 0; k < joined->ranks; n += (size_t)rank_file[k++].head.rows) {
        const int status = own_ids(&rank_file[k], k, owner + n, joined->id);
        if (status) return status;
    }
    qsort(owner, n, sizeof *owner, compare_joined);
    for (size_t k = 0; k < n; ++k) {
        joined->id[k] = owner[k].id;
        if (k > 0 && owner[k].id == owner[k - 1].id)
            return message_at(STATUS_INPUT, rank_file[owner[k].file].path, 0,
                              "id %" PRIu64 " is there twice, also in %.200s", owner[k].id,
                              rank_file[owner[k - 1].file].path);
    }
    return STATUS_OK;
}

static int join_ids(const struct rank_file *rank_file, struct joined *joined) {
    uint64_t n = 0;
    for (size_t k = 0; k < joined->ranks; ++k) n += rank_file[k].head.rows;
    if (n > FIBRAD_SPHERES_MAX)
        return message_at(STATUS_INPUT, rank_file[0].path, 0, "%" PRIu64 " spheres are too many for one matrix", n);
    joined->n = (uint32_t)n;
    joined->id = joined_memory(n, sizeof *joined->id);
    joined->x = joined_memory(5 * n, sizeof *joined->x);
    struct owner *owner = joined_memory(n, sizeof *owner);
    const bool enough = joined->id && joined->x && owner;
    if (enough) {
        joined->radius = joined->x + 3 * n;
        joined->emissivity = joined->radius + n;
    }
    const int status = enough ? order_ids(rank_file, owner, joined) : message_memory();
    free(owner);
    return status;
}

/* The number of the sphere of an id. joined->n: there is none. */
static uint32_t sphere_of(const struct joined *joined, uint64_t id) {
    const uint64_t *at = joined->n > 0 ? bsearch(&id, joined->id, joined->n, sizeof id, compare_joined) : NULL;
    return at ? (uint32_t)(at - joined->id) : joined->n;
}

/* ---- rows ------------------------------------------------------------------------------------------------------- */

/* One file that is being read. All but the entries is in memory; entries are read row by row. */
struct file_rows {
    const struct rank_file *rank_file;
    struct joined *joined;
    uint64_t *id, *start; /* [rows], [rows + 1] */
    double *wall;         /* [rows][walls] */
    double *rest;         /* [8 rows]: escaped, beyond, error, radius, emissivity, x[rows][3] */
    uint64_t *col_id;     /* [longest row] columns of the current row by id */
    uint32_t *col;        /* [longest row] columns by number */
    double *f;            /* [longest row] factors */
    FILE *cols, *values;
};

static int check_starts(const struct file_rows *from, uint64_t *longest) {
    const fibrad_rows_head *head = &from->rank_file->head;
    bool good = from->start[0] == 0 && from->start[head->rows] == head->entries;
    *longest = 0;
    for (uint64_t k = 0; good && k < head->rows; ++k) {
        const uint64_t length = from->start[k + 1] - from->start[k];
        good = from->start[k] <= from->start[k + 1] && length <= from->joined->n;
        if (length > *longest) *longest = length;
    }
    return good ? STATUS_OK : message_at(STATUS_INPUT, from->rank_file->path, 0, "the starts of its rows are damaged");
}

/* Reads all but the entries, and goes to the first entry. */
static int load_around(struct file_rows *from) {
    const fibrad_rows_head *head = &from->rank_file->head;
    const uint64_t n = head->rows;
    from->id = joined_memory(2 * n + 1, WORD);
    from->wall = joined_memory((head->walls + 8) * n, WORD);
    if (!from->id || !from->wall) return message_memory();
    from->start = from->id + n;
    from->rest = from->wall + n * head->walls;
    int status = file_open(from->rank_file, 0, &from->cols);
    if (!status) status = file_read(from->rank_file, from->cols, from->id, 2 * n + 1);
    if (!status) status = file_open(from->rank_file, 2 * n + 1 + 2 * head->entries, &from->values);
    if (!status) status = file_read(from->rank_file, from->values, from->wall, (head->walls + 8) * n);
    if (status) return status;
    const off_t entries = (off_t)(sizeof *head + WORD * (2 * n + 1 + head->entries));
    return fseeko(from->values, entries, SEEK_SET) == 0
               ? STATUS_OK
               : message_at(STATUS_FILE, from->rank_file->path, 0, "%s", strerror(errno));
}

static int load_buffers(struct file_rows *from) {
    uint64_t longest;
    const int status = check_starts(from, &longest);
    if (status) return status;
    from->col_id = joined_memory(longest, sizeof *from->col_id);
    from->col = joined_memory(longest, sizeof *from->col);
    from->f = joined_memory(longest, sizeof *from->f);
    return from->col_id && from->col && from->f ? STATUS_OK : message_memory();
}

static int row_fault(const struct file_rows *from, uint64_t k, const char *what) {
    return message_at(STATUS_INPUT, from->rank_file->path, 0, "id %" PRIu64 ": %s", from->id[k], what);
}

/* Takes centre, radius and emissivity of the sphere of row k. */
static int take_sphere(const struct file_rows *from, uint64_t k, uint32_t i) {
    const uint64_t n = from->rank_file->head.rows;
    const double *radius = from->rest + 3 * n, *emissivity = radius + n, *x = emissivity + n;
    struct joined *to = from->joined;
    for (uint64_t axis = 0; axis < 3; ++axis) {
        to->x[3 * (uint64_t)i + axis] = x[3 * k + axis];
        if (!isfinite(x[3 * k + axis])) return row_fault(from, k, "its centre is not finite");
    }
    to->radius[i] = radius[k];
    to->emissivity[i] = emissivity[k];
    if (!(to->radius[i] > 0 && to->radius[i] < INFINITY)) return row_fault(from, k, "its radius is not above 0");
    if (!(to->emissivity[i] >= 0 && to->emissivity[i] <= 1))
        return row_fault(from, k, "its emissivity is not within 0 and 1");
    return STATUS_OK;
}

static int take_entries(struct file_rows *from, uint64_t k, uint32_t length) {
    int status = file_read(from->rank_file, from->cols, from->col_id, length);
    if (!status) status = file_read(from->rank_file, from->values, from->f, length);
    for (uint32_t j = 0; !status && j < length; ++j) {
        from->col[j] = sphere_of(from->joined, from->col_id[j]);
        if (from->col[j] == from->joined->n)
            return message_at(STATUS_INPUT, from->rank_file->path, 0,
                              "id %" PRIu64 " has an entry for id %" PRIu64 ", which has no row", from->id[k],
                              from->col_id[j]);
    }
    return status;
}

static int take_row(struct file_rows *from, uint64_t k) {
    const fibrad_rows_head *head = &from->rank_file->head;
    const uint32_t length = (uint32_t)(from->start[k + 1] - from->start[k]);
    const fibrad_row row = {.col = from->col,
                            .f = from->f,
                            .wall = from->wall + k * head->walls,
                            .sphere = sphere_of(from->joined, from->id[k]),
                            .length = length,
                            .escaped = from->rest[k],
                            .beyond = from->rest[head->rows + k],
                            .error = from->rest[2 * head->rows + k]};
    int status = take_sphere(from, k, row.sphere);
    if (!status) status = take_entries(from, k, length);
    if (!status && !(row.error < INFINITY)) return row_fault(from, k, "its error is not finite");
    if (status) return status;
    switch (fibrad_rows_add(&from->joined->rows, &row, from->joined->walls)) {
    case FIBRAD_OK:
        return interrupt_status();
    case FIBRAD_E_ARGUMENT:
        return row_fault(from, k, "a factor of its row is not within 0 and 1, or its columns do not ascend");
    default:
        return message_memory();
    }
}

static int join_file(const struct rank_file *rank_file, struct joined *joined) {
    struct file_rows from = {.rank_file = rank_file, .joined = joined};
    int status = load_around(&from);
    if (!status) status = load_buffers(&from);
    for (uint64_t k = 0; !status && k < rank_file->head.rows; ++k) status = take_row(&from, k);
    if (from.cols) fclose(from.cols);
    if (from.values) fclose(from.values);
    free(from.id);
    free(from.wall);
    free(from.col_id);
    free(from.col);
    free(from.f);
    return status;
}

static int join_files(struct rank_file *rank_file, size_t count, struct joined *joined) {
    int status = STATUS_OK;
    for (size_t k = 0; !status && k < count; ++k) status = read_head(&rank_file[k]);
    if (!status) status = order_files(rank_file, count);
    if (status) return status;
    const fibrad_rows_head *head = &rank_file[0].head;
    joined->ranks = head->ranks;
    joined->step = head->step;
    joined->walls = (uint32_t)head->walls;
    joined->emissive = head->emissive != 0;
    joined->cutoff = head->cutoff;
    status = join_ids(rank_file, joined);
    for (size_t k = 0; !status && k < count; ++k) status = join_file(&rank_file[k], joined);
    return status;
}

int read_rows(const char *const *paths, size_t count, struct joined *joined) {
    *joined = (struct joined){.rows.memory.resize = fibrad_heap_resize};
    struct rank_file *rank_file = joined_memory(count, sizeof *rank_file);
    if (!rank_file) return message_memory();
    for (size_t k = 0; k < count; ++k) rank_file[k] = (struct rank_file){.path = paths[k]};
    const int status = join_files(rank_file, count, joined);
    free(rank_file);
    return status;
}

void joined_free(struct joined *joined) {
    free(joined->id);
    free(joined->x);
    free(joined->rows.memory.block);
}
