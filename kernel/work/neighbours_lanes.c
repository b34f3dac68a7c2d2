/* neighbours_lanes.c - shells of spheres near that of the row, and marches along one direction. Compiled once per
 * instruction set. SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "base/lanes/below.h"
#include "work/neighbours_lanes.h"
#include "scene/grid_walk.h"

/* The floats of the culls, for spheres [from, to) of the list. A cull may pass a sphere that the exact test then
 * rejects, but not the other way round: the errors of three products and two sums are less than 4 ulp of the distance,
 * those of their squares less than 40 ulp of its square. Beyond the range of floats a cull passes all. */
static void prepare_culls(fibrad_near *near, uint32_t from, uint32_t to) {
    const vd one = vd_set1(1), zero = vd_set1(0);
    for (uint32_t k = from; k < to; k += VD_LANES) {
        vd x = vd_load(near->x + k), y = vd_load(near->y + k), z = vd_load(near->z + k), r = vd_load(near->r + k);
        vd square = x * x + y * y + z * z, wide = one + r;
        vd size = vd_abs(x) + vd_abs(y) + vd_abs(z); /* at least the distance */
        vd e = vd_sqrt(vd_max(square - wide * wide, zero)), about = one + size;
        vd q = square + one - r * r;
        vm small = vd_lt(size, vd_set1(1e18));
        vd_store_float(near->fx + k, vd_select(small, x, zero));
        vd_store_float(near->fy + k, vd_select(small, y, zero));
        vd_store_float(near->fz + k, vd_select(small, z, zero));
        vd_store_float(near->fe + k, vd_select(small, e - 1e-6 * size, vd_set1(-1)));
        q -= 4e-6 * (about * about);
        vd_store_float(near->fq + k, vd_select(small, q, vd_set1(-FLT_MAX)));
    }
}

/* Thickness of the layers of a march: thinner ones enclose the beam more closely, but there are more of them. */
#define LAYER_CELLS 1.5

/* Coordinates of spheres of the current run, relative to the centre and in units of the radius. */
static inline vd relative_to_centre(const fibrad_workspace *work, const fibrad_walk *walk, int axis,
                                    const double *coordinate) {
    vd c = vd_loadu(coordinate) - work->centre[axis];
    return (c + walk->shift[axis]) * work->inverse;
}

/* Appends those of the spheres on a walk whose squared minimum depth lies in (from, to]. False: no room. */
static bool collect_near(fibrad_workspace *work, fibrad_walk *walk, double from, double to, uint32_t *count) {
    const fibrad_near near = work->near; /* copies: what is stored cannot change their pointers */
    const fibrad_scene scene = *work->scene;
    const vd inverse = vd_set1(work->inverse), cutoff2 = vd_set1(work->reach * work->reach), zero = vd_set1(0);
    uint32_t n = *count;
    while (fibrad_walk_next(walk))
        for (uint32_t j = walk->begin; j < walk->end; j += VD_LANES) {
            vd x = relative_to_centre(work, walk, 0, scene.x + j), y = relative_to_centre(work, walk, 1, scene.y + j);
            vd z = relative_to_centre(work, walk, 2, scene.z + j);
            vd r = vd_loadu(scene.r + j) * inverse, wide = 1 + r;
            vd square = x * x + y * y + z * z;
            vd e = square - wide * wide;
            vm other = vd_lt(zero, square) & vd_le(square, cutoff2); /* than the sphere itself */
            vm in_range = vd_lt(vd_set1(from), e) & vd_le(e, vd_set1(to));
            uint32_t bits = vm_bits(in_range & other) & vd_lanes_below(walk->end - j);
            if (n + VD_LANES > near.capacity) return false;
            vd_compress(near.x + n, bits, x);
            vd_compress(near.y + n, bits, y);
            vd_compress(near.z + n, bits, z);
            vd_compress(near.r + n, bits, r);
            n += vd_compress_places(near.sphere + n, bits, j);
        }
    *count = n;
    return true;
}

