/* packing.c - makes random beds and lattices. SPDX-License-Identifier: MIT */
#include "bed/packing.h"

#include <math.h>
#include <stdlib.h>

#include "cli/interrupt.h"
#include "cli/message.h"

#define PI 3.14159265358979323846

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

/* Moves spheres that reach beyond the faces z = 0 and z = edge back to these faces. */
static void move_between(struct bed *bed, double edge) {
    for (uint32_t i = 0; i < bed->n; ++i) bed->z[i] = fmin(fmax(bed->z[i], bed->r[i]), edge - bed->r[i]);
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

/* What pack() does: at most `sweeps` sweeps. layer: the spheres lie between two faces across z instead of a period. */
struct pushing {
    uint32_t sweeps;
    bool layer;
    bool apart; /* out: no spheres overlap */
};

/* Puts spheres at random and pushes them apart. */
static int pack(struct bed *bed, uint32_t n, double low, double high, double fraction, uint64_t seed,
                struct pushing *pushing) {
    double volume = 0, largest = 0;
    for (uint32_t i = 0; i < n; ++i) {
        const double r = low + (high - low) * bed_make_random(seed, 4 * (uint64_t)i);
        const int status = bed_add(bed, &(struct bed_sphere){.r = r});
        if (status) return status;
        volume += 4 * PI / 3 * r * r * r;
        largest = fmax(largest, r);
    }
    const double edge = cbrt(volume / fraction);
    for (uint32_t i = 0; i < n; ++i) {
        bed->x[i] = edge * bed_make_random(seed, 4 * (uint64_t)i + 1);
        bed->y[i] = edge * bed_make_random(seed, 4 * (uint64_t)i + 2);
        bed->z[i] = edge * bed_make_random(seed, 4 * (uint64_t)i + 3);
    }
    struct cells cells = {.side = (uint32_t)fmax(1, floor(edge / (2 * largest)))};
    cells.first = malloc((size_t)cells.side * cells.side * cells.side * sizeof *cells.first);
    cells.next = malloc(n * sizeof *cells.next);
    int status = cells.first && cells.next ? STATUS_OK : message_memory();
    pushing->apart = false;
    for (uint32_t round = 0; round < pushing->sweeps && !status && !pushing->apart; ++round) {
        if (pushing->layer) move_between(bed, edge);
        pushing->apart = !sweep_cells(bed, edge, &cells);
        status = interrupt_status();
    }
    if (pushing->layer) move_between(bed, edge);
    free(cells.first);
    free(cells.next);
    for (int axis = 0; axis < 3; ++axis) bed->period[axis] = bed->high[axis] = edge;
    return status;
}

int bed_make_packing(struct bed *bed, uint32_t n, double low, double high, double fraction, uint64_t seed) {
    struct pushing pushing = {.sweeps = SWEEPS};
    const int status = pack(bed, n, low, high, fraction, seed, &pushing);
    if (status || pushing.apart) return status;
    return message(STATUS_INPUT, "cannot pack %u spheres to %g of solid", n, fraction);
}

int bed_make_jammed(struct bed *bed, uint32_t n, double fraction, uint32_t sweeps, uint64_t seed) {
    struct pushing pushing = {.sweeps = sweeps};
    return pack(bed, n, 1, 1, fraction, seed, &pushing);
}

/* Whether unit sphere i at `at` would overlap another one. */
static bool would_overlap(const struct bed *bed, uint32_t i, const double at[3]) {
    const double *const centre[3] = {bed->x, bed->y, bed->z};
    bool overlap = false;
    for (uint32_t j = 0; j < bed->n && !overlap; ++j) {
        double square = 0;
        for (int a = 0; a < 3 && square < 4; ++a) {
            const double e = fabs(centre[a][j] - at[a]);
            const double nearest = e > bed->period[a] / 2 && bed->period[a] > 0 ? bed->period[a] - e : e;
            square += nearest * nearest;
        }
        overlap = j != i && square < 4;
    }
    return overlap;
}

/* Moves each unit sphere once by up to STEP along each axis, if it stays apart from others and between faces. */
#define STEP   .4
#define SHAKES 100
static void shake(struct bed *bed, uint64_t seed, uint64_t sweep) {
    for (uint32_t i = 0; i < bed->n; ++i) {
        double at[3] = {bed->x[i], bed->y[i], bed->z[i]};
        bool inside = true;
        for (int a = 0; a < 3; ++a) {
            at[a] += STEP * (2 * bed_make_random(seed, 3 * (sweep * bed->n + i) + (uint64_t)a) - 1);
            if (bed->period[a] > 0)
                at[a] -= bed->period[a] * floor(at[a] / bed->period[a]);
            else
                inside = inside && at[a] >= 1 && at[a] <= bed->high[a] - 1;
        }
        if (!inside || would_overlap(bed, i, at)) continue;
        bed->x[i] = at[0];
        bed->y[i] = at[1];
        bed->z[i] = at[2];
    }
}

static int shake_all(struct bed *bed, uint32_t sweeps, uint64_t seed) {
    int status = STATUS_OK;
    for (uint32_t sweep = 0; sweep < sweeps && !status; ++sweep) {
        shake(bed, seed, sweep);
        status = interrupt_status();
    }
    return status;
}

int bed_make_layer(struct bed *bed, uint32_t n, double fraction, uint32_t sweeps, uint64_t seed) {
    struct pushing pushing = {.sweeps = sweeps, .layer = true};
    const int status = pack(bed, n, 1, 1, fraction, seed, &pushing);
    bed->period[2] = 0;
    return status ? status : shake_all(bed, SHAKES, seed);
}

int bed_make_shaken(struct bed *bed, uint32_t cells, double fraction, uint64_t seed) {
    static const double site[4][3] = {{0, 0, 0}, {.5, .5, 0}, {.5, 0, .5}, {0, .5, .5}};
    const double cell = cbrt(16 * PI / 3 / fraction);
    int status = STATUS_OK;
    for (uint32_t k = 0; k < 4 * cells * cells * cells && !status; ++k) {
        const double *at = site[k % 4];
        status = bed_add(bed, &(struct bed_sphere){.x = cell * (k / 4 % cells + at[0]),
                                                   .y = cell * (k / 4 / cells % cells + at[1]),
                                                   .z = cell * (k / 4 / cells / cells + at[2]),
                                                   .r = 1});
    }
    for (int axis = 0; axis < 3; ++axis) bed->period[axis] = bed->high[axis] = cells * cell;
    return status ? status : shake_all(bed, SHAKES, seed);
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
    const double edge = cbrt(4 * PI / 3 * (small + large * ratio * ratio * ratio) / fraction);
    for (uint32_t i = 0; i < n; ++i) {
        const int status = bed_add(bed, &(struct bed_sphere){.x = edge * bed_make_random(seed, 3 * (uint64_t)i),
                                                             .y = edge * bed_make_random(seed, 3 * (uint64_t)i + 1),
                                                             .z = edge * bed_make_random(seed, 3 * (uint64_t)i + 2),
                                                             .r = i < large ? ratio : 1});
        if (status) return status;
    }
    struct cells cells = {.side = (uint32_t)fmax(1, floor(edge / 2))};
    cells.first = malloc((size_t)cells.side * cells.side * cells.side * sizeof *cells.first);
    cells.next = malloc(n * sizeof *cells.next);
    int status = cells.first && cells.next ? STATUS_OK : message_memory();
    for (uint32_t round = 0; !status && sweep_by_size(bed, edge, &cells); ++round) {
        status = interrupt_status();
        if (round == SWEEPS)
            status = message(STATUS_INPUT, "cannot pack spheres of two sizes to %g of solid", fraction);
    }
    free(cells.first);
    free(cells.next);
    for (int axis = 0; axis < 3; ++axis) bed->period[axis] = bed->high[axis] = edge;
    return status;
}

int bed_make_copies(struct bed *to, const struct bed *from, const uint32_t copies[3]) {
    int status = STATUS_OK;
    for (uint32_t i = 0; i < from->n; ++i)
        for (uint32_t a = 0; a < copies[0]; ++a)
            for (uint32_t b = 0; b < copies[1]; ++b)
                for (uint32_t c = 0; c < copies[2] && !status; ++c)
                    status = bed_add(to, &(struct bed_sphere){.x = from->x[i] + a * from->period[0],
                                                              .y = from->y[i] + b * from->period[1],
                                                              .z = from->z[i] + c * from->period[2],
                                                              .r = from->r[i]});
    for (int axis = 0; axis < 3; ++axis) to->period[axis] = to->high[axis] = copies[axis] * from->period[axis];
    return status;
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
