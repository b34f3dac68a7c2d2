/* strays.c - particles beyond walls, and particles whose centre lies inside another. SPDX-License-Identifier: MIT */
#include "couple/ranks/strays.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#define OPENING_SLACK 1e-12 /* a particle may reach this much beyond an opening, as in fibrad_scene_init */
#define INSIDE_MOST   64    /* centres inside a particle, in the mean over all particles: more are an error */
#define INSIDE_SLACK  1e-9  /* catches a centre at the surface of another particle whatever the rounding */

/* ---- bounds ---- */

static bool plane_holds(const fibrad_plane *plane, const double x[3]) {
    return plane->upper ? x[plane->axis] <= plane->at : x[plane->axis] >= plane->at;
}

/* cylinder: its axis, as in fibrad_insitu_bed */
static bool wall_holds(const fibrad_wall *wall, int cylinder, const double x[3]) {
    if (wall->kind == FIBRAD_WALL_PLANE) return plane_holds(&wall->plane, x);
    if (wall->kind != FIBRAD_WALL_CYLINDER) return true;
    const double a = (x[cylinder == 1 ? 1 : 0] - wall->cylinder.x) / wall->cylinder.radius;
    const double b = (x[cylinder == 0 ? 1 : 2] - wall->cylinder.y) / wall->cylinder.radius;
    return a * a + b * b <= 1;
}

static bool opening_holds(const fibrad_plane *plane, const fibrad_particle *p) {
    const double x = p->x[plane->axis], beyond = p->radius - (plane->upper ? plane->at - x : x - plane->at);
    return beyond <= OPENING_SLACK * (p->radius + fabs(x));
}

static void describe(char *message, const fibrad_particle *p, const char *fault, const fibrad_plane *plane) {
    char name[] = "the cylinder";
    if (plane) snprintf(name, sizeof name, "%c%s", "xyz"[plane->axis], plane -> upper ? "hi" : "lo");
    fibrad_refuse(message, 0, "particle %" PRIu64 " at (%.6g, %.6g, %.6g): %s %s", p->id, p->x[0], p->x[1], p->x[2],
                  fault, name);
}

bool fibrad_bounds_hold(const fibrad_bounds *bounds, const fibrad_particle *p, bool *opening, char *message) {
    *opening = false;
    for (uint32_t k = 0; k < bounds->walls; ++k) {
        const fibrad_wall *wall = &bounds->wall[k];
        if (wall_holds(wall, bounds->cylinder, p->x)) continue;
        char fault[48];
        snprintf(fault, sizeof fault, "its centre lies beyond wall %" PRIu32 ",", k + 1);
        describe(message, p, fault, wall->kind == FIBRAD_WALL_PLANE ? &wall->plane : NULL);
        return false;
    }
    for (uint32_t k = 0; k < bounds->openings; ++k) {
        if (opening_holds(&bounds->opening[k], p)) continue;
        describe(message, p, "it reaches beyond the opening", &bounds->opening[k]);
        *opening = true;
        return false;
    }
    return true;
}

/* ---- remarks ---- */

void fibrad_remark_add(fibrad_remark *remark, uint64_t id, const char *message) {
    if (remark->count++ && id > remark->id) return;
    remark->id = id;
    fibrad_refuse(remark->message, 0, "%s", message);
}

void fibrad_remark_agree(MPI_Comm comm, fibrad_remark *remark) {
    int rank, lowest;
    uint64_t least = remark->count ? remark->id : UINT64_MAX;
    const uint64_t own = least;
    MPI_Allreduce(MPI_IN_PLACE, &remark->count, 1, MPI_UINT64_T, MPI_SUM, comm);
    if (!remark->count) return;
    MPI_Comm_rank(comm, &rank);
    MPI_Allreduce(MPI_IN_PLACE, &least, 1, MPI_UINT64_T, MPI_MIN, comm);
    lowest = own == least ? rank : INT32_MAX;
    MPI_Allreduce(MPI_IN_PLACE, &lowest, 1, MPI_INT, MPI_MIN, comm);
    remark->id = least;
    MPI_Bcast(remark->message, FIBRAD_MESSAGE, MPI_CHAR, lowest, comm);
}

/* ---- overlaps ---- */

/* Particles sorted by the cells of a grid. */
struct cells {
    double low[3], inverse;
    int64_t count[3];
    uint32_t *start; /* [cells + 1] */
    uint32_t *order; /* [particles] */
};

static int64_t coarse_place(const struct cells *c, int axis, double x) {
    return (int64_t)fmax(0, fmin((double)c->count[axis] - 1, (x - c->low[axis]) * c->inverse));
}

static size_t coarse_cell(const struct cells *c, const double x[3]) {
    return (size_t)(coarse_place(c, 0, x[0]) +
                    c->count[0] * (coarse_place(c, 1, x[1]) + c->count[1] * coarse_place(c, 2, x[2])));
}

