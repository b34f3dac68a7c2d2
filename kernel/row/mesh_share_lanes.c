/* mesh_share_lanes.c - what of a window triangles take from spheres and from the open. Compiled once per instruction
 * set. SPDX-License-Identifier: MIT
 *
 * Points of the window are resolved by depth: lines along its direction, each from where it leaves sphere i. What a
 * sphere loses is its visible area times the share of its points that triangles hide, so that areas stay exact where
 * nothing hides them. Lines that meet no sphere get directions of their own, as those among walls do, if what they meet
 * is far: docs/methods.md section 9. */
#include FIBRAD_LANES_HEADER
#include "base/constants.h"
#include "row/mesh_share_lanes.h"
#include "scene/walls.h"
#include "window/points_lanes.h"

#define MESH_POINTS 256u
#define MESH_SPREAD 1.8 /* radius of the disc of directions times root n, and how near edges need none: as of walls */
#define MESH_NEAR   1.3

/* The window as the tree sees it, in the frame of an image: lengths in radii of sphere i but for `centre`. */
typedef struct mesh_beam {
    const double *frame;
    double centre[3]; /* [L] of sphere i, from the image */
    double from, to;  /* depths that are looked at */
    double wide;      /* how fast it widens with depth */
    double grain;     /* lengths that may be rounding */
    double nearest;   /* about the least depth of triangles that come before the window, widened */
    bool spread, cut; /* whether lines have directions of their own; whether triangles may cut sphere i */
} mesh_beam;

/* A triangle in the frame of the window. */
typedef struct mesh_face {
    double u[3], v[3], z[3];
    uint32_t triangle, number;
} mesh_face;

static mesh_face face_of(const fibrad_workspace *work, const mesh_beam *beam, uint32_t t) {
    const double *f = beam->frame;
    mesh_face face = {.triangle = t, .number = work->scene->mesh.number[t]};
    for (int k = 0; k < 3; k++) {
        double c[3];
        for (int axis = 0; axis < 3; axis++)
            c[axis] = (work->scene->mesh.corner[t][k][axis] - beam->centre[axis]) * work->inverse;
        face.u[k] = f[0] * c[0] + f[1] * c[1] + f[2] * c[2];
        face.v[k] = f[3] * c[0] + f[4] * c[1] + f[5] * c[2];
        face.z[k] = f[6] * c[0] + f[7] * c[1] + f[8] * c[2];
    }
    return face;
}

/* Whether a face may come before the window. */
static bool face_before(const mesh_face *face, const mesh_beam *beam) {
    const double low = fibrad_min(face->z[0], fibrad_min(face->z[1], face->z[2]));
    const double high = fibrad_max(face->z[0], fibrad_max(face->z[1], face->z[2]));
    if (high < (beam->cut ? -1 : 0) || low > beam->to) return false;
    const double half = 1 + beam->wide * fibrad_max(0, high);
    for (int side = 0; side < 2; side++) {
        const double *x = side == 0 ? face->u : face->v;
        if (fibrad_min(x[0], fibrad_min(x[1], x[2])) > half || fibrad_max(x[0], fibrad_max(x[1], x[2])) < -half)
            return false;
    }
    return true;
}

/* Notes the lanes given by bits, whose keys are not above those so far. */
static void note_side(fibrad_workspace *work, const mesh_face *face, uint32_t p, uint32_t bits, uint32_t backs,
                      const double *key) {
    fibrad_met *met = work->met;
    for (; bits != 0; bits &= bits - 1) {
        const uint32_t lane = (uint32_t)__builtin_ctz(bits), at = p + lane, before = met->side[at];
        if (key[lane] == met->depth[at] && before != FIBRAD_NO_SIDE &&
            work->scene->mesh.number[before / 2] <= face->number)
            continue;
        met->depth[at] = key[lane];
        met->side[at] = 2 * face->triangle + (backs >> lane & 1);
    }
}

