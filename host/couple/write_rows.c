/* write_rows.c - writes the rows of each rank to a file. SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>

#include "couple/insitu.h"
#include "couple/rows_file.h"

#define PATH_BYTES 4096

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "files are written as memory is");

/* The id of a row, and where the row is. */
struct row_place {
    uint64_t id;
    size_t at;
    int thread;
};

/* An entry of a row, by the id of its column. */
struct entry_of_id {
    uint64_t id;
    double f;
};

static int compare_ids(const void *a, const void *b) {
    const uint64_t x = ((const struct row_place *)a)->id, y = ((const struct row_place *)b)->id;
    return (x > y) - (x < y);
}

static int compare_entries(const void *a, const void *b) {
    const struct entry_of_id *x = a, *y = b;
    if (x->id != y->id) return x->id < y->id ? -1 : 1;
    return (x->f > y->f) - (x->f < y->f);
}

/* The arrays of a file. */
struct rows_arrays {
    uint64_t *id, *start, *col;
    double *f, *wall, *escaped, *beyond, *error, *radius, *emissivity, *x;
};

/* Puts a row into the arrays as row i. Images of one particle are joined in one entry, in an order that does not depend
 * on the order of the row. */
static void put_row(const fibrad_insitu_set *set, const fibrad_row *row, size_t i, struct entry_of_id *entry,
                    struct rows_arrays *to) {
    const uint64_t *id = set->id.at;
    const fibrad_particle *p = (const fibrad_particle *)set->particle.at + row->sphere;
    uint64_t end = to->start[i];
    for (uint32_t k = 0; k < row->length; ++k) entry[k] = (struct entry_of_id){id[row->col[k]], row->f[k]};
    qsort(entry, row->length, sizeof *entry, compare_entries);
    for (uint32_t k = 0; k < row->length; ++k) {
        if (k && entry[k].id == entry[k - 1].id) {
            to->f[end - 1] += entry[k].f;
            continue;
        }
        to->col[end] = entry[k].id;
        to->f[end++] = entry[k].f;
    }
    to->id[i] = id[row->sphere];
    to->start[i + 1] = end;
    to->escaped[i] = row->escaped;
    to->beyond[i] = row->beyond;
    to->error[i] = row->error;
    to->radius[i] = p->radius;
    to->emissivity[i] = p->node;
    memcpy(to->x + 3 * i, p->x, sizeof p->x);
    if (set->walls) memcpy(to->wall + i * set->walls, row->wall, set->walls * sizeof *to->wall);
}

static int write_words(FILE *file, const void *words, size_t count) {
    return count == 0 || fwrite(words, sizeof(uint64_t), count, file) == count;
}

static int write_file(const char *name, const fibrad_rows_head *head, const struct rows_arrays *a) {
    FILE *file = fopen(name, "wb");
    if (!file) return 0;
    const size_t n = head->rows;
    const int whole = write_words(file, head, sizeof *head / sizeof(uint64_t)) && write_words(file, a->id, n) &&
                      write_words(file, a->start, n + 1) && write_words(file, a->col, head->entries) &&
                      write_words(file, a->f, head->entries) && write_words(file, a->wall, n * head->walls) &&
                      write_words(file, a->escaped, n) && write_words(file, a->beyond, n) &&
                      write_words(file, a->error, n) && write_words(file, a->radius, n) &&
                      write_words(file, a->emissivity, n) && write_words(file, a->x, 3 * n);
    return fclose(file) == 0 && whole;
}

/* Lists the rows by ascending id, place[own]. Returns the length of the longest row. */
static uint32_t list_rows(fibrad_insitu *s, struct row_place *place) {
    fibrad_row row;
    size_t count = 0;
    uint32_t longest = 0;
    const uint64_t *id = s->set.id.at;
    for (int t = 0; t < s->config.threads; ++t)
        for (size_t at = 0, before = 0; fibrad_rows_read(&s->set.rows[t], &at, &row); before = at) {
            place[count++] = (struct row_place){id[row.sphere], before, t};
            if (row.length > longest) longest = row.length;
        }
    qsort(place, count, sizeof *place, compare_ids);
    return longest;
}

