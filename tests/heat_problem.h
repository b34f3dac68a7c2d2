/* heat_problem.h - a heat problem for tests: a bed, its walls, the sources and the results.
 * SPDX-License-Identifier: MIT */
#ifndef TESTS_HEAT_PROBLEM_H
#define TESTS_HEAT_PROBLEM_H

#include "base/elementary.h"
#include "base/random.h"
#include "row/beam.h"
#include "scene/walls.h"
#include "patches/subdivision.h"
#include "heat_runs.h"
#include "sample/direction.h"
#include "sample/tables.h"
#include "scenes.h"
#include "suite.h"

/* Walls by slot: 0 to 5 are planes across the axes, x low, x high, y low, y high, z low, z high; 6 is a cylinder. */
struct walls {
    uint32_t planes;    /* sum of 1 << slot */
    uint32_t open;      /* sum of 1 << slot of openings */
    double at[6];       /* coordinate of plane k on its axis */
    double cylinder[3]; /* x and y of its axis, and its radius; radius 0: none */
};

/* A bed, its walls and surroundings, and the results. */
struct problem {
    struct bed bed;
    struct walls walls;
    double wall_temperature[FIBRAD_WALLS], wall_emissivity[FIBRAD_WALLS], wall_power[FIBRAD_WALLS]; /* by slot */
    uint32_t given, slot[FIBRAD_WALLS]; /* the walls of the scene are at these slots */
    fibrad_heat_config config;
    fibrad_heat_sources sources;
    double *temperature, *emissivity;
    fibrad_scene *scene;
    fibrad_heat *heat;
    fibrad_heat_result result;
    bool backwards; /* tasks and parts from the last to the first */
    bool turned;    /* so are walls */
    int isa;
};

static inline struct problem problem_of(struct bed bed, double temperature, double emissivity) {
    struct problem p = {.bed = bed};
    p.temperature = malloc(bed.n * sizeof(double));
    p.emissivity = malloc(bed.n * sizeof(double));
    p.result.power = malloc(bed.n * sizeof(double));
    for (uint32_t i = 0; i < bed.n; i++) p.temperature[i] = temperature, p.emissivity[i] = emissivity;
    fibrad_heat_sources_init(&p.sources);
    ck_assert(isnan(p.sources.surroundings) && p.sources.sigma == FIBRAD_STEFAN_BOLTZMANN);
    p.sources.sigma = 1, p.sources.surroundings = 0;
    p.sources.temperature = p.temperature;
    p.sources.emissivity = p.emissivity;
    for (int k = 0; k < FIBRAD_WALLS; k++) p.wall_emissivity[k] = 1;
    return p;
}

static inline void free_heat(struct problem *p) {
    free(p->scene);
    free(p->heat);
}

#define OWNED_PROBLEM OWNED_BY(free_problem) struct problem

static inline void free_problem(struct problem *p) {
    free_heat(p);
    free(p->temperature);
    free(p->emissivity);
    free(p->result.power);
    bed_free(&p->bed);
}

/* The scene of the bed within its walls. */
static inline void build_scene(struct problem *p) {
    const struct walls *walls = &p->walls;
    fibrad_wall wall[FIBRAD_WALLS];
    fibrad_plane opening[6];
    uint32_t openings = 0;
    p->given = 0;
    for (int slot = 0; slot < 6; slot++)
        if (walls->open >> slot & 1) opening[openings++] = (fibrad_plane){slot / 2, slot % 2, walls->at[slot]};
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++) {
        const uint32_t slot = p->turned ? FIBRAD_WALLS - 1 - k : k;
        if (slot == FIBRAD_CYLINDER ? !(walls->cylinder[2] > 0) : (walls->planes >> slot & 1) == 0) continue;
        wall[p->given] = slot == FIBRAD_CYLINDER
                             ? cylinder_at(walls->cylinder[0], walls->cylinder[1], walls->cylinder[2])
                             : plane_at((int)slot / 2, slot % 2, walls->at[slot]);
        p->slot[p->given++] = slot;
    }
    p->scene = scene_with(
        &p->bed, &(fibrad_scene_config){
                     .isa = p->isa, .wall = wall, .walls = p->given, .opening = opening, .openings = openings});
}

static inline void trace_beams(struct problem *p) {
    OWNED_WORK work = work_growing();
    assert_ok(heat_trace(p->heat, &work, p->backwards));
}

