/* link.c - values of particles that other ranks own. SPDX-License-Identifier: MIT
 *
 * The directory says who owns an id. It is divided over the ranks; the id alone tells which rank has its entry. Owners
 * enter their ids. Users ask the directory for the owner of each id once, and then tell the owners. From then on only
 * ranks that share particles exchange messages, with one value per particle, between buffers that stay in place. */
#include <limits.h>
#include <stdbool.h>
#include <string.h>

#include "couple/ranks/collective.h"
#include "couple/fibrad_couple.h"

#define LINK_TAG 12012

struct fibrad_link {
    size_t own, used;         /* numbers of ids that this rank owns, and uses */
    size_t sent;              /* own values that ranks use, this rank included */
    size_t got;               /* different ids that this rank uses */
    uint32_t *source;         /* [sent] indices of own values, by the rank that uses them */
    uint32_t *slot;           /* [used] index in `in` of the value */
    double *out, *in;         /* [sent], [got] messages of _forward, by rank; _reverse sends `in` and receives `out` */
    size_t self_out, self_in; /* indices in out and in where the values from this rank to itself begin */
    size_t self;              /* number of these values */
    MPI_Request *request;     /* [2][requests] persistent requests of _forward and of _reverse */
    int requests;
};

/* ---- ids to numbers ---- */

/* A hash table of ids with open addressing, at most half full. */
struct id_table {
    uint64_t *id;
    uint32_t *number; /* UINT32_MAX: free */
    size_t mask;
};

static int open_table(struct id_table *table, size_t count) {
    size_t size = 2;
    while (size < 2 * count) size *= 2;
    *table = (struct id_table){malloc(size * sizeof *table->id), malloc(size * sizeof *table->number), size - 1};
    if (!table->id || !table->number) return FIBRAD_E_MEMORY;
    memset(table->number, 0xff, size * sizeof *table->number);
    return FIBRAD_OK;
}

static void close_table(struct id_table *table) {
    free(table->id);
    free(table->number);
}

/* The place of the number of an id in the table. The high bits of the hash choose the place, since the low bits choose
 * the rank of the directory. */
static uint32_t *find_id(const struct id_table *table, uint64_t id) {
    size_t k = fibrad_hash_id(id) >> 20 & table->mask;
    while (table->number[k] != UINT32_MAX && table->id[k] != id) k = (k + 1) & table->mask;
    table->id[k] = id;
    return &table->number[k];
}

/* ---- making a link ---- */

/* An entry of the directory: the rank that owns an id, and the index of the id there. */
struct owner {
    uint64_t id;
    uint32_t rank, index;
};

enum { DIRECTORY, QUESTIONS, REPLIES, WANTED, ARRIVALS };

/* The making of a link. */
struct making {
    MPI_Comm comm;
    int rank, ranks;
    int *count, *got;   /* [ranks] numbers of elements sent and received; got is scratch before an exchange */
    int *answers;       /* [ranks] numbers of replies from each rank of the directory */
    const uint64_t *id; /* [own + used] */
    uint64_t *asked;    /* [unique] different ids used, in the order of the ranks of their directory */
    size_t unique;
    uint32_t *number;    /* [unique] first the index of each id in `asked`, later the index of its value in `in` */
    struct owner *owner; /* [own] entries for the directory, in the order of its ranks */
    struct id_table table;
    fibrad_block *arrived; /* [ARRIVALS] elements received */
    uint64_t culprit;      /* least id at fault on this rank */
    bool fault;            /* an id is at fault */
};

static void blame(struct making *m, uint64_t id) {
    if (!m->fault || id < m->culprit) m->culprit = id;
    m->fault = true;
}

static int directory_of(const struct making *m, uint64_t id) { return (int)(fibrad_hash_id(id) % (uint64_t)m->ranks); }

