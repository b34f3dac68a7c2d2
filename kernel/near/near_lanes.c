/* near_lanes.c - shells of spheres near the sphere of the row, and walks along one direction. Compiled once
 * per instruction set. SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "base/lanes/below.h"
#include "near/cull_lanes.h"
#include "near/near_lanes.h"
#include "scene/grid_walk.h"

/* Up to this length of a hull, in radii, floats tell what certainly reaches into it. */
#define BETWEEN_MOST 1e3

/* Computes the floats for culls of spheres [from, to) of the list. */
static void prepare_culls(fibrad_near *near, uint32_t from, uint32_t to) {
    const vd zero = vd_set1(0);
    for (uint32_t k = from; k < to; k += VD_LANES) {
        const vd x = vd_load(near->x + k), y = vd_load(near->y + k), z = vd_load(near->z + k), r = vd_load(near->r + k);
        const sphere_cull cull = cull_of_sphere(x, y, z, r);
        const vd wide = 1 + r, e = vd_sqrt(vd_max(cull.square - wide * wide, zero));
        vd_store_float(near->fx + k, cull.x);
        vd_store_float(near->fy + k, cull.y);
        vd_store_float(near->fz + k, cull.z);
        vd_store_float(near->fe + k, vd_select(cull.small, e - 1e-6 * cull.size, vd_set1(-1)));
        vd_store_float(near->fq + k, cull.q);
        vd_store_float(near->fsquare + k, r * r);
    }
}

/* Coordinates of the spheres of the current run, relative to the centre and in units of the radius. */
static inline vd relative_to_centre(const fibrad_workspace *work, const fibrad_walk *walk, int axis,
                                    const double *coordinate) {
    vd c = vd_loadu(coordinate) - work->centre[axis];
    return (c + walk->shift[axis]) * work->inverse;
}

/* Appends those spheres of a walk whose squared minimum depth lies in (from, to]. False: there is no room. */
static bool collect_near(fibrad_workspace *work, fibrad_walk *walk, double from, double to, uint32_t *count) {
    const fibrad_near near =
        work->near; /* copies, so that the compiler sees that stores do not change their pointers */
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
            vm other = vd_lt(zero, square) & vd_le(square, cutoff2); /* the sphere of the row itself is left out */
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
    near->full = shell == FIBRAD_SHELLS ||
                 (shell > 0 && to < work->free_path); /* few windows would meet a sphere of another shell */
    for (uint32_t l = 0; l < scene->levels && !near->full; l++) {
        double wide = 1 + scene->level[l].radius_max * work->inverse;
        double ball = fibrad_min(fibrad_sqrt(to * to + wide * wide), work->reach) * work->unit;
        fibrad_walk walk;
        fibrad_walk_about(&walk, scene, &scene->level[l], work->centre, work->centre, ball);
        near->full = !collect_near(work, &walk, shell > 0 ? from * from : -__builtin_inf(), to * to, &count);
    }
    if (near->full) return;
    for (; count % 16 != 0; count++) { /* the capacity is a multiple of 16 */
        near->x[count] = near->y[count] = near->z[count] = near->r[count] = 0;
        near->sphere[count] = 0;
    }
    prepare_culls(near, begin, count);
    for (uint32_t k = begin; k < count; k++) near->entry[k] = FIBRAD_NONE, near->count[k][0] = near->count[k][1] = 0;
    near->end[shell] = count;
    if (shell == 0) near->all.count = count;
    near->limit[shell] = to;
    near->shells++;
}

/* Lists the spheres of the first shell for an octant of directions. False: there is no room. A sphere with centre c
 * comes before no window of the octant if the greatest w.c of these directions is at most e. The greatest w.c is the
 * length of the components of c that point into the octant. e is lowered by more than the rounding errors. Where e
 * is below 0, nothing is known. The points that fill the shell up lie at 0 and have e = 0. */
static bool list_octant(const fibrad_near *of, uint32_t octant, fibrad_sight *sight) {
    const fibrad_near near = *of; /* copies, so that the compiler sees that stores do not change their pointers */
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
        vf_compress(to.square + n, bits, vf_load(near.fsquare + k));
        n += vf_compress_places(to.near + n, bits, (uint32_t)k);
    }
    for (; n % FIBRAD_LANES_MAX != 0; n++) to.x[n] = to.y[n] = to.z[n] = to.e[n] = to.square[n] = 0;
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

