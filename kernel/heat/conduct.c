/* conduct.c - spheres that conduct, so that their surfaces are not at one temperature. SPDX-License-Identifier: MIT
 *
 * The inside is steady, and sources are spread evenly inside. If the surface temperature T is a harmonic of degree l,
 * the flux k l T/r is conducted inwards. Emission is linear in T about the mean T0 of the surface. Let w = N J/A be the
 * flux that is absorbed, E the emission, d the diameter and K = k/(4 d sigma T0^3). Then w = 2 K l E in degree l. With
 * J = E + (1 - eps) w/eps,
 *
 *     w = g J,   1/g = 1/eps_l - 1,   1/eps_l = 1/eps + 1/(2 K l).
 *
 * If light of the flux a is absorbed besides, w + a is conducted, and w = g (J - a/(2 K l)).
 *
 * The mean over a surface has the emissivity eps itself. 1/(2 K) is called unevenness here. It is 0 for a sphere at one
 * temperature. */
#include "base/constants.h"
#include "base/elementary.h"
#include "base/vector.h"
#include "heat/fine.h"
#include "sample/sphere_patch.h"
#include "scene/grid_walk.h"
#include "scene/walls.h"

#define NUMBERS (FIBRAD_HARMONICS_WITHIN + 1)

/* Below EVEN, the unevenness of a sphere changes no result. Below LEAST, it changes no flux that is absorbed: then
 * LEAST takes its place, since black spheres have gains in proportion to its inverse. */
#define EVEN  1e-9
#define LEAST 1e-6

/* Harmonics of the present level. */
static const fibrad_harmonics *harmonics_of(const fibrad_heat *heat) {
    return &heat->harmonics[heat->solution.group > 1];
}

/* The degree of number k of a filter. */
static double degree_of(const fibrad_heat *heat, uint32_t k) {
    return k < FIBRAD_HARMONICS_DEGREES ? k : fibrad_harmonics_within(harmonics_of(heat));
}

/* Filters values on the patches of sphere b. */
static double filter_sphere(const fibrad_heat *heat, uint32_t b, const double by[NUMBERS], const double *pattern,
                            double *to) {
    const uint32_t first = heat->first[b], fine = heat->division.first_four[b];
    const fibrad_harmonics_patches on = {heat->solution.area + first, heat->config.patches, heat->first[b + 1] - first,
                                         heat->division.on_patch + fine};
    return fibrad_harmonics_filter(harmonics_of(heat), &on, by, pattern + first, to != NULL ? to + first : NULL);
}

/* g by degree. It is 0 for the mean, which solve.c treats. */
static void find_gains(const fibrad_heat *heat, uint32_t b, double by[NUMBERS]) {
    const double eps = heat->sources.emissivity[b];
    by[0] = 0;
    for (uint32_t k = 1; k < NUMBERS; k++) {
        const double uneven = fibrad_max(heat->sources.unevenness[b], LEAST) / degree_of(heat, k);
        by[k] = eps / (1 - eps + eps * uneven);
    }
}

/* 1/(1 + g) by degree. For the mean it is 0 as well. */
static void find_dampings(const fibrad_heat *heat, uint32_t b, double by[NUMBERS]) {
    find_gains(heat, b, by);
    for (uint32_t k = 1; k < NUMBERS; k++) by[k] = 1 / (1 + by[k]);
}

double fibrad_heat_sent_back(const fibrad_heat *heat, uint32_t body) {
    const double eps = heat->sources.emissivity[body];
    const double uneven = fibrad_heat_conducts(heat, body) ? heat->sources.unevenness[body] / (2 * heat->side) : 0;
    return 1 - eps / (1 + eps * uneven);
}

/* The unevenness of a sphere at its present emission. */
static double unevenness_of(const fibrad_heat *heat, uint32_t b) {
    const double t = fibrad_heat_temperature(heat, heat->sources.emission[b]);
    const double slope = t > 0 && heat->sources.emissivity[b] > 0 ? 4 * heat->sources.sigma * t * t * t : 0;
    const double uneven = heat->scene->r[b] * slope / heat->sources.conductivity[b];
    return uneven > EVEN ? uneven : 0;
}

