/* shine.c - light from outside on the patches of a heat problem. SPDX-License-Identifier: MIT
 *
 * The light that a sphere takes is known exactly. The lit points of its window tell on which of its patches the light
 * falls. A wall takes the light that the spheres leave to it. Rays tell on which of its patches this light falls. */
#include "base/random.h"
#include "heat/problem.h"
#include "heat/wall_patch.h"
#include "light/light.h"
#include "ray/tracer.h"
#include "sample/sphere_patch.h"

#define SHINE_SPHERES 64u     /* of a task */
#define SHINE_RAYS    131072u /* of a light */

uint32_t fibrad_heat_patches(const fibrad_heat *heat) { return heat != NULL ? heat->patches : 0; }

uint32_t fibrad_heat_shine_tasks(const fibrad_heat *heat) {
    return heat != NULL ? (heat->spheres + SHINE_SPHERES - 1) / SHINE_SPHERES : 0;
}

/* A sphere in the light: its place and window, and what of the light it takes. */
typedef struct shining {
    const fibrad_heat *heat;
    const fibrad_footprint *f;
    uint32_t place;
    double uv[2], r;
    bool whole; /* all that is open is lit */
} shining;

/* The patch of a sphere at a place in its window. */
static uint32_t patch_in_window(const shining *s, double x, double y) {
    const double up = fibrad_sqrt(fibrad_max(0, 1 - (x * x + y * y)));
    double normal[3], at[2];
    for (int a = 0; a < 3; a++) normal[a] = x * s->f->frame[a] + y * s->f->frame[3 + a] + up * s->f->frame[6 + a];
    const uint32_t face = fibrad_patch_place(normal, s->heat->side, at);
    const uint32_t patch = fibrad_patch_number(face, (uint32_t)at[0], (uint32_t)at[1], s->heat->side);
    const uint32_t fine = s->heat->division.root[s->place] != FIBRAD_NONE
                              ? fibrad_heat_fine_on_face(s->heat, s->place, patch, at[0], at[1])
                              : FIBRAD_NONE;
    if (fine == FIBRAD_NONE) return s->heat->first[s->place] + patch;
    return fibrad_heat_first_fine(s->heat, s->place) +
           (fine - FIBRAD_HEAT_FOUR * s->heat->division.first_four[s->place]);
}

static bool is_lit(const shining *s, const fibrad_points *points, uint32_t p) {
    const double at[2] = {s->uv[0] + s->r * points->set.x[p], s->uv[1] + s->r * points->set.y[p]};
    return (points->seen[p / 64] >> p % 64 & 1) != 0 && (s->whole || fibrad_footprint_lights(s->f, at, NULL));
}

/* The middle of the corners of an open region, for regions so small that they hold no point. */
static void middle_of_corners(const fibrad_areas *areas, double middle[2]) {
    fibrad_open_arc arc;
    double corners = 0, sum[2] = {0, 0};
    for (uint32_t at = 0; fibrad_areas_next(areas, &at, &arc); corners++)
        for (int a = 0; a < 2; a++) sum[a] += arc.c[a] + arc.p[a];
    for (int a = 0; a < 2; a++) middle[a] = corners > 0 ? sum[a] / corners : 0;
}

/* Spreads a power over the patches that the lit points of a window are on. */
static void spread_on_sphere(const shining *s, const fibrad_points *points, const fibrad_areas *areas, double power,
                             double *hits) {
    uint32_t count = 0;
    for (uint32_t p = 0; p < points->count; p++) count += is_lit(s, points, p);
    for (uint32_t p = 0; p < points->count && count > 0; p++)
        if (is_lit(s, points, p)) hits[patch_in_window(s, points->set.x[p], points->set.y[p])] += power / count;
    if (count > 0) return;
    double middle[2];
    middle_of_corners(areas, middle);
    hits[patch_in_window(s, middle[0], middle[1])] += power;
}

