/* radiation.c - net radiative powers of a bed that may move. SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "simple/heap.h"
#include "simple/team.h"

enum { PARTS = 16, TASKS_AT_ONCE = 16 };

struct fibrad_radiation {
    fibrad_team team;
    fibrad_heat_config config;
    fibrad_heat *heat; /* NULL: none yet */
    void *heat_block;
    size_t heat_size; /* bytes of heat_block; 0: none */
    fibrad_scene *scene;
    void *scene_block;
    uint32_t n;
    fibrad_fault fault;
    double *light;  /* [patches] of the last fibrad_radiation_shine; NULL: none */
    double *places; /* memory of fibrad_heat_sources.contact_places in the last solution; NULL: none */
    bool busy;      /* within a call */
};

/* Begins a call that ends with end_call. A function of the caller that runs within a call can begin no other. */
static int begin_call(fibrad_radiation *r) {
    if (!r) return FIBRAD_E_ARGUMENT;
    if (r->busy) return FIBRAD_E_STATE;
    r->busy = true;
    return FIBRAD_OK;
}

static int end_call(fibrad_radiation *r, int status) {
    r->busy = false;
    return status;
}

static int trace_beams(void *radiation, int thread, uint32_t task) {
    fibrad_radiation *r = radiation;
    return fibrad_heat_trace(r->heat, &r->team.work[thread], task);
}

/* Replaces the heat problem by a new one in a block of `at_least` bytes or more. */
static int replace_heat(fibrad_radiation *r, const fibrad_scene *scene, size_t at_least) {
    fibrad_heat *heat;
    size_t size = fibrad_heat_size(&r->config, scene);
    if (!size) return FIBRAD_E_ARGUMENT;
    if (size < at_least) size = at_least;
    void *block = malloc(size);
    if (!block) return FIBRAD_E_MEMORY;
    const int status = fibrad_heat_init(&heat, block, size, &r->config, scene);
    if (status) {
        free(block);
        return status;
    }
    free(r->heat_block);
    r->heat = heat;
    r->heat_block = block;
    r->heat_size = size;
    return FIBRAD_OK;
}

/* Moves the problem to another scene. If the moved walls need a larger block, makes a new problem. */
static int move_heat(fibrad_radiation *r, const fibrad_scene *scene) {
    const int status = r->heat ? fibrad_heat_move(r->heat, scene) : FIBRAD_E_SIZE;
    return status == FIBRAD_E_SIZE ? replace_heat(r, scene, 0) : status;
}

/* Traces all beams. FIBRAD_E_SIZE: spheres see more others than the block has room for; the block is doubled. */
static int trace_all(fibrad_radiation *r) {
    for (;;) {
        const uint32_t tasks = fibrad_heat_tasks(r->heat);
        int status = fibrad_team_run(&r->team, "beams", tasks, TASKS_AT_ONCE, trace_beams, r, NULL);
        r->fault.triangle = r->team.triangle;
        if (status != FIBRAD_E_SIZE) return status;
        status = replace_heat(r, r->scene, 2 * r->heat_size);
        if (status) return status;
    }
}

static int move_bed(fibrad_radiation *r, const fibrad_scene_config *config, const fibrad_spheres *spheres) {
    fibrad_scene *scene;
    void *block;
    r->fault = (fibrad_fault){spheres->n, spheres->n, UINT32_MAX, 0, 0};
    if (r->heat && spheres->n != r->n) return FIBRAD_E_ARGUMENT;
    int status = fibrad_heap_scene(&scene, &block, config, spheres, &r->fault);
    if (!status) status = move_heat(r, scene);
    if (status) {
        free(block);
        return status;
    }
    free(r->scene_block);
    r->scene = scene;
    r->scene_block = block;
    r->n = spheres->n;
    return trace_all(r);
}

int fibrad_radiation_move(fibrad_radiation *r, const fibrad_scene_config *config, const fibrad_spheres *spheres) {
    if (!spheres) return FIBRAD_E_ARGUMENT;
    const int status = begin_call(r);
    return status ? status : end_call(r, move_bed(r, config, spheres));
}

