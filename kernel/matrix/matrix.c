/* matrix.c - what is done to all rows together: reciprocity, sums of at most 1, dropping. SPDX-License-Identifier: MIT
 */
#include "base/port.h"
#include "fibrad.h"

static int check(const fibrad_rows *rows) {
    if (rows == NULL || rows->n == 0 || rows->start == NULL || rows->start[0] != 0) return FIBRAD_E_ARGUMENT;
    for (uint32_t i = 0; i < rows->n; i++)
        if (rows->start[i + 1] < rows->start[i]) return FIBRAD_E_ARGUMENT;
    uint64_t entries = rows->start[rows->n];
    if (entries > rows->capacity || (entries > 0 && (rows->col == NULL || rows->f == NULL))) return FIBRAD_E_ARGUMENT;
    for (uint32_t i = 0; i < rows->n; i++)
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++)
            if (rows->col[k] >= rows->n || (k > rows->start[i] && rows->col[k] <= rows->col[k - 1]))
                return FIBRAD_E_ARGUMENT;
    return FIBRAD_OK;
}

static int check_radii(const double *r, uint32_t n) {
    if (r == NULL) return FIBRAD_E_ARGUMENT;
    for (uint32_t i = 0; i < n; i++)
        if (!(r[i] > 0 && fibrad_finite(r[i]))) return FIBRAD_E_ARGUMENT;
    return FIBRAD_OK;
}

/* Where column j stands in row i, or UINT64_MAX. */
static uint64_t find(const fibrad_rows *rows, uint32_t i, uint32_t j) {
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

static double factor(const fibrad_rows *rows, uint32_t i, uint32_t j) {
    uint64_t k = find(rows, i, j);
    return k == UINT64_MAX ? 0 : rows->f[k];
}

/* Entries of rows [begin, end) of the union of the matrix's pattern with its transpose. */
static uint64_t union_size(const fibrad_rows *rows, uint32_t begin, uint32_t end) {
    uint64_t size = rows->start[end] - rows->start[begin];
    for (uint32_t i = 0; i < rows->n; i++)
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) {
            uint32_t j = rows->col[k];
            if (j >= begin && j < end) size += find(rows, j, i) == UINT64_MAX;
        }
    return size;
}

/* Entries of rows [begin, end) of the transpose; those of each row in place[i + 1]. */
static uint64_t count_transposed(const fibrad_rows *raw, uint32_t begin, uint32_t end, uint64_t *place) {
    uint64_t entries = raw->start[raw->n], count = 0;
    for (uint32_t i = begin; i <= end; i++) place[i] = 0;
    for (uint64_t k = 0; k < entries; k++) {
        uint32_t j = raw->col[k];
        if (j < begin || j >= end) continue;
        place[j + 1]++;
        count++;
    }
    return count;
}

/* Puts these rows of the transpose into the end of out's arrays; out->start[i], which told their lengths, becomes the
 * end of row i. */
static void transpose_to_end(const fibrad_rows *raw, uint32_t begin, uint32_t end, uint64_t from, fibrad_rows *out) {
    uint64_t *place = out->start;
    place[begin] = from;
    for (uint32_t i = begin; i < end; i++) place[i + 1] += place[i];
    for (uint32_t i = 0; i < raw->n; i++)
        for (uint64_t k = raw->start[i]; k < raw->start[i + 1]; k++) {
            uint32_t j = raw->col[k];
            if (j < begin || j >= end) continue;
            uint64_t to = place[j]++;
            out->col[to] = i, out->f[to] = raw->f[k];
        }
}

/* A row of the result is the merged row of `raw` and of its transpose, both ascending: memory is only read in order,
 * which a search for each entry's partner is not. The transpose waits at the end of out's arrays; the result grows from
 * their beginning and never reaches it, since what is still to come has at least as many entries as what is left of
 * the transpose. */
