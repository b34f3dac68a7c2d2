/* read_rows.h - joins the rows that the ranks of a simulation wrote. SPDX-License-Identifier: MIT */
#ifndef READ_ROWS_H
#define READ_ROWS_H

#include <stdbool.h>

#include "fibrad.h"

/* The rows of one step from all ranks. Sphere k has the id id[k]. */
struct joined {
    uint32_t n, walls;
    uint64_t ranks, step;
    bool emissive;               /* the rows have exchange factors; false: view factors */
    double cutoff;               /* [L] */
    uint64_t *id;                /* [n] ascending */
    double *x;                   /* [n][3] [L] */
    double *radius, *emissivity; /* [n] */
    fibrad_rows rows;            /* rows of all spheres, raw */
};

/* Reads the files of all ranks, in any order. host/couple/rows_file.h has their format. Files are mapped. Takes 12
 * bytes per entry and some 130 per sphere. Free the result also after an error. Status 0, STATUS_FILE, STATUS_MEMORY,
 * that of a signal, or STATUS_INPUT naming the file and, if one sphere is at fault, its id. */
int read_rows(const char *const *paths, size_t count, struct joined *joined);
void joined_free(struct joined *joined);

#endif
