/* shine.c - light from outside on the patches of a heat problem. SPDX-License-Identifier: MIT
 *
 * The light that a sphere takes is known exactly. The lit points of its window tell on which of its patches the light
 * falls. On a free sphere each patch gets exactly what falls on it. */
#include "base/vector.h"
#include "patches/subdivision.h"
#include "light/light.h"

#define SHINE_SPHERES 64u /* of a task */
#define SHINE_RULE    4u  /* points along an edge of a patch, for what falls on it */

uint32_t fibrad_heat_patches(const fibrad_heat *heat) { return heat != NULL ? heat->patches : 0; }

uint32_t fibrad_heat_shine_tasks(const fibrad_heat *heat) {
    return heat != NULL ? (heat->spheres + SHINE_SPHERES - 1) / SHINE_SPHERES : 0;
}

/* How the points of windows stand for patches of the cube, for light of one direction. The weight of a patch is what
 * falls on it if nothing is before the sphere, over the number of points there. A patch without a point is lit if the
 * point next to it is. */
typedef struct spread {
    double weight[FIBRAD_HEAT_PATCHES_MAX];
    uint32_t next[FIBRAD_HEAT_PATCHES_MAX]; /* FIBRAD_NONE: the patch has points, or is on the dark side */
} spread;

/* A sphere in the light: its place and window, and what of the light it takes. */
typedef struct shining {
    const fibrad_heat *heat;
    const fibrad_footprint *f;
    const spread *how;
    uint32_t place;
    double uv[2], r;
    bool whole; /* all that is open is lit */
} shining;

static spread *shares_of(const fibrad_workspace *space) { return (void *)fibrad_light_scratch(space); }

/* Light on the patches of a task before the task, behind its spread. */
static double *hits_before(const fibrad_workspace *space) { return (void *)(shares_of(space) + 1); }

/* The patch of the cube at a place in the window, and the place on the face of the cube. */
static uint32_t patch_in_window(const shining *s, double x, double y, double at[2]) {
    const double up = fibrad_sqrt(fibrad_max(0, 1 - (x * x + y * y)));
    double normal[3];
    for (int a = 0; a < 3; a++) normal[a] = x * s->f->frame[a] + y * s->f->frame[3 + a] + up * s->f->frame[6 + a];
    const uint32_t face = fibrad_patch_place(normal, s->heat->side, at);
    return fibrad_patch_number(face, (uint32_t)at[0], (uint32_t)at[1], s->heat->side);
}

/* Adds a power times the weight of a point to the patch there, which may be fine. Returns the weight. */
static double shine_on_point(const shining *s, double x, double y, double power, double *hits) {
    double at[2];
    const uint32_t patch = patch_in_window(s, x, y, at);
    if (hits == NULL) return s->how->weight[patch];
    hits[fibrad_heat_patch_on_face(s->heat, s->place, patch, at)] += power * s->how->weight[patch];
    return s->how->weight[patch];
}

double fibrad_light_falls_on(const fibrad_heat *heat, const double frame[9], const fibrad_heat_four *four,
                             uint32_t patch, double middle[2]) {
    double sum = 0, at[3], n[3];
    middle[0] = middle[1] = 0;
    for (uint32_t k = 0; k < SHINE_RULE * SHINE_RULE; k++) {
        const double u = (k / SHINE_RULE + .5) / SHINE_RULE, v = (k % SHINE_RULE + .5) / SHINE_RULE;
        const double area =
            fibrad_heat_fine_point(heat, four, .5 * ((patch >> 1 & 1) + u), .5 * ((patch & 1) + v), at, n);
        const double falls = area * fibrad_max(0, fibrad_dot(n, frame + 6));
        for (int axis = 0; axis < 2; axis++) middle[axis] += falls * fibrad_dot(n, frame + 3 * axis);
        sum += falls;
    }
    for (int axis = 0; axis < 2; axis++) middle[axis] /= SHINE_RULE * SHINE_RULE;
    return sum / (SHINE_RULE * SHINE_RULE);
}

/* The point of a window that is next to a place. */
static uint32_t next_point(const fibrad_disc_points *set, double x, double y) {
    uint32_t next = 0;
    double least = __builtin_inf();
    for (uint32_t p = 0; p < FIBRAD_SUNLIT_POINTS; p++) {
        const double dx = set->x[p] - x, dy = set->y[p] - y;
        if (dx * dx + dy * dy < least) least = dx * dx + dy * dy, next = p;
    }
    return next;
}

