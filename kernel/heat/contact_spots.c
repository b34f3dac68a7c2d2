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

#define TOUCHES     1.05 /* of two surfaces: distance over that at which they touch, at most */
#define NEAR        .8   /* cosine of the rings in which they see little else */
#define SPREAD      .9   /* cosine of the places over which the heat of a spot is spread on patches */
#define SPREAD_SIZE .755 /* a spot as warm in its middle has this part of their radius */

/* Errors of what radiation about a spot changes, of 120 flows: docs/methods.md section 28. */
#define RADIATED_ERROR .01 /* of the whole */
#define NEAR_ERROR     .08 /* of what is not as patches tell, at walls */
#define FACING_ERROR   .15 /* the same between spheres */
#define STEEPER        .4  /* times 1/(2 k*): these errors are larger where a sphere conducts badly */

struct spot {
    double apart, resistance; /* K, and K over power */
    double doubt[2];          /* squares of the errors of both */
};

/* The direction from a sphere to the other end of contact k. False: it is not known, or the sphere has one temperature.
 */
static bool direction_of_spot(const fibrad_heat *heat, uint32_t body, uint32_t other, double axis[3], double *away) {
    const fibrad_scene *scene = heat->scene;
    if (!fibrad_heat_conducts(heat, body) || other >= fibrad_heat_body(heat, FIBRAD_MESHES)) return false;
    const double at[3] = {scene->x[body], scene->y[body], scene->z[body]};
    if (other >= heat->spheres) {
        fibrad_wall_normal(scene, other - heat->spheres, at, axis);
        for (int k = 0; k < 3; k++) axis[k] = -axis[k];
        *away = fibrad_walls_away(&scene->container, other - heat->spheres, at);
        return true;
    }
    axis[0] = scene->x[other] - at[0], axis[1] = scene->y[other] - at[1], axis[2] = scene->z[other] - at[2];
    for (int k = 0; k < 3; k++)
        if (scene->period[k] > 0) axis[k] -= scene->period[k] * fibrad_floor(axis[k] / scene->period[k] + .5);
    const double distance = fibrad_sqrt(fibrad_dot(axis, axis));
    for (int k = 0; k < 3; k++) axis[k] /= distance;
    *away = distance;
    return distance > 0;
}

/* Lets a power enter a sphere about a direction. It is spread over patches, since patterns know no single patch. */
static void enter_at(const fibrad_heat *heat, uint32_t b, const double axis[3], double power) {
    double sum = 0;
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) {
            const double share = heat->solution.area[a] * fibrad_heat_within_cap(heat, b, a, axis, SPREAD);
            if (pass == 0)
                sum += share;
            else if (sum > 0)
                heat->spots.entering[a] += power * (share / sum);
        }
}

/* Resistances of spots are those of half-spaces, 1/(4 k a), times what a sphere adds, whose other side takes the heat
 * out evenly. docs/methods.md section 28. */
static double resistance_of_spot(double conductivity, double size, double radius) {
    const double x = fibrad_min(size, SPOT_LARGEST);
    return (1 - x / FIBRAD_PI * (.5 + fibrad_log(2 * x) + .77 * x)) / (4 * conductivity * size * radius);
}

/* An end of a contact: a place on a sphere, or a wall. */
struct end {
    uint32_t body;
    bool known; /* the place is known, and the sphere conducts */
    double axis[3];
    fibrad_heat_ringed mean; /* about the axis */
};

/* How the rings about a spot radiate: the power per area that a ring absorbs is `absorbs` minus `emits` times the
 * difference of its emission from the mean of the sphere. */
struct ring_light {
    double absorbs[FIBRAD_RINGS], emits[FIBRAD_RINGS], follows[FIBRAD_RINGS];
};

/* What a ring has before it: the share of its view that is the other surface, the share of that surface's view that is
 * the sphere, and what the other surface emits there. */
struct opposite {
    double sees, seen, emitted;
};

static struct opposite opposite_wall(const fibrad_heat *heat, uint32_t wall, double height, double cosine) {
    const double square = height * height + 1 - cosine * cosine;
    return (struct opposite){(1 + cosine) / 2, height / (square * fibrad_sqrt(square)),
                             heat->sources.emissivity[wall] * heat->sources.emission[wall]};
}

static struct opposite opposite_sphere(const fibrad_heat *heat, double r, const struct end *other, double distance,
                                       double cosine) {
    const double size = heat->scene->r[other->body], eps = heat->sources.emissivity[other->body];
    const double sine = fibrad_min(1, fibrad_sqrt(1 - cosine * cosine) * r / size),
                 turned = fibrad_sqrt(1 - sine * sine);
    const uint32_t k = fibrad_rings_at(heat->rings, turned);
    return (struct opposite){fibrad_rings_sees(r, size, distance, cosine), fibrad_rings_sees(size, r, distance, turned),
                             other->known ? other->mean.sent[k] - (1 - eps) * other->mean.arriving[k]
                                          : eps * heat->sources.emission[other->body]};
}

