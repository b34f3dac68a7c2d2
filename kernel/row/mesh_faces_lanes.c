/* mesh_faces_lanes.c - finds the triangles that may come before a window, boxes and triangles in lanes. Compiled once
 * per instruction set. SPDX-License-Identifier: MIT */
#include FIBRAD_LANES_HEADER
#include "base/lanes/below.h"
#include "row/mesh_faces_lanes.h"

/* How far from the axis of the window its lines are down to a depth. */
FIBRAD_INLINE vd reach_at(const fibrad_face_search *search, vd depth) {
    return 1 + search->slack + search->wide * vd_max(vd_set1(0), depth);
}

/* Goes into a node, to the boxes that may come before the window, the nearest first. */
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

/* Edges of triangles as they are seen: sums u edge[0] + v edge[1] + edge[2] have the sign of the area on their inner
 * side. */
FIBRAD_INLINE void edge_between(const vd a[3], const vd b[3], vd edge[3]) {
    edge[0] = a[1] - b[1], edge[1] = b[0] - a[0], edge[2] = a[0] * b[1] - a[1] * b[0];
}

/* How deep the middle of the window meets the plane of a triangle, as far as it goes. Windows that look a little away
 * from a plane are treated as those that look as little towards it. */
FIBRAD_INLINE vd depth_of_plane(vd c[3][3], vd low, vd high) {
    vd a[3], b[3];
    for (int axis = 0; axis < 3; axis++) a[axis] = c[1][axis] - c[0][axis], b[axis] = c[2][axis] - c[0][axis];
    const vd n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    const vd size = vd_abs(n[2]), height = vd_abs(n[0] * c[0][0] + n[1] * c[0][1] + n[2] * c[0][2]);
    const vd depth = vd_select(vd_lt(vd_set1(0), size), height / size, vd_set1(__builtin_inf()));
    return vd_max(vd_max(vd_set1(0), low), vd_min(depth, high));
}

/* Lists those of up to VD_LANES triangles that may come before the window. */
static void add_faces(fibrad_workspace *work, fibrad_face_search *search, uint32_t first, uint32_t count) {
    const fibrad_mesh *mesh = &work->scene->mesh;
    fibrad_faces *faces = &work->met->faces;
    const double *f = search->frame;
    vd c[3][3];
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        vd at[3];
        for (int axis = 0; axis < 3; axis++)
            at[axis] = (vd_loadu(mesh->corner[k][axis] + first) - search->centre[axis]) * work->inverse;
        for (int axis = 0; axis < 3; axis++)
            c[k][axis] = f[3 * axis] * at[0] + f[3 * axis + 1] * at[1] + f[3 * axis + 2] * at[2];
    }
    const vd low = vd_min(c[0][2], vd_min(c[1][2], c[2][2])), high = vd_max(c[0][2], vd_max(c[1][2], c[2][2]));
    vd edge[3][3], most = vd_set1(0);
    edge_between(c[1], c[2], edge[0]), edge_between(c[2], c[0], edge[1]), edge_between(c[0], c[1], edge[2]);
    const vd sum = edge[0][2] + edge[1][2] + edge[2][2], reach = reach_at(search, vd_min(high, vd_set1(search->deepest)));
    const vd sign = vd_select(vd_lt(sum, vd_set1(0)), vd_set1(-1), vd_set1(1));
    vm before = vd_le(low, vd_set1(search->deepest)) & vd_le(vd_set1(search->cut ? -1 : 0), high);
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        const vd square = edge[k][0] * edge[k][0] + edge[k][1] * edge[k][1], e = sign * edge[k][2];
        before = before & vm_not(vd_lt(e, vd_set1(0)) & vd_lt(reach * reach * square, e * e));
        most = vd_max(most, square);
    }
    const uint32_t bits = vm_bits(before) & vd_lanes_below(count), at = faces->count;
    if (bits == 0) return;
    const vm known = vd_lt(1e-9 * most, vd_abs(sum)); /* else it is seen edge-on, or nearly so */
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        const vd rounding = search->slack * (vd_abs(edge[k][0]) + vd_abs(edge[k][1]));
        const vd rest = vd_select(known, sign * edge[k][2] + rounding, vd_set1(__builtin_inf()));
        vd_compress(faces->edge[k][0] + at, bits, sign * edge[k][0]);
        vd_compress(faces->edge[k][1] + at, bits, sign * edge[k][1]);
        vd_compress(faces->edge[k][2] + at, bits, rest);
        for (int axis = 0; axis < 3; axis++) vd_compress(faces->corner[k][axis] + at, bits, c[k][axis]);
    }
    vd_compress(faces->low + at, bits, low);
    vd_compress(faces->plane + at, bits, depth_of_plane(c, low, high));
    faces->count += vd_compress_places(faces->triangle + at, bits, first);
    for (uint32_t k = at; k < faces->count; k++) {
        search->shallow = fibrad_min(search->shallow, faces->low[k]);
        search->nearest = fibrad_min(search->nearest, faces->plane[k]);
    }
    if (search->nearest < search->near) search->wide = 0;
}