/* Compares spheres with the part of the hull about its axis that is as wide as the smaller sphere. Spheres whose
 * centres lie near a centre of the pair are passed over. They are the pair itself, spheres beyond the range of floats,
 * and those that fill a shell up: the last two kinds lie at 0. */
bool LANED(fibrad_near_between)(const fibrad_near *near, const double c[3], double r) {
    const double length = fibrad_sqrt(c[0] * c[0] + c[1] * c[1] + c[2] * c[2]), least = fibrad_min(1, r);
    const vf cx = vf_set1((float)c[0]), cy = vf_set1((float)c[1]), cz = vf_set1((float)c[2]), zero = vf_set1(0);
    const vf wx = vf_set1((float)(c[0] / length)), wy = vf_set1((float)(c[1] / length));
    const vf wz = vf_set1((float)(c[2] / length)), end = vf_set1((float)length);
    const vf wide = vf_set1((float)least), inside = vf_set1((float)(least * least / 4));
    if (near->shells == 0 || !(length < BETWEEN_MOST)) return false;
    for (uint32_t k = 0; k < near->end[near->shells - 1]; k += VF_LANES) {
        const vf x = vf_load(near->fx + k), y = vf_load(near->fy + k), z = vf_load(near->fz + k);
        const vf along = vf_max(zero, vf_min(end, wx * x + wy * y + wz * z));
        const vf px = x - along * wx, py = y - along * wy, pz = z - along * wz; /* from the axis */
        const vf dx = x - cx, dy = y - cy, dz = z - cz, reach = wide + vf_sqrt(vf_load(near->fsquare + k));
        const uint32_t other =
            vf_lt_bits(inside, x * x + y * y + z * z) & vf_lt_bits(inside, dx * dx + dy * dy + dz * dz);
        if ((vf_lt_bits(px * px + py * py + pz * pz, reach * reach * 0.999f) & other) != 0) return true;
    }
    return false;
}

/* Removes those discs from number `from` on that do not overlap the window or do not lie ahead. */
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
    const fibrad_near near =
        work->near; /* copies, so that the compiler sees that stores do not change their pointers */
    const fibrad_discs disc = work->disc;
    uint32_t from = disc.count, end = from + found;
    if (end > disc.capacity) {
        work->disc.count = end;
        return;
    }
    fibrad_zero(disc.near + end, VD_LANES * sizeof *disc.near); /* the last vector also reads these */
    uint32_t outside = 0;                                       /* outside the window, or not certainly ahead */
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

/* A walk collects rows, runs and spheres in lists before it looks at them. So lanes are full, and waits for memory
 * overlap. A row is the cells side by side along x that a beam meets. A run is the part of a row within one image of
 * the box. */
#define WALK_ROWS  (6 * VD_LANES)
#define WALK_RUNS  (6 * VD_LANES)
#define WALK_FOUND (8 * VD_LANES)

/* A walk along a beam, or along a ray, through the cells of one level. Coordinates are in units of cells. */
typedef struct beam_walk {
    _Alignas(64) double layer[WALK_ROWS]; /* cells */
    double row[WALK_ROWS], near[WALK_ROWS],
        far[WALK_ROWS]; /* cells, and the depths between which the beam meets them */
    double begin[WALK_RUNS], end[WALK_RUNS], shift[3][WALK_RUNS]; /* cells of the scene; shift by whole periods */
    uint32_t first_sphere[WALK_RUNS], end_sphere[WALK_RUNS];
    uint32_t sphere[WALK_FOUND], run[WALK_FOUND]; /* the spheres found, and the run of each */
    fibrad_workspace *work;
    const fibrad_level *level;
    const double *frame;
    const fibrad_tube *tube;
    double from, to; /* squared minimum depths: spheres in (from, to] are wanted */
    double slack;    /* allowance for rounding errors, in radii */
    double at[3], slope[3],
        per_slope[3];         /* place of the beam at depth 0, its advance per depth, and 1 over this advance */
    double side[3], depth[3]; /* half the width of the tube, the largest sphere included; the depth in which the beam
                                 advances by it */
    double first[3], last[3]; /* the outermost cells, which also contain stray spheres */
    double cells[3], per_cells[3];  /* number of cells of the box, and 1 over it */
    int layers_across, rows_across; /* axes */
    uint32_t rows, runs, found;
} beam_walk;