double fibrad_heat_find_unevenness(fibrad_heat *heat, double least) {
    double change = 0;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        const double last = heat->sources.unevenness[b];
        change = fibrad_max(change, fibrad_abs(unevenness_of(heat, b) - last) / fibrad_max(last, EVEN));
    }
    if (!(change > least)) return change;
    heat->sources.conducts = false;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        heat->sources.unevenness[b] = unevenness_of(heat, b);
        heat->sources.conducts = heat->sources.conducts || heat->sources.conductivity[b] < __builtin_inf();
    }
    return change;
}

/* Replaces values on patches of a sphere by the means of groups that share one J. */
static void average_groups(const fibrad_heat *heat, uint32_t b, double *value) {
    const uint32_t end = heat->first[b + 1], group = heat->solution.group;
    for (uint32_t a = heat->first[b]; a < end && group > 1; a += group) {
        double sum = 0, area = 0;
        for (uint32_t k = a; k < a + group; k++)
            sum += heat->solution.area[k] * value[k], area += heat->solution.area[k];
        for (uint32_t k = a; k < a + group; k++) value[k] = area > 0 ? sum / area : 0;
    }
}

/* The flux that each patch of a sphere absorbs. */
static void find_fluxes(const fibrad_heat *heat, uint32_t b, double *flux) {
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
        flux[a] = heat->solution.area[a] > 0 ? heat->solution.net[a] / heat->solution.area[a] : 0;
}

/* Subtracts from values on a sphere their mean, which would leave rounding errors in products. */
static void take_mean_off(const fibrad_heat *heat, uint32_t b, double *value) {
    const double mean = fibrad_heat_mean(heat, b, value);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) value[a] -= mean;
}

double fibrad_heat_pattern_residual(fibrad_heat *heat, uint32_t b, double shift) {
    double by[NUMBERS], *change = heat->solution.source, *residual = heat->solution.gathered, slope = 0;
    find_fluxes(heat, b, residual);
    find_gains(heat, b, by);
    filter_sphere(heat, b, by, heat->solution.radiosity, change);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) residual[a] -= change[a];
    take_mean_off(heat, b, residual);
    average_groups(heat, b, residual);
    find_dampings(heat, b, by);
    filter_sphere(heat, b, by, residual, change);
    average_groups(heat, b, change);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) {
        slope += heat->solution.area[a] * residual[a] * change[a];
        change[a] += shift;
    }
    return slope;
}

double fibrad_heat_pattern_curvature(const fibrad_heat *heat, uint32_t b) {
    double by[NUMBERS];
    find_gains(heat, b, by);
    return filter_sphere(heat, b, by, heat->solution.direction, NULL);
}

/* The ratio of the pattern of emission to the pattern of J, by degree: g/(2 K l). */
static void find_emitted(const fibrad_heat *heat, uint32_t b, double by[NUMBERS]) {
    find_gains(heat, b, by);
    for (uint32_t k = 1; k < NUMBERS; k++) by[k] *= heat->sources.unevenness[b] / degree_of(heat, k);
}

/* The power that enters a sphere at a patch: absorbed light, and heat of contacts. */
static double entering(const fibrad_heat *heat, uint32_t a) {
    return (heat->sources.absorbed != NULL ? heat->sources.absorbed[a] : 0) +
           (heat->spots.entering != NULL ? heat->spots.entering[a] : 0);
}

/* Filters the power per area that enters patches of a sphere. Overwrites heat->solution.gathered. */
static double filter_absorbed(fibrad_heat *heat, uint32_t b, const double by[NUMBERS], double *to) {
    double *flux = heat->solution.gathered;
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
        flux[a] = heat->solution.area[a] > 0 ? entering(heat, a) / heat->solution.area[a] : 0;
    take_mean_off(heat, b, flux);
    return filter_sphere(heat, b, by, flux, to);
}

/* As find_emitted. Light is taken to be even within the patches of the cube: it has few points on a fine patch. */
static void find_heated(const fibrad_heat *heat, uint32_t b, double by[NUMBERS]) {
    find_emitted(heat, b, by);
    by[FIBRAD_HARMONICS_WITHIN] = 0;
}

/* Adds `share` of what stands for the pattern of absorbed light to the net flows of a sphere. */
static void stand_for_absorbed(fibrad_heat *heat, uint32_t b, double share) {
    double by[NUMBERS], *more = heat->solution.source;
    find_heated(heat, b, by);
    filter_absorbed(heat, b, by, more);
    take_mean_off(heat, b, more);
    average_groups(heat, b, more);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
        heat->solution.net[a] += share * heat->solution.area[a] * more[a];
}