int fibrad_rows_average_part(const fibrad_rows *raw, const double *r, const double *weight, uint32_t begin,
                             uint32_t end, fibrad_rows *out) {
    if (out == NULL || raw == NULL || check(raw) != FIBRAD_OK || check_radii(r, raw->n) != FIBRAD_OK ||
        out->n != raw->n || out->start == NULL || out->start == raw->start || begin > end || end > raw->n)
        return FIBRAD_E_ARGUMENT;
    uint32_t n = raw->n;
    for (uint32_t i = 0; i < n && weight != NULL; i++)
        if (!(weight[i] >= 1e-100 && weight[i] <= 1e100)) return FIBRAD_E_ARGUMENT;
    if (out->capacity > 0 && (out->col == NULL || out->f == NULL || out->col == raw->col || out->f == raw->f))
        return FIBRAD_E_ARGUMENT;
    uint64_t own = raw->start[end] - raw->start[begin], other = count_transposed(raw, begin, end, out->start);
    if (out->capacity < own || out->capacity - own < other) {
        uint64_t needed = union_size(raw, begin, end);
        if (needed > out->capacity) {
            out->start[n] = needed;
            return FIBRAD_E_CAPACITY;
        }
    }
    uint64_t there = out->capacity - other, to = 0;
    transpose_to_end(raw, begin, end, there, out);
    for (uint32_t i = 0; i < begin; i++) out->start[i] = 0;
    for (uint32_t i = begin; i < end; i++) {
        uint64_t here = raw->start[i], here_end = raw->start[i + 1], there_end = out->start[i];
        out->start[i] = to;
        while (here < here_end || there < there_end) {
            uint32_t mine = here < here_end ? raw->col[here] : UINT32_MAX;
            uint32_t theirs = there < there_end ? out->col[there] : UINT32_MAX;
            uint32_t j = mine < theirs ? mine : theirs;
            double f = mine == j ? raw->f[here++] : 0, back = theirs == j ? out->f[there++] : 0;
            /* areas relative to the larger one; the sum is the same from both sides */
            double larger = fibrad_max(r[i], r[j]), a_i = r[i] / larger, a_j = r[j] / larger;
            a_i *= a_i, a_j *= a_j;
            double share = weight == NULL ? 0.5 : weight[i] / (weight[i] + weight[j]);
            double other_share = weight == NULL ? 0.5 : weight[j] / (weight[i] + weight[j]);
            out->col[to] = j;
            out->f[to++] = (share * (a_i * f) + other_share * (a_j * back)) / a_i;
        }
    }
    for (uint32_t i = end; i <= n; i++) out->start[i] = to;
    return FIBRAD_OK;
}

int fibrad_rows_average_weighted(const fibrad_rows *raw, const double *r, const double *weight, fibrad_rows *out) {
    return fibrad_rows_average_part(raw, r, weight, 0, raw != NULL ? raw->n : 0, out);
}

int fibrad_rows_average(const fibrad_rows *raw, const double *r, fibrad_rows *out) {
    return fibrad_rows_average_weighted(raw, r, NULL, out);
}

static double sum_of(const fibrad_rows *rows, uint32_t i) {
    double sum = 0;
    for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) sum += rows->f[k];
    return sum;
}

int fibrad_rows_limit(fibrad_rows *rows, double *scratch) {
    if (check(rows) != FIBRAD_OK || scratch == NULL) return FIBRAD_E_ARGUMENT;
    for (uint32_t i = 0; i < rows->n; i++) {
        double sum = sum_of(rows, i);
        scratch[i] = sum > 1 ? 1 / sum : 1;
    }
    for (uint32_t i = 0; i < rows->n; i++)
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++)
            rows->f[k] *= fibrad_min(scratch[i], scratch[rows->col[k]]);
    return FIBRAD_OK;
}

/* Shares `rest` out as `part` has it, walls and what escapes. */
static void share_out(double rest, const double part[FIBRAD_WALLS + 1], double wall[FIBRAD_WALLS], double *escaped) {
    double sum = 0;
    for (int k = 0; k <= FIBRAD_WALLS; k++) sum += part[k];
    for (int k = 0; k < FIBRAD_WALLS; k++) wall[k] = sum > 0 ? rest * (part[k] / sum) : 0;
    *escaped = sum > 0 ? rest * (part[FIBRAD_WALLS] / sum) : rest;
}

int fibrad_rows_close(const fibrad_rows *rows, const double *r, double (*wall)[FIBRAD_WALLS], double *escaped) {
    if (check(rows) != FIBRAD_OK || check_radii(r, rows->n) != FIBRAD_OK || wall == NULL || escaped == NULL)
        return FIBRAD_E_ARGUMENT;
    double all[FIBRAD_WALLS + 1] = {0}, largest = 0;
    for (uint32_t i = 0; i < rows->n; i++) largest = fibrad_max(largest, r[i]);
    for (uint32_t i = 0; i < rows->n; i++) {
        double area = r[i] / largest * (r[i] / largest);
        for (int k = 0; k < FIBRAD_WALLS; k++) all[k] += area * wall[i][k];
        all[FIBRAD_WALLS] += area * escaped[i];
    }
    for (uint32_t i = 0; i < rows->n; i++) {
        double own[FIBRAD_WALLS + 1], sum = 0;
        for (int k = 0; k <= FIBRAD_WALLS; k++) {
            own[k] = k < FIBRAD_WALLS ? wall[i][k] : escaped[i];
            sum += own[k];
        }
        share_out(fibrad_max(0, 1 - sum_of(rows, i)), sum > 0 ? own : all, wall[i], &escaped[i]);
    }
    return FIBRAD_OK;
}

