/* insitu_rows.c - makes the rows of the particles of a rank. SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <math.h>
#include <string.h>

#include "couple/insitu.h"

#define BACKS_MOST 0.1 /* part of all particles that may see what belongs to no wall */

int fibrad_insitu_scene(fibrad_insitu_build *b, const fibrad_particle *p, size_t n, uint64_t *id) {
    fibrad_insitu *s = b->s;
    const bool images = id && !b->whole, marked = id && b->to->facts.particles && (images || b->repeats);
    if (n > FIBRAD_SPHERES_MAX) return FIBRAD_E_MEMORY;
    fibrad_triangles triangles = b->bed->triangles ? *b->bed->triangles : (fibrad_triangles){0};
    memcpy(triangles.period, b->period, sizeof triangles.period);
    const size_t size = fibrad_scene_size((uint32_t)n, id != NULL) + fibrad_triangles_size(triangles.n, (uint32_t)n) +
                        fibrad_insitu_clumps(b, n);
    if (fibrad_block_fit(&s->scene, size, 1) || fibrad_block_fit(&s->clump, b->bed->clump ? n : 0, sizeof(uint32_t)) ||
        fibrad_block_fit(&s->emissivity, (b->to->conducts ? 3 : 1) * n, sizeof(double)))
        return FIBRAD_E_MEMORY;
    double *emissivity = s->emissivity.at;
    for (size_t i = 0; i < n; ++i) emissivity[i] = p[i].emissivity;
    for (size_t i = 0; i < n && b->to->conducts; ++i)
        emissivity[n + i] = p[i].conductivity, emissivity[2 * n + i] = p[i].node;
    fibrad_scene_config config = {0}; /* no rows: an empty scene */
    if (n || !id) {
        config = (fibrad_scene_config){.wall = b->bed->wall, .walls = b->bed->walls, .opening = b->opening};
        config.openings = b->openings, config.occupancy = marked ? &b->map : NULL, config.triangles = &triangles;
        if (!images) memcpy(config.period, b->period, sizeof config.period);
    }
    const fibrad_spheres spheres = fibrad_particle_spheres(p, n, id, b->bed->clump ? s->clump.at : NULL);
    fibrad_fault fault;
    const int status = fibrad_scene_init(&b->scene, s->scene.at, s->scene.size, &config, &spheres, &fault);
    return status && id ? fibrad_insitu_fault(b, status, id, n, fault) : status;
}

fibrad_exchange_rule fibrad_insitu_rule(const fibrad_insitu_build *b, size_t n) {
    const double *emissivity = b->s->emissivity.at;
    return (fibrad_exchange_rule){.emissivity = emissivity,
                                  .conductivity = b->to->conducts ? emissivity + n : NULL,
                                  .node_emissivity = b->to->conducts ? emissivity + 2 * n : NULL,
                                  .wall_emissivity = b->bed->wall_emissivity,
                                  .directions = b->s->config.directions,
                                  .paths = b->s->config.paths,
                                  .open_error = b->s->open_error,
                                  .seed = b->s->config.seed + b->step * 0x9e3779b97f4a7c15u,
                                  .tolerance = b->s->config.tolerance};
}

/* Says why the row of a particle could not be computed. */
static int name_row_fault(const fibrad_insitu_build *b, int status, uint64_t id, const fibrad_work *work,
                          char *message) {
    const fibrad_triangles *t = b->bed->triangles;
    if (status != FIBRAD_E_BACK || !t || work->triangle >= t->n)
        return fibrad_refuse(message, status, "particle %" PRIu64 ": %s", id, fibrad_status_text(status));
    const uint32_t front = t->front[work->triangle], back = t->back ? t->back[work->triangle] : FIBRAD_NO_WALL;
    const uint32_t wall = front == FIBRAD_NO_WALL ? back : front;
    if (wall == FIBRAD_NO_WALL)
        return fibrad_refuse(message, status,
                             "particle %" PRIu64 " sees triangle %" PRIu32 ", and no side of it belongs to a wall", id,
                             work->triangle);
    return fibrad_refuse(message, status,
                         "particle %" PRIu64 " sees the back of wall %" PRIu32 ", at triangle %" PRIu32 "; this side "
                         "belongs to no wall",
                         id, wall + 1, work->triangle);
}

/* Deals with a row that could not be computed. If its particle sees what belongs to no wall, the row becomes an empty
 * one, all of it beyond. */