int fibrad_radiation_new(fibrad_radiation **radiation, const fibrad_scene_config *config, const fibrad_spheres *spheres,
                         const fibrad_heat_config *heat_config, fibrad_run *run) {
    if (!radiation) return FIBRAD_E_ARGUMENT;
    fibrad_radiation *r = calloc(1, sizeof *r);
    *radiation = NULL;
    if (!r) return FIBRAD_E_MEMORY;
    if (spheres) r->fault = (fibrad_fault){spheres->n, spheres->n, UINT32_MAX, 0, 0};
    if (heat_config) r->config = *heat_config;
    r->config.parts = PARTS;
    int status = fibrad_team_open(&r->team, run);
    if (!status) status = fibrad_radiation_move(r, config, spheres);
    if (run) run->fault = r->fault;
    if (status)
        fibrad_radiation_free(r);
    else
        *radiation = r;
    return status;
}

static int sweep_beams(void *heat, int thread, uint32_t part) {
    (void)thread;
    return fibrad_heat_sweep(heat, part);
}

/* Makes room for contacts at their places, if spheres conduct. In steps in time contacts act on means of surfaces. */
static int make_places(fibrad_radiation *r, fibrad_heat_sources *sources) {
    free(r->places);
    r->places = NULL;
    if (sources->contacts == 0 || !sources->conductivity || sources->hold || sources->contact_places) return FIBRAD_OK;
    r->places = malloc((4 * (size_t)sources->contacts + fibrad_heat_patches(r->heat)) * sizeof *r->places);
    sources->contact_places = r->places;
    return r->places ? FIBRAD_OK : FIBRAD_E_MEMORY;
}

/* Finds a solution, which is then read. */
static int find_solution(fibrad_radiation *r, const fibrad_heat_sources *given) {
    fibrad_heat_sources sources = *given;
    if (!r->heat) return FIBRAD_E_STATE;
    r->fault = (fibrad_fault){r->n, r->n, UINT32_MAX, 0, 0};
    int solved = 0, status = fibrad_heat_check(r->heat, &sources, &r->fault);
    if (!status) status = make_places(r, &sources);
    if (!status) status = fibrad_heat_begin(r->heat, &sources);
    for (uint64_t sweeps = 0; !status && !solved; ++sweeps) {
        status = fibrad_team_report(&r->team, "sweeps", sweeps, 0);
        if (!status) status = fibrad_team_run(&r->team, NULL, PARTS, 1, sweep_beams, r->heat, NULL);
        if (!status) status = fibrad_heat_step(r->heat, &solved);
    }
    return status;
}

static int solve_sources(fibrad_radiation *r, const fibrad_heat_sources *sources, fibrad_heat_result *result) {
    const int status = find_solution(r, sources);
    return status ? status : fibrad_heat_read(r->heat, result);
}

int fibrad_radiation_solve(fibrad_radiation *r, const fibrad_heat_sources *sources, fibrad_heat_result *result) {
    const int status = begin_call(r);
    return status ? status : end_call(r, solve_sources(r, sources, result));
}

int fibrad_radiation_sides(const fibrad_radiation *r, double *flux, double *temperature) {
    if (!r) return FIBRAD_E_ARGUMENT;
    return r->heat ? fibrad_heat_read_sides(r->heat, flux, temperature) : FIBRAD_E_STATE;
}

#define EMISSIVITY_CHANGE   1e-5
#define CONDUCTIVITY_CHANGE 1e-4 /* relative */
enum { SETTLE_MAX = 100 };

/* Whether the sources have the arrays of temperatures that the law reads first. */
static bool temperatures_given(const fibrad_heat_sources *s, const fibrad_scene_facts *facts) {
    return (!facts->spheres || s->temperature) && (!facts->walls || s->wall_temperature);
}

static bool are_emissivities(const double *emissivity, uint32_t n) {
    bool valid = true;
    for (uint32_t i = 0; i < n && valid; ++i) valid = emissivity[i] >= 0 && emissivity[i] <= 1;
    return valid;
}

static double largest_change(const double *before, const double *now, uint32_t n) {
    double largest = 0;
    for (uint32_t i = 0; i < n; ++i) {
        const double change = fabs(now[i] - before[i]);
        if (change > largest) largest = change;
    }
    return largest;
}

