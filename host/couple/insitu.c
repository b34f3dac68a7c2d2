/* insitu.c - rows of a bed whose particles are divided over ranks: keeps them, with facts and remarks.
 * SPDX-License-Identifier: MIT */
#include "couple/insitu.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

#define THREADS_MAX 1024

/* What a fibrad_accuracy stands for. alone: paths if rows do not know all sources, see source_paths.c */
static const struct {
    const char *name;
    uint32_t directions, paths, alone;
    double open; /* error of what meets no sphere, see fibrad_exchange_rule */
    double most; /* paths of all sources over those of all particles, at most */
} samples[] = {[FIBRAD_ACCURACY_NORMAL] = {"normal", 30, 24, 80, 0, 2},
               [FIBRAD_ACCURACY_LOW] = {"low", 16, 8, 34, 0, 2},
               [FIBRAD_ACCURACY_HIGH] = {"high", 144, 800, 1600, 7e-4, 10}};

int fibrad_accuracy_named(const char *name) {
    for (int k = FIBRAD_ACCURACY_NORMAL; k <= FIBRAD_ACCURACY_HIGH && name; ++k)
        if (!strcmp(samples[k].name, name)) return k;
    return -1;
}

static bool config_valid(const fibrad_insitu_config *c) {
    const bool directions =
        !c->directions || (c->directions >= FIBRAD_DIRECTIONS_MIN && c->directions <= FIBRAD_DIRECTIONS_MAX);
    return c->cutoff >= 0 && isfinite(c->cutoff) && directions && c->paths <= FIBRAD_PATHS_MAX && c->tolerance >= 0 &&
           isfinite(c->tolerance) && c->threads >= 0 && c->threads <= THREADS_MAX &&
           (c->strict == 0 || c->strict == 1) && c->accuracy >= FIBRAD_ACCURACY_NORMAL &&
           c->accuracy <= FIBRAD_ACCURACY_HIGH;
}

/* Replaces zeroes by the numbers for which they stand. */
static void complete_config(fibrad_insitu *s) {
    fibrad_insitu_config *c = &s->config;
    s->paths_alone = c->paths ? c->paths : samples[c->accuracy].alone;
    s->source_paths = samples[c->accuracy].most;
    s->open_error = c->directions ? 0 : samples[c->accuracy].open;
    if (!c->directions) c->directions = samples[c->accuracy].directions;
    if (!c->paths) c->paths = samples[c->accuracy].paths;
    if (!c->threads) c->threads = 1;
    s->gather = FIBRAD_GATHER_MOST;
}

static int open_set(fibrad_insitu_set *set, int threads) {
    set->rows = calloc((size_t)threads, sizeof *set->rows);
    for (int t = 0; t < threads && set->rows; ++t) set->rows[t].memory.resize = fibrad_heap_resize;
    return set->rows ? FIBRAD_OK : FIBRAD_E_MEMORY;
}

/* Frees blocks up to a NULL. */
static void free_blocks(fibrad_block *const *block) {
    for (; *block; ++block) fibrad_block_free(*block);
}

static void close_set(fibrad_insitu_set *set, int threads) {
    for (int t = 0; t < threads && set->rows; ++t) free(set->rows[t].memory.block);
    free(set->rows);
    fibrad_link_free(set->seen);
    fibrad_link_free(set->present);
    fibrad_block *const blocks[] = {&set->particle, &set->id,    &set->weight, &set->root, &set->unknown,
                                    &set->emission, &set->power, &set->now,    &set->made, NULL};
    free_blocks(blocks);
}

int fibrad_insitu_new(fibrad_insitu **insitu, MPI_Comm comm, const fibrad_insitu_config *config) {
    fibrad_insitu *s = calloc(1, sizeof *s);
    int status = s ? FIBRAD_OK : FIBRAD_E_MEMORY;
    if (s) {
        if (config) s->config = *config;
        if (!insitu || !config_valid(&s->config)) status = FIBRAD_E_ARGUMENT;
        if (!status) complete_config(s);
    }
    if (!status) status = open_set(&s->set, s->config.threads);
    if (!status) status = open_set(&s->next, s->config.threads);
    if (!status) status = fibrad_team_open(&s->team, &(fibrad_run){.threads = s->config.threads});
    status = fibrad_agree(comm, status, NULL);
    if (insitu) *insitu = status ? NULL : s;
    if (status && s) {
        if (s->set.rows) close_set(&s->set, s->config.threads);
        if (s->next.rows) close_set(&s->next, s->config.threads);
        fibrad_team_close(&s->team);
        free(s);
    }
    if (status) return status;
    MPI_Comm_dup(comm, &s->comm);
    MPI_Comm_rank(s->comm, &s->rank);
    MPI_Comm_size(s->comm, &s->ranks);
    return FIBRAD_OK;
}

void fibrad_insitu_free(fibrad_insitu *s) {
    if (!s) return;
    close_set(&s->set, s->config.threads);
    close_set(&s->next, s->config.threads);
    fibrad_team_close(&s->team);
    fibrad_block *const blocks[] = {&s->scene, &s->order, &s->emissivity, &s->clump, &s->mark,
                                    &s->known, &s->sent,  &s->solver,     &s->value, NULL};
    free_blocks(blocks);
    MPI_Comm_free(&s->comm);
    free(s);
}

const char *fibrad_insitu_message(const fibrad_insitu *s) { return s ? s->message : ""; }

const char *fibrad_insitu_remark(const fibrad_insitu *s, int kind) {
    return s && s->ready && kind >= 0 && kind < FIBRAD_REMARKS ? s->set.remark[kind].message : "";
}

