/* cast_lanes.c - a row of view factors by rays. Compiled once per instruction set. SPDX-License-Identifier: MIT
 *
 * Rays are made in batches, lanes over rays, from points of the unit 4-cube. Two coordinates give the origin on the
 * sphere. Two give the direction in the frame of the normal there. Then rays are traced one by one, lanes over the
 * near spheres of work.h, shell by shell. A cull in floats leaves few spheres. Their distances are computed in
 * doubles. */
#include FIBRAD_LANES_HEADER
#include "base/lanes/turn.h"
#include "row/cast_lanes.h"
#include "scene/walls.h"
#include "near/near_lanes.h"

#define CAST_BATCH  (8 * VD_LANES)              /* rays: 64 in AVX-512; fewer in narrower sets, to save stack */
#define CAST_STRIDE ((fibrad_stride){3.0, 1.4}) /* less than for windows, since a ray ends sooner */

/* First points of the 4-cube, then rays. A ray has a direction w, two unit vectors u and v across it, and the angle
 * between w and the normal. The origin is cosine w - sine v. */
struct cast_batch {
    _Alignas(64) double at[4][CAST_BATCH];
    _Alignas(64) double u[3][CAST_BATCH];
    _Alignas(64) double v[3][CAST_BATCH];
    _Alignas(64) double w[3][CAST_BATCH];
    _Alignas(64) double sine[CAST_BATCH];
    _Alignas(64) double cosine[CAST_BATCH];
};

/* Fills the coordinates of rays from ray `first` on. The points are those of a quasirandom sequence, which a random
 * shift of the row moves together, or random points. Each number is a function of (seed, i, ray), so a row depends on
 * no other row. */
static void fill_batch(struct cast_batch *rays, const fibrad_cast_rule *rule, fibrad_random stream, uint32_t first) {
    for (int d = 0; d < 4; d++) {
        const uint64_t shift = fibrad_random_ahead(stream, (uint64_t)d), step = fibrad_quasirandom_step(4, d);
        for (uint32_t b = 0; b < CAST_BATCH; b++) {
            const uint64_t k = (uint64_t)first + b;
            const uint64_t x = rule->random ? fibrad_random_ahead(stream, 4 * k + (uint64_t)d) : shift + k * step;
            rays->at[d][b] = fibrad_fraction(x);
        }
    }
}

/* The origin n: z uniform over [-1, 1], azimuth uniform. The direction: by the cosine law the squared sine of the
 * angle to n is uniform over [0, 1]. The azimuth about n is uniform. Its frame is the parallel a, the meridian b and
 * n. */
static void aim_batch(struct cast_batch *rays) {
    const vd one = vd_set1(1);
    for (uint32_t b = 0; b < CAST_BATCH; b += VD_LANES) {
        vd height = vd_load(rays->at[0] + b), square = vd_load(rays->at[2] + b), cos, sin, across, along;
        vd_turn(vd_load(rays->at[1] + b), &cos, &sin);
        vd_turn(vd_load(rays->at[3] + b), &across, &along);
        vd z = one - (height + height);
        vd ring = vd_sqrt(4 * height * (one - height));
        vd sine = vd_sqrt(square), cosine = vd_sqrt(one - square), zero = vd_set1(0);
        vd axis_a[3] = {zero - sin, cos, zero};
        vd axis_b[3] = {zero - z * cos, zero - z * sin, ring};
        vd normal[3] = {ring * cos, ring * sin, z};
        for (int axis = 0; axis < 3; axis++) {
            vd side = across * axis_a[axis] + along * axis_b[axis];
            vd_store(rays->u[axis] + b, along * axis_a[axis] - across * axis_b[axis]);
            vd_store(rays->v[axis] + b, cosine * side - sine * normal[axis]);
            vd_store(rays->w[axis] + b, sine * side + cosine * normal[axis]);
        }
        vd_store(rays->sine + b, sine);
        vd_store(rays->cosine + b, cosine);
    }
}

/* A ray. In the window of direction w its place is (0, -sine). It starts at depth `cosine`. */
struct cast_ray {
    double frame[9], sine, cosine;
};

/* The first sphere so far. */
struct cast_hit {
    double distance;       /* infinity: there is none */
    double depth, u, v, r; /* of its disc */
    uint32_t sphere;
};