/* Adds what the sphere at a place takes in one direction. */
static int shine_on_sphere(const fibrad_heat *heat, fibrad_workspace *space, uint32_t place, double flux, double *hits,
                           fibrad_light_ends *kept) {
    const fibrad_scene *scene = heat->scene;
    fibrad_footprint *f = fibrad_light_footprint(space);
    fibrad_points points = {.count = 0};
    const double centre[3] = {scene->x[place], scene->y[place], scene->z[place]};
    double area[FIBRAD_SLOTS] = {0}, open = 0, sum = 0;
    shining s = {.heat = heat, .f = f, .place = place, .r = scene->r[place]};
    const int status =
        FIBRAD_VERSION_OF(fibrad_sunlit, scene->facts.isa)(scene, space, place, f->frame, &points, &open);
    if (status != FIBRAD_OK || !(open > 0)) return status;
    fibrad_footprint_place(f, centre, s.uv);
    fibrad_footprint_share(f, &space->areas, open, s.uv, s.r, area);
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++) sum += area[slot];
    if (!(sum > 0)) return FIBRAD_OK;
    s.whole = sum >= open * s.r * s.r;
    spread_on_sphere(&s, &points, &space->areas, flux * sum, hits);
    fibrad_light_add_ends(scene, area, flux, kept);
    kept->spheres += flux * sum;
    return FIBRAD_OK;
}

/* The same with work memory that grows. When it grows, the footprint is lost. */
static int shine_and_grow(const fibrad_heat *heat, fibrad_work *work, fibrad_workspace **space,
                          const fibrad_light *light, uint32_t k, uint32_t place, double *hits,
                          fibrad_light_ends *kept) {
    const double flux = light->flux / fibrad_light_count(light);
    int status = shine_on_sphere(heat, *space, place, flux, hits, kept);
    while (status == FIBRAD_E_WORK) {
        status = fibrad_work_grow(work, space);
        if (status != FIBRAD_OK) return status;
        fibrad_footprint_make(fibrad_light_footprint(*space), heat->scene, light, k);
        status = shine_on_sphere(heat, *space, place, flux, hits, kept);
    }
    return status;
}

