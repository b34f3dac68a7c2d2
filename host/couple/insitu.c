/* insitu.c - rows of a bed whose particles are divided over ranks. SPDX-License-Identifier: MIT */
#include "couple/insitu.h"

#include <inttypes.h>
#include <math.h>
#include <omp.h>
#include <stdbool.h>
#include <string.h>

#include "couple/ranks/coarse_map.h"
#include "couple/ranks/turned.h"
#include "fibrad_mesh.h"

#define THREADS_MAX  1024
#define CUTOFF_RADII 8    /* least default cutoff: the largest diameter plus this many mean radii */
#define CUTOFF_COUNT 1e5  /* particles in a cube that may be sent for the default cutoff, see below */
#define CELL_RADII   0.25 /* width of the cells of the coarse map, in mean radii */
#define REACH_RADII  1.5  /* spheres this many largest radii beyond the cutoff still matter to a row: fibrad.h */
#define PERIODS_MAX  100  /* the kernel's beams go this far */
#define PART_LEAST   1e-3 /* a particle whose radius would be reduced to less is left out */
#define CHANGED_MOST 0.1  /* part of all particles that may come or go before all rows are made anew */
#define BACKS_MOST   0.1  /* part of all particles that may see what belongs to no wall */
#define OUTSIDE_MOST 0.1  /* part of all particles that may be left out of the first rows */

/* ---- begin and end ---- */

static void *resize_on_heap(void *context, void *block, size_t size) {
    (void)context;
    return realloc(block, size);
}

/* What a fibrad_accuracy stands for. alone: paths if rows do not know all sources, see source_paths.c */
static const struct {
    const char *name;
    uint32_t directions, open, paths, alone;
} samples[] = {[FIBRAD_ACCURACY_NORMAL] = {"normal", 36, 0, 24, 80},
               [FIBRAD_ACCURACY_LOW] = {"low", 18, 0, 8, 34},
               [FIBRAD_ACCURACY_HIGH] = {"high", 144, 1000, 800, 1600}};

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
           (c->strict == 0 || c->strict == 1) && (c->one_way == 0 || c->one_way == 1) &&
           c->accuracy >= FIBRAD_ACCURACY_NORMAL && c->accuracy <= FIBRAD_ACCURACY_HIGH;
}

/* Replaces zeroes by the numbers for which they stand. */
static void complete_config(fibrad_insitu *s) {
    fibrad_insitu_config *c = &s->config;
    s->paths_alone = c->paths ? c->paths : samples[c->accuracy].alone;
    s->open_directions = c->directions ? 0 : samples[c->accuracy].open;
    if (!c->directions) c->directions = samples[c->accuracy].directions;
    if (!c->paths) c->paths = samples[c->accuracy].paths;
    if (!c->threads) c->threads = 1;
}

static int open_set(fibrad_insitu_set *set, int threads) {
    set->rows = calloc((size_t)threads, sizeof *set->rows);
    for (int t = 0; t < threads && set->rows; ++t) set->rows[t].memory.resize = resize_on_heap;
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
                                    &set->emission, &set->power, &set->now,    NULL};
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
    if (!status) s->work = calloc((size_t)s->config.threads, sizeof *s->work);
    if (!status && !s->work) status = FIBRAD_E_MEMORY;
    status = fibrad_agree(comm, status, NULL);
    if (insitu) *insitu = status ? NULL : s;
    if (status && s) {
        if (s->set.rows) close_set(&s->set, s->config.threads);
        if (s->next.rows) close_set(&s->next, s->config.threads);
        free(s->work);
        free(s);
    }
    if (status) return status;
    for (int t = 0; t < s->config.threads; ++t) s->work[t].memory.resize = resize_on_heap;
    MPI_Comm_dup(comm, &s->comm);
    MPI_Comm_rank(s->comm, &s->rank);
    MPI_Comm_size(s->comm, &s->ranks);
    return FIBRAD_OK;
}

void fibrad_insitu_free(fibrad_insitu *s) {
    if (!s) return;
    close_set(&s->set, s->config.threads);
    close_set(&s->next, s->config.threads);
    for (int t = 0; t < s->config.threads; ++t) free(s->work[t].memory.block);
    free(s->work);
    fibrad_block *const blocks[] = {&s->scene, &s->order,  &s->emissivity, &s->mark, &s->known,
                                    &s->sent,  &s->solver, &s->value,      NULL};
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
    return sum + set->now.size + set->unknown.size;
}

void fibrad_insitu_facts_get(const fibrad_insitu *s, fibrad_insitu_facts *facts) {
    if (!s || !facts) return;
    *facts = s->set.facts;
    facts->seconds_rows = s->seconds_rows;
    facts->seconds_powers = s->seconds_powers;
    facts->bytes = set_bytes(&s->set, s->config.threads) + set_bytes(&s->next, s->config.threads) + s->scene.size +
                   s->order.size + s->emissivity.size + s->mark.size + s->known.size + s->sent.size + s->solver.size +
                   s->value.size;
    for (int t = 0; t < s->config.threads; ++t) facts->bytes += s->work[t].memory.size;
}