/* Appends the discs of one shell that lie before the window and that the ray from o along w may meet. With q = c^2 +
 * 1 - r^2 these are the discs with (w.c - w.o)^2 > q - 2 o.c. */
static void cull_for_ray(fibrad_workspace *work, const struct cast_ray *ray, uint32_t shell) {
    const fibrad_near *near = &work->near;
    uint32_t *to = work->disc.near;
    size_t end = near->end[shell];
    const double *v = ray->frame + 3, *w = ray->frame + 6;
    vf wx = vf_set1((float)w[0]), wy = vf_set1((float)w[1]), wz = vf_set1((float)w[2]);
    vf ox = vf_set1((float)(2 * (ray->cosine * w[0] - ray->sine * v[0])));
    vf oy = vf_set1((float)(2 * (ray->cosine * w[1] - ray->sine * v[1])));
    vf oz = vf_set1((float)(2 * (ray->cosine * w[2] - ray->sine * v[2])));
    vf start = vf_set1((float)ray->cosine);
    for (size_t j = shell == 0 ? 0 : near->end[shell - 1]; j < end; j += VF_LANES) {
        vf x = vf_load(near->fx + j), y = vf_load(near->fy + j), z = vf_load(near->fz + j);
        vf depth = wx * x + wy * y + wz * z;
        vf twice = ox * x + oy * y + oz * z;
        vf from = depth - start, rest = vf_load(near->fq + j) - twice;
        uint32_t bits = vf_lt_bits(vf_load(near->fe + j), depth) & vf_lt_bits(rest, from * from);
        to += vf_compress_places(to, bits, (uint32_t)j);
    }
    LANED(fibrad_near_discs)(work, ray->frame, (uint32_t)(to - work->disc.near));
}

/* Whether hit a comes before hit b. Two distances are equal if the ray begins inside both spheres, for example. Then
 * the smaller depth counts. Two depths may be equal, too. */
static bool cast_hit_before(const fibrad_scene *scene, const struct cast_hit *a, const struct cast_hit *b) {
    if (a->distance != b->distance) return a->distance < b->distance;
    if (a->depth != b->depth) return a->depth < b->depth;
    return fibrad_scene_tie(scene, a->sphere, (double[]){a->u, a->v}, b->sphere, (double[]){b->u, b->v}, 2);
}

/* Compares the discs of `work` down to the horizon with the first sphere so far. */
static void intersect_discs(const fibrad_workspace *work, const struct cast_ray *ray, double horizon,
                            struct cast_hit *first) {
    const fibrad_discs *disc = &work->disc;
    for (uint32_t k = 0; k < disc->count; k++) {
        struct cast_hit hit = {0, disc->depth[k], disc->u[k], disc->v[k], disc->r[k], fibrad_work_sphere(work, k)};
        double v = hit.v + ray->sine, square = hit.r * hit.r - (hit.u * hit.u + v * v);
        if (!(square > 0 && hit.depth <= horizon)) continue;
        hit.distance = fibrad_max(0, hit.depth - ray->cosine - fibrad_sqrt(square));
        if (cast_hit_before(work->scene, &hit, first)) *first = hit;
    }
}

/* Traces one ray. Spheres that have not been listed are deeper than `known`. If spheres do not overlap, this means
 * that they come after all spheres that are less deep. If sphere k is deeper than sphere j but is met first, the
 * part of the ray in j lies in a cap of j inside k. The height of this cap is at most the overlap h r_j. Such a
 * chord is so inclined to the line of centres that k is deeper by at most (r_j + r_k) sqrt(2 h). A member of a clump
 * may be deeper by its own radius. False: there are too many discs for the memory. */
