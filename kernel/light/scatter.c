/* scatter.c - rays of light: what walls take, and where reflected light arrives. SPDX-License-Identifier: MIT
 *
 * A ray comes from outside. It meets a sphere or wall, and goes on from there by the cosine law. So light that falls on
 * a part of a patch is reflected from where it falls. All light that a body reflects first is known. The rays that
 * leave the body share it out. Where few rays meet a body, patches that are lit wholly reflect without rays. Rays of
 * narrow light go on for some hits, as long as there are many of them on a body. */
#include "base/vector.h"
#include "patches/subdivision.h"
#include "light/light.h"
#include "ray/tracer.h"
#include "scene/walls.h"

#define SCATTER_TASK    2048u   /* rays of a task */
#define SCATTER_LEAST   131072u /* rays of a light */
#define SCATTER_MOST    (1u << 24)
#define SCATTER_BEAMS   12u /* rays of a light, over the beams of a sphere */
#define SCATTER_LIT     16u /* beams of a sphere over the rays for each sphere in the light */
#define SCATTER_WHOLE   .9  /* a patch that gets more than this part of what may fall on it is lit wholly */
#define SCATTER_NARROW  4.0 /* discs of the largest sphere, of which light is narrow */
#define SCATTER_RANDOM  .36 /* even rays for which a random one stands */
#define SCATTER_SEED    UINT64_C(0x4c49474854) /* of random reflections */
#define SCATTER_PATCHES 4.0                    /* patches of a four, for which fibrad_heat_fine_point gives areas */

uint32_t fibrad_heat_light_rays(const fibrad_heat *heat, const double *hits) {
    uint64_t lit = 0;
    if (heat == NULL || hits == NULL) return 0;
    for (uint32_t b = 0; b < heat->spheres; b++) {
        double sum = 0;
        for (uint32_t a = heat->first[b]; a < heat->first[b + 1]; a++) sum += hits[a];
        lit += sum > 0;
    }
    const double rays = heat->beams * (SCATTER_BEAMS + (double)lit / SCATTER_LIT);
    const double tasks = fibrad_min(fibrad_max(rays, SCATTER_LEAST), SCATTER_MOST) / SCATTER_TASK;
    return (uint32_t)tasks * SCATTER_TASK;
}

/* A place on a surface. */
typedef struct light_place {
    double at[3], normal[3]; /* L */
    uint32_t sphere;         /* FIBRAD_NONE: none */
    uint32_t except;         /* the triangle there, or FIBRAD_NO_SIDE */
} light_place;

/* The place where a ray ends that a hit was found for. False: the ray leaves. */
static bool find_light_place(const fibrad_heat *heat, const double origin[3], const double w[3], const fibrad_hit *hit,
                             light_place *place) {
    const fibrad_scene *scene = heat->scene;
    double length = __builtin_inf();
    *place = (light_place){.sphere = hit->sphere, .except = FIBRAD_NO_SIDE};
    if (hit->sphere != FIBRAD_NONE) {
        const double centre[3] = {scene->x[hit->sphere], scene->y[hit->sphere], scene->z[hit->sphere]};
        for (int a = 0; a < 3; a++) {
            place->normal[a] = hit->normal[a];
            place->at[a] = centre[a] + scene->r[hit->sphere] * hit->normal[a];
        }
        return true;
    }
    const uint32_t wall = scene->container.walls ? fibrad_walls_exit(scene, origin, w, &length) : FIBRAD_NONE;
    const bool meshed = hit->side != FIBRAD_NO_SIDE && (wall == FIBRAD_NONE || hit->distance < length);
    if (!meshed && (wall == FIBRAD_NONE || heat->openings >> wall & 1)) return false;
    for (int a = 0; a < 3; a++) place->at[a] = origin[a] + (meshed ? hit->distance : length) * w[a];
    if (meshed) {
        place->except = fibrad_side_triangle(hit->side);
        fibrad_mesh_normal(&scene->mesh, hit->side, place->normal);
    } else {
        fibrad_wall_normal(scene, wall, place->at, place->normal);
    }
    return true;
}

