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
 * are replaced by their mean, and all vectors stay within such J; the finer level goes on from there.
 *
 * Patches of a mesh may each have an emission of their own. On the coarser level it is eps times what the patch emits
 * more than its body that J differs by within a group: within such J the system is the same.
 *
 * Light from outside that arrives at a patch is part of its net flow: it arrives like what the other patches send, and
 * never changes.
 *
 * A body of unknown temperature gives off S - h E. From q = A eps/rho (<J> - E) = h E - S, <J> the mean over it,
 *
 *     E = (rho S + A eps <J>)/D,    D = rho h + A eps,
 *
 * which leaves a system of J alone that is symmetric as before. Its residuals are dealt with in two parts, none of
 * which divides by eps or rho: their mean r = eps (S - h <J>)/D + q/A, changed by r/(1 + eps h/D), and the rest,
 * changed as that of other bodies about the mean. A black body sends J = E all over.
 *
 * On a sphere that conducts the mean of J is dealt with as above, and the rest as conduct.c says. */
#include "heat/problem.h"
#include "heat/pencils.h"
#include "heat/sweep.h"

/* A body of unknown temperature: its area, the means of J and of N J per area, and D. */
typedef struct free_body {
    double area, radiosity, net, divisor;
} free_body;

static bool is_free(const fibrad_heat *heat, uint32_t body) { return heat->sources.hold[body] >= 0; }

/* The mean of values per area, or the sum of values, over the patches of a body. */
static double mean_over(const fibrad_heat *heat, uint32_t body, const double *value) {
    double sum = 0, area = 0;
    for (uint32_t a = heat->first[body]; a < heat->first[body + 1]; a++)
        sum += heat->solution.area[a] * value[a], area += heat->solution.area[a];
    return area > 0 ? sum / area : 0;
}

static double sum_over(const fibrad_heat *heat, uint32_t body, const double *value) {
    double sum = 0;
    for (uint32_t a = heat->first[body]; a < heat->first[body + 1]; a++) sum += value[a];
    return sum;
}

static free_body free_body_of(const fibrad_heat *heat, uint32_t b) {
    const double eps = heat->sources.emissivity[b], area = sum_over(heat, b, heat->solution.area);
    return (free_body){area, mean_over(heat, b, heat->solution.radiosity),
                       area > 0 ? sum_over(heat, b, heat->solution.net) / area : 0,
                       (1 - eps) * heat->sources.hold[b] + area * eps};
}

/* What the mean residual of a body of unknown temperature is, where it and what it receives are at one emission. */
static double drive_at(const fibrad_heat *heat, uint32_t b, const free_body *body, double emission) {
    return heat->sources.emissivity[b] * (heat->sources.drive[b] - heat->sources.hold[b] * emission) / body->divisor;
}

/* 1 + eps h/D */
static double stiffness(const fibrad_heat *heat, uint32_t b, const free_body *body) {
    return 1 + heat->sources.emissivity[b] * heat->sources.hold[b] / body->divisor;
}

/* Patches from a on that share one J, up to `end`. */
static uint32_t end_of_group(uint32_t a, uint32_t end, uint32_t group) { return end - a > group ? a + group : end; }

static uint32_t group_end(const fibrad_heat *heat, uint32_t a, uint32_t end) {
    return end_of_group(a, end, heat->solution.group);
}

/* What one Jacobi iteration would change of a body of given temperature. Returns the residual times that. */
static double given_residual(fibrad_heat *heat, uint32_t b) {
    const double eps = heat->sources.emissivity[b];
    const double *lift = fibrad_heat_lift(heat, b);
    const uint32_t begin = heat->first[b], end = heat->first[b + 1];
    double slope = 0;
    for (uint32_t a = begin, next; a < end; a = next) {
        double sum = 0, area = 0;
        next = group_end(heat, a, end);
        for (uint32_t k = a; k < next; k++) {
            const double emission =
                lift != NULL ? heat->sources.emission[b] + lift[k - begin] : heat->sources.emission[b];
            sum += heat->solution.area[k] * eps * (emission - heat->solution.radiosity[k]) +
                   (1 - eps) * heat->solution.net[k];
            area += heat->solution.area[k];
        }
        const double change = eps < 1 && area > 0 ? sum / area : 0;
        for (uint32_t k = a; k < next; k++) fibrad_heat_send(heat, k, change);
        if (eps < 1) slope += area * change * change / (1 - eps);
    }
    return slope;
}

