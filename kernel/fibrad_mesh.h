/* fibrad_mesh.h - walls of any shape: triangles in a scene.
 *
 * Index: fibrad_triangles, fibrad_triangles_size, fibrad_triangle_ray, fibrad_triangle_views. Conventions are those of
 * fibrad.h.
 *
 * Sides    Seen from its front a triangle's corners go counter-clockwise. Each side belongs to a body of kind
 *          FIBRAD_BODY_MESH, or to none: then it must not be seen, and whatever sees it ends with FIBRAD_E_BACK and
 *          the number of the triangle. Triangles block, receive, emit and reflect on both sides alike.
 * Spheres  may be cut by triangles, as in settled beds: what a sphere emits where its surface lies beyond a triangle,
 *          as seen from its centre, meets that triangle at once.
 * Edges    Triangles share an edge if their corners there have equal coordinates; then nothing passes between them.
 * Walls    Planes and the cylinder bound the scene as ever; what of a triangle lies beyond them plays no part.
 * Periods  On periodic axes triangles are repeated with the period, wherever their corners are.
 * Bounds   No coordinate of corners, spheres and planes is above 3e13 times half the length of all triangles together,
 *          and at most 4096 images of them lie at one place (the product along all periodic axes of 2 + (length +
 *          largest diameter)/period), else FIBRAD_E_ARGUMENT; fault.triangle is one that is too far, small or long.
 * Parts    Rows with a cutoff meet triangles beyond it where the occupancy of fibrad_part.h leaves their way clear.
 *
 * SPDX-License-Identifier: MIT */
#ifndef FIBRAD_MESH_H
#define FIBRAD_MESH_H

#include "fibrad.h"

#ifdef __cplusplus
extern "C" {
#endif

#define FIBRAD_TRIANGLES_MAX 100000000u
#define FIBRAD_NO_BODY       UINT32_MAX

/* All triangles of a scene, of all its meshes; fibrad_scene_config.triangles. Copied. */
typedef struct fibrad_triangles {
    const double *x, *y, *z; /* [L] vertex v is at x[v stride], y[v stride], z[v stride]; bounds as of spheres */
    uint32_t stride;         /* in doubles; 0: 1 */
    uint32_t vertices;
    const uint32_t *corner; /* [n][3] vertices; triangles without area are never met */
    const uint32_t *front;  /* [n] body of the front side, FIBRAD_NO_BODY: none */
    const uint32_t *back;   /* [n] likewise; NULL: no triangle's back may be seen */
    uint32_t n;             /* [0, FIBRAD_TRIANGLES_MAX] */
    double period[3]; /* [L] by which triangles alone are repeated, along open axes of the scene; 0: they are not */
} fibrad_triangles;

/* Bytes that n triangles add to fibrad_scene_size(spheres, ids), 135 each and 4 a sphere. Errors: 0 if there are too
 * many. */
size_t fibrad_triangles_size(uint32_t n, uint32_t spheres);

/* What a ray meets first. */
typedef struct fibrad_triangle_hit {
    uint32_t triangle; /* the caller's number; UINT32_MAX: the ray meets none */
    int back;          /* 1: its back */
    double distance;   /* [L] */
} fibrad_triangle_hit;

/* The first triangle that a ray from `origin` [L] along the unit vector w meets within the length [L], spheres and
 * other walls apart; images along periodic axes count. Errors: _ARGUMENT (also an origin 3e13 times as far from the
 * middle of all triangles as half their length), _STATE. Cost: a microsecond or two among 1e5.
 */
int fibrad_triangle_ray(const fibrad_scene *scene, const double origin[3], const double w[3], double length,
                        fibrad_triangle_hit *hit);

/* Where what a side sends out goes, of all directions by the cosine law. */
typedef struct fibrad_side_view {
    double spheres; /* NaN, as all: the side is nobody's, or no point of it lies within planes and cylinder */
    double bodies;
    double escaped; /* 1 less the others */
} fibrad_side_view;

/* The views of a triangle's front and back by `rays` [1, 2^30] quasi-random rays from even points of each; place [0,
 * triangles): which one in the order of the scene, so that those near each other follow each other. *triangle out: the
 * caller's number, of the one whose back is seen after FIBRAD_E_BACK. The same whatever else is asked. Error of
 * spheres in a bed 0.007 with 256 rays. Errors: _ARGUMENT, _STATE, _BACK. Cost: about a microsecond a ray in a bed. */
int fibrad_triangle_views(const fibrad_scene *scene, uint32_t place, uint32_t rays, uint32_t *triangle,
                          fibrad_side_view view[2]);

#ifdef __cplusplus
}
#endif
#endif
