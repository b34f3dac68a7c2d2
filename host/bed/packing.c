/* packing.c - makes random beds and lattices. SPDX-License-Identifier: MIT */
#include "bed/packing.h"

#include <math.h>
#include <stdlib.h>

#include "cli/message.h"

double bed_make_random(uint64_t seed, uint64_t count) {
    uint64_t z = (seed + 1) * 0xd1342543de82ef95u + count * 0x9e3779b97f4a7c15u;
    for (int round = 0; round < 2; ++round) {
        z = (z ^ z >> 32) * 0xbea225f9eb34556du;
        z = (z ^ z >> 29) * 0xbea225f9eb34556du;
    }
    return (double)(z >> 11) * 0x1p-53;
}

/* Spheres are pushed apart by SPARE more than necessary, relative to their distance, so that pushing comes to an end.
 */
#define SPARE  1e-4
#define SWEEPS 20000

/* Lists of spheres by cells of a periodic cube. A cell is as wide as the largest sphere, or as the smallest one for
 * sweep_by_size. */
struct cells {
    uint32_t side;  /* cells along an edge */
    int32_t *first; /* [side^3] the first sphere of the cell, or -1 */
    int32_t *next;  /* [n] the next sphere of the cell, or -1 */
};

static uint32_t cell_index(double c, double edge, uint32_t side) {
    const uint32_t cell = (uint32_t)(c / edge * side);
    return cell < side ? cell : side - 1;
}

static void fill_cells(struct cells *cells, const struct bed *bed, double edge) {
    const uint32_t side = cells->side;
    for (uint32_t c = 0; c < side * side * side; ++c) cells->first[c] = -1;
    for (uint32_t i = 0; i < bed->n; ++i) {
        const uint32_t c = (cell_index(bed->z[i], edge, side) * side + cell_index(bed->y[i], edge, side)) * side +
                           cell_index(bed->x[i], edge, side);
        cells->next[i] = cells->first[c];
        cells->first[c] = (int32_t)i;
    }
}

/* Pushes two overlapping spheres apart along their line of centres. Sphere i moves by `share` of the distance missing,
 * sphere j by the rest. Returns whether they overlapped. */
static bool push(struct bed *bed, double edge, uint32_t i, uint32_t j, double share) {
    double *const axis[3] = {bed->x, bed->y, bed->z};
    double e[3], square = 0;
    for (int a = 0; a < 3; ++a) {
        e[a] = axis[a][j] - axis[a][i];
        e[a] -= edge * round(e[a] / edge);
        square += e[a] * e[a];
    }
    const double sum = bed->r[i] + bed->r[j], distance = sqrt(square);
    if (distance >= sum) return false;
    const double missing = distance > 0 ? sum * (1 + SPARE) / distance - 1 : 0;
    for (int a = 0; a < 3; ++a) {
        axis[a][i] -= share * missing * e[a];
        axis[a][j] += (1 - share) * missing * e[a];
    }
    return true;
}

static void wrap_and_fill(struct cells *cells, struct bed *bed, double edge) {
    double *const axis[3] = {bed->x, bed->y, bed->z};
    for (int a = 0; a < 3; ++a)
        for (uint32_t i = 0; i < bed->n; ++i) axis[a][i] -= edge * floor(axis[a][i] / edge);
    fill_cells(cells, bed, edge);
}

static bool sweep_cells(struct bed *bed, double edge, struct cells *cells) {
    bool overlap = false;
    wrap_and_fill(cells, bed, edge);
    const uint32_t side = cells->side;
    for (uint32_t c = 0; c < side * side * side; ++c)
        for (int32_t dz = -1; dz <= 1; ++dz)
            for (int32_t dy = -1; dy <= 1; ++dy)
                for (int32_t dx = -1; dx <= 1; ++dx) {
                    const uint32_t x = (c % side + side + (uint32_t)dx) % side;
                    const uint32_t y = (c / side % side + side + (uint32_t)dy) % side;
                    const uint32_t z = (c / side / side + side + (uint32_t)dz) % side;
                    for (int32_t i = cells->first[c]; i >= 0; i = cells->next[i])
                        for (int32_t j = cells->first[(z * side + y) * side + x]; j >= 0; j = cells->next[j])
                            if (j > i) overlap |= push(bed, edge, (uint32_t)i, (uint32_t)j, 0.5);
                }
    return overlap;
}

/* Pushes spheres in a periodic cube apart by at most `sweeps` sweeps. The cells are at least `width` wide. *apart: no
 * spheres overlap. */
static int push_all(struct bed *bed, double edge, double width, bool sweep(struct bed *, double, struct cells *),
                    uint32_t sweeps, bool *apart) {
    struct cells cells = {.side = (uint32_t)fmax(1, floor(edge / width))};
    cells.first = malloc((size_t)cells.side * cells.side * cells.side * sizeof *cells.first);
    cells.next = malloc(bed->n * sizeof *cells.next);
    int status = cells.first && cells.next ? STATUS_OK : message_memory();
    *apart = false;
    for (uint32_t round = 0; round < sweeps && !status && !*apart; ++round) {
        *apart = !sweep(bed, edge, &cells);
        status = interrupt_status();
    }
    free(cells.first);
    free(cells.next);
    for (int axis = 0; axis < 3; ++axis) bed->period[axis] = bed->high[axis] = edge;
    return status;
}

