/* paths_lanes.c - traces paths. Compiled once per instruction set. SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "base/lanes/turn.h"
#include "exchange/paths.h"
#include "scene/walls.h"

/* Points of the unit sphere are made this many at a time. Most paths from a sphere take fewer. */
#define PATH_POINTS 4
/* Paths in a box are followed this many at a time. */
#define PATH_BATCH 8
/* A path is broken off after so many segments, in case no surface absorbs. The weight that is left counts as an error.
 */
#define PATH_SEGMENTS 32768u
/* Russian roulette: a path whose weight w is below this survives with probability w/ROULETTE_WEIGHT. Its weight is then
 * ROULETTE_WEIGHT. Of 0.05, 0.1, 0.2 and 0.4 this value gave the least error for a given number of rays, at
 * emissivities of 0.3 and 0.8. */
#define ROULETTE_WEIGHT 0.2
/* The same for paths that go on from known first segments, as a part of the weight with which they go on. All these
 * weights are equal. Of 0.2, 0.4, 0.5, 0.7 and 1 the values from 0.4 to 0.7 gave the least error. */
#define ROULETTE_PART 0.5
/* The first coordinates of a path are quasi-random: those of its start and of its first two directions. Six such
 * coordinates take a tenth to a fifth fewer rays than four. */
#define QUASI_COORDINATES FIBRAD_SOBOL_DIMENSIONS
/* Paths go on from known first segments in steps of this prime. So the first paths come from windows of all directions.
 */
#define SEGMENT_STRIDE UINT64_C(2654435761)
/* What a segment meets that begins inside another member of its clump. Nothing leaves there. */
#define INSIDE_CLUMP (FIBRAD_NONE - 1)

/* A path so far. */
struct grey_path {
    _Alignas(64) double even[3][PATH_BATCH]; /* points of the unit sphere */
    uint64_t k;
    uint32_t part;     /* of the four parts of an entry, to which this path belongs */
    fibrad_random own; /* numbers of this path alone */
    double weight;
    double least; /* Russian roulette: weights below this are raised to this */
    /* [L] from the centre of the sphere left first: centre of the present sphere; at a wall: origin of the scene */
    double centre[3];
    double n[3];           /* normal where the path is */
    uint32_t place;        /* position of the sphere; FIBRAD_NONE: the path is at a wall */
    double point[3];       /* [L] at a wall: where */
    uint32_t triangle;     /* at a mesh: on which; FIBRAD_NO_SIDE: at a plane or a cylinder */
    uint32_t used;         /* points of the unit sphere that are used up */
    const uint32_t *sobol; /* [8] the point of Sobol's sequence of a path from a wall */
};

/* Coordinate d of a path. The first QUASI_COORDINATES coordinates of paths from spheres are those of the additive
 * recurrence with the steps g^-1 ... g^-6, g^7 = g + 1, in units of 2^-64, as for the rays of row/cast_lanes.c. Those
 * of paths from walls are of Sobol's sequence. All further coordinates are random. */
static double path_coordinate(const fibrad_paths *paths, const struct grey_path *path, uint32_t d) {
    static const uint64_t step[QUASI_COORDINATES] = {UINT64_C(0xe60e2b722b53aeeb), UINT64_C(0xcebd76d9edb6a8ef),
                                                     UINT64_C(0xb9c9aa3a51d00b65), UINT64_C(0xa6f5777f6f88983f),
                                                     UINT64_C(0x9609c71eb7d03f7a), UINT64_C(0x86d516e50b04ab1b)};
    if (d >= QUASI_COORDINATES) return fibrad_fraction(fibrad_random_ahead(path->own, d));
    const uint64_t shift = fibrad_random_ahead(paths->stream, d);
    if (paths->place != FIBRAD_NONE) return fibrad_fraction(shift + path->k * step[d]);
    return fibrad_fraction(shift ^ (uint64_t)path->sobol[d] << 32); /* NOLINT: paths from walls have a point */
}

