/* shine.c - light from outside, and what absorbs it. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "simple/bed.h"

#define LIGHT_TOLERANCE 1e-5
#define ROUNDING        1e-14 /* relative rounding error of areas that add up to the area of a light */

/* Light that falls on a bed. */
struct shine_tasks {
    fibrad_bed *bed;
    const fibrad_light_sources *sources;
    uint32_t walls;
    const fibrad_light *light; /* the light in hand */
    fibrad_light_ends *kept;   /* [tasks], of this light */
    fibrad_light_ray *ray;     /* [rays], of this light */
    uint32_t rays;
    double *now, *all;      /* [patches], first hits of this light, and of all lights so far */
    double *power, *apart;  /* [spheres + walls], first hits of this light, and those of even less odd directions */
    fibrad_light_hits hits; /* of all lights so far */
    double *cones;          /* [spheres + walls], squared errors of first hits of all lights so far, from cones */
};

/* Allocates the arrays, in one block but for kept and ray. hits.spots is the bed's. */
static int begin_shine(struct shine_tasks *t) {
    fibrad_bed *bed = t->bed;
    const size_t patches = fibrad_heat_patches(bed->heat), surfaces = bed->facts.spheres + t->walls;
    double *block = calloc(3 * patches + 4 * surfaces + 2, sizeof *block);
    t->kept = calloc(fibrad_heat_shine_tasks(bed->heat) + (size_t)1, sizeof *t->kept);
    if (!block || !t->kept) {
        free(block);
        return FIBRAD_E_MEMORY;
    }
    t->now = block, t->all = block + patches;
    t->hits = (fibrad_light_hits){t->now, block + 2 * patches, bed->light, block + 3 * patches};
    t->power = block + 3 * patches + surfaces + 2, t->apart = t->power + surfaces, t->cones = t->apart + surfaces;
    return FIBRAD_OK;
}

static int shine_task(void *tasks, int thread, uint32_t task) {
    const struct shine_tasks *t = tasks;
    return fibrad_heat_shine(t->bed->heat, &t->bed->team.work[thread], t->light, task, t->now, &t->kept[task],
                             t->apart);
}

static int scatter_task(void *tasks, int thread, uint32_t task) {
    const struct shine_tasks *t = tasks;
    return fibrad_heat_scatter(t->bed->heat, &t->bed->team.work[thread], t->light, t->rays, task, t->ray);
}

/* Subtracts from `ends` the light that the spheres of a task keep. */
static void take_kept(const fibrad_light_ends *kept, uint32_t walls, fibrad_light_ends *ends) {
    ends->spheres += kept->spheres;
    ends->through -= kept->through;
    for (uint32_t b = 0; b < walls; ++b) ends->wall[b] -= kept->wall[b];
}

/* Follows the rays of a light. */
static int scatter_rays(struct shine_tasks *t) {
    fibrad_bed *bed = t->bed;
    free(t->ray);
    t->rays = fibrad_heat_light_rays(bed->heat, t->now);
    t->ray = malloc(t->rays * sizeof *t->ray);
    if (!t->ray) return FIBRAD_E_MEMORY;
    const uint32_t tasks = fibrad_heat_scatter_tasks(t->rays);
    const int status = fibrad_team_run(&bed->team, "rays of light", tasks, 1, scatter_task, t, NULL);
    bed->fault.triangle = bed->team.triangle;
    return status;
}

/* The error of what a surface takes of a cone, over the difference between even and odd directions. */
#define CONE_ERROR .7

/* Adds the squared errors of first hits of one light: of each sphere the mean of two, from its own difference between
 * even and odd directions, and from those of all spheres. Walls take what spheres do not. */
static void add_cone_errors(struct shine_tasks *t) {
    const uint32_t n = t->bed->facts.spheres;
    double differences = 0, powers = 0;
    for (uint32_t i = 0; i < n; ++i) differences += t->apart[i] * t->apart[i], powers += t->power[i] * t->power[i];
    for (uint32_t i = 0; i < n && differences > 0; ++i)
        t->cones[i] += CONE_ERROR * CONE_ERROR / 2 *
                       (t->apart[i] * t->apart[i] + t->power[i] * t->power[i] * (differences / powers));
    for (uint32_t b = n; b < n + t->walls; ++b)
        if (t->power[b] > 0) t->cones[b] += CONE_ERROR * CONE_ERROR * differences;
}

/* Adds the first hits of one light, and has them reflected. Adds to the result what the light brings, and what of it
 * leaves at once. */
