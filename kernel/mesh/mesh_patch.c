/* mesh_patch.c - cuts triangles into patches, and joins small ones. SPDX-License-Identifier: MIT */
#include "mesh/mesh.h"

#define HALVINGS_MAX 30u
#define FACING       0.7  /* least cosine between the normals of sides that share a patch */
#define FAR          2.0  /* greatest distance between the middles of such sides, in edges of a patch */
#define BEGUN        0.25 /* a patch with less than this part of its area takes any side */
#define LONGER       1e-6 /* edges whose squares differ by less count as equal, so that rotations change no choice */

/* The area of side k in the list of all sides. */
static double area_of_side(const fibrad_mesh *mesh, uint32_t number, uint32_t k) {
    return mesh->area[k] - (k > mesh->first[number] ? mesh->area[k - 1] : 0);
}

/* How often a side is halved so that its patches have about a given area: never, or at least twice. */
static uint32_t halvings_for(double own, double area) {
    uint32_t halvings = 0;
    if (own < 2 * area) return 0;
    for (; own > 1.5 * area && halvings < HALVINGS_MAX; own *= 0.5) halvings++;
    return halvings < 2 ? 2 : halvings;
}

static void middle_of_side(const fibrad_mesh *mesh, uint32_t side, double middle[3]) {
    double c[3][3];
    fibrad_mesh_corners(mesh, fibrad_side_triangle(side), c);
    for (int axis = 0; axis < 3; axis++) middle[axis] = (c[0][axis] + c[1][axis] + c[2][axis]) / 3;
}

/* A patch of several sides while it grows. */
typedef struct joint_patch {
    double area, middle[3], normal[3]; /* middle and normal are those of the first side */
} joint_patch;

static void begin_joint(const fibrad_mesh *mesh, uint32_t side, joint_patch *patch) {
    patch->area = 0;
    middle_of_side(mesh, side, patch->middle);
    fibrad_mesh_normal(mesh, side, patch->normal);
}

/* Whether a side with area `own` joins a patch. */
static bool joins(const fibrad_mesh *mesh, uint32_t side, double own, double area, const joint_patch *patch) {
    double middle[3], normal[3], square = 0, facing = 0;
    if (patch->area < BEGUN * area) return true;
    if (patch->area + 0.5 * own > area) return false;
    middle_of_side(mesh, side, middle);
    fibrad_mesh_normal(mesh, side, normal);
    for (int axis = 0; axis < 3; axis++) {
        square += (middle[axis] - patch->middle[axis]) * (middle[axis] - patch->middle[axis]);
        facing += normal[axis] * patch->normal[axis];
    }
    return facing > FACING && square < FAR * FAR * area;
}

/* Cuts the sides that are larger than two patches. */
static uint32_t cut_large(const fibrad_mesh *mesh, uint32_t number, double area, uint32_t next, fibrad_mesh_cut *cut) {
    for (uint32_t k = mesh->first[number]; k < mesh->first[number + 1]; k++) {
        const uint32_t halvings = halvings_for(area_of_side(mesh, number, k), area);
        if (halvings == 0) continue;
        if (cut != NULL) *fibrad_mesh_cut_of(mesh, cut, mesh->side[k]) = (fibrad_mesh_cut){next, halvings};
        next += UINT32_C(1) << halvings;
    }
    return next;
}

/* Joins the small fronts or the small backs. */
static uint32_t join_small(const fibrad_mesh *mesh, uint32_t number, bool back, double area, uint32_t next,
                           fibrad_mesh_cut *cut) {
    joint_patch patch = {0};
    bool begun = false;
    for (uint32_t k = mesh->first[number]; k < mesh->first[number + 1]; k++) {
        const double own = area_of_side(mesh, number, k);
        const uint32_t side = mesh->side[k];
        if (fibrad_side_is_back(side) != back || halvings_for(own, area) > 0) continue;
        if (!begun || !joins(mesh, side, own, area, &patch)) begin_joint(mesh, side, &patch), next += begun;
        begun = true;
        patch.area += own;
        if (cut != NULL) *fibrad_mesh_cut_of(mesh, cut, side) = (fibrad_mesh_cut){next, 0};
    }
    return next + begun;
}