/* ---- the bed ---- */

/* What bounds a scene, with the axes of the scene. */
struct scene_walls {
    fibrad_wall wall[FIBRAD_WALLS_MAX];
    fibrad_plane opening[FIBRAD_OPENINGS_MAX];
    fibrad_triangles triangles;
    double period[3];
};

static void turn_walls(const fibrad_insitu_build *b, struct scene_walls *to) {
    const fibrad_insitu_bed *bed = b->bed;
    for (uint32_t k = 0; k < bed->walls; ++k) to->wall[k] = fibrad_turned_wall(bed->cylinder, bed->wall[k]);
    for (uint32_t k = 0; k < b->openings; ++k) to->opening[k] = fibrad_turned_plane(bed->cylinder, b->opening[k]);
    fibrad_turn(bed->cylinder, b->period, to->period);
    fibrad_triangles *t = &to->triangles;
    *t = bed->triangles ? *bed->triangles : (fibrad_triangles){0};
    const double *x[3];
    fibrad_turn_arrays(bed->cylinder, (const double *const[]){t->x, t->y, t->z}, x);
    t->x = x[0], t->y = x[1], t->z = x[2];
    memcpy(t->period, to->period, sizeof t->period);
}

/* Checks the bed without its particles, which is the same on all ranks. */
static int check_bed(fibrad_insitu_build *b) {
    const fibrad_insitu_bed *bed = b->bed;
    char *message = b->s->message;
    unsigned char block[FIBRAD_SCENE_BYTES(0)];
    fibrad_scene *empty;
    struct scene_walls turned;
    uint32_t walls = 0; /* without meshes, which bound no box */
    if (!bed || (bed->n && !(bed->id && bed->x && bed->radius && bed->emissivity)) || bed->n > FIBRAD_SPHERES_MAX ||
        bed->walls > FIBRAD_WALLS_MAX || (bed->walls && !(bed->wall && bed->wall_emissivity)) ||
        bed->openings > FIBRAD_OPENINGS_MAX || (bed->openings && !bed->opening) || bed->cylinder < 0 ||
        bed->cylinder > 2)
        return FIBRAD_E_ARGUMENT;
    for (int axis = 0; axis < 3; ++axis) {
        if (!bed->periodic[axis]) continue;
        b->period[axis] = bed->high[axis] - bed->low[axis];
        if (!(b->period[axis] > 0 && isfinite(b->period[axis])))
            return fibrad_refuse(message, FIBRAD_E_ARGUMENT, "the periodic box has no extent along %c", "xyz"[axis]);
    }
    b->openings = bed->openings;
    for (uint32_t k = 0; k < bed->openings; ++k) {
        fibrad_plane *opening = &b->opening[k];
        *opening = bed->opening[k];
        if (isnan(opening->at))
            opening->at = opening->upper ? FIBRAD_LENGTH_MAX : -FIBRAD_LENGTH_MAX; /* until the bed is known */
    }
    turn_walls(b, &turned);
    for (uint32_t k = 0; k < bed->walls; ++k)
        if (turned.wall[k].kind != FIBRAD_WALL_MESH) turned.wall[walls++] = turned.wall[k];
    const fibrad_scene_config config = {.period = {turned.period[0], turned.period[1], turned.period[2]},
                                        .wall = turned.wall,
                                        .walls = walls,
                                        .opening = turned.opening,
                                        .openings = bed->openings};
    const int status = fibrad_scene_init(&empty, block, sizeof block, &config, &(fibrad_spheres){0}, NULL);
    if (status == FIBRAD_E_ENDLESS) return fibrad_refuse(message, status, "%s", fibrad_status_text(status));
    if (status) return fibrad_refuse(message, status, "the walls do not bound a box or a cylinder");
    for (uint32_t k = 0; k < bed->walls; ++k)
        if (!(bed->wall_emissivity[k] >= 0 && bed->wall_emissivity[k] <= 1))
            return fibrad_refuse(message, FIBRAD_E_ARGUMENT, "wall %" PRIu32 ": its emissivity is not between 0 and 1",
                                 k + 1);
    return FIBRAD_OK;
}

static int refuse_particle(char *message, uint64_t id, const char *fault) {
    return fibrad_refuse(message, FIBRAD_E_ARGUMENT, "particle %" PRIu64 ": %s", id, fault);
}

/* Whether a particle takes part. If not, counts it; with `strict` sets *status instead. */
static bool takes_part(fibrad_insitu_build *b, const fibrad_particle *p, int *status) {
    const fibrad_bounds bounds = {b->bed->wall, b->opening, b->bed->walls, b->bed->openings, b->bed->cylinder};
    char why[FIBRAD_MESSAGE];
    bool opening;
    if (fibrad_bounds_hold(&bounds, p, &opening, why)) return true;
    if (b->s->config.strict)
        *status = fibrad_refuse(b->s->message, opening ? FIBRAD_E_GEOMETRY : FIBRAD_E_ARGUMENT, "%s", why);
    else
        fibrad_remark_add(&b->remark[FIBRAD_REMARK_OUTSIDE], p->id, why);
    return false;
}

