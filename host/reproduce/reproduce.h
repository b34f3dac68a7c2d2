/* reproduce.h - published numbers beside ours: what the experiments of `fibrad reproduce` share.
 * SPDX-License-Identifier: MIT */
#ifndef REPRODUCE_H
#define REPRODUCE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#include "bed/bed.h"
#include "cli/output.h"
#include "simple/fibrad_host.h"

/* Where results go. */
struct reproduce {
    const char *directory; /* NULL: the terminal only */
    bool plots;
    struct output comparison; /* comparison.csv */
    const char *experiment;   /* its name, at the head of each line */
    /* the data of the experiment in hand, as CSV */
    FILE *data;
    char *text;
    size_t length;
};

/* Who says what ours is compared with: the paper itself, or an independent calculation by its method. */
#define SOURCE_PAPER "paper"
#define SOURCE_CHECK "check"

/* One line, on standard output and in comparison.csv: a number of others (NAN: there is none) and ours. In units of
 * "%", the difference is in points, otherwise in per cent. */
void reproduce_compare(struct reproduce *reproduce, const char *what, const char *source, const char *unit,
                       double theirs, double ours);

/* Writes the collected data as NAME.csv and, by a gnuplot script that finds it in $data, NAME.svg. Status. */
int reproduce_figure(struct reproduce *reproduce, const char *name, const char *script);

/* One experiment: writes its data to reproduce->data, the header line first, and compares. Status. */
typedef int experiment(struct reproduce *reproduce);

experiment reproduce_fig3, reproduce_fig4, reproduce_third_sphere, reproduce_fig10, reproduce_table1,
    reproduce_pebble_pair, reproduce_pebble_rays, reproduce_pebble_bed, reproduce_conductivity, reproduce_exchange;

/* ---- rows of a bed, one thread ---- */

/* The row in hand. */
struct rows {
    fibrad_scene *scene;
    void *block; /* of the scene */
    fibrad_work work;
    uint32_t n;
    uint32_t *col; /* [n] */
    double *f;     /* [n] */
};

/* Status. Close it in any case. */
int rows_open(struct rows *rows, const struct bed *bed, bool periodic);
void rows_close(struct rows *rows);

/* Row i by the rule of `method` into rows->col and f; length and the rest in *row. Status. */
int rows_row(struct rows *rows, const fibrad_bed_options *method, uint32_t i, fibrad_row *row);

#endif