static size_t set_bytes(const fibrad_insitu_set *set, int threads) {
    size_t sum =
        set->particle.size + set->id.size + set->weight.size + set->emission.size + set->power.size + set->root.size;
    for (int t = 0; t < threads; ++t) sum += set->rows[t].memory.size;
    return sum + set->made.size + set->now.size + set->unknown.size;
}

void fibrad_insitu_facts_get(const fibrad_insitu *s, fibrad_insitu_facts *facts) {
    if (!s || !facts) return;
    *facts = s->set.facts;
    facts->seconds_rows = s->seconds_rows;
    facts->seconds_powers = s->seconds_powers;
    facts->bytes = set_bytes(&s->set, s->config.threads) + set_bytes(&s->next, s->config.threads) + s->scene.size +
                   s->order.size + s->emissivity.size + s->clump.size + s->mark.size + s->known.size + s->sent.size +
                   s->solver.size + s->value.size;
    for (int t = 0; t < s->config.threads; ++t) facts->bytes += s->team.work[t].memory.size;
}

/* Writes the sentence on particles of one kind; "" if there are none. */
static void tell_remark(const fibrad_remark *remark, int kind, char *message) {
    static const char *const done[FIBRAD_REMARKS] = {"left out until back",
                                                     "smaller, so that no centre is inside another", "without a row"};
    message[0] = 0;
    if (remark->count)
        fibrad_refuse(message, 0, "%" PRIu64 " particle%s %s %s; %s", remark->count, remark->count > 1 ? "s" : "",
                      remark->count > 1 ? "are" : "is", done[kind], remark->message);
}

/* Sums the facts of the rows over all ranks. */
static void sum_facts(fibrad_insitu_build *b) {
    fibrad_insitu_set *to = b->to;
    const double *weight = to->weight.at;
    double *unknown = to->unknown.at;
    fibrad_row row;
    /* emission, beyond, squared errors, entries, rows of emissivity above 0, escaped; then by walls */
    double sum[6 + FIBRAD_WALLS_MAX] = {0}, *of_wall = sum + 6;
    for (int t = 0; t < b->s->config.threads; ++t) {
        for (size_t at = 0; fibrad_rows_read(&to->rows[t], &at, &row);) {
            sum[0] += weight[row.sphere];
            if (row.sphere < b->fresh) unknown[row.sphere] = row.beyond;
            sum[1] += weight[row.sphere] * unknown[row.sphere];
            sum[2] += row.error * row.error;
            sum[4] += weight[row.sphere] > 0;
            sum[5] += row.escaped;
            for (uint32_t k = 0; k < b->bed->walls; ++k)
                of_wall[k] += fibrad_row_weight(&row, weight[row.sphere]) * row.wall[k];
        }
        sum[3] += (double)to->rows[t].entries;
    }
    MPI_Allreduce(MPI_IN_PLACE, sum, 6 + FIBRAD_WALLS_MAX, MPI_DOUBLE, MPI_SUM, b->s->comm);
    for (uint32_t k = 0; k < b->bed->walls; ++k) {
        to->facts.wall[k] = of_wall[k] + to->wall_exchange.surroundings[k];
        for (uint32_t c = 0; c < b->bed->walls; ++c) to->facts.wall[k] += to->wall_exchange.wall[k][c];
    }
    to->facts.beyond = sum[0] > 0 ? sum[1] / sum[0] : 0;
    to->facts.error = sum[4] > 0 ? sqrt(sum[2] / sum[4]) : 0;
    to->facts.entries = (uint64_t)sum[3];
    to->escapes = sum[5] > 0;
    to->facts.halo = b->halo;
    to->facts.outside = b->remark[FIBRAD_REMARK_OUTSIDE].count;
    to->facts.overlapping = b->remark[FIBRAD_REMARK_OVERLAP].count;
    to->facts.behind = b->remark[FIBRAD_REMARK_BACK].count;
    for (int kind = 0; kind < FIBRAD_REMARKS; ++kind) tell_remark(&b->remark[kind], kind, to->remark[kind].message);
}

static int make_new_rows(fibrad_insitu *s, const fibrad_insitu_bed *bed, uint64_t step, bool follows) {
    if (!s) return FIBRAD_E_ARGUMENT;
    fibrad_insitu_build b = {.s = s, .to = &s->next, .bed = bed, .step = step};
    s->message[0] = 0;
    s->makings++;
    int status = fibrad_insitu_check(&b);
    const double begun = MPI_Wtime();
    if (!status) status = fibrad_insitu_measure(&b);
    b.to->changed = 0;
    if (!status && follows && s->ready && s->set.walls == bed->walls) status = fibrad_follow_changes(&b);
    if (b.follows) b.to->conducts |= s->set.conducts;
    if (!status) status = fibrad_insitu_gather(&b);
    if (b.follows) b.to->wall_exchange = s->set.wall_exchange;
    if (!status && !b.follows) status = fibrad_insitu_sources(&b);
    if (!status) status = fibrad_insitu_make(&b);
    fibrad_follow_free(&b.follow);
    if (status) {
        if (!s->message[0]) fibrad_refuse(s->message, status, "%s", fibrad_status_text(status));
        return status;
    }
    sum_facts(&b);
    b.to->walls = bed->walls;
    b.to->flows = 0;
    const fibrad_insitu_set made = s->next;
    s->next = s->set;
    s->set = made;
    s->ready = 1;
    s->seconds_rows += MPI_Wtime() - begun;
    return FIBRAD_OK;
}

int fibrad_insitu_rows(fibrad_insitu *s, const fibrad_insitu_bed *bed, uint64_t step) {
    return make_new_rows(s, bed, step, false);
}

int fibrad_insitu_follow(fibrad_insitu *s, const fibrad_insitu_bed *bed, uint64_t step) {
    return make_new_rows(s, bed, step, true);
}
