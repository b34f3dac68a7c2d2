/* scale.c - row sums of sparse reciprocal rows brought to what they should be, and small entries dropped.
 * SPDX-License-Identifier: MIT */
#include "matrix/matrix.h"

uint64_t fibrad_sparse_find(const fibrad_sparse *rows, uint32_t i, uint32_t j) {
    uint64_t low = rows->start[i], high = rows->start[i + 1];
    while (low < high) {
        uint64_t middle = low + (high - low) / 2;
        if (rows->col[middle] < j)
            low = middle + 1;
        else
            high = middle;
    }
    return low < rows->start[i + 1] && rows->col[low] == j ? low : UINT64_MAX;
}

double fibrad_sparse_sum(const fibrad_sparse *rows, uint32_t i) {
    double sum = 0;
    for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) sum += rows->f[k];
    return sum;
}

void fibrad_sparse_limit(fibrad_sparse *rows, double *scratch) {
    for (uint32_t i = 0; i < rows->n; i++) {
        double sum = fibrad_sparse_sum(rows, i);
        scratch[i] = sum > 1 ? 1 / sum : 1;
    }
    for (uint32_t i = 0; i < rows->n; i++)
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++)
            rows->f[k] *= fibrad_min(scratch[i], scratch[rows->col[k]]);
}

#define GONE -1.0

/* Takes out the pairs of which both factors are below the threshold. The lower row decides, for both. */
static void take_out(fibrad_sparse *rows, const double *r, double threshold) {
    for (uint32_t i = 0; i < rows->n; i++)
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) {
            uint32_t j = rows->col[k];
            uint64_t partner = fibrad_sparse_find(rows, j, i);
            if (j == i || rows->f[k] < 0 || (j < i && partner != UINT64_MAX)) continue; /* not its turn */
            double f = rows->f[k], back = r[i] / r[j] * (r[i] / r[j]) * f;              /* F_ji */
            if (f >= threshold || back >= threshold) continue;
            rows->f[k] = GONE;
            if (partner != UINT64_MAX) rows->f[partner] = GONE;
        }
    uint64_t to = 0, from = 0;
    for (uint32_t i = 0; i < rows->n; i++) {
        uint64_t end = rows->start[i + 1];
        rows->start[i] = to;
        for (; from < end; from++) {
            uint32_t j = rows->col[from];
            double f = rows->f[from];
            if (f == GONE) continue;
            rows->col[to] = j, rows->f[to++] = f;
        }
    }
    rows->start[rows->n] = to;
}

/* Factors u with u_i sum_j F_ij u_j = target_i, by u_i <- sqrt(u_i target_i/sum_j F_ij u_j), which stays near 1 and
 * more than halves the error each time where such factors exist. Ends when all sums are right to `tolerance`. */
static void find_scaling(const fibrad_sparse *rows, const double *target, double tolerance, double *u, double *next) {
    for (uint32_t i = 0; i < rows->n; i++) u[i] = 1;
    for (int step = 0; step < 60; step++) {
        double worst = 0;
        for (uint32_t i = 0; i < rows->n; i++) {
            double sum = 0;
            for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) sum += rows->f[k] * u[rows->col[k]];
            worst = fibrad_max(worst, fibrad_abs(target[i] - u[i] * sum));
            next[i] = sum > 0 ? fibrad_sqrt(u[i] * target[i] / sum) : 1;
        }
        if (worst <= tolerance) return;
        fibrad_copy(u, next, rows->n * sizeof *u);
    }
}

static void scale_rows(fibrad_sparse *rows, const double *u) {
    for (uint32_t i = 0; i < rows->n; i++)
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) rows->f[k] *= u[i] * u[rows->col[k]];
}

/* Brings rows above their targets down to them and leaves reciprocity as it is. */
static void bring_down(fibrad_sparse *rows, const double *target, double *u) {
    for (uint32_t i = 0; i < rows->n; i++) {
        double sum = fibrad_sparse_sum(rows, i);
        u[i] = sum > target[i] ? target[i] / sum : 1;
    }
    for (uint32_t i = 0; i < rows->n; i++)
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) rows->f[k] *= fibrad_min(u[i], u[rows->col[k]]);
}

void fibrad_sparse_balance(fibrad_sparse *rows, const double *target, double *scratch) {
    find_scaling(rows, target, 1e-14, scratch, scratch + rows->n);
    scale_rows(rows, scratch);
    bring_down(rows, target, scratch);
}

/* Puts into F_ii what a row is short of its target, by more than rounding; rows move up to make room. */
static void fill_up(fibrad_sparse *rows, const double *target) {
    double rounding = 4e-15;
    uint64_t wanted = 0;
    for (uint32_t i = 0; i < rows->n; i++)
        if (target[i] - fibrad_sparse_sum(rows, i) > rounding && fibrad_sparse_find(rows, i, i) == UINT64_MAX) wanted++;
    uint64_t from = rows->start[rows->n], to = from + wanted;
    for (uint32_t i = rows->n; i-- > 0;) {
        double lack = target[i] - fibrad_sparse_sum(rows, i);
        uint64_t diagonal = fibrad_sparse_find(rows, i, i);
        if (diagonal != UINT64_MAX && lack > rounding) rows->f[diagonal] += lack;
        bool insert = diagonal == UINT64_MAX && lack > rounding;
        uint64_t end = to;
        while (from > rows->start[i]) {
            from--;
            if (insert && rows->col[from] < i) {
                rows->col[--to] = i, rows->f[to] = lack;
                insert = false;
            }
            rows->col[--to] = rows->col[from], rows->f[to] = rows->f[from];
        }
        if (insert) rows->col[--to] = i, rows->f[to] = lack;
        rows->start[i + 1] = end;
    }
}

void fibrad_sparse_drop(fibrad_sparse *rows, const double *r, double threshold, double *scratch) {
    const uint32_t n = rows->n;
    double *target = scratch, *u = scratch + n, *next = u + n;
    for (uint32_t i = 0; i < n; i++) target[i] = fibrad_sparse_sum(rows, i);
    take_out(rows, r, threshold);
    find_scaling(rows, target, 0, u, next);
    scale_rows(rows, u);
    bring_down(rows, target, u); /* where no scaling exists, rows are above or below their targets */
    fill_up(rows, target);
}
