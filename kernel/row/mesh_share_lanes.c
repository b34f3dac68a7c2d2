/* mesh_share_lanes.c - what of a window triangles take from spheres and from the open. Compiled once per instruction
 * set. SPDX-License-Identifier: MIT
 *
 * Points of the window are resolved by depth: lines along its direction, each from where it leaves sphere i. What a
 * sphere loses is its visible area times the share of its points that triangles hide, so that areas stay exact where
 * nothing hides them. Lines that meet no sphere get directions of their own, as those among walls do, if what they meet
 * is far: docs/methods.md section 9. */
#include FIBRAD_LANES_HEADER
#include "base/constants.h"
#include "base/lanes/below.h"
#include "row/mesh_share_lanes.h"
#include "scene/walls.h"
#include "window/points_lanes.h"

#define MESH_SPREAD 1.8 /* radius of the disc of directions times root n, and how near edges need none: as of walls */
#define MESH_NEAR   1.3
#define MESH_SEEK   0.9 /* of the depth of the nearest triangle: others are not looked for beyond */

/* The window as the tree sees it, in the frame of an image: lengths in radii of sphere i but for `centre`. */
typedef struct mesh_beam {
    const double *frame;
    double centre[3];                              /* [L] of sphere i, from the image */
    double from, to;                               /* depths that are looked at */
    double low[2], high[2], least[2], most[2], at; /* bounds of its lines, as of each eight of them */
    double grain, slack;                           /* lengths that may be rounding; of bounds */
    double nearest;                                /* about the least depth of triangles before it */
    double shallow;                                /* none of them is less deep */
    double near;                                   /* if some are nearer than this, it does not matter how near */
    bool seek;                                     /* for the nearest triangle, not for those that lines meet */
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

/* Bounds of coordinate k of the lines of a beam between two depths. */
FIBRAD_INLINE void bounds_between(const mesh_beam *beam, int k, double from, double to, double *low, double *high) {
    const double a = beam->least[k] * (from - beam->at), b = beam->least[k] * (to - beam->at);
    const double c = beam->most[k] * (from - beam->at), d = beam->most[k] * (to - beam->at);
    *low = beam->low[k] + fibrad_min(fibrad_min(a, b), fibrad_min(c, d)) - beam->slack;
    *high = beam->high[k] + fibrad_max(fibrad_max(a, b), fibrad_max(c, d)) + beam->slack;
}

/* Of a face: its box. */
typedef struct face_box {
    double low[3], high[3];
} face_box;

static face_box box_of_face(const mesh_face *face) {
    const double *x[3] = {face->u, face->v, face->z};
    face_box box;
    for (int k = 0; k < 3; k++) {
        box.low[k] = fibrad_min(x[k][0], fibrad_min(x[k][1], x[k][2]));
        box.high[k] = fibrad_max(x[k][0], fibrad_max(x[k][1], x[k][2]));
    }
    return box;
}

/* Whether a face may come before the window. */
static bool face_before(const face_box *box, const mesh_beam *beam) {
    if (box->high[2] < (beam->cut ? -1 : 0) || box->low[2] > beam->to) return false;
    const double from = fibrad_max(-1, box->low[2]), to = fibrad_max(-1, box->high[2]);
    for (int k = 0; k < 2; k++) {
        double low, high;
        bounds_between(beam, k, from, to, &low, &high);
        if (box->low[k] > high || box->high[k] < low) return false;
    }
    return true;
}

/* Notes the lines p + lane given by bits, whose keys are not above those so far. */
static void note_side(fibrad_workspace *work, const mesh_face *face, uint32_t p, uint32_t bits, uint32_t backs,
                      const double *key) {
    fibrad_lines *lines = &work->met->lines;
    for (; bits != 0; bits &= bits - 1) {
        const uint32_t lane = (uint32_t)__builtin_ctz(bits), at = p + lane, before = lines->side[at];
        if (key[lane] == lines->depth[at] && before != FIBRAD_NO_SIDE &&
            work->scene->mesh.number[before / 2] <= face->number)
            continue;
        lines->depth[at] = key[lane];
        lines->side[at] = 2 * face->triangle + (backs >> lane & 1);
    }
}

/* Eight lines and a face. Of the depth, a grain more at backs, so that fronts come first at edges. */
FIBRAD_INLINE void meet_lines(fibrad_workspace *work, const mesh_beam *beam, const mesh_face *face, uint32_t first,
                              bool spread) {
    const fibrad_lines *lines = &work->met->lines;
    const vd zero = vd_set1(0), grain = vd_set1(beam->grain);
    for (uint32_t p = first; p < first + FIBRAD_LINE_BLOCK; p += VD_LANES) {
        const vd u = vd_load(lines->place[0] + p), v = vd_load(lines->place[1] + p), s = vd_load(lines->exit + p);
        vd x[3], y[3];
        for (int k = 0; k < 3; k++) {
            x[k] = face->u[k] - u, y[k] = face->v[k] - v;
            if (!spread) continue;
            const vd ahead = face->z[k] - s;
            x[k] = x[k] - vd_load(lines->aside[0] + p) * ahead;
            y[k] = y[k] - vd_load(lines->aside[1] + p) * ahead;
        }
        const vd a = x[1] * y[2] - y[1] * x[2], b = x[2] * y[0] - y[2] * x[0], c = x[0] * y[1] - y[0] * x[1];
        const vm none = vd_lt(vd_min(a, vd_min(b, c)), zero), some = vd_lt(zero, vd_max(a, vd_max(b, c)));
        const vm all = vm_not(some) & none; /* all <= 0, not all 0 */
        const vm inside = (some & vm_not(none)) | all;
        if (vm_bits(inside) == 0) continue;
        const vd sum = a + b + c, z = (a * face->z[0] + b * face->z[1] + c * face->z[2]) / sum;
        const vm back = vd_lt(zero, sum);
        const vd shift = vd_select(back, grain, zero - grain), key = z + vd_select(back, grain, zero);
        const uint32_t bits =
            vm_bits(inside & vd_lt(s + shift, z) & vd_le(key, vd_load(lines->depth + p)) & vd_le(z, vd_set1(1e300)));
        if (bits == 0) continue;
        _Alignas(64) double keys[VD_LANES];
        vd_store(keys, key);
        note_side(work, face, p, bits, vm_bits(back), keys);
    }
}

/* Lines and a face, those eights of them that pass its box. */
FIBRAD_INLINE void meet_blocks(fibrad_workspace *work, const mesh_beam *beam, const mesh_face *face,
                               const face_box *box, bool spread) {
    const fibrad_lines *lines = &work->met->lines;
    const uint32_t blocks = lines->count / FIBRAD_LINE_BLOCK;
    const double from = fibrad_max(-1, box->low[2]) - lines->at, to = fibrad_max(-1, box->high[2]) - lines->at;
    for (uint32_t b = 0; b < blocks; b += VD_LANES) {
        vm apart = vd_lt(vd_set1(0), vd_set1(0));
        for (int k = 0; k < 2; k++) {
            vd low = vd_load(lines->low[k] + b) - beam->slack, high = vd_load(lines->high[k] + b) + beam->slack;
            if (spread) {
                const vd least = vd_load(lines->least[k] + b), most = vd_load(lines->most[k] + b);
                const vd at_least[2] = {least * from, least * to}, at_most[2] = {most * from, most * to};
                low += vd_min(vd_min(at_least[0], at_least[1]), vd_min(at_most[0], at_most[1]));
                high += vd_max(vd_max(at_least[0], at_least[1]), vd_max(at_most[0], at_most[1]));
            }
            apart = apart | vd_lt(high, vd_set1(box->low[k])) | vd_lt(vd_set1(box->high[k]), low);
        }
        uint32_t bits = vm_bits(vm_not(apart)) & vd_lanes_below(blocks - b);
        for (; bits != 0; bits &= bits - 1)
            meet_lines(work, beam, face, (b + (uint32_t)__builtin_ctz(bits)) * FIBRAD_LINE_BLOCK, spread);
    }
}

/* Where the surface of sphere i lies beyond a face, as seen from its centre: there lines end at once, before all that
 * others meet, nearest first. */
static void cut_surface(fibrad_workspace *work, const mesh_face *face) {
    const fibrad_lines *lines = &work->met->lines;
    const vd zero = vd_set1(0), one = vd_set1(1);
    double n[3][3], sum_n[3]; /* of the planes through the centre and each edge; of that of the face */
    for (int k = 0; k < 3; k++) {
        const int next = (k + 1) % 3, last = (k + 2) % 3;
        n[k][0] = face->v[next] * face->z[last] - face->z[next] * face->v[last];
        n[k][1] = face->z[next] * face->u[last] - face->u[next] * face->z[last];
        n[k][2] = face->u[next] * face->v[last] - face->v[next] * face->u[last];
    }
    for (int axis = 0; axis < 3; axis++) sum_n[axis] = n[0][axis] + n[1][axis] + n[2][axis];
    const double volume = face->u[0] * n[0][0] + face->v[0] * n[0][1] + face->z[0] * n[0][2]; /* of six tetrahedra */
    const double square = sum_n[0] * sum_n[0] + sum_n[1] * sum_n[1] + sum_n[2] * sum_n[2];
    if (volume * volume > square * (1 + 1e-9)) return; /* its plane passes the sphere */
    for (uint32_t p = 0; p < lines->count; p += VD_LANES) {
        const vd u = vd_load(lines->place[0] + p), v = vd_load(lines->place[1] + p), s = vd_load(lines->exit + p);
        vd e[3];
        for (int k = 0; k < 3; k++) e[k] = n[k][0] * u + n[k][1] * v + n[k][2] * s;
        const vd least = vd_min(e[0], vd_min(e[1], e[2])), most = vd_max(e[0], vd_max(e[1], e[2]));
        const vm inside = (vd_lt(zero, most) & vd_le(zero, least)) | (vd_lt(least, zero) & vd_le(most, zero));
        const vd sum = e[0] + e[1] + e[2], share = volume / sum; /* of the way from the centre to the surface */
        const vd key = share - 2;
        const uint32_t bits =
            vm_bits(inside & vd_lt(zero, share) & vd_lt(share, one) & vd_le(key, vd_load(lines->depth + p)));
        if (bits == 0) continue;
        _Alignas(64) double keys[VD_LANES];
        vd_store(keys, key);
        note_side(work, face, p, bits, vm_bits(vd_lt(zero, sum)), keys);
    }
}

/* How deep the middle of the window meets the plane of a face, as far as the face goes. Windows that look a little away
 * from a plane are treated as those that look as little towards it. */
static double depth_of_face(const mesh_face *face, const face_box *box) {
    double n[3];
    const double *u = face->u, *v = face->v, *z = face->z;
    n[0] = (v[1] - v[0]) * (z[2] - z[0]) - (z[1] - z[0]) * (v[2] - v[0]);
    n[1] = (z[1] - z[0]) * (u[2] - u[0]) - (u[1] - u[0]) * (z[2] - z[0]);
    n[2] = (u[1] - u[0]) * (v[2] - v[0]) - (v[1] - v[0]) * (u[2] - u[0]);
    const double depth = n[2] != 0 ? fibrad_abs((n[0] * u[0] + n[1] * v[0] + n[2] * z[0]) / n[2]) : __builtin_inf();
    return fibrad_max(fibrad_max(0, box->low[2]), fibrad_min(depth, box->high[2]));
}

static void meet_face(fibrad_workspace *work, mesh_beam *beam, uint32_t t) {
    const mesh_face face = face_of(work, beam, t);
    const face_box box = box_of_face(&face);
    if (!face_before(&box, beam)) return;
    if (beam->seek) {
        beam->nearest = fibrad_min(beam->nearest, depth_of_face(&face, &box));
        beam->to = beam->nearest > beam->near ? fibrad_min(beam->to, MESH_SEEK * beam->nearest) : -__builtin_inf();
        beam->shallow = fibrad_min(beam->shallow, fibrad_min(beam->to, box.low[2]));
        return;
    }
    if (beam->spread)
        meet_blocks(work, beam, &face, &box, true);
    else
        meet_blocks(work, beam, &face, &box, false);
    if (beam->cut && box.low[2] < 1) cut_surface(work, &face);
}

/* How boxes lie along one axis of the window: the corner that is farthest along it, and the opposite one. */
typedef struct box_axis {
    double f[3], shift; /* bound number far[axis] of a box times f[axis], all added up, and shift: in radii */
    uint32_t far[3], near[3];
} box_axis;

static box_axis axis_of_boxes(const fibrad_workspace *work, const mesh_beam *beam, int k) {
    box_axis of = {.shift = 0};
    for (uint32_t axis = 0; axis < 3; axis++) {
        const uint32_t up = beam->frame[3 * k + (int)axis] > 0;
        of.f[axis] = beam->frame[3 * k + (int)axis] * work->inverse;
        of.shift += of.f[axis] * (work->scene->mesh.middle[axis] - beam->centre[axis]);
        of.far[axis] = axis + 3 * up, of.near[axis] = axis + 3 - 3 * up;
    }
    return of;
}

FIBRAD_INLINE double bound_of_box(const box_axis *of, const uint32_t number[3], const float bound[6]) {
    return of->f[0] * bound[number[0]] + of->f[1] * bound[number[1]] + of->f[2] * bound[number[2]] + of->shift;
}

/* Whether a box may come before the window; bounds that are infinite make it so. */
FIBRAD_INLINE bool box_before(const fibrad_mesh_node *node, const mesh_beam *beam, const box_axis of[3]) {
    const double front = bound_of_box(&of[2], of[2].near, node->bound);
    if (front > beam->to) return false;
    const double behind = bound_of_box(&of[2], of[2].far, node->bound);
    if (behind < beam->from) return false;
    const double from = fibrad_max(-1, front), to = fibrad_min(behind, fibrad_min(beam->to, 1e300));
    for (int k = 0; k < 2; k++) {
        double low, high;
        bounds_between(beam, k, from, to, &low, &high);
        if (bound_of_box(&of[k], of[k].near, node->bound) > high || bound_of_box(&of[k], of[k].far, node->bound) < low)
            return false;
    }
    return true;
}

static void meet_tree(fibrad_workspace *work, mesh_beam *beam) {
    const fibrad_mesh *mesh = &work->scene->mesh;
    const box_axis of[3] = {axis_of_boxes(work, beam, 0), axis_of_boxes(work, beam, 1), axis_of_boxes(work, beam, 2)};
    for (uint32_t k = 0; k < mesh->nodes && beam->to >= beam->from;) {
        const fibrad_mesh_node *node = &mesh->node[k];
        if (!box_before(node, beam, of)) {
            k = node->skip;
            continue;
        }
        const uint32_t begin = node->leaf / 8, end = begin + node->leaf % 8;
        for (uint32_t t = begin; t < end; t++) meet_face(work, beam, t);
        k++;
    }
}

/* Whether some line may meet what is deeper. */
static bool look_deeper(const fibrad_workspace *work, const mesh_beam *beam, double depth) {
    const fibrad_lines *lines = &work->met->lines;
    if (beam->seek) return beam->nearest > depth;
    for (uint32_t p = 0; p < lines->count; p++)
        if (lines->depth[p] > depth) return true;
    return false;
}

/* All triangles down to a depth, along periodic axes a period at a time. */
static void meet_mesh(fibrad_workspace *work, mesh_beam *beam, double deepest) {
    const fibrad_mesh *mesh = &work->scene->mesh;
    double stretch = deepest + 1, from = -1, wide = 0; /* of the directions of lines, at most */
    for (int k = 0; k < 2; k++) wide += fibrad_max(beam->most[k], -beam->least[k]);
    for (int axis = 0; axis < 3; axis++) {
        const double period = mesh->period[axis] * work->inverse, w = fibrad_abs(beam->frame[6 + axis]);
        const double ahead =
            beam->frame[6 + axis] > 0 ? mesh->high[axis] - work->centre[axis] : work->centre[axis] - mesh->low[axis];
        if (!(period > 0)) { /* the window leaves the box about all triangles */
            if (w > wide)
                deepest = fibrad_min(deepest, 1.0001 * (fibrad_max(0, ahead) * work->inverse + 1) / (w - wide));
            continue;
        }
        stretch = fibrad_min(stretch, fibrad_max(2, period));
        if (w > 0) deepest = fibrad_min(deepest, FIBRAD_PERIODS * period / w);
    }
    for (bool more = true; more;) {
        double low[3], high[3], side = 1;
        const double to = fibrad_min(from + stretch, deepest);
        for (int k = 0; k < 2; k++) side += fibrad_max(beam->most[k], -beam->least[k]) * fibrad_max(0, to);
        for (int axis = 0; axis < 3; axis++) {
            const double w = beam->frame[6 + axis], a = w == 0 ? 0 : from * w, b = w == 0 ? 0 : to * w;
            low[axis] = work->centre[axis] + (fibrad_min(a, b) - side) * work->unit;
            high[axis] = work->centre[axis] + (fibrad_max(a, b) + side) * work->unit;
        }
        beam->from = from, beam->to = to;
        const fibrad_mesh_images images = fibrad_mesh_images_in(mesh, low, high);
        for (int32_t z = images.first[2]; z <= images.last[2]; z++)
            for (int32_t y = images.first[1]; y <= images.last[1]; y++)
                for (int32_t x = images.first[0]; x <= images.last[0]; x++) {
                    beam->centre[0] = work->centre[0] - x * mesh->period[0];
                    beam->centre[1] = work->centre[1] - y * mesh->period[1];
                    beam->centre[2] = work->centre[2] - z * mesh->period[2];
                    meet_tree(work, beam);
                }
        more = to < deepest && to > from && look_deeper(work, beam, to);
        from = to;
    }
}

static double exit_of_point(const fibrad_points *points, uint32_t p) {
    const double u = points->set.x[p], v = points->set.y[p];
    return fibrad_sqrt(fibrad_max(0, 1 - u * u - v * v));
}

/* The line of a point [L]. */
static void line_of_point(const fibrad_workspace *work, const double frame[9], const fibrad_points *points, uint32_t p,
                          double origin[3], double w[3]) {
    const fibrad_met *met = work->met;
    const double u = points->set.x[p], v = points->set.y[p], s = exit_of_point(points, p);
    for (int axis = 0; axis < 3; axis++) {
        const double *f = frame + axis;
        origin[axis] = work->centre[axis] + work->unit * (u * f[0] + v * f[3] + s * f[6]);
        w[axis] = f[6] + met->aside[0][p] * f[0] + met->aside[1][p] * f[3];
    }
}

/* Whether a point that meets no sphere meets its triangle before any wall. */
static bool before_walls(const fibrad_workspace *work, const double frame[9], const fibrad_points *points, uint32_t p) {
    const fibrad_met *met = work->met;
    double origin[3], w[3], distance;
    if (!work->scene->container.walls || met->depth[p] < -1) return true;
    line_of_point(work, frame, points, p, origin, w);
    fibrad_walls_exit(work->scene, origin, w, &distance);
    return (met->depth[p] - exit_of_point(points, p)) * work->unit < distance;
}

static double depth_of_disc(const fibrad_workspace *work, uint32_t disc) {
    const fibrad_discs *d = &work->disc;
    return d->depth[disc] < 0 ? d->resolved[disc] : d->depth[disc];
}

/* Of the points given by bits, in word `word`, those that meet a triangle before sphere `disc`; others forget it. */
static uint64_t before_disc(fibrad_workspace *work, const fibrad_points *points, uint32_t word, uint64_t bits,
                            uint32_t disc) {
    fibrad_met *met = work->met;
    const fibrad_discs *d = &work->disc;
    const double depth = depth_of_disc(work, disc), r = d->r[disc];
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

static void add_weights(fibrad_met *met, const uint64_t taken[4], double weight) {
    for (uint32_t word = 0; word < 4; word++)
        for (uint64_t rest = taken[word]; rest != 0; rest &= rest - 1)
            met->weight[64 * word + (uint32_t)__builtin_ctzll(rest)] += weight;
}

/* The point nearest to the centre of a disc. */
static uint32_t nearest_point(const fibrad_points *points, double u, double v) {
    double least = __builtin_inf();
    uint32_t nearest = 0;
    for (uint32_t p = 0; p < points->count; p++) {
        const double x = points->set.x[p] - u, y = points->set.y[p] - v, square = x * x + y * y;
        if (square < least) least = square, nearest = p;
    }
    return nearest;
}

/* A disc that is seen between points goes with the point that is nearest to it, to the disc or the triangle there. */
static void share_gap(fibrad_workspace *work, const fibrad_points *points, uint32_t disc, uint32_t k, double area) {
    const fibrad_met *met = work->met;
    const uint32_t p = nearest_point(points, work->disc.u[disc], work->disc.v[disc]);
    if (met->side[p] != FIBRAD_NO_SIDE && met->depth[p] < depth_of_disc(work, disc))
        work->met->weight[p] += area;
    else
        fibrad_work_accumulate(work, disc, k, area);
}

/* What triangles take from one disc, of visible area `area`; 0: by points. Points of it are no longer seen. Returns how
 * many there are; with none, nothing is done. */
static uint32_t share_disc(fibrad_workspace *work, fibrad_points *points, uint32_t disc, uint32_t k, double area) {
    uint64_t taken[4] = {0};
    uint32_t own = 0, lost = 0;
    for (uint32_t word = 0; word < points->count / 64; word++) {
        const uint64_t bits = points->seen[word] & LANED(fibrad_points_within)(points, word, work->disc.u[disc],
                                                                               work->disc.v[disc], work->disc.r[disc]);
        points->seen[word] &= ~bits;
        taken[word] = before_disc(work, points, word, bits, disc);
        own += fibrad_count_bits(bits), lost += fibrad_count_bits(taken[word]);
    }
    if (area > 0 && own > 0) {
        add_weights(work->met, taken, area / own);
        if (lost < own) fibrad_work_accumulate(work, disc, k, lost > 0 ? area / own * (own - lost) : area);
    } else if (lost > 0) {
        add_weights(work->met, taken, 1);
        fibrad_work_accumulate(work, disc, k, -(double)lost);
    }
    return own;
}

/* How wide the directions of open lines spread, if the nearest of what they meet is at some depth. */
static double spread_at(double depth, uint32_t n) {
    const double wide = MESH_SPREAD / fibrad_sqrt(n), ratio = MESH_NEAR / fibrad_max(depth * wide, 1e-300);
    return ratio < 1 && depth < __builtin_inf() ? wide * fibrad_sqrt(1 - ratio * ratio) : 0;
}

/* The line of a point of window k. */
typedef struct mesh_line {
    double place[2], exit, aside[2];
} mesh_line;

static mesh_line line_through(const fibrad_points *points, uint32_t p, uint32_t k, double spread) {
    mesh_line line = {.place = {points->set.x[p], points->set.y[p]}, .exit = exit_of_point(points, p)};
    if (spread > 0) {
        const uint32_t q = fibrad_points_partner(points->count, p, k);
        line.aside[0] = (float)(points->set.x[q] * spread), line.aside[1] = (float)(points->set.y[q] * spread);
    }
    return line;
}

/* In which of four by four cells of a square about the window a line is, to and fro. */
static uint8_t cell_of_line(const mesh_line *line, double depth, double over) {
    uint32_t cell[2];
    for (int axis = 0; axis < 2; axis++) {
        const double at = line->place[axis] + line->aside[axis] * (depth - line->exit);
        cell[axis] = (uint32_t)fibrad_max(0, fibrad_min(3, 2 + at * over));
    }
    return (uint8_t)(4 * cell[1] + (cell[1] % 2 == 0 ? cell[0] : 3 - cell[0]));
}

/* Bounds of each eight lines, and of all. */
static void bound_lines(fibrad_lines *lines, mesh_beam *beam) {
    for (int axis = 0; axis < 2; axis++) {
        beam->low[axis] = beam->least[axis] = __builtin_inf(), beam->high[axis] = beam->most[axis] = -__builtin_inf();
        for (uint32_t b = 0; b < lines->count / FIBRAD_LINE_BLOCK; b++) {
            double low = __builtin_inf(), high = -low, least = low, most = high;
            for (uint32_t p = FIBRAD_LINE_BLOCK * b; p < FIBRAD_LINE_BLOCK * (b + 1); p++) {
                const double aside = lines->aside[axis][p];
                const double at = lines->place[axis][p] + aside * (lines->at - lines->exit[p]);
                low = fibrad_min(low, at), high = fibrad_max(high, at);
                least = fibrad_min(least, aside), most = fibrad_max(most, aside);
            }
            lines->low[axis][b] = low, lines->high[axis][b] = high;
            lines->least[axis][b] = least, lines->most[axis][b] = most;
            beam->low[axis] = fibrad_min(beam->low[axis], low), beam->high[axis] = fibrad_max(beam->high[axis], high);
            beam->least[axis] = fibrad_min(beam->least[axis], least);
            beam->most[axis] = fibrad_max(beam->most[axis], most);
        }
    }
    beam->at = lines->at;
}

/* A beam about all lines whose directions spread so far. */
static void bound_window(mesh_beam *beam, double spread) {
    for (int axis = 0; axis < 2; axis++) {
        beam->low[axis] = -1, beam->high[axis] = 1;
        beam->least[axis] = -spread, beam->most[axis] = spread;
    }
    beam->at = 0;
}

static void set_line(fibrad_lines *lines, uint32_t to, uint32_t point, mesh_line line, double depth) {
    for (int axis = 0; axis < 2; axis++)
        lines->place[axis][to] = line.place[axis], lines->aside[axis][to] = line.aside[axis];
    lines->exit[to] = line.exit, lines->point[to] = point;
    lines->depth[to] = depth, lines->side[to] = FIBRAD_NO_SIDE;
}

/* Looks which triangles the lines of chosen points meet first, down to depth[p] of each (NULL: any) and to `deepest`.
 * Returns how many lines there are. */
static uint32_t meet_points(fibrad_workspace *work, mesh_beam *beam, const fibrad_points *points,
                            const uint64_t chosen[4], uint32_t k, double spread, double deepest, const double *depth) {
    fibrad_lines *lines = &work->met->lines;
    uint32_t start[17] = {0}, count = 0;
    uint8_t cell[FIBRAD_MET_POINTS];
    lines->at = spread > 0 ? beam->nearest : 0;
    const double over = 2 / (1 + spread * lines->at);
    for (uint32_t word = 0; word < points->count / 64; word++)
        for (uint64_t rest = chosen[word]; rest != 0; rest &= rest - 1) {
            const uint32_t p = 64 * word + (uint32_t)__builtin_ctzll(rest);
            const mesh_line line = line_through(points, p, k, spread);
            cell[count] = cell_of_line(&line, lines->at, over);
            start[cell[count++] + 1]++;
        }
    if (count == 0) return 0;
    for (uint32_t c = 0; c < 16; c++) start[c + 1] += start[c];
    lines->count = (count + FIBRAD_LINE_BLOCK - 1) / FIBRAD_LINE_BLOCK * FIBRAD_LINE_BLOCK;
    for (uint32_t word = 0, n = 0; word < points->count / 64; word++)
        for (uint64_t rest = chosen[word]; rest != 0; rest &= rest - 1) {
            const uint32_t p = 64 * word + (uint32_t)__builtin_ctzll(rest), to = start[cell[n++]]++;
            set_line(lines, to, p, line_through(points, p, k, spread), depth != NULL ? depth[p] : __builtin_inf());
        }
    const mesh_line end = {{lines->place[0][count - 1], lines->place[1][count - 1]},
                           lines->exit[count - 1],
                           {lines->aside[0][count - 1], lines->aside[1][count - 1]}};
    for (uint32_t to = count; to < lines->count; to++) set_line(lines, to, 0, end, -__builtin_inf());
    bound_lines(lines, beam);
    if (beam->cut) bound_window(beam, 1.0001 * spread);
    beam->spread = spread > 0, beam->seek = false;
    beam->slack = beam->grain + 1e-12 * (1 + spread * lines->at);
    meet_mesh(work, beam, deepest);
    return count;
}

/* Tells the points of so many lines what these meet. Returns how many meet anything. */
static uint32_t tell_points(fibrad_met *met, uint32_t count) {
    const fibrad_lines *lines = &met->lines;
    uint32_t meet = 0;
    for (uint32_t to = 0; to < count; to++) {
        const uint32_t p = lines->point[to];
        met->depth[p] = lines->depth[to], met->side[p] = lines->side[to];
        for (int axis = 0; axis < 2; axis++) met->aside[axis][p] = (float)lines->aside[axis][to];
        meet += met->side[p] != FIBRAD_NO_SIDE;
    }
    return meet;
}

/* What triangles take of the open, `open` of it. */
static double share_open(fibrad_workspace *work, const double frame[9], fibrad_points *points, uint32_t k,
                         double open) {
    fibrad_met *met = work->met;
    uint64_t taken[4] = {0};
    uint32_t own = 0, lost = 0;
    for (uint32_t p = 0; p < points->count; p++) {
        if ((points->seen[p / 64] >> p % 64 & 1) == 0) continue;
        own++;
        if (met->side[p] == FIBRAD_NO_SIDE) continue;
        if (before_walls(work, frame, points, p))
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
    add_weights(met, taken, open / own);
    return lost < own ? open / own * (own - lost) : 0;
}

/* Disc number c of those that may be seen in a window, by points or (count 0) by areas; FIBRAD_NONE: it is not seen. */
static uint32_t seen_disc(const fibrad_workspace *work, const fibrad_points *points, uint32_t c) {
    if (points->count > 0) return points->occluder[c];
    return c > 0 && work->areas.area[c] > 0 ? work->areas.whose[c] : FIBRAD_NONE;
}

static uint32_t seen_discs(const fibrad_workspace *work, const fibrad_points *points) {
    return points->count > 0 ? points->occluders : work->areas.circles;
}

/* The deepest disc that is seen; FIBRAD_NONE: there is none. */
static uint32_t deepest_disc(const fibrad_workspace *work, const fibrad_points *points) {
    const uint32_t discs = seen_discs(work, points);
    uint32_t deepest = FIBRAD_NONE;
    for (uint32_t c = 0; c < discs; c++) {
        const uint32_t disc = seen_disc(work, points, c);
        if (disc == FIBRAD_NONE) continue;
        if (deepest == FIBRAD_NONE || depth_of_disc(work, disc) > depth_of_disc(work, deepest)) deepest = disc;
    }
    return deepest;
}

/* Whether no triangle comes before a window that sees nothing deeper than a disc: those parts of it that sphere i is
 * not certainly nearer to than any triangle, the sphere of the disc is. */
static bool clear_to_disc(const fibrad_workspace *work, uint32_t disc) {
    const fibrad_discs *d = &work->disc;
    const double own = work->clear_mesh * work->clear_mesh - 1, depth = depth_of_disc(work, disc);
    const double aside = 1 + fibrad_sqrt(d->u[disc] * d->u[disc] + d->v[disc] * d->v[disc]);
    const double clear = work->scene->clear[fibrad_work_sphere(work, disc)] * d->r[disc];
    if (!(own > 0 && clear > 0)) return false;
    const double left = fibrad_max(0, depth - fibrad_sqrt(own));
    return left * left + aside * aside < clear * clear * (1 - 1e-9);
}

/* Gives the points of a disc that are still seen its depth; they are no longer seen. */
static void limit_points(fibrad_workspace *work, fibrad_points *points, uint32_t disc) {
    const double depth = depth_of_disc(work, disc);
    for (uint32_t word = 0; word < points->count / 64; word++) {
        const uint64_t bits = points->seen[word] & LANED(fibrad_points_within)(points, word, work->disc.u[disc],
                                                                               work->disc.v[disc], work->disc.r[disc]);
        points->seen[word] &= ~bits;
        for (uint64_t rest = bits; rest != 0; rest &= rest - 1)
            work->met->depth[64 * word + (uint32_t)__builtin_ctzll(rest)] = depth;
    }
}

/* The side that the deepest of the lines meets. */
static uint32_t deepest_side(const fibrad_lines *lines) {
    double deepest = -__builtin_inf();
    uint32_t side = FIBRAD_NO_SIDE;
    for (uint32_t p = 0; p < lines->count; p++)
        if (lines->side[p] != FIBRAD_NO_SIDE && lines->depth[p] > deepest)
            deepest = lines->depth[p], side = lines->side[p];
    return side;
}

/* Looks what all points of a window meet, whose discs are those of `given`. Returns whether any meets a triangle. */
static bool meet_window(fibrad_workspace *work, mesh_beam *beam, const fibrad_points *given, fibrad_points *points,
                        uint32_t k, double spread, double deepest, bool open) {
    fibrad_met *met = work->met;
    const uint32_t discs = seen_discs(work, given);
    uint64_t covered[4] = {0};
    uint32_t own = 0, meet = 0;
    for (uint32_t p = 0; p < points->count; p++) {
        met->depth[p] = __builtin_inf(), met->side[p] = FIBRAD_NO_SIDE, met->weight[p] = 0;
        met->aside[0][p] = met->aside[1][p] = 0;
    }
    for (uint32_t c = 0; c < discs; c++)
        if (seen_disc(work, given, c) != FIBRAD_NONE) limit_points(work, points, seen_disc(work, given, c));
    for (uint32_t word = 0; word < points->count / 64; word++)
        covered[word] = ~points->seen[word], own += fibrad_count_bits(points->seen[word]);
    met->deepest = FIBRAD_NO_SIDE;
    if (beam->shallow <= deepest)
        meet += tell_points(met, meet_points(work, beam, points, covered, k, 0, deepest, met->depth));
    if (open && own > 0) {
        const uint32_t lines = meet_points(work, beam, points, points->seen, k, spread, __builtin_inf(), NULL);
        meet += tell_points(met, lines);
    } else if (open) { /* too little for points: where the deepest line ends */
        meet_points(work, beam, points, covered, k, 0, __builtin_inf(), NULL);
        met->deepest = deepest_side(&met->lines);
    }
    return meet > 0 || met->deepest != FIBRAD_NO_SIDE;
}

static void see_all(fibrad_points *points) {
    for (uint32_t word = 0; word < points->count / 64; word++) points->seen[word] = UINT64_MAX;
}

/* How many points serve a window by areas, if there are n windows. */
static uint32_t points_of(uint32_t n) { return n <= 600 ? 64 : n <= 1400 ? 128 : 256; }

double LANED(fibrad_mesh_share)(fibrad_workspace *work, const double frame[9], fibrad_points *points, uint32_t k,
                                double open) {
    fibrad_met *met = work->met;
    const bool by_areas = points->count == 0;
    fibrad_points *used = by_areas ? &met->points : points;
    const uint32_t disc = deepest_disc(work, points);
    const double last = disc != FIBRAD_NONE ? depth_of_disc(work, disc) : 0;
    const double deepest = open > 0 ? __builtin_inf() : last;
    mesh_beam beam = {.frame = frame,
                      .cut = work->clear_mesh < 1,
                      .seek = true,
                      .nearest = __builtin_inf(),
                      .shallow = __builtin_inf(),
                      .grain = work->scene->mesh.grain * work->inverse,
                      .slack = work->scene->mesh.grain * work->inverse};
    if (!fibrad_mesh_near(work, deepest)) return open;
    if (!(open > 0) && disc != FIBRAD_NONE && clear_to_disc(work, disc)) return open;
    const double wide = open > 0 ? 1.0001 * MESH_SPREAD / fibrad_sqrt(work->windows) : 0;
    bound_window(&beam, wide);
    beam.near = open > 0 ? MESH_NEAR / wide : __builtin_inf();
    meet_mesh(work, &beam, deepest);
    if (!(beam.nearest < __builtin_inf())) return open;
    const double spread = open > 0 ? spread_at(beam.nearest, work->windows) : 0;
    met->points.count = by_areas ? points_of(work->windows) : points->count;
    (void)fibrad_disc_points_get(met->points.count, &met->points.set);
    see_all(used);
    met->any = meet_window(work, &beam, points, used, k, spread, last, open > 0) || spread > 0;
    if (!met->any) return open;
    const uint32_t discs = seen_discs(work, points);
    uint32_t *own = work->disc.hidden_points; /* of windows by points alone, else */
    see_all(used);
    for (uint32_t c = 0; c < discs; c++)
        if (seen_disc(work, points, c) != FIBRAD_NONE)
            own[c] = share_disc(work, used, seen_disc(work, points, c), k, by_areas ? work->areas.area[c] : 0);
    const double rest = open > 0 ? share_open(work, frame, used, k, open) : 0;
    for (uint32_t c = 0; by_areas && c < discs; c++)
        if (seen_disc(work, points, c) != FIBRAD_NONE && own[c] == 0)
            share_gap(work, used, seen_disc(work, points, c), k, work->areas.area[c]);
    return rest;
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
                       : origin[axis] + (met->depth[p] - exit_of_point(&met->points, p)) * work->unit * w[axis];
    }
}

/* Whether a line ends, by cutoff or known region, before it meets its triangle. */
static bool beyond_known(const fibrad_workspace *work, const double frame[9], uint32_t p) {
    const fibrad_met *met = work->met;
    double origin[3], w[3], from[3];
    if (!work->cut || met->depth[p] < -1) return false;
    line_of_point(work, frame, &met->points, p, origin, w);
    for (int axis = 0; axis < 3; axis++) from[axis] = (origin[axis] - work->centre[axis]) * work->inverse;
    const double length = (met->depth[p] - exit_of_point(&met->points, p)) * work->unit;
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