/* Points of the unit sphere from pairs of coordinates. */
static void make_even(double at[2][PATH_BATCH], double even[3][PATH_BATCH]) {
    const vd one = vd_set1(1);
    for (uint32_t b = 0; b < PATH_BATCH; b += VD_LANES) {
        vd height = vd_load(at[0] + b), cosine, sine;
        vd_turn(vd_load(at[1] + b), &cosine, &sine);
        vd ring = vd_sqrt(4 * height * (one - height));
        vd_store(even[0] + b, ring * cosine);
        vd_store(even[1] + b, ring * sine);
        vd_store(even[2] + b, one - (height + height));
    }
}

/* Makes the next PATH_POINTS points of the unit sphere. The first point of a path is where it starts. Each further
 * point belongs to a direction. */
static void make_sphere_points(const fibrad_paths *paths, struct grey_path *path) {
    _Alignas(64) double at[2][PATH_BATCH] = {{0}};
    for (uint32_t b = 0; b < PATH_POINTS; b++)
        for (uint32_t d = 0; d < 2; d++) at[d][b] = path_coordinate(paths, path, 2 * (path->used + b) + d);
    make_even(at, path->even);
}

static void next_sphere_point(const fibrad_paths *paths, struct grey_path *path, double at[3]) {
    uint32_t b = path->used % PATH_POINTS;
    if (b == 0) make_sphere_points(paths, path);
    path->used++;
    for (int axis = 0; axis < 3; axis++) at[axis] = path->even[axis][b];
}

/* A direction by the cosine law about the normal n. It is the direction of n + even, `even` being a random point of the
 * unit sphere. */
static void direction_about(const double n[3], const double even[3], double w[3]) {
    for (int axis = 0; axis < 3; axis++) w[axis] = n[axis] + even[axis];
    double square = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    if (square < 1e-24) {
        for (int axis = 0; axis < 3; axis++) w[axis] = n[axis];
        return;
    }
    double inverse = 1 / fibrad_sqrt(square);
    for (int axis = 0; axis < 3; axis++) w[axis] *= inverse;
}

static void draw_direction(const fibrad_paths *paths, struct grey_path *path, double w[3]) {
    double even[3];
    next_sphere_point(paths, path, even);
    direction_about(path->n, even, w);
}

/* The point of the scene [L] where a path is. centre: out: of the sphere on which the point lies; 0 at a wall. */
static void find_point(const fibrad_scene *scene, const struct grey_path *path, double centre[3], double point[3]) {
    const double *const of_axis[3] = {scene->x, scene->y, scene->z};
    for (int axis = 0; axis < 3; axis++) {
        centre[axis] = path->place != FIBRAD_NONE ? of_axis[axis][path->place] : 0;
        point[axis] =
            path->place != FIBRAD_NONE ? centre[axis] + scene->r[path->place] * path->n[axis] : path->point[axis];
    }
}

/* The point where a path is, relative to the centre of the sphere left first [L]. */
static void find_place(const fibrad_paths *paths, const struct grey_path *path, double at[3]) {
    const fibrad_scene *scene = paths->tracer->scene;
    for (int axis = 0; axis < 3; axis++)
        at[axis] = path->centre[axis] +
                   (path->place != FIBRAD_NONE ? scene->r[path->place] * path->n[axis] : path->point[axis]);
}

/* The same point in radii of that sphere. */
static void find_start(const fibrad_paths *paths, const struct grey_path *path, double start[3]) {
    find_place(paths, path, start);
    for (int axis = 0; axis < 3; axis++) start[axis] *= paths->inverse;
}

/* The length of a ray [L] up to the end of the cutoff's ball. Below 0: the ray begins outside the ball. */
static double ball_length(const fibrad_paths *paths, const struct grey_path *path, const double w[3]) {
    double start[3];
    find_start(paths, path, start);
    return fibrad_ball_exit(start, w, paths->cutoff) * paths->tracer->scene->r[paths->place];
}

/* Whether a ray stays within the cutoff up to a length. For most rays the triangle inequality
 * tells. */
static bool is_within(const fibrad_paths *paths, const struct grey_path *path, const double w[3], double length) {
    double start[3], rest = paths->cutoff - length * paths->inverse;
    if (!paths->cut) return true;
    find_start(paths, path, start);
    const double square = start[0] * start[0] + start[1] * start[1] + start[2] * start[2];
    return (rest > 0 && square < rest * rest * (1 - 1e-9)) || !(length > ball_length(paths, path, w));
}

