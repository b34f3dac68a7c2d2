/* mesh_build.c - puts triangles into a tree of boxes, in fixed memory. SPDX-License-Identifier: MIT
 *
 * The tree is built from the top. In each node the largest box is cut in two until there are eight. A cut is across
 * the longest axis, at one of sixteen places: where the sum over both parts of surface times number of triangles is
 * least. This separates large triangles from small ones. Source: I. Wald, IEEE Symposium on Interactive Ray Tracing
 * (2007) 33. */
#include "mesh/mesh.h"

#define BINS       16
#define BY_SURFACE (FIBRAD_MESH_DEPTH / 2) /* number of cuts that compare surfaces; further cuts halve a box */
#define NO_BOX     (-1e30f)

void fibrad_mesh_layout(fibrad_arena *arena, fibrad_mesh *mesh, uint32_t triangles) {
    const size_t n = triangles;
    mesh->triangles = triangles;
    mesh->node = fibrad_arena_take(arena, n / (FIBRAD_MESH_WIDE - 1) + 1, sizeof *mesh->node);
    for (int k = 0; k < 3; k++)
        for (int axis = 0; axis < 3; axis++)
            mesh->corner[k][axis] = fibrad_arena_take(arena, n + FIBRAD_MESH_WIDE, sizeof(double));
    mesh->number = fibrad_arena_take(arena, n, sizeof *mesh->number);
    mesh->mesh = fibrad_arena_take(arena, n, sizeof *mesh->mesh);
    mesh->side = fibrad_arena_take(arena, 2 * n, sizeof *mesh->side);
    mesh->area = fibrad_arena_take(arena, 2 * n, sizeof *mesh->area);
}

size_t fibrad_triangles_size(uint32_t n, uint32_t spheres) {
    fibrad_arena arena = {0};
    fibrad_mesh mesh;
    if (n > FIBRAD_TRIANGLES_MAX) return 0;
    fibrad_mesh_layout(&arena, &mesh, n);
    fibrad_arena_take(&arena, spheres, sizeof(float));
    return fibrad_arena_total(&arena);
}

typedef struct mesh_box {
    double low[3], high[3];
} mesh_box;

static const mesh_box no_box = {{__builtin_inf(), __builtin_inf(), __builtin_inf()},
                                {-__builtin_inf(), -__builtin_inf(), -__builtin_inf()}};

static void box_add(mesh_box *box, const mesh_box *other) {
    for (int axis = 0; axis < 3; axis++) {
        box->low[axis] = fibrad_min(box->low[axis], other->low[axis]);
        box->high[axis] = fibrad_max(box->high[axis], other->high[axis]);
    }
}

static mesh_box triangle_box(const fibrad_mesh *mesh, uint32_t t) {
    mesh_box box;
    for (int axis = 0; axis < 3; axis++) {
        const double a = mesh->corner[0][axis][t], b = mesh->corner[1][axis][t], c = mesh->corner[2][axis][t];
        box.low[axis] = fibrad_min(a, fibrad_min(b, c)), box.high[axis] = fibrad_max(a, fibrad_max(b, c));
    }
    return box;
}

/* Half the surface of a box over the square of a length. This keeps the number finite. */
static double surface_of(const mesh_box *box, double length) {
    double edge[3];
    for (int axis = 0; axis < 3; axis++) {
        edge[axis] = (box->high[axis] - box->low[axis]) / length;
        if (!(edge[axis] >= 0)) return 0;
    }
    return edge[0] * edge[1] + edge[1] * edge[2] + edge[2] * edge[0];
}

static double middle_of(const fibrad_mesh *mesh, uint32_t t, int axis) {
    const mesh_box box = triangle_box(mesh, t);
    return 0.5 * box.low[axis] + 0.5 * box.high[axis];
}

static void swap_triangles(fibrad_mesh *mesh, uint32_t a, uint32_t b) {
    for (int k = 0; k < 3; k++)
        for (int axis = 0; axis < 3; axis++) {
            double *corner = mesh->corner[k][axis], first = corner[a];
            corner[a] = corner[b], corner[b] = first;
        }
    const uint32_t number = mesh->number[a];
    mesh->number[a] = mesh->number[b], mesh->number[b] = number;
}