void LANED(fibrad_near_extend)(fibrad_workspace *work) {
    const fibrad_scene *scene = work->scene;
    fibrad_near *near = &work->near;
    uint32_t shell = near->shells, begin = shell > 0 ? near->end[shell - 1] : 0, count = begin;
    double from = shell > 0 ? near->limit[shell - 1] : 0;
    double to = shell > 0 ? work->growth * from : work->step;
    near->full = shell == FIBRAD_SHELLS;
    for (uint32_t l = 0; l < scene->levels && !near->full; l++) {
        double wide = 1 + scene->level[l].radius_max * work->inverse;
        double ball = fibrad_min(fibrad_sqrt(to * to + wide * wide), work->reach) * work->unit, low[3], high[3];
        for (int axis = 0; axis < 3; axis++)
            low[axis] = work->centre[axis] - ball, high[axis] = work->centre[axis] + ball;
        fibrad_walk walk;
        fibrad_walk_begin(&walk, scene, &scene->level[l], low, high);
        near->full = !collect_near(work, &walk, shell > 0 ? from * from : -__builtin_inf(), to * to, &count);
    }
    if (near->full) return;
    for (; count % 16 != 0; count++) { /* the capacity is a multiple of 16 */
        near->x[count] = near->y[count] = near->z[count] = near->r[count] = 0;
        near->sphere[count] = 0;
    }
    prepare_culls(near, begin, count);
    for (uint32_t k = begin; k < count; k++) near->entry[k] = FIBRAD_NONE;
    near->end[shell] = count;
    if (shell == 0) near->all.count = count;
    near->limit[shell] = to;
    near->shells++;
}

/* Lists the first shell for an octant of directions; false: no room. Sphere c comes before none of its windows if the
 * most that w.c can be, the length of what c has along the octant's axes, is not more than e. e is lowered by more than
 * rounding; below 0 it may be anything. What fills the shell up is at 0 with e = 0. */
static bool list_octant(const fibrad_near *of, uint32_t octant, fibrad_sight *sight) {
    const fibrad_near near = *of; /* copies: what is stored cannot change their pointers */
    const fibrad_sight to = *sight;
    const vf sx = vf_set1(octant & 1 ? -1 : 1), sy = vf_set1(octant & 2 ? -1 : 1), sz = vf_set1(octant & 4 ? -1 : 1);
    const vf zero = vf_set1(0);
    size_t n = 0;
    for (size_t k = 0; k < near.end[0]; k += VF_LANES) {
        if (n + FIBRAD_LANES_MAX > near.sights) return false;
        const vf x = vf_load(near.fx + k), y = vf_load(near.fy + k), z = vf_load(near.fz + k);
        const vf e = vf_load(near.fe + k);
        const vf ax = vf_max(sx * x, zero), ay = vf_max(sy * y, zero), az = vf_max(sz * z, zero);
        const uint32_t bits = vf_lt_bits(e, zero) | vf_lt_bits(e * e, ax * ax + ay * ay + az * az);
        vf_compress(to.x + n, bits, x);
        vf_compress(to.y + n, bits, y);
        vf_compress(to.z + n, bits, z);
        vf_compress(to.e + n, bits, e);
        n += vf_compress_places(to.near + n, bits, (uint32_t)k);
    }
    for (; n % FIBRAD_LANES_MAX != 0; n++) to.x[n] = to.y[n] = to.z[n] = to.e[n] = 0;
    sight->count = (uint32_t)n;
    return true;
}

const fibrad_sight *LANED(fibrad_near_sight)(fibrad_near *near, const double w[3]) {
    const uint32_t octant = (w[0] < 0) + 2 * (uint32_t)(w[1] < 0) + 4 * (uint32_t)(w[2] < 0);
    if (near->seen[octant] == NULL) {
        fibrad_sight *sight = &near->octant[octant];
        near->seen[octant] = list_octant(near, octant, sight) ? sight : &near->all;
    }
    return near->seen[octant];
}