/* Checks the particles and copies those that take part, moved into the periodic box. */
static int take_particles(fibrad_insitu_build *b) {
    const fibrad_insitu_bed *bed = b->bed;
    char *message = b->s->message;
    int status = FIBRAD_OK;
    size_t own = 0;
    if (fibrad_block_fit(&b->to->particle, bed->n, sizeof(fibrad_particle))) return FIBRAD_E_MEMORY;
    fibrad_particle *particle = b->to->particle.at;
    for (size_t i = 0; i < bed->n; ++i) {
        fibrad_particle p = {.id = bed->id[i],
                             .radius = bed->radius[i],
                             .emissivity = bed->emissivity[i],
                             .conductivity = bed->conductivity ? bed->conductivity[i] : INFINITY};
        p.node = fibrad_node_emissivity(p.emissivity, p.conductivity);
        for (int axis = 0; axis < 3; ++axis) {
            const double x = bed->x[3 * i + (size_t)axis], period = b->period[axis];
            if (!(fabs(x) <= FIBRAD_LENGTH_MAX)) return refuse_particle(message, p.id, "a coordinate is not finite");
            p.x[axis] = period > 0 ? x - period * floor((x - bed->low[axis]) / period) : x;
        }
        if (!(p.radius > 0 && p.radius <= FIBRAD_LENGTH_MAX))
            return refuse_particle(message, p.id, "its radius is not above 0");
        if (!(p.emissivity >= 0 && p.emissivity <= 1))
            return refuse_particle(message, p.id, "its emissivity is not between 0 and 1");
        if (isnan(p.node))
            return fibrad_refuse(message, FIBRAD_E_ARGUMENT,
                                 "particle %" PRIu64 ": its relative conductivity must be at least %g, not %g", p.id,
                                 FIBRAD_RELATIVE_CONDUCTIVITY_MIN, p.conductivity);
        if (takes_part(b, &p, &status)) particle[own++] = p;
        if (status) return status;
    }
    b->own = own;
    return FIBRAD_OK;
}

static int begin_bed(fibrad_insitu_build *b) {
    int status = check_bed(b);
    if (!status) status = take_particles(b);
    return fibrad_agree(b->s->comm, status, b->s->message);
}

/* How many particles and images a cube of side 2 R about the middle of the bed has. Infinity: the cube has too many
 * periods. span: of the centres. */
static double count_within(const fibrad_insitu_build *b, const double span[3], double particles, double radius) {
    for (int axis = 0; axis < 3; ++axis) {
        const double period = b->period[axis], wide = span[axis] + 2 * b->radius_max;
        if (period > 0 && !(radius + REACH_RADII * b->radius_max < PERIODS_MAX * period)) return INFINITY;
        particles *= period > 0 ? (period + 2 * radius) / period : fmin(1, 2 * radius / wide);
    }
    return particles;
}

/* A cutoff hardly changes the time that rows take, but the number of particles that are sent. So the default is as long
 * as that number allows, and no longer than the bed. ends: high and -low of centres. */
static double default_cutoff(const fibrad_insitu_build *b, const double ends[6], double particles) {
    double span[3], longest = 0, cutoff = 2 * b->radius_max + CUTOFF_RADII * b->radius_mean;
    for (int axis = 0; axis < 3; ++axis) {
        span[axis] = ends[axis] + ends[axis + 3];
        longest += span[axis] * span[axis];
        if (b->period[axis] > 0) longest = INFINITY;
    }
    longest = sqrt(longest) + 2 * b->radius_max;
    while (cutoff < longest && count_within(b, span, particles, 1.25 * cutoff) <= CUTOFF_COUNT) cutoff *= 1.25;
    return cutoff;
}

/* Without particles a bed ends with its box, or a little beyond the outermost plane. */
static void take_box_ends(fibrad_insitu_build *b) {
    double longest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        b->ends[0][axis] = b->bed->low[axis], b->ends[1][axis] = b->bed->high[axis];
        for (uint32_t k = 0; k < b->bed->walls; ++k) {
            const fibrad_wall *wall = &b->bed->wall[k];
            if (wall->kind != FIBRAD_WALL_PLANE || wall->plane.axis != axis) continue;
            b->ends[0][axis] = fmin(b->ends[0][axis], wall->plane.at);
            b->ends[1][axis] = fmax(b->ends[1][axis], wall->plane.at);
        }
        longest = fmax(longest, b->ends[1][axis] - b->ends[0][axis]);
    }
    b->radius_mean = 1e-3 * longest;
}

/* Finds extents, radii and the cutoff. They must be the same to the bit whoever owns which particle. So the mean radius
 * comes from a sum of whole numbers. */
