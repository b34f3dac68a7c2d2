/* gnuplot.h - runs gnuplot with its picture going to an output. SPDX-License-Identifier: MIT */
#ifndef GNUPLOT_H
#define GNUPLOT_H

#include <stdbool.h>
#include <stdio.h>
#include <sys/types.h>

#include "cli/output.h"

/* Can a plot be written to a path with this ending? */
bool plot_ending(const char *path);

struct gnuplot {
    FILE *script; /* what is written here, gnuplot executes */
    pid_t process;
    const struct output *picture;
};

/* Starts gnuplot; what it draws without `set output`, .svg or .png, goes to `picture`. Status 0 or STATUS_FILE. */
int gnuplot_start(struct gnuplot *gnuplot, const struct output *picture);

/* The terminal for the ending of a path, and the style of panels: a picture this large. */
void gnuplot_style(FILE *script, const char *path, int width, int height);

/* A palette from dark to bright, for values without a middle. */
#define GNUPLOT_PALETTE                                                                                                \
    "set palette defined (0 '#440154', 1 '#46327e', 2 '#365c8d', 3 '#277f8e', 4 '#1fa187', 5 '#4ac16d', 6 '#a0da39', " \
    "7 '#fde725')\n"

/* The last part of a path, for a gnuplot string in single quotes. */
void gnuplot_name(FILE *script, const char *path);

/* Ends the script and waits. Status 0, or STATUS_FILE if gnuplot was not content or the picture is not whole, or that
 * of a signal. */
int gnuplot_end(struct gnuplot *gnuplot);

#endif
