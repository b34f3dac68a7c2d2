/* plot_time.h - a picture of temperatures in time, by gnuplot. SPDX-License-Identifier: MIT */
#ifndef PLOT_TIME_H
#define PLOT_TIME_H

#include <stddef.h>

#include "cli/output.h"

/* Temperatures of all spheres at a time. */
struct time_point {
    double time;              /* [s] */
    double mean, least, most; /* temperatures [K] */
};

/* Draws mean, least and largest temperature over time. Status as plot_heat. */
int plot_time(const struct output *output, const char *name, const struct time_point *point, size_t points);

#endif