/* The patch where a ray ends. FIBRAD_NONE: on a side that belongs to no wall. */
static uint32_t patch_met(const fibrad_heat *heat, const double origin[3], const double w[3], const fibrad_hit *hit) {
    return hit->sphere != FIBRAD_NONE ? fibrad_heat_patch_at(heat, hit->sphere, hit->normal)
                                      : fibrad_heat_ends(heat, origin, w, hit->side, hit->distance);
}

/* Reflects a ray at a place. x: two numbers in [0, 1). */
static void reflect_ray(const fibrad_scene *scene, const light_place *from, const double x[2], double w[3],
                        fibrad_hit *hit) {
    fibrad_heat_direction(x, from->normal, w);
    *hit = (fibrad_hit){0};
    if (from->sphere != FIBRAD_NONE)
        FIBRAD_VERSION_OF(fibrad_trace, scene->facts.isa)(scene, NULL, from->sphere, from->normal, w, hit);
    else
        FIBRAD_VERSION_OF(fibrad_trace_point, scene->facts.isa)(scene, NULL, from->at, w, from->except, hit);
}

/* How many hits of a ray are followed. */
static uint32_t hits_of(const fibrad_heat *heat, const fibrad_footprint *f) {
    const double r = heat->scene->facts.radius_max;
    return fibrad_footprint_area(f) <= SCATTER_NARROW * FIBRAD_PI * r * r ? FIBRAD_LIGHT_HITS : 2;
}

/* Follows ray n of a light in one of its directions. The first two hits are evenly spread, the others random.
 * FIBRAD_E_BACK: *back is the triangle whose side belongs to no wall. */
static int follow_light(const fibrad_heat *heat, const fibrad_footprint *f, uint32_t n, fibrad_light_ray *ray,
                        uint32_t *back) {
    double d[3] = {0 - f->frame[6], 0 - f->frame[7], 0 - f->frame[8]};
    double x[4], uv[2], at[3];
    uint32_t piece;
    fibrad_hit hit = {0};
    light_place place;
    *ray = (fibrad_light_ray){.slot = FIBRAD_ESCAPED};
    for (uint32_t h = 0; h < FIBRAD_LIGHT_HITS; h++) ray->patch[h] = FIBRAD_NONE;
    fibrad_heat_even_point(heat, 0, n, x);
    for (int a = 0; a < 2; a++) uv[a] = f->bound_low[a] + x[a] * (f->bound_high[a] - f->bound_low[a]);
    if (!fibrad_footprint_lights(f, uv, &piece)) return FIBRAD_OK;
    fibrad_footprint_enters(f, piece, uv, at);
    FIBRAD_VERSION_OF(fibrad_trace_point, heat->scene->facts.isa)(heat->scene, NULL, at, d, FIBRAD_NO_SIDE, &hit);
    ray->slot = f->piece[piece].slot;
    fibrad_random random = fibrad_random_start(SCATTER_SEED, n);
    for (uint32_t h = 0, hits = hits_of(heat, f); h < hits; h++) {
        ray->patch[h] = patch_met(heat, at, d, &hit);
        if (ray->patch[h] == FIBRAD_NONE) {
            *back = fibrad_side_number(&heat->scene->mesh, hit.side);
            return FIBRAD_E_BACK;
        }
        if (h + 1 == hits || !find_light_place(heat, at, d, &hit, &place)) break;
        for (int a = 2; a < 4 && h > 0; a++) x[a] = fibrad_random_next(&random);
        reflect_ray(heat->scene, &place, x + 2, d, &hit);
        fibrad_copy(at, place.at, sizeof at);
    }
    return FIBRAD_OK;
}

