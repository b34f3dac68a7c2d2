/* source_paths.c - paths that begin at walls and surroundings. SPDX-License-Identifier: MIT
 *
 * A wall or an opening is a source. Its paths tell what sources exchange with each other. They also tell what each
 * particle exchanges with a source by way of other surfaces. This is worth far more paths of the particles themselves:
 * those of a particle go anywhere, and few of them end at a hot wall. Such paths may cross the whole bed. So every rank
 * has all particles, and the ranks share the paths out. */
#include <math.h>
#include <string.h>

#include "couple/insitu.h"

#define PATHS_WORTH 25      /* paths of a source are worth so many times those of a particle */
#define PATHS_LEAST 512     /* of each source */
#define PATHS_EMPTY 8192    /* of each source of a bed without particles */
#define UNIT        0x1p-40 /* of fibrad_exchange_wall */

/* A wall or an opening. */
struct source {
    uint32_t wall, known; /* number for fibrad_exchange_wall; element of what particles know */
    double emits;         /* L^2, area times emissivity */
    double density;       /* 1/L^2, number of paths followed for each `emits` */
    uint32_t paths;
    fibrad_wall_row row;
};

/* All sources of a bed. */
struct sources {
    fibrad_insitu_build *b;
    fibrad_wall_rule rule;
    uint32_t count;
    struct source source[FIBRAD_WALLS_MAX + FIBRAD_OPENINGS_MAX];
    fibrad_wall_row part[FIBRAD_WALLS_MAX + FIBRAD_OPENINGS_MAX][FIBRAD_WALL_PARTS]; /* zero on all ranks but one */
    /* 1: paths meet a side that belongs to no wall, so there is no row */
    unsigned char back[FIBRAD_WALLS_MAX + FIBRAD_OPENINGS_MAX];
    uint64_t *hits;  /* [count][n], particles in the order of ranks */
    size_t n, first; /* numbers of particles: all, and those of lower ranks */
};

/* ---- the scene ---- */

/* Where a particle of the scene stands in the order of ranks, which all ranks share. */
static size_t ranked(const struct sources *t, size_t i) {
    if (i < t->b->own) return t->first + i;
    return i < t->b->own + t->first ? i - t->b->own : i;
}

/* A plane beyond all particles and triangles, at some distance, so that it is no side of a mesh. */
static double outer_end(const fibrad_insitu_build *b, int axis, int upper) {
    const fibrad_triangles *t = b->bed->triangles;
    double end = b->ends[upper][axis];
    for (uint32_t v = 0; t && v < t->vertices; ++v) {
        const size_t at = (size_t)v * (t->stride ? t->stride : 1);
        const double x = axis == 0 ? t->x[at] : axis == 1 ? t->y[at] : t->z[at];
        end = upper ? fmax(end, x) : fmin(end, x);
    }
    return upper ? end + b->radius_mean : end - b->radius_mean;
}

/* Adds openings where neither a wall nor a period bounds the bed, so that surroundings are sources. Adds none if one
 * would cut a wall that is endless. */
static void close_bed(fibrad_insitu_build *b) {
    bool face[3][2] = {{false}}, any[3], open[3];
    for (uint32_t k = 0; k < b->bed->walls; ++k) {
        const fibrad_wall *wall = &b->bed->wall[k];
        if (wall->kind == FIBRAD_WALL_PLANE) face[wall->plane.axis][wall->plane.upper] = true;
        if (wall->kind == FIBRAD_WALL_CYLINDER) return; /* its ends are closed */
    }
    for (uint32_t k = 0; k < b->openings; ++k) face[b->opening[k].axis][b->opening[k].upper] = true;
    for (int axis = 0; axis < 3; ++axis) {
        any[axis] = face[axis][0] || face[axis][1];
        open[axis] = b->period[axis] == 0 && !(face[axis][0] && face[axis][1]);
    }
    for (int axis = 0; axis < 3; ++axis)
        if (any[axis] && (open[(axis + 1) % 3] || open[(axis + 2) % 3])) return;
    for (int axis = 0; axis < 3; ++axis)
        for (int upper = 0; upper < 2 && open[axis]; ++upper)
            if (!face[axis][upper]) b->opening[b->openings++] = (fibrad_plane){axis, upper, outer_end(b, axis, upper)};
}

/* ---- paths ---- */