/* A problem may be traced again after a change. */
static inline void trace(struct problem *p) {
    free_heat(p);
    build_scene(p);
    const size_t size = fibrad_heat_size(&p->config, p->scene);
    ck_assert_uint_gt(size, 0);
    void *block = block_of(size);
    assert_ok(fibrad_heat_init(&p->heat, block, size, &p->config, p->scene));
    ck_assert_ptr_eq(p->heat, block);
    trace_beams(p);
}

static inline void solve(struct problem *p) {
    const uint32_t parts = p->config.parts ? p->config.parts : 8;
    double temperature[FIBRAD_WALLS], emissivity[FIBRAD_WALLS], power[FIBRAD_WALLS];
    for (uint32_t b = 0; b < p->given; b++)
        temperature[b] = p->wall_temperature[p->slot[b]], emissivity[b] = p->wall_emissivity[p->slot[b]];
    p->sources.wall_temperature = temperature, p->sources.wall_emissivity = emissivity;
    p->result.wall_power = power;
    ck_assert_uint_eq(fibrad_heat_parts(p->heat), parts);
    heat_solve(p->heat, &p->sources, &p->result, p->backwards);
    memset(p->wall_power, 0, sizeof p->wall_power);
    for (uint32_t b = 0; b < p->given; b++) p->wall_power[p->slot[b]] = power[b];
    p->sources.wall_temperature = p->sources.wall_emissivity = NULL;
    p->result.wall_power = NULL;
}

static inline void trace_and_solve(struct problem *p) {
    trace(p);
    solve(p);
}

static inline double emission(double t) { return t * t * t * t; }

static inline double sphere_area(const struct bed *bed, uint32_t i) { return 4 * PI * bed->r[i] * bed->r[i]; }

/* All walls of a box, the planes at -half and half. */
static inline struct walls box_of(double half) {
    return (struct walls){.planes = 63, .at = {-half, half, -half, half, -half, half}};
}

/* The box that holds an open bed. */
static inline struct walls box_about(const struct bed *bed) {
    struct walls walls = {.planes = 63};
    const double *const coordinate[3] = {bed->x, bed->y, bed->z};
    for (int axis = 0; axis < 3; axis++) {
        walls.at[2 * axis] = INFINITY, walls.at[2 * axis + 1] = -INFINITY;
        for (uint32_t i = 0; i < bed->n; i++) {
            walls.at[2 * axis] = fmin(walls.at[2 * axis], coordinate[axis][i] - bed->r[i]);
            walls.at[2 * axis + 1] = fmax(walls.at[2 * axis + 1], coordinate[axis][i] + bed->r[i]);
        }
    }
    return walls;
}

static inline double sum_of_powers(const struct problem *p, double *largest) {
    double sum = p->result.surroundings_power;
    *largest = fabs(sum);
    for (int k = 0; k < FIBRAD_WALLS; k++) {
        sum += p->wall_power[k];
        worst_of(largest, fabs(p->wall_power[k]));
    }
    for (uint32_t i = 0; i < p->bed.n; i++) {
        sum += p->result.power[i];
        worst_of(largest, fabs(p->result.power[i]));
    }
    return sum;
}

static inline void diffuse(const double n[3], double u, double v, double w[3]) {
    double a[3] = {0, 0, 0}, b[3], sine, cosine;
    const int least = fabs(n[0]) < .6 ? 0 : 1;
    a[least] = 1;
    const double along = n[least];
    for (int k = 0; k < 3; k++) a[k] -= along * n[k];
    const double size = sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
    for (int k = 0; k < 3; k++) a[k] /= size;
    for (int k = 0; k < 3; k++) b[k] = n[(k + 1) % 3] * a[(k + 2) % 3] - n[(k + 2) % 3] * a[(k + 1) % 3];
    fibrad_sincos_turn(v, &sine, &cosine);
    for (int k = 0; k < 3; k++) w[k] = sqrt(u) * (cosine * a[k] + sine * b[k]) + sqrt(1 - u) * n[k];
}

/* The first surface that a ray meets from `o` on along w, by trying all: sphere k, or n + wall. UINT32_MAX: none. Sets
 * the point and the normal there. */
