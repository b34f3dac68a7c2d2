/* coarse_map.c - marks the coarse cells of the whole bed that have particles. SPDX-License-Identifier: MIT */
#include "couple/ranks/ranks.h"

#include <math.h>
#include <string.h>

#define CELLS_MAX 0x1p24
#define AXIS_MAX  0x1p20
#define MARGIN    1e-6 /* in widths of a cell, far above rounding */

#define CELLS_AT_ONCE 64 /* along x */

#define TRIM_ROUNDS 16
#define TRIM_UNITS  0x1p16 /* units per side of the box: squares of 2^31 positions fit into a sum */

/* Divides the box into cells of a width, with at most AXIS_MAX cells along an axis. Returns the number of cells. */
static double divide_box(double width, fibrad_occupancy *map) {
    double product = 1;
    for (int axis = 0; axis < 3; ++axis) {
        map->cells[axis] = (uint32_t)fmax(1, fmin(AXIS_MAX, ceil((map->high[axis] - map->low[axis]) / width)));
        product *= map->cells[axis];
    }
    return product;
}

/* Narrows the box along open axes to mean and four standard deviations of the centres, again and again while centres
 * are left out. So particles lost far away do not make the cells wide. Sums are of whole numbers, so the result does
 * not depend on who owns which particle. */
static void leave_out_strays(MPI_Comm comm, const fibrad_particle *particle, size_t own, double radius,
                             fibrad_occupancy *map) {
    bool less = true;
    for (int round = 0; round < TRIM_ROUNDS && less; ++round) {
        uint64_t sum[3][3] = {{0}}; /* by axis: number of centres, sum of their positions, sum of squared positions */
        for (size_t i = 0; i < own; ++i) {
            const double *x = particle[i].x;
            for (int axis = 0; axis < 3; ++axis) {
                const double at = (x[axis] - map->low[axis]) / (map->high[axis] - map->low[axis]);
                if (!(at >= 0 && at <= 1)) continue;
                const uint64_t place = (uint64_t)(at * TRIM_UNITS);
                sum[axis][0]++, sum[axis][1] += place, sum[axis][2] += place * place;
            }
        }
        MPI_Allreduce(MPI_IN_PLACE, sum, 9, MPI_UINT64_T, MPI_SUM, comm);
        less = false;
        for (int axis = 0; axis < 3; ++axis) {
            const double count = (double)sum[axis][0], side = map->high[axis] - map->low[axis];
            if (map->periodic[axis] || !(count > 0)) continue;
            const double mean = (double)sum[axis][1] / count;
            const double square = fmax(0, (double)sum[axis][2] / count - mean * mean);
            const double from = (mean - 4 * sqrt(square) - 1) / TRIM_UNITS * side - radius;
            const double to = (mean + 4 * sqrt(square) + 1) / TRIM_UNITS * side + radius;
            less = less || from > 0 || to < side;
            map->high[axis] = map->low[axis] + fmin(to, side);
            map->low[axis] += fmax(from, 0);
        }
    }
}

/* Finds the cells [first, last] that a sphere touches along an axis. On periodic axes they may lie beyond the box.
 * Returns whether the sphere touches the box. */
static bool find_cells(const fibrad_occupancy *map, const fibrad_particle *p, int axis, int64_t *first, int64_t *last) {
    const double cells = map->cells[axis], scale = cells / (map->high[axis] - map->low[axis]);
    double low = floor((p->x[axis] - p->radius - map->low[axis]) * scale - MARGIN);
    double high = floor((p->x[axis] + p->radius - map->low[axis]) * scale + MARGIN);
    if (map->periodic[axis] && high - low + 1 >= cells) low = 0, high = cells - 1;
    const bool touches = map->periodic[axis] || (high >= 0 && low <= cells - 1);
    if (!map->periodic[axis]) low = fmax(0, fmin(low, cells - 1)), high = fmax(0, fmin(high, cells - 1));
    *first = (int64_t)low;
    *last = (int64_t)high;
    return touches;
}

/* The square of the distance along an axis from the centre of a sphere to a cell. */
static double square_to_cell(const fibrad_occupancy *map, const fibrad_particle *p, int axis, int64_t cell) {
    const double width = (map->high[axis] - map->low[axis]) / map->cells[axis];
    const double low = map->low[axis] + ((double)cell - MARGIN) * width;
    const double before = low - p->x[axis], behind = p->x[axis] - low - (1 + 2 * MARGIN) * width;
    const double d = before > behind ? before : behind;
    return d > 0 ? d * d : 0;
}

/* The number of a cell within the periodic box. */
static int64_t wrap_cell(int64_t cell, int64_t cells) {
    return cell >= 0 && cell < cells ? cell : (cell % cells + cells) % cells;
}

/* Marks the cells of a row along x that a sphere touches: those whose square[] is at most `most`. */
static void mark_row(uint64_t *mark, const double *square, int64_t count, double most, int64_t row, int64_t at,
                     int64_t cells) {
    for (int64_t i = 0; i < count; ++i) {
        const int64_t cell = row + wrap_cell(at + i, cells);
        mark[cell / 64] |= (uint64_t)(square[i] <= most) << cell % 64;
    }
}

static void mark_sphere(const fibrad_occupancy *map, const fibrad_particle *p, uint64_t *mark) {
    int64_t first[3], last[3];
    const int64_t n[3] = {map->cells[0], map->cells[1], map->cells[2]};
    for (int axis = 0; axis < 3; ++axis)
        if (!find_cells(map, p, axis, &first[axis], &last[axis])) return;
    for (int64_t from = first[0]; from <= last[0]; from += CELLS_AT_ONCE) {
        double square[CELLS_AT_ONCE];
        const int64_t left = last[0] + 1 - from, count = left < CELLS_AT_ONCE ? left : CELLS_AT_ONCE;
        for (int64_t i = 0; i < count; ++i) square[i] = square_to_cell(map, p, 0, from + i);
        for (int64_t k = first[2]; k <= last[2]; ++k)
            for (int64_t j = first[1]; j <= last[1]; ++j) {
                const double most = p->radius * p->radius - square_to_cell(map, p, 1, j) - square_to_cell(map, p, 2, k);
                const int64_t row = n[0] * (wrap_cell(j, n[1]) + n[1] * wrap_cell(k, n[2]));
                if (most >= 0) mark_row(mark, square, count, most, row, from, n[0]);
            }
    }
}

int fibrad_coarse_map(MPI_Comm comm, double width, double radius, const fibrad_particle *particle, size_t own,
                      fibrad_block *mark, fibrad_occupancy *map) {
    if (divide_box(width, map) > CELLS_MAX) leave_out_strays(comm, particle, own, radius, map);
    while (divide_box(width, map) > CELLS_MAX) width *= 1.25;
    const size_t words = ((size_t)map->cells[0] * map->cells[1] * map->cells[2] + 63) / 64;
    const int status = fibrad_agree(comm, fibrad_block_fit(mark, words, sizeof(uint64_t)), NULL);
    if (status) return status;
    memset(mark->at, 0, words * sizeof(uint64_t));
    for (size_t i = 0; i < own; ++i) mark_sphere(map, &particle[i], mark->at);
    MPI_Allreduce(MPI_IN_PLACE, mark->at, (int)words, MPI_UINT64_T, MPI_BOR, comm);
    map->mark = mark->at;
    return FIBRAD_OK;
}
