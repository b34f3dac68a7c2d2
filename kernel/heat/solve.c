/* solve.c - radiosities by conjugate gradients, a sweep over all beams a step. SPDX-License-Identifier: MIT
 *
 * With K the exchange areas between patches, A = K 1 their areas and rho = 1 - eps, the radiosities solve
 *
 *     (A/rho - K) J = A eps/rho E,
 *
 * a symmetric positive definite system. A sweep forms the net flows N J = K J - A J beam by beam, each beam giving to
 * one end what it takes from the other: they add up to zero whatever J is, and are zero where all J are equal. Times
 * rho/A the residual is eps (E - J) + rho N J/A: what one Jacobi iteration would change. Patches with rho = 0 have J =
 * E and take no part. On the coarser level J is the same on the patches of a group. For that the residuals of a group
 * are replaced by their mean, and all vectors stay within such J; the finer level goes on from there. */
#include "heat/solve.h"

#define BEYOND (FIBRAD_WALLS + 1)

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

/* Adds what the beams of one sphere bring to its own patches, and to those they meet; or, in the first sweep of all,
 * the areas they stand for. */
static void sweep_sphere(const fibrad_heat *heat, uint32_t place, double *to, double away[BEYOND]) {
    const uint32_t *hit = heat->hit + (size_t)place * heat->beams, patches = heat->config.patches;
    const fibrad_heat_source *source = heat->source, *mine = source + (size_t)place * patches;
    const bool areas = heat->phase == FIBRAD_HEAT_AREA;
    double own[FIBRAD_HEAT_PATCHES_MAX] = {0}, sum[BEYOND] = {0};
    for (uint32_t begin = 0; begin < heat->beams; begin += heat->config.points) {
        for (uint32_t k = begin; k < begin + heat->config.points; k++) {
            const uint32_t a = heat->leave[k], b = hit[k];
            const double area = beam_area(mine, &source[b]);
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
        const double flow = areas ? ray.area : ray.area * (heat->source[ray.to].value - heat->source[ray.from].value);
        to[ray.from] += flow;
        to[ray.to] += areas ? flow : -flow;
        if (k % 64 == 63) set_aside(heat, to, away);
    }
}

/* Where a part begins of n things. */
static uint32_t part_begin(const fibrad_heat *heat, uint32_t n, uint32_t part) {
    return (uint32_t)((uint64_t)n * part / heat->config.parts);
}

/* How much more the even directions of a sphere's own beams bring it than the odd ones. */
static double sweep_halves(const fibrad_heat *heat, uint32_t place) {
    const uint32_t *hit = heat->hit + (size_t)place * heat->beams, points = heat->config.points;
    const fibrad_heat_source *source = heat->source, *mine = source + (size_t)place * heat->config.patches;
    double half[2] = {0, 0};
    for (uint32_t k = 0; k < heat->config.directions; k++) {
        double sum = 0;
        for (uint32_t p = k * points; p < (k + 1) * points; p++) {
            const fibrad_heat_source *other = &source[hit[p]];
            sum += beam_area(mine, other) * (other->value - mine[heat->leave[p]].value);
        }
        half[k % 2] += k == 0 || k + 1 == heat->config.directions ? sum / 2 : sum;
    }
    return half[0] - half[1];
}

/* All of a part but the note that it is done. */
static void sweep_part(fibrad_heat *heat, uint32_t part) {
    const uint32_t spheres = heat->spheres;
    const uint32_t begin = part_begin(heat, spheres, part), end = part_begin(heat, spheres, part + 1);
    double *to = heat->gathered + (size_t)part * heat->patches, away[BEYOND] = {0};
    if (heat->phase == FIBRAD_HEAT_CHECK) {
        for (uint32_t place = begin; place < end; place++) heat->halves[place] = sweep_halves(heat, place);
        return;
    }
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

/* Adds up what the parts have gathered, in the first part's place. */
static const double *gather_parts_of(fibrad_heat *heat) {
    double *sum = heat->gathered;
    for (uint32_t part = 1; part < heat->config.parts; part++) {
        const double *from = heat->gathered + (size_t)part * heat->patches;
        for (uint32_t a = 0; a < heat->patches; a++) sum[a] += from[a];
    }
    return sum;
}

/* What one Jacobi iteration would change: of all patches, into source[].value. Returns the residual times that. */
static double find_residual(fibrad_heat *heat) {
    double slope = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const double eps = heat->emissivity[b];
        const uint32_t end = heat->first[b + 1];
        for (uint32_t a = heat->first[b], next; a < end; a = next) {
            double sum = 0, area = 0;
            next = end - a > heat->group ? a + heat->group : end;
            for (uint32_t k = a; k < next; k++) {
                sum += heat->area[k] * eps * (heat->emission[b] - heat->radiosity[k]) + (1 - eps) * heat->net[k];
                area += heat->area[k];
            }
            const double change = eps < 1 && area > 0 ? sum / area : 0;
            for (uint32_t k = a; k < next; k++) heat->source[k].value = change;
            if (eps < 1) slope += area * change * change / (1 - eps);
        }
    }
    return slope;
}

/* Emissivity times area of a body. */
static double emitting(const fibrad_heat *heat, uint32_t body) {
    double area = 0;
    for (uint32_t a = heat->first[body]; a < heat->first[body + 1]; a++) area += heat->area[a];
    return heat->emissivity[body] * area;
}

/* Net powers of the bodies. Those that reflect all have none: what residuals leave of theirs goes to the others, by
 * emissivity times area. */
static void find_powers(const fibrad_heat *heat, double *power) {
    double left = 0, weights = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        power[b] = 0;
        for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) power[b] += heat->net[a];
        if (heat->emissivity[b] == 0) left += power[b], power[b] = 0;
    }
    for (uint32_t b = 0; b < heat->bodies && left != 0; b++) weights += emitting(heat, b);
    for (uint32_t b = 0; b < heat->bodies && weights > 0; b++) power[b] += left * (emitting(heat, b) / weights);
}