/* Lines of the window and a face. Of the depth, a grain more at backs, so that fronts come first at edges. */
FIBRAD_INLINE void meet_lines(fibrad_workspace *work, const mesh_beam *beam, const fibrad_points *points,
                              const mesh_face *face, bool spread) {
    fibrad_met *met = work->met;
    const vd zero = vd_set1(0), grain = vd_set1(beam->grain);
    for (uint32_t p = 0; p < points->count; p += VD_LANES) {
        const vd u = vd_load_float(points->set.x + p), v = vd_load_float(points->set.y + p), s = vd_load(met->exit + p);
        vd x[3], y[3];
        for (int k = 0; k < 3; k++) {
            x[k] = face->u[k] - u, y[k] = face->v[k] - v;
            if (!spread) continue;
            const vd ahead = face->z[k] - s;
            x[k] = x[k] - vd_load_float(met->aside[0] + p) * ahead;
            y[k] = y[k] - vd_load_float(met->aside[1] + p) * ahead;
        }
        const vd a = x[1] * y[2] - y[1] * x[2], b = x[2] * y[0] - y[2] * x[0], c = x[0] * y[1] - y[0] * x[1];
        const vm none = vd_lt(vd_min(a, vd_min(b, c)), zero), some = vd_lt(zero, vd_max(a, vd_max(b, c)));
        const vm all = vm_not(vd_lt(zero, vd_max(a, vd_max(b, c)))) & none; /* all <= 0, not all 0 */
        const vm inside = (some & vm_not(none)) | all;
        if (vm_bits(inside) == 0) continue;
        const vd sum = a + b + c, z = (a * face->z[0] + b * face->z[1] + c * face->z[2]) / sum;
        const vm back = vd_lt(zero, sum);
        const vd shift = vd_select(back, grain, zero - grain), key = z + vd_select(back, grain, zero);
        const uint32_t bits =
            vm_bits(inside & vd_lt(s + shift, z) & vd_le(key, vd_load(met->depth + p)) & vd_le(z, vd_set1(1e300)));
        if (bits == 0) continue;
        _Alignas(64) double keys[VD_LANES];
        vd_store(keys, key);
        note_side(work, face, p, bits, vm_bits(back), keys);
    }
}

/* Where the surface of sphere i lies beyond a face, as seen from its centre: there lines end at once, before all that
 * others meet, nearest first. */
static void cut_surface(fibrad_workspace *work, const fibrad_points *points, const mesh_face *face) {
    fibrad_met *met = work->met;
    const vd zero = vd_set1(0), one = vd_set1(1);
    double n[3][3], volume = 0; /* of the planes through the centre and each edge; six times that of the tetrahedron */
    for (int k = 0; k < 3; k++) {
        const int next = (k + 1) % 3, last = (k + 2) % 3;
        n[k][0] = face->v[next] * face->z[last] - face->z[next] * face->v[last];
        n[k][1] = face->z[next] * face->u[last] - face->u[next] * face->z[last];
        n[k][2] = face->u[next] * face->v[last] - face->v[next] * face->u[last];
    }
    volume = face->u[0] * n[0][0] + face->v[0] * n[0][1] + face->z[0] * n[0][2];
    for (uint32_t p = 0; p < points->count; p += VD_LANES) {
        const vd u = vd_load_float(points->set.x + p), v = vd_load_float(points->set.y + p), s = vd_load(met->exit + p);
        vd e[3];
        for (int k = 0; k < 3; k++) e[k] = n[k][0] * u + n[k][1] * v + n[k][2] * s;
        const vd least = vd_min(e[0], vd_min(e[1], e[2])), most = vd_max(e[0], vd_max(e[1], e[2]));
        const vm inside = (vd_lt(zero, most) & vd_le(zero, least)) | (vd_lt(least, zero) & vd_le(most, zero));
        const vd sum = e[0] + e[1] + e[2], share = volume / sum; /* of the way from the centre to the surface */
        const vd key = share - 2;
        const uint32_t bits = vm_bits(inside & vd_lt(zero, share) & vd_lt(share, one) &
                                      vd_le(key, vd_load(met->depth + p)) & vd_lt(s, vd_set1(2)));
        if (bits == 0) continue;
        _Alignas(64) double keys[VD_LANES];
        vd_store(keys, key);
        note_side(work, face, p, bits, vm_bits(vd_lt(zero, sum)), keys);
    }
}