static int shine_one(struct shine_tasks *t, fibrad_light_result *result) {
    fibrad_bed *bed = t->bed;
    fibrad_light_ends ends;
    const uint32_t tasks = fibrad_heat_shine_tasks(bed->heat), patches = fibrad_heat_patches(bed->heat);
    int status = fibrad_light_empty(bed->scene, &bed->team.work[0], t->light, &ends, &bed->fault);
    if (status) return status;
    memset(t->now, 0, patches * sizeof *t->now);
    result->incident += ends.through;
    for (uint32_t b = 0; b < t->walls; ++b) result->incident += ends.wall[b];
    status = fibrad_team_run(&bed->team, "light", tasks, 1, shine_task, t, NULL);
    for (uint32_t k = 0; k < tasks && !status; ++k) take_kept(&t->kept[k], t->walls, &ends);
    if (!status) status = scatter_rays(t);
    if (!status) status = fibrad_heat_shine_walls(bed->heat, &bed->team.work[0], t->ray, t->rays, &ends, t->now);
    if (!status)
        status = fibrad_heat_reflect(bed->heat, &bed->team.work[0], t->light, t->ray, t->rays, t->sources->absorptivity,
                                     t->sources->wall_absorptivity, &t->hits);
    if (!status) status = fibrad_heat_sum_light(bed->heat, t->now, t->power, t->power + bed->facts.spheres);
    if (!status) add_cone_errors(t);
    for (uint32_t a = 0; a < patches; ++a) t->all[a] += t->now[a];
    if (ends.through > ROUNDING * (ends.spheres + ends.through)) result->transmitted += ends.through;
    return status;
}

/* First hits of all lights on all patches, and where they are reflected to. */
static int shine_all(struct shine_tasks *t, fibrad_light_result *result) {
    const fibrad_light_sources *s = t->sources;
    int status = begin_shine(t);
    result->incident = result->transmitted = 0;
    for (uint32_t k = 0; k < s->lights && !status; ++k) {
        t->light = &s->light[k], result->lights = k;
        status = shine_one(t, result);
    }
    if (!status) result->lights = s->lights;
    return status;
}

/* Let n rays or beams carry the power p each. The error of their sum, over sqrt(n) p: they are more evenly spread than
 * random ones. */
#define RAYS_ERROR  .6
#define BEAMS_ERROR .6

/* What has arrived by rays, and what tells its error: sums of squared powers as of fibrad_light_hits. */
struct arrived {
    double all;            /* what rays and patches have reflected once */
    const double *squares; /* [spheres + walls + 1] */
    double beams;
    const double *cones; /* [spheres + walls] */
};

/* The square of the error that rays and beams bring to what a surface absorbs. solved: what it absorbs in the solution.
 * A fraction of the beams that leave patches arrives at the surface; it is taken to be the same for all patches. */
static double error_of_rays(const struct arrived *a, uint32_t surface, double absorptivity, double solved) {
    const double share = absorptivity > 0 && a->all > 0 ? smaller_of(1, fabs(solved) / (absorptivity * a->all)) : 0;
    const double rays = RAYS_ERROR * RAYS_ERROR * a->squares[surface];
    const double beams = BEAMS_ERROR * BEAMS_ERROR * share * (1 - share) * a->beams;
    return absorptivity * absorptivity * (rays + beams);
}

/* Adds to what n surfaces from number `first` on absorb in the solution what they absorb of `spots`, and to the errors
 * of the solution those of rays and cones. */
static void add_spots(const struct arrived *a, uint32_t first, uint32_t n, const double *absorptivity,
                      const double *spots, double *absorbed, double *error) {
    for (uint32_t i = 0; i < n; ++i) {
        const double cone = absorptivity[i] * absorptivity[i] * a->cones[first + i];
        const double more = error_of_rays(a, first + i, absorptivity[i], absorbed[i]) + cone;
        if (error) error[i] = sqrt(error[i] * error[i] + more);
        absorbed[i] += absorptivity[i] * spots[first + i];
    }
}

static struct arrived arrived_of(const struct shine_tasks *t) {
    const uint32_t surfaces = t->bed->facts.spheres + t->walls;
    struct arrived arrived = {0, t->hits.squares, t->hits.squares[surfaces + 1], t->cones};
    for (uint32_t a = 0; a < fibrad_heat_patches(t->bed->heat); ++a) arrived.all += t->hits.light[a];
    return arrived;
}