/* Coordinates of the spheres found, relative to the centre and in units of the radius. */
static inline vd found_coordinate(const beam_walk *m, uint32_t k, int axis, const double *coordinate) {
    vd c = vd_gather(coordinate, m->sphere + k) - m->work->centre[axis];
    return (c + vd_gather(m->shift[axis], m->run + k)) * m->work->inverse;
}

/* Appends the discs of the spheres found. Those at depth 0 may turn out not to lie ahead. */
static void append_found(beam_walk *m) {
    fibrad_workspace *work = m->work;
    const fibrad_scene scene =
        *work->scene; /* copies, so that the compiler sees that stores do not change their pointers */
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
        vm other = vd_lt(zero, square) & vd_le(square, cutoff2); /* the sphere of the row itself is left out */
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

/* Finds the spheres of the runs that may come before the beam: all spheres that do, and few others. */
static void look_at_runs(beam_walk *m) {
    const fibrad_workspace *work = m->work;
    const fibrad_scene *scene = work->scene;
    const double *frame = m->frame;
    uint32_t *begin = m->first_sphere, *end = m->end_sphere;
    for (uint32_t k = 0; k < m->runs; k++) {
        begin[k] = scene->start[(uint32_t)m->begin[k]], end[k] = scene->start[(uint32_t)m->end[k]];
        __builtin_prefetch(&scene->coarse[begin[k] / FIBRAD_COARSE]);
    }
    double origin[3], x[3], y[3];
    for (int axis = 0; axis < 3; axis++) {
        const double unit = scene->coarse_unit[axis] * work->inverse;
        origin[axis] = (scene->coarse_low[axis] - work->centre[axis]) * work->inverse;
        x[axis] = frame[axis] * unit, y[axis] = frame[3 + axis] * unit;
    }
    /* the place where coarse coordinates are 0, relative to the middle of the tube */
    const double u_at = frame[0] * origin[0] + frame[1] * origin[1] + frame[2] * origin[2] - m->tube->u;
    const double v_at = frame[3] * origin[0] + frame[4] * origin[1] + frame[5] * origin[2] - m->tube->v;
    _Alignas(64) double u0[WALK_RUNS], v0[WALK_RUNS]; /* the same for images */
    for (uint32_t k = 0; k < m->runs; k += VD_LANES) {
        vd sx = vd_loadu(m->shift[0] + k), sy = vd_loadu(m->shift[1] + k), sz = vd_loadu(m->shift[2] + k);
        vd_store(u0 + k, u_at + component(frame, sx, sy, sz) * work->inverse);
        vd_store(v0 + k, v_at + component(frame + 3, sx, sy, sz) * work->inverse);
    }
    const vd ux = vd_set1(x[0]), uy = vd_set1(x[1]), uz = vd_set1(x[2]), vx = vd_set1(y[0]), vy = vd_set1(y[1]);
    const vd vz = vd_set1(y[2]), stray = vd_set1(FIBRAD_COARSE_STRAY), tube = vd_set1(m->tube->radius + m->slack);
    const vd radius = vd_set1(scene->coarse_radius * work->inverse);
    for (uint32_t k = 0; k < m->runs; k++) {
        if (begin[k] == end[k]) continue;
        for (uint32_t j = begin[k] / VD_LANES * VD_LANES; j < end[k]; j += VD_LANES) {
            const uint16_t *coarse = scene->coarse[j / FIBRAD_COARSE].number + j % FIBRAD_COARSE;
            vd a = vd_load_short(coarse), b = vd_load_short(coarse + FIBRAD_COARSE);
            vd c = vd_load_short(coarse + 2 * FIBRAD_COARSE), r = vd_load_short(coarse + 3 * FIBRAD_COARSE);
            vd u = vd_set1(u0[k]) + (ux * a + uy * b + uz * c), v = vd_set1(v0[k]) + (vx * a + vy * b + vz * c);
            vd wide = tube + radius * r;
            uint32_t bits = vm_bits(vd_lt(u * u + v * v, wide * wide) | vd_le(stray, r));
            if (bits == 0) continue;
            bits &= vd_lanes_below(end[k] - j);
            if (j < begin[k]) bits &= ~vd_lanes_below(begin[k] - j);
            if (m->found + VD_LANES > WALK_FOUND) append_found(m);
            const uint32_t to = m->found + vd_compress_places(m->sphere + m->found, bits, j);
            while (m->found < to) m->run[m->found++] = k;
        }
    }
    append_found(m);
    m->runs = 0;
}

/* The largest whole number not above x, which must be well below 2^51. */
static inline vd whole(vd x) {
    vd nearest = (x + 0x1.8p52) - 0x1.8p52;
    return nearest - vd_select(vd_lt(x, nearest), vd_set1(1), vd_set1(0));
}

/* The number of periods between the box and the image that contains a cell. */
static inline vd periods_away(const beam_walk *m, int axis, vd cell) {
    return whole((cell + 0.5) * m->per_cells[axis]);
}

/* Narrows a range of depths to the depths in which the beam meets a cell of an axis. */
static inline void narrow_to_cell(const beam_walk *m, int axis, vd cell, vd *near, vd *far) {
    const vd inf = vd_set1(__builtin_inf());
    vd low = vd_select(vd_lt(vd_set1(m->first[axis]), cell), cell, 0 - inf);
    vd high = vd_select(vd_lt(cell, vd_set1(m->last[axis])), cell + 1, inf);
    low = (low - m->at[axis]) * m->per_slope[axis], high = (high - m->at[axis]) * m->per_slope[axis];
    *near = vd_max(*near, vd_min(low, high) - m->depth[axis]);
    *far = vd_min(*far, vd_max(low, high) + m->depth[axis]);
}

/* The first and the last cell of an axis that the beam meets in a range of depths. */
static inline void cells_met(const beam_walk *m, int axis, vd near, vd far, vd *low, vd *high) {
    const vd first = vd_set1(m->first[axis]), last = vd_set1(m->last[axis]);
    near *= m->slope[axis], far *= m->slope[axis];
    *low = whole(vd_max(first, vd_min(last, m->at[axis] - m->side[axis] + vd_min(near, far))));
    *high = whole(vd_max(first, vd_min(last, m->at[axis] + m->side[axis] + vd_max(near, far))));
}

/* Divides rows into runs. */
static void look_at_rows(beam_walk *m) {
    const int a = m->layers_across, b = m->rows_across;
    const double *period = m->work->scene->period, stride[3] = {1, m->cells[0], m->cells[0] * m->cells[1]};
    const vd zero = vd_set1(0), most = vd_set1(m->cells[0]);
    for (uint32_t k = 0; k < m->rows; k += VD_LANES) {
        vd layer = vd_load(m->layer + k), row = vd_load(m->row + k), near = vd_load(m->near + k);
        vd far = vd_load(m->far + k), low, high;
        narrow_to_cell(m, b, row, &near, &far);
        cells_met(m, 0, near, far, &low, &high);
        vd layer_away = periods_away(m, a, layer), row_away = periods_away(m, b, row);
        vd cell = (layer - layer_away * m->cells[a]) * stride[a] + (row - row_away * m->cells[b]) * stride[b];
        cell += m->level->first_cell;
        vd away = periods_away(m, 0, low), last = periods_away(m, 0, high);
        for (uint32_t bits = vm_bits(vd_le(near, far)) & vd_lanes_below(m->rows - k); bits != 0;) {
            if (m->runs + VD_LANES > WALK_RUNS) look_at_runs(m);
            vd begin = vd_max(zero, low - away * most), end = vd_min(most, high + 1 - away * most);
            vd_compress(m->begin + m->runs, bits, cell + begin);
            vd_compress(m->end + m->runs, bits, cell + end);
            vd_compress(m->shift[0] + m->runs, bits, away * period[0]);
            vd_compress(m->shift[a] + m->runs, bits, layer_away * period[a]);
            vd_compress(m->shift[b] + m->runs, bits, row_away * period[b]);
            m->runs += fibrad_count_bits(bits);
            bits &= vm_bits(vd_lt(away, last));
            away += 1;
        }
    }
    look_at_runs(m);
    m->rows = 0;
}

/* Prepares a walk for spheres of one level with minimum depths in (from, to]. Such spheres lie in a stretch of a
 * tube. The radius of the tube is 1 + r about the axis of a beam, and r about a ray. near, far: out: the depths of
 * the stretch. */
static void begin_beam_walk(beam_walk *m, double from, double to, double *near, double *far) {
    const fibrad_workspace *work = m->work;
    const fibrad_scene *scene = work->scene;
    const fibrad_level *level = m->level;
    const double *w = m->frame + 6, r = level->radius_max * work->inverse;
    m->layers_across = fibrad_abs(w[1]) > fibrad_abs(w[2]) ? 1 : 2, m->rows_across = 3 - m->layers_across;
    m->slack = 0;
    *near = fibrad_max(from, 0);
    const double aside = fibrad_sqrt(m->tube->u * m->tube->u + m->tube->v * m->tube->v);
    const double inner = fibrad_max(0, aside - m->tube->radius - r - 1e-6); /* no centre is nearer to the axis */
    *far = fibrad_min(fibrad_sqrt(to * to + (1 + r) * (1 + r) - inner * inner), fibrad_near_horizon(work, w));
    for (int axis = 0; axis < 3; axis++) {
        const double middle = m->tube->u * m->frame[axis] + m->tube->v * m->frame[3 + axis];
        const double radius = m->tube->radius + r, scale = work->unit * level->inverse[axis];
        const bool periodic = scene->period[axis] > 0;
        m->side[axis] = radius * fibrad_sqrt(fibrad_max(0, 1 - w[axis] * w[axis]));
        const double low = scene->box_low[axis] - (periodic ? 0 : level->radius_max);
        m->at[axis] = (work->centre[axis] + middle * work->unit - low) * level->inverse[axis];
        m->slope[axis] = w[axis] * scale;
        m->per_slope[axis] = 1 / (fibrad_abs(m->slope[axis]) > 1e-290 ? m->slope[axis] : 1e-290);
        m->first[axis] = periodic ? -1e9 : 0;
        m->last[axis] = periodic ? 1e9 : level->cells[axis] - 1;
        m->cells[axis] = level->cells[axis], m->per_cells[axis] = 1 / m->cells[axis];
        m->slack += fibrad_abs(work->centre[axis]) + fibrad_abs(low);
    }
    m->slack = 1e-12 + 1e-14 * (m->slack * work->inverse + *far);
    for (int axis = 0; axis < 3; axis++) {
        m->side[axis] = (m->side[axis] + m->slack) * (work->unit * level->inverse[axis]) + 1e-6;
        m->depth[axis] = m->side[axis] * fibrad_abs(m->per_slope[axis]);
    }
}

/* Goes through the cells layer by layer along y or z, whichever axis is nearer to the beam's direction. In each
 * layer it goes row by row. The cells of a row lie side by side in memory, along x, and are taken together. */
static void walk_level(beam_walk *m, double from, double to) {
    _Alignas(64) double near[VD_LANES], far[VD_LANES], low[VD_LANES], high[VD_LANES], number[VD_LANES];
    double begin, end;
    begin_beam_walk(m, from, to, &begin, &end);
    if (!(begin <= end)) return;
    for (int l = 0; l < VD_LANES; l++) number[l] = l;
    vd first, last;
    cells_met(m, m->layers_across, vd_set1(begin), vd_set1(end), &first, &last);
    vd_store(low, first);
    vd_store(high, last);
    const double most = high[0];
    for (double layer = low[0]; layer <= most; layer += VD_LANES) {
        vd layers = layer + vd_load(number), nearest = vd_set1(begin), farthest = vd_set1(end), least_row, last_row;
        narrow_to_cell(m, m->layers_across, layers, &nearest, &farthest);
        cells_met(m, m->rows_across, nearest, farthest, &least_row, &last_row);
        vd_store(near, nearest);
        vd_store(far, farthest);
        vd_store(low, least_row);
        vd_store(high, last_row);
        for (uint32_t l = 0; l < VD_LANES && layer + l <= most; l++) {
            if (!(near[l] <= far[l])) continue;
            for (double row = low[l]; row <= high[l]; row++) {
                if (m->rows == WALK_ROWS) look_at_rows(m);
                m->layer[m->rows] = layer + l, m->row[m->rows] = row;
                m->near[m->rows] = near[l], m->far[m->rows++] = far[l];
            }
        }
    }
    look_at_rows(m);
}

void LANED(fibrad_near_walk)(fibrad_workspace *work, const double frame[9], const fibrad_tube *tube, double from,
                             double to) {
    uint32_t first = work->disc.count, own = work->near.capacity;
    beam_walk m;
    fibrad_zero(&m, sizeof m); /* lanes beyond the end of a list are read too */
    m.work = work, m.frame = frame, m.tube = tube;
    m.from = from < 0 ? -__builtin_inf() : from * from, m.to = to * to;
    for (uint32_t l = 0; l < work->scene->levels; l++) {
        m.level = &work->scene->level[l];
        walk_level(&m, from, to);
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
