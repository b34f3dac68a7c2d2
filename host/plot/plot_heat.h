/* plot_heat.h - pictures of temperatures and powers, also in time, by gnuplot. SPDX-License-Identifier: MIT */
#ifndef PLOT_HEAT_H
#define PLOT_HEAT_H

#include "cli/output.h"
#include "plot/plot_slice.h"
#include "write/write.h"

/* Draws two slices of the bed into an open output. They show temperatures, absorbed light and powers, the first two of
 * them that differ from sphere to sphere. If only one differs, the second slice is at right angles to the first one.
 * name: a path, whose last part is the title. Status 0, STATUS_FILE if gnuplot is missing or fails, STATUS_MEMORY, or
 * that of a signal. */
int plot_heat(const struct output *output, const char *name, const struct contents *what,
              const struct plot_plane *plane);

/* Temperatures of all spheres at a time. */
struct time_point {
    double time;              /* [s] */
    double mean, least, most; /* temperatures [K] */
    double outlet;            /* of the gas that leaves [K]; NaN: there is no stream */
};

/* Draws mean, least and largest temperature and that of the gas at the outlet over time, and a slice of the
 * temperatures at the end, those of `what`. Status as plot_heat. */
int plot_time(const struct output *output, const char *name, const struct time_point *point, size_t points,
              const struct contents *what, const struct plot_plane *plane);

#endif
