/* sweep.c - net flows between patches, a sweep over all beams. SPDX-License-Identifier: MIT
 *
 * Each beam gives to one end what it takes from the other: flows add up to zero whatever is sent, and are zero where
 * all send alike. */
#include "heat/sweep.h"

#define BEYOND (FIBRAD_WALLS + 1)

/* Halves of rays are independent, so that by how much they differ is their error; those of directions differ by more.
 */
#define RAYS_WEIGHT 2.5

/* A beam stands for the area 1/(n + m) if its two surfaces send out n and m beams per area: so the beams either way
 * together tell what the two exchange, those of the denser one counting as much more as there are more of them. */
static double beam_area(const fibrad_heat_source *a, const fibrad_heat_source *b) {
    return 1 / (a->density + b->density);
}

/* Many beams meet the few patches that lie beyond the walls and their patches; one sum of all would lose digits. So
 * what has come to them lately is moved to a longer sum. */
static void set_aside(const fibrad_heat *heat, double *to, double sum[BEYOND]) {
    const uint32_t first = heat->first[fibrad_heat_beyond(heat, 0)];
    for (uint32_t b = first; b < heat->patches; b++) sum[b - first] += to[b], to[b] = 0;
}

/* What flows count for by direction k of n, or ray k: 1, but in the sweep for the error that much more by even ones
 * than by odd ones. The first and the last direction are halved, or the even ones would lean to one side. */
static double half_sign(const fibrad_heat *heat, uint32_t k, uint32_t n) {
    if (heat->phase != FIBRAD_HEAT_CHECK) return 1;
    return (k % 2 == 0 ? 1 : -1) * (k == 0 || k + 1 == n ? .5 : 1);
}

/* Adds what the beams of one sphere bring to its own patches, and to those they meet; or, in the first sweep of all,
 * the areas they stand for. */
static void sweep_sphere(const fibrad_heat *heat, uint32_t place, double *to, double away[BEYOND]) {
    const uint32_t *hit = heat->hit + (size_t)place * heat->beams, patches = heat->config.patches;
    const fibrad_heat_source *source = heat->source, *mine = source + (size_t)place * patches;
    const bool areas = heat->phase == FIBRAD_HEAT_AREA;
    double own[FIBRAD_HEAT_PATCHES_MAX] = {0}, sum[BEYOND] = {0};
    for (uint32_t direction = 0; direction < heat->config.directions; direction++) {
        const double sign = half_sign(heat, direction, heat->config.directions);
        const uint32_t begin = direction * heat->config.points;
        for (uint32_t k = begin; k < begin + heat->config.points; k++) {
            const uint32_t a = heat->leave[k], b = hit[k];
            const double area = sign * beam_area(mine, &source[b]);
            const double flow = areas ? area : area * (source[b].value - mine[a].value);
            own[a] += flow;
            to[b] += areas ? flow : -flow;
        }
        set_aside(heat, to, sum);
    }
    for (uint32_t a = 0; a < patches; a++) to[(size_t)place * patches + a] += own[a];
    for (int b = 0; b < BEYOND; b++) away[b] += sum[b];
}

static void sweep_rays(const fibrad_heat *heat, uint32_t begin, uint32_t end, double *to, double away[BEYOND]) {
    const bool areas = heat->phase == FIBRAD_HEAT_AREA;
    for (uint32_t k = begin; k < end; k++) {
        const fibrad_heat_ray ray = heat->ray[k];
        const double area = (heat->phase == FIBRAD_HEAT_CHECK ? RAYS_WEIGHT * (1 - 2 * (double)(k % 2)) : 1) * ray.area;
        const double flow = areas ? area : area * (heat->source[ray.to].value - heat->source[ray.from].value);
        to[ray.from] += flow;
        to[ray.to] += areas ? flow : -flow;
        if (k % 64 == 63) set_aside(heat, to, away);
    }
}

/* Where a part begins of n things. */
static uint32_t part_begin(const fibrad_heat *heat, uint32_t n, uint32_t part) {
    return (uint32_t)((uint64_t)n * part / heat->config.parts);
}

/* All of a part but the note that it is done. */
static void sweep_part(fibrad_heat *heat, uint32_t part) {
    const uint32_t spheres = heat->spheres;
    const uint32_t begin = part_begin(heat, spheres, part), end = part_begin(heat, spheres, part + 1);
    double *to = heat->gathered + (size_t)part * heat->patches, away[BEYOND] = {0};
    fibrad_zero(to, heat->patches * sizeof *to);
    for (uint32_t place = begin; place < end; place++) sweep_sphere(heat, place, to, away);
    sweep_rays(heat, part_begin(heat, heat->rays, part), part_begin(heat, heat->rays, part + 1), to, away);
    set_aside(heat, to, away);
    const uint32_t few = heat->first[fibrad_heat_beyond(heat, 0)];
    fibrad_copy(to + few, away, (heat->patches - few) * sizeof *to);
}

int fibrad_heat_sweep(fibrad_heat *heat, uint32_t part) {
    if (heat == NULL || part >= heat->config.parts) return FIBRAD_E_ARGUMENT;
    if (heat->phase == FIBRAD_HEAT_IDLE || heat->phase == FIBRAD_HEAT_DONE || heat->swept[part]) return FIBRAD_E_STATE;
    sweep_part(heat, part);
    heat->swept[part] = 1;
    return FIBRAD_OK;
}

const double *fibrad_heat_gathered(fibrad_heat *heat) {
    double *sum = heat->gathered;
    for (uint32_t part = 1; part < heat->config.parts; part++) {
        const double *from = heat->gathered + (size_t)part * heat->patches;
        for (uint32_t a = 0; a < heat->patches; a++) sum[a] += from[a];
    }
    return sum;
}