static int measure_bed(fibrad_insitu_build *b) {
    const fibrad_particle *particle = b->to->particle.at;
    const fibrad_insitu_config *config = &b->s->config;
    double most[15] = {0, -1}; /* radius, -emissivity, high and -low of centres and of surfaces, whether it conducts */
    uint64_t sum[2] = {b->own, 0};
    int status = FIBRAD_OK;
    for (int k = 2; k < 14; ++k) most[k] = -INFINITY;
    for (size_t i = 0; i < b->own; ++i) {
        most[0] = fmax(most[0], particle[i].radius);
        most[1] = fmax(most[1], -particle[i].node);
        most[14] = fmax(most[14], particle[i].node < particle[i].emissivity);
        for (int axis = 0; axis < 3; ++axis) {
            most[2 + axis] = fmax(most[2 + axis], particle[i].x[axis]);
            most[5 + axis] = fmax(most[5 + axis], -particle[i].x[axis]);
            most[8 + axis] = fmax(most[8 + axis], particle[i].x[axis] + particle[i].radius);
            most[11 + axis] = fmax(most[11 + axis], particle[i].radius - particle[i].x[axis]);
        }
    }
    MPI_Allreduce(MPI_IN_PLACE, most, 15, MPI_DOUBLE, MPI_MAX, b->s->comm);
    for (size_t i = 0; i < b->own; ++i) sum[1] += (uint64_t)llround(particle[i].radius / most[0] * 0x1p32);
    MPI_Allreduce(MPI_IN_PLACE, sum, 2, MPI_UINT64_T, MPI_SUM, b->s->comm);
    b->to->facts = (fibrad_insitu_facts){.particles = sum[0], .step = b->step};
    b->radius_max = most[0];
    for (int axis = 0; axis < 3; ++axis) b->ends[0][axis] = -most[11 + axis], b->ends[1][axis] = most[8 + axis];
    if (!sum[0]) take_box_ends(b);
    for (uint32_t k = 0; k < b->bed->openings; ++k) {
        fibrad_plane *opening = &b->opening[k];
        if (isnan(b->bed->opening[k].at)) opening->at = b->ends[opening->upper][opening->axis];
    }
    if (sum[0]) b->radius_mean = (double)sum[1] / (double)sum[0] / 0x1p32 * b->radius_max;
    b->whole = !(config->cutoff > 0) && (double)sum[0] <= FIBRAD_GATHER_MOST;
    b->cutoff = config->cutoff > 0 || b->whole ? config->cutoff : default_cutoff(b, most + 2, (double)sum[0]);
    if (!b->whole && b->cutoff < 2 * b->radius_max)
        status = fibrad_refuse(b->s->message, FIBRAD_E_ARGUMENT,
                               "the cutoff %g is less than the diameter of the largest particle, %g", b->cutoff,
                               2 * b->radius_max);
    b->to->facts.cutoff = b->cutoff;
    b->reach = b->whole ? 2 * b->radius_max : b->cutoff + REACH_RADII * b->radius_max;
    b->to->emissive = -most[1] < 1;
    b->to->conducts = most[14] > 0;
    for (uint32_t k = 0; k < b->bed->walls; ++k) b->to->emissive |= b->bed->wall_emissivity[k] < 1;
    for (int axis = 0; axis < 3; ++axis) {
        const bool periodic = b->period[axis] > 0;
        b->repeats |= periodic;
        const int turned = fibrad_turned_axis(b->bed->cylinder, axis);
        b->map.periodic[turned] = periodic;
        b->map.low[turned] = periodic ? b->bed->low[axis] : -most[5 + axis] - b->radius_max;
        b->map.high[turned] = periodic ? b->bed->high[axis] : most[2 + axis] + b->radius_max;
        if (periodic && !status && !(b->radius_max < b->period[axis]))
            status = fibrad_refuse(b->s->message, FIBRAD_E_GEOMETRY,
                                   "the largest radius, %g, is more than the period along %c, %g", b->radius_max,
                                   "xyz"[axis], b -> period[axis]);
        if (periodic && !status && !(b->reach < PERIODS_MAX * b->period[axis]))
            status = fibrad_refuse(b->s->message, FIBRAD_E_ARGUMENT, "the cutoff is more than %d periods along %c",
                                   PERIODS_MAX, "xyz"[axis]);
    }
    return status;
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
    if (status == FIBRAD_E_ARGUMENT) refuse_particle(b->s->message, culprit, "this id occurs twice");
    return status;
}

static int find_halo(fibrad_insitu_build *b) {
    fibrad_insitu_set *to = b->to;
    return fibrad_halo(b->s->comm, b->period, b->reach, &to->particle, b->own, &b->s->sent, &b->halo);
}

/* Reduces the radii of own particles, and leaves out those of which next to nothing would remain. */
static void reduce_radii(fibrad_insitu_build *b, const double *part) {
    fibrad_particle *p = b->to->particle.at;
    size_t own = 0;
    for (size_t i = 0; i < b->own; ++i) {
        char why[FIBRAD_MESSAGE];
        if (part[i] < PART_LEAST) {
            fibrad_refuse(why, 0, "particle %" PRIu64 " at (%.6g, %.6g, %.6g): another has the same centre", p[i].id,
                          p[i].x[0], p[i].x[1], p[i].x[2]);
            fibrad_remark_add(&b->remark[FIBRAD_REMARK_OUTSIDE], p[i].id, why);
            continue;
        }
        p[own] = p[i];
        p[own++].radius *= part[i];
    }
    b->own = own;
}