/* The same of a body of unknown temperature. */
static double free_residual(fibrad_heat *heat, uint32_t b) {
    const double eps = heat->sources.emissivity[b], rho = 1 - eps;
    const uint32_t end = heat->first[b + 1];
    const free_body body = free_body_of(heat, b);
    if (!(body.area > 0)) return 0;
    const double mean = drive_at(heat, b, &body, body.radiosity) + body.net;
    const double shift = mean / stiffness(heat, b, &body);
    double slope = body.area * mean * shift;
    for (uint32_t a = heat->first[b], next; a < end; a = next) {
        double sum = 0, area = 0;
        next = group_end(heat, a, end);
        for (uint32_t k = a; k < next; k++) {
            sum += heat->solution.area[k] * (eps * (body.radiosity - heat->solution.radiosity[k]) - rho * body.net) +
                   rho * heat->solution.net[k];
            area += heat->solution.area[k];
        }
        const double change = eps < 1 && area > 0 ? sum / area : 0;
        for (uint32_t k = a; k < next; k++) fibrad_heat_send(heat, k, shift + change);
        if (eps < 1) slope += area * change * change / rho;
    }
    return slope;
}

/* Whether the mean of J over a sphere that conducts is what it emits, as it reflects next to nothing. If such a mean
 * were searched for, rounding errors of J would count 1/rho times. */
#define NEXT_TO_NOTHING 1e-9
static bool has_black_mean(const fibrad_heat *heat, uint32_t b) {
    return !is_free(heat, b) && 1 - heat->sources.emissivity[b] < NEXT_TO_NOTHING;
}

/* The same of a sphere that conducts. */
static double conducting_residual(fibrad_heat *heat, uint32_t b) {
    const double eps = heat->sources.emissivity[b];
    const free_body body = free_body_of(heat, b);
    double shift = 0, slope = 0;
    if (!(body.area > 0)) return 0;
    if (is_free(heat, b)) {
        const double mean = drive_at(heat, b, &body, body.radiosity) + body.net;
        shift = mean / stiffness(heat, b, &body);
        slope = body.area * mean * shift;
    } else if (!has_black_mean(heat, b)) {
        shift = eps * (heat->sources.emission[b] - body.radiosity) + (1 - eps) * body.net;
        slope = body.area * shift * shift / (1 - eps);
    }
    return slope + fibrad_heat_pattern_residual(heat, b, shift);
}

/* The changes of all patches, to be sent. */
static double find_residual(fibrad_heat *heat) {
    double slope = 0;
    for (uint32_t b = 0; b < heat->bodies; b++)
        slope += fibrad_heat_conducts(heat, b) ? conducting_residual(heat, b)
                 : is_free(heat, b)            ? free_residual(heat, b)
                                               : given_residual(heat, b);
    return slope;
}

/* Emissions of the bodies of unknown temperature. */
static void find_emissions(fibrad_heat *heat) {
    for (uint32_t b = 0; b < heat->bodies; b++) {
        if (!is_free(heat, b)) continue;
        const free_body body = free_body_of(heat, b);
        const double eps = heat->sources.emissivity[b];
        if (body.area > 0)
            heat->sources.emission[b] =
                ((1 - eps) * heat->sources.drive[b] + body.area * eps * body.radiosity) / body.divisor;
    }
}

