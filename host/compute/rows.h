/* rows.h - rows of view factors of a whole bed, by OpenMP over its spheres. SPDX-License-Identifier: MIT */
#ifndef ROWS_H
#define ROWS_H

#include <stdbool.h>
#include <stdint.h>

#include "bed/bed.h"
#include "compute/method.h"
#include "fibrad.h"

struct run_options {
    const char *file; /* the bed's name in messages */
    struct row_method method;
    int threads;        /* 0: as OpenMP has it, which is all cores */
    bool raw;           /* leave the rows as the method gave them */
    fibrad_walls walls; /* zeroed: none */
    const bool *wanted; /* [n] which rows; NULL: all. Some rows only: raw has to be set */
    bool progress;      /* show the bar even if standard error is no terminal */
};

/* The matrix and what is worth telling of it. Rows not wanted are empty. */
struct result {
    fibrad_rows rows;
    bool *wanted;    /* [n] */
    double *row_sum; /* [n] */
    double *error;   /* [n] estimated Euclidean error of each row */
    double *escaped; /* [n] raw rows: as measured; averaged rows: what the row sum and the walls leave of 1 */
    double (*wall)[FIBRAD_WALLS]; /* [n] factors to the walls */
    fibrad_scene_facts facts;
    int threads;
    uint32_t directions; /* beam: the most that a row took */
    uint64_t fallbacks;  /* beam: windows that the robust method had to do */
    double seconds;      /* computing, without reading and writing */
    double row_sum_min, row_sum_max, escaped_mean;
    double wall_mean[FIBRAD_WALLS];
    double closure_max;     /* largest |row sum + walls + escaped - 1| of the raw rows */
    double reciprocity_max; /* NaN if rows are missing */
    double error_estimate;  /* the largest of the rows' */
};

/* Computes the rows. They depend on the bed and the method, not on threads and schedule. Free the result also after an
 * error. Status 0; STATUS_INPUT if the kernel refuses the bed, naming the line; STATUS_MEMORY; that of a signal. */
int run_rows(const struct bed *bed, const struct run_options *options, struct result *result);

void result_free(struct result *result);

/* Euclidean distance of row i in two matrices. */
double rows_distance(const fibrad_rows *a, const fibrad_rows *b, uint32_t i);

/* Makes the scene of a bed in *block, which is to be freed, also after an error. Status 0; STATUS_INPUT if the kernel
 * refuses the bed, naming the line; STATUS_MEMORY. */
int run_scene(const struct bed *bed, const fibrad_walls *walls, const char *file, fibrad_scene **scene, void **block);

/* A block on a 64-byte boundary, as the kernel wants it; free() it. NULL: out of memory. */
void *run_block(size_t size);

/* Makes work memory in *block in the place of what is there (NULL: nothing); free() it. False: out of memory, and
 * *work is NULL. */
bool run_work(fibrad_work **work, void **block, const fibrad_work_config *config);

#endif
