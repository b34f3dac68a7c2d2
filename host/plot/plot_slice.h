/* plot_slice.h - a slice through a bed with coloured spheres and walls. SPDX-License-Identifier: MIT */
#ifndef PLOT_SLICE_H
#define PLOT_SLICE_H

#include <stdio.h>

#include "bed/wall_option.h"

/* A plane across an axis. Zeroes: across y, where the default is. */
struct plot_plane {
    char axis;   /* 'x', 'y' or 'z'; 0: y */
    bool placed; /* or else the plane goes through the centre nearest to the middle of the bed */
    double at;   /* [L] */
};

/* Reads the argument of --slice, AXIS or AXIS=VALUE, into a struct plot_plane. Status 0 or STATUS_USAGE. */
int plot_plane_option(const char *text, void *plane);

/* Refuses a plane that meets no sphere. Status 0 or STATUS_USAGE. */
int plot_plane_check(const struct plot_plane *plane, const struct bed *bed);

/* A slice: its plane, its range and its unit. */
struct plot_slice {
    const struct bed *bed;
    const struct walls *walls; /* NULL: none */
    int across, axis[2];       /* axis of the plane, and those of the picture to the right and up */
    double at;                 /* place of the plane */
    double low[3], high[3];    /* range: the bed, and walls near the bed */
    double scale;              /* unit of the axes [L] */
    char unit[32];             /* name of that unit; "": not known */
    char place[64];            /* "y = 3 mm", for titles */
};

/* Makes a slice through a bed. */
void plot_slice_of(struct plot_slice *slice, const struct plot_plane *plane, const struct bed *bed,
                   const struct walls *walls);

/* What colours a slice. */
struct plot_colours {
    const double *value;         /* [n] of spheres */
    double unit;                 /* of the scale of colours */
    const unsigned char *wanted; /* [n] 0: the sphere is left out; NULL: all spheres are drawn */
    const double *wall_value;    /* [walls] NULL: walls are grey */
};

/* Draws the circles in which the plane cuts spheres, and lines where it meets walls, with the current palette. */
void plot_slice_draw(FILE *script, const struct plot_slice *slice, const struct plot_colours *colours);

#endif
