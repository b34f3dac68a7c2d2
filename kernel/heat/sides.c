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
 * of the finer level, where the search begins. Both levels are searched in turn until nothing changes. What
 * extrapolation and areas from beams add to the fluxes of sides (`beyond`) is part of their balance. So fluxes are
 * those of a mesh whose sides are given the temperatures that were found. */
#include "heat/solution.h"

/* The sum over the patches of a side of areas times values, and of areas. */
static double sum_over(const fibrad_heat *heat, uint32_t begin, uint32_t end, const double *value, double *area) {
    double sum = 0;
    *area = 0;
    for (uint32_t a = begin; a < end; a++) sum += heat->solution.area[a] * value[a], *area += heat->solution.area[a];
    return sum;
}

/* What arrives at a side per area. */
static double arriving_at(const fibrad_heat *heat, uint32_t begin, uint32_t end, double *area) {
    double sum = sum_over(heat, begin, end, heat->solution.radiosity, area);
    for (uint32_t a = begin; a < end; a++) sum += heat->solution.net[a];
    return *area > 0 ? sum / *area : 0;
}

/* The end of the patches of the side that begins at patch a of a mesh. */
static uint32_t end_of_side(const fibrad_heat *heat, uint32_t a, uint32_t end) {
    do a++;
    while (a < end && heat->sources.within[a - fibrad_heat_first_meshed(heat)]);
    return a;
}

/* What the fluxes of a mesh have besides those of patches, with the present powers of the coarser level. */
static double beyond_of(const fibrad_heat *heat, uint32_t m) {
    return heat->sources.beyond[m] - FIBRAD_HEAT_EXTRAPOLATION *
                                         heat->solution.coarse[fibrad_heat_body(heat, FIBRAD_MESHES + m)] /
                                         fibrad_mesh_area(&heat->scene->mesh, m);
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

static side_law law_of_side(const fibrad_heat *heat, uint32_t m, uint32_t number, double arriving, double light) {
    const fibrad_contacts *c = &heat->contacts;
    const fibrad_heat_side side = fibrad_heat_side_of(heat, &heat->sources.asked, number);
    const double eps = heat->sources.emissivity[fibrad_heat_body(heat, FIBRAD_MESHES + m)], own = side.temperature;
    if (!side.found) return (side_law){fibrad_contact_emission(c, own == own ? own : heat->sources.of_others[m]), 0};
    const double more = side.power + light + beyond_of(heat, m);
    if (side.film == 0) return (side_law){arriving + more / eps, 1};
    const double supply = eps * (arriving - fibrad_contact_emission(c, 0)) + more + side.film * side.gas;
    const double t = supply != 0 ? root_of_balance(eps * c->sigma, side.film, fibrad_abs(supply)) : 0;
    const double slope = 4 * eps * c->sigma * t * t * t;
    return (side_law){fibrad_contact_emission(c, supply < 0 ? -t : t), slope / (slope + side.film)};
}

/* Finds `still` and `answer` of a mesh with the radiation that now arrives. Returns the mean emission of its sides.
 * Overwrites heat->solution.source. */
#define BELOW     1e-9 /* of sigma T^4: no more than this below 0 is rounding */
#define REFLECTED 1e-3 /* a side reflects at least this in the search, which divides by it */
static double find_sides_of(fibrad_heat *heat, uint32_t m) {
    const fibrad_mesh *mesh = &heat->scene->mesh;
    const uint32_t b = fibrad_heat_body(heat, FIBRAD_MESHES + m), from = fibrad_heat_first_meshed(heat);
    double *still = heat->sources.still - from, *answer = heat->sources.answer - from, *areas = heat->solution.source;
    const double eps = heat->sources.emissivity[b];
    double all = 0, sum = 0;
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) still[a] = answer[a] = areas[a] = 0;
    for (uint32_t k = mesh->first[m]; k < mesh->first[m + 1]; k++) {
        const fibrad_mesh_cut cut = *fibrad_mesh_cut_of(mesh, heat->cut, mesh->side[k]);
        if (cut.patch == UINT32_MAX) continue;
        const uint32_t begin = from + cut.patch, end = begin + (UINT32_C(1) << cut.halvings);
        const double own = fibrad_mesh_triangle_area(mesh, fibrad_side_triangle(mesh->side[k]));
        double area, light = 0;
        const double arriving = arriving_at(heat, begin, end, &area);
        for (uint32_t a = begin; a < end && heat->sources.absorbed != NULL; a++)
            light += heat->sources.absorbed[a] / area;
        side_law law = law_of_side(heat, m, mesh->side[k], arriving, light);
        if (!(area > 0)) law = (side_law){heat->sources.emission[b] + heat->sources.excess[cut.patch], 0};
        law.answer = fibrad_max(law.answer, (REFLECTED - (1 - eps)) / eps);
        heat->sources.held = heat->sources.held || law.answer < 1;
        for (uint32_t a = begin; a < end; a++) {
            areas[a] += own, answer[a] += own * law.answer;
            still[a] += own * (law.emission - law.answer * arriving);
            heat->sources.within[a - from] = a > begin;
        }
        all += own, sum += own * law.emission;
    }
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
        if (areas[a] > 0) still[a] /= areas[a], answer[a] /= areas[a];
    return all > 0 ? sum / all : heat->sources.emission[b];
}