static int skip_row(fibrad_insitu_build *b, int status, uint32_t i, const fibrad_work *work, fibrad_rows *rows) {
    static const double none[FIBRAD_WALLS_MAX];
    const uint64_t id = ((uint64_t *)b->to->id.at)[i];
    char message[FIBRAD_MESSAGE];
    if (name_row_fault(b, status, id, work, message) != FIBRAD_E_BACK || b->s->config.strict)
        return b->s->message[0] ? status : fibrad_refuse(b->s->message, status, "%s", message);
    fibrad_remark_add(&b->remark[FIBRAD_REMARK_BACK], id, message);
    const fibrad_row row = {.sphere = i, .wall = (double *)none, .beyond = 1};
    return fibrad_rows_add(rows, &row, b->bed->walls);
}

/* Lists the particles of this rank in the order of the cells. */
static int list_own(fibrad_insitu_build *b) {
    const size_t n = b->own + b->halo;
    if (fibrad_block_fit(&b->s->order, n, sizeof(uint32_t))) return FIBRAD_E_MEMORY;
    uint32_t *order = b->s->order.at, count = 0;
    for (uint32_t k = 0; k < n; ++k) {
        const uint32_t i = fibrad_scene_sphere(b->scene, k);
        if (i < b->fresh) order[count++] = i;
    }
    return FIBRAD_OK;
}

/* Tells a row what paths from walls and surroundings have found about its particle. */
static void know_sources(const fibrad_insitu_build *b, uint32_t i, fibrad_exchange_rule *rule) {
    const fibrad_particle *p = (const fibrad_particle *)b->to->particle.at + i;
    rule->known = (const double *)b->s->known.at + (size_t)i * (b->bed->walls + 1);
    rule->known_paths = b->density * fibrad_particle_weight(p);
}

/* The making of all rows. */
struct row_making {
    fibrad_insitu_build *b;
    fibrad_exchange_rule rule;
};

/* Computes the rows of one of equal parts of the list. */
static int compute_part(void *making, int thread, uint32_t part) {
    const struct row_making *m = making;
    fibrad_insitu_build *b = m->b;
    const uint32_t *order = b->s->order.at;
    const size_t parts = (size_t)b->s->config.threads, end = b->fresh * (part + 1) / parts;
    int status = FIBRAD_OK;
    for (size_t k = b->fresh * part / parts; k < end && !status; ++k) {
        fibrad_row row = {.rows = &b->to->rows[part]};
        fibrad_exchange_rule rule =
            m->rule; /* each row has its own directions, so that their errors average out in powers of walls */
        rule.seed += ((uint64_t *)b->to->id.at)[order[k]] * 0xd1342543de82ef95u;
        if (b->knows) know_sources(b, order[k], &rule);
        status = fibrad_exchange_row(b->scene, &b->s->team.work[thread], order[k], &rule, &row, NULL);
        if (!status) continue;
#pragma omp critical
        status = skip_row(b, status, order[k], &b->s->team.work[thread], &b->to->rows[part]);
    }
    return status;
}

/* Computes all rows. The collections of rows one after the other have the order of the list, whatever their number. */
static int compute_rows(fibrad_insitu_build *b) {
    fibrad_insitu *s = b->s;
    struct row_making making = {b, fibrad_insitu_rule(b, b->own + b->halo)};
    making.rule.cutoff = b->cutoff;
    if (!b->knows_all) making.rule.paths = s->paths_alone;
    for (int t = 0; t < s->config.threads; ++t) fibrad_rows_clear(&b->to->rows[t]);
    return fibrad_team_run(&s->team, NULL, (uint32_t)s->config.threads, 1, compute_part, &making, NULL);
}

