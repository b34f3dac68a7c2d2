/* write.h - matrices to files, and what is said of them. SPDX-License-Identifier: MIT */
#ifndef WRITE_H
#define WRITE_H

#include <stdbool.h>
#include <stdio.h>

#include "bed/bed.h"
#include "bed/wall_option.h"
#include "simple/fibrad_host.h"

/* A further array of a .npz. */
struct array {
    const char *name, *type; /* "x.npy"; kind and bytes as NumPy has them: "f8" */
    const void *data;
    uint64_t length, columns; /* columns 0: one dimension */
};

enum { ARRAYS_MAX = 16 };

/* What is written. */
struct contents {
    const struct bed *bed;
    const fibrad_bed_factors *factors;
    const unsigned char *wanted;      /* [n] not 0: this row was computed; NULL: all were */
    const struct walls *walls;        /* NULL: neither walls nor surroundings are written; none in it: no walls, and
                                         surroundings only with exchange factors */
    const fibrad_exchange_rule *grey; /* NULL: view factors; else exchange factors by this rule */
    const struct array *array;        /* [arrays] that a .npz has besides the matrix, at most ARRAYS_MAX */
    size_t arrays;
};

/* Writes to the file; a failing file is noticed by the caller. Status 0 or that of a signal. */
typedef int write_function(FILE *file, const struct contents *what);

write_function write_csv, write_mtx, write_npz, write_vtp;

/* The writer for the ending of a path, NULL if there is none or no path. `endings`, unless NULL, gets the list of those
 * known. */
write_function *write_find(const char *path, const char **endings);

/* What the rows that were computed have in common. */
struct summary {
    double row_sum_min, row_sum_max, escaped_mean, beyond_mean;
    double closure_max; /* largest |row sum + escaped + beyond + walls - 1| */
    double error_max, error_rms;
    double wall_mean[WALLS_MAX];
};

/* The sum over the spheres that row i sees. */
double summary_row(const fibrad_factors *matrix, uint32_t i);

void summary_make(struct summary *summary, const struct contents *what);

/* Prints a line `wall_NAME mean-F area` for each wall. */
void summary_print_walls(const struct summary *summary, const struct contents *what);

#endif
