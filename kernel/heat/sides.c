/* sides.c - temperatures of sides of triangles that have films or powers. SPDX-License-Identifier: MIT
 *
 * Let H be what arrives at a side per area, the mean over its patches. The emission E of the side follows from
 *
 *     eps (H - E) + film (T_gas - T) + power = 0.
 *
 * About the present H it is linear: E = still + answer H, where answer = dE/dH is 0 if T is given and 1 if there is no
 * film. So the side is like one of emissivity eps (1 - answer) for the mean of J, and of eps for what differs from the
 * mean. If sides share a patch, `still` and `answer` are their means.
 *
 * This is so on the finer level. There `still` and `answer` are found anew where the search would end, until they no
 * longer change. On the coarser level the emissions of all sides are given, as if they had temperatures. They are those
 * of the finer level, so both levels are searched again until they no longer change. What extrapolation and areas from
 * beams add to the fluxes of sides (`beyond`) is part of their balance. So fluxes are those of a mesh whose sides are
 * given the temperatures that were found. */
#include "heat/solution.h"

/* A mean over the patches of a side. */
static double mean_over(const fibrad_heat *heat, uint32_t begin, uint32_t end, const double *value, double *area) {
    double sum = 0;
    *area = 0;
    for (uint32_t a = begin; a < end; a++) sum += heat->solution.area[a] * value[a], *area += heat->solution.area[a];
    return *area > 0 ? sum / *area : 0;
}

/* The net flow to the patches of a side, or another sum over them, per area. */
static double flow_to(uint32_t begin, uint32_t end, const double *flow, double area) {
    double sum = 0;
    for (uint32_t a = begin; a < end && flow != NULL; a++) sum += flow[a];
    return area > 0 ? sum / area : 0;
}

/* The end of the patches of the side that begins at patch a of a mesh. */
static uint32_t end_of_side(const fibrad_heat *heat, uint32_t a, uint32_t end) {
    const unsigned char *within = heat->sources.within - fibrad_heat_first_meshed(heat);
    do a++;
    while (a < end && within[a]);
    return a;
}

/* T of a T^4 + b T = c. All are above 0. T begins too high, and Newton's method comes down. */
static double root_of_balance(double a, double b, double c) {
    double t = fibrad_min(fibrad_sqrt(fibrad_sqrt(c / a)), c / b), last;
    do last = t, t -= (a * (t * t) * (t * t) + b * t - c) / (4 * a * t * t * t + b);
    while (t < last);
    return t;
}

/* The emission of a side at what arrives, and how it changes with that. A negative emission has a negative T. */
typedef struct side_law {
    double emission, answer;
} side_law;

#define LEAST_ANSWER 1e-9 /* of a side that reflects nothing: 1 minus its effective emissivity divides */

static side_law law_of_side(const fibrad_heat *heat, uint32_t m, uint64_t side, double arriving, double light) {
    const fibrad_heat_given *s = &heat->sources;
    const fibrad_contacts *c = &heat->contacts;
    const double eps = s->emissivity[fibrad_heat_body(heat, FIBRAD_MESHES + m)];
    if (!fibrad_heat_side_is_found(s->side_film, s->side_power, side)) {
        const double own = s->side_temperature != NULL ? s->side_temperature[side] : __builtin_nan("");
        return (side_law){fibrad_contact_emission(c, own == own ? own : s->of_others[m]), 0};
    }
    const double given = s->side_power != NULL && s->side_power[side] == s->side_power[side] ? s->side_power[side] : 0;
    const double film = s->side_film != NULL ? s->side_film[side] : 0, more = given + light + s->beyond[m];
    if (film == 0) return (side_law){arriving + more / eps, 1};
    const double supply = eps * (arriving - fibrad_contact_emission(c, 0)) + more + film * s->side_gas[side];
    const double t = supply != 0 ? root_of_balance(eps * s->sigma, film, fibrad_abs(supply)) : 0;
    const double slope = 4 * eps * s->sigma * t * t * t, least = eps == 1 ? LEAST_ANSWER : 0;
    return (side_law){fibrad_contact_emission(c, supply < 0 ? -t : t), fibrad_max(slope / (slope + film), least)};
}

