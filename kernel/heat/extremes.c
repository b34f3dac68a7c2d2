/* extremes.c - the hottest and the coldest place of spheres that conduct. SPDX-License-Identifier: MIT
 *
 * Near a neighbour temperatures differ over lengths much shorter than a patch. So places that face a neighbour are
 * looked at in rings, together with the neighbour (rings/rings.h). Elsewhere the rings are about the hottest or coldest
 * patch, and all light is that of patches. */
#include "base/vector.h"
#include "heat/solution.h"
#include "patches/subdivision.h"
#include "scene/grid_walk.h"

/* Constants. They decide what is looked at. With them the errors of docs/accuracy.md were measured, from
 * 240 pairs of spheres and 400 spheres of poly2000. */
#define NEAR          1.0  /* largest gap to a neighbour, in radii of the smaller sphere */
#define NEAR_COSINE   .985 /* patches with a larger cosine to a neighbour belong to the neighbour */
#define WIDE_COSINE   .94  /* the same on spheres more uneven than STEEP, and beside neighbours LARGER times as large */
#define STEEP         8.0  /* 1/(2 k*) */
#define LARGER        3.0  /* ratio of radii */
#define AROUND        1.3  /* light from elsewhere is found within this many times the angle where the neighbour sets */
#define POINTS        4u   /* of an own patch, whose rings are looked up */
#define MIDDLE_COSINE .8   /* the middle of an open place is looked for among patches of a larger cosine to it */
#define TRIED         3u   /* hottest places that are looked at in rings, and coldest: patches tell them roughly */
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
        fibrad_walk walk;
        fibrad_walk_about(&walk, scene, &scene->level[l], centre, centre, reach);
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

/* How much the irradiation of a patch differs from that of its four, per area. 0: fine patches, which have no four. */
static double detail_of(const fibrad_heat *heat, uint32_t b, uint32_t a) {
    const uint32_t first = heat->first[b], begin = a - (a - first) % FIBRAD_HEAT_FOUR;
    double sum = 0, area = 0;
    if (a >= first + heat->config.patches) return 0;
    for (uint32_t k = begin; k < begin + FIBRAD_HEAT_FOUR; k++)
        sum += heat->solution.area[k] * heat->solution.radiosity[k] + heat->solution.net[k],
            area += heat->solution.area[k];
    return heat->solution.radiosity[a] + heat->solution.net[a] / heat->solution.area[a] - sum / area;
}

/* Sums of what patches of a sphere have in rings about an axis: areas, and areas times irradiation, J and light. The
 * irradiation is that of each patch plus `sharp` times its difference from its four. */
static void sum_rings(const fibrad_heat *heat, uint32_t b, const double axis[3], double sign, double sharp,
                      fibrad_heat_ringed *sums) {
    const uint32_t first = heat->first[b], cube = heat->config.patches;
    fibrad_zero(sums, sizeof *sums);
    for (uint32_t a = first; a < heat->first[b + 1]; a++) {
        const uint32_t points = a < first + cube ? POINTS : 1;
        const double area = heat->solution.area[a] / points, sent = heat->solution.radiosity[a];
        const double more = sharp > 0 && area > 0 ? sharp * detail_of(heat, b, a) : 0;
        for (uint32_t k = 0; k < points && area > 0; k++) {
            double fine[3];
            if (points == 1) normal_on_patch(heat, b, a - first, .5, .5, fine);
            const double *normal = points == 1 ? fine : heat->normal + 3 * (POINTS * (a - first) + k);
            const uint32_t ring = fibrad_rings_at(heat->rings, sign * fibrad_dot(normal, axis));
            sums->area[ring] += area, sums->sent[ring] += area * sent;
            sums->arriving[ring] += area * (sent + more) + heat->solution.net[a] / points;
            sums->absorbed[ring] += fibrad_heat_entering(heat, a) / points;
        }
    }
}

/* Turns sums into means. Rings without patches, which are near the axis, have what the next ring has. */
static void average_rings(fibrad_heat_ringed *sums) {
    for (uint32_t k = FIBRAD_RINGS; k-- > 0;) {
        const double area = sums->area[k];
        double *const of[3] = {sums->arriving, sums->sent, sums->absorbed};
        for (int m = 0; m < 3; m++) of[m][k] = area > 0 ? of[m][k] / area : k + 1 < FIBRAD_RINGS ? of[m][k + 1] : 0;
    }
}

void fibrad_heat_look_in_rings(const fibrad_heat *heat, uint32_t b, const double axis[3], double sign, double sharp,
                               fibrad_heat_ringed *mean) {
    sum_rings(heat, b, axis, sign, sharp, mean);
    average_rings(mean);
}

static void put_in_rings(const fibrad_heat *heat, uint32_t b, const fibrad_heat_ringed *mean, fibrad_ringed *sphere) {
    sphere->radius = heat->scene->r[b], sphere->emissivity = heat->sources.emissivity[b];
    sphere->biot = fibrad_heat_biot(heat, b);
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
    fibrad_heat_ringed mean[2];
    fibrad_ringed sphere[2];
    const uint32_t count = place->other == FIBRAD_NONE ? 1 : 2;
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t body = i == 0 ? b : place->other;
        fibrad_heat_look_in_rings(heat, body, place->axis, i == 0 ? 1 : -1, 0, &mean[i]);
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