/* Removes the discs from number `from` on that do not overlap the window or do not lie ahead. */
static void remove_not_ahead(fibrad_workspace *work, uint32_t from) {
    const fibrad_discs disc = work->disc;
    uint32_t to = from, own = work->near.capacity;
    for (uint32_t k = from; k < disc.count; k++) {
        double depth = disc.depth[k], u = disc.u[k], v = disc.v[k], wide = 1 + disc.r[k];
        uint32_t near = disc.near[k];
        if (near >= own) work->near.sphere[own + to] = work->near.sphere[near], near = own + to;
        disc.depth[to] = depth, disc.u[to] = u, disc.v[to] = v, disc.r[to] = disc.r[k], disc.near[to] = near;
        to += u * u + v * v < wide * wide && fibrad_work_ahead(work, depth, u, v, fibrad_work_sphere(work, k));
    }
    work->disc.count = to;
}

static inline vd component(const double a[3], vd x, vd y, vd z) { return a[0] * x + a[1] * y + a[2] * z; }

void LANED(fibrad_near_discs)(fibrad_workspace *work, const double frame[9], uint32_t found) {
    const fibrad_near near = work->near; /* copies: what is stored cannot change their pointers */
    const fibrad_discs disc = work->disc;
    uint32_t from = disc.count, end = from + found;
    if (end > disc.capacity) {
        work->disc.count = end;
        return;
    }
    fibrad_zero(disc.near + end, VD_LANES * sizeof *disc.near); /* read, too, in the last vector */
    uint32_t outside = 0;                                       /* the window, or not certainly ahead */
    for (uint32_t k = from; k < end; k += VD_LANES) {
        const uint32_t *place = disc.near + k;
        vd x = vd_gather(near.x, place), y = vd_gather(near.y, place), z = vd_gather(near.z, place);
        vd u = component(frame, x, y, z), v = component(frame + 3, x, y, z), depth = component(frame + 6, x, y, z);
        vd r = vd_gather(near.r, place), wide = 1 + r;
        vm overlaps = vd_lt(u * u + v * v, wide * wide);
        vm ahead = vd_lt(vd_set1(0), depth);
        vd_storeu(disc.u + k, u);
        vd_storeu(disc.v + k, v);
        vd_storeu(disc.r + k, r);
        vd_storeu(disc.depth + k, depth);
        outside |= ~vm_bits(overlaps & ahead) & vd_lanes_below(end - k);
    }
    work->disc.count = end;
    if (outside != 0) remove_not_ahead(work, from);
}

/* A part of a march: spheres whose squared minimum depth lies in (from, to], and whose coordinate along an axis, in the
 * sense of the beam, in [edge, end). */
typedef struct march_layer {
    int along;
    double sense, edge, end, from, to;
} march_layer;