/* Emissivity times area of a body whose power and emission are not both told by others; 0 of the rest. */
static double emitting(const fibrad_heat *heat, uint32_t body) {
    return heat->sources.hold[body] != 0 ? heat->sources.emissivity[body] * sum_over(heat, body, heat->solution.area)
                                         : 0;
}

/* Net powers of the bodies. Those that reflect all have none, and some give off a given power: what residuals leave of
 * theirs goes to the others, by emissivity times area. */
static void find_powers(const fibrad_heat *heat, double *power) {
    double left = 0, weights = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        power[b] = sum_over(heat, b, heat->solution.net);
        if (heat->sources.emissivity[b] == 0) left += power[b], power[b] = 0;
        if (heat->sources.hold[b] == 0) left += power[b] + heat->sources.drive[b], power[b] = -heat->sources.drive[b];
    }
    for (uint32_t b = 0; b < heat->bodies && left != 0; b++) weights += emitting(heat, b);
    for (uint32_t b = 0; b < heat->bodies && weights > 0; b++) power[b] += left * (emitting(heat, b) / weights);
}

/* What is nothing but rounding in a sum of squares. */
#define ROUNDING 1e-28

/* Where temperatures are found of spheres that conduct: the tolerance with which these are found for the first time,
 * and the relative change of unevenness that no longer matters. */
#define ROUGH   1e-2
#define SETTLED 1e-3

/* Emissivity times area times the square of how far the emission of each patch is from that of its body. */
static double lifted_squares(const fibrad_heat *heat, uint32_t b) {
    const double *lift = fibrad_heat_lift(heat, b);
    double sum = 0;
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1] && lift != NULL; a++)
        sum +=
            heat->sources.emissivity[b] * heat->solution.area[a] * lift[a - heat->first[b]] * lift[a - heat->first[b]];
    return sum;
}

/* Likewise of the light that patches reflect first. */
static double light_squares(const fibrad_heat *heat, uint32_t b) {
    double sum = 0;
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1] && heat->sources.light != NULL; a++)
        if (heat->solution.area[a] > 0)
            sum += (1 - heat->sources.emissivity[b]) * heat->sources.light[a] * heat->sources.light[a] /
                   heat->solution.area[a];
    return sum;
}

/* What residuals are compared with: how much emission differs from its mean, what is given off, what arrives from
 * outside, and, for rounding, emission itself. */
static void find_scale(fibrad_heat *heat) {
    double weights = 0, sum = 0, largest = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const double area = emitting(heat, b), emission = heat->sources.emission[b];
        weights += area, sum += area * emission, largest += area * emission * emission + lifted_squares(heat, b);
    }
    heat->solution.scale = 0;
    const double mean = weights > 0 ? sum / weights : 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const double difference = heat->sources.emission[b] - mean;
        heat->solution.scale += light_squares(heat, b);
        const free_body body = is_free(heat, b) ? free_body_of(heat, b) : (free_body){0};
        if (body.area > 0) {
            const double drive = drive_at(heat, b, &body, mean);
            heat->solution.scale += body.area * drive * drive / stiffness(heat, b, &body);
        } else {
            heat->solution.scale += emitting(heat, b) * difference * difference + lifted_squares(heat, b);
        }
    }
    heat->solution.smallest = ROUNDING * fibrad_max(largest, heat->solution.scale);
}

/* Whether there are temperatures that give the powers: something is given, or the powers add up to zero, those of light
 * included. */
#define BALANCED 1e-9
static bool solvable(fibrad_heat *heat) {
    double sum = 0, sizes = 0;
    bool held = false;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        held = held || emitting(heat, b) > 0;
        const double light = heat->sources.light != NULL ? sum_over(heat, b, heat->sources.light) : 0;
        if (heat->sources.hold[b] == 0) sum += heat->sources.drive[b], sizes += fibrad_abs(heat->sources.drive[b]);
        sum += light, sizes += light;
    }
    heat->sources.afloat = !held;
    return held || fibrad_abs(sum) <= BALANCED * sizes;
}

