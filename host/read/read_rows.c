/* read_rows.c - joins the rows that the ranks of a simulation wrote. SPDX-License-Identifier: MIT
 *
 * All files are mapped. First the heads are compared: they tell whether these are the files of all ranks of one step.
 * Then ids are sorted, which give each sphere its number. Then rows are joined one by one. */
#include "read/read_rows.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cli/message.h"
#include "cli/output.h"
#include "couple/rows_file.h"
#include "simple/fibrad_host.h"

enum { WORD = 8 };

/* A mapped file and its arrays, as rows_file.h has them. */
struct rank_file {
    const char *path;
    void *map; /* NULL: not mapped */
    size_t bytes;
    const fibrad_rows_head *head;
    const uint64_t *id, *start, *col;
    double *f, *wall, *escaped, *beyond, *error, *radius, *emissivity, *x; /* not to be written */
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

/* ---- heads ------------------------------------------------------------------------------------------------------ */

static int map_file(struct rank_file *from) {
    struct stat about = {0};
    int status = output_spare(from->path);
    if (status) return status;
    const int file = open(from->path, O_RDONLY);
    if (file < 0) return message_at(STATUS_FILE, from->path, 0, "%s", strerror(errno));
    if (fstat(file, &about) != 0 || !S_ISREG(about.st_mode))
        status = message_at(STATUS_FILE, from->path, 0, "cannot be read twice; a regular file is needed");
    else if ((uint64_t)about.st_size < sizeof *from->head)
        status = message_at(STATUS_INPUT, from->path, 0, "is no file of rows");
    from->bytes = (size_t)about.st_size;
    void *map = status ? NULL : mmap(NULL, from->bytes, PROT_READ, MAP_PRIVATE, file, 0);
    if (map == MAP_FAILED)
        status = message_at(STATUS_FILE, from->path, 0, "%s", strerror(errno));
    else
        from->map = map;
    close(file);
    return status;
}

static int check_size(const struct rank_file *from) {
    const fibrad_rows_head *head = from->head;
    const uint64_t most = from->bytes / WORD;
    if (head->rows > most || head->entries > most) return message_at(STATUS_INPUT, from->path, 0, "ends too early");
    const uint64_t bytes = sizeof *head + WORD * (1 + 2 * head->entries + (10 + head->walls) * head->rows);
    if (from->bytes < bytes)
        return message_at(STATUS_INPUT, from->path, 0, "ends too early, after %zu of %" PRIu64 " bytes", from->bytes,
                          bytes);
    if (from->bytes > bytes)
        return message_at(STATUS_INPUT, from->path, 0, "has %" PRIu64 " bytes too many", from->bytes - bytes);
    return STATUS_OK;
}

/* Finds the arrays of a file whose size is right. The offsets of its rows must ascend. */
static int find_arrays(struct rank_file *from) {
    const fibrad_rows_head *head = from->head;
    const uint64_t n = head->rows, words = sizeof *head / WORD + 2 * n + 1 + head->entries; /* before f */
    from->id = (const uint64_t *)(head + 1);
    from->start = from->id + n;
    from->col = from->start + n + 1;
    from->f = (double *)from->map + words;
    from->wall = from->f + head->entries;
    from->escaped = from->wall + n * head->walls;
    from->beyond = from->escaped + n;
    from->error = from->beyond + n;
    from->radius = from->error + n;
    from->emissivity = from->radius + n;
    from->x = from->emissivity + n;
    bool good = from->start[0] == 0 && from->start[n] == head->entries;
    for (uint64_t k = 0; good && k < n; ++k) good = from->start[k] <= from->start[k + 1];
    return good ? STATUS_OK : message_at(STATUS_INPUT, from->path, 0, "the starts of its rows are damaged");
}

static int read_head(struct rank_file *from) {
    int status = map_file(from);
    if (status) return status;
    const fibrad_rows_head *head = from->head = from->map;
    if (memcmp(head->magic, FIBRAD_ROWS_MAGIC, sizeof head->magic) != 0)
        return message_at(STATUS_INPUT, from->path, 0, "is no file of rows");
    if (head->rank >= head->ranks || head->emissive > 1 || head->walls > FIBRAD_WALLS_MAX ||
        !(head->cutoff >= 0 && head->cutoff < INFINITY))
        return message_at(STATUS_INPUT, from->path, 0, "its head is damaged");
    status = check_size(from);
    return status ? status : find_arrays(from);
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
    const uint64_t left = ((const struct rank_file *)a)->head->rank, right = ((const struct rank_file *)b)->head->rank;
    return (left > right) - (left < right);
}

/* Sorts the files by rank. Each rank must be there once. */
static int order_files(struct rank_file *rank_file, size_t count) {
    for (size_t k = 1; k < count; ++k) {
        const char *difference = head_difference(rank_file[0].head, rank_file[k].head);
        if (difference)
            return message_at(STATUS_INPUT, rank_file[k].path, 0, "has %s than %.200s", difference, rank_file[0].path);
    }
    qsort(rank_file, count, sizeof *rank_file, compare_files);
    for (size_t k = 0; k < count; ++k) {
        if (k > 0 && rank_file[k].head->rank == rank_file[k - 1].head->rank)
            return message_at(STATUS_INPUT, rank_file[k].path, 0, "has the rows of rank %" PRIu64 ", as %.200s has",
                              rank_file[k].head->rank, rank_file[k - 1].path);
        if (rank_file[k].head->rank != k) break;
    }
    for (size_t k = 0; k < rank_file[0].head->ranks; ++k)
        if (k >= count || rank_file[k].head->rank != k)
            return message_at(STATUS_INPUT, rank_file[0].path, 0,
                              "is one of %" PRIu64 " files; the file of rank %zu is missing", rank_file[0].head->ranks,
                              k);
    return STATUS_OK;
}

/* ---- ids -------------------------------------------------------------------------------------------------------- */

/* Compares ids, or structures that begin with an id. */
static int compare_joined(const void *a, const void *b) {
    const uint64_t left = *(const uint64_t *)a, right = *(const uint64_t *)b;
    return (left > right) - (left < right);
}

/* Sorts all ids into joined->id. Each id must be there once. */
static int order_ids(const struct rank_file *rank_file, struct owner *owner, struct joined *joined) {
    size_t n = 0;
    for (size_t file = 0; file < joined->ranks; ++file)
        for (uint64_t k = 0; k < rank_file[file].head->rows; ++k)
            owner[n++] = (struct owner){rank_file[file].id[k], file};
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
    for (size_t k = 0; k < joined->ranks; ++k) n += rank_file[k].head->rows;
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

static int row_fault(const struct rank_file *from, uint64_t k, const char *what) {
    return message_at(STATUS_INPUT, from->path, 0, "id %" PRIu64 ": %s", from->id[k], what);
}

/* Takes centre, radius and emissivity of the sphere of row k. */
static int take_sphere(const struct rank_file *from, uint64_t k, uint32_t i, struct joined *to) {
    for (uint64_t axis = 0; axis < 3; ++axis) {
        to->x[3 * (uint64_t)i + axis] = from->x[3 * k + axis];
        if (!isfinite(from->x[3 * k + axis])) return row_fault(from, k, "its centre is not finite");
    }
    to->radius[i] = from->radius[k];
    to->emissivity[i] = from->emissivity[k];
    if (!(to->radius[i] > 0 && to->radius[i] < INFINITY)) return row_fault(from, k, "its radius is not above 0");
    if (!(to->emissivity[i] >= 0 && to->emissivity[i] <= 1))
        return row_fault(from, k, "its emissivity is not within 0 and 1");
    return STATUS_OK;
}

/* Joins row k. col [joined->n]: room for its columns. */
static int take_row(const struct rank_file *from, uint64_t k, uint32_t *col, struct joined *joined) {
    const uint64_t start = from->start[k], length = from->start[k + 1] - start;
    if (length > joined->n) return message_at(STATUS_INPUT, from->path, 0, "the starts of its rows are damaged");
    fibrad_row row = {.col = col, .f = from->f + start, .wall = from->wall + k * from->head->walls};
    row.sphere = sphere_of(joined, from->id[k]), row.length = (uint32_t)length;
    row.escaped = from->escaped[k], row.beyond = from->beyond[k], row.error = from->error[k];
    const int status = take_sphere(from, k, row.sphere, joined);
    if (status) return status;
    for (uint64_t j = 0; j < length; ++j) {
        col[j] = sphere_of(joined, from->col[start + j]);
        if (col[j] == joined->n)
            return message_at(STATUS_INPUT, from->path, 0,
                              "id %" PRIu64 " has an entry for id %" PRIu64 ", which has no row", from->id[k],
                              from->col[start + j]);
    }
    if (!(row.error < INFINITY)) return row_fault(from, k, "its error is not finite");
    switch (fibrad_rows_add(&joined->rows, &row, joined->walls)) {
    case FIBRAD_OK:
        return interrupt_status();
    case FIBRAD_E_ARGUMENT:
        return row_fault(from, k, "a factor of its row is not within 0 and 1, or its columns do not ascend");
    default:
        return message_memory();
    }
}

static int join_files(struct rank_file *rank_file, size_t count, struct joined *joined) {
    int status = STATUS_OK;
    for (size_t k = 0; !status && k < count; ++k) status = read_head(&rank_file[k]);
    if (!status) status = order_files(rank_file, count);
    if (status) return status;
    const fibrad_rows_head *head = rank_file[0].head;
    joined->ranks = head->ranks;
    joined->step = head->step;
    joined->walls = (uint32_t)head->walls;
    joined->emissive = head->emissive != 0;
    joined->cutoff = head->cutoff;
    status = join_ids(rank_file, joined);
    if (status) return status;
    uint32_t *col = joined_memory(joined->n, sizeof *col);
    if (!col) return message_memory();
    for (size_t file = 0; file < count; ++file)
        for (uint64_t k = 0; !status && k < rank_file[file].head->rows; ++k)
            status = take_row(&rank_file[file], k, col, joined);
    free(col);
    return status;
}

int read_rows(const char *const *paths, size_t count, struct joined *joined) {
    *joined = (struct joined){.rows.memory.resize = fibrad_heap_resize};
    struct rank_file *rank_file = joined_memory(count, sizeof *rank_file);
    if (!rank_file) return message_memory();
    for (size_t k = 0; k < count; ++k) rank_file[k] = (struct rank_file){.path = paths[k]};
    const int status = join_files(rank_file, count, joined);
    for (size_t k = 0; k < count; ++k)
        if (rank_file[k].map) munmap(rank_file[k].map, rank_file[k].bytes);
    free(rank_file);
    return status;
}

void joined_free(struct joined *joined) {
    free(joined->id);
    free(joined->x);
    free(joined->rows.memory.block);
}
