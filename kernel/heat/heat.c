/* heat.c - lays out a heat problem, has its beams followed, takes its sources and hands out its powers.
 * SPDX-License-Identifier: MIT */
#include "base/arena.h"
#include "heat/hits_lanes.h"
#include "heat/sphere_patch.h"
#include "row/beam.h"
#include "sample/tables.h"

#define PI         3.14159265358979323846
#define DIRECTIONS 168u
#define POINTS     64u
#define PATCHES    96u
#define PARTS      8u
#define PARTS_MAX  1024u
#define TOLERANCE  1e-3
#define SWEEPS_MAX 1000u
/* Errors over what they are told from, as measured: docs/heat.md. */
#define PATCH_ERROR .2
#define BEAM_ERROR  .2
#define FEW_ERROR   .25

static fibrad_heat_config completed(const fibrad_heat_config *config) {
    fibrad_heat_config c = {0};
    if (config != NULL) c = *config;
    if (c.directions == 0) c.directions = DIRECTIONS;
    if (c.points == 0) c.points = POINTS;
    if (c.patches == 0) c.patches = PATCHES;
    if (c.parts == 0) c.parts = PARTS;
    return c;
}

/* Squares along an edge of the cube; 0: no such number of patches. */
static uint32_t side_of(uint32_t patches) { return patches == 24 ? 2 : patches == 96 ? 4 : patches == 384 ? 8 : 0; }

static bool valid(const fibrad_heat_config *c, const fibrad_scene *scene) {
    fibrad_disc_points set;
    return c->directions >= FIBRAD_DIRECTIONS_MIN && c->directions <= FIBRAD_DIRECTIONS_MAX &&
           fibrad_disc_points_get(c->points, &set) == FIBRAD_OK && side_of(c->patches) > 0 && c->parts <= PARTS_MAX &&
           scene->facts.spheres <= (UINT32_MAX >> 1) / c->patches;
}

/* The numbers that follow from a valid configuration. */
static void dimension(fibrad_heat *heat, const fibrad_heat_config *config, const fibrad_scene *scene) {
    const uint32_t spheres = scene->facts.spheres;
    heat->config = *config;
    heat->scene = scene;
    heat->beams = config->directions * config->points;
    heat->side = side_of(config->patches);
    heat->bodies = spheres + 2 * FIBRAD_WALLS + 1;
    heat->patches = spheres * config->patches + 1;
    fibrad_heat_cut_walls(heat);
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++)
        heat->patches += heat->wall[k].squares[0] * heat->wall[k].squares[1] + heat->wall[k].unbounded;
}

/* Takes the arrays from the arena; the object itself is to be copied to the address returned. */
static fibrad_heat *layout(fibrad_arena *arena, fibrad_heat *heat) {
    fibrad_heat *place = fibrad_arena_take(arena, 1, sizeof *place);
    const uint32_t spheres = heat->scene->facts.spheres;
    heat->first = fibrad_arena_take(arena, heat->bodies + 1, sizeof *heat->first);
    heat->leave = fibrad_arena_take(arena, heat->beams, sizeof *heat->leave);
    heat->hit = fibrad_arena_take(arena, (size_t)spheres * heat->beams, sizeof *heat->hit);
    heat->ray = fibrad_arena_take(arena, heat->rays, sizeof *heat->ray);
    heat->source = fibrad_arena_take(arena, heat->patches, sizeof *heat->source);
    heat->gathered = fibrad_arena_take(arena, (size_t)heat->patches * heat->config.parts, sizeof(double));
    double **const of_patches[] = {&heat->area, &heat->radiosity, &heat->detail, &heat->net, &heat->direction};
    for (size_t k = 0; k < sizeof of_patches / sizeof *of_patches; k++)
        *of_patches[k] = fibrad_arena_take(arena, heat->patches, sizeof(double));
    double **const of_bodies[] = {&heat->emissivity, &heat->emission, &heat->coarse, &heat->power};
    for (size_t k = 0; k < sizeof of_bodies / sizeof *of_bodies; k++)
        *of_bodies[k] = fibrad_arena_take(arena, heat->bodies, sizeof(double));
    heat->doubt = fibrad_arena_take(arena, spheres, sizeof(double));
    return place;
}

size_t fibrad_heat_size(const fibrad_heat_config *config, const fibrad_scene *scene) {
    if (scene == NULL) return 0;
    fibrad_heat_config c = completed(config);
    if (!valid(&c, scene)) return 0;
    fibrad_arena arena = {0};
    fibrad_heat fields = {0};
    dimension(&fields, &c, scene);
    layout(&arena, &fields);
    return fibrad_arena_total(&arena);
}

