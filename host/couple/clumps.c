/* clumps.c - members of clumps that are divided over ranks. SPDX-License-Identifier: MIT
 *
 * A hash of its number names the rank that sums up a clump. */
#include <string.h>

#include "couple/insitu.h"

struct member {
    uint64_t clump, id, back; /* back: where the particle stands in what its rank gets */
    double value[FIBRAD_CLUMP_WIDTH];
};

static int by_clump_and_id(const void *a, const void *b) {
    const struct member *x = a, *y = b;
    if (x->clump != y->clump) return x->clump < y->clump ? -1 : 1;
    return x->id < y->id ? -1 : x->id > y->id;
}

static int by_back(const void *a, const void *b) {
    const struct member *x = a, *y = b;
    return x->back < y->back ? -1 : x->back > y->back;
}

/* Gives all members of each clump the same values. They come back in the order in which they were. */
static void sum_members(struct member *member, size_t n, int width) {
    for (size_t k = 0; k < n; ++k) member[k].back = k;
    if (n) qsort(member, n, sizeof *member, by_clump_and_id);
    for (size_t k = 0, end; k < n; k = end) {
        for (end = k + 1; end < n && member[end].clump == member[k].clump; ++end)
            for (int v = 1; v < width; ++v) member[k].value[v] += member[end].value[v];
        for (size_t m = k + 1; m < end; ++m) memcpy(member[m].value, member[k].value, sizeof member[k].value);
    }
    if (n) qsort(member, n, sizeof *member, by_back);
}

int fibrad_clump_sums(MPI_Comm comm, const uint32_t *clump, const uint64_t *id, size_t n, double *value, int width) {
    int ranks;
    MPI_Comm_size(comm, &ranks);
    struct member *send = malloc((n + 1) * sizeof *send);
    size_t *from = malloc((n + 1) * sizeof *from), sum = 0;
    int *count = calloc(3 * (size_t)ranks, sizeof *count), *got = count + ranks, *unused = got + ranks;
    fibrad_block there = {0}, back = {0};
    int status = fibrad_agree(comm, send && from && count ? FIBRAD_OK : FIBRAD_E_MEMORY, NULL);
    for (int q = 0; q < ranks && !status; ++q)
        for (size_t i = 0; i < n; ++i) {
            if (!clump[i] || fibrad_hash_id(clump[i]) % (uint64_t)ranks != (uint64_t)q) continue;
            send[sum] = (struct member){.clump = clump[i], .id = id[i]};
            memcpy(send[sum].value, value + i * (size_t)width, (size_t)width * sizeof *value);
            from[sum++] = i, count[q]++;
        }
    if (!status) status = fibrad_deal(comm, status, send, count, sizeof *send, &there, 0, got);
    if (!status) {
        sum_members(there.at, fibrad_count_sum(got, ranks), width);
        status = fibrad_deal(comm, status, there.at, got, sizeof *send, &back, 0, unused);
    }
    const struct member *member = back.at;
    for (size_t k = 0; k < sum && !status; ++k)
        memcpy(value + from[k] * (size_t)width, member[k].value, (size_t)width * sizeof *value);
    free(send);
    free(from);
    free(count);
    fibrad_block_free(&there);
    fibrad_block_free(&back);
    return status;
}

int fibrad_insitu_exposed(fibrad_insitu *s, const uint32_t *clump, double *area) {
    const fibrad_insitu_set *set = &s->set;
    const size_t n = set->now_n;
    const int status = fibrad_agree(s->comm, fibrad_block_fit(&s->value, n + set->own, sizeof(double)), NULL);
    if (status) return status;
    double *value = s->value.at;
    const fibrad_particle *p = set->particle.at;
    memset(value, 0, n * sizeof *value);
    for (size_t i = 0; i < set->own; ++i) value[n + i] = p[i].exposed;
    fibrad_link_reverse(set->present, value, 1);
    for (size_t i = 0; i < n; ++i)
        if (clump[i]) area[i] = value[i];
    return FIBRAD_OK;
}
