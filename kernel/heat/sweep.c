/* sweep.c - net flows between patches, a sweep over all beams. SPDX-License-Identifier: MIT
 *
 * A beam brings one end what it takes from the other: flows add up to zero whatever is sent, and are zero where all
 * send alike. Each sphere sums what its own beams bring it, then what those of others do that end on it: each beam is
 * gone through twice, but no sum is anybody else's. */
#include "heat/sweep.h"

#define AHEAD  8
#define BEYOND (FIBRAD_WALLS + 1)

/* Halves of rays are independent, so that by how much they differ is their error; those of directions differ by more.
 */
#define RAYS_WEIGHT 2.5
/* What a pencil says of beams k: the patches of their two ends, 0 being that of its owner, and how many they are. */
enum { NUMBERS = 3, HOW_MANY = 2 };
FIBRAD_INLINE uint32_t beam_number(const fibrad_heat_pencil *pencil, uint32_t k, uint32_t which, bool wide) {
    const void *numbers = pencil + 1;
    const uint32_t at = NUMBERS * k + which;
    return wide ? ((const uint16_t *)numbers)[at] : ((const uint8_t *)numbers)[at];
}

/* A beam stands for the area 1/(n + m) if its two surfaces send out n and m beams per area: so the beams either way
 * together tell what the two exchange, those of the denser one counting as much more as there are more of them. One
 * that is kept stands for several. In the sweep for the error those by even directions count more than odd ones. */
static double beam_area(const fibrad_heat *heat, uint32_t owner, const fibrad_heat_pencil *pencil) {
    const double other = pencil->body < heat->spheres ? heat->density[pencil->body] : 0;
    const double share = heat->phase == FIBRAD_HEAT_CHECK ? pencil->share * (pencil->tilt / 32767.) : pencil->share;
    return share / (heat->density[owner] + other);
}

/* Adds what the beams of a pencil bring one of its ends from the other. */
FIBRAD_INLINE void bring_beams(double *own, const double *mine, const double *other, const fibrad_heat_pencil *pencil,
                               uint32_t end, double area, bool wide) {
    for (uint32_t k = 0; k < pencil->count; k++) {
        const uint32_t a = beam_number(pencil, k, end, wide), b = beam_number(pencil, k, 1 - end, wide);
        own[a] += area * beam_number(pencil, k, HOW_MANY, wide) * (other[b] - mine[a]);
    }
}

static void bring(const fibrad_heat *heat, double *own, const double *mine, const double *other,
                  const fibrad_heat_pencil *pencil, uint32_t end, double area) {
    if (fibrad_heat_number_bytes(heat) == 2)
        bring_beams(own, mine, other, pencil, end, area, true);
    else if (end == 0)
        bring_beams(own, mine, other, pencil, 0, area, false);
    else
        bring_beams(own, mine, other, pencil, 1, area, false);
}

/* Where the patches of the other end of a pencil begin. */
static size_t other_end(const fibrad_heat *heat, const fibrad_heat_pencil *pencil) {
    const uint32_t spheres = heat->spheres, body = pencil->body;
    return body < spheres ? (size_t)body * heat->config.patches : fibrad_heat_other_block(heat, body);
}

/* Many beams meet the few patches that lie beyond the walls and their patches; one sum of all would lose digits. So
 * what has come to them lately is moved to a longer sum. */
static void set_aside(const fibrad_heat *heat, double *to, double sum[BEYOND]) {
    const uint32_t first = heat->first[fibrad_heat_beyond(heat, 0)], others = fibrad_heat_others(heat);
    for (uint32_t b = first; b < heat->patches; b++) sum[b - first] += to[b - others], to[b - others] = 0;
}

/* What sweeps of a part have in common: where it gathers what patches that are not of spheres are brought; and, in the
 * first sweep of all, whose sums are areas, what the ends of beams then send. */
struct gathering {
    bool areas;
    double *walls, away[BEYOND];
    double none[FIBRAD_HEAT_PATCHES_MAX], one[FIBRAD_HEAT_PATCHES_MAX];
};

/* Takes from walls and what is beyond what the beams of a pencil bring its owner. */
static void take_from_walls(const fibrad_heat *heat, const double *mine, const double *other,
                            const fibrad_heat_pencil *pencil, double area, struct gathering *g) {
    double *to = g->walls + (other_end(heat, pencil) - fibrad_heat_others(heat));
    const bool wide = fibrad_heat_number_bytes(heat) == 2;
    for (uint32_t k = 0; k < pencil->count; k++) {
        const uint32_t a = beam_number(pencil, k, 0, wide), b = beam_number(pencil, k, 1, wide);
        const double all = area * beam_number(pencil, k, HOW_MANY, wide);
        to[b] += g->areas ? all : -(all * (other[b] - mine[a]));
    }
    set_aside(heat, g->walls, g->away);
}

/* What the other end of a pencil reflects of its beams. */
static double reflected_beams(const fibrad_heat *heat, const fibrad_heat_pencil *pencil) {
    const uint32_t body = pencil->body < heat->spheres ? pencil->body : fibrad_heat_other_body(heat, pencil->body);
    const double part = (1 - heat->emissivity[body]) * pencil->share;
    const bool wide = fibrad_heat_number_bytes(heat) == 2;
    uint32_t beams = 0;
    for (uint32_t k = 0; k < pencil->count && part > 0; k++) beams += beam_number(pencil, k, HOW_MANY, wide);
    return part * beams;
}

