/* gnuplot.h - runs gnuplot with its picture going to an output. SPDX-License-Identifier: MIT */
#ifndef GNUPLOT_H
#define GNUPLOT_H

#include <stdio.h>
#include <sys/types.h>

#include "cli/output.h"

struct gnuplot {
    FILE *script; /* what is written here, gnuplot executes */
    pid_t process;
    const struct output *picture;
};

/* Starts gnuplot; what it draws without `set output`, .svg or .png, goes to `picture`. Status 0 or STATUS_FILE. */
int gnuplot_start(struct gnuplot *gnuplot, const struct output *picture);

/* Ends the script and waits. Status 0, or STATUS_FILE if gnuplot was not content or the picture is not whole, or that
 * of a signal. */
int gnuplot_end(struct gnuplot *gnuplot);

#endif
