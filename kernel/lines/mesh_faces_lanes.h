/* mesh_faces_lanes.h - the triangles that may come before a window. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_LINES_MESH_FACES_LANES_H
#define FIBRAD_LINES_MESH_FACES_LANES_H

#include "base/lanes/laned.h"
#include "work/work.h"

/* A search for them, image by image and stretch by stretch. Lengths are in radii of sphere i but for `centre`. */
typedef struct fibrad_face_search {
    const double *frame;
    double deepest; /* depth beyond which nothing matters; may be lessened on the way */
    double wide;    /* how far lines lead aside at most, per depth; may be lessened, too */
    double near;    /* if some are nearer than this, lines do not lead aside */
    double slack;   /* lengths that may be rounding */
    bool cut;       /* whether triangles may cut sphere i */
    double nearest; /* about the least depth of those found, ... */
    double shallow; /* ... and none of them is less deep */
    double most;    /* if a stretch has more images than this, it and those behind it are left out, ... */
    double rest;    /* ... and here they begin */
    double stretch; /* depths that are looked at together; the one in hand: */
    double from, to;
    bool inside;               /* whether some of it is left */
    fibrad_mesh_images images; /* that it meets */
    int64_t at[3];             /* the image in hand */
    double centre[3];          /* [L] of sphere i, from there */
    double box[3][3];          /* the frame, for boxes in their units; row by row, ... */
    double shift[3];           /* ... and what is added */
    fibrad_mesh_walk walk;
} fibrad_face_search;

/* Begins a search for triangles down to a depth. */
void LANED(fibrad_faces_begin)(const fibrad_workspace *work, const double frame[9], double deepest, double wide,
                               double near, fibrad_face_search *search);

/* Lists the next triangles, roughly from front to back, in work->met->faces. False: there are no more. */
bool LANED(fibrad_faces_next)(fibrad_workspace *work, fibrad_face_search *search);

#endif