static void find_spread(const fibrad_heat *heat, const fibrad_footprint *f, spread *how) {
    const shining s = {.heat = heat, .f = f};
    fibrad_disc_points set;
    double at[2];
    fibrad_zero(how, sizeof *how);
    if (fibrad_disc_points_get(FIBRAD_SUNLIT_POINTS, &set) != FIBRAD_OK) return;
    for (uint32_t p = 0; p < FIBRAD_SUNLIT_POINTS; p++) how->weight[patch_in_window(&s, set.x[p], set.y[p], at)]++;
    for (uint32_t a = 0; a < heat->config.patches; a++) {
        const fibrad_heat_four four = {.own = a / FIBRAD_HEAT_FOUR};
        const double count = how->weight[a], falls = fibrad_light_falls_on(heat, f->frame, &four, a, at);
        how->weight[a] = count > 0 ? falls / count : falls;
        how->next[a] = count > 0 || !(falls > 0) ? FIBRAD_NONE : next_point(&set, at[0] / falls, at[1] / falls);
    }
}

static bool is_lit(const shining *s, const fibrad_points *points, uint32_t p) {
    const double at[2] = {s->uv[0] + s->r * points->set.x[p], s->uv[1] + s->r * points->set.y[p]};
    const double in_window[2] = {points->set.x[p], points->set.y[p]};
    return (points->seen[p / 64] >> p % 64 & 1) != 0 && fibrad_unshadowed_holds(&s->f->unshadowed, in_window) &&
           (s->whole || fibrad_footprint_lights(s->f, at, NULL));
}

/* The middle of the corners of an open region, for regions so small that they hold no point. */
static void middle_of_corners(const fibrad_areas *areas, double middle[2]) {
    fibrad_open_arc arc;
    double corners = 0, sum[2] = {0, 0};
    for (uint32_t at = 0; fibrad_areas_next(areas, &at, &arc); corners++)
        for (int a = 0; a < 2; a++) sum[a] += arc.c[a] + arc.p[a];
    for (int a = 0; a < 2; a++) middle[a] = corners > 0 ? sum[a] / corners : 0;
}

/* Spreads a power over the patches that the lit points of a window are on. Returns the sum of the weights. */
static double spread_on_patches(const shining *s, const fibrad_points *points, double power, double *hits) {
    double sum = 0;
    for (uint32_t p = 0; p < points->count; p++)
        if (is_lit(s, points, p)) sum += shine_on_point(s, points->set.x[p], points->set.y[p], power, hits);
    for (uint32_t a = 0; a < s->heat->config.patches; a++) {
        if (s->how->next[a] == FIBRAD_NONE || fibrad_heat_is_divided(s->heat, s->place, a / FIBRAD_HEAT_FOUR)) continue;
        if (!is_lit(s, points, s->how->next[a])) continue;
        sum += s->how->weight[a];
        if (hits != NULL) hits[s->heat->first[s->place] + a] += power * s->how->weight[a];
    }
    return sum;
}

static void spread_on_sphere(const shining *s, const fibrad_points *points, const fibrad_areas *areas, double power,
                             double *hits) {
    const double sum = spread_on_patches(s, points, 0, NULL);
    double middle[2], at[2];
    if (sum > 0) {
        spread_on_patches(s, points, power / sum, hits);
        return;
    }
    middle_of_corners(areas, middle);
    hits[s->heat->first[s->place] + patch_in_window(s, middle[0], middle[1], at)] += power;
}

/* Adds what the sphere at a place takes in one direction. *takes: out: that. */
static int shine_on_sphere(const fibrad_heat *heat, fibrad_workspace *space, uint32_t place, double *hits,
                           fibrad_light_ends *kept, double *takes) {
    const fibrad_scene *scene = heat->scene;
    fibrad_footprint *f = fibrad_light_footprint(space);
    fibrad_points points = {.count = 0};
    const double centre[3] = {scene->x[place], scene->y[place], scene->z[place]};
    double area[FIBRAD_SLOTS] = {0}, open = 0, sum = 0;
    shining s = {.heat = heat, .f = f, .how = shares_of(space), .place = place, .r = scene->r[place]};
    const int status = FIBRAD_VERSION_OF(fibrad_sunlit, scene->facts.isa)(scene, space, place, f->frame, &points, &open,
                                                                          &f->unshadowed);
    if (status != FIBRAD_OK || !(open > 0)) return status;
    fibrad_footprint_place(f, centre, s.uv);
    fibrad_footprint_share(f, &space->areas, open, s.uv, s.r, area);
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++) sum += area[slot];
    if (!(sum > 0)) return FIBRAD_OK;
    s.whole = sum >= open * s.r * s.r;
    spread_on_sphere(&s, &points, &space->areas, f->flux * sum, hits);
    fibrad_light_add_ends(scene, area, f->flux, kept);
    kept->spheres += f->flux * sum;
    *takes = f->flux * sum;
    return FIBRAD_OK;
}

/* All directions of a light on the spheres at places begin to end - 1. Errors: as of one sphere; FIBRAD_E_ARGUMENT: no
 * open face lets the light in. */
