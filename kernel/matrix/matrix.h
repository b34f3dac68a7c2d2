/* matrix.h - the inside of a matrix of factors. SPDX-License-Identifier: MIT */
#ifndef FIBRAD_MATRIX_MATRIX_H
#define FIBRAD_MATRIX_MATRIX_H

#include "scene/scene.h"
#include "rows/record.h"

/* Rows begin to end - 1 of the result. One task averages them into a range of col and f of its own. */
typedef struct fibrad_matrix_part {
    uint32_t begin, end;
    uint64_t first, transposed, last; /* the range, and the place in it where the rows of the transpose begin */
    uint64_t filled;                  /* end of the averaged rows */
    uint64_t to;                      /* place of the rows after all parts have been moved together */
    double worst;                     /* largest value of a row, for the present step */
    uint32_t worst_row;               /* the row with this value */
} fibrad_matrix_part;

/* Compressed rows under construction. */
typedef struct fibrad_sparse {
    uint32_t n;
    uint64_t capacity;
    uint64_t *start;
    uint32_t *col;
    double *f;
    float *half; /* [capacity], of the transpose, as in fibrad_row; NULL unless all rows are along lines */
} fibrad_sparse;

struct fibrad_matrix {
    fibrad_sparse result;
    uint32_t walls, tasks;
    bool raw, exchange, open, closed;
    bool sampled;             /* exchange factors, or view factors by rays: averaged by variances */
    bool lines;               /* all rows are along lines */
    bool bodies;              /* rows are of bodies */
    const fibrad_rows *given; /* [given_count], the collections; given_serial is the sum of their changes so far */
    uint32_t given_count;
    uint64_t given_serial;
    double drop;
    const fibrad_record **row;        /* [n], raw row of each sphere */
    double *r;                        /* L, [n], radii, for exchange factors times the root of the emissivity */
    double *radius;                   /* L, [n], radii, if sampled */
    double *area;                     /* [n], square of r over the largest r */
    double *noise;                    /* [n], that of the sum of each averaged row; infinity: not along lines */
    double *variance;                 /* [n], of the noise of raw rows; of all rows along lines */
    uint64_t *place;                  /* [n], position of the next entry of each row of the transpose */
    double *scratch;                  /* [3 n] */
    double all[FIBRAD_WALLS_MAX + 2]; /* sums over all spheres: to each wall, the surroundings, beyond */
    fibrad_parallel *parallel;
    void *context;
    double *escaped, *beyond, *error;
    double *wall;    /* [n][walls] */
    bool enclosed;   /* whether walls have rows; otherwise the fields up to wall_closure are not used */
    double *between; /* [walls][walls] */
    double *wall_escaped, *wall_error;
    double *newton, *before;         /* [walls][walls + 1] scratch */
    double length[FIBRAD_WALLS_MAX]; /* L, as r of spheres; 0: the wall has no row */
    double correction;               /* largest |sum - 1| of a wall's row before closing */
    double wall_closure;             /* largest |sum - 1| of a wall's row after closing */
    double changed;                  /* as in fibrad_factors, with changed_row */
    uint32_t changed_row;
    fibrad_matrix_part *part; /* [tasks] */
};

/* Does pieces 0 to pieces - 1 of a job, by the caller's threads if `parallel` is set. */
static inline void fibrad_matrix_share(const fibrad_matrix *m, uint32_t pieces, fibrad_piece *piece, void *job) {
    if (m->parallel != NULL && pieces > 1) {
        m->parallel(m->context, pieces, piece, job);
        return;
    }
    for (uint32_t k = 0; k < pieces; k++) piece(job, k);
}

/* Counts the entries of the rows of the transpose in a part, into matrix->place. Returns their sum. */
uint64_t fibrad_matrix_count_part(fibrad_matrix *matrix, const fibrad_matrix_part *part);

/* The weight of row i in the average of rows i and j. It is 1/2 for view factors by areas. Along lines each row has the
 * areas of one sense of each line, so both rows together are one sum. Sampled factors have weights by variances:
 * A_j/(A_i + A_j). There are as many paths from i as from j, and each carries the emission of its sphere over their
 * number. So the variance is as the area. */
static inline double fibrad_matrix_own(const fibrad_matrix *m, uint32_t i, uint32_t j) {
    if (!m->sampled) return 0.5;
    const double ratio = m->radius[i] / m->radius[j];
    return 1 / (1 + ratio * ratio);
}

/* Averages the rows of a part. */
void fibrad_matrix_average_part(fibrad_matrix *matrix, fibrad_matrix_part *part);

/* Copies the rows of walls of a rule. */
void fibrad_matrix_take_walls(fibrad_matrix *matrix, const fibrad_scene *scene, const fibrad_matrix_rule *rule);

/* Makes the rows of walls reciprocal, and closes all rows together. The rows of spheres must be closed already. */
void fibrad_matrix_enclose(fibrad_matrix *matrix);

/* Position of the first of ascending columns that is not below `column`, or `length`. A version without branches takes
 * longer, since the processor then fetches nothing ahead. */
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

/* The sum of row i. */
double fibrad_sparse_sum(const fibrad_sparse *rows, uint32_t i);

/* One step of the iteration for u. scratch holds three arrays of n elements: given, u, and the u before, which becomes
 * the next u.
 *   closing false  u_i sum_j F_ij u_j = given_i
 *   closing true   u_i (given_i + sum_j F_ij u_j) = 1, given_i being what row i gives to walls, surroundings and beyond
 * Returns the largest error of these equations for the present u. */
double fibrad_matrix_step(fibrad_matrix *matrix, bool closing);

/* Makes the next u the present one. */
void fibrad_matrix_advance(fibrad_matrix *matrix);

/* Closes reciprocal rows: F_ij becomes F_ij u_i u_j with u of fibrad_matrix_step. Reciprocity stays. Sums are 1 to
 * 1e-14 where such u exist. They exist if rows meet more than spheres, or if rows have an F_ii or loops of three
 * spheres and are not far from closed. No sum over spheres is above 1 afterwards. Factors to walls, escaped and beyond
 * stay. */
void fibrad_matrix_balance(fibrad_matrix *matrix);

/* Drops entries below matrix->drop and scales the others so that row sums stay. What no scaling can restore goes to
 * F_ii. The capacity has room for n more entries. */
void fibrad_matrix_drop(fibrad_matrix *matrix);

#endif