static void sweep_own_beams(const fibrad_heat *heat, uint32_t place, const double *mine, double *own,
                            struct gathering *g) {
    const unsigned char *at = heat->pool + heat->row[place].begin, *end = at + heat->row[place].bytes;
    while (at < end) {
        const fibrad_heat_pencil *pencil = fibrad_heat_pencil_at(at);
        const double *other = g->areas ? g->one : heat->source + other_end(heat, pencil);
        const double area = beam_area(heat, place, pencil);
        bring(heat, own, mine, other, pencil, 0, area);
        if (pencil->body >= heat->spheres) take_from_walls(heat, mine, other, pencil, area, g);
        if (heat->phase == FIBRAD_HEAT_CHECK) heat->reflected[place] += reflected_beams(heat, pencil);
        at += fibrad_heat_pencil_bytes(heat, pencil);
    }
}

static void sweep_beams_of_others(const fibrad_heat *heat, uint32_t place, const double *mine, double *own,
                                  const struct gathering *g) {
    for (size_t l = heat->first_link[place]; l < heat->first_link[place + 1]; l++) {
        if (l + AHEAD < heat->first_link[place + 1]) {
            const fibrad_heat_link *next = &heat->link[l + AHEAD];
            const unsigned char *soon = heat->pool + heat->row[next->sphere].begin + 4 * (size_t)next->at;
            __builtin_prefetch(soon);
            __builtin_prefetch(soon + 64);
        }
        const uint32_t owner = heat->link[l].sphere;
        const unsigned char *row = heat->pool + heat->row[owner].begin;
        const fibrad_heat_pencil *pencil = fibrad_heat_pencil_at(row + 4 * (size_t)heat->link[l].at);
        const double *other = g->areas ? g->one : heat->source + (size_t)owner * heat->config.patches;
        bring(heat, own, mine, other, pencil, 1, beam_area(heat, owner, pencil));
    }
}

static void sweep_sphere(const fibrad_heat *heat, uint32_t place, struct gathering *g) {
    const size_t first = (size_t)place * heat->config.patches;
    const double *mine = g->areas ? g->none : heat->source + first;
    double *own = heat->gathered + first;
    fibrad_zero(own, heat->config.patches * sizeof *own);
    heat->reflected[place] = 0;
    sweep_own_beams(heat, place, mine, own, g);
    sweep_beams_of_others(heat, place, mine, own, g);
}

static void sweep_rays(const fibrad_heat *heat, uint32_t begin, uint32_t end, struct gathering *g) {
    const double *source = heat->source;
    const uint32_t others = fibrad_heat_others(heat);
    for (uint32_t k = begin; k < end; k++) {
        const fibrad_heat_ray ray = heat->ray[k];
        if (ray.area == 0) continue;
        const double area = (heat->phase == FIBRAD_HEAT_CHECK ? RAYS_WEIGHT * (1 - 2 * (double)(k % 2)) : 1) * ray.area;
        const double flow = g->areas ? area : area * (source[ray.to] - source[ray.from]);
        g->walls[ray.from - others] += flow;
        g->walls[ray.to - others] += g->areas ? flow : -flow;
        if (k % 64 == 63) set_aside(heat, g->walls, g->away);
    }
}

/* Where a part begins of n things. */
static uint32_t part_begin(const fibrad_heat *heat, uint32_t n, uint32_t part) {
    return (uint32_t)((uint64_t)n * part / heat->config.parts);
}

/* All of a part but the note that it is done. */
static void sweep_part(fibrad_heat *heat, uint32_t part) {
    const uint32_t spheres = heat->spheres, others = fibrad_heat_others(heat), of_walls = heat->patches - others;
    const uint32_t begin = part_begin(heat, spheres, part), end = part_begin(heat, spheres, part + 1);
    struct gathering g = {heat->phase == FIBRAD_HEAT_AREA, heat->brought + (size_t)part * of_walls, {0}, {0}, {0}};
    for (uint32_t a = 0; a < FIBRAD_HEAT_PATCHES_MAX; a++) g.one[a] = 1;
    fibrad_zero(g.walls, of_walls * sizeof *g.walls);
    for (uint32_t place = begin; place < end; place++) sweep_sphere(heat, place, &g);
    sweep_rays(heat, part_begin(heat, heat->rays, part), part_begin(heat, heat->rays, part + 1), &g);
    set_aside(heat, g.walls, g.away);
    const uint32_t few = heat->first[fibrad_heat_beyond(heat, 0)];
    fibrad_copy(g.walls + (few - others), g.away, (heat->patches - few) * sizeof *g.walls);
}

int fibrad_heat_sweep(fibrad_heat *heat, uint32_t part) {
    if (heat == NULL || part >= heat->config.parts) return FIBRAD_E_ARGUMENT;
    if (heat->phase == FIBRAD_HEAT_IDLE || heat->phase == FIBRAD_HEAT_DONE || heat->swept[part]) return FIBRAD_E_STATE;
    sweep_part(heat, part);
    heat->swept[part] = 1;
    return FIBRAD_OK;
}

const double *fibrad_heat_gathered(fibrad_heat *heat) {
    const uint32_t others = fibrad_heat_others(heat), of_walls = heat->patches - others;
    double *sum = heat->gathered + others;
    fibrad_zero(sum, of_walls * sizeof *sum);
    for (uint32_t part = 0; part < heat->config.parts; part++) {
        const double *from = heat->brought + (size_t)part * of_walls;
        for (uint32_t a = 0; a < of_walls; a++) sum[a] += from[a];
    }
    return heat->gathered;
}
