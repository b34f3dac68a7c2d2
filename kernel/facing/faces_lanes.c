/* faces_lanes.c - finds the triangles that may come before a window, with boxes and triangles in lanes.
 * Compiled once per instruction set. SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "base/lanes/below.h"
#include "facing/faces_lanes.h"

#define IMAGES_MOST 4096 /* images of a stretch, unless the caller wants fewer */

/* The greatest distance between the axis of the window and its lines down to a depth. */
FIBRAD_INLINE vd reach_at(const fibrad_face_search *search, vd depth) {
    return 1 + search->slack + search->wide * vd_max(vd_set1(0), depth);
}

/* Enters a node. Visits the boxes that may come before the window, the nearest first. */
static void enter_before(const fibrad_mesh *mesh, fibrad_face_search *search, uint32_t number) {
    const fibrad_mesh_node *node = &mesh->node[number];
    _Alignas(64) float key[FIBRAD_MESH_WIDE];
    const vd from = vd_set1(search->from), to = vd_set1(fibrad_min(search->to, search->deepest));
    uint32_t bits = 0;
    for (uint32_t k = 0; k < FIBRAD_MESH_WIDE; k += VD_LANES) {
        vd at[3], half[3], middle[3], aside[3];
        for (int axis = 0; axis < 3; axis++)
            at[axis] = vd_load_float(node->middle[axis] + k), half[axis] = vd_load_float(node->half[axis] + k);
        for (int c = 0; c < 3; c++) {
            const double *f = search->box[c];
            middle[c] = f[0] * at[0] + f[1] * at[1] + f[2] * at[2] + search->shift[c];
            aside[c] = fibrad_abs(f[0]) * half[0] + fibrad_abs(f[1]) * half[1] + fibrad_abs(f[2]) * half[2];
        }
        const vd front = middle[2] - aside[2], behind = middle[2] + aside[2];
        const vd reach = reach_at(search, vd_min(behind, to));
        const vm before = vd_le(front, to) & vd_le(from, behind) & vd_le(vd_abs(middle[0]), aside[0] + reach) &
                          vd_le(vd_abs(middle[1]), aside[1] + reach);
        bits |= vm_bits(before) << k;
        vd_store_float(key + k, front);
    }
    fibrad_mesh_enter(&search->walk, number, bits, key);
}

/* Triangles in lanes, in the frame of the window. */
typedef struct face_lanes {
    vd c[3][3], low, high;
    vd n[3]; /* normal of each triangle, with a length of twice its area */
} face_lanes;

FIBRAD_INLINE face_lanes load_faces(const fibrad_workspace *work, const fibrad_face_search *search, uint32_t first) {
    const fibrad_mesh *mesh = &work->scene->mesh;
    const double *f = search->frame;
    face_lanes of;
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        vd at[3];
        for (int axis = 0; axis < 3; axis++)
            at[axis] = (vd_loadu(mesh->corner[k][axis] + first) - search->centre[axis]) * work->inverse;
        for (int axis = 0; axis < 3; axis++)
            of.c[k][axis] = f[3 * axis] * at[0] + f[3 * axis + 1] * at[1] + f[3 * axis + 2] * at[2];
    }
    of.low = vd_min(of.c[0][2], vd_min(of.c[1][2], of.c[2][2]));
    of.high = vd_max(of.c[0][2], vd_max(of.c[1][2], of.c[2][2]));
    vd a[3], b[3];
    for (int axis = 0; axis < 3; axis++)
        a[axis] = of.c[1][axis] - of.c[0][axis], b[axis] = of.c[2][axis] - of.c[0][axis];
    for (int axis = 0; axis < 3; axis++) {
        const int next = (axis + 1) % 3, last = (axis + 2) % 3;
        of.n[axis] = a[next] * b[last] - a[last] * b[next];
    }
    return of;
}

/* The depth at which the axis of the window meets the plane of a triangle, limited to the depths of the triangle. A
 * window that looks away from the plane by a small angle counts as one that looks towards it by the same angle. */
FIBRAD_INLINE vd depth_of_plane(const face_lanes *of) {
    const vd size = vd_abs(of->n[2]), zero = vd_set1(0);
    const vd height = vd_abs(of->n[0] * of->c[0][0] + of->n[1] * of->c[0][1] + of->n[2] * of->c[0][2]);
    const vd depth = vd_select(vd_lt(zero, size), height / size, vd_set1(__builtin_inf()));
    return vd_max(vd_max(zero, of->low), vd_min(depth, of->high));
}