/* Sets the hit to the triangle that a ray meets if there are no spheres. */
static void look_past(const fibrad_scene *scene, const struct grey_path *path, const double point[3], const double w[3],
                      fibrad_hit *hit) {
    const uint32_t except = path->place != FIBRAD_NONE ? FIBRAD_NO_SIDE : path->triangle;
    const fibrad_mesh_hit met = fibrad_mesh_first(&scene->mesh, point, w, __builtin_inf(), except);
    hit->side = met.side, hit->distance = met.distance;
}

/* Ends a segment at a wall, or at a side of a mesh. */
static void reach_wall(const fibrad_scene *scene, struct grey_path *path, uint32_t wall, uint32_t side,
                       const double at[3]) {
    double centre[3], point[3];
    find_point(scene, path, centre, point);
    for (int axis = 0; axis < 3; axis++) {
        path->centre[axis] -= centre[axis];
        path->point[axis] = at[axis];
        if (scene->period[axis] == 0) continue;
        /* back to the first period, so that the point does not depend on where the spheres are */
        double whole = scene->period[axis] * fibrad_floor(path->point[axis] / scene->period[axis]);
        path->point[axis] -= whole;
        path->centre[axis] += whole;
    }
    path->triangle = wall < FIBRAD_WALLS ? FIBRAD_NO_SIDE : fibrad_side_triangle(side);
    if (wall < FIBRAD_WALLS)
        fibrad_wall_normal(scene, wall, path->point, path->n);
    else
        fibrad_mesh_normal(&scene->mesh, side, path->n);
    path->place = FIBRAD_NONE;
}

/* Sets the hit to where a known first segment meets its sphere. */
static void meet_known(const fibrad_paths *paths, const fibrad_segment *segment, fibrad_hit *hit) {
    const fibrad_scene *scene = paths->tracer->scene;
    const double unit = scene->r[paths->place], r = scene->r[segment->sphere] * paths->inverse;
    const double *c = segment->centre, *w = segment->w, *n = segment->n, e[3] = {c[0] - n[0], c[1] - n[1], c[2] - n[2]};
    const double along = e[0] * w[0] + e[1] * w[1] + e[2] * w[2];
    const double across[3] = {e[0] - along * w[0], e[1] - along * w[1], e[2] - along * w[2]};
    const double square = r * r - (across[0] * across[0] + across[1] * across[1] + across[2] * across[2]);
    const double root = fibrad_sqrt(fibrad_max(0, square)), scale = 1 / r;
    *hit =
        (fibrad_hit){.side = FIBRAD_NO_SIDE, .sphere = segment->sphere, .distance = unit * fibrad_max(0, along - root)};
    for (int axis = 0; axis < 3; axis++) {
        hit->centre[axis] = unit * c[axis];
        hit->normal[axis] = -(across[axis] + root * w[axis]) * scale;
    }
}

/* Whether the segment tells the sphere that it meets, or that it meets none, so that no ray need be traced. */
static bool is_met_known(const fibrad_paths *paths, const fibrad_segment *segment) {
    const fibrad_scene *scene = paths->tracer->scene;
    if (segment == NULL || scene->clear != NULL) return false;
    if (scene->clump != NULL && scene->clump[paths->place] != 0) return false; /* it may begin inside a member */
    return segment->open || (segment->sphere != FIBRAD_NONE && !scene->cut[segment->sphere]);
}

/* Moves a path along w to what it meets. Returns FIBRAD_NONE for a sphere, and the slot for a wall or a mesh.
 * FIBRAD_ESCAPED, FIBRAD_BEYOND and INSIDE_CLUMP: the path ends. A side that belongs to no wall counts as beyond. A ray
 * is traced unless `known` tells what the path meets. */
