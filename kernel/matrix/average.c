/* average.c - the mean of a matrix and its transpose, some rows at a time. SPDX-License-Identifier: MIT
 *
 * A row of the result is merged from the rows of the matrix and of its transpose. Both have ascending columns. So
 * memory is read in order, which a search for the partner of each entry would not do. The rows of the transpose are
 * at the end of the range of a part. The result grows from the beginning of the range. It never reaches them, since
 * the entries still to come are at least as many as the entries left in the transpose. */
#include "matrix/matrix.h"

uint64_t fibrad_matrix_count_part(fibrad_matrix *m, const fibrad_matrix_part *part) {
    uint64_t count = 0;
    for (uint32_t j = part->begin; j < part->end; j++) m->place[j] = 0;
    for (uint32_t i = 0; i < m->result.n && part->begin < part->end; i++) {
        const uint32_t *col = fibrad_record_col(m->row[i]), length = m->row[i]->length;
        const uint32_t first = (uint32_t)fibrad_first_entry(col, length, part->begin);
        uint32_t k = first;
        for (; k < length && col[k] < part->end; k++) m->place[col[k]]++;
        count += k - first;
    }
    return count;
}

/* Writes the rows of the transpose. Before: matrix->place[j] is the length of row j. After: its end. */
static void transpose_part(fibrad_matrix *m, const fibrad_matrix_part *part) {
    const fibrad_sparse to = m->result; /* copies, so that the compiler sees that stores do not change their pointers */
    uint64_t *next = m->place, place = part->transposed;
    for (uint32_t j = part->begin; j < part->end; j++) {
        const uint64_t length = next[j];
        next[j] = place;
        place += length;
    }
    for (uint32_t i = 0; i < to.n && part->begin < part->end; i++) {
        const uint32_t *col = fibrad_record_col(m->row[i]), length = m->row[i]->length;
        const double *f = fibrad_record_f(m->row[i]);
        const float *half = m->lines ? fibrad_record_half(m->row[i]) : NULL;
        for (uint32_t k = (uint32_t)fibrad_first_entry(col, length, part->begin); k < length && col[k] < part->end;
             k++) {
            const uint64_t at = next[col[k]]++;
            to.col[at] = i, to.f[at] = f[k];
            if (half != NULL) to.half[at] = half[k];
        }
    }
}

/* The error of a row along lines. Half the difference of the averaged halves has two parts. Points of masks give noise,
 * whose square is known. The rest is the error of areas of the halves. That of the whole set is smaller by a factor,
 * which was measured: docs/accuracy.md. Both halves have errors of the shares of walls in common. */
#define HALVES_ERROR 0.4

/* What the halves of a row say. */
typedef struct row_halves {
    double square, sum; /* of the differences of entries: sum of squares, and sum */
    double noise;       /* square of the noise of the entries */
} row_halves;

static double error_of_halves(const row_halves *halves, const fibrad_record *row) {
    const double all = halves->square + halves->sum * halves->sum; /* what is open differs by the sum */
    const double areas = fibrad_max(0, all - halves->noise);
    return fibrad_sqrt(HALVES_ERROR * HALVES_ERROR * areas + halves->noise + row->shares * row->shares);
}

/* Merges row i from `length` entries of its own and those of the transpose from *there on. If one of two factors is
 * exact, it is taken as it is. Exact factors have a minus sign until the rows are closed. */
static uint64_t merge_row(fibrad_matrix *m, uint32_t i, uint64_t at, uint64_t *there) {
    const fibrad_sparse to = m->result;
    const fibrad_record *row = m->row[i];
    const uint32_t *col = fibrad_record_col(row), length = row->length;
    const double *f = fibrad_record_f(row), *area = m->area, *variance = m->variance, inverse = 1 / area[i];
    const float *half = m->lines ? fibrad_record_half(row) : NULL;
    const uint64_t there_end = m->place[i];
    row_halves halves = {0, 0, 0};
    uint32_t here = 0;
    to.start[i] = at;
    while (here < length || *there < there_end) {
        const uint32_t mine = here < length ? col[here] : UINT32_MAX;
        const uint32_t theirs = *there < there_end ? to.col[*there] : UINT32_MAX, j = mine < theirs ? mine : theirs;
        const double own = mine == j ? f[here] : 0, back = theirs == j ? to.f[*there] : 0;
        const bool own_exact = half != NULL && mine == j && half[here] == FIBRAD_HALF_EXACT;
        const bool back_exact = half != NULL && theirs == j && to.half[*there] == FIBRAD_HALF_EXACT;
        const bool exact = own_exact || back_exact, one = own_exact != back_exact;
        const double own_part = one ? own_exact : fibrad_matrix_own(m, i, j);
        const double back_part = one ? back_exact : fibrad_matrix_own(m, j, i);
        const double mean = (own_part * (area[i] * own) + back_part * (area[j] * back)) * inverse;
        if (half != NULL && !exact) {
            const double ratio = area[j] * inverse;
            const double difference = ((mine == j ? half[here] : 0) + ratio * (theirs == j ? to.half[*there] : 0)) / 2;
            halves.square += difference * difference, halves.sum += difference;
            halves.noise += (variance[i] * own + ratio * ratio * (variance[j] * back)) / 4;
        }
        here += mine == j, *there += theirs == j;
        to.col[at] = j;
        to.f[at++] = exact ? -mean : mean;
    }
    if (half != NULL) m->error[i] = error_of_halves(&halves, row), m->noise[i] = fibrad_sqrt(halves.noise);
    return at;
}

void fibrad_matrix_average_part(fibrad_matrix *m, fibrad_matrix_part *part) {
    uint64_t at = part->first, there = part->transposed;
    transpose_part(m, part);
    for (uint32_t i = part->begin; i < part->end; i++) at = merge_row(m, i, at, &there);
    part->filled = at;
}