/* Triangles [begin, end), their box, and the number of cuts above them. */
typedef struct mesh_part {
    uint32_t begin, end, depth;
    mesh_box box;
} mesh_part;

static mesh_part part_of(const fibrad_mesh *mesh, uint32_t begin, uint32_t end, uint32_t depth) {
    mesh_part part = {begin, end, depth, no_box};
    for (uint32_t t = begin; t < end; t++) {
        const mesh_box own = triangle_box(mesh, t);
        box_add(&part.box, &own);
    }
    return part;
}

/* The bin of a coordinate between low and high. */
static int place_of_bin(double at, double low, double high) {
    const double share = (at - low) / (high - low) * BINS;
    return share >= BINS - 1 ? BINS - 1 : (int)fibrad_max(0, share);
}

/* Moves the triangles whose bin is at most `cut` to the front. Returns where the others begin. */
static uint32_t move_below(fibrad_mesh *mesh, const mesh_part *part, int axis, double low, double high, int cut) {
    uint32_t to = part->begin;
    for (uint32_t t = part->begin; t < part->end; t++)
        if (place_of_bin(middle_of(mesh, t, axis), low, high) <= cut) swap_triangles(mesh, t, to++);
    return to;
}

/* The place where a part is cut in two. */
static uint32_t cut_part(fibrad_mesh *mesh, const mesh_part *part) {
    const uint32_t count = part->end - part->begin;
    mesh_box middles = no_box, bin[BINS], right[BINS];
    uint32_t in_bin[BINS] = {0}, on_right = 0, on_left = 0;
    for (uint32_t t = part->begin; t < part->end; t++)
        for (int axis = 0; axis < 3; axis++) {
            const double at = middle_of(mesh, t, axis);
            middles.low[axis] = fibrad_min(middles.low[axis], at);
            middles.high[axis] = fibrad_max(middles.high[axis], at);
        }
    int axis = 0, best = -1;
    for (int a = 1; a < 3; a++)
        if (middles.high[a] - middles.low[a] > middles.high[axis] - middles.low[axis]) axis = a;
    const double low = middles.low[axis], high = middles.high[axis];
    if (!(high > low) || part->depth >= BY_SURFACE) return part->begin + count / 2;
    for (int b = 0; b < BINS; b++) bin[b] = no_box;
    for (uint32_t t = part->begin; t < part->end; t++) {
        const int b = place_of_bin(middle_of(mesh, t, axis), low, high);
        const mesh_box own = triangle_box(mesh, t);
        box_add(&bin[b], &own);
        in_bin[b]++;
    }
    right[BINS - 1] = bin[BINS - 1];
    for (int b = BINS - 1; b-- > 0;) right[b] = bin[b], box_add(&right[b], &right[b + 1]);
    double least = __builtin_inf(), length = 0;
    for (int a = 0; a < 3; a++) length = fibrad_max(length, part->box.high[a] - part->box.low[a]);
    mesh_box left = no_box;
    on_right = count;
    for (int b = 0; b + 1 < BINS; b++) {
        box_add(&left, &bin[b]);
        on_left += in_bin[b], on_right -= in_bin[b];
        if (on_left == 0 || on_right == 0) continue;
        const double cost = on_left * surface_of(&left, length) + on_right * surface_of(&right[b + 1], length);
        if (cost < least) least = cost, best = b;
    }
    return best < 0 ? part->begin + count / 2 : move_below(mesh, part, axis, low, high, best);
}

static void set_box(const fibrad_mesh *mesh, fibrad_mesh_node *node, uint32_t place, const mesh_box *box) {
    for (int axis = 0; axis < 3; axis++) {
        const double low = (box->low[axis] - mesh->middle[axis]) / mesh->extent;
        const double high = (box->high[axis] - mesh->middle[axis]) / mesh->extent;
        const float middle = (float)(0.5 * low + 0.5 * high);
        const double half = fibrad_max(high - (double)middle, (double)middle - low) + 2 * mesh->grain / mesh->extent;
        node->middle[axis][place] = middle, node->half[axis][place] = (float)(half * (1 + 2e-7));
    }
}

