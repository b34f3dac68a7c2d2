/* side_arrays.c - values of the sides of triangles, and arrays over triangles made of them.
 * SPDX-License-Identifier: MIT */
#include "mesh/meshes.h"

#include <math.h>
#include <stdlib.h>

#include "cli/message.h"

int side_arrays_begin(struct side_arrays *arrays, const struct fibrad_triangles *triangles,
                      const struct side_quantity *quantity, size_t count) {
    const size_t n = triangles->n;
    *arrays = (struct side_arrays){.n = triangles->n, .arrays = 1, .count = count};
    for (size_t t = 0; t < n; ++t)
        if (triangles->front[t] != FIBRAD_NO_WALL && triangles->back[t] != FIBRAD_NO_WALL) arrays->arrays = 3;
    double *next = arrays->values = malloc((2 + arrays->arrays) * count * n * sizeof *next);
    if (!next) return message_memory();
    for (size_t q = 0; q < count; ++q) {
        arrays->quantity[q] = quantity[q];
        arrays->quantity[q].side = next, next += 2 * n;
        for (size_t k = 0; k < arrays->arrays; ++k, next += n) arrays->quantity[q].shown[k] = next;
    }
    return STATUS_OK;
}

void side_arrays_free(struct side_arrays *arrays) {
    free(arrays->values);
    *arrays = (struct side_arrays){0};
}

double sum_of_sides(double a, double b) { return a + b; }

double mean_of_sides(double a, double b) { return a == b ? a : pow(((a * a) * (a * a) + (b * b) * (b * b)) / 2, 0.25); }

double side_joined(const double side[2], side_join *join) {
    return isnan(side[0]) ? side[1] : isnan(side[1]) ? side[0] : join(side[0], side[1]);
}

void side_arrays_show(struct side_arrays *arrays) {
    for (size_t q = 0; q < arrays->count; ++q) {
        const struct side_quantity *quantity = &arrays->quantity[q];
        for (size_t t = 0; t < arrays->n; ++t) {
            const double *side = quantity->side + 2 * t;
            quantity->shown[0][t] = side_joined(side, quantity->join);
            if (arrays->arrays > 1) quantity->shown[1][t] = side[0], quantity->shown[2][t] = side[1];
        }
    }
}