/* Enters the own ids into the directory. */
static int enter_owned(struct making *m, size_t own) {
    memset(m->count, 0, (size_t)m->ranks * sizeof *m->count);
    for (size_t i = 0; i < own; ++i) m->count[directory_of(m, m->id[i])]++;
    fibrad_count_starts(m->count, m->ranks, m->got);
    for (size_t i = 0; i < own; ++i)
        m->owner[m->got[directory_of(m, m->id[i])]++] = (struct owner){m->id[i], (uint32_t)m->rank, (uint32_t)i};
    return fibrad_deal(m->comm, FIBRAD_OK, m->owner, m->count, sizeof *m->owner, &m->arrived[DIRECTORY], 0, m->got);
}

/* Asks the directory for the owners of the used ids, each id once. slot [used]: index of the question. */
static int ask_directory(struct making *m, size_t own, size_t used, uint32_t *slot) {
    struct id_table seen;
    int status = open_table(&seen, used);
    memset(m->count, 0, (size_t)m->ranks * sizeof *m->count);
    for (size_t k = 0; k < used && !status; ++k) {
        uint32_t *number = find_id(&seen, m->id[own + k]);
        if (*number == UINT32_MAX) {
            *number = (uint32_t)m->unique++;
            m->count[directory_of(m, m->id[own + k])]++;
        }
        slot[k] = *number;
    }
    fibrad_count_starts(m->count, m->ranks, m->got);
    for (size_t k = 0, next = 0; k < used && !status; ++k)
        if (slot[k] == next) { /* the first use of this id */
            const int at = m->got[directory_of(m, m->id[own + k])]++;
            m->asked[at] = m->id[own + k];
            m->number[next++] = (uint32_t)at;
        }
    for (size_t k = 0; k < used && !status; ++k) slot[k] = m->number[slot[k]];
    close_table(&seen);
    return fibrad_deal(m->comm, status, m->asked, m->count, sizeof *m->asked, &m->arrived[QUESTIONS], 0, m->got);
}

/* Answers the questions of all ranks. Each rank gets its replies in the order of its questions. */
static int answer(struct making *m, size_t entries) {
    const struct owner *entry = m->arrived[DIRECTORY].at;
    const uint64_t *question = m->arrived[QUESTIONS].at;
    const size_t questions = fibrad_count_sum(m->got, m->ranks);
    struct owner *reply = malloc((questions + 1) * sizeof *reply);
    int status = open_table(&m->table, entries);
    if (!reply) status = FIBRAD_E_MEMORY;
    for (size_t k = 0; k < entries && !status; ++k) {
        uint32_t *number = find_id(&m->table, entry[k].id);
        if (*number != UINT32_MAX) blame(m, entry[k].id);
        *number = (uint32_t)k;
    }
    for (size_t k = 0; k < questions && !status; ++k) {
        const uint32_t number = *find_id(&m->table, question[k]);
        if (number == UINT32_MAX) blame(m, question[k]);
        reply[k] = number == UINT32_MAX ? (struct owner){question[k], UINT32_MAX, 0} : entry[number];
    }
    status = fibrad_deal(m->comm, status, reply, m->got, sizeof *reply, &m->arrived[REPLIES], 0, m->answers);
    free(reply);
    return status;
}

/* Finds the least id at fault on all ranks. */
static int agree_on_fault(struct making *m, uint64_t *culprit) {
    uint64_t least[2] = {!m->fault, m->fault ? m->culprit : UINT64_MAX};
    MPI_Allreduce(MPI_IN_PLACE, least, 2, MPI_UINT64_T, MPI_MIN, m->comm);
    if (least[0]) return FIBRAD_OK;
    if (culprit) *culprit = least[1];
    return FIBRAD_E_ARGUMENT;
}

/* Tells the owners which values this rank uses. Slots become indices in the order of owners. */
static int ask_owners(struct making *m, fibrad_link *link) {
    const struct owner *reply = m->arrived[REPLIES].at;
    uint32_t *wanted = malloc((m->unique + 1) * sizeof *wanted);
    memset(m->count, 0, (size_t)m->ranks * sizeof *m->count);
    for (size_t u = 0; u < m->unique; ++u) m->count[reply[u].rank]++;
    fibrad_count_starts(m->count, m->ranks, m->got);
    for (size_t u = 0; u < m->unique && wanted; ++u) {
        const int at = m->got[reply[u].rank]++;
        wanted[at] = reply[u].index;
        m->number[u] = (uint32_t)at;
    }
    for (size_t k = 0; k < link->used; ++k) link->slot[k] = m->number[link->slot[k]];
    const int status = fibrad_deal(m->comm, wanted ? FIBRAD_OK : FIBRAD_E_MEMORY, wanted, m->count, sizeof *wanted,
                                   &m->arrived[WANTED], 0, m->got);
    free(wanted);
    return status;
}

