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

/* Cells side by side along x that a beam meets are a run. Runs and spheres are gathered before they are looked at, so
 * that waits for memory overlap. */
#define MARCH_RUNS  32
#define MARCH_FOUND 64

/* A march along a beam, or a ray of one, through the cells of one level, whose number along each axis is the unit of
 * its coordinates. */
typedef struct march {
    fibrad_workspace *work;
    const fibrad_level *level;
    const double *frame;
    const fibrad_tube *tube;
    double from, to;                      /* squared minimum depths of spheres looked for: (from, to] */
    double at[3], slope[3], per_slope[3]; /* the beam at depth 0, what it advances per depth, and 1/that */
    double side[3];                       /* half its width, and that of the largest sphere */
    int32_t first[3], last[3];            /* the outermost cells, in which are strays, too */
    double slack;                         /* for rounding, in radii */
    uint32_t runs, found;
    uint32_t begin[MARCH_RUNS], end[MARCH_RUNS]; /* of each run: cells, then spheres */
    double shift[3][MARCH_RUNS];                 /* by whole periods */
    uint32_t sphere[MARCH_FOUND + FIBRAD_LANES_MAX], run[MARCH_FOUND + FIBRAD_LANES_MAX];
} march;

/* Coordinates of found spheres, relative to the centre and in units of the radius. */
static inline vd found_coordinate(const march *m, uint32_t k, int axis, const double *coordinate) {
    vd c = vd_gather(coordinate, m->sphere + k) - m->work->centre[axis];
    return (c + vd_gather(m->shift[axis], m->run + k)) * m->work->inverse;
}

/* Appends the discs of the found spheres. Those at depth 0 may turn out not to lie ahead. */
static void append_found(march *m) {
    fibrad_workspace *work = m->work;
    const fibrad_scene scene = *work->scene; /* copies: what is stored cannot change their pointers */
    const fibrad_discs disc = work->disc;
    const double *frame = m->frame;
    const vd inverse = vd_set1(work->inverse), cutoff2 = vd_set1(work->reach * work->reach), zero = vd_set1(0);
    uint32_t *sphere = work->near.sphere + work->near.capacity, n = disc.count;
    for (uint32_t k = m->found; k % VD_LANES != 0; k++) m->sphere[k] = m->run[k] = 0;
    for (uint32_t k = 0; k < m->found; k += VD_LANES) {
        vd x = found_coordinate(m, k, 0, scene.x), y = found_coordinate(m, k, 1, scene.y);
        vd z = found_coordinate(m, k, 2, scene.z), r = vd_gather(scene.r, m->sphere + k) * inverse, wide = 1 + r;
        vd square = x * x + y * y + z * z;
        vd u = component(frame, x, y, z), v = component(frame + 3, x, y, z), depth = component(frame + 6, x, y, z);
        wide *= wide;
        vd e = square - wide;
        vm in_range = vd_lt(vd_set1(m->from), e) & vd_le(e, vd_set1(m->to));
        vm other = vd_lt(zero, square) & vd_le(square, cutoff2); /* than the sphere itself */
        vm ahead = vd_le(zero, depth) & vd_le(e, depth * depth * (1 + 1e-12));
        uint32_t bits = vm_bits(in_range & other & ahead & vd_lt(u * u + v * v, wide)) & vd_lanes_below(m->found - k);
        if (n <= disc.capacity) {
            vd_compress(disc.depth + n, bits, depth);
            vd_compress(disc.u + n, bits, u);
            vd_compress(disc.v + n, bits, v);
            vd_compress(disc.r + n, bits, r);
            for (uint32_t l = 0, to = n; l < VD_LANES; to += bits >> l & 1, l++) sphere[to] = m->sphere[k + l];
        }
        n += fibrad_count_bits(bits);
    }
    work->disc.count = n;
    m->found = 0;
}

