/* plot_heat.h - a picture of temperatures and net radiative powers, by gnuplot. SPDX-License-Identifier: MIT */
#ifndef PLOT_HEAT_H
#define PLOT_HEAT_H

#include "bed/bed.h"
#include "bed/wall_option.h"
#include "cli/output.h"
#include "plot/plot_slice.h"

/* The contents of the picture. Temperatures are in K. Powers are in W, above 0 where heat is gained. */
struct heat_shown {
    const struct bed *bed;
    const struct walls *walls;
    double metres;                                       /* the bed's unit of length [m]; 0: not known */
    const double *temperature, *power;                   /* [bed->n] */
    const double *wall_temperature, *wall_power;         /* [walls->count]; NULL if there are no walls */
    double surroundings_temperature, surroundings_power; /* NaN: the bed is closed */
    bool found;             /* temperatures of spheres were found: the picture has them by height, not powers */
    const double *absorbed; /* [bed->n] light from outside that spheres absorb [W]; NULL: there is none */
    struct plot_plane plane;
};

/* Draws four panels into an open output: two slices of the bed, powers or temperatures by height, and powers of
 * spheres, walls and surroundings. The slices show temperatures, absorbed light and powers, the first two of them that
 * differ from sphere to sphere. If only one differs, the second slice is at right angles to the first one. If
 * temperatures were found within a cylinder, they against radius take the place of the second slice, unless there is
 * light. name: a path, whose last part is the title. Status 0, STATUS_FILE if gnuplot is missing or fails,
 * STATUS_MEMORY, or that of a signal. */
int plot_heat(const struct output *output, const char *name, const struct heat_shown *what);

#endif