static uint32_t trace_segment(fibrad_paths *paths, struct grey_path *path, const double w[3],
                              const fibrad_segment *known) {
    const fibrad_scene *scene = paths->tracer->scene;
    fibrad_hit hit = {.side = FIBRAD_NO_SIDE, .sphere = FIBRAD_NONE};
    double centre[3], point[3], distance;
    if (!is_met_known(paths, known)) known = NULL;
    paths->rays += known == NULL;
    find_point(scene, path, centre, point);
    if (path->place != FIBRAD_NONE) {
        const uint32_t behind = fibrad_walls_behind(scene, path->place, path->n, point);
        if (behind != FIBRAD_NONE) reach_wall(scene, path, behind, FIBRAD_NO_SIDE, point);
        if (behind != FIBRAD_NONE) return behind;
    }
    if (known != NULL) {
        if (!known->open) meet_known(paths, known, &hit);
    } else if (path->place != FIBRAD_NONE) {
        LANED(fibrad_trace)(scene, paths->tracer, path->place, path->n, w, &hit);
    } else {
        LANED(fibrad_trace_point)(scene, paths->tracer, path->point, w, path->triangle, &hit);
    }
    if (hit.sphere != FIBRAD_NONE && path->place != FIBRAD_NONE && hit.distance == 0 &&
        fibrad_one_clump(scene, path->place, hit.sphere))
        return INSIDE_CLUMP;
    if (hit.sphere != FIBRAD_NONE && is_within(paths, path, w, hit.distance)) {
        for (int axis = 0; axis < 3 && path->place == FIBRAD_NONE; axis++) path->centre[axis] += path->point[axis];
        for (int axis = 0; axis < 3; axis++) {
            path->centre[axis] += hit.centre[axis];
            path->n[axis] = hit.normal[axis];
        }
        path->place = hit.sphere;
        fibrad_tracer_expect(paths->tracer, path->place);
        return FIBRAD_NONE;
    }
    if (hit.sphere != FIBRAD_NONE && scene->clear != NULL) look_past(scene, path, point, w, &hit);
    const double ball = paths->cut ? ball_length(paths, path, w) : __builtin_inf();
    const uint32_t met = hit.side != FIBRAD_NO_SIDE
                             ? fibrad_surroundings_side(scene, point, w, ball, hit.side, hit.distance, &distance)
                             : fibrad_surroundings_met(scene, point, w, ball, &distance);
    if (met == FIBRAD_NONE) {
        paths->back = fibrad_side_number(&scene->mesh, hit.side);
        return FIBRAD_BEYOND;
    }
    if (met == FIBRAD_ESCAPED || met == FIBRAD_BEYOND) return met;
    for (int axis = 0; axis < 3; axis++) point[axis] += distance * w[axis];
    reach_wall(scene, path, met, met < FIBRAD_WALLS ? FIBRAD_NO_SIDE : hit.side, point);
    return met;
}

/* Takes from the path what the surface absorbs. Adds it to the sums if `counts`. wall: slot; FIBRAD_NONE: the surface
 * is a sphere. */
static void absorb_at_surface(fibrad_paths *paths, struct grey_path *path, uint32_t wall, bool counts) {
    const fibrad_scene *scene = paths->tracer->scene;
    double emissivity = 1;
    if (wall != FIBRAD_NONE)
        emissivity = paths->wall_emissivity[wall];
    else if (paths->emissivity != NULL)
        emissivity = paths->emissivity[scene->order[path->place]];
    double absorbed = path->weight * emissivity;
    path->weight -= absorbed;
    if (!counts || emissivity == 0) return; /* spheres that absorb nothing have no entry */
    if (wall != FIBRAD_NONE) {
        paths->wall[wall] += absorbed, paths->end[wall][path->part] += absorbed;
        return;
    }
    paths->absorbed += absorbed;
    if (paths->entries != NULL) {
        const uint32_t entry = fibrad_entries_of(paths->entries, path->place);
        fibrad_entries_add(paths->entries, entry, path->part, absorbed);
        return;
    }
    double *square = paths->square[path->k % FIBRAD_DISPLACEMENT_PARTS];
    for (int axis = 0; axis < 3; axis++) square[axis] += absorbed * (path->centre[axis] * path->centre[axis]);
}

/* Counts what the sphere where the path is has absorbed. The number may be anything if an emissivity is not valid. */
static void count_reflected(fibrad_paths *paths, const struct grey_path *path, double absorbed) {
    if (paths->reflected == NULL) return;
    const uint64_t units = (uint64_t)(0x1p40 * fibrad_min(fibrad_max(absorbed, 0), 1));
    paths->reflected[paths->tracer->scene->order[path->place]] += paths->undo ? 0 - units : units;
}

