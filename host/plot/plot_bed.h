/* plot_bed.h - a picture of a bed and its view factors, by gnuplot. SPDX-License-Identifier: MIT */
#ifndef PLOT_BED_H
#define PLOT_BED_H

#include <stdbool.h>

#include "cli/output.h"
#include "write/write.h"

/* Can a plot be written to a path with this ending? */
bool plot_ending(const char *path);

/* Draws four panels into an open output: a slice of the bed, F against distance, how F adds up with distance, and the
 * row sums. Status 0; STATUS_FILE if gnuplot is missing or fails; STATUS_MEMORY; that of a signal. */
int plot_bed(const struct output *output, const char *name, const struct contents *what);

#endif
