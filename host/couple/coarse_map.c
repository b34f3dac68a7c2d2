/* coarse_map.c - where the whole bed has particles, in coarse cells. SPDX-License-Identifier: MIT */
#include "couple/coarse_map.h"

#include <math.h>
#include <string.h>

#define CELLS_MAX 0x1p24
#define AXIS_MAX  0x1p20
#define MARGIN    1e-6 /* cells, far above rounding */

/* Cells of a width, wider ones if they were too many. */
static void choose_widths(double width, fibrad_occupancy *map) {
    for (int axis = 0; axis < 3; ++axis) width = fmax(width, (map->high[axis] - map->low[axis]) / AXIS_MAX);
    for (double product = 2 * CELLS_MAX; product > CELLS_MAX; width *= 1.25) {
        product = 1;
        for (int axis = 0; axis < 3; ++axis) {
            map->cells[axis] = (uint32_t)fmax(1, fmin(AXIS_MAX, ceil((map->high[axis] - map->low[axis]) / width)));
            product *= map->cells[axis];
        }
    }
}

/* The cells [first, last] that a sphere may touch along an axis; on periodic axes they may lie beyond the box. */
static void find_cells(const fibrad_occupancy *map, const fibrad_particle *p, int axis, int64_t *first, int64_t *last) {
    const double cells = map->cells[axis], scale = cells / (map->high[axis] - map->low[axis]);
    double low = floor((p->x[axis] - p->radius - map->low[axis]) * scale - MARGIN);
    double high = floor((p->x[axis] + p->radius - map->low[axis]) * scale + MARGIN);
    if (map->periodic[axis] && high - low + 1 >= cells) low = 0, high = cells - 1;
    if (!map->periodic[axis]) low = fmax(0, fmin(low, cells - 1)), high = fmax(0, fmin(high, cells - 1));
    *first = (int64_t)low;
    *last = (int64_t)high;
}

/* The cell in the box. */
static int64_t wrap_cell(int64_t cell, int64_t cells) { return (cell % cells + cells) % cells; }

static void mark_sphere(const fibrad_occupancy *map, const fibrad_particle *p, uint64_t *mark) {
    int64_t first[3], last[3];
    const int64_t n[3] = {map->cells[0], map->cells[1], map->cells[2]};
    for (int axis = 0; axis < 3; ++axis) find_cells(map, p, axis, &first[axis], &last[axis]);
    for (int64_t k = first[2]; k <= last[2]; ++k)
        for (int64_t j = first[1]; j <= last[1]; ++j)
            for (int64_t i = first[0]; i <= last[0]; ++i) {
                const int64_t cell = wrap_cell(i, n[0]) + n[0] * (wrap_cell(j, n[1]) + n[1] * wrap_cell(k, n[2]));
                mark[cell / 64] |= (uint64_t)1 << cell % 64;
            }
}

int fibrad_coarse_map(MPI_Comm comm, double width, const fibrad_particle *particle, size_t own, fibrad_block *mark,
                      fibrad_occupancy *map) {
    choose_widths(width, map);
    const size_t words = ((size_t)map->cells[0] * map->cells[1] * map->cells[2] + 63) / 64;
    const int status = fibrad_agree(comm, fibrad_block_fit(mark, words, sizeof(uint64_t)), NULL);
    if (status) return status;
    memset(mark->at, 0, words * sizeof(uint64_t));
    for (size_t i = 0; i < own; ++i) mark_sphere(map, &particle[i], mark->at);
    MPI_Allreduce(MPI_IN_PLACE, mark->at, (int)words, MPI_UINT64_T, MPI_BOR, comm);
    map->mark = mark->at;
    return FIBRAD_OK;
}
