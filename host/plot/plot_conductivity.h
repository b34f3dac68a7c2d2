/* plot_conductivity.h - a picture of exchange factors along the axes, by gnuplot. SPDX-License-Identifier: MIT */
#ifndef PLOT_CONDUCTIVITY_H
#define PLOT_CONDUCTIVITY_H

#include "bed/conductivity.h"
#include "cli/output.h"

/* Draws F_E along each wanted axis with twice its standard error, and F_E between plates where it is known. The names
 * of the axes include k. name: a path, whose last part is the title. Status as plot_heat. */
int plot_conduction(const struct output *output, const char *name, const struct conduction *conduction);

#endif
