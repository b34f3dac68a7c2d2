/* trace_lanes.c - finds the first sphere that a ray meets. Compiled once per instruction set.
 * SPDX-License-Identifier: MIT
 *
 * Near spheres are compared with the ray in floats first, in lanes. For the few that pass, distances are computed in
 * doubles. */
#include FIBRAD_LANES_HEADER
#include "base/lanes/below.h"
#include "base/vector.h"
#include "ray/tracer.h"
#include "scene/grid_walk.h"
#include "scene/walls.h"

/* A ray: positions relative to `base`, lengths in units of `unit`. */
struct trace_ray {
    const fibrad_scene *scene;
    const double *o, *w;
    double base[3], unit, inverse; /* [L] */
    uint32_t place;                /* of the sphere that the ray leaves; FIBRAD_NONE: the ray starts at a point */
};

/* The first sphere so far. */
struct trace_first {
    double distance, depth; /* infinity: there is none */
    double c[3], across[3]; /* its centre, and the component of the centre across the ray */
    double root;            /* half the chord */
    uint32_t sphere;
};

/* Whether the ray meets the sphere at place j with centre c before the first sphere so far. Two distances are equal
 * if the ray begins inside both spheres, for example. Then the smaller depth counts. Two depths may be
 * equal, too. */
static bool trace_before(const fibrad_scene *scene, double distance, double depth, uint32_t j, const double c[3],
                         const struct trace_first *first) {
    if (distance != first->distance) return distance < first->distance;
    if (depth != first->depth) return depth < first->depth;
    return fibrad_scene_tie(scene, j, c, first->sphere, first->c, 3);
}

/* Compares sphere j with centre c with the first sphere so far. */
static void intersect_sphere(const struct trace_ray *ray, uint32_t j, const double c[3], struct trace_first *first) {
    const double *w = ray->w;
    double r = ray->scene->r[j] * ray->inverse, e[3] = {c[0] - ray->o[0], c[1] - ray->o[1], c[2] - ray->o[2]};
    double depth = fibrad_dot(c, w), along = fibrad_dot(e, w);
    double across[3] = {e[0] - along * w[0], e[1] - along * w[1], e[2] - along * w[2]};
    double square = r * r - fibrad_dot(across, across);
    if (!(square > 0)) return;
    double root = fibrad_sqrt(square), distance = fibrad_max(0, along - root);
    const bool by_centre = ray->place != FIBRAD_NONE && !fibrad_one_clump(ray->scene, ray->place, j);
    const bool ahead = by_centre ? depth > 0 : along + root > 0;
    if (!ahead || !trace_before(ray->scene, distance, depth, j, c, first)) return;
    *first = (struct trace_first){distance, depth, {c[0], c[1], c[2]}, {across[0], across[1], across[2]}, root, j};
}

/* A ray as floats, for comparing the spheres of a list. Positions are as in the list. */
struct trace_cull {
    vf w[3], twice[3]; /* direction, and twice the point where the ray begins */
    vf along, inside;  /* depth of this point; 1 less the square of its distance from the centre */
    vf behind;         /* spheres of less depth are not met */
};

static struct trace_cull cull_of(const double start[3], const double w[3], double inside, float behind) {
    struct trace_cull cull = {
        .along = vf_set1((float)fibrad_dot(start, w)), .inside = vf_set1((float)inside), .behind = vf_set1(behind)};
    for (int axis = 0; axis < 3; axis++)
        cull.w[axis] = vf_set1((float)w[axis]), cull.twice[axis] = vf_set1((float)(2 * start[axis]));
    return cull;
}

