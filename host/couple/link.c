/* link.c - values of particles that other ranks own. SPDX-License-Identifier: MIT
 *
 * A link is made from the places of values: who owns them, and where. Callers may know these places. If not, a
 * directory does. It is divided over the ranks; the id alone tells which rank has its entry. Owners enter their ids.
 * Users ask the directory for the place of each id, and then tell the owners. From then on only ranks that share
 * particles exchange messages, with one value per particle, between buffers that stay in place. */
#include <limits.h>
#include <string.h>

#include "couple/insitu.h"

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

/* ---- the directory ---- */

/* An entry of the directory: an id, and where its owner has it. */
struct entry {
    uint64_t id;
    fibrad_place place;
};

enum { ENTRIES, QUESTIONS, REPLIES, ARRIVALS };

/* A directory, and what a rank sends to it and gets from it. */
struct directory {
    MPI_Comm comm;
    int rank, ranks;
    const uint64_t *id; /* [own + used] */
    size_t own, used;
    int *count, *got, *answers; /* [ranks] numbers of elements sent and received, and of replies received */
    unsigned char *here;        /* [own + used] 1: this rank needs no directory for this id */
    uint32_t *at;               /* [own + used] place of what is sent for each other id */
    struct entry *entry;        /* [own] in the order of ranks */
    uint64_t *question;         /* [used] in the order of ranks */
    fibrad_place *reply;        /* to the questions of all ranks */
    struct id_table table;      /* of the entries that arrived */
    fibrad_block *arrived;      /* [ARRIVALS] elements received */
    uint64_t fault[2];          /* 0, or 1: no id is at fault; the least id at fault */
};

static void blame(struct directory *d, uint64_t id) {
    d->fault[0] = 0;
    if (id < d->fault[1]) d->fault[1] = id;
}

/* Finds the used ids that this rank owns. If no id is owned or used twice, no other rank need know of them. */
static int find_here(struct directory *d, fibrad_place *place) {
    struct id_table mine;
    const int status = open_table(&mine, d->own);
    for (size_t i = 0; i < d->own && !status; ++i) *find_id(&mine, d->id[i]) = (uint32_t)i;
    for (size_t k = 0; k < d->used && !status; ++k) {
        const uint32_t i = *find_id(&mine, d->id[d->own + k]);
        if (i == UINT32_MAX) continue;
        place[k] = (fibrad_place){(uint32_t)d->rank, i};
        d->here[i] = d->here[d->own + k] = 1;
    }
    close_table(&mine);
    return status;
}

/* Orders ids [from, to) by the ranks that have their entries: d->count of them for each rank, id k at the place at[k].
 */
static void order_by_rank(struct directory *d, size_t from, size_t to) {
    memset(d->count, 0, (size_t)d->ranks * sizeof *d->count);
    for (size_t k = from; k < to; ++k)
        if (!d->here[k]) d->count[fibrad_hash_id(d->id[k]) % (uint64_t)d->ranks]++;
    fibrad_count_starts(d->count, d->ranks, d->got);
    for (size_t k = from; k < to; ++k)
        if (!d->here[k]) d->at[k] = (uint32_t)d->got[fibrad_hash_id(d->id[k]) % (uint64_t)d->ranks]++;
}

static int enter_owned(struct directory *d, int status) {
    order_by_rank(d, 0, d->own);
    for (size_t i = 0; i < d->own; ++i)
        if (!d->here[i]) d->entry[d->at[i]] = (struct entry){d->id[i], {(uint32_t)d->rank, (uint32_t)i}};
    return fibrad_deal(d->comm, status, d->entry, d->count, sizeof *d->entry, &d->arrived[ENTRIES], 0, d->got);
}

/* Makes a table of the entries that arrived. */
static int list_entries(struct directory *d) {
    const struct entry *entry = d->arrived[ENTRIES].at;
    const size_t entries = fibrad_count_sum(d->got, d->ranks);
    const int status = open_table(&d->table, entries);
    for (size_t k = 0; k < entries && !status; ++k) {
        uint32_t *number = find_id(&d->table, entry[k].id);
        if (*number != UINT32_MAX) blame(d, entry[k].id);
        *number = (uint32_t)k;
    }
    return status;
}

static int ask(struct directory *d, int status) {
    order_by_rank(d, d->own, d->own + d->used);
    for (size_t k = d->own; k < d->own + d->used; ++k)
        if (!d->here[k]) d->question[d->at[k]] = d->id[k];
    return fibrad_deal(d->comm, status, d->question, d->count, sizeof *d->question, &d->arrived[QUESTIONS], 0, d->got);
}