/* How deep the middle of the window meets the plane of a face, as far as the face goes. */
static double depth_of_face(const mesh_face *face) {
    double n[3];
    const double *u = face->u, *v = face->v, *z = face->z;
    n[0] = (v[1] - v[0]) * (z[2] - z[0]) - (z[1] - z[0]) * (v[2] - v[0]);
    n[1] = (z[1] - z[0]) * (u[2] - u[0]) - (u[1] - u[0]) * (z[2] - z[0]);
    n[2] = (u[1] - u[0]) * (v[2] - v[0]) - (v[1] - v[0]) * (u[2] - u[0]);
    const double least = fibrad_max(0, fibrad_min(z[0], fibrad_min(z[1], z[2])));
    const double depth = n[2] != 0 ? (n[0] * u[0] + n[1] * v[0] + n[2] * z[0]) / n[2] : 0;
    return fibrad_max(least, fibrad_min(depth, fibrad_max(z[0], fibrad_max(z[1], z[2]))));
}

static void meet_face(fibrad_workspace *work, mesh_beam *beam, const fibrad_points *points, uint32_t t) {
    const mesh_face face = face_of(work, beam, t);
    if (!face_before(&face, beam)) return;
    if (beam->wide > 0 && !beam->spread) beam->nearest = fibrad_min(beam->nearest, depth_of_face(&face));
    if (beam->spread)
        meet_lines(work, beam, points, &face, true);
    else
        meet_lines(work, beam, points, &face, false);
    if (beam->cut && fibrad_min(face.z[0], fibrad_min(face.z[1], face.z[2])) < 1) cut_surface(work, points, &face);
}

/* Whether a box may come before the window; bounds that are infinite make it so. */
static bool box_before(const fibrad_mesh_node *node, const mesh_beam *beam, const double middle[3], double inverse) {
    double at[3], half[3], along[3], extent[3];
    for (int axis = 0; axis < 3; axis++) {
        at[axis] = (0.5 * node->low[axis] + 0.5 * node->high[axis] - middle[axis]) * inverse;
        half[axis] = (0.5 * node->high[axis] - 0.5 * node->low[axis]) * inverse;
    }
    for (int k = 0; k < 3; k++) {
        const double *f = beam->frame + 3 * k;
        along[k] = f[0] * at[0] + f[1] * at[1] + f[2] * at[2];
        extent[k] = fibrad_abs(f[0]) * half[0] + fibrad_abs(f[1]) * half[1] + fibrad_abs(f[2]) * half[2];
    }
    if (along[2] + extent[2] < beam->from || along[2] - extent[2] > beam->to) return false;
    const double wide = 1 + beam->wide * fibrad_max(0, along[2] + extent[2]);
    return !(fibrad_abs(along[0]) - extent[0] > wide || fibrad_abs(along[1]) - extent[1] > wide);
}

static void meet_tree(fibrad_workspace *work, mesh_beam *beam, const fibrad_points *points) {
    const fibrad_mesh *mesh = &work->scene->mesh;
    double middle[3];
    for (int axis = 0; axis < 3; axis++) middle[axis] = beam->centre[axis] - mesh->middle[axis];
    for (uint32_t k = 0; k < mesh->nodes;) {
        const fibrad_mesh_node *node = &mesh->node[k];
        if (!box_before(node, beam, middle, work->inverse)) {
            k = node->skip;
            continue;
        }
        const uint32_t begin = node->leaf / 8, end = begin + node->leaf % 8;
        for (uint32_t t = begin; t < end; t++) meet_face(work, beam, points, t);
        k++;
    }
}