/* Lifts the radiosities of black spheres that conduct so that their means are what they emit. */
static void lift_black(fibrad_heat *heat) {
    for (uint32_t b = 0; b < heat->spheres && heat->sources.conducts; b++) {
        if (!fibrad_heat_conducts(heat, b) || !has_black_mean(heat, b)) continue;
        const double more = heat->sources.emission[b] - mean_over(heat, b, heat->solution.radiosity);
        for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) heat->solution.radiosity[a] += more;
    }
}

/* Makes the next sweep one of the radiosities. */
static void send_radiosities(fibrad_heat *heat, fibrad_heat_phase phase) {
    lift_black(heat);
    for (uint32_t a = 0; a < heat->patches; a++) fibrad_heat_send(heat, a, heat->solution.radiosity[a]);
    heat->solution.phase = phase;
}

/* Makes the next sweep the one for the error, which knows of no more than the coarser level does. */
static void send_means(fibrad_heat *heat) {
    for (uint32_t b = 0; b < heat->bodies; b++)
        for (uint32_t a = heat->first[b], next; a < heat->first[b + 1]; a = next) {
            double sum = 0;
            next = end_of_group(a, heat->first[b + 1], FIBRAD_HEAT_FOUR);
            for (uint32_t k = a; k < next; k++) sum += heat->solution.radiosity[k];
            for (uint32_t k = a; k < next; k++) fibrad_heat_send(heat, k, sum / (next - a));
        }
    heat->solution.phase = FIBRAD_HEAT_CHECK;
}

void fibrad_heat_start(fibrad_heat *heat) {
    if (heat->solution.areas)
        send_radiosities(heat, FIBRAD_HEAT_FIRST);
    else {
        fibrad_heat_link_pencils(heat);
        heat->solution.phase = FIBRAD_HEAT_AREA;
    }
}

/* Where nothing says how high emissions are: lowers all, so that their mean is that of the surroundings. */
static void sink(fibrad_heat *heat) {
    double sum = 0, weights = 0;
    for (uint32_t b = 0; b < heat->bodies; b++) {
        const double area = heat->sources.emissivity[b] * sum_over(heat, b, heat->solution.area);
        sum += area * heat->sources.emission[b], weights += area;
    }
    const double mean = weights > 0 ? sum / weights : 0;
    for (uint32_t b = 0; b < heat->bodies; b++) heat->sources.emission[b] -= mean;
    for (uint32_t a = 0; a < heat->patches; a++) heat->solution.radiosity[a] -= mean;
}

/* Takes the finer powers and adds what patches without size would change. Where radiosities are smooth the error falls
 * with the area of patches, and a third of the difference from the coarser powers would be right; near contacts they
 * are not quite, and this is what settled beds ask for: docs/methods_heat.md section 6. */
static void finish_powers(fibrad_heat *heat) {
    find_powers(heat, heat->solution.power);
    find_emissions(heat);
    if (heat->sources.afloat) sink(heat);
    if (heat->sources.conducts) fibrad_heat_find_spans(heat);
    for (uint32_t b = 0; b < heat->bodies; b++) {
        if (heat->solution.group > 1)
            heat->solution.coarse[b] = heat->solution.power[b],
            heat->solution.coarse_emission[b] = heat->sources.emission[b];
        heat->solution.power[b] += FIBRAD_HEAT_EXTRAPOLATION * (heat->solution.power[b] - heat->solution.coarse[b]);
        if (is_free(heat, b))
            heat->sources.temperature[b] = fibrad_heat_temperature(
                heat, heat->sources.emission[b] +
                          FIBRAD_HEAT_EXTRAPOLATION * (heat->sources.emission[b] - heat->solution.coarse_emission[b]));
    }
    if (heat->solution.group == 1)
        for (uint32_t a = 0; a < heat->patches; a++) heat->solution.detail[a] += heat->solution.radiosity[a];
    send_means(heat);
}