uint32_t fibrad_heat_scatter_tasks(uint32_t rays) { return rays / SCATTER_TASK + (rays % SCATTER_TASK > 0); }

int fibrad_heat_scatter(const fibrad_heat *heat, fibrad_work *work, const fibrad_light *light, uint32_t rays,
                        uint32_t task, fibrad_light_ray *ray) {
    fibrad_workspace *space;
    if (heat == NULL || work == NULL || ray == NULL || task >= fibrad_heat_scatter_tasks(rays))
        return FIBRAD_E_ARGUMENT;
    if (!fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    int status = fibrad_light_check(heat->scene, light, NULL);
    if (status == FIBRAD_OK) status = fibrad_light_open(heat->scene, work, 0, &space);
    if (status != FIBRAD_OK) return status;
    fibrad_footprint *f = fibrad_light_footprint(space);
    const uint32_t begin = task * SCATTER_TASK, count = fibrad_light_count(light);
    const uint32_t end = rays - begin < SCATTER_TASK ? rays : begin + SCATTER_TASK;
    for (uint32_t n = begin, made = FIBRAD_NONE; n < end && status == FIBRAD_OK; n++) {
        const uint32_t k = (uint32_t)((uint64_t)n * count / rays);
        if (k != made) fibrad_footprint_make(f, heat->scene, light, made = k);
        status = follow_light(heat, f, n, &ray[n], &work->triangle);
    }
    return status;
}

/* Whether rays name patches and slots that there are. */
static bool are_rays(const fibrad_heat *heat, const fibrad_light_ray *ray, uint32_t rays) {
    for (uint32_t n = 0; n < rays; n++) {
        if (ray == NULL || ray[n].slot > FIBRAD_ESCAPED) return false;
        for (uint32_t h = 0; h < FIBRAD_LIGHT_HITS && ray[n].patch[h] != FIBRAD_NONE; h++)
            if (ray[n].patch[h] >= heat->patches) return false;
    }
    return true;
}

/* Counts of rays that meet no sphere. Rays that end on triangles are counted by the slot at which they would end
 * without the triangles, and by patch. */
typedef struct ray_counts {
    double *patch;  /* [patches that are not of spheres], rays that end on no triangle; surroundings: that leave */
    double *meshed; /* [slots up to FIBRAD_ESCAPED][patches of meshes] */
    uint32_t others, first_meshed, of_meshes;
} ray_counts;

static ray_counts counts_of(const fibrad_heat *heat, double *room) {
    const uint32_t first = fibrad_heat_first_meshed(heat), others = fibrad_heat_others(heat);
    const uint32_t end = heat->first[fibrad_heat_body(heat, FIBRAD_MESHES + heat->meshes)];
    return (ray_counts){room, room != NULL ? room + (heat->patches - others) : NULL, others, first, end - first};
}

static size_t size_of_counts(const fibrad_heat *heat) {
    const ray_counts none = counts_of(heat, NULL);
    return (heat->patches - none.others + (size_t)none.of_meshes * (FIBRAD_ESCAPED + 1)) * sizeof(double);
}

static double *meshed_from(const ray_counts *counts, uint32_t slot) {
    return counts->meshed + (size_t)slot * counts->of_meshes;
}

static void add_ray(const fibrad_heat *heat, ray_counts *counts, uint32_t slot, uint32_t patch) {
    if (patch >= counts->first_meshed && patch - counts->first_meshed < counts->of_meshes)
        meshed_from(counts, slot)[patch - counts->first_meshed]++;
    else
        counts->patch[(slot == FIBRAD_ESCAPED ? fibrad_heat_open(heat) : patch) - counts->others]++;
}

static double sum_of(const double *count, uint32_t n) {
    double sum = 0;
    for (uint32_t a = 0; a < n; a++) sum += count[a];
    return sum;
}

static void spread_on_body(const fibrad_heat *heat, uint32_t body, const double *count, double all, double power,
                           double *hits) {
    for (uint32_t a = heat->first[body]; a < heat->first[body + 1]; a++)
        hits[a] += power * (count[a - heat->first[body]] / all);
}

/* Spreads the light that would end at a slot without triangles, `power`, as its rays have met patches. own and beyond
 * are the bodies of the slot. Without rays the light is spread evenly on `own`. Returns what triangles leave. */
static double spread_on_walls(const fibrad_heat *heat, const ray_counts *counts, uint32_t slot, double power,
                              double *hits, fibrad_light_ends *ends) {
    const bool wall = slot < FIBRAD_WALLS;
    const uint32_t own = wall ? fibrad_heat_body(heat, slot) : heat->bodies - 1;
    const uint32_t body[2] = {own, wall ? fibrad_heat_beyond(heat, slot) : own};
    const double *meshed = meshed_from(counts, slot);
    double left = 0;
    for (int n = 0; n < (wall ? 2 : 1); n++)
        left += sum_of(counts->patch + (heat->first[body[n]] - counts->others),
                       heat->first[body[n] + 1] - heat->first[body[n]]);
    const double all = left + sum_of(meshed, counts->of_meshes);
    const uint32_t begin = heat->first[own], end = heat->first[own + 1];
    for (uint32_t a = begin; a < end && wall && !(all > 0); a++) hits[a] += power / (end - begin);
    if (!(all > 0)) return power;
    for (int n = 0; n < 2 && wall; n++)
        spread_on_body(heat, body[n], counts->patch + (heat->first[body[n]] - counts->others), all, power, hits);
    for (uint32_t b = 0; b < heat->given_walls; b++) {
        const uint32_t mesh = fibrad_heat_body(heat, heat->slot[b]);
        if (heat->slot[b] < FIBRAD_MESHES) continue;
        const double *count = meshed + (heat->first[mesh] - counts->first_meshed);
        spread_on_body(heat, mesh, count, all, power, hits);
        ends->wall[b] += power * (sum_of(count, heat->first[mesh + 1] - heat->first[mesh]) / all);
    }
    return power * (left / all);
}

int fibrad_heat_shine_walls(const fibrad_heat *heat, fibrad_work *work, const fibrad_light_ray *ray, uint32_t rays,
                            fibrad_light_ends *ends, double *hits) {
    fibrad_workspace *space;
    if (heat == NULL || work == NULL || ends == NULL || hits == NULL) return FIBRAD_E_ARGUMENT;
    if (!fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    if (!are_rays(heat, ray, rays)) return FIBRAD_E_ARGUMENT;
    const size_t room = size_of_counts(heat);
    const int status = fibrad_light_open(heat->scene, work, room, &space);
    if (status != FIBRAD_OK) return status;
    ray_counts counts = counts_of(heat, fibrad_light_scratch(space));
    fibrad_zero(counts.patch, room);
    for (uint32_t n = 0; n < rays; n++)
        if (ray[n].patch[0] != FIBRAD_NONE && ray[n].patch[0] >= counts.others)
            add_ray(heat, &counts, ray[n].slot, ray[n].patch[0]);
    for (uint32_t b = 0; b < heat->given_walls; b++)
        if (heat->slot[b] < FIBRAD_WALLS)
            ends->wall[b] = spread_on_walls(heat, &counts, heat->slot[b], fibrad_max(0, ends->wall[b]), hits, ends);
    if (heat->meshes > 0)
        ends->through = spread_on_walls(heat, &counts, FIBRAD_ESCAPED, fibrad_max(0, ends->through), hits, ends);
    return FIBRAD_OK;
}

/* What the reflection of a light works with. */
typedef struct reflection {
    const fibrad_heat *heat;
    const double *frame; /* of the light */
    const double *first; /* [patches], first hits */
    double flux;
    double *count;   /* [patches], rays of a hit that meet a patch; -1: none is needed */
    double *came;    /* [patches], what these rays bring */
    double *squares; /* [patches], of what arrives by rays */
    double *left;    /* [patches], what arrives by rays and patches reflect */
    double *falls;   /* [patches of meshes], what light of flux 1 brings if nothing is before them */
    double *sent[FIBRAD_LIGHT_HITS - 1]; /* [patches]: what each ray carries on from its first hit, and the fraction of
                                           it that it carries on from the next ones */
} reflection;

/* Finds what light of flux 1 brings to the patches of meshes. */
static void fall_on_meshes(const reflection *r) {
    const fibrad_heat *heat = r->heat;
    const fibrad_mesh *mesh = &heat->scene->mesh;
    for (uint32_t s = 0; s < 2 * heat->triangles; s++) {
        const fibrad_mesh_cut *cut = fibrad_mesh_cut_of(mesh, heat->cut, s);
        if (cut->patch == UINT32_MAX) continue;
        double n[3];
        fibrad_mesh_normal(mesh, s, n);
        const uint32_t patches = UINT32_C(1) << cut->halvings;
        const double area = fibrad_mesh_triangle_area(mesh, fibrad_side_triangle(s)) / patches;
        for (uint32_t a = cut->patch; a < cut->patch + patches; a++)
            r->falls[a] += area * fibrad_max(0, fibrad_dot(n, r->frame + 6));
    }
}

/* What light of flux 1 brings to a patch if nothing is before it. Infinity: not known. */
static double may_fall_on(const reflection *r, uint32_t body, uint32_t patch) {
    const fibrad_heat *heat = r->heat;
    double middle[2];
    if (body >= fibrad_heat_beyond(heat, 0)) return __builtin_inf();
    if (body >= fibrad_heat_body(heat, FIBRAD_MESHES)) return r->falls[patch - fibrad_heat_first_meshed(heat)];
    const uint32_t fine = fibrad_heat_first_fine(heat, body);
    const uint32_t number = patch - (patch < fine ? heat->first[body] : fine);
    const fibrad_heat_four own = {.body = body, .own = number / FIBRAD_HEAT_FOUR};
    const fibrad_heat_four *four =
        patch < fine ? &own : &heat->division.four[heat->division.first_four[body] + number / FIBRAD_HEAT_FOUR];
    return fibrad_light_falls_on(heat, r->frame, four, number % FIBRAD_HEAT_FOUR, middle) / SCATTER_PATCHES;
}

/* Whether all patches of the four that begins at a patch are lit wholly. The coarser level has one source for them. */
static bool is_lit_wholly(const reflection *r, uint32_t body, uint32_t begin, uint32_t end) {
    bool whole = true;
    for (uint32_t a = begin; a < end && whole; a++)
        whole = r->first[a] > 0 && r->first[a] > SCATTER_WHOLE * r->flux * may_fall_on(r, body, a);
    return whole;
}

static double beams_of_patch(const fibrad_heat *heat) {
    return 2.0 * heat->beams / (heat->config.patches * heat->thin);
}

/* Whether as many rays meet a body as beams would leave its patches there. Rays are then the better ones. came: what
 * falls on patches. ray: what a ray counts. */
static bool has_dense_rays(const reflection *r, uint32_t body, const double *came, double ray) {
    double rays = 0, power = 0, squares = 0;
    for (uint32_t a = r->heat->first[body]; a < r->heat->first[body + 1]; a++)
        rays += ray * r->count[a], power += came[a], squares += came[a] * came[a];
    return power > 0 && rays * squares >= beams_of_patch(r->heat) * power * power;
}

/* Divides the light on a body into that on patches which are lit wholly, and the rest, which rays reflect. Sets what
 * each ray carries on; the count of patches without rays is set below 1. If a body has no rays, its patches reflect
 * all.
 */
static void divide_light(const reflection *r, uint32_t body, double absorptivity, const fibrad_light_hits *hits) {
    const uint32_t begin = r->heat->first[body], end = r->heat->first[body + 1];
    const bool dense = has_dense_rays(r, body, r->first, 1);
    double rays = 0, power = 0;
    for (uint32_t a = begin, next; a < end; a = next) {
        next = end - a > FIBRAD_HEAT_FOUR ? a + FIBRAD_HEAT_FOUR : end;
        const bool whole = !dense && is_lit_wholly(r, body, a, next);
        for (uint32_t k = a; k < next && whole; k++) r->count[k] = -1;
        for (uint32_t k = a; k < next && !whole; k++) rays += r->count[k], power += r->first[k];
    }
    for (uint32_t a = begin; a < end; a++) {
        if (r->count[a] < 0 || rays == 0) hits->light[a] += r->first[a];
        if (r->count[a] <= 0) continue;
        r->sent[0][a] = power / rays * (1 - absorptivity);
        hits->spots[a] += r->count[a] * (power / rays);
    }
}

/* Has rays carry on what they have brought to a body with hit h. Patches reflect it if the rays are few. */
static void carry_on(const reflection *r, uint32_t body, uint32_t h, double absorptivity,
                     const fibrad_light_hits *hits) {
    const bool dense = has_dense_rays(r, body, r->came, SCATTER_RANDOM);
    for (uint32_t a = r->heat->first[body]; a < r->heat->first[body + 1]; a++) {
        if (dense) r->sent[h][a] = 1 - absorptivity;
        *(dense ? &hits->spots[a] : &r->left[a]) += r->came[a];
    }
}

/* Reflects what has come to a body with hit h. */
static void reflect_on(const reflection *r, uint32_t body, uint32_t h, double absorptivity,
                       const fibrad_light_hits *hits) {
    if (h == 0)
        divide_light(r, body, absorptivity, hits);
    else
        carry_on(r, body, h, absorptivity, hits);
}

/* What a ray brings with hit h > 0. */
static double brought_by(const reflection *r, const fibrad_light_ray *ray, uint32_t h) {
    double power = ray->patch[0] == FIBRAD_NONE || ray->patch[h] == FIBRAD_NONE ? 0 : r->sent[0][ray->patch[0]];
    for (uint32_t k = 1; k < h && power > 0; k++) power *= r->sent[k][ray->patch[k]];
    return power;
}

/* Whether a ray has no hit after hit h. */
static bool ends_with(const fibrad_light_ray *ray, uint32_t h) {
    return h + 1 == FIBRAD_LIGHT_HITS || ray->patch[h + 1] == FIBRAD_NONE;
}

/* Finds what rays bring with hit h. Patches reflect what comes by rays that end there. */
static void bring_light(const reflection *r, const fibrad_light_ray *ray, uint32_t rays, uint32_t h) {
    const size_t bytes = r->heat->patches * sizeof *r->came;
    fibrad_zero(r->count, bytes);
    fibrad_zero(r->came, bytes);
    for (uint32_t n = 0; n < rays; n++) {
        const uint32_t patch = ray[n].patch[h];
        const double power = h == 0 ? 0 : brought_by(r, &ray[n], h);
        if (patch == FIBRAD_NONE || (h > 0 && !(power > 0))) continue;
        r->squares[patch] += power * power / (h > 1 ? SCATTER_RANDOM : 1);
        if (h > 0 && ends_with(&ray[n], h))
            r->left[patch] += power;
        else
            r->count[patch]++, r->came[patch] += power;
    }
}

/* Adds the squares of a body. What its patches reflect leaves each patch by a few beams. */
static void add_squares_of(const reflection *r, uint32_t body, double absorptivity, double *squares, double *beams) {
    const double few = beams_of_patch(r->heat);
    for (uint32_t a = r->heat->first[body]; a < r->heat->first[body + 1]; a++) {
        const double reflected = (1 - absorptivity) * r->left[a];
        *squares += r->squares[a], *beams += reflected * reflected / few;
    }
}

static void add_squares(const reflection *r, const double *absorptivity, const double *wall_absorptivity,
                        double *squares) {
    const fibrad_heat *heat = r->heat;
    double *outside = squares + heat->spheres + heat->given_walls, *beams = outside + 1;
    for (uint32_t b = 0; b < heat->spheres; b++)
        add_squares_of(r, b, absorptivity[heat->order[b]], &squares[heat->order[b]], beams);
    for (uint32_t k = 0; k < heat->given_walls; k++) {
        const uint32_t slot = heat->slot[k];
        double *own = &squares[heat->spheres + k];
        add_squares_of(r, fibrad_heat_body(heat, slot), wall_absorptivity[k], own, beams);
        if (slot < FIBRAD_WALLS) add_squares_of(r, fibrad_heat_beyond(heat, slot), wall_absorptivity[k], own, beams);
    }
    for (uint32_t k = 0; k < FIBRAD_WALLS; k++)
        if (heat->openings >> k & 1) add_squares_of(r, heat->spheres + k, 1, outside, beams);
    add_squares_of(r, heat->bodies - 1, 1, outside, beams);
}

int fibrad_heat_reflect(const fibrad_heat *heat, fibrad_work *work, const fibrad_light *light,
                        const fibrad_light_ray *ray, uint32_t rays, const double *absorptivity,
                        const double *wall_absorptivity, const fibrad_light_hits *hits) {
    fibrad_workspace *space;
    if (heat == NULL || work == NULL || hits == NULL) return FIBRAD_E_ARGUMENT;
    if ((heat->spheres > 0 && absorptivity == NULL) || (heat->given_walls > 0 && wall_absorptivity == NULL))
        return FIBRAD_E_ARGUMENT;
    if (!fibrad_heat_scene_kept(heat)) return FIBRAD_E_STATE;
    if (!are_rays(heat, ray, rays)) return FIBRAD_E_ARGUMENT;
    const size_t patches = heat->patches;
    const size_t bytes = ((3 + FIBRAD_LIGHT_HITS) * patches + counts_of(heat, NULL).of_meshes) * sizeof(double);
    int status = fibrad_light_check(heat->scene, light, NULL);
    if (status == FIBRAD_OK) status = fibrad_light_open(heat->scene, work, bytes, &space);
    if (status != FIBRAD_OK) return status;
    fibrad_footprint *f = fibrad_light_footprint(space);
    double *room = fibrad_light_scratch(space);
    reflection r = {.heat = heat, .frame = f->frame, .first = hits->first, .flux = light->flux, .count = room};
    r.came = room + patches, r.squares = room + 2 * patches, r.left = room + 3 * patches;
    r.falls = room + (3 + FIBRAD_LIGHT_HITS) * patches;
    for (uint32_t h = 0; h + 1 < FIBRAD_LIGHT_HITS; h++) r.sent[h] = room + (4 + h) * patches;
    fibrad_zero(room, bytes);
    fibrad_footprint_make(f, heat->scene, light, 0);
    fall_on_meshes(&r);
    for (uint32_t h = 0; h < FIBRAD_LIGHT_HITS; h++) {
        bring_light(&r, ray, rays, h);
        for (uint32_t b = 0; b < heat->spheres; b++) reflect_on(&r, b, h, absorptivity[heat->order[b]], hits);
        for (uint32_t k = 0; k < heat->given_walls; k++) {
            const uint32_t slot = heat->slot[k];
            reflect_on(&r, fibrad_heat_body(heat, slot), h, wall_absorptivity[k], hits);
            if (slot < FIBRAD_WALLS) reflect_on(&r, fibrad_heat_beyond(heat, slot), h, wall_absorptivity[k], hits);
        }
    }
    for (size_t a = 0; a < patches; a++) hits->light[a] += r.left[a];
    add_squares(&r, absorptivity, wall_absorptivity, hits->squares);
    return FIBRAD_OK;
}