/* Where a sphere touches a wall or a sphere, irradiation is known: what the other surface emits, what it sends back,
 * and light from elsewhere, taken to be equally bright in all directions. */
static void look_before(const fibrad_heat *heat, const struct end *end, const struct end *other, double away,
                        struct ring_light *light) {
    const double r = heat->scene->r[end->body], e = heat->sources.emissivity[end->body];
    const double bright = heat->sources.emissivity[other->body], mean = heat->sources.emission[end->body];
    const bool wall = other->body >= heat->spheres;
    const double touching = wall ? r : r + heat->scene->r[other->body], distance = fibrad_max(away, touching);
    const double follows =
        other->known ? heat->sources.conductivity[end->body] / heat->sources.conductivity[other->body] : 0;
    double back[FIBRAD_RINGS], own[FIBRAD_RINGS], open[FIBRAD_RINGS], sum = 0, squares = 0;
    uint32_t near = 0;
    if (away > TOUCHES * touching) return;
    while (near < FIBRAD_RINGS && heat->rings->cosine[near] >= NEAR) near++;
    for (uint32_t k = 0; k < near; k++) {
        const double cosine = heat->rings->cosine[k], taper = fibrad_min(1, 2 * (cosine - NEAR) / (1 - NEAR));
        const struct opposite opposite = wall ? opposite_wall(heat, other->body, distance / r, cosine)
                                              : opposite_sphere(heat, r, other, distance, cosine);
        back[k] = opposite.sees * opposite.seen * (1 - bright) * taper;
        own[k] = opposite.sees * opposite.emitted, light->follows[k] = opposite.sees * bright * follows * taper;
        open[k] = 1 - opposite.sees * bright - back[k];
        sum += end->mean.area[k] * open[k] * (end->mean.arriving[k] - back[k] * end->mean.sent[k] - own[k]);
        squares += end->mean.area[k] * open[k] * open[k];
    }
    for (uint32_t k = 0; k < near && squares > 0; k++) {
        const double keeps = e / (1 - back[k] * (1 - e));
        light->emits[k] = keeps * (1 - back[k]), light->follows[k] *= keeps;
        light->absorbs[k] = keeps * (own[k] + open[k] * (sum / squares) - (1 - back[k]) * mean);
    }
}

/* Looks at the rings about an end. entering: what enters there so far. Returns the distance of the other end from the
 * centre. */
static double look_at_end(const fibrad_heat *heat, uint32_t body, uint32_t other, double entering, struct end *end) {
    double away = 0;
    end->body = body, end->known = direction_of_spot(heat, body, other, end->axis, &away);
    if (!end->known) return away;
    enter_at(heat, body, end->axis, -entering);
    fibrad_heat_look_in_rings(heat, body, end->axis, 1, true, &end->mean);
    enter_at(heat, body, end->axis, entering);
    return away;
}

static double square_of(double x) { return x * x; }

static double error_of_radiated(double whole, double near, double uneven) {
    return (1 + square_of(STEEPER * uneven)) * (square_of(RADIATED_ERROR * whole) + square_of(near));
}

/* By how much less a spot emits if the other surface is warmer about its spot where this one is colder. Patches know
 * this as far as the heat that is spread on them tells. */
static double followed(const fibrad_heat *heat, const struct ring_light *light, double size,
                       const double response[FIBRAD_RINGS]) {
    double sum = 0, spread[FIBRAD_RINGS], spot[FIBRAD_RINGS];
    if (!(light->follows[0] > 0)) return 0;
    fibrad_rings_warmth(heat->rings, SPREAD_SIZE * fibrad_sqrt(2 * (1 - SPREAD)), spread);
    fibrad_rings_warmth(heat->rings, size, spot);
    for (uint32_t m = 0; m < FIBRAD_RINGS; m++)
        if (light->follows[m] > 0)
            sum += heat->rings->share[m] * light->follows[m] * square_of(response[m]) * (1 - spread[m] / spot[m]);
    return sum;
}

