/* heat.c - lays out a heat problem, takes its sources and hands out its powers. SPDX-License-Identifier: MIT */
#include "heat/heat.h"
#include "base/arena.h"
#include "heat/beams_lanes.h"
#include "sample/tables.h"

#define DIRECTIONS 144u
#define POINTS     64u
#define PATCHES    96u
#define PARTS      8u

static fibrad_heat_config completed(const fibrad_heat_config *config) {
    fibrad_heat_config c = *config;
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
           fibrad_disc_points_get(c->points, &set) == FIBRAD_OK && side_of(c->patches) > 0 && c->parts <= 1024 &&
           scene->facts.spheres < UINT32_MAX / c->patches - 1;
}

/* Takes the arrays from the arena; the object itself is to be copied to the address returned. */
static fibrad_heat *layout(fibrad_arena *arena, const fibrad_heat_config *config, const fibrad_scene *scene,
                           fibrad_heat *heat) {
    fibrad_heat *place = fibrad_arena_take(arena, 1, sizeof *place);
    const size_t spheres = scene->facts.spheres;
    heat->config = *config;
    heat->scene = scene;
    heat->beams = config->directions * config->points;
    heat->side = side_of(config->patches);
    heat->patches = (uint32_t)(spheres * config->patches) + 1;
    heat->leave = fibrad_arena_take(arena, heat->beams, sizeof *heat->leave);
    heat->hit = fibrad_arena_take(arena, spheres * heat->beams, sizeof *heat->hit);
    heat->source = fibrad_arena_take(arena, heat->patches, sizeof *heat->source);
    heat->gathered = fibrad_arena_take(arena, (size_t)heat->patches * config->parts, sizeof(double));
    double **const vectors[] = {&heat->area,      &heat->radiosity,  &heat->received,
                                &heat->direction, &heat->emissivity, &heat->emission};
    for (size_t k = 0; k < sizeof vectors / sizeof *vectors; k++)
        *vectors[k] = fibrad_arena_take(arena, heat->patches, sizeof(double));
    heat->coarse = fibrad_arena_take(arena, spheres, sizeof(double));
    return place;
}

size_t fibrad_heat_size(const fibrad_heat_config *config, const fibrad_scene *scene) {
    if (config == NULL || scene == NULL) return 0;
    fibrad_heat_config c = completed(config);
    if (!valid(&c, scene)) return 0;
    fibrad_arena arena = {0};
    fibrad_heat fields = {0};
    layout(&arena, &c, scene, &fields);
    return fibrad_arena_total(&arena);
}

int fibrad_heat_init(fibrad_heat **out, void *memory, size_t size, const fibrad_heat_config *config,
                     const fibrad_scene *scene) {
    if (out == NULL) return FIBRAD_E_ARGUMENT;
    fibrad_arena arena;
    int status = fibrad_arena_open(&arena, memory, size, fibrad_heat_size(config, scene));
    if (status != FIBRAD_OK) return status;
    fibrad_heat_config c = completed(config);
    fibrad_heat fields = {0};
    fibrad_heat *heat = layout(&arena, &c, scene, &fields);
    for (uint32_t a = 0; a < fields.patches; a++) {
        double r = a + 1 < fields.patches ? scene->r[a / c.patches] : __builtin_inf();
        fields.source[a].density = fields.beams / (4 * 3.14159265358979323846 * r * r);
    }
    *heat = fields;
    fibrad_heat_leave_function *leave = fibrad_heat_leave_scalar;
    switch (scene->facts.isa) {
#ifdef FIBRAD_WITH_SSE2
    case FIBRAD_ISA_SSE2:
        leave = fibrad_heat_leave_sse2;
        break;
#endif
#ifdef FIBRAD_WITH_AVX2
    case FIBRAD_ISA_AVX2:
        leave = fibrad_heat_leave_avx2;
        break;
#endif
#ifdef FIBRAD_WITH_AVX512
    case FIBRAD_ISA_AVX512:
        leave = fibrad_heat_leave_avx512;
        break;
#endif
    }
    leave(heat);
    *out = heat;
    return FIBRAD_OK;
}

int fibrad_heat_trace(fibrad_heat *heat, fibrad_work *work, uint32_t i) {
    if (heat == NULL || work == NULL || i >= heat->scene->facts.spheres) return FIBRAD_E_ARGUMENT;
    fibrad_heat_beams_function *beams = fibrad_heat_beams_scalar;
    switch (heat->scene->facts.isa) {
#ifdef FIBRAD_WITH_SSE2
    case FIBRAD_ISA_SSE2:
        beams = fibrad_heat_beams_sse2;
        break;
#endif
#ifdef FIBRAD_WITH_AVX2
    case FIBRAD_ISA_AVX2:
        beams = fibrad_heat_beams_avx2;
        break;
#endif
#ifdef FIBRAD_WITH_AVX512
    case FIBRAD_ISA_AVX512:
        beams = fibrad_heat_beams_avx512;
        break;
#endif
    }
    return beams(heat, work, heat->scene->place[i]);
}