void fibrad_heat_take_absorbed_off(fibrad_heat *heat, uint32_t b) { stand_for_absorbed(heat, b, -1); }

double fibrad_heat_add_absorbed(fibrad_heat *heat, uint32_t b) {
    double by[NUMBERS], damping[NUMBERS];
    stand_for_absorbed(heat, b, 1);
    find_heated(heat, b, by);
    find_dampings(heat, b, damping);
    for (uint32_t k = 0; k < NUMBERS; k++) by[k] *= by[k] * damping[k];
    return filter_absorbed(heat, b, by, NULL);
}

/* Adds to the emissions of a sphere what light adds to them. */
static void add_heated(fibrad_heat *heat, uint32_t b, double *emission) {
    double by[NUMBERS], *more = heat->solution.source;
    find_heated(heat, b, by);
    for (uint32_t k = 1; k < FIBRAD_HARMONICS_WITHIN; k++)
        by[k] = (1 - by[k]) * heat->sources.unevenness[b] / degree_of(heat, k);
    filter_absorbed(heat, b, by, more);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) emission[a] += more[a];
}

void fibrad_heat_find_spans(fibrad_heat *heat) {
    double *emission = heat->solution.direction;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        fibrad_heat_span *span = &heat->solution.span[b];
        double by[NUMBERS], low = 0, high = 0;
        if (fibrad_heat_conducts(heat, b)) {
            find_emitted(heat, b, by);
            filter_sphere(heat, b, by, heat->solution.radiosity, emission);
            if (fibrad_heat_is_entered(heat)) add_heated(heat, b, emission);
            average_groups(heat, b, emission);
            for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++)
                low = fibrad_min(low, emission[a]), high = fibrad_max(high, emission[a]);
        }
        span->low = low, span->high = high;
    }
}

/* The hottest and the coldest place of a sphere. Near a neighbour temperatures differ over lengths much shorter than a
 * patch. So places that face a neighbour are looked at in rings, together with the neighbour (rings/rings.h). Elsewhere
 * the rings are about the hottest or coldest patch, and all light is that of patches. */
#define NEAR          1.0  /* largest gap to a neighbour, in radii of the smaller sphere */
#define NEAR_COSINE   .985 /* patches with a larger cosine to a neighbour belong to the neighbour */
#define WIDE_COSINE   .94  /* the same on spheres more uneven than STEEP, and beside neighbours LARGER times as large */
#define STEEP         8.0
#define LARGER        3.0
#define AROUND        1.3  /* light from elsewhere is found within this many times the angle where the neighbour sets */
#define POINTS        4u   /* of an own patch, whose rings are looked up */
#define MIDDLE_COSINE .8   /* the middle of an open place is looked for among patches of a larger cosine to it */
#define TRIED         3u   /* hottest places that are looked at in rings, and coldest: patches tell them roughly */
#define SPOT_LARGEST  .4   /* largest radius of a spot for which a sphere adds to its resistance */
#define APART         1e-6 /* least gap that is used, over the sum of radii: spheres may overlap */

/* A place on a sphere. */
struct place {
    double axis[3];  /* its normal */
    double emission; /* of the patch there, minus the mean */
    uint32_t other;  /* the neighbour that it faces, or FIBRAD_NONE */
    double distance; /* L, of the neighbour's centre */
};

/* The places with the largest values of sign times emission, by descending value. */
struct ranking {
    double sign;
    uint32_t count;
    struct place place[TRIED];
};

static void rank_place(struct ranking *best, const struct place *place) {
    uint32_t k = best->count < TRIED ? best->count++ : TRIED;
    for (; k > 0 && best->sign * place->emission > best->sign * best->place[k - 1].emission; k--)
        if (k < TRIED) best->place[k] = best->place[k - 1];
    if (k < TRIED) best->place[k] = *place;
}

/* The normal at shares u, v of the edges of a patch of sphere b, which has the number `patch` on the sphere. */
static void normal_on_patch(const fibrad_heat *heat, uint32_t b, uint32_t patch, double u, double v, double normal[3]) {
    const uint32_t cube = heat->config.patches;
    const fibrad_heat_four own = {.body = b, .own = patch / FIBRAD_HEAT_FOUR};
    const fibrad_heat_four *fine =
        heat->division.four + heat->division.first_four[b] + (patch - cube) / FIBRAD_HEAT_FOUR;
    double at[3];
    fibrad_heat_fine_point(heat, patch < cube ? &own : fine, .5 * ((patch >> 1 & 1) + u), .5 * ((patch & 1) + v), at,
                           normal);
}