static void list_sources(struct sources *t) {
    const fibrad_insitu_build *b = t->b;
    const uint32_t walls = b->bed->walls;
    for (uint32_t k = 0; k < walls + b->openings; ++k) {
        struct source *source = &t->source[t->count];
        *source = (struct source){.wall = k, .known = k < walls ? k : walls};
        if (k >= walls) {
            const fibrad_plane *at = &b->opening[k - walls];
            source->wall = FIBRAD_OPENING(walls, at->axis, at->upper);
        }
        source->emits = fibrad_scene_wall_area(b->scene, source->wall);
        if (k < walls) source->emits *= b->bed->wall_emissivity[k];
        t->count += source->emits > 0 && isfinite(source->emits);
    }
}

/* Finds how many paths leave each source. Particles need none if nothing reflects. */
static void count_paths(struct sources *t) {
    const double paths = t->b->s->config.paths, radius = t->b->radius_mean, particle = 4 * acos(-1) * radius * radius;
    double emits = 0;
    for (uint32_t k = 0; k < t->count; ++k) emits += t->source[k].emits;
    const bool empty = !t->b->to->facts.particles;
    const double most = t->b->s->source_paths * (double)t->b->to->facts.particles * paths / emits;
    t->b->density = t->b->to->emissive && !empty ? fmin(PATHS_WORTH * paths / particle, most) : 0;
    for (uint32_t k = 0; k < t->count; ++k) {
        struct source *source = &t->source[k];
        const double count =
            fmin(fmax(empty ? PATHS_EMPTY : PATHS_LEAST, t->b->density * source->emits), FIBRAD_PATHS_MAX);
        source->paths = ((uint32_t)count + FIBRAD_WALL_PARTS - 1) / FIBRAD_WALL_PARTS * FIBRAD_WALL_PARTS;
    }
}

/* Follows the paths of one of the batches that this rank does. */
static int follow_batch(void *sources, int thread, uint32_t batch) {
    struct sources *t = sources;
    const fibrad_insitu *s = t->b->s;
    const uint32_t task = (uint32_t)s->rank + batch * (uint32_t)s->ranks;
    const uint32_t k = task / FIBRAD_WALL_PARTS, part = task % FIBRAD_WALL_PARTS;
    uint64_t *hits = calloc(t->n + 1, sizeof *hits);
    fibrad_wall_rule rule = t->rule;
    rule.paths = t->source[k].paths;
    const int status = !hits ? FIBRAD_E_MEMORY
                             : fibrad_exchange_wall(t->b->scene, &s->team.work[thread], t->source[k].wall, &rule, part,
                                                    &t->part[k][part], hits);
#pragma omp critical
    {
        if (status == FIBRAD_E_BACK) t->back[k] = 1;
        for (size_t i = 0; i < t->n && !status; ++i) t->hits[k * t->n + ranked(t, i)] += hits[i];
    }
    free(hits);
    return status == FIBRAD_E_BACK ? FIBRAD_OK : status;
}

static int follow_sources(struct sources *t) {
    fibrad_insitu *s = t->b->s;
    const uint32_t rank = (uint32_t)s->rank, ranks = (uint32_t)s->ranks, tasks = t->count * FIBRAD_WALL_PARTS;
    const uint32_t own = tasks > rank ? (tasks - rank + ranks - 1) / ranks : 0;
    return fibrad_team_run(&s->team, NULL, own, 1, follow_batch, t, NULL);
}

/* Gives all ranks what each of them has found. All but one have zeroes. */
static void sum_up(struct sources *t) {
    const MPI_Comm comm = t->b->s->comm;
    MPI_Allreduce(MPI_IN_PLACE, t->part, (int)sizeof t->part, MPI_BYTE, MPI_BOR, comm);
    MPI_Allreduce(MPI_IN_PLACE, t->back, (int)sizeof t->back, MPI_BYTE, MPI_BOR, comm);
    for (uint32_t k = 0; k < t->count; ++k) {
        MPI_Allreduce(MPI_IN_PLACE, t->hits + k * t->n, (int)t->n, MPI_UINT64_T, MPI_SUM, comm);
        fibrad_exchange_wall_mean(t->part[k], &t->source[k].row);
        t->source[k].density = (double)t->source[k].row.paths / t->source[k].emits;
    }
}

/* ---- what they tell ---- */

/* Whether walls and, last, the surroundings have rows. The surroundings have one if all openings do. has: out:
 * [walls + 1] */