/* Sizes the cells: two mean radii wide, or wider if there would be too many per particle. */
static size_t size_cells(struct cells *c, const fibrad_particle *p, size_t n) {
    double high[3] = {-INFINITY, -INFINITY, -INFINITY}, sum = 0, cells;
    for (int axis = 0; axis < 3; ++axis) c->low[axis] = INFINITY;
    for (size_t i = 0; i < n; ++i) {
        sum += p[i].radius;
        for (int axis = 0; axis < 3; ++axis) {
            c->low[axis] = fmin(c->low[axis], p[i].x[axis]);
            high[axis] = fmax(high[axis], p[i].x[axis]);
        }
    }
    double wide = 2 * sum / (double)n;
    for (;; wide *= 1.5) {
        cells = 1;
        for (int axis = 0; axis < 3; ++axis) cells *= floor((high[axis] - c->low[axis]) / wide) + 1;
        if (cells <= 8 * (double)n + 64) break;
    }
    c->inverse = 1 / wide;
    for (int axis = 0; axis < 3; ++axis) c->count[axis] = (int64_t)floor((high[axis] - c->low[axis]) / wide) + 1;
    return (size_t)cells;
}

static int sort_particles(struct cells *c, const fibrad_particle *p, size_t n) {
    const size_t cells = size_cells(c, p, n);
    c->start = calloc(cells + 2, sizeof *c->start);
    c->order = malloc(n * sizeof *c->order);
    if (!c->start || !c->order) return FIBRAD_E_MEMORY;
    uint32_t *end = c->start + 1; /* while particles are sorted: where the next one of each cell goes */
    for (size_t i = 0; i < n; ++i) end[coarse_cell(c, p[i].x) + 1]++;
    for (size_t k = 1; k <= cells; ++k) end[k] += end[k - 1];
    for (size_t i = 0; i < n; ++i) c->order[end[coarse_cell(c, p[i].x)]++] = (uint32_t)i;
    return FIBRAD_OK;
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

/* Reduces the parts of a particle and of all others whose centres lie inside of it. inside[i]: one of the other.
 * Returns the number of centres inside. */
static size_t look_inside(const struct cells *c, const fibrad_particle *p, size_t i, size_t own, double *part,
                          uint32_t *inside) {
    int64_t first[3], last[3];
    size_t count = 0;
    for (int axis = 0; axis < 3; ++axis) {
        first[axis] = coarse_place(c, axis, p[i].x[axis] - p[i].radius);
        last[axis] = coarse_place(c, axis, p[i].x[axis] + p[i].radius);
    }
    for (int64_t z = first[2]; z <= last[2]; ++z)
        for (int64_t y = first[1]; y <= last[1]; ++y) {
            const size_t row = (size_t)(c->count[0] * (y + c->count[1] * z));
            for (uint32_t k = c->start[row + (size_t)first[0]]; k < c->start[row + (size_t)last[0] + 1]; ++k) {
                const size_t j = c->order[k];
                if (p[j].id == p[i].id) continue;
                const double reach = p[i].radius * (1 + INSIDE_SLACK);
                const double d[3] = {p[j].x[0] - p[i].x[0], p[j].x[1] - p[i].x[1], p[j].x[2] - p[i].x[2]};
                if (fabs(d[0]) > reach || fabs(d[1]) > reach || fabs(d[2]) > reach) continue;
                const double distance = hypot(hypot(d[0], d[1]), d[2]);
                if (!(distance < reach)) continue;
                ++count;
                const double outside = distance / fmax(p[i].radius, p[j].radius) * (1 - INSIDE_SLACK);
                const size_t pair[2] = {i, j};
                for (int side = 0; side < 2; ++side)
                    if (pair[side] < own && outside < part[pair[side]])
                        part[pair[side]] = outside, inside[pair[side]] = (uint32_t)pair[1 - side];
            }
        }
    return count;
}

int fibrad_overlaps(const fibrad_particle *particle, size_t own, size_t all, double *part, fibrad_remark *remark) {
    struct cells cells = {.inverse = 0};
    uint32_t *inside = malloc((own + 1) * sizeof *inside);
    int status = inside ? FIBRAD_OK : FIBRAD_E_MEMORY;
    for (size_t i = 0; i < own; ++i) part[i] = 1;
    if (!status && own) status = sort_particles(&cells, particle, all);
    size_t sum = 0;
    for (size_t i = 0; i < all && own && !status; ++i) {
        const size_t count = look_inside(&cells, particle, i, own, part, inside);
        sum += count;
        if (sum > INSIDE_MOST * all)
            status = fibrad_refuse(remark->message, FIBRAD_E_GEOMETRY,
                                   "particle %" PRIu64 " of radius %g has the centres of %zu others inside it: is its "
                                   "diameter right?",
                                   particle[i].id, particle[i].radius, count);
    }
    for (size_t i = 0; i < own && !status; ++i)
        if (part[i] < 1) describe_overlap(remark, &particle[i], &particle[inside[i]]);
    free(inside);
    free(cells.start);
    free(cells.order);
    return status;
}