/* Allocates the arrays of a file. Returns FIBRAD_OK or _E_MEMORY. */
static int open_arrays(const fibrad_insitu_set *set, uint64_t entries, struct rows_arrays *a) {
    const size_t n = set->own;
    a->id = malloc((2 * n + 1 + entries) * sizeof *a->id);
    a->f = malloc((n * (8 + set->walls) + entries + 1) * sizeof *a->f);
    if (!a->id || !a->f) return FIBRAD_E_MEMORY;
    a->start = a->id + n;
    a->col = a->start + n + 1;
    a->wall = a->f + entries;
    a->escaped = a->wall + n * set->walls;
    a->beyond = a->escaped + n;
    a->error = a->beyond + n;
    a->radius = a->error + n;
    a->emissivity = a->radius + n;
    a->x = a->emissivity + n;
    return FIBRAD_OK;
}

/* Fills the arrays with the rows in the order of their ids. Returns FIBRAD_OK or _E_MEMORY. */
static int gather_rows(fibrad_insitu *s, struct rows_arrays *a) {
    const size_t n = s->set.own;
    struct row_place *place = malloc((n + 1) * sizeof *place);
    if (!place) return FIBRAD_E_MEMORY;
    struct entry_of_id *entry = malloc(((size_t)list_rows(s, place) + 1) * sizeof *entry);
    a->start[0] = 0;
    for (size_t i = 0; i < n && entry; ++i) {
        fibrad_row row;
        size_t at = place[i].at;
        fibrad_rows_read(&s->set.rows[place[i].thread], &at, &row);
        put_row(&s->set, &row, i, entry, a);
    }
    const int status = entry ? FIBRAD_OK : FIBRAD_E_MEMORY;
    free(place);
    free(entry);
    return status;
}

static int write_draft(fibrad_insitu *s, const char *name) {
    const fibrad_insitu_set *set = &s->set;
    struct rows_arrays a = {0};
    uint64_t entries = 0;
    for (int t = 0; t < s->config.threads; ++t) entries += set->rows[t].entries;
    int status = open_arrays(set, entries, &a);
    if (!status) status = gather_rows(s, &a);
    if (!status) {
        fibrad_rows_head head = {.rank = (uint64_t)s->rank, .ranks = (uint64_t)s->ranks, .step = set->facts.step};
        head.rows = set->own, head.entries = a.start[set->own], head.walls = set->walls;
        head.emissive = (uint64_t)set->emissive, head.cutoff = set->facts.cutoff;
        memcpy(head.magic, FIBRAD_ROWS_MAGIC, sizeof head.magic);
        if (!write_file(name, &head, &a)) status = fibrad_refuse(s->message, FIBRAD_E_FILE, "cannot write %s", name);
    }
    free(a.id);
    free(a.f);
    return status;
}

int fibrad_insitu_write(fibrad_insitu *s, const char *path) {
    char name[PATH_BYTES], draft[PATH_BYTES];
    if (!s) return FIBRAD_E_ARGUMENT;
    s->message[0] = 0;
    int status = s->ready ? FIBRAD_OK : fibrad_refuse(s->message, FIBRAD_E_STATE, "there are no rows to write");
    if (!status && s->set.changed)
        status = fibrad_refuse(s->message, FIBRAD_E_STATE, "particles have come or gone since all rows were made");
    if (!status && (!path || strlen(path) + 32 > PATH_BYTES))
        status = fibrad_refuse(s->message, FIBRAD_E_ARGUMENT, "the name for the files of rows is empty or too long");
    status = fibrad_agree(s->comm, status, s->message);
    if (status) return status;
    snprintf(name, sizeof name, "%.4000s.%d.rows", path, s->rank);
    snprintf(draft, sizeof draft, "%.4000s.%d.rows.tmp", path, s->rank);
    status = fibrad_agree(s->comm, write_draft(s, draft), s->message);
    const bool renamed = !status && rename(draft, name) == 0;
    if (!status && !renamed) status = fibrad_refuse(s->message, FIBRAD_E_FILE, "cannot rename to %.200s", name);
    status = fibrad_agree(s->comm, status, s->message);
    if (status) {
        remove(draft);
        if (renamed) remove(name);
    }
    return status;
}