/* All triangles down to a depth, along periodic axes a period at a time. */
static void meet_mesh(fibrad_workspace *work, mesh_beam *beam, const fibrad_points *points, double deepest) {
    const fibrad_mesh *mesh = &work->scene->mesh;
    double stretch = deepest + 1, from = -1;
    for (int axis = 0; axis < 3; axis++) {
        const double period = mesh->period[axis] * work->inverse, w = fibrad_abs(beam->frame[6 + axis]);
        const double ahead =
            beam->frame[6 + axis] > 0 ? mesh->high[axis] - work->centre[axis] : work->centre[axis] - mesh->low[axis];
        if (!(period > 0)) { /* the window leaves the box about all triangles */
            if (w > beam->wide)
                deepest = fibrad_min(deepest, 1.0001 * (fibrad_max(0, ahead) * work->inverse + 1) / (w - beam->wide));
            continue;
        }
        stretch = fibrad_min(stretch, fibrad_max(2, period));
        if (w > 0) deepest = fibrad_min(deepest, FIBRAD_PERIODS * period / w);
    }
    for (bool more = true; more; from = beam->to) {
        double low[3], high[3];
        beam->from = from, beam->to = fibrad_min(from + stretch, deepest);
        const double side = 1 + beam->wide * fibrad_max(0, beam->to);
        for (int axis = 0; axis < 3; axis++) {
            const double w = beam->frame[6 + axis], a = w == 0 ? 0 : from * w, b = w == 0 ? 0 : beam->to * w;
            low[axis] = work->centre[axis] + (fibrad_min(a, b) - side) * work->unit;
            high[axis] = work->centre[axis] + (fibrad_max(a, b) + side) * work->unit;
        }
        const fibrad_mesh_images images = fibrad_mesh_images_in(mesh, low, high);
        for (int32_t z = images.first[2]; z <= images.last[2]; z++)
            for (int32_t y = images.first[1]; y <= images.last[1]; y++)
                for (int32_t x = images.first[0]; x <= images.last[0]; x++) {
                    beam->centre[0] = work->centre[0] - x * mesh->period[0];
                    beam->centre[1] = work->centre[1] - y * mesh->period[1];
                    beam->centre[2] = work->centre[2] - z * mesh->period[2];
                    meet_tree(work, beam, points);
                }
        more = beam->to < deepest && beam->to > from;
    }
}

/* The line of a point [L]. */
static void line_of_point(const fibrad_workspace *work, const double frame[9], const fibrad_points *points, uint32_t p,
                          double origin[3], double w[3]) {
    const fibrad_met *met = work->met;
    const double u = points->set.x[p], v = points->set.y[p], s = fibrad_sqrt(fibrad_max(0, 1 - u * u - v * v));
    for (int axis = 0; axis < 3; axis++) {
        const double *f = frame + axis;
        origin[axis] = work->centre[axis] + work->unit * (u * f[0] + v * f[3] + s * f[6]);
        w[axis] = f[6];
        if (met->spread) w[axis] += met->aside[0][p] * f[0] + met->aside[1][p] * f[3];
    }
}

/* Whether a point that meets no sphere meets its triangle before any wall. */
static bool before_walls(const fibrad_workspace *work, const double frame[9], const fibrad_points *points, uint32_t p) {
    const fibrad_met *met = work->met;
    double origin[3], w[3], distance;
    if (!work->scene->container.walls || met->depth[p] < -1) return true;
    line_of_point(work, frame, points, p, origin, w);
    fibrad_walls_exit(work->scene, origin, w, &distance);
    return (met->depth[p] - met->exit[p]) * work->unit < distance;
}

