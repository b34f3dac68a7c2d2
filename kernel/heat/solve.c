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
#include "heat/sweep.h"

/* What one Jacobi iteration would change: of all patches, to be sent. Returns the residual times that. */
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
            for (uint32_t k = a; k < next; k++) fibrad_heat_send(heat, k, change);
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
    for (uint32_t a = 0; a < heat->patches; a++) fibrad_heat_send(heat, a, heat->radiosity[a]);
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
        heat->direction[a] = fibrad_heat_sent(heat, a) + (keep != 0 ? keep * heat->direction[a] : 0);
        fibrad_heat_send(heat, a, heat->direction[a]);
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
    const double *sum = fibrad_heat_gathered(heat);
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