/* Makes particles smaller whose centre lies inside another, and tells the other ranks. */
static int part_overlaps(fibrad_insitu_build *b) {
    fibrad_insitu *s = b->s;
    fibrad_remark *remark = &b->remark[FIBRAD_REMARK_OVERLAP];
    int status = fibrad_block_fit(&s->emissivity, b->own, sizeof(double));
    double *part = s->emissivity.at;
    if (!status) status = fibrad_overlaps(b->to->particle.at, b->own, b->own + b->halo, part, remark);
    if (status) fibrad_refuse(s->message, status, "%s", remark->message);
    status = fibrad_agree(s->comm, status, s->message);
    if (status) return status;
    fibrad_remark_agree(s->comm, remark);
    if (!remark->count) return FIBRAD_OK;
    if (s->config.strict) return fibrad_refuse(s->message, FIBRAD_E_GEOMETRY, "%s", remark->message);
    reduce_radii(b, part);
    return find_halo(b);
}

/* ---- rows ---- */

static int name_scene_fault(const fibrad_insitu_build *b, int status, const uint64_t *id, size_t n,
                            fibrad_fault fault) {
    char *message = b->s->message;
    if (b->bed->triangles && fault.triangle < b->bed->triangles->n)
        return fibrad_refuse(message, status, "triangle %" PRIu32 " of the walls is not valid", fault.triangle);
    if (fault.first >= n || fault.second >= n) return status;
    const uint64_t first = id[fault.first], second = id[fault.second];
    if (fault.first == fault.second)
        return refuse_particle(message, first, "it lies too far from the origin for its size");
    if (first == second)
        return fibrad_refuse(message, status, "particle %" PRIu64 ": the centre of its periodic image lies inside it",
                             first);
    return fibrad_refuse(message, status,
                         "particles %" PRIu64 " and %" PRIu64 ": the centre of one lies inside the other",
                         first < second ? first : second, first < second ? second : first);
}

int fibrad_insitu_scene(fibrad_insitu_build *b, const fibrad_particle *p, size_t n, uint64_t *id) {
    fibrad_insitu *s = b->s;
    const bool images = id && !b->whole, marked = id && b->to->facts.particles && (images || b->repeats);
    if (n > FIBRAD_SPHERES_MAX) return FIBRAD_E_MEMORY;
    struct scene_walls turned;
    turn_walls(b, &turned);
    const size_t size =
        fibrad_scene_size((uint32_t)n, id != NULL) + fibrad_triangles_size(turned.triangles.n, (uint32_t)n);
    if (fibrad_block_fit(&s->scene, size, 1) || fibrad_block_fit(&s->emissivity, 3 * n + 1, sizeof(double)))
        return FIBRAD_E_MEMORY;
    double *emissivity = s->emissivity.at;
    for (size_t i = 0; i < n; ++i) {
        if (id) id[i] = p[i].id;
        emissivity[i] = p[i].emissivity, emissivity[n + i] = p[i].conductivity, emissivity[2 * n + i] = p[i].node;
    }
    fibrad_scene_config config = {0}; /* no rows: an empty scene */
    if (n || !id)
        config = (fibrad_scene_config){.wall = turned.wall,
                                       .walls = b->bed->walls,
                                       .opening = turned.opening,
                                       .openings = b->openings,
                                       .occupancy = marked ? &b->map : NULL,
                                       .triangles = &turned.triangles};
    if ((n || !id) && !images) memcpy(config.period, turned.period, sizeof config.period);
    const uint32_t stride = sizeof *p / sizeof(double);
    const double *x[3];
    fibrad_turn_arrays(b->bed->cylinder, (const double *const[]){&p->x[0], &p->x[1], &p->x[2]}, x);
    const fibrad_spheres spheres = {x[0], x[1], x[2], &p->radius, (uint32_t)n, stride, stride, id};
    fibrad_fault fault;
    const int status = fibrad_scene_init(&b->scene, s->scene.at, s->scene.size, &config, &spheres, &fault);
    return status && id ? name_scene_fault(b, status, id, n, fault) : status;
}

