/* fibrad_mesh.h - walls of any shape, made of triangles.
 *
 * Index
 *   fibrad_triangles       the triangles of a scene
 *   fibrad_triangles_size  bytes that triangles add to a scene
 *   fibrad_triangle_ray    the first triangle that a ray meets
 *   fibrad_triangle_views  what a triangle sees
 *
 * Units, words, errors and the layout of comments are as in fibrad.h.
 *
 * Sides    Seen from its front, the corners of a triangle go counter-clockwise. Each side belongs to a wall of kind
 *          FIBRAD_WALL_MESH, or to no wall. A side that belongs to no wall must not be seen. A call that sees such a
 *          side ends with FIBRAD_E_BACK and writes the number of the triangle. Both sides block, receive, emit and
 *          reflect alike.
 * Spheres  A triangle may cut a sphere, as in settled beds. A part of the sphere's surface then lies beyond the
 *          triangle, as seen from the centre of the sphere. What this part emits meets the triangle at once.
 * Edges    Two triangles share an edge if their corners have equal coordinates. Nothing passes between them.
 * Walls    Planes and the cylinder bound the scene. The part of a triangle that lies beyond them has no effect.
 * Periods  Triangles repeat along the periodic axes of the scene. Their corners may lie outside the box.
 * Bounds   Triangles must not be too far from the origin for their size, and must not reach over too many periods.
 *          Otherwise fibrad_scene_init returns FIBRAD_E_ARGUMENT, and fault.triangle is such a triangle. In numbers:
 *          along each axis all triangles together have an extent. Let l be half of the largest extent. No coordinate of
 *          corners, spheres and planes may be above 3e13 l. For each periodic axis let m = 2 + (extent along the axis +
 *          largest diameter of a sphere)/period. The product of all m may be at most 4096.
 * Cutoffs  Radiation of a row with a cutoff may end on a triangle beyond the cutoff. It does if the occupancy of the
 *          scene marks no cell on its way there.
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_MESH_H
#define FIBRAD_MESH_H

#include "fibrad.h"

#ifdef __cplusplus
extern "C" {
#endif

#define FIBRAD_NO_WALL UINT32_MAX

/* All triangles of all meshes of a scene, for fibrad_scene_config.triangles. fibrad_scene_init copies them.
 *
 * Example: a square of two triangles. Its front belongs to wall 0. Its back must not be seen.
 *   const double at[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
 *   const uint32_t corner[2][3] = {{0, 1, 2}, {0, 2, 3}}, front[2] = {0, 0};
 *   const fibrad_triangles square = {.x = &at[0][0], .y = &at[0][1], .z = &at[0][2], .stride = 3, .vertices = 4,
 *                                    .corner = &corner[0][0], .front = front, .n = 2}; */
typedef struct fibrad_triangles {
    const double *x, *y, *z; /* L, vertex v is x[v stride], y[v stride], z[v stride]; bounds as of fibrad_spheres */
    uint32_t stride;         /* doubles; 0: 1 */
    uint32_t vertices;       /* number of vertices */
    const uint32_t *corner;  /* [n][3], vertices of each triangle; a triangle without area is never met */
    const uint32_t *front;   /* [n], wall of each front side; FIBRAD_NO_WALL: none */
    const uint32_t *back;    /* [n], wall of each back side; FIBRAD_NO_WALL: none; NULL: none for all */
    uint32_t n;              /* number of triangles, 0 to FIBRAD_TRIANGLES_MAX */
    double period[3];        /* L, of triangles alone, along an axis that is open for spheres; 0: none */
} fibrad_triangles;

/* Bytes that n triangles add to fibrad_scene_size(spheres, ids): 135 per triangle and 4 per sphere.
 *   Errors   0 if n is above FIBRAD_TRIANGLES_MAX */
size_t fibrad_triangles_size(uint32_t n, uint32_t spheres);

/* What a ray meets first. */
typedef struct fibrad_triangle_hit {
    uint32_t triangle; /* the caller's number; UINT32_MAX: none is met */
    int back;          /* 1: the back is met, 0: the front is met */
    double distance;   /* L, from the origin of the ray */
} fibrad_triangle_hit;

/* The first triangle that a ray meets. Spheres, planes and the cylinder are ignored. Images along periodic axes count.
 *   Input    origin[3]: [L], at most 3e13 l from the middle of all triangles (see Bounds above)
 *            w[3]: a unit vector, the direction
 *            length: [L], of the ray
 *   Output   hit
 *   Errors   _ARGUMENT, _STATE
 *   Cost     1 to 2 microseconds among 1e5 triangles
 *   Source   docs/methods.md section 10 */
int fibrad_triangle_ray(const fibrad_scene *scene, const double origin[3], const double w[3], double length,
                        fibrad_triangle_hit *hit);

/* What a side of a triangle sees: fractions of the radiation that leaves the side by the cosine law. All fields are NaN
 * if the side belongs to no wall, or if no point of the side lies within the planes and the cylinder. */
typedef struct fibrad_side_view {
    double spheres; /* fraction that meets spheres */
    double walls;   /* fraction that meets walls */
    double escaped; /* fraction that reaches the surroundings */
} fibrad_side_view;

/* The views of both sides of one triangle, by quasi-random rays from evenly spread points. The result for a triangle
 * does not depend on other calls.
 *   Input    place: 0 to triangles - 1, position in the order of the scene; neighbours in space mostly follow each
 *            other
 *            rays: from each side, 1 to 2^30
 *   Output   triangle: the caller's number of the triangle; after FIBRAD_E_BACK the triangle whose side was seen
 *            view[2]: of the front and of the back
 *   Errors   _ARGUMENT, _STATE, _BACK
 *   Cost     1 microsecond per ray in a bed. The error of `spheres` is 0.007 there with 256 rays. */
int fibrad_triangle_views(const fibrad_scene *scene, uint32_t place, uint32_t rays, uint32_t *triangle,
                          fibrad_side_view view[2]);

#ifdef __cplusplus
}
#endif
#endif
