/* solve.c - radiosities by conjugate gradients, a sweep over all beams a step. SPDX-License-Identifier: MIT
 *
 * With K the exchange areas between patches, A = K 1 their areas and rho = 1 - eps, the radiosities solve
 *
 *     (A/rho - K) J = A eps/rho E,
 *
 * a symmetric positive definite system. Preconditioned by rho/A the residual is eps E + rho H - J, H = K J/A: what a
 * plain sweep would change. Patches with rho = 0 have J = E and take no part. On the coarser level J is the same on
 * the patches of a group; that is no more than a preconditioner that takes the mean over each group, since all vectors
 * then stay within such J. So the finer level goes on from where the coarser one ends. */
#include "heat/heat.h"

static uint32_t part_begin(const fibrad_heat *heat, uint32_t part) {
    return (uint32_t)((uint64_t)heat->scene->facts.spheres * part / heat->config.parts);
}

/* What the beams of one sphere exchange: to its own patches `own`, to those they meet `other`. */
static void exchange(const fibrad_heat *heat, uint32_t place, double *own, double *other) {
    const uint32_t *hit = heat->hit + (size_t)place * heat->beams;
    const fibrad_heat_source *source = heat->source, *mine = source + (size_t)place * heat->config.patches;
    const uint16_t *leave = heat->leave;
    const double density = mine->density;
    for (uint32_t k = 0; k < heat->beams; k++) {
        const uint32_t a = leave[k], b = hit[k];
        const double weight = 1 / (density + source[b].density);
        own[a] += weight * source[b].value;
        other[b] += weight * mine[a].value;
    }
}

void fibrad_heat_sweep(fibrad_heat *heat, uint32_t part) {
    double *to = heat->gathered + (size_t)part * heat->patches, own[384];
    const uint32_t patches = heat->config.patches;
    fibrad_zero(to, heat->patches * sizeof *to);
    for (uint32_t place = part_begin(heat, part); place < part_begin(heat, part + 1); place++) {
        fibrad_zero(own, patches * sizeof *own);
        exchange(heat, place, own, to);
        for (uint32_t a = 0; a < patches; a++) to[(size_t)place * patches + a] += own[a];
    }
}

/* Adds up what the parts have gathered, in the first part's place. */
static double *gather(fibrad_heat *heat) {
    double *sum = heat->gathered;
    for (uint32_t part = 1; part < heat->config.parts; part++) {
        const double *from = heat->gathered + (size_t)part * heat->patches;
        for (uint32_t a = 0; a < heat->patches; a++) sum[a] += from[a];
    }
    return sum;
}

/* The next search direction: preconditioned residual and `keep` times the last direction. Returns the residual times
 * the preconditioned one. */
static double residual(const fibrad_heat *heat, uint32_t a, uint32_t group) {
    double sum = 0, area = 0;
    for (uint32_t b = a; b < a + group; b++) {
        const double eps = heat->emissivity[b];
        if (heat->area[b] == 0) continue;
        sum += heat->area[b] * (eps * heat->emission[b] - heat->radiosity[b]) + (1 - eps) * heat->received[b];
        area += heat->area[b];
    }
    return area > 0 ? sum / area : 0;
}

static double slope_of(fibrad_heat *heat) {
    double slope = 0;
    for (uint32_t a = 0; a < heat->patches; a++) {
        const uint32_t group = a + 1 < heat->patches ? heat->group : 1;
        const double z = residual(heat, a, group);
        for (uint32_t b = a; b < a + group; b++) {
            heat->source[b].value = z;
            if (heat->emissivity[b] < 1) slope += heat->area[b] * z * z / (1 - heat->emissivity[b]);
        }
        a += group - 1;
    }
    return slope;
}

static void net_power(const fibrad_heat *heat, double *power) {
    const uint32_t patches = heat->config.patches;
    for (uint32_t i = 0; i < heat->scene->facts.spheres; i++) {
        power[i] = 0;
        for (uint32_t a = i * patches; a < (i + 1) * patches; a++)
            power[i] += heat->received[a] - heat->area[a] * heat->radiosity[a];
    }
}

static void set_scale(fibrad_heat *heat) {
    double sum = 0, mean = 0, square = 0;
    for (uint32_t a = 0; a < heat->patches; a++) {
        sum += heat->area[a] * heat->emissivity[a];
        mean += heat->area[a] * heat->emissivity[a] * heat->emission[a];
    }
    mean = sum > 0 ? mean / sum : 0;
    for (uint32_t a = 0; a < heat->patches; a++) {
        const double difference = heat->emission[a] - mean;
        square += heat->area[a] * heat->emissivity[a] * difference * difference;
    }
    heat->scale = square;
}