/* Compares one group of the list. */
static void intersect_group(const struct trace_ray *ray, const fibrad_nearby_group *group,
                            const struct trace_cull *cull, struct trace_first *first) {
    const fibrad_scene *scene = ray->scene;
    for (uint32_t k = 0; k < FIBRAD_GROUP; k += VF_LANES) {
        vf x = vf_load(group->x + k), y = vf_load(group->y + k), z = vf_load(group->z + k);
        vf depth = cull->w[0] * x + cull->w[1] * y + cull->w[2] * z;
        vf twice = cull->twice[0] * x + cull->twice[1] * y + cull->twice[2] * z + cull->inside;
        vf from = depth - cull->along;
        uint32_t bits = vf_lt_bits(vf_load(group->q + k) - twice, from * from);
        bits &= vf_lt_bits(cull->behind, depth);
        for (; bits != 0; bits &= bits - 1) {
            uint32_t at = k + (uint32_t)__builtin_ctz(bits), j = group->sphere[at];
            const int8_t *periods = group->periods[at];
            double c[3] = {(scene->x[j] - ray->base[0] + periods[0] * scene->period[0]) * ray->inverse,
                           (scene->y[j] - ray->base[1] + periods[1] * scene->period[1]) * ray->inverse,
                           (scene->z[j] - ray->base[2] + periods[2] * scene->period[2]) * ray->inverse};
            intersect_sphere(ray, j, c, first);
        }
    }
}

/* Compares the spheres of a list, whose unit is `scale` times that of the ray. Returns the length up to which all
 * spheres are compared. */
static double intersect_list(const struct trace_ray *ray, const fibrad_nearby *list, double scale,
                             const struct trace_cull *cull, struct trace_first *first) {
    for (uint32_t group = 0; group < list->groups && !(first->distance < list->clear[group] * scale); group++)
        intersect_group(ray, &list->group[group], cull, first);
    return list->clear[list->groups] * scale;
}

/* The lengths at which the ray enters and leaves a box, from length `from` on. grid: the box of the grid; otherwise
 * the box of all centres. The box is enlarged by the largest radius. Along periodic axes the ray ends after
 * FIBRAD_PERIODS periods. */
static void cross_box(const struct trace_ray *ray, bool grid, double *enter, double *leave) {
    const fibrad_scene *scene = ray->scene;
    double wide = scene->facts.radius_max * (1 + 1e-9);
    *leave = __builtin_inf();
    for (int axis = 0; axis < 3; axis++) {
        double w = ray->w[axis];
        if (scene->period[axis] > 0) {
            if (w != 0)
                *leave = fibrad_min(*leave, FIBRAD_PERIODS * scene->period[axis] * ray->inverse / fibrad_abs(w));
            continue;
        }
        double low = (grid ? scene->box_low : scene->low)[axis] - wide - ray->base[axis];
        double high = (grid ? scene->box_high : scene->high)[axis] + wide - ray->base[axis];
        double to_low = low * ray->inverse - ray->o[axis], to_high = high * ray->inverse - ray->o[axis];
        if (w == 0) {
            if (to_low > 0 || to_high < 0) *leave = 0;
            continue;
        }
        *enter = fibrad_max(*enter, (w > 0 ? to_low : to_high) / w);
        *leave = fibrad_min(*leave, (w > 0 ? to_high : to_low) / w);
    }
}

/* Compares the spheres of a run. Lanes pass all spheres that the ray meets, and perhaps a few others. */
static void intersect_run(const struct trace_ray *ray, const fibrad_walk *walk, struct trace_first *first) {
    const fibrad_scene *scene = ray->scene;
    const double *const of_axis[3] = {scene->x, scene->y, scene->z}, *w = ray->w;
    for (uint32_t j = walk->begin; j < walk->end; j += VD_LANES) {
        vd c[3], along = vd_set1(0), square = vd_set1(0);
        for (int axis = 0; axis < 3; axis++) {
            c[axis] = (vd_loadu(of_axis[axis] + j) - ray->base[axis] + walk->shift[axis]) * ray->inverse;
            const vd e = c[axis] - ray->o[axis];
            along += e * w[axis], square += e * e;
        }
        const vd r = vd_loadu(scene->r + j) * ray->inverse;
        uint32_t bits = vm_bits(vd_lt(square * (1 - 1e-12), along * along + r * r)) & vd_lanes_below(walk->end - j);
        for (; bits != 0; bits &= bits - 1) {
            const uint32_t lane = (uint32_t)__builtin_ctz(bits);
            _Alignas(64) double at[3][VD_LANES];
            for (int axis = 0; axis < 3; axis++) vd_store(at[axis], c[axis]);
            const double centre[3] = {at[0][lane], at[1][lane], at[2][lane]};
            if (j + lane != ray->place || walk->image) intersect_sphere(ray, j + lane, centre, first);
        }
    }
}

