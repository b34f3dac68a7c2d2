/* follow.c - rows that stay when particles come or go. SPDX-License-Identifier: MIT
 *
 * Only particles that have come get rows. Old rows do not know of them. So the new rows carry all of what a new and an
 * old particle exchange, not half of it: their factors to old particles are doubled. Two new particles know each
 * other. Factors to particles that are gone are given back to the rest of the row. */
#include <string.h>

#include "couple/insitu.h"

static int find_known(const fibrad_insitu *s, const uint64_t *owned, size_t own, const uint64_t *used, size_t n,
                      unsigned char **known) {
    uint64_t *id = malloc((own + n + 1) * sizeof *id);
    *known = malloc(n + 1);
    int status = fibrad_agree(s->comm, id && *known ? FIBRAD_OK : FIBRAD_E_MEMORY, NULL);
    if (!status) {
        if (own) memcpy(id, owned, own * sizeof *id);
        if (n) memcpy(id + own, used, n * sizeof *id);
        status = fibrad_link_known(s->comm, id, own, own + n, *known);
    }
    free(id);
    return status;
}

/* Counts particles that have come and gone, and what stays. */
static void count_changes(fibrad_follow *f, const fibrad_insitu *s, size_t own) {
    const fibrad_insitu_set *set = &s->set;
    uint64_t sum[2] = {0};
    for (size_t i = 0; i < own; ++i) sum[0] += !f->has[i];
    for (size_t c = 0; c < set->columns; ++c) *(c < set->own ? &f->kept : &f->kept_seen) += f->there[c];
    sum[1] = set->own - f->kept;
    MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPI_UINT64_T, MPI_SUM, s->comm);
    f->came = sum[0], f->gone = sum[1];
}

int fibrad_follow_find(fibrad_follow *f, const fibrad_insitu *s, const fibrad_particle *particle, size_t own,
                       size_t halo) {
    const fibrad_insitu_set *set = &s->set;
    uint64_t *id = malloc((own + halo + 1) * sizeof *id);
    int status = fibrad_agree(s->comm, id ? FIBRAD_OK : FIBRAD_E_MEMORY, NULL);
    for (size_t i = 0; i < own + halo && !status; ++i) id[i] = particle[i].id;
    if (!status) status = find_known(s, id, own, set->id.at, set->columns, &f->there);
    if (!status) status = find_known(s, set->id.at, set->own, id, own + halo, &f->has);
    if (!status) count_changes(f, s, own);
    free(id);
    return status;
}

/* Appends an old row. f, col: scratch. The factors are halved on the way, since doubled ones are no factors. */
static int keep_row(fibrad_rows *rows, const fibrad_row *old, const uint32_t *number, uint32_t walls, double *f,
                    uint32_t *col) {
    fibrad_row row = *old, added;
    size_t at = rows->used;
    row.f = f, row.col = col, row.sphere = number[old->sphere], row.length = 0;
    for (uint32_t k = 0; k < old->length; ++k) {
        if (number[old->col[k]] == UINT32_MAX) {
            row.beyond += 0.5 * old->f[k];
            continue;
        }
        f[row.length] = 0.5 * old->f[k];
        col[row.length++] = number[old->col[k]];
    }
    const int status = fibrad_rows_add(rows, &row, walls);
    if (!status && fibrad_rows_read(rows, &at, &added))
        for (uint32_t k = 0; k < added.length; ++k) added.f[k] *= 2;
    return status;
}

int fibrad_follow_keep(const fibrad_follow *follow, const fibrad_insitu *s, fibrad_insitu_set *to, size_t fresh) {
    const fibrad_insitu_set *set = &s->set;
    const size_t columns = set->columns;
    uint32_t *number = malloc((columns + 1) * sizeof *number), *col = malloc((columns + 1) * sizeof *col);
    double *f = malloc((columns + 1) * sizeof *f);
    int status = number && col && f ? FIBRAD_OK : FIBRAD_E_MEMORY;
    size_t next = fresh;
    fibrad_row row;
    for (size_t c = 0; c < columns && !status; ++c) number[c] = follow->there[c] ? (uint32_t)next++ : UINT32_MAX;
    for (int t = 0; t < s->config.threads; ++t)
        for (size_t at = 0; !status && fibrad_rows_read(&set->rows[t], &at, &row);)
            if (number[row.sphere] != UINT32_MAX) status = keep_row(&to->rows[t], &row, number, set->walls, f, col);
    free(number);
    free(col);
    free(f);
    return status;
}

void fibrad_follow_free(fibrad_follow *f) {
    free(f->there);
    free(f->has);
}
