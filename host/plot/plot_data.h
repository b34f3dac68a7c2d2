/* plot_data.h - the numbers in a picture of a bed. SPDX-License-Identifier: MIT */
#ifndef PLOT_DATA_H
#define PLOT_DATA_H

#include "write/write.h"

enum {
    PLOT_DISTANCES = 110, /* bins of the distance, up to PLOT_DISTANCE_MAX */
    PLOT_FACTORS = 60,    /* bins of log10 F, from PLOT_FACTOR_MIN to 0 */
    PLOT_ROWS = 4000      /* largest number of rows for quantiles */
};
#define PLOT_DISTANCE_MAX 5.5
#define PLOT_FACTOR_MIN   (-6.0)

struct plot_data {
    double diameter; /* mean diameter [L] */
    /* Numbers of pairs by distance d/(r_i + r_j) and by log10 of F_ij r_i/r_j, which is symmetric in i and j. */
    double pairs[PLOT_DISTANCES][PLOT_FACTORS];
    /* By log10 F: the fraction of all entries, and the fraction of the sum of all factors. */
    double entries[PLOT_FACTORS], carried[PLOT_FACTORS];
    /* Quantiles 0.1, 0.5 and 0.9 over rows of the sum of factors within a distance, in mean diameters. */
    double within[PLOT_DISTANCES + 1][3];
};

/* Collects the numbers. Status 0 or STATUS_MEMORY. Cost: O(entries). */
int plot_data_collect(struct plot_data *data, const struct contents *what);

#endif
