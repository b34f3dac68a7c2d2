/* plot_data.h - what a picture of a bed shows, in numbers. SPDX-License-Identifier: MIT */
#ifndef PLOT_DATA_H
#define PLOT_DATA_H

#include "write/write.h"

enum {
    PLOT_DISTANCES = 110, /* bins of the distance, up to PLOT_DISTANCE_MAX */
    PLOT_FACTORS = 60,    /* bins of log10 F, from PLOT_FACTOR_MIN to 0 */
    PLOT_ROWS = 4000      /* rows that quantiles are taken from */
};
#define PLOT_DISTANCE_MAX 5.5
#define PLOT_FACTOR_MIN   (-6.0)

struct plot_data {
    double diameter; /* mean [file units] */
    /* Pairs by distance d/(r_i + r_j) and log10 of F_ij r_i/r_j, which is the same both ways. */
    double pairs[PLOT_DISTANCES][PLOT_FACTORS];
    /* By log10 F: share of the entries, share of what they carry. */
    double entries[PLOT_FACTORS], carried[PLOT_FACTORS];
    /* Quantiles 0.1, 0.5, 0.9 of the rows' sums of F up to a distance in mean diameters. */
    double within[PLOT_DISTANCES + 1][3];
};

/* Status 0 or STATUS_MEMORY. Cost: O(entries). */
int plot_data_collect(struct plot_data *data, const struct contents *what);

#endif