fibrad_exchange_rule fibrad_insitu_rule(const fibrad_insitu_build *b, size_t n) {
    const double *emissivity = b->s->emissivity.at;
    return (fibrad_exchange_rule){.emissivity = emissivity,
                                  .conductivity = b->to->conducts ? emissivity + n : NULL,
                                  .node_emissivity = b->to->conducts ? emissivity + 2 * n : NULL,
                                  .wall_emissivity = b->bed->wall_emissivity,
                                  .directions = b->s->config.directions,
                                  .paths = b->s->config.paths,
                                  .open_directions = b->s->open_directions,
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
static int skip_row(fibrad_insitu_build *b, int status, uint32_t i, int thread) {
    static const double none[FIBRAD_WALLS_MAX];
    const uint64_t id = ((uint64_t *)b->to->id.at)[i];
    char message[FIBRAD_MESSAGE];
    if (name_row_fault(b, status, id, &b->s->work[thread], message) != FIBRAD_E_BACK || b->s->config.strict)
        return b->s->message[0] ? status : fibrad_refuse(b->s->message, status, "%s", message);
    fibrad_remark_add(&b->remark[FIBRAD_REMARK_BACK], id, message);
    const fibrad_row row = {.sphere = i, .wall = (double *)none, .beyond = 1};
    return fibrad_rows_add(&b->to->rows[thread], &row, b->bed->walls);
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

/* Computes all rows. Each thread takes an equal part of the list, one after the other. So rows are in the order of the
 * list for any number of threads. */
static int compute_rows(fibrad_insitu_build *b) {
    fibrad_insitu *s = b->s;
    fibrad_exchange_rule rule = fibrad_insitu_rule(b, b->own + b->halo);
    rule.cutoff = b->cutoff;
    if (!b->knows_all) rule.paths = s->paths_alone;
    const uint32_t *order = s->order.at;
    const int64_t own = (int64_t)b->fresh;
    int status = FIBRAD_OK;
    for (int t = 0; t < s->config.threads; ++t) fibrad_rows_clear(&b->to->rows[t]);
#pragma omp parallel for schedule(static) num_threads(s->config.threads)
    for (int64_t k = 0; k < own; ++k) {
        const int thread = omp_get_thread_num();
        fibrad_row row = {.rows = &b->to->rows[thread]};
        int before;
#pragma omp atomic read
        before = status;
        if (before) continue;
        fibrad_exchange_rule turned =
            rule; /* each row has its own directions, so that their errors average out in powers of walls */
        turned.seed += ((uint64_t *)b->to->id.at)[order[k]] * 0xd1342543de82ef95u;
        if (b->knows) know_sources(b, order[k], &turned);
        int result = fibrad_exchange_row(b->scene, &s->work[thread], order[k], &turned, &row, NULL);
        if (!result) continue;
#pragma omp critical
        {
            result = skip_row(b, result, order[k], thread);
            if (result && !status) {
#pragma omp atomic write
                status = result;
            }
        }
    }
    return status;
}

/* Agrees on the particles that are left out. Too many of them in the first rows tell that walls or radii are wrong. */
static int check_outside(fibrad_insitu_build *b) {
    fibrad_remark *remark = &b->remark[FIBRAD_REMARK_OUTSIDE];
    const uint64_t particles = b->to->facts.particles;
    fibrad_remark_agree(b->s->comm, remark);
    if (b->s->ready || (double)remark->count <= OUTSIDE_MOST * (double)(particles + remark->count)) return FIBRAD_OK;
    return fibrad_refuse(b->s->message, FIBRAD_E_GEOMETRY, "%" PRIu64 " of %" PRIu64 " particles cannot take part; %s",
                         remark->count, particles + remark->count, remark->message);
}

/* Agrees on the particles without rows, and refuses too many of them. */
static int check_backs(fibrad_insitu_build *b) {
    fibrad_remark *remark = &b->remark[FIBRAD_REMARK_BACK];
    fibrad_remark_agree(b->s->comm, remark);
    if ((double)remark->count <= BACKS_MOST * (double)b->to->facts.particles) return FIBRAD_OK;
    return fibrad_refuse(b->s->message, FIBRAD_E_BACK, "%s", remark->message);
}

/* Doubles the factors of new rows to particles that have a row already, which does not know of the new ones. */
static void double_new_to_old(const fibrad_insitu_build *b) {
    fibrad_row row;
    for (int t = 0; t < b->s->config.threads; ++t)
        for (size_t at = 0; fibrad_rows_read(&b->to->rows[t], &at, &row);)
            for (uint32_t k = 0; k < row.length; ++k)
                if (b->follow.has[row.col[k]]) row.f[k] *= 2;
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
        fibrad_block_fit(&b->s->solver, to->conducts ? 4 * to->own : 0, sizeof(double)) ||
        fibrad_block_fit(&to->emission, to->columns, sizeof(double)) ||
        fibrad_block_fit(&to->power, to->columns, sizeof(double)) ||
        fibrad_block_fit(&b->s->sent, b->halo, sizeof(fibrad_place)) ||
        fibrad_block_fit(&b->s->value, b->bed->n + to->own, sizeof(double)))
        return FIBRAD_E_MEMORY;
    fibrad_particle *p = to->particle.at;
    const fibrad_particle *old = set->particle.at;
    double *unknown = to->unknown.at;
    const double *before = set->unknown.at;
    size_t own = b->fresh;
    for (size_t c = 0; b->follows && c < set->own; ++c)
        if (b->follow.there[c]) unknown[own] = before[c], p[own++] = old[c];
    const uint32_t *number = b->s->order.at; /* of columns; 0: not seen */
    fibrad_place *place = b->s->sent.at;     /* of particles seen, for link_seen */
    for (size_t i = b->own; i < b->own + b->halo && !b->follows; ++i)
        if (number[i]) place[number[i] - to->own] = p[i].owner;
    double *weight = to->weight.at;
    memset(weight, 0, to->columns * sizeof *weight);
    for (size_t i = 0; i < to->own; ++i) weight[i] = fibrad_particle_weight(&p[i]);
    return FIBRAD_OK;
}

/* Links home particles with columns. Particles of the halo know their homes, unless old rows are kept. */
static int link_seen(fibrad_insitu_build *b) {
    fibrad_insitu_set *to = b->to;
    fibrad_link_free(to->seen);
    return b->follows ? fibrad_link_new(&to->seen, b->s->comm, to->id.at, to->own, to->columns, NULL)
                      : fibrad_link_to(&to->seen, b->s->comm, to->own, b->s->sent.at, to->columns - to->own);
}

static int make_rows(fibrad_insitu_build *b) {
    const size_t n = b->own + b->halo;
    int status = fibrad_block_fit(&b->to->id, n, sizeof(uint64_t));
    if (!status) status = fibrad_insitu_scene(b, b->to->particle.at, n, b->to->id.at);
    if (!status) status = list_own(b);
    if (!status) status = compute_rows(b);
    if (!status && b->follows) double_new_to_old(b);
    if (!status) status = number_columns(b);
    if (!status && b->follows) status = fibrad_follow_keep(&b->follow, b->s, b->to, b->fresh);
    if (!status) status = list_home(b);
    return fibrad_agree(b->s->comm, status, b->s->message);
}

/* Finds how many particles have come and gone. All rows are made if they are too many, none if none have come. */
static int find_changes(fibrad_insitu_build *b) {
    fibrad_insitu *s = b->s;
    const int status = fibrad_follow_find(&b->follow, s, b->to->particle.at, b->own, 0);
    if (status) return status;
    b->to->changed = s->set.changed + b->follow.came + b->follow.gone;
    b->to->facts.gone = s->set.facts.gone + b->follow.gone;
    b->follows = (double)b->to->changed <= CHANGED_MOST * (double)b->to->facts.particles;
    if (!b->follows) b->to->facts.gone = b->to->changed = b->follow.kept = b->follow.kept_seen = 0;
    if (b->follows && !b->follow.came) b->own = 0;
    return FIBRAD_OK;
}

/* Puts the particles that need rows first. */
static int choose_fresh(fibrad_insitu_build *b) {
    fibrad_follow_free(&b->follow);
    b->follow = (fibrad_follow){0};
    const int status = fibrad_follow_find(&b->follow, b->s, b->to->particle.at, b->own, b->halo);
    if (status) return status;
    fibrad_particle *p = b->to->particle.at;
    b->fresh = 0;
    for (size_t i = 0; i < b->own; ++i) {
        if (b->follow.has[i]) continue;
        const fibrad_particle first = p[i];
        p[i] = p[b->fresh], p[b->fresh] = first;
        b->follow.has[i] = b->follow.has[b->fresh], b->follow.has[b->fresh++] = 0;
    }
    return FIBRAD_OK;
}

/* Gathers the particles of the scene, and chooses those that get rows. The halo of a whole bed only tells overlaps. */
static int gather_bed(fibrad_insitu_build *b) {
    int status = find_halo(b);
    if (!status) status = part_overlaps(b);
    if (!status && b->whole)
        status = fibrad_gather(b->s->comm, &b->to->particle, b->own, &b->s->sent, &b->halo, &b->lower);
    if (!status && (!b->whole || b->repeats))
        status = fibrad_coarse_map(b->s->comm, CELL_RADII * b->radius_mean, b->radius_max, b->bed->cylinder,
                                   b->to->particle.at, b->own, &b->s->mark, &b->map);
    b->fresh = b->own;
    return !status && b->follows ? choose_fresh(b) : status;
}

/* Writes the sentence on particles of one kind; "" if there are none. */
static void tell_remark(const fibrad_remark *remark, int kind, char *message) {
    static const char *const done[FIBRAD_REMARKS] = {"left out until back",
                                                     "smaller, so that no centre is inside another", "without a row",
                                                     "in sight of particles beyond the cutoff"};
    message[0] = 0;
    if (remark->count)
        fibrad_refuse(message, 0, "%" PRIu64 " particle%s %s %s; %s", remark->count, remark->count > 1 ? "s" : "",
                      remark->count > 1 ? "are" : "is", done[kind], remark->message);
}

/* Finds what stands between nodes and particles that conduct. A row says what its particle emits, and the other rows
 * say the same a second time. The mean of both takes the place of A n, so that the system for powers is positive in
 * spite of the noise of the rows. */
static void find_resistances(fibrad_insitu_build *b) {
    fibrad_insitu_set *to = b->to;
    const double *weight = to->weight.at;
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
                sum[row.sphere] += 0.5 * all * row.f[k];
                sum[row.col[k]] += 0.5 * all * row.f[k];
            }
        }
    fibrad_link_reverse(to->seen, sum, 1);
    for (size_t i = 0; i < to->own; ++i)
        root[i] = p[i].node > 0 && sum[i] > 0 ? sqrt((1 - p[i].node / p[i].emissivity) / sum[i]) : 0;
}