/* Numbers the patches through and tells each how many beams leave its surface per area. */
static void number_patches(fibrad_heat *heat) {
    const fibrad_scene *scene = heat->scene;
    uint32_t a = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const uint32_t wall = b - scene->facts.spheres; /* only if not a sphere */
        uint32_t count = 1;
        double density = 0;
        if (b < scene->facts.spheres)
            count = heat->config.patches, density = heat->beams / (4 * PI * scene->r[b] * scene->r[b]);
        else if (wall < FIBRAD_WALLS)
            count = heat->wall[wall].squares[0] * heat->wall[wall].squares[1];
        else if (wall < 2 * FIBRAD_WALLS)
            count = heat->wall[wall - FIBRAD_WALLS].unbounded;
        heat->first[b] = a;
        for (uint32_t end = a + count; a < end; a++) heat->source[a].density = density;
    }
    heat->first[heat->bodies] = a;
}

/* Which patch of its sphere each beam leaves. */
static void find_origins(fibrad_heat *heat) {
    const uint32_t points = heat->config.points;
    fibrad_disc_points set = {NULL, NULL};
    if (fibrad_disc_points_get(points, &set) != FIBRAD_OK) return;
    for (uint32_t k = 0; k < heat->config.directions; k++) {
        double frame[9], n[3];
        fibrad_beam_frame(k, heat->config.directions, points, frame);
        for (uint32_t p = 0; p < points; p++) {
            const double x = set.x[p], y = set.y[p], up = fibrad_sqrt(fibrad_max(0, 1 - (x * x + y * y)));
            for (int axis = 0; axis < 3; axis++) n[axis] = x * frame[axis] + y * frame[3 + axis] + up * frame[6 + axis];
            heat->leave[k * points + p] = (uint16_t)fibrad_patch_of(n, heat->side);
        }
    }
}

int fibrad_heat_init(fibrad_heat **out, void *memory, size_t size, const fibrad_heat_config *config,
                     const fibrad_scene *scene) {
    if (out == NULL || scene == NULL) return FIBRAD_E_ARGUMENT;
    fibrad_arena arena;
    int status = fibrad_arena_open(&arena, memory, size, fibrad_heat_size(config, scene));
    if (status != FIBRAD_OK) return status;
    fibrad_heat_config c = completed(config);
    fibrad_heat fields = {0};
    dimension(&fields, &c, scene);
    fibrad_heat *heat = layout(&arena, &fields);
    *heat = fields;
    number_patches(heat);
    find_origins(heat);
    *out = heat;
    return FIBRAD_OK;
}

uint32_t fibrad_heat_tasks(const fibrad_heat *heat) {
    return heat->scene->facts.spheres + (heat->rays + FIBRAD_HEAT_TASK - 1) / FIBRAD_HEAT_TASK;
}

int fibrad_heat_trace(fibrad_heat *heat, fibrad_workspace *work, uint32_t task) {
    if (heat == NULL || work == NULL || task >= fibrad_heat_tasks(heat)) return FIBRAD_E_ARGUMENT;
    switch (heat->scene->facts.isa) {
#ifdef FIBRAD_WITH_SSE2
    case FIBRAD_ISA_SSE2:
        return fibrad_heat_follow_sse2(heat, work, task);
#endif
#ifdef FIBRAD_WITH_AVX2
    case FIBRAD_ISA_AVX2:
        return fibrad_heat_follow_avx2(heat, work, task);
#endif
#ifdef FIBRAD_WITH_AVX512
    case FIBRAD_ISA_AVX512:
        return fibrad_heat_follow_avx512(heat, work, task);
#endif
    }
    return fibrad_heat_follow_scalar(heat, work, task);
}

static bool is_share(double x) { return x >= 0 && x <= 1; }

static bool is_temperature(double t) { return t >= 0 && fibrad_finite(t); }

static bool sources_valid(const fibrad_heat *heat, const fibrad_heat_sources *s) {
    if (s->temperature == NULL || s->emissivity == NULL) return false;
    for (uint32_t i = 0; i < heat->scene->facts.spheres; i++)
        if (!is_temperature(s->temperature[i]) || !is_share(s->emissivity[i])) return false;
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++) {
        if (!(heat->scene->facts.wall_area[k] > 0)) continue;
        if (!is_temperature(s->wall_temperature[k]) || !is_share(s->wall_emissivity[k])) return false;
    }
    return is_temperature(s->surroundings) && s->sigma > 0 && fibrad_finite(s->sigma) && s->tolerance >= 0 &&
           s->tolerance < 1;
}

