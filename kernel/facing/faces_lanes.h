/* faces_lanes.h - the triangles that may come before a window. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_FACING_FACES_LANES_H
#define FIBRAD_FACING_FACES_LANES_H

#include "base/lanes/laned.h"
#include "workspace/workspace.h"

/* A search for triangles, stretch by stretch and image by image. Lengths are in radii of sphere i, except `centre`. */
typedef struct fibrad_face_search {
    const double *frame;
    double deepest; /* greatest depth that matters; the caller may lessen it during the search */
    double wide;    /* greatest distance aside of lines, per depth; it may become less during the search */
    double near;    /* if a triangle is nearer than this, lines do not spread */
    double slack;   /* lengths below this may be rounding errors */
    bool cut;       /* whether triangles may cut sphere i */
    double nearest; /* approximate least depth of the triangles found */
    double shallow; /* no triangle found is less deep */
    double most;    /* largest number of images of a stretch; a stretch with more ends the search */
    double rest;    /* the depth at which the search has ended */
    double stretch; /* length of a stretch of depths */
    double from, to;
    bool inside;               /* whether a part of the present stretch is left */
    fibrad_mesh_images images; /* images that meet the present stretch */
    int64_t at[3];             /* the present image */
    double centre[3];          /* [L] centre of sphere i in the frame of this image */
    double box[3][3];          /* the frame in units of boxes, row by row */
    double shift[3];           /* what is added to coordinates in this frame */
    fibrad_mesh_walk walk;
} fibrad_face_search;

/* Begins a search for triangles down to a depth. */
void LANED(fibrad_faces_begin)(const fibrad_workspace *work, const double frame[9], double deepest, double wide,
                               double near, fibrad_face_search *search);

/* Lists the next triangles in work->met->faces, roughly from front to back. False: no triangle is left. */
bool LANED(fibrad_faces_next)(fibrad_workspace *work, fibrad_face_search *search);

#endif
