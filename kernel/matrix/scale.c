/* scale.c - corrects the row sums of sparse reciprocal rows, and drops small entries. SPDX-License-Identifier: MIT */
#include "matrix/matrix.h"

/* The position of column j in row i, or UINT64_MAX. */
static uint64_t find_entry(const fibrad_sparse *rows, uint32_t i, uint32_t j) {
    const uint64_t start = rows->start[i], end = rows->start[i + 1];
    const uint64_t at = start + fibrad_first_entry(rows->col + start, end - start, j);
    return at < end && rows->col[at] == j ? at : UINT64_MAX;
}

double fibrad_sparse_sum(const fibrad_sparse *rows, uint32_t i) {
    double sum = 0;
    for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) sum += fibrad_abs(rows->f[k]);
    return sum;
}

/* The sum of the exact factors of row i. */
static double exact_sum(const fibrad_sparse *rows, uint32_t i) {
    double sum = 0;
    for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) sum -= fibrad_min(0, rows->f[k]);
    return sum;
}

#define GONE -1.0

/* Removes the pairs whose factors are both below the threshold. The lower row decides for both. */
static void take_out(fibrad_sparse *rows, const double *r, double threshold) {
    for (uint32_t i = 0; i < rows->n; i++)
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) {
            uint32_t j = rows->col[k];
            uint64_t partner = find_entry(rows, j, i);
            if (j == i || rows->f[k] < 0 || (j < i && partner != UINT64_MAX)) continue; /* the other row decides */
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

/* The rows that are scaled, and how. */
struct scaling {
    const fibrad_matrix *matrix;
    bool closing;
};

/* The next value of u. wanted: the value for which the sum is right if the others stay. Near the end this is the heavy
 * ball method (B. T. Polyak, USSR Comput. Math. Math. Phys. 4 (1964) 1): a step and a part of the last one, best for
 * matrices whose eigenvalues are between 0.6 and 2. It leaves a third of the error, the square root a half or more. */
static inline double next_scale(double u, double before, double wanted) {
    const double step = 0.835, inertia = 0.085, near = 0.1 * u;
    if (!(fibrad_abs(wanted - u) < near && fibrad_abs(before - u) < near)) return fibrad_sqrt(u * wanted);
    return u + step * (wanted - u) + inertia * (u - before);
}

/* A step of the rows of a part. */
static void scaling_step(void *job, uint32_t p) {
    const struct scaling *scaling = job;
    const fibrad_matrix *m = scaling->matrix;
    const fibrad_sparse *rows = &m->result;
    const double *given = m->scratch, *u = given + rows->n;
    double *next = m->scratch + 2 * (size_t)rows->n, worst = 0;
    for (uint32_t i = m->part[p].begin; i < m->part[p].end; i++) {
        const double emits = m->r[i] > 0 ? 1 : 0;
        double target = scaling->closing ? emits : given[i], sum = scaling->closing ? given[i] : 0;
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++)
            if (rows->f[k] < 0)
                target += rows->f[k];
            else
                sum += rows->f[k] * u[rows->col[k]];
        worst = fibrad_max(worst, fibrad_abs(target - u[i] * sum));
        next[i] = sum > 0 ? next_scale(u[i], next[i], target / sum) : 1;
    }
    m->part[p].worst = worst;
}

double fibrad_matrix_step(fibrad_matrix *m, bool closing) {
    double worst = 0;
    fibrad_matrix_share(m, m->tasks, scaling_step, &(struct scaling){m, closing});
    for (uint32_t p = 0; p < m->tasks; p++) worst = fibrad_max(worst, m->part[p].worst);
    return worst;
}

void fibrad_matrix_advance(fibrad_matrix *m) {
    double *u = m->scratch + m->result.n, *next = u + m->result.n;
    for (uint32_t i = 0; i < m->result.n; i++) {
        const double now = u[i];
        u[i] = next[i], next[i] = now;
    }
}

/* Finds u by steps. The values stay near 1. Each step more than halves the error if such factors exist. Ends when the
 * errors of all sums are at most `tolerance`. */