/* Numbers the columns of new rows: those with new rows, what is kept of the old columns, and what else is seen. */
static int number_columns(fibrad_insitu_build *b) {
    fibrad_insitu_set *to = b->to;
    const size_t n = b->own + b->halo, kept = b->follow.kept + b->follow.kept_seen;
    const int threads = b->s->config.threads;
    fibrad_row row;
    if (fibrad_block_fit(&b->s->order, n, sizeof(uint32_t)) || fibrad_block_fit(&to->id, n + kept, sizeof(uint64_t)))
        return FIBRAD_E_MEMORY;
    uint32_t *number = b->s->order.at;
    uint64_t *id = to->id.at;
    memset(number, 0, n * sizeof *number);
    for (int t = 0; t < threads; ++t)
        for (size_t at = 0; fibrad_rows_read(&to->rows[t], &at, &row);)
            for (uint32_t k = 0; k < row.length; ++k) number[row.col[k]] = 1;
    memmove(id + b->fresh + kept, id + b->fresh, (n - b->fresh) * sizeof *id);
    const uint64_t *seen = id + kept;
    size_t columns = b->fresh;
    const uint64_t *old = b->s->set.id.at;
    for (size_t c = 0; b->follows && c < b->s->set.columns; ++c)
        if (b->follow.there[c]) id[columns++] = old[c];
    for (size_t i = 0; i < n; ++i) {
        if (i >= b->fresh && !number[i]) continue;
        number[i] = (uint32_t)(i < b->fresh ? i : columns);
        if (i >= b->fresh) id[columns++] = seen[i];
    }
    to->columns = columns;
    for (int t = 0; t < threads; ++t)
        for (size_t at = 0; fibrad_rows_read(&to->rows[t], &at, &row);)
            for (uint32_t k = 0; k < row.length; ++k) row.col[k] = number[row.col[k]];
    return FIBRAD_OK;
}

/* Lists the particles that are at home here: those with new rows, then those whose old rows are kept. */
static int list_home(fibrad_insitu_build *b) {
    fibrad_insitu_set *to = b->to;
    const fibrad_insitu_set *set = &b->s->set;
    to->own = b->fresh + b->follow.kept;
    if (fibrad_block_fit(&to->particle, to->own, sizeof(fibrad_particle)) ||
        fibrad_block_fit(&to->weight, to->columns, sizeof(double)) ||
        fibrad_block_fit(&to->root, to->own, sizeof(double)) ||
        fibrad_block_fit(&to->unknown, to->own, sizeof(double)) ||
        fibrad_block_fit(&to->made, to->columns, sizeof(double)) ||
        fibrad_block_fit(&b->s->solver, to->conducts ? 4 * to->own : 0, sizeof(double)) ||
        fibrad_block_fit(&to->emission, to->columns, sizeof(double)) ||
        fibrad_block_fit(&to->power, to->columns, sizeof(double)) ||
        fibrad_block_fit(&b->s->sent, b->halo, sizeof(fibrad_place)) ||
        fibrad_block_fit(&b->s->value, b->bed->n + to->own, sizeof(double)))
        return FIBRAD_E_MEMORY;
    fibrad_particle *p = to->particle.at;
    const fibrad_particle *old = set->particle.at;
    double *unknown = to->unknown.at, *made = to->made.at;
    const double *before = set->unknown.at, *made_before = set->made.at;
    size_t own = b->fresh;
    for (size_t c = 0; c < to->columns; ++c) made[c] = (double)b->s->makings;
    for (size_t c = 0; b->follows && c < set->own; ++c)
        if (b->follow.there[c]) unknown[own] = before[c], made[own] = made_before[c], p[own++] = old[c];
    const uint32_t *number = b->s->order.at; /* of columns; 0: not seen */
    fibrad_place *place = b->s->sent.at;     /* of particles seen, for link_seen */
    for (size_t i = b->own; i < b->own + b->halo && !b->follows; ++i)
        if (number[i]) place[number[i] - to->own] = p[i].owner;
    double *weight = to->weight.at;
    memset(weight, 0, to->columns * sizeof *weight);
    for (size_t i = 0; i < to->own; ++i) weight[i] = fibrad_particle_weight(&p[i]);
    return FIBRAD_OK;
}

/* Links present owners to home ranks. Refuses ids that occur twice. Those of the rows in use do not. */
static int link_present(fibrad_insitu_build *b) {
    fibrad_insitu_set *to = b->to;
    const fibrad_particle *particle = to->particle.at;
    const size_t n = b->bed->n, all = n + to->own;
    uint64_t culprit, sum[3] = {n, fibrad_hash_ids(b->bed->id, n), to->own};
    int status = fibrad_block_fit(&to->now, all, sizeof(uint64_t));
    status = fibrad_agree(b->s->comm, status, b->s->message);
    if (status) return status;
    MPI_Allreduce(MPI_IN_PLACE, sum, 3, MPI_UINT64_T, MPI_SUM, b->s->comm);
    to->all = sum[0], to->hash = sum[1], to->facts.particles = sum[2];
    uint64_t *id = to->now.at;
    if (n) memcpy(id, b->bed->id, n * sizeof *id);
    for (size_t i = 0; i < to->own; ++i) id[n + i] = particle[i].id;
    to->now_n = n;
    fibrad_link_free(to->present);
    const fibrad_insitu_set *set = &b->s->set;
    const bool known = b->s->ready && set->all == to->all && set->hash == to->hash;
    status = fibrad_link_find(&to->present, b->s->comm, id, n, all, known, &culprit);
    if (status == FIBRAD_E_ARGUMENT) fibrad_refuse_particle(b->s->message, culprit, "this id occurs twice");
    return status;
}