/* Whether the radiosities of the level in hand are good enough. */
static bool level_solved(const fibrad_heat *heat) {
    const double tolerance =
        heat->sources.roughly ? fibrad_max(ROUGH, heat->sources.tolerance) : heat->sources.tolerance;
    return heat->solution.slope <= fibrad_max(tolerance * tolerance * heat->solution.scale, heat->solution.smallest) ||
           heat->solution.sweeps >= heat->sources.limit;
}

/* Finds what temperatures make of the unevenness of spheres. Whether the coarser level is to be solved again as they
 * have changed. */
static bool unsettled(fibrad_heat *heat) {
    if (!heat->sources.conducts || heat->solution.sweeps >= heat->sources.limit) return false;
    find_emissions(heat);
    const bool rough = heat->sources.roughly;
    heat->sources.roughly = false;
    return fibrad_heat_find_unevenness(heat) > SETTLED || rough;
}

/* The direction to search next: the residual, and `keep` of the last direction. */
static void turn_direction(fibrad_heat *heat, double keep) {
    for (uint32_t a = 0; a < heat->patches; a++) {
        heat->solution.direction[a] = fibrad_heat_sent(heat, a) + (keep != 0 ? keep * heat->solution.direction[a] : 0);
        fibrad_heat_send(heat, a, heat->solution.direction[a]);
    }
}

/* From the coarser level to the finer one, with the detail that an earlier solution had. Until this one has its own,
 * `detail` holds what is to be taken from it. */
static void refine_patches(fibrad_heat *heat) {
    find_powers(heat, heat->solution.coarse);
    find_emissions(heat);
    if (heat->sources.afloat) sink(heat);
    if (heat->sources.conducts) fibrad_heat_find_spans(heat);
    fibrad_copy(heat->solution.coarse_emission, heat->sources.emission, heat->bodies * sizeof *heat->sources.emission);
    heat->solution.group = 1;
    for (uint32_t a = 0; a < heat->patches; a++) {
        const double coarse = heat->solution.radiosity[a];
        heat->solution.radiosity[a] += heat->solution.detail[a];
        heat->solution.detail[a] = -coarse;
    }
    send_radiosities(heat, FIBRAD_HEAT_FIRST);
}

/* Goes on with the search, or with the finer level, if there is something left to do. */
static void search_on(fibrad_heat *heat, bool restart) {
    const double last = heat->solution.slope;
    heat->solution.slope = find_residual(heat);
    if (restart) heat->solution.smallest = fibrad_max(heat->solution.smallest, ROUNDING * heat->solution.slope);
    if (level_solved(heat)) {
        if (heat->solution.group == FIBRAD_HEAT_FOUR && unsettled(heat))
            send_radiosities(heat, FIBRAD_HEAT_FIRST);
        else if (heat->solution.group == FIBRAD_HEAT_FOUR)
            refine_patches(heat);
        else
            finish_powers(heat);
        return;
    }
    turn_direction(heat, restart ? 0 : heat->solution.slope / last);
    heat->solution.phase = FIBRAD_HEAT_STEPS;
}

/* The product of the search direction with its image, over a body of given temperature. */
static double given_curvature(const fibrad_heat *heat, uint32_t b, const double *product) {
    double sum = 0;
    if (heat->sources.emissivity[b] == 1) return 0;
    const double share = heat->sources.emissivity[b] / (1 - heat->sources.emissivity[b]);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) {
        const double p = heat->solution.direction[a];
        sum += p * (heat->solution.area[a] * p * share - product[a]);
    }
    return sum;
}

/* The same of unknown temperature: what differs from the mean counts as above, the mean for what holds it. */
static double free_curvature(const fibrad_heat *heat, uint32_t b, const double *product) {
    const double eps = heat->sources.emissivity[b], mean = mean_over(heat, b, heat->solution.direction);
    const double share = eps < 1 ? eps / (1 - eps) : 0;
    const free_body body = free_body_of(heat, b);
    if (!(body.area > 0)) return 0;
    double sum = body.area * mean * mean * (stiffness(heat, b, &body) - 1);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) {
        const double p = heat->solution.direction[a], rest = p - mean;
        sum += share * heat->solution.area[a] * rest * rest - p * product[a];
    }
    return sum;
}

