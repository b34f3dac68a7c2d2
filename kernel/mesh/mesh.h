/* mesh.h - triangles in a tree of boxes. SPDX-License-Identifier: MIT
 *
 * Side 2 t is the front of triangle t, a place in the order of the tree, and 2 t + 1 its back. Whether a line meets a
 * triangle is decided by the signs of three areas in the plane across it, each of which is exactly the opposite for the
 * two triangles at an edge: nothing passes between them. Triangles that are seen edge-on are not met. */
#ifndef FIBRAD_MESH_MESH_H
#define FIBRAD_MESH_MESH_H

#include "base/arena.h"
#include "base/port.h"
#include "fibrad_mesh.h"

#define FIBRAD_NO_SIDE UINT32_MAX
#define FIBRAD_NO_MESH UINT8_MAX

#define FIBRAD_MESH_WIDE  8u  /* boxes of a node, triangles of a leaf at most */
#define FIBRAD_MESH_DEPTH 64u /* of the tree at most */

/* In so many stretches at the most lines look for images. In each they cross hardly any period, since they look no
 * farther than 100 periods along any axis. */
#define FIBRAD_MESH_STRETCHES 1000

/* Boxes about some of the triangles, side by side: their middles, from mesh->middle, and half their edges, rounded
 * outwards; both in units of mesh->extent. Boxes that are not there have negative edges. */
typedef struct fibrad_mesh_node {
    float middle[3][FIBRAD_MESH_WIDE], half[3][FIBRAD_MESH_WIDE];
    uint32_t child[FIBRAD_MESH_WIDE]; /* a node times 16, or of a leaf its first triangle times 16 and how many */
} fibrad_mesh_node;

static inline uint32_t fibrad_mesh_leaf(uint32_t child) { return child % 16; } /* how many triangles; 0: a node */

/* Meshes are numbered as their bodies come. */
typedef struct fibrad_mesh {
    uint32_t triangles, nodes;
    double period[3];                      /* [L] 0: the axis is open */
    double low[3], high[3];                /* [L] of all triangles */
    double middle[3];                      /* [L] */
    double extent;                         /* [L] from there to the farthest of low and high, along any axis */
    double grain;                          /* [L] lengths below this may be rounding */
    fibrad_mesh_node *node;                /* [nodes] */
    double *corner[3][3];                  /* [triangles] of each corner x, y, z [L]; whole eights can be read */
    uint32_t *number;                      /* [triangles] the caller's */
    uint8_t (*mesh)[2];                    /* [triangles] whose front and back are; FIBRAD_NO_MESH: nobody's */
    uint32_t *side;                        /* [2 triangles] the sides of the first mesh, then those of the second ... */
    double *area;                          /* [2 triangles] of the mesh's sides up to this one [L^2] */
    uint32_t first[FIBRAD_BODIES_MAX + 1]; /* where those of each mesh begin */
} fibrad_mesh;

static inline void fibrad_mesh_corners(const fibrad_mesh *mesh, uint32_t triangle, double corner[3][3]) {
    for (int k = 0; k < 3; k++)
        for (int axis = 0; axis < 3; axis++) corner[k][axis] = mesh->corner[k][axis][triangle];
}

/* A walk through the tree, nodes within nodes: which they are, and which of their boxes are left, the next one last. */
typedef struct fibrad_mesh_walk {
    uint32_t node[FIBRAD_MESH_DEPTH], level;
    uint8_t box[FIBRAD_MESH_DEPTH][FIBRAD_MESH_WIDE], left[FIBRAD_MESH_DEPTH];
} fibrad_mesh_walk;

/* Goes into a node, to its boxes given by bits, in the order of their keys. */
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

/* The next child; false: there is none left. A box that is not there has the root as its child, which is none. */
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

/* Takes the arrays of so many triangles from the arena. */
void fibrad_mesh_layout(fibrad_arena *arena, fibrad_mesh *mesh, uint32_t triangles);

/* Fills a mesh that is laid out. mesh_of [bodies]: which mesh a body is, or FIBRAD_NO_MESH. longest: of coordinates and
 * periods. FIBRAD_E_ARGUMENT: *fault is the triangle, UINT32_MAX if it is none. */
int fibrad_mesh_build(fibrad_mesh *mesh, const struct fibrad_triangles *given, const double period[3],
                      const uint8_t *mesh_of, uint32_t bodies, double longest, uint32_t *fault);

/* The caller's number of a triangle that reaches highest along an axis. */
uint32_t fibrad_mesh_highest(const fibrad_mesh *mesh, int axis);

/* Area of a triangle [L^2]. */
double fibrad_mesh_triangle_area(const fibrad_mesh *mesh, uint32_t triangle);

/* Area of a mesh [L^2], both sides if both are its own. */
double fibrad_mesh_area(const fibrad_mesh *mesh, uint32_t number);

/* The distance [L] from a point to the nearest triangle, or its image, not more than `most`, rounded down. */
double fibrad_mesh_distance(const fibrad_mesh *mesh, const double point[3], double most);

/* The images of a mesh whose boxes meet a box [L]: shifts by whole periods, first[axis] to last[axis]. */
typedef struct fibrad_mesh_images {
    int64_t first[3], last[3];
} fibrad_mesh_images;
fibrad_mesh_images fibrad_mesh_images_in(const fibrad_mesh *mesh, const double low[3], const double high[3]);

/* What a ray meets. */
typedef struct fibrad_mesh_hit {
    uint32_t side;   /* FIBRAD_NO_SIDE: nothing */
    double distance; /* [L] */
} fibrad_mesh_hit;

/* The first side that a ray from `origin` [L] along the unit vector w meets within the length `to`, which may be
 * infinite. Fronts count from a grain behind the origin on, backs from a grain after it; `except`: the triangle
 * that the ray leaves, which does not count but for images beside it, or FIBRAD_NO_SIDE. */
fibrad_mesh_hit fibrad_mesh_first(const fibrad_mesh *mesh, const double origin[3], const double w[3], double to,
                                  uint32_t except);

/* The outward unit normal of a side. */
void fibrad_mesh_normal(const fibrad_mesh *mesh, uint32_t side, double normal[3]);

/* An even point [L] of a triangle for two numbers in [0, 1]. */
void fibrad_mesh_triangle_point(const fibrad_mesh *mesh, uint32_t triangle, const double share[2], double point[3]);

/* An even point [L] on a mesh for two numbers in [0, 1); returns its side. */
uint32_t fibrad_mesh_point(const fibrad_mesh *mesh, uint32_t number, const double share[2], double point[3]);

#endif