/* Puts spheres at random and pushes them apart. */
static int pack(struct bed *bed, uint32_t n, double low, double high, double fraction, uint64_t seed, uint32_t sweeps,
                bool *apart) {
    double volume = 0, largest = 0;
    for (uint32_t i = 0; i < n; ++i) {
        const double r = low + (high - low) * bed_make_random(seed, 4 * (uint64_t)i);
        const int status = bed_add(bed, &(struct bed_sphere){.r = r});
        if (status) return status;
        volume += 4 * M_PI / 3 * r * r * r;
        largest = fmax(largest, r);
    }
    const double edge = cbrt(volume / fraction);
    for (uint32_t i = 0; i < n; ++i) {
        bed->x[i] = edge * bed_make_random(seed, 4 * (uint64_t)i + 1);
        bed->y[i] = edge * bed_make_random(seed, 4 * (uint64_t)i + 2);
        bed->z[i] = edge * bed_make_random(seed, 4 * (uint64_t)i + 3);
    }
    return push_all(bed, edge, 2 * largest, sweep_cells, sweeps, apart);
}

int bed_make_packing(struct bed *bed, uint32_t n, double low, double high, double fraction, uint64_t seed) {
    bool apart;
    const int status = pack(bed, n, low, high, fraction, seed, SWEEPS, &apart);
    return status || apart ? status : message(STATUS_INPUT, "cannot pack %u spheres to %g of solid", n, fraction);
}

int bed_make_jammed(struct bed *bed, uint32_t n, double fraction, uint32_t sweeps, uint64_t seed) {
    bool apart;
    return pack(bed, n, 1, 1, fraction, seed, sweeps, &apart);
}

/* A sweep for spheres of very different sizes. Cells are as wide as the smallest sphere. Of each pair the larger sphere
 * looks for the smaller one, and the smaller one moves. */
static bool sweep_by_size(struct bed *bed, double edge, struct cells *cells) {
    bool overlap = false;
    wrap_and_fill(cells, bed, edge);
    const int64_t side = cells->side;
    for (uint32_t i = 0; i < bed->n; ++i) {
        const double *const centre[3] = {bed->x, bed->y, bed->z};
        int64_t low[3], high[3];
        for (int a = 0; a < 3; ++a) {
            low[a] = (int64_t)floor((centre[a][i] - 2 * bed->r[i]) / edge * (double)side);
            high[a] = (int64_t)floor((centre[a][i] + 2 * bed->r[i]) / edge * (double)side);
            if (high[a] - low[a] >= side) high[a] = low[a] + side - 1;
        }
        for (int64_t z = low[2]; z <= high[2]; ++z)
            for (int64_t y = low[1]; y <= high[1]; ++y)
                for (int64_t x = low[0]; x <= high[0]; ++x) {
                    const int64_t cell = ((z + side) % side * side + (y + side) % side) * side + (x + side) % side;
                    for (int32_t j = cells->first[cell]; j >= 0; j = cells->next[j]) {
                        const double r = bed->r[j], size = pow(bed->r[i] / r, 3);
                        if (r < bed->r[i] || (!(r > bed->r[i]) && (uint32_t)j > i))
                            overlap |= push(bed, edge, i, (uint32_t)j, 1 / (1 + size));
                    }
                }
    }
    return overlap;
}

int bed_make_two_sizes(struct bed *bed, uint32_t large, double ratio, double fraction, uint64_t seed) {
    const uint32_t small = (uint32_t)(large * ratio * ratio * ratio + 0.5), n = large + small;
    const double edge = cbrt(4 * M_PI / 3 * (small + large * ratio * ratio * ratio) / fraction);
    for (uint32_t i = 0; i < n; ++i) {
        const int status = bed_add(bed, &(struct bed_sphere){.x = edge * bed_make_random(seed, 3 * (uint64_t)i),
                                                             .y = edge * bed_make_random(seed, 3 * (uint64_t)i + 1),
                                                             .z = edge * bed_make_random(seed, 3 * (uint64_t)i + 2),
                                                             .r = i < large ? ratio : 1});
        if (status) return status;
    }
    bool apart;
    const int status = push_all(bed, edge, 2, sweep_by_size, SWEEPS, &apart);
    return status || apart ? status
                           : message(STATUS_INPUT, "cannot pack spheres of two sizes to %g of solid", fraction);
}

int bed_make_fcc(struct bed *bed, double low, double distance, uint64_t seed) {
    const double edge = sqrt(2);
    const int most = (int)(distance / edge) + 1;
    int status = bed_add(bed, &(struct bed_sphere){.r = 1});
    uint64_t count = 0;
    for (int i = -most; i <= most; ++i)
        for (int j = -most; j <= most; ++j)
            for (int k = -most; k <= most; ++k) {
                const int square = i * i + j * j + k * k;
                if ((i + j + k) % 2 != 0 || square == 0) continue;
                const double r = low + (1 - low) * bed_make_random(seed, count++);
                if (2 * square > distance * distance * (1 + 1e-12) || status) continue;
                status = bed_add(bed, &(struct bed_sphere){edge * i, edge * j, edge * k, r, 0, 0});
            }
    return status;
}
