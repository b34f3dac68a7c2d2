/* unshadowed.h - the part of a window that no triangle hides from the light. SPDX-License-Identifier: MIT
 *
 * The part is a list of convex polygons, which do not overlap. A triangle that comes before the sphere is taken away
 * from each polygon. What is left of a polygon is up to one polygon for each side of the triangle. Lengths are in radii
 * of the window. */
#ifndef FIBRAD_LIGHT_UNSHADOWED_H
#define FIBRAD_LIGHT_UNSHADOWED_H

#include "workspace/workspace.h"

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

#endif