/* Of the points given by bits, in word `word`, those that meet a triangle before sphere `disc`; others forget it. */
static uint64_t before_disc(fibrad_workspace *work, const fibrad_points *points, uint32_t word, uint64_t bits,
                            uint32_t disc) {
    fibrad_met *met = work->met;
    const fibrad_discs *d = &work->disc;
    const double depth = d->depth[disc] < 0 ? d->resolved[disc] : d->depth[disc], r = d->r[disc];
    uint64_t taken = 0;
    for (uint64_t rest = bits; rest != 0; rest &= rest - 1) {
        const uint32_t p = 64 * word + (uint32_t)__builtin_ctzll(rest);
        if (met->side[p] == FIBRAD_NO_SIDE) continue;
        const double x = points->set.x[p] - d->u[disc], y = points->set.y[p] - d->v[disc];
        if (met->depth[p] < depth - fibrad_sqrt(fibrad_max(0, r * r - x * x - y * y)))
            taken |= UINT64_C(1) << p % 64;
        else
            met->side[p] = FIBRAD_NO_SIDE;
    }
    return taken;
}

static void set_weights(fibrad_met *met, const uint64_t taken[4], double weight) {
    for (uint32_t word = 0; word < 4; word++)
        for (uint64_t rest = taken[word]; rest != 0; rest &= rest - 1)
            met->weight[64 * word + (uint32_t)__builtin_ctzll(rest)] = weight;
}

/* What triangles take from one disc, of visible area `area`; 0: by points. Points of it are no longer seen. */
static void share_disc(fibrad_workspace *work, fibrad_points *points, uint32_t disc, uint32_t k, double area) {
    uint64_t taken[4] = {0};
    uint32_t own = 0, lost = 0;
    for (uint32_t word = 0; word < points->count / 64; word++) {
        const uint64_t bits = points->seen[word] & LANED(fibrad_points_within)(points, word, work->disc.u[disc],
                                                                               work->disc.v[disc], work->disc.r[disc]);
        points->seen[word] &= ~bits;
        taken[word] = before_disc(work, points, word, bits, disc);
        own += fibrad_count_bits(bits), lost += fibrad_count_bits(taken[word]);
    }
    if (area > 0) {
        set_weights(work->met, taken, own > 0 ? area / own : 0);
        if (lost < own || own == 0) fibrad_work_accumulate(work, disc, k, lost > 0 ? area / own * (own - lost) : area);
    } else if (lost > 0) {
        set_weights(work->met, taken, 1);
        fibrad_work_accumulate(work, disc, k, -(double)lost);
    }
}

/* How wide the directions of open lines spread, if the nearest of what they meet is at some depth. */
static double spread_at(double depth, uint32_t n) {
    const double wide = MESH_SPREAD / fibrad_sqrt(n), ratio = MESH_NEAR / fibrad_max(depth * wide, 1e-300);
    return ratio < 1 && depth < __builtin_inf() ? wide * fibrad_sqrt(1 - ratio * ratio) : 0;
}

/* Gives open lines directions of their own, and looks what these meet. */
static void spread_lines(fibrad_workspace *work, mesh_beam *beam, const fibrad_points *points, uint32_t k,
                         double spread) {
    fibrad_met *met = work->met;
    for (uint32_t p = 0; p < points->count; p++) {
        const uint32_t q = fibrad_points_partner(points->count, p, k);
        met->aside[0][p] = (float)(points->set.x[q] * spread), met->aside[1][p] = (float)(points->set.y[q] * spread);
        if ((points->seen[p / 64] >> p % 64 & 1) != 0)
            met->depth[p] = __builtin_inf(), met->side[p] = FIBRAD_NO_SIDE;
        else
            met->exit[p] = __builtin_inf(); /* decided */
    }
    met->spread = beam->spread = true;
    beam->wide = 1.0001 * spread;
    meet_mesh(work, beam, points, __builtin_inf());
    for (uint32_t p = 0; p < points->count; p++) {
        const double u = points->set.x[p], v = points->set.y[p];
        met->exit[p] = fibrad_sqrt(fibrad_max(0, 1 - u * u - v * v));
    }
}