static inline uint32_t first_met(const struct problem *p, uint32_t from, double o[3], const double w[3],
                                 double normal[3]) {
    const struct bed *bed = &p->bed;
    const double *cylinder = p->walls.cylinder;
    uint32_t met = UINT32_MAX;
    double nearest = INFINITY;
    for (uint32_t j = 0; j < bed->n; j++) {
        const double c[3] = {bed->x[j] - o[0], bed->y[j] - o[1], bed->z[j] - o[2]};
        const double depth = c[0] * w[0] + c[1] * w[1] + c[2] * w[2];
        const double root = bed->r[j] * bed->r[j] - (c[0] * c[0] + c[1] * c[1] + c[2] * c[2]) + depth * depth;
        if (j == from || depth <= 0 || root <= 0 || depth - sqrt(root) >= nearest) continue;
        nearest = depth - sqrt(root), met = j;
    }
    for (uint32_t k = 0; k < 6 && met >= bed->n; k++) {
        const double t = (p->walls.at[k] - o[k / 2]) / w[k / 2];
        if (((p->walls.planes | p->walls.open) >> k & 1) == 0 || (w[k / 2] > 0) != (k % 2 == 1) || t >= nearest)
            continue;
        nearest = t, met = bed->n + k;
    }
    if (met >= bed->n && cylinder[2] > 0) {
        const double x = o[0] - cylinder[0], y = o[1] - cylinder[1], across = w[0] * w[0] + w[1] * w[1];
        const double along = x * w[0] + y * w[1], inside = cylinder[2] * cylinder[2] - (x * x + y * y);
        const double t = (sqrt(fmax(0, along * along + across * inside)) - along) / across;
        if (t < nearest) nearest = t, met = bed->n + FIBRAD_CYLINDER;
    }
    if (met == UINT32_MAX) return met;
    for (int a = 0; a < 3; a++) o[a] += nearest * w[a], normal[a] = 0;
    if (met == bed->n + FIBRAD_CYLINDER) {
        normal[0] = (cylinder[0] - o[0]) / cylinder[2], normal[1] = (cylinder[1] - o[1]) / cylinder[2];
    } else if (met >= bed->n) {
        normal[(met - bed->n) / 2] = (met - bed->n) % 2 ? -1 : 1;
    } else {
        normal[0] = (o[0] - bed->x[met]) / bed->r[met], normal[1] = (o[1] - bed->y[met]) / bed->r[met];
        normal[2] = (o[2] - bed->z[met]) / bed->r[met];
    }
    return met;
}

/* Net power of sphere i by paths that are followed backwards. Each path brings the emission of its last surface. */
static inline double power_by_paths(const struct problem *p, uint32_t i, uint32_t paths) {
    double sum = 0;
    for (uint32_t k = 0; k < paths; k++) {
        fibrad_random random = fibrad_random_start(i, k);
        double n[3], o[3], w[3], sine, cosine;
        const double z = 2 * fibrad_random_next(&random) - 1;
        fibrad_sincos_turn(fibrad_random_next(&random), &sine, &cosine);
        n[0] = sqrt(1 - z * z) * cosine, n[1] = sqrt(1 - z * z) * sine, n[2] = z;
        o[0] = p->bed.x[i] + p->bed.r[i] * n[0], o[1] = p->bed.y[i] + p->bed.r[i] * n[1];
        o[2] = p->bed.z[i] + p->bed.r[i] * n[2];
        for (uint32_t at = i;;) {
            const double u = fibrad_random_next(&random), v = fibrad_random_next(&random);
            diffuse(n, u, v, w);
            at = first_met(p, at, o, w, n);
            const uint32_t wall = at - p->bed.n;
            const double eps = at < p->bed.n ? p->emissivity[at] : p->wall_emissivity[wall];
            if (fibrad_random_next(&random) >= eps) continue;
            sum += emission(at < p->bed.n ? p->temperature[at] : p->wall_temperature[wall]);
            break;
        }
    }
    return p->emissivity[i] * sphere_area(&p->bed, i) * (sum / paths - emission(p->temperature[i]));
}

/* The planes that are missing if a box of some planes would be endless. */
static inline uint32_t openings_of(uint32_t planes) {
    const int axes = ((planes & 3) > 0) + ((planes & 12) > 0) + ((planes & 48) > 0);
    return axes > 1 ? 63 & ~planes : 0;
}

#endif