/* Makes buffers and persistent requests. m->count: values from each rank; m->got: values to each rank. */
static int lay_out(struct making *m, fibrad_link *link) {
    int peers = 0;
    for (int q = 0; q < m->ranks; ++q) peers += q != m->rank ? (m->count[q] > 0) + (m->got[q] > 0) : 0;
    link->got = m->unique;
    link->sent = fibrad_count_sum(m->got, m->ranks);
    link->source = m->arrived[WANTED].at;
    m->arrived[WANTED].at = NULL;
    link->out = malloc((link->sent + 1) * sizeof *link->out);
    link->in = malloc((link->got + 1) * sizeof *link->in);
    link->request = malloc((2 * (size_t)peers + 1) * sizeof(MPI_Request));
    const int status = fibrad_agree(m->comm, link->out && link->in && link->request ? 0 : FIBRAD_E_MEMORY, NULL);
    if (status) return status;
    MPI_Request *forward = link->request, *reverse = link->request + peers;
    double *in = link->in, *out = link->out;
    link->requests = peers;
    for (int q = 0; q < m->ranks; in += m->count[q], out += m->got[q], ++q) {
        if (q == m->rank) {
            link->self = (size_t)m->count[q];
            link->self_in = (size_t)(in - link->in);
            link->self_out = (size_t)(out - link->out);
            continue;
        }
        if (m->count[q]) {
            MPI_Recv_init(in, m->count[q], MPI_DOUBLE, q, LINK_TAG, m->comm, forward++);
            MPI_Send_init(in, m->count[q], MPI_DOUBLE, q, LINK_TAG, m->comm, reverse++);
        }
        if (m->got[q]) {
            MPI_Send_init(out, m->got[q], MPI_DOUBLE, q, LINK_TAG, m->comm, forward++);
            MPI_Recv_init(out, m->got[q], MPI_DOUBLE, q, LINK_TAG, m->comm, reverse++);
        }
    }
    return FIBRAD_OK;
}

static int make_link(struct making *m, fibrad_link *link, uint64_t *culprit) {
    int status = enter_owned(m, link->own);
    const size_t entries = status ? 0 : fibrad_count_sum(m->got, m->ranks);
    if (!status) status = ask_directory(m, link->own, link->used, link->slot);
    if (!status) status = answer(m, entries);
    if (!status) status = agree_on_fault(m, culprit);
    if (!status) status = ask_owners(m, link);
    return status ? status : lay_out(m, link);
}

/* Allocates memory for own and used ids. Close it also after an error. Returns FIBRAD_OK or _E_MEMORY. */
static int open_making(struct making *m, size_t own, size_t used) {
    const size_t ranks = (size_t)m->ranks;
    m->count = malloc(ranks * sizeof *m->count);
    m->got = malloc(ranks * sizeof *m->got);
    m->answers = malloc(ranks * sizeof *m->answers);
    m->asked = malloc((used + 1) * sizeof *m->asked);
    m->number = malloc((used + 1) * sizeof *m->number);
    m->owner = malloc((own + 1) * sizeof *m->owner);
    return m->count && m->got && m->answers && m->asked && m->number && m->owner ? FIBRAD_OK : FIBRAD_E_MEMORY;
}

static void close_making(struct making *m) {
    free(m->count);
    free(m->got);
    free(m->answers);
    free(m->asked);
    free(m->number);
    free(m->owner);
    close_table(&m->table);
    for (int k = 0; k < ARRIVALS; ++k) fibrad_block_free(&m->arrived[k]);
}

/* Makes a link without buffers. NULL: there is not enough memory. */
static fibrad_link *open_link(size_t own, size_t used) {
    fibrad_link *link = calloc(1, sizeof *link);
    if (!link) return NULL;
    link->own = own;
    link->used = used;
    link->slot = malloc((used + 1) * sizeof *link->slot);
    if (link->slot) return link;
    free(link);
    return NULL;
}