/* Appends the discs of the spheres on a walk. Those at depth 0 may turn out not to lie ahead. */
static void append_discs(fibrad_workspace *work, const double frame[9], fibrad_walk *walk, const march_layer *layer) {
    const fibrad_scene scene = *work->scene; /* copies: what is stored cannot change their pointers */
    const fibrad_discs disc = work->disc;
    const vd inverse = vd_set1(work->inverse), cutoff2 = vd_set1(work->reach * work->reach), zero = vd_set1(0);
    uint32_t *sphere = work->near.sphere + work->near.capacity, n = disc.count;
    while (fibrad_walk_next(walk))
        for (uint32_t j = walk->begin; j < walk->end; j += VD_LANES) {
            const vd c[3] = {relative_to_centre(work, walk, 0, scene.x + j),
                             relative_to_centre(work, walk, 1, scene.y + j),
                             relative_to_centre(work, walk, 2, scene.z + j)};
            vd r = vd_loadu(scene.r + j) * inverse, wide = 1 + r;
            vd square = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
            vd depth = component(frame + 6, c[0], c[1], c[2]), place = layer->sense * c[layer->along];
            wide *= wide;
            vd e = square - wide;
            vm in_layer = vd_le(vd_set1(layer->edge), place) & vd_lt(place, vd_set1(layer->end));
            vm in_range = vd_lt(vd_set1(layer->from), e) & vd_le(e, vd_set1(layer->to));
            vm other = vd_lt(zero, square) & vd_le(square, cutoff2); /* than the sphere itself */
            vm ahead = vd_le(zero, depth) & vd_le(e, depth * depth * (1 + 1e-12));
            uint32_t bits = vm_bits(in_layer & in_range & other & ahead);
            bits &= vd_lanes_below(walk->end - j);
            if (bits == 0) continue;
            vd u = component(frame, c[0], c[1], c[2]), v = component(frame + 3, c[0], c[1], c[2]);
            bits &= vm_bits(vd_lt(u * u + v * v, wide));
            if (n <= disc.capacity) {
                vd_compress(disc.depth + n, bits, depth);
                vd_compress(disc.u + n, bits, u);
                vd_compress(disc.v + n, bits, v);
                vd_compress(disc.r + n, bits, r);
                vd_compress_places(sphere + n, bits, j);
            }
            n += fibrad_count_bits(bits);
        }
    work->disc.count = n;
}

/* The distance from `edge`, a coordinate along an axis, to where the grid begins, or, beyond the grid, infinity: only
 * stray spheres are there. 0 within the grid and on a periodic axis. */
static double distance_to_grid(const fibrad_workspace *work, int axis, double sense, double edge) {
    const fibrad_scene *scene = work->scene;
    if (scene->period[axis] > 0) return 0;
    const double low = (scene->box_low[axis] - work->centre[axis]) * sense * work->inverse;
    const double high = (scene->box_high[axis] - work->centre[axis]) * sense * work->inverse;
    if (edge >= fibrad_max(low, high)) return __builtin_inf();
    return fibrad_max(0, fibrad_min(low, high) - edge);
}

/* The stretch of a tube about the line along w, in radii from the centre, and the axis across which it is cut. */
typedef struct march_stretch {
    const double *w;
    double middle[3], lateral[3]; /* the tube's cross-section: centre and half extents */
    double begin, end;            /* depths */
    int axis;                     /* the one that w is most nearly along */
    double slope, sense;          /* of w along it: size and sign */
} march_stretch;

static march_stretch stretch_of(const double frame[9], const fibrad_tube *tube, double radius, double from, double to) {
    march_stretch s = {.w = frame + 6, .begin = fibrad_max(from, 0)};
    s.end = fibrad_sqrt(to * to + (1 + radius) * (1 + radius));
    for (int axis = 0; axis < 3; axis++) {
        s.middle[axis] = tube->u * frame[axis] + tube->v * frame[3 + axis];
        s.lateral[axis] = (tube->radius + radius) * fibrad_sqrt(fibrad_max(0, 1 - s.w[axis] * s.w[axis]));
        if (fibrad_abs(s.w[axis]) > fibrad_abs(s.w[s.axis])) s.axis = axis;
    }
    s.slope = fibrad_abs(s.w[s.axis]), s.sense = s.w[s.axis] < 0 ? -1 : 1;
    return s;
}

/* The thickest layer: the stretch itself, or what passes one period of another axis; not less than a cell. */
static double thickest_layer(const fibrad_workspace *work, const fibrad_level *level, const march_stretch *s,
                             double length) {
    const double *period = work->scene->period;
    for (int axis = 0; axis < 3; axis++)
        if (axis != s->axis && period[axis] > 0 && s->w[axis] != 0)
            length = fibrad_min(length, period[axis] * work->inverse * fibrad_abs(s->w[s->axis] / s->w[axis]));
    return fibrad_max(length, level->cell[s->axis] * work->inverse);
}

/* The box [L] about the part of the stretch whose coordinate along the axis, in the sense of w, is in
 * [edge, edge + thick). */