/* Cuts the largest box among those with more triangles than a leaf holds. False: there is no such box. */
static bool cut_largest(fibrad_mesh *mesh, mesh_part *part, uint32_t *parts) {
    double most = -1;
    uint32_t largest = 0;
    for (uint32_t k = 0; k < *parts; k++) {
        const double surface = surface_of(&part[k].box, mesh->extent);
        if (part[k].end - part[k].begin > FIBRAD_MESH_WIDE && surface > most) most = surface, largest = k;
    }
    if (most < 0) return false;
    mesh_part *cut = &part[largest];
    const uint32_t begin = cut->begin, end = cut->end, middle = cut_part(mesh, cut), depth = cut->depth + 1;
    *cut = part_of(mesh, begin, middle, depth);
    part[(*parts)++] = part_of(mesh, middle, end, depth);
    return true;
}

/* Builds the tree level by level. A node that is still to be divided has its triangles in child[0] to child[1] and
 * its cuts in child[2]. A node has either eight boxes or only leaves. Hence there is at most one node for seven
 * triangles. */
static void build_tree(fibrad_mesh *mesh) {
    mesh_part part[FIBRAD_MESH_WIDE];
    mesh->nodes = mesh->triangles > 0;
    if (mesh->nodes > 0) mesh->node[0] = (fibrad_mesh_node){.child = {0, mesh->triangles, 0}};
    for (uint32_t k = 0; k < mesh->nodes; k++) {
        fibrad_mesh_node *node = &mesh->node[k];
        uint32_t parts = 1;
        part[0] = part_of(mesh, node->child[0], node->child[1], node->child[2]);
        while (parts < FIBRAD_MESH_WIDE && cut_largest(mesh, part, &parts)) {}
        for (uint32_t place = 0; place < FIBRAD_MESH_WIDE; place++) {
            const mesh_part *own = &part[place];
            node->child[place] = 0;
            for (int axis = 0; axis < 3; axis++) node->half[axis][place] = NO_BOX;
            if (place >= parts) continue;
            set_box(mesh, node, place, &own->box);
            node->child[place] = own->begin * 16 + (own->end - own->begin);
            if (own->end - own->begin <= FIBRAD_MESH_WIDE) continue;
            node->child[place] = mesh->nodes * 16;
            mesh->node[mesh->nodes++] = (fibrad_mesh_node){.child = {own->begin, own->end, own->depth}};
        }
    }
}

double fibrad_mesh_triangle_area(const fibrad_mesh *mesh, uint32_t triangle) {
    double corner[3][3], a[3], b[3];
    fibrad_mesh_corners(mesh, triangle, corner);
    for (int axis = 0; axis < 3; axis++)
        a[axis] = corner[1][axis] - corner[0][axis], b[axis] = corner[2][axis] - corner[0][axis];
    const double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    return 0.5 * fibrad_sqrt(x * x + y * y + z * z);
}

uint32_t fibrad_mesh_highest(const fibrad_mesh *mesh, int axis) {
    uint32_t t = 0;
    while (t + 1 < mesh->triangles && !(triangle_box(mesh, t).high[axis] == mesh->high[axis])) t++;
    return mesh->number[t];
}

/* Lists the sides of each mesh with the running sum of their areas. */
static void list_sides(fibrad_mesh *mesh) {
    uint32_t end[FIBRAD_WALLS_MAX + 1] = {0};
    for (uint32_t s = 0; s < 2 * mesh->triangles; s++)
        if (fibrad_side_mesh(mesh, s) != FIBRAD_NO_MESH) end[fibrad_side_mesh(mesh, s) + 1]++;
    for (uint32_t m = 0; m < FIBRAD_WALLS_MAX; m++) end[m + 1] += end[m];
    fibrad_copy(mesh->first, end, sizeof mesh->first);
    for (uint32_t s = 0; s < 2 * mesh->triangles; s++) {
        const uint8_t m = fibrad_side_mesh(mesh, s);
        if (m == FIBRAD_NO_MESH) continue;
        const uint32_t at = end[m]++;
        mesh->side[at] = s;
        mesh->area[at] =
            fibrad_mesh_triangle_area(mesh, fibrad_side_triangle(s)) + (at > mesh->first[m] ? mesh->area[at - 1] : 0);
    }
}