/* What is nothing but rounding in a sum of squares. */
#define ROUNDING 1e-28

/* What residuals are compared with: how much emission differs from its mean, and, for rounding, emission itself. */
static void find_scale(fibrad_heat *heat) {
    double weights = 0, sum = 0, largest = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const double area = emitting(heat, b), emission = heat->emission[b];
        weights += area, sum += area * emission, largest += area * emission * emission;
    }
    heat->scale = 0;
    heat->smallest = ROUNDING * largest;
    for (uint32_t b = 0; b < heat->bodies && weights > 0; b++) {
        const double difference = heat->emission[b] - sum / weights;
        heat->scale += emitting(heat, b) * difference * difference;
    }
}

/* Makes the next sweep one of the radiosities. */
static void send_radiosities(fibrad_heat *heat, fibrad_heat_phase phase) {
    for (uint32_t a = 0; a < heat->patches; a++) heat->source[a].value = heat->radiosity[a];
    heat->phase = phase;
}

void fibrad_heat_start(fibrad_heat *heat) {
    if (heat->areas)
        send_radiosities(heat, FIBRAD_HEAT_FIRST);
    else
        heat->phase = FIBRAD_HEAT_AREA;
}

/* Takes the finer powers and adds what patches without size would change. Where radiosities are smooth the error falls
 * with the area of patches, and a third of the difference from the coarser powers would be right; near contacts they
 * are not quite, and this is what settled beds ask for: docs/heat.md. */
#define EXTRAPOLATION 0.4
static void finish_powers(fibrad_heat *heat) {
    find_powers(heat, heat->power);
    for (uint32_t b = 0; b < heat->bodies; b++) {
        if (heat->group > 1) heat->coarse[b] = heat->power[b];
        heat->power[b] += EXTRAPOLATION * (heat->power[b] - heat->coarse[b]);
    }
    if (heat->group == 1)
        for (uint32_t a = 0; a < heat->patches; a++) heat->detail[a] += heat->radiosity[a];
    send_radiosities(heat, FIBRAD_HEAT_CHECK);
}