/* Finds the places of a sphere that face neighbours, and which own patches are near them. Returns how many. */
static uint32_t search_neighbours(const fibrad_heat *heat, uint32_t b, struct ranking best[2], bool *near) {
    uint32_t found = 0;
    const fibrad_scene *scene = heat->scene;
    const double r = scene->r[b], centre[3] = {scene->x[b], scene->y[b], scene->z[b]};
    for (uint32_t l = 0; l < scene->levels; l++) {
        const double most = scene->level[l].radius_max, reach = r + most + NEAR * fibrad_min(r, most);
        double low[3], high[3];
        for (int axis = 0; axis < 3; axis++) low[axis] = centre[axis] - reach, high[axis] = centre[axis] + reach;
        fibrad_walk walk;
        fibrad_walk_begin(&walk, scene, &scene->level[l], low, high);
        while (fibrad_walk_next(&walk))
            for (uint32_t j = walk.begin; j < walk.end; j++) {
                const double both = r + scene->r[j];
                struct place place = {.other = j};
                place.axis[0] = scene->x[j] + walk.shift[0] - centre[0];
                place.axis[1] = scene->y[j] + walk.shift[1] - centre[1];
                place.axis[2] = scene->z[j] + walk.shift[2] - centre[2];
                place.distance = fibrad_sqrt(fibrad_dot(place.axis, place.axis));
                if (!(place.distance > 0) || place.distance > both + NEAR * fibrad_min(r, scene->r[j])) continue;
                for (int axis = 0; axis < 3; axis++) place.axis[axis] /= place.distance;
                place.distance = fibrad_max(place.distance, both * (1 + APART));
                place.emission = heat->solution.direction[fibrad_heat_patch_at(heat, b, place.axis)];
                rank_place(&best[0], &place), rank_place(&best[1], &place);
                found++;
                const bool wide = heat->sources.unevenness[b] > STEEP || scene->r[j] > LARGER * r;
                for (uint32_t k = 0; k < POINTS * heat->config.patches; k++)
                    near[k / POINTS] |=
                        fibrad_dot(heat->normal + 3 * k, place.axis) > (wide ? WIDE_COSINE : NEAR_COSINE);
            }
    }
    return found;
}

/* What patches of a sphere have in rings about an axis: areas, and areas times irradiation, J and absorbed light. */
struct ring_sums {
    double area[FIBRAD_RINGS], arriving[FIBRAD_RINGS], sent[FIBRAD_RINGS], absorbed[FIBRAD_RINGS];
};

static void sum_rings(const fibrad_heat *heat, uint32_t b, const double axis[3], double sign, struct ring_sums *sums) {
    const uint32_t first = heat->first[b], cube = heat->config.patches;
    fibrad_zero(sums, sizeof *sums);
    for (uint32_t a = first; a < heat->first[b + 1]; a++) {
        const uint32_t points = a < first + cube ? POINTS : 1;
        const double area = heat->solution.area[a] / points, sent = heat->solution.radiosity[a];
        for (uint32_t k = 0; k < points && area > 0; k++) {
            double fine[3];
            if (points == 1) normal_on_patch(heat, b, a - first, .5, .5, fine);
            const double *normal = points == 1 ? fine : heat->normal + 3 * (POINTS * (a - first) + k);
            const uint32_t ring = fibrad_rings_at(heat->rings, sign * fibrad_dot(normal, axis));
            sums->area[ring] += area, sums->sent[ring] += area * sent;
            sums->arriving[ring] += area * sent + heat->solution.net[a] / points;
            sums->absorbed[ring] += entering(heat, a) / points;
        }
    }
}

/* Turns sums into means. Rings without patches, which are near the axis, have what the next ring has. */
static void average_rings(struct ring_sums *sums) {
    for (uint32_t k = FIBRAD_RINGS; k-- > 0;) {
        const double area = sums->area[k];
        double *const of[3] = {sums->arriving, sums->sent, sums->absorbed};
        for (int m = 0; m < 3; m++) of[m][k] = area > 0 ? of[m][k] / area : k + 1 < FIBRAD_RINGS ? of[m][k + 1] : 0;
    }
}