/* Starts a path at one of evenly spread points of the wall or mesh that paths leave. */
static void start_at_wall(const fibrad_paths *paths, struct grey_path *path) {
    const fibrad_scene *scene = paths->tracer->scene;
    const double share[2] = {path_coordinate(paths, path, 0), path_coordinate(paths, path, 1)};
    if (fibrad_slot_is_mesh(paths->from)) {
        const uint32_t side = fibrad_mesh_point(&scene->mesh, fibrad_slot_mesh(paths->from), share, path->point);
        fibrad_mesh_normal(&scene->mesh, side, path->n);
        path->triangle = fibrad_side_triangle(side);
        return;
    }
    fibrad_wall_even_point(scene, paths->from, share, path->point);
    fibrad_wall_normal(scene, paths->from, path->point, path->n);
}

/* The point from which a path leaves a sphere that conducts. Either the path was reflected and stays where it is. Or
 * the sphere has absorbed it, and gives off elsewhere what its node does not keep. */
static void leave_sphere(fibrad_paths *paths, struct grey_path *path, uint32_t segment) {
    const uint32_t i = paths->tracer->scene->order[path->place];
    const double surface = paths->surface[i], node = paths->emissivity[i], conductivity = paths->conductivity[i];
    const uint64_t first = UINT64_C(2) << 32 | (uint64_t)segment << 8;
    double even[3];
    if (!(surface >= node && surface <= 1 && conductivity >= FIBRAD_RELATIVE_CONDUCTIVITY_MIN)) {
        paths->absorbed = __builtin_nan("");
        return;
    }
    if (fibrad_fraction(fibrad_random_ahead(path->own, first)) * (1 - node) < 1 - surface) return;
    next_sphere_point(paths, path, even);
    fibrad_reemit_above(surface / (2 * conductivity), path->own, first + 1, even, path->n);
}

/* Follows a first segment. Writes where it arrives, and what the surface there reflects. */
static void follow_first_segment(fibrad_paths *paths, fibrad_segment *segment) {
    struct grey_path path = {.weight = segment->weight, .place = paths->place, .triangle = FIBRAD_NO_SIDE};
    fibrad_copy(path.n, segment->n, sizeof path.n);
    const uint32_t met = trace_segment(paths, &path, segment->w, segment);
    segment->weight = 0;
    if (met == FIBRAD_ESCAPED || met == FIBRAD_BEYOND || met == INSIDE_CLUMP) return;
    absorb_at_surface(paths, &path, met, false);
    fibrad_copy(segment->n, path.n, sizeof segment->n);
    fibrad_copy(segment->w, path.point, sizeof segment->w);
    fibrad_copy(segment->centre, path.centre, sizeof segment->centre);
    segment->weight = path.weight, segment->sphere = path.place, segment->triangle = path.triangle;
}

/* Chooses a segment for each path that begins with one, those of large weight several times and some of small weight
 * not at all. */
static void choose_segments(fibrad_segments *segments, double offset) {
    double all = 0, sum = 0;
    uint32_t at = 0, last = 0;
    for (uint32_t k = 0; k < segments->sources; k++) {
        all += segments->segment[k].weight;
        if (segments->segment[k].weight > 0) last = k;
    }
    if (!(all > 0)) segments->length = 0;
    segments->share = all / fibrad_max(1, segments->length);
    for (uint32_t k = 0; k < segments->length; k++) {
        while (at < last && sum + segments->segment[at].weight <= (k + offset) * segments->share)
            sum += segments->segment[at++].weight;
        segments->segment[k].chosen = at;
    }
}

void LANED(fibrad_paths_arrive)(fibrad_paths *paths) {
    for (uint32_t k = 0; k < paths->segments->sources; k++) follow_first_segment(paths, &paths->segments->segment[k]);
    choose_segments(paths->segments, fibrad_fraction(fibrad_random_ahead(paths->stream, QUASI_COORDINATES)));
}

