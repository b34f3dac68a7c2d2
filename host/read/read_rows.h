/* read_rows.h - the rows that the ranks of a simulation wrote, put together. SPDX-License-Identifier: MIT */
#ifndef READ_ROWS_H
#define READ_ROWS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "fibrad.h"

/* The rows of one step, all ranks together. Sphere k is that of the k-th id. */
struct joined {
    uint32_t n, bodies;
    uint64_t ranks, step;
    bool emissive;               /* exchange factors, else view factors */
    double cutoff;               /* [L] */
    uint64_t *id;                /* [n] ascending */
    double *x;                   /* [n][3] [L] */
    double *radius, *emissivity; /* [n] */
    fibrad_rows rows;            /* of all spheres, as they were written */
};

/* Reads the files of all ranks, in any order; host/couple/rows_file.h has their format. Takes 12 bytes an entry and
 * some 130 a sphere. Free the result also after an error. Status 0; STATUS_INPUT naming the file and, where it is one
 * sphere's fault, its id; STATUS_FILE, STATUS_MEMORY, or that of a signal. */
int read_rows(const char *const *paths, size_t count, struct joined *joined);
void joined_free(struct joined *joined);

#endif