/* Answers the questions of all ranks. Each rank gets its replies in the order of its questions. */
static int answer(struct directory *d) {
    const struct entry *entry = d->arrived[ENTRIES].at;
    const uint64_t *question = d->arrived[QUESTIONS].at;
    const size_t questions = fibrad_count_sum(d->got, d->ranks);
    d->reply = malloc((questions + 1) * sizeof *d->reply);
    for (size_t k = 0; k < questions && d->reply; ++k) {
        const uint32_t number = *find_id(&d->table, question[k]);
        if (number == UINT32_MAX) blame(d, question[k]);
        d->reply[k] = number == UINT32_MAX ? (fibrad_place){UINT32_MAX, 0} : entry[number].place;
    }
    return fibrad_deal(d->comm, d->reply ? FIBRAD_OK : FIBRAD_E_MEMORY, d->reply, d->got, sizeof *d->reply,
                       &d->arrived[REPLIES], 0, d->answers);
}

static int begin_directory(struct directory *d) {
    const size_t all = d->own + d->used;
    if (all > INT_MAX) return FIBRAD_E_MEMORY; /* MPI counts by int */
    MPI_Comm_rank(d->comm, &d->rank);
    MPI_Comm_size(d->comm, &d->ranks);
    d->count = malloc(3 * (size_t)d->ranks * sizeof *d->count);
    d->here = calloc(all + 1, sizeof *d->here);
    d->at = malloc((all + 1) * sizeof *d->at);
    d->entry = malloc((d->own + 1) * sizeof *d->entry);
    d->question = malloc((d->used + 1) * sizeof *d->question);
    if (!d->count || !d->here || !d->at || !d->entry || !d->question) return FIBRAD_E_MEMORY;
    d->got = d->count + d->ranks, d->answers = d->got + d->ranks;
    return FIBRAD_OK;
}

static void end_directory(struct directory *d) {
    free(d->count);
    free(d->here);
    free(d->at);
    free(d->entry);
    free(d->question);
    free(d->reply);
    close_table(&d->table);
    for (int k = 0; k < ARRIVALS; ++k) fibrad_block_free(&d->arrived[k]);
}

/* Finds the least id at fault on all ranks. */
static int agree_on_fault(struct directory *d, uint64_t *culprit) {
    MPI_Allreduce(MPI_IN_PLACE, d->fault, 2, MPI_UINT64_T, MPI_MIN, d->comm);
    if (d->fault[0]) return FIBRAD_OK;
    if (culprit) *culprit = d->fault[1];
    return FIBRAD_E_ARGUMENT;
}

/* Collective. Finds who owns the ids that this rank uses: place[used]; the rank UINT32_MAX: nobody. once: no id is
 * owned or used twice. Errors, on all ranks: FIBRAD_E_ARGUMENT, after all places are found: nobody owns an id, or two
 * ranks. */
static int find_owners(MPI_Comm comm, const uint64_t *id, size_t own, size_t used, bool once, fibrad_place *place,
                       uint64_t *culprit) {
    fibrad_block arrived[ARRIVALS] = {{0}};
    struct directory d = {
        .comm = comm, .id = id, .own = own, .used = used, .arrived = arrived, .fault = {1, UINT64_MAX}};
    int status = fibrad_agree(comm, begin_directory(&d), NULL);
    if (!status) status = enter_owned(&d, once ? find_here(&d, place) : FIBRAD_OK);
    if (!status) status = ask(&d, list_entries(&d));
    if (!status) status = answer(&d);
    const fibrad_place *reply = arrived[REPLIES].at;
    for (size_t k = 0; k < used && !status; ++k)
        if (!d.here[own + k]) place[k] = reply[d.at[own + k]];
    if (!status) status = agree_on_fault(&d, culprit);
    end_directory(&d);
    return status;
}

int fibrad_link_known(MPI_Comm comm, const uint64_t *id, size_t own, size_t all, unsigned char *known) {
    fibrad_place *place = malloc((all - own + 1) * sizeof *place);
    int status = fibrad_agree(comm, place ? FIBRAD_OK : FIBRAD_E_MEMORY, NULL);
    if (!status) status = find_owners(comm, id, own, all - own, false, place, NULL);
    if (status == FIBRAD_E_ARGUMENT) status = FIBRAD_OK;
    for (size_t k = 0; k < all - own && !status; ++k) known[k] = place[k].rank != UINT32_MAX;
    free(place);
    return status;
}