/* Finds the spheres of a run that may come before the beam: all that do, and few others. */
static void cull_run(march *m, uint32_t run) {
    const fibrad_workspace *work = m->work;
    const fibrad_scene *scene = work->scene;
    double origin[3], x[3], y[3];
    for (int axis = 0; axis < 3; axis++) {
        const double unit = scene->coarse_unit[axis] * work->inverse;
        origin[axis] = (scene->coarse_low[axis] - work->centre[axis] + m->shift[axis][run]) * work->inverse;
        x[axis] = m->frame[axis] * unit, y[axis] = m->frame[3 + axis] * unit;
    }
    const double u0 = m->frame[0] * origin[0] + m->frame[1] * origin[1] + m->frame[2] * origin[2] - m->tube->u;
    const double v0 = m->frame[3] * origin[0] + m->frame[4] * origin[1] + m->frame[5] * origin[2] - m->tube->v;
    const double radius = scene->coarse_radius * work->inverse, tube = m->tube->radius + m->slack;
    const uint32_t begin = m->begin[run], end = m->end[run];
    for (uint32_t j = begin - begin % VD_LANES; j < end; j += VD_LANES) {
        const fibrad_coarse *coarse = &scene->coarse[j / FIBRAD_COARSE];
        const uint32_t at = j % FIBRAD_COARSE;
        vd a = vd_load_short(coarse->x + at), b = vd_load_short(coarse->y + at), c = vd_load_short(coarse->z + at);
        vd r = vd_load_short(coarse->r + at), wide = tube + r * radius;
        vd u = u0 + component(x, a, b, c), v = v0 + component(y, a, b, c);
        uint32_t bits = vm_bits(vd_lt(u * u + v * v, wide * wide) | vd_le(vd_set1(FIBRAD_COARSE_STRAY), r));
        bits &= vd_lanes_below(end - j);
        if (j < begin) bits &= ~vd_lanes_below(begin - j);
        if (bits == 0) continue;
        if (m->found + VD_LANES > MARCH_FOUND) append_found(m);
        const uint32_t to = m->found + vd_compress_places(m->sphere + m->found, bits, j);
        while (m->found < to) m->run[m->found++] = run;
    }
}

static void look_at_runs(march *m) {
    const fibrad_scene *scene = m->work->scene;
    for (uint32_t k = 0; k < m->runs; k++) {
        m->begin[k] = scene->start[m->begin[k]], m->end[k] = scene->start[m->end[k]];
        __builtin_prefetch(&scene->coarse[m->begin[k] / FIBRAD_COARSE]);
    }
    for (uint32_t k = 0; k < m->runs; k++) cull_run(m, k);
    append_found(m);
    m->runs = 0;
}

/* Adds the cells from `low` to `high` along x, as cells of the box, to the runs. */
static void add_runs(march *m, const int32_t cell[3], const double shift[3], int32_t low, int32_t high) {
    const fibrad_level *level = m->level;
    const uint32_t nx = (uint32_t)level->cells[0], ny = (uint32_t)level->cells[1];
    const uint32_t row = level->first_cell + nx * (ny * (uint32_t)cell[2] + (uint32_t)cell[1]);
    for (int32_t x = low, run; x <= high; x += run) {
        if (m->runs == MARCH_RUNS) look_at_runs(m);
        const uint32_t k = m->runs++;
        const int32_t begin = fibrad_grid_image(m->work->scene, level, 0, x, &m->shift[0][k]);
        run = level->cells[0] - begin; /* to the end of the box, or of the cells */
        if (run > high - x + 1) run = high - x + 1;
        m->begin[k] = row + (uint32_t)begin, m->end[k] = row + (uint32_t)(begin + run);
        m->shift[1][k] = shift[1], m->shift[2][k] = shift[2];
    }
}

typedef struct march_range {
    double near, far;
} march_range;

/* The part of a range of depths in which the beam meets a cell of an axis. */
static inline march_range depths_in_cell(const march *m, int axis, int32_t cell, march_range all) {
    const double inf = __builtin_inf(), side = m->side[axis] * fibrad_abs(m->per_slope[axis]);
    const double low = ((cell > m->first[axis] ? cell : -inf) - m->at[axis]) * m->per_slope[axis];
    const double high = ((cell < m->last[axis] ? cell + 1.0 : inf) - m->at[axis]) * m->per_slope[axis];
    return (march_range){fibrad_max(all.near, fibrad_min(low, high) - side),
                         fibrad_min(all.far, fibrad_max(low, high) + side)};
}

static inline int32_t march_cell(const march *m, int axis, double coordinate) {
    const double c = fibrad_max(m->first[axis], fibrad_min(coordinate, m->last[axis]));
    const int32_t cell = (int32_t)c;
    return cell - (c < cell);
}

/* The first and the last cell of an axis that the beam meets in a range of depths. */
static inline void cells_in_range(const march *m, int axis, march_range range, int32_t *low, int32_t *high) {
    const double near = range.near * m->slope[axis], far = range.far * m->slope[axis];
    *low = march_cell(m, axis, m->at[axis] + fibrad_min(near, far) - m->side[axis]);
    *high = march_cell(m, axis, m->at[axis] + fibrad_max(near, far) + m->side[axis]);
}