/* The largest relative change of conductivities above 0, some of which may be infinite. */
static double largest_ratio(const double *before, const double *now, uint32_t n) {
    double largest = 0;
    for (uint32_t i = 0; i < n; ++i) {
        const double change = now[i] == before[i] ? 0 : fabs(now[i] / before[i] - 1);
        if (!(change <= largest)) largest = change;
    }
    return largest;
}

/* The arrays of a problem that follows a law, [spheres] and [walls] each unless said, in one block. */
struct settling {
    double *emissivity, *wall_emissivity, *before, *wall_before, *power, *wall_power, *temperature, *wall_temperature;
    double *conductivity, *conductance; /* [spheres] and [contacts], of the last solution */
};

static void divide_block(double *block, uint32_t n, uint32_t walls, struct settling *s) {
    double **const of_spheres[] = {&s->emissivity, &s->before, &s->power, &s->temperature, &s->conductivity};
    double **const of_walls[] = {&s->wall_emissivity, &s->wall_before, &s->wall_power, &s->wall_temperature};
    for (size_t k = 0; k < sizeof of_spheres / sizeof *of_spheres; ++k, block += n) *of_spheres[k] = n ? block : NULL;
    for (size_t k = 0; k < sizeof of_walls / sizeof *of_walls; ++k, block += walls) *of_walls[k] = walls ? block : NULL;
    s->conductance = block;
}

static void copy_values(double *to, const double *from, uint32_t n) {
    if (n) memcpy(to, from, n * sizeof *to);
}

/* Solves until the emissivities and conductivities that the law gives have settled. Only then is `result` written. */
static int follow_law(fibrad_radiation *r, const fibrad_heat_sources *sources, fibrad_emissivity_law *law,
                      void *context, const fibrad_scene_facts *facts, const struct settling *s,
                      fibrad_heat_result *result) {
    const uint32_t n = facts->spheres, walls = facts->walls, conducting = sources->conductivity ? n : 0;
    const uint32_t contacts = sources->conductance ? sources->contacts : 0;
    fibrad_heat_result found = {.power = s->power,
                                .wall_power = s->wall_power,
                                .temperature = s->temperature,
                                .wall_temperature = s->wall_temperature};
    fibrad_heat_sources now = *sources;
    now.emissivity = s->emissivity, now.wall_emissivity = s->wall_emissivity;
    if (contacts) now.conductance = s->conductance; /* the law may change those of the caller before they are read */
    law(context, sources->temperature, sources->wall_temperature, s->emissivity, s->wall_emissivity);
    for (int k = 0; k < SETTLE_MAX; ++k) {
        copy_values(s->conductance, sources->conductance, contacts);
        int status = find_solution(r, &now);
        if (status) return status;
        status = fibrad_heat_read(r->heat, &found);
        if (status == FIBRAD_E_UNSOLVABLE) (void)fibrad_heat_read(r->heat, result); /* a temperature may be missing */
        if (status) return status;
        copy_values(s->before, s->emissivity, n);
        copy_values(s->wall_before, s->wall_emissivity, walls);
        copy_values(s->conductivity, sources->conductivity, conducting);
        law(context, s->temperature, s->wall_temperature, s->emissivity, s->wall_emissivity);
        if (!are_emissivities(s->emissivity, n) || !are_emissivities(s->wall_emissivity, walls))
            return FIBRAD_E_ARGUMENT;
        if (largest_change(s->before, s->emissivity, n) + largest_change(s->wall_before, s->wall_emissivity, walls) <=
                EMISSIVITY_CHANGE &&
            largest_ratio(s->conductivity, sources->conductivity, conducting) <= CONDUCTIVITY_CHANGE &&
            largest_ratio(s->conductance, sources->conductance, contacts) <= CONDUCTIVITY_CHANGE)
            return fibrad_heat_read(r->heat, result);
    }
    return FIBRAD_E_UNSOLVABLE;
}