/* Whether the radiosities of the level in hand are good enough. */
static bool level_solved(const fibrad_heat *heat) {
    return heat->slope <= fibrad_max(heat->tolerance * heat->tolerance * heat->scale, heat->smallest) ||
           heat->sweeps >= heat->limit;
}

/* The direction to search next: the residual, and `keep` of the last direction. */
static void turn_direction(fibrad_heat *heat, double keep) {
    for (uint32_t a = 0; a < heat->patches; a++) {
        heat->direction[a] = heat->source[a].value + (keep != 0 ? keep * heat->direction[a] : 0);
        heat->source[a].value = heat->direction[a];
    }
}

/* From the coarser level to the finer one, with the detail that an earlier solution had. Until this one has its own,
 * `detail` holds what is to be taken from it. */
static void refine_patches(fibrad_heat *heat) {
    find_powers(heat, heat->coarse);
    heat->group = 1;
    for (uint32_t a = 0; a < heat->patches; a++) {
        const double coarse = heat->radiosity[a];
        heat->radiosity[a] += heat->detail[a];
        heat->detail[a] = -coarse;
    }
    send_radiosities(heat, FIBRAD_HEAT_FIRST);
}

/* Goes on with the search, or with the finer level, if there is something left to do. */
static void search_on(fibrad_heat *heat, bool restart) {
    const double last = heat->slope;
    heat->slope = find_residual(heat);
    if (restart) heat->smallest = fibrad_max(heat->smallest, ROUNDING * heat->slope);
    if (level_solved(heat)) {
        if (heat->group == 4)
            refine_patches(heat);
        else
            finish_powers(heat);
        return;
    }
    turn_direction(heat, restart ? 0 : heat->slope / last);
    heat->phase = FIBRAD_HEAT_STEPS;
}

/* Goes along the direction whose product with N is `product`, as far as the error falls. */
static void advance_radiosities(fibrad_heat *heat, const double *product) {
    double curvature = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        if (heat->emissivity[b] == 1) continue;
        const double share = heat->emissivity[b] / (1 - heat->emissivity[b]);
        for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) {
            const double p = heat->direction[a];
            curvature += p * (heat->area[a] * p * share - product[a]);
        }
    }
    if (!(curvature > 0)) return;
    const double length = heat->slope / curvature;
    for (uint32_t a = 0; a < heat->patches; a++) {
        heat->radiosity[a] += length * heat->direction[a];
        heat->net[a] += length * product[a];
    }
}

/* What the sweep in hand was for. */
static void end_sweep(fibrad_heat *heat) {
    if (heat->phase == FIBRAD_HEAT_CHECK) {
        heat->phase = FIBRAD_HEAT_DONE;
        heat->warm = true;
        return;
    }
    const double *sum = gather_parts_of(heat);
    heat->sweeps++;
    switch (heat->phase) {
    case FIBRAD_HEAT_AREA:
        fibrad_copy(heat->area, sum, heat->patches * sizeof *sum);
        heat->areas = true;
        send_radiosities(heat, FIBRAD_HEAT_FIRST);
        return;
    case FIBRAD_HEAT_FIRST:
        fibrad_copy(heat->net, sum, heat->patches * sizeof *sum);
        find_scale(heat);
        search_on(heat, true);
        return;
    default:
        advance_radiosities(heat, sum);
        search_on(heat, false);
    }
}

int fibrad_heat_step(fibrad_heat *heat, int *solved) {
    if (heat == NULL || solved == NULL) return FIBRAD_E_ARGUMENT;
    if (heat->phase == FIBRAD_HEAT_IDLE || heat->phase == FIBRAD_HEAT_DONE) return FIBRAD_E_STATE;
    if (!fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    for (uint32_t part = 0; part < heat->config.parts; part++)
        if (!heat->swept[part]) return FIBRAD_E_STATE;
    end_sweep(heat);
    fibrad_zero(heat->swept, heat->config.parts);
    *solved = heat->phase == FIBRAD_HEAT_DONE;
    return FIBRAD_OK;
}