static void find_scaling(fibrad_matrix *m, bool closing, double tolerance) {
    const uint32_t n = m->result.n;
    double *u = m->scratch + n;
    for (uint32_t i = 0; i < 2 * n; i++) u[i] = 1;
    for (int step = 0; step < 60 && fibrad_matrix_step(m, closing) > tolerance; step++) fibrad_matrix_advance(m);
}

static void scale_rows(fibrad_sparse *rows, const double *u) {
    for (uint32_t i = 0; i < rows->n; i++)
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++)
            if (rows->f[k] > 0) rows->f[k] *= u[i] * u[rows->col[k]];
}

/* Reduces rows with sums above their targets to these targets. Reciprocity stays. target NULL: 1. */
static void bring_down(fibrad_sparse *rows, const double *target, double *u) {
    for (uint32_t i = 0; i < rows->n; i++) {
        const double sum = fibrad_sparse_sum(rows, i), most = target != NULL ? target[i] : 1,
                     exact = exact_sum(rows, i);
        u[i] = sum > most && sum > exact ? (most - exact) / (sum - exact) : 1;
    }
    for (uint32_t i = 0; i < rows->n; i++)
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++)
            if (rows->f[k] > 0) rows->f[k] *= fibrad_min(u[i], u[rows->col[k]]);
}

/* Finds what rows leave for all but spheres. Sampled rows say so themselves. Otherwise the averaged sum says it, since
 * it has both senses of each line. But a row without an open window, whose sum lacks no more than noise, is closed. */
#define NOISE_MOST 5.0
#define ROUNDING   1e-12

static void find_rest(void *matrix, uint32_t p) {
    const fibrad_matrix *m = matrix;
    for (uint32_t i = m->part[p].begin; i < m->part[p].end; i++) {
        const fibrad_record *row = m->row[i];
        const double *f = fibrad_record_f(row), *wall = fibrad_record_wall(row);
        double sum = 0, open = row->escaped + row->beyond;
        for (uint32_t b = 0; b < m->walls; b++) open += wall[b];
        for (uint32_t k = 0; k < row->length && m->sampled; k++) sum += f[k];
        if (!m->sampled) sum = fibrad_sparse_sum(&m->result, i);
        const bool closed = !m->sampled && !(open > 0) && !(1 - sum > NOISE_MOST * m->noise[i] + ROUNDING);
        m->scratch[i] = m->r[i] > 0 && !closed ? fibrad_max(0, 1 - sum) : 0;
    }
}

void fibrad_matrix_balance(fibrad_matrix *m) {
    double *u = m->scratch + m->result.n;
    fibrad_matrix_share(m, m->tasks, find_rest, m);
    find_scaling(m, true, 1e-14);
    scale_rows(&m->result, u);
    bring_down(&m->result, NULL, u);
    for (uint64_t k = 0; k < m->result.start[m->result.n]; k++) m->result.f[k] = fibrad_abs(m->result.f[k]);
}

/* Adds to F_ii what a row lacks of its target, if it is more than a rounding error. Rows move up to make room. */
static void fill_up(fibrad_sparse *rows, const double *target) {
    double rounding = 4e-15;
    uint64_t wanted = 0;
    for (uint32_t i = 0; i < rows->n; i++)
        if (target[i] - fibrad_sparse_sum(rows, i) > rounding && find_entry(rows, i, i) == UINT64_MAX) wanted++;
    uint64_t from = rows->start[rows->n], to = from + wanted;
    for (uint32_t i = rows->n; i-- > 0;) {
        double lack = target[i] - fibrad_sparse_sum(rows, i);
        uint64_t diagonal = find_entry(rows, i, i);
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

void fibrad_matrix_drop(fibrad_matrix *m) {
    fibrad_sparse *rows = &m->result;
    double *target = m->scratch, *u = target + rows->n;
    if (rows->n == 0) return;
    for (uint32_t i = 0; i < rows->n; i++) target[i] = fibrad_sparse_sum(rows, i);
    take_out(rows, m->r, m->drop);
    find_scaling(m, false, 0);
    scale_rows(rows, u);
    bring_down(rows, target, u); /* where no scaling exists, rows may be above or below their targets */
    fill_up(rows, target);
}