/* Begins or goes on with the search. Returns whether there is a direction left to search in. */
static int search(fibrad_heat *heat, bool restart) {
    for (;;) {
        const double slope = slope_of(heat);
        const bool done = slope <= heat->tolerance * heat->tolerance * heat->scale || heat->sweeps >= heat->limit;
        if (!done) {
            const double keep = restart ? 0 : slope / heat->slope;
            for (uint32_t a = 0; a < heat->patches; a++) {
                const double z = heat->emissivity[a] < 1 ? heat->source[a].value : 0;
                heat->direction[a] = z + (restart ? 0 : keep * heat->direction[a]);
                heat->source[a].value = heat->direction[a];
            }
            heat->slope = slope;
            heat->phase = FIBRAD_HEAT_STEPS;
            return 1;
        }
        if (heat->group != 4 || heat->sweeps >= heat->limit) break;
        net_power(heat, heat->coarse);
        heat->group = 1;
        restart = true;
    }
    heat->phase = FIBRAD_HEAT_DONE;
    return 0;
}

static int first(fibrad_heat *heat) {
    for (uint32_t a = 0; a < heat->patches; a++) heat->source[a].value = heat->radiosity[a];
    heat->phase = FIBRAD_HEAT_FIRST;
    return 1;
}

int fibrad_heat_step(fibrad_heat *heat) {
    const double *sum = gather(heat);
    heat->sweeps++;
    if (heat->phase == FIBRAD_HEAT_AREA) {
        fibrad_copy(heat->area, sum, heat->patches * sizeof *sum);
        return first(heat);
    }
    if (heat->phase == FIBRAD_HEAT_FIRST) {
        fibrad_copy(heat->received, sum, heat->patches * sizeof *sum);
        set_scale(heat);
        return search(heat, true);
    }
    double curvature = 0;
    for (uint32_t a = 0; a < heat->patches; a++) {
        const double p = heat->direction[a];
        if (heat->emissivity[a] < 1) curvature += p * (heat->area[a] * p / (1 - heat->emissivity[a]) - sum[a]);
    }
    const double length = heat->slope / curvature;
    for (uint32_t a = 0; a < heat->patches; a++) {
        heat->radiosity[a] += length * heat->direction[a];
        heat->received[a] += length * sum[a];
    }
    return search(heat, false);
}

int fibrad_heat_begin(fibrad_heat *heat, const fibrad_heat_sources *s) {
    const uint32_t patches = heat->config.patches;
    const fibrad_scene *scene = heat->scene;
    for (uint32_t a = 0; a < heat->patches; a++) {
        const bool open = a + 1 == heat->patches;
        const uint32_t i = open ? 0 : scene->order[a / patches];
        const double t = open ? s->surroundings : s->temperature[i];
        const double emission = s->sigma * (t * t) * (t * t);
        heat->radiosity[a] = heat->solved ? heat->radiosity[a] + (emission - heat->emission[a]) : emission;
        heat->emission[a] = emission;
        heat->emissivity[a] = open ? 1 : s->emissivity[i];
        if (heat->emissivity[a] == 1) heat->radiosity[a] = emission;
    }
    heat->group = s->uniform ? patches : 4;
    heat->tolerance = s->tolerance > 0 ? s->tolerance : 1e-4;
    heat->limit = s->sweeps_max > 0 ? s->sweeps_max : 1000;
    heat->sweeps = 0;
    if (heat->solved) return first(heat), FIBRAD_OK;
    for (uint32_t a = 0; a < heat->patches; a++) heat->source[a].value = 1;
    heat->phase = FIBRAD_HEAT_AREA;
    return FIBRAD_OK;
}

int fibrad_heat_read(const fibrad_heat *heat, fibrad_heat_result *result) {
    const uint32_t patches = heat->config.patches, n = heat->scene->facts.spheres;
    double square = 0;
    for (uint32_t place = 0; place < n; place++) {
        double q = 0;
        for (uint32_t a = place * patches; a < (place + 1) * patches; a++)
            q += heat->received[a] - heat->area[a] * heat->radiosity[a];
        const double change = heat->group == 1 ? (q - heat->coarse[place]) / 3 : 0;
        result->power[heat->scene->order[place]] = q + change;
        square += change * change;
    }
    result->error = fibrad_sqrt(square / n);
    const uint32_t open = heat->patches - 1;
    result->surroundings_power = heat->received[open] - heat->area[open] * heat->radiosity[open];
    result->sweeps = heat->sweeps;
    result->residual = heat->scale > 0 ? fibrad_sqrt(heat->slope / heat->scale) : 0;
    return FIBRAD_OK;
}