/* Puts a path where the first segment arrived that was chosen for it. w: out: the direction in which it goes on. */
static void begin_at_segment(fibrad_paths *paths, struct grey_path *path, double w[3]) {
    const fibrad_segments *segments = paths->segments;
    path->k = path->k * SEGMENT_STRIDE % segments->length;
    const uint32_t chosen = segments->segment[path->k].chosen;
    const fibrad_segment *segment = &segments->segment[chosen];
    path->part = chosen % 4;
    path->weight = segments->share, path->least = ROULETTE_PART * segments->share;
    path->place = segment->sphere, path->triangle = segment->triangle;
    fibrad_copy(path->n, segment->n, sizeof path->n);
    fibrad_copy(path->point, segment->w, sizeof path->point);
    fibrad_copy(path->centre, segment->centre, sizeof path->centre);
    if (path->place != FIBRAD_NONE && paths->conductivity != NULL) leave_sphere(paths, path, 0);
    direction_about(path->n, segments->segment[path->k].even, w);
}

/* The end of a path whose weight has become small: it ends, or goes on with a larger weight. */
static bool survives(struct grey_path *path, uint32_t segment) {
    if (path->weight >= path->least) return true;
    const double draw = fibrad_fraction(fibrad_random_ahead(path->own, UINT64_C(1) << 32 | segment));
    if (draw * path->least >= path->weight) return false;
    path->weight = path->least;
    return true;
}

/* Counts a path that ends in the surroundings or beyond. */
static void leave_scene(fibrad_paths *paths, const struct grey_path *path, uint32_t met) {
    const bool escaped = met == FIBRAD_ESCAPED;
    *(escaped ? &paths->escaped : &paths->beyond) += path->weight;
    paths->end[FIBRAD_SLOTS + !escaped][path->part] += path->weight;
}

static void follow_path(fibrad_paths *paths, uint64_t k, const uint32_t sobol[8]) {
    struct grey_path path = {.k = k, .part = (uint32_t)(k % 4), .own = {fibrad_random_ahead(paths->stream, 8 + k)}};
    path.sobol = sobol, path.weight = 1, path.least = ROULETTE_WEIGHT, path.place = paths->place;
    path.triangle = FIBRAD_NO_SIDE;
    const uint32_t first = paths->segments != NULL && k < paths->segments->length;
    double w[3];
    if (first) {
        begin_at_segment(paths, &path, w);
    } else {
        next_sphere_point(paths, &path, path.n);
        if (path.place == FIBRAD_NONE) start_at_wall(paths, &path);
        draw_direction(paths, &path, w);
    }
    for (uint32_t segment = first; segment < PATH_SEGMENTS; segment++) {
        const bool counts = segment > 0 || paths->first;
        const uint32_t met = trace_segment(paths, &path, w, NULL);
        if (met == INSIDE_CLUMP) return;
        if (met == FIBRAD_ESCAPED || met == FIBRAD_BEYOND) {
            if (counts) leave_scene(paths, &path, met);
            return;
        }
        const double before = path.weight;
        absorb_at_surface(paths, &path, met, counts);
        if (segment > 0 && met == FIBRAD_NONE) count_reflected(paths, &path, before - path.weight);
        if (!survives(&path, segment)) return;
        if (met == FIBRAD_NONE && paths->conductivity != NULL) leave_sphere(paths, &path, segment);
        draw_direction(paths, &path, w);
    }
    paths->left += path.weight;
}

/* A walk arrives at a sphere. It is reflected there, or absorbed and given off at another point. */
static void scatter(fibrad_paths *paths, struct grey_path *path, uint32_t segment) {
    const uint32_t i = paths->tracer->scene->order[path->place];
    const double emissivity = paths->surface[i], conductivity = paths->conductivity[i];
    double draw[3], even[3];
    if (!(emissivity >= 0 && emissivity <= 1 && conductivity >= FIBRAD_RELATIVE_CONDUCTIVITY_MIN))
        paths->origins = __builtin_nan("");
    for (uint32_t d = 0; d < 3; d++)
        draw[d] = fibrad_fraction(fibrad_random_ahead(path->own, (UINT64_C(1) << 32) + 3 * segment + d));
    if (!(draw[2] < emissivity)) return;
    next_sphere_point(paths, path, even);
    fibrad_reemit(2 * conductivity / emissivity, draw, even, path->n);
}