/* Compares all spheres that the ray meets between the lengths `from` and `to`, and perhaps others. */
static void intersect_stretch(const struct trace_ray *ray, double from, double to, struct trace_first *first) {
    const fibrad_scene *scene = ray->scene;
    double ends[2][3];
    for (int axis = 0; axis < 3; axis++) {
        ends[0][axis] = ray->base[axis] + (ray->o[axis] + from * ray->w[axis]) * ray->unit;
        ends[1][axis] = ray->base[axis] + (ray->o[axis] + to * ray->w[axis]) * ray->unit;
    }
    for (uint32_t l = 0; l < scene->levels; l++) {
        fibrad_walk walk;
        fibrad_walk_about(&walk, scene, &scene->level[l], ends[0], ends[1], scene->level[l].radius_max * (1 + 1e-9));
        while (fibrad_walk_next(&walk)) intersect_run(ray, &walk, first);
    }
}

/* Continues through the grid from length `from` in steps of the mean spacing. Outside the box of the grid there are
 * only stray spheres, and the steps become longer. */
static void walk_ray(const struct trace_ray *ray, double from, struct trace_first *first) {
    double step = ray->scene->spacing * ray->inverse, enter = fibrad_min(from, 0), leave, begin = enter, end;
    cross_box(ray, true, &enter, &leave);
    cross_box(ray, false, &begin, &end);
    from = fibrad_max(from, begin);
    for (double stride = step; from < end && !(first->distance <= from);) {
        double to = from + stride, bound = end;
        if (from < enter)
            bound = fibrad_min(enter, end);
        else if (from < leave)
            bound = fibrad_min(leave, end);
        stride = from >= enter && from < leave ? step : 1.5 * stride;
        to = fibrad_min(to, bound);
        if (!(to > from)) to = end; /* by rounding */
        intersect_stretch(ray, from, to, first);
        from = to;
    }
}

static void write_hit(const struct trace_ray *ray, const struct trace_first *first, fibrad_hit *hit) {
    hit->sphere = FIBRAD_NONE, hit->side = FIBRAD_NO_SIDE;
    if (!(first->distance < __builtin_inf())) return;
    hit->sphere = first->sphere;
    hit->distance = first->distance * ray->unit;
    double scale = 1 / (ray->scene->r[first->sphere] * ray->inverse);
    for (int axis = 0; axis < 3; axis++) {
        hit->centre[axis] = first->c[axis] * ray->unit;
        hit->normal[axis] = -(first->across[axis] + first->root * ray->w[axis]) * scale;
    }
    double at[3]; /* spheres behind a wall are met only from within */
    if (hit->distance > 0 && fibrad_walls_behind(ray->scene, hit->sphere, hit->normal, at) != FIBRAD_NONE)
        hit->sphere = FIBRAD_NONE;
}

/* The triangle that a ray from a point meets before its first sphere. */
static void meet_mesh_before(const fibrad_scene *scene, const double origin[3], const double w[3], uint32_t except,
                             fibrad_hit *hit) {
    const double length = hit->sphere != FIBRAD_NONE ? hit->distance : __builtin_inf();
    const fibrad_mesh_hit met = fibrad_mesh_first(&scene->mesh, origin, w, length, except);
    if (met.side == FIBRAD_NO_SIDE) return;
    hit->side = met.side, hit->distance = met.distance, hit->sphere = FIBRAD_NONE;
}

