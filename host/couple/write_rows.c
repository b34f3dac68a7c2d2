/* write_rows.c - the rows of each rank in a file. SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <string.h>

#include "couple/insitu.h"
#include "couple/rows_file.h"
#include "fibrad_part.h"

#define PATH_BYTES 4096

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "files are written as memory is");

/* A row and where it lies, or an entry of it, by id. */
struct row_place {
    uint64_t id;
    size_t at;
    int thread;
};
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
    double *f, *body, *escaped, *beyond, *error, *radius, *emissivity, *x;
};

/* One row at place i of the arrays; images of one particle in one entry, whatever the order they were found in. */
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
    to->emissivity[i] = p->emissivity;
    memcpy(to->x + 3 * i, p->x, sizeof p->x);
    if (set->bodies) memcpy(to->body + i * set->bodies, row->body, set->bodies * sizeof *to->body);
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
                      write_words(file, a->f, head->entries) && write_words(file, a->body, n * head->bodies) &&
                      write_words(file, a->escaped, n) && write_words(file, a->beyond, n) &&
                      write_words(file, a->error, n) && write_words(file, a->radius, n) &&
                      write_words(file, a->emissivity, n) && write_words(file, a->x, 3 * n);
    return fclose(file) == 0 && whole;
}

/* Rows by ascending id. Their places are the caller's. */
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

static int write_rows(fibrad_insitu *s, const char *name) {
    const fibrad_insitu_set *set = &s->set;
    const size_t n = set->own, width = 8 + set->bodies;
    uint64_t entries = 0;
    for (int t = 0; t < s->config.threads; ++t) entries += set->rows[t].entries;
    struct row_place *place = malloc((n + 1) * sizeof *place);
    double *reals = malloc((n * width + entries + 1) * sizeof *reals);
    uint64_t *whole = malloc((2 * n + 1 + entries) * sizeof *whole);
    struct entry_of_id *entry = NULL;
    const uint32_t longest = place ? list_rows(s, place) : 0;
    entry = malloc(((size_t)longest + 1) * sizeof *entry);
    int status = place && reals && whole && entry ? FIBRAD_OK : FIBRAD_E_MEMORY;
    if (!status) {
        struct rows_arrays a = {.id = whole, .start = whole + n, .col = whole + 2 * n + 1, .f = reals};
        double **const arrays[] = {&a.escaped, &a.beyond, &a.error, &a.radius, &a.emissivity, &a.x, &a.body};
        for (size_t k = 0; k < sizeof arrays / sizeof *arrays; ++k)
            *arrays[k] = reals + entries + k * n + (k == 6 ? 2 * n : 0);
        a.start[0] = 0;
        for (size_t i = 0; i < n; ++i) {
            fibrad_row row;
            size_t at = place[i].at;
            fibrad_rows_read(&s->set.rows[place[i].thread], &at, &row);
            put_row(set, &row, i, entry, &a);
        }
        fibrad_rows_head head = {.rank = (uint64_t)s->rank,
                                 .ranks = (uint64_t)s->ranks,
                                 .step = set->facts.step,
                                 .rows = n,
                                 .entries = a.start[n],
                                 .bodies = set->bodies,
                                 .emissive = (uint64_t)set->emissive,
                                 .cutoff = set->facts.cutoff};
        memcpy(head.magic, FIBRAD_ROWS_MAGIC, sizeof head.magic);
        if (!write_file(name, &head, &a))
            status = fibrad_refuse(s->message, FIBRAD_E_ARGUMENT, "cannot write %s", name);
    }
    free(place);
    free(reals);
    free(whole);
    free(entry);
    return status;
}

int fibrad_insitu_write(fibrad_insitu *s, const char *path) {
    char name[PATH_BYTES], draft[PATH_BYTES];
    if (!s) return FIBRAD_E_ARGUMENT;
    s->message[0] = 0;
    int status = s->ready ? FIBRAD_OK : fibrad_refuse(s->message, FIBRAD_E_STATE, "there are no rows to write");
    if (!status && (!path || strlen(path) + 32 > PATH_BYTES))
        status = fibrad_refuse(s->message, FIBRAD_E_ARGUMENT, "no name, or one too long, for files of rows");
    status = fibrad_agree(s->comm, status, s->message);
    if (status) return status;
    snprintf(name, sizeof name, "%.4000s.%d.rows", path, s->rank);
    snprintf(draft, sizeof draft, "%.4000s.%d.rows.tmp", path, s->rank);
    status = fibrad_agree(s->comm, write_rows(s, draft), s->message);
    if (!status && rename(draft, name))
        status = fibrad_refuse(s->message, FIBRAD_E_ARGUMENT, "cannot rename to %.200s", name);
    status = fibrad_agree(s->comm, status, s->message);
    if (status) {
        remove(draft);
        remove(name);
    }
    return status;
}