/* Lists the triangles given by bits. */
FIBRAD_INLINE void list_faces(fibrad_workspace *work, fibrad_face_search *search, const face_lanes *of, vd edge[3][3],
                              uint32_t bits, uint32_t first) {
    fibrad_faces *faces = &work->met->faces;
    const uint32_t at = faces->count;
    const vm front = vd_lt(of->n[2], vd_set1(0)); /* the front is seen, so the corners are turned round */
    const vd inverse = 1 / of->n[2], slope[2] = {0 - of->n[0] * inverse, 0 - of->n[1] * inverse};
    vd most = vd_set1(0);
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        const vd square = edge[k][0] * edge[k][0] + edge[k][1] * edge[k][1];
        most = vd_max(most, square);
        for (int axis = 0; axis < 3; axis++) {
            const vd turned = k == 0 ? of->c[0][axis] : vd_select(front, of->c[3 - k][axis], of->c[k][axis]);
            vd_compress(faces->corner[k][axis] + at, bits, turned);
        }
    }
    const vm known = vd_lt(1e-9 * most, vd_abs(of->n[2])); /* otherwise the triangle is seen edge-on or nearly so */
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        const vd rounding = search->slack * (vd_abs(edge[k][0]) + vd_abs(edge[k][1]));
        vd_compress(faces->edge[k][0] + at, bits, edge[k][0]);
        vd_compress(faces->edge[k][1] + at, bits, edge[k][1]);
        vd_compress(faces->edge[k][2] + at, bits, vd_select(known, edge[k][2] + rounding, vd_set1(__builtin_inf())));
    }
    vd_compress(faces->low + at, bits, of->low);
    vd_compress(faces->high + at, bits, of->high);
    vd_compress(faces->plane[0] + at, bits, slope[0]);
    vd_compress(faces->plane[1] + at, bits, slope[1]);
    vd_compress(faces->plane[2] + at, bits, of->c[0][2] - slope[0] * of->c[0][0] - slope[1] * of->c[0][1]);
    vd_compress(faces->middle + at, bits, depth_of_plane(of));
    vd_compress(faces->side + at, bits, vd_select(front, vd_set1(0), vd_set1(1)));
    faces->count += vd_compress_places(faces->triangle + at, bits, first);
    for (uint32_t k = at; k < faces->count; k++) {
        faces->side[k] += 2. * faces->triangle[k];
        search->shallow = fibrad_min(search->shallow, faces->low[k]);
        search->nearest = fibrad_min(search->nearest, faces->middle[k]);
    }
    if (search->nearest < search->near) search->wide = 0;
}

/* Lists those of up to VD_LANES triangles that may come before the window: the window does not lie outside one of
 * their edges. */
static void add_faces(fibrad_workspace *work, fibrad_face_search *search, uint32_t first, uint32_t count) {
    const face_lanes of = load_faces(work, search, first);
    const vd reach = reach_at(search, vd_min(of.high, vd_set1(search->deepest)));
    const vd sign = vd_select(vd_lt(of.n[2], vd_set1(0)), vd_set1(-1), vd_set1(1));
    vm before = vd_le(of.low, vd_set1(search->deepest)) & vd_le(vd_set1(search->cut ? -1 : 0), of.high);
    vd edge[3][3];
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        const vd *a = of.c[(k + 1) % 3], *b = of.c[(k + 2) % 3];
        edge[k][0] = sign * (a[1] - b[1]), edge[k][1] = sign * (b[0] - a[0]),
        edge[k][2] = sign * (a[0] * b[1] - a[1] * b[0]);
        const vd square = edge[k][0] * edge[k][0] + edge[k][1] * edge[k][1];
        before =
            before & vm_not(vd_lt(edge[k][2], vd_set1(0)) & vd_lt(reach * reach * square, edge[k][2] * edge[k][2]));
    }
    const uint32_t bits = vm_bits(before) & vd_lanes_below(count);
    if (bits != 0) list_faces(work, search, &of, edge, bits, first);
}

/* Goes to an image and begins at the root of the tree. */
static void enter_image(const fibrad_workspace *work, fibrad_face_search *search) {
    const fibrad_mesh *mesh = &work->scene->mesh;
    double from[3];
    for (int axis = 0; axis < 3; axis++) {
        search->centre[axis] = work->centre[axis] - (double)search->at[axis] * mesh->period[axis];
        from[axis] = (mesh->middle[axis] - search->centre[axis]) * work->inverse;
    }
    for (int c = 0; c < 3; c++) {
        const double *f = search->frame + 3 * c;
        for (int axis = 0; axis < 3; axis++) search->box[c][axis] = f[axis] * mesh->extent * work->inverse;
        search->shift[c] = f[0] * from[0] + f[1] * from[1] + f[2] * from[2];
    }
    if (mesh->nodes > 0) enter_before(mesh, search, 0);
}

