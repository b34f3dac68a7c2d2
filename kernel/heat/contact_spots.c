/* contact_spots.c - contacts at their places on spheres that conduct. SPDX-License-Identifier: MIT
 *
 * An end of a contact on a sphere that conducts is a spot of one temperature. Its radius follows from the conductance,
 * which is that between half-spaces. The spot is warmer than the mean of its sphere by
 *
 *     apart + resistance times the power that enters,
 *
 * apart being due to light and to other contacts. */
#include "base/elementary.h"
#include "base/vector.h"
#include "heat/solution.h"
#include "scene/walls.h"

#define SPOT_LARGEST .4 /* largest radius of a spot for which a sphere adds to its resistance */

struct spot {
    double apart, resistance; /* K, and K over power */
};

/* The direction from a sphere to the other end of contact k. False: it is not known, or the sphere has one temperature.
 */
static bool direction_of_spot(const fibrad_heat *heat, uint32_t body, uint32_t other, double axis[3]) {
    const fibrad_scene *scene = heat->scene;
    if (!fibrad_heat_conducts(heat, body) || other >= fibrad_heat_body(heat, FIBRAD_MESHES)) return false;
    const double at[3] = {scene->x[body], scene->y[body], scene->z[body]};
    if (other >= heat->spheres) {
        fibrad_wall_normal(scene, other - heat->spheres, at, axis);
        for (int k = 0; k < 3; k++) axis[k] = -axis[k];
        return true;
    }
    axis[0] = scene->x[other] - at[0], axis[1] = scene->y[other] - at[1], axis[2] = scene->z[other] - at[2];
    for (int k = 0; k < 3; k++)
        if (scene->period[k] > 0) axis[k] -= scene->period[k] * fibrad_floor(axis[k] / scene->period[k] + .5);
    const double distance = fibrad_sqrt(fibrad_dot(axis, axis));
    for (int k = 0; k < 3; k++) axis[k] /= distance;
    return distance > 0;
}

/* Lets a power enter a sphere at a direction: evenly into the own patch there. */
static void enter_at(const fibrad_heat *heat, uint32_t b, const double axis[3], double power) {
    double area = 0;
    const uint32_t cube = heat->config.patches, first = heat->first[b], own = fibrad_patch_of(axis, heat->side);
    const uint16_t *on_patch = heat->division.on_patch + heat->division.first_four[b];
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t a = first; a < heat->first[b + 1]; a++) {
            const uint32_t k = a - first;
            if ((k < cube ? k : on_patch[(k - cube) / FIBRAD_HEAT_FOUR]) != own) continue;
            if (pass == 0)
                area += heat->solution.area[a];
            else if (area > 0)
                heat->spots.entering[a] += power * (heat->solution.area[a] / area);
        }
}

/* Resistances of spots are those of half-spaces, 1/(4 k a), times what a sphere adds, whose other side takes the heat
 * out evenly. docs/methods.md section 28. */
static double resistance_of_spot(double conductivity, double size, double radius) {
    const double x = fibrad_min(size, SPOT_LARGEST);
    return (1 - x / FIBRAD_PI * (.5 + fibrad_log(2 * x) + .85 * x)) / (4 * conductivity * size * radius);
}

/* The end of contact k on `body`. entering: what enters there so far. The irradiation on the axis counts most, and
 * patches have means, so it is extrapolated to patches without size. */
static struct spot find_spot(const fibrad_heat *heat, uint32_t body, uint32_t other, double radius,
                             double entering_so_far, fibrad_rings_work *work) {
    double axis[3], response[FIBRAD_RINGS], apart = 0;
    struct spot spot = {0, 0};
    fibrad_heat_ringed mean;
    if (!direction_of_spot(heat, body, other, axis)) return spot;
    const double r = heat->scene->r[body], eps = heat->sources.emissivity[body], k = heat->sources.conductivity[body],
                 uneven = heat->sources.unevenness[body], slope = uneven * k / r;
    enter_at(heat, body, axis, -entering_so_far);
    fibrad_heat_look_in_rings(heat, body, axis, 1, other >= heat->spheres ? FIBRAD_HEAT_EXTRAPOLATION : 0, &mean);
    enter_at(heat, body, axis, entering_so_far);
    const double less = fibrad_rings_spot(heat->rings, fibrad_min(radius / r, SPOT_LARGEST), eps, uneven,
                                          fibrad_heat_biot(heat, body), work, response);
    for (uint32_t m = 0; m < FIBRAD_RINGS; m++)
        apart += heat->rings->share[m] * response[m] * (eps * mean.arriving[m] + mean.absorbed[m]);
    spot.apart = apart / slope;
    spot.resistance = resistance_of_spot(k, radius / r, r) - less / (4 * FIBRAD_PI * r * r * slope);
    return spot;
}