/* What triangles take of the open, `open` of it. */
static double share_open(fibrad_workspace *work, mesh_beam *beam, fibrad_points *points, uint32_t k, uint32_t n,
                         double open) {
    fibrad_met *met = work->met;
    uint64_t taken[4] = {0};
    uint32_t own = 0, lost = 0;
    const double spread = spread_at(beam->nearest, n);
    if (spread > 0) spread_lines(work, beam, points, k, spread);
    for (uint32_t p = 0; p < points->count; p++) {
        if ((points->seen[p / 64] >> p % 64 & 1) == 0) continue;
        own++;
        if (met->side[p] == FIBRAD_NO_SIDE) continue;
        if (before_walls(work, beam->frame, points, p))
            taken[p / 64] |= UINT64_C(1) << p % 64, lost++;
        else
            met->side[p] = FIBRAD_NO_SIDE;
    }
    if (own == 0) { /* too little for points: where the deepest line ends */
        const uint32_t slot =
            met->deepest != FIBRAD_NO_SIDE ? fibrad_scene_slot(work->scene, met->deepest) : FIBRAD_NONE;
        if (slot == FIBRAD_NONE) return open;
        const uint32_t entry = fibrad_entries_of(&work->entries, work->scene->facts.spheres + slot);
        fibrad_entries_add(&work->entries, entry, k, open);
        return 0;
    }
    for (uint32_t word = 0; word < 4; word++) points->seen[word] &= ~taken[word];
    points->open = own - lost;
    set_weights(met, taken, open / own);
    return lost < own ? open / own * (own - lost) : 0;
}

/* The depth of the last disc that is seen; infinity if something is open. */
static double deepest_of(const fibrad_workspace *work, const fibrad_points *points, double open) {
    const fibrad_discs *d = &work->disc;
    double deepest = 0;
    if (open > 0) return __builtin_inf();
    for (uint32_t c = 1; points->count == 0 && c < work->areas.circles; c++) {
        const uint32_t disc = work->areas.whose[c];
        if (work->areas.area[c] > 0)
            deepest = fibrad_max(deepest, d->depth[disc] < 0 ? d->resolved[disc] : d->depth[disc]);
    }
    for (uint32_t c = 0; points->count > 0 && c < points->occluders; c++) {
        const uint32_t disc = points->occluder[c];
        deepest = fibrad_max(deepest, d->depth[disc] < 0 ? d->resolved[disc] : d->depth[disc]);
    }
    return deepest;
}

/* The side that the deepest of all lines meets. */
static void note_deepest(fibrad_met *met, uint32_t count) {
    double deepest = -__builtin_inf();
    met->deepest = FIBRAD_NO_SIDE;
    for (uint32_t p = 0; p < count; p++)
        if (met->side[p] != FIBRAD_NO_SIDE && met->depth[p] > deepest)
            deepest = met->depth[p], met->deepest = met->side[p];
}