void fibrad_heat_find_sides(fibrad_heat *heat) {
    heat->sources.held = false;
    for (uint32_t m = 0; m < heat->meshes; m++)
        if (heat->sources.has_sides[m]) find_sides_of(heat, m);
}

double fibrad_heat_sides_residual(fibrad_heat *heat, uint32_t b) {
    const double eps = heat->sources.emissivity[b];
    for (uint32_t a = heat->first[b], end; a < heat->first[b + 1]; a = end) {
        double area;
        end = end_of_side(heat, a, heat->first[b + 1]);
        const uint32_t at = a - fibrad_heat_first_meshed(heat);
        const double emission = heat->sources.still[at] + heat->sources.answer[at] * arriving_at(heat, a, end, &area);
        for (uint32_t k = a; k < end; k++)
            heat->solution.source[k] = heat->solution.area[k] > 0
                                           ? eps * (emission - heat->solution.radiosity[k]) +
                                                 (1 - eps) * heat->solution.net[k] / heat->solution.area[k]
                                           : 0;
    }
    return fibrad_heat_sides_product(heat, b, heat->solution.source, heat->solution.source, false);
}

double fibrad_heat_sides_product(const fibrad_heat *heat, uint32_t b, const double *x, const double *y, bool emits) {
    const double eps = heat->sources.emissivity[b], rho = 1 - eps, of_rest = rho > 0 ? (emits ? eps : 1) / rho : 0;
    double sum = 0, area;
    for (uint32_t a = heat->first[b], end; a < heat->first[b + 1]; a = end) {
        end = end_of_side(heat, a, heat->first[b + 1]);
        const double x_sum = sum_over(heat, a, end, x, &area), y_sum = sum_over(heat, a, end, y, &area);
        const double answer = heat->sources.answer[a - fibrad_heat_first_meshed(heat)], reflects = rho + eps * answer;
        if (!(area > 0)) continue;
        sum += (emits ? eps * (1 - answer) : 1) / reflects * x_sum * y_sum / area;
        for (uint32_t k = a; k < end; k++)
            sum += of_rest * heat->solution.area[k] * (x[k] - x_sum / area) * (y[k] - y_sum / area);
    }
    return sum;
}

/* Takes over the emissions of the sides of a mesh. Returns the square of what has changed: what the coarser level has
 * had, as far as extrapolation takes it, and `beyond`. */
static double finish_sides_of(fibrad_heat *heat, uint32_t m) {
    const uint32_t b = fibrad_heat_body(heat, FIBRAD_MESHES + m), from = fibrad_heat_first_meshed(heat);
    const double t0 = heat->sources.surroundings, black = heat->sources.sigma * (t0 * t0) * (t0 * t0);
    const double eps = heat->sources.emissivity[b], mean = find_sides_of(heat, m), before = beyond_of(heat, m);
    double *excess = heat->sources.excess - from, changed = 0, area, beyond[2];
    fibrad_heat_beyond_patches(heat, m, beyond);
    const double more = beyond[0] + beyond[1] - before;
    for (uint32_t a = heat->first[b], end; a < heat->first[b + 1]; a = end) {
        end = end_of_side(heat, a, heat->first[b + 1]);
        const double answer = heat->sources.answer[a - from];
        const double emission = heat->sources.still[a - from] + answer * arriving_at(heat, a, end, &area);
        const double lag = FIBRAD_HEAT_EXTRAPOLATION * (emission - heat->sources.emission[b] - excess[a]);
        changed += area * (eps * lag * lag + answer * more * (answer * more) / eps);
        for (uint32_t k = a; k < end; k++) excess[k] = emission - mean;
        heat->sources.below = heat->sources.below || emission + black < -BELOW * (black + fibrad_abs(mean));
    }
    heat->sources.beyond[m] += more;
    heat->sources.emission[b] = mean, heat->sources.temperature[b] = fibrad_heat_temperature(heat, mean);
    return changed;
}

bool fibrad_heat_finish_sides(fibrad_heat *heat) {
    const double last = heat->sources.changed, tolerance = heat->sources.tolerance;
    const bool passed = heat->sources.passed;
    double changed = 0;
    heat->sources.below = false;
    for (uint32_t m = 0; m < heat->meshes; m++)
        if (heat->sources.has_sides[m]) changed += finish_sides_of(heat, m);
    heat->sources.passed = true, heat->sources.changed = passed ? changed : __builtin_inf();
    return heat->sources.sides &&
           (!passed || (changed > fibrad_max(tolerance * tolerance * heat->solution.scale, heat->solution.smallest) &&
                        changed < last / 4));
}
