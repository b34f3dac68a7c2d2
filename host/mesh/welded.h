/* welded.h - triangles that share corners and edges. SPDX-License-Identifier: MIT */
#ifndef WELDED_H
#define WELDED_H

#include "mesh/stl.h"

/* Triangles that hang together by edges of two: one part, which has two sides if they can be wound alike. */
struct part {
    uint32_t first, n; /* in surface.in_parts */
    bool closed;       /* all its edges are edges of two */
    bool twisted;      /* they cannot */
    int inner;         /* meshes_enclosing */
};

struct surface {
    uint32_t vertices, n;
    double (*vertex)[3];   /* [vertices] no two alike */
    uint32_t (*corner)[3]; /* [n] as wound in the file */
    uint64_t *place;       /* [n] as in struct stl */
    uint32_t *solid;       /* [n] */
    uint32_t given;        /* triangles of the file, those left out included */
    uint32_t *number;      /* [n] which one of these, from 0 */
    /* of surface_find_parts */
    uint32_t parts;
    struct part *part;     /* [parts] */
    uint32_t *in_parts;    /* [n] triangles, part by part */
    uint32_t *part_of;     /* [n] */
    unsigned char *turned; /* [n] 1: wound the other way than the most of its part */
    /* what was met */
    uint32_t snapped; /* corners moved to one that is nearly the same */
    uint32_t flat;    /* triangles without area; those of two equal corners are left out */
    uint32_t twice;   /* triangles left out, being there already */
    uint32_t open;    /* edges of one triangle; */
    uint32_t crowded; /* of more than two */
    double mean_edge;
};

/* Joins corners closer than 1e-6 of the mean edge, leaves out what is flat or there twice; coordinates are multiplied
 * by `scale`. Status 0 or STATUS_MEMORY; to be freed also then. */
int surface_weld(struct surface *surface, const struct stl *stl, double scale);

/* Finds edges and parts. Status 0 or STATUS_MEMORY. */
int surface_find_parts(struct surface *surface);

void surface_free(struct surface *surface);

/* Corner k of a triangle; its normal, as long as twice its area; this. */
const double *surface_corner(const struct surface *surface, uint32_t triangle, int k);
void surface_normal(const struct surface *surface, uint32_t triangle, double normal[3]);
double surface_area(const struct surface *surface, uint32_t triangle);

#endif