static void note_spot(const fibrad_heat *heat, uint32_t b, double warmer) {
    fibrad_heat_span *span = &heat->solution.span[b];
    span->coldest_spot = fibrad_min(span->coldest_spot, warmer);
    span->hottest_spot = fibrad_max(span->hottest_spot, warmer);
}

/* Finds what contact k conducts. Returns by how much its flow changes. */
static double find_flow(fibrad_heat *heat, uint32_t k, fibrad_rings_work *work) {
    const fibrad_contacts *c = &heat->contacts;
    const fibrad_heat_spots *s = &heat->spots;
    const uint32_t i = c->node[c->first[k]], j = c->node[c->second[k]];
    const double given = s->given[k], last = s->flow[k], inf = __builtin_inf();
    s->conductance[k] = given, s->offset[k] = 0;
    if (!(given > 0) || i == j) return 0;
    const double softness[2] = {i < heat->spheres ? 1 / heat->sources.conductivity[i] : 0,
                                j < heat->spheres ? 1 / heat->sources.conductivity[j] : 0};
    const double radius = given * (softness[0] + softness[1]) / 4;
    const struct spot first = find_spot(heat, i, j, radius, -last, work),
                      second = find_spot(heat, j, i, radius, last, work);
    const double resistance = first.resistance + second.resistance;
    if (resistance > 0 && resistance < inf)
        s->conductance[k] = 1 / resistance, s->offset[k] = (first.apart - second.apart) / resistance;
    s->next[k] = s->conductance[k] * (fibrad_contact_temperature(c, heat->sources.emission[i]) -
                                      fibrad_contact_temperature(c, heat->sources.emission[j])) +
                 s->offset[k];
    if (i < heat->spheres) note_spot(heat, i, first.apart - first.resistance * s->next[k]);
    if (j < heat->spheres) note_spot(heat, j, second.apart + second.resistance * s->next[k]);
    return fibrad_abs(s->next[k] - last);
}

double fibrad_heat_find_spots(fibrad_heat *heat) {
    const fibrad_contacts *c = &heat->contacts;
    const fibrad_heat_spots *s = &heat->spots;
    double change = 0, largest = 0;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        heat->solution.span[b].coldest_spot = heat->solution.span[b].hottest_spot = 0;
        if (fibrad_heat_conducts(heat, b)) fibrad_heat_stand_for_absorbed(heat, b, -1);
    }
    for (uint32_t k = 0; k < c->count; k++) {
        s->next[k] = 0;
        change = fibrad_max(change, find_flow(heat, k, &heat->near[0]));
        largest = fibrad_max(largest, fibrad_abs(s->next[k]));
    }
    for (uint32_t b = 0; b < heat->spheres; b++)
        if (fibrad_heat_conducts(heat, b)) fibrad_heat_stand_for_absorbed(heat, b, 1);
    return largest > 0 ? change / largest : 0;
}

void fibrad_heat_place_flows(fibrad_heat *heat) {
    const fibrad_contacts *c = &heat->contacts;
    const fibrad_heat_spots *s = &heat->spots;
    double axis[3];
    fibrad_zero(s->entering, heat->patches * sizeof *s->entering);
    for (uint32_t k = 0; k < c->count; k++) {
        const uint32_t i = c->node[c->first[k]], j = c->node[c->second[k]];
        s->flow[k] = s->next[k];
        if (i == j) continue;
        if (i < heat->spheres && direction_of_spot(heat, i, j, axis)) enter_at(heat, i, axis, -s->flow[k]);
        if (j < heat->spheres && direction_of_spot(heat, j, i, axis)) enter_at(heat, j, axis, s->flow[k]);
    }
}

void fibrad_heat_add_offsets(const fibrad_heat *heat, double *to) {
    const fibrad_contacts *c = &heat->contacts;
    for (uint32_t k = 0; k < c->count && heat->spots.entering != NULL; k++)
        to[c->node[c->first[k]]] -= heat->spots.offset[k], to[c->node[c->second[k]]] += heat->spots.offset[k];
}