uint32_t fibrad_mesh_cut_sides(const fibrad_mesh *mesh, uint32_t number, double area, uint32_t first,
                               fibrad_mesh_cut *cut) {
    if (!(fibrad_mesh_area(mesh, number) > 0)) return 0;
    uint32_t next = cut_large(mesh, number, area, first, cut);
    next = join_small(mesh, number, false, area, next, cut);
    return join_small(mesh, number, true, area, next, cut) - first;
}

/* The barycentric coordinates of a place on a triangle, none below 0. On periodic axes the image of the place next
 * to the triangle counts. */
static void find_shares(const fibrad_mesh *mesh, uint32_t triangle, const double at[3], double share[3]) {
    double c[3][3], aa = 0, ab = 0, bb = 0, ad = 0, bd = 0;
    fibrad_mesh_corners(mesh, triangle, c);
    for (int axis = 0; axis < 3; axis++) {
        const double low = fibrad_min(c[0][axis], fibrad_min(c[1][axis], c[2][axis]));
        const double high = fibrad_max(c[0][axis], fibrad_max(c[1][axis], c[2][axis]));
        const double period = mesh->period[axis], away = at[axis] - (0.5 * low + 0.5 * high);
        const double image = period > 0 ? period * fibrad_floor(away / period + 0.5) : 0;
        const double a = c[1][axis] - c[0][axis], b = c[2][axis] - c[0][axis], d = at[axis] - image - c[0][axis];
        aa += a * a, ab += a * b, bb += b * b, ad += a * d, bd += b * d;
    }
    const double scale = aa * bb - ab * ab;
    share[1] = scale > 0 ? fibrad_max(0, (ad * bb - bd * ab) / scale) : 0;
    share[2] = scale > 0 ? fibrad_max(0, (bd * aa - ad * ab) / scale) : 0;
    share[0] = fibrad_max(0, 1 - share[1] - share[2]);
}

uint32_t fibrad_mesh_patch_at(const fibrad_mesh *mesh, const fibrad_mesh_cut *cut, uint32_t side, const double at[3]) {
    const fibrad_mesh_cut own = cut[fibrad_side_given(mesh, side)];
    double c[3][3], share[3], square[3] = {0, 0, 0}; /* square: squared length of the edge opposite each corner */
    uint32_t number = 0;
    if (own.halvings == 0) return own.patch;
    find_shares(mesh, fibrad_side_triangle(side), at, share);
    fibrad_mesh_corners(mesh, fibrad_side_triangle(side), c);
    for (int k = 0; k < 3; k++)
        for (int axis = 0; axis < 3; axis++) {
            const double edge = c[(k + 1) % 3][axis] - c[(k + 2) % 3][axis];
            square[k] += edge * edge;
        }
    for (uint32_t h = 0; h < own.halvings; h++) {
        uint32_t top = square[1] > square[0] * (1 + LONGER) ? 1 : 0; /* the corner opposite the longest edge */
        if (square[2] > square[top] * (1 + LONGER)) top = 2;
        const uint32_t a = (top + 1) % 3, b = (top + 2) % 3, second = share[b] > share[a];
        const uint32_t kept = second ? b : a,
                       left = second ? a : b; /* the middle of the longest edge takes the index `left` */
        const double median = 0.5 * (square[a] + square[b]) - 0.25 * square[top];
        share[kept] -= share[left], share[left] *= 2;
        /* new edges: from kept to middle is opposite top; from middle to top is opposite kept; from top to kept is
         * unchanged */
        square[top] *= 0.25, square[kept] = median;
        number = 2 * number + second;
    }
    return own.patch + number;
}