static bool follow_cast_ray(fibrad_workspace *work, const struct cast_ray *ray, struct cast_hit *first) {
    const fibrad_scene_facts *facts = &work->scene->facts;
    double largest = facts->radius_max * work->inverse;
    double lead = work->scene->clump != NULL ? 1 : fibrad_sqrt(2 * facts->overlap_max + 1e-12);
    double known = -1, horizon = __builtin_inf();
    for (uint32_t shell = 0; known < horizon; shell++) {
        work->disc.count = 0;
        if (shell == work->near.shells && fibrad_near_pays(&work->near)) LANED(fibrad_near_extend)(work);
        if (shell < work->near.shells) {
            cull_for_ray(work, ray, shell);
            known = work->near.limit[shell];
        } else {
            const double to = fibrad_near_further(work, known);
            LANED(fibrad_near_walk)(work, ray->frame, &(fibrad_tube){0, -ray->sine, 0}, known, to);
            known = to;
        }
        if (work->disc.count > work->disc.capacity) return false;
        if (known >= work->clear) horizon = fibrad_near_horizon(work, ray->frame + 6);
        intersect_discs(work, ray, horizon, first);
        if (first->distance < __builtin_inf() && first->depth + (first->r + largest) * lead <= known) break;
    }
    return true;
}

/* The angle whose tangent is y/x, both >= 0. The tangent of an eighth of the angle is below 0.2, where a short
 * series suffices. */
static double angle_of_tangent(double y, double x) {
    double t = y / (x + fibrad_sqrt(x * x + y * y));
    t = t / (1 + fibrad_sqrt(1 + t * t));
    t = t / (1 + fibrad_sqrt(1 + t * t));
    double square = t * t, sum = 0;
    for (int n = 23; n >= 1; n -= 2) sum = 1.0 / n - square * sum;
    return 8 * t * sum;
}

/* Whether the first sphere that a ray meets lies behind a wall that the ray meets before. */
static bool is_behind(const fibrad_scene *scene, const struct cast_ray *ray, const double from[3],
                      const struct cast_hit *hit) {
    double n[3], at[3];
    if (!(hit->distance > 0 && hit->distance < __builtin_inf()) || !scene->cut[hit->sphere]) return false;
    for (int axis = 0; axis < 3; axis++) {
        const double *frame = ray->frame + axis;
        const double centre = hit->u * frame[0] + hit->v * frame[3] + hit->depth * frame[6];
        n[axis] = (from[axis] + hit->distance * frame[6] - centre) / hit->r;
    }
    return fibrad_walls_behind(scene, hit->sphere, n, at) != FIBRAD_NONE;
}

/* Counts a ray that meets no sphere, by the place where it leaves. from: origin in radii from the centre. */
static void count_exit(fibrad_workspace *work, const struct cast_ray *ray, const double from[3]) {
    work->wall[fibrad_work_met(work, from, ray->frame + 6, work->reach)]++;
}

/* Counts a ray that meets a triangle before a sphere at some distance [radii]. False: the ray meets no triangle
 * before. */
static bool count_side(fibrad_workspace *work, const struct cast_ray *ray, const double from[3], double sphere,
                       uint32_t k) {
    const fibrad_scene *scene = work->scene;
    double origin[3], length;
    if (!(sphere + 1 >= work->clear_mesh)) return false;
    fibrad_mesh_hit met = {FIBRAD_NO_SIDE, 0};
    if (work->clear_mesh < 1) /* the origin may lie beyond a triangle */
        met = fibrad_mesh_first(&scene->mesh, work->centre, from, work->unit, FIBRAD_NO_SIDE);
    if (met.side != FIBRAD_NO_SIDE) met.distance = 0;
    for (int axis = 0; axis < 3; axis++) origin[axis] = work->centre[axis] + work->unit * from[axis];
    if (met.side == FIBRAD_NO_SIDE)
        met = fibrad_mesh_first(&scene->mesh, origin, ray->frame + 6, sphere * work->unit, FIBRAD_NO_SIDE);
    if (met.side == FIBRAD_NO_SIDE) return false;
    const double ball = fibrad_ball_exit(from, ray->frame + 6, work->reach) * work->unit;
    const uint32_t slot =
        fibrad_surroundings_side(scene, origin, ray->frame + 6, ball, met.side, met.distance, &length);
    if (slot == FIBRAD_NONE)
        work->back = fibrad_side_number(&scene->mesh, met.side);
    else
        fibrad_entries_add(&work->entries, fibrad_entries_of(&work->entries, scene->facts.spheres + slot), k, 1);
    return true;
}