/* sigma (T^4 - T0^4), T0 being that of the surroundings: all emission and radiosity is counted from theirs. */
static double emission_of(const fibrad_heat_sources *s, double t) {
    const double t0 = s->surroundings;
    return s->sigma * (t * t + t0 * t0) * (t + t0) * (t - t0);
}

/* Emissivity and emission of a body. What lies beyond the patches of a wall receives no more than the surroundings
 * send, its area being infinite; so it is like a black body of that radiosity. */
static void set_body(fibrad_heat *heat, const fibrad_heat_sources *s, uint32_t b) {
    const uint32_t spheres = heat->scene->facts.spheres;
    double eps = 1, emission = 0;
    if (b < spheres) {
        const uint32_t i = heat->scene->order[b];
        eps = s->emissivity[i], emission = emission_of(s, s->temperature[i]);
    } else if (b + 1 < heat->bodies) {
        const uint32_t wall = (b - spheres) % FIBRAD_WALLS;
        const double wall_eps = heat->wall_emissivity[wall], wall_emission = heat->wall_emission[wall];
        if (b < spheres + FIBRAD_WALLS)
            eps = wall_eps, emission = wall_emission;
        else
            emission = wall_eps * wall_emission;
    }
    /* an earlier solution goes up or down with the emission; the coarser level begins with what it had of it */
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) {
        if (heat->phase == FIBRAD_HEAT_DONE && !s->uniform && eps < 1)
            heat->radiosity[a] += emission - heat->emission[b] - heat->detail[a];
        else
            heat->radiosity[a] = emission, heat->detail[a] = 0;
    }
    heat->emissivity[b] = eps, heat->emission[b] = emission;
}

int fibrad_heat_begin(fibrad_heat *heat, const fibrad_heat_sources *sources) {
    if (heat == NULL || sources == NULL || !sources_valid(heat, sources)) return FIBRAD_E_ARGUMENT;
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++) {
        const bool there = heat->scene->facts.wall_area[k] > 0;
        heat->wall_emissivity[k] = there ? sources->wall_emissivity[k] : 0;
        heat->wall_emission[k] = there ? emission_of(sources, sources->wall_temperature[k]) : 0;
    }
    for (uint32_t b = 0; b < heat->bodies; b++) set_body(heat, sources, b);
    heat->group = sources->uniform ? UINT32_MAX : 4;
    heat->tolerance = sources->tolerance > 0 ? sources->tolerance : TOLERANCE;
    heat->limit = sources->sweeps_max > 0 ? sources->sweeps_max : SWEEPS_MAX;
    heat->sweeps = 0;
    fibrad_heat_start(heat);
    return FIBRAD_OK;
}

int fibrad_heat_read(const fibrad_heat *heat, fibrad_heat_result *result) {
    if (heat == NULL || result == NULL || result->power == NULL || heat->phase != FIBRAD_HEAT_DONE)
        return FIBRAD_E_ARGUMENT;
    const uint32_t spheres = heat->scene->facts.spheres, open = heat->bodies - 1;
    double patches = 0, beams = 0, square = 0, reflected = 0;
    for (uint32_t b = 0; b < spheres; b++) {
        const double change = heat->power[b] - heat->coarse[b];
        result->power[heat->scene->order[b]] = heat->power[b];
        patches += change * change, square += heat->power[b] * heat->power[b], reflected += 1 - heat->emissivity[b];
        beams += heat->doubt[b] * heat->doubt[b];
    }
    result->surroundings_power = heat->power[open];
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++) {
        const uint32_t beyond = fibrad_heat_beyond(heat, k), a = heat->first[beyond];
        result->wall_power[k] = heat->power[fibrad_heat_wall_body(heat, k)];
        if (a == heat->first[beyond + 1]) continue;
        /* beyond its patches the wall takes eps of what comes and reflects the rest to the surroundings */
        const double less = heat->radiosity[a] - heat->wall_emission[k];
        const double absorbed = heat->wall_emissivity[k] * (heat->net[a] + heat->area[a] * less);
        result->wall_power[k] += absorbed;
        result->surroundings_power += heat->power[beyond] - absorbed;
    }
    /* patches that few beams leave send too much back along each; not so if there is one radiosity per body */
    const double each = heat->group == 1 ? 2.0 * heat->beams / heat->config.patches : __builtin_inf();
    const double few = FEW_ERROR / each * fibrad_sqrt(reflected / spheres);
    result->error_patches = PATCH_ERROR * fibrad_sqrt(patches / spheres);
    result->error_beams = fibrad_sqrt((BEAM_ERROR * BEAM_ERROR * beams + few * few * square) / spheres);
    result->sweeps = heat->sweeps;
    result->residual = heat->scale > 0 ? fibrad_sqrt(heat->slope / heat->scale) : 0;
    return FIBRAD_OK;
}