int fibrad_radiation_settle(fibrad_radiation *r, const fibrad_heat_sources *sources, fibrad_emissivity_law *law,
                            void *context, double *emissivity, double *wall_emissivity, fibrad_heat_result *result) {
    fibrad_scene_facts facts = {0};
    if (!r || !sources || !law || !result) return FIBRAD_E_ARGUMENT;
    fibrad_scene_describe(r->scene, &facts);
    const uint32_t n = facts.spheres, walls = facts.walls;
    if ((n && !(emissivity && result->temperature)) || (walls && !(wall_emissivity && result->wall_temperature)) ||
        !temperatures_given(sources, &facts))
        return FIBRAD_E_ARGUMENT;
    int status = begin_call(r);
    if (status) return status;
    struct settling s;
    const uint32_t contacts = sources->conductance ? sources->contacts : 0;
    double *block = malloc((5 * (size_t)n + 4 * (size_t)walls + contacts + 1) * sizeof *block);
    if (!block) return end_call(r, FIBRAD_E_MEMORY);
    divide_block(block, n, walls, &s);
    copy_values(s.emissivity, emissivity, n);
    copy_values(s.wall_emissivity, wall_emissivity, walls);
    status = follow_law(r, sources, law, context, &facts, &s, result);
    if (!status) {
        copy_values(emissivity, s.emissivity, n);
        copy_values(wall_emissivity, s.wall_emissivity, walls);
    }
    free(block);
    return end_call(r, status);
}
#define LIGHT_TOLERANCE 1e-5
#define ROUNDING        1e-14 /* relative rounding error of areas that add up to the area of a light */