/* The same for a ray from a sphere. The ray ends at once if its origin lies beyond a triangle. */
static void meet_mesh_from(const fibrad_scene *scene, uint32_t place, const double n[3], const double w[3],
                           fibrad_hit *hit) {
    const double r = scene->r[place], centre[3] = {scene->x[place], scene->y[place], scene->z[place]};
    const double clear = scene->clear[place];
    if (clear < 1) {
        const fibrad_mesh_hit cut = fibrad_mesh_first(&scene->mesh, centre, n, r, FIBRAD_NO_SIDE);
        if (cut.side != FIBRAD_NO_SIDE) {
            hit->side = cut.side, hit->distance = 0, hit->sphere = FIBRAD_NONE;
            return;
        }
    }
    if (hit->sphere != FIBRAD_NONE && hit->distance < (clear - 1) * r) return;
    const double origin[3] = {centre[0] + r * n[0], centre[1] + r * n[1], centre[2] + r * n[2]};
    meet_mesh_before(scene, origin, w, FIBRAD_NO_SIDE, hit);
}

void LANED(fibrad_trace)(const fibrad_scene *scene, fibrad_tracer *tracer, uint32_t place, const double n[3],
                         const double w[3], fibrad_hit *hit) {
    const double unit = scene->r[place];
    const struct trace_ray ray = {scene, n,        w,    {scene->x[place], scene->y[place], scene->z[place]},
                                  unit,  1 / unit, place};
    struct trace_first first = {.distance = __builtin_inf()};
    double known = -1;
    if (tracer != NULL) {
        const fibrad_nearby *list = fibrad_tracer_nearby(tracer, place);
        const struct trace_cull cull = cull_of(n, w, 0, -list->behind);
        known = intersect_list(&ray, list, 1, &cull, &first);
    }
    /* spheres that overlap this one count also behind the origin, if their centres are ahead */
    if (!(first.distance < known)) walk_ray(&ray, known >= 0 ? known : -fibrad_dot(n, w), &first);
    write_hit(&ray, &first, hit);
    if (scene->clear != NULL) meet_mesh_from(scene, place, n, w, hit);
}

/* The largest power of two not above x. x is a normal number. */
static double power_of_two_below(double x) {
    uint64_t bits;
    fibrad_copy(&bits, &x, sizeof bits);
    bits &= UINT64_C(0x7ff) << 52;
    fibrad_copy(&x, &bits, sizeof x);
    return x;
}

/* Compares the spheres near the point where a ray begins. Returns the length up to which all spheres are compared. */
static double intersect_near(const struct trace_ray *ray, fibrad_tracer *tracer, struct trace_first *first) {
    double start[3], radius;
    const fibrad_nearby *list = fibrad_tracer_cell_of(tracer, ray->base, start, &radius);
    if (list == NULL) return 0;
    const struct trace_cull cull = cull_of(start, ray->w, 1 - fibrad_dot(start, start), -__builtin_inff());
    return fibrad_max(0, intersect_list(ray, list, radius * ray->inverse, &cull, first));
}

void LANED(fibrad_trace_point)(const fibrad_scene *scene, fibrad_tracer *tracer, const double point[3],
                               const double w[3], uint32_t except, fibrad_hit *hit) {
    static const double origin[3] = {0, 0, 0};
    hit->sphere = FIBRAD_NONE, hit->side = FIBRAD_NO_SIDE;
    if (scene->facts.spheres > 0) {
        /* a power of two causes no rounding, so that other spheres change no bit */
        const double unit = power_of_two_below(scene->spacing);
        const struct trace_ray ray = {scene, origin, w, {point[0], point[1], point[2]}, unit, 1 / unit, FIBRAD_NONE};
        struct trace_first first = {.distance = __builtin_inf()};
        const double known = tracer != NULL ? intersect_near(&ray, tracer, &first) : 0;
        if (!(first.distance < known)) walk_ray(&ray, known, &first);
        write_hit(&ray, &first, hit);
    }
    if (scene->clear != NULL) meet_mesh_before(scene, point, w, except, hit);
}