/* By how much A_i F_ij and A_j F_ji differ, over the larger area; the same from both sides. */
static double difference(const double *r, uint32_t i, uint32_t j, double f, double back) {
    double larger = fibrad_max(r[i], r[j]), a_i = r[i] / larger, a_j = r[j] / larger;
    return fibrad_abs(a_i * a_i * f - a_j * a_j * back);
}

int fibrad_rows_reciprocity(const fibrad_rows *rows, const double *r, double *largest) {
    if (check(rows) != FIBRAD_OK || check_radii(r, rows->n) != FIBRAD_OK || largest == NULL) return FIBRAD_E_ARGUMENT;
    double worst = 0;
    uint64_t below = 0, partners = 0; /* entries below the diagonal, and of those above it the partners */
    for (uint32_t i = 0; i < rows->n; i++)
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) {
            uint32_t j = rows->col[k];
            below += j < i;
            if (j <= i) continue;
            uint64_t partner = find(rows, j, i);
            partners += partner != UINT64_MAX;
            double back = partner == UINT64_MAX ? 0 : rows->f[partner];
            worst = fibrad_max(worst, difference(r, i, j, rows->f[k], back));
        }
    for (uint32_t i = 0; i < rows->n && partners < below; i++) /* some below the diagonal stand alone */
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1] && rows->col[k] < i; k++) {
            uint32_t j = rows->col[k];
            worst = fibrad_max(worst, difference(r, i, j, rows->f[k], factor(rows, j, i)));
        }
    *largest = worst;
    return FIBRAD_OK;
}

#define GONE -1.0

/* Takes out the pairs of which both factors are below the threshold. The lower row decides, for both. */
static void take_out(fibrad_rows *rows, const double *r, double threshold) {
    for (uint32_t i = 0; i < rows->n; i++)
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) {
            uint32_t j = rows->col[k];
            uint64_t partner = find(rows, j, i);
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
static void find_scaling(const fibrad_rows *rows, const double *target, double tolerance, double *u, double *next) {
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

static void scale(fibrad_rows *rows, const double *u) {
    for (uint32_t i = 0; i < rows->n; i++)
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) rows->f[k] *= u[i] * u[rows->col[k]];
}

/* Brings rows above their targets down to them and leaves reciprocity as it is. */
static void bring_down(fibrad_rows *rows, const double *target, double *u) {
    for (uint32_t i = 0; i < rows->n; i++) {
        double sum = sum_of(rows, i);
        u[i] = sum > target[i] ? target[i] / sum : 1;
    }
    for (uint32_t i = 0; i < rows->n; i++)
        for (uint64_t k = rows->start[i]; k < rows->start[i + 1]; k++) rows->f[k] *= fibrad_min(u[i], u[rows->col[k]]);
}

int fibrad_rows_balance(fibrad_rows *rows, const double *target, double *scratch) {
    if (check(rows) != FIBRAD_OK || target == NULL || scratch == NULL) return FIBRAD_E_ARGUMENT;
    for (uint32_t i = 0; i < rows->n; i++)
        if (!(target[i] >= 0 && fibrad_finite(target[i]))) return FIBRAD_E_ARGUMENT;
    find_scaling(rows, target, 1e-14, scratch, scratch + rows->n);
    scale(rows, scratch);
    bring_down(rows, target, scratch);
    return FIBRAD_OK;
}

/* Puts into F_ii what a row lacks of its target, by more than rounding; rows move up to make room. */
static int fill_up(fibrad_rows *rows, const double *target) {
    double rounding = 4e-15;
    uint64_t wanted = 0;
    for (uint32_t i = 0; i < rows->n; i++)
        if (target[i] - sum_of(rows, i) > rounding && find(rows, i, i) == UINT64_MAX) wanted++;
    uint64_t from = rows->start[rows->n], to = from + wanted;
    if (to > rows->capacity) return FIBRAD_E_CAPACITY;
    for (uint32_t i = rows->n; i-- > 0;) {
        double lack = target[i] - sum_of(rows, i);
        uint64_t diagonal = find(rows, i, i);
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
    return FIBRAD_OK;
}

int fibrad_rows_drop(fibrad_rows *rows, const double *r, double threshold, double *scratch) {
    if (check(rows) != FIBRAD_OK || check_radii(r, rows->n) != FIBRAD_OK || scratch == NULL || !(threshold >= 0))
        return FIBRAD_E_ARGUMENT;
    uint32_t n = rows->n;
    double *target = scratch, *u = scratch + n, *next = u + n;
    for (uint32_t i = 0; i < n; i++) target[i] = sum_of(rows, i);
    take_out(rows, r, threshold);
    find_scaling(rows, target, 0, u, next);
    scale(rows, u);
    bring_down(rows, target, u); /* where no scaling exists, rows are above or below their targets */
    return fill_up(rows, target);
}