/* Light that falls on a bed. */
struct shine_tasks {
    fibrad_radiation *radiation;
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

/* Allocates the arrays, in one block but for kept and ray. hits.spots is the radiation's. */
static int begin_shine(struct shine_tasks *t) {
    fibrad_radiation *r = t->radiation;
    const size_t patches = fibrad_heat_patches(r->heat);
    const size_t surfaces = r->n + t->walls;
    double *block = calloc(3 * patches + 4 * surfaces + 2, sizeof *block);
    t->kept = calloc(fibrad_heat_shine_tasks(r->heat) + (size_t)1, sizeof *t->kept);
    if (!block || !t->kept) {
        free(block);
        return FIBRAD_E_MEMORY;
    }
    t->now = block, t->all = block + patches;
    t->hits = (fibrad_light_hits){t->now, block + 2 * patches, r->light, block + 3 * patches};
    t->power = block + 3 * patches + surfaces + 2, t->apart = t->power + surfaces, t->cones = t->apart + surfaces;
    return FIBRAD_OK;
}

static void end_shine(struct shine_tasks *t) {
    free(t->now);
    free(t->kept);
    free(t->ray);
}

static int shine_task(void *tasks, int thread, uint32_t task) {
    const struct shine_tasks *t = tasks;
    return fibrad_heat_shine(t->radiation->heat, &t->radiation->team.work[thread], t->light, task, t->now,
                             &t->kept[task], t->apart);
}

static int scatter_task(void *tasks, int thread, uint32_t task) {
    const struct shine_tasks *t = tasks;
    return fibrad_heat_scatter(t->radiation->heat, &t->radiation->team.work[thread], t->light, t->rays, task, t->ray);
}

/* Subtracts from `ends` the light that the spheres of a task keep. */
static void take_kept(const fibrad_light_ends *kept, uint32_t walls, fibrad_light_ends *ends) {
    ends->spheres += kept->spheres;
    ends->through -= kept->through;
    for (uint32_t b = 0; b < walls; ++b) ends->wall[b] -= kept->wall[b];
}

/* Follows the rays of a light. */
static int scatter_rays(struct shine_tasks *t) {
    fibrad_radiation *r = t->radiation;
    free(t->ray);
    t->rays = fibrad_heat_light_rays(r->heat, t->now);
    t->ray = malloc(t->rays * sizeof *t->ray);
    if (!t->ray) return FIBRAD_E_MEMORY;
    const uint32_t tasks = fibrad_heat_scatter_tasks(t->rays);
    const int status = fibrad_team_run(&r->team, "rays of light", tasks, 1, scatter_task, t, NULL);
    r->fault.triangle = r->team.triangle;
    return status;
}

/* The error of what a surface takes of a cone, over the difference between even and odd directions. */
#define CONE_ERROR .7

/* Adds the squared errors of first hits of one light: of each sphere the mean of two, from its own difference between
 * even and odd directions, and from those of all spheres. Walls take what spheres do not. */
static void add_cone_errors(struct shine_tasks *t) {
    const uint32_t n = t->radiation->n;
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
    fibrad_radiation *r = t->radiation;
    fibrad_light_ends ends;
    const uint32_t tasks = fibrad_heat_shine_tasks(r->heat), patches = fibrad_heat_patches(r->heat);
    int status = fibrad_light_empty(r->scene, &r->team.work[0], t->light, &ends, &r->fault);
    if (status) return status;
    memset(t->now, 0, patches * sizeof *t->now);
    result->incident += ends.through;
    for (uint32_t b = 0; b < t->walls; ++b) result->incident += ends.wall[b];
    status = fibrad_team_run(&r->team, "light", tasks, 1, shine_task, t, NULL);
    for (uint32_t k = 0; k < tasks && !status; ++k) take_kept(&t->kept[k], t->walls, &ends);
    if (!status) status = scatter_rays(t);
    if (!status) status = fibrad_heat_shine_walls(r->heat, &r->team.work[0], t->ray, t->rays, &ends, t->now);
    if (!status)
        status = fibrad_heat_reflect(r->heat, &r->team.work[0], t->light, t->ray, t->rays, t->sources->absorptivity,
                                     t->sources->wall_absorptivity, &t->hits);
    if (!status) status = fibrad_heat_sum_light(r->heat, t->now, t->power, t->power + r->n);
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

static double lesser(double a, double b) { return a < b ? a : b; }

/* The square of the error that rays and beams bring to what a surface absorbs. solved: what it absorbs in the solution.
 * A fraction of the beams that leave patches arrives at the surface; it is taken to be the same for all patches. */
static double error_of_rays(const struct arrived *a, uint32_t surface, double absorptivity, double solved) {
    const double share = absorptivity > 0 && a->all > 0 ? lesser(1, fabs(solved) / (absorptivity * a->all)) : 0;
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
    const uint32_t surfaces = t->radiation->n + t->walls;
    struct arrived arrived = {0, t->hits.squares, t->hits.squares[surfaces + 1], t->cones};
    for (uint32_t a = 0; a < fibrad_heat_patches(t->radiation->heat); ++a) arrived.all += t->hits.light[a];
    return arrived;
}

/* Solves for the light that is absorbed. Temperatures are 0, and absorptivities take the place of emissivities. */
static int absorb(const struct shine_tasks *t, fibrad_light_result *result) {
    fibrad_radiation *r = t->radiation;
    const fibrad_light_sources *s = t->sources;
    const size_t surfaces = r->n + t->walls;
    double *zero = calloc(2 * surfaces + 1, sizeof *zero);
    if (!zero) return FIBRAD_E_MEMORY;
    double *spots = zero + surfaces;
    fibrad_heat_sources sources;
    fibrad_heat_sources_init(&sources);
    sources.temperature = zero, sources.wall_temperature = zero + r->n, sources.surroundings = 0;
    sources.emissivity = s->absorptivity, sources.wall_emissivity = s->wall_absorptivity;
    sources.tolerance = s->tolerance > 0 ? s->tolerance : LIGHT_TOLERANCE, sources.uniform = s->uniform;
    sources.light = t->hits.light;
    fibrad_heat_result solved = {.power = result->absorbed,
                                 .wall_power = result->wall_absorbed,
                                 .power_error = result->absorbed_error,
                                 .wall_error = result->wall_absorbed_error};
    int status = solve_sources(r, &sources, &solved);
    if (!status) status = fibrad_heat_sum_light(r->heat, t->hits.spots, spots, spots + r->n);
    const struct arrived arrived = arrived_of(t);
    if (!status) {
        add_spots(&arrived, 0, r->n, s->absorptivity, spots, result->absorbed, result->absorbed_error);
        add_spots(&arrived, r->n, t->walls, s->wall_absorptivity, spots, result->wall_absorbed,
                  result->wall_absorbed_error);
        const double rays = error_of_rays(&arrived, r->n + t->walls, 1, solved.surroundings_power);
        result->error = sqrt(solved.surroundings_error * solved.surroundings_error + rays);
    }
    result->reflected = solved.surroundings_power, result->error_patches = solved.error_patches,
    result->sweeps = solved.sweeps;
    free(zero);
    return status;
}

static bool shine_valid(const fibrad_radiation *r, const fibrad_light_sources *s, uint32_t walls,
                        const fibrad_light_result *result) {
    return (s->light || s->lights == 0) &&
           (r->n == 0 || (s->absorptivity && result->absorbed && result->absorbed_first)) &&
           (walls == 0 || (s->wall_absorptivity && result->wall_absorbed && result->wall_absorbed_first));
}

/* fmax would need the library of mathematics. */
static double above_zero(double a) { return a > 0 ? a : 0; }

/* Adds up what surfaces absorb after reflections, above and below 0. */
static void add_reflections(const double *absorbed, const double *first, uint32_t n, double *above, double *below) {
    for (uint32_t i = 0; i < n; ++i) {
        *above += above_zero(absorbed[i] - first[i]);
        *below += above_zero(first[i] - absorbed[i]);
    }
}

static void scale_reflections(double *absorbed, const double *first, uint32_t n, double factor) {
    for (uint32_t i = 0; i < n; ++i) absorbed[i] = first[i] + factor * above_zero(absorbed[i] - first[i]);
}

/* By the errors of patches a surface may absorb less than of the light that it meets first. Then it absorbs just that.
 * What all absorb after reflections, and what leaves, are scaled, so that the sum of all stays. */
static void keep_first(uint32_t n, uint32_t walls, fibrad_light_result *light) {
    double above = above_zero(light->reflected), below = above_zero(-light->reflected);
    add_reflections(light->absorbed, light->absorbed_first, n, &above, &below);
    add_reflections(light->wall_absorbed, light->wall_absorbed_first, walls, &above, &below);
    if (below == 0) return;
    const double factor = above > below ? 1 - below / above : 0;
    scale_reflections(light->absorbed, light->absorbed_first, n, factor);
    scale_reflections(light->wall_absorbed, light->wall_absorbed_first, walls, factor);
    light->reflected = factor * above_zero(light->reflected);
}

/* After an error result->lights alone is written. */
static int shine_lights(fibrad_radiation *r, const fibrad_light_sources *s, uint32_t walls,
                        fibrad_light_result *result) {
    fibrad_light_result now = *result;
    double *const last = r->light, *light = calloc(fibrad_heat_patches(r->heat) + (size_t)1, sizeof *light);
    if (!light) return FIBRAD_E_MEMORY;
    r->light = light;
    struct shine_tasks tasks = {.radiation = r, .sources = s, .walls = walls};
    int status = shine_all(&tasks, &now);
    result->lights = now.lights;
    if (!status) status = absorb(&tasks, &now);
    if (!status) status = fibrad_heat_sum_light(r->heat, tasks.all, now.absorbed_first, now.wall_absorbed_first);
    if (!status) status = fibrad_heat_keep_light(r->heat, light);
    end_shine(&tasks);
    r->light = status ? last : light;
    free(status ? light : last);
    if (status) return status;
    for (uint32_t i = 0; i < r->n; ++i) now.absorbed_first[i] *= s->absorptivity[i];
    for (uint32_t b = 0; b < walls; ++b) now.wall_absorbed_first[b] *= s->wall_absorptivity[b];
    keep_first(r->n, walls, &now);
    now.patches = light;
    *result = now;
    return FIBRAD_OK;
}

int fibrad_radiation_shine(fibrad_radiation *r, const fibrad_light_sources *s, fibrad_light_result *result) {
    fibrad_scene_facts facts;
    if (!r || !s || !result) return FIBRAD_E_ARGUMENT;
    if (!r->heat) return FIBRAD_E_STATE;
    fibrad_scene_describe(r->scene, &facts);
    if (!shine_valid(r, s, facts.walls, result)) return FIBRAD_E_ARGUMENT;
    const int status = begin_call(r);
    return status ? status : end_call(r, shine_lights(r, s, facts.walls, result));
}

void fibrad_radiation_describe(const fibrad_radiation *r, fibrad_scene_facts *facts, fibrad_fault *fault) {
    if (!r) return;
    if (facts) fibrad_scene_describe(r->scene, facts);
    if (fault) *fault = r->fault;
}

void fibrad_radiation_free(fibrad_radiation *r) {
    if (!r) return;
    fibrad_team_close(&r->team);
    free(r->heat_block);
    free(r->scene_block);
    free(r->light);
    free(r->places);
    free(r);
}
