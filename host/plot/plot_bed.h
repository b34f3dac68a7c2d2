/* plot_bed.h - a picture of a bed and its view or exchange factors, by gnuplot. SPDX-License-Identifier: MIT */
#ifndef PLOT_BED_H
#define PLOT_BED_H

#include "cli/output.h"
#include "plot/plot_slice.h"
#include "write/write.h"

/* Draws four panels into an open output: a slice of the bed by a plane, factors against distance, sums of factors
 * within a distance, and sizes of factors. name: a path, whose last part is the title. Status 0, STATUS_FILE if gnuplot
 * is missing or fails, STATUS_MEMORY, or that of a signal. */
int plot_bed(const struct output *output, const char *name, const struct contents *what,
             const struct plot_plane *plane);

#endif