static void put_in_rings(const fibrad_heat *heat, uint32_t b, const struct ring_sums *mean, fibrad_ringed *sphere) {
    sphere->radius = heat->scene->r[b], sphere->emissivity = heat->sources.emissivity[b];
    sphere->unevenness = heat->sources.unevenness[b], sphere->emission = heat->sources.emission[b];
    fibrad_copy(sphere->arriving, mean->arriving, sizeof sphere->arriving);
    fibrad_copy(sphere->absorbed, mean->absorbed, sizeof sphere->absorbed);
}

/* Takes from the light that arrives at sphere i what comes from the other one. What is elsewhere is taken to be equally
 * bright in all directions. The light that arrives around the place where the neighbour is tells how bright. */
static void take_other_off(const fibrad_heat *heat, const fibrad_rings_work *work, uint32_t i, fibrad_ringed *sphere,
                           double sets, const double area[FIBRAD_RINGS], const double sent[FIBRAD_RINGS]) {
    const double *facing = work->facing[i];
    double light = 0, open = 0;
    for (uint32_t k = 0; k < FIBRAD_RINGS; k++) {
        double brought = 0;
        if (heat->rings->cosine[k] < 1 - AROUND * AROUND * (1 - sets)) continue;
        for (uint32_t m = 0; m < FIBRAD_RINGS; m++) brought += work->factor[i][k][m] * sent[m];
        light += area[k] * (1 - facing[k]) * (sphere->arriving[k] - brought);
        open += area[k] * (1 - facing[k]) * (1 - facing[k]);
    }
    for (uint32_t k = 0; k < FIBRAD_RINGS; k++)
        if (facing[k] > 0) sphere->arriving[k] = open > 0 ? (1 - facing[k]) * (light / open) : 0;
}

/* The emission at a place minus the mean of the sphere. */
static double emission_in_rings(const fibrad_heat *heat, uint32_t b, const struct place *place,
                                fibrad_rings_work *work) {
    struct ring_sums mean[2];
    fibrad_ringed sphere[2];
    const uint32_t count = place->other == FIBRAD_NONE ? 1 : 2;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t body = i == 0 ? b : place->other;
        sum_rings(heat, body, place->axis, i == 0 ? 1 : -1, &mean[i]);
        average_rings(&mean[i]);
        put_in_rings(heat, body, &mean[i], &sphere[i]);
    }
    if (count > 1) {
        const double radius[2] = {sphere[0].radius, sphere[1].radius};
        const double sets = (radius[0] - radius[1]) / place->distance; /* cosine of the angle where the other sets */
        fibrad_rings_face(heat->rings, radius, place->distance, work);
        take_other_off(heat, work, 0, &sphere[0], sets, mean[0].area, mean[1].sent);
        take_other_off(heat, work, 1, &sphere[1], -sets, mean[1].area, mean[0].sent);
    }
    return fibrad_rings_top(heat->rings, sphere, count, work);
}

/* Moves a place to the middle of the patches around it, weighted by how much hotter, or colder, they are than the
 * coldest, or hottest, of them. A hottest place is seldom in the middle of a patch. */
static void move_to_middle(const fibrad_heat *heat, uint32_t b, double sign, struct place *place) {
    const double *emission = heat->solution.direction + heat->first[b];
    double least = __builtin_inf(), sum[3] = {0, 0, 0};
    for (int pass = 0; pass < 2; pass++)
        for (uint32_t k = 0; k < POINTS * heat->config.patches; k++) {
            const double *normal = heat->normal + 3 * k, value = sign * emission[k / POINTS];
            if (fibrad_dot(normal, place->axis) < MIDDLE_COSINE) continue;
            if (pass == 0) least = fibrad_min(least, value);
            for (int axis = 0; axis < 3 && pass == 1; axis++) sum[axis] += (value - least) * normal[axis];
        }
    const double length = fibrad_sqrt(fibrad_dot(sum, sum));
    for (int axis = 0; axis < 3 && length > 0; axis++) place->axis[axis] = sum[axis] / length;
}

/* The largest of 0 and sign times the emissions at places. */
static double largest_at(const fibrad_heat *heat, uint32_t b, const struct ranking *best, const bool *near,
                         fibrad_rings_work *work) {
    double most = 0;
    for (uint32_t k = 0; k < best->count; k++)
        most = fibrad_max(most, best->sign * emission_in_rings(heat, b, &best->place[k], work));
    if (best->count == 0 || best->place[0].other != FIBRAD_NONE) return most;
    struct place middle = best->place[0];
    move_to_middle(heat, b, best->sign, &middle);
    if (near[fibrad_patch_of(middle.axis, heat->side)]) return most;
    return fibrad_max(most, best->sign * emission_in_rings(heat, b, &middle, work));
}

