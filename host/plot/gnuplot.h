/* gnuplot.h - runs gnuplot, whose picture goes to an output. SPDX-License-Identifier: MIT */
#ifndef GNUPLOT_H
#define GNUPLOT_H

#include <stdio.h>
#include <sys/types.h>

#include "cli/output.h"

/* Whether the ending of a path is one of pictures, .svg or .png. */
bool plot_ending(const char *path);

struct gnuplot {
    FILE *script; /* gnuplot executes the commands written here */
    pid_t process;
    const struct output *picture;
};

/* Starts gnuplot. A picture drawn without `set output` goes to `picture`. Status 0 or STATUS_FILE. */
int gnuplot_start(struct gnuplot *gnuplot, const struct output *picture);

/* Sets the terminal by the ending of a path, the size of the picture in pixels, and the style of panels. */
void gnuplot_style(FILE *script, const char *path, int width, int height);

/* A palette from dark to bright, for values without a neutral middle. */
#define GNUPLOT_PALETTE                                                                                                \
    "set palette defined (0 '#440154', 1 '#46327e', 2 '#365c8d', 3 '#277f8e', 4 '#1fa187', 5 '#4ac16d', 6 '#a0da39', " \
    "7 '#fde725')\n"

/* Writes the last part of a path into a gnuplot string in single quotes. */
void gnuplot_name(FILE *script, const char *path);

/* Ends the script and waits for gnuplot. Status 0, STATUS_FILE if gnuplot has failed or the picture is incomplete, or
 * that of a signal. */
int gnuplot_end(struct gnuplot *gnuplot);

#endif