static void box_of_layer(const fibrad_workspace *work, const march_stretch *s, double edge, double thick, double low[3],
                         double high[3]) {
    const int a = s->axis;
    const double height = edge - s->sense * s->middle[a], side = s->lateral[a];
    const double near_depth = fibrad_max((height - side) / s->slope, s->begin);
    const double far_depth = fibrad_min((height + thick + side) / s->slope, s->end);
    for (int axis = 0; axis < 3; axis++) {
        double p = near_depth * s->w[axis], q = far_depth * s->w[axis];
        low[axis] = s->middle[axis] + fibrad_min(p, q) - s->lateral[axis];
        high[axis] = s->middle[axis] + fibrad_max(p, q) + s->lateral[axis];
    }
    low[a] = s->sense > 0 ? edge : -edge - thick, high[a] = s->sense > 0 ? edge + thick : -edge;
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = work->centre[axis] + low[axis] * work->unit;
        high[axis] = work->centre[axis] + high[axis] * work->unit;
    }
}

/* Spheres of one level, of minimum depth in (from, to], lie in a stretch of the tube of radius 1 + r about the beam, or
 * of radius r about a ray of it. It is cut into layers across the axis the beam is most nearly along, so that the boxes
 * walked enclose the tube closely. Outside the grid layers grow, up to where the tube passes one period of another
 * axis. */
static void march_level(fibrad_workspace *work, const fibrad_level *level, const double frame[9],
                        const fibrad_tube *tube, double from, double to) {
    const fibrad_scene *scene = work->scene;
    const march_stretch s = stretch_of(frame, tube, level->radius_max * work->inverse, from, to);
    const int a = s.axis;
    const double side = s.lateral[a], sense = s.sense;
    double first = s.begin * s.slope - side + sense * s.middle[a], last = s.end * s.slope + side + sense * s.middle[a];
    const double stride = thickest_layer(work, level, &s, last - first);
    if (scene->period[a] == 0) { /* nothing beyond the box */
        double start = sense > 0 ? scene->low[a] - work->centre[a] : work->centre[a] - scene->high[a];
        double stop = sense > 0 ? scene->high[a] - work->centre[a] : work->centre[a] - scene->low[a];
        first = fibrad_max(first, start * work->inverse), last = fibrad_min(last, stop * work->inverse);
    }
    /* layers [edge, edge + thick) along that axis, in radii from the centre. They need not match the cells, and then a
     * sphere could be met twice: its own coordinate along the axis decides which layer it belongs to */
    const double least = fibrad_min(stride, LAYER_CELLS * level->cell[a] * work->inverse);
    double thick = least;
    for (double edge = first; edge <= last; edge += thick) {
        double clear = distance_to_grid(work, a, sense, edge), low[3], high[3];
        thick = clear > least ? fibrad_min(fibrad_min(2 * thick, stride), clear) : least;
        box_of_layer(work, &s, edge, thick, low, high);
        const march_layer layer = {a, sense, edge, edge + thick, from < 0 ? -__builtin_inf() : from * from, to * to};
        fibrad_walk walk;
        fibrad_walk_begin(&walk, scene, level, low, high);
        append_discs(work, frame, &walk, &layer);
    }
}

void LANED(fibrad_near_march)(fibrad_workspace *work, const double frame[9], const fibrad_tube *tube, double from,
                              double to) {
    uint32_t first = work->disc.count, own = work->near.capacity;
    for (uint32_t l = 0; l < work->scene->levels; l++) march_level(work, &work->scene->level[l], frame, tube, from, to);
    if (work->disc.count > work->disc.capacity) return;
    bool ahead = true;
    for (uint32_t k = first; k < work->disc.count; k++) {
        work->disc.near[k] = own + k;
        work->near.entry[own + k] = FIBRAD_NONE;
        ahead = ahead && work->disc.depth[k] > 0;
    }
    if (!ahead) remove_not_ahead(work, first);
}