/* Goes to the next image of the stretch. False: no image is left. */
static bool next_image(const fibrad_workspace *work, fibrad_face_search *search) {
    for (int axis = 0; axis < 3; axis++) {
        if (search->at[axis]++ < search->images.last[axis]) {
            enter_image(work, search);
            return true;
        }
        search->at[axis] = search->images.first[axis];
    }
    return false;
}

/* The greatest component along an axis of a unit vector across the window. */
static double share_along(const fibrad_face_search *search, int axis) {
    const double w = search->frame[6 + axis];
    return fibrad_sqrt(fibrad_max(0, 1 - w * w));
}

static double count_images(const fibrad_mesh_images *images) {
    double count = 1;
    for (int axis = 0; axis < 3; axis++) {
        const int64_t along = images->last[axis] - images->first[axis] + 1;
        count *= along > 0 ? (double)along : 0;
    }
    return count;
}

/* Goes to the next stretch. False: no stretch is left. */
static bool enter_stretch(const fibrad_workspace *work, fibrad_face_search *search) {
    const double from = search->to, to = fibrad_min(from + search->stretch, search->deepest);
    const double aside = 1 + search->wide * (fibrad_max(0, to) + 2);
    double low[3], high[3];
    if (!(from < to)) return false;
    for (int axis = 0; axis < 3; axis++) {
        const double w = search->frame[6 + axis], a = w == 0 ? 0 : from * w, b = w == 0 ? 0 : to * w;
        const double side = aside * share_along(search, axis) + search->slack;
        low[axis] = work->centre[axis] + (fibrad_min(a, b) - side) * work->unit;
        high[axis] = work->centre[axis] + (fibrad_max(a, b) + side) * work->unit;
    }
    search->from = from, search->to = to;
    search->images = fibrad_mesh_images_in(&work->scene->mesh, low, high);
    const double images = count_images(&search->images);
    if (from > 0 && images > search->most) {
        search->rest = from;
        return false;
    }
    for (int axis = 0; axis < 3; axis++) {
        search->at[axis] = search->images.first[axis];
        if (images == 0) search->images.last[axis] = search->images.first[axis];
    }
    search->inside = true;
    if (images > 0) enter_image(work, search);
    return true;
}

void LANED(fibrad_faces_begin)(const fibrad_workspace *work, const double frame[9], double deepest, double wide,
                               double near, fibrad_face_search *search) {
    const fibrad_mesh *mesh = &work->scene->mesh;
    search->frame = frame, search->wide = wide, search->near = near, search->cut = work->clear_mesh < 1;
    search->slack = mesh->grain * work->inverse + 1e-12;
    search->nearest = search->shallow = __builtin_inf();
    search->most = IMAGES_MOST, search->rest = __builtin_inf();
    search->stretch = deepest + 1, search->to = -1;
    search->walk.level = 0, search->inside = false;
    for (int axis = 0; axis < 3; axis++) {
        const double period = mesh->period[axis] * work->inverse, w = fibrad_abs(frame[6 + axis]);
        const double ahead =
            frame[6 + axis] > 0 ? mesh->high[axis] - work->centre[axis] : work->centre[axis] - mesh->low[axis];
        const double least = w - wide * share_along(search, axis); /* component of a line along the axis, per depth */
        if (!(period > 0)) { /* the window ends where it leaves the box about all triangles */
            if (least > 0) deepest = fibrad_min(deepest, 1.0001 * (fibrad_max(0, ahead) * work->inverse + 1) / least);
            continue;
        }
        search->stretch = fibrad_min(search->stretch, fibrad_max(2, period));
        if (w > 0) deepest = fibrad_min(deepest, FIBRAD_PERIODS * period / w);
    }
    search->deepest = deepest;
    search->stretch = fibrad_max(search->stretch, deepest / FIBRAD_MESH_STRETCHES);
}

bool LANED(fibrad_faces_next)(fibrad_workspace *work, fibrad_face_search *search) {
    const fibrad_mesh *mesh = &work->scene->mesh;
    fibrad_faces *faces = &work->met->faces;
    faces->count = 0;
    if (!search->inside && !enter_stretch(work, search)) return false;
    do {
        uint32_t child;
        while (fibrad_mesh_next(&search->walk, mesh, &child)) {
            const uint32_t place = child / 16, count = fibrad_mesh_leaf(child);
            for (uint32_t k = 0; k < count; k += VD_LANES) add_faces(work, search, place + k, count - k);
            if (count == 0) enter_before(mesh, search, place);
            if (faces->count > FIBRAD_FACES - FIBRAD_MESH_WIDE) return true;
        }
    } while (next_image(work, search));
    search->inside = false;
    return search->to < search->deepest;
}