/* Links home particles with columns. Particles of the halo know their homes, unless old rows are kept. */
static int link_seen(fibrad_insitu_build *b) {
    fibrad_insitu_set *to = b->to;
    fibrad_link_free(to->seen);
    if (!b->follows) return fibrad_link_to(&to->seen, b->s->comm, to->own, b->s->sent.at, to->columns - to->own);
    const int status = fibrad_link_new(&to->seen, b->s->comm, to->id.at, to->own, to->columns, NULL);
    if (!status) fibrad_link_forward(to->seen, to->made.at, 1);
    return status;
}

static int make_rows(fibrad_insitu_build *b) {
    const size_t n = b->own + b->halo;
    int status = fibrad_block_fit(&b->to->id, n, sizeof(uint64_t));
    if (!status) status = fibrad_insitu_scene(b, b->to->particle.at, n, b->to->id.at);
    fibrad_particle *p = b->to->particle.at;
    for (uint32_t i = 0; i < b->fresh && !status; ++i)
        p[i].exposed = p[i].clump ? fibrad_scene_exposed_area(b->scene, i) : 0;
    if (!status) status = list_own(b);
    if (!status) status = compute_rows(b);
    if (!status) status = number_columns(b);
    if (!status && b->follows) status = fibrad_follow_keep(&b->follow, b->s, b->to, b->fresh);
    if (!status) status = list_home(b);
    return fibrad_agree(b->s->comm, status, b->s->message);
}

/* Agrees on the particles without rows, and refuses too many of them. */
static int check_backs(fibrad_insitu_build *b) {
    fibrad_remark *remark = &b->remark[FIBRAD_REMARK_BACK];
    fibrad_remark_agree(b->s->comm, remark);
    if ((double)remark->count <= BACKS_MOST * (double)b->to->facts.particles) return FIBRAD_OK;
    return fibrad_refuse(b->s->message, FIBRAD_E_BACK, "%s", remark->message);
}

/* Finds what stands between nodes and particles that conduct. A row says what its particle emits, and the other rows
 * say the same a second time. The mean of both takes the place of A n, so that the system for powers is positive in
 * spite of the noise of the rows. */
static void find_resistances(fibrad_insitu_build *b) {
    fibrad_insitu_set *to = b->to;
    const double *weight = to->weight.at, *made = to->made.at;
    const fibrad_particle *p = to->particle.at;
    double *sum = to->power.at, *root = to->root.at;
    fibrad_row row;
    memset(sum, 0, to->columns * sizeof *sum);
    for (int t = 0; t < b->s->config.threads; ++t)
        for (size_t at = 0; fibrad_rows_read(&to->rows[t], &at, &row);) {
            const double all = fibrad_row_weight(&row, weight[row.sphere]);
            double rest = row.escaped;
            for (uint32_t k = 0; k < b->bed->walls; ++k) rest += row.wall[k];
            sum[row.sphere] += all * rest;
            for (uint32_t k = 0; k < row.length; ++k) {
                const double said = (made[row.col[k]] == made[row.sphere] ? 0.5 : 1) * all * row.f[k];
                sum[row.sphere] += said;
                sum[row.col[k]] += said;
            }
        }
    fibrad_link_reverse(to->seen, sum, 1);
    for (size_t i = 0; i < to->own; ++i)
        root[i] = p[i].node > 0 && sum[i] > 0 ? sqrt((1 - p[i].node / p[i].emissivity) / sum[i]) : 0;
}

int fibrad_insitu_make(fibrad_insitu_build *b) {
    int status = make_rows(b);
    if (!status) status = check_backs(b);
    if (!status) status = link_present(b);
    if (!status) status = link_seen(b);
    if (!status && b->to->conducts) find_resistances(b);
    fibrad_block_trim(&b->to->particle, b->to->own, sizeof(fibrad_particle));
    fibrad_block_trim(&b->to->id, b->to->columns, sizeof(uint64_t));
    return status;
}