int fibrad_link_new(fibrad_link **link, MPI_Comm comm, const uint64_t *id, size_t own, size_t all, uint64_t *culprit) {
    fibrad_block arrived[ARRIVALS] = {{0}};
    struct making m = {.comm = comm, .id = id, .arrived = arrived};
    MPI_Comm_rank(comm, &m.rank);
    MPI_Comm_size(comm, &m.ranks);
    int status = link && all >= own && (id || all == 0) ? FIBRAD_OK : FIBRAD_E_ARGUMENT;
    if (!status && all > INT_MAX) status = FIBRAD_E_MEMORY; /* MPI counts by int */
    fibrad_link *made = status ? NULL : open_link(own, all - own);
    if (!status) status = made ? open_making(&m, own, all - own) : FIBRAD_E_MEMORY;
    status = fibrad_agree(comm, status, NULL);
    if (!status) status = make_link(&m, made, culprit);
    close_making(&m);
    if (status) {
        fibrad_link_free(made);
        made = NULL;
    }
    if (link) *link = made;
    return status;
}

int fibrad_link_known(MPI_Comm comm, const uint64_t *id, size_t own, size_t all, unsigned char *known) {
    fibrad_block arrived[ARRIVALS] = {{0}};
    struct making m = {.comm = comm, .id = id, .arrived = arrived};
    MPI_Comm_rank(comm, &m.rank);
    MPI_Comm_size(comm, &m.ranks);
    uint32_t *slot = malloc((all - own + 1) * sizeof *slot);
    int status = slot && all <= INT_MAX ? open_making(&m, own, all - own) : FIBRAD_E_MEMORY;
    status = fibrad_agree(comm, status, NULL);
    if (!status) status = enter_owned(&m, own);
    const size_t entries = status ? 0 : fibrad_count_sum(m.got, m.ranks);
    if (!status) status = ask_directory(&m, own, all - own, slot);
    if (!status) status = answer(&m, entries);
    const struct owner *reply = arrived[REPLIES].at;
    for (size_t k = 0; k < all - own && !status; ++k) known[k] = reply[slot[k]].rank != UINT32_MAX;
    close_making(&m);
    free(slot);
    return status;
}

/* ---- using a link ---- */

static void exchange_messages(const fibrad_link *link, MPI_Request *request) {
    MPI_Startall(link->requests, request);
    MPI_Waitall(link->requests, request, MPI_STATUSES_IGNORE);
}

void fibrad_link_forward(fibrad_link *link, double *value, int width) {
    const size_t w = (size_t)width;
    double *used = value + link->own * w;
    for (size_t c = 0; c < w; ++c) {
        for (size_t k = 0; k < link->sent; ++k) link->out[k] = value[link->source[k] * w + c];
        memcpy(link->in + link->self_in, link->out + link->self_out, link->self * sizeof *link->in);
        exchange_messages(link, link->request);
        for (size_t k = 0; k < link->used; ++k) used[k * w + c] = link->in[link->slot[k]];
    }
}

void fibrad_link_reverse(fibrad_link *link, double *value, int width) {
    const size_t w = (size_t)width;
    double *used = value + link->own * w;
    for (size_t c = 0; c < w; ++c) {
        memset(link->in, 0, link->got * sizeof *link->in);
        for (size_t k = 0; k < link->used; ++k) {
            link->in[link->slot[k]] += used[k * w + c];
            used[k * w + c] = 0;
        }
        memcpy(link->out + link->self_out, link->in + link->self_in, link->self * sizeof *link->in);
        exchange_messages(link, link->request + link->requests);
        for (size_t k = 0; k < link->sent; ++k) value[link->source[k] * w + c] += link->out[k];
    }
}

void fibrad_link_free(fibrad_link *link) {
    if (!link) return;
    for (int k = 0; k < 2 * link->requests; ++k) MPI_Request_free(&link->request[k]);
    free(link->request);
    free(link->source);
    free(link->slot);
    free(link->out);
    free(link->in);
    free(link);
}
