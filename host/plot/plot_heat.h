/* plot_heat.h - a picture of temperatures and net radiative powers, by gnuplot. SPDX-License-Identifier: MIT */
#ifndef PLOT_HEAT_H
#define PLOT_HEAT_H

#include "bed/bed.h"
#include "bed/wall_option.h"
#include "cli/output.h"

/* What is shown: temperatures in K, powers in W, > 0 where heat is gained. */
struct heat_shown {
    const struct bed *bed;
    const struct walls *walls;                           /* none in it: no walls */
    double metres;                                       /* of the unit of the bed's lengths; 0: not known */
    const double *temperature, *power;                   /* [bed->n] */
    const double *wall_temperature, *wall_power;         /* [walls->count]; NULL if there are none */
    double surroundings_temperature, surroundings_power; /* NaN: there are none */
    bool found; /* temperatures of spheres were found: they are shown by height, instead of powers */
};

/* Draws four panels into an open output: the temperatures and the powers in a slice of the bed, powers or temperatures
 * by height, and what spheres, walls and surroundings gain and lose. name: a path, whose last part is the title. Status
 * 0; STATUS_FILE if gnuplot is missing or fails; STATUS_MEMORY; that of a signal. */
int plot_heat(const struct output *output, const char *name, const struct heat_shown *what);

#endif
