/* insitu_bed.c - checks and measures a bed, and gathers the particles of a scene. SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "couple/insitu.h"

#define CUTOFF_RADII 8    /* least default cutoff: the largest diameter plus this many mean radii */
#define CUTOFF_COUNT 1e5  /* particles in a cube that may be sent for the default cutoff, see below */
#define CELL_RADII   0.25 /* width of the cells of the coarse map, in mean radii */
#define REACH_RADII  1.5  /* spheres this many largest radii beyond the cutoff still matter to a row: fibrad.h */
#define PERIODS_MAX  100  /* the kernel's beams go this far */
#define PART_LEAST   1e-3 /* a particle whose radius would be reduced to less is left out */
#define OUTSIDE_MOST 0.1  /* part of all particles that may be left out of the first rows */

/* A wall, or behind all walls an opening. name[48]: what messages call it */
static fibrad_wall wall_of(const fibrad_insitu_build *b, uint32_t k, char *name) {
    const bool opens = k >= b->bed->walls;
    const fibrad_wall wall =
        opens ? (fibrad_wall){.kind = FIBRAD_WALL_PLANE, .plane = b->opening[k - b->bed->walls]} : b->bed->wall[k];
    const int count = snprintf(name, 48, opens ? "the opening" : "wall %" PRIu32, k + 1);
    if (wall.kind == FIBRAD_WALL_PLANE) snprintf(name + count, 48 - (size_t)count, " at %g", wall.plane.at);
    return wall;
}

/* What contradicts in two walls. NULL: nothing */
static const char *contradiction(const fibrad_wall *a, const fibrad_wall *b) {
    const bool round = a->kind == FIBRAD_WALL_CYLINDER, same_kind = a->kind == b->kind;
    if (round && same_kind) return "is a cylinder, as is";
    if (round && b->kind == FIBRAD_WALL_PLANE && b->plane.axis != a->cylinder.along)
        return "is a cylinder, and across it lies";
    if (!same_kind || a->kind != FIBRAD_WALL_PLANE || a->plane.axis != b->plane.axis) return NULL;
    if (a->plane.upper == b->plane.upper) return "is on the same side as";
    return b->plane.upper && !(a->plane.at < b->plane.at) ? "does not lie below" : NULL;
}

/* Says what contradicts in the walls, of which no scene can be made. */
static int refuse_walls(const fibrad_insitu_build *b) {
    const uint32_t n = b->bed->walls + b->openings;
    const char *bound = "the walls do not bound a box or a cylinder";
    char *message = b->s->message, name[2][48];
    for (uint32_t k = 0; k < n * n; ++k) {
        const fibrad_wall first = wall_of(b, k / n, name[0]), second = wall_of(b, k % n, name[1]);
        const char *why = k / n != k % n ? contradiction(&first, &second) : NULL;
        if (why) return fibrad_refuse(message, FIBRAD_E_ARGUMENT, "%s: %s %s %s", bound, name[0], why, name[1]);
        if (first.kind == FIBRAD_WALL_CYLINDER && !(first.cylinder.radius > 0))
            return fibrad_refuse(message, FIBRAD_E_ARGUMENT, "%s: the radius of %s is not above 0", bound, name[0]);
    }
    return fibrad_refuse(message, FIBRAD_E_ARGUMENT, "%s: one is not valid, or its axis is periodic", bound);
}

/* Checks the bed without its particles, which is the same on all ranks. */
static int check_bed(fibrad_insitu_build *b) {
    const fibrad_insitu_bed *bed = b->bed;
    char *message = b->s->message;
    unsigned char block[FIBRAD_SCENE_BYTES(0)];
    fibrad_scene *empty;
    fibrad_wall wall[FIBRAD_WALLS_MAX]; /* without meshes, which bound no box */
    uint32_t walls = 0;
    if (!bed || (bed->n && !(bed->id && bed->x && bed->radius && bed->emissivity)) || bed->n > FIBRAD_SPHERES_MAX ||
        bed->walls > FIBRAD_WALLS_MAX || (bed->walls && !(bed->wall && bed->wall_emissivity)) ||
        bed->openings > FIBRAD_OPENINGS_MAX || (bed->openings && !bed->opening))
        return FIBRAD_E_ARGUMENT;
    if (bed->clump && bed->conductivity)
        return fibrad_refuse(message, FIBRAD_E_UNSUPPORTED, "clumps have one temperature each: they do not conduct");
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
        if (!isfinite(opening->at))
            opening->at = opening->upper ? FIBRAD_LENGTH_MAX : -FIBRAD_LENGTH_MAX; /* until the bed is known */
    }
    for (uint32_t k = 0; k < bed->walls; ++k)
        if (bed->wall[k].kind != FIBRAD_WALL_MESH) wall[walls++] = bed->wall[k];
    fibrad_scene_config config = {.period = {b->period[0], b->period[1], b->period[2]}, .wall = wall, .walls = walls};
    config.opening = b->opening, config.openings = bed->openings;
    const int status = fibrad_scene_init(&empty, block, sizeof block, &config, &(fibrad_spheres){0}, NULL);
    if (status == FIBRAD_E_ENDLESS) return fibrad_refuse(message, status, "%s", fibrad_status_text(status));
    if (status) return refuse_walls(b);
    for (uint32_t k = 0; k < bed->walls; ++k)
        if (!(bed->wall_emissivity[k] >= 0 && bed->wall_emissivity[k] <= 1))
            return fibrad_refuse(message, FIBRAD_E_ARGUMENT, "wall %" PRIu32 ": its emissivity is not between 0 and 1",
                                 k + 1);
    return FIBRAD_OK;
}