/* Adds the products of flights that fibrad_paths_function tells. at[0] to at[steps]: the ends of the flights. */
static void correlate(fibrad_paths *paths, uint64_t k, double at[][3], uint32_t steps) {
    double *square = paths->square[k % FIBRAD_DISPLACEMENT_PARTS];
    const uint32_t n = paths->flights, origins = steps < n ? steps : n;
    paths->origins += origins;
    for (uint32_t step = 1; step <= origins; step++) {
        const uint32_t last = step + n < steps ? step + n : steps, before = step + n - 1 < steps ? step + n - 1 : steps;
        for (int axis = 0; axis < 3; axis++) {
            const double here = at[step][axis], length = here - at[step - 1][axis];
            square[axis] += length * (length + (at[last][axis] - here) + (at[before][axis] - here));
        }
    }
}

static void follow_walk(fibrad_paths *paths, uint64_t k) {
    struct grey_path path = {
        .k = k, .own = {fibrad_random_ahead(paths->stream, 8 + k)}, .place = paths->place, .triangle = FIBRAD_NO_SIDE};
    double at[2 * FIBRAD_FLIGHTS_MAX + 1][3], w[3];
    uint32_t steps = 0;
    next_sphere_point(paths, &path, path.n);
    find_place(paths, &path, at[0]);
    while (steps < 2 * paths->flights) {
        scatter(paths, &path, steps);
        draw_direction(paths, &path, w);
        if (trace_segment(paths, &path, w, NULL) != FIBRAD_NONE) {
            paths->lost++;
            break;
        }
        find_place(paths, &path, at[++steps]);
    }
    correlate(paths, k, at, steps);
}

/* Follows up to PATH_BATCH paths of one segment in a box, each to the wall that it would meet without spheres. */
static void follow_boxed(fibrad_paths *paths, uint32_t paths_left, uint32_t sobol[PATH_BATCH][8]) {
    const fibrad_scene *scene = paths->tracer->scene;
    _Alignas(64) double at[2][PATH_BATCH] = {{0}}, even[3][PATH_BATCH];
    struct grey_path path = {.place = FIBRAD_NONE};
    for (uint32_t b = 0; b < paths_left; b++) {
        path.sobol = sobol[b];
        for (uint32_t d = 0; d < 2; d++) at[d][b] = path_coordinate(paths, &path, 2 + d);
    }
    make_even(at, even);
    for (uint32_t b = 0; b < paths_left; b++) {
        const double point[3] = {even[0][b], even[1][b], even[2][b]};
        double w[3], distance;
        fibrad_hit hit;
        path.sobol = sobol[b];
        start_at_wall(paths, &path);
        direction_about(path.n, point, w);
        LANED(fibrad_trace_point)(scene, NULL, path.point, w, FIBRAD_NO_SIDE, &hit);
        paths->rays++;
        const uint32_t wall = fibrad_surroundings_met(scene, path.point, w, __builtin_inf(), &distance);
        if (hit.sphere == FIBRAD_NONE)
            paths->wall[wall]++;
        else
            paths->behind[wall]++;
    }
}

void LANED(fibrad_paths_follow)(fibrad_paths *paths, uint64_t begin, uint64_t end) {
    uint32_t point[8] = {0}, batch[PATH_BATCH][8] = {{0}}, at = 0;
    const uint32_t step = paths->boxed ? PATH_BATCH : 1;
    for (uint64_t k = begin; k < end; k += step) {
        const uint32_t count = end - k < step ? (uint32_t)(end - k) : step;
        for (uint32_t b = 0; b < count && paths->place == FIBRAD_NONE; b++) {
            fibrad_sobol_move(paths->sobol, at, (uint32_t)k + b, point);
            at = (uint32_t)k + b;
            fibrad_copy(batch[b], point, sizeof point);
        }
        if (paths->flights > 0)
            follow_walk(paths, k);
        else if (paths->boxed)
            follow_boxed(paths, count, batch);
        else
            follow_path(paths, k, batch[0]);
    }
}