/* Finds `still` and `answer` of a mesh with the radiation that now arrives. Overwrites heat->solution.source. Returns
 * the mean emission of its sides. */
static double find_sides_of(fibrad_heat *heat, uint32_t m) {
    const fibrad_mesh *mesh = &heat->scene->mesh;
    const uint32_t b = fibrad_heat_body(heat, FIBRAD_MESHES + m), from = fibrad_heat_first_meshed(heat);
    double *still = heat->sources.still - from, *answer = heat->sources.answer - from, *areas = heat->solution.source;
    double all = 0, sum = 0;
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) still[a] = answer[a] = areas[a] = 0;
    for (uint32_t k = mesh->first[m]; k < mesh->first[m + 1]; k++) {
        const fibrad_mesh_cut cut = *fibrad_mesh_cut_of(mesh, heat->cut, mesh->side[k]);
        if (cut.patch == UINT32_MAX) continue;
        const uint32_t begin = from + cut.patch, end = begin + (UINT32_C(1) << cut.halvings);
        const double own = fibrad_mesh_triangle_area(mesh, fibrad_side_triangle(mesh->side[k]));
        double area;
        const double sent = mean_over(heat, begin, end, heat->solution.radiosity, &area);
        const double arriving = sent + flow_to(begin, end, heat->solution.net, area);
        const double light = flow_to(begin, end, heat->sources.absorbed, area);
        side_law law = law_of_side(heat, m, fibrad_side_given(mesh, mesh->side[k]), arriving, light);
        if (!(area > 0)) law = (side_law){heat->sources.emission[b] + heat->sources.excess[cut.patch], 0};
        for (uint32_t a = begin; a < end; a++) {
            areas[a] += own, answer[a] += own * law.answer;
            still[a] += own * (law.emission - law.answer * arriving);
        }
        all += own, sum += own * law.emission;
    }
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
        if (areas[a] > 0) still[a] /= areas[a], answer[a] /= areas[a];
    return all > 0 ? sum / all : heat->sources.emission[b];
}

void fibrad_heat_find_sides(fibrad_heat *heat) {
    for (uint32_t m = 0; m < heat->meshes; m++)
        if (heat->sources.has_sides[m]) find_sides_of(heat, m);
}

double fibrad_heat_sides_residual(fibrad_heat *heat, uint32_t b) {
    const double eps = heat->sources.emissivity[b], rho = 1 - eps, *net = heat->solution.net;
    const double *answer = heat->sources.answer - fibrad_heat_first_meshed(heat),
                 *still = heat->sources.still - fibrad_heat_first_meshed(heat);
    double slope = 0, area;
    for (uint32_t a = heat->first[b], end; a < heat->first[b + 1]; a = end) {
        end = end_of_side(heat, a, heat->first[b + 1]);
        const double sent = mean_over(heat, a, end, heat->solution.radiosity, &area), flow = flow_to(a, end, net, area);
        const double reflects = rho + eps * answer[a], takes = eps * (1 - answer[a]);
        const double shift = area > 0 && reflects > 0 ? eps * still[a] - takes * sent + reflects * flow : 0;
        if (reflects > 0) slope += area * shift * shift / reflects;
        for (uint32_t k = a; k < end; k++) {
            const double own = heat->solution.area[k];
            const double rest =
                rho > 0 && own > 0 ? eps * (sent - heat->solution.radiosity[k]) + rho * (net[k] / own - flow) : 0;
            heat->solution.source[k] = shift + rest;
            if (rho > 0) slope += own * rest * rest / rho;
        }
    }
    return slope;
}

