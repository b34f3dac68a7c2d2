/* wall_rows.c - what walls exchange with each other and with the surroundings. SPDX-License-Identifier: MIT
 *
 * Paths from a wall may cross the whole bed. So rank 0 gathers all particles and follows the paths. What walls exchange
 * with particles follows from the rows of particles, which are far more accurate. */
#include <limits.h>
#include <math.h>
#include <omp.h>
#include <string.h>

#include "couple/insitu.h"

#define PATHS_MOST   64   /* paths from a wall, in paths from a particle */
#define PATHS_PART   16   /* all particles have so many times the paths of all walls, unless a wall has */
#define PATHS_LEAST  1024 /* so few */
#define PATHS_GROWTH 4    /* from one number of paths to the next, until the tolerance is met */
#define ERROR_FALLS  0.8  /* the error must fall to this part of itself, else no more paths are added */

/* The rows of all walls. */
struct wall_rows {
    fibrad_insitu_build *b;
    fibrad_exchange_rule rule;
    fibrad_body_row row[FIBRAD_BODIES_MAX];
    bool has[FIBRAD_BODIES_MAX]; /* whether the wall has a row */
};

/* Computes the row of a wall. _BACK: paths meet a side that belongs to no wall. */
static int compute_row(struct wall_rows *w, uint32_t wall) {
    const fibrad_insitu *s = w->b->s;
    fibrad_body_row part[FIBRAD_BODY_PARTS];
    int status[FIBRAD_BODY_PARTS], first = FIBRAD_OK;
#pragma omp parallel for schedule(dynamic) num_threads(s->config.threads)
    for (uint32_t k = 0; k < FIBRAD_BODY_PARTS; ++k)
        status[k] = fibrad_exchange_body(w->b->scene, &s->work[omp_get_thread_num()], wall, &w->rule, k, &part[k]);
    for (uint32_t k = 0; k < FIBRAD_BODY_PARTS && !first; ++k) first = status[k];
    return first ? first : fibrad_exchange_body_mean(part, &w->row[wall]);
}

static bool emits(const fibrad_insitu_bed *bed, uint32_t wall) { return bed->body_emissivity[wall] > 0; }

/* Number of paths from each wall that emits. */
static uint32_t count_paths(const fibrad_insitu_build *b) {
    const double paths = b->s->config.paths;
    double walls = 0;
    for (uint32_t wall = 0; wall < b->bed->bodies; ++wall) walls += emits(b->bed, wall);
    const double share = (double)b->to->facts.particles * paths / (PATHS_PART * walls);
    return (uint32_t)fmin(fmax(PATHS_LEAST, fmin(share, PATHS_MOST * paths)), FIBRAD_PATHS_MAX);
}

/* Whether more paths would bring the row of a wall nearer to the tolerance. Paths that are broken off among mirrors
 * leave an error that does not fall. before: error with fewer paths */
static bool needs_more(const struct wall_rows *w, uint32_t wall, double before) {
    const double error = w->row[wall].error, tolerance = w->rule.tolerance;
    return tolerance > 0 && error > tolerance && error < ERROR_FALLS * before &&
           w->rule.paths <= FIBRAD_PATHS_MAX / PATHS_GROWTH;
}

/* Computes the row of a wall to the tolerance. A wall without emission, and an endless one, have no row. A wall whose
 * paths meet a side that belongs to no wall has none either. */
static int make_row(struct wall_rows *w, uint32_t wall) {
    double before = INFINITY;
    if (!emits(w->b->bed, wall) || !isfinite(fibrad_scene_body_area(w->b->scene, wall))) return FIBRAD_OK;
    w->rule.paths = count_paths(w->b);
    int status = compute_row(w, wall);
    while (!status && needs_more(w, wall, before)) {
        before = w->row[wall].error;
        w->rule.paths *= PATHS_GROWTH;
        status = compute_row(w, wall);
    }
    w->has[wall] = !status;
    return status == FIBRAD_E_BACK ? FIBRAD_OK : status;
}

/* Finds what walls exchange. Two walls exchange the mean of what their two rows say. If one of them has no row, they
 * exchange what the other row says. */
static void find_exchange(const struct wall_rows *w, fibrad_wall_exchange *exchange) {
    const uint32_t walls = w->b->bed->bodies;
    for (uint32_t a = 0; a < walls; ++a) {
        if (!w->has[a]) continue;
        const double emits = fibrad_scene_body_area(w->b->scene, a) * w->rule.body_emissivity[a];
        exchange->surroundings[a] = emits * w->row[a].escaped;
        for (uint32_t c = 0; c < walls; ++c) {
            const double said = emits * w->row[a].body[c] * (w->has[c] ? 0.5 : 1);
            if (c == a) continue;
            exchange->wall[a][c] += said;
            exchange->wall[c][a] += said;
        }
    }
}

/* Makes the rows on rank 0, from all particles. */
static int make_wall_rows(fibrad_insitu_build *b, const fibrad_particle *particle, size_t n) {
    int status = fibrad_insitu_scene(b, particle, n, NULL);
    struct wall_rows w = {.b = b, .rule = fibrad_insitu_rule(b, n)};
    for (uint32_t wall = 0; wall < b->bed->bodies && !status; ++wall) status = make_row(&w, wall);
    if (!status) find_exchange(&w, &b->to->walls);
    return status;
}

/* Gathers all particles on rank 0. */
static int gather(const fibrad_insitu_build *b, fibrad_block *all, size_t *n) {
    const fibrad_insitu *s = b->s;
    int *count = calloc(2 * (size_t)s->ranks, sizeof *count);
    int status = fibrad_agree(s->comm, count && b->own <= INT_MAX ? FIBRAD_OK : FIBRAD_E_MEMORY, NULL);
    if (!status) {
        count[0] = (int)b->own;
        status =
            fibrad_deal(s->comm, status, b->to->particle.at, count, sizeof(fibrad_particle), all, 0, count + s->ranks);
    }
    if (!status) *n = fibrad_count_sum(count + s->ranks, s->ranks);
    free(count);
    return status;
}

int fibrad_insitu_wall_rows(fibrad_insitu_build *b) {
    fibrad_block all = {0};
    size_t n = 0;
    bool any = false;
    b->to->walls = (fibrad_wall_exchange){0};
    for (uint32_t wall = 0; wall < b->bed->bodies; ++wall) any = any || emits(b->bed, wall);
    if (!any || !b->to->facts.particles) return FIBRAD_OK;
    int status = gather(b, &all, &n);
    if (!status && b->s->rank == 0) status = make_wall_rows(b, all.at, n);
    fibrad_block_free(&all);
    status = fibrad_agree(b->s->comm, status, b->s->message);
    MPI_Bcast(&b->to->walls, sizeof b->to->walls, MPI_BYTE, 0, b->s->comm);
    return status;
}
