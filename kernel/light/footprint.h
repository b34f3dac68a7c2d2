/* footprint.h - the cross-section of light before it meets a sphere, in convex pieces. SPDX-License-Identifier: MIT
 *
 * Places across the light have the coordinates u and v. A piece is the light that enters the container through one face
 * and would end at one slot if there were no spheres. Counted with their signs, the pieces cover the cross-section
 * once. A circle that is seen at a slant, or that bounds a beam, is replaced by a polygon of the same area. */
#ifndef FIBRAD_LIGHT_FOOTPRINT_H
#define FIBRAD_LIGHT_FOOTPRINT_H

#include "fibrad_light.h"
#include "light/unshadowed.h"
#include "window/areas.h"
#include "workspace/workspace.h"

#define FIBRAD_LIGHT_SIDES 256u /* of the polygon that stands for a circle */
#define FIBRAD_LIGHT_LINES                                                                                             \
    (3 * FIBRAD_LIGHT_SIDES + 32u + FIBRAD_UNSHADOWED_SIDES) /* around a piece, and around all                         \
                                                              */
#define FIBRAD_LIGHT_PIECES 12u
#define FIBRAD_LIGHT_OWN    4u

typedef struct fibrad_light_piece {
    uint32_t slot; /* where its light ends */
    double sign;   /* -1: the piece is subtracted */
    double area;   /* L^2 */
    uint32_t face; /* axis of the plane through which it enters; 3: none */
    double from;   /* L, where that plane is */
    bool far;      /* it lies within the far end of the cylinder, too */
    uint32_t lines;
    fibrad_light_line line[FIBRAD_LIGHT_OWN];
} fibrad_light_piece;

/* A polygon, counter-clockwise. */
typedef struct fibrad_light_polygon {
    uint32_t corners;
    double at[FIBRAD_LIGHT_LINES][2];
} fibrad_light_polygon;

/* A line near a window, with lengths in radii of the window. It has the stretch that bounds the piece, and sums over
 * the places where the boundary of the open region crosses the line. */
typedef struct fibrad_light_edge {
    fibrad_light_line line;
    double low, high, sum;
    int32_t balance; /* crossings outwards minus crossings inwards, 0 in the end */
} fibrad_light_edge;

/* A part of an arc, and the first edge that may still cut it. */
typedef struct fibrad_light_arc {
    double p[2], q[2];
    uint32_t next;
} fibrad_light_arc;

typedef struct fibrad_footprint {
    double frame[9];                    /* axes u and v, and the direction towards the light */
    double flux;                        /* of the light in this direction, across it */
    double origin[3];                   /* L, where u = v = 0 and the depth is 0 */
    double low[3], high[3];             /* L, box about the bed: walls, periods or spheres */
    double bound_low[2], bound_high[2]; /* L, u and v of the whole cross-section */
    double image[2][2];                 /* L, u and v of the periods of a beam that is repeated */
    uint32_t images, common, far; /* how many of them; number of lines of all pieces, and of the cylinder's far end */
    uint32_t pieces;
    fibrad_light_piece piece[FIBRAD_LIGHT_PIECES];
    fibrad_light_line line[FIBRAD_LIGHT_LINES];   /* common ones, then those of the far end */
    fibrad_light_polygon start, polygon, clipped; /* of all, and scratch */
    fibrad_light_edge edge[FIBRAD_LIGHT_LINES];   /* scratch */
    fibrad_light_arc arc[FIBRAD_LIGHT_LINES + 1]; /* scratch */
    fibrad_unshadowed unshadowed;                 /* of the window in hand */
} fibrad_footprint;

/* What is wrong with a light, a fibrad_why. */
int fibrad_light_why(const fibrad_scene *scene, const fibrad_light *light);

/* The first sphere, by the caller's index, that lies before the disc of a light as seen along the light; FIBRAD_NONE.
 */
uint32_t fibrad_light_obstacle(const fibrad_scene *scene, const fibrad_light *light);

/* How many directions a light has. */
uint32_t fibrad_light_count(const fibrad_light *light);

/* The cross-section of a valid light in its direction k. */
void fibrad_footprint_make(fibrad_footprint *f, const fibrad_scene *scene, const fibrad_light *light, uint32_t k);

/* L^2, what all pieces let in. 0 or below: no open face lets the light in. */
double fibrad_footprint_area(const fibrad_footprint *f);

/* u and v of a place. */
void fibrad_footprint_place(const fibrad_footprint *f, const double at[3], double uv[2]);

/* Image number `image` of a place: the image nearest to the middle of a repeated beam, or one beside it. False: there
 * is no such image. If light falls on all that is open, the place itself is the only image. */
bool fibrad_footprint_image(const fibrad_footprint *f, const double uv[2], uint32_t image, double at[2]);

/* Adds to `area` by slot [L^2] what the open region of a completed window takes from the light that would end there.
 * f->unshadowed tells what triangles leave of the window. The window has `open` in units of its radius r [L] squared,
 * and its middle at uv. */
void fibrad_footprint_share(fibrad_footprint *f, const fibrad_areas *areas, double open, const double uv[2], double r,
                            double area[FIBRAD_SLOTS]);

/* Whether there is light at a place. *piece: the piece that it belongs to; may be NULL. */
bool fibrad_footprint_lights(const fibrad_footprint *f, const double uv[2], uint32_t *piece);

/* Where the light of a piece at the place uv enters the container [L]. */
void fibrad_footprint_enters(const fibrad_footprint *f, uint32_t piece, const double uv[2], double at[3]);

#endif