double fibrad_heat_sides_product(const fibrad_heat *heat, uint32_t b, const double *x, const double *y, bool emits) {
    const double eps = heat->sources.emissivity[b], rho = 1 - eps, of_rest = rho > 0 ? (emits ? eps : 1) / rho : 0;
    const double *answer = heat->sources.answer - fibrad_heat_first_meshed(heat);
    double sum = 0, area;
    for (uint32_t a = heat->first[b], end; a < heat->first[b + 1]; a = end) {
        end = end_of_side(heat, a, heat->first[b + 1]);
        const double x_mean = mean_over(heat, a, end, x, &area), y_mean = mean_over(heat, a, end, y, &area);
        const double reflects = rho + eps * answer[a], takes = eps * (1 - answer[a]);
        if (reflects > 0) sum += (emits ? takes : 1) / reflects * area * x_mean * y_mean;
        for (uint32_t k = a; k < end; k++) sum += of_rest * heat->solution.area[k] * (x[k] - x_mean) * (y[k] - y_mean);
    }
    return sum;
}

double fibrad_heat_sides_squares(const fibrad_heat *heat, uint32_t b, double level) {
    const uint32_t from = fibrad_heat_first_meshed(heat);
    const double eps = heat->sources.emissivity[b], *answer = heat->sources.answer - from,
                 *still = heat->sources.still - from;
    double sum = 0;
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) {
        const double more = still[a] - (1 - answer[a]) * level;
        sum += eps * heat->solution.area[a] * more * more;
    }
    return sum;
}

bool fibrad_heat_sides_hold(const fibrad_heat *heat, uint32_t b) {
    const double *answer = heat->sources.answer - fibrad_heat_first_meshed(heat);
    bool hold = false;
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
        hold = hold || (heat->solution.area[a] > 0 && answer[a] < 1);
    return hold;
}

void fibrad_heat_correct_sides(fibrad_heat *heat, double change) {
    for (uint32_t m = 0; m < heat->meshes; m++) {
        const uint32_t b = fibrad_heat_body(heat, FIBRAD_MESHES + m);
        if (heat->sources.has_sides[m])
            heat->sources.beyond[m] +=
                change * FIBRAD_HEAT_EXTRAPOLATION * heat->solution.coarse[b] / fibrad_mesh_area(&heat->scene->mesh, m);
    }
}

bool fibrad_heat_finish_sides(fibrad_heat *heat) {
    const double last = heat->sources.changed, tolerance = heat->sources.tolerance;
    const bool passed = heat->sources.passed;
    double changed = 0;
    for (uint32_t m = 0; m < heat->meshes; m++) {
        if (!heat->sources.has_sides[m]) continue;
        const uint32_t b = fibrad_heat_body(heat, FIBRAD_MESHES + m), from = fibrad_heat_first_meshed(heat);
        const double eps = heat->sources.emissivity[b], before = heat->sources.beyond[m];
        double *excess = heat->sources.excess - from, area, beyond[2];
        fibrad_heat_beyond_patches(heat, m, beyond);
        const double more = beyond[0] + beyond[1] - before, mean = find_sides_of(heat, m);
        const double *answer = heat->sources.answer - from, *still = heat->sources.still - from;
        for (uint32_t a = heat->first[b], end; a < heat->first[b + 1]; a = end) {
            end = end_of_side(heat, a, heat->first[b + 1]);
            const double sent = mean_over(heat, a, end, heat->solution.radiosity, &area);
            const double emission = still[a] + answer[a] * (sent + flow_to(a, end, heat->solution.net, area));
            const double lag = emission - (heat->sources.emission[b] + excess[a]), by = answer[a] * more;
            changed += area * (eps * FIBRAD_HEAT_EXTRAPOLATION * FIBRAD_HEAT_EXTRAPOLATION * lag * lag + by * by / eps);
            for (uint32_t k = a; k < end; k++) {
                if (passed) heat->solution.detail[k] -= eps * lag;
                excess[k] = emission - mean;
            }
        }
        heat->sources.beyond[m] += more;
        heat->sources.emission[b] = mean, heat->sources.temperature[b] = fibrad_heat_temperature(heat, mean);
    }
    if (passed) heat->sources.changed = changed;
    heat->sources.passed = true;
    return !passed || (changed > fibrad_max(tolerance * tolerance * heat->solution.scale, heat->solution.smallest) &&
                       changed < last / 4);
}