/* Whether a particle takes part. If not, counts it; with `strict` sets *status instead. */
static bool takes_part(fibrad_insitu_build *b, const fibrad_particle *p, int *status) {
    const fibrad_bounds bounds = {b->bed->wall, b->opening, b->bed->walls, b->bed->openings};
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
        fibrad_particle p = {.id = bed->id[i], .radius = bed->radius[i], .emissivity = bed->emissivity[i]};
        p.conductivity = bed->conductivity ? bed->conductivity[i] : INFINITY;
        p.node = fibrad_node_emissivity(p.emissivity, p.conductivity);
        p.clump = bed->clump ? bed->clump[i] : 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double x = bed->x[3 * i + (size_t)axis], period = b->period[axis];
            if (!(fabs(x) <= FIBRAD_LENGTH_MAX))
                return fibrad_refuse_particle(message, p.id, "a coordinate is not finite");
            p.x[axis] = period > 0 ? x - period * floor((x - bed->low[axis]) / period) : x;
        }
        if (!(p.radius > 0 && p.radius <= FIBRAD_LENGTH_MAX))
            return fibrad_refuse_particle(message, p.id, "its radius is not above 0");
        if (!(p.emissivity >= 0 && p.emissivity <= 1))
            return fibrad_refuse_particle(message, p.id, "its emissivity is not between 0 and 1");
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

