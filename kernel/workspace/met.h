/* met.h - triangles that may come before a window, and the lines that look for them. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_WORKSPACE_MET_H
#define FIBRAD_WORKSPACE_MET_H

#include "window/points.h"

/* Some of the triangles that may come before a window, in the frame of the window. Seen along the direction of the
 * window, their corners go round to the left. */
#define FIBRAD_FACES      32u
#define FIBRAD_FACES_ROOM (FIBRAD_FACES + FIBRAD_LANES_MAX)
typedef struct fibrad_faces {
    double corner[3][3][FIBRAD_FACES_ROOM];                 /* u, v and depth of each corner */
    double low[FIBRAD_FACES_ROOM], high[FIBRAD_FACES_ROOM]; /* range of depths */
    double plane[3][FIBRAD_FACES_ROOM];                     /* depth = u plane[0] + v plane[1] + plane[2] */
    double middle[FIBRAD_FACES_ROOM];     /* about the depth of the plane at the middle of the window */
    double edge[3][3][FIBRAD_FACES_ROOM]; /* u edge[k][0] + v edge[k][1] + edge[k][2] >= 0 inside */
    double side[FIBRAD_FACES_ROOM];       /* side of the mesh that is seen */
    uint32_t triangle[FIBRAD_FACES_ROOM]; /* triangle of the mesh */
    uint32_t count;
} fibrad_faces;

/* Lines of a window that search for triangles, one for each point. They are sorted so that the eight lines of a block
 * are near each other at the depth `at`. The last block is filled up with lines that meet nothing. */
#define FIBRAD_MET_POINTS  256
#define FIBRAD_LINE_BLOCK  8
#define FIBRAD_LINE_BLOCKS (FIBRAD_MET_POINTS / FIBRAD_LINE_BLOCK)
#define FIBRAD_PAIRS       64u
#define FIBRAD_PAIRS_ROOM  (FIBRAD_PAIRS + FIBRAD_LINE_BLOCKS + FIBRAD_LANES_MAX)
typedef struct fibrad_lines {
    _Alignas(64) double place[2][FIBRAD_MET_POINTS]; /* u, v where the lines leave sphere i */
    double exit[FIBRAD_MET_POINTS];                  /* depth where the lines leave sphere i */
    double aside[2][FIBRAD_MET_POINTS];              /* parts of the directions along u and v; 0 unless spread */
    double depth[FIBRAD_MET_POINTS];                 /* depth of what a line meets, or where its search ends */
    double side[FIBRAD_MET_POINTS];                  /* side of the mesh that a line meets; -1: none */
    uint32_t point[FIBRAD_MET_POINTS];
    /* Of each block: bounds of u and v at depth `at`, bounds of `aside`, and the depth where all searches end. */
    double low[2][FIBRAD_LINE_BLOCKS], high[2][FIBRAD_LINE_BLOCKS];
    double least[2][FIBRAD_LINE_BLOCKS], most[2][FIBRAD_LINE_BLOCKS];
    double last[FIBRAD_LINE_BLOCKS];
    uint32_t count;
    uint32_t parallel; /* number of points if the lines are those of all points and parallel; 0: other lines */
    double at;
    uint32_t pair[FIBRAD_PAIRS_ROOM]; /* FIBRAD_LINE_BLOCKS times a face + a block of lines that may meet it */
    uint32_t pairs;
} fibrad_lines;

/* Points of a window that meet triangles. */
typedef struct fibrad_met {
    fibrad_faces faces;
    double depth[FIBRAD_MET_POINTS];   /* along the line, from the plane through the centre; below -1 for
                                          points beyond a triangle that cuts sphere i */
    double weight[FIBRAD_MET_POINTS];  /* area, or number of points, for the triangle */
    float aside[2][FIBRAD_MET_POINTS]; /* parts of the direction of the line along u and v */
    uint32_t side[FIBRAD_MET_POINTS];  /* side of the mesh; FIBRAD_NO_SIDE: none */
    fibrad_points points;              /* the points; for windows by areas also which are open */
    uint32_t deepest;                  /* side that the deepest line meets */
    bool any;                          /* whether the present window has such points */
    fibrad_lines lines;
} fibrad_met;

#endif