static void mark_rows(const struct sources *t, bool has[FIBRAD_WALLS_MAX + 1]) {
    memset(has, 0, (FIBRAD_WALLS_MAX + 1) * sizeof *has);
    for (uint32_t k = 0; k < t->count; ++k) has[t->source[k].known] = true;
    for (uint32_t k = 0; k < t->count; ++k) has[t->source[k].known] &= !t->back[k];
}

/* Two sources exchange the mean of what their rows say, or what the row of one says if the other has none. */
static void find_exchange(const struct sources *t, const bool *has, fibrad_wall_exchange *exchange) {
    const uint32_t walls = t->b->bed->walls;
    for (uint32_t k = 0; k < t->count; ++k) {
        const struct source *source = &t->source[k];
        const uint32_t a = source->known;
        for (uint32_t c = 0; c <= walls && has[a]; ++c) {
            const double factor = c < walls ? source->row.wall[c] : source->row.escaped;
            const double said = source->emits * factor * (has[c] ? 0.5 : 1);
            if (c == a) continue;
            if (a == walls || c == walls) {
                exchange->surroundings[a == walls ? c : a] += said;
            } else {
                exchange->wall[a][c] += said;
                exchange->wall[c][a] += said;
            }
        }
    }
}

/* Whether all that absorbs, other than particles, has a row. */
static bool have_all(const struct sources *t, const bool *has) {
    const uint32_t walls = t->b->bed->walls;
    bool all = true, escapes = false;
    for (uint32_t k = 0; k < t->count; ++k) escapes = escapes || t->source[k].row.escaped > 0;
    for (uint32_t k = 0; k < walls; ++k) all = all && (has[k] || t->b->bed->wall_emissivity[k] == 0);
    return all && (has[walls] || !escapes);
}

/* Keeps what own particles know: paths that sources absorb of those that are worth as many. */
static int keep_known(const struct sources *t, const bool *has) {
    fibrad_insitu_build *b = t->b;
    const size_t width = b->bed->walls + 1;
    if (fibrad_block_fit(&b->s->known, b->own * width, sizeof(double))) return FIBRAD_E_MEMORY;
    double *known = b->s->known.at;
    for (size_t i = 0; i < b->own * width; ++i) known[i] = has[i % width] ? 0 : NAN;
    for (uint32_t k = 0; k < t->count; ++k) {
        const struct source *source = &t->source[k];
        const double worth = UNIT * (b->density / source->density);
        for (size_t i = 0; i < b->own; ++i)
            known[i * width + source->known] += worth * (double)t->hits[k * t->n + t->first + i];
    }
    return FIBRAD_OK;
}

static int make_sources(struct sources *t) {
    fibrad_insitu_build *b = t->b;
    int status = fibrad_insitu_scene(b, b->to->particle.at, t->n, NULL);
    status = fibrad_agree(b->s->comm, status, b->s->message);
    if (status) return status;
    const fibrad_exchange_rule rule = fibrad_insitu_rule(b, t->n);
    t->rule = (fibrad_wall_rule){.emissivity = rule.emissivity, .wall_emissivity = rule.wall_emissivity};
    t->rule.node_emissivity = rule.node_emissivity, t->rule.conductivity = rule.conductivity, t->rule.seed = rule.seed;
    list_sources(t);
    if (!t->count) return FIBRAD_OK;
    count_paths(t);
    t->hits = calloc(t->count * t->n, sizeof *t->hits);
    status = fibrad_agree(b->s->comm, t->hits ? follow_sources(t) : FIBRAD_E_MEMORY, b->s->message);
    if (status) return status;
    sum_up(t);
    bool has[FIBRAD_WALLS_MAX + 1];
    mark_rows(t, has);
    find_exchange(t, has, &b->to->wall_exchange);
    b->knows = true;
    b->knows_all = have_all(t, has);
    return fibrad_agree(b->s->comm, keep_known(t, has), b->s->message);
}

int fibrad_insitu_sources(fibrad_insitu_build *b) {
    const uint32_t openings = b->openings;
    b->to->wall_exchange = (fibrad_wall_exchange){0};
    if ((!b->to->facts.particles && !b->bed->walls) || !b->whole || b->s->config.cutoff > 0) return FIBRAD_OK;
    close_bed(b);
    struct sources *t = calloc(1, sizeof *t);
    int status = fibrad_agree(b->s->comm, t ? FIBRAD_OK : FIBRAD_E_MEMORY, b->s->message);
    if (!status) {
        t->b = b, t->n = b->own + b->halo, t->first = b->lower;
        status = make_sources(t);
        free(t->hits);
    }
    b->openings = openings;
    free(t);
    return status;
}
