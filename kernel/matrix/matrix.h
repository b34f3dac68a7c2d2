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
    const fibrad_rows *given; /* [given_count] the collections, and the sum of their changes so far */
    uint32_t given_count;
    uint64_t given_serial;
    double drop;
    const fibrad_record **row; /* [n] raw rows by sphere */
    double *r;                 /* [n] radii, times the root of the emissivity with exchange factors */
    uint64_t *place;           /* [n] where the next entry of each row of the transpose goes */
    double *scratch;           /* [3 n] */
    double *escaped, *beyond, *error;
    double *body;    /* [n][bodies] */
    bool enclosed;   /* whether bodies have rows, too; else what follows is not used */
    double *between; /* [bodies][bodies] */
    double *body_escaped, *body_error;
    double *newton, *before;          /* [bodies][bodies + 1] scratch */
    double length[FIBRAD_BODIES_MAX]; /* as r of spheres; 0: no row */
    double correction;                /* the largest distance of a body's sum from 1, before all were closed */
    fibrad_matrix_part *part;         /* [tasks] */
};

/* Averages the rows of a part. */
void fibrad_matrix_average_part(fibrad_matrix *matrix, fibrad_matrix_part *part);

/* Takes over the rows of bodies that a rule has. */
void fibrad_matrix_take_bodies(fibrad_matrix *matrix, const fibrad_scene *scene, const fibrad_matrix_rule *rule);

/* Makes them reciprocal, and closes them together with the rows of spheres, which are closed already. */
void fibrad_matrix_enclose(fibrad_matrix *matrix);

/* Sum of a row. */
double fibrad_sparse_sum(const fibrad_sparse *rows, uint32_t i);

/* Where column j stands in row i, or UINT64_MAX. */
uint64_t fibrad_sparse_find(const fibrad_sparse *rows, uint32_t i, uint32_t j);

/* Brings row sums above 1 down to 1 and leaves reciprocity as it is: F_ij times min(s_i, s_j), s = min(1, 1/sum).
 * scratch [n]. */
void fibrad_sparse_limit(fibrad_sparse *rows, double *scratch);

/* Brings the row sums of reciprocal rows to `target` and leaves reciprocity as it is: F_ij u_i u_j with u found so; to
 * 1e-14 where such u exist, as they do if rows have an F_ii or loops of three and are not far off. Else some rows end
 * below their targets, none above. scratch [2 n]. */
void fibrad_sparse_balance(fibrad_sparse *rows, const double *target, double *scratch);

/* Drops entries below `threshold` and gives what they carried back, so that row sums are as before; what no scaling can
 * place goes into F_ii. scratch [3 n]. The capacity has room for n entries more. */
void fibrad_sparse_drop(fibrad_sparse *rows, const double *r, double threshold, double *scratch);

#endif