int fibrad_insitu_check(fibrad_insitu_build *b) {
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
 * as that number allows. A cutoff that all particles are within is none. ends: high and -low of centres. */
static void choose_cutoff(fibrad_insitu_build *b, const double ends[6], double particles) {
    const bool given = b->s->config.cutoff > 0;
    double span[3], longest = 0, cutoff = 2 * b->radius_max + CUTOFF_RADII * b->radius_mean;
    for (int axis = 0; axis < 3; ++axis) {
        span[axis] = ends[axis] + ends[axis + 3];
        longest += b->period[axis] > 0 ? INFINITY : span[axis] * span[axis];
    }
    longest = sqrt(longest) + 2 * b->radius_max;
    while (!given && cutoff < longest && count_within(b, span, particles, 1.25 * cutoff) <= CUTOFF_COUNT)
        cutoff *= 1.25;
    if (given) cutoff = b->s->config.cutoff;
    b->whole = cutoff >= longest || (!given && particles <= b->s->gather);
    b->cutoff = b->whole ? 0 : cutoff;
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

/* The mean radius comes from a sum of whole numbers, so that it does not depend on who owns which particle. */
int fibrad_insitu_measure(fibrad_insitu_build *b) {
    const fibrad_particle *particle = b->to->particle.at;
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
        const double given = b->bed->opening[k].at, low = b->bed->low[opening->axis],
                     high = b->bed->high[opening->axis];
        if (!isfinite(given)) opening->at = b->ends[opening->upper][opening->axis];
        if (isinf(given)) opening->at = opening->upper ? fmax(high, opening->at) : fmin(low, opening->at);
    }
    if (sum[0]) b->radius_mean = (double)sum[1] / (double)sum[0] / 0x1p32 * b->radius_max;
    choose_cutoff(b, most + 2, (double)sum[0]);
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
        b->map.periodic[axis] = periodic;
        b->map.low[axis] = periodic ? b->bed->low[axis] : -most[5 + axis] - b->radius_max;
        b->map.high[axis] = periodic ? b->bed->high[axis] : most[2 + axis] + b->radius_max;
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

static int find_halo(fibrad_insitu_build *b) {
    fibrad_insitu_set *to = b->to;
    return fibrad_halo(b->s->comm, b->period, b->reach, false, &to->particle, b->own, &b->s->sent, &b->halo);
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

int fibrad_insitu_fault(const fibrad_insitu_build *b, int status, const uint64_t *id, size_t n, fibrad_fault fault) {
    char *message = b->s->message;
    if (b->bed->triangles && fault.triangle < b->bed->triangles->n)
        return fibrad_refuse(message, status, "triangle %" PRIu32 " of the walls is not valid", fault.triangle);
    if (fault.first >= n || fault.second >= n) return status;
    const uint64_t first = id[fault.first], second = id[fault.second];
    if (fault.why == FIBRAD_WHY_CLUMP) return fibrad_refuse_particle(message, first, fibrad_why_text(fault.why));
    if (fault.first == fault.second)
        return fibrad_refuse_particle(message, first, "it lies too far from the origin for its size");
    if (first == second)
        return fibrad_refuse(message, status, "particle %" PRIu64 ": the centre of its periodic image lies inside it",
                             first);
    return fibrad_refuse(message, status,
                         "particles %" PRIu64 " and %" PRIu64 ": the centre of one lies inside the other",
                         first < second ? first : second, first < second ? second : first);
}

static void describe_overlap(fibrad_remark *remark, const fibrad_particle *p, const fibrad_particle *other) {
    char message[FIBRAD_MESSAGE];
    const uint64_t first = p->id < other->id ? p->id : other->id, second = p->id < other->id ? other->id : p->id;
    fibrad_refuse(message, 0,
                  "particles %" PRIu64 " and %" PRIu64
                  " at (%.6g, %.6g, %.6g): the centre of one lies inside the other",
                  first, second, p->x[0], p->x[1], p->x[2]);
    fibrad_remark_add(remark, p->id, message);
}

/* Finds to what part the radii of particles must be reduced, and remarks those of this rank. */
static int find_overlaps(fibrad_insitu_build *b, fibrad_remark *remark) {
    fibrad_insitu *s = b->s;
    const size_t n = b->own + b->halo,
                 size = n <= FIBRAD_SPHERES_MAX ? fibrad_scene_size((uint32_t)n, 1) + fibrad_insitu_clumps(b, n) : 0;
    const fibrad_particle *p = b->to->particle.at;
    if (!size || fibrad_block_fit(&s->scene, size, 1) || fibrad_block_fit(&s->emissivity, n, sizeof(double)) ||
        fibrad_block_fit(&s->order, n, sizeof(uint32_t)) || fibrad_block_fit(&b->to->id, n, sizeof(uint64_t)) ||
        fibrad_block_fit(&s->clump, b->bed->clump ? n : 0, sizeof(uint32_t)))
        return FIBRAD_E_MEMORY;
    const fibrad_spheres spheres = fibrad_particle_spheres(p, n, b->to->id.at, b->bed->clump ? s->clump.at : NULL);
    const uint32_t *other = s->order.at;
    double *part = s->emissivity.at;
    fibrad_fault fault;
    const int status = fibrad_spheres_inside(&spheres, s->scene.at, s->scene.size, part, s->order.at, &fault);
    for (size_t i = 0; i < b->own && !status; ++i)
        if (part[i] < 1) describe_overlap(remark, &p[i], &p[other[i]]);
    if (status != FIBRAD_E_GEOMETRY) return status ? fibrad_insitu_fault(b, status, spheres.id, n, fault) : FIBRAD_OK;
    return fibrad_refuse(s->message, status,
                         "particle %" PRIu64 " of radius %g has the centres of many others inside it: is its diameter "
                         "right?",
                         p[fault.first].id, p[fault.first].radius);
}

/* Makes particles smaller whose centre lies inside another, and tells the other ranks. */
static int part_overlaps(fibrad_insitu_build *b) {
    fibrad_insitu *s = b->s;
    fibrad_remark *remark = &b->remark[FIBRAD_REMARK_OVERLAP];
    const int status = fibrad_agree(s->comm, b->own ? find_overlaps(b, remark) : FIBRAD_OK, s->message);
    if (status) return status;
    fibrad_remark_agree(s->comm, remark);
    if (!remark->count) return FIBRAD_OK;
    if (s->config.strict) return fibrad_refuse(s->message, FIBRAD_E_GEOMETRY, "%s", remark->message);
    reduce_radii(b, s->emissivity.at);
    return find_halo(b);
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

/* Gathers the particles of the scene, and chooses those that get rows. The halo of a whole bed only tells overlaps. */
static int gather_scene(fibrad_insitu_build *b) {
    int status = find_halo(b);
    if (!status) status = part_overlaps(b);
    if (!status && b->whole) status = fibrad_gather(b->s->comm, &b->to->particle, b->own, &b->halo, &b->lower);
    if (!status && (!b->whole || b->repeats))
        status = fibrad_coarse_map(b->s->comm, CELL_RADII * b->radius_mean, b->radius_max, b->to->particle.at, b->own,
                                   &b->s->mark, &b->map);
    b->fresh = b->own;
    return !status && b->follows ? fibrad_follow_choose(b) : status;
}

int fibrad_insitu_gather(fibrad_insitu_build *b) {
    const bool needed = b->to->facts.particles && !(b->follows && !b->follow.came);
    const int status = needed ? gather_scene(b) : FIBRAD_OK;
    return status ? status : check_outside(b);
}