/* The same of a sphere that conducts. */
static double conducting_curvature(const fibrad_heat *heat, uint32_t b, const double *product) {
    const double eps = heat->sources.emissivity[b], mean = mean_over(heat, b, heat->solution.direction);
    const free_body body = free_body_of(heat, b);
    if (!(body.area > 0)) return 0;
    const double share = is_free(heat, b)          ? stiffness(heat, b, &body) - 1
                         : has_black_mean(heat, b) ? 0
                                                   : eps / (1 - eps);
    double sum = share * body.area * mean * mean + fibrad_heat_pattern_curvature(heat, b);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) sum -= heat->solution.direction[a] * product[a];
    return sum;
}

/* Goes along the direction whose product with N is `product`, as far as the error falls. */
static void advance_radiosities(fibrad_heat *heat, const double *product) {
    double curvature = 0;
    for (uint32_t b = 0; b < heat->bodies; b++)
        curvature += fibrad_heat_conducts(heat, b) ? conducting_curvature(heat, b, product)
                     : is_free(heat, b)            ? free_curvature(heat, b, product)
                                                   : given_curvature(heat, b, product);
    if (!(curvature > 0)) return;
    const double length = heat->solution.slope / curvature;
    for (uint32_t a = 0; a < heat->patches; a++) {
        heat->solution.radiosity[a] += length * heat->solution.direction[a];
        heat->solution.net[a] += length * product[a];
    }
}

/* What the sweep in hand was for; FIBRAD_E_UNSOLVABLE. */
static int end_sweep(fibrad_heat *heat) {
    const double *sum = fibrad_heat_gathered(heat);
    if (heat->solution.phase == FIBRAD_HEAT_CHECK) {
        for (uint32_t b = 0; b < heat->bodies; b++) heat->samples.halves[b] = sum_over(heat, b, sum);
        heat->solution.phase = FIBRAD_HEAT_DONE;
        heat->solution.warm = true;
        return FIBRAD_OK;
    }
    heat->solution.sweeps++;
    switch (heat->solution.phase) {
    case FIBRAD_HEAT_AREA:
        fibrad_copy(heat->solution.area, sum, heat->patches * sizeof *sum);
        heat->solution.areas = true;
        send_radiosities(heat, FIBRAD_HEAT_FIRST);
        return FIBRAD_OK;
    case FIBRAD_HEAT_FIRST:
        for (uint32_t a = 0; a < heat->patches; a++)
            heat->solution.net[a] = heat->sources.light != NULL ? sum[a] + heat->sources.light[a] : sum[a];
        if (!solvable(heat)) return FIBRAD_E_UNSOLVABLE;
        find_scale(heat);
        search_on(heat, true);
        return FIBRAD_OK;
    default:
        advance_radiosities(heat, sum);
        search_on(heat, false);
        return FIBRAD_OK;
    }
}

int fibrad_heat_step(fibrad_heat *heat, int *solved) {
    if (heat == NULL || solved == NULL) return FIBRAD_E_ARGUMENT;
    if (heat->solution.phase == FIBRAD_HEAT_IDLE || heat->solution.phase == FIBRAD_HEAT_DONE) return FIBRAD_E_STATE;
    if (!fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    for (uint32_t part = 0; part < heat->config.parts; part++)
        if (!heat->swept[part]) return FIBRAD_E_STATE;
    const int status = end_sweep(heat);
    if (status != FIBRAD_OK) {
        heat->solution.phase = FIBRAD_HEAT_IDLE;
        return status;
    }
    fibrad_zero(heat->swept, heat->config.parts);
    *solved = heat->solution.phase == FIBRAD_HEAT_DONE;
    return FIBRAD_OK;
}