/* Remarks a particle if much of what it emits has no known end. Particles that see backs are remarked as such. */
static void tell_unknown(fibrad_insitu_build *b, const fibrad_particle *p, double unknown) {
    char message[FIBRAD_MESSAGE];
    if (!(unknown > FIBRAD_BEYOND_MUCH && unknown < 1)) return;
    fibrad_refuse(message, 0,
                  "%.2g %% of what particle %" PRIu64 " at (%.6g, %.6g, %.6g) emits goes beyond the cutoff %g",
                  100 * unknown, p->id, p->x[0], p->x[1], p->x[2], b->cutoff);
    fibrad_remark_add(&b->remark[FIBRAD_REMARK_BEYOND], p->id, message);
}

/* Sums the facts of the rows over all ranks. */
static void sum_facts(fibrad_insitu_build *b) {
    fibrad_insitu_set *to = b->to;
    const double *weight = to->weight.at;
    const fibrad_particle *particle = to->particle.at;
    double *unknown = to->unknown.at;
    fibrad_row row;
    /* emission, beyond, squared errors, entries, rows of emissivity above 0; then by walls */
    double sum[5 + FIBRAD_WALLS_MAX] = {0}, *of_wall = sum + 5;
    for (int t = 0; t < b->s->config.threads; ++t) {
        for (size_t at = 0; fibrad_rows_read(&to->rows[t], &at, &row);) {
            sum[0] += weight[row.sphere];
            if (row.sphere < b->fresh) unknown[row.sphere] = row.beyond;
            sum[1] += weight[row.sphere] * unknown[row.sphere];
            tell_unknown(b, &particle[row.sphere], unknown[row.sphere]);
            sum[2] += row.error * row.error;
            sum[4] += weight[row.sphere] > 0;
            for (uint32_t k = 0; k < b->bed->walls; ++k)
                of_wall[k] += fibrad_row_weight(&row, weight[row.sphere]) * row.wall[k];
        }
        sum[3] += (double)to->rows[t].entries;
    }
    MPI_Allreduce(MPI_IN_PLACE, sum, 5 + FIBRAD_WALLS_MAX, MPI_DOUBLE, MPI_SUM, b->s->comm);
    for (uint32_t k = 0; k < b->bed->walls; ++k) {
        to->facts.wall[k] = of_wall[k] + to->wall_exchange.surroundings[k];
        for (uint32_t c = 0; c < b->bed->walls; ++c) to->facts.wall[k] += to->wall_exchange.wall[k][c];
    }
    to->facts.beyond = sum[0] > 0 ? sum[1] / sum[0] : 0;
    to->facts.error = sum[4] > 0 ? sqrt(sum[2] / sum[4]) : 0;
    to->facts.entries = (uint64_t)sum[3];
    to->facts.halo = b->halo;
    fibrad_remark_agree(b->s->comm, &b->remark[FIBRAD_REMARK_BEYOND]);
    to->facts.outside = b->remark[FIBRAD_REMARK_OUTSIDE].count;
    to->facts.overlapping = b->remark[FIBRAD_REMARK_OVERLAP].count;
    to->facts.behind = b->remark[FIBRAD_REMARK_BACK].count;
    for (int kind = 0; kind < FIBRAD_REMARKS; ++kind) tell_remark(&b->remark[kind], kind, to->remark[kind].message);
}

