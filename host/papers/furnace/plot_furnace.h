/* plot_furnace.h - a picture of the fields in the centre plane of a box, by gnuplot. SPDX-License-Identifier: MIT */
#ifndef PLOT_FURNACE_H
#define PLOT_FURNACE_H

#include "papers/furnace/furnace_run.h"
#include "cli/output.h"

/* Draws temperature and, if it was measured, 1/Theta in the plane y = Y/2, and the temperature on the axis. number: the
 * published case, whose reference is drawn, too; 0: none. name: a path, whose last part is the title. Status 0,
 * STATUS_FILE, or that of a signal. */
int furnace_plot(const struct output *output, const char *name, const struct furnace_run *run, bool measured,
                 int number);

#endif