static int shine_on_spheres(const fibrad_heat *heat, fibrad_workspace *space, const fibrad_light *light, uint32_t begin,
                            uint32_t end, double *hits, fibrad_light_ends *kept, double *apart) {
    const uint32_t count = fibrad_light_count(light);
    fibrad_footprint *f = fibrad_light_footprint(space);
    double all = 0;
    int status = FIBRAD_OK;
    *kept = (fibrad_light_ends){0};
    for (uint32_t k = 0; k < count && status == FIBRAD_OK; k++) {
        fibrad_footprint_make(f, heat->scene, light, k);
        find_spread(heat, f, shares_of(space));
        all += fibrad_footprint_area(f);
        for (uint32_t place = begin; place < end && status == FIBRAD_OK; place++) {
            double takes = 0;
            status = shine_on_sphere(heat, space, place, hits, kept, &takes);
            if (count > 1) apart[place - begin] += k % 2 ? -takes : takes;
        }
    }
    return status != FIBRAD_OK || all > 0 ? status : FIBRAD_E_ARGUMENT;
}

int fibrad_heat_shine(const fibrad_heat *heat, fibrad_work *work, const fibrad_light *light, uint32_t task,
                      double *hits, fibrad_light_ends *kept, double *apart) {
    fibrad_workspace *space;
    fibrad_light_ends sum;
    double halves[SHINE_SPHERES];
    if (heat == NULL || work == NULL || hits == NULL || kept == NULL || task >= fibrad_heat_shine_tasks(heat))
        return FIBRAD_E_ARGUMENT;
    if (!fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    const uint32_t begin = task * SHINE_SPHERES;
    const uint32_t end = heat->spheres - begin < SHINE_SPHERES ? heat->spheres : begin + SHINE_SPHERES;
    double *const first = hits + heat->first[begin];
    const size_t bytes = (heat->first[end] - heat->first[begin]) * sizeof *hits, extra = sizeof(spread) + bytes;
    int status = fibrad_light_check(heat->scene, light, NULL);
    if (status == FIBRAD_OK) status = fibrad_light_open(heat->scene, work, extra, &space);
    while (status == FIBRAD_OK) {
        fibrad_copy(hits_before(space), first, bytes);
        fibrad_zero(halves, sizeof halves);
        status = shine_on_spheres(heat, space, light, begin, end, hits, &sum, halves);
        if (status == FIBRAD_OK) break;
        fibrad_copy(first, hits_before(space), bytes);
        if (status == FIBRAD_E_WORK) status = fibrad_light_grow(work, extra, &space);
    }
    if (status == FIBRAD_OK) *kept = sum;
    for (uint32_t place = begin; place < end && status == FIBRAD_OK && apart != NULL; place++)
        apart[heat->order[place]] = halves[place - begin];
    return status;
}

int fibrad_heat_sum_light(const fibrad_heat *heat, const double *hits, double *power, double *wall_power) {
    if (heat == NULL || hits == NULL || (heat->spheres > 0 && power == NULL)) return FIBRAD_E_ARGUMENT;
    if (heat->given_walls > 0 && wall_power == NULL) return FIBRAD_E_ARGUMENT;
    for (uint32_t b = 0; b < heat->spheres; b++) power[heat->order[b]] = fibrad_heat_sum(heat, b, hits);
    for (uint32_t b = 0; b < heat->given_walls; b++) {
        const uint32_t slot = heat->slot[b];
        wall_power[b] = fibrad_heat_sum(heat, fibrad_heat_body(heat, slot), hits);
        if (slot < FIBRAD_WALLS) wall_power[b] += fibrad_heat_sum(heat, fibrad_heat_beyond(heat, slot), hits);
    }
    return FIBRAD_OK;
}

/* Adds to `spots`, times the absorptivity of a body, what its patches absorb of other light. All of the latter together
 * is the power of the body. */
static void keep_on_body(const fibrad_heat *heat, uint32_t b, double *spots) {
    double sum = 0;
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) sum += fibrad_max(0, heat->solution.net[a]);
    for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) {
        spots[a] *= heat->sources.emissivity[b];
        if (sum > 0) spots[a] += fibrad_max(0, heat->solution.net[a]) / sum * fibrad_max(0, heat->solution.power[b]);
    }
}

int fibrad_heat_keep_light(const fibrad_heat *heat, double *spots) {
    if (heat == NULL || spots == NULL) return FIBRAD_E_ARGUMENT;
    if (heat->solution.phase != FIBRAD_HEAT_DONE || !fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    for (uint32_t b = 0; b < heat->spheres; b++) keep_on_body(heat, b, spots);
    for (uint32_t k = 0; k < heat->given_walls; k++) keep_on_body(heat, fibrad_heat_body(heat, heat->slot[k]), spots);
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++)
        for (uint32_t b = fibrad_heat_beyond(heat, k), a = heat->first[b]; a < heat->first[b + 1]; a++) spots[a] = 0;
    return FIBRAD_OK;
}
