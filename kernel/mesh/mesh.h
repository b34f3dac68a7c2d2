/* mesh.h - triangles in a tree of boxes. SPDX-License-Identifier: MIT
 *
 * Triangles are numbered in the order of the tree. Each has two sides, front and back. A line meets a triangle if three
 * areas in the plane across the line have one sign. If two triangles share an edge, their areas at this edge are
 * exactly opposite. Hence nothing passes between the triangles. A triangle that is seen edge-on is not met. */
#ifndef FIBRAD_MESH_MESH_H
#define FIBRAD_MESH_MESH_H

#include "base/arena.h"
#include "fibrad_mesh.h"

/* ---- triangles in a tree of boxes -------------------------------------------------------------------------------- */

/* The largest coordinate, in smallest radii or half lengths of all meshes together. It leaves room for the digits of a
 * radius. */
#define FIBRAD_COORDINATE_MAX 0x1p45

/* No search goes farther than this many periods along a periodic axis. */
#define FIBRAD_PERIODS 100.0

#define FIBRAD_NO_SIDE UINT32_MAX
#define FIBRAD_NO_MESH UINT8_MAX

#define FIBRAD_MESH_WIDE  8u  /* boxes of a node, and largest number of triangles in a leaf */
#define FIBRAD_MESH_DEPTH 64u /* greatest depth of the tree */

/* A long line is divided into this many pieces at most, which search for images one by one. A line ends after 100
 * periods along any axis, so that a piece crosses hardly any period. */
#define FIBRAD_MESH_STRETCHES 1000

/* The boxes of a node. Middles are relative to mesh->middle. Half edges are rounded outwards. Both are in units of
 * mesh->extent. A box that does not exist has negative edges. */
typedef struct fibrad_mesh_node {
    float middle[3][FIBRAD_MESH_WIDE], half[3][FIBRAD_MESH_WIDE];
    uint32_t child[FIBRAD_MESH_WIDE]; /* 16 times the index of a node; or, for a leaf, 16 times its first triangle
                                         plus the number of its triangles */
} fibrad_mesh_node;

static inline uint32_t fibrad_mesh_leaf(uint32_t child) { return child % 16; } /* number of triangles; 0: a node */

/* The triangles of all meshes. Meshes are numbered in the order of their walls. */
typedef struct fibrad_mesh {
    uint32_t triangles, nodes;
    double period[3];       /* L; 0: the axis is open */
    double low[3], high[3]; /* L, box of all triangles */
    double middle[3];       /* L, of this box */
    double extent;          /* L, half the longest edge of this box */
    double grain;           /* L, lengths below this may be rounding errors */
    fibrad_mesh_node *node; /* [nodes] */
    double *corner[3][3];   /* L, [triangles], x, y and z of each corner; padded to a multiple of eight */
    uint32_t *number;       /* [triangles], the caller's number */
    uint8_t (*mesh)[2];     /* [triangles], mesh of front and back; FIBRAD_NO_MESH: no wall */
    uint32_t *side;         /* [2 triangles], the sides of all meshes, mesh by mesh */
    double *area;           /* L^2, [2 triangles], sum of the areas from the first side of the mesh to this side */
    uint32_t first[FIBRAD_WALLS_MAX + 1]; /* first element of side and area of each mesh */
} fibrad_mesh;

/* The side of a triangle; the triangle of a side, and whether the side is its back. */
static inline uint32_t fibrad_side(uint32_t triangle, bool back) { return 2 * triangle + back; }
static inline uint32_t fibrad_side_triangle(uint32_t side) { return side / 2; }
static inline bool fibrad_side_is_back(uint32_t side) { return side % 2 != 0; }

/* The mesh of a side, or FIBRAD_NO_MESH; the caller's number of its triangle; the number of the side in the caller's
 * order, which is 2 times that number, plus 1 for backs. */
static inline uint8_t fibrad_side_mesh(const fibrad_mesh *mesh, uint32_t side) {
    return mesh->mesh[fibrad_side_triangle(side)][fibrad_side_is_back(side)];
}
static inline uint32_t fibrad_side_number(const fibrad_mesh *mesh, uint32_t side) {
    return mesh->number[fibrad_side_triangle(side)];
}
static inline uint64_t fibrad_side_given(const fibrad_mesh *mesh, uint32_t side) {
    return fibrad_side(fibrad_side_number(mesh, side), fibrad_side_is_back(side));
}

static inline void fibrad_mesh_corners(const fibrad_mesh *mesh, uint32_t triangle, double corner[3][3]) {
    for (int k = 0; k < 3; k++)
        for (int axis = 0; axis < 3; axis++) corner[k][axis] = mesh->corner[k][axis][triangle];
}

/* A walk through the tree. Each level has a node and its boxes that are left to visit. The last of them comes next. */
typedef struct fibrad_mesh_walk {
    uint32_t node[FIBRAD_MESH_DEPTH], level;
    uint8_t box[FIBRAD_MESH_DEPTH][FIBRAD_MESH_WIDE], left[FIBRAD_MESH_DEPTH];
} fibrad_mesh_walk;

/* Enters a node whose boxes given by bits are to be visited, in ascending order of their keys. */
static inline void fibrad_mesh_enter(fibrad_mesh_walk *walk, uint32_t node, uint32_t boxes,
                                     const float key[FIBRAD_MESH_WIDE]) {
    uint8_t *box = walk->box[walk->level], count = 0;
    for (; boxes != 0; boxes &= boxes - 1) {
        const uint8_t own = (uint8_t)__builtin_ctz(boxes);
        uint8_t to = count++;
        for (; to > 0 && key[box[to - 1]] < key[own]; to--) box[to] = box[to - 1];
        box[to] = own;
    }
    walk->node[walk->level] = node, walk->left[walk->level++] = count;
}