/* Turns to an image: the tree from its root. */
static void enter_image(const fibrad_workspace *work, fibrad_face_search *search) {
    const fibrad_mesh *mesh = &work->scene->mesh;
    double from[3];
    for (int axis = 0; axis < 3; axis++) {
        search->centre[axis] = work->centre[axis] - search->at[axis] * mesh->period[axis];
        from[axis] = (mesh->middle[axis] - search->centre[axis]) * work->inverse;
    }
    for (int c = 0; c < 3; c++) {
        const double *f = search->frame + 3 * c;
        for (int axis = 0; axis < 3; axis++) search->box[c][axis] = f[axis] * mesh->extent * work->inverse;
        search->shift[c] = f[0] * from[0] + f[1] * from[1] + f[2] * from[2];
    }
    if (mesh->nodes > 0) enter_before(mesh, search, 0);
}

/* Turns to the next image of the stretch; false: there is none. */
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

/* Turns to the next stretch. False: there is none. */
static bool enter_stretch(const fibrad_workspace *work, fibrad_face_search *search) {
    const double from = search->to, to = fibrad_min(from + search->stretch, search->deepest);
    const double side = 1 + 2 * search->wide * fibrad_max(0, to);
    double low[3], high[3];
    bool none = false;
    if (!(from < to)) return false;
    for (int axis = 0; axis < 3; axis++) {
        const double w = search->frame[6 + axis], a = w == 0 ? 0 : from * w, b = w == 0 ? 0 : to * w;
        low[axis] = work->centre[axis] + (fibrad_min(a, b) - side) * work->unit;
        high[axis] = work->centre[axis] + (fibrad_max(a, b) + side) * work->unit;
    }
    search->from = from, search->to = to;
    search->images = fibrad_mesh_images_in(&work->scene->mesh, low, high);
    for (int axis = 0; axis < 3; axis++) {
        search->at[axis] = search->images.first[axis];
        none = none || search->images.first[axis] > search->images.last[axis];
    }
    for (int axis = 0; none && axis < 3; axis++) search->images.last[axis] = search->images.first[axis];
    search->inside = true;
    if (!none) enter_image(work, search);
    return true;
}

void LANED(fibrad_faces_begin)(const fibrad_workspace *work, const double frame[9], double deepest, double wide,
                               double near, fibrad_face_search *search) {
    const fibrad_mesh *mesh = &work->scene->mesh;
    search->frame = frame, search->wide = wide, search->near = near, search->cut = work->clear_mesh < 1;
    search->slack = mesh->grain * work->inverse + 1e-12;
    search->nearest = search->shallow = __builtin_inf();
    search->stretch = deepest + 1, search->to = -1;
    search->walk.level = 0, search->inside = false;
    for (int axis = 0; axis < 3; axis++) {
        const double period = mesh->period[axis] * work->inverse, w = fibrad_abs(frame[6 + axis]);
        const double ahead =
            frame[6 + axis] > 0 ? mesh->high[axis] - work->centre[axis] : work->centre[axis] - mesh->low[axis];
        if (!(period > 0)) { /* the window leaves the box about all triangles */
            if (w > 2 * wide)
                deepest = fibrad_min(deepest, 1.0001 * (fibrad_max(0, ahead) * work->inverse + 1) / (w - 2 * wide));
            continue;
        }
        search->stretch = fibrad_min(search->stretch, fibrad_max(2, period));
        if (w > 0) deepest = fibrad_min(deepest, FIBRAD_PERIODS * period / w);
    }
    search->deepest = deepest;
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