int fibrad_heat_shine(const fibrad_heat *heat, fibrad_work *work, const fibrad_light *light, uint32_t task,
                      double *hits, fibrad_light_ends *kept) {
    fibrad_workspace *space;
    if (heat == NULL || work == NULL || hits == NULL || kept == NULL || task >= fibrad_heat_shine_tasks(heat))
        return FIBRAD_E_ARGUMENT;
    if (!fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    int status = fibrad_light_check(heat->scene, light, NULL);
    if (status == FIBRAD_OK) status = fibrad_light_open(heat->scene, work, 0, &space);
    if (status != FIBRAD_OK) return status;
    const uint32_t begin = task * SHINE_SPHERES;
    const uint32_t end = heat->spheres - begin < SHINE_SPHERES ? heat->spheres : begin + SHINE_SPHERES;
    *kept = (fibrad_light_ends){0};
    for (uint32_t k = 0; k < fibrad_light_count(light) && status == FIBRAD_OK; k++) {
        fibrad_footprint_make(fibrad_light_footprint(space), heat->scene, light, k);
        for (uint32_t place = begin; place < end && status == FIBRAD_OK; place++)
            status = shine_and_grow(heat, work, &space, light, k, place, hits, kept);
    }
    return status;
}

/* Counts the rays of one direction that meet no sphere, by the patch on which they end. */
static int count_rays(const fibrad_heat *heat, const fibrad_footprint *f, uint32_t k, uint32_t rays, double *tally) {
    const double d[3] = {0 - f->frame[6], 0 - f->frame[7], 0 - f->frame[8]};
    for (uint32_t n = 0; n < rays; n++) {
        double x[4], uv[2], at[3];
        uint32_t piece;
        fibrad_hit hit = {0};
        fibrad_heat_ray_coordinates(k, n, x);
        for (int a = 0; a < 2; a++) uv[a] = f->bound_low[a] + x[a] * (f->bound_high[a] - f->bound_low[a]);
        if (!fibrad_footprint_lights(f, uv, &piece)) continue;
        fibrad_footprint_enters(f, piece, uv, at);
        FIBRAD_VERSION_OF(fibrad_trace_point, heat->scene->facts.isa)(heat->scene, at, d, FIBRAD_NO_SIDE, &hit);
        if (hit.sphere != FIBRAD_NONE) continue;
        const uint32_t patch = fibrad_heat_ends(heat, at, d, hit.side, hit.distance);
        if (patch == FIBRAD_NONE) return FIBRAD_E_BACK;
        tally[patch - fibrad_heat_others(heat)]++;
    }
    return FIBRAD_OK;
}

/* Spreads a power over the patches of bodies [from, to] as rays have met them; evenly if none has. */
static void spread_on_wall(const fibrad_heat *heat, uint32_t own, uint32_t beyond, double power, const double *tally,
                           double *hits) {
    const uint32_t body[2] = {own, beyond}, others = fibrad_heat_others(heat);
    double sum = 0;
    for (int n = 0; n < 2; n++)
        for (uint32_t a = heat->first[body[n]]; a < heat->first[body[n] + 1]; a++) sum += tally[a - others];
    for (int n = 0; n < 2 && sum > 0; n++)
        for (uint32_t a = heat->first[body[n]]; a < heat->first[body[n] + 1]; a++)
            hits[a] += power * (tally[a - others] / sum);
    const uint32_t begin = heat->first[own], end = heat->first[own + 1];
    for (uint32_t a = begin; a < end && !(sum > 0); a++) hits[a] += power / (end - begin);
}

int fibrad_heat_shine_walls(const fibrad_heat *heat, fibrad_work *work, const fibrad_light *light,
                            const fibrad_light_ends *ends, double *hits) {
    fibrad_workspace *space;
    if (heat == NULL || work == NULL || ends == NULL || hits == NULL) return FIBRAD_E_ARGUMENT;
    if (!fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    int status = fibrad_light_check(heat->scene, light, NULL);
    const uint32_t of_walls = heat->patches - fibrad_heat_others(heat), count = fibrad_light_count(light);
    if (status == FIBRAD_OK) status = fibrad_light_open(heat->scene, work, of_walls * sizeof(double), &space);
    if (status != FIBRAD_OK || heat->given_bodies == 0) return status;
    double *tally = fibrad_light_scratch(space);
    fibrad_zero(tally, of_walls * sizeof *tally);
    for (uint32_t k = 0; k < count && status == FIBRAD_OK; k++) {
        fibrad_footprint *f = fibrad_light_footprint(space);
        fibrad_footprint_make(f, heat->scene, light, k);
        status = count_rays(heat, f, k, SHINE_RAYS / count, tally);
    }
    for (uint32_t b = 0; b < heat->given_bodies && status == FIBRAD_OK; b++) {
        const uint32_t slot = heat->slot[b], own = fibrad_heat_body(heat, slot);
        spread_on_wall(heat, own, slot < FIBRAD_WALLS ? fibrad_heat_beyond(heat, slot) : own,
                       fibrad_max(0, ends->body[b]), tally, hits);
    }
    return status;
}

static double sum_of_light(const fibrad_heat *heat, uint32_t body, const double *hits) {
    double sum = 0;
    for (uint32_t a = heat->first[body]; a < heat->first[body + 1]; a++) sum += hits[a];
    return sum;
}

int fibrad_heat_sum_light(const fibrad_heat *heat, const double *hits, double *power, double *body_power) {
    if (heat == NULL || hits == NULL || (heat->spheres > 0 && power == NULL)) return FIBRAD_E_ARGUMENT;
    if (heat->given_bodies > 0 && body_power == NULL) return FIBRAD_E_ARGUMENT;
    for (uint32_t b = 0; b < heat->spheres; b++) power[heat->order[b]] = sum_of_light(heat, b, hits);
    for (uint32_t b = 0; b < heat->given_bodies; b++) {
        const uint32_t slot = heat->slot[b];
        body_power[b] = sum_of_light(heat, fibrad_heat_body(heat, slot), hits);
        if (slot < FIBRAD_WALLS) body_power[b] += sum_of_light(heat, fibrad_heat_beyond(heat, slot), hits);
    }
    return FIBRAD_OK;
}

int fibrad_heat_keep_light(const fibrad_heat *heat, const unsigned char *insulated, double *hits) {
    if (heat == NULL || hits == NULL || (heat->given_bodies > 0 && insulated == NULL)) return FIBRAD_E_ARGUMENT;
    if (heat->solution.phase != FIBRAD_HEAT_DONE || !fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    fibrad_zero(hits, heat->patches * sizeof *hits);
    for (uint32_t b = 0; b < heat->given_bodies; b++) {
        const uint32_t own = fibrad_heat_body(heat, heat->slot[b]);
        double sum = 0;
        for (uint32_t a = heat->first[own]; a < heat->first[own + 1]; a++) sum += fibrad_max(0, heat->solution.net[a]);
        for (uint32_t a = heat->first[own]; a < heat->first[own + 1] && sum > 0 && insulated[b]; a++)
            hits[a] = fibrad_max(0, heat->solution.net[a]) / sum * fibrad_max(0, heat->solution.power[own]);
    }
    return FIBRAD_OK;
}