static int make_new_rows(fibrad_insitu *s, const fibrad_insitu_bed *bed, uint64_t step, bool follows) {
    if (!s) return FIBRAD_E_ARGUMENT;
    fibrad_insitu_build b = {.s = s, .to = &s->next, .bed = bed, .step = step};
    s->message[0] = 0;
    int status = begin_bed(&b);
    const double begun = MPI_Wtime();
    if (!status) status = measure_bed(&b);
    b.to->changed = 0;
    if (!status && follows && s->ready && s->set.walls == bed->walls) status = find_changes(&b);
    if (b.follows) b.to->conducts |= s->set.conducts;
    if (!status && b.to->facts.particles && !(b.follows && !b.follow.came)) status = gather_bed(&b);
    if (!status) status = check_outside(&b);
    if (b.follows) b.to->wall_exchange = s->set.wall_exchange;
    if (!status && !b.follows) status = fibrad_insitu_sources(&b);
    if (!status) status = make_rows(&b);
    if (!status) status = check_backs(&b);
    if (!status) status = link_present(&b);
    if (!status) status = link_seen(&b);
    fibrad_follow_free(&b.follow);
    if (status) {
        if (!s->message[0]) fibrad_refuse(s->message, status, "%s", fibrad_status_text(status));
        return status;
    }
    if (b.to->conducts) find_resistances(&b);
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