/* Solves for the light that is absorbed. Temperatures are 0, and absorptivities take the place of emissivities. */
static int absorb(const struct shine_tasks *t, fibrad_light_result *result) {
    fibrad_bed *bed = t->bed;
    const fibrad_light_sources *s = t->sources;
    const size_t surfaces = bed->facts.spheres + t->walls;
    double *zero = calloc(2 * surfaces + 1, sizeof *zero);
    if (!zero) return FIBRAD_E_MEMORY;
    double *spots = zero + surfaces;
    fibrad_heat_sources sources;
    fibrad_heat_sources_init(&sources);
    sources.temperature = zero, sources.wall_temperature = zero + bed->facts.spheres, sources.surroundings = 0;
    sources.emissivity = s->absorptivity, sources.wall_emissivity = s->wall_absorptivity;
    sources.tolerance = s->tolerance > 0 ? s->tolerance : LIGHT_TOLERANCE;
    sources.light = t->hits.light;
    fibrad_heat_result solved = {.power = result->absorbed, .wall_power = result->wall_absorbed};
    solved.power_error = result->absorbed_error, solved.wall_error = result->wall_absorbed_error;
    int status = fibrad_bed_solve_now(bed, &sources, &solved);
    if (!status) status = fibrad_heat_sum_light(bed->heat, t->hits.spots, spots, spots + bed->facts.spheres);
    const struct arrived arrived = arrived_of(t);
    if (!status) {
        add_spots(&arrived, 0, bed->facts.spheres, s->absorptivity, spots, result->absorbed, result->absorbed_error);
        add_spots(&arrived, bed->facts.spheres, t->walls, s->wall_absorptivity, spots, result->wall_absorbed,
                  result->wall_absorbed_error);
        const double rays = error_of_rays(&arrived, bed->facts.spheres + t->walls, 1, solved.surroundings_power);
        result->error = sqrt(solved.surroundings_error * solved.surroundings_error + rays);
    }
    result->reflected = solved.surroundings_power, result->error_patches = solved.error_patches,
    result->sweeps = solved.sweeps;
    free(zero);
    return status;
}

static bool shine_valid(const fibrad_bed *bed, const fibrad_light_sources *s, uint32_t walls,
                        const fibrad_light_result *result) {
    return (s->light || s->lights == 0) &&
           (bed->facts.spheres == 0 || (s->absorptivity && result->absorbed && result->absorbed_first)) &&
           (walls == 0 || (s->wall_absorptivity && result->wall_absorbed && result->wall_absorbed_first));
}

/* Adds up what surfaces absorb after reflections, above and below 0. */
static void add_reflections(const double *absorbed, const double *first, uint32_t n, double *above, double *below) {
    for (uint32_t i = 0; i < n; ++i) {
        *above += larger_of(absorbed[i] - first[i], 0);
        *below += larger_of(first[i] - absorbed[i], 0);
    }
}

static void scale_reflections(double *absorbed, const double *first, uint32_t n, double factor) {
    for (uint32_t i = 0; i < n; ++i) absorbed[i] = first[i] + factor * larger_of(absorbed[i] - first[i], 0);
}

/* By the errors of patches a surface may absorb less than of the light that it meets first. Then it absorbs just that.
 * What all absorb after reflections, and what leaves, are scaled, so that the sum of all stays. */
static void keep_first(uint32_t n, uint32_t walls, fibrad_light_result *light) {
    double above = larger_of(light->reflected, 0), below = larger_of(-light->reflected, 0);
    add_reflections(light->absorbed, light->absorbed_first, n, &above, &below);
    add_reflections(light->wall_absorbed, light->wall_absorbed_first, walls, &above, &below);
    if (below == 0) return;
    const double factor = above > below ? 1 - below / above : 0;
    scale_reflections(light->absorbed, light->absorbed_first, n, factor);
    scale_reflections(light->wall_absorbed, light->wall_absorbed_first, walls, factor);
    light->reflected = factor * larger_of(light->reflected, 0);
}

/* After an error result->lights alone is written. */
static int shine_lights(fibrad_bed *bed, const fibrad_light_sources *s, uint32_t walls, fibrad_light_result *result) {
    fibrad_light_result now = *result;
    double *const last = bed->light, *light = calloc(fibrad_heat_patches(bed->heat) + (size_t)1, sizeof *light);
    if (!light) return FIBRAD_E_MEMORY;
    bed->light = light;
    struct shine_tasks tasks = {.bed = bed, .sources = s, .walls = walls};
    int status = shine_all(&tasks, &now);
    result->lights = now.lights;
    if (!status) status = absorb(&tasks, &now);
    if (!status) status = fibrad_heat_sum_light(bed->heat, tasks.all, now.absorbed_first, now.wall_absorbed_first);
    if (!status) status = fibrad_heat_keep_light(bed->heat, light);
    free(tasks.now);
    free(tasks.kept);
    free(tasks.ray);
    bed->light = status ? last : light;
    free(status ? light : last);
    if (status) return status;
    for (uint32_t i = 0; i < bed->facts.spheres; ++i) now.absorbed_first[i] *= s->absorptivity[i];
    for (uint32_t b = 0; b < walls; ++b) now.wall_absorbed_first[b] *= s->wall_absorptivity[b];
    keep_first(bed->facts.spheres, walls, &now);
    now.patches = light;
    *result = now;
    return FIBRAD_OK;
}

int fibrad_bed_shine(fibrad_bed *bed, const fibrad_light_sources *s, fibrad_light_result *result) {
    if (!bed || !s || !result || !shine_valid(bed, s, bed->facts.walls, result)) return FIBRAD_E_ARGUMENT;
    int status = fibrad_bed_begin(bed);
    if (status) return status;
    status = fibrad_bed_trace(bed);
    return fibrad_bed_end(bed, status ? status : shine_lights(bed, s, bed->facts.walls, result));
}
