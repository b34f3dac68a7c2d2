/* light.h - light from outside: what its sources share. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_LIGHT_LIGHT_H
#define FIBRAD_LIGHT_LIGHT_H

#include "fibrad_light.h"
#include "patches/problem.h"

/* ---- the part of a window that no triangle hides from the light -------------------------------------------------- */

/* The part is a list of convex polygons, which do not overlap. A triangle that comes before the sphere is taken away
 * from each polygon. What is left of a polygon is up to one polygon for each side of the triangle. Lengths are in radii
 * of the window. */

/* A line across the light. What is inside has n.x <= c. n is a unit vector. */
typedef struct fibrad_light_line {
    double n[2], c;
} fibrad_light_line;

/* How far a place lies beyond a line. */
static inline double fibrad_light_beyond(const fibrad_light_line *line, const double at[2]) {
    return line->n[0] * at[0] + line->n[1] * at[1] - line->c;
}

/* The line through two places. What lies to the left of the way from a to b is inside. False: the places are one. */
static inline bool fibrad_light_line_through(const double a[2], const double b[2], fibrad_light_line *line) {
    const double n[2] = {b[1] - a[1], a[0] - b[0]}, size = fibrad_sqrt(n[0] * n[0] + n[1] * n[1]);
    if (!(size > 0)) return false;
    *line = (fibrad_light_line){{n[0] / size, n[1] / size}, (n[0] * a[0] + n[1] * a[1]) / size};
    return true;
}

/* The area of a convex polygon, above 0 if its corners run counter-clockwise. */
static inline double fibrad_light_area(double corner[][2], uint32_t corners) {
    double sum = 0;
    for (uint32_t k = 1; k + 1 < corners; k++) {
        const double *a = corner[0], *b = corner[k], *c = corner[k + 1];
        sum += .5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    }
    return sum;
}

/* A convex polygon, counter-clockwise. Side k goes from corner k to the next corner. Sides of the square about the
 * window have no line: their n is 0. */
#define FIBRAD_UNSHADOWED_SIDES 32u
typedef struct fibrad_unshadowed_polygon {
    uint32_t sides;
    double corner[FIBRAD_UNSHADOWED_SIDES][2];
    fibrad_light_line line[FIBRAD_UNSHADOWED_SIDES];
} fibrad_unshadowed_polygon;

typedef struct fibrad_unshadowed {
    bool whole; /* no triangle comes before the window, and there are no polygons */
    uint32_t count, room;
    fibrad_unshadowed_polygon *polygon; /* [room] */
} fibrad_unshadowed;

#define FIBRAD_UNSHADOWED_FIRST 16u /* polygons for which there is room at first */

/* FIBRAD_E_WORK. space->needed.extra is set so that there is twice the room. */
int fibrad_unshadowed_missed(fibrad_workspace *space, const fibrad_unshadowed *unshadowed);

/* Takes away what triangle number `face` of space->met->faces hides. False: there is no room. */
bool fibrad_unshadowed_hide(fibrad_unshadowed *unshadowed, const fibrad_workspace *space, const double frame[9],
                            uint32_t face);

/* Whether no triangle hides a place. */
bool fibrad_unshadowed_holds(const fibrad_unshadowed *unshadowed, const double at[2]);

/* ---- the cross-section of light before it meets a sphere, in convex pieces --------------------------------------- */

/* Places across the light have the coordinates u and v. A piece is the light that enters the container through one face
 * and would end at one slot if there were no spheres. Counted with their signs, the pieces cover the cross-section
 * once. A circle that is seen at a slant, or that bounds a beam, is replaced by a polygon of the same area. */

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

/* ---- the window of a sphere towards a light ---------------------------------------------------------------------- */

#define FIBRAD_SUNLIT_POINTS 256u

/* Resolves the window of the sphere at `place` in one direction, and leaves it in space->areas. points: gets the points
 * of the window that no sphere hides. *open: the open area, in units of the radius
 * squared, whatever triangles hide. unshadowed: gets the part that no triangle hides. Errors: FIBRAD_E_WORK, _TABLE. */
typedef int fibrad_sunlit_function(const fibrad_scene *scene, fibrad_workspace *space, uint32_t place,
                                   const double frame[9], fibrad_points *points, double *open,
                                   fibrad_unshadowed *unshadowed);
FIBRAD_DECLARE_VERSIONS(fibrad_sunlit_function, fibrad_sunlit);

/* ---- light from outside: what the calls share -------------------------------------------------------------------- */

/* Checks a scene and a light, but not whether light comes in. Errors and fault: as fibrad_light_empty. */
int fibrad_light_check(const fibrad_scene *scene, const fibrad_light *light, fibrad_fault *fault);

/* Lays out work memory with room for a footprint and `extra` bytes of scratch. */
int fibrad_light_open(const fibrad_scene *scene, fibrad_work *work, size_t extra, fibrad_workspace **space);

/* The same after FIBRAD_E_WORK, larger. What it held is lost. */
int fibrad_light_grow(fibrad_work *work, size_t extra, fibrad_workspace **space);

fibrad_footprint *fibrad_light_footprint(const fibrad_workspace *space);
double *fibrad_light_scratch(const fibrad_workspace *space);

/* Adds areas by slot [L^2], times a flux. */
void fibrad_light_add_ends(const fibrad_scene *scene, const double area[FIBRAD_SLOTS], double flux,
                           fibrad_light_ends *ends);

/* What light of flux 1 along a frame brings to one of the patches of a four, if nothing is before it, times the number
 * of these patches. middle: out: the mean of u and v of its normals, times that. */
double fibrad_light_falls_on(const fibrad_heat *heat, const double frame[9], const fibrad_heat_four *four,
                             uint32_t patch, double middle[2]);

#endif
