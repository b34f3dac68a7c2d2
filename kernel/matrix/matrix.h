/* matrix.h - the inside of a matrix of factors. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_MATRIX_MATRIX_H
#define FIBRAD_MATRIX_MATRIX_H

#include "scene/scene.h"
#include "store/record.h"

/* Rows [begin, end) of the result, averaged by one task into a stretch of col and f of its own. */
typedef struct fibrad_matrix_part {
    uint32_t begin, end;
    uint64_t first, transposed, last; /* the stretch; where the rows of the transpose wait in it */
    uint64_t filled;                  /* where the averaged rows end */
    uint64_t to;                      /* where they go when parts are moved together */
    double worst;                     /* of its rows: how far one is off, ... */
    uint32_t worst_row;               /* ... and which, where that is asked for */
    unsigned char done;
} fibrad_matrix_part;

/* Compressed rows that may change. */
typedef struct fibrad_sparse {
    uint32_t n;
    uint64_t capacity;
    uint64_t *start;
    uint32_t *col;
    double *f;
} fibrad_sparse;

struct fibrad_matrix {
    fibrad_sparse result;
    uint32_t bodies, tasks;
    bool raw, exchange, open, closed;
    bool sampled;             /* exchange factors, or view factors by rays or points */
    const fibrad_rows *given; /* [given_count] the collections, and the sum of their changes so far */
    uint32_t given_count;
    uint64_t given_serial;
    double drop;
    const fibrad_record **row;         /* [n] raw rows by sphere */
    double *r;                         /* [n] radii, times the root of the emissivity with exchange factors */
    double *radius;                    /* [n] radii alone, of what is sampled */
    uint64_t *place;                   /* [n] where the next entry of each row of the transpose goes */
    double *scratch;                   /* [3 n] */
    double all[FIBRAD_BODIES_MAX + 2]; /* what all spheres together send to each body, to the surroundings and beyond */
    fibrad_parallel *parallel;
    void *context;
    double *escaped, *beyond, *error;
    double *body;    /* [n][bodies] */
    bool enclosed;   /* whether bodies have rows, too; else what follows is not used */
    double *between; /* [bodies][bodies] */
    double *body_escaped, *body_error;
    double *newton, *before;          /* [bodies][bodies + 1] scratch */
    double length[FIBRAD_BODIES_MAX]; /* as r of spheres; 0: no row */
    double correction;                /* the largest distance of a body's sum from 1, before all were closed */
    double body_closure;              /* ... and after that */
    double changed;                   /* as in fibrad_factors, and of which row */
    uint32_t changed_row;
    fibrad_matrix_part *part; /* [tasks] */
};

/* Does pieces [0, pieces) of a job by the caller's threads, if he has given any. */
void fibrad_matrix_share(const fibrad_matrix *matrix, uint32_t pieces, fibrad_piece *piece, void *job);

/* Counts the entries of each row of the transpose that is in a part, into matrix->place. Returns how many. */
uint64_t fibrad_matrix_count_part(fibrad_matrix *matrix, const fibrad_matrix_part *part);

/* Of what i and j exchange, the part of the mean that row i's estimate is: a half of view factors, whose two estimates
 * are two sums of the same visible areas; of what is sampled by variances. Each of as many paths from i or from j
 * carries what is emitted by its sphere, so that the variance of the estimate is as the sphere's area. */
static inline double fibrad_matrix_own(const fibrad_matrix *m, uint32_t i, uint32_t j) {
    if (!m->sampled) return 0.5;
    const double ratio = m->radius[i] / m->radius[j];
    return 1 / (1 + ratio * ratio);
}

/* Averages the rows of a part. */
void fibrad_matrix_average_part(fibrad_matrix *matrix, fibrad_matrix_part *part);

/* Takes over the rows of bodies that a rule has. */
void fibrad_matrix_take_bodies(fibrad_matrix *matrix, const fibrad_scene *scene, const fibrad_matrix_rule *rule);

/* Makes them reciprocal, and closes them together with the rows of spheres, which are closed already. */
void fibrad_matrix_enclose(fibrad_matrix *matrix);

/* The first of ascending columns that is not below `column`, or their number. Without branches it takes longer: nothing
 * is fetched ahead then. */
static inline uint64_t fibrad_first_entry(const uint32_t *col, uint64_t length, uint32_t column) {
    uint64_t low = 0, high = length;
    while (low < high) {
        const uint64_t middle = low + (high - low) / 2;
        if (col[middle] < column)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Sum of a row. */
double fibrad_sparse_sum(const fibrad_sparse *rows, uint32_t i);

/* Where column j stands in row i, or UINT64_MAX. */
uint64_t fibrad_sparse_find(const fibrad_sparse *rows, uint32_t i, uint32_t j);

/* Brings row sums above 1 down to 1 and leaves reciprocity as it is: F_ij times min(s_i, s_j), s = min(1, 1/sum). */
void fibrad_matrix_limit(fibrad_matrix *matrix);

/* One step of u, the second n of scratch, with which rows have the sums wanted: u_i sum_j F_ij u_j is the first n of
 * scratch; or, to close rows, u_i (rest_i + sum_j F_ij u_j) is 1, rest_i being the first n, what they meet besides
 * spheres. The next u are the third n. Returns by how much the worst row is off now. */
double fibrad_matrix_step(fibrad_matrix *matrix, bool closing);

/* Closes reciprocal rows, with what raw rows meet besides spheres, and leaves reciprocity as it is: F_ij u_i u_j with u
 * found so; to 1e-14 where such u exist, as they do where rows meet more than spheres, or have an F_ii or loops of
 * three and are not far off. No row meets more than 1 of spheres. What it meets besides is not written. */
void fibrad_matrix_balance(fibrad_matrix *matrix);

/* Drops entries below the threshold and gives what they carried back, so that row sums are as before; what no scaling
 * can place goes into F_ii. The capacity has room for n entries more. */
void fibrad_matrix_drop(fibrad_matrix *matrix);

#endif