static void find_extremes(const fibrad_heat *heat, uint32_t b, fibrad_rings_work *work) {
    bool near[FIBRAD_HEAT_PATCHES_MAX] = {0};
    struct ranking facing[2] = {{.sign = -1}, {.sign = 1}}, open[2] = {{.sign = -1}, {.sign = 1}};
    fibrad_heat_span *span = &heat->solution.span[b];
    span->least = span->largest = 0, span->open_low = span->open_high = false;
    if (!fibrad_heat_conducts(heat, b)) return;
    span->neighbours = search_neighbours(heat, b, facing, near);
    for (uint32_t own = 0; own < heat->config.patches; own++) {
        const uint32_t a = heat->first[b] + own;
        struct place place = {.other = FIBRAD_NONE, .emission = heat->solution.direction[a]};
        normal_on_patch(heat, b, own, .5, .5, place.axis);
        if (near[own] || !(heat->solution.area[a] > 0)) continue;
        rank_place(&open[0], &place), rank_place(&open[1], &place);
    }
    const double low[2] = {largest_at(heat, b, &facing[0], near, work), largest_at(heat, b, &open[0], near, work)},
                 high[2] = {largest_at(heat, b, &facing[1], near, work), largest_at(heat, b, &open[1], near, work)};
    span->open_low = low[1] > low[0], span->open_high = high[1] > high[0];
    span->least = -fibrad_max(low[0], low[1]), span->largest = fibrad_max(high[0], high[1]);
}

void fibrad_heat_find_extremes(const fibrad_heat *heat, uint32_t begin, uint32_t end, fibrad_rings_work *work) {
    for (uint32_t k = begin; k < end; k++) find_extremes(heat, heat->sequence[k], work);
}

void fibrad_heat_make_rings(fibrad_heat *heat) {
    if (heat->ringed) return;
    heat->ringed = true;
    fibrad_rings_make(heat->rings);
    for (uint32_t k = 0; k < POINTS * heat->config.patches; k++)
        normal_on_patch(heat, 0, k / POINTS, .25 + .5 * (k / 2 % 2), .25 + .5 * (k % 2), heat->normal + 3 * k);
}

/* Contacts at their places. An end of a contact on a sphere that conducts is a spot of one temperature. Its radius
 * follows from the conductance, which is that between half-spaces. The spot is warmer than the mean of its sphere by
 *
 *     apart + resistance times the power that enters,
 *
 * apart being due to light and to other contacts. */
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
 * out evenly. docs/methods_heat.md section 16. */
static double resistance_of_spot(double conductivity, double size, double radius) {
    const double x = fibrad_min(size, SPOT_LARGEST);
    return (1 - x / FIBRAD_PI * (.5 + fibrad_log(2 * x) + .85 * x)) / (4 * conductivity * size * radius);
}

/* The end of contact k on `body`. entering: what enters there so far. */
static struct spot find_spot(const fibrad_heat *heat, uint32_t body, uint32_t other, double radius,
                             double entering_so_far, fibrad_rings_work *work) {
    double axis[3], response[FIBRAD_RINGS], apart = 0;
    struct spot spot = {0, 0};
    struct ring_sums mean;
    if (!direction_of_spot(heat, body, other, axis)) return spot;
    const double r = heat->scene->r[body], eps = heat->sources.emissivity[body], k = heat->sources.conductivity[body],
                 uneven = heat->sources.unevenness[body], slope = uneven * k / r;
    enter_at(heat, body, axis, -entering_so_far);
    sum_rings(heat, body, axis, 1, &mean);
    enter_at(heat, body, axis, entering_so_far);
    average_rings(&mean);
    const double less =
        fibrad_rings_spot(heat->rings, fibrad_min(radius / r, SPOT_LARGEST), eps, uneven, work, response);
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
        if (fibrad_heat_conducts(heat, b)) stand_for_absorbed(heat, b, -1);
    }
    for (uint32_t k = 0; k < c->count; k++) {
        s->next[k] = 0;
        change = fibrad_max(change, find_flow(heat, k, &heat->near[0]));
        largest = fibrad_max(largest, fibrad_abs(s->next[k]));
    }
    for (uint32_t b = 0; b < heat->spheres; b++)
        if (fibrad_heat_conducts(heat, b)) stand_for_absorbed(heat, b, 1);
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