/* ---- making a link ---- */

/* The making of a link. */
struct making {
    MPI_Comm comm;
    int rank, ranks;
    int *count, *got; /* [ranks] numbers of values that come from and go to each rank; got is scratch at first */
    uint32_t *number; /* [used] index in `in` of each different value */
    uint32_t *wanted; /* [used] index of each different value at its owner, in the order of the owners */
    size_t unique;    /* number of different values */
};

/* Gives each different place one value in `in`, in the order of owners. slot: its index, for each use. */
static int list_wanted(struct making *m, const fibrad_place *place, size_t used, uint32_t *slot) {
    struct id_table seen;
    const int status = open_table(&seen, used);
    memset(m->count, 0, (size_t)m->ranks * sizeof *m->count);
    for (size_t k = 0; k < used && !status; ++k) {
        uint32_t *number = find_id(&seen, (uint64_t)place[k].rank << 32 | place[k].index);
        if (*number == UINT32_MAX) *number = (uint32_t)m->unique++, m->count[place[k].rank]++;
        slot[k] = *number;
    }
    fibrad_count_starts(m->count, m->ranks, m->got);
    for (size_t k = 0, next = 0; k < used && !status; ++k)
        if (slot[k] == next) { /* the first use of this value */
            const int at = m->got[place[k].rank]++;
            m->wanted[at] = place[k].index;
            m->number[next++] = (uint32_t)at;
        }
    for (size_t k = 0; k < used && !status; ++k) slot[k] = m->number[slot[k]];
    close_table(&seen);
    return status;
}

/* Makes buffers and persistent requests. m->count: values from each rank; m->got: values to each rank. */
static int lay_out(struct making *m, fibrad_link *link) {
    int peers = 0;
    for (int q = 0; q < m->ranks; ++q) peers += q != m->rank ? (m->count[q] > 0) + (m->got[q] > 0) : 0;
    link->got = m->unique;
    link->sent = fibrad_count_sum(m->got, m->ranks);
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

int fibrad_link_to(fibrad_link **link, MPI_Comm comm, size_t own, const fibrad_place *place, size_t used) {
    struct making m = {.comm = comm};
    MPI_Comm_rank(comm, &m.rank);
    MPI_Comm_size(comm, &m.ranks);
    m.count = malloc(2 * (size_t)m.ranks * sizeof *m.count);
    m.number = malloc((2 * used + 1) * sizeof *m.number);
    fibrad_link *made = calloc(1, sizeof *made);
    if (made) made->own = own, made->used = used, made->slot = malloc((used + 1) * sizeof *made->slot);
    const bool fits = m.count && m.number && made && made->slot;
    int status = fibrad_agree(comm, fits ? FIBRAD_OK : FIBRAD_E_MEMORY, NULL);
    if (!status) {
        fibrad_block wanted = {0};
        m.got = m.count + m.ranks, m.wanted = m.number + used;
        status = list_wanted(&m, place, used, made->slot);
        status = fibrad_deal(comm, status, m.wanted, m.count, sizeof *m.wanted, &wanted, 0, m.got);
        made->source = wanted.at;
    }
    if (!status) status = lay_out(&m, made);
    free(m.count);
    free(m.number);
    if (status) fibrad_link_free(made);
    *link = status ? NULL : made;
    return status;
}

int fibrad_link_find(fibrad_link **link, MPI_Comm comm, const uint64_t *id, size_t own, size_t all, bool once,
                     uint64_t *culprit) {
    int status = link && all >= own && (id || all == 0) ? FIBRAD_OK : FIBRAD_E_ARGUMENT;
    if (link) *link = NULL;
    fibrad_place *place = status ? NULL : malloc((all - own + 1) * sizeof *place);
    if (!status && !place) status = FIBRAD_E_MEMORY;
    status = fibrad_agree(comm, status, NULL);
    if (!status) status = find_owners(comm, id, own, all - own, once, place, culprit);
    if (!status) status = fibrad_link_to(link, comm, own, place, all - own);
    free(place);
    return status;
}

int fibrad_link_new(fibrad_link **link, MPI_Comm comm, const uint64_t *id, size_t own, size_t all, uint64_t *culprit) {
    return fibrad_link_find(link, comm, id, own, all, false, culprit);
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