/* The next child to visit. False: no child is left. A box that does not exist has child 0, which is the root. Such a
 * child is passed over. */
static inline bool fibrad_mesh_next(fibrad_mesh_walk *walk, const fibrad_mesh *mesh, uint32_t *child) {
    while (walk->level > 0) {
        const uint32_t top = walk->level - 1;
        if (walk->left[top] == 0) {
            walk->level--;
            continue;
        }
        *child = mesh->node[walk->node[top]].child[walk->box[top][--walk->left[top]]];
        if (*child != 0) return true;
    }
    return false;
}

/* Takes the arrays of this many triangles from the arena. */
void fibrad_mesh_layout(fibrad_arena *arena, fibrad_mesh *mesh, uint32_t triangles);

/* Fills a mesh that is laid out.
 *   Input    mesh_of[walls]: mesh of each wall, or FIBRAD_NO_MESH
 *            longest: [L], bound of coordinates and periods
 *   Output   fault: the triangle at fault, or UINT32_MAX
 *   Errors   FIBRAD_E_ARGUMENT */
int fibrad_mesh_build(fibrad_mesh *mesh, const struct fibrad_triangles *given, const double period[3],
                      const uint8_t *mesh_of, uint32_t walls, double longest, uint32_t *fault);

/* The caller's number of a triangle that reaches highest along an axis. */
uint32_t fibrad_mesh_highest(const fibrad_mesh *mesh, int axis);

/* Area of a triangle [L^2]. */
double fibrad_mesh_triangle_area(const fibrad_mesh *mesh, uint32_t triangle);

/* Area of a mesh [L^2], the sum over all sides that belong to it. */
double fibrad_mesh_area(const fibrad_mesh *mesh, uint32_t number);

/* Lower bound of the distance [L] from a point to the nearest triangle or image, at most `most`. */
double fibrad_mesh_distance(const fibrad_mesh *mesh, const double point[3], double most);

/* Which images of triangles may lie in a box [L]: those shifted by first[axis] to last[axis] periods along each
 * axis. */
typedef struct fibrad_mesh_images {
    int64_t first[3], last[3];
} fibrad_mesh_images;
fibrad_mesh_images fibrad_mesh_images_in(const fibrad_mesh *mesh, const double low[3], const double high[3]);

/* What a ray meets first. */
typedef struct fibrad_mesh_hit {
    uint32_t side;   /* FIBRAD_NO_SIDE: none */
    double distance; /* L */
} fibrad_mesh_hit;

/* The first side that a ray from `origin` [L] along the unit vector w meets within the length `to`, which may be
 * infinite. Fronts count from one grain behind the origin on, and backs from one grain after the origin on. `except` is
 * the triangle that the ray leaves, or FIBRAD_NO_SIDE. This triangle does not count, but its images do. */
fibrad_mesh_hit fibrad_mesh_first(const fibrad_mesh *mesh, const double origin[3], const double w[3], double to,
                                  uint32_t except);

/* The outward unit normal of a side. */
void fibrad_mesh_normal(const fibrad_mesh *mesh, uint32_t side, double normal[3]);

/* The point [L] of a triangle for two numbers from 0 to 1. Evenly spread numbers give evenly spread points. */
void fibrad_mesh_triangle_point(const fibrad_mesh *mesh, uint32_t triangle, const double share[2], double point[3]);

/* The point [L] of a mesh for two numbers from 0 to below 1. Evenly spread numbers give evenly spread points.
 * Returns the side. */
uint32_t fibrad_mesh_point(const fibrad_mesh *mesh, uint32_t number, const double share[2], double point[3]);

/* The sides of a mesh lie one after another, each as long as its area. Returns the index in mesh->side of the side
 * at `at` [L^2], and the sum of the areas before this side. */
uint32_t fibrad_mesh_side_at(const fibrad_mesh *mesh, uint32_t number, double at, double *before);

/* ---- the patches of a mesh --------------------------------------------------------------------------------------- */

/* A side that is larger than two patches is halved across its longest edge. The halves are halved again, and so on.
 * So all patches of a side have the same area. Four patches in a row form the triangle that the side had two
 * halvings before. Smaller sides share a patch if they are near each other in the tree and face the same way. */

/* The first patch of a side, and how many times the side is halved. */
typedef struct fibrad_mesh_cut {
    uint32_t patch; /* UINT32_MAX: the side belongs to no wall */
    uint32_t halvings;
} fibrad_mesh_cut;

/* Cuts a mesh into patches of about an area [L^2]. The patches are numbered from `first` on. Returns the number of
 * patches. cut: [2 triangles], front and back of each triangle in the order of the caller's numbers. So `cut` stays
 * valid when the triangles move. NULL: the function only counts. */
uint32_t fibrad_mesh_cut_sides(const fibrad_mesh *mesh, uint32_t number, double area, uint32_t first,
                               fibrad_mesh_cut *cut);

/* The cut of a side. */
static inline fibrad_mesh_cut *fibrad_mesh_cut_of(const fibrad_mesh *mesh, fibrad_mesh_cut *cut, uint32_t side) {
    return &cut[fibrad_side_given(mesh, side)];
}

/* The patch at a place [L] on a side of a mesh, or on an image of it. */
uint32_t fibrad_mesh_patch_at(const fibrad_mesh *mesh, const fibrad_mesh_cut *cut, uint32_t side, const double at[3]);

#endif