static struct spot find_spot(const fibrad_heat *heat, const struct end *end, const struct end *other, double away,
                             double radius, fibrad_rings_work *work) {
    double response[FIBRAD_RINGS], apart = 0, other_light = 0;
    struct ring_light light;
    if (!end->known) return (struct spot){0};
    const uint32_t b = end->body;
    const double r = heat->scene->r[b], eps = heat->sources.emissivity[b], k = heat->sources.conductivity[b],
                 uneven = heat->sources.unevenness[b], slope = uneven * k / r,
                 near = other->body < heat->spheres ? FACING_ERROR : NEAR_ERROR,
                 size = fibrad_min(radius / r, SPOT_LARGEST), to_spot = 1 / (4 * FIBRAD_PI * r * r * slope);
    for (uint32_t m = 0; m < FIBRAD_RINGS; m++)
        light.emits[m] = eps, light.follows[m] = 0,
        light.absorbs[m] = eps * (end->mean.arriving[m] - heat->sources.emission[b]);
    look_before(heat, end, other, away, &light);
    const double alone =
        fibrad_rings_spot(heat->rings, size, light.emits, uneven, fibrad_heat_biot(heat, b), work, response);
    double other_less = followed(heat, &light, size, response);
    const double less = alone + other_less;
    for (uint32_t m = 0; m < FIBRAD_RINGS; m++) {
        const double share = heat->rings->share[m] * response[m];
        apart += share * (light.absorbs[m] + end->mean.absorbed[m]);
        other_light += share * (light.absorbs[m] - eps * (end->mean.arriving[m] - heat->sources.emission[b]));
        other_less += share * response[m] * (light.emits[m] - eps);
    }
    return (struct spot){apart / slope,
                         resistance_of_spot(k, radius / r, r) - less * to_spot,
                         {error_of_radiated(apart, near * other_light, uneven) / square_of(slope),
                          error_of_radiated(less, near * other_less, uneven) * square_of(to_spot)}};
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
    const uint32_t i = heat->end[c->first[k]], j = heat->end[c->second[k]];
    const double given = s->given[k], last = s->flow[k], inf = __builtin_inf();
    s->conductance[k] = given, s->offset[k] = 0;
    if (!(given > 0) || i == j) return 0;
    const double softness[2] = {i < heat->spheres ? 1 / heat->sources.conductivity[i] : 0,
                                j < heat->spheres ? 1 / heat->sources.conductivity[j] : 0};
    const double radius = given * (softness[0] + softness[1]) / 4;
    struct end end[2];
    const double away[2] = {look_at_end(heat, i, j, -last, &end[0]), look_at_end(heat, j, i, last, &end[1])};
    const struct spot first = find_spot(heat, &end[0], &end[1], away[0], radius, work),
                      second = find_spot(heat, &end[1], &end[0], away[1], radius, work);
    const double resistance = first.resistance + second.resistance;
    if (resistance > 0 && resistance < inf)
        s->conductance[k] = 1 / resistance, s->offset[k] = (first.apart - second.apart) / resistance;
    const double other = fibrad_heat_at_contact(heat, k, fibrad_contact_temperature(c, heat->sources.emission[j]));
    s->next[k] = s->conductance[k] * (fibrad_contact_temperature(c, heat->sources.emission[i]) - other) + s->offset[k];
    s->doubt[k] = square_of(s->conductance[k]) *
                  (first.doubt[0] + second.doubt[0] + (first.doubt[1] + second.doubt[1]) * square_of(s->next[k]));
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
    double axis[3], away;
    fibrad_zero(s->entering, heat->patches * sizeof *s->entering);
    for (uint32_t k = 0; k < c->count; k++) {
        const uint32_t i = heat->end[c->first[k]], j = heat->end[c->second[k]];
        s->flow[k] = s->next[k];
        if (i == j) continue;
        if (i < heat->spheres && direction_of_spot(heat, i, j, axis, &away)) enter_at(heat, i, axis, -s->flow[k]);
        if (j < heat->spheres && direction_of_spot(heat, j, i, axis, &away)) enter_at(heat, j, axis, s->flow[k]);
    }
}

void fibrad_heat_add_places(const fibrad_heat *heat, double *to) {
    const fibrad_contacts *c = &heat->contacts;
    const double *own = heat->sources.asked.contact_temperature;
    for (uint32_t k = 0; k < c->count && own != NULL; k++) {
        if (own[k] != own[k]) continue; /* NaN: that of the wall */
        const uint32_t b = heat->end[c->second[k]];
        const double more = c->conductance[k] * (own[k] - fibrad_contact_temperature(c, heat->sources.emission[b]));
        to[heat->end[c->first[k]]] += more, to[b] -= more;
    }
}

void fibrad_heat_add_offsets(const fibrad_heat *heat, double *to) {
    const fibrad_contacts *c = &heat->contacts;
    fibrad_heat_add_places(heat, to);
    for (uint32_t k = 0; k < c->count && heat->spots.entering != NULL; k++)
        to[heat->end[c->first[k]]] -= heat->spots.offset[k], to[heat->end[c->second[k]]] += heat->spots.offset[k];
}