/* Counts a hit. */
static void count_hit(fibrad_workspace *work, const struct cast_hit *first, uint32_t k, bool means) {
    uint32_t entry = fibrad_entries_of(&work->entries, first->sphere);
    fibrad_entries_add(&work->entries, entry, k, 1);
    if (!means || entry == FIBRAD_NONE) return;
    work->entries.lengths[entry] += first->distance * work->unit;
    work->entries.angles[entry] +=
        angle_of_tangent(fibrad_sqrt(first->u * first->u + first->v * first->v), first->depth);
}

static void write_cast_means(const fibrad_workspace *work, const fibrad_row *row, const fibrad_cast_means *means) {
    const fibrad_entries *entries = &work->entries;
    for (uint32_t k = 0; k < row->length; k++) {
        uint32_t entry = fibrad_entries_find(entries, work->scene->place[row->col[k]]);
        const double *part = entries->part[entry];
        double count = part[0] + part[1] + part[2] + part[3];
        means->length[k] = entries->lengths[entry] / count;
        means->angle[k] = entries->angles[entry] / count;
    }
}

int LANED(fibrad_cast_lanes)(const fibrad_scene *scene, fibrad_workspace *work, uint32_t i,
                             const fibrad_cast_task *task, fibrad_row *row) {
    const fibrad_cast_rule *rule = &task->rule;
    const fibrad_cast_means *means = task->means;
    struct cast_batch rays;
    fibrad_random stream = {fibrad_mix(fibrad_random_ahead((fibrad_random){rule->seed}, fibrad_scene_id(scene, i)))};
    fibrad_work_begin(work, scene, scene->place[i], rule->cutoff, CAST_STRIDE);
    for (uint32_t k = 0; k < rule->rays; k++) {
        uint32_t b = k % CAST_BATCH;
        if (b == 0) {
            fill_batch(&rays, rule, stream, k);
            aim_batch(&rays);
        }
        struct cast_ray ray = {.sine = rays.sine[b], .cosine = rays.cosine[b]};
        for (int axis = 0; axis < 3; axis++) {
            ray.frame[axis] = rays.u[axis][b];
            ray.frame[3 + axis] = rays.v[axis][b];
            ray.frame[6 + axis] = rays.w[axis][b];
        }
        struct cast_hit first = {.distance = __builtin_inf()};
        double from[3], at[3];
        for (int axis = 0; axis < 3; axis++)
            from[axis] = ray.cosine * ray.frame[6 + axis] - ray.sine * ray.frame[3 + axis];
        const uint32_t behind = fibrad_walls_behind(scene, work->place, from, at);
        if (behind != FIBRAD_NONE) {
            work->wall[behind]++;
            continue;
        }
        if (!follow_cast_ray(work, &ray, &first)) return fibrad_work_discs_missed(work);
        if (is_behind(scene, &ray, from, &first)) first.distance = __builtin_inf();
        if (scene->clear != NULL && count_side(work, &ray, from, first.distance, k)) continue;
        if (first.distance < __builtin_inf())
            count_hit(work, &first, k, means != NULL);
        else
            count_exit(work, &ray, from);
    }
    if (work->entries.missed > 0) return fibrad_work_entries_missed(work);
    if (work->back != UINT32_MAX) return FIBRAD_E_BACK;
    fibrad_entries_slots(&work->entries, scene, work->wall);
    int status = fibrad_entries_row(&work->entries, scene, 1.0 / rule->rays, row);
    if (status != FIBRAD_OK) return status;
    row->escaped = work->wall[FIBRAD_ESCAPED] * (1.0 / rule->rays);
    row->beyond = work->wall[FIBRAD_BEYOND] * (1.0 / rule->rays);
    for (uint32_t slot = 0; slot < FIBRAD_SLOTS; slot++)
        if (fibrad_slot_of_wall(slot)) work->wall[slot] *= 1.0 / rule->rays;
    fibrad_row_walls(scene, work->wall, row);
    row->directions = row->fallbacks = 0;
    row->symmetric = 0;
    /* row->error is right as it is: each half has half as many rays, so its error is sqrt 2 times as large, and the
     * halves differ by twice the error of their mean. For quasirandom rays 0.65 to 1.9 times this was measured. */
    if (means != NULL) write_cast_means(work, row, means);
    return fibrad_row_checked(scene, row);
}
