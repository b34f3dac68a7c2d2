/* wall_window.h - the disc of directions that a window stands for, which walls need. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_ROW_WALL_WINDOW_H
#define FIBRAD_ROW_WALL_WINDOW_H

#include "sums/wall_sum.h"

/* Windows stand for a disc of directions where they look at walls or triangles. Its radius times sqrt n. For discs as
 * large as the share of one direction it would be 2. */
#define FIBRAD_WINDOW_SPREAD 1.8

/* All lines of a window pass an edge at distance D over an angle of 1/D. If this angle is large enough, the directions
 * need no disc. */
#define FIBRAD_WINDOW_NEAR 1.3

/* Distances of the walls ahead of a direction and behind it, and how fast the direction approaches them. */
typedef struct fibrad_wall_course {
    double ahead[3], behind[3], rate[3];
} fibrad_wall_course;

typedef struct fibrad_wall_window {
    double frame[9];           /* axes of the window, by the axes of the cylinder */
    const double *direction;   /* by the axes x, y and z */
    fibrad_grid grid[3];       /* for shares of windows, sizes and squared sizes */
    uint32_t k, n;             /* window k of n */
    double open, hidden;       /* open and hidden part of the window, areas or points */
    double weight;             /* size of the window over that of the others: masks differ by some points */
    double part;               /* how much of its disc of directions is used; 1, or less if the slope is not known */
    bool parallel;             /* whether all lines have the direction of the window */
    bool end;                  /* whether it counts half in differences of even and odd windows */
    double slope[2];           /* growth of the open part as the direction turns towards each axis, per radian */
    double band;               /* as fibrad_wall_window_band says */
    double through;            /* part of the lines of this band across the horizon that meet nothing */
    double wide;               /* radius of the disc of directions */
    fibrad_wall_course course; /* of the direction, unless all walls are across one axis */
    double spread;             /* radius of the part of this disc that is needed for walls as near as these */
    double sharpness[3]; /* of the edge between the planes across axes a and a + 1; with a cylinder [2] is that of its
                            end. 1 over the change of `passing` over half the width in which lines change from one wall
                            to the other */
} fibrad_wall_window;

/* Completes a window of which the fields from k to slope are set, but for `sharpness`. frame: axes of the window, by
 * the axes x, y and z; they must stay. */
void fibrad_wall_window_begin(fibrad_wall_window *window, const fibrad_wall_view *view, const double frame[9]);

/* Half width of the band of directions for which the window stands if all walls are planes across one axis. 0: it does
 * not reach the horizon, or the row has directions that are turned at random. */
double fibrad_wall_window_band(const fibrad_wall_window *window, const fibrad_wall_view *view, bool turned);

/* Adds to the regions a window that one wall gets as a whole, or whose shares follow from one number. False: lines
 * must tell the shares. */
bool fibrad_wall_window_simple(const fibrad_wall_window *window, const fibrad_wall_view *view, fibrad_wall_sums *sums);

/* Sets `sharpness`, which lines need. */
void fibrad_wall_window_sharpen(fibrad_wall_window *window, const fibrad_wall_view *view);

/* Whether lines of the window lie in an octant. */
bool fibrad_wall_window_has(const fibrad_wall_window *window, const fibrad_wall_view *view, uint32_t octant);

/* Adds to a region the open area or points of a window, and the share that the region would have if nothing were
 * hidden. */
void fibrad_wall_window_add(const fibrad_wall_window *window, uint32_t region, double open, double share,
                            fibrad_wall_sums *sums);

#endif