/* Spheres of one level, of minimum depth in (from, to], lie in a stretch of the tube of radius 1 + r about the beam, or
 * of radius r about a ray of it. Its cells are met layer by layer along y or z, whichever it is more nearly along; in
 * each row by row; in each all at once along x, in which they lie side by side in memory. */
static void march_level(march *m, double from, double to) {
    fibrad_workspace *work = m->work;
    const fibrad_scene *scene = work->scene;
    const fibrad_level *level = m->level;
    const double *w = m->frame + 6, r = level->radius_max * work->inverse, wide = m->tube->radius + r;
    march_range all = {fibrad_max(from, 0), fibrad_sqrt(to * to + (1 + r) * (1 + r))};
    m->slack = 0;
    for (int axis = 0; axis < 3; axis++) {
        const double middle = m->tube->u * m->frame[axis] + m->tube->v * m->frame[3 + axis];
        const double lateral = wide * fibrad_sqrt(fibrad_max(0, 1 - w[axis] * w[axis]));
        const bool periodic = scene->period[axis] > 0;
        if (!periodic && w[axis] != 0) { /* nothing beyond the box */
            const double stop =
                w[axis] > 0 ? scene->high[axis] - work->centre[axis] : scene->low[axis] - work->centre[axis];
            all.far = fibrad_min(all.far, (stop * work->inverse - middle) / w[axis] + lateral / fibrad_abs(w[axis]));
        }
        const double scale = work->unit * level->inverse[axis];
        const double low = scene->box_low[axis] - (periodic ? 0 : level->radius_max);
        m->at[axis] = (work->centre[axis] + middle * work->unit - low) * level->inverse[axis];
        m->slope[axis] = w[axis] * scale;
        m->per_slope[axis] = 1 / (fibrad_abs(m->slope[axis]) > 1e-290 ? m->slope[axis] : 1e-290);
        m->side[axis] = lateral * scale;
        m->first[axis] = periodic ? -1000000000 : 0;
        m->last[axis] = periodic ? 1000000000 : level->cells[axis] - 1;
        m->slack += fibrad_abs(work->centre[axis]) + fibrad_abs(low);
    }
    m->slack = 1e-12 + 1e-14 * (m->slack * work->inverse + all.far);
    for (int axis = 0; axis < 3; axis++) m->side[axis] += 1e-6 + m->slack * work->unit * level->inverse[axis];
    if (!(all.near <= all.far)) return;

    const int a = fibrad_abs(w[1]) > fibrad_abs(w[2]) ? 1 : 2, b = 3 - a;
    int32_t cell[3], low[3], high[3];
    double shift[3];
    cells_in_range(m, a, all, &low[a], &high[a]);
    for (int32_t layer = low[a]; layer <= high[a]; layer++) {
        const march_range in_layer = depths_in_cell(m, a, layer, all);
        if (!(in_layer.near <= in_layer.far)) continue;
        cell[a] = fibrad_grid_image(scene, level, a, layer, &shift[a]);
        cells_in_range(m, b, in_layer, &low[b], &high[b]);
        for (int32_t row = low[b]; row <= high[b]; row++) {
            const march_range in_row = depths_in_cell(m, b, row, in_layer);
            if (!(in_row.near <= in_row.far)) continue;
            cell[b] = fibrad_grid_image(scene, level, b, row, &shift[b]);
            cells_in_range(m, 0, in_row, &low[0], &high[0]);
            add_runs(m, cell, shift, low[0], high[0]);
        }
    }
    look_at_runs(m);
}

void LANED(fibrad_near_march)(fibrad_workspace *work, const double frame[9], const fibrad_tube *tube, double from,
                              double to) {
    uint32_t first = work->disc.count, own = work->near.capacity;
    march m;
    m.work = work, m.frame = frame, m.tube = tube, m.runs = m.found = 0;
    m.from = from < 0 ? -__builtin_inf() : from * from, m.to = to * to;
    for (uint32_t l = 0; l < work->scene->levels; l++) {
        m.level = &work->scene->level[l];
        march_level(&m, from, to);
    }
    if (work->disc.count > work->disc.capacity) return;
    bool ahead = true;
    for (uint32_t k = first; k < work->disc.count; k++) {
        work->disc.near[k] = own + k;
        work->near.entry[own + k] = FIBRAD_NONE;
        ahead = ahead && work->disc.depth[k] > 0;
    }
    if (!ahead) remove_not_ahead(work, first);
}