double LANED(fibrad_mesh_share)(fibrad_workspace *work, const double frame[9], fibrad_points *points, uint32_t k,
                                double open) {
    fibrad_met *met = work->met;
    const bool by_areas = points->count == 0;
    fibrad_points *used = by_areas ? &met->points : points;
    const uint32_t n = work->windows;
    const double deepest = deepest_of(work, points, open);
    mesh_beam beam = {.frame = frame,
                      .cut = work->clear_mesh < 1,
                      .nearest = __builtin_inf(),
                      .grain = work->scene->mesh.grain * work->inverse};
    if (open > 0) beam.wide = 1.0001 * MESH_SPREAD / fibrad_sqrt(n);
    met->spread = false;
    met->any = fibrad_mesh_near(work, deepest);
    if (!met->any) return open;
    met->points.count = by_areas ? MESH_POINTS : points->count;
    (void)fibrad_disc_points_get(met->points.count, &met->points.set);
    for (uint32_t p = 0; p < used->count; p++) {
        const double u = used->set.x[p], v = used->set.y[p];
        met->exit[p] = fibrad_sqrt(fibrad_max(0, 1 - u * u - v * v));
        met->depth[p] = __builtin_inf(), met->side[p] = FIBRAD_NO_SIDE;
    }
    meet_mesh(work, &beam, used, deepest);
    note_deepest(met, used->count);
    met->any = met->deepest != FIBRAD_NO_SIDE || (open > 0 && spread_at(beam.nearest, n) > 0);
    if (!met->any) return open;
    for (uint32_t word = 0; word < used->count / 64; word++) used->seen[word] = UINT64_MAX;
    for (uint32_t c = 1; by_areas && c < work->areas.circles; c++)
        if (work->areas.area[c] > 0) share_disc(work, used, work->areas.whose[c], k, work->areas.area[c]);
    for (uint32_t c = 0; !by_areas && c < used->occluders; c++) share_disc(work, used, used->occluder[c], k, 0);
    if (open > 0) return share_open(work, &beam, used, k, n, open);
    for (uint32_t p = 0; p < used->count; p++) /* points of areas that no disc holds, by rounding */
        if ((used->seen[p / 64] >> p % 64 & 1) != 0) met->side[p] = FIBRAD_NO_SIDE;
    return 0;
}

void LANED(fibrad_mesh_line)(const fibrad_workspace *work, const double frame[9], uint32_t p, double origin[3],
                             double w[3]) {
    line_of_point(work, frame, &work->met->points, p, origin, w);
}

void LANED(fibrad_mesh_place)(const fibrad_workspace *work, const double frame[9], uint32_t p, double at[3]) {
    const fibrad_met *met = work->met;
    const bool cut = met->depth[p] < -1; /* on the way from the centre to the surface */
    double origin[3], w[3];
    line_of_point(work, frame, &met->points, p, origin, w);
    for (int axis = 0; axis < 3; axis++) {
        const double centre = work->centre[axis];
        at[axis] = cut ? centre + (met->depth[p] + 2) * (origin[axis] - centre)
                       : origin[axis] + (met->depth[p] - met->exit[p]) * work->unit * w[axis];
    }
}

/* Whether a line ends, by cutoff or known region, before it meets its triangle. */
static bool beyond_known(const fibrad_workspace *work, const double frame[9], uint32_t p) {
    const fibrad_met *met = work->met;
    double origin[3], w[3], from[3];
    if (!work->cut || met->depth[p] < -1) return false;
    line_of_point(work, frame, &met->points, p, origin, w);
    for (int axis = 0; axis < 3; axis++) from[axis] = (origin[axis] - work->centre[axis]) * work->inverse;
    const double length = (met->depth[p] - met->exit[p]) * work->unit;
    return length > fibrad_ball_exit(from, w, work->reach) * work->unit ||
           length > fibrad_region_exit(work->scene, origin, w);
}

void LANED(fibrad_mesh_count)(fibrad_workspace *work, const double frame[9], uint32_t k) {
    const fibrad_scene *scene = work->scene;
    fibrad_met *met = work->met;
    const fibrad_points *points = &met->points;
    for (uint32_t p = 0; p < points->count; p++) {
        const uint32_t side = met->side[p];
        if (side == FIBRAD_NO_SIDE) continue;
        uint32_t slot = fibrad_scene_slot(scene, side);
        if (slot == FIBRAD_NONE) {
            work->back = scene->mesh.number[side / 2];
            continue;
        }
        if (beyond_known(work, frame, p)) slot = FIBRAD_BEYOND;
        const uint32_t entry = fibrad_entries_of(&work->entries, scene->facts.spheres + slot);
        fibrad_entries_add(&work->entries, entry, k, met->weight[p]);
    }
}