double fibrad_mesh_area(const fibrad_mesh *mesh, uint32_t number) {
    const uint32_t end = mesh->first[number + 1];
    return end > mesh->first[number] ? mesh->area[end - 1] : 0;
}

/* Copies a triangle. longest: bound of its coordinates [L]. False: the triangle is not valid. */
static bool take_triangle(fibrad_mesh *mesh, const struct fibrad_triangles *given, uint32_t t, double longest) {
    const size_t stride = given->stride > 0 ? given->stride : 1;
    for (int k = 0; k < 3; k++) {
        const size_t v = given->corner[3 * (size_t)t + (size_t)k];
        if (v >= given->vertices) return false;
        const double at[3] = {given->x[v * stride], given->y[v * stride], given->z[v * stride]};
        for (int axis = 0; axis < 3; axis++) {
            if (!(fibrad_abs(at[axis]) <= longest)) return false;
            mesh->corner[k][axis][t] = at[axis];
            mesh->low[axis] = fibrad_min(mesh->low[axis], at[axis]);
            mesh->high[axis] = fibrad_max(mesh->high[axis], at[axis]);
        }
    }
    mesh->number[t] = t;
    return true;
}

/* The mesh of a side whose wall is `wall`. False: there is no such wall. */
static bool mesh_of_side(uint32_t wall, const uint8_t *mesh_of, uint32_t walls, uint8_t *number) {
    *number = FIBRAD_NO_MESH;
    if (wall == FIBRAD_NO_WALL) return true;
    if (wall >= walls || mesh_of[wall] == FIBRAD_NO_MESH) return false;
    *number = mesh_of[wall];
    return true;
}

int fibrad_mesh_build(fibrad_mesh *mesh, const struct fibrad_triangles *given, const double period[3],
                      const uint8_t *mesh_of, uint32_t walls, double longest, uint32_t *fault) {
    const bool arrays = given->x != NULL && given->y != NULL && given->z != NULL && given->corner != NULL;
    *fault = UINT32_MAX;
    if (given->n > 0 && (!arrays || given->front == NULL)) return FIBRAD_E_ARGUMENT;
    for (int axis = 0; axis < 3; axis++) {
        mesh->period[axis] = period[axis] > 0 ? period[axis] : given->period[axis];
        if (!(mesh->period[axis] >= 0 && mesh->period[axis] <= longest)) return FIBRAD_E_ARGUMENT;
    }
    for (int axis = 0; axis < 3; axis++) mesh->low[axis] = __builtin_inf(), mesh->high[axis] = -__builtin_inf();
    for (uint32_t t = 0; t < given->n; t++) {
        uint8_t ignored;
        *fault = t;
        if (!take_triangle(mesh, given, t, longest) || !mesh_of_side(given->front[t], mesh_of, walls, &ignored) ||
            (given->back != NULL && !mesh_of_side(given->back[t], mesh_of, walls, &ignored)))
            return FIBRAD_E_ARGUMENT;
    }
    double scale = 0;
    mesh->extent = 0;
    for (int axis = 0; axis < 3; axis++) {
        mesh->middle[axis] = 0.5 * mesh->low[axis] + 0.5 * mesh->high[axis];
        const double far = fibrad_max(fibrad_abs(mesh->low[axis]), fibrad_abs(mesh->high[axis]));
        scale = fibrad_max(scale, far + (mesh->high[axis] - mesh->low[axis]));
        mesh->extent = fibrad_max(mesh->extent, 0.5 * (mesh->high[axis] - mesh->low[axis]));
    }
    if (!(mesh->extent > 0)) mesh->extent = 1;
    mesh->grain = 1e-11 * scale;
    build_tree(mesh);
    for (uint32_t t = 0; t < mesh->triangles; t++) { /* from here on in the order of the tree */
        mesh_of_side(given->front[mesh->number[t]], mesh_of, walls, &mesh->mesh[t][0]);
        mesh_of_side(given->back != NULL ? given->back[mesh->number[t]] : FIBRAD_NO_WALL, mesh_of, walls,
                     &mesh->mesh[t][1]);
    }
    list_sides(mesh);
    return FIBRAD_OK;
}
