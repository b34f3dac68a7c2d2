/* gnuplot.h - runs gnuplot with its picture going to an open file. SPDX-License-Identifier: MIT */
#ifndef GNUPLOT_H
#define GNUPLOT_H

#include <stdio.h>
#include <sys/types.h>

struct gnuplot {
    FILE *script; /* what is written here, gnuplot executes */
    pid_t process;
};

/* Starts gnuplot; what it draws without `set output` goes to `picture`. Status 0 or STATUS_FILE. */
int gnuplot_start(struct gnuplot *gnuplot, FILE *picture);

/* Ends the script and waits. Status 0, or STATUS_FILE if gnuplot was not content, or that of a signal. */
int gnuplot_end(struct gnuplot *gnuplot);

#endif
