/* plot_data.c - the numbers in a picture of a bed. SPDX-License-Identifier: MIT */
#include "plot/plot_data.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/message.h"
#include "text/read_number.h"

/* Distance of two centres, or of their nearest images in a periodic bed. i = j: distance of a sphere from its nearest
 * image. */
static double distance_of_pair(const struct bed *bed, uint32_t i, uint32_t j) {
    const double between[3] = {bed->x[j] - bed->x[i], bed->y[j] - bed->y[i], bed->z[j] - bed->z[i]};
    double square = 0, shortest = INFINITY;
    for (int axis = 0; axis < 3; ++axis) {
        const double period = bed->period[axis];
        const double d = period > 0 ? remainder(between[axis], period) : between[axis];
        if (period > 0) shortest = fmin(shortest, period);
        square += d * d;
    }
    return i == j ? shortest : sqrt(square);
}

/* The bin of x if low to high is divided into n bins. Smaller x are in the first bin, larger x in the last one. */
static int bin_index(double x, double low, double high, int n) {
    const double k = floor((x - low) / (high - low) * n);
    return k < 0 ? 0 : k >= n ? n - 1 : (int)k;
}

static void count_pairs(struct plot_data *data, const struct contents *what) {
    const struct bed *bed = what->bed;
    const fibrad_factors *matrix = &what->factors->matrix;
    double sum = 0;
    for (uint32_t i = 0; i < matrix->n; ++i)
        for (uint64_t k = matrix->start[i]; k < matrix->start[i + 1]; ++k) {
            const uint32_t j = matrix->col[k];
            const double apart = distance_of_pair(bed, i, j) / (bed->r[i] + bed->r[j]);
            const double symmetric = log10(matrix->f[k] * bed->r[i] / bed->r[j]);
            const int factor = bin_index(log10(matrix->f[k]), PLOT_FACTOR_MIN, 0, PLOT_FACTORS);
            if (apart < PLOT_DISTANCE_MAX && symmetric >= PLOT_FACTOR_MIN)
                data->pairs[bin_index(apart, 0, PLOT_DISTANCE_MAX, PLOT_DISTANCES)]
                           [bin_index(symmetric, PLOT_FACTOR_MIN, 0, PLOT_FACTORS)] += 1;
            data->entries[factor] += 1;
            data->carried[factor] += matrix->f[k];
            sum += matrix->f[k];
        }
    const double count = (double)matrix->start[matrix->n];
    for (int k = 0; k < PLOT_FACTORS && count > 0; ++k) {
        data->entries[k] /= count;
        data->carried[k] /= sum;
    }
}

/* Finds sums of factors within each distance for a selection of rows, sums[distance][row]. Returns the number of rows.
 */
static uint32_t add_distances(const struct plot_data *data, const struct contents *what, double (*sums)[PLOT_ROWS]) {
    const fibrad_factors *matrix = &what->factors->matrix;
    const uint32_t stride = matrix->n / PLOT_ROWS + 1;
    uint32_t taken = 0;
    for (uint32_t i = 0; i < matrix->n; i += stride) {
        if (what->wanted && !what->wanted[i]) continue;
        for (int d = 0; d <= PLOT_DISTANCES; ++d) sums[d][taken] = 0;
        for (uint64_t k = matrix->start[i]; k < matrix->start[i + 1]; ++k) {
            const bool back =
                what->grey && matrix->col[k] == i; /* emission that other spheres reflect to its own sphere */
            const double apart = back ? 0 : distance_of_pair(what->bed, i, matrix->col[k]) / data->diameter;
            if (apart < PLOT_DISTANCE_MAX)
                sums[bin_index(apart, 0, PLOT_DISTANCE_MAX, PLOT_DISTANCES) + 1][taken] += matrix->f[k];
        }
        for (int d = 1; d <= PLOT_DISTANCES; ++d) sums[d][taken] += sums[d - 1][taken];
        ++taken;
    }
    return taken;
}

int plot_data_collect(struct plot_data *data, const struct contents *what) {
    memset(data, 0, sizeof *data);
    const struct bed *bed = what->bed;
    data->diameter = bed_diameter(bed);
    count_pairs(data, what);
    double(*sums)[PLOT_ROWS] = calloc(PLOT_DISTANCES + 1, sizeof *sums);
    if (!sums) return message_memory();
    const uint32_t taken = add_distances(data, what, sums);
    for (int d = 0; d <= PLOT_DISTANCES && taken > 0; ++d) {
        qsort(sums[d], taken, sizeof *sums[d], number_order);
        for (int q = 0; q < 3; ++q) data->within[d][q] = sums[d][(taken - 1) * (uint32_t)(1 + 4 * q) / 10];
    }
    free(sums);
    return STATUS_OK;
}
