/* welded.h - triangles that share corners and edges. SPDX-License-Identifier: MIT */
#ifndef WELDED_H
#define WELDED_H

#include "fibrad.h"
#include "mesh/stl.h"

/* A connected component: triangles joined by edges of exactly two triangles. */
struct component {
    uint32_t first, n; /* its triangles in surface.in_components */
    bool closed;       /* each edge belongs to two triangles */
    bool twisted;      /* no winding of the triangles makes one side, as on a Moebius strip */
    int inner;         /* of meshes_face. 1: closed, and its wall is the fronts of triangles that are not turned and
                        * the backs of the others; -1: the other side is; 0: not closed, or both sides are walls */
};

struct surface {
    uint32_t vertices, n;
    double (*vertex)[3];   /* [vertices] no two are equal */
    uint32_t (*corner)[3]; /* [n] vertices, in the winding of the file */
    uint64_t *place;       /* [n] as in struct stl */
    uint32_t *solid;       /* [n] as in struct stl */
    uint32_t given;        /* triangles of the file, those left out included */
    uint32_t *number;      /* [n] number of the triangle in the file, from 0 */
    /* set by surface_find_components */
    uint32_t components;
    struct component *component; /* [components] */
    uint32_t *in_components;     /* [n] triangles, one component after the other */
    uint32_t *component_of;      /* [n] the component of a triangle */
    unsigned char *turned;       /* [n] 1: its winding is not that of most of its component */
    /* faults of the mesh */
    uint32_t snapped; /* corners moved to another one within 1e-6 of the mean edge */
    uint32_t flat;    /* triangles without area; those with two equal corners are left out */
    uint32_t twice;   /* triangles that are left out, since they occur twice */
    uint32_t open;    /* edges of one triangle */
    uint32_t crowded; /* edges of more than two triangles */
    double mean_edge; /* mean length of edges */
};

/* Makes a surface of triangles, with coordinates multiplied by `scale`. Joins corners closer than 1e-6 of the mean
 * edge. Leaves out triangles with two equal corners and triangles that occur twice. Free the surface also after an
 * error. Status 0 or STATUS_MEMORY. */
int surface_weld(struct surface *surface, const struct stl *stl, double scale);

/* Finds edges and connected components. Status 0 or STATUS_MEMORY. */
int surface_find_components(struct surface *surface);

void surface_free(struct surface *surface);

double surface_distance(const double a[3], const double b[3]);

/* Corner k of a triangle; its normal, whose length is twice its area; its area. */
const double *surface_corner(const struct surface *surface, uint32_t triangle, int k);
void surface_normal(const struct surface *surface, uint32_t triangle, double normal[3]);
double surface_area(const struct surface *surface, uint32_t triangle);

/* Lets spheres vote on which side of each component they lie. A sphere votes by the side of its centre at the nearest
 * triangle, with the weight (r/distance)^2, at most 1. If there are many spheres, only some of them vote. period: 0:
 * the axis is open. votes [components], out: above 0: before the fronts of triangles that are not turned; below 0:
 * behind them; 0: unknown. Status 0 or STATUS_MEMORY. */
int facing_votes(const struct surface *surface, const fibrad_spheres *spheres, const double period[3], double *votes);

/* The distance from a point to a component. *side: 1: before the fronts of triangles that are not turned; -1: behind
 * them; 0: unknown. */
double facing_distance(const struct surface *surface, const struct component *component, const double point[3],
                       const double period[3], int *side);

/* Volume within a closed component. Below 0: the fronts of triangles that are not turned are inside. */
double facing_volume(const struct surface *surface, const struct component *component);

#endif
